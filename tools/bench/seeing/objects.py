# SPDX-License-Identifier: MIT
"""Photographs of objects: the folder of COIL-100 that RLVC_COIL100 names, and what may happen to a
picture between two looks at it."""

from __future__ import annotations

import functools
import os
import pathlib
import sys

import cv2
import numpy as np

cv2.setNumThreads(1)
SIDE = 128


@functools.cache
def folder():
    name = os.environ.get("RLVC_COIL100")
    if not name:
        sys.exit("RLVC_COIL100 must name a folder of COIL-100 pictures")
    return pathlib.Path(name)


@functools.cache
def picture(number, angle):
    """An object seen from an angle in degrees, red first."""
    return cv2.imread(str(folder() / f"obj{number}__{angle % 360}.png"))[:, :, ::-1].copy()


@functools.cache
def objects(angles):
    """The numbers of the objects that were photographed from all these angles."""
    names = {path.name for path in folder().glob("obj*__*.png")}
    numbers = {int(name[3:].split("__")[0]) for name in names}
    return [n for n in sorted(numbers)
            if all(f"obj{n}__{angle % 360}.png" in names for angle in angles)]


def disturbed(picture, random, noise=3.0, light=0.05):
    """The picture in other light, with other noise."""
    scaled = picture.astype(np.float32) * (1 + light * random.uniform(-1, 1))
    scaled += noise * random.standard_normal(picture.shape, np.float32)
    return np.clip(scaled, 0, 255).astype(np.uint8)


def turned(picture, degrees):
    """The picture turned about its centre, in a frame that has room for every turn."""
    height, width = picture.shape[:2]
    side = int(np.hypot(height, width)) + 2
    matrix = cv2.getRotationMatrix2D((width / 2, height / 2), degrees, 1)
    matrix[:, 2] += (side - width) / 2, (side - height) / 2
    return cv2.warpAffine(picture, matrix, (side, side))
