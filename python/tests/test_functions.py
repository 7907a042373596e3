"""Densities that Python computes: a Gaussian, whose optical depth along the middle is known."""

import ctypes
import gc
import math
import weakref

import numpy as np
import pytest
from quadrature import z_score

import freepath as fp

try:
    import numba
except ImportError:
    numba = None

TAU = math.sqrt(math.pi) * math.erf(2)  # of exp(-x²) from -2 to 2


def gaussian(positions):
    return np.exp(-np.square(positions).sum(1))


def per_position(positions, densities, n):
    for i in range(n):
        x, y, z = positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]
        densities[i] = math.exp(-(x * x + y * y + z * z))


def in_arrays(positions):
    densities = np.empty(len(positions), np.float32)
    for i in range(len(positions)):
        x, y, z = positions[i]
        densities[i] = math.exp(-(x * x + y * y + z * z))
    return densities


@pytest.fixture(scope="module")
def compiled():
    """A C function, by Numba."""
    if numba is None:
        pytest.skip("Numba is not installed")
    floats = numba.types.CPointer(numba.float32)
    return numba.cfunc(numba.types.void(floats, floats, numba.types.intp))(per_position)


class Tensor:
    """What has DLPack alone."""

    def __init__(self, array):
        self._array = array

    def __dlpack__(self, **options):
        return self._array.__dlpack__(**options)

    def __dlpack_device__(self):
        return self._array.__dlpack_device__()


def bounds(lower, upper):
    nearest = [max(low, 0.0) if low > 0 else min(high, 0.0) for low, high in zip(lower, upper)]
    farthest = [max(abs(low), abs(high)) for low, high in zip(lower, upper)]
    square = [sum(c * c for c in corner) for corner in (farthest, nearest)]
    return math.exp(-square[0]) * 0.9999, math.exp(-square[1]) * 1.0001


FUNCTIONS = {
    "NumPy": (lambda compiled: gaussian, 4000),
    "DLPack": (lambda compiled: lambda positions: Tensor(gaussian(positions)), 4000),
    "numba.njit": (lambda compiled: numba.njit(in_arrays), 4000),
    "numba.cfunc": (lambda compiled: compiled, 400_000),
    "ctypes": (lambda compiled: compiled.ctypes, 400_000),
}


@pytest.mark.parametrize("make, samples", FUNCTIONS.values(), ids=FUNCTIONS.keys())
@pytest.mark.parametrize("known", [(0.0, 1.0), bounds], ids=["one pair", "bounds by place"])
def test_transmittance_of_a_function_is_unbiased(make, samples, known, request):
    needs_numba = samples > 1e5 or "njit" in request.node.callspec.id
    function = make(request.getfixturevalue("compiled") if needs_numba else None)
    field = fp.DensityFunction(function, -2, 2, bounds=known, cells=8)
    for scale in (1.0, 1.01):
        medium = fp.Component(field, sigma_s=scale)
        mean, error, _ = fp.transmittance(medium, [-5, 0, 0], [1, 0, 0], samples=samples)
        z = abs(z_score(mean, error, math.exp(-TAU), samples))
        assert z < 4.5 if scale == 1 else samples < 1e5 or z > 4.5
    paths = fp.sample_free_paths(field, [-5, 0, 0], np.tile([1.0, 0, 0], (samples, 1)))
    escaped = np.mean(paths.event == fp.Event.ESCAPE)
    assert abs(escaped - math.exp(-TAU)) < 4.5 * 0.5 / math.sqrt(samples)
    assert paths.statistics["bound_violations"] == 0


def test_functions_are_rendered(compiled):
    field = fp.DensityFunction(compiled, -2, 2, bounds=bounds)
    picture = fp.render(fp.Scene.around(field, size=(20, 12), environment=1.0), spp=16)
    assert picture.alpha.max() > 0.3
    assert abs(picture.image.mean() - 1) < 0.05


def test_a_baked_function_is_the_field_of_its_samples(compiled):
    function = fp.DensityFunction(gaussian, [-2, -1, -2], [2, 1, 2], bounds=(0, 1), name="bell")
    field = function.bake(0.25)
    assert field.shape == (16, 8, 16) and field.name == "bell"
    assert np.allclose(fp.Medium(field).bounds, [[-2, -1, -2], [2, 1, 2]])
    centre = np.array([3, 5, 7])
    position = np.array([-2, -1, -2]) + (centre + 0.5) * 0.25
    assert field.to_array()[tuple(centre)] == pytest.approx(np.exp(-(position @ position)))
    with pytest.raises(fp.Error, match="needs no baking"):
        fp.DensityFunction(compiled, -2, 2, bounds=(0, 1)).bake(0.1)
    with pytest.raises(fp.Error, match="too many"):
        function.bake(1e-6)


def test_errors_of_functions_come_through():
    def fail(positions):
        raise KeyError("not my day")

    for function, error, message in [
        (fail, KeyError, "not my day"),
        (lambda p: -np.ones(len(p)), fp.Error, r"density function 'mine' is -1 at \("),
        (lambda p: np.full(len(p), np.nan), fp.Error, "nan"),
        (lambda p: np.ones((len(p), 2)), fp.Error, "one density for each"),
    ]:
        field = fp.DensityFunction(function, -2, 2, bounds=(0, 1), name="mine")
        with pytest.raises(error, match=message):
            fp.transmittance(field, [-5, 0, 0], [1, 0, 0])


def test_what_is_no_function_is_refused():
    for options, message in [
        (dict(bounds=(1, 0)), "least one first"),
        (dict(bounds=(-1, 1)), "not negative"),
        (dict(bounds=3), "neither a pair"),
        (dict(bounds=lambda a, b: (0, np.inf)), "finite"),
        (dict(bounds=(0, 1), cells=0), "cells"),
        (dict(bounds=(0, 1), lower=3), "empty"),
    ]:
        with pytest.raises(fp.Error, match=message):
            fp.Medium(fp.DensityFunction(gaussian, options.pop("lower", -2), 2, **options))
    with pytest.raises(TypeError, match="no function"):
        fp.DensityFunction(3, -2, 2, bounds=(0, 1))
    field = fp.DensityFunction(gaussian, -2, 2, bounds=(0, 1))
    with pytest.raises(fp.Error, match="no voxels"):
        field.to_array()
    with pytest.raises(fp.Error, match="no voxels"):
        field.save("never.vdb")


def test_functions_are_let_go():
    class Function:
        def __call__(self, positions):
            return gaussian(positions)

    function = Function()
    gone = weakref.ref(function)
    medium = fp.Medium(fp.DensityFunction(function, -2, 2, bounds=(0, 1)))
    del function
    gc.collect()
    assert fp.transmittance(medium, [-5, 0, 0], [1, 0, 0], samples=10).mean > 0
    del medium
    gc.collect()
    assert gone() is None


def test_ctypes_functions_have_the_signature_of_compiled_ones(compiled):
    """A C function pointer that was made by hand."""
    signature = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_ssize_t)
    field = fp.DensityFunction(signature(compiled.address), -2, 2, bounds=(0, 1))
    assert fp.transmittance(field, [-5, 0, 0], [1, 0, 0], samples=10).mean > 0
