#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Introduces learning from a Gymnasium environment. The README shows what follows."""

import gymnasium

import rlvc

env = gymnasium.make("FrozenLake-v1", is_slippery=True)
run = rlvc.learn(env, 10_000, seed=2)
print(run.text())
print("mean return:", run.evaluate(env, episodes=1000, seed=2))
