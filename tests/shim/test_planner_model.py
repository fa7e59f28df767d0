# SPDX-License-Identifier: MIT
"""Random calls of a planner against an abstract model of it: what each call must return or raise, what is counted,
and that a call that fails changes nothing. With snapshots that are cut off and changed.

    RLVC_MODEL_RUNS=1000 python -m pytest tests/shim/test_planner_model.py      # many more runs
"""

import os

import hypothesis
import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule

import rlvc
from rlvc import errors

ACTIONS, COMPONENTS = 3, 2
GOES_ON, TERMINATED, TRUNCATED = range(3)
PLACES = st.tuples(*[st.sampled_from([-1e9, -1.0, 0.0, 0.25, 3.0])] * COMPONENTS)


class PlannerMachine(RuleBasedStateMachine):
    @initialize(
        capacity=st.sampled_from([64, 300]),
        leaves=st.sampled_from([2, 16]),
        horizon=st.sampled_from([1, 7, 500]),
        seed=st.integers(0, 3),
    )
    def make(self, capacity, leaves, horizon, seed):
        self.planner = rlvc.Planner(
            COMPONENTS, ACTIONS, capacity=capacity, sample=32, random=32, candidates=20, patience=10,
            model_leaves=2, leaves=leaves, horizon=horizon, seed=seed,
        )  # fmt: skip
        self.random = np.random.default_rng(seed)
        self.open = self.learning = self.due = False
        self.observed = self.episodes = self.steps = 0

    def percept(self, place):
        return np.array(place, np.float32)

    def shown(self):
        """All that one sees of a planner; between two steps of learning that is all there is."""
        if self.learning:
            return self.planner.statistics, self.planner.print("json")
        return self.planner.snapshot()

    def unchanged(self, error, call, *arguments, **more):
        before = self.shown()
        with pytest.raises(error):
            call(*arguments, **more)
        assert self.shown() == before

    # ------------------------------------------------------------------ calls that fail

    @rule(which=st.integers(0, 5))
    def refuse(self, which):
        planner, percept = self.planner, self.percept((0, 0))
        calls = [
            (errors.PerceptError, planner.begin, self.percept((np.nan, 0))),
            (errors.PerceptError, planner.act_at, self.percept((0, 2e9))),
            (errors.PerceptError, planner.observe, 0, 0.0, None),
            (errors.RangeError, planner.learn, planner.budget_min - 1),
            (errors.RangeError, planner.observe, ACTIONS, 0.0, percept),
            (errors.RewardError, planner.observe, 0, float("nan"), percept),
        ]
        if which < 4 or self.open:
            self.unchanged(*calls[which])

    # ------------------------------------------------------------------ calls

    def close(self):
        self.episodes += 1
        self.due = True
        self.steps = 0

    def possible(self, call, *arguments):
        """A call that may be refused only because learning needs the oldest interactions."""
        before = self.shown()
        try:
            call(*arguments)
        except errors.BusyError:
            assert self.learning and self.shown() == before
            return False
        return True

    @rule(place=PLACES)
    def begin(self, place):
        if self.possible(self.planner.begin, self.percept(place)):
            self.open, self.steps = True, 0

    @rule(action=st.integers(0, ACTIONS - 1), reward=st.sampled_from([0.0, 1.0, -1e12]), place=PLACES,
          end=st.sampled_from([GOES_ON, GOES_ON, TERMINATED, TRUNCATED]))  # fmt: skip
    def observe(self, action, reward, place, end):
        arguments = (action, reward, self.percept(place), end == TERMINATED, end == TRUNCATED)
        if not self.open:
            self.unchanged(errors.OrderError, self.planner.observe, *arguments)
        elif self.possible(self.planner.observe, *arguments):
            self.observed += 1
            self.steps += 1
            self.open = end == GOES_ON
            if not self.open or self.steps == self.planner.config.horizon:
                self.close()

    @rule(episodes=st.integers(1, 4))
    def live(self, episodes):
        """Episodes of ten interactions as the planner acts, paid for one action on each side of 0."""
        for _ in range(episodes):
            self.begin(self.random.normal(size=COMPONENTS))
            for i in range(10):
                if not self.open:
                    return
                action = self.planner.act()
                assert 0 <= action < ACTIONS
                reward = float(action == (self.random.random() < 0.5))
                end = TERMINATED if i == 9 else GOES_ON
                self.observe(action, reward, self.random.normal(size=COMPONENTS), end)

    @rule(least=st.booleans())
    def learn(self, least):
        self.learning = self.learning or self.due
        self.due = self.due and not self.learning
        progress = self.planner.learn(self.planner.budget_min if least else None)
        assert progress.done or least
        self.learning = not progress.done

    @rule(place=PLACES)
    def ask(self, place):
        before = None if self.learning else self.planner.print("json")
        assert 0 <= self.planner.predict(self.percept(place)) < ACTIONS
        assert 0 <= self.planner.act_at(self.percept(place)) < ACTIONS
        if self.open:
            assert 0 <= self.planner.act() < ACTIONS
        else:
            self.unchanged(errors.OrderError, self.planner.act)
        assert before is None or self.planner.print("json") == before

    # ------------------------------------------------------------------ power

    @rule()
    def save_and_load(self):
        if self.learning:
            self.unchanged(errors.BusyError, self.planner.snapshot)
            return
        snapshot = self.planner.snapshot()
        self.planner = rlvc.Planner.restore(COMPONENTS, self.planner.config, snapshot)
        assert self.planner.snapshot() == snapshot

    @rule(first=st.integers(0, 96), flipped=st.integers(0, 2**16), bit=st.integers(0, 7))
    def cut_the_power(self, first, flipped, bit):
        """Whatever is left of a snapshot is refused, and one with a wrong bit, too."""
        if self.learning:
            return
        snapshot, config = self.planner.snapshot(), self.planner.config
        for end in range(first, len(snapshot), 97):
            if any(snapshot[end:]):
                with pytest.raises(errors.SnapshotError):
                    rlvc.Planner.restore(COMPONENTS, config, snapshot[:end])
        at = flipped % len(snapshot)
        wrong = bytearray(snapshot)
        wrong[at] ^= 1 << bit
        try:
            restored = rlvc.Planner.restore(COMPONENTS, config, bytes(wrong))
        except errors.SnapshotError:
            return
        assert restored.snapshot() == snapshot  # a byte behind the end

    # ------------------------------------------------------------------ what is always so

    @invariant()
    def holds(self):
        if not hasattr(self, "planner"):
            return
        statistics = self.planner.statistics
        assert statistics.interactions == self.observed
        assert statistics.episodes == self.episodes
        assert 0 <= statistics.leaves <= self.planner.config.leaves
        assert np.isfinite(statistics.score)


PlannerMachine.TestCase.settings = hypothesis.settings(
    max_examples=int(os.environ.get("RLVC_MODEL_RUNS", "30")), stateful_step_count=30, deadline=None
)
test_planner = PlannerMachine.TestCase
