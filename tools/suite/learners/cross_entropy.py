# SPDX-License-Identifier: MIT
"""A linear policy by the cross-entropy method: weights are drawn from a normal distribution, which moves
to those of the best episodes.

Mannor, Rubinstein and Gat, The cross entropy method for fast policy search, 2003; with noise that is
added to the deviation (Szita and Lorincz, 2006)."""

import numpy as np

POPULATION = 50
ELITE = 10
NOISE = 0.5  # of the deviation, falling to 0 over the run


def _episode(env, weights):
    """The return of an episode, and its interactions."""
    row, _ = env.reset()
    earned, taken, over = 0.0, 0, False
    while not over:
        row, reward, ended, cut, _ = env.step(int((weights[:, :-1] @ row + weights[:, -1]).argmax()))
        earned, taken, over = earned + float(reward), taken + 1, ended or cut
    return earned, taken


def _policy(weights):
    return lambda rows: (rows @ weights[:, :-1].T + weights[:, -1]).argmax(axis=1)


def learn(task, seed, check, times=1):
    """One run of ``times`` the task's interactions; see the head of this package."""
    env, random = task.make(seed), np.random.default_rng(seed)
    env.reset(seed=seed)
    mean = np.zeros((int(env.action_space.n), env.observation_space.shape[0] + 1))
    deviation, done, most = np.ones_like(mean), 0, times * task.interactions
    while done < most:
        drawn = mean + deviation * random.standard_normal((POPULATION, *mean.shape))
        returns = []
        for weights in drawn:
            earned, taken = _episode(env, weights)
            returns.append(earned)
            done += taken
        best = drawn[np.argsort(returns)[-ELITE:]]
        mean = best.mean(axis=0)
        deviation = best.std(axis=0) + NOISE * max(0.0, 1.0 - done / most)
        check(done, _policy(mean))
    return {"bytes": mean.nbytes}
