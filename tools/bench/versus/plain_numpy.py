#!/usr/bin/env python3
#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compares learning the Tiled Gridworld with a plain numpy version of it, in one run on one thread.

    plain_numpy.py PATH/TO/run_gridworld [--seed S] [-- OPTIONS OF run_gridworld tiled]

run_gridworld learns and writes a snapshot. numpy reads the interactions from it and learns from them again, in
the same number of steps, with the same candidates, radii (margin rule), scores and corrected p-values, by
arrays over all features and samples of a class. Its distances are |a|^2 + |b|^2 - 2 a b by matrix products
(BLAS), or, with --by-difference, sums of squared differences for one feature at a time. The times are
processor times and do not include making vectors of pictures.

Values are solved within a tolerance, so targets differ in their last digits. Which of several samples with
nearly equal targets is drawn may then differ, and with it the tree. Compared are the number of classes and
the share of percepts for which both trees give the same value, within 1.
"""
import argparse
import json
import os
import struct
import subprocess
import sys
import tempfile
import time

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np
from scipy.stats import chi2, hypergeom

SUTTON = ["--noise", "3", "--light", "0.05", "--poses", "0,20,-20", "--test-poses", "10,-10"]
BINS, MEASURED, GAP_MIN, GAP_BEYOND, DRAWS_MAX = 64, 512, 7, 5, 64  # core/domains/descriptors.c


class Snapshot:
    """The interactions and the tree of a snapshot: see core/SPEC.md."""

    def __init__(self, data, dimensions):
        self.data, self.at = data, 16
        self.percept_bytes, self.feature_bytes = self.take("II")
        self.actions, _, _, _, self.min_samples, _, _ = self.take("7I")
        self.take("8B")
        self.discount, _, self.alpha, self.alpha_known, self.tolerance, _, _ = self.take("7f")
        self.take("QQIIIIIf")
        count = self.take("IIIIB")[1]
        slot = np.dtype([("count", "<u4"), ("numbers", "i1", self.percept_bytes - 4),
                         ("reward", "<f4"), ("label", "<u2"), ("action", "u1"), ("flags", "u1")])
        self.slots = np.frombuffer(data, slot, count, self.at)
        self.at += count * slot.itemsize
        self.points = (self.percept_bytes - 4) // dimensions
        numbers = self.slots["numbers"][:, :self.points * dimensions]
        self.vectors = numbers.reshape(count, self.points, dimensions)
        self.classes = self.take("I")[0]
        self.at += (self.classes - 1) * (28 + self.feature_bytes)
        value = np.frombuffer(data, np.dtype([("value", "<f4"), ("rest", f"V{4 + 12 * self.actions}")]),
                              self.classes, self.at)
        self.values = value["value"][np.minimum(self.slots["label"], self.classes - 1)]

    def take(self, form):
        made = struct.unpack_from("<" + form, self.data, self.at)
        self.at += struct.calcsize("<" + form)
        return made


def scatter(x):
    for _ in range(2):
        x = (x ^ x >> np.uint32(16)) * np.uint32(0x45d9f3b)
    return x ^ x >> np.uint32(16)


class Learner:
    def __init__(self, snapshot, options, by_difference):
        self.s, self.by_difference = snapshot, by_difference
        self.radius, self.margin, self.draws, self.candidates = (
            options[k] for k in ("radius", "margin", "draws", "candidates"))
        self.x = snapshot.vectors.astype(np.float32)
        self.dead = np.arange(snapshot.points) >= snapshot.slots["count"][:, None]
        self.squares = np.where(self.dead, np.float32(1e9), (self.x * self.x).sum(2))
        self.labels = np.zeros(len(self.x), int)
        self.known = 0  # slots that have a label
        self.tree, self.values = [], np.zeros(1)

    # ---------------------------------------------------------------- features

    def nearest(self, slots, features):
        """Squared distances of the nearest vectors, [slots][features]."""
        x = self.x[slots]
        if self.by_difference:
            made = [np.where(self.dead[slots], np.float32(1e9), ((x - f) ** 2).sum(2)).min(1)
                    for f in features]
            return np.stack(made, 1)
        products = x.reshape(-1, x.shape[2]) @ features.T
        products *= -2
        products += self.squares[slots].reshape(-1, 1)
        return products.reshape(*x.shape[:2], -1).min(1) + (features * features).sum(1)

    def gaps(self, slots, features):
        """The width and the radius of each feature's gap by the margin rule."""
        measured = min(len(slots), MEASURED)
        squared = self.nearest(slots[np.arange(measured) * len(slots) // measured], features)
        low = np.float32(self.radius / self.margin)
        step = (np.float32(self.radius * self.margin) - low) / np.float32(BINS)
        edges = (low + step * np.arange(BINS + 1, dtype=np.float32)) ** 2
        place = np.searchsorted(edges, squared, side="right")  # 0: nearer, BINS + 1: farther
        counts = np.zeros((BINS + 2, len(features)), int)
        np.add.at(counts, (place, np.arange(len(features))[None]), 1)
        below, row = counts[0].copy(), np.zeros(len(features), int)
        width, radius = np.zeros(len(features), int), np.zeros(len(features), np.float32)
        for b in range(BINS):
            open_ = below < measured
            row = np.where(counts[b + 1] == 0, row + 1, 0)
            below += counts[b + 1]
            better = open_ & (row > width) & (below > 0)
            width[better] = row[better]
            radius[better] = low + step * (b + 1 - row[better] / GAP_BEYOND)
        return width, radius

    def propose(self, slots, keys):
        """The candidates of a class: features and radii."""
        begins = np.flatnonzero(np.append(True, keys[1:] != keys[:-1]))
        ends = np.append(begins[1:], len(keys))
        number = np.arange(self.candidates)
        run = number % len(begins) if len(begins) < self.candidates else (
            number * len(begins) // self.candidates)
        draw = np.arange(self.draws)
        chance = scatter((number[:, None] * DRAWS_MAX + draw + 1).astype(np.uint32))
        slot = slots[begins[run][:, None] + chance % (ends - begins)[run][:, None]]
        count = self.s.slots["count"][slot]
        pick = scatter(chance) % np.maximum(count, 1)
        drawn = self.x[slot, pick]
        width, radius = self.gaps(slots, drawn.reshape(-1, drawn.shape[2]))
        width = np.where(count > 0, width.reshape(slot.shape), 0)
        radius, taken, found = radius.reshape(slot.shape), set(), []
        for i in number:
            best, at = GAP_MIN - 1, None
            for t in draw:
                if width[i, t] > best and drawn[i, t].tobytes() not in taken:
                    best, at = width[i, t], t
            if at is not None:
                taken.add(drawn[i, at].tobytes())
                found.append((drawn[i, at], radius[i, at]))
        return found

    # ---------------------------------------------------------------- splits

    def cutpoints(self, targets):
        cuts, at = [], 0
        while True:
            at = int(np.searchsorted(targets, targets[at] + 2 * self.s.tolerance, side="right"))
            if at == len(targets):
                return np.array(cuts, int)
            cuts.append(at)

    def search(self, groups):
        """The best split of a class of which these are the (slots, targets) after each action."""
        groups = [(slots[order], targets[order]) for slots, targets in groups
                  for order in [np.argsort(targets, kind="stable")]]
        slots, keys = (np.concatenate(part) for part in zip(*groups))
        if len(slots) < self.s.min_samples:
            return None
        parts = self.parts(groups)
        if sum(end - begin for begin, end, _ in parts) < self.s.min_samples:
            return None
        found = self.propose(slots, keys)
        if not found:
            return None
        features, radii = np.stack([f for f, _ in found]), np.array([r for _, r in found])
        present = self.nearest(slots, features) <= radii * radii
        return self.weigh(parts, present, features, radii)

    def parts(self, groups):
        """Where the samples of each action begin and end, and their cutpoints, if there are any."""
        parts, begin = [], 0
        for slots, targets in groups:
            end = begin + len(slots)
            cuts = self.cutpoints(targets) if len(slots) else []
            if len(cuts):
                parts.append((begin, end, cuts))
            begin = end
        return parts

    def weigh(self, parts, present, features, radii):
        f = np.arange(present.shape[1])
        evidence, statistic, log_tests = np.zeros((3, len(f)))
        degrees, alone, cuts_of_all = np.zeros(len(f), int), (0.0, None), 0
        for begin, end, cuts in parts:
            n, a = end - begin, np.cumsum(present[begin:end], axis=0)[cuts - 1]
            total = present[begin:end].sum(0)
            table = np.stack([a, cuts[:, None] - a, total - a, n - cuts[:, None] - total + a])
            score = gain(table.astype(float))
            best = score.argmax(0)
            divides = (total > 0) & (total < n)
            mine = np.where(divides, score[best, f] * n, 0)
            degrees += divides
            log_tests += divides * np.log(len(cuts))
            evidence += mine
            statistic += np.where(divides, summand(table[:, best, f]), 0)
            cuts_of_all += len(cuts)
            if mine.max() > alone[0]:
                j = mine.argmax()
                alone = (mine[j], j, table[:, best[j], j])
        if alone[1] is None:
            return None
        j, log_p = alone[1], log_p_alone(alone[2]) + np.log(cuts_of_all)
        if len(parts) > 1:
            both = evidence.argmax()
            together = chi2.logsf(statistic[both], degrees[both]) + log_tests[both]
            j, log_p = (both, together) if together < log_p else (j, log_p)
            log_p += np.log(2)
        log_p += np.log((degrees > 0).sum())
        new = not any(np.array_equal(features[j], split[1]) and radii[j] == split[2]
                      for split in self.tree)
        if log_p < self.log_level or (not new and log_p < np.log(self.s.alpha_known)):
            return features[j], radii[j]
        return None

    # ---------------------------------------------------------------- the loop

    def solve(self, at, following):
        """Value iteration over the transitions from the slots `at`."""
        classes, actions = len(self.values), self.s.actions
        pair = self.labels[at] * actions + self.s.slots["action"][at]
        tried = np.bincount(pair, minlength=classes * actions)
        reward = np.bincount(pair, self.s.slots["reward"][at], classes * actions)
        goes = following >= 0
        to = np.zeros((classes * actions, classes))
        np.add.at(to, (pair[goes], self.labels[following[goes]]), 1)
        times = np.maximum(tried, 1)
        reward, to = reward / times, to / times[:, None]
        gamma, values, change = self.s.discount, self.values, np.inf
        while change > self.s.tolerance * (1 - gamma) / gamma:
            q = np.where(tried > 0, reward + gamma * (to @ values), -np.inf)
            best = q.reshape(classes, actions).max(1)
            after = np.where(np.isfinite(best), best, values)
            change = np.abs(after - values).max()
            values = after
        self.values = values

    def relabel(self, slots, split):
        class_id, feature, radius, made = split
        inside = slots[self.labels[slots] == class_id]
        if len(inside):
            has = self.nearest(inside, feature[None])[:, 0] <= radius * radius
            self.labels[inside[has]] = made

    def step(self, k, interactions):
        """Learning step k, from the first so many interactions."""
        s, d = self.s, (k + 1).bit_length()
        self.log_level = np.log(s.alpha / (d * (d + 1) * 2 ** (d - 1)))  # core/SPEC.md, "The level"
        at = np.flatnonzero(s.slots["flags"] & 1)[:interactions]
        following = np.where(s.slots["flags"][at] & 4, -1, at + 1)
        end = max(at[-1], following[-1]) + 1
        for split in self.tree:
            self.relabel(np.arange(self.known, end), split)
        self.known = end
        while True:
            self.solve(at, following)
            ahead = np.where(following < 0, 0, self.values[self.labels[following]])
            targets = (s.slots["reward"][at] + s.discount * ahead).astype(np.float32)
            splits = []
            for c in range(len(self.values)):
                mine = [np.flatnonzero((self.labels[at] == c) & (s.slots["action"][at] == a))
                        for a in range(s.actions)]
                found = self.search([(at[i], targets[i]) for i in mine])
                if found:
                    splits.append((c, *found, len(self.values) + len(splits)))
            if not splits:
                return
            for split in splits:
                self.relabel(np.arange(end), split)
                self.values = np.append(self.values, self.values[split[0]])
            self.tree += splits


def gain(table):
    """Information gain of the 2 x 2 tables (a, b, c, d), in bits."""
    def information(*counts):
        whole = sum(counts)
        return sum(c * np.log2(np.where(c > 0, whole / np.maximum(c, 1), 1)) for c in counts)
    a, b, c, d = table
    whole = a + b + c + d
    return (information(a + b, c + d) - information(a, c) - information(b, d)) / whole


def pearson(table):
    a, b, c, d = table
    product = (a + b) * (c + d) * (a + c) * (b + d)
    return (a + b + c + d) * (a * d - b * c) ** 2 / np.maximum(product, 1)


def least_expected(table):
    a, b, c, d = table
    return np.minimum(a + b, c + d) * np.minimum(a + c, b + d) / (a + b + c + d)


def summand(table):
    """What the 2 x 2 tables add to a sum of statistics."""
    table = table.astype(float)
    ratio = 2 * np.log(2) * table.sum(0) * gain(table)
    return np.where(least_expected(table) < 1, ratio, pearson(table))


def log_p_alone(table):
    """Of one table by itself: Fisher's where a count below 5 is expected."""
    if least_expected(table) >= 5:
        return chi2.logsf(pearson(table.astype(float)), 1)
    a, b, c, d = (int(x) for x in table)
    law = hypergeom(a + b + c + d, a + b, a + c)
    return min(0.0, np.log(2) + (law.logsf(a - 1) if a * d >= b * c else law.logcdf(a)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", help="the run_gridworld that was built")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--by-difference", action="store_true")
    parser.add_argument("options", nargs="*", help=f"default: {' '.join(SUTTON)}")
    args = parser.parse_args()
    folder = os.environ.get("RLVC_COIL100")
    pictures = ["--images", folder] if folder else []
    with tempfile.TemporaryDirectory() as made:
        report, kept = os.path.join(made, "report"), os.path.join(made, "snapshot")
        subprocess.run([args.program, "tiled", *pictures, *(args.options or SUTTON), "--seed",
                        str(args.seed), "--json", report, "--snapshot", kept], check=True,
                       stdout=subprocess.DEVNULL)
        with open(report) as file:
            report = json.load(file)
        with open(kept, "rb") as file:
            data = file.read()
    features, run = report["features"], report["runs"][0]
    if features["form"] != "int8" or features["margin"] <= 1:
        sys.exit("plain_numpy.py: only for int8 vectors and the margin rule")
    snapshot = Snapshot(data, features["dimensions"])
    interactions, steps = run["interactions"], report["options"]["steps"]
    start = time.process_time()
    learner = Learner(snapshot, features, args.by_difference)
    for k in range(steps):
        learner.step(k, interactions * (k + 1) // steps)
    seconds = time.process_time() - start

    same = np.abs(learner.values[learner.labels] - snapshot.values) < 1
    print(f"{interactions} interactions, {steps} steps; seconds of the processor, one thread")
    print(f"  numpy {np.__version__:14} {seconds:8.2f} s   {len(learner.values)} classes")
    print(f"  {'rlvc':20} {run['seconds']:8.2f} s   {snapshot.classes} classes")
    print(f"  {seconds / run['seconds']:.1f} times as fast; "
          f"{100 * same.mean():.1f} % of the percepts have the same value by both")


if __name__ == "__main__":
    main()
