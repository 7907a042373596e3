"""freepath: unbiased free paths and transmittance in heterogeneous participating media.

Arrays in, arrays with standard errors out, at the speed of the C++ library. Lengths are in world
units, those of a field's transform, and are written as metres; coefficients are per that unit.
Errors are `freepath.Error`, a ValueError, and say what is wrong, where, and what to do.
"""

from ._field import DensityFunction, Field
from ._film import Film, merge
from ._flux import Fluxes, FluxMap, SlabFluxes, flux, slab
from ._freepath import Error, max_channels, simd
from ._freepath import version as __version__
from ._medium import Component, Medium
from ._methods import Method, Option, PhaseFunction, estimators, phase_functions, trackers
from ._render import Picture, Progress, radiance, render
from ._sampling import Estimate, Event, FreePaths, sample_free_paths, transmittance
from ._scene import Scene

__all__ = [
    "Component",
    "DensityFunction",
    "Error",
    "Estimate",
    "Event",
    "Field",
    "Film",
    "FluxMap",
    "Fluxes",
    "FreePaths",
    "Medium",
    "Method",
    "Option",
    "PhaseFunction",
    "Picture",
    "Progress",
    "Scene",
    "SlabFluxes",
    "__version__",
    "estimators",
    "flux",
    "max_channels",
    "merge",
    "phase_functions",
    "radiance",
    "render",
    "sample_free_paths",
    "simd",
    "slab",
    "trackers",
    "transmittance",
]
