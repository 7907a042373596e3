"""Fields: densities in voxels."""

from __future__ import annotations

import os
import warnings
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _freepath
from ._arrays import as_array, as_triple
from ._freepath import Error

_AXES = "xyz"


class Field:
    """A scalar grid with its place in the world: voxels of single precision, 0 outside.

    Made by `Field.from_array`, `Field.open` or `DensityFunction.bake`, never changed afterwards,
    and shared by the media that use it. A point between voxel centres has the value that the
    `interpolation` of a walk gives it.
    """

    __slots__ = ("_core", "_digest_text")
    _core: _freepath.Field
    _digest_text: str

    def __init__(self) -> None:
        raise TypeError("fields are made by Field.from_array or Field.open")

    @classmethod
    def _of(cls, core: _freepath.Field) -> Field:
        field = cls.__new__(cls)
        field._core = core
        return field

    @classmethod
    def from_array(
        cls,
        values: Any,
        *,
        voxel_size: ArrayLike | None = None,
        origin: ArrayLike | None = None,
        transform: ArrayLike | None = None,
        axes: str | None = None,
        name: str = "density",
        negative: str = "error",
        invalid: str = "error",
    ) -> Field:
        """Copy a dense array into a field.

        By default `values[i, j, k]` is the voxel with index (i, j, k) along x, y and z, as in
        OpenVDB's copyFromArray, NiBabel and yt. Arrays of models and of pbrt's grids mostly have z
        first: give `axes="zyx"`. Of an xarray.DataArray whose dimensions are named x, y and z, the
        names count.

        Args:
            values: float32 or float64 of shape (nx, ny, nz), or as `axes` says; any strides,
                read-only too; a NumPy array, an xarray.DataArray or anything with DLPack.
            voxel_size: edge of a voxel, or three along x, y and z [m]; 1 if nothing is said.
            origin: corner of the first voxel where x, y and z are least [m, world]; 0 if nothing
                is said. The array fills the box from there to `origin + shape * voxel_size`.
            transform: in place of both, a 4x4 matrix from index space, in which voxel (i, j, k) has
                its *centre* at the point (i, j, k), to world space. As in OpenVDB points are rows:
                (i, j, k, 1) @ transform; its last row is the offset.
            axes: a permutation of "xyz", the axes of the array in their order.
            name: of the field, in messages and files.
            negative: what to do about negative values: "error", or "clamp" them to 0 with a warning.
            invalid: about values that are NaN or infinite: "error", or "zero" with a warning.

        Returns:
            The field, in bricks of 8x8x8 voxels; bricks of one value are stored once.

        Raises:
            Error: for another shape or dtype, an empty array, one larger than the machine's memory,
                values that are no densities (naming the first voxel), and a transform that is not
                4x4, not affine, or has no inverse.
        """
        dims = getattr(values, "dims", None)
        array = as_array(values, name)
        if array.ndim != 3:
            raise Error(f"{name}: its shape is {array.shape}; give an array of three axes")
        array = array.transpose(_order(axes, dims, name))
        core, notes = _freepath.field_from_array(
            array,
            name,
            _transform(voxel_size, origin, transform, name),
            _word(negative, "negative", ("error", "clamp")) == "clamp",
            _word(invalid, "invalid", ("error", "zero")) == "zero",
        )
        _tell(notes)
        return cls._of(core)

    @classmethod
    def open(
        cls,
        path: str | os.PathLike[str],
        *,
        grid: str | int | None = None,
        negative: str = "error",
        invalid: str = "zero",
    ) -> Field:
        """Read a grid of a volume file: .vdb, .nvdb, .nc and others (docs/volumes.md).

        Args:
            path: the file; what it is is told by its first bytes.
            grid: name of the grid, or its number from 0; none: the one named "density", else the
                only scalar one.
            negative: what to do about negative densities: "error", or "clamp" them to 0.
            invalid: about NaN and infinities: "error", or "zero".

        Returns:
            The field, in the place that the file gives it [m, world]. What there is to say about
            it comes as Python warnings.

        Raises:
            Error: naming file, grid and voxel, for what cannot be read or is no density.
        """
        core, notes = _freepath.open_field(
            os.fspath(path),
            "" if grid is None else str(grid),
            _word(negative, "negative", ("error", "clamp")) == "clamp",
            _word(invalid, "invalid", ("error", "zero")) == "zero",
        )
        _tell(notes)
        return cls._of(core)

    def save(self, path: str | os.PathLike[str], *, half: bool = False) -> None:
        """Write the field as a grid of an OpenVDB file.

        The file is written aside and then renamed, so that under its own name there is never a part
        of it. The same field gives the same bytes.

        Args:
            path: of the .vdb file.
            half: whether to store values in half precision: half the size, 11 significant bits.

        Raises:
            Error: if the file cannot be written.
        """
        self._core.save(os.fspath(path), half)

    def to_array(self) -> NDArray[np.float32]:
        """Return the voxels between `first_voxel` and the last active one as an array.

        Returns:
            float32 of shape (nx, ny, nz), `[i, j, k]` along x, y and z: a copy.

        Raises:
            Error: if they are more than the machine's memory holds.
        """
        return self._core.to_array()  # type: ignore[return-value]

    @property
    def name(self) -> str:
        """Name of the grid."""
        return self._core.name

    @property
    def transform(self) -> NDArray[np.float64]:
        """Matrix of shape (4, 4) from index space to world space; points are rows."""
        return np.array(self._core.transform)

    @property
    def first_voxel(self) -> tuple[int, int, int]:
        """Index of the first active voxel along x, y and z."""
        x, y, z = self._core.first_voxel
        return x, y, z

    @property
    def shape(self) -> tuple[int, int, int]:
        """Number of voxels along x, y and z, from the first active one to the last."""
        first, last = self._core.first_voxel, self._core.last_voxel
        x, y, z = (b - a + 1 for a, b in zip(first, last))
        return x, y, z

    @property
    def memory_bytes(self) -> int:
        """Bytes of the voxels and their index."""
        return self._core.memory_bytes

    def _digest(self) -> str:
        """Name for the voxels and their place in the world: the same ones, the same name."""
        if not hasattr(self, "_digest_text"):
            self._digest_text = _freepath.digest_of_field(self._core)
        return self._digest_text

    def __reduce__(self) -> Any:
        return _field_of_bricks, (
            self.name,
            self._core.transform,
            *_freepath.bricks_of_field(self._core),
        )

    def __repr__(self) -> str:
        return f"<freepath.Field {self.name!r} of {' x '.join(map(str, self.shape))} voxels>"


def _field_of_bricks(*parts: Any) -> Field:
    """Field of what pickling has made of it."""
    return Field._of(_freepath.field_of_bricks(*parts))


def _order(axes: str | None, dims: Any, name: str) -> tuple[int, int, int]:
    """Places of x, y and z among the axes of an array."""
    if axes is None and dims is not None and sorted(map(str, dims)) == list(_AXES):
        axes = "".join(map(str, dims))
    axes = axes or _AXES
    if sorted(axes) != list(_AXES):
        raise Error(f"{name}: axes {axes!r} are no permutation of 'xyz'")
    return axes.index("x"), axes.index("y"), axes.index("z")


def _transform(voxel_size: Any, origin: Any, transform: Any, name: str) -> list[list[float]]:
    """Rows of the matrix from index space to world space."""
    if transform is not None:
        if voxel_size is not None or origin is not None:
            raise Error(f"{name}: transform says again what voxel_size and origin say; give one")
        matrix = np.asarray(as_array(transform, f"{name}: transform"), np.float64)
        if matrix.shape != (4, 4) or not np.array_equal(matrix[:, 3], [0, 0, 0, 1]):
            raise Error(
                f"{name}: transform is a 4x4 matrix whose last column is 0, 0, 0, 1: points are "
                "rows, and the last row is the offset"
            )
        return matrix.tolist()
    size = as_triple(1.0 if voxel_size is None else voxel_size, f"{name}: voxel_size")
    corner = as_triple(0.0 if origin is None else origin, f"{name}: origin")
    if min(size) <= 0:
        raise Error(f"{name}: voxel_size {voxel_size!r} must be positive")
    matrix = np.diag([*size, 1.0])
    matrix[3, :3] = np.add(corner, np.multiply(0.5, size))
    return matrix.tolist()  # type: ignore[no-any-return]


def _word(value: str, what: str, words: tuple[str, ...]) -> str:
    """Return a word if it is one of those there are."""
    if value not in words:
        raise Error(f"{what} {value!r} is unknown; there are: {', '.join(words)}")
    return value


def _tell(notes: list[str]) -> None:
    """Raise what there is to say as warnings."""
    for note in notes:
        warnings.warn(note, stacklevel=3)
