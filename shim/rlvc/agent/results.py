# SPDX-License-Identifier: MIT
"""What an agent answers."""

from __future__ import annotations

import dataclasses
from typing import Any, NamedTuple

import numpy as np

CHOICE = np.dtype([("action", np.uint8), ("exploited", np.uint8)])
"""Of the arrays of choices: ``rlvc_choice``."""


class Choice(NamedTuple):
    """What was done, and why.

    Attributes
    ----------
    action : int
        [0, actions).
    exploited : bool
        Whether it is the greedy action of the agent's policy, chosen because it is.
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
    """How far a learning step is.

    Attributes
    ----------
    work : int
        Samples looked at by this call.
    rounds : int
        Rounds of refinement begun in this step so far.
    splits : int
        Splits made in this step so far.
    done : bool
        Whether the step is finished.
    """

    work: int
    rounds: int
    splits: int
    done: bool


@dataclasses.dataclass(frozen=True)
class Statistics:
    """Numbers about an agent.

    Attributes
    ----------
    interactions : int
        Observed since the agent was made.
    stored : int
        Of these, still in the ring.
    step : int
        k: learning steps finished.
    classes : int
        Leaves of the tree.
    depth : int
        Tests on its longest path.
    last_split : int
        The step k at which the newest split was made; 0 if none.
    refused : int
        Splits that proved real but found the tree full.
    sweeps : int
        Of the last solution.
    residual : float
        Of the last solution, in units of reward: max |V_new - V_old| of its last sweep.
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
    """One split of the tree: percepts with the feature got a new class.

    Attributes
    ----------
    index : int
        j: its place in the order of splits. The new class is j + 1.
    class_id : int
        The class that was split; it keeps the percepts without the feature.
    feature : scalar of the domain's feature_dtype
    name : str
        The feature's name.
    step : int
        k at that time.
    action : int or None
        Whose targets betrayed the aliasing; None if those of all actions did together.
    samples : int
        Of that class and action, or of the class.
    log_tests, score, log_p : float
        ln of the number of tests corrected for; the score; ln of the corrected p-value.
    """

    index: int
    class_id: int
    feature: Any
    name: str
    step: int
    action: int | None
    samples: int
    log_tests: float
    score: float
    log_p: float
