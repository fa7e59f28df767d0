# SPDX-License-Identifier: MIT
"""Types of the results of an agent."""

from __future__ import annotations

import dataclasses
from typing import Any, Literal, NamedTuple, get_args

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


Solution = Literal["converged", "cut short", "endless"]
SOLUTIONS: tuple[Solution, ...] = ("converged", "cut short", "endless")


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
        max |V_new - V_old| of the last sweep, in units of reward; 1e30 if `solution` is "endless".
    solution : {"converged", "cut short", "endless"}
        What the values are. cut short: the last solution took `max_sweeps` sweeps, and may have been
        changing still. endless: the discount is 1, and from some classes no end of the episode is known;
        their values are held at a bound, half of `max_sweeps` times the greatest mean reward.
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
    solution: Solution


Acting = Literal["random", "explore", "new", "again"]
Verdict = Literal["learnt", "no_episode", "no_difference", "no_model"]


@dataclasses.dataclass(frozen=True)
class PlannerStatistics:
    """Statistics of a planner.

    Attributes
    ----------
    interactions, episodes : int
        Number observed, and number that ended, since the planner was made.
    explored : int
        Number of interactions in episodes that explored.
    fits, searches : int
        How often the model was fitted, and how often it was searched.
    candidates : int
        Number of trees that the searches looked at.
    leaves : int
        Leaves of the learnt policy; 1 while there is none.
    tried : int
        Number of episodes in which the learnt policy acted.
    score : float
        What the learnt policy is expected to earn in an episode.
    beta : float
        How far the model is trusted, [0.05, 1].
    deviation : float
        Typical deviation of an episode's return from the policy's mean.
    acting : {"random", "explore", "new", "again"}
        What acts in this episode: random actions, a tree that the model expects to see what is new, a
        tree that was found in the model, or one of the best again.
    verdict : {"learnt", "no_episode", "no_difference", "no_model"}
        Whether anything was learnt, and if not, why: no episode ended, all episodes earned the same,
        or the model does not predict what policies earn.
    """

    interactions: int
    episodes: int
    explored: int
    fits: int
    searches: int
    candidates: int
    leaves: int
    tried: int
    score: float
    beta: float
    deviation: float
    acting: Acting
    verdict: Verdict

    @classmethod
    def of(cls, native: Any) -> PlannerStatistics:
        """Make it of the C struct."""
        fields = {field.name: getattr(native, field.name) for field in dataclasses.fields(cls)}
        names = {
            "acting": get_args(Acting)[native.acting],
            "verdict": get_args(Verdict)[native.verdict],
        }
        return cls(**(fields | names))


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
