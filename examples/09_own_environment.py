#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Introduces an environment of one's own: a thermostat in a room with a window."""

import gymnasium
import numpy as np
from gymnasium import spaces

import rlvc


class Room(gymnasium.Env):
    def __init__(self):
        self.observation_space = spaces.MultiDiscrete([8, 2])  # warmth, window
        self.action_space = spaces.Discrete(2)  # wait, heat

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.warmth, self.window, self.hour = 4, int(self.np_random.integers(2)), 0
        return self.observe(), {}

    def observe(self):
        return np.array([self.warmth, self.window])

    def step(self, action):
        change = (2 if action else -1) - self.window  # an open window cools
        self.warmth = int(np.clip(self.warmth + change, 0, 7))
        if self.np_random.random() < 0.1:
            self.window = 1 - self.window
        self.hour += 1
        reward = -0.3 * float(action) - (1.0 if self.warmth < 3 else 0.0)
        over = self.hour == 23
        return self.observe(), reward, False, over, {}  # truncated: the day is over, the room is not


run = rlvc.learn(Room(), 8000, seed=1, discount=0.9, epsilon=0.5, names=["warmth", "window"])
print(run.text())
print("mean return:", run.evaluate(Room(), episodes=200, seed=3).mean)
