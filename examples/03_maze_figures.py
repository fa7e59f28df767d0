#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Introduces the plots: learns the paper's maze and draws it as figure 3 does.

03_maze_figures.py [FOLDER]
"""

import pathlib
import sys

import rlvc
import rlvc.envs
from rlvc import plot, report

folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
env = rlvc.envs.BinaryGridworld()
run = rlvc.learn(env, 2500, seed=1, discount=0.9)
made = report.make(run, env)
for kind in ("maze", "values", "curve", "splits", "tree"):
    plot.KINDS[kind](made, folder / f"{kind}.png")
    plot.KINDS[kind](made, folder / f"{kind}.svg")
    print(folder / f"{kind}.svg")
