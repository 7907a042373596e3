"""Pictures: the same bits as the program's, what they hold, and how they are ended."""

import os
import signal
import subprocess
import threading

import numpy as np
import pytest

import freepath as fp


def read_pfm(path):
    """R, G and B of a PFM file, row 0 at the top."""
    with open(path, "rb") as file:
        assert file.readline() == b"PF\n"
        width, height = map(int, file.readline().split())
        scale = float(file.readline())
        values = np.frombuffer(file.read(), "<f4" if scale < 0 else ">f4")
    return values.reshape(height, width, 3)[::-1]


def run(program, *arguments):
    subprocess.run([program, *map(str, arguments)], check=True, capture_output=True)


SCENES = {
    "standard": ({}, {}, []),
    "methods": (
        {"camera": "spherical", "sun": (10, 90, 2), "environment": 0.5, "up": "z"},
        {"tracker": "weighted-decomposition", "estimator": "residual-ratio", "seed": 3},
        ["--camera", "spherical", "--sun", "10,90,2", "--environment", "0.5", "--up", "z",
         "--tracker", "weighted-decomposition", "--transmittance", "residual-ratio", "--seed", "3"],
    ),
    "ground, spectral": (
        {"ground": 0.4, "look_from": (9, 9, 9), "look_at": (2, 2, 3), "fov": 30},
        {"color": "spectral", "absorption": "analog", "interpolation": "trilinear"},
        ["--ground", "0.4", "--look-at", "9,9,9,2,2,3", "--fov", "30", "--color", "spectral",
         "--absorption", "analog", "--interpolation", "trilinear"],
    ),
    "periodic": ({"periodic": "xz"}, {"max_scatterings": 100}, ["--periodic", "x,z", "--max-scatterings", "100"]),
}  # fmt: skip


@pytest.mark.parametrize("around, how, arguments", SCENES.values(), ids=SCENES.keys())
def test_pictures_of_volumes_have_the_bits_of_the_programs(
    program, cloud, tmp_path, around, how, arguments
):
    cloud.save(tmp_path / "cloud.vdb")
    component = fp.Component(cloud, sigma_s=[0.5, 0.75, 1], sigma_a=0.125, phase=0.5, emission=0.25)
    picture = fp.render(fp.Scene.around(component, size=(24, 16), **around), spp=3, **how)
    run(
        program, "render", tmp_path / "cloud.vdb", "-o", tmp_path / "cloud.pfm", "--size", "24x16",
        "--spp", 3, "--sigma-s", "0.5,0.75,1", "--sigma-a", "0.125", "--g", "0.5", "--le", "0.25",
        *arguments,
    )  # fmt: skip
    assert np.array_equal(picture.image, read_pfm(tmp_path / "cloud.pfm"))


TEXT = """
LookAt 0 0 -5  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 20 "integer yresolution" 12
Sampler "sobol" "integer pixelsamples" 4 "integer seed" 2
Integrator "volpath" "integer maxdepth" 20
WorldBegin
LightSource "infinite" "rgb L" [ 0.4 0.5 0.6 ]
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [ 0.4 0.6 0.8 ] "rgb sigma_a" [ 0.1 0.1 0.1 ]
AttributeBegin
  MediumInterface "fog" ""
  Material "interface"
  Shape "sphere" "float radius" 1.2
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.5 0.2 0.1 ]
Translate 0 -1.5 0
Shape "sphere" "float radius" 0.3
"""


def test_pictures_of_scenes_have_the_bits_of_the_programs(program, tmp_path):
    (tmp_path / "scene.pbrt").write_text(TEXT)
    run(program, "render", tmp_path / "scene.pbrt", "-o", tmp_path / "scene.pfm")
    expected = read_pfm(tmp_path / "scene.pfm")
    scene = fp.Scene.from_pbrt(tmp_path / "scene.pbrt")
    assert scene.size == (20, 12) and scene.files == [str(tmp_path / "scene.pbrt")]
    picture = fp.render(scene)
    assert picture.stats["samples"] == 4 and picture.stats["seed"] == 2
    assert np.array_equal(picture.image, expected)
    assert np.array_equal(fp.render(fp.Scene.from_pbrt(TEXT)).image, expected)


def test_threads_and_instructions_do_not_change_a_picture(cloud):
    scene = fp.Scene.around(cloud, size=(20, 12))
    first = fp.render(scene, spp=2, threads=1, simd="one-lane").image
    for simd in fp.simd():
        assert np.array_equal(fp.render(scene, spp=2, threads=2, simd=simd).image, first)
    assert not np.array_equal(fp.render(scene, spp=2, seed=1).image, first)


def test_a_closed_volume_of_albedo_one_in_constant_light_is_not_seen(cloud):
    """Radiance 1 everywhere; the error is that which the picture tells of itself."""
    scene = fp.Scene.around(cloud, size=(32, 18), environment=1.0)
    picture = fp.render(scene, spp=64)
    error = np.sqrt(picture.variance.astype(float).sum((0, 1))) / picture.image[..., 0].size
    assert (np.abs(picture.image.astype(float).mean((0, 1)) - 1) < 5 * error + 1e-6).all()


def test_the_noise_asked_for_is_that_of_the_picture(cloud):
    scene = fp.Scene.around(cloud, size=(24, 18))
    picture = fp.render(scene, noise=0.02, seed=4)
    reached = np.sqrt(picture.variance.mean()) / picture.image.mean()
    assert 0.018 < reached < 0.021
    same = fp.render(scene, spp=picture.stats["samples"], seed=4)
    np.testing.assert_array_equal(same.image, picture.image)
    assert fp.render(scene, noise=1e-4, spp=3).stats["samples"] == 3


def test_layers_and_crops(cloud):
    scene = fp.Scene.around(cloud, size=(20, 12))
    picture = fp.render(scene, spp=2, layers="all")
    layers = picture.layers
    assert {"albedo", "depth", "variance", "normal", "position", "transmittance"} <= set(layers)
    assert layers["depth"].shape == (12, 20) and layers["albedo"].shape == (12, 20, 3)
    parts = sum(layers[name] for name in ("emission", "background", "direct", "indirect"))
    assert np.allclose(parts, picture.image, rtol=1e-5, atol=1e-5)
    assert picture.alpha.shape == (12, 20) and 0 < picture.alpha.max() <= 1
    part = fp.render(scene, spp=2, crop=(5, 2, 15, 10))
    assert np.array_equal(part.image, picture.image[2:10, 5:15])
    bare = fp.render(scene, spp=2, layers="none")
    assert not bare.layers and np.array_equal(bare.image, picture.image)
    with pytest.raises(ValueError, match="read-only"):
        picture.image[0, 0] = 0


def test_arrays_outlive_their_picture(cloud):
    image = fp.render(fp.Scene.around(cloud, size=(20, 12)), spp=1).image
    copy = image.copy()
    fp.render(fp.Scene.around(cloud, size=(40, 24)), spp=1)
    assert np.array_equal(image, copy)


def test_pictures_are_saved(cloud, tmp_path):
    picture = fp.render(fp.Scene.around(cloud, size=(20, 12)), spp=2)
    for name in ("a.exr", "a.png", "a.pfm", "a.qoi"):
        picture.save(tmp_path / name)
        assert (tmp_path / name).stat().st_size > 100
    assert np.array_equal(read_pfm(tmp_path / "a.pfm"), picture.image)
    assert picture.png()[:8] == b"\x89PNG\r\n\x1a\n" == picture._repr_png_()[:8]
    for name in ("a.jpg", "missing/a.png"):
        with pytest.raises(fp.Error, match=os.path.basename(name).replace(".", r"\.")):
            picture.save(tmp_path / name)


def test_images_light_a_scene(cloud, tmp_path):
    """The library of image formats is found from the installed module."""
    fp.render(fp.Scene.around(cloud, size=(20, 10)), spp=1).save(tmp_path / "sky.exr")
    scene = fp.Scene.around(cloud, size=(20, 12), environment=tmp_path / "sky.exr")
    assert fp.render(scene, spp=1).image.max() > 0


def test_progress_is_told_and_ends_a_rendering(cloud):
    scene = fp.Scene.around(cloud, size=(64, 36))
    told = []
    fp.render(scene, spp=2, progress=told.append)
    assert told[-1].samples == told[-1].total == 2
    thread = []

    def stop(progress):
        thread.append(threading.current_thread())
        return progress.samples < 1

    picture = fp.render(scene, time=300, progress=stop)
    assert picture.stats["interrupted"] and picture.stats["samples"] >= 1
    assert set(thread) == {threading.main_thread()}


def test_progress_shows_pictures(cloud):
    images = []

    def look(progress):
        if progress.image is not None:
            images.append(progress.image)
        return len(images) < 2

    fp.render(fp.Scene.around(cloud, size=(64, 36)), time=300, progress=look)
    assert images[0].shape == (36, 64, 3) and images[0].max() > 0


def test_what_progress_raises_ends_a_rendering(cloud):
    def fail(progress):
        raise RuntimeError("no more")

    with pytest.raises(RuntimeError, match="no more"):
        fp.render(fp.Scene.around(cloud, size=(64, 36)), time=300, progress=fail)


LONG = {
    "render": lambda cloud: fp.render(fp.Scene.around(cloud), time=300),
    "slab": lambda cloud: fp.slab(5, 0.99, paths=1e11),
    "flux": lambda cloud: fp.flux(cloud, paths=1e11),
    "transmittance": lambda cloud: fp.transmittance(cloud, [0, 2, 3], [1.0, 0, 0], samples=2**32 - 1),
}


@pytest.mark.parametrize("work", LONG.values(), ids=LONG.keys())
def test_ctrl_c_ends_long_work(cloud, work):
    # Python leaves Ctrl-C ignored where it is started so, as in the background of a script.
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            work(cloud)
        timer.join()
    finally:
        signal.signal(signal.SIGINT, handler)


def test_python_runs_while_a_picture_renders(cloud):
    """The lock is free: another thread counts meanwhile."""
    counted = 0
    is_done = threading.Event()

    def count():
        nonlocal counted
        while not is_done.is_set():
            counted += 1

    thread = threading.Thread(target=count)
    thread.start()
    before = counted
    fp.render(fp.Scene.around(cloud, size=(200, 100)), spp=8)
    gained = counted - before
    is_done.set()
    thread.join()
    assert gained > 1000


def test_scattering_limits_are_told_of():
    dense = fp.Field.from_array(np.full((8, 8, 8), 5.0))
    scene = fp.Scene.around(fp.Component(dense, sigma_s=1), size=(20, 12), environment=1.0)
    with pytest.warns(UserWarning, match="max_scatterings"):
        fp.render(scene, spp=4, max_scatterings=2)


def test_radiance_along_rays_of_ones_own_is_that_of_the_camera(cloud):
    """The rays of an orthographic camera, in constant light and a medium that only absorbs and glows:
    L = L_e (1 - T) + T."""
    medium = fp.Medium(fp.Component(cloud, sigma_s=0, sigma_a=1, emission=[2, 3, 4]))
    scene = fp.Scene.around(medium, environment=1.0)
    origins = np.stack(np.meshgrid(np.linspace(0, 4, 30), np.linspace(0, 5, 70), [-3.0]), -1)[:, :, 0]
    before = fp.render(scene, spp=1).image.copy()
    seen = fp.radiance(scene, origins, [0, 0, 2], spp=4096, interpolation="trilinear")
    assert seen.mean.shape == seen.error.shape == (70, 30, 3)
    through = fp.transmittance(
        medium, origins, [0, 0, 1], estimator="regular", samples=1, interpolation="trilinear"
    ).mean
    if through.ndim == 2:
        through = through[..., None]
    expected = np.array([2.0, 3, 4]) * (1 - through) + through
    z = (seen.mean - expected) / np.maximum(seen.error, 1e-6)
    assert np.abs(z).max() < 6 and 0.8 < z.std() < 1.2
    assert np.array_equal(fp.render(scene, spp=1).image, before)  # the camera is back


def test_rays_get_the_same_whatever_else_is_asked(cloud):
    scene = fp.Scene.around(cloud)
    origins = np.random.default_rng(1).random((1500, 3)) * 4
    everything = fp.radiance(scene, origins, [0, 1, 0], spp=2, threads=1)
    again = fp.radiance(scene, origins, [0, 1, 0], spp=2, threads=2)
    assert np.array_equal(everything.mean, again.mean)
    assert fp.radiance(scene, np.empty((0, 3)), [0, 1, 0]).mean.shape == (0, 3)
    with pytest.raises(fp.Error, match="ray 1: its direction"):
        fp.radiance(scene, [0, 0, 0], [[0, 1.0, 0], [0, 0, 0]])


BAD_SCENES = {
    "camera": (dict(camera="fisheye"), "perspective, orthographic, spherical"),
    "size": (dict(size=(0, 10)), "width: 0"),
    "one size": (dict(size=10), "size"),
    "up": (dict(up="x"), "there are: y, z"),
    "sun": (dict(sun=(1,)), "elevation and azimuth"),
    "high sun": (dict(sun=(100, 0)), "elevation"),
    "turbidity": (dict(turbidity=1), "turbidity"),
    "environment": (dict(environment=-1.0), "radiance"),
    "no image": (dict(environment="missing.exr"), "missing.exr"),
    "fov": (dict(fov=180), "180"),
    "ground": (dict(ground=2.0), "albedo"),
    "height": (dict(ground_height=2.0), "albedo"),
    "axes": (dict(periodic="w"), "axes are x, y and z"),
    "domain": (dict(domain=([0, 0, 0], [1, 1, 1])), "periodic"),
}


@pytest.mark.parametrize("options, message", BAD_SCENES.values(), ids=BAD_SCENES.keys())
def test_bad_scenes_have_one_clear_error(cloud, options, message):
    with pytest.raises(fp.Error, match=message):
        fp.Scene.around(cloud, **options)


def test_media_that_scenes_do_not_take_are_refused(cloud):
    with pytest.raises(fp.Error, match="2 channels"):
        fp.Scene.around(fp.Component(cloud, sigma_s=[1, 2]))
    with pytest.raises(fp.Error, match="optical depth"):
        fp.Scene.around(fp.Component(cloud, sigma_s=1e8))


BAD_RENDERS = {
    "spp": (dict(spp=0), "spp"),
    "time": (dict(time=-1), "time"),
    "color": (dict(color="cmyk"), "rgb, spectral"),
    "layers": (dict(layers="depht"), "depth"),
    "crop": (dict(crop=(0, 0, 100, 100)), "100"),
    "tracker": (dict(tracker="dleta"), "delta"),
    "estimator": (dict(estimator="ration"), "ratio"),
    "interpolation": (dict(interpolation="cubic"), "stochastic"),
    "wavelengths": (dict(wavelengths=0), "wavelengths"),
}


@pytest.mark.parametrize("options, message", BAD_RENDERS.values(), ids=BAD_RENDERS.keys())
def test_bad_renderings_have_one_clear_error(cloud, options, message):
    with pytest.raises(fp.Error, match=message):
        fp.render(fp.Scene.around(cloud, size=(20, 12)), **options)


def test_bad_files_have_one_clear_error(tmp_path):
    with pytest.raises(fp.Error, match="missing.pbrt"):
        fp.Scene.from_pbrt(tmp_path / "missing.pbrt")
    with pytest.raises(fp.Error, match="^mine:2:1: "):
        fp.Scene.from_pbrt("\nWorldBegun\n", name="mine")
    with pytest.raises(TypeError, match="Scene"):
        fp.render("scene.pbrt")
