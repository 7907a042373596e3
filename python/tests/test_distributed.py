"""Pictures on Dask: the bits of one process, whatever becomes of the workers."""

import os
import signal
import sys

import numpy as np
import pytest

import freepath as fp
import freepath.distributed
from test_films import TEXT, assert_same_bits, scene_around
from test_studies import without_times

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
    for noise, spp, fewest in ((0.2, 50, 3), (0.05, None, 50), (0.01, 7, 7)):
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
    monkeypatch.setattr(freepath._cluster, "version", "0.0.1")
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


def test_a_sweep_of_suns_has_the_bits_of_one_process(cluster, client, cloud):
    medium = fp.Component(cloud, sigma_s=0.8, sigma_a=0.1, phase=0.6)
    suns = [(zenith, azimuth) for zenith in (0, 40, 70) for azimuth in (0, 90)]
    how = {"paths": 4000, "seed": 2, "columns": (2, 5), "views": [(0, 0)], "ground": 0.2}
    killed = []

    def kill(number, fluxes):
        busy = {address for address, tasks in client.processing().items() if tasks}
        for worker in cluster.workers.values():
            if not killed and worker.worker_address in busy:
                os.kill(worker.pid, signal.SIGKILL)
                killed.append(worker.pid)

    swept = freepath.distributed.flux_sweep(medium, client, suns, on_result=kill, **how)
    assert len(swept) == len(suns)
    for sun, theirs in zip(suns, swept):
        ours = fp.flux(medium, sun=sun, **how)
        assert theirs.reflectance.all == ours.reflectance.all
        for name in ("reflectance", "transmittance", "absorptance"):
            one, other = getattr(theirs, name).columns, getattr(ours, name).columns
            assert np.array_equal(one.mean, other.mean) and np.array_equal(one.error, other.error)
        assert np.array_equal(theirs.radiances[0].columns.mean, ours.radiances[0].columns.mean)


def test_a_sweep_is_ended_and_refused(client, cloud):
    sweep = freepath.distributed.flux_sweep
    some = sweep(cloud, client, [(z, 0) for z in range(0, 80, 5)], paths=100, on_result=lambda *_: False)
    assert len(some) == 16 and sum(fluxes is not None for fluxes in some) == 1
    assert sweep(cloud, client, []) == []
    with pytest.raises(fp.Error, match="suns"):
        sweep(cloud, client, [(0, 0), (95, 0)])
    with pytest.raises(fp.Error, match="there is no method 'dleta'"):
        sweep(cloud, client, [(0, 0)], tracker="dleta")
    with pytest.raises(TypeError, match="sun: not on a cluster"):
        sweep(cloud, client, [(0, 0)], sun=(0, 0))
    with pytest.raises(TypeError, match=r"flux_sweep\(\) has no argument 'path'"):
        sweep(cloud, client, [(0, 0)], path=3)


def test_comparisons_have_the_numbers_of_one_process(client, scene):
    how = {
        "trackers": ["delta", "decomposition"], "spp": 16, "repeats": 4, "reference_spp": 32,
        "seed": 5, "crop": (3, 2, 40, 30),
    }  # fmt: skip
    seen = []
    found = freepath.distributed.compare(scene, client, on_result=seen.append, **how)
    whole = fp.compare(scene, **how)
    assert without_times(found.data) == without_times(whole.data)
    assert [len(part.data["configurations"][0]["runs"]) for part in seen] == [1, 2, 3]
    some = freepath.distributed.compare(scene, client, on_result=lambda part: False, **how)
    assert len(some.runs) == 2


def test_comparisons_measure_against_files_of_the_client(client, scene, tmp_path):
    fp.render(scene, spp=32, seed=9, layers="variance").save(tmp_path / "reference.exr")
    how = {"trackers": "delta", "spp": 8, "repeats": 2, "reference": tmp_path / "reference.exr"}
    found = freepath.distributed.compare(scene, client, **how)
    assert without_times(found.data) == without_times(fp.compare(scene, **how).data)
    with pytest.raises(fp.Error, match="there is no method 'dleta'"):
        freepath.distributed.compare(scene, client, trackers="dleta")
    with pytest.raises(TypeError, match="cache: not on a cluster"):
        freepath.distributed.compare(scene, client, cache=tmp_path)
    with pytest.raises(TypeError, match=r"compare\(\) has no argument 'sp'"):
        freepath.distributed.compare(scene, client, sp=3)


def test_without_dask_the_error_says_what_to_install(monkeypatch, scene):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(fp.Error, match=r"pip install 'freepath\[distributed\]'"):
        freepath.distributed.render(scene, None)
