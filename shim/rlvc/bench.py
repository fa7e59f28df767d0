# SPDX-License-Identifier: MIT
"""Times the package's calls, and empty calls of the library for comparison."""

from __future__ import annotations

import copy
import ctypes
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from . import _native
from .agent.agent import Agent
from .agent.planner import Planner
from .agent.results import CHOICE
from .learning.interact import ends_of
from .learning.learn import learn

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
        start = time.process_time()
        function()
        times.append(time.process_time() - start)
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


class _Recorder:
    """Stands for an environment, and keeps what it is asked and what it answers."""

    def __init__(self, env: Any) -> None:
        self._env = env
        self.seen: list[Any] = []

    def __getattr__(self, name: str) -> Any:
        return getattr(self._env, name)

    def reset(self, **arguments: Any) -> Any:
        """Reset the environment."""
        returned = self._env.reset(**arguments)
        self.current = copy.deepcopy(returned[0])  # it may be written over
        return returned

    def step(self, action: Any) -> Any:
        """Act, and keep the interaction."""
        returned = self._env.step(action)
        before, self.current = self.current, copy.deepcopy(returned[0])
        self.seen.append((before, action, returned[1], self.current, *returned[2:4]))
        return returned


def _alone(env: Any, seen: list[Any], seed: int) -> float:
    """The seconds that the environment takes by itself for the same interactions."""
    env.reset(seed=seed)
    start = time.process_time()
    for _, action, _, _, _, _ in seen:
        _, _, terminated, truncated, _ = env.step(action)
        if terminated or truncated:
            env.reset()
    return time.process_time() - start


def _core(run: Any, seen: list[Any], every: int) -> float:
    """The seconds that the core takes by itself for the same interactions and learning steps."""
    before, actions, rewards, after, terminated, truncated = zip(*seen, strict=True)
    sides = [run.percepts(np.array(side)) for side in (before, after)]
    numbers, ends = np.array(rewards, np.float32), ends_of(terminated, truncated)
    if isinstance(run.learner, Planner):
        planner = Planner(len(sides[0][0]), run.planner.config)
        return _planner_alone(planner, sides, actions, numbers, ends)
    choices = np.zeros(len(seen), CHOICE)
    choices["action"] = actions
    agent = Agent(run.agent.domain, run.agent.config)
    start = time.process_time()
    for at in range(0, len(seen), every):
        some = slice(at, at + every)
        agent.observe_many(sides[0][some], choices[some], numbers[some], sides[1][some], ends[some])
        agent.learn()
    return time.process_time() - start


def _planner_alone(planner: Planner, sides: Any, actions: Any, rewards: Any, ends: Any) -> float:
    """The seconds that a planner takes for the same interactions: it acts as in learning."""
    steps = 0
    start = time.process_time()
    planner.begin(sides[0][0])
    for i, action in enumerate(actions):
        planner.act()
        planner.observe(action, rewards[i], sides[1][i], ends[i] == 1, ends[i] == 2)
        steps += 1
        if ends[i] or steps == planner.config.horizon:
            steps = 0
            planner.learn()
        if ends[i] and i + 1 < len(actions):
            planner.begin(sides[0][i + 1])
    return time.process_time() - start


def learning_times(env: Any, interactions: int, seed: int = 1) -> tuple[float, float, float]:
    """Time :func:`rlvc.learn`, and what it cannot do without.

    Parameters
    ----------
    env : gymnasium.Env
        Of Discrete actions.
    interactions, seed : int

    Returns
    -------
    tuple of float
        Seconds of learning, and of the environment and the core alone, with the same interactions.
    """
    start = time.process_time()
    learn(env, interactions, seed=seed)
    whole = time.process_time() - start
    recorder: Any = _Recorder(env)
    run = learn(recorder, interactions, seed=seed)
    seen = recorder.seen
    return whole, _alone(env, seen, seed), _core(run, seen, max(100, interactions // 100))


def _tasks() -> None:
    try:
        import gymnasium
    except ImportError:
        print("learning in environments is not timed: it needs Gymnasium, pip install 'rlvc[gym]'")
        return
    for task, count in (("Taxi-v4", 30_000), ("FrozenLake-v1", 30_000), ("CartPole-v1", 3000)):
        whole, alone, core = learning_times(gymnasium.make(task), count)
        print(
            f"{task}, {count} interactions: learn {whole:.2f} s, environment alone {alone:.2f} s, core "
            f"alone {core:.2f} s: {whole / (alone + core):.2f} times both"
        )
    one = _beside(gymnasium.make("FrozenLake-v1"), 1)
    many = _beside(gymnasium.make_vec("FrozenLake-v1", num_envs=16, vectorization_mode="sync"), 16)
    print(
        f"an interaction beside FrozenLake's own step: {one * 1e6:.1f} us; in a vector of 16: "
        f"{many * 1e6:.1f} us"
    )


def _steps_alone(env: Any, environments: int, actions: Any) -> None:
    """Step an environment, or a vector, as often as that many interactions need."""
    env.reset(seed=1)
    if environments == 1:
        for action in actions:
            _, _, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                env.reset()
        return
    done, dead = 0, np.zeros(environments, np.bool_)  # a step that only resets is no interaction
    while done < len(actions):
        _, _, terminated, truncated, _ = env.step(actions[done])
        done += environments - int(dead.sum())
        dead = terminated | truncated


def _beside(env: Any, environments: int, count: int = 20_000) -> float:
    """Seconds that an interaction takes beside the environment's own step, without learning steps."""
    random = np.random.default_rng(1)
    actions = random.integers(4, size=(count, environments) if environments > 1 else count)
    alone = best(lambda: _steps_alone(env, environments, actions), 5)
    return (best(lambda: learn(env, count, seed=1, every=count, classes=1), 5) - alone) / count


def main() -> None:
    """Print a table, and the ratio of learning to what it cannot do without."""
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
    _tasks()
