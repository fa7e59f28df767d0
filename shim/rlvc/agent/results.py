# SPDX-License-Identifier: MIT
"""Types of the results of an agent."""

from __future__ import annotations

import dataclasses
from typing import Any, NamedTuple

import numpy as np

CHOICE = np.dtype([("action", np.uint8), ("exploited", np.uint8)])
"""Dtype of arrays of choices."""


class Choice(NamedTuple):
    """An action, and whether it was exploitation.

    Attributes
    ----------
    action : int
        [0, actions).
    exploited : bool
        Whether it was chosen because it is greedy.
    """

    action: int
    exploited: bool


class Prediction(NamedTuple):
    """The class of a percept and its greedy action.

    Attributes
    ----------
    class_id : int, or ndarray of uint32 [n]
    action : int, or ndarray of uint32 [n]
    """

    class_id: Any
    action: Any


class Progress(NamedTuple):
    """The progress of a learning step.

    Attributes
    ----------
    work : int
        Work of this call, in samples.
    rounds : int
        Rounds of refinement started in this step.
    splits : int
        Splits made in this step.
    done : bool
        Whether the step is finished.
    """

    work: int
    rounds: int
    splits: int
    done: bool


@dataclasses.dataclass(frozen=True)
class Statistics:
    """Statistics of an agent.

    Attributes
    ----------
    interactions : int
        Number observed since the agent was made.
    stored : int
        Number in the replay buffer.
    step : int
        k: number of learning steps finished.
    classes : int
        Leaves of the tree.
    depth : int
        Number of tests on the longest path.
    last_split : int
        The step k of the newest split; 0: none.
    refused : int
        Number of significant splits not made because the tree was full.
    sweeps : int
        Number of sweeps of the last solution.
    residual : float
        max |V_new - V_old| of the last sweep, in units of reward.
    """

    interactions: int
    stored: int
    step: int
    classes: int
    depth: int
    last_split: int
    refused: int
    sweeps: int
    residual: float


@dataclasses.dataclass(frozen=True)
class Split:
    """One split of the tree: percepts with the feature became a new class.

    Attributes
    ----------
    index : int
        j: its index, oldest first. The new class is j + 1.
    class_id : int
        The class that was split; it keeps the percepts without the feature.
    feature : scalar of the domain's feature_dtype
    name : str
        The feature's name.
    step : int
        The learning step k of the split.
    action : int or None
        The action whose targets showed the aliasing; None: the targets of all actions together, or
        what followed them.
    samples : int
        Number of samples of that class and action, or of the class.
    successors : bool
        Whether what followed the actions showed the aliasing, and not their targets.
    log_tests, score, log_p : float
        ln of the number of tests that the p-value is corrected for; the score; ln of the corrected
        p-value.
    """

    index: int
    class_id: int
    feature: Any
    name: str
    step: int
    action: int | None
    samples: int
    successors: bool
    log_tests: float
    score: float
    log_p: float
