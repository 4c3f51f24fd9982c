"""Subsurface scattering on rendered images: numpy arrays in and out, on any OpenCL device.

    plan = dermis.Plan({1: "skin", 2: "marble"}, images=["depth", "material"], quality="final")
    camera = dermis.Camera.perspective(900, 900, 480, 270)
    scattered = plan.run(camera, mm_per_unit=10, light=light, depth=depth, material=ids).scattered

A plan is made once and runs any number of frames, from several threads at once if need be. Errors are `dermis.Error`,
with the fields `code`, `argument`, `seen` and `wanted`. `dermis.oracle` is the same filter in double precision, and
`import dermis.exr` reads and writes pictures.
"""

from . import oracle
from ._core import (Camera, Device, DeviceInfo, Error, Plan, Profile, Result, Taps, __version__, devices, presets,
                    settings)

__all__ = ["Camera", "Device", "DeviceInfo", "Error", "Plan", "Profile", "Result", "Taps", "__version__", "devices",
           "oracle", "presets", "settings"]
