# Three scenes that are hard on a filter: blender -b --factory-startup -P cycles_scenes.py -- SCENE OUT.exr SAMPLES WIDTH HEIGHT
# SCENE: face (close up), leaves (thin plates before a body of the same material), wide (a lens of 97 degrees).
# One scene unit is 10 mm; material 1 is skin, 2 marble, 3 wax, 0 the wall.
import math
import sys

import bpy
import mathutils

scene_name, out, samples, width, height = sys.argv[sys.argv.index("--") + 1 :]
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.engine = "CYCLES"
scene.cycles.samples = int(samples)
scene.cycles.use_denoising = False
scene.cycles.use_adaptive_sampling = False
scene.cycles.pixel_filter_type = "BOX"
scene.cycles.filter_width = 1.0
scene.cycles.max_bounces = 2
scene.render.resolution_x = int(width)
scene.render.resolution_y = int(height)


def material(name, index, colour):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    made.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*colour, 1)
    made.pass_index = index
    return made


skin = material("skin", 1, (0.75, 0.52, 0.42))
marble = material("marble", 2, (0.83, 0.79, 0.75))
wax = material("wax", 3, (0.8, 0.55, 0.2))
wall = material("wall", 0, (0.25, 0.25, 0.28))


def dress(its_material, levels=0, bumps=0.0, bump_size=0.2):
    """The object that was made last."""
    made = bpy.context.object
    bpy.ops.object.shade_smooth()
    made.data.materials.append(its_material)
    if levels > 0:
        made.modifiers.new("smooth", "SUBSURF").render_levels = levels
    if bumps > 0:
        texture = bpy.data.textures.new("bumps", "CLOUDS")
        texture.noise_scale = bump_size
        modifier = made.modifiers.new("bumps", "DISPLACE")
        modifier.texture = texture
        modifier.strength = bumps


def face():
    bpy.ops.mesh.primitive_monkey_add(size=6, rotation=(math.radians(-6), 0, math.radians(12)))
    dress(skin, 4, 0.06, 0.25)
    for x in (-1.05, 1.05):
        bpy.ops.mesh.primitive_uv_sphere_add(radius=0.55, segments=96, ring_count=48, location=(x * 0.98 + 0.2, -2.25, 0.75))
        dress(marble)
    return (1.2, -9, 0.6), (0.1, -1.5, 0.3), 62


def leaves():
    bpy.ops.mesh.primitive_uv_sphere_add(radius=2.6, segments=128, ring_count=64, location=(0, 1.2, 0))
    dress(skin, 0, 0.15, 0.4)
    for i in range(7):
        angle = i * 0.9
        bpy.ops.mesh.primitive_cylinder_add(
            radius=0.62,
            depth=0.07,
            vertices=96,
            location=(2.2 * math.cos(angle), -1.9 + 0.25 * (i % 3), 1.7 * math.sin(angle)),
            rotation=(math.radians(70 + 12 * i), math.radians(25 * i), 0.3 * i),
        )
        dress(skin if i % 2 else wax)
    bpy.ops.mesh.primitive_cylinder_add(
        radius=0.16, depth=5, vertices=64, location=(0, -2.4, 0), rotation=(0, math.radians(35), 0)
    )
    dress(skin)
    return (0, -12, 0), (0, 0, 0), 50


def wide():
    bpy.ops.mesh.primitive_monkey_add(size=4, location=(-1.5, 0, 0.2), rotation=(0, 0, math.radians(35)))
    dress(skin, 4, 0.04, 0.2)
    bpy.ops.mesh.primitive_torus_add(
        major_radius=1.2,
        minor_radius=0.5,
        major_segments=160,
        minor_segments=64,
        location=(2.1, 0.6, 0.2),
        rotation=(math.radians(60), 0.4, 0),
    )
    dress(wax)
    bpy.ops.mesh.primitive_plane_add(size=14, location=(0, 2, -1.7))
    dress(marble)
    return (0.3, -4.2, 0.9), (0, 0, -0.1), 16


def towards(place, target):
    return (mathutils.Vector(target) - mathutils.Vector(place)).to_track_quat("-Z", "Y").to_euler()


def light(place, energy, size, colour):
    data = bpy.data.lights.new("light", "AREA")
    data.energy, data.size, data.color = energy, size, colour
    made = bpy.data.objects.new("light", data)
    scene.collection.objects.link(made)
    made.location = place
    made.rotation_euler = towards(place, (0, 0, 0))


camera_place, target, lens = {"face": face, "leaves": leaves, "wide": wide}[scene_name]()
bpy.ops.mesh.primitive_plane_add(size=60, location=(0, 14, 0), rotation=(math.radians(90), 0, 0))
dress(wall)
light((7, -8, 9), 1800, 0.6, (1, 0.95, 0.9))
light((-9, -5, 2), 400, 3, (0.65, 0.78, 1))
world = bpy.data.worlds.new("world")
scene.world = world
world.use_nodes = True
world.node_tree.nodes["Background"].inputs[0].default_value = (0.03, 0.03, 0.035, 1)
camera = bpy.data.cameras.new("camera")
camera.lens = lens
camera.clip_end = 500
holder = bpy.data.objects.new("camera", camera)
scene.collection.objects.link(holder)
scene.camera = holder
holder.location = camera_place
holder.rotation_euler = towards(camera_place, target)

layer = scene.view_layers[0]
for name in ("z", "position", "normal", "diffuse_direct", "diffuse_indirect", "diffuse_color", "material_index"):
    setattr(layer, "use_pass_" + name, True)
scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
scene.render.image_settings.color_depth = "32"
scene.render.image_settings.exr_codec = "ZIP"
scene.render.filepath = out
bpy.ops.render.render(write_still=True)
