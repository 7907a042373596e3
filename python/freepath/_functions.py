"""Fields whose densities a function computes."""

from __future__ import annotations

import uuid
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _freepath
from ._arrays import as_triple
from ._field import Field
from ._freepath import Error


class DensityFunction(Field):
    """A density that a function computes, in place of a field of voxels.

    Where a walk needs densities, it calls the function with some few positions at a time (as many
    as a SIMD register has lanes), from many threads. What that costs depends on the function:

    * a function compiled by `numba.cfunc`, or any other C function, is called without Python, at
      the speed of C;
    * a Python callable is called with the interpreter's lock held, which takes some microseconds
      for each call and lets one thread work at a time: some fifty times slower (docs/python.md). It
      is for trying out; `bake` makes voxels of it, which walks read at full speed.

    The components of one medium are all computed or all of voxels, and share `cells`.

    Args:
        function: a callable that takes positions, float32 of shape (n, 3) [m, world], and returns n
            densities; or a compiled function with an attribute `address`, as those of `numba.cfunc`
            have, of the signature `void(float32* positions, float32* densities, intp n)` with
            x, y, z of each position one after the other; or a ctypes function of that signature.
        lower: corner of the box in which the density may differ from 0 [m, world].
        upper: its opposite corner.
        bounds: the least and the largest density anywhere in the box, a pair; or a callable that
            takes two corners of a part of the box (tuples of three numbers) and returns that pair
            for it. Tighter bounds make faster walks. Trackers that need a bound are biased where
            the largest is too low, which `statistics["bound_violations"]` counts.
        cells: how many cells bounds are asked for along x, y and z, or one number for all, from 1
            to 1024.
        name: of the density, in messages.

    Raises:
        Error: for an empty box, cells out of range, and bounds that are none. Walks raise it where
            the function returns a density that is negative, NaN or infinite, naming the position.
    """

    __slots__ = ("_function", "_lower", "_upper")
    _function: Any

    def __init__(
        self,
        function: Any,
        lower: ArrayLike,
        upper: ArrayLike,
        *,
        bounds: tuple[float, float] | Callable[..., tuple[float, float]],
        cells: int | tuple[int, int, int] = 16,
        name: str = "function",
    ) -> None:
        self._function = function
        self._lower = as_triple(lower, f"{name}: lower")
        self._upper = as_triple(upper, f"{name}: upper")
        address = _address(function)
        if address == 0 and not callable(function):
            raise TypeError(f"{name}: {function!r} is no function")
        counts = [int(n) for n in as_triple(cells, f"{name}: cells")]
        self._core = _freepath.computed_field(
            name,
            address,
            function if address else _checked(function, name),
            _bounds_function(bounds, name),
            list(self._lower),
            list(self._upper),
            counts,
        )

    def bake(self, voxel_size: float) -> Field:
        """Sample the function at the centres of voxels.

        Walks through the result read voxels at full speed; what they see is the function as the
        `interpolation` of the walk makes it of the samples.

        Args:
            voxel_size: edge of a voxel [m]; the box is filled with whole voxels, from `lower` on.

        Returns:
            A field of the same name.

        Raises:
            Error: for a size that is not positive or makes more voxels than memory holds, a
                compiled function (which takes no arrays), and densities that are none.
        """
        if _address(self._function):
            raise Error(f"{self.name}: a compiled function needs no baking; walks call it directly")
        if not (np.isfinite(voxel_size) and voxel_size > 0):
            raise Error(f"{self.name}: a voxel size of {voxel_size!r} is not positive")
        size = np.subtract(self._upper, self._lower)
        counts = np.maximum(np.ceil(size / voxel_size - 1e-6), 1)
        if counts.prod() > 2**33:
            raise Error(f"{self.name}: {counts.prod():.3g} voxels are too many: take larger ones")
        nx, ny, nz = counts.astype(int).tolist()
        y, z = np.meshgrid(np.arange(ny), np.arange(nz), indexing="ij")
        function = _checked(self._function, self.name)
        values = np.empty((nx, ny, nz), np.float32)
        for x in range(nx):
            index = np.stack([np.full_like(y, x), y, z], axis=-1).reshape(-1, 3)
            points = np.asarray(self._lower) + (index + 0.5) * voxel_size
            values[x] = function(points.astype(np.float32)).reshape(ny, nz)
        return Field.from_array(values, voxel_size=voxel_size, origin=self._lower, name=self.name)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Nothing: a computed density has no voxels."""
        raise Error(f"'{self.name}' is computed and has no voxels: bake it first")

    def _digest(self) -> str:
        # What a function computes can't be known: it is the same as itself alone.
        if not hasattr(self, "_digest_text"):
            self._digest_text = uuid.uuid4().hex
        return self._digest_text

    def __repr__(self) -> str:
        return f"<freepath.DensityFunction {self.name!r} from {self._lower} to {self._upper}>"


def _address(function: Any) -> int:
    """Address of a compiled function, 0 of others."""
    address = getattr(function, "address", 0)
    if isinstance(address, int) and address:
        return address
    if hasattr(function, "argtypes") and hasattr(function, "restype"):
        import ctypes

        return ctypes.cast(function, ctypes.c_void_p).value or 0
    return 0


def _checked(function: Callable[..., Any], name: str) -> Callable[..., NDArray[np.float32]]:
    """Return the function with its result checked and in single precision."""

    def evaluate(positions: NDArray[np.float32]) -> NDArray[np.float32]:
        values = function(positions)
        if hasattr(values, "__dlpack__") and not isinstance(values, np.ndarray):
            values = np.from_dlpack(values)
        values = np.asarray(values, np.float32)
        if values.shape != (len(positions),):
            raise Error(
                f"{name}: the function returned an array of shape {values.shape} for "
                f"{len(positions)} positions; it returns one density for each"
            )
        return np.ascontiguousarray(values)

    return evaluate


def _bounds_function(bounds: Any, name: str) -> Callable[..., tuple[float, float]]:
    """Return a function of corners that gives checked bounds."""
    if not callable(bounds):
        try:
            least, largest = bounds
        except (TypeError, ValueError):
            raise Error(f"{name}: bounds {bounds!r} are neither a pair nor a function") from None

        def constant(lower: Any, upper: Any) -> tuple[float, float]:
            return least, largest

        return _bounds_function(constant, name)

    def checked(lower: Any, upper: Any) -> tuple[float, float]:
        least, largest = (float(value) for value in bounds(tuple(lower), tuple(upper)))
        if not 0 <= least <= largest < float("inf"):
            raise Error(
                f"{name}: bounds {least} to {largest} between {tuple(lower)} and {tuple(upper)}; "
                "they are finite, not negative, the least one first"
            )
        return least, largest

    return checked
