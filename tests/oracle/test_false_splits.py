# SPDX-License-Identifier: MIT
"""The rate of false splits, in short runs: false_splits.py measures it in long ones."""
import pytest

import false_splits

RUNS, INTERACTIONS, EVERY = 40, 600, 50


@pytest.mark.parametrize("score", ["gain", "ranks"])
@pytest.mark.parametrize("task", false_splits.TASKS)
def test_seldom(task, score):
    """Six or more of 40 runs at 0.05 would come about once in a hundred times, were the rate just that."""
    score = false_splits.SCORES[score]
    assert false_splits.count(task, RUNS, INTERACTIONS, EVERY, alpha=0.05, score=score) < 6


@pytest.mark.parametrize("task", ["staying", "mixed drift"])
def test_what_stays_seldom_agrees(task):
    grown = sum(false_splits.grows_staying(task, seed, INTERACTIONS, EVERY, alpha=0.05) > 0 for seed in range(RUNS))
    assert grown < 6


def test_drift_would_be_taken_for_structure():
    assert any(false_splits.grows_staying("mixed drift", seed, INTERACTIONS, EVERY, alpha=0.05, dependence=0)
               for seed in range(5))


@pytest.mark.parametrize("seed", range(4))
def test_a_large_tree_tests_no_noise(seed):
    assert false_splits.tests_noise(seed, alpha=0.05) == (100, 0)


def test_they_would_be_seen():
    assert false_splits.count("coin", RUNS, INTERACTIONS, EVERY, alpha=1.0) > RUNS // 10
