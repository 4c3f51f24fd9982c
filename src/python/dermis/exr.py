"""Pictures of renderers: channels, their roles, and the camera.

    picture = dermis.exr.Picture.read("frame.exr")
    roles = picture.roles()
    found = picture.camera(roles)
    images = picture.images(roles, found)
    plan = dermis.Plan({1: "skin"}, images=[name for name in images if name != "light"], lighting=roles.lighting)
    result = plan.run(found.camera, mm_per_unit=10, **images)
    for i, channel in enumerate("RGB"):
        picture["sss." + channel] = result.scattered[..., i]
    picture.write("frame_sss.exr")

It is there if OpenImageIO was when the package was built.
"""

from . import _core  # noqa: F401, whose types _exr has

try:
    from ._exr import FoundCamera, Picture, Roles
except ModuleNotFoundError as error:
    raise ImportError("dermis was built without OpenImageIO, so that it reads no pictures") from error

__all__ = ["FoundCamera", "Picture", "Roles"]
