"""Clouds as models write them, in NetCDF files.

usage: clouds.py FOLDER: puts classic.nc and netcdf4.nc there, and extinction.npy, what they mean.
"""

import sys
from pathlib import Path

import numpy as np
import xarray as xr

ENGINES = {"classic": "scipy", "netcdf4": "h5netcdf"}


def write_cloud(path, kind):
    """Write liquid water [g/m³] and effective radii [µm] on samples 50, 25 and 40 m apart.

    Returns:
        The extinction 3/2 LWC/(ρ_w r_e) [1/m], of shape (x, y, z).
    """
    water = 0.1 + np.random.default_rng(2).random((4, 3, 5))
    radius = 5.0 + np.arange(4)
    meters = {"units": "m"}
    xr.Dataset(
        {
            "lwc": (("z", "y", "x"), water, {"units": "g m-3"}),
            "re": (("z",), radius, {"units": "um"}),
        },
        {
            "x": ("x", 50.0 * np.arange(5), meters),
            "y": ("y", 25.0 * np.arange(3), meters),
            "z": ("z", 300 + 40.0 * np.arange(4), meters),
        },
    ).to_netcdf(path, engine=ENGINES[kind])
    return (1.5 * 1e-3 * water / (1000 * 1e-6 * radius[:, None, None])).transpose(2, 1, 0)


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    for kind in ENGINES:
        np.save(folder / "extinction.npy", write_cloud(folder / f"{kind}.nc", kind))
