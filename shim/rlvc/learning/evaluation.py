# SPDX-License-Identifier: MIT
"""Playing episodes with a learnt policy: :class:`Evaluation`."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..checks import whole
from ..errors import ConfigError, Error
from .environment import Environment
from .masks import best_allowed, warn

if TYPE_CHECKING:
    from .run import Run


@dataclasses.dataclass(frozen=True)
class Evaluation:
    """The episodes that a policy played.

    Attributes
    ----------
    returns : ndarray of float64, [episodes]
        The undiscounted return of each.
    lengths : ndarray of int64, [episodes]
        Its number of decisions.
    cut : int
        How many were cut off after ``max_steps`` decisions: they may never have ended.
    """

    returns: npt.NDArray[np.float64]
    lengths: npt.NDArray[np.int64]
    cut: int = 0

    @property
    def mean(self) -> float:
        """The mean return."""
        return float(self.returns.mean())

    @property
    def std(self) -> float:
        """The standard deviation of the returns."""
        return float(self.returns.std())

    def __float__(self) -> float:
        """Return the mean."""
        return self.mean

    def __str__(self) -> str:
        """Describe it in one line."""
        count = len(self.returns)
        cut = f", {self.cut} cut off after {self.lengths.max()} decisions" if self.cut else ""
        return f"{self.mean:.4g} +- {self.std:.4g} ({count} episode{'s' * (count != 1)}{cut})"


@dataclasses.dataclass
class _Place:
    """Where playing is, from 0 on, for errors; of a vector, how many episodes ended."""

    episode: int = 0
    step: int = 0


def evaluate(run: Run, env: Any, episodes: int, seed: int, max_steps: int) -> Evaluation:
    """Play episodes: see :meth:`rlvc.Run.evaluate`."""
    episodes = whole("episodes", episodes, 1, 2**53)
    max_steps = whole("max_steps", max_steps, 1, 2**53)
    seed = whole("seed", seed, 0, 2**63 - 1)
    stream = Environment(env)
    if run.encoder is None:
        raise ConfigError("evaluate: a run on percepts has no encoder for observations")
    stream.need_fit(run, learns=False)
    stream.start(run.actions, seed)
    play = _play_all if stream.vector else _play
    place = _Place()
    try:
        evaluation = play(run, stream, episodes, max_steps, place)
    except Error as error:
        error.args = (f"episode {place.episode}, step {place.step}: {error}",)
        raise
    if not stream.masked:
        warn(run)
    return evaluation


def _play(
    run: Run, stream: Environment, episodes: int, max_steps: int, place: _Place
) -> Evaluation:
    returns, lengths, cut = [], [], 0
    for place.episode in range(episodes):
        total, length, over = 0.0, 0, False
        while not over and length < max_steps:
            place.step = length
            percept = run.percept(stream.current)
            action = run.index(percept)
            if stream.masks is not None:
                action = best_allowed(run, percept, action, stream.masks[0])
            _, reward, terminated, truncated = stream.step(action)
            total, length, over = total + reward, length + 1, terminated or truncated
        cut += not over
        stream.restart()
        returns.append(total)
        lengths.append(length)
    return Evaluation(np.array(returns), np.array(lengths), cut)


def _play_all(
    run: Run, stream: Environment, episodes: int, max_steps: int, place: _Place
) -> Evaluation:
    """Play with a vector: each environment its share, so that short episodes do not count more.

    An environment whose episode is cut off plays no more, as it cannot be reset by itself.
    """
    count = stream.count
    share = [(episodes + i) // count for i in range(count)][::-1]
    sums, steps = np.zeros(count), np.zeros(count, np.int64)
    returns: list[list[float]] = [[] for _ in range(count)]
    lengths: list[list[int]] = [[] for _ in range(count)]
    cut = 0
    while any(len(done) < wanted for done, wanted in zip(returns, share, strict=True)):
        percepts = run.percepts(stream.current)
        chosen = np.array(run.indices(percepts), np.int64)
        if stream.masks is not None:
            for i, mask in enumerate(stream.masks):
                chosen[i] = best_allowed(run, percepts[i], int(chosen[i]), mask)
        dead = stream.dead
        place.episode = sum(len(done) for done in returns)
        _, rewards, terminated, truncated = stream.step_all(chosen)
        sums[~dead] += rewards[~dead]
        steps[~dead] += 1
        over = terminated | truncated
        for i in np.flatnonzero((over | (steps >= max_steps)) & ~dead).tolist():
            if len(returns[i]) < share[i]:
                returns[i].append(float(sums[i]))
                lengths[i].append(int(steps[i]))
                if not over[i]:
                    cut += 1
                    share[i] = len(returns[i])
            sums[i], steps[i] = 0.0, 0
        place.step += 1
    return Evaluation(
        np.array([value for done in returns for value in done]),
        np.array([value for done in lengths for value in done]),
        cut,
    )
