"""Pictures on Dask: the bits of one process, whatever becomes of the workers."""

import os
import signal
import sys

import numpy as np
import pytest

import freepath as fp
import freepath.distributed
from test_films import TEXT, assert_same_bits, scene_around

distributed = pytest.importorskip("distributed")


@pytest.fixture(scope="module")
def cluster():
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, processes=True
    ) as cluster:
        yield cluster


@pytest.fixture
def client(cluster):
    with distributed.Client(cluster) as client:
        client.wait_for_workers(2, timeout=60)
        yield client


@pytest.fixture
def scene(cloud):
    return scene_around(cloud, size=(48, 32))


def test_a_cluster_gives_the_bits_of_one_process(client, scene):
    how = {"seed": 3, "layers": "all", "crop": (3, 2, 40, 30), "tracker": "weighted-delta"}
    seen = []
    picture = freepath.distributed.render(
        scene, client, spp=23, parts=7, on_result=lambda part: seen.append(part), **how
    )
    whole = fp.render(scene, spp=23, **how)
    assert_same_bits(picture, whole)
    assert picture.film.facts == whole.film.facts
    assert picture.stats["paths"] == whole.stats["paths"]
    # Pictures so far, of more and more samples: 23 in seven parts are three or four each.
    counts = [part.stats["samples"] for part in seen]
    assert len(counts) == 6 and np.all(np.diff([0, *counts, 23]) >= 3)


def test_a_noise_takes_the_samples_of_one_process(client, scene):
    for noise, spp, fewest in ((0.2, 50, 3), (0.05, None, 100), (0.01, 7, 7)):
        picture = freepath.distributed.render(scene, client, noise=noise, spp=spp, parts=5)
        whole = fp.render(scene, noise=noise, spp=spp)
        assert fewest <= whole.stats["samples"] < 1000
        assert_same_bits(picture, whole)


def test_a_scene_of_a_file_has_its_own_samples_and_is_read_where_the_worker_is(client, tmp_path):
    path = tmp_path / "scene.pbrt"
    path.write_text(TEXT.replace("WorldBegin", 'Sampler "sobol" "integer pixelsamples" 6\nWorldBegin'))
    scene = fp.Scene.from_pbrt(path)
    picture = freepath.distributed.render(scene, client)
    assert picture.stats["samples"] == 6
    assert_same_bits(picture, fp.render(scene))


def test_a_worker_whose_files_are_others_is_found_out(client, tmp_path):
    path = tmp_path / "scene.pbrt"
    path.write_text(TEXT)
    scene = fp.Scene.from_pbrt(path)
    scene._facts()
    path.write_text(TEXT + "# another\n")
    with pytest.raises(fp.Error, match="another scene: the content of scene.pbrt is"):
        freepath.distributed.render(scene, client, spp=2)


def test_a_worker_of_another_version_is_found_out(client, scene, monkeypatch):
    monkeypatch.setattr(freepath.distributed, "version", "0.0.1")
    with pytest.raises(fp.Error, match="a worker has freepath .* and not 0.0.1"):
        freepath.distributed.render(scene, client, spp=2)


def test_killed_workers_cost_no_bit(cluster, client, scene):
    """The first result ends a worker by SIGKILL, in the middle of the next part of its own."""
    whole = fp.render(scene, spp=240, seed=8)
    killed = []

    def kill(picture):
        busy = {address for address, tasks in client.processing().items() if tasks}
        for worker in cluster.workers.values():
            if not killed and worker.worker_address in busy:
                os.kill(worker.pid, signal.SIGKILL)
                killed.append(worker.pid)

    picture = freepath.distributed.render(scene, client, spp=240, parts=24, seed=8, on_result=kill)
    assert killed
    assert_same_bits(picture, whole)


def test_a_rendering_that_its_watcher_ends_has_the_samples_so_far(client, scene):
    picture = freepath.distributed.render(
        scene, client, spp=64, parts=32, on_result=lambda part: part.stats["samples"] < 4
    )
    assert 4 <= picture.stats["samples"] < 64
    with pytest.raises(ZeroDivisionError):
        freepath.distributed.render(scene, client, spp=8, on_result=lambda part: 1 / 0)
    # What was cancelled is in nobody's way.
    assert freepath.distributed.render(scene, client, spp=2).stats["samples"] == 2


def test_what_can_not_be_is_told_before_anything_is_sent(client, scene, cloud):
    render = freepath.distributed.render
    with pytest.raises(fp.Error, match="there is no method 'dleta'"):
        render(scene, client, tracker="dleta")
    with pytest.raises(fp.Error, match="parts"):
        render(scene, client, parts=0)
    with pytest.raises(TypeError, match="no argument 'sp'"):
        render(scene, client, sp=3)
    with pytest.raises(TypeError, match="time: not on a cluster"):
        render(scene, client, time=3)
    with pytest.raises(TypeError, match="client: str is no dask.distributed.Client"):
        render(scene, "localhost")
    density = fp.DensityFunction(lambda p: p[:, 0], [0, 0, 0], [1, 1, 1], bounds=(0, 1))
    with pytest.raises(fp.Error, match="bake it first"):
        render(fp.Scene.around(density, size=(8, 6)), client)


def test_without_dask_the_error_says_what_to_install(monkeypatch, scene):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(fp.Error, match=r"pip install 'freepath\[distributed\]'"):
        freepath.distributed.render(scene, None)
