# SPDX-License-Identifier: MIT
"""The common form of all logs."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..errors import LogError


@dataclasses.dataclass
class Log:
    """A sequence of interactions.

    Attributes
    ----------
    before, after : ndarray, [n, ...], or list of observations
        s and s'.
    actions : ndarray of int, [n]
        In [0, 254].
    rewards : ndarray of float32, [n]
    ends : ndarray of uint8, [n]
        0: the episode goes on; 1: terminated; 2: truncated.
    exploited : ndarray of bool, [n], or None
        Whether the action was greedy; None: unknown.
    where : str
        The file or data set, for error messages.
    columns : list of str
        Names of the elements of an observation, if known.
    record_bytes : int
        Size of a percept, if before and after are percepts [n, record_bytes]; 0: they are
        observations.
    action_count : int
        Number of actions; 0: unknown.
    """

    before: Any
    after: Any
    actions: npt.NDArray[np.int64]
    rewards: npt.NDArray[np.float32]
    ends: npt.NDArray[np.uint8]
    exploited: npt.NDArray[np.bool_] | None
    where: str
    columns: list[str] = dataclasses.field(default_factory=list)
    record_bytes: int = 0
    action_count: int = 0

    def __len__(self) -> int:
        """Return the number of interactions."""
        return len(self.actions)


def checked(log: Log) -> Log:
    """Return the log, or raise LogError if a reward is not finite or an action out of range."""
    bad = np.flatnonzero(~np.isfinite(log.rewards))
    if len(bad):
        raise LogError(
            f"{log.where}: rewards: index {bad[0]}: {log.rewards[bad[0]]} is not a finite number"
        )
    bad = np.flatnonzero(np.abs(log.rewards) > _native.REWARD_MAX)
    if len(bad):
        raise LogError(
            f"{log.where}: rewards: index {bad[0]}: {log.rewards[bad[0]]} is not in [-1e12, 1e12]"
        )
    bad = np.flatnonzero((log.actions < 0) | (log.actions > 254))
    if len(bad):
        raise LogError(
            f"{log.where}: actions: index {bad[0]}: {log.actions[bad[0]]} is not in [0, 254]"
        )
    return log
