# SPDX-License-Identifier: MIT
"""Policies made of agents: what they do, how small they are, and their export as C."""

import dataclasses
import subprocess

import numpy as np
import pytest

import rlvc
from rlvc import errors

ALL = np.arange(8, dtype=np.uint8)[:, None]


@pytest.fixture
def agent(walk):
    agent = walk()
    agent.learn()
    return agent


@pytest.fixture
def sorter():
    """An agent whose tree tests first what is worth most, bit 0, of which nothing follows."""
    agent = rlvc.Agent(3, 2)
    for i in range(960):
        percept = np.array([i % 8], np.uint8)
        right = i % 8 >= 6
        agent.begin(percept)
        agent.observe(i // 8 % 2, 10.0 * (i % 2) + (i // 8 % 2 == right), None, terminated=True)
    agent.learn()
    return agent


def test_it_acts_as_the_agent(agent):
    policy = agent.compact(0)
    assert policy.info.classes == agent.classes
    assert policy.info.leaves <= policy.info.collapsed <= policy.info.classes
    cells = ALL[[0, 1, 2, 3, 4, 6, 7]]  # in 5 nothing is ever done
    actions = policy.act(cells)
    assert actions.dtype == np.uint32
    np.testing.assert_array_equal(actions, agent.predict(cells).action)
    assert [policy.act(bytes(cell)) for cell in cells] == list(actions)
    assert policy.act(ALL[3]) == actions[3]


def test_it_is_as_small_as_can_be(sorter):
    policy = sorter.compact()
    assert dataclasses.astuple(policy.info)[:8] == (6, 6, 3, 8, 3, policy.info.bytes, True, False)
    assert policy.info.value_after == policy.info.value_before > 0
    np.testing.assert_array_equal(policy.act(ALL), sorter.predict(ALL).action)
    assert repr(policy) == "<rlvc.Policy of 3 leaves>"
    assert len(policy.tree["nodes"]) == 5
    assert policy.print().count("action") == 3
    assert policy.print("dot").startswith("digraph")
    assert sorter.compact(1.0).info.leaves == 1


def test_what_bounds_it(sorter):
    assert sorter.compact(percepts=7).info.as_agent
    assert sorter.compact(percepts=8).info.leaves == 3
    info = sorter.compact(entries=2, effort=1).info
    assert not info.exact and info.leaves >= 3


def test_it_outlives_the_agent(sorter):
    policy = sorter.compact()
    before = policy.act(ALL)
    sorter.close()
    np.testing.assert_array_equal(policy.act(ALL), before)
    policy.close()
    for use in (lambda: policy.act(ALL), lambda: policy.act(bytes(1)), policy.print):
        with pytest.raises(errors.ClosedError):
            use()
    with pytest.raises(errors.ClosedError):
        sorter.compact()


@pytest.mark.parametrize(
    "change",
    [
        {"tolerance": -1.0},
        {"tolerance": 1.5},
        {"tolerance": float("nan")},
        {"percepts": 0},
        {"percepts": -1},
        {"entries": 1},
        {"entries": 2**40},
        {"effort": 0},
        {"tolerance": "much"},
        {"effort": 1.5},
    ],
)
def test_what_it_refuses(agent, change):
    with pytest.raises((errors.RangeError, errors.ConfigError)):
        agent.compact(**change)


def test_percepts_and_forms_it_refuses(agent):
    policy = agent.compact()
    with pytest.raises(errors.PerceptError):
        policy.act(bytes(2))
    with pytest.raises(errors.PerceptError):
        policy.act(np.zeros((3, 2), np.uint8))
    with pytest.raises(errors.RangeError):
        policy.print("prose")
    with pytest.raises(errors.RangeError):
        policy.export_c("no name")


class Failing(rlvc.Domain):
    """Three bits, whose detector fails when it is told to."""

    def __init__(self):
        super().__init__(np.uint8, (1,), np.int32, 3)
        self.fails = False

    def exhibits(self, percept, feature):
        if self.fails:
            raise ZeroDivisionError
        return bool(percept[0] >> feature & 1)

    def candidates(self, percepts):
        return np.arange(3, dtype=np.int32)

    def name(self, feature):
        return f"bit {feature}"


def test_a_fault_of_the_domain(walk):
    domain = Failing()
    agent = walk(domain)
    agent.learn()
    policy = agent.compact()
    domain.fails = True
    with pytest.raises(ZeroDivisionError):
        agent.compact()
    with pytest.raises(ZeroDivisionError):
        policy.act(bytes([3]))
    with pytest.raises(ZeroDivisionError):
        policy.act(ALL)
    domain.fails = False
    assert policy.act(bytes([7])) == 0
    with pytest.raises(errors.ConfigError):
        policy.export_c()


def test_its_export_is_the_policy(sorter, tmp_path):
    policy = sorter.compact()
    (tmp_path / "small.h").write_text(policy.export_c("small"), encoding="utf-8")
    (tmp_path / "main.c").write_text(
        '#include <stdio.h>\n#include "small.h"\nint main(void) {\n'
        "    for (int i = 0; i < 8; i++) {\n        unsigned char percept = (unsigned char)i;\n"
        '        printf("%u\\n", small_act(&percept));\n    }\n    return 0;\n}\n',
        encoding="utf-8",
    )
    program = tmp_path / "main"
    subprocess.run(["gcc", "-std=c99", "-o", program, tmp_path / "main.c"], check=True)
    done = subprocess.run([program], capture_output=True, text=True, check=True)
    np.testing.assert_array_equal([int(line) for line in done.stdout.split()], policy.act(ALL))


def test_prune(walk):
    agent = walk()
    agent.learn()
    before = agent.predict(ALL[1:]).action
    classes = agent.classes
    assert agent.prune() == 0
    assert agent.prune(0.5) == classes - agent.classes > 0
    np.testing.assert_array_equal(agent.predict(ALL[1:]).action, before)
    agent.check()
    assert agent.learn().splits > 0, "what differs is split again"
    for wrong in ((-1.0, 0.0), (0.0, -1.0), (float("nan"), 0.0), ("much", 0.0)):
        with pytest.raises(errors.RangeError):
            agent.prune(*wrong)
    agent.begin(ALL[1])
    agent.observe(agent.act(), 0.0, None, terminated=True)
    agent.learn(64)
    with pytest.raises(errors.BusyError):
        agent.prune()


def reference(rows, allowed):
    """The fewest leaves, by trying every feature at every node."""
    if allowed.all(axis=0).any():
        return 1
    sides = [rows[:, f] for f in range(rows.shape[1]) if 0 < rows[:, f].sum() < len(rows)]
    return min(
        reference(rows[~s], allowed[~s]) + reference(rows[s], allowed[s]) for s in sides
    )  # fmt: skip


def leaf_of(tree, row):
    leaf = 0
    for j, (split, feature) in enumerate(tree.splits):
        if split == leaf and row[feature]:
            leaf = j + 1
    return leaf


def test_the_fewest_leaves():
    random = np.random.default_rng(1)
    for _ in range(50):
        rows = np.unique(random.random((12, 5)) < 0.5, axis=0)
        allowed = random.random((len(rows), 3)) < 0.4
        allowed[np.arange(len(rows)), random.integers(3, size=len(rows))] = True
        tree = rlvc.min_tree(rows, allowed)
        assert tree.exact and tree.leaves == reference(rows, allowed)
        assert all(a[tree.actions[leaf_of(tree, r)]] for r, a in zip(rows, allowed, strict=True))
    wide = np.zeros((2, 200), bool)
    wide[1, 150] = True
    assert rlvc.min_tree(wide, np.eye(2, dtype=bool)).splits.tolist() == [[0, 150]]


def test_what_fewest_refuses():
    rows, allowed = np.eye(2, dtype=bool), np.eye(2, dtype=bool)
    for wrong in (rows.astype(int), rows[0]):
        with pytest.raises(errors.ArrayError):
            rlvc.min_tree(wrong, allowed)
    with pytest.raises(errors.ArrayError):
        rlvc.min_tree(rows, allowed[:1])
    for numbers in ({"entries": 1}, {"entries": 2**29}, {"effort": 0}, {"effort": 0.5}):
        with pytest.raises(errors.RangeError):
            rlvc.min_tree(rows, allowed, **numbers)
    for torn in (np.zeros((2, 2), bool), np.zeros((2, 65), bool)):
        with pytest.raises(errors.RangeError):
            rlvc.min_tree(rows, torn)
    with pytest.raises(errors.RangeError):
        rlvc.min_tree(np.zeros((2, 2), bool), allowed)
    with pytest.raises(errors.RangeError):
        rlvc.min_tree(np.zeros((0, 2), bool), np.zeros((0, 2), bool))


def test_a_run_plays_with_it():
    gymnasium = pytest.importorskip("gymnasium")
    env = gymnasium.make("FrozenLake-v1", is_slippery=False)
    run = rlvc.learn(env, 1000, seed=1)
    assert run.evaluate(env, 5, seed=1).mean == run.compact().evaluate(env, 5, seed=1).mean == 1.0
    assert run.leaves < run.agent.classes
