"""A scene of bench/peers in Mitsuba 3; arguments: VARIANT THREADS."""

import sys

import drjit as dr
import mitsuba as mi
import numpy as np
from worker import serve, write_pfm


def load(scene):
    mi.set_variant(sys.argv[1])
    dr.set_thread_count(int(sys.argv[2]))
    if any(scene["emission"]):
        raise SystemExit("Mitsuba's heterogeneous media do not emit")
    low, high = (np.array(corner) for corner in scene["bounds"])
    density = np.fromfile(scene["raw"], "<f4").reshape(*scene["voxels"][::-1], 1)
    sigma_s, sigma_a = np.array(scene["sigma_s"]), np.array(scene["sigma_a"])
    sigma_t = sigma_s + sigma_a
    chromatic = len(set(sigma_t)) > 1
    box = mi.ScalarTransform4f().translate(list(low)).scale(list(high - low))
    medium = {
        "type": "heterogeneous",
        "sigma_t": {
            "type": "gridvolume",
            "grid": mi.VolumeGrid(
                (density * (sigma_t if chromatic else sigma_t[:1])).astype(np.float32)
            ),
            "to_world": box,
            "raw": True,
        },
        "albedo": {
            "type": "constvolume",
            "value": {"type": "rgb", "value": list(sigma_s / sigma_t)},
        },
        "phase": {"type": "hg", "g": scene["g"]} if scene["g"] else {"type": "isotropic"},
        "has_spectral_extinction": chromatic,
    }
    width, height = scene["size"]
    description = {
        "type": "scene",
        # Roulette from the first scatterings on ends paths of bright clouds for nothing.
        "integrator": {
            "type": "volpathmis" if chromatic else "volpath",
            "max_depth": -1,
            "rr_depth": 1000,
        },
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
            "interior": medium,
        },
    }
    if any(scene["sun"]):
        description["sun"] = {
            "type": "directional",
            "direction": [-x for x in scene["to_sun"]],
            "irradiance": {"type": "rgb", "value": scene["sun"]},
        }
    loaded = mi.load_dict(description)

    def render(spp, seed):
        picture = np.array(mi.render(loaded, spp=spp, seed=seed))
        return lambda path: write_pfm(path, picture[::-1, :, :3])

    return f"Mitsuba {mi.__version__}, {sys.argv[1]}", render


serve(load)
