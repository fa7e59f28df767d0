#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Asks whether another classifier would see better (section 7): a tree, naive Bayes and a forest.

    RLVC_COIL100=DIR tools/bench/seeing/classifiers.py [--runs N] [--seed N]

All of them get the same presences: which of 512 vectors, drawn from the pictures that are learnt from,
are within tau in a picture. Pictures are those of outside.py: 33 objects, learnt from black or from
clutter, tested in each condition. Each object wants one of four actions, drawn at random; an answer is
right with 25 % by chance. The tree is the library's on these bits (discount 0, each action tried at each
picture); the others are scikit-learn's: naive Bayes on the bits that the tree tests, naive Bayes on all,
and 100 extremely random trees on all. Prints Markdown. Needs scikit-image and scikit-learn."""

import numpy as np
from sklearn.ensemble import ExtraTreesClassifier
from sklearn.naive_bayes import BernoulliNB

import command_line
import objects
import outside
import rlvc
import rlvc.vision

FEATURES, ACTIONS = 512, 4
WINDOWS = {"sigma 6, 30 points": {"sigma": 6.0, "points": 30},
           "sigma 2.5, 120 points": {"sigma": 2.5, "points": 120}}
NAMES = ("tree", "Bayes on the tree's bits", "Bayes on all", "forest")


class Presences:
    """Which of the features a percept exhibits."""

    def __init__(self, domain, percepts, random):
        self.domain = domain
        vectors = np.concatenate([self.vectors(percept) for percept in percepts])
        self.features = vectors[random.choice(len(vectors), FEATURES, replace=False)].astype(float)

    def vectors(self, percept):
        count = int(np.frombuffer(percept, np.uint32, 1)[0])
        size = count * self.domain.dimensions
        return np.frombuffer(percept, np.int8, size, 4).reshape(count, -1)

    def of(self, percept):
        vectors = self.vectors(percept).astype(float)
        if len(vectors) == 0:
            return np.zeros(FEATURES, bool)
        squares = ((self.features[:, None] - vectors) ** 2).sum(2).min(1)
        return squares <= self.domain.parameters[2] ** 2


def packed(presences):
    return np.packbits(presences, axis=-1, bitorder="little")


def grown(presences, wanted, seed):
    """The library's tree, and which bits it tests."""
    agent = rlvc.Agent(rlvc.Bits(FEATURES), rlvc.Config(
        ACTIONS, capacity=ACTIONS * len(wanted), classes=256, discount=0.0, successors=False, seed=seed))
    for row, right in zip(packed(presences), wanted, strict=True):
        for action in range(ACTIONS):
            agent.begin(row)
            agent.observe(action, float(action == right), None, terminated=True)
    agent.learn()
    tested = sorted({int(split.name.split()[1]) for split in agent.splits})
    return agent, tested


def run(config, seed, name):
    """{condition: the share of right answers of each classifier}"""
    random = np.random.default_rng(seed)
    maze = outside.Maze()
    shuffled = random.permutation(objects.objects((*outside.SEEN, *outside.HELD_OUT, *outside.BEYOND)))
    metric = outside.make_metric(shuffled[maze.cells:], random, config)
    extractor = rlvc.vision.Extractor(metric=metric, form="int8")
    scenes = outside.Scenes(shuffled[:maze.cells], extractor, random)
    action_of = random.integers(ACTIONS, size=maze.cells)
    learnt = [(percept, action_of[i]) for i, seen in enumerate(scenes.learnt(name)) for percept in seen]
    seer = Presences(extractor.domain(), [percept for percept, _ in learnt], random)
    rows = np.array([seer.of(percept) for percept, _ in learnt])
    wanted = np.array([action for _, action in learnt])
    agent, tested = grown(rows, wanted, seed)
    small, whole = BernoulliNB().fit(rows[:, tested], wanted), BernoulliNB().fit(rows, wanted)
    forest = ExtraTreesClassifier(100, random_state=seed).fit(rows, wanted)
    made = {}
    for condition, pictures in scenes.tested(name).items():
        seen = np.array([seer.of(percept) for cell in pictures for percept in cell])
        right = np.repeat(action_of, [len(cell) for cell in pictures])
        answers = (agent.predict(packed(seen)).action, small.predict(seen[:, tested]),
                   whole.predict(seen), forest.predict(seen))
        made[condition] = [np.mean(answer == right) for answer in answers]
    return made


def main():
    parser = command_line.parser_of(__doc__, runs=5)
    options = parser.parse_args()
    print(f"| window | learnt from | test | {' | '.join(NAMES)} |\n|---|---|---|---|---|---|---|")
    for window, config in WINDOWS.items():
        for name in ("black", "clutter"):
            results = [run(config, options.seed + i, name) for i in range(options.runs)]
            for condition in results[0]:
                shares = 100 * np.mean([result[condition] for result in results], 0)
                cells = " | ".join(f"{share:.1f}" for share in shares)
                print(f"| {window} | {name} | {condition} | {cells} |", flush=True)


if __name__ == "__main__":
    main()
