"""A scene of bench/peers in Mitsuba 3; arguments: VARIANT THREADS."""

import sys

import drjit as dr
import mitsuba as mi
import numpy as np
from worker import serve, write_pfm


def medium_of(scene, sigma_s, sigma_t, box):
    """Medium of one extinction for all channels [1/unit of density]."""
    density = np.fromfile(scene["raw"], "<f4").reshape(*scene["voxels"][::-1], 1)
    return {
        "type": "heterogeneous",
        "sigma_t": {
            "type": "gridvolume",
            "grid": mi.VolumeGrid((density * sigma_t).astype(np.float32)),
            "to_world": box,
            "raw": True,
        },
        "albedo": {
            "type": "constvolume",
            "value": {
                "type": "rgb",
                "value": [min(float(value), 1) for value in sigma_s / sigma_t],
            },
        },
        "phase": {"type": "hg", "g": scene["g"]} if scene["g"] else {"type": "isotropic"},
        "has_spectral_extinction": False,
    }


def description_of(scene, sigma_s, sigma_t):
    low, high = (np.array(corner) for corner in scene["bounds"])
    box = mi.ScalarTransform4f().translate(list(low)).scale(list(high - low))
    width, height = scene["size"]
    description = {
        "type": "scene",
        # Roulette from the first scatterings on ends paths of bright clouds for nothing.
        "integrator": {"type": "volpath", "max_depth": -1, "rr_depth": 1000},
        "sensor": {
            "type": "perspective",
            "fov": scene["fov"],
            "fov_axis": "smaller",
            "to_world": mi.ScalarTransform4f().look_at(scene["eye"], scene["target"], [0, 1, 0]),
            "film": {
                "type": "hdrfilm",
                "width": width,
                "height": height,
                "pixel_format": "rgb",
                "component_format": "float32",
                "rfilter": {"type": "box"},
            },
            "sampler": {"type": "independent"},
        },
        "sky": {"type": "constant", "radiance": {"type": "rgb", "value": scene["sky"]}},
        # The cube reaches from -1 to 1, the grid from 0 to 1.
        "cloud": {
            "type": "cube",
            "to_world": box.translate([0.5] * 3).scale([0.5] * 3),
            "bsdf": {"type": "null"},
            "interior": medium_of(scene, sigma_s, sigma_t, box),
        },
    }
    if any(scene["sun"]):
        description["sun"] = {
            "type": "directional",
            "direction": [-x for x in scene["to_sun"]],
            "irradiance": {"type": "rgb", "value": scene["sun"]},
        }
    return description


def load(scene):
    mi.set_variant(sys.argv[1])
    dr.set_thread_count(int(sys.argv[2]))
    if any(scene["emission"]):
        raise SystemExit("Mitsuba's heterogeneous media do not emit")
    sigma_s = np.array(scene["sigma_s"])
    sigma_t = sigma_s + np.array(scene["sigma_a"])
    # Where extinctions differ much, volpath and volpathmis lost 5 to 8 % of the red of a cloud
    # at 48 samples, by noise or bias. So each channel is rendered by itself, which serves best.
    chromatic = len(set(sigma_t)) > 1
    loaded = [
        mi.load_dict(description_of(scene, sigma_s, value))
        for value in (sigma_t if chromatic else sigma_t[:1])
    ]

    def render(spp, seed):
        pictures = [
            np.array(mi.render(one, spp=spp, seed=3 * seed + i)) for i, one in enumerate(loaded)
        ]
        picture = pictures[0][:, :, :3]
        for channel in range(1, len(pictures)):
            picture[:, :, channel] = pictures[channel][:, :, channel]
        return lambda path: write_pfm(path, picture[::-1])

    return f"Mitsuba {mi.__version__}, {sys.argv[1]}", render


serve(load)
