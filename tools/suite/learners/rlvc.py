# SPDX-License-Identifier: MIT
"""rlvc, with the defaults of ``rlvc.learn``."""

import dataclasses

import numpy as np

import rlvc


def _encode(run, rows):
    return np.ascontiguousarray(run.encoder.encode_many(rows))


def _act(run):
    if run.small is not None:  # a small policy, found by trials
        return lambda rows: run.small.act(np.asarray(rows, np.float32))
    return lambda rows: run.agent.predict(_encode(run, rows)).action


def _compact(run):
    if run.small is not None:
        return run.small.leaves, _act(run)
    policy = run.agent.compact()
    return policy.info.leaves, lambda rows: policy.act(_encode(run, rows))


def learn(task, seed, check):
    """One run; see the head of this package."""
    run = rlvc.learn(
        task.make(seed), task.interactions, seed=seed, discount=task.discount,
        callback=lambda run: check(run.history[-1].interactions, _act(run)),
    )  # fmt: skip
    noise = [] if task.world is None else task.world.distractors.tolist()
    return {
        "leaves": run.agent.classes,
        "distractors": sum(int(split.feature) in noise for split in run.agent.splits) if noise else 0,
        "bytes": run.agent.memory_bytes,
        "compact": lambda: _compact(run),
        "config": dataclasses.asdict(run.agent.config),
    }
