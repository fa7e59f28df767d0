# SPDX-License-Identifier: MIT
"""Small policies on real numbers, and trials that find a good one.

Of real numbers a tree never knows enough: each new class makes values a little truer, and the
policy of a class-level model that is nearly right may be a bad one. So a small tree is made of the
agent's values (:func:`shrink`), it is this tree that acts, and what it earns decides
(:class:`Trials`). Of many that are tried for a few episodes the best may be one that was lucky; so
it is tried again in the end.
"""

from __future__ import annotations

import numpy as np

from .small_policy import SmallPolicy

_EPISODES = 5  # of a trial, at most
_DOUBT = 0.3  # episodes that earn nothing, added to those of a policy when it is compared


class Trials:
    """Which policy acts, and which has done best.

    A policy is tried for a few episodes, and no longer than its mean return is at least that of the
    best so far. Then the next is made. The best is the one with the greatest mean return, of which
    a little is taken off for doubt, the less the more episodes it was tried for.
    """

    def __init__(self) -> None:
        self._tried: list[tuple[SmallPolicy, list[float]]] = []
        self._now: tuple[SmallPolicy, list[float]] | None = None

    @property
    def policy(self) -> SmallPolicy | None:
        """The one on trial."""
        return self._now[0] if self._now else None

    @property
    def best(self) -> SmallPolicy | None:
        """The one that has done best of those that had an episode."""
        return self._best()[0] if self._tried else None

    def _best(self) -> tuple[SmallPolicy, list[float]]:
        """With its returns; of equals the last."""
        return max(reversed(self._tried), key=lambda tried: _score(tried[1]))

    def start(self, policy: SmallPolicy) -> None:
        """Put a policy on trial."""
        self._now = (policy, [])

    def end_episode(self, gained: float) -> bool:
        """Note the return of an episode; whether the trial is over."""
        assert self._now is not None
        returns = self._now[1]
        if not returns:
            self._tried.append(self._now)
        returns.append(gained)
        return len(returns) >= _EPISODES or np.mean(returns) < np.mean(self._best()[1])

    def resume(self) -> None:
        """Put the best on trial again; what it earned before counts on."""
        self._now = self._best()


def _score(returns: list[float]) -> float:
    """The mean, less doubt."""
    mean = float(np.mean(returns))
    return mean - abs(mean) * _DOUBT / (len(returns) + _DOUBT)
