# SPDX-License-Identifier: MIT
"""Reinforcement learning of classes, plainly: a second implementation of the method in numpy.

It follows the paper (sections cited) and the rules that the core's headers state; it is written to be
read, in double precision and without a thought for memory or time. Percepts are vectors of bits, features
are the numbers of bits.
"""
import functools
from dataclasses import dataclass

import numpy
import scipy.stats

RETURNS, RESIDUAL = 0, 1
GAIN, RANKS = 0, 3


@dataclass
class Interaction:
    """<s, a, r, s', e> of section 4.2.1."""

    percept: numpy.ndarray
    action: int
    reward: float
    next: numpy.ndarray | None  # None: the episode terminated
    exploited: bool
    linked: bool  # the next interaction of the database goes on from s'


# ------------------------------------------------------------------ targets (section 4.2.2)


def truncated_returns(database, horizon, discount, continuing, number=float):
    """Definition 1: sum of discount^i r_{t+i+1}, i = 0..horizon, for each t; NaN where undefined. From the
    last reward back, in numbers of the type `number`: definition 2 asks whether two of them are equal."""
    discount = number(discount)
    result = numpy.full(len(database), numpy.nan)
    for t in range(len(database) - horizon):
        window = database[t : t + horizon + 1]
        whole = all(x.linked or (continuing and x.next is None) for x in window[:-1])
        if whole and all(x.exploited for x in window):
            total = number(0)
            for x in reversed(window):
                total = number(x.reward) + discount * total
            result[t] = total
    return result


def bellman_targets(database, next_classes, values, discount):
    """r + discount V(class of s'), and r alone after a terminated interaction."""
    rewards = numpy.array([x.reward for x in database])
    return rewards + discount * numpy.where(next_classes < 0, 0.0, values[next_classes])


# ------------------------------------------------------------------ values (section 2.3)


@dataclass
class Tables:
    """What is known of each class and action. Q is NaN and `tried` 0 where nothing is."""

    q: numpy.ndarray
    tried: numpy.ndarray
    values: numpy.ndarray

    def split(self, class_id):
        """A class becomes two, of which each is worth what it was until the next solution."""
        actions = self.q.shape[1]
        self.q = numpy.vstack([self.q, numpy.full(actions, numpy.nan)])
        self.tried = numpy.vstack([self.tried, numpy.zeros(actions, int)])
        self.q[class_id], self.tried[class_id] = numpy.nan, 0
        self.values = numpy.append(self.values, self.values[class_id])


def solve(database, classes, next_classes, before, discount):
    """Value iteration, to convergence, over the class-level process that the database shows. What it does
    not show stays as it was before: Q of a pair, V of a class without any."""
    shape = before.q.shape
    tried, reward = numpy.zeros(shape, int), numpy.zeros(shape)
    transitions = numpy.zeros(shape + shape[:1])
    for x, c, after in zip(database, classes, next_classes):
        tried[c, x.action] += 1
        reward[c, x.action] += x.reward
        if after >= 0:
            transitions[c, x.action, after] += 1
    times = numpy.maximum(tried, 1)
    values, change = before.values, numpy.inf
    while change > 1e-13 * (1 + numpy.abs(values).max()):
        q = numpy.where(tried > 0, (reward + discount * transitions @ values) / times, before.q)
        counts = numpy.where(numpy.isnan(q), -numpy.inf, q)
        best = counts.max(axis=1)
        after = numpy.where(numpy.isfinite(best), best, values)
        change = numpy.abs(after - values).max()
        values = after
    return Tables(q, numpy.where(tried > 0, tried, before.tried), values)


# ------------------------------------------------------------------ splits (sections 4.2.3, 4.2.4)


def scores(a, b, c, d):
    """How much better one knows the side of the cutpoint once the presence of the feature is known, from
    2 x 2 tables: with and without it below (a, b) and above (c, d)."""
    present, absent = numpy.array([a, c], float), numpy.array([b, d], float)
    both = present + absent
    return entropy(both) - (share(present, both) * entropy(present)
                            + share(absent, both) * entropy(absent))


def share(part, whole):
    return part.sum(axis=0) / whole.sum(axis=0)


def proportions(counts):
    return counts / numpy.maximum(counts.sum(axis=0), 1)


def entropy(counts):
    p = proportions(counts)
    return -numpy.sum(p * numpy.log2(numpy.where(p > 0, p, 1)), axis=0)


def pearson(a, b, c, d):
    product = (a + b) * (c + d) * (a + c) * (b + d)
    n = a + b + c + d
    return numpy.where(product > 0, n * (a * d - b * c) ** 2 / numpy.maximum(product, 1.0), 0.0)


def expects_below(table, count):
    """Is a cell expected to hold fewer than that?"""
    a, b, c, d = (int(x) for x in table)
    return min(a + b, c + d) * min(a + c, b + d) < count * (a + b + c + d)


@functools.lru_cache(None)
def fisher(table):
    """Fisher's p-value: twice that of the tables as far off on the same side."""
    a, b, c, d = (int(x) for x in table)
    law = scipy.stats.hypergeom(a + b + c + d, a + b, a + c)
    return min(1.0, 2 * float(law.sf(a - 1) if a * d >= b * c else law.cdf(a)))


def table_log_p(table):
    """Of one table."""
    return (numpy.log(fisher(tuple(table))) if expects_below(table, 5)
            else scipy.stats.chi2.logsf(float(pearson(*table)), 1))


def table_statistic(table):
    """What a table adds to a sum over several, of one degree of freedom."""
    if expects_below(table, 1):
        return float(2 * numpy.log(2) * sum(table) * scores(*table))
    return float(pearson(*table))


def rank_sum(present, cuts):
    """Of samples in the order of their targets, of which some show the feature: how far the sum of these
    samples' ranks is from its mean, its variance by drawing without replacement, and tau. A cluster's samples
    share the mean of their ranks."""
    n = len(present)
    sizes = numpy.diff([0, *cuts, n])
    ends = numpy.cumsum(sizes)
    ranks = numpy.repeat(ends - (sizes - 1) / 2, sizes)
    a = present.sum()
    variance = a * (n - a) * ranks.var() / (n - 1)
    return abs(ranks[present].sum() - a * ranks.mean()), variance, ((sizes / n) ** 3).sum()


def rank_statistic(present, cuts):
    """Twice the logarithm of a likelihood ratio of Poisson's law with jumps: z squared without ties, or
    where as many samples show the feature as do not; less where ties and a rare feature give z long tails."""
    deviation, variance, tau = rank_sum(present, cuts)
    more = 2 * present.sum() - len(present)
    jump = numpy.sqrt((more**2 + 1) * tau) / 2
    u = jump * deviation / variance
    if u < 1e-6:
        return deviation**2 / variance
    return 2 * variance / jump**2 * ((1 + u) * numpy.log1p(u) - u)


def cutpoints(targets, gap):
    """Of sorted targets: the places i, between i - 1 and i, where a new cluster begins; a cluster holds
    what is within `gap` of its lowest."""
    places, lowest = [], targets[0]
    for i, target in enumerate(targets):
        if target - lowest > gap:
            places.append(i)
            lowest = target
    return numpy.array(places, int)


@dataclass
class Candidate:
    """A feature and a cutpoint for the samples after one action."""

    action: int
    feature: int
    evidence: float
    score: float
    table: tuple

    @property
    def statistic(self):
        return table_statistic(self.table)

    @property
    def log_p(self):
        return table_log_p(self.table)

    @property
    def likeness(self):
        """The same for tables that differ by exchanged rows or columns: their scores are the same bits."""
        a, b, c, d = self.table
        return min((a, b, c, d), (b, a, d, c), (c, d, a, b), (d, c, b, a))


@dataclass
class RankSum:
    """A feature for the samples after one action: no cutpoint."""

    action: int
    feature: int
    evidence: float
    likeness: tuple

    @property
    def score(self):
        return self.evidence

    @property
    def statistic(self):
        return self.evidence

    @property
    def log_p(self):
        return scipy.stats.chi2.logsf(self.evidence, 1)


class Group:
    """The samples of a class after one action."""

    def __init__(self, action, percepts, targets, gap):
        order = numpy.argsort(targets, kind="stable")
        self.action, self.samples = action, len(targets)
        self.cuts = cutpoints(targets[order], gap)
        self.shown = percepts[order] == 1
        self.present = numpy.cumsum(percepts[order], axis=0).astype(float)

    def divided_by(self, feature):
        return 0 < self.present[-1, feature] < self.samples

    def candidates(self, feature, kind):
        """One for each cutpoint; one by ranks."""
        if kind == RANKS:
            shown = self.shown[:, feature]
            deviation, variance, _ = rank_sum(shown, self.cuts)
            likeness = (self.action, round(2 * deviation), round(variance, 6))
            return [RankSum(self.action, feature, rank_statistic(shown, self.cuts), likeness)]
        a = self.present[self.cuts - 1, feature]
        b = self.cuts - a
        c = self.present[-1, feature] - a
        d = self.samples - self.cuts - c
        found = scores(a, b, c, d)
        return [Candidate(self.action, feature, *numbers)
                for numbers in zip(found * self.samples, found, zip(a, b, c, d))]


@dataclass
class Search:
    """What there is to choose from in one class, and what each choice would be worth."""

    alone: list  # of Candidate
    together: dict  # feature: for each group that it divides, its Candidates
    groups: list  # of those that take part
    log_features: float
    kind: int

    def __bool__(self):
        return any(x.evidence > 1e-9 for x in self.alone)

    def correction(self):
        """Two winners are compared where there is more than one group."""
        return numpy.log(2) if len(self.groups) > 1 else 0.0

    def tests(self, group):
        """That each feature makes of a group."""
        return 1 if self.kind == RANKS else len(group.cuts)

    def log_tests_alone(self):
        tests = sum(self.tests(g) for g in self.groups)
        return self.log_features + numpy.log(tests) + self.correction()

    def log_tests_together(self, feature):
        tests = [self.tests(g) for g in self.groups if g.divided_by(feature)]
        return self.log_features + numpy.log(tests).sum() + self.correction()

    def log_p_alone(self, candidate):
        return min(0.0, candidate.log_p + self.log_tests_alone())

    def log_p_together(self, feature, chosen):
        """For one candidate of each group."""
        log_p = scipy.stats.chi2.logsf(sum(x.statistic for x in chosen), len(chosen))
        return min(0.0, log_p + self.log_tests_together(feature))


def search(percepts, actions, targets, action_count, gap, kind, min_samples):
    """Looks for the best split of a class; None if there is too little to tell apart."""
    groups = []
    for action in range(action_count):
        mine = actions == action
        if mine.any():
            group = Group(action, percepts[mine], targets[mine], gap)
            if len(group.cuts) > 0:
                groups.append(group)
    if not groups or sum(g.samples for g in groups) < min_samples:
        return None
    features = [f for f in range(percepts.shape[1]) if any(g.divided_by(f) for g in groups)]
    together = {f: [g.candidates(f, kind) for g in groups if g.divided_by(f)] for f in features}
    alone = [x for lists in together.values() for candidates in lists for x in candidates]
    return Search(alone, together, groups, numpy.log(max(len(features), 1)), kind)


def matters(percepts, actions, targets, groups, feature, smallest, min_samples):
    """May the mean targets with and without a feature be apart by that after any action with a cutpoint?"""
    for group in groups:
        mine = targets[actions == group.action]
        sides = [mine[percepts[actions == group.action, feature] == v] for v in (0, 1)]
        fewer = min(len(side) for side in sides)
        if fewer == 0:
            continue
        apart = abs(sides[1].mean() - sides[0].mean())
        error = numpy.sqrt(sum(side.var() / len(side) for side in sides))
        if fewer < min_samples or apart + 3 * error >= smallest:
            return True
    return False


def level(alpha, step, successors):
    """At which a feature new to the tree must pass."""
    d = (step + 1).bit_length()
    return alpha / (d * (d + 1) * 2 ** (d - 1)) / (1 + successors)


def table_least(table):
    """What a table adds to a sum of very many."""
    n = sum(table)
    return min(float(pearson(*table)) * (n - 1) / n,
               float(2 * numpy.log(2) * n * scores(*table)))


def add_table(sums, table):
    a, b, c, d = table
    if min(a + b, c + d, a + c, b + d) > 0:
        sums += table_least(table), 1


def sum_log_p(statistic, degrees):
    """ln p; of more than 24 degrees of freedom that of 24, as many standard deviations above the mean; of an odd
    number above 3 that of one more."""
    if statistic <= degrees:
        return 0.0
    if degrees > 24:
        statistic = 24 + (statistic - degrees) * numpy.sqrt(24 / degrees)
        degrees = 24
    if degrees > 3:
        degrees += degrees % 2
    return scipy.stats.chi2.logsf(statistic, degrees)


def influenced(percepts, nexts, ended, actions, classes, action_count, log_level):
    """The features of s' that depend on the action, in strata of the class and of what s exhibits, or that tell
    where an action of a class ends the episode; there is no s' where `ended`."""
    passed = []
    for f in range(percepts.shape[1]):
        sums = numpy.zeros(2)
        for class_id, a in numpy.ndindex(classes.max(initial=0) + 1, action_count):
            mine = (classes == class_id) & (actions == a)
            add_table(sums, tuple(numpy.sum(mine & (percepts[:, f] == value) & (ended == e))
                                  for value, e in ((1, False), (1, True), (0, False), (0, True))))
        for class_id, value in numpy.ndindex(classes.max(initial=0) + 1, 2):
            mine = ~ended & (classes == class_id) & (percepts[:, f] == value)
            counts = numpy.array([[numpy.sum(nexts[mine & (actions == a), f] == v) for v in (1, 0)]
                                  for a in range(action_count)])
            for a in range(1, action_count):
                add_table(sums, (*counts[:a].sum(0), *counts[a]))
        if sum_log_p(*sums) + numpy.log(percepts.shape[1]) < log_level:
            passed.append(f)
    return passed


def lasting(percepts, nexts, actions, action_count, features):
    """For each feature: the sum of statistics by which s' depends on s, and its degrees of freedom."""
    result = {}
    for f in features:
        result[f] = numpy.zeros(2)
        for a in range(action_count):
            now, then = percepts[actions == a, f], nexts[actions == a, f]
            add_table(result[f], tuple(numpy.sum((now == x) & (then == y))
                                       for x, y in ((1, 1), (1, 0), (0, 1), (0, 0))))
    return result


# ------------------------------------------------------------------ classes (section 4.3)


class Tree:
    """Split j of class c: percepts of c that show the feature go to the new class j + 1."""

    def __init__(self):
        self.splits = []

    def classify(self, percepts):
        classes = numpy.zeros(len(percepts), int)
        for j, (class_id, feature) in enumerate(self.splits):
            classes[(classes == class_id) & (percepts[:, feature] == 1)] = j + 1
        return classes
