"""Free paths and transmittances against quadrature, their determinism, and what is refused."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from quadrature import Grid, z_of, z_score

import freepath as fp

# Those that walk through any medium without bias; closed-form has a test of its own.
TRACKERS = [m.name for m in fp.trackers() if not m.biased and m.name != "closed-form"]
ESTIMATORS = [m.name for m in fp.estimators() if not m.biased and m.name != "closed-form"]
CHROMATIC = {m.name for m in fp.trackers() if m.chromatic}

# Of some ten thousand numbers that a thousand examples compare, one of a normal distribution lies
# beyond this once in a hundred runs. The examples and their seeds are the same in every run.
LARGEST_Z = 5.2

numbers = st.floats(0.125, 4, width=32)
grids = arrays.arrays(
    np.float32,
    arrays.array_shapes(min_dims=3, max_dims=3, min_side=1, max_side=5),
    elements=st.sampled_from([0, 0.25, 1, 1.75, 3]),
)
# Of whole hundredths: a density changes by nothing along 1e-300 of a way.
unit_vectors = st.tuples(*[st.integers(-100, 100).map(lambda n: n / 100)] * 3).filter(
    lambda v: np.linalg.norm(v) > 0.1
).map(lambda v: np.array(v) / np.linalg.norm(v))


def test_there_are_trackers_and_estimators_to_test():
    assert len(TRACKERS) >= 9 and len(ESTIMATORS) >= 5


@st.composite
def flights(draw):
    """A grid and a ray that passes through it, from a point in or around it."""
    values = draw(grids)
    # Coarse ones have super-voxels whose densities are above 0 everywhere: what controls are made of.
    for axis in range(3):
        values = values.repeat(draw(st.sampled_from([1, 1, 7])), axis)
    size = np.array(draw(st.tuples(numbers, numbers, numbers)), float)
    size *= 3 / (size * values.shape).max()
    grid = Grid(values, size, draw(st.tuples(*[st.sampled_from([0.0, -2.5, 40.0])] * 3)))
    inside = np.array(draw(st.tuples(*[st.floats(0, 1)] * 3))) * size * values.shape + grid.origin
    direction = draw(unit_vectors)
    start = inside - draw(st.sampled_from([0.0, 0.5, 8.0])) * direction
    return values, grid, start, direction


def coarse_grid():
    """A box of 3 x 3 x 3 with densities from 0.25 to 1.25 that change every 8 voxels."""
    values = np.random.default_rng(3).random((4, 4, 4)).astype(np.float32) + 0.25
    values = values.repeat(8, 0).repeat(8, 1).repeat(8, 2)
    return Grid(values, np.full(3, 3 / 32), np.zeros(3)), values


def medium_of(values, grid, sigma_s, sigma_a, scale=1.0):
    field = fp.Field.from_array(values, voxel_size=grid.size, origin=grid.origin)
    return fp.Medium(
        fp.Component(
            field, sigma_s=np.multiply(scale, sigma_s), sigma_a=np.multiply(scale, sigma_a)
        ),
        super_voxel=4,
    )


def differences(medium, grid, start, direction, tracker, sigma_s, sigma_a, count, seed, **options):
    """z of what scatters within half the way and within all of it, and of what escapes."""
    length = 12.0
    ends = np.array([length / 2, length])
    depth = grid.optical_depth(start, direction, ends)
    sigma_s, sigma_a = np.atleast_1d(sigma_s), np.atleast_1d(sigma_a)
    carried = (
        [None] if tracker in CHROMATIC or len(sigma_s) == 1 else list(range(len(sigma_s)))
    )
    result = []
    for only in carried:
        paths = fp.sample_free_paths(
            medium,
            start,
            np.broadcast_to(np.asarray(direction, float), (count, 3)),
            t_max=length,
            tracker=tracker,
            channels=only,
            seed=seed,
            **options,
        )
        weights = paths.weight.reshape(count, -1)
        channels = range(len(sigma_s)) if only is None else [only]
        for column, channel in enumerate(channels):
            weight = weights[:, column].astype(float)
            sigma_t = sigma_s[channel] + sigma_a[channel]
            albedo = sigma_s[channel] / sigma_t
            scatters = paths.event == fp.Event.SCATTER
            for end, tau in zip(ends, depth):
                expected = albedo * -np.expm1(-sigma_t * tau)
                result.append(z_of(weight * (scatters & (paths.distance <= end)), expected))
            escapes = paths.event == fp.Event.ESCAPE
            result.append(z_of(weight * escapes, np.exp(-sigma_t * depth[-1])))
    return np.array(result)


def interpolation_of(method):
    """The one that a method is for: a closed form of the density takes no voxel drawn at random."""
    return "trilinear" if method == "regular" else "stochastic"


@pytest.mark.parametrize(
    "tracker, interpolation",
    [(tracker, "trilinear") for tracker in TRACKERS]
    + [(tracker, "stochastic") for tracker in TRACKERS if tracker != "regular"],
)
@given(flight=flights(), seed=st.integers(0, 2**64 - 1))
def test_free_paths_follow_their_law(tracker, interpolation, flight, seed):
    values, grid, start, direction = flight
    medium = medium_of(values, grid, 0.8, 0.2)
    z = differences(
        medium, grid, start, direction, tracker, 0.8, 0.2, 20_000, seed, interpolation=interpolation
    )
    assert np.abs(z).max() < LARGEST_Z


@pytest.mark.parametrize("tracker", TRACKERS)
@given(flight=flights(), seed=st.integers(0, 2**64 - 1))
def test_free_paths_follow_their_law_in_color(tracker, flight, seed):
    values, grid, start, direction = flight
    sigma_s, sigma_a = [0.3, 0.8, 1.5], [0.1, 0.05, 0.4]
    medium = medium_of(values, grid, sigma_s, sigma_a)
    z = differences(
        medium, grid, start, direction, tracker, sigma_s, sigma_a, 20_000, seed,
        interpolation=interpolation_of(tracker),
    )  # fmt: skip
    assert np.abs(z).max() < LARGEST_Z


@pytest.mark.parametrize("tracker", TRACKERS)
def test_an_error_of_one_percent_is_noticed(tracker):
    """The same test, of a medium that is denser by a hundredth than what it is compared with."""
    grid, values = coarse_grid()
    ray = [-1, 1.4, 1.6], [1, 0, 0], tracker, 0.8, 0.2, 1_000_000, 11
    how = {"interpolation": interpolation_of(tracker)}
    right = differences(medium_of(values, grid, 0.8, 0.2), grid, *ray, **how)
    wrong = differences(medium_of(values, grid, 0.8, 0.2, 1.01), grid, *ray, **how)
    assert np.abs(right).max() < LARGEST_Z < np.abs(wrong).max()


@pytest.mark.parametrize("tracker", ["decomposition", "weighted-decomposition", "spectral-decomposition"])
def test_controls_take_part(tracker):
    grid, values = coarse_grid()
    medium = medium_of(values, grid, 0.8, 0.2)
    paths = fp.sample_free_paths(medium, [-1, 1.4, 1.6], np.tile([1.0, 0, 0], (1000, 1)), tracker=tracker)
    assert paths.statistics["control_collisions"] > 100


@pytest.mark.parametrize("estimator", ESTIMATORS)
@given(flight=flights(), seed=st.integers(0, 2**64 - 1), length=st.floats(0, 12))
def test_transmittances_are_unbiased(estimator, flight, seed, length):
    values, grid, start, direction = flight
    sigma_t = np.array([0.4, 0.85, 1.9])
    medium = medium_of(values, grid, sigma_t * 0.75, sigma_t * 0.25)
    estimate = fp.transmittance(
        medium, start, direction, length, estimator=estimator, samples=20_000, seed=seed,
        interpolation=interpolation_of(estimator),
    )  # fmt: skip
    expected = np.exp(-sigma_t * grid.optical_depth(start, direction, [length])[0])
    assert estimate.mean.shape == estimate.error.shape == (3,)
    z = z_score(estimate.mean, estimate.error, expected, 20_000)
    assert np.abs(z).max() < LARGEST_Z


@pytest.mark.parametrize("estimator", ESTIMATORS)
def test_an_error_of_one_percent_in_transmittances_is_noticed(estimator):
    values = np.random.default_rng(3).random((4, 4, 4)).astype(np.float32) + 0.25
    grid = Grid(values, np.full(3, 0.75), np.zeros(3))
    tau = grid.optical_depth([-1, 1.4, 1.6], [1, 0, 0], [12.0])[0]
    samples = 1_000_000

    def z(scale):
        medium = medium_of(values, grid, 0.5, 0.5, scale)
        mean, error, _ = fp.transmittance(
            medium, [-1, 1.4, 1.6], [1, 0, 0], 12, estimator=estimator, samples=samples,
            interpolation=interpolation_of(estimator),
        )  # fmt: skip
        return abs(z_score(mean, error, np.exp(-tau), samples))

    assert z(1.0) < LARGEST_Z < z(1.01)


def test_closed_form_is_exact_in_homogeneous_media():
    field = fp.Field.from_array(np.full((3, 3, 3), 0.7))
    options = {"interpolation": "nearest"}
    paths = fp.sample_free_paths(
        field, [-1, 1.5, 1.5], np.tile([1.0, 0, 0], (100_000, 1)), tracker="closed-form", **options
    )
    escaped = (paths.event == fp.Event.ESCAPE).astype(float)
    assert abs(z_of(escaped, np.exp(-2.1))) < LARGEST_Z
    estimate = fp.transmittance(field, [-1, 1.5, 1.5], [1, 0, 0], estimator="closed-form", **options)
    assert estimate.mean == pytest.approx(np.exp(-2.1), rel=1e-5)


def some_rays(count):
    random = np.random.default_rng(5)
    directions = random.normal(size=(count, 3))
    return [2, 2.5, 3] + random.normal(size=(count, 3)), directions


@pytest.mark.parametrize("tracker", ["delta", "weighted-decomposition", "spectral"])
def test_results_depend_on_neither_threads_nor_instructions(cloud, tracker):
    medium = fp.Medium(fp.Component(cloud, sigma_s=[0.5, 1, 2]) if tracker == "spectral" else cloud)
    origins, directions = some_rays(5000)

    def results(**options):
        paths = fp.sample_free_paths(medium, origins, directions, tracker=tracker, seed=1, **options)
        through = fp.transmittance(medium, origins[:50], directions[:50], samples=3000, **options)
        return (
            paths.distance, paths.event, paths.component, paths.weight, paths.lookups,
            through.mean, through.error,
        )  # fmt: skip

    first = results(threads=1, simd="one-lane")
    for simd in fp.simd():
        for again, before in zip(results(threads=2, simd=simd), first):
            assert np.array_equal(again, before)


def test_a_flight_depends_on_its_ray_and_number_alone(cloud):
    origins, directions = some_rays(3000)
    all_of_them = fp.sample_free_paths(cloud, origins, directions, seed=2)
    some = fp.sample_free_paths(cloud, origins[:100], directions[:100], seed=2)
    assert np.array_equal(all_of_them.distance[:100], some.distance)
    other = fp.sample_free_paths(cloud, origins[:100], directions[:100], seed=3)
    assert not np.array_equal(other.distance, some.distance)


def test_shapes_are_those_of_the_rays(cloud):
    color = fp.Component(cloud, sigma_s=[0.5, 1, 2])
    directions = np.broadcast_to([1.0, 0, 0], (4, 7, 3))
    paths = fp.sample_free_paths(color, [0, 2, 3], directions, tracker="spectral")
    assert paths.distance.shape == paths.event.shape == paths.lookups.shape == (4, 7)
    assert paths.weight.shape == (4, 7, 3)
    assert fp.sample_free_paths(cloud, [0, 2, 3], directions).weight.shape == (4, 7)
    assert fp.sample_free_paths(color, [0, 2, 3], [1, 0, 0], channels=np.int64(1)).weight.shape == ()
    assert fp.sample_free_paths(color, [0, 2, 3], [1, 0, 0], tracker="spectral", channels=[2, 0]).weight.shape == (2,)
    assert fp.sample_free_paths(cloud, np.empty((0, 3)), [1, 0, 0]).distance.shape == (0,)
    assert fp.transmittance(cloud, np.empty((0, 3)), [1, 0, 0]).mean.shape == (0,)


def test_layouts_and_precisions_of_rays_change_nothing(cloud):
    origins = np.zeros((100, 3), np.float32) + np.float32([0, 2, 3])
    directions = np.tile(np.float32([1, 0, 0]), (100, 1))
    first = fp.sample_free_paths(cloud, origins, directions)
    wide = np.zeros((100, 8))
    wide[:, ::-2][:, :3] = origins
    for start in (origins.astype(float), np.asfortranarray(origins), wide[:, ::-2][:, :3], origins[0]):
        along = directions.copy()
        along.flags.writeable = False
        assert np.array_equal(fp.sample_free_paths(cloud, start, along).distance, first.distance)


def test_distances_are_in_units_of_the_world_whatever_the_length_of_directions(cloud):
    unit = fp.sample_free_paths(cloud, [0, 2, 3], np.tile([1.0, 0, 0], (1000, 1)))
    longer = fp.sample_free_paths(cloud, [0, 2, 3], np.tile([4.0, 0, 0], (1000, 1)))
    assert np.array_equal(unit.distance, longer.distance)


def test_components_are_told_apart(cloud):
    medium = fp.Medium([fp.Component(cloud, sigma_s=1), fp.Component(cloud, sigma_s=3)])
    paths = fp.sample_free_paths(medium, [0, 2, 3], np.tile([1.0, 0, 0], (100_000, 1)), seed=4)
    scattered = paths.event == fp.Event.SCATTER
    assert (paths.component[~scattered] == -1).all()
    assert abs(z_of(paths.component[scattered], 0.75)) < LARGEST_Z


def test_more_channels_than_three(cloud):
    sigma_s = np.linspace(0.1, 2, fp.max_channels)
    medium = fp.Medium(fp.Component(cloud, sigma_s=sigma_s))
    assert medium.channels == fp.max_channels
    estimate = fp.transmittance(medium, [-1, 2, 3], [1, 0, 0], samples=20_000)
    single = fp.transmittance(medium, [-1, 2, 3], [1, 0, 0], samples=20_000, channels=4)
    grid = Grid(cloud.to_array(), np.ones(3), np.zeros(3))
    expected = np.exp(-sigma_s * grid.optical_depth([-1, 2, 3], [1, 0, 0], [12.0])[0])
    assert np.abs((estimate.mean - expected) / estimate.error).max() < LARGEST_Z
    assert abs(single.mean - expected[4]) < LARGEST_Z * single.error


def test_emission_is_gathered(cloud):
    """A medium that absorbs alone has emitted L_e (1 - T) of what escapes and is absorbed."""
    medium = fp.Medium(fp.Component(cloud, sigma_s=0, sigma_a=1, emission=2))
    paths = fp.sample_free_paths(medium, [-1, 2, 3], np.tile([1.0, 0, 0], (200_000, 1)))
    grid = Grid(cloud.to_array(), np.ones(3), np.zeros(3))
    depth = grid.optical_depth([-1, 2, 3], [1, 0, 0], [12.0])[0]
    assert abs(z_of(paths.emitted, 2 * -np.expm1(-depth))) < LARGEST_Z
    assert fp.sample_free_paths(cloud, [0, 2, 3], [1, 0, 0]).emitted is None


def test_methods_tell_of_themselves():
    spectral = next(m for m in fp.trackers() if m.name == "spectral")
    assert spectral.chromatic and not spectral.biased and spectral.source.startswith("[Kutz17")
    weighted = next(m for m in fp.trackers() if m.name == "weighted-decomposition")
    assert any(option.name == "control" for option in weighted.options)
    assert "auto" in {m.name for m in fp.trackers()}
    assert "ratio" in {m.name for m in fp.estimators()}
    assert "droplets" in fp.phase_functions()


@pytest.mark.parametrize(
    "text, mean_cosine",
    [("isotropic", 0), ("henyey-greenstein:g=0.8", 0.8), ("rayleigh", 0), ("draine:g=0,alpha=1", 0)],
)
def test_phase_functions_integrate_to_one(text, mean_cosine):
    phase = fp.PhaseFunction(text)
    cosines, weights = np.polynomial.legendre.leggauss(200)
    values = phase.evaluate(cosines)
    assert 2 * np.pi * weights @ values == pytest.approx(1, rel=1e-5)
    assert 2 * np.pi * weights @ (values * cosines) == pytest.approx(mean_cosine, abs=1e-5)
    assert phase.mean_cosine == pytest.approx(mean_cosine, abs=1e-6)


X = [1.0, 0, 0]
BAD = {
    "shape of origins": (dict(origins=[0, 0], directions=X), r"shape is \(2,\)"),
    "shapes apart": (dict(origins=np.zeros((2, 3)), directions=np.ones((3, 3))), "do not go together"),
    "dtype": (dict(origins=np.zeros(3, int), directions=X), "dtype is int64"),
    "NaN in origins": (dict(origins=[[0, 0, 0], [0, np.nan, 0]], directions=X), "ray 1: its origin"),
    "direction 0": (dict(origins=[0, 0, 0], directions=[0.0, 0, 0]), "ray 0: its direction"),
    "infinite direction": (dict(origins=[0, 0, 0], directions=[np.inf, 0, 0]), "ray 0: its direction"),
    "negative end": (dict(origins=[0, 0, 0], directions=X, t_max=-1.0), "t_max is -1"),
    "NaN as an end": (dict(origins=[0, 0, 0], directions=X, t_max=np.nan), "t_max is nan"),
    "tracker": (dict(origins=[0, 0, 0], directions=X, tracker="dleta"), "delta"),
    "option": (dict(origins=[0, 0, 0], directions=X, tracker="delta:x=1"), "x"),
    "interpolation": (dict(origins=[0, 0, 0], directions=X, interpolation="cubic"), "stochastic"),
    "absorption": (dict(origins=[0, 0, 0], directions=X, absorption="none"), "analog, weighted"),
    "simd": (dict(origins=[0, 0, 0], directions=X, simd="mmx"), "mmx"),
    "seed": (dict(origins=[0, 0, 0], directions=X, seed=-1), "seed"),
    "channel": (dict(origins=[0, 0, 0], directions=X, channels=3), "channel 3"),
    "no channel": (dict(origins=[0, 0, 0], directions=X, channels=[]), "None for all"),
    "threads": (dict(origins=[0, 0, 0], directions=X, threads=-1), "threads"),
}


@pytest.mark.parametrize("options, message", BAD.values(), ids=BAD.keys())
def test_bad_rays_and_words_have_one_clear_error(cloud, options, message):
    with pytest.raises(fp.Error, match=message):
        fp.sample_free_paths(cloud, **options)


def test_channels_that_need_paths_of_their_own_are_refused(cloud):
    medium = fp.Medium(fp.Component(cloud, sigma_s=[0.5, 1, 2]))
    with pytest.raises(fp.Error, match="delta"):
        fp.sample_free_paths(medium, [0, 2, 3], X)


COMPONENTS = {
    "negative": (dict(sigma_s=-1), "not negative"),
    "NaN": (dict(sigma_a=np.nan), "finite"),
    "two axes": (dict(sigma_s=np.ones((3, 3))), r"\(3, 3\)"),
    "none": (dict(sigma_s=[]), r"\(0,\)"),
    "phase": (dict(phase="henyey-greenstein:g=2"), "g"),
    "unknown phase": (dict(phase="mie"), "mie"),
}


@pytest.mark.parametrize("options, message", COMPONENTS.values(), ids=COMPONENTS.keys())
def test_bad_components_have_one_clear_error(cloud, options, message):
    with pytest.raises(fp.Error, match=message):
        fp.Component(cloud, **options)


def test_bad_media_have_one_clear_error(cloud):
    with pytest.raises(fp.Error, match="not 0"):
        fp.Medium([])
    with pytest.raises(fp.Error, match="2, 3 channels"):
        fp.Medium([fp.Component(cloud, sigma_s=[1, 2]), fp.Component(cloud, sigma_s=[1, 2, 3])])
    with pytest.raises(fp.Error, match="at most"):
        fp.Medium(fp.Component(cloud, sigma_s=np.ones(fp.max_channels + 1)))
    with pytest.raises(TypeError, match="ndarray is no Component"):
        fp.Medium(np.ones((3, 3)))
    with pytest.raises(TypeError, match="ndarray is no Field"):
        fp.Component(np.ones((3, 3, 3)))


def test_rays_of_dlpack_are_read(cloud):
    class Tensor:
        def __init__(self, array):
            self.__dlpack__, self.__dlpack_device__ = array.__dlpack__, array.__dlpack_device__

    directions = np.random.default_rng(1).normal(size=(50, 3)).astype(np.float32)
    ends = np.linspace(1, 5, 50)
    one = fp.sample_free_paths(cloud, [2, 2, 3], Tensor(directions), t_max=Tensor(ends))
    other = fp.sample_free_paths(cloud, [2, 2, 3], directions, t_max=ends)
    assert np.array_equal(one.distance, other.distance)
