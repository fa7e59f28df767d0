# SPDX-License-Identifier: MIT
"""Whatever value stands where another one belongs, the package answers with an error of its own."""

import numpy as np
import pytest
from gymnasium import spaces

import rlvc
import rlvc.envs
from rlvc import errors, fleet, plot


class Raises:
    """Raises at whatever is asked of it, also for its name."""

    def _no(self, *arguments):
        raise RuntimeError("no")

    __index__ = __float__ = __len__ = __iter__ = __array__ = __repr__ = __str__ = __fspath__ = _no
    __bool__ = __eq__ = __getattr__ = _no
    __hash__ = None


def raises_at_two():
    yield 1
    raise RuntimeError("no")


DEEP = []
for _ in range(5000):
    DEEP = [DEEP]

VALUES = {
    "a huge int": 10**400,
    "an int that cannot be spelt": 10**5000,
    "a list that cannot be spelt": DEEP,
    "what raises": Raises(),
    "what raises later": raises_at_two,
    "too many": range(10**12),
    "lists of several lengths": [[1], [2, 3]],
    "an array": np.array([1.0, 2.0]),
    "an empty array": np.zeros(0),
    "a record": np.zeros(1, [("a", "i4")]),
    "what is masked": np.ma.masked,
    "no character": "\ud800",
    "half a number": np.array([None, 1j], object),
}


def agent():
    made = rlvc.Agent(3, 2)
    made.begin(b"\1")
    return made


def planner():
    made = rlvc.Planner(rlvc.Thresholds(2), 2)
    made.begin(np.zeros(2, np.float32))
    return made


NUMBER, REALS = rlvc.Encoder(spaces.Discrete(3)), rlvc.Encoder(spaces.Box(-1, 1, (3,)))
SEEN = np.zeros(2, np.float32)
LEARNT = rlvc.learn(rlvc.envs.BinaryGridworld(), 30, seed=1)
PICTURES = np.zeros((60, 8, 8, 3), np.uint8)
GROUND = np.zeros((400, 400, 3), np.uint8)
LOG = {"observation": [0, 1], "action": [0, 1], "reward": [0.0, 1.0], "terminated": [False, True]}
ROWS = np.eye(2, dtype=bool)
LEAF = (0.0, 65535, 0, 0)
CALLS = {
    "bits": rlvc.Bits,
    "components": rlvc.Thresholds,
    "oblique": lambda value: rlvc.Thresholds(2, oblique=value),
    "radius": lambda value: rlvc.Descriptors(2, 2, value),
    "form": lambda value: rlvc.Bags(2, 2, 1.0, form=value),
    "actions": lambda value: rlvc.Agent(3, value),
    "capacity": lambda value: rlvc.Agent(3, 2, capacity=value),
    "discount": lambda value: rlvc.Agent(3, 2, discount=value),
    "criterion": lambda value: rlvc.Agent(3, 2, criterion=value),
    "continuing": lambda value: rlvc.Agent(3, 2, continuing=value),
    "sample": lambda value: rlvc.Planner(rlvc.Thresholds(2), 2, sample=value),
    "percept": lambda value: agent().begin(value),
    "percepts": lambda value: agent().predict(value),
    "action": lambda value: agent().observe(value, 0.0, b"\1"),
    "exploited": lambda value: agent().observe((0, value), 0.0, b"\1"),
    "reward": lambda value: agent().observe(0, value, b"\1"),
    "terminated": lambda value: agent().observe(0, 0.0, b"\1", value),
    "truncated": lambda value: planner().observe(0, 0.0, SEEN, False, value),
    "resume": lambda value: agent().observe_many(
        np.zeros((1, 1), np.uint8), np.zeros(1, rlvc.CHOICE), np.zeros(1, np.float32),
        np.zeros((1, 1), np.uint8), np.zeros(1, np.uint8), value,
    ),
    "budget": lambda value: agent().learn(value),
    "print": lambda value: agent().print(value),
    "names": lambda value: agent().save("never.rlvc", value),
    "file": lambda value: rlvc.load(value),
    "snapshot": lambda value: rlvc.Agent.restore(3, rlvc.Config(2), value),
    "feature": lambda value: rlvc.Bits(3).exhibits(b"\1", value),
    "name": lambda value: rlvc.Bags(2, 2, 1.0).name(value),
    "record": lambda value: rlvc.Thresholds(2).feature(value),
    "rows": lambda value: rlvc.min_tree(value, ROWS),
    "nodes": lambda value: rlvc.PlannedPolicy(rlvc.Thresholds(2), 2, value),
    "node": lambda value: rlvc.PlannedPolicy(rlvc.Thresholds(2), 2, [value]),
    "cutpoint": lambda value: rlvc.PlannedPolicy(rlvc.Thresholds(2), 2, [(value, *LEAF[1:])]),
    "observation": NUMBER.encode,
    "observations": NUMBER.encode_many,
    "reals": REALS.encode,
    "rows of reals": REALS.encode_many,
    "env": lambda value: rlvc.learn(value, 10),
    "environments": lambda value: rlvc.learn_many(value, 10, seeds=2),
    "render_mode": lambda value: rlvc.envs.BinaryGridworld(render_mode=value),
    "placement": lambda value: rlvc.envs.TiledGridworld(pictures=PICTURES, placement=value),
    "goal": lambda value: rlvc.envs.GroundView(GROUND, 16, goal=value),
    "walls": lambda value: rlvc.envs.GroundView(GROUND, 16, walls=value),
    "wall": lambda value: rlvc.envs.GroundView(GROUND, 16, walls=[value]),
    "columns": lambda value: rlvc.learn_from(LOG, columns=value),
    "history": lambda value: rlvc.learn_from(LOG, history=value),
    "source": fleet.learn_from,
    "drawing": lambda value: plot.splits(LEARNT, value),
    "axes": lambda value: plot.splits(LEARNT, ax=value),
    "words": lambda value: rlvc.Actions(2, words=value),
}  # fmt: skip
HARMLESS = {  # texts can be made of it, or there are none
    ("words", "an array"), ("words", "an empty array"), ("words", "a record"),
    ("words", "lists of several lengths"), ("words", "half a number"), ("words", "a list that cannot be spelt"),
    ("names", "an empty array"), ("rows of reals", "an empty array"), ("observations", "an empty array"),
    ("walls", "an empty array"), ("columns", "an empty array"),
}  # fmt: skip
PAIRS = [(call, value) for call in CALLS for value in VALUES if (call, value) not in HARMLESS]


@pytest.mark.parametrize(("call", "value"), PAIRS)
def test_what_is_no_such_value(call, value, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    given = VALUES[value]() if VALUES[value] is raises_at_two else VALUES[value]
    with pytest.raises(errors.Error) as caught:
        CALLS[call](given)
    assert 10 < len(str(caught.value)) < 400
    assert not list(tmp_path.iterdir())
