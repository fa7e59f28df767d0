# SPDX-License-Identifier: MIT
"""The objects of the Tiled Gridworld (section 6.2): pictures from several angles."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from . import _native
from .checks import flag, listed, whole
from .errors import PictureError, RangeError
from .files import checked_name


class Objects(NamedTuple):
    """Objects and their pictures.

    Attributes
    ----------
    names : list of str
    angles : list of int
        The angles of the pictures, in degrees.
    pictures : ndarray of uint8, [objects, angles, height, width, 3]
        Red first.
    folder : str or None
        The folder of the pictures; "": rendered; None: from an array.
    """

    names: list[str]
    angles: list[int]
    pictures: npt.NDArray[np.uint8]
    folder: str | None

    def view(self, index: int, angle: int) -> npt.NDArray[np.uint8]:
        """Return a picture: uint8 [height, width, 3]."""
        return np.asarray(self.pictures[index, self.angles.index(angle)])


def given(pictures: npt.NDArray[np.uint8]) -> Objects:
    """Make objects from an array of pictures.

    Parameters
    ----------
    pictures : ndarray of uint8, [objects, height, width, 3] or [objects, views, height, width, 3]

    Returns
    -------
    Objects
        With angles 0, 1, ... for the views.

    Raises
    ------
    PictureError
        The array has another dtype or shape.
    """
    if not isinstance(pictures, np.ndarray) or pictures.dtype != np.uint8:
        kind = getattr(pictures, "dtype", type(pictures).__name__)
        raise PictureError(f"pictures: {kind}, expected an array of uint8")
    if pictures.ndim == 4:
        pictures = pictures[:, None]
    if pictures.ndim != 5 or pictures.shape[4] != 3 or 0 in pictures.shape:
        raise PictureError(
            f"pictures: {list(pictures.shape)}, expected [objects, height, width, 3] or "
            "[objects, views, height, width, 3]"
        )
    names = [f"object{i + 1}" for i in range(len(pictures))]
    return Objects(names, list(range(pictures.shape[1])), pictures, None)


def _reading(resize: int | None, scale_depth: bool) -> tuple[int, bool]:
    """The pixels of a side, 0 for as many as there are, and whether to scale 16 bits to 8."""
    side = 0 if resize is None else whole("resize", resize, 8, 4096)
    return side, flag("scale_depth", scale_depth)


def read(
    path: str | Path, resize: int | None = None, scale_depth: bool = False
) -> npt.NDArray[np.uint8]:
    """Read a picture from a file, upright as its EXIF orientation says.

    Parameters
    ----------
    path : str or Path
        PNG, JPEG, WebP, BMP, TIFF, PPM or PGM.
    resize : int or None
        Scale the picture to this many pixels a side, [8, 4096]. None: leave it as it is.
    scale_depth : bool
        Whether to scale 16 bits a channel to 8; otherwise they are refused.

    Returns
    -------
    ndarray of uint8, [height, width, 3]
        Red first; a grey picture has three equal channels.

    Raises
    ------
    ImportError
        The vision module is missing. The message says what to install.
    PictureError
        The file is no picture that can be used, or was cut short. The message names it.
    """
    library = _native.load_optional("rlvc-objects", _native.OBJECTS)
    handle, text = ctypes.c_void_p(), ctypes.create_string_buffer(512)
    status = library.rlvc_shim_objects_read(
        os.fsencode(checked_name("picture", path, PictureError)),
        *_reading(resize, scale_depth),
        ctypes.byref(handle),
        text,
        len(text),
    )
    if status != 0:
        raise PictureError(text.value.decode(errors="replace"))
    try:
        sizes = [ctypes.c_uint32() for _ in range(3)]
        library.rlvc_shim_objects_size(handle, *(ctypes.byref(size) for size in sizes))
        picture = np.empty((sizes[1].value, sizes[2].value, 3), np.uint8)
        library.rlvc_shim_objects_copy(handle, 0, 0, picture.ctypes.data)
    finally:
        library.rlvc_shim_objects_free(handle)
    return picture


def find(
    folder: str | Path | None = None,
    angles: Sequence[int] = (0,),
    wanted: int = 1,
    resize: int | None = None,
    scale_depth: bool = False,
) -> Objects:
    """Read objects from a folder, or render them, like ``run_gridworld tiled``.

    Parameters
    ----------
    folder : str, Path or None
        Pictures named ``objN__ANGLE.*`` as in COIL-100; or other pictures with one object each; or
        a folder for each object, whose pictures, by their names, have the angles 0, 1, ... None:
        render objects.
    angles : sequence of int
        In degrees, [0, 360). Objects without a picture from each angle are left out.
    wanted : int
        Minimum number of objects, [1, 65536]; exactly this many are rendered.
    resize : int or None
        Scale pictures to this many pixels a side, [8, 4096]. None: all must have one size.
    scale_depth : bool
        Whether to scale pictures of 16 bits a channel to 8; otherwise they are refused.

    Returns
    -------
    Objects

    Raises
    ------
    ImportError
        The vision module is missing. The message says what to install.
    PictureError
        There are fewer objects, or a picture cannot be used. The message names it.
    RangeError
        An angle or ``wanted`` is out of range.
    """
    library = _native.load_optional("rlvc-objects", _native.OBJECTS)
    each = listed("angles", angles, "numbers", RangeError)
    chosen = list(dict.fromkeys(whole("angles", angle, 0, 359, RangeError) for angle in each))
    if not chosen:
        raise RangeError("angles: give at least one")
    count = whole("wanted", wanted, 1, 65536, RangeError)
    where = "" if folder is None else checked_name("pictures", folder, PictureError)
    handle, text = ctypes.c_void_p(), ctypes.create_string_buffer(512)
    numbers = np.array(chosen, np.int32)
    status = library.rlvc_shim_objects_find(
        os.fsencode(where),
        numbers.ctypes.data,
        len(chosen),
        count,
        *_reading(resize, scale_depth),
        ctypes.byref(handle),
        text,
        len(text),
    )
    if status != 0:
        raise PictureError(text.value.decode(errors="replace"))
    try:
        sizes = [ctypes.c_uint32() for _ in range(3)]
        library.rlvc_shim_objects_size(handle, *(ctypes.byref(size) for size in sizes))
        count, height, width = (size.value for size in sizes)
        names = [library.rlvc_shim_objects_name(handle, i).decode() for i in range(count)]
        pictures = np.empty((count, len(chosen), height, width, 3), np.uint8)
        for i in range(count):
            for j, angle in enumerate(chosen):
                library.rlvc_shim_objects_copy(handle, i, angle, pictures[i, j].ctypes.data)
    finally:
        library.rlvc_shim_objects_free(handle)
    return Objects(names, chosen, pictures, where)
