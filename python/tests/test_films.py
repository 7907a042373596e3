"""Films: parts of pictures merged to the bits of the whole, and refused where they are of another."""

import os
import pickle
import subprocess

import numpy as np
import pytest

import freepath as fp

SIZE = (24, 16)


def scene_around(field, *, component=None, super_voxel=0, **around):
    coefficients = {"sigma_s": [0.5, 0.75, 1], "sigma_a": 0.125, "phase": 0.5, **(component or {})}
    medium = fp.Medium(fp.Component(field, **coefficients), super_voxel=super_voxel)
    return fp.Scene.around(medium, **{"size": SIZE, **around})


def assert_same_bits(one, other):
    assert one.layers.keys() == other.layers.keys()
    assert np.array_equal(one.image, other.image) and np.array_equal(one.alpha, other.alpha)
    for name, values in one.layers.items():
        assert np.array_equal(values, other.layers[name]), name


@pytest.fixture
def scene(cloud):
    return scene_around(cloud)


def test_parts_of_samples_tiles_and_crops_become_the_bits_of_the_whole(scene):
    how = {"layers": "all", "seed": 5, "color": "spectral"}
    whole = fp.render(scene, spp=9, **how)
    parts = [
        fp.render(scene, samples=range(4, 9), tile=(2, 2), **how).film,
        fp.render(scene, samples=(4, 9), tile=(1, 2), **how).film,
        fp.render(scene, samples=(0, 4), crop=(0, 0, 10, 16), **how).film,
        fp.render(scene, samples=(0, 4), crop=(10, 0, 24, 16), **how).film,
    ]
    assert parts[0].samples == range(4, 9) and parts[0].window == (0, 8, 24, 16)
    assert parts[0].seed == 5 and parts[3].window == (10, 0, 24, 16)
    merged = fp.merge(parts)
    assert merged.samples == range(9) and merged.window == (0, 0, 24, 16)
    assert_same_bits(merged.picture(), whole)
    stats = merged.picture().stats
    for name in ("samples", "paths", "tracker", "estimator", "color", "seed", "max_scatterings"):
        assert stats[name] == whole.stats[name], name
    assert stats["free_paths"]["lookups"] == whole.stats["free_paths"]["lookups"]


def test_films_come_back_from_bytes_files_and_pickles(scene, tmp_path):
    picture = fp.render(scene, spp=3)
    film = picture.film
    film.save(tmp_path / "a.film")
    for copy in (
        fp.Film.from_bytes(film.to_bytes()),
        fp.Film.open(tmp_path / "a.film"),
        pickle.loads(pickle.dumps(film)),
    ):
        assert copy.facts == film.facts and copy.samples == range(3)
        assert copy.to_bytes() == film.to_bytes()
        assert_same_bits(copy.picture(), picture)


def test_damaged_bytes_are_refused_wherever_they_are_damaged(scene):
    data = fp.render(scene, spp=1).film.to_bytes()
    for offset in range(0, len(data), max(1, len(data) // 40)):
        damaged = bytearray(data)
        damaged[offset] ^= 0x40
        with pytest.raises(fp.Error, match="bytes of a film: "):
            fp.Film.from_bytes(bytes(damaged))
    for size in (0, 10, len(data) // 2, len(data) - 1):
        with pytest.raises(fp.Error, match="bytes of a film: "):
            fp.Film.from_bytes(data[:size])


def test_the_program_merges_films_of_python_and_python_those_of_the_program(
    program, cloud, scene, tmp_path
):
    whole = fp.render(scene, spp=5)
    fp.render(scene, samples=(0, 2)).film.save(tmp_path / "a.film")
    fp.render(scene, samples=(2, 5)).film.save(tmp_path / "b.film")
    merge = [program, "merge", "a.film", "b.film", "-o", "both.film"]
    subprocess.run(merge, check=True, capture_output=True, cwd=tmp_path)
    assert_same_bits(fp.Film.open(tmp_path / "both.film").picture(), whole)

    cloud.save(tmp_path / "cloud.vdb")
    for samples, name in (("0-1", "c.film"), ("2-4", "d.film")):
        render = [
            program, "render", "cloud.vdb", "-o", name, "--size", "24x16", "--samples", samples,
            "--sigma-s", "0.5,0.75,1", "--sigma-a", "0.125", "--g", "0.5",
        ]  # fmt: skip
        subprocess.run(render, check=True, capture_output=True, cwd=tmp_path)
    merged = fp.merge(fp.Film.open(tmp_path / name) for name in ("d.film", "c.film"))
    assert_same_bits(merged.picture(), whole)


def test_averages_of_seeds_have_the_mean_of_both(scene):
    # Pixels of equal samples, so that each seed counts as much as the other.
    one, other = (fp.render(scene, spp=4, seed=seed, adaptive=False) for seed in (1, 2))
    both = fp.merge([one.film, other.film], average=True).picture()
    np.testing.assert_allclose(both.image, (one.image + other.image) / 2, rtol=1e-5)
    assert both.stats["samples"] == 8
    with pytest.raises(fp.Error, match=r"films\[1\]: .*its seed is 2 and not 1"):
        fp.merge([one.film, other.film])


def test_what_is_missing_or_there_twice_is_an_error(scene):
    a, b, c = (fp.render(scene, samples=(2 * i, 2 * i + 2)).film for i in range(3))
    with pytest.raises(fp.Error, match=r"films\[0\] and films\[1\] overlap"):
        fp.merge([a, a])
    with pytest.raises(fp.Error, match="samples 2 to 3 of pixel"):
        fp.merge([a, c])
    assert fp.merge([a, c], partial=True).picture().stats["samples"] == 4
    assert_same_bits(fp.merge([c, a, b]).picture(), fp.render(scene, spp=6))
    with pytest.raises(fp.Error, match="no film"):
        fp.merge([])
    with pytest.raises(TypeError, match="films: Picture is no Film"):
        fp.merge([a.picture()])


def changed_voxel(field):
    values = field.to_array()
    values[1, 2, 3] += 0.001
    return fp.Field.from_array(values)


OTHER_SCENES = {
    "a voxel": lambda field: scene_around(changed_voxel(field)),
    "its place": lambda field: scene_around(fp.Field.from_array(field.to_array(), origin=1)),
    "sigma_a": lambda field: scene_around(field, component={"sigma_a": 0.126}),
    "emission": lambda field: scene_around(field, component={"emission": 0.1}),
    "phase": lambda field: scene_around(field, component={"phase": 0.51}),
    "super_voxel": lambda field: scene_around(field, super_voxel=4),
    "fov": lambda field: scene_around(field, fov=41),
    "camera": lambda field: scene_around(field, look_from=(9, 9, 9)),
    "sky": lambda field: scene_around(field, environment=0.5),
    "sun": lambda field: scene_around(field, sun=(30, 255)),
    "ground": lambda field: scene_around(field, ground=0.5),
    "turbidity": lambda field: scene_around(field, turbidity=3),
    "periodic": lambda field: scene_around(field, periodic="x"),
}


@pytest.mark.parametrize("other", OTHER_SCENES.values(), ids=OTHER_SCENES.keys())
def test_films_of_other_scenes_are_no_parts(cloud, scene, other):
    part = fp.render(scene, samples=(0, 1)).film
    fp.merge([part, fp.render(scene_around(cloud), samples=(1, 2)).film])
    with pytest.raises(fp.Error, match="the scene is"):
        fp.merge([part, fp.render(other(cloud), samples=(1, 2)).film])


@pytest.mark.parametrize(
    "how",
    [
        {"tracker": "weighted-delta"}, {"estimator": "residual-ratio"}, {"absorption": "analog"},
        {"emission": "analog"}, {"interpolation": "trilinear"}, {"max_scatterings": 9},
        {"shadow_roulette": False}, {"near_light_lines": False}, {"lobe_splitting": False},
        {"light_through_glass": False}, {"adaptive": False},
        {"color": "spectral"}, {"wavelengths": 3}, {"layers": "all"}, {"seed": 1},
    ],
    ids=str,
)  # fmt: skip
def test_films_by_other_methods_are_no_parts(scene, how):
    part = fp.render(scene, samples=(0, 1)).film
    with pytest.raises(fp.Error, match="no part of the same picture"):
        fp.merge([part, fp.render(scene, samples=(1, 2), **how).film])


def test_a_computed_density_is_the_same_as_itself_alone():
    def scene(density):
        return fp.Scene.around(density, size=(8, 6), environment=1)

    a, b = (
        fp.DensityFunction(lambda p: p[:, 0], [0, 0, 0], [1, 1, 1], bounds=(0, 1)) for _ in range(2)
    )
    part = fp.render(scene(a), samples=(0, 1)).film
    fp.merge([part, fp.render(scene(a), samples=(1, 2)).film])
    with pytest.raises(fp.Error, match="the scene is"):
        fp.merge([part, fp.render(scene(b), samples=(1, 2)).film])
    with pytest.raises(fp.Error, match="can't be sent: bake it first"):
        pickle.dumps(scene(a))


def test_files_count_by_their_content(cloud, tmp_path):
    text = """
        LookAt 0 0 -20  2 2 3  0 1 0
        Camera "perspective" "float fov" 40
        Film "rgb" "integer xresolution" 12 "integer yresolution" 8
        WorldBegin
        LightSource "infinite" "rgb L" [ 1 1 1 ]
        MakeNamedMedium "cloud" "string type" "nanovdb" "string filename" "cloud.vdb"
        AttributeBegin
          MediumInterface "cloud" ""
          Material "interface"
          Shape "sphere" "float radius" 10
        AttributeEnd
        """

    def write(folder, field):
        os.makedirs(folder, exist_ok=True)
        field.save(folder / "cloud.vdb")
        (folder / "scene.pbrt").write_text(text)
        return fp.Scene.from_pbrt(folder / "scene.pbrt")

    one = write(tmp_path / "one", cloud)
    picture = fp.render(one, samples=(0, 1))
    part = picture.film
    assert {"the content of cloud.vdb", "the content of scene.pbrt"} <= part.facts.keys()
    same = write(tmp_path / "same", cloud)
    fp.merge([part, fp.render(same, samples=(1, 2)).film])
    other = write(tmp_path / "other", changed_voxel(cloud))
    with pytest.raises(fp.Error, match="the content of cloud.vdb is"):
        fp.merge([part, fp.render(other, samples=(1, 2)).film])
    # A scene whose file is another one by now has no film that could tell.
    late = fp.render(fp.Scene.from_pbrt(tmp_path / "one" / "scene.pbrt"), samples=(1, 2))
    (tmp_path / "one" / "scene.pbrt").write_text(text + "# another\n")
    with pytest.raises(fp.Error, match="scene.pbrt: has changed since the scene was built"):
        _ = late.film


def sparse_field():
    """Bricks of one value, some of many, empty ones between, and a first voxel that is not 0."""
    values = np.zeros((40, 33, 50), np.float32)
    values[8:24, 8:16, 16:32] = 0.5
    values[30:, 20:, 40:] = np.random.default_rng(3).random((10, 13, 10))
    return fp.Field.from_array(values, voxel_size=0.1, origin=(1, 2, 3), name="sparse")


def test_pickled_fields_have_the_same_voxels_in_the_same_place(cloud, tmp_path):
    sparse_field().save(tmp_path / "sparse.vdb")
    opened = fp.Field.open(tmp_path / "sparse.vdb")
    assert opened.first_voxel != (0, 0, 0) or opened.shape == (40, 33, 50)
    for field in (cloud, sparse_field(), opened):
        copy = pickle.loads(pickle.dumps(field))
        assert copy.name == field.name and copy.first_voxel == field.first_voxel
        assert np.array_equal(copy.transform, field.transform)
        assert np.array_equal(copy.to_array(), field.to_array())
        assert copy._digest() == field._digest()
        assert copy.memory_bytes <= field.memory_bytes  # bricks of one value are stored once


def test_pickled_fields_of_bricks_far_apart_stay_small():
    voxels = np.random.default_rng(4).random((3, 512)).astype(np.float32)
    voxels[0] = 0
    coords = np.array([[0, 0, 0], [20_000, 3, 20_000]], np.int32)
    far = fp._field._field_of_bricks(
        "far", np.eye(4).tolist(), (0, 0, 0), (160_007, 31, 160_007), (-8, -8, -8), (20_003, 6, 20_003),
        True, coords, np.array([1, 2], np.uint32), voxels,
    )  # fmt: skip
    copy = pickle.loads(pickle.dumps(far))
    assert copy._digest() == far._digest() and copy.shape == (160_008, 32, 160_008)
    assert copy.memory_bytes < 100_000
    medium = fp.Medium(copy)
    rays = [[-5, 3.5, 3.5], [159_990, 27.5, 160_003.5]]
    through = fp.transmittance(medium, rays, [1.0, 0, 0], estimator="regular", interpolation="nearest")
    assert (through.mean < 1).all()


SCENES_TO_SEND = {
    "around": lambda cloud, folder: scene_around(cloud, ground=0.3, sun=(20, 30, 2), up="z"),
    "two components": lambda cloud, folder: fp.Scene.around(
        [fp.Component(cloud, phase="rayleigh"), fp.Component(sparse_field(), emission=[0.1, 0, 0])],
        size=SIZE,
    ),
    "text": lambda cloud, folder: fp.Scene.from_pbrt(TEXT, fov=50),
    "file": lambda cloud, folder: fp.Scene.from_pbrt("scene.pbrt", environment="sky.pfm"),
}
TEXT = """
LookAt 0 0 -5  0 0 0  0 1 0
Film "rgb" "integer xresolution" 12 "integer yresolution" 8
Camera "perspective" "float fov" 40
WorldBegin
LightSource "infinite" "rgb L" [ 0.4 0.5 0.6 ]
Shape "sphere" "float radius" 1.2
"""


@pytest.mark.parametrize("make", SCENES_TO_SEND.values(), ids=SCENES_TO_SEND.keys())
def test_pickled_scenes_give_the_same_bits_from_any_folder(cloud, tmp_path, monkeypatch, make):
    (tmp_path / "scene.pbrt").write_text(TEXT)
    fp.render(fp.Scene.around(cloud, size=(8, 4)), spp=1).save(tmp_path / "sky.pfm")
    monkeypatch.chdir(tmp_path)
    scene = make(cloud, tmp_path)
    data = pickle.dumps(scene)
    monkeypatch.chdir("/")
    copy = pickle.loads(data)
    ours, theirs = (fp.render(one, spp=2, seed=4) for one in (scene, copy))
    assert_same_bits(ours, theirs)
    assert ours.film.facts == theirs.film.facts


@pytest.mark.parametrize(
    "how, message",
    [
        ({"samples": (3, 3)}, "samples: end"),
        ({"samples": (-1, 3)}, "samples: first"),
        ({"samples": range(0, 8, 2)}, "samples: "),
        ({"samples": 3}, "samples: 3 is not"),
        ({"samples": (0, 3), "spp": 3}, "samples and spp both"),
        ({"samples": (0, 3), "time": 3}, "samples and time both"),
        ({"tile": (3, 2)}, "tile: number"),
        ({"tile": (0, 2)}, "tile: number"),
        ({"tile": 2}, "tile: 2 is not"),
        ({"tile": (1, 17)}, "17 tiles of 16 rows"),
        ({"tile": (1, 2), "noise": 0.1}, "noise and tile"),
    ],
    ids=str,
)
def test_parts_that_are_none_are_refused(scene, how, message):
    with pytest.raises(fp.Error, match=message):
        fp.render(scene, **how)
    with pytest.raises(fp.Error, match="extension"):
        fp.render(scene, samples=(0, 1)).film.save("film.exr")
