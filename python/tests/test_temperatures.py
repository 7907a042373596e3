"""Media that glow as black bodies of a field of temperatures."""

import pickle
import subprocess

import numpy as np
import pytest

import freepath as fp
from test_render import read_pfm


def glowing(kelvins=2000.0, **how):
    """An opaque cube of one temperature, which it has around it too, that does not scatter."""
    hot = fp.Field.from_array(np.full((12, 12, 12), kelvins, np.float32), origin=[-4, -4, -4])
    options = {"sigma_s": 0, "sigma_a": 50, "temperature": hot, **how}
    return fp.Component(fp.Field.from_array(np.ones((4, 4, 4), np.float32)), **options)


def seen(component):
    scene = fp.Scene.around(component, size=(8, 8), environment=0.0, sun=None)
    return fp.radiance(scene, [2, 2, -5], [0, 0, 1], spp=64)


def test_pictures_have_the_bits_of_the_programs(program, tmp_path):
    file = tmp_path / "fireball.vdb"
    subprocess.run([program, "generate", "fireball", "-o", file, "--resolution", "24"], check=True, capture_output=True)
    density, temperature = (fp.Field.open(file, grid=grid) for grid in ("density", "temperature"))
    for periodic, arguments in (("", []), ("xz", ["--periodic", "x,z"])):
        component = fp.Component(
            density, sigma_s=1, sigma_a=3, emission=2, temperature=temperature,
            temperature_scale=0.9, temperature_offset=10,
        )  # fmt: skip
        picture = fp.render(fp.Scene.around(component, size=(24, 16), periodic=periodic), spp=3)
        subprocess.run(
            [program, "render", file, "-o", tmp_path / "fire.pfm", "--size", "24x16", "--spp", "3",
             "--sigma-s", "1", "--sigma-a", "3", "--le", "2", "--grid", "density", "--temperature",
             "temperature", "--temperature-scale", "0.9", "--temperature-offset", "10", *arguments],
            check=True, capture_output=True,
        )  # fmt: skip
        assert picture.image.max() > 0
        assert np.array_equal(picture.image, read_pfm(tmp_path / "fire.pfm"))


def test_an_opaque_body_has_the_radiance_of_its_temperature():
    """Red of a hot body outshines its blue; twice the factor is twice the radiance."""
    one, twice = seen(glowing()).mean, seen(glowing(emission=2)).mean
    assert one[0] > one[1] > one[2] and one[0] > 0
    assert np.allclose(twice, 2 * one, rtol=1e-5)
    # 1000 above 0 K at 1000 is as 2000 of a half, and so on.
    again = seen(glowing(2000.0, temperature_scale=2, temperature_offset=1000)).mean
    assert np.allclose(again, one, rtol=1e-5)
    assert (seen(glowing(100.0)).mean == 0).all()


def test_paths_gather_the_radiance_along_their_way():
    """L (1 - T) of a thin cube, in each channel; a planted error of 1 % shows."""
    opaque = seen(glowing()).mean
    thin = glowing(sigma_a=0.25)
    count = 400_000
    paths = fp.sample_free_paths(
        thin, [2, 2, -5], np.tile([0.0, 0, 1], (count, 1)), interpolation="nearest"
    )
    emitted = paths.emitted.astype(float)
    assert emitted.shape == (count, 3)
    z = (emitted.mean(0) - opaque * -np.expm1(-1.0)) / (emitted.std(0) / np.sqrt(count))
    assert np.abs(z).max() < 4.5
    planted = (1.01 * emitted.mean(0) - opaque * -np.expm1(-1.0)) / (emitted.std(0) / np.sqrt(count))
    assert np.abs(planted).min() > 4.5


def test_films_and_pickles_know_temperatures():
    def scene(component):
        return fp.Scene.around(component, size=(8, 6), environment=0.0, sun=None)

    component = glowing()
    again = pickle.loads(pickle.dumps(component))
    one, other = (fp.render(scene(c), samples=(i, i + 1)).film for i, c in enumerate((component, again)))
    fp.merge([one, other])
    hotter = fp.render(scene(glowing(2100.0)), samples=(1, 2)).film
    with pytest.raises(fp.Error, match="scene"):
        fp.merge([one, hotter])


def test_what_is_no_temperature_has_one_clear_error(cloud):
    computed = fp.DensityFunction(lambda p: p[:, 0], 0, 1, bounds=(0, 1), name="hot")
    for options, message in [
        (dict(temperature_scale=0), "temperature_scale"),
        (dict(temperature_offset=np.nan), "temperature_offset"),
        (dict(sigma_s=[1, 2]), "2 channels; black bodies"),
        (dict(temperature=computed), "'hot' is computed"),
    ]:
        with pytest.raises(fp.Error, match=message):
            fp.Medium(glowing(**options))
    with pytest.raises(TypeError, match="float is no Field"):
        glowing(temperature=2000.0)
    with pytest.raises(fp.Error, match="no part of these fluxes"):
        fp.flux(glowing(), paths=100)
