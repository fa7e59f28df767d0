# SPDX-License-Identifier: MIT
"""Times the package's calls, and empty calls of the library for comparison."""

from __future__ import annotations

import ctypes
import time
from collections.abc import Callable

import numpy as np

from . import _native
from .agent.agent import Agent
from .agent.results import CHOICE

PERCEPTS = 1_000_000
_STEPS = 50_000


def best(function: Callable[[], object], rounds: int = 7) -> float:
    """Time a function.

    Parameters
    ----------
    function : callable
    rounds : int

    Returns
    -------
    float
        The shortest time of all rounds, in seconds.
    """
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return min(times)


def grown_agent() -> Agent:
    """Make an agent of 18 bits, 4 actions and 64 classes."""
    random = np.random.default_rng(1)
    agent = Agent(18, 4, capacity=40_000)
    percepts = random.integers(256, size=(20_000, 3), dtype=np.uint8)
    choices = np.zeros(20_000, CHOICE)
    choices["action"] = random.integers(4, size=20_000)
    rewards = (percepts[:, 0] % 64).astype(np.float32)
    agent.observe_many(percepts, choices, rewards, percepts, np.ones(20_000, np.uint8))
    agent.learn()
    return agent


def many_percepts() -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    """Make a million percepts for :func:`grown_agent`."""
    return np.random.default_rng(2).integers(256, size=(PERCEPTS, 3), dtype=np.uint8)


def step_times(agent: Agent) -> tuple[float, float]:
    """Time act plus observe, and two empty calls with the same arguments.

    Parameters
    ----------
    agent : Agent

    Returns
    -------
    tuple of float
        Both times, in seconds.
    """
    percept = np.array([1, 2, 3], np.uint8)
    agent.begin(percept)
    act, observe = agent.act, agent.observe
    empty_act, empty_observe = (
        _native.call.rlvc_shim_empty_act,
        _native.call.rlvc_shim_empty_observe,
    )
    handle, choice, record = agent._handle, agent._choice, percept.tobytes()
    reference = ctypes.byref(choice)

    def steps() -> None:
        for _ in range(_STEPS):
            observe(act(), 1.0, percept)

    def empty() -> None:
        for _ in range(_STEPS):
            empty_act(handle, reference)
            empty_observe(handle, choice, 1.0, record, 0)

    return best(steps) / _STEPS, best(empty) / _STEPS


def batch_time(agent: Agent, environments: int) -> float:
    """Time a step of a :class:`~rlvc.Batch`, with writing its arrays.

    Parameters
    ----------
    agent : Agent
    environments : int
        Size of the vector.

    Returns
    -------
    float
        Time of a step for each environment, in seconds.
    """
    random = np.random.default_rng(3)
    percepts = random.integers(256, size=(environments, 3), dtype=np.uint8)
    rewards, ends = np.ones(environments, np.float32), np.zeros(environments, np.uint8)
    batch = agent.batch(environments)
    rounds = max(10, _STEPS // environments)

    def steps() -> None:
        for _ in range(rounds):
            batch.percepts[...] = percepts
            batch.act()
            batch.next_percepts[...] = percepts
            batch.rewards[...] = rewards
            batch.ends[...] = ends
            batch.observe()

    return best(steps) / (rounds * environments)


def main() -> None:
    """Print a table."""
    agent = grown_agent()
    percepts = many_percepts()
    print(f"{agent}, depth {agent.statistics.depth}")
    step, empty = step_times(agent)
    rows = [
        ("predict, each of a million percepts", best(lambda: agent.predict(percepts)) / PERCEPTS),
        ("act and observe", step),
        ("two empty calls", empty),
        *(
            (f"act and observe, in a vector of {n}", batch_time(agent, n))
            for n in (16, 64, 256, 1024)
        ),
    ]
    for name, seconds in rows:
        print(f"{seconds * 1e9:8.0f} ns  {name}")
