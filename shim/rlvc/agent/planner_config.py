# SPDX-License-Identifier: MIT
"""The config of a planner."""

from __future__ import annotations

import dataclasses

from .. import _native
from ..checks import whole
from .fields import Fields


@dataclasses.dataclass(frozen=True)
class PlannerConfig(Fields):
    """How a planner learns. It is fixed when the planner is made.

    Parameters
    ----------
    actions : int
        Number of actions, [2, 64].
    capacity : int
        Number of percepts that are stored, [64, 10**8]; an episode of n interactions has n + 1. When
        it is full, the oldest are dropped.
    sample : int
        Maximum number of interactions that a model is fitted to, [32, capacity].
    model_leaves : int
        Maximum number of leaves of each tree of the model, [1, 256].
    leaves : int
        Maximum number of leaves of the policy, [2, 16].
    horizon : int
        Number of interactions after which an episode counts as one, although it goes on, [1, 10**8].
    random : int
        Number of random interactions before the first model, [32, capacity / 2]; the last of their
        episodes is random to its end.
    candidates : int
        Number of trees that a search looks at, [1, 10**6]; less if they take more than 2,500 steps
        of the model each.
    patience : int
        Number of trees without gain after which a search ends, [1, 10**6].
    seed : int
        Seed of all random numbers, [0, 2**32 - 1].

    Notes
    -----
    The fields are checked when a planner is made. ``rlvc_config`` in
    ``core/include/rlvc/agent.h`` has more details.
    """

    _learner = "a planner"

    actions: int
    capacity: int = 2000
    sample: int = 2000
    model_leaves: int = 32
    leaves: int = 16
    horizon: int = 500
    random: int = 200
    candidates: int = 1000
    patience: int = 300
    seed: int = 1



def to_native(config: PlannerConfig, domain: _native.Domain) -> _native.Config:
    """Make the C struct and check it.

    Parameters
    ----------
    config : PlannerConfig
    domain : rlvc_domain
        Of thresholds.

    Returns
    -------
    rlvc_config

    Raises
    ------
    ConfigError
        A field is out of range. The message names it.
    """
    capacity = whole("capacity", config.capacity, 64, _native.PLANNER_CAPACITY_MAX)
    most = _native.PLANNER_CANDIDATES_MAX
    whole("components", domain.percept_words, 1, _native.PLANNER_COMPONENTS_MAX)
    return _native.Config(
        method=_native.METHOD_PLANNER,
        actions=whole("actions", config.actions, 2, _native.PLANNER_ACTIONS_MAX),
        capacity=capacity,
        sample=whole("sample", config.sample, 32, capacity),
        model_leaves=whole(
            "model_leaves", config.model_leaves, 1, _native.PLANNER_MODEL_LEAVES_MAX
        ),
        leaves=whole("leaves", config.leaves, 2, _native.PLANNER_LEAVES_MAX),
        horizon=whole("horizon", config.horizon, 1, _native.PLANNER_CAPACITY_MAX),
        random=whole("random", config.random, 32, capacity // 2),
        candidates=whole("candidates", config.candidates, 1, most),
        patience=whole("patience", config.patience, 1, most),
        seed=whole("seed", config.seed, 0, 2**32 - 1),
    )
