# SPDX-License-Identifier: MIT
"""Interacting with an environment, and storing the interactions in the agent."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..agent.batch import Batch
from ..checks import shown
from ..domains.domain import Domain
from ..errors import EnvError, PerceptError
from .encode import Encoder
from .environment import Environment
from .masks import allowed
from .run import Run


class Interaction:
    """Counts interactions and returns, and says when a learning step is due."""

    def __init__(self, stream: Environment, interactions: int, every: int, before: int = 0) -> None:
        self.stream = stream
        self.before = before  # interactions of the run until now
        self.interactions = interactions
        self.every = every
        self.done = 0
        self.at = 0  # the current or last interaction
        self.episodes = 0  # ended so far
        self.sums = [0.0] * stream.count
        self.current: npt.NDArray[Any] | None = None  # percepts of a vector, if encoded already
        self.returns: list[float] = []  # of episodes that ended since the last learning step

    def step(self, action: int) -> tuple[Any, float, bool, bool]:
        """Step a single environment: see :meth:`Environment.step`."""
        self.at = self.done
        stepped = self.stream.step(action)
        self.done += 1
        self._count(0, stepped[1], stepped[2] or stepped[3])
        return stepped

    def step_all(self, actions: npt.NDArray[Any]) -> tuple[Any, ...]:
        """Step a vector; return s' of all, and rewards and ends of those that are not dead."""
        self.at = self.done
        live = np.flatnonzero(~self.stream.dead)[: self.interactions - self.done]
        reached, rewards, terminated, truncated = self.stream.step_all(actions)
        over = terminated | truncated
        for i, reward, ended in zip(
            live.tolist(), rewards[live].tolist(), over[live].tolist(), strict=True
        ):
            self._count(i, reward, ended)
        self.done += len(live)
        return live, reached, rewards[live], ends_of(terminated[live], truncated[live])

    def _count(self, i: int, reward: float, over: bool) -> None:
        self.sums[i] += reward
        if over:
            self.returns.append(self.sums[i])
            self.episodes += 1
            self.sums[i] = 0.0

    def due(self, before: int) -> bool:
        """Whether a learning step is due now, but was not after ``before`` interactions."""
        return self.done // self.every > before // self.every or self.done >= self.interactions


def encoding(encoder: Any, domain: Domain) -> Callable[[Any], bytes]:
    """Return the function that encodes an observation; of an encoder by the caller it is checked.

    Parameters
    ----------
    encoder : object
    domain : Domain

    Returns
    -------
    callable
    """
    encode: Callable[[Any], bytes] = encoder.encode
    if type(encoder) is Encoder:
        return encode

    def checked(observation: Any) -> bytes:
        record = encode(observation)
        if not isinstance(record, bytes) or len(record) != domain.percept_bytes:
            raise PerceptError(
                f"the encoder returned {shown(record)}, expected {domain.percept_bytes} bytes"
            )
        return record

    return checked


def packed(encoder: Any, observations: Any, domain: Domain) -> npt.NDArray[Any]:
    """Encode a batch, or a list of observations, for :meth:`rlvc.Agent.observe_many`.

    Parameters
    ----------
    encoder : object
    observations : batch or list
    domain : Domain

    Returns
    -------
    ndarray, [n, *percept_shape]
    """
    if type(encoder) is Encoder and not isinstance(observations, list):
        return encoder.encode_many(observations)
    encode = encoding(encoder, domain)
    flat = np.frombuffer(b"".join(map(encode, observations)), domain.percept_dtype)
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


def _one(run: Run, learner: Interaction) -> Iterator[None]:
    """Interact with a single environment; yield whenever a learning step is due."""
    agent, stream = run.agent, learner.stream
    encode = encoding(run.encoder, agent.domain)
    act, observe, begin, step = agent.act, agent.observe, agent.begin, learner.step
    while learner.done < learner.interactions:
        choice: Any = act()
        if stream.masks is not None and not stream.masks[0][choice.action]:
            percept = encode(stream.current)
            choice = allowed(run, percept, choice, stream.masks[0], learner.done)
        reached, reward, terminated, truncated = step(choice[0])
        percept = encode(reached)
        run.seen.add(percept)
        observe(choice, reward, percept, terminated, truncated)
        if terminated or truncated:
            stream.restart()
            begin(encode(stream.current))
        if learner.due(learner.done - 1):
            yield


def _step_all(run: Run, learner: Interaction, batch: Batch) -> None:
    """Make an interaction with each environment of a vector."""
    stream, domain = learner.stream, run.agent.domain
    live = np.flatnonzero(~stream.dead)
    everyone = learner.current
    if everyone is None:
        everyone = _encoded_all(run, stream, stream.current)
    batch.percepts[: len(live)] = everyone[live]
    actions = np.zeros(stream.count, np.int64)
    choices = batch.act(len(live))
    if stream.masks is not None:
        for j, i in enumerate(live.tolist()):
            if not stream.masks[i][choices["action"][j]]:
                percept = domain.pack(everyone[i])
                choice = (int(choices["action"][j]), bool(choices["exploited"][j]))
                choices[j] = allowed(run, percept, choice, stream.masks[i], learner.done + j)
    actions[live] = choices["action"]
    live, reached, rewards, ends = learner.step_all(actions)
    count = len(live)
    batch.rewards[:count] = rewards
    following = _encoded_all(run, stream, reached)
    learner.current = following if reached is stream.current else None
    batch.next_percepts[:count] = following[live]
    batch.ends[:count] = ends
    if count:
        run.seen.add(domain.pack(batch.next_percepts[0]))
    batch.observe(count)


def _encoded_all(run: Run, stream: Environment, batch: Any) -> npt.NDArray[Any]:
    """The percepts of a vector's batch, or of a list of observations."""
    quick = type(run.encoder) is Encoder and not isinstance(batch, list)
    if quick and not isinstance(batch, tuple):
        with contextlib.suppress(PerceptError):  # one by one it becomes clear which is wrong
            percepts = packed(run.encoder, batch, run.agent.domain)
            if len(percepts) == stream.count:
                return percepts
    listed = batch if isinstance(batch, list) else stream.split(batch)
    if len(listed) != stream.count:
        raise EnvError(f"observations: {len(listed)}, expected {stream.count}")
    return packed(run.encoder, listed, run.agent.domain)


def collect(run: Run, learner: Interaction) -> Iterator[None]:
    """Interact; yield whenever a learning step is due."""
    if not learner.stream.vector:
        run.agent.begin(encoding(run.encoder, run.agent.domain)(learner.stream.current))
        yield from _one(run, learner)
        return
    batch = run.agent.batch(learner.stream.count)
    while learner.done < learner.interactions:
        before = learner.done
        _step_all(run, learner, batch)
        if learner.due(before):
            yield
