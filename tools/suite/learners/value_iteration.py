# SPDX-License-Identifier: MIT
"""Value iteration on a model of a random walk, by a learner that is given the state of the world."""

import numpy as np

from ._model import Model, greedy


def learn(task, seed, check, checks=100):
    """One run; see the head of this package."""
    env, world = task.make(seed), task.world
    random = np.random.default_rng([seed, 5])
    model = Model(len(world.starts), world.actions, task.discount)
    values = np.zeros(len(world.starts))
    every = task.interactions // checks
    state = world.state_of(env.reset(seed=seed)[0])
    for done in range(1, task.interactions + 1):
        action = int(random.integers(world.actions))
        observation, reward, over, cut, _ = env.step(action)
        reached = world.state_of(observation)
        model.add(state, action, reward, reached, over)
        state = world.state_of(env.reset()[0]) if over or cut else reached
        if done % every == 0:
            check(done, greedy(world, model.solve(values, -np.inf, 1)))
    return {"bytes": model.nbytes}
