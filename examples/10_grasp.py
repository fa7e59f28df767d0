#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Learns to grasp by sight: how wide to open a hand, and how high to hold it (discount 0).

10_grasp.py [PICTURES [SEED]]

An episode is one look and one try. The actions are a grid of three openings and three heights; a try
earns 1 if the hand is neither too narrow nor too wide for the thing, and at the height of its middle,
else 0. Nothing says what the thing is. Things are seen from 0 and +-20 degrees while learning, and
tried from +-10. PICTURES is a folder such as that of COIL-100; without it, or if it is "", things are
rendered. SEED chooses the things and the tries. Needs a package that was made where OpenCV is.
"""

import sys

import numpy as np

import rlvc
from rlvc import objects, vision

THINGS, TRIES, GRID = 8, 1000, 3
LEARNT, HELD_OUT = (0, 20, 340), (10, 350)


def outline(picture):
    """The width of what stands out from the background, and the height of its middle, in pixels."""
    background = np.median(picture[:, [0, -1]], (0, 1))
    shown = np.abs(picture - background).max(2) > 40
    columns, rows = (np.flatnonzero(shown.sum(axis) > 5) for axis in (0, 1))
    return np.ptp(columns), (rows[0] + rows[-1]) / 2


def thirds(values):
    """Which third of the values each is in: 0, 1 or 2."""
    return np.searchsorted(np.quantile(values, [1 / 3, 2 / 3]), values, side="right")


def disturbed(picture):
    """The picture in other light and with other noise."""
    changed = picture * random.uniform(0.95, 1.05) + 3 * random.standard_normal(picture.shape)
    return np.clip(changed, 0, 255).astype(np.uint8)


folder, seed = (*sys.argv[1:], *("", "1")[len(sys.argv) - 1 :])
random = np.random.default_rng(int(seed))
found = objects.find(folder or None, (*LEARNT, *HELD_OUT), THINGS)
things = random.permutation(len(found.names))[:THINGS]
widths, middles = np.array([outline(found.view(thing, 0)) for thing in things]).T
right = GRID * thirds(widths) + thirds(middles)

pairs = [(found.view(t, 0), found.view(t, angle), "views") for t in things for angle in LEARNT[1:]]
pairs += [(found.view(t, 0), disturbed(found.view(t, 0)), "copies") for t in things]
metric = vision.Metric.fit(
    [found.view(t, 0) for t in things], pairs=pairs, kind="discriminant", axes=16, share=0.035
)
eye = vision.Eye(vision.Extractor(metric=metric, form="int8"))
agent = rlvc.Agent(
    eye.domain,
    GRID * GRID,
    capacity=TRIES,
    discount=0.0,
    explore="uniform",
    epsilon=1.0,
    seed=int(seed),
)
for i in range(TRIES):
    which = random.integers(THINGS)
    agent.begin(eye.encode(disturbed(found.view(things[which], LEARNT[random.integers(3)]))))
    choice = agent.act()
    agent.observe(choice, float(choice.action == right[which]), None, terminated=True)
    if (i + 1) % 250 == 0:
        agent.learn()
        grasped = [
            agent.predict(eye.encode(disturbed(found.view(thing, angle)))).action == action
            for thing, action in zip(things, right, strict=True)
            for angle in HELD_OUT
            for _ in range(5)
        ]
        print(f"{i + 1} tries: {agent.classes} classes, held-out grasps: {np.mean(grasped):.3f}")
