# SPDX-License-Identifier: MIT
"""The common form of all logs."""

from __future__ import annotations

import dataclasses
import warnings
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..errors import LogError, LogWarning
from ..learning.actions import Actions


@dataclasses.dataclass
class Log:
    """A sequence of interactions.

    Attributes
    ----------
    before, after : ndarray [n, ...], dict of columns [n], or list of n observations
        s and s'.
    actions : ndarray of int64, [n]
        Numbers of actions, [0, known.count).
    rewards : ndarray of float32, [n]
    ends : ndarray of uint8, [n]
        0: the episode goes on; 1: terminated; 2: truncated.
    exploited : ndarray of bool, [n], or None
        Whether the action was greedy; None: unknown.
    where : str
        The file or data set, for error messages.
    known : Actions
        What the numbers of the actions mean.
    space : object
        The space of an observation: of Gymnasium, or :class:`rlvc.learning.Numbers` or
        :class:`rlvc.learning.Columns`; None: of arrays.
    notes : list of str
        How the log was understood: one line for each decision.
    record_bytes : int
        Size of a percept, if before and after are percepts [n, record_bytes]; 0: they are
        observations.
    """

    before: Any
    after: Any
    actions: npt.NDArray[np.int64]
    rewards: npt.NDArray[np.float32]
    ends: npt.NDArray[np.uint8]
    exploited: npt.NDArray[np.bool_] | None
    where: str
    known: Actions
    space: Any = None
    notes: list[str] = dataclasses.field(default_factory=list)
    record_bytes: int = 0

    def __len__(self) -> int:
        """Return the number of interactions."""
        return len(self.actions)

    def describe(self) -> str:
        """Say how the log was understood.

        Returns
        -------
        str
        """
        known = self.known
        named = ", ".join(known.name(i) for i in range(min(known.count, 8)))
        more = ", ..." if known.count > 8 else ""
        lines = [
            f"{self.where}: {len(self)} interactions, {int((self.ends == 1).sum())} terminated, "
            f"{int((self.ends == 2).sum())} truncated",
            f"{known.count} actions: {named}{more}",
            f"rewards from {self.rewards.min():.6g} to {self.rewards.max():.6g}",
            *self.notes,
        ]
        return "\n".join(lines) + "\n"


def checked(log: Log) -> Log:
    """Return the log, or raise LogError if a reward is not finite."""
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
    return log


def counted(count: int, name: str) -> str:
    """Spell a number of things: ``2 rows are``."""
    return f"{count} {name} is" if count == 1 else f"{count} {name}s are"


def warn(log: Log, text: str) -> None:
    """Note what is lost, and warn of it."""
    log.notes.append(text)
    warnings.warn(f"{log.where}: {text}", LogWarning, stacklevel=4)


def warn_of_collapse(log: Log, name: str, values: npt.NDArray[Any]) -> None:
    """Warn if different numbers become one in binary32."""
    if values.dtype.kind not in "fiu" or values.dtype.itemsize <= 2 or values.dtype == np.float32:
        return
    for i, column in enumerate(values.reshape(len(values), -1).T):
        with np.errstate(over="ignore"):
            before, after = len(np.unique(column)), len(np.unique(column.astype(np.float32)))
        if after < before:
            label = name if values.ndim == 1 or values[0].size == 1 else f"{name}[{i}]"
            warn(
                log,
                f"{label}: {before} different numbers become {after} in binary32, which learning "
                "uses: subtract an offset from the column",
            )
