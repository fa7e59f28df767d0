# SPDX-License-Identifier: MIT
"""What learning in Python costs, beside the environment and the core."""

import gymnasium

from rlvc import bench


def test_learning_takes_little_more_than_the_environment_and_the_core():
    whole, alone, core = bench.learning_times(gymnasium.make("Taxi-v4"), 5000)
    assert whole <= 3 * (alone + core)
