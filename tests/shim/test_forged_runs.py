# SPDX-License-Identifier: MIT
"""The head of a run's file with members that no run has, and a right checksum: it is refused by an error of
the package, or the run that it makes can be used."""

import copy
import json
import zlib

import gymnasium
import numpy as np
import pytest
from gymnasium import spaces

import rlvc
from rlvc import errors

HOSTILE = [None, True, -1, 0, 3, 255, 10**30, 0.5, float("nan"), float("inf"), "", "1", [], [None], {}, ["x"] * 3]


class Line(gymnasium.Env):
    """Eight places in a line, of which the last pays and ends the episode."""

    action_space = spaces.Discrete(2)

    def __init__(self, real):
        self.real = real
        self.observation_space = spaces.Box(-2, 2, (2,), np.float32) if real else spaces.Discrete(8)

    def seen(self):
        return np.array([self.place / 4 - 1, self.place % 2], np.float32) if self.real else self.place

    def reset(self, *, seed=None, options=None):
        self.place = 0
        return self.seen(), {}

    def step(self, action):
        self.place = min(7, max(0, self.place + 2 * int(action) - 1))
        return self.seen(), float(self.place == 7), self.place == 7, False, {}


RUNS = {
    "bits": (Line(False), {}, 200),
    "classes": (Line(True), {"method": "classes"}, 200),
    "planner": (Line(True), {}, 400),
}


def paths(value, path=()):
    """The way to each member, and to the first ones of a list."""
    if path:
        yield path
    members = value.items() if isinstance(value, dict) else enumerate(value[:3]) if isinstance(value, list) else ()
    for key, inner in members:
        yield from paths(inner, (*path, key))


def changed(head, path, value):
    made = copy.deepcopy(head)
    inner = made
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = value
    return made


def use(run, env):
    observation, _ = env.reset()
    run.predict(observation)
    run.predict(np.array([observation, observation]))
    run.explain(observation)
    run.export_c()
    run.importances()
    run.evaluate(env, episodes=1, max_steps=10)
    run.learn(env, 3)
    assert run.text() and run._repr_html_()


@pytest.mark.filterwarnings("ignore::rlvc.errors.MaskWarning")  # a forged `masked` is believed
@pytest.mark.parametrize("name", RUNS)
def test_members_that_no_run_has(name, tmp_path):
    env, how, interactions = RUNS[name]
    file = tmp_path / "run"
    rlvc.learn(env, interactions, seed=1, **how).save(file)
    magic, line, rest = file.read_bytes()[:-4].split(b"\n", 2)
    head = json.loads(line)
    head["encoder"] = json.loads(head["encoder"])
    ways = [path for path in paths(head) if path[0] not in ("config", "planner")]  # the learner's tests have those
    drawn = np.random.default_rng(1)
    refused = 0
    for path in ways:
        for value in (HOSTILE[i] for i in drawn.choice(len(HOSTILE), 3, replace=False)):
            other = changed(head, path, value)
            if isinstance(other["encoder"], dict):
                other["encoder"] = json.dumps(other["encoder"])
            content = b"\n".join([magic, json.dumps(other).encode(), rest])
            file.write_bytes(content + zlib.crc32(content).to_bytes(4, "little"))
            try:
                use(rlvc.load(file), env)
            except errors.Error:
                refused += 1
            except Exception as error:
                raise AssertionError(f"{'.'.join(map(str, path))} = {value!r}") from error
    assert refused > len(ways)
