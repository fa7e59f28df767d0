# SPDX-License-Identifier: MIT
"""Interacting with an environment, and storing the interactions in the agent."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..agent.batch import Batch
from ..domains.domain import Domain
from ..errors import PerceptError
from .environment import Environment
from .run import Run


class Interaction:
    """Counts interactions and returns, and says when a learning step is due."""

    def __init__(self, stream: Environment, interactions: int, every: int) -> None:
        self.stream = stream
        self.interactions = interactions
        self.every = every
        self.done = 0
        self.at = 0  # the current or last interaction
        self.episodes = 0  # ended so far
        self.sums = np.zeros(stream.count)
        self.returns: list[float] = []  # of episodes that ended since the last learning step

    def transition(self, actions: Any) -> tuple[Any, ...]:
        """Step; leave out dead environments and those beyond the number of interactions."""
        stream, self.at = self.stream, self.done
        before = stream.split(stream.current)
        live = np.flatnonzero(~stream.dead)[: self.interactions - self.done]
        reached, rewards, terminated, truncated = stream.step(np.asarray(actions))
        self.sums[live] += rewards[live]
        for i in live[(terminated | truncated)[live]]:
            self.returns.append(float(self.sums[i]))
            self.episodes += 1
            self.sums[i] = 0.0
        self.done += len(live)
        return (
            [before[i] for i in live],
            np.asarray(actions)[live],
            rewards[live],
            [reached[i] for i in live],
            terminated[live],
            truncated[live],
        )

    def due(self, before: int) -> bool:
        """Whether a learning step is due now, but was not after ``before`` interactions."""
        return self.done // self.every > before // self.every or self.done >= self.interactions


def packed(encoder: Any, observations: Any, domain: Domain) -> npt.NDArray[Any]:
    """Encode observations as an array of percepts, for :meth:`rlvc.Agent.observe_many`.

    Parameters
    ----------
    encoder : object
    observations : iterable
    domain : Domain

    Returns
    -------
    ndarray, [n, *percept_shape]
    """
    records = [encoder.encode(observation) for observation in observations]
    for record in records:
        if not isinstance(record, bytes) or len(record) != domain.percept_bytes:
            raise PerceptError(
                f"the encoder returned {record!r:.80}, expected {domain.percept_bytes} bytes"
            )
    flat = np.frombuffer(b"".join(records), domain.percept_dtype)
    return flat.reshape(-1, *domain.percept_shape)


def ends_of(terminated: Any, truncated: Any) -> npt.NDArray[np.uint8]:
    """Return how interactions ended, for :meth:`rlvc.Agent.observe_many`.

    Parameters
    ----------
    terminated, truncated : array of bool, [n]

    Returns
    -------
    ndarray of uint8, [n]
    """
    return np.where(
        terminated, _native.TERMINATED, np.where(truncated, _native.TRUNCATED, 0)
    ).astype(np.uint8)


def _step(run: Run, learner: Interaction) -> None:
    """Make an interaction with a single environment."""
    choice = run.agent.act()
    _, _, rewards, reached, terminated, truncated = learner.transition(np.array([choice.action]))
    percept = packed(run.encoder, reached, run.agent.domain)[0]
    run.agent.observe(choice, rewards[0], percept, bool(terminated[0]), bool(truncated[0]))
    if terminated[0] or truncated[0]:
        run.agent.begin(packed(run.encoder, [learner.stream.current], run.agent.domain)[0])


def _step_all(run: Run, learner: Interaction, batch: Batch) -> None:
    """Make an interaction with each environment of a vector."""
    stream = learner.stream
    live = np.flatnonzero(~stream.dead)
    everyone = stream.split(stream.current)
    batch.percepts[: len(live)] = packed(run.encoder, [everyone[i] for i in live], run.agent.domain)
    actions = np.zeros(stream.count, np.int64)
    actions[live] = batch.act(len(live))["action"]
    _, _, rewards, reached, terminated, truncated = learner.transition(actions)
    count = len(reached)
    batch.rewards[:count] = rewards
    batch.next_percepts[:count] = packed(run.encoder, reached, run.agent.domain)
    batch.ends[:count] = ends_of(terminated, truncated)
    batch.observe(count)


def collect(run: Run, learner: Interaction) -> Iterator[None]:
    """Interact; yield whenever a learning step is due."""
    batch = run.agent.batch(learner.stream.count) if learner.stream.vector else None
    while learner.done < learner.interactions:
        before = learner.done
        if batch is None:
            _step(run, learner)
        else:
            _step_all(run, learner, batch)
        if learner.due(before):
            yield
