# SPDX-License-Identifier: MIT
"""What learning in Python costs, beside the environment and the core."""

import gymnasium
import pytest

from rlvc import bench


@pytest.mark.parametrize(
    ("task", "interactions"), [("Taxi-v4", 5000), ("FrozenLake-v1", 5000), ("CartPole-v1", 1000)]
)
def test_learning_takes_little_more_than_the_environment_and_the_core(task, interactions):
    whole, alone, core = bench.learning_times(gymnasium.make(task), interactions)
    assert whole <= 3 * (alone + core)
