"""Scenes: of pbrt files, and around a medium."""

from __future__ import annotations

import hashlib
import os
import warnings
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from numpy.typing import ArrayLike

from . import _freepath
from ._arrays import as_count, as_triple
from ._field import Field
from ._freepath import Error
from ._medium import Component, Medium, as_medium

_UNSET: Any = object()
"""What is said of a sun where nothing is said."""


@dataclass(frozen=True)
class _PbrtSource:
    """What a pbrt scene is read from.

    Attributes:
        source: name of a file, or a text.
        is_text: whether it is a text.
        name: of the text.
    """

    source: str
    is_text: bool
    name: str

    def __reduce__(self) -> Any:
        # Whoever reads it may be in another folder.
        if self.is_text:
            return _PbrtSource, (self.source, True, os.path.abspath(self.name))
        return _PbrtSource, (os.path.abspath(self.source), False, self.name)


@dataclass(frozen=True)
class _Recipe:
    """What a scene is made of.

    Attributes:
        of: a medium, or what a pbrt scene is read from.
        options: attributes of SceneOptions by name.
    """

    of: Medium | _PbrtSource
    options: dict[str, Any]

    def build(self) -> tuple[_freepath.Scene, list[str]]:
        """Return the scene, and what there is to say about it."""
        options = _freepath.SceneOptions()
        for name, value in self.options.items():
            setattr(options, name, value)
        if isinstance(self.of, Medium):
            return _freepath.scene_around(self.of._core, options)
        return _freepath.scene_of_pbrt(self.of.source, self.of.is_text, self.of.name, options)

    def environment_file(self) -> str | None:
        """Return the name of the image that lights the scene, if there is one."""
        environment = self.options["environment"]
        return environment if isinstance(environment, str) and environment != "sky" else None

    def text(self) -> str:
        """Return what tells it from others; files count by their content, which is told apart."""
        options = dict(self.options)
        if self.environment_file():
            options["environment"] = "a file"
        if isinstance(self.of, Medium):
            of = self.of._digest()
        else:
            of = self.of.source if self.of.is_text else "a file"
        return repr((of, sorted(options.items())))

    def __reduce__(self) -> Any:
        options = dict(self.options)
        file = self.environment_file()
        if file:
            options["environment"] = os.path.abspath(file)
        return _Recipe, (self.of, options)


class Scene:
    """A scene as paths see it, with a camera: built once, rendered as often as you like.

    Made by `Scene.around` or `Scene.from_pbrt`. Pickled, it is what it was made of, and is built
    again elsewhere: of a file its name, of a medium its voxels.
    """

    __slots__ = ("_core", "_recipe", "_stamps", "_known_facts")
    _core: _freepath.Scene
    _recipe: _Recipe
    _stamps: dict[str, tuple[int, int]]
    _known_facts: list[tuple[str, str]]

    def __init__(self) -> None:
        raise TypeError("scenes are made by Scene.around or Scene.from_pbrt")

    @classmethod
    def _of(cls, recipe: _Recipe) -> Scene:
        core, notes = recipe.build()
        for note in notes:
            warnings.warn(note, stacklevel=3)
        scene = cls.__new__(cls)
        scene._core = core
        scene._recipe = recipe
        files = {*core.files}
        if environment := recipe.environment_file():
            files.add(environment)
        if isinstance(recipe.of, _PbrtSource) and not recipe.of.is_text:
            files.add(recipe.of.source)
        scene._stamps = {file: _stamp(file) for file in sorted({*map(os.path.abspath, files)})}
        return scene

    def _facts(self) -> list[tuple[str, str]]:
        """What pictures of it depend on, as films tell: names and values.

        Raises:
            Error: where a file has changed since the scene was built.
        """
        if not hasattr(self, "_known_facts"):
            facts = _freepath.file_facts(list(self._stamps))
            for file, stamp in self._stamps.items():
                if _stamp(file) != stamp:
                    raise Error(
                        f"{file}: has changed since the scene was built, whose film is asked for: "
                        "build the scene again"
                    )
            digest = hashlib.sha1(self._recipe.text().encode()).hexdigest()
            self._known_facts = [("the scene", digest), *facts]
        return self._known_facts

    def __reduce__(self) -> Any:
        return Scene._of, (self._recipe,)

    @classmethod
    def around(
        cls,
        medium: Medium | Component | Field | Iterable[Component],
        *,
        size: tuple[int, int] = (640, 360),
        camera: str = "perspective",
        look_from: ArrayLike | None = None,
        look_at: ArrayLike | None = None,
        fov: float = 40.0,
        up: str = "y",
        environment: str | os.PathLike[str] | ArrayLike = "sky",
        sun: Sequence[Any] | None = _UNSET,
        turbidity: float = 2.0,
        ground: ArrayLike | None = None,
        ground_height: float | None = None,
        periodic: str = "",
        domain: tuple[ArrayLike, ArrayLike] | None = None,
    ) -> Scene:
        """Put a medium under a sky, before a camera that sees all of it.

        The same options of `freepath render` give the same picture, to the bit. A bare field
        scatters all that it takes out of a ray, 1/m per unit of density.

        Args:
            medium: a `Medium` of one or three channels (R, G, B), or a component or field of one.
            size: width and height of the picture [pixels].
            camera: "perspective", "orthographic" or "spherical".
            look_from: place of the camera [m, world]; none: where it sees the whole volume.
            look_at: what is in the middle of the picture [m, world].
            fov: vertical angle of view [degrees].
            up: axis that points up, "y" or "z".
            environment: "sky", a radiance (one number, or R, G, B), or the name of a
                latitude-longitude image.
            sun: elevation and azimuth (clockwise from north) [degrees], perhaps with an irradiance on
                what faces it, one number or R, G, B; None: none. By default (38, 255) under a sky,
                else none.
            turbidity: haze of sky and sun, 2 to 10.
            ground: albedo of a level plane, one number or R, G, B; none: no ground.
            ground_height: along the axis that points up [m]; none: the bottom of the volume.
            periodic: axes along which the volume repeats without end, "xy" for example.
            domain: least and largest corner of a period [m, world], along those axes.

        Raises:
            Error: for values out of range, an image that cannot be read, a medium with another
                number of channels, and one that is too dense for single precision.
        """
        options = _options(
            size, camera, look_from, look_at, fov, up, environment, sun, turbidity, ground,
            ground_height, periodic, domain,
        )  # fmt: skip
        if sun is _UNSET:
            options.has_sun = isinstance(environment, str) and environment == "sky"
        return cls._of(_Recipe(as_medium(medium), _state_of(options)))

    @classmethod
    def from_pbrt(
        cls,
        source: str | os.PathLike[str],
        *,
        name: str = "scene",
        size: tuple[int, int] | None = None,
        camera: str | None = None,
        look_from: ArrayLike | None = None,
        look_at: ArrayLike | None = None,
        fov: float | None = None,
        up: str = "y",
        environment: str | os.PathLike[str] | ArrayLike | None = None,
        sun: Sequence[Any] | None = None,
        turbidity: float = 2.0,
        ground: ArrayLike | None = None,
        ground_height: float | None = None,
        periodic: str = "",
        domain: tuple[ArrayLike, ArrayLike] | None = None,
    ) -> Scene:
        """Build a scene of pbrt-v4's language (docs/scenes.md says what of it there is).

        Args:
            source: name of a file, .pbrt or .pbrt.gz; or the text of a scene, which has more than one
                line.
            name: what to call the text in messages; files are found beside it.
            size, camera, look_from, look_at, fov, up, environment, sun, turbidity, ground,
            ground_height, periodic, domain: take the place of what the file says, and are as
                `around` has them. An environment replaces the lights from all around; a sun and a
                ground are added.

        Raises:
            Error: beginning with file:line:column, for what cannot be read or rendered. What there
                is to say about the rest comes as Python warnings.
        """
        options = _options(
            size, camera, look_from, look_at, fov, up, environment, sun, turbidity, ground,
            ground_height, periodic, domain,
        )  # fmt: skip
        text = os.fspath(source)
        is_text = isinstance(source, str) and "\n" in text
        return cls._of(_Recipe(_PbrtSource(text, is_text, name), _state_of(options)))

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture [pixels]."""
        return self._core.size

    @property
    def files(self) -> list[str]:
        """Names of all files that were read for it."""
        return list(self._core.files)

    def __repr__(self) -> str:
        return f"<freepath.Scene of {self.size[0]} x {self.size[1]} pixels>"


def _options(
    size: Any, camera: Any, look_from: Any, look_at: Any, fov: Any, up: Any, environment: Any,
    sun: Any, turbidity: Any, ground: Any, ground_height: Any, periodic: Any, domain: Any,
) -> _freepath.SceneOptions:  # fmt: skip
    options = _freepath.SceneOptions()
    options.up = up
    if size is not None:
        options.size = picture_size(size)
    options.camera = camera
    options.fov = None if fov is None else float(fov)
    options.look_from = None if look_from is None else as_triple(look_from, "look_from")
    options.look_at = None if look_at is None else as_triple(look_at, "look_at")
    if environment is not None:
        options.environment = _environment(environment)
    options.turbidity = float(turbidity)
    if sun is not None and sun is not _UNSET:
        _set_sun(options, sun)
    if ground is not None:
        options.ground_albedo = as_triple(ground, "ground")
    elif ground_height is not None:
        raise Error("ground_height is that of a ground: give its albedo too")
    options.ground_height = None if ground_height is None else float(ground_height)
    options.periodic = periodic
    options.domain = corners(domain)
    return options


def _state_of(options: _freepath.SceneOptions) -> dict[str, Any]:
    """Return all attributes by name."""
    names = [name for name in dir(options) if not name.startswith("_")]
    return {name: getattr(options, name) for name in names}


def _stamp(file: str) -> tuple[int, int]:
    """Size and time of a file, which tell whether it has been written to."""
    status = os.stat(file)
    return status.st_size, status.st_mtime_ns


def picture_size(size: Any) -> tuple[int, int]:
    """Return width and height, each from 1 to 32768.

    Raises:
        Error: for anything else.
    """
    try:
        width, height = size
    except (TypeError, ValueError):
        raise Error(f"size: {size!r} is not a width and a height") from None
    return as_count(width, "width", 1, 32768), as_count(height, "height", 1, 32768)


def corners(domain: Any) -> tuple[tuple[float, ...], tuple[float, ...]] | None:
    """Return the corners of a domain, None where there is none.

    Raises:
        Error: for anything else than two points.
    """
    if domain is None:
        return None
    try:
        lower, upper = domain
    except (TypeError, ValueError):
        raise Error(f"domain: {domain!r} are not two corners") from None
    return as_triple(lower, "domain"), as_triple(upper, "domain")


def _environment(environment: Any) -> str | tuple[float, float, float]:
    if isinstance(environment, (str, os.PathLike)):
        return os.fspath(environment)
    return as_triple(environment, "environment")


def _set_sun(options: _freepath.SceneOptions, sun: Any) -> None:
    try:
        elevation, azimuth, *irradiance = sun
        options.sun_elevation, options.sun_azimuth = float(elevation), float(azimuth)
        if len(irradiance) > 1:
            raise ValueError
    except (TypeError, ValueError):
        raise Error(
            f"sun: {sun!r} is not elevation and azimuth in degrees, perhaps with an irradiance"
        ) from None
    options.has_sun = True
    if irradiance:
        options.sun_irradiance = as_triple(irradiance[0], "sun: irradiance")
