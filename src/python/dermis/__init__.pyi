from . import oracle as oracle
from typing import Callable, Mapping, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str

class Error(RuntimeError):
    """What dermis refuses: `argument`, the value `seen` and the one `wanted`; `code` is an exit code of the program."""

    code: int
    argument: str
    seen: str
    wanted: str

class DeviceInfo:
    name: str
    platform: str
    driver: str
    type: str
    compute_units: int
    memory_bytes: int

class Device:
    """A device: by number, type ("CPU") or a part of its name; "" is the first GPU, or the first one. `threads` of a CPU; 0: all."""

    def __init__(self, name: str = "", threads: int = 0) -> None: ...
    @property
    def info(self) -> DeviceInfo: ...

def devices() -> list[DeviceInfo]: ...

class Profile:
    """A diffusion profile, as the program spells it: "skin", "burley:1/0.6/0.4", "walk:12/7/2,albedo=0.8/0.55/0.2".

    Functions take numbers of any shape and add an axis of three channels. Lengths are in millimetres.
    """

    def __init__(self, text: str) -> None: ...
    def radial(self, r_mm: ArrayLike) -> NDArray[np.float64]:
        """R(r), 1/mm^2, for r > 0."""
    def marginal(self, x_mm: ArrayLike) -> NDArray[np.float64]:
        """The integral of R over lines, 1/mm."""
    def edge(self, x_mm: ArrayLike) -> NDArray[np.float64]:
        """What a straight shadow edge looks like: 0 far left, 1 far right."""
    def cdf(self, r_mm: ArrayLike) -> NDArray[np.float64]:
        """The share of the light within r, 0..1."""
    def radius(self, share: ArrayLike) -> NDArray[np.float64]:
        """The distance within which a share of the light leaves, mm."""
    def transmittance(self, thickness_mm: ArrayLike) -> NDArray[np.float64]:
        """The share of the light that comes through a slab, 0..1."""

def presets() -> dict[str, str]:
    """The names of all presets, and where their numbers come from."""

class Taps:
    """Taps for pixels of one size: settings are model, rank, taps and placement."""

    def __init__(self, profile: Union[Profile, str], pixel_mm: float, **settings: object) -> None: ...
    pixel_mm: float
    predicted_rel_l2: float
    @property
    def offsets_px(self) -> NDArray[np.float64]: ...
    @property
    def scales(self) -> NDArray[np.float64]:
        """Of each term and channel: the kernel is the sum of scale w(x) w(y)."""
    @property
    def weights(self) -> NDArray[np.float32]:
        """Of each term, offset and channel."""

class Camera:
    """Pixel (i, j) has its centre at (i + 0.5, j + 0.5), y down."""

    scale_x: float
    scale_y: float
    center_x: float
    center_y: float
    @staticmethod
    def perspective(focal_x_px: float, focal_y_px: float, center_x_px: float, center_y_px: float) -> Camera: ...
    @staticmethod
    def orthographic(px_per_unit_x: float, px_per_unit_y: float) -> Camera: ...

class Result:
    scattered: NDArray
    result: NDArray | None
    stats: dict[str, float]

class Plan:
    """Filters frames that have `images`: light always, and of albedo, depth, material, mask, matte, normal and beauty
    those that are named. `materials`: a profile, or profiles by id. `pixel_mm`: by id, the size of a pixel on the
    surface, which decides how many taps a quality takes. Settings: `dermis.settings()` lists them."""

    def __init__(self, materials: Union[Profile, str, Mapping[int, Union[Profile, str]]], images: Sequence[str],
                 device: Device | None = None, pixel_mm: Mapping[int, float] = ..., **settings: object) -> None: ...
    def run(self, camera: Camera, mm_per_unit: float = 1.0, *, scattered: NDArray | None = None,
            result: NDArray | None = None, progress: Callable[[float], bool | None] | None = None,
            **images: ArrayLike) -> Result:
        """Filters a frame. Images are (height, width) or (height, width, 3), of float16, float32 or unsigned integers,
        which are not copied; others are converted. `scattered` and `result` (with a beauty) are written if they are
        given, else made. `progress` is called with 0..1, and stops the run by returning False. Other threads of Python
        run meanwhile."""
    def scratch_bytes(self, width: int, height: int) -> int: ...

def settings() -> dict[str, str]:
    """All settings of a plan, with what they are."""
