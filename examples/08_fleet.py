#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Introduces learning from the logs of many machines: four robots cross a frozen lake by chance.

Each robot's log becomes Parquet files. Workers of a cluster, here Ray on this machine, count what is
in them; the counts make the tree that all interactions in one memory would make. A robot loads it and
goes on learning from what it sees itself.
"""

import gymnasium as gym
import numpy as np

import rlvc
import rlvc.fleet

INTERACTIONS = 5000  # of each robot


def wander(seed):
    """The log of a robot that acts by chance: bits of the cell's number, in arrays."""
    env, random = gym.make("FrozenLake-v1", is_slippery=True), np.random.default_rng(seed)
    columns = [[] for _ in range(6)]
    cell, _ = env.reset(seed=seed)
    for _ in range(INTERACTIONS):
        action = int(random.integers(4))
        after, reward, terminated, truncated, _ = env.step(action)
        seen = (cell, after, action, reward, terminated, truncated)
        for column, value in zip(columns, seen, strict=True):
            column.append(value)
        cell = env.reset()[0] if terminated or truncated else after
    names = ("observations", "next_observations", "actions", "rewards", "terminated", "truncated")
    log = dict(zip(names, map(np.array, columns), strict=True))
    for name in names[:2]:
        log[name] = (log[name][:, None] >> np.arange(4) & 1).astype(bool)
    return log


if __name__ == "__main__":  # the workers import this file, too
    for robot in range(4):
        rlvc.fleet.convert(wander(robot), "logs", prefix=f"robot-{robot}", actions=4)

    run = rlvc.fleet.learn_from("logs", cluster="ray", workers=2)
    print(run.text())
    print(f"{run.report.interactions} interactions in {run.report.passes} passes")

    run.agent.save("agent.rlvc")
    robot = rlvc.Agent.load("agent.rlvc")  # on the robot: it holds 2,000 interactions
    print(f"the robot begins with {robot.classes} classes")
    env = gym.make("FrozenLake-v1", is_slippery=True)
    returns = []
    for episode in range(200):
        cell, _ = env.reset(seed=episode)
        over = False
        while not over:
            cell, reward, terminated, truncated, _ = env.step(robot.predict(bytes([cell])).action)
            over = terminated or truncated
        returns.append(reward)
    print(f"mean return: {np.mean(returns):.2f}")
