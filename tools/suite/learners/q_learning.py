# SPDX-License-Identifier: MIT
"""Tabular Q-learning (Watkins, 1989), epsilon-greedy:

    Q(s, a) := Q(s, a) + rate * (r + discount * max over b of Q(s', b) - Q(s, a)),    Q = 0 at first

A state is the true state of the world, or, if ``raw``, the whole observation with its distractors.
"""

import collections

import numpy as np


def learn(task, seed, check, rate=0.1, epsilon=0.1, checks=100, raw=False):
    """One run; see the head of this package."""
    env, world = task.make(seed), task.world
    random = np.random.default_rng([seed, 3])
    zeros = np.zeros(world.actions)
    table = collections.defaultdict(zeros.copy)
    every = task.interactions // checks

    def key(observation):
        return observation.tobytes() if raw else world.state_of(observation)

    def act(rows):
        return np.array([table.get(key(row), zeros) for row in rows]).argmax(axis=1)

    state = key(env.reset(seed=seed)[0])
    for done in range(1, task.interactions + 1):
        q = table[state]
        if random.random() < epsilon:
            action = int(random.integers(world.actions))
        else:
            action = int(random.choice(np.flatnonzero(q == q.max())))
        observation, reward, over, cut, _ = env.step(action)
        reached = key(observation)
        target = reward + (0.0 if over else task.discount * table[reached].max())
        q[action] += rate * (target - q[action])
        state = key(env.reset()[0]) if over or cut else reached
        if done % every == 0:
            check(done, act)
    return {"bytes": len(table) * zeros.nbytes}
