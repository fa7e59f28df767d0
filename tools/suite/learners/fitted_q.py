# SPDX-License-Identifier: MIT
"""Fitted Q iteration (Ernst, Geurts and Wehenkel, 2005) with extremely randomized trees.

The interactions come from random actions.
"""

import numpy as np


def learn(task, seed, check, trees=50, rounds=50, checks=1):
    """One run; see the head of this package."""
    from sklearn.ensemble import ExtraTreesRegressor

    env = task.make(seed)
    random = np.random.default_rng([seed, 4])
    actions = int(env.action_space.n)
    log = []
    before, _ = env.reset(seed=seed)
    model = None

    def joined(rows, chosen):
        return np.concatenate([rows, np.eye(actions)[chosen]], axis=1).astype(np.float32)

    def values(rows):
        return np.stack(
            [model.predict(joined(rows, np.full(len(rows), a))) for a in range(actions)], axis=1
        )

    for done in range(1, task.interactions + 1):
        action = int(random.integers(actions))
        after, reward, over, cut, _ = env.step(action)
        log.append((before, action, reward, after, over))
        before = env.reset()[0] if over or cut else after
        if done % (task.interactions // checks):
            continue
        s, a, r, reached, ended = (np.array(column) for column in zip(*log, strict=True))
        inputs, targets = joined(s, a), r.astype(float)
        for _ in range(rounds):
            model = ExtraTreesRegressor(trees, min_samples_split=5, random_state=seed, n_jobs=1)
            model.fit(inputs, targets)
            targets = r + task.discount * np.where(ended, 0.0, values(reached).max(axis=1))
        check(done, lambda rows: values(rows).argmax(axis=1))
    nodes = sum(tree.tree_.node_count for tree in model.estimators_)
    leaves = sum(int(tree.get_n_leaves()) for tree in model.estimators_)
    return {"leaves": leaves, "bytes": nodes * 64}
