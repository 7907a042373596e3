"""Components and media."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _freepath
from ._arrays import as_channels
from ._field import Field
from ._freepath import Error
from ._methods import PhaseFunction, as_phase_function


class Component:
    """A density times cross sections, with a phase function and an emission.

    Coefficients are one number for all channels, or a sequence of one for each channel, of which
    there may be `freepath.max_channels`; media that are rendered have one or three, R, G and B.

    Args:
        field: the density, of voxels (`Field`) or computed (`DensityFunction`).
        sigma_a: absorption per unit of density [1/m].
        sigma_s: scattering per unit of density [1/m].
        phase: a `PhaseFunction`, the text of one, or the mean cosine g of Henyey-Greenstein's.
        emission: L_e, radiance of the medium were it opaque; the source term is
            sigma_a · density · L_e. With temperatures, what multiplies the radiance of their black
            bodies. None: 0, and with temperatures 1.
        temperature: field of temperatures, of which the medium glows as black bodies do, the
            spectrum of each scaled to a maximum of 1 as in pbrt. Such a medium has the channels R,
            G and B.
        temperature_scale: what values of the field are multiplied by to be kelvins [K].
        temperature_offset: value of the field at 0 K, taken off first.

    Raises:
        Error: for coefficients that are negative or not finite, an unknown phase function, and
            temperatures whose scale is none.
    """

    __slots__ = (
        "emission",
        "field",
        "phase",
        "sigma_a",
        "sigma_s",
        "temperature",
        "temperature_offset",
        "temperature_scale",
    )

    def __init__(
        self,
        field: Field,
        *,
        sigma_a: ArrayLike = 0.0,
        sigma_s: ArrayLike = 1.0,
        phase: PhaseFunction | str | float = "isotropic",
        emission: ArrayLike | None = None,
        temperature: Field | None = None,
        temperature_scale: float = 1.0,
        temperature_offset: float = 0.0,
    ) -> None:
        if not isinstance(field, Field):
            raise TypeError(f"field: {type(field).__name__} is no Field; see Field.from_array")
        self.field = field
        self.sigma_a = as_channels(sigma_a, "sigma_a")
        self.sigma_s = as_channels(sigma_s, "sigma_s")
        if temperature is not None and not isinstance(temperature, Field):
            raise TypeError(f"temperature: {type(temperature).__name__} is no Field")
        if not (np.isfinite([temperature_scale, temperature_offset]).all() and temperature_scale > 0):
            raise Error(
                f"temperature_scale {temperature_scale} and temperature_offset {temperature_offset}: "
                "they are finite, and the scale is positive"
            )
        self.temperature = temperature
        self.temperature_scale = float(temperature_scale)
        self.temperature_offset = float(temperature_offset)
        if emission is None:
            emission = 0.0 if temperature is None else 1.0
        self.emission = as_channels(emission, "emission")
        self.phase = as_phase_function(phase)

    def __reduce__(self) -> Any:
        return _component, (
            self.field,
            self.sigma_a,
            self.sigma_s,
            self.phase,
            self.emission,
            self._thermal(),
        )

    def _thermal(self) -> tuple[Field, float, float] | None:
        """Temperatures with their scale and offset."""
        if self.temperature is None:
            return None
        return self.temperature, self.temperature_scale, self.temperature_offset

    def __repr__(self) -> str:
        return (
            f"freepath.Component({self.field!r}, sigma_a={self.sigma_a}, sigma_s={self.sigma_s}, "
            f"phase={self.phase.text!r}, emission={self.emission}"
            + (f", temperature={self.temperature!r})" if self.temperature else ")")
        )


class Medium:
    """A sum of components, cut into super-voxels with bounds of their densities.

    Components may stand anyhow in the world and overlap; those that share transform and bounds
    walk the fastest. A medium is never changed once made, and threads share it.

    Args:
        components: at least one; a single `Component` or `Field` will do.
        super_voxel: edge of a super-voxel [voxels]: 4, 8, 16, 32, 64, or 0 for automatic.

    Raises:
        Error: for no component or too many, numbers of channels that do not go together, an empty
            field, and fields of voxels among computed ones.
    """

    __slots__ = ("_core", "_parts", "_super_voxel", "components")

    def __init__(
        self, components: Component | Field | Iterable[Component], *, super_voxel: int = 0
    ) -> None:
        self.components = _component_list(components)
        count = _channel_count(self.components)
        parts: list[Any] = [
            (
                component.field._core,
                *(_repeated(v, count) for v in _coefficients(component)),
                component.phase._core,
                _thermal_core(component),
            )
            for component in self.components
        ]
        self._core = _freepath.make_medium(parts, super_voxel)
        # As they are now, whatever becomes of the components.
        self._parts = tuple(component.__reduce__()[1] for component in self.components)
        self._super_voxel = super_voxel

    @property
    def bounds(self) -> NDArray[np.float64]:
        """Box of the active voxels: array of shape (2, 3), least and largest corner [m, world]."""
        return np.array(self._core.bounds)

    @property
    def channels(self) -> int:
        """Number of channels: 1 where every coefficient is one number."""
        return self._core.channel_count

    @property
    def super_voxels(self) -> int:
        """Number of super-voxels."""
        return self._core.super_voxel_count

    def _digest(self) -> str:
        """Text that tells it from others."""
        parts = [
            [field._digest(), sigma_a, sigma_s, phase._digest(), emission]
            + ([thermal[0]._digest(), *thermal[1:]] if thermal else [])
            for field, sigma_a, sigma_s, phase, emission, thermal in self._parts
        ]
        return repr([parts, self._super_voxel])

    def __reduce__(self) -> Any:
        return _medium, (self._parts, self._super_voxel)

    def __repr__(self) -> str:
        return f"freepath.Medium({list(self.components)!r})"


def _component(
    field: Field, sigma_a: Any, sigma_s: Any, phase: Any, emission: Any, thermal: Any
) -> Component:
    """Component of what pickling has made of it."""
    temperature, scale, offset = thermal or (None, 1.0, 0.0)
    return Component(
        field,
        sigma_a=sigma_a,
        sigma_s=sigma_s,
        phase=phase,
        emission=emission,
        temperature=temperature,
        temperature_scale=scale,
        temperature_offset=offset,
    )


def _thermal_core(component: Component) -> Any:
    thermal = component._thermal()
    return thermal and (thermal[0]._core, *thermal[1:])


def _medium(parts: tuple[Any, ...], super_voxel: int) -> Medium:
    """Medium of what pickling has made of it."""
    return Medium([_component(*part) for part in parts], super_voxel=super_voxel)


def as_medium(medium: Medium | Component | Field | Iterable[Component]) -> Medium:
    """Return a medium of what users give."""
    return medium if isinstance(medium, Medium) else Medium(medium)


def _component_list(components: Any) -> tuple[Component, ...]:
    if isinstance(components, Field):
        components = Component(components)
    if isinstance(components, Component):
        components = (components,)
    listed = tuple(components)
    for component in listed:
        if not isinstance(component, Component):
            raise TypeError(f"components: {type(component).__name__} is no Component")
    return listed


def _coefficients(component: Component) -> tuple[Any, Any, Any]:
    return component.sigma_a, component.sigma_s, component.emission


def _channel_count(components: tuple[Component, ...]) -> int:
    """Number of channels of all coefficients that are sequences, 1 where none is."""
    counts = {
        len(value) for c in components for value in _coefficients(c) if isinstance(value, list)
    }
    if len(counts) > 1:
        raise Error(
            f"coefficients have {', '.join(map(str, sorted(counts)))} channels; give as many of "
            "each, or one number for all"
        )
    count = counts.pop() if counts else 1
    if any(component.temperature for component in components):
        if count not in (1, 3):
            raise Error(f"coefficients have {count} channels; black bodies glow in R, G and B")
        count = 3
    if count > _freepath.max_channels:
        raise Error(
            f"coefficients have {count} channels; a path carries {_freepath.max_channels} at most"
        )
    return count


def _repeated(value: list[float] | float, count: int) -> list[float]:
    return value if isinstance(value, list) else [value] * count
