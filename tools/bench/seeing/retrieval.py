#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How well vectors find things again: descriptors of the library and of OpenCV over all conditions.

    RLVC_COIL100=DIR tools/bench/seeing/retrieval.py [ROW ...] [--runs N] [--seed N]

A run knows half of the objects by one picture each, from the front before black; metrics are fitted to
the other half. What is asked: pictures from +-10, 20 or 30 degrees, turned by 30 in their plane, at 0.7
and 1.25 times the size, with 10 and 20 % covered by one colour, and before photographs; noise 3 and light
+-5 % in all. Two numbers of each condition, in percent:

    found     pictures whose object has the most vectors near theirs. Each vector of a picture votes for the
              object that has the nearest to it, the more the farther away those of all other objects are
    hits      features that are present: vectors of the known picture that have one within tau. tau is such
              that 5 % of other objects' pictures (from the front) have one

Rows with points are the library's, in bytes. SIFT, RootSIFT, ORB and AKAZE are OpenCV's with their own
points, the 120 strongest. Prints Markdown. Needs OpenCV 4 (5 has no AKAZE), scikit-image and scikit-learn."""

import cv2
import numpy as np

import command_line
import objects
import outside
import rlvc.vision

STRONGEST = 120
FALSE = 0.05  # of other objects' pictures


def own(descriptor, sigma, points, axes=0, **options):
    """A row of the library: what makes a function from pictures to vectors, given the other objects."""
    def make(others, random):
        config = {"sigma": sigma, "points": points}
        if axes:
            metric = outside.make_metric(others, random, config)
        else:
            pictures = [objects.picture(n, angle) for n in others for angle in (0, 10)]
            pairs = [(objects.picture(n, 0), objects.picture(n, angle), "views")
                     for n in others for angle in (10, -10)]
            metric = rlvc.vision.Metric.fit(
                pictures, np.repeat(others, 2), pairs=pairs, share=0.05, **options,
                config=rlvc.vision.VisionConfig(descriptor, **config))
        extractor = rlvc.vision.Extractor(metric=metric, form="int8")
        return lambda picture: extractor.look(picture).vectors.astype(np.float32)
    return make


def strongest(detector, turn):
    """A row of OpenCV: its strongest points, and what becomes of their vectors."""
    def describe(picture):
        grey = cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY)
        points = sorted(detector.detect(grey, None), key=lambda point: -point.response)[:STRONGEST]
        _, vectors = detector.compute(grey, points)
        return turn(vectors) if vectors is not None else np.zeros((0, 1), np.float32)
    return lambda others, random: describe


def bits(vectors):
    """Squared distances of these are Hamming's."""
    return np.unpackbits(vectors, axis=1).astype(np.float32)


ROWS = {
    "sift-upright, sigma 6, 16 axes, 30 points": own("sift-upright", 6.0, 30, axes=16),
    "sift-upright, sigma 4, 16 axes, 60 points": own("sift-upright", 4.0, 60, axes=16),
    "sift-upright, sigma 2.5, 16 axes, 120 points": own("sift-upright", 2.5, 120, axes=16),
    "sqrt-invariants, sigma 2.5, 30 points": own("sqrt-invariants", 2.5, 30, kind="change"),
    "orb, 30 points": own("orb", 2.5, 30, kind="plain"),
    "OpenCV SIFT": strongest(cv2.SIFT_create(), lambda v: v),
    "OpenCV RootSIFT": strongest(
        cv2.SIFT_create(), lambda v: np.sqrt(v / np.maximum(v.sum(1, keepdims=True), 1e-9))),
    "OpenCV ORB": strongest(cv2.ORB_create(500, edgeThreshold=15, patchSize=15), bits),
    "OpenCV AKAZE": strongest(cv2.AKAZE_create(threshold=1e-4), bits),
}


def conditions(random):
    """What is done to an object for each condition."""
    def pose(degrees):
        return lambda n: objects.picture(n, degrees * random.choice((-1, 1)))

    def changed(change):
        return lambda n: change(objects.picture(n, 0))

    return {
        "pose 10": pose(10), "pose 20": pose(20), "pose 30": pose(30),
        "turn 30": changed(lambda p: objects.turned(p, 30)),
        "x 0.7": changed(lambda p: objects.scaled(p, 0.7)),
        "x 1.25": changed(lambda p: objects.scaled(p, 1.25)),
        "cover 10 %": changed(lambda p: objects.covered(p, 0.1, random)),
        "cover 20 %": changed(lambda p: objects.covered(p, 0.2, random)),
        "clutter": changed(lambda p: objects.before(p, outside.TESTED, random)),
    }


def squares(a, b):
    """Squared distances [a, b]."""
    made = (a**2).sum(1)[:, None] + (b**2).sum(1) - 2 * a @ b.T
    return np.maximum(made, 0)


def nearest(vectors, of_objects):
    """From each vector to the nearest of each object [vectors, objects]; infinite if it has none."""
    return np.stack([squares(vectors, known).min(1) if len(known) else np.full(len(vectors), np.inf)
                     for known in of_objects], 1)


def vote(distances):
    """The object that a picture's vectors [vectors, objects] are most like; -1 without a vector."""
    if len(distances) == 0:
        return -1
    ordered = np.sort(distances, 1)
    weight = 1 - np.sqrt((ordered[:, 0] + 1e-9) / (ordered[:, 1] + 1e-9))
    return int(np.bincount(distances.argmin(1), np.nan_to_num(weight), distances.shape[1]).argmax())


def tau_of(known, fronts):
    """The squared distance within which 5 % of other objects' pictures have a vector."""
    found = []
    for number, vectors in enumerate(known):
        others = [seen for i, seen in enumerate(fronts) if i != number and len(seen)]
        if len(vectors) and others:
            found.append(nearest(vectors, others).ravel())
    return np.quantile(np.concatenate(found), FALSE)


def run(make, seed):
    """{condition: (found, hits)}"""
    random = np.random.default_rng(seed)
    every = random.permutation(objects.objects((0, 10, -10, 20, -20, 30, -30)))
    half = len(every) // 2
    describe = make(every[half:], random)
    known = [describe(objects.disturbed(objects.picture(n, 0), random)) for n in every[:half]]
    fronts = [describe(objects.disturbed(objects.picture(n, 0), random)) for n in every[:half]]
    tau = tau_of(known, fronts)
    made = {}
    for condition, change in conditions(random).items():
        found, hits = [], []
        for number, name in enumerate(every[:half]):
            seen = describe(objects.disturbed(change(name), random))
            found.append(len(seen) > 0 and vote(nearest(seen, known)) == number)
            if len(known[number]):
                near = nearest(known[number], [seen])[:, 0] <= tau
                hits.append(near.mean())
        made[condition] = 100 * np.mean(found), 100 * np.mean(hits)
    return made


def main():
    parser = command_line.parser_of(__doc__, runs=5)
    command_line.add_names(parser, "row", ROWS)
    options = parser.parse_args()
    for i, row in enumerate(options.rows):
        results = [run(ROWS[row], options.seed + k) for k in range(options.runs)]
        if i == 0:
            print(f"| found / hits, % | {' | '.join(results[0])} |\n|---{'|---' * len(results[0])}|")
        cells = [np.mean([result[condition] for result in results], 0) for condition in results[0]]
        print(f"| {row} | {' | '.join(f'{found:.0f} / {hits:.0f}' for found, hits in cells)} |", flush=True)


if __name__ == "__main__":
    main()
