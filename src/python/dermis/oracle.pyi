from typing import Mapping, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import Camera, Profile

_Materials = Union[Profile, str, Mapping[int, Union[Profile, str]]]

class Reference:
    """What a filter should write. Of a device in float32 each value may be off by the bound; `exact` has none."""

    @property
    def scattered(self) -> NDArray[np.float64]: ...
    @property
    def scattered_bound(self) -> NDArray[np.float64] | None: ...
    @property
    def result(self) -> NDArray[np.float64] | None: ...
    @property
    def result_bound(self) -> NDArray[np.float64] | None: ...

def separable(materials: _Materials, camera: Camera, mm_per_unit: float = 1.0, settings: Mapping[str, object] = ...,
              **images: ArrayLike) -> Reference:
    """The two passes, as `dermis.Plan` with these settings has them. Images as for Plan.run."""

def exact(materials: _Materials, camera: Camera, mm_per_unit: float = 1.0, settings: Mapping[str, object] = ...,
          **images: ArrayLike) -> Reference:
    """The integral over the surface that the camera sees, by quadrature."""

def disc(materials: _Materials, camera: Camera, mm_per_unit: float = 1.0, settings: Mapping[str, object] = ...,
         **images: ArrayLike) -> Reference:
    """The samples of discs."""

class Scene:
    """A G-buffer whose unit is a millimetre."""

    camera: Camera
    @property
    def images(self) -> dict[str, NDArray[np.float32]]:
        """light, albedo, depth, material and beauty."""

def scene(name: str, width: int, height: int, px_per_mm: float = 4.0, orthographic: bool = False) -> Scene:
    """An analytic scene, with so many pixels to the millimetre in its middle."""

def scenes() -> dict[str, str]:
    """The names of all scenes, and what they are."""
