# SPDX-License-Identifier: MIT
"""Trials of small policies, for percepts of real numbers.

With continuous inputs the tree never refines fully: each new class makes the values a little more
accurate, and a nearly accurate model can still have a bad policy. So a small tree is made from the
agent's values (:func:`rlvc.learning.shrink`); it acts, and its returns decide whether it is kept
(:class:`Trials`). The best of many policies with few episodes each may only have been lucky, so at
the end the best one is tried again.
"""

from __future__ import annotations

import numpy as np

from .small_policy import SmallPolicy

_EPISODES = 5  # maximum number of episodes of a trial
_DOUBT = 0.3  # number of episodes of return 0 that are added to those of a policy in comparisons


class Trials:
    """The policy on trial, and the best policy so far.

    A trial ends after a few episodes, or as soon as the policy's mean return is below that of the
    best. The best policy has the highest mean return, minus a penalty that shrinks with its number
    of episodes.
    """

    def __init__(self) -> None:
        self._tried: list[tuple[SmallPolicy, list[float]]] = []
        self._now: tuple[SmallPolicy, list[float]] | None = None

    @property
    def policy(self) -> SmallPolicy | None:
        """The policy on trial, or None."""
        return self._now[0] if self._now else None

    @property
    def best(self) -> SmallPolicy | None:
        """The best policy that had an episode, or None."""
        return self._best()[0] if self._tried else None

    def _best(self) -> tuple[SmallPolicy, list[float]]:
        """The best policy and its returns; the latest if several are equal."""
        return max(reversed(self._tried), key=lambda tried: _score(tried[1]))

    def start(self, policy: SmallPolicy) -> None:
        """Put a policy on trial."""
        self._now = (policy, [])

    def end_episode(self, gained: float) -> bool:
        """Record the return of an episode; return whether the trial is over."""
        assert self._now is not None
        returns = self._now[1]
        if not returns:
            self._tried.append(self._now)
        returns.append(gained)
        return len(returns) >= _EPISODES or np.mean(returns) < np.mean(self._best()[1])

    def resume(self) -> None:
        """Put the best policy on trial again; its earlier returns still count."""
        self._now = self._best()


def _score(returns: list[float]) -> float:
    """The mean return minus the penalty for few episodes."""
    mean = float(np.mean(returns))
    return mean - abs(mean) * _DOUBT / (len(returns) + _DOUBT)
