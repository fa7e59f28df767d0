# SPDX-License-Identifier: MIT
"""What every kind of log is read into."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..errors import LogError


@dataclasses.dataclass
class Log:
    """Interactions, one after another.

    Attributes
    ----------
    before, after : ndarray, [n, ...], or list of observations
        s and s'.
    actions : ndarray of int, [n]
        From 0 on.
    rewards : ndarray of float32, [n]
    ends : ndarray of uint8, [n]
        0: goes on; 1: terminated; 2: truncated.
    exploited : ndarray of bool, [n], or None
        Whether the action was the greedy one of the policy that acted; None if not known.
    where : str
        The file or the data set, for what is said about damage.
    columns : list of str
        What the numbers of an observation are called, as far as that is known.
    record_bytes : int
        If before and after are percepts' records, [n, record_bytes]; 0: they are observations.
    action_count : int
        How many actions there are, if the log says so; 0: it does not.
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
        """Give the number of interactions."""
        return len(self.actions)


def checked(log: Log) -> Log:
    """Refuse a log with a reward that is not finite, or an action out of range."""
    bad = np.flatnonzero(~np.isfinite(log.rewards))
    if len(bad):
        raise LogError(
            f"{log.where}: rewards: index {bad[0]}: {log.rewards[bad[0]]} is no finite number"
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
