"""freepath: unbiased free paths and transmittance in heterogeneous participating media.

Arrays in, arrays with standard errors out, at the speed of the C++ library. Lengths are in world
units, those of a field's transform, and are written as metres; coefficients are per that unit.
Errors are `freepath.Error`, a ValueError, and say what is wrong, where, and what to do.
"""

from ._compare import Comparison, compare
from ._field import Field
from ._film import Film, merge
from ._flux import Fluxes, FluxMap, SlabFluxes, flux, slab
from ._freepath import Error, max_channels, simd
from ._freepath import version as __version__
from ._functions import DensityFunction
from ._lab import Lab, lab, lab_settings
from ._medium import Component, Medium
from ._methods import Method, Option, PhaseFunction, estimators, phase_functions, trackers
from ._render import Picture, Progress, radiance, render
from ._sampling import Estimate, Event, FreePaths, sample_free_paths, transmittance
from ._scene import Scene

__all__ = [
    "Comparison",
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
    "Lab",
    "Medium",
    "Method",
    "Option",
    "PhaseFunction",
    "Picture",
    "Progress",
    "Scene",
    "SlabFluxes",
    "__version__",
    "compare",
    "estimators",
    "flux",
    "lab",
    "lab_settings",
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
