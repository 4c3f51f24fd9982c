"""A scene lit from behind: a mushroom, a cube of soap, a petal and a ring. METHODS.md says how near dermis comes to it.

    blender -b --python still_life.py -- MODE OUT.exr SAMPLES WIDTH HEIGHT SEED

With - for OUT nothing is rendered, for the script that adds views. MODE is lambert (plain diffuse surfaces, what dermis reads) or walk (Cycles' random walk, the truth). One unit is 10 mm.
"""
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


def material(name, index, color, radius=None):
    made = bpy.data.materials.new(name)
    made.use_nodes, made.pass_index = True, index
    inputs = made.node_tree.nodes["Principled BSDF"].inputs
    inputs["Base Color"].default_value = inputs["Subsurface Color"].default_value = (*color, 1)
    inputs["Specular"].default_value, inputs["Roughness"].default_value = 0.3, 0.5
    if radius and MODE == "walk":
        made.node_tree.nodes["Principled BSDF"].subsurface_method = "RANDOM_WALK"
        inputs["Subsurface"].default_value = 1
        inputs["Subsurface Radius"].default_value = radius
        inputs["Subsurface IOR"].default_value = 1.4
    return made


def add(primitive, its_material, scale=(1, 1, 1), **arguments):
    primitive(**arguments)
    made = bpy.context.object
    bpy.ops.object.shade_smooth()
    made.scale = scale
    made.data.materials.append(its_material)
    return made


def add_lamp(location, watts, size, color):
    lamp = bpy.data.lights.new("lamp", "AREA")
    lamp.energy, lamp.size, lamp.color = watts, size, color
    made = bpy.data.objects.new("lamp", lamp)
    scene.collection.objects.link(made)
    made.location = location
    made.rotation_euler = (-Vector(location)).to_track_quat("-Z", "Y").to_euler()


jade = material("jade", 1, (0.45, 0.7, 0.5), (0.5, 0.8, 0.6))
soap = material("soap", 2, (0.85, 0.8, 0.7), (1.0, 0.7, 0.5))
petal = material("petal", 3, (0.8, 0.35, 0.4), (0.6, 0.25, 0.25))
mesh = bpy.ops.mesh
add(mesh.primitive_uv_sphere_add, jade, (1, 1, 0.45), radius=1.5, segments=96, ring_count=48, location=(-3, 0, 0.2))
add(mesh.primitive_cylinder_add, jade, radius=0.45, depth=2.4, vertices=64, location=(-3, 0, -1.2))
cube = add(mesh.primitive_cube_add, soap, size=1.9, location=(0.2, 0, -0.9), rotation=(0.2, 0.3, 0.5))
bevel = cube.modifiers.new("bevel", "BEVEL")
bevel.width, bevel.segments = 0.35, 8
add(mesh.primitive_uv_sphere_add, petal, (0.16, 1, 1), radius=1.4, segments=96, ring_count=48, location=(3.2, 0, 0),
    rotation=(0, 0, 1.2))
add(mesh.primitive_torus_add, petal, major_radius=0.8, minor_radius=0.22, major_segments=128, minor_segments=48,
    location=(0.3, -0.3, 1.3), rotation=(1.2, 0.3, 0))
add(mesh.primitive_plane_add, material("floor", 0, (0.3, 0.3, 0.32)), size=40, location=(0, 0, -2.4))
add_lamp((4, 9, 5), 1500, 1.5, (1, 0.95, 0.85))
add_lamp((-6, 7, 1), 700, 1, (0.8, 0.9, 1))
add_lamp((3, -12, 6), 250, 3, (1, 1, 1))
scene.world = bpy.data.worlds.new("world")
scene.world.use_nodes = True
scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0.02, 0.02, 0.02, 1)

camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
scene.collection.objects.link(camera)
scene.camera = camera
camera.data.lens, camera.data.clip_end = 55, 200
camera.location = (0.5, -15, 2.5)
camera.rotation_euler = (Vector((0, 0, -0.3)) - camera.location).to_track_quat("-Z", "Y").to_euler()

for name in ("z", "normal", "position", "diffuse_direct", "diffuse_indirect", "diffuse_color", "material_index"):
    setattr(scene.view_layers[0], "use_pass_" + name, True)
settings = scene.render.image_settings
settings.file_format, settings.color_depth, settings.exr_codec = "OPEN_EXR_MULTILAYER", "32", "ZIP"
scene.render.filepath = OUT
if OUT != "-":
    bpy.ops.render.render(write_still=True)
