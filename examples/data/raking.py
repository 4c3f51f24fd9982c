"""A head of one albedo under one hard lamp that grazes it: what scatters is the edge of the light, and nothing else.

    blender -b --factory-startup -P raking.py -- MODE OUT.exr SAMPLES WIDTH HEIGHT SEED

MODE is lambert (a plain diffuse surface, what dermis reads) or walk (Cycles' random walk, the truth). One unit is 5 mm.
"""
import math
import sys

import bpy
from mathutils import Vector

MODE, OUT, SAMPLES, WIDTH, HEIGHT, SEED = sys.argv[sys.argv.index("--") + 1:][:6]

bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.engine = "CYCLES"
scene.render.resolution_x, scene.render.resolution_y = int(WIDTH), int(HEIGHT)
scene.cycles.samples, scene.cycles.seed, scene.cycles.max_bounces = int(SAMPLES), int(SEED), 4
scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 1.0

# Skin: radii in units of 5 mm.
skin = bpy.data.materials.new("skin")
skin.use_nodes, skin.pass_index = True, 1
inputs = skin.node_tree.nodes["Principled BSDF"].inputs
inputs["Base Color"].default_value = inputs["Subsurface Color"].default_value = (0.71, 0.47, 0.39, 1)
inputs["Specular"].default_value, inputs["Roughness"].default_value = 0.3, 0.5
if MODE == "walk":
    skin.node_tree.nodes["Principled BSDF"].subsurface_method = "RANDOM_WALK"
    inputs["Subsurface"].default_value = 1
    inputs["Subsurface Radius"].default_value = (1.8, 0.7, 0.36)
    inputs["Subsurface IOR"].default_value = 1.4

bpy.ops.mesh.primitive_monkey_add(size=6, rotation=(math.radians(-8), 0, math.radians(10)))
head = bpy.context.object
bpy.ops.object.shade_smooth()
head.modifiers.new("smooth", "SUBSURF").render_levels = 4
head.data.materials.append(skin)

lamp = bpy.data.lights.new("lamp", "SPOT")
lamp.energy, lamp.spot_size, lamp.shadow_soft_size = 9000, math.radians(40), 0.01
lamp_object = bpy.data.objects.new("lamp", lamp)
lamp_object.location = (13, -2.5, 3)
lamp_object.rotation_euler = (-lamp_object.location).to_track_quat("-Z", "Y").to_euler()
scene.collection.objects.link(lamp_object)
scene.world = bpy.data.worlds.new("world")
scene.world.use_nodes = True
scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0.01, 0.01, 0.012, 1)

camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
camera.data.lens = 60
camera.location = (0.5, -13, 0.5)
camera.rotation_euler = (Vector((0.2, 0, 0.1)) - camera.location).to_track_quat("-Z", "Y").to_euler()
scene.collection.objects.link(camera)
scene.camera = camera
for name in ("z", "normal", "position", "diffuse_direct", "diffuse_indirect", "diffuse_color", "glossy_direct",
             "glossy_indirect", "glossy_color", "material_index", "environment"):
    setattr(scene.view_layers[0], "use_pass_" + name, True)
settings = scene.render.image_settings
settings.file_format, settings.color_depth, settings.exr_codec = "OPEN_EXR_MULTILAYER", "32", "ZIP"
if OUT != "-":
    scene.render.filepath = OUT
    bpy.ops.render.render(write_still=True)
