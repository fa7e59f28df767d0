# SPDX-License-Identifier: MIT
"""Actions that an environment forbids: an ``action_mask`` in its info or observation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..agent.agent import Agent

if TYPE_CHECKING:
    from .run import Run


def allowed(
    run: Run, percept: bytes, choice: Any, mask: npt.NDArray[np.bool_], draw: int
) -> tuple[int, bool]:
    """Replace a choice of a forbidden action while learning.

    Parameters
    ----------
    run : Run
    percept : bytes
    choice : Choice
    mask : ndarray of bool, [actions]
        At least one is True.
    draw : int
        Number of the interaction, by which an exploring action is drawn.

    Returns
    -------
    int, bool
        The action, and whether it is the best of those that are allowed.
    """
    if choice[1]:
        return best_allowed(run, percept, choice[0], mask), True
    options = np.flatnonzero(mask)
    return int(options[(draw * 2654435761 >> 7) % len(options)]), False


def best_allowed(run: Run, percept: Any, action: int, mask: npt.NDArray[np.bool_]) -> int:
    """Return the action of a run, or if it is forbidden the best one that is not.

    Parameters
    ----------
    run : Run
    percept : bytes or ndarray
    action : int
        The action without a mask.
    mask : ndarray of bool, [actions]

    Returns
    -------
    int
        By an agent's Q among what it has tried. A planner and a small policy have no values: the
        next action that is allowed.
    """
    if mask[action]:
        return action
    options = np.flatnonzero(mask)
    if isinstance(run.acting, Agent):
        class_id = run.agent.predict(percept).class_id
        q, samples = run.tables()
        tried = options[samples[class_id][options] > 0]
        if len(tried):
            return int(tried[np.argmax(q[class_id][tried])])
    return int(options[np.searchsorted(options, action) % len(options)])
