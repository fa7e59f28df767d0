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


# ---------------------------------------------------------------------- what a camera sees elsewhere


@functools.cache
def photograph(name):
    """A photograph that scikit-image or scikit-learn ships, red first."""
    if name in ("china", "flower"):
        from sklearn.datasets import load_sample_image

        return load_sample_image(f"{name}.jpg").copy()
    from skimage import data

    picture = getattr(data, name)()
    return np.stack([picture] * 3, 2) if picture.ndim == 2 else picture[:, :, :3].copy()


def part_of(names, height, width, random):
    """A random part of one of these photographs."""
    whole = photograph(names[random.integers(len(names))])
    y = random.integers(whole.shape[0] - height + 1)
    x = random.integers(whole.shape[1] - width + 1)
    return whole[y:y + height, x:x + width]


def mask(picture, step=14):
    """Which pixels are the object: those that no one colour joins to the picture's corners."""
    height, width = picture.shape[:2]
    flooded = np.zeros((height + 2, width + 2), np.uint8)
    flags = 4 | cv2.FLOODFILL_FIXED_RANGE | cv2.FLOODFILL_MASK_ONLY | 255 << 8
    for corner in ((0, 0), (width - 1, 0), (0, height - 1), (width - 1, height - 1)):
        cv2.floodFill(picture.copy(), flooded, corner, 0, (step,) * 3, (step,) * 3, flags)
    return cv2.erode((flooded[1:-1, 1:-1] == 0).astype(np.uint8), np.ones((3, 3), np.uint8)) > 0


def before(picture, names, random):
    """The object before a part of one of these photographs."""
    made = part_of(names, *picture.shape[:2], random).copy()
    inside = mask(picture)
    made[inside] = picture[inside]
    return made


def covered(picture, share, random):
    """The picture with a rectangle of one colour over a share of it."""
    height, width = picture.shape[:2]
    shape = np.exp(random.uniform(-0.7, 0.7))  # width to height
    across = int(np.clip(np.sqrt(share * height * width * shape), 1, width))
    down = int(np.clip(share * height * width / across, 1, height))
    y, x = random.integers(height - down + 1), random.integers(width - across + 1)
    made = picture.copy()
    made[y:y + down, x:x + across] = random.integers(0, 256, 3)
    return made


def scaled(picture, size):
    """The picture of so many times the size about its centre, in the same frame."""
    height, width = picture.shape[:2]
    matrix = cv2.getRotationMatrix2D((width / 2 - 0.5, height / 2 - 0.5), 0, size)
    return cv2.warpAffine(picture, matrix, (width, height))
