"""What scripts/wheel tries of an installed wheel, by NumPy alone, on a machine that has nothing else.

usage: wheel_trial.py FOLDER: with the files of clouds.py.
"""

import sys
from pathlib import Path

import numpy as np

import freepath as fp


def try_wheel(folder):
    field = fp.Field.from_array(np.ones((8, 8, 8)), voxel_size=0.125)
    mean, error, _ = fp.transmittance(field, [-1, 0.5, 0.5], [1.0, 0, 0], samples=100_000)
    assert abs(mean - np.exp(-1)) < 5 * error + 1e-3, (mean, error)
    for name in ("field.vdb", "field.nvdb", "field.vti"):
        field.save(name)
        assert np.array_equal(fp.Field.open(name).to_array(), field.to_array()), name
    expected = np.load(folder / "extinction.npy")
    for name in ("classic.nc", "netcdf4.nc"):
        cloud = fp.Field.open(folder / name, grid="extinction")
        assert np.allclose(cloud.to_array(), expected, rtol=1e-6), name
    picture = fp.render(fp.Scene.around(field, size=(32, 18)), spp=4)
    for name in ("picture.exr", "picture.png"):  # images are read by a library of their own
        picture.save(name)
        sky = fp.Scene.around(field, size=(32, 18), environment=name)
        assert fp.render(sky, spp=1).image.max() > 0, name


def print_libraries():
    """Tell what was loaded that the wheel, NumPy or Python has not brought."""
    mapped = {line.split()[-1] for line in open("/proc/self/maps") if ".so" in line}
    system = {Path(path).name for path in mapped if path.startswith(("/usr/lib/", "/lib"))}
    print("of the system it uses", ", ".join(sorted(system)))


if __name__ == "__main__":
    try_wheel(Path(sys.argv[1]))
    print_libraries()
