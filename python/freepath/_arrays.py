"""Arrays that users give, as the extension takes them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._freepath import Error

Floats = NDArray[np.floating[Any]]


def as_array(values: Any, what: str) -> Floats:
    """Return values as a NumPy array of float32 or float64, without a copy where they are one.

    Args:
        values: a NumPy array, anything with DLPack (a tensor in the machine's own memory), an
            xarray.DataArray, or numbers and sequences of them, which become float64.
        what: the beginning of error messages.

    Raises:
        Error: for another dtype, or memory that NumPy cannot read.
    """
    try:
        if isinstance(values, (np.ndarray, np.generic)):
            array = np.asarray(values)
        elif hasattr(values, "__dlpack__"):
            array = np.from_dlpack(values)
        elif hasattr(values, "__array__"):
            array = np.asarray(values)
        else:
            array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError, BufferError, RuntimeError) as error:
        raise Error(
            f"{what}: {type(values).__name__} is no array of numbers that NumPy can read ({error}); "
            "give a NumPy array, or one in the machine's own memory"
        ) from error
    if not array.dtype.isnative:
        array = array.astype(array.dtype.newbyteorder("="))
    if array.dtype not in (np.float32, np.float64):
        raise Error(
            f"{what}: its dtype is {array.dtype}; give float32 or float64, "
            "for example by .astype(numpy.float32)"
        )
    # The extension counts strides in elements.
    if any(stride % array.itemsize for stride in array.strides) or not array.flags.aligned:
        array = array.copy()
    return array


def as_vectors(values: Any, what: str) -> Floats:
    """Return an array of shape (..., 3).

    Raises:
        Error: for another shape, and as as_array.
    """
    array = as_array(values, what)
    if array.ndim < 1 or array.shape[-1] != 3:
        raise Error(f"{what}: its shape is {array.shape}; give (3,), (n, 3) or (..., 3)")
    return array


def as_triple(values: Any, what: str) -> tuple[float, float, float]:
    """Return three finite numbers, or one three times.

    Raises:
        Error: for anything else.
    """
    array = as_array(values, what)
    if array.shape not in ((), (3,)) or not np.isfinite(array).all():
        raise Error(f"{what}: {values!r} is neither one finite number nor three")
    x, y, z = np.broadcast_to(array, (3,)).tolist()
    return x, y, z


class Rays:
    """Rays of a common shape, flat for the extension.

    Args:
        origins: points of shape (..., 3) [m, world].
        directions: of shape (..., 3), which has to go together with that of the origins.
        t_max: ends of the rays along them [m], of shape (...); infinity: none.
    """

    def __init__(self, origins: Any, directions: Any, t_max: Any) -> None:
        starts = as_vectors(origins, "origins")
        along = as_vectors(directions, "directions")
        ends = as_array(t_max, "t_max")
        try:
            self.shape = np.broadcast_shapes(starts.shape[:-1], along.shape[:-1], ends.shape)
        except ValueError:
            raise Error(
                f"origins of shape {starts.shape}, directions of shape {along.shape} and t_max of "
                f"shape {ends.shape} do not go together: give as many of each, or one for all"
            ) from None
        self.origins = self._flat(starts, (3,))
        self.directions = self._flat(along, (3,))
        self.t_max = self._flat(ends, ())

    def _flat(self, array: Floats, last: tuple[int, ...]) -> Floats:
        """Repeats an array without a copy where it has one value for all."""
        count = int(np.prod(self.shape, dtype=np.int64))
        if array.shape == last:
            return np.broadcast_to(array, (count, *last))
        return np.broadcast_to(array, self.shape + last).reshape((count, *last))

    def shaped(self, values: NDArray[Any], is_scalar: bool) -> Any:
        """Return results of shape (n, channels) or (n,) as (..., channels) or (...).

        Args:
            values: one for each ray, or a row of channels.
            is_scalar: whether there is one channel, whose axis goes.
        """
        if values.ndim == 2 and not is_scalar:
            return values.reshape((*self.shape, values.shape[1]))
        return values.reshape(self.shape)


def as_channels(values: Any, what: str) -> list[float] | float:
    """Return a coefficient: one number, or a list of one for each channel.

    Raises:
        Error: for another shape, and values that are negative or not finite.
    """
    array = as_array(values, what)
    if array.ndim > 1 or array.size == 0:
        raise Error(f"{what}: its shape is {array.shape}; give a number, or one for each channel")
    if not (np.isfinite(array) & (array >= 0)).all():
        raise Error(f"{what}: {values!r} must be finite and not negative")
    return array.tolist()  # type: ignore[no-any-return]


def as_count(value: Any, what: str, least: int, most: int) -> int:
    """Return a whole number, which may be written 1e6.

    Raises:
        Error: for anything else, or one out of range.
    """
    try:
        number = int(value)
        is_whole = number == value
    except (TypeError, ValueError, OverflowError):
        is_whole = False
    if not is_whole or not least <= number <= most:
        raise Error(f"{what}: {value!r} is no whole number from {least} to {most}")
    return number
