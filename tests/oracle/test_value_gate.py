# SPDX-License-Identifier: MIT
"""What the value gate does, in short runs: value_gate.py measures it in long ones."""
import statistics

import pytest

import value_gate

RUNS = range(5)


def median(task, **fields):
    classes, good = zip(*(value_gate.choose(task, seed, **fields) for seed in RUNS))
    return statistics.median(classes), statistics.median(good)


@pytest.mark.parametrize("task", ["no use", "both"])
def test_tests_of_no_use_stay_out(task):
    classes, good = median(task, gate=1)
    needed = value_gate.CHOICES[task][1] + 1
    assert (classes, good) == (needed, 1.0)
    assert median(task, gate=0)[0] > needed


def test_tests_of_use_only_together_are_lost():
    assert median("and", gate=1)[0] == 1
