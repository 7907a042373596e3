"""Free paths and transmittances of rays."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _freepath
from ._arrays import Rays, as_count
from ._field import Field
from ._freepath import Error
from ._medium import Component, Medium, as_medium

_MediumLike = Medium | Component | Field | Iterable[Component]


class Event(IntEnum):
    """How a flight ended."""

    ESCAPE = 0
    """It left the medium or reached the end of its ray."""
    SCATTER = 1
    """It scattered in a component."""
    ABSORB = 2
    """It was absorbed, or nothing was left of its weight."""


@dataclass(frozen=True)
class FreePaths:
    """What became of rays, in arrays of the rays' shape (...).

    Where the medium has several channels, those of weights have an axis more, of channels, the
    last.

    Attributes:
        distance: float32 of shape (...): from the origin to the event [m]; that of an escape is
            where the flight left the medium or its ray ended, and has no other meaning.
        event: uint8 of shape (...), of `Event`.
        component: int8 of shape (...): number of the component that scattered, -1 where none did.
        weight: float32 of shape (...) or (..., channels): throughput of the flight.
        lookups: uint32 of shape (...): densities that were read.
        emitted: float32 like `weight`: emitted radiance gathered on the way; None where the medium
            emits nothing.
        statistics: counts over all flights, by the names of the glossary.
        tracker: the method that was taken, where `auto` chose it.
    """

    distance: NDArray[np.float32]
    event: NDArray[np.uint8]
    component: NDArray[np.int8]
    weight: NDArray[np.float32]
    lookups: NDArray[np.uint32]
    emitted: NDArray[np.float32] | None
    statistics: dict[str, Any]
    tracker: str


class Estimate(NamedTuple):
    """A mean and its standard error: numbers, or arrays of one shape.

    Attributes:
        mean: the estimate.
        error: its standard error.
        upper: upper limit at a confidence of 95 %, where no sample was other than 0 though some
            could be: mean and error are 0 then, and say nothing. None otherwise, and of arrays.
    """

    mean: Any
    error: Any
    upper: float | None = None


def sample_free_paths(
    medium: _MediumLike,
    origins: ArrayLike,
    directions: ArrayLike,
    *,
    t_max: ArrayLike = np.inf,
    tracker: str = "delta",
    channels: int | Sequence[int] | None = None,
    interpolation: str = "stochastic",
    absorption: str = "weighted",
    seed: int = 0,
    threads: int = 0,
    simd: str = "best",
) -> FreePaths:
    """Fly every ray to its next scattering, absorption or escape [Kutz17].

    The flight of ray number i depends on the ray, `seed` and i alone: not on threads, on the other
    rays, or on the machine. All threads work, without Python's lock; Ctrl-C ends it.

    Args:
        medium: a `Medium`, or a component or field of one.
        origins: float32 or float64 of shape (..., 3) [m, world]. They are kept in single precision
            relative to the middle of the medium.
        directions: of shape (..., 3); unit vectors, or else scaled to be. Origins, directions and
            ends are broadcast against each other without a copy: one origin serves all directions.
        t_max: ends of the rays [m], of shape (...); infinity: none.
        tracker: a method by name, as `trackers` lists them, with its options:
            "weighted-decomposition:control=0.5"; "auto" chooses one.
        channels: None: all of the medium's, in one path, which needs a chromatic tracker
            ("spectral") where their extinctions differ; or the number of one, or several.
        interpolation: "nearest", "trilinear" or "stochastic": one voxel, drawn with its trilinear
            weight [Pharr24].
        absorption: "weighted": the weight takes the albedo; or "analog": it ends the flight.
        seed: of the random numbers, 0 to 2^64 - 1.
        threads: to work on; 0: as many as the machine has.
        simd: "best", or one of `freepath.simd()`; all give the same bits.

    Returns:
        Distances, events, components, weights and look-ups of all rays.

    Raises:
        Error: for shapes and dtypes that do not go together, rays that are none (naming the first),
            methods, words and channels that do not exist, and a tracker that the medium is not for.
        KeyboardInterrupt: at Ctrl-C; nothing is returned then.
    """
    medium = as_medium(medium)
    rays = Rays(origins, directions, t_max)
    options = walk_options(
        tracker=tracker,
        interpolation=interpolation,
        absorption=absorption,
        seed=seed,
        simd=simd,
    )
    distance, event, component, weight, lookups, emitted, statistics, taken = (
        _freepath.sample_free_paths(
            medium._core,
            rays.origins,
            rays.directions,
            rays.t_max,
            options,
            _channel_list(channels),
            threads_of(threads),
        )
    )
    is_scalar = medium.channels == 1 or isinstance(channels, (int, np.integer))
    return FreePaths(
        distance=rays.shaped(distance, is_scalar),
        event=rays.shaped(event, is_scalar),
        component=rays.shaped(component, is_scalar),
        weight=rays.shaped(weight, is_scalar),
        lookups=rays.shaped(lookups, is_scalar),
        emitted=None if emitted is None else rays.shaped(emitted, is_scalar),
        statistics=statistics,
        tracker=taken,
    )


def transmittance(
    medium: _MediumLike,
    origins: ArrayLike,
    directions: ArrayLike,
    t_max: ArrayLike = np.inf,
    *,
    estimator: str = "ratio",
    samples: int = 64,
    channels: int | Sequence[int] | None = None,
    interpolation: str = "stochastic",
    seed: int = 0,
    threads: int = 0,
    simd: str = "best",
) -> Estimate:
    """Estimate the transmittance of rays from their origins to their ends.

    Unbiased where the estimator is, at any number of samples. The result of ray number i depends on
    the ray, `samples`, `seed` and i alone.

    Args:
        medium: a `Medium`, or a component or field of one.
        origins: float32 or float64 of shape (..., 3) [m, world].
        directions: of shape (..., 3); unit vectors, or else scaled to be.
        t_max: ends of the rays [m], of shape (...); infinity: none.
        estimator: a method by name, as `estimators` lists them, with its options.
        samples: of each ray, 1 to 2^32 - 1.
        channels: as `sample_free_paths` has it; all estimators carry all channels.
        interpolation: "nearest", "trilinear" or "stochastic".
        seed: of the random numbers, 0 to 2^64 - 1.
        threads: to work on; 0: as many as the machine has.
        simd: "best", or one of `freepath.simd()`; all give the same bits.

    Returns:
        Mean and standard error, float64 of the rays' shape (...), with a last axis of channels
        where the medium has several. Of one sample its magnitude stands in for the error.

    Raises:
        Error: as `sample_free_paths`.
    """
    medium = as_medium(medium)
    rays = Rays(origins, directions, t_max)
    options = walk_options(
        estimator=estimator, interpolation=interpolation, seed=seed, simd=simd
    )
    mean, error, _ = _freepath.transmittance(
        medium._core,
        rays.origins,
        rays.directions,
        rays.t_max,
        options,
        as_count(samples, "samples", 1, 2**32 - 1),
        _channel_list(channels),
        threads_of(threads),
    )
    is_scalar = medium.channels == 1 or isinstance(channels, (int, np.integer))
    return Estimate(rays.shaped(mean, is_scalar), rays.shaped(error, is_scalar))


def walk_options(
    *,
    tracker: str = "delta",
    estimator: str = "ratio",
    interpolation: str = "stochastic",
    absorption: str = "weighted",
    emission: str = "collision",
    seed: int = 0,
    simd: str = "best",
) -> _freepath.WalkOptions:
    """Return settings of walks for the extension, which checks the words."""
    options = _freepath.WalkOptions()
    options.tracker = tracker
    options.transmittance = estimator
    options.interpolation = interpolation
    options.absorption = absorption
    options.emission = emission
    options.simd = simd
    options.seed = as_count(seed, "seed", 0, 2**64 - 1)
    return options


def threads_of(threads: int) -> int:
    """Return a number of threads, 0 for as many as the machine has."""
    return as_count(threads, "threads", 0, 4096)


def _channel_list(channels: int | Sequence[int] | None) -> list[int]:
    if channels is None:
        return []
    if isinstance(channels, (int, np.integer)):
        channels = (int(channels),)
    if len(channels) == 0:
        raise Error("channels: none is named; give None for all of them")
    return [as_count(channel, "channels", 0, _freepath.max_channels - 1) for channel in channels]
