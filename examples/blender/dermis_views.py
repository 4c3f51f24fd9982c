"""Renders what the camera of a Blender scene does not see, for the light that comes through: dermis filter --view.

    blender -b shot.blend --python examples/blender/dermis_views.py -- --frame 12 -o shot

renders shot.exr, as the scene's camera sees it, and shot_behind.exr, from the other side, with the passes that dermis
reads. With profiles for its materials, by name or pass index, it runs dermis on them as well, which writes shot_sss.exr:

    blender -b shot.blend --python examples/blender/dermis_views.py -- -o shot --material Skin=skin-walk

Run with Blender 3.4 and Cycles; what 2.93 names otherwise is heeded. A scene unit is as long as the scene says, or as
--mm-per-unit does. Materials that scatter are those with a pass index above 0; nothing else is seen by the added cameras, so that no floor
or wall hides a surface. Subsurface scattering itself had better be off in the scene, as dermis adds it.
"""

import argparse
import math
import os
import subprocess
import sys

import bpy
from mathutils import Vector

PASSES = ("combined", "z", "normal", "position", "diffuse_direct", "diffuse_indirect", "diffuse_color",
          "material_index")


def scatters(obj):
    """True for a mesh any of whose materials has a pass index."""
    return obj.type == "MESH" and any(slot.material and slot.material.pass_index > 0 for slot in obj.material_slots)


def bounding_sphere(objects):
    """The middle and the radius of a sphere around the boxes of objects, in world space, scene units."""
    corners = [obj.matrix_world @ Vector(corner) for obj in objects for corner in obj.bound_box]
    low = Vector([min(corner[i] for corner in corners) for i in range(3)])
    high = Vector([max(corner[i] for corner in corners) for i in range(3)])
    middle = (low + high) / 2
    return middle, max((corner - middle).length for corner in corners)


def directions(scene, middle, kind):
    """By name, the directions from the middle of the objects to where cameras are put."""
    axes = scene.camera.matrix_world.to_3x3()
    right, up = axes @ Vector((1, 0, 0)), axes @ Vector((0, 1, 0))
    back = (middle - scene.camera.matrix_world.translation).normalized()
    if kind == "behind":
        return {"behind": back}
    if kind == "corners":
        return {"left": (back - right + up).normalized(), "right": (back + right - up).normalized()}
    lights = [obj for obj in scene.objects if obj.type == "LIGHT" and obj.data.type != "SUN"]
    found = {}
    for light in lights:
        way = (light.matrix_world.translation - middle).normalized()
        if way.dot(back) > 0:
            found[f"light{len(found)}"] = way
    return found


def set_passes(view_layer):
    for name in PASSES:
        setattr(view_layer, "use_pass_" + name, True)


def render(scene, path):
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    print("dermis_views: wrote", path)


def render_views(scene, arguments):
    """Renders the added views; everything that it changes is as before afterwards."""
    objects = [obj for obj in scene.objects if scatters(obj) and not obj.hide_render]
    if not objects:
        sys.exit("dermis_views: no material with a pass index above 0: that is what tells dermis materials apart")
    middle, radius = bounding_sphere(objects)
    ways = directions(scene, middle, arguments.views)
    if not ways:
        sys.exit("dermis_views: no light behind the objects; want --views behind or corners")
    side = max(int(max(scene.render.resolution_x, scene.render.resolution_y) * arguments.scale), 16)

    data = bpy.data.cameras.new("dermis_view")
    data.type = "ORTHO"
    data.ortho_scale = 2.02 * radius
    data.clip_end = 100 * radius
    camera = bpy.data.objects.new("dermis_view", data)
    scene.collection.objects.link(camera)
    others = [obj for obj in scene.objects if obj.type == "MESH" and obj not in objects]
    before = (scene.camera, scene.render.resolution_x, scene.render.resolution_y, scene.cycles.samples,
              scene.render.pixel_aspect_x, scene.render.pixel_aspect_y)
    # Blender 3.0 has moved who sees an object.
    seen = [(obj, obj.visible_camera if hasattr(obj, "visible_camera") else obj.cycles_visibility.camera)
            for obj in others]

    def set_seen(obj, value):
        if hasattr(obj, "visible_camera"):
            obj.visible_camera = value
        else:
            obj.cycles_visibility.camera = value

    try:
        for obj in others:
            set_seen(obj, False)
        scene.camera = camera
        scene.render.resolution_x = scene.render.resolution_y = side
        scene.render.pixel_aspect_x = scene.render.pixel_aspect_y = 1
        scene.cycles.samples = arguments.samples
        written = []
        for name, way in ways.items():
            camera.location = middle + 4 * radius * way
            camera.rotation_euler = (-way).to_track_quat("-Z", "Y").to_euler()
            bpy.context.view_layer.update()
            written.append(f"{arguments.output}_{name}.exr")
            render(scene, os.path.abspath(written[-1]))
        return written
    finally:
        (scene.camera, scene.render.resolution_x, scene.render.resolution_y, scene.cycles.samples,
         scene.render.pixel_aspect_x, scene.render.pixel_aspect_y) = before
        for obj, value in seen:
            set_seen(obj, value)
        bpy.data.objects.remove(camera)
        bpy.data.cameras.remove(data)


def pass_index(name):
    """The pass index of a material of that name, or the index that the name is."""
    material = bpy.data.materials.get(name)
    if material is None and name.isdigit():
        return int(name)
    if material is None or material.pass_index == 0:
        sys.exit(f"dermis_views: --material: got {name}, want a material with a pass index above 0, or that index")
    return material.pass_index


def filter_picture(scene, views, arguments, materials):
    """Runs dermis on the picture and its views; ends with its exit code if that is not 0."""
    mm_per_unit = arguments.mm_per_unit or 1000 * scene.unit_settings.scale_length
    command = [arguments.dermis, "filter", arguments.output + ".exr", "-o", arguments.output + "_sss.exr"]
    for view in views:
        command += ["--view", view]
    command += ["--mm-per-unit", f"{mm_per_unit:g}"]
    for index, profile in materials:
        command += ["--material", f"{index}={profile}"]
    print("dermis_views:", " ".join(command))
    try:
        code = subprocess.run(command).returncode
    except OSError as error:
        sys.exit(f"dermis_views: --dermis: got {error}, want the dermis program")
    if code != 0:
        sys.exit(code)


def parse(argv):
    parser = argparse.ArgumentParser(prog="dermis_views", description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", required=True, help="names begin with this: OUTPUT.exr, OUTPUT_behind.exr")
    parser.add_argument("--views", choices=("behind", "corners", "lights"), default="behind",
                        help="behind: one from the other side; corners: two; lights: one from each lamp behind")
    parser.add_argument("--scale", type=float, default=0.5, help="of the longer side of the picture")
    parser.add_argument("--samples", type=int, default=16, help="of each pixel of the views")
    parser.add_argument("--frame", type=int, help="of the timeline; else the current one")
    parser.add_argument("--views-only", action="store_true", help="do not render the picture itself")
    parser.add_argument("--material", action="append", default=[], metavar="NAME=PROFILE",
                        help="run dermis with this profile for a material, by its name or pass index; repeatable")
    parser.add_argument("--mm-per-unit", type=float, help="else by the units of the scene")
    parser.add_argument("--dermis", default="dermis", help="the program, if it is not where the system looks")
    return parser.parse_known_args(argv)[0]


def main():
    arguments = parse(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
    scene = bpy.context.scene
    materials = [(pass_index(name), profile) for name, _, profile in
                 (text.partition("=") for text in arguments.material)]
    if arguments.frame is not None:
        scene.frame_set(arguments.frame)
    settings = scene.render.image_settings
    settings.file_format = "OPEN_EXR_MULTILAYER"
    settings.color_depth = "32"
    set_passes(bpy.context.view_layer)
    if not arguments.views_only:
        render(scene, os.path.abspath(arguments.output + ".exr"))
    views = render_views(scene, arguments)
    if materials:
        filter_picture(scene, views, arguments, materials)
    else:
        print("dermis filter", arguments.output + ".exr", "-o", arguments.output + "_sss.exr",
              " ".join("--view " + view for view in views), "--mm-per-unit MM --material ID=PROFILE")


main()
