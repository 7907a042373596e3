"""Options of pictures, as users give them and as the extension takes them."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _freepath
from ._arrays import as_count
from ._freepath import Error
from ._sampling import threads_of, walk_options
from ._scene import Scene

Facts = list[tuple[str, str]]
"""What a picture depends on, names and values."""


def picture_options(
    scene: Scene,
    *,
    spp: int | None = None,
    time: float | None = None,
    noise: float | None = None,
    samples: tuple[int, int] | range | None = None,
    seed: int | None = None,
    color: str | None = None,
    layers: str | None = None,
    crop: tuple[int, int, int, int] | None = None,
    tile: tuple[int, int] | None = None,
    tracker: str | None = None,
    estimator: str | None = None,
    interpolation: str | None = None,
    absorption: str = "weighted",
    emission: str = "collision",
    max_scatterings: int | None = None,
    wavelengths: int = 4,
    shadow_roulette: bool = True,
    near_light_lines: bool = True,
    lobe_splitting: bool = True,
    light_through_glass: bool = True,
    adaptive: bool = True,
    threads: int = 0,
    simd: str = "best",
) -> _freepath.RenderOptions:
    """Return the options of a picture, which `render` documents.

    Raises:
        Error: for what is out of range, and what can't be said together.
    """
    options = common_options(
        scene, spp, seed, color, tracker, estimator, interpolation, absorption, emission,
        max_scatterings, wavelengths, shadow_roulette, near_light_lines, lobe_splitting,
        light_through_glass, threads, simd,
    )  # fmt: skip
    options.time_limit = _seconds(time)
    options.adaptive = bool(adaptive)
    if noise is not None:
        if not 1e-6 <= noise <= 1:
            raise Error(f"noise: {noise!r} is not between 1e-6 and 1")
        options.noise = float(noise)
    options.layers = layers
    if crop is not None:
        if len(crop) != 4:
            raise Error(f"crop: {crop!r} is not x0, y0, x1, y1")
        options.crop = [as_count(edge, "crop", 0, 32768) for edge in crop]
    if samples is not None:
        for name, value in {"spp": spp, "time": time, "noise": noise}.items():
            if value is not None:
                raise Error(f"samples and {name} both say how many samples; give one of them")
        options.range = _sample_range(samples)
    if tile is not None:
        if noise is not None:
            raise Error(
                "noise and tile: each tile would choose a number of samples of its own; choose "
                "one by a noise of the whole, and give it as spp"
            )
        options.tile = _tile(tile)
    return options


def facts_of(scene: Scene, options: _freepath.RenderOptions) -> Facts:
    """Return what a picture depends on and the library doesn't tell of.

    Raises:
        Error: where a file that the scene was read from has changed since.
    """
    return [
        *scene._facts(),
        ("absorption", options.walk.absorption),
        ("emission", options.walk.emission),
        ("wavelengths", str(options.wavelengths)),
        ("shadow_roulette", str(options.shadow_roulette)),
        ("near_light_lines", str(options.near_light_lines)),
        ("lobe_splitting", str(options.lobe_splitting)),
        ("light_through_glass", str(options.light_through_glass)),
        ("adaptive", str(options.adaptive)),
    ]


def common_options(
    scene: Scene, spp: Any, seed: Any, color: Any, tracker: Any, estimator: Any, interpolation: Any,
    absorption: Any, emission: Any, max_scatterings: Any, wavelengths: Any, shadow_roulette: Any,
    near_light_lines: Any, lobe_splitting: Any, light_through_glass: Any, threads: Any, simd: Any,
) -> _freepath.RenderOptions:  # fmt: skip
    """Options that pictures and rays have in common."""
    if not isinstance(scene, Scene):
        raise TypeError(f"scene: {type(scene).__name__} is no Scene; see Scene.around")
    options = _freepath.RenderOptions()
    options.walk = walk_options(absorption=absorption, emission=emission, simd=simd)
    options.samples = None if spp is None else as_count(spp, "spp", 1, 2**30)
    options.seed = None if seed is None else as_count(seed, "seed", 0, 2**64 - 1)
    options.color = color
    options.tracker, options.estimator, options.interpolation = tracker, estimator, interpolation
    if max_scatterings is not None:
        options.max_scatterings = as_count(max_scatterings, "max_scatterings", 1, 2**32 - 1)
    options.wavelengths = as_count(wavelengths, "wavelengths", 1, _freepath.max_channels)
    options.threads = threads_of(threads)
    options.shadow_roulette = bool(shadow_roulette)
    options.near_light_lines = bool(near_light_lines)
    options.lobe_splitting = bool(lobe_splitting)
    options.light_through_glass = bool(light_through_glass)
    return options


def _seconds(time: float | None) -> float:
    if time is None:
        return 0.0
    if not (np.isfinite(time) and time > 0):
        raise Error(f"time: {time!r} is no positive number of seconds")
    return float(time)


def _sample_range(samples: Any) -> tuple[int, int]:
    """Return the first sample, and that after the last.

    Raises:
        Error: for anything that is no range with a sample in it.
    """
    if isinstance(samples, range):
        samples = (samples.start, samples.stop) if samples.step == 1 else (samples,)
    try:
        first, end = samples
    except (TypeError, ValueError):
        raise Error(f"samples: {samples!r} is not a first sample and one after the last") from None
    first = as_count(first, "samples: first", 0, 2**30 - 1)
    return first, as_count(end, "samples: end", first + 1, 2**30)


def _tile(tile: Any) -> tuple[int, int]:
    """Return number and count of a tile.

    Raises:
        Error: for anything else.
    """
    try:
        number, count = tile
    except (TypeError, ValueError):
        raise Error(f"tile: {tile!r} is not a number and a count, as (1, 8) to (8, 8)") from None
    count = as_count(count, "tile: count", 1, 32768)
    return as_count(number, "tile: number", 1, count), count
