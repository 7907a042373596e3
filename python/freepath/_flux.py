"""Reflectance and transmittance: of plane-parallel layers, and of media that repeat sideways."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _freepath
from ._arrays import as_array, as_count
from ._field import Field
from ._freepath import Error
from ._medium import Component, Medium, as_medium
from ._methods import PhaseFunction, as_phase_function
from ._sampling import Estimate, threads_of, walk_options
from ._scene import corners


@dataclass(frozen=True)
class SlabFluxes:
    """Fluxes of layers, as fractions of what falls on the top.

    Attributes:
        reflectance: what leaves through the top.
        transmittance: what leaves through the bottom, scattered or not.
        unscattered: the part of it that never scattered.
        absorptance: what is neither reflected nor transmitted.
        largest_weight: largest magnitude of a weight that left; far above 1, the errors say little.
        paths: that were traced.
        tracker: as it was understood, where `auto` chose it.
    """

    reflectance: Estimate
    transmittance: Estimate
    unscattered: Estimate
    absorptance: Estimate
    largest_weight: float
    paths: int
    tracker: str


def slab(
    tau: ArrayLike,
    albedo: ArrayLike = 1.0,
    g: ArrayLike = 0.0,
    *,
    phase: PhaseFunction | str | Sequence[PhaseFunction | str] | None = None,
    mu0: float = 1.0,
    diffuse: bool = False,
    paths: float = 1e6,
    tracker: str = "delta",
    absorption: str = "weighted",
    seed: int = 0,
    threads: int = 0,
    simd: str = "best",
) -> SlabFluxes:
    """Trace light through plane-parallel layers without surfaces [vandeHulst80].

    Args:
        tau: optical thickness of each layer, from the top down; the last may be infinite.
        albedo: of single scattering, one for each layer or one for all, in [0, 1].
        g: mean cosine of Henyey-Greenstein's phase function, likewise.
        phase: a phase function in place of it, one for all or one for each layer.
        mu0: cosine of incidence, in (0, 1]; 1 is along the normal.
        diffuse: the same radiance from all directions above instead.
        paths: number of paths; the result depends on it, the layers, methods and seed alone.
        tracker: free-path sampling, by name.
        absorption: "weighted" or "analog".
        seed: of the random numbers.
        threads: to work on; 0: as many as the machine has.
        simd: "best", or one of `freepath.simd()`.

    Returns:
        Fluxes, each with its standard error.

    Raises:
        Error: for values out of range, and trackers whose weights would have an infinite variance.
    """
    taus = np.atleast_1d(as_array(tau, "tau"))
    if taus.ndim != 1:
        raise Error(f"tau: its shape is {taus.shape}; give one number for each layer")
    count = len(taus)
    functions: list[PhaseFunction]
    if phase is None:
        functions = [as_phase_function(float(v)) for v in _for_layers(g, "g", count)]
    else:
        given = [phase] if isinstance(phase, (str, PhaseFunction)) else list(phase)
        if len(given) not in (1, count):
            raise Error(f"phase: there are {len(given)} for {count} layers; give one, or as many")
        functions = [as_phase_function(one) for one in given]
        functions = functions * (count // len(functions))
    layers = [
        (float(t), float(a), function._core)
        for t, a, function in zip(taus, _for_layers(albedo, "albedo", count), functions)
    ]
    result = _freepath.slab(
        layers,
        float(mu0),
        bool(diffuse),
        as_count(paths, "paths", 1, 10**15),
        walk_options(tracker=tracker, absorption=absorption, seed=seed, simd=simd),
        threads_of(threads),
    )
    parts: dict[str, Any] = {
        k: Estimate(*v) if isinstance(v, tuple) else v for k, v in result.items()
    }
    return SlabFluxes(**parts)


@dataclass(frozen=True)
class FluxMap:
    """One quantity, of the whole domain and column by column.

    Where the medium has several channels, arrays have an axis of channels, the last.

    Attributes:
        all: as a fraction of what falls on the domain: mean and error, numbers or of shape
            (channels,).
        columns: as fractions of what falls on each column: mean and error, float64 of shape
            (n, m) or (n, m, channels) along the two level axes, x and y where z is up, x and z
            where y is.
    """

    all: Estimate
    columns: Estimate


@dataclass(frozen=True)
class Fluxes:
    """What a medium that repeats sideways does to light from above.

    Each channel is a grey medium with paths of its own. Channels share their random numbers, so
    that noise hardly tells them apart.

    Attributes:
        reflectance: what leaves by the top.
        transmittance: what arrives at the bottom, scattered or not, over a ground however often.
        unscattered: the part of it that never scattered.
        absorptance: what stays in the medium.
        radiances: of each view π I / F, where I is the radiance that leaves towards it and F the flux
            that falls in; light that never scattered is in no view.
        largest_weight: largest magnitude of a weight that left, of all channels; far above 1, the
            errors say little.
        paths: that were traced, in each channel.
        tracker: the method that was taken.
    """

    reflectance: FluxMap
    transmittance: FluxMap
    unscattered: FluxMap
    absorptance: FluxMap
    radiances: tuple[FluxMap, ...]
    largest_weight: float
    paths: int
    tracker: str


def flux(
    medium: Medium | Component | Field | Iterable[Component],
    *,
    sun: tuple[float, float] | None = (0.0, 270.0),
    up: str = "z",
    domain: tuple[ArrayLike, ArrayLike] | None = None,
    columns: tuple[int, int] | None = None,
    ground: float | None = None,
    ground_height: float | None = None,
    views: Sequence[tuple[float, float]] = (),
    paths: float = 1e6,
    tracker: str = "delta",
    estimator: str = "ratio",
    interpolation: str = "nearest",
    absorption: str = "weighted",
    seed: int = 0,
    threads: int = 0,
    simd: str = "best",
) -> Fluxes:
    """Trace light from above through a medium that repeats sideways (docs/flux.md).

    Args:
        medium: a `Medium` of any number of channels, or a component or field of one.
        sun: zenith angle and azimuth (clockwise from north) [degrees]; None: the same radiance from
            all over the sky.
        up: axis that points up, "z" or "y".
        domain: least and largest corner of a period along the level axes [m, world]; none: that of
            the active voxels.
        columns: numbers of columns along the two level axes; none: one for each voxel.
        ground: albedo of a level plane below that reflects evenly; none: no ground.
        ground_height: along the axis that points up [m]; none: the bottom of the medium.
        views: zenith and azimuth [degrees] of directions towards those who look; a zenith beyond 90
            is seen from below.
        paths: number of paths.
        tracker: free-path sampling, by name.
        estimator: transmittance towards views, by name.
        interpolation: "nearest", "trilinear" or "stochastic".
        absorption: "weighted" or "analog".
        seed: of the random numbers.
        threads: to work on; 0: as many as the machine has.
        simd: "best", or one of `freepath.simd()`.

    Returns:
        Fluxes of the whole domain and of each column, with standard errors.

    Raises:
        Error: for values out of range, voxels that do not fit the period, and a medium that emits.
    """
    options = _freepath.FluxOptions()
    options.walk = walk_options(
        tracker=tracker,
        estimator=estimator,
        interpolation=interpolation,
        absorption=absorption,
        seed=seed,
        simd=simd,
    )
    options.up = up
    options.domain = corners(domain)
    if columns is not None:
        options.columns = [as_count(n, "columns", 1, 32768) for n in columns]
    if ground is not None:
        options.ground_albedo = float(ground)
    elif ground_height is not None:
        raise Error("ground_height is that of a ground: give its albedo too")
    options.ground_height = None if ground_height is None else float(ground_height)
    options.sun = None if sun is None else angles(sun, "sun", 0, 90)
    options.views = [angles(view, "views", 0, 180) for view in views]
    options.paths = as_count(paths, "paths", 1, 10**15)
    options.threads = threads_of(threads)
    core = as_medium(medium)._core
    results, used = _freepath.flux(core, options)
    if len(results) < core.channel_count:  # all are the same
        results = results * core.channel_count
    maps = {
        name: _map([result[name] for result in results])
        for name in ("reflectance", "transmittance", "unscattered", "absorptance")
    }
    return Fluxes(
        **maps,
        radiances=tuple(map(_map, zip(*(result["radiances"] for result in results)))),
        largest_weight=max(result["largest_weight"] for result in results),
        paths=results[0]["paths"],
        tracker=used,
    )


def _for_layers(values: Any, what: str, count: int) -> NDArray[Any]:
    array = as_array(values, what)
    if array.shape not in ((), (1,), (count,)):
        raise Error(f"{what}: its shape is {array.shape} for {count} layers; give one, or as many")
    return np.broadcast_to(array, (count,))


def angles(pair: Any, what: str, least: float, most: float) -> tuple[float, float]:
    """Return zenith angle and azimuth [degrees].

    Raises:
        Error: for anything else, and a zenith angle out of range.
    """
    try:
        zenith, azimuth = (float(angle) for angle in pair)
    except (TypeError, ValueError):
        raise Error(f"{what}: {pair!r} is not a zenith angle and an azimuth") from None
    is_level = abs(zenith - 90) < 1e-3
    if not least <= zenith <= most or is_level or not np.isfinite(azimuth):
        raise Error(
            f"{what}: zenith angle {zenith} and azimuth {azimuth}; zenith angles lie from {least} "
            f"to {most} degrees, and are not 90"
        )
    return zenith, azimuth


def _map(channels: Sequence[tuple[Any, Any, Any]]) -> FluxMap:
    """Return a map of what it is in each channel."""
    wholes, means, errors = zip(*channels)
    if len(channels) == 1:
        return FluxMap(Estimate(*wholes[0]), Estimate(means[0].T, errors[0].T))
    mean, error = (np.array([whole[i] for whole in wholes]) for i in (0, 1))
    # Rows of channels are those of columns turned about.
    return FluxMap(Estimate(mean, error), Estimate(np.array(means).T, np.array(errors).T))
