# SPDX-License-Identifier: MIT
"""The learners: ours, and its peers. Each has ``learn(task, seed, check)``.

``check(interactions, act)`` is called now and then with the greedy policy so far, ``act`` giving the
actions of an array of observations. What is returned says how large the result is; ``compact`` in it, if
there, gives the leaves and the actions of a policy made compact.
"""

import dataclasses
import importlib.util
from collections.abc import Callable

import numpy as np

import rlvc

# ------------------------------------------------------------------ ours


def _packed(run, rows):
    return np.ascontiguousarray(run.encoder.encode_many(rows))


def _compact(run):
    if run.small is not None:  # found by trials
        return run.small.leaves, rlvc_act(run)
    policy = run.agent.compact()
    return policy.info.leaves, lambda rows: policy.act(_packed(run, rows))


def rlvc_act(run):
    if run.small is not None:
        return lambda rows: run.small.act(np.asarray(rows, np.float32))
    return lambda rows: run.agent.predict(_packed(run, rows)).action


def learn_rlvc(task, seed, check):
    """The defaults of ``rlvc.learn``."""
    run = rlvc.learn(
        task.make(seed), task.interactions, seed=seed, discount=task.discount,
        callback=lambda run: check(run.history[-1].interactions, rlvc_act(run)),
    )  # fmt: skip
    noise = [] if task.world is None else task.world.distractors.tolist()
    return {
        "leaves": run.agent.classes,
        "distractors": sum(int(split.feature) in noise for split in run.agent.splits) if noise else 0,
        "bytes": run.agent.memory_bytes,
        "compact": lambda: _compact(run),
        "config": dataclasses.asdict(run.agent.config),
    }


# ------------------------------------------------------------------ tabular Q-learning


def learn_q(task, seed, check, rate=0.1, epsilon=0.1, checks=100):
    """Q-learning that is told the state."""
    env, world = task.make(seed), task.world
    random = np.random.default_rng([seed, 3])
    q = np.zeros((len(world.starts), world.actions))
    every = task.interactions // checks

    def act(rows):
        return q[[world.state_of(row) for row in rows]].argmax(axis=1)

    state = world.state_of(env.reset(seed=seed)[0])
    for done in range(1, task.interactions + 1):
        if random.random() < epsilon:
            action = int(random.integers(world.actions))
        else:
            action = int(random.choice(np.flatnonzero(q[state] == q[state].max())))
        observation, reward, over, cut, _ = env.step(action)
        reached = world.state_of(observation)
        target = reward + (0.0 if over else task.discount * q[reached].max())
        q[state, action] += rate * (target - q[state, action])
        state = world.state_of(env.reset()[0]) if over or cut else reached
        if done % every == 0:
            check(done, act)
    return {"bytes": q.nbytes}


# ------------------------------------------------------------------ fitted Q iteration


def learn_fqi(task, seed, check, trees=50, rounds=50, checks=1):
    """Fitted Q iteration with extremely randomized trees, on random actions."""
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


# ------------------------------------------------------------------ DQN


def learn_dqn(task, seed, check, checks=20):
    """Stable-Baselines3's DQN, its defaults but the discount."""
    import torch
    from stable_baselines3 import DQN
    from stable_baselines3.common.callbacks import BaseCallback

    torch.set_num_threads(1)
    model = DQN("MlpPolicy", task.make(seed), gamma=task.discount, seed=seed, device="cpu")

    class Checks(BaseCallback):
        def _on_step(self):
            if self.num_timesteps % (task.interactions // checks) == 0:
                check(self.num_timesteps, lambda rows: model.predict(rows, deterministic=True)[0])
            return True

    model.learn(task.interactions, callback=Checks())
    return {"bytes": sum(p.numel() * p.element_size() for p in model.q_net.parameters())}


@dataclasses.dataclass(frozen=True)
class Learner:
    """A learner, how it was set, and what it needs: names of modules, and the package of each."""

    learn: Callable
    about: str = ""
    needs: dict = dataclasses.field(default_factory=dict)


LEARNERS = {
    "rlvc": Learner(learn_rlvc),
    "q": Learner(learn_q, "rate 0.1, epsilon 0.1; without distractors"),
    "fqi": Learner(learn_fqi, "on random actions, 50 trees, 50 rounds when all of them are done", {
        "sklearn": "python3-sklearn",
    }),
    "dqn": Learner(learn_dqn, "Stable-Baselines3's, with its defaults but the discount", {
        "torch": "python3-torch", "pandas": "python3-pandas", "matplotlib": "python3-matplotlib",
        "stable_baselines3": "stable-baselines3",
    }),
}  # fmt: skip


def missing(learner):
    """The packages that a learner needs and that are not there."""
    wanted = LEARNERS[learner].needs
    return [package for module, package in wanted.items() if not importlib.util.find_spec(module)]
