#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Introduces frames with a log beside: learns to sort things from what a camera saw.

11_frames.py [FOLDER]

A camera looked at a belt. At each frame someone chose one of two boxes, and was told whether the thing
belonged there. FOLDER ("frames") gets the frames, and log.csv with a row for each: the frame, the
action, the reward, and that nothing follows from it (done). Then the folder is learnt from, as

    python -m rlvc learn --frames FOLDER

does. Needs a package that was made where OpenCV is.
"""

import pathlib
import sys

import numpy as np

from rlvc import frames, objects

THINGS, FRAMES, TRIED = 6, 400, 60
random = np.random.default_rng(1)
views = objects.find(angles=(0, 15, 345), wanted=THINGS).pictures


def look():
    """A thing on the belt in some light, and the box that it belongs in."""
    thing, view = random.integers(THINGS), random.integers(3)
    picture = views[thing, view] * random.uniform(0.95, 1.05)
    picture = picture + 3 * random.standard_normal(picture.shape)
    return np.clip(picture, 0, 255).astype(np.uint8), thing % 2


folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "frames")
folder.mkdir(parents=True, exist_ok=True)
lines = ["frame,action,reward,done"]
for i in range(FRAMES):
    picture, box = look()
    height, width = picture.shape[:2]
    header = f"P6 {width} {height} 255\n".encode()
    (folder / f"frame{i}.ppm").write_bytes(header + picture.tobytes())
    action = int(random.integers(2))
    lines.append(f"frame{i}.ppm,{action},{int(action == box)},1")
(folder / "log.csv").write_text("\n".join(lines) + "\n")

run = frames.learn_from_frames(folder, discount=0.0)
print(run)
tried = [look() for _ in range(TRIED)]
right = [run.predict(picture) == box for picture, box in tried]
print(f"{sum(right)} of {TRIED} new frames are sorted rightly")
