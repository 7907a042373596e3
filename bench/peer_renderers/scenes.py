"""Scenes that every renderer is given the same: a cloud of `freepath generate`, lights, a camera.

A scene is a plain dict, so that it reaches the workers as JSON. Coordinates are right-handed;
radiance and irradiance are linear RGB; a density of 1 has the cross sections that the scene says
[1/unit].
"""

import array
import json
import re
import subprocess
from pathlib import Path

CAMERA = {"eye": [0, 42, 165], "target": [0, 28, 0], "fov": 33}
TO_SUN = [0.6, 1.0, 0.5]

SCENES = {
    "white_sky": {
        "about": "albedo 0.95, isotropic, constant white sky",
        "sigma_s": [0.95] * 3,
        "sigma_a": [0.05] * 3,
        "g": 0,
        "sky": [1, 1, 1],
    },
    "sun_sky": {
        "about": "albedo 0.999, g 0.8, sun and constant blue sky",
        "sigma_s": [0.999] * 3,
        "sigma_a": [0.001] * 3,
        "g": 0.8,
        "sky": [0.32, 0.48, 0.80],
        "sun": [2.6, 2.418, 2.132],
    },
    "chromatic": {
        "about": "red scatters, blue absorbs; sun and weak sky",
        "sigma_s": [0.8, 0.2, 0.05],
        "sigma_a": [0.004, 0.04, 0.2],
        "g": 0,
        "sky": [0.25] * 3,
        "sun": [6, 6, 6],
    },
    "glow": {
        "about": "albedo 0.5, g 0.3, emits like fire, weak sky",
        "sigma_s": [0.4] * 3,
        "sigma_a": [0.4] * 3,
        "g": 0.3,
        "sky": [0.02, 0.025, 0.03],
        "emission": [9, 3, 0.5],
        "largest_resolution": 64,
    },
}


def make(name, freepath, folder, resolution, size):
    """The scene of that name, with its volume and its pbrt file written into `folder`."""
    scene = {"name": name, "sun": [0, 0, 0], "emission": [0, 0, 0], "to_sun": TO_SUN, **CAMERA}
    scene |= SCENES[name] | {"size": size}
    resolution = min(resolution, scene.get("largest_resolution", resolution))
    stem = folder / f"cloud{resolution}"
    run(freepath, "generate", "cloud", "-o", f"{stem}.vdb", "--resolution", resolution)
    for suffix in ("nvdb", "vti"):
        run(freepath, "convert", f"{stem}.vdb", f"{stem}.{suffix}")
    scene |= dense(Path(f"{stem}.vti"), Path(f"{stem}.raw")) | {"vdb": f"{stem}.vdb"}
    scene["pbrt"] = str(folder / f"{name}.pbrt")
    Path(scene["pbrt"]).write_text(pbrt_text(scene, f"{stem}.nvdb"))
    return scene


def run(*words):
    subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL)


def dense(vti, raw):
    """Writes a VTI file's floats, x fastest, with a border of zeros, beyond which there is nothing.

    The border makes what interpolates between voxels fall off alike everywhere.
    """
    content = vti.read_bytes()
    header, data = content.split(b'<AppendedData encoding="raw">\n_', 1)
    words = {
        key: re.search(f'{key}="([^"]*)"'.encode(), header)[1].split()
        for key in ("WholeExtent", "Origin", "Spacing")
    }
    low, high = [[int(word) for word in words["WholeExtent"][i::2]] for i in (0, 1)]
    nx, ny, nz = (b - a + 1 for a, b in zip(low, high))
    values = array.array("f", data[8 : 8 + 4 * nx * ny * nz])
    padded = array.array("f", bytes(4 * (nx + 2) * (ny + 2)))
    for z in range(nz):
        padded.extend([0.0] * (nx + 2))
        for y in range(ny):
            row = nx * (y + ny * z)
            padded.extend([0.0, *values[row : row + nx], 0.0])
        padded.extend([0.0] * (nx + 2))
    padded.extend([0.0] * ((nx + 2) * (ny + 2)))
    raw.write_bytes(padded.tobytes())
    origin, spacing = ([float(word) for word in words[key]] for key in ("Origin", "Spacing"))
    voxels = [nx + 2, ny + 2, nz + 2]
    corner = [o + s * (a - 1.5) for o, s, a in zip(origin, spacing, low)]
    bounds = [corner, [c + s * n for c, s, n in zip(corner, spacing, voxels)]]
    return {"raw": str(raw), "voxels": voxels, "bounds": bounds}


def pbrt_text(scene, nvdb):
    """The scene in pbrt-v4's format; mirrored, as pbrt's coordinates are left-handed."""

    def rgb(values):
        return "[ " + " ".join(f"{value:g}" for value in values) + " ]"

    (x0, y0, z0), (x1, y1, z1) = scene["bounds"]
    corners = [f"{x:.9g} {y:.9g} {z:.9g}" for z in (z0, z1) for y in (y0, y1) for x in (x0, x1)]
    width, height = scene["size"]
    sections = f'"rgb sigma_a" {rgb(scene["sigma_a"])} "rgb sigma_s" {rgb(scene["sigma_s"])}'
    if len(set(scene["sigma_a"])) == len(set(scene["sigma_s"])) == 1:
        grey = [scene["sigma_a"][0], scene["sigma_s"][0]]
        sections = " ".join(
            f'"spectrum {name}" [ 300 {value:g} 900 {value:g} ]'
            for name, value in zip(("sigma_a", "sigma_s"), grey)
        )
    sections += f' "float scale" 1 "float g" {scene["g"]}'
    if any(scene["emission"]):
        density = array.array("f", Path(scene["raw"]).read_bytes())
        counts = " ".join(f'"integer n{axis}" {n}' for axis, n in zip("xyz", scene["voxels"]))
        medium = (
            f'"string type" "uniformgrid" {counts} "point3 p0" [ {corners[0]} ]'
            f' "point3 p1" [ {corners[-1]} ] {sections} "rgb Le" {rgb(scene["emission"])}\n'
            f'  "float density" [ {" ".join(f"{value:.9g}" for value in density)} ]'
        )
    else:
        medium = f'"string type" "nanovdb" "string filename" {json.dumps(nvdb)} {sections}'
    sun = ""
    if any(scene["sun"]):
        sun = (
            f'LightSource "distant" "point3 from" {rgb(scene["to_sun"])} "point3 to" [ 0 0 0 ]'
            f' "rgb L" {rgb(scene["sun"])}\n'
        )
    return f"""# {scene["name"]}: {scene["about"]}; written by bench/peers
Film "rgb" "integer xresolution" {width} "integer yresolution" {height} "string filename" "picture.pfm"
Sampler "independent" "integer pixelsamples" 64
PixelFilter "box" "float xradius" 0.5 "float yradius" 0.5
Integrator "volpath" "integer maxdepth" 100000
Scale -1 1 1
LookAt {' '.join(str(x) for x in scene["eye"])}  {' '.join(str(x) for x in scene["target"])}  0 1 0
Camera "perspective" "float fov" {scene["fov"]}
WorldBegin
LightSource "infinite" "rgb L" {rgb(scene["sky"])}
{sun}MakeNamedMedium "vol" {medium}
AttributeBegin
  Material "interface"
  MediumInterface "vol" ""
  Shape "trianglemesh" "point3 P" [ {"  ".join(corners)} ]
    "integer indices" [ 0 2 3 0 3 1  4 5 7 4 7 6  0 1 5 0 5 4  2 6 7 2 7 3  0 4 6 0 6 2  1 3 7 1 7 5 ]
AttributeEnd
"""
