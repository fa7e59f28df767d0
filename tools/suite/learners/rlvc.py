# SPDX-License-Identifier: MIT
"""rlvc, with the defaults of ``rlvc.learn``: a planner on up to 64 real numbers, else an agent."""

import dataclasses

import numpy as np
from gymnasium import spaces

import rlvc


def _encode(run, rows):
    return np.ascontiguousarray(run.encoder.encode_many(rows))


def _act(run):
    if isinstance(run.learner, rlvc.Planner):
        return lambda rows: run.planner.predict(_encode(run, rows))
    return lambda rows: run.agent.predict(_encode(run, rows)).action


def _compact(run):
    policy = run.policy()
    return policy.info.leaves, lambda rows: policy.act(_encode(run, rows))


def _on_bits(run, task):
    """How many tests of an agent's tree are of distractors."""
    noise = task.distractors if task.world is None else task.world.distractors.tolist()
    return sum(int(split.feature) in noise for split in run.agent.splits) if noise else 0


def learn(task, seed, check):
    """One run; see the head of this package."""
    env = task.make(seed)
    real = isinstance(env.observation_space, spaces.Box)
    looked = []  # the tree at the last look: a planner's often stays as it is

    def look(run, last=False):
        plans = isinstance(run.learner, rlvc.Planner)
        tree = run.planner.print() if plans else None
        if not plans or last or looked != [tree]:
            looked[:] = [tree]
            check(run.history[-1].interactions if not last else task.interactions, _act(run))

    discount = {} if real else {"discount": task.discount}  # a planner has none
    run = rlvc.learn(env, task.interactions, seed=seed, callback=look, **discount)
    if real:
        look(run, last=True)
    return {
        "leaves": run.leaves,
        "distractors": None if real else _on_bits(run, task),
        "bytes": run.learner.memory_bytes,
        "compact": lambda: _compact(run),
        "config": dataclasses.asdict(run.learner.config),
    }
