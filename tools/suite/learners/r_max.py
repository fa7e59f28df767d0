# SPDX-License-Identifier: MIT
"""R-max (Brafman and Tennenholtz, 2002), by a learner that is given the state of the world.

It plans on the model of what it tried. A state-action pair is known once it was tried ``known`` times;
until then it is worth the highest return there is. So the plan leads to what is little known, and once
nothing is worth finding out it is optimal. The highest return is the highest reward: in all tasks here
that ends an episode.
"""

import numpy as np

from ._model import Model, greedy


def learn(task, seed, check, checks=100):
    """One run; see the head of this package."""
    env, world = task.make(seed), task.world
    known = 1 if world.chance.max(axis=2).min() == 1 else 20
    highest = world.reward.max()
    model = Model(len(world.starts), world.actions, task.discount)
    hopes, values = np.full(len(world.starts), highest), np.zeros(len(world.starts))
    plan = model.solve(hopes, highest, known)
    every = task.interactions // checks
    state = world.state_of(env.reset(seed=seed)[0])
    for done in range(1, task.interactions + 1):
        action = int(plan[state].argmax())
        observation, reward, over, cut, _ = env.step(action)
        reached = world.state_of(observation)
        model.add(state, action, reward, reached, over)
        if model.tried[state, action] == known:
            plan = model.solve(hopes, highest, known)
        state = world.state_of(env.reset()[0]) if over or cut else reached
        if done % every == 0:
            check(done, greedy(world, model.solve(values, -np.inf, 1)))
    return {"bytes": model.nbytes}
