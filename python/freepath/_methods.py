"""The methods there are: trackers, transmittance estimators, phase functions."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _freepath
from ._arrays import as_array
from ._freepath import Error


@dataclass(frozen=True)
class Option:
    """An option of a method, a number or one of some words.

    It follows the method's name, "weighted-decomposition:control=0.5".

    Attributes:
        name: of the option.
        meaning: what it does.
        default: its value where nothing is said.
        minimum, maximum: range of a number.
        choices: the words, if it takes words.
    """

    name: str
    meaning: str
    default: float | str
    minimum: float | None = None
    maximum: float | None = None
    choices: tuple[str, ...] = ()


@dataclass(frozen=True)
class Method:
    """A tracker or a transmittance estimator, as it says of itself.

    Attributes:
        name: the same in Python, C++, scenes and on the command line.
        summary: what it does.
        needs: what the medium must be like; empty: anything.
        unbiased: when it is unbiased.
        biased: whether it is biased.
        chromatic: whether one path carries channels whose extinctions differ.
        paths: what is to be known of its weights in paths of many scatterings; empty where they
            are bounded.
        source: citation key and equation (docs/references.bib).
        options: that may follow its name.
    """

    name: str
    summary: str
    needs: str
    unbiased: str
    biased: bool
    chromatic: bool
    paths: str
    source: str
    options: tuple[Option, ...]


def trackers() -> list[Method]:
    """Return the rules of free-path sampling that `tracker=` names, `auto` among them."""
    return [_method(entry) for entry in _freepath.trackers()]


def estimators() -> list[Method]:
    """Return the transmittance estimators that `estimator=` names."""
    return [_method(entry) for entry in _freepath.estimators()]


def phase_functions() -> list[str]:
    """Return the names of the phase functions that `phase=` and `PhaseFunction` take."""
    return list(_freepath.phase_functions())


def _method(entry: dict[str, Any]) -> Method:
    options = tuple(
        Option(**{**option, "choices": tuple(option.get("choices", ()))})
        for option in entry["options"]
    )
    return Method(**{**entry, "options": options})


class PhaseFunction:
    """How light that scatters spreads over directions; it integrates to 1 over the sphere.

    Args:
        text: "isotropic", "henyey-greenstein:g=0.8", "rayleigh", "draine:g=0.5,alpha=1",
            "droplets:diameter=20" (micrometres), "tabulated:FILE" (lines of an angle in degrees and
            a value), or a mixture whose weights sum to 1, "0.7*henyey-greenstein:g=0.8+0.3*rayleigh".

    Raises:
        Error: that says what is wrong with the text, and what would be right.
    """

    __slots__ = ("_core", "text")

    def __init__(self, text: str = "isotropic") -> None:
        self.text = text
        self._core = _freepath.PhaseFunction(text)

    @property
    def mean_cosine(self) -> float:
        """Mean of the cosine between the directions of travel before and after."""
        return self._core.mean_cosine()

    def evaluate(self, cosines: ArrayLike) -> NDArray[np.float64]:
        """Return values of the phase function.

        Args:
            cosines: between the directions of travel before and after, in [-1, 1], of any shape.

        Returns:
            float64 of that shape [1/sr].

        Raises:
            Error: for a cosine out of range.
        """
        array = np.asarray(as_array(cosines, "cosines"), np.float64)
        if not (np.abs(array) <= 1).all():
            raise Error("cosines: they lie in [-1, 1]")
        flat = np.ascontiguousarray(array.reshape(-1))
        values: Any = self._core.evaluate(flat)
        return values.reshape(array.shape)  # type: ignore[no-any-return]

    def _digest(self) -> str:
        """Text that tells it from others, which of a table is that of its values."""
        if "tabulated" not in self.text:
            return self.text
        return hashlib.sha1(self.evaluate(np.linspace(-1, 1, 4097)).tobytes()).hexdigest()

    def __reduce__(self) -> Any:
        return PhaseFunction, (self.text,)

    def __repr__(self) -> str:
        return f"freepath.PhaseFunction({self.text!r})"


def as_phase_function(phase: PhaseFunction | str | float) -> PhaseFunction:
    """Return a phase function of what users give: itself, its text, or g of Henyey-Greenstein's."""
    if isinstance(phase, PhaseFunction):
        return phase
    if isinstance(phase, str):
        return PhaseFunction(phase)
    if isinstance(phase, (int, float)):
        return PhaseFunction(f"henyey-greenstein:g={float(phase)!r}")
    raise TypeError(f"phase {phase!r} is no phase function, text or mean cosine")
