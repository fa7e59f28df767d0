#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Introduces learning on real numbers: a pole is balanced by a tree that fits on a hand."""

import gymnasium

import rlvc

env = gymnasium.make("CartPole-v1")
run = rlvc.learn(env, 5000, seed=1)
print(run.text())
print("mean return:", run.evaluate(env, episodes=100, seed=1).mean)

run.policy().save("balance.rlvc")  # rlvc.PlannedPolicy.load reads it
print(run.policy().export_c("balance"))  # for a controller
