"""Fluxes against what is known of them."""

import json
import subprocess

import numpy as np
import pytest

import freepath as fp


def z(estimate, expected):
    return (estimate.mean - expected) / max(estimate.error, 1e-9)


def test_a_layer_without_scattering_transmits_by_its_law():
    fluxes = fp.slab(1.25, 0.0, mu0=0.5, paths=2e5)
    assert abs(z(fluxes.transmittance, np.exp(-2.5))) < 4
    assert fluxes.reflectance.mean == 0 and fluxes.reflectance.upper is None
    assert abs(z(fluxes.unscattered, np.exp(-2.5))) < 4


def test_an_isotropic_half_space_reflects_as_chandrasekhar_says():
    """R = 1 - H(mu0) sqrt(1 - albedo) [Chandrasekhar60], with H from its integral equation."""
    albedo, mu0 = 0.9, 0.5
    mu, weights = np.polynomial.legendre.leggauss(64)
    mu, weights = (mu + 1) / 2, weights / 2
    h = np.ones_like(mu)
    for _ in range(2000):
        # 1/H(m) = sqrt(1 - albedo) + albedo/2 int H(n) n/(m + n) dn
        h = 1 / (
            np.sqrt(1 - albedo)
            + albedo / 2 * (weights * h * mu / (mu[:, None] + mu)).sum(1)
        )
    at_mu0 = 1 / (np.sqrt(1 - albedo) + albedo / 2 * (weights * h * mu / (mu0 + mu)).sum())
    expected = 1 - at_mu0 * np.sqrt(1 - albedo)
    fluxes = fp.slab(np.inf, albedo, mu0=mu0, paths=1e6)
    assert abs(z(fluxes.reflectance, expected)) < 4
    wrong = fp.slab(np.inf, albedo * 0.99, mu0=mu0, paths=1e6)
    assert abs(z(wrong.reflectance, expected)) > 4


def test_layers_take_values_each_or_one_for_all():
    two = fp.slab([0.5, 0.5], [0.9, 0.9], 0.5, paths=1e5)
    again = fp.slab([0.5, 0.5], 0.9, phase="henyey-greenstein:g=0.5", paths=1e5)
    assert two == again
    assert two.reflectance.mean + two.transmittance.mean + two.absorptance.mean == pytest.approx(1)


SLABS = {
    "tau": (dict(tau=-1.0), "thick|tau"),
    "albedo": (dict(tau=1.0, albedo=2.0), "albedo"),
    "counts": (dict(tau=[1.0, 2.0], albedo=[1.0, 1.0, 1.0]), "2 layers"),
    "g": (dict(tau=1.0, g=1.5), "g"),
    "mu0": (dict(tau=1.0, mu0=0.0), "mu0|cosine"),
    "paths": (dict(tau=1.0, paths=0.5), "paths"),
    "axes": (dict(tau=np.ones((2, 2))), "shape"),
    "infinite above": (dict(tau=[np.inf, 1.0]), "last"),
    "phases": (dict(tau=[1.0, 1.0], phase=["rayleigh"] * 3), "2 layers"),
}


@pytest.mark.parametrize("options, message", SLABS.values(), ids=SLABS.keys())
def test_bad_layers_have_one_clear_error(options, message):
    with pytest.raises(fp.Error, match=message):
        fp.slab(**options)


def test_fluxes_of_homogeneous_columns_are_those_of_a_layer():
    field = fp.Field.from_array(np.ones((4, 4, 8)), voxel_size=0.25)
    medium = fp.Component(field, sigma_s=0.9, sigma_a=0.1)
    fluxes = fp.flux(medium, sun=(60, 0), paths=4e5, columns=(2, 1))
    layer = fp.slab(2.0, 0.9, mu0=0.5, paths=4e5, seed=1)
    for name in ("reflectance", "transmittance", "absorptance"):
        one, other = getattr(fluxes, name).all, getattr(layer, name)
        assert abs(one.mean - other.mean) < 4 * np.hypot(one.error, other.error)
    assert fluxes.reflectance.columns.mean.shape == (2, 1)


def test_columns_stand_where_the_array_has_them():
    """Thick at x = 0, thin at x = 1, of two voxels along x and three along y."""
    values = np.zeros((2, 3, 1), np.float32)
    values[0] = 3
    fluxes = fp.flux(fp.Component(fp.Field.from_array(values), sigma_s=0, sigma_a=1), paths=1e5)
    through, error, _ = fluxes.transmittance.columns
    assert through.shape == error.shape == (2, 3)
    assert (np.abs(through - [[np.exp(-3)], [1]]) < 4 * error).all()


def test_bad_fluxes_have_one_clear_error(cloud):
    for options, message in [
        (dict(sun=(95, 0)), "sun"),
        (dict(sun=3), "sun"),
        (dict(views=[(90, 0)]), "views"),
        (dict(columns=(0, 1)), "columns"),
        (dict(ground=1.5), "albedo"),
        (dict(ground_height=1.0), "albedo"),
        (dict(up="x"), "y, z"),
        (dict(domain=([0, 0, 0], [3.3, 5, 0])), "x|period|domain"),
    ]:
        with pytest.raises(fp.Error, match=message):
            fp.flux(cloud, **options)
    with pytest.raises(fp.Error, match="emission"):
        fp.flux(fp.Component(cloud, sigma_a=[1, 2, 3], emission=[0, 0, 1]), paths=100)


def in_channel(estimate, channel):
    return estimate.mean[..., channel], estimate.error[..., channel]


def test_channels_are_grey_media_of_their_own(cloud):
    sigma_s, sigma_a = np.linspace(0.25, 2, fp.max_channels), 0.25
    how = {"sun": (30, 90), "views": [(0, 0), (60, 10)], "ground": 0.25, "paths": 1000, "seed": 3}
    all_of_them = fp.flux(fp.Component(cloud, sigma_s=sigma_s, sigma_a=sigma_a), **how)
    largest = []
    for channel, scattering in enumerate(sigma_s):
        grey = fp.flux(fp.Component(cloud, sigma_s=scattering, sigma_a=sigma_a), **how)
        largest.append(grey.largest_weight)
        names = ("reflectance", "transmittance", "unscattered", "absorptance")
        pairs = [(getattr(all_of_them, name), getattr(grey, name)) for name in names]
        for colors, own in [*pairs, *zip(all_of_them.radiances, grey.radiances, strict=True)]:
            assert colors.columns.mean.shape == (4, 5, fp.max_channels)
            assert in_channel(colors.all, channel) == own.all[:2]
            assert np.array_equal(in_channel(colors.columns, channel), own.columns[:2])
    assert all_of_them.largest_weight == max(largest) and all_of_them.paths == 1000
    same = fp.flux(fp.Component(cloud, sigma_s=[0.25] * 3, sigma_a=sigma_a), **how)
    assert np.array_equal(in_channel(same.reflectance.all, 2), in_channel(all_of_them.reflectance.all, 0))


def test_channels_are_those_of_the_program(program, cloud, tmp_path):
    cloud.save(tmp_path / "cloud.vdb")
    fluxes = fp.flux(
        fp.Component(cloud, sigma_s=[0.5, 1, 2], sigma_a=0.25), sun=(40, 270), views=[(20, 30)],
        paths=2000, seed=5,
    )  # fmt: skip
    theirs = json.loads(subprocess.check_output([
        program, "flux", tmp_path / "cloud.vdb", "--sigma-s", "0.5,1,2", "--sigma-a", "0.25",
        "--sun-zenith", "40", "--view", "20,30", "--paths", "2000", "--seed", "5", "--json",
    ]))["channels"]  # fmt: skip
    for channel, name in enumerate("RGB"):
        of_all = in_channel(fluxes.absorptance.all, channel)
        assert of_all == (theirs[name]["absorptance"], theirs[name]["absorptance_error"])
        through = in_channel(fluxes.transmittance.columns, channel)[0]
        assert np.array_equal(through.T, theirs[name]["columns"]["transmittance"])
        view = theirs[name]["radiances"][0]
        assert fluxes.radiances[0].all.mean[channel] == view["radiance"]
