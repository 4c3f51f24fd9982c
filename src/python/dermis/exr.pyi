from os import PathLike
from typing import Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import Camera

class Roles:
    """Which channels play which role. `role in roles` says whether there are any, `roles[role]` are they: a sum of
    groups of three or one. Roles: light, albedo, depth, position, normal, material, mask, matte, specular, beauty,
    stretch_u, stretch_v, thickness."""

    layer: str
    view: str
    renderer: str
    lighting: str
    warnings: list[str]
    def __contains__(self, role: str) -> bool: ...
    def __getitem__(self, role: str) -> list[list[str]]: ...

class FoundCamera:
    camera: Camera
    source: str
    residual_units: float
    warnings: list[str]

class Picture:
    """All channels of an OpenEXR file. What is not set is written as it was read, bit for bit."""

    width: int
    height: int
    compression: str
    channels: list[str]
    def __init__(self, width: int, height: int) -> None: ...
    @staticmethod
    def read(path: Union[str, PathLike[str]]) -> Picture: ...
    def __contains__(self, channel: str) -> bool: ...
    def __getitem__(self, channel: str) -> NDArray[np.float32]: ...
    def __setitem__(self, channel: str, values: ArrayLike) -> None:
        """One value per pixel. A channel that is not there is added, of float32."""
    def roles(self, overrides: Sequence[str] = ..., layer: str = "", view: str = "", renderer: str = "") -> Roles:
        """Found by the names of the channels. Overrides are as `dermis filter --role` has them: "light=sss"."""
    def load(self, roles: Roles, role: str) -> NDArray[np.float32] | None:
        """The values of a role; None if the picture has none."""
    def camera(self, roles: Roles, fov_deg: float | None = None, focal_px: float | None = None,
               orthographic_px_per_unit: float | None = None) -> FoundCamera:
        """Found by positions and depth, this word on it, or attributes, whichever comes first."""
    def images(self, roles: Roles, camera: FoundCamera) -> dict[str, NDArray[np.float32]]:
        """What Plan.run takes: light, and of albedo, depth, material, mask, matte and beauty those that there are."""
    def attribute(self, name: str) -> str | None: ...
    def set_attribute(self, name: str, value: str) -> None: ...
    def write(self, path: Union[str, PathLike[str]], compression: str = "", channels: Sequence[str] = ...) -> None:
        """With all channels, or these. The file takes its place when it is whole."""
