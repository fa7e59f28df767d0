# SPDX-License-Identifier: MIT
"""Learning by a planner: its policies act, and it learns after each episode."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from .. import _native
from ..agent.config import Config
from ..agent.planner_config import PlannerConfig
from ..domains.domain import Domain
from ..domains.thresholds import Thresholds
from ..errors import ConfigError
from .interact import Interaction
from .masks import best_allowed
from .run import Run

_CAPACITY_MIN, _CAPACITY_MAX = 2000, 1_000_000


def refusal(domain: Domain, actions: int) -> str:
    """Why a planner cannot learn this; empty if it can.

    Parameters
    ----------
    domain : Domain
    actions : int
        Number of actions.

    Returns
    -------
    str
    """
    if not isinstance(domain, Thresholds):
        return "a planner needs percepts of real numbers"
    if domain.components > _native.PLANNER_COMPONENTS_MAX:
        return f"a planner has at most {_native.PLANNER_COMPONENTS_MAX} components"
    if not 2 <= actions <= _native.PLANNER_ACTIONS_MAX:
        return f"a planner has 2 to {_native.PLANNER_ACTIONS_MAX} actions"
    return ""


def default_config(
    actions: int, interactions: int, seed: int, changes: dict[str, Any]
) -> PlannerConfig:
    """Return the default config of a planner in :func:`rlvc.learn`, with the caller's changes.

    Parameters
    ----------
    actions, interactions, seed : int
    changes : dict
        Fields set by the caller.

    Returns
    -------
    PlannerConfig
    """
    for name in changes:
        if not hasattr(PlannerConfig, name) and hasattr(Config, name):
            raise ConfigError(f"{name}: a planner has no such field, the method 'classes' has it")
    capacity = min(max(2 * interactions, _CAPACITY_MIN), _CAPACITY_MAX)
    fields: dict[str, Any] = {"capacity": capacity, "seed": seed}
    return PlannerConfig(actions).replace(**(fields | changes))


def episodes(run: Run, learner: Interaction) -> Iterator[None]:
    """Interact and learn; yield after each learning step.

    Parameters
    ----------
    run : Run
        Of a planner.
    learner : Interaction
    """
    planner, steps, stream = run.planner, 0, learner.stream
    planner.begin(run.percept(stream.current))
    while learner.done < learner.interactions:
        action = planner.act()
        if stream.masks is not None:
            action = best_allowed(run, b"", action, stream.masks[0])
        reached, reward, *ends = learner.step(action)
        percept = run.percept(reached)
        run.seen.add(percept.tobytes())
        planner.observe(action, reward, percept, *ends)
        if any(ends):
            stream.restart()
        steps += 1
        if any(ends) or steps == planner.config.horizon:
            steps = 0
            planner.learn()
            yield
        if any(ends):
            planner.begin(run.percept(stream.current))
