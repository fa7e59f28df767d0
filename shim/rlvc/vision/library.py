# SPDX-License-Identifier: MIT
"""The vision library: calls, errors, pictures and owned objects."""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from .. import _native
from ..checks import one_of
from ..errors import (
    BlockError,
    ConfigError,
    Error,
    MetricError,
    PictureError,
    RangeError,
    StoreError,
)

library = _native.load_optional("rlvc-vision", _native.VISION)

_ERRORS: dict[int, type[Error]] = {
    -102: ConfigError,
    -103: PictureError,
    -105: RangeError,
    -106: MetricError,
    -107: StoreError,
    -108: MetricError,
    -109: MetricError,
    -110: MetricError,
    -111: BlockError,
}


def call(name: str, *arguments: Any) -> None:
    """Call a function whose last argument is an ``rlvc_vision_error``."""
    error = _native.VisionError()
    try:
        status = getattr(library, name)(*arguments, ctypes.byref(error))
    except ctypes.ArgumentError as wrong:
        raise RangeError(f"{name}: {wrong}") from None
    if status != 0:
        text = error.text.decode(errors="replace") or library.rlvc_vision_status_text(
            status
        ).decode(errors="replace")
        raise _ERRORS.get(status, Error)(text)


Order = Literal["rgb", "bgr"]
Picture: TypeAlias = "npt.NDArray[np.uint8]"
_FORMATS = {"rgb": 2, "bgr": 1}
_SIDE_MAX = 32767


def native_picture(picture: Any, order: Order) -> _native.Picture:
    """Make the C struct of a picture, which keeps its pixels alive."""
    one_of("order", order, _FORMATS, PictureError)
    if not isinstance(picture, np.ndarray):
        raise PictureError(f"a picture must be an array, not {type(picture).__name__}")
    if picture.dtype != np.uint8:
        raise PictureError(f"a picture is {picture.dtype}, expected uint8")
    grey = picture.ndim == 2
    if not grey and (picture.ndim != 3 or picture.shape[2] != 3):
        raise PictureError(
            f"a picture is {list(picture.shape)}, expected [height, width] or [..., 3]"
        )
    if not 1 <= min(picture.shape[:2]) <= max(picture.shape[:2]) <= _SIDE_MAX:
        raise PictureError(
            f"a picture has {picture.shape[1]} x {picture.shape[0]} pixels: each side must be in "
            f"[1, {_SIDE_MAX}]"
        )
    pixel = (1,) if grey else (3, 1)
    if picture.strides[1:] != pixel or abs(picture.strides[0]) < picture.shape[1] * pixel[0]:
        picture = np.ascontiguousarray(picture)
    height, width = picture.shape[:2]
    form = 0 if grey else _FORMATS[order]
    native = _native.Picture(picture.ctypes.data, picture.strides[0], width, height, form)
    native._keeps = picture
    return native


class Owned:
    """An object of the library, freed with this one. The lock admits one thread at a time."""

    def __init__(self, make: str, free: str, *arguments: Any) -> None:
        self._lock = threading.Lock()
        made = ctypes.c_void_p()
        reference = ctypes.byref(made)
        call(make, *arguments, reference)
        self._handle: int | None = made.value
        self._free: Callable[[int | None], None] = getattr(library, free)

    def __getattr__(self, name: str) -> Any:
        """Say what is wrong with an object that ``__new__`` alone has made."""
        if "_free" in self.__dict__ or name.startswith("__"):
            raise AttributeError(f"{type(self).__name__} has no attribute {name}")
        raise Error(f"the {type(self).__name__} was not made by one of its constructors")

    def __del__(self) -> None:
        if "_free" in self.__dict__:
            self._free(self._handle)
