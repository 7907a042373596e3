"""Films: what the samples of pictures add up to, and how parts of a picture become one."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from . import _freepath

if TYPE_CHECKING:
    from ._render import Picture


class Film:
    """What the samples of each pixel have added up to, and what they are samples of.

    Made by rendering (`Picture.film`), `Film.open`, `Film.from_bytes` or `merge`, and never changed.
    Files are those of `freepath render -o FILE.film` and `freepath merge`.
    """

    __slots__ = ("_core",)
    _core: _freepath.Film

    def __init__(self) -> None:
        raise TypeError("films are made by rendering, Film.open, Film.from_bytes or merge")

    @classmethod
    def _of(cls, core: _freepath.Film) -> Film:
        film = cls.__new__(cls)
        film._core = core
        return film

    @classmethod
    def open(cls, path: str | os.PathLike[str]) -> Film:
        """Read a film from its file.

        Raises:
            Error: naming the file, if it is no film, cut off, damaged or of another version.
        """
        return cls._of(_freepath.open_film(os.fspath(path)))

    @classmethod
    def from_bytes(cls, data: bytes) -> Film:
        """Make a film of what `to_bytes` returned.

        Raises:
            Error: if they are no film, cut off, damaged or of another version.
        """
        return cls._of(_freepath.film_from_bytes(bytes(data)))

    def to_bytes(self) -> bytes:
        """Return the bytes of the film's file: packed, with a checksum."""
        return self._core.to_bytes()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the film to a file, aside and then renamed.

        Args:
            path: of the .film file.

        Raises:
            Error: if it has another extension or cannot be written.
        """
        self._core.save(os.fspath(path))

    def picture(self) -> Picture:
        """Return the picture of the samples, with every layer that the film has."""
        from ._render import Picture

        return Picture(self._core.picture())

    @property
    def samples(self) -> range:
        """Numbers of the samples of each pixel; of the pixel with the most, if some have fewer."""
        first = self._core.first_sample
        return range(first, first + self._core.most_samples)

    @property
    def window(self) -> tuple[int, int, int, int]:
        """Pixels that it has: x0, y0, x1, y1 as of a crop, from (x0, y0) to before (x1, y1)."""
        x0, y0, x1, y1 = self._core.window
        return x0, y0, x1, y1

    @property
    def seed(self) -> int:
        """Seed of the random numbers."""
        return self._core.seed

    @property
    def facts(self) -> dict[str, str]:
        """What the samples depend on besides: films are parts of one picture where it is equal."""
        return dict(self._core.facts)

    def __reduce__(self) -> Any:
        return Film.from_bytes, (self.to_bytes(),)

    def __repr__(self) -> str:
        samples, (x0, y0, x1, y1) = self.samples, self.window
        return (
            f"<freepath.Film of {x1 - x0} x {y1 - y0} pixels, samples {samples.start} to "
            f"{samples.stop - 1}>"
        )


def merge(films: Iterable[Film], *, average: bool = False, partial: bool = False) -> Film:
    """Merge films of parts of a picture: of ranges of samples, of tiles or crops, or of both.

    Args:
        films: in any order.
        average: whether to average pictures of different seeds, each pixel weighted by its samples;
            else all are of one seed.
        partial: whether to take what there is where parts are missing: pixels without samples are 0.

    Returns:
        A film with the bits of that of one `render` of all of it.

    Raises:
        Error: naming the films, for parts of different pictures and such as overlap; where samples
            are missing.
    """
    listed = list(films)
    for film in listed:
        if not isinstance(film, Film):
            raise TypeError(f"films: {type(film).__name__} is no Film; see Picture.film")
    return Film._of(_freepath.merge([film._core for film in listed], average, partial))
