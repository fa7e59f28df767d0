# SPDX-License-Identifier: MIT
"""Small policies, and trials of them."""

import subprocess

import gymnasium
import numpy as np
import pytest
from gymnasium import spaces

import rlvc
from rlvc import errors
from rlvc.learning import SmallPolicy, Trials, shrink


def plane(count=400, seed=1):
    return np.random.default_rng(seed).uniform(-1, 1, (count, 2)).astype(np.float32)


def test_the_fewest_tests_that_matter():
    x = plane()
    wanted = np.where(x[:, 0] > 0.2, np.where(x[:, 1] > -0.5, 2, 1), 0)
    small = shrink(x, np.eye(3)[wanted], 12)
    assert small.leaves <= 12
    assert (small.act(x) == wanted).mean() > 0.95
    assert [small.act(row) for row in x] == small.act(x).tolist()
    assert small.text().count("action") == small.leaves
    fewer = shrink(x, np.eye(3)[wanted], 3)
    assert fewer.leaves == 3 and fewer.text().startswith("x[0] > 0.")


def test_the_export_acts_alike(tmp_path):
    x = plane()
    small = shrink(x, np.eye(2)[(x[:, 0] > x[:, 1]).astype(int)], 12)
    assert small.leaves > 4
    (tmp_path / "p.h").write_text(small.export_c("p"))
    (tmp_path / "p.c").write_text(
        '#include "p.h"\n#include <stdio.h>\nint main(void) {\n    float x[2];\n'
        "    while (fread(x, sizeof x, 1, stdin) == 1)\n        putchar('0' + (int)p_act(x));\n"
        "    return 0;\n}\n"
    )
    command = ["gcc", "-std=c99", "-Wall", "-Wextra", "-Wdouble-promotion", "-Werror"]
    subprocess.run([*command, tmp_path / "p.c", "-o", tmp_path / "p"], check=True)
    shown = subprocess.run([tmp_path / "p"], input=x.tobytes(), capture_output=True, check=True)
    assert [int(c) for c in shown.stdout.decode()] == small.act(x).tolist()
    with pytest.raises(errors.RangeError):
        small.export_c("a-b")


def test_what_is_at_stake_counts():
    x = plane()
    values = np.zeros((len(x), 2))
    values[:, 1] = np.where(x[:, 0] > 0, 10.0, -10.0) + np.where(x[:, 1] > 0, 0.1, -0.1)
    assert shrink(x, values, 2).text().startswith("x[0]")


@pytest.mark.parametrize("values", [np.zeros((400, 2)), np.ones((400, 1)), np.eye(2)[[1] * 400]])
def test_nothing_to_tell_apart(values):
    small = shrink(plane(), values, 12)
    assert small.leaves == 1 and small.act(plane()).tolist() == [int(values[0].argmax())] * 400


def test_much_at_stake_does_not_take_all_leaves():
    x = plane()
    values = np.zeros((len(x), 2))
    values[:, 1] = np.where(x[:, 1] > 0.95, -100, np.sign(x[:, 0]))  # ten rows, or most of it all
    assert shrink(x, values, 2).text().startswith("x[0]")
    assert "x[1] > 0.9" in shrink(x, values, 3).text()


def test_tests_that_lead_to_the_same_are_left_out():
    x = np.round(plane() * 2)  # -2 to 2
    values = np.eye(2)[(np.abs(x[:, 0]) > 1).astype(int)]
    assert shrink(x, values, 12).leaves == 3
    # All want action 1, and by how much does not matter.
    assert shrink(x, np.stack([x[:, 0] * 0, 3 + x[:, 0]], axis=1), 12).leaves == 1
    with pytest.raises(errors.RangeError):
        shrink(x, values, 0)


def test_a_trial_ends_when_it_is_lost():
    trials, good, bad = Trials(), SmallPolicy(), SmallPolicy()
    trials.start(good)
    assert [trials.end_episode(10.0) for _ in range(5)] == [False] * 4 + [True]
    assert trials.best is good
    trials.start(bad)
    assert trials.end_episode(9.0) and trials.best is good
    trials.start(bad)
    assert [trials.end_episode(10.0) for _ in range(4)] == [False] * 4
    assert trials.best is good  # a tie so far, by fewer episodes
    assert trials.end_episode(11.0) and trials.best is bad
    trials.start(good)
    assert trials.end_episode(2.0)
    trials.resume()
    assert trials.policy is bad and trials.end_episode(4.0) and trials.best is not bad
    trials.resume()
    assert trials.policy is good  # which had 10.0 five times
    negative, worse = Trials(), SmallPolicy()
    negative.start(worse)
    negative.end_episode(-5.0)
    negative.start(good)
    assert not negative.end_episode(-1.0) and negative.best is good


def test_a_pole_is_balanced():
    run = rlvc.learn(gymnasium.make("CartPole-v1"), 3000, seed=1, discount=0.98, leaves=8)
    assert 2 <= run.small.leaves <= 8
    assert run.evaluate(gymnasium.make("CartPole-v1"), 10) > 100
    assert run.text() == run.encoder.explain(run.small.text())
    assert run.agent.config.min_samples == 64
    last = [record for record in run.history if record.interactions >= 0.75 * 3000]
    assert len(last) > 1 and all(record.splits == 0 for record in last)
    assert len({record.step for record in last}) == 1  # not learning, but choosing
    again = rlvc.learn(gymnasium.make("CartPole-v1"), 3000, seed=1, discount=0.98, leaves=8)
    assert again.text() == run.text() and again.agent.print() == run.agent.print()


class Drift(gymnasium.Env):
    """A number that is to be kept near 0; no episode ever ends."""

    observation_space = spaces.Box(-10, 10, (1,), np.float32)
    action_space = spaces.Discrete(2)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.at = 0.0
        return np.array([self.at], np.float32), {}

    def step(self, action):
        self.at = float(np.clip(self.at + (0.3 if action else -0.3), -3, 3))
        return np.array([self.at], np.float32), -abs(self.at), False, False, {}


def test_what_never_ends_is_tried_for_a_while():
    run = rlvc.learn(Drift(), 2000, seed=1, discount=0.9)
    assert run.small.act(np.array([[-2.0], [2.0]], np.float32)).tolist() == [1, 0]


def test_trials_only_where_they_can_be():
    with pytest.raises(errors.ConfigError, match="leaves"):
        rlvc.learn(gymnasium.make("FrozenLake-v1"), 100, leaves=5)
    with pytest.raises(errors.ConfigError, match="leaves"):
        rlvc.learn(Drift(), 100, leaves=-1)
    with pytest.raises(errors.ConfigError, match="leaves"):
        rlvc.learn(Drift(), 100, leaves=5, criterion="returns")
    run = rlvc.learn(Drift(), 500, seed=1, leaves=0)
    assert run.agent.config.min_samples == 8
    assert run.small is None and run.act(np.zeros(1, np.float32)) in (0, 1)
    stopped = rlvc.learn(Drift(), 2000, seed=1, callback=lambda run: True)
    assert len(stopped.history) == 1 and stopped.small is not None
