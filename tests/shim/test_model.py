# SPDX-License-Identifier: MIT
"""Random calls of an agent against an abstract model of it: what each call must return or raise, what the ring
holds, and that a call that fails changes nothing. On all domains and solvers, with callbacks that fail at any
call, and with snapshots cut off at every byte.

    RLVC_MODEL_RUNS=5000 python -m pytest tests/shim/test_model.py      # many more runs
"""

import os

import hypothesis
import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

import rlvc
from rlvc import errors

ACTIONS = 2
PERCEPTS = 8
GOES_ON, TERMINATED, TRUNCATED = range(3)


class Boom(Exception):
    """What a callback raises on purpose."""


class Failing(rlvc.Domain):
    """Percepts are numbers; a feature is a bound. Its methods fail from some call on, for some calls."""

    def __init__(self):
        super().__init__(np.uint8, (1,), np.int16)
        self.after, self.times = 0, 0

    def step(self):
        if self.after > 0:
            self.after -= 1
        elif self.times > 0:
            self.times -= 1
            raise Boom

    def exhibits(self, percept, feature):
        self.step()
        return bool(percept[0] >= feature)

    def candidates(self, percepts):
        self.step()
        return np.unique(percepts).astype(np.int16)

    def name(self, feature):
        self.step()
        return f"from {feature} on"

    def check_percept(self, percept):
        return bool(percept[0] < PERCEPTS)

    def check_feature(self, feature):
        return bool(0 <= feature < PERCEPTS)


def bits_of(i):
    return np.array([i], np.uint8)


def numbers_of(i):
    return np.array([i % 3, i // 3], np.float32)


def vectors_of(i):
    return np.array([[i % 4, i // 4]] * (1 + i % 2), np.float32)


def placed_vectors_of(i):
    vectors = vectors_of(i)
    return vectors, np.arange(2 * len(vectors)).reshape(-1, 2) * (1 + i)


# A domain, what its percepts look like, and a record that it refuses.
DOMAINS = {
    "bits": (lambda: rlvc.Bits(3), bits_of, None),
    "thresholds": (lambda: rlvc.Thresholds(2), numbers_of, np.full(2, np.nan, np.float32)),
    "descriptors": (
        lambda: rlvc.Descriptors(2, 2, 0.5),
        vectors_of,
        np.full((1, 2), np.inf, np.float32),
    ),
    "spatial": (
        lambda: rlvc.Spatial(2, 2, 0.5, pairs=4),
        placed_vectors_of,
        (np.full((1, 2), np.nan, np.float32), np.zeros((1, 2))),
    ),
    "bags": (
        lambda: rlvc.Bags(2, 2, 0.5, size=2),
        vectors_of,
        np.full((1, 2), np.nan, np.float32),
    ),
    "own": (Failing, bits_of, bits_of(PERCEPTS)),
}


class Ring:
    """The model of the agent's ring: of each percept what came of it, None if nothing did."""

    def __init__(self, capacity):
        self.slots, self.room, self.open = [], capacity + 1, False

    def make_room(self):
        if len(self.slots) < self.room:
            return
        self.slots.pop(0)
        if len(self.slots) > self.open and self.slots[0] is None:
            self.slots.pop(0)

    def push(self):
        self.make_room()
        self.slots.append(None)

    def begin(self):
        if self.open and not self.awaited:  # nobody needs it
            self.slots.pop()
        self.open = False
        self.push()
        self.open = True

    def observe(self, end):
        if end != TERMINATED:
            self.make_room()
        self.slots[-1] = end
        if end != TERMINATED:
            self.push()
        self.open = end == GOES_ON

    def clear(self):
        self.slots = [None] if self.open else []

    @property
    def stored(self):
        return sum(slot is not None for slot in self.slots)

    @property
    def awaited(self):
        """Whether the open percept is s' of an interaction."""
        return self.open and len(self.slots) > 1 and self.slots[-2] == GOES_ON

    def freeze(self):
        """How many slots a learning step that begins now keeps."""
        return len(self.slots) - self.open + self.awaited

    @property
    def full(self):
        return len(self.slots) == self.room


class AgentMachine(RuleBasedStateMachine):
    @initialize(
        kind=st.sampled_from(sorted(DOMAINS)),
        solver=st.sampled_from(["value_iteration", "policy_iteration", "q_learning", "sarsa"]),
        criterion=st.sampled_from(["residual", "returns"]),
        capacity=st.sampled_from([1, 5, 40]),
        classes=st.sampled_from([1, 2, 8]),
    )
    def make(self, kind, solver, criterion, capacity, classes):
        domain, self.percept, self.refused = DOMAINS[kind]
        self.domain = domain()
        self.agent = rlvc.Agent(
            self.domain, ACTIONS, solver=solver, criterion=criterion, capacity=capacity,
            classes=classes, min_samples=2, alpha=1.0, max_sweeps=200,
        )  # fmt: skip
        self.ring = Ring(capacity)
        self.observed = self.step = 0
        self.learning = self.failed = False  # a step is under way; its last call failed
        self.frozen = 0  # slots that the step keeps
        self.classes = 1

    # ------------------------------------------------------------------ calls that fail

    def unchanged(self, error, call, *arguments, **more):
        """A call that must raise this, and must change nothing."""
        before = self.agent.snapshot()
        with pytest.raises(error):
            call(*arguments, **more)
        assert self.agent.snapshot() == before

    @rule(which=st.integers(0, 6))
    def refuse(self, which):
        agent, percept = self.agent, self.percept(1)
        calls = [
            (errors.RangeError, agent.observe, ACTIONS, 0.0, percept),
            (errors.RewardError, agent.observe, 0, float("nan"), percept),
            (errors.RewardError, agent.observe, 0, 2e12, percept),
            (errors.PerceptError, agent.observe, 0, 0.0, b"too long for any domain" * 9),
            (errors.PerceptError, agent.begin, None),
            (errors.RangeError, agent.learn, 1),
            (errors.RangeError, agent.prune, -1.0),
        ]
        self.unchanged(*calls[which])

    @rule()
    def refuse_what_the_domain_refuses(self):
        if self.refused is not None:
            self.unchanged(errors.PerceptError, self.agent.begin, self.refused)

    @rule(after=st.integers(0, 30), times=st.integers(1, 5))
    def fail(self, after, times):
        """From then on callbacks of a domain of one's own fail."""
        self.domain.__dict__.update(after=after, times=times)

    @property
    def busy(self):
        """Whether there is no room, since a learning step needs the oldest interaction."""
        return self.learning and self.frozen > 0 and self.ring.full

    def heal(self):
        self.domain.__dict__.update(after=0, times=0)

    # ------------------------------------------------------------------ calls

    @rule(where=st.integers(0, PERCEPTS - 1))
    def begin(self, where):
        if self.busy and (self.ring.awaited or not self.ring.open):
            if not self.failed:
                self.unchanged(errors.BusyError, self.agent.begin, self.percept(where))
                return
            self.learning = self.failed = False
        self.agent.begin(self.percept(where))
        self.ring.begin()

    @rule(action=st.integers(0, ACTIONS - 1), reward=st.sampled_from([0.0, 1.0, -1.0]),
          where=st.integers(0, PERCEPTS - 1), end=st.sampled_from([GOES_ON, GOES_ON, TERMINATED, TRUNCATED]))  # fmt: skip
    def observe(self, action, reward, where, end):
        arguments = (action, reward, self.percept(where), end == TERMINATED, end == TRUNCATED)
        if not self.ring.open:
            self.unchanged(errors.OrderError, self.agent.observe, *arguments)
            return
        gives_way = self.busy and end != TERMINATED
        if gives_way and not self.failed:
            self.unchanged(errors.BusyError, self.agent.observe, *arguments)
            return
        before = self.agent.snapshot()
        try:
            self.agent.observe(*arguments)
        except Boom:  # an incremental solver classifies s and s'
            assert self.agent.snapshot() == before
            return
        if gives_way:
            self.learning = self.failed = False
        self.ring.observe(end)
        self.observed += 1

    @rule(budget=st.sampled_from([64, 64, 200, 1000, None]))
    def learn(self, budget):
        if not self.learning:
            self.learning, self.frozen = True, self.ring.freeze()
        try:
            progress = self.agent.learn(budget)
        except Boom:
            self.failed = True
            return
        self.failed = False
        if progress.done:
            self.learning = False
            self.step += 1
            if self.agent.config.criterion == "returns":
                self.ring.clear()

    @rule()
    def abandon(self):
        self.agent.abandon()
        self.learning = self.failed = False

    @rule(tolerance=st.sampled_from([0.0, 0.5]))
    def prune(self, tolerance):
        if self.learning:
            self.unchanged(errors.BusyError, self.agent.prune, tolerance)
            return
        before = self.agent.statistics.classes
        undone = self.agent.prune(tolerance)
        self.classes = self.agent.statistics.classes
        assert self.classes == before - undone

    @rule(where=st.integers(0, PERCEPTS - 1))
    def ask(self, where):
        """Acting, deciding and printing change nothing but the random numbers."""
        before = self.agent.snapshot()
        try:
            class_id, action = self.agent.predict(self.percept(where))
            assert class_id < self.agent.statistics.classes and action < ACTIONS
            assert self.agent.tree["classes"] == self.agent.statistics.classes
        except Boom:
            pass
        assert self.agent.snapshot() == before
        if self.ring.open:
            try:
                assert self.agent.act().action < ACTIONS
            except Boom:
                assert self.agent.snapshot() == before
        else:
            self.unchanged(errors.OrderError, self.agent.act)

    # ------------------------------------------------------------------ power

    @rule()
    def save_and_load(self):
        self.heal()
        snapshot = self.agent.snapshot()
        self.agent = rlvc.Agent.restore(self.domain, self.agent.config, snapshot)
        assert self.agent.snapshot() == snapshot

    @precondition(lambda self: self.ring.stored > 2)
    @rule(flipped=st.integers(0, 2**16), bit=st.integers(0, 7))
    def cut_the_power(self, flipped, bit):
        """Whatever is left of a snapshot is refused, and one with a wrong bit, too."""
        self.heal()
        snapshot = self.agent.snapshot()
        config = self.agent.config
        for end in range(len(snapshot)):
            if any(snapshot[end:]):
                with pytest.raises(errors.SnapshotError):
                    rlvc.Agent.restore(self.domain, config, snapshot[:end])
        at = flipped % len(snapshot)
        wrong = bytearray(snapshot)
        wrong[at] ^= 1 << bit
        try:
            restored = rlvc.Agent.restore(self.domain, config, bytes(wrong))
        except errors.SnapshotError:
            return
        assert restored.snapshot() == snapshot  # a byte behind the end

    # ------------------------------------------------------------------ what is always so

    @invariant()
    def holds(self):
        if not hasattr(self, "agent"):
            return
        self.agent.check()
        statistics = self.agent.statistics
        assert statistics.interactions == self.observed
        assert statistics.stored == self.ring.stored
        assert statistics.step == self.step
        assert self.classes <= statistics.classes <= self.agent.config.classes
        self.classes = statistics.classes
        assert np.isfinite(self.agent.q).all()


AgentMachine.TestCase.settings = hypothesis.settings(
    max_examples=int(os.environ.get("RLVC_MODEL_RUNS", "40")), stateful_step_count=40
)
test_agent = AgentMachine.TestCase
