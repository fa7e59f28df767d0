#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Introduces pictures as percepts: learns the Tiled Gridworld and draws it as figures 4 and 5 do.

06_tiled_figures.py [FOLDER [PICTURES]]

PICTURES is a folder such as that of COIL-100; without it objects are rendered. Needs a package that was
made where OpenCV is.
"""

import pathlib
import sys

import rlvc
import rlvc.envs
from rlvc import plot, report, vision

folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
pictures = sys.argv[2] if len(sys.argv) > 2 else None
env = rlvc.envs.TiledGridworld(rlvc.envs.SMALL, pictures, placement=1)
metric = vision.Metric.fit(
    env.objects.pictures[:, 0], sigma=4.0, form="int8", normalise=True, share=0.035
)
eye = vision.Eye(vision.Extractor(metric=metric))
run = rlvc.learn(env, 1000, encoder=eye, every=500, seed=1, discount=0.9)
print("mean return:", run.evaluate(env, episodes=100, seed=1).mean)
made = report.make(run, env)
for suffix in ("png", "svg"):
    plot.tiles(made, folder / f"tiles.{suffix}", env.objects)
    plot.features(made, folder / f"features.{suffix}", env.objects)
    print(folder / f"features.{suffix}")
