"""A scene of bench/peers in Blender's Cycles; argument: THREADS."""

import math
import os
import sys
import tempfile

import bpy
import mathutils
import numpy as np
from worker import serve, write_pfm


def settle(scene, size):
    """Settings without bias: no clamps, no thresholds, as many bounces as there may be."""
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    # Where data persist, another seed alone is not noticed, and the old picture stays. So every
    # picture loads anew, alike for one sample and for many, whose difference counts.
    scene.render.use_persistent_data = False
    scene.render.threads_mode, scene.render.threads = "FIXED", int(sys.argv[1])
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.light_sampling_threshold = 0
    cycles.max_bounces = cycles.volume_bounces = cycles.transparent_max_bounces = 1024
    cycles.volume_biased = False


def add_cloud(description):
    volume = bpy.data.volumes.new("cloud")
    volume.filepath = description["vdb"]
    volume.render.precision = "FULL"
    material = bpy.data.materials.new("cloud")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    density = nodes.new("ShaderNodeAttribute")
    density.attribute_name = "density"
    medium = nodes.new("ShaderNodeVolumeCoefficients")
    medium.inputs["Anisotropy"].default_value = description["g"]
    # Emission is what a unit of length emits, sigma_a times L_e.
    emission = [s * e for s, e in zip(description["sigma_a"], description["emission"])]
    for name, value in (
        ("Absorption", description["sigma_a"]),
        ("Scatter", description["sigma_s"]),
        ("Emission", emission),
    ):
        product = nodes.new("ShaderNodeVectorMath")
        product.operation = "SCALE"
        product.inputs[0].default_value = value
        links.new(density.outputs["Fac"], product.inputs["Scale"])
        links.new(product.outputs["Vector"], medium.inputs[f"{name} Coefficients"])
    output = nodes.new("ShaderNodeOutputMaterial")
    links.new(medium.outputs[0], output.inputs["Volume"])
    volume.materials.append(material)
    bpy.context.collection.objects.link(bpy.data.objects.new("cloud", volume))


def add_lights(description):
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = [*description["sky"], 1]
    bpy.context.scene.world = world
    if any(description["sun"]):
        light = bpy.data.lights.new("sun", "SUN")
        light.angle, light.energy = 0, max(description["sun"])
        light.color = [value / light.energy for value in description["sun"]]
        sun = bpy.data.objects.new("sun", light)
        # Suns shine along their own -z.
        sun.rotation_mode = "QUATERNION"
        sun.rotation_quaternion = mathutils.Vector(description["to_sun"]).to_track_quat("Z", "Y")
        bpy.context.collection.objects.link(sun)


def add_camera(description):
    data = bpy.data.cameras.new("camera")
    data.sensor_fit = (
        "VERTICAL" if description["size"][0] >= description["size"][1] else "HORIZONTAL"
    )
    data.angle = math.radians(description["fov"])
    data.clip_end = 1e6
    camera = bpy.data.objects.new("camera", data)
    eye, target = (mathutils.Vector(description[key]) for key in ("eye", "target"))
    back = (eye - target).normalized()
    right = mathutils.Vector((0, 1, 0)).cross(back).normalized()
    camera.matrix_world = mathutils.Matrix(
        (*zip(right, back.cross(right), back, eye), (0, 0, 0, 1))
    )
    bpy.context.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def load(description):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    settle(scene, description["size"])
    add_cloud(description)
    add_lights(description)
    add_camera(description)

    def write(path):
        with tempfile.TemporaryDirectory() as folder:
            name = os.path.join(folder, "picture.exr")
            bpy.data.images["Render Result"].save_render(name, scene=scene)
            image = bpy.data.images.load(name)
            image.colorspace_settings.name = "Non-Color"
            width, height = image.size
            pixels = np.array(image.pixels[:], dtype=np.float32).reshape(height, width, 4)
            bpy.data.images.remove(image)
        write_pfm(path, pixels[:, :, :3])

    def render(spp, seed):
        scene.cycles.samples, scene.cycles.seed = spp, seed
        bpy.ops.render.render()
        return write

    return f"Blender {bpy.app.version_string}, Cycles", render


serve(load, compiles=False)
