"""The add-on in Blender without a window: a ball is rendered and scattered, and what goes wrong is told.

    blender -b --factory-startup --python-exit-code 1 --python tests/blender/addon_test.py -- DERMIS FOLDER
"""

import os
import sys

import bpy

dermis, folder = sys.argv[sys.argv.index("--") + 1:]
addon = os.path.join(os.path.dirname(__file__), "..", "..", "examples", "blender", "dermis_addon.py")

bpy.ops.preferences.addon_install(filepath=addon, overwrite=True)
bpy.ops.preferences.addon_enable(module="dermis_addon")
bpy.context.preferences.addons["dermis_addon"].preferences.program = dermis

scene = bpy.context.scene
scene.render.engine = "CYCLES"
scene.cycles.samples, scene.cycles.use_denoising = 4, False
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 96, 54, 100
scene.unit_settings.scale_length = 0.01
scene.render.image_settings.file_format = "PNG"
bpy.ops.mesh.primitive_uv_sphere_add(radius=1.5)
ball = bpy.context.object
for obj in list(scene.objects):
    if obj.type == "MESH" and obj is not ball:
        bpy.data.objects.remove(obj)
ball.data.materials.append(bpy.data.materials.new("skin"))
result = os.path.join(folder, "result.exr")


def refused():
    """What the operator says, which without a window is an exception."""
    try:
        bpy.ops.render.dermis(output=result)
    except RuntimeError as error:
        return str(error)
    return ""


assert "no material has a profile" in refused()
material = bpy.data.materials["skin"]
material.dermis_profile = "butter"
message = refused()
assert "got butter" in message or "butter" in message, message
assert not os.path.exists(result)

material.dermis_profile = "burley:3/2/1"
scene.dermis_quality = "DRAFT"
assert bpy.ops.render.dermis(output=result) == {"FINISHED"}
assert material.pass_index > 0
assert os.path.getsize(result) > 10000
assert scene.render.image_settings.file_format == "PNG"
assert bpy.data.images["dermis"].filepath == result
bpy.context.preferences.addons["dermis_addon"].preferences.program = os.path.join(folder, "nowhere")
assert "the preferences of the add-on say where dermis is" in refused()
print("add-on: all well")
