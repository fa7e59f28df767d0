#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Learns arrangements: what to do depends on how the same objects lie to each other.

    RLVC_COIL100=DIR tools/bench/seeing/arrangements.py [TASK ...] [--runs N] [--seed N]

Objects lie side by side, 40 pixels apart with 6 more or less, in new noise and light each time, seen
from 0 or +-20 degrees while learning and from +-10 in the test. left-of-2: which of two objects is
left. left-of-4: of two out of four. between-3: which of three is between the others, which takes a path
of pairs. turned-15, turned-180: left-of-2 with the picture turned by up to so many degrees; with 180 the
vectors and the displacements follow the points' directions. random: left-of-2 with rewards that are drawn,
where each split is one too many. The metric comes from other objects. A line tells the share of right
actions in the test (of random: whether the tree grew), and how many classes and pairs there are;
--single learns without pairs."""

import itertools

import numpy as np

import command_line
import objects
import rlvc
import rlvc.vision

GAP, JITTER = 40, 6
LEARNT, HELD_OUT = (0, 20, -20), (10, -10)
METRIC_OBJECTS = 20
SHARE = 0.035  # as run_gridworld tiled has it
TESTS = 200
STEPS = 6  # learning steps of a run
TASKS = {  # name: (objects there are, objects shown, interactions, degrees)
    "left-of-2": (2, 2, 300, 0),
    "left-of-4": (4, 2, 1500, 0),
    "between-3": (3, 3, 1500, 0),
    "turned-15": (2, 2, 600, 15),
    "turned-180": (2, 2, 600, 180),
    "random": (2, 2, 300, 0),
}


def scene(shown, angles, random, degrees):
    """A picture of objects side by side, from left to right."""
    step = objects.SIDE + GAP
    canvas = np.zeros((objects.SIDE + 2 * GAP, GAP + step * len(shown), 3), np.uint8)
    for k, number in enumerate(shown):
        y, x = (GAP + random.integers(-JITTER, JITTER + 1, 2)) + (0, step * k)
        angle = angles[random.integers(len(angles))]
        canvas[y:y + objects.SIDE, x:x + objects.SIDE] = objects.picture(number, angle)
    if degrees:
        canvas = objects.turned(canvas, random.uniform(-degrees, degrees))
    return objects.disturbed(canvas, random)


def make_extractor(others, random, degrees):
    """An extractor whose metric was fitted to other objects."""
    turns = degrees > 90
    pictures = [objects.picture(n, angle) for n in others for angle in LEARNT]
    pairs = [(objects.picture(n, 0), objects.picture(n, angle), "views")
             for n in others for angle in LEARNT[1:]]
    pairs += [(objects.picture(n, 0), objects.disturbed(objects.picture(n, 0), random), "copies")
              for n in others]
    config = rlvc.vision.VisionConfig("sift" if turns else "sift-upright", axes=16, form="int8",
                                      places="directed" if turns else "points")
    metric = rlvc.vision.Metric.fit(pictures, np.repeat(others, len(LEARNT)), pairs=pairs,
                                    config=config, kind="discriminant", share=SHARE)
    return rlvc.vision.Extractor(metric=metric, form="int8", places=config.places)


class Task:
    """One task with objects of its own."""

    def __init__(self, name, seed, single):
        self.name = name
        self.random = np.random.default_rng(seed)
        many, self.shown, self.interactions, self.degrees = TASKS[name]
        known = objects.objects((*LEARNT, *HELD_OUT))
        chosen = self.random.permutation(known)
        self.objects, others = chosen[:many], chosen[many:many + METRIC_OBJECTS]
        self.extractor = make_extractor(others, self.random, self.degrees)
        self.single = single
        self.orders = list(itertools.permutations(range(many), self.shown))

    def draw(self, angles):
        """A percept, and the action that is right."""
        order = self.orders[self.random.integers(len(self.orders))]
        picture = scene([self.objects[i] for i in order], angles, self.random, self.degrees)
        sight = self.extractor.look(picture)
        return sight.vectors if self.single else sight, order[1 if self.name == "between-3" else 0]

    def learn(self, domain):
        actions = len(self.objects)
        agent = rlvc.Agent(domain, rlvc.Config(actions, capacity=self.interactions, classes=64,
                                               discount=0.0, explore="uniform", epsilon=1.0,
                                               seed=int(self.random.integers(2**31))))
        for i in range(self.interactions):
            percept, right = self.draw(LEARNT)
            agent.begin(percept)
            choice = agent.act()
            reward = float(self.random.integers(2) if self.name == "random" else choice.action == right)
            agent.observe(choice, reward, None, terminated=True)
            if (i + 1) % (self.interactions // STEPS) == 0:
                agent.learn()
        return agent

    def test(self, agent):
        if self.name == "random":
            return float(agent.classes > 1)
        drawn = [self.draw(HELD_OUT) for _ in range(TESTS)]
        return float(np.mean([agent.predict(percept).action == right for percept, right in drawn]))


def run(name, seed, single):
    task = Task(name, seed, single)
    domain = task.extractor.domain()
    if single:
        domain = rlvc.Descriptors(*domain.parameters[:7])
    agent = task.learn(domain)
    pairs = sum("pair" in split.name for split in agent.splits)
    return task.test(agent), agent.classes, pairs


def main():
    parser = command_line.parser_of(__doc__, runs=20)
    command_line.add_names(parser, "task", TASKS)
    parser.add_argument("--single", action="store_true", help="without pairs")
    options = parser.parse_args()
    for name in options.tasks:
        results = np.array([run(name, options.seed + i, options.single) for i in range(options.runs)])
        right, classes, pairs = results.T
        print(f"{name:10}  mean {right.mean():.4f}  least {right.min():.4f}  classes {np.median(classes):.0f}"
              f" (at most {classes.max():.0f})  pairs {np.median(pairs):.0f}", flush=True)


if __name__ == "__main__":
    main()
