#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compares the search for a split with scikit-learn's exact one, in one run on one thread.

    scikit_learn.py BUILD/tools/bench/bench_search [--samples N] [--bits F] [--repeats R]

scikit-learn has no search over (feature, cutpoint of the target). One fit for each feature gives the
same answer: a tree of depth 1 by entropy, with the target as the only column and the feature's bit as
the label, splits at the cutpoint of the highest information gain. Our time includes sorting the samples,
detecting features and searching. Both must find the same split. Times are processor times.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np
import sklearn
from sklearn.tree import DecisionTreeClassifier


def make_samples(samples, bits, seed):
    """Normal targets; random bits, of which every sixth leans at a cutpoint of its own."""
    rng = np.random.default_rng(seed)
    target = rng.standard_normal(samples).astype(np.float32)
    percept = np.zeros(samples, "<u4")
    for bit in range(bits):
        chance = 0.5
        if bit % 6 == 5:
            chance = np.where(target > rng.standard_normal() / 2, 0.53, 0.47)
        percept |= (rng.random(samples) < chance).astype(np.uint32) << np.uint32(bit)
    return target, percept


def by_sklearn(column, percept, bits):
    """The best (gain, feature, samples at or below the threshold), and the seconds of all fits."""
    best = (0.0, None, None)
    seconds = 0.0
    for bit in range(bits):
        label = (percept >> np.uint32(bit) & np.uint32(1)).astype(np.intp)
        start = time.process_time()
        tree = DecisionTreeClassifier(criterion="entropy", max_depth=1).fit(column, label)
        seconds += time.process_time() - start
        tree = tree.tree_
        if tree.node_count < 3:
            continue
        below, above = tree.n_node_samples[1:3]
        gain = tree.impurity[0] - (tree.impurity[1] * below + tree.impurity[2] * above) / (
            below + above)
        if gain > best[0]:
            best = (gain, bit, below)
    return best, seconds


def by_rlvc(program, target, percept, bits, repeats):
    records = np.rec.fromarrays([target, percept], names="target,percept")
    with tempfile.NamedTemporaryFile() as file:
        file.write(records.tobytes())
        file.flush()
        out = subprocess.run([program, file.name, str(bits), str(repeats)], check=True,
                             capture_output=True, text=True).stdout
    found = json.loads(out)
    return (found["gain"], found["feature"], found["below"]), found["seconds"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", help="the program bench_search")
    parser.add_argument("--samples", type=int, default=1000000)
    parser.add_argument("--bits", type=int, default=18, help="features, 1 to 32")
    parser.add_argument("--repeats", type=int, default=3, help="of scikit-learn; ours has 5 times")
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()

    target, percept = make_samples(args.samples, args.bits, args.seed)
    ours, our_seconds = by_rlvc(args.program, target, percept, args.bits, 5 * args.repeats)
    column = target.reshape(-1, 1)
    runs = [by_sklearn(column, percept, args.bits) for _ in range(args.repeats)]
    theirs = runs[0][0]
    their_seconds = statistics.median(seconds for _, seconds in runs)

    print(f"{args.samples} samples, {args.bits} features; medians of processor time, one thread")
    for name, seconds, (gain, bit, below) in (
            (f"scikit-learn {sklearn.__version__}", their_seconds, theirs),
            ("rlvc", our_seconds, ours)):
        print(f"  {name:20} {seconds * 1e3:10.1f} ms   bit {bit} below {below}, gain {gain:.6g}")
    print(f"  {their_seconds / our_seconds:.0f} times as fast")
    if theirs[1:] != ours[1:] or abs(theirs[0] - ours[0]) > 1e-5 * theirs[0]:
        print("the two found different splits", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
