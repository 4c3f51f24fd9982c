"""An add-on for Blender 3.4 with Cycles: renders the scene and lets dermis scatter its light.

Install it under Edit > Preferences > Add-ons > Install, and tell it there where the dermis program is. Each material
that scatters gets a profile under Material Properties > dermis, as "skin-walk" or "burley:1/0.6/0.4"; then Render
Properties > dermis > Render and Scatter renders the scene with the passes that dermis reads, runs dermis, and shows
the result in the image editor. A scene unit is as long as the scene's units say. Subsurface scattering of Blender's own
had better be off in these materials.
"""

import os
import subprocess
import tempfile

import bpy

bl_info = {
    "name": "dermis",
    "description": "Subsurface scattering after the render, by dermis",
    "blender": (3, 0, 0),
    "version": (0, 1, 0),
    "location": "Render Properties > dermis, Material Properties > dermis",
    "category": "Render",
}

PASSES = ("combined", "z", "normal", "position", "diffuse_direct", "diffuse_indirect", "diffuse_color",
          "material_index")
RESULT = "dermis"


class Failure(Exception):
    """What the user is told in one line."""


def scattering_materials():
    """The materials that have a profile, with pass indices of their own."""
    materials = [material for material in bpy.data.materials if material.dermis_profile]
    if not materials:
        raise Failure("no material has a profile: Material Properties > dermis")
    taken = {material.pass_index for material in bpy.data.materials}
    for material in materials:
        twins = [other for other in bpy.data.materials
                 if other is not material and other.pass_index == material.pass_index]
        if material.pass_index == 0 or twins:
            material.pass_index = next(index for index in range(1, 65536) if index not in taken)
            taken.add(material.pass_index)
    return materials


def render_passes(scene, view_layer, path):
    """Renders all passes into an OpenEXR file; the settings of the scene are as before afterwards."""
    for name in PASSES:
        setattr(view_layer, "use_pass_" + name, True)
    render, settings = scene.render, scene.render.image_settings
    before = (render.filepath, render.use_file_extension, settings.file_format, settings.color_depth)
    try:
        settings.file_format, settings.color_depth = "OPEN_EXR_MULTILAYER", "32"
        render.filepath, render.use_file_extension = path, False
        bpy.ops.render.render(write_still=True)
    except RuntimeError as error:
        raise Failure(str(error).strip().splitlines()[0]) from error
    finally:
        settings.file_format = before[2]
        settings.color_depth = before[3]
        render.filepath, render.use_file_extension = before[:2]


def dermis_command(scene, materials, program, rendered, result):
    """The command that scatters the light of a picture that was rendered."""
    mm_per_unit = 1000 * scene.unit_settings.scale_length
    command = [program, "filter", rendered, "-o", result, "--mm-per-unit", f"{mm_per_unit:g}",
               "--quality", scene.dermis_quality.lower()]
    for material in materials:
        command += ["--material", f"{material.pass_index}={material.dermis_profile}"]
    return command


def run_dermis(command):
    """Runs dermis; what it warns of is printed."""
    try:
        outcome = subprocess.run(command, capture_output=True, text=True)
    except OSError as error:
        raise Failure(f"{command[0]}: {error.strerror}; the preferences of the add-on say where dermis is") from error
    print(outcome.stderr, end="")
    if outcome.returncode != 0:
        raise Failure(outcome.stderr.strip().splitlines()[-1] if outcome.stderr.strip() else
                      f"dermis ended with {outcome.returncode}")


def show(path):
    """The picture as Blender's image `dermis`, in every image editor that is open."""
    image = bpy.data.images.get(RESULT)
    if image is None:
        image = bpy.data.images.load(path)
        image.name = RESULT
    image.filepath = path
    image.reload()
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "IMAGE_EDITOR":
                area.spaces.active.image = image


class DERMIS_OT_render(bpy.types.Operator):
    bl_idname = "render.dermis"
    bl_label = "Render and Scatter"
    bl_description = "Render the scene with the passes that dermis reads, and let it scatter their light"

    output: bpy.props.StringProperty(name="Output", description="The OpenEXR file; else one in the temporary folder",
                                     subtype="FILE_PATH")

    def execute(self, context):
        preferences = context.preferences.addons.get(__name__)
        program = preferences.preferences.program if preferences else "dermis"
        result = bpy.path.abspath(self.output) or os.path.join(tempfile.gettempdir(), "dermis_result.exr")
        rendered = os.path.splitext(result)[0] + "_passes.exr"
        try:
            materials = scattering_materials()
            render_passes(context.scene, context.view_layer, rendered)
            run_dermis(dermis_command(context.scene, materials, program, rendered, result))
        except Failure as failure:
            self.report({"ERROR"}, f"dermis: {failure}")
            return {"CANCELLED"}
        show(result)
        return {"FINISHED"}


class DERMIS_preferences(bpy.types.AddonPreferences):
    bl_idname = __name__

    program: bpy.props.StringProperty(name="dermis", description="The dermis program", default="dermis",
                                      subtype="FILE_PATH")

    def draw(self, _context):
        self.layout.prop(self, "program")


class DERMIS_PT_render(bpy.types.Panel):
    bl_label = "dermis"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"

    def draw(self, context):
        self.layout.prop(context.scene, "dermis_quality")
        self.layout.operator("render.dermis")


class DERMIS_PT_material(bpy.types.Panel):
    bl_label = "dermis"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "material"

    @classmethod
    def poll(cls, context):
        return context.material is not None

    def draw(self, context):
        self.layout.prop(context.material, "dermis_profile")


CLASSES = (DERMIS_OT_render, DERMIS_preferences, DERMIS_PT_render, DERMIS_PT_material)


def register():
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Material.dermis_profile = bpy.props.StringProperty(
        name="Profile", description='How far light spreads, as "skin-walk"; empty: the material does not scatter')
    bpy.types.Scene.dermis_quality = bpy.props.EnumProperty(
        name="Quality", default="FINAL",
        items=[(name.upper(), name.capitalize(), "") for name in ("draft", "preview", "final", "reference")])


def unregister():
    del bpy.types.Scene.dermis_quality
    del bpy.types.Material.dermis_profile
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)


if __name__ == "__main__":
    register()
