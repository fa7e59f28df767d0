#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Introduces learning from a Gymnasium environment. The README shows what follows."""

import gymnasium

import rlvc

env = gymnasium.make("FrozenLake-v1", is_slippery=True)
run = rlvc.learn(env, 20_000, epsilon=0.5, seed=2)  # explore half of the time
print(run.text())
print("mean return:", run.evaluate(env, episodes=1000, seed=2).mean)
