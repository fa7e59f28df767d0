# SPDX-License-Identifier: MIT
"""The interaction with an environment."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..agent.batch import Batch
from ..agent.results import CHOICE
from ..domains.domain import Domain

if TYPE_CHECKING:
    pass

from .environment import Environment
from .run import Run


class Interaction:
    """The loop of section 4.2.1 around an environment."""

    def __init__(self, stream: Environment, interactions: int, every: int) -> None:
        self.stream = stream
        self.interactions = interactions
        self.every = every
        self.done = 0
        self.sums = np.zeros(stream.count)
        self.returns: list[float] = []  # of the episodes ended since the last learning step

    def transition(self, actions: Any) -> tuple[Any, ...]:
        """Act, and leave out what is dead or too much."""
        stream = self.stream
        before = stream.split(stream.current)
        live = np.flatnonzero(~stream.dead)[: self.interactions - self.done]
        reached, rewards, terminated, truncated = stream.step(np.asarray(actions))
        self.sums[live] += rewards[live]
        for i in live[(terminated | truncated)[live]]:
            self.returns.append(float(self.sums[i]))
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
        """Whether a learning step is due, if there were ``before`` interactions before the last."""
        return self.done // self.every > before // self.every or self.done >= self.interactions


def packed(encoder: Any, observations: Any, domain: Domain) -> npt.NDArray[Any]:
    """Encode observations as an array of percepts, as :meth:`rlvc.Agent.observe_many` takes it.

    Parameters
    ----------
    encoder : object
    observations : iterable
    domain : Domain

    Returns
    -------
    ndarray, [n, *percept_shape]
    """
    joined = b"".join(encoder.encode(observation) for observation in observations)
    return np.frombuffer(joined, domain.percept_dtype).reshape(-1, *domain.percept_shape)


def ends_of(terminated: Any, truncated: Any) -> npt.NDArray[np.uint8]:
    """Give how interactions ended, as :meth:`rlvc.Agent.observe_many` takes it.

    Parameters
    ----------
    terminated, truncated : array of bool, [n]

    Returns
    -------
    ndarray of uint8, [n]
    """
    return np.where(terminated, _native.TERMINATED, np.where(truncated, _native.TRUNCATED, 0)).astype(
        np.uint8
    )


def _store(run: Run, percepts: Any, transition: tuple[Any, ...], choices: npt.NDArray[Any]) -> None:
    _, _, rewards, reached, terminated, truncated = transition
    run.agent.observe_many(
        percepts,
        choices,
        np.asarray(rewards, np.float32),
        packed(run.encoder, reached, run.agent.domain),
        ends_of(terminated, truncated),
        resume=True,
    )


def _fill(run: Run, batch: Batch, transition: tuple[Any, ...]) -> int:
    """Write what came of a vector's step into its arrays; how many interactions that is."""
    _, _, rewards, reached, terminated, truncated = transition
    count = len(reached)
    batch.rewards[:count] = rewards
    batch.next_percepts[:count] = packed(run.encoder, reached, run.agent.domain)
    batch.ends[:count] = ends_of(terminated, truncated)
    return count


def collect(run: Run, learner: Interaction) -> Iterator[None]:
    """Interact; yields whenever a learning step is due."""
    stream, agent = learner.stream, run.agent
    batch = agent.batch(stream.count)
    while learner.done < learner.interactions:
        before = learner.done
        live = np.flatnonzero(~stream.dead)
        everyone = stream.split(stream.current)
        percepts = packed(run.encoder, [everyone[i] for i in live], agent.domain)
        if stream.vector:
            batch.percepts[: len(live)] = percepts
            choices = batch.act(len(live))
        else:
            choices = np.array([agent.act()], CHOICE)
        actions = np.zeros(stream.count, np.int64)
        actions[live] = choices["action"]
        transition = learner.transition(actions)
        if stream.vector:
            batch.observe(_fill(run, batch, transition))
        else:
            _store(run, percepts, transition, choices)
            if transition[4][0] or transition[5][0]:
                agent.begin(run.encoder.encode(stream.current))  # type: ignore[union-attr]
        if learner.due(before):
            yield
