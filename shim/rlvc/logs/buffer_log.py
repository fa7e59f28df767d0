# SPDX-License-Identifier: MIT
"""The replay buffers of Stable-Baselines3 as logs."""

from __future__ import annotations

from typing import Any

import numpy as np

from .array_log import from_arrays
from .log import Log


def is_buffer(log: Any) -> bool:
    """Whether this is a replay buffer of Stable-Baselines3."""
    return all(
        hasattr(log, name)
        for name in ("observations", "actions", "rewards", "dones", "pos", "full")
    )


def from_buffer(buffer: Any, where: str = "buffer", **arguments: Any) -> Log:
    """Make a log of a replay buffer of Stable-Baselines3.

    Parameters
    ----------
    buffer : stable_baselines3.common.buffers.ReplayBuffer or DictReplayBuffer
        Of several environments each is taken by itself.
    where : str
        Name of the log in errors.
    **arguments
        Of :func:`rlvc.logs.from_arrays`.
    """
    count, full = int(buffer.pos), bool(buffer.full)
    rows = np.roll(np.arange(len(buffer.actions)), -count) if full else np.arange(count)

    def column(values: Any) -> Any:
        taken = np.asarray(values)[rows]  # [n, environments, ...]
        return np.concatenate([taken[:, i] for i in range(taken.shape[1])])

    arrays: dict[str, Any] = {}
    following = buffer.next_observations
    if getattr(buffer, "optimize_memory_usage", False):
        following = np.roll(np.asarray(buffer.observations), -1, axis=0)
    for name, values in (("observations", buffer.observations), ("next_observations", following)):
        if isinstance(values, dict):
            start = "" if name == "observations" else "next_"
            arrays |= {f"{start}obs_{key}": column(value) for key, value in values.items()}
        else:
            arrays[name] = column(values)
    for name in ("actions", "rewards", "dones", "timeouts"):
        if hasattr(buffer, name):
            arrays[name] = column(getattr(buffer, name))
    environments = np.asarray(buffer.actions).shape[1]
    if environments > 1:
        arrays["episode"] = np.repeat(np.arange(environments), len(rows))
    return from_arrays(arrays, where, **arguments)
