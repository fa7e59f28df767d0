# SPDX-License-Identifier: MIT
"""Learning steps of the core against method.py: every split, its numbers, and the values.

Where two candidates are as good to within the core's rounding, the core may take either, and method.py
goes on with its choice; but of tables that are the same it must take the first.
"""
import itertools

import numpy
import pytest
import scipy.stats

import binding
import method
from binding import GOES_ON, TERMINATED, TRUNCATED

NEAR = 4e-6  # relative: a quarter of what score.h grants a score
NUMBERS = 1e-5
SCORES = [method.GAIN, method.GAIN, method.GAIN, method.RANKS]


class Learner:
    """An agent, and the database that it should have."""

    def __init__(self, bits, actions, **fields):
        fields.setdefault("successors", 0)
        fields.setdefault("dependence", 0)
        self.agent = binding.Agent(bits, actions, **fields)
        self.config = self.agent.config
        self.tree, self.database, self.current = method.Tree(), [], None
        self.tables = method.Tables(numpy.full((1, actions), numpy.nan),
                                    numpy.zeros((1, actions), int), numpy.zeros(1))

    def begin(self, percept):
        if self.current is not None and self.database:
            self.database[-1].linked = False
        self.current = percept
        self.agent.begin(percept)

    def observe(self, action, exploited, reward, percept, end):
        reward = float(numpy.float32(reward))
        self.agent.observe(action, exploited, reward, percept, end)
        self.database.append(method.Interaction(self.current, action, reward, percept,
                                                bool(exploited), end == GOES_ON))
        self.current = percept if end == GOES_ON else None

    # -------------------------------------------------------------- one step, checked

    def learn(self):
        """Lets the agent learn, and goes after it. Returns how many splits it made."""
        step, known = self.agent.stats().step, len(self.tree.splits)
        self.agent.learn()
        left = self.agent.splits()[known:]
        while self.round(left, step):
            pass
        assert not left, "a split too many"
        if self.config.criterion == method.RETURNS:
            self.solve()
        self.compare_values()
        if self.config.criterion == method.RETURNS:
            self.database = []  # the next step needs a fresh one
        return len(self.tree.splits) - known

    def classes(self):
        """Of s and of s', -1 where the episode terminated."""
        here = self.tree.classify(numpy.array([x.percept for x in self.database]))
        after = self.tree.classify(numpy.array([x.percept if x.next is None else x.next
                                                for x in self.database]))
        return here, numpy.where([x.next is None for x in self.database], -1, after)

    def solve(self):
        self.tables = method.solve(self.database, *self.classes(), self.tables,
                                   self.config.discount)

    def targets(self, step):
        if self.config.criterion == method.RETURNS:
            return method.truncated_returns(self.database, step, self.config.discount,
                                            self.config.continuing, numpy.float32)
        self.solve()
        return method.bellman_targets(self.database, self.classes()[1], self.tables.values,
                                      self.config.discount)

    def round(self, left, step):
        """Every class once, and if none is split, once more, by what follows; takes the splits that were
        made off `left`."""
        targets, (here, _) = self.targets(step), self.classes()
        percepts = numpy.array([x.percept for x in self.database])
        actions = numpy.array([x.action for x in self.database])
        residual = self.config.criterion == method.RESIDUAL
        gap = 2.0 * self.config.tolerance if residual else 0.0
        strict = method.level(self.config.alpha, step, self.config.successors)
        lives = numpy.array([x.next is not None for x in self.database])
        nexts = numpy.array([x.percept if x.next is None else x.next for x in self.database])

        def search(mine):
            found = method.search(percepts[mine], actions[mine], targets[mine], self.config.actions,
                                  gap, self.config.score, self.config.min_samples)
            smallest = self.config.smallest_effect
            return [x for x in (self.allowed(found) if found else []) if smallest == 0 or method.matters(
                percepts[mine], actions[mine], targets[mine], found.groups, x["bit"], smallest,
                self.config.min_samples)]

        def follow(mine):
            if mine.sum() < self.config.min_samples:
                return []
            goes_on = mine & lives
            return self.following(method.lasting(percepts[goes_on], nexts[goes_on], actions[goes_on],
                                                 self.config.actions, features), mine.sum())

        for look in (search, follow)[:1 + self.config.successors]:
            splits = []
            if look is follow:
                features = method.influenced(percepts, nexts, ~lives, actions, here, self.config.actions,
                                             numpy.log(strict))
            for class_id in range(len(self.tree.splits) + 1):
                split = left[0] if left and left[0][0].class_id == class_id else None
                known = features if look is follow else [bit for _, bit in self.tree.splits + splits]
                mine = (here == class_id) & ~numpy.isnan(targets)
                if self.compare(look(mine), split, known, strict):
                    assert split[0].step == step
                    splits.append((class_id, left.pop(0)[1]))
            for class_id, _ in splits:
                self.tables.split(class_id)
            self.tree.splits += splits
            if splits:
                return True
        return False

    # -------------------------------------------------------------- one class

    def compare(self, allowed, split, known, strict):
        """Whether the class is split; fails if the core's answer is not one that the method allows.
        Less evidence is asked of features that the tree knows."""

        def beyond(x, sign):
            mild = max(strict, self.config.alpha_known)
            level = numpy.log(mild if x["bit"] in known else strict)
            return x["log_p"] < level + sign * NUMBERS * (1 + abs(level))

        if split is None:
            certain = [x for x in allowed if beyond(x, -1)]
            assert not certain or len(certain) < len(allowed), f"no split, but {allowed}"
        if split is None or not any(0.0 > x["log_p"] and beyond(x, 1) for x in allowed):
            return False  # a split that was made nonetheless is left over
        about, bit = split
        got = {name: getattr(about, name) for name in ("action", "samples", "log_tests", "score",
                                                       "log_p")}
        got["bit"] = bit
        assert any(self.same(got, x) for x in allowed), f"{got} is none of {allowed}"
        return True

    @staticmethod
    def same(got, wanted):
        numbers = ("log_tests", "score", "log_p")
        return (all(got[name] == wanted[name] for name in ("action", "samples", "bit"))
                and all(abs(got[n] - wanted[n]) <= NUMBERS * (1 + abs(wanted[n])) for n in numbers))

    def allowed(self, found):
        """The splits that the method allows: one, but for what rounding cannot tell apart."""
        alone = self.alone(found)
        together = self.together(found) if len(found.groups) > 1 else []

        def may_beat(one, others):
            worst = max((x["log_p"] for x in others), default=0.0)
            return one["log_p"] <= worst + NUMBERS * (1 + abs(worst))

        return ([x for x in alone if may_beat(x, together)]
                + [x for x in together if may_beat(x, alone)])

    @staticmethod
    def alone(found):
        most = max(x.evidence for x in found.alone)
        order = sorted((x for x in found.alone if x.evidence >= most * (1 - NEAR)),
                       key=lambda x: (x.action, x.feature))
        samples = {g.action: g.samples for g in found.groups}
        options, seen = [], set()
        for x in order:
            if x.likeness not in seen:
                options.append({"bit": x.feature, "action": x.action, "score": x.score,
                                "samples": samples[x.action], "log_p": found.log_p_alone(x),
                                "log_tests": found.log_tests_alone()})
            seen.add(x.likeness)
        return options

    def together(self, found):
        sums = {feature: sum(max(x.evidence for x in group) for group in lists)
                for feature, lists in found.together.items()}
        most = max(sums.values())
        samples = sum(g.samples for g in found.groups)
        options, seen = [], set()
        for feature, lists in sorted(found.together.items()):
            if sums[feature] < most * (1 - NEAR):
                continue
            choices = [best_cutpoints(group) for group in lists]
            tables = tuple(group[0].likeness for group in choices)
            if tables in seen and all(len(group) == 1 for group in choices):
                continue
            seen.add(tables)
            for chosen in combinations(choices):
                options.append({"bit": feature, "action": self.config.actions, "samples": samples,
                                "score": sums[feature] / samples,
                                "log_tests": found.log_tests_together(feature),
                                "log_p": found.log_p_together(feature, chosen)})
        return options

    def following(self, sums, samples):
        """The split by what lasts that the method allows; several if rounding cannot tell."""
        log_p = {f: method.sum_log_p(*x) for f, x in sums.items()}
        least = min(log_p.values(), default=0.0)
        return [{"bit": f, "action": self.config.actions + 1, "samples": samples,
                 "score": sums[f][0] / samples, "log_tests": numpy.log(len(sums)),
                 "log_p": log_p[f] + numpy.log(len(sums))}
                for f in sorted(sums) if log_p[f] < 0.0 and log_p[f] <= least + NUMBERS * (1 - least)]

    # -------------------------------------------------------------- values

    def compare_values(self):
        q, tried, values, policy = self.agent.tables()
        wanted = self.tables
        bound = self.config.tolerance + NUMBERS * (1 + numpy.abs(wanted.values).max())
        assert (tried == wanted.tried).all()
        assert numpy.abs(values - wanted.values).max() <= bound
        known = wanted.tried > 0
        assert numpy.abs(q - wanted.q)[known].max() <= bound
        assert (q[~known] == 0.0).all()
        counts = numpy.where(known, q, -numpy.inf)
        some = numpy.isfinite(counts).any(axis=1)
        assert (policy[some] == counts[some].argmax(axis=1)).all()


def best_cutpoints(candidates):
    """Of one group: those that rounding cannot tell apart; of the same tables the first."""
    most = max(x.evidence for x in candidates)
    best = {}
    for x in candidates:
        if x.evidence >= most * (1 - NEAR):
            best.setdefault(x.likeness, x)
    return list(best.values())


def combinations(choices):
    """One cutpoint a group, in all ways: those of one group differ in what they say of their table."""
    differing = [list({x.statistic: x for x in group}.values()) for group in choices]
    return list(itertools.product(*differing))


# ------------------------------------------------------------------ random databases


def fill(learner, rng, interactions, levels, exploited=0.5):
    """Random percepts; rewards are sums of a few bits, and noise that differs a little by action."""
    bits = learner.agent.bits
    weights = rng.integers(-2, 3, (learner.config.actions, bits)) * (rng.random(bits) < 0.4)
    for _ in range(interactions):
        percept = rng.integers(0, 2, bits) if learner.current is None else learner.current
        if learner.current is None or rng.random() < 0.05:
            learner.begin(percept)
        percept = learner.current
        action = int(rng.integers(learner.config.actions))
        reward = weights[action] @ percept + rng.integers(0, levels) / 4
        end = rng.choice([GOES_ON, TERMINATED, TRUNCATED], p=[0.8, 0.15, 0.05])
        after = None if end == TERMINATED else rng.integers(0, 2, bits)
        learner.observe(action, int(rng.random() < exploited), reward, after, int(end))


@pytest.mark.parametrize("seed", range(60))
def test_random_residual(seed):
    rng = numpy.random.default_rng(seed)
    learner = Learner(
        int(rng.integers(2, 12)), int(rng.integers(1, 5)), classes=200, capacity=1000,
        criterion=method.RESIDUAL, score=SCORES[seed % 4], alpha=[0.01, 0.3, 1.0][seed % 3 - seed % 2],
        tolerance=1e-4, discount=float(rng.choice([0.0, 0.5, 0.9])), solver=seed // 2 % 2,
        min_samples=int(rng.integers(2, 20)), features_at_once=1 + seed % 7,
        smallest_effect=[0.0, 1.3][seed % 5 == 0])
    for _ in range(2):
        fill(learner, rng, int(rng.integers(5, 250)), levels=int(rng.choice([1, 3, 30])))
        learner.learn()


@pytest.mark.parametrize("seed", range(60))
def test_random_successors(seed):
    """Percepts whose bits move: some are kept, some copied from others, the rest random. A few rewards."""
    rng = numpy.random.default_rng(3000 + seed)
    bits, actions = int(rng.integers(2, 10)), int(rng.integers(1, 5))
    learner = Learner(
        bits, actions, classes=200, capacity=1000, successors=1, score=SCORES[seed % 4], tolerance=1e-4,
        alpha=[1e-4, 0.01, 0.3][seed % 3], alpha_known=[0.1, 1e-3, 1.0][seed // 3 % 3],
        min_samples=int(rng.integers(2, 20)))
    sources = rng.integers(-1, bits, (actions, bits))  # -1: at random
    for _ in range(2):
        for _ in range(int(rng.integers(5, 300))):
            if learner.current is None:
                learner.begin(rng.integers(0, 2, bits))
            percept, action = learner.current, int(rng.integers(actions))
            source, noise = sources[action], rng.integers(0, 2, bits)
            end = int(rng.choice([GOES_ON, TERMINATED, TRUNCATED], p=[0.9, 0.07, 0.03]))
            after = numpy.where((source < 0) | (rng.random(bits) < 0.1), noise, percept[source])
            learner.observe(action, 0, float(seed % 2 and percept[0] and rng.random() < 0.1),
                            None if end == TERMINATED else after, end)
        learner.learn()


@pytest.mark.parametrize("seed", range(10))
def test_nothing_pays(seed):
    """While no reward differs, the tree grows by the bits that the agent turns round, and by no other,
    although one stays for long."""
    rng = numpy.random.default_rng(4000 + seed)
    learner = Learner(6, 2, capacity=1000, successors=1)
    learner.begin(rng.integers(0, 2, 6))
    for _ in range(400):
        percept, action = learner.current, int(rng.integers(2))
        after = rng.integers(0, 2, 6)
        turned = rng.random(6) < 0.8
        after[[1, 4]] = numpy.where(turned, percept ^ action, after)[[1, 4]]
        after[2] = percept[2] ^ (rng.random() < 0.05)
        learner.observe(action, 0, 0.0, after, GOES_ON)
    assert learner.learn() == 3
    assert {bit for _, bit in learner.agent.splits()} == {1, 4}
    assert all(split.action == 3 for split, _ in learner.agent.splits())


@pytest.mark.parametrize("seed", range(60))
def test_random_returns(seed):
    rng = numpy.random.default_rng(1000 + seed)
    learner = Learner(
        int(rng.integers(2, 12)), int(rng.integers(1, 4)), classes=200, capacity=1000,
        criterion=method.RETURNS, score=SCORES[seed % 4], alpha=[0.01, 0.3, 1.0][seed % 3 - seed % 2],
        discount=float(rng.choice([0.0, 0.5, 0.9, 0.99])), continuing=seed % 2, tolerance=1e-4,
        min_samples=int(rng.integers(2, 20)))
    for _ in range(3):
        fill(learner, rng, int(rng.integers(20, 300)), levels=int(rng.choice([1, 3, 30])),
             exploited=0.9)
        learner.learn()


@pytest.mark.parametrize("seed", range(20))
def test_same_columns(seed):
    """Bits that are copies of others: the first must win."""
    rng = numpy.random.default_rng(2000 + seed)
    learner = Learner(9, 2, classes=100, capacity=1000, criterion=seed % 2, score=SCORES[seed % 4],
                      alpha=0.5, discount=0.5, features_at_once=1 + seed % 4)
    for _ in range(300):
        base = rng.integers(0, 2, 3)
        learner.begin(numpy.concatenate([base, base, 1 - base]))
        learner.observe(int(rng.integers(2)), 1, float(base[0] + 2 * base[1] * base[2]), None,
                        TERMINATED)
    assert learner.learn() >= 3
    assert all(bit < 3 for _, bit in learner.agent.splits())


# ------------------------------------------------------------------ a maze


MAZE = ["...#*",
        ".#...",
        "....."]
MOVES = [(0, -1), (1, 0), (0, 1), (-1, 0)]
CELLS = [(x, y) for y, row in enumerate(MAZE) for x, sign in enumerate(row) if sign == "."]


class Walk:
    """Through the maze; percepts are 3 bits of x, 4 at random, 2 of y."""

    def __init__(self, seed):
        self.rng = numpy.random.default_rng(seed)
        self.reset()

    def reset(self):
        self.place = CELLS[self.rng.integers(len(CELLS))]

    def percept(self):
        x, y = self.place
        return numpy.array([x & 1, x >> 1 & 1, x >> 2, *self.rng.integers(0, 2, 4), y & 1, y >> 1])

    def move(self, action):
        """The reward, and whether the exit is reached."""
        x, y = (a + b for a, b in zip(self.place, MOVES[action]))
        if 0 <= y < len(MAZE) and 0 <= x < len(MAZE[0]) and MAZE[y][x] != "#":
            self.place = (x, y)
        out = MAZE[self.place[1]][self.place[0]] == "*"
        return (100.0 if out else -1.0), out


def walk(learner, world, interactions):
    for _ in range(interactions):
        if learner.current is None:
            learner.begin(world.percept())
        action, exploited = learner.agent.act()
        reward, out = world.move(action)
        learner.observe(action, exploited, reward, None if out else world.percept(),
                        TERMINATED if out else GOES_ON)
        if out:
            world.reset()


def steps_to_exit(learner, world, place):
    world.place, steps, out = place, 0, False
    while not out and steps < 50:
        _, out = world.move(learner.agent.predict(world.percept())[1])
        steps += 1
    return steps


def distances():
    """The length of the shortest way from each cell."""
    exits = [(x, y) for y, row in enumerate(MAZE) for x, sign in enumerate(row) if sign == "*"]
    far, edge = {place: 0 for place in exits}, list(exits)
    for place in edge:
        for dx, dy in MOVES:
            other = place[0] + dx, place[1] + dy
            if other in CELLS and other not in far:
                far[other] = far[place] + 1
                edge.append(other)
    return far


@pytest.mark.parametrize("seed", range(3))
def test_maze_residual(seed):
    learner, world = Learner(9, 4, capacity=4000, seed=seed, criterion=method.RESIDUAL), Walk(seed)
    for _ in range(6):
        walk(learner, world, 400)
        learner.learn()
    assert {bit for _, bit in learner.agent.splits()} <= {0, 1, 2, 7, 8}
    assert all(steps_to_exit(learner, world, place) == distances()[place] for place in CELLS)


@pytest.mark.parametrize("seed", range(3))
def test_maze_returns(seed):
    learner, world = Learner(9, 4, capacity=2500, seed=seed, criterion=method.RETURNS, continuing=1,
                             epsilon=0.8), Walk(seed)
    for _ in range(10):
        walk(learner, world, 2000)
        learner.learn()
    assert len(learner.tree.splits) > 5
    assert {bit for _, bit in learner.agent.splits()} <= {0, 1, 2, 7, 8}
