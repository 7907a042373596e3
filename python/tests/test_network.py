"""Workers behind networks of their own, which nothing but a bridge joins to the scheduler."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("distributed")

WORKERS = 2


def ip(*words):
    subprocess.run(["ip", *words], check=True, capture_output=True, text=True)


def build_networks():
    """A bridge in this network, and for each worker a network with one way out, to the bridge.

    Returns:
        Processes that keep the networks alive.
    """
    ip("link", "set", "lo", "up")
    ip("link", "add", "bridge", "type", "bridge")
    ip("addr", "add", "10.77.0.1/24", "dev", "bridge")
    ip("link", "set", "bridge", "up")
    keepers = []
    for i in range(WORKERS):
        # It tells once it has a network of its own.
        keeper = subprocess.Popen(
            ["unshare", "--net", "sh", "-c", "echo there; exec sleep 600"], stdout=subprocess.PIPE
        )
        keepers.append(keeper)
        assert keeper.stdout.readline() == b"there\n"
        ip("link", "add", f"out{i}", "type", "veth", "peer", "name", f"in{i}")
        ip("link", "set", f"out{i}", "master", "bridge", "up")
        ip("link", "set", f"in{i}", "netns", str(keeper.pid))
        for words in (
            ["link", "set", "lo", "up"],
            ["addr", "add", f"10.77.0.{10 + i}/24", "dev", f"in{i}"],
            ["link", "set", f"in{i}", "up"],
        ):
            subprocess.run(inside(keeper, "ip", *words), check=True)
    return keepers


def inside(keeper, *command):
    return ["nsenter", "--net", "--target", str(keeper.pid), *command]


def render_over_the_network():
    """What runs in the scheduler's network."""
    import numpy as np
    from distributed import Client, LocalCluster

    import freepath as fp
    import freepath.distributed

    field = fp.Field.from_array(np.random.default_rng(7).random((4, 5, 6)))
    scene = fp.Scene.around(field, size=(32, 20))
    keepers = build_networks()
    workers = []
    try:
        with LocalCluster(
            n_workers=0, host="10.77.0.1", dashboard_address=None
        ) as cluster, Client(cluster) as client:
            for i, keeper in enumerate(keepers):
                command = [sys.executable, "-m", "distributed.cli.dask_worker", "--nthreads", "1",
                           "--host", f"10.77.0.{10 + i}", "--no-dashboard", "--no-nanny",
                           "--local-directory", os.getcwd(), cluster.scheduler_address]  # fmt: skip
                workers.append(subprocess.Popen(inside(keeper, *command)))
            client.wait_for_workers(WORKERS, timeout=120)
            addresses = {address.split("/")[2].split(":")[0] for address in client.nthreads()}
            assert addresses == {f"10.77.0.{10 + i}" for i in range(WORKERS)}, addresses
            far = freepath.distributed.render(scene, client, spp=12, parts=6, seed=4)
            near = fp.render(scene, spp=12, seed=4)
            assert np.array_equal(far.image, near.image)
            suns = [(0, 0), (60, 0)]
            swept = freepath.distributed.flux_sweep(field, client, suns, paths=2000)
            assert [s.reflectance.all for s in swept] == [
                fp.flux(field, sun=sun, paths=2000).reflectance.all for sun in suns
            ]
    finally:
        for process in workers + keepers:
            process.kill()
            process.wait()
    print("the same bits from", *sorted(addresses))


def test_workers_in_networks_of_their_own_give_the_bits_of_one_process(tmp_path):
    for tool in ("unshare", "nsenter", "ip"):
        if shutil.which(tool) is None:
            pytest.skip(f"there is no {tool}")
    probe = "ip link add name out type veth peer name in && ip link add name between type bridge"
    if subprocess.run(["unshare", "--net", "sh", "-c", probe], capture_output=True).returncode:
        pytest.skip("networks of one's own are not permitted here")
    # The networks go with the processes; those of the machine are not touched.
    done = subprocess.run(
        ["unshare", "--net", sys.executable, str(Path(__file__))],
        cwd=tmp_path, capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "the same bits from 10.77.0.10 10.77.0.11" in done.stdout


if __name__ == "__main__":
    render_over_the_network()
