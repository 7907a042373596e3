"""Rendering scenes to pictures."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _freepath
from ._arrays import Rays
from ._film import Film
from ._freepath import Error
from ._picture_options import Facts, common_options, facts_of, picture_options
from ._sampling import Estimate
from ._scene import Scene


@dataclass(frozen=True)
class Progress:
    """How far a rendering is.

    Attributes:
        samples: of each pixel that are done, on average.
        total: samples that there will be; None: as many as the time allows.
        seconds: since it began.
        image: float32 of shape (height, width, 3): linear R, G, B of the last pass over all pixels,
            if one was completed since it was asked for last; else None.
    """

    samples: float
    total: float | None
    seconds: float
    image: NDArray[np.float32] | None


class Picture:
    """A picture with its layers, and how it came about. Row 0 is the top.

    It keeps its film, some 250 bytes a pixel, more with path layers. In Jupyter it shows itself.
    Arrays are views of the picture's own memory, and read-only.
    """

    __slots__ = ("_core", "_facts", "_pixels", "_indices")

    def __init__(self, core: _freepath.Picture, facts: Callable[[], Facts] | None = None) -> None:
        self._core = core
        self._facts = facts
        pixels: Any = core.pixels
        self._pixels: NDArray[np.float32] = pixels
        self._indices = {name: i for i, name in enumerate(core.channels)}

    @property
    def image(self) -> NDArray[np.float32]:
        """Linear R, G, B: float32 of shape (height, width, 3)."""
        return self._named("R", "G", "B")

    @property
    def alpha(self) -> NDArray[np.float32]:
        """1 - transmittance along the camera rays: float32 of shape (height, width)."""
        return self._named("A")

    @property
    def variance(self) -> NDArray[np.float32]:
        """Variance of the means of R, G, B, of shape (height, width, 3): its root is their error.

        Raises:
            KeyError: if the layer was not recorded.
        """
        return self.layers["variance"]

    @property
    def layers(self) -> Mapping[str, NDArray[np.float32]]:
        """Layers by name, each of shape (height, width) or (height, width, 3): docs/pictures.md."""
        groups: dict[str, list[str]] = {}
        for name in self._indices:
            if name not in "RGBA":
                groups.setdefault(name.rpartition(".")[0] or name, []).append(name)
        return {group: self._named(*names) for group, names in groups.items()}

    @property
    def stats(self) -> dict[str, Any]:
        """Samples, paths, seconds, methods, and counts of free paths and shadow rays."""
        return self._core.statistics

    @property
    def film(self) -> Film:
        """What the samples of each pixel have added up to: to be merged with other parts.

        Raises:
            Error: where a file that the scene was read from has changed since.
        """
        return Film._of(self._core.film.with_facts(self._facts() if self._facts else []))

    def save(
        self, path: str | os.PathLike[str], *, exposure: float = 0.0, view: str = "standard"
    ) -> None:
        """Write the picture: all layers to .exr, the colour to .png, .pfm or .qoi.

        The file is written aside and then renamed.

        Args:
            path: of the file.
            exposure: of .png and .qoi [stops].
            view: "standard", which clips, or "neutral", which rolls bright light off to white.

        Raises:
            Error: if the file cannot be written.
        """
        self._core.save(os.fspath(path), exposure, view)

    def png(self, *, exposure: float = 0.0, view: str = "standard") -> bytes:
        """Return the bytes of a PNG file of the colour, with 8 bits a channel."""
        return self._core.png(exposure, view)

    def _repr_png_(self) -> bytes:
        return self.png(view="neutral")

    def _named(self, *names: str) -> NDArray[np.float32]:
        """Channels of consecutive indices, as a view."""
        indices = [self._indices[name] for name in names]
        if len(indices) == 1:
            return self._pixels[..., indices[0]]
        if indices == list(range(indices[0], indices[-1] + 1)):
            return self._pixels[..., indices[0] : indices[-1] + 1]
        return self._pixels[..., indices]

    def __repr__(self) -> str:
        height, width = self._pixels.shape[:2]
        return f"<freepath.Picture of {width} x {height} pixels, {self.stats['samples']} samples>"


def render(
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
    progress: Callable[[Progress], Any] | bool | None = None,
    threads: int = 0,
    simd: str = "best",
) -> Picture:
    """Render a scene without bias.

    The picture depends on scene, methods, seed and number of samples alone, and has the same bits
    as that of `freepath render` with the same options. What is not said is what the scene's file
    says, and else the program's standard. Python's lock is free meanwhile.

    Args:
        scene: what to render.
        spp: samples of each pixel [64].
        time: seconds to render; with spp, whichever ends first.
        noise: to render as many samples as it takes for the standard error of a pixel, root mean
            square, to be this part of the picture's mean, by a pilot of another seed; spp is the most.
        samples: in place of the three above, a part: the samples from the first to before the end,
            counted from 0; a pair, or a range. Films of parts are merged by `freepath.merge`.
        seed: of the random numbers, 0 to 2^64 - 1.
        color: "rgb", or "spectral": with `wavelengths` of each sample [volumes: rgb, scenes:
            spectral].
        layers: names of layers to record, separated by commas; "all", "none" or "default".
        crop: x0, y0, x1, y1 [pixels]: a part of the picture, from (x0, y0) to before (x1, y1).
        tile: number, counted from 1, and count: one of so many bands of rows of it.
        tracker: free-path sampling, by name; "auto" chooses.
        estimator: transmittance of shadow rays, by name.
        interpolation: "nearest", "trilinear" or "stochastic".
        absorption: "weighted" or "analog".
        emission: "collision" or "analog".
        max_scatterings: ends paths, whose light is missing then; by default no limit, or that of
            the scene's file.
        wavelengths: of a path, where color is "spectral".
        shadow_roulette: whether shadow rays that bring little are cast by Russian roulette.
        near_light_lines: whether light of lights in or near media is found along lines that pass
            them, so that the variance has an end; else at scatterings alone.
        lobe_splitting: whether paths split towards a light that outshines others, like the sun,
            where phase functions have lobes.
        light_through_glass: whether lamps are drawn for scatterings within spheres of smooth glass,
            where their light is refracted; else it is found there by chance.
        adaptive: whether pixels that are noisier take more samples, by a pilot: spp is their mean
            then. Not with a time below 20 s.
        progress: called some times a second with a `Progress`, by the thread that called `render`;
            False ends the rendering soon, and what there is is returned. True: shows it on standard
            error, in Jupyter with a picture that grows.
        threads: to work on; 0: as many as the machine has.
        simd: "best", or one of `freepath.simd()`; all give the same bits.

    Returns:
        The picture; what makes it less than it should be comes as Python warnings.

    Raises:
        Error: for methods, words and numbers that do not exist or fit, methods whose weights would
            grow without bound in this scene, a picture larger than memory, and where no pixel has a
            sample.
        KeyboardInterrupt: at Ctrl-C; nothing is returned then.
        Exception: whatever `progress` raises, once the rendering has ended.
    """
    options = picture_options(
        scene, spp=spp, time=time, noise=noise, samples=samples, seed=seed, color=color,
        layers=layers, crop=crop, tile=tile, tracker=tracker, estimator=estimator,
        interpolation=interpolation, absorption=absorption, emission=emission,
        max_scatterings=max_scatterings, wavelengths=wavelengths, shadow_roulette=shadow_roulette,
        near_light_lines=near_light_lines, lobe_splitting=lobe_splitting,
        light_through_glass=light_through_glass, adaptive=adaptive, threads=threads, simd=simd,
    )  # fmt: skip
    shown: Any = None
    if progress is True:
        from ._display import show_progress

        progress = shown = show_progress()
    callback, wants_pictures = _callback(progress)
    try:
        core = _freepath.render(scene._core, options, callback, wants_pictures)
    finally:
        if shown is not None:
            shown.close()
    picture = Picture(core, lambda: facts_of(scene, options))
    return checked(picture, is_part=samples is not None)


def film_of_part(scene: Scene, **how: Any) -> Film:
    """Render as `render` does, and return the film without a word about what may be amiss."""
    options = picture_options(scene, **how)
    core = _freepath.render(scene._core, options, None, False)
    return Picture(core, lambda: facts_of(scene, options)).film


def radiance(
    scene: Scene,
    origins: ArrayLike,
    directions: ArrayLike,
    *,
    spp: int | None = None,
    seed: int | None = None,
    color: str | None = None,
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
    threads: int = 0,
    simd: str = "best",
) -> Estimate:
    """Estimate the radiance that comes in along rays: a sensor of your own.

    The rays take the place of the scene's camera, and begin in the media that it is in. What ray
    number i gets depends on the scene, the ray, i, `spp` and `seed` alone.

    Args:
        scene: what is seen; while it is, others who render it wait.
        origins: float32 or float64 of shape (..., 3) [m, world].
        directions: of shape (..., 3), away from the sensor; scaled to unit vectors.
        spp: samples of each ray [64]; two at least, if the error is to mean something.
        seed, color, tracker, estimator, interpolation, absorption, emission, max_scatterings,
        wavelengths, shadow_roulette, near_light_lines, lobe_splitting, light_through_glass, threads,
        simd: as `render` has them.

    Returns:
        Mean and standard error of R, G and B (linear), float64 of shape (..., 3).

    Raises:
        Error: as `render`, and for rays that are none, naming the first.
        KeyboardInterrupt: at Ctrl-C; nothing is returned then.
    """
    options = common_options(
        scene, spp, seed, color, tracker, estimator, interpolation, absorption, emission,
        max_scatterings, wavelengths, shadow_roulette, near_light_lines, lobe_splitting,
        light_through_glass, threads, simd,
    )  # fmt: skip
    options.layers = "variance"
    rays = Rays(origins, directions, np.inf)
    count = len(rays.origins)
    if count == 0:
        return Estimate(np.empty((*rays.shape, 3)), np.empty((*rays.shape, 3)))
    width = min(count, _ROW)
    core = _freepath.radiance(
        scene._core, options, rays.origins, rays.directions, rays.t_max, width
    )
    picture = checked(Picture(core))
    mean, variance = (
        pixels.reshape(-1, 3)[:count].astype(np.float64)
        for pixels in (picture.image, picture.variance)
    )
    return Estimate(mean.reshape((*rays.shape, 3)), np.sqrt(variance).reshape((*rays.shape, 3)))


_ROW = 1024
"""Rays in a row of the picture that they are rendered as."""


def _callback(progress: Any) -> tuple[Callable[..., Any] | None, bool]:
    """Return a callback for the extension, and whether it looks at pictures."""
    if progress is None or progress is False:
        return None, False
    if not callable(progress):
        raise TypeError(f"progress: {progress!r} is no function")

    def tell(samples: float, total: float, seconds: float, pixels: Any) -> Any:
        image = None if pixels is None else pixels[..., :3]
        return progress(Progress(samples, total or None, seconds, image))

    return tell, getattr(progress, "wants_pictures", True)


def checked(picture: Picture, *, is_part: bool = False) -> Picture:
    """Return a picture after saying what makes it less than it should be.

    Raises:
        Error: where no pixel has a sample.
    """
    stats = picture.stats
    if stats["most_samples"] == 0:
        cause = "ended" if stats["interrupted"] else "the time was up"
        raise Error(
            f"{cause} after {stats['seconds']:.1f} s, before any pixel had a sample: "
            "give more time, or choose a smaller size or a thinner volume"
        )
    # Of a part it goes without saying: other parts have the samples of these pixels.
    if stats["pixels_without_samples"] and not is_part:
        warnings.warn(
            f"{stats['pixels_without_samples']} pixels have no sample, for want of time or "
            "of rounds: black with alpha 0",
            stacklevel=3,
        )
    if stats["cut_share"] >= 0.005:
        warnings.warn(
            f"paths that ended at the limit of {stats['max_scatterings']} scatterings still had "
            f"{100 * stats['cut_share']:.2g} % of all weight: about as much light may be missing. "
            "Give a higher max_scatterings",
            stacklevel=3,
        )
    if stats["overflows"]:
        warnings.warn(
            f"the weights of {stats['overflows']} of {stats['paths']} paths left the range of "
            "float, so that the picture is not known: the variance of their pixels is infinite; "
            "media or surfaces that give back more light than they get do that, and trackers whose "
            "weights grow",
            stacklevel=3,
        )
    return picture
