# SPDX-License-Identifier: MIT
"""Actions that an environment forbids: an ``action_mask`` in its info or observation."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..agent.agent import Agent
from ..checks import shown
from ..errors import ConfigError, MaskWarning

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


def masks_of(mask: Any, count: int, actions: int) -> npt.NDArray[np.bool_] | None:
    """Return the masks of some environments; None if they are not an ``action_mask``.

    Parameters
    ----------
    mask : array of numbers or bool, [actions] or [count, actions]
    count : int
        Number of environments.
    actions : int
        Number of actions.

    Returns
    -------
    ndarray of bool, [count, actions], or None
        Where no action is allowed, none is forbidden.
    """
    try:
        masks = np.asarray(mask)
    except Exception:  # ragged, or of a class of the caller
        return None
    if masks.size != count * actions or masks.dtype.kind not in "biuf":
        return None
    masks = masks.reshape(count, actions).astype(np.bool_)
    some = np.logical_or.reduce(masks, axis=1)
    if False in some.tolist():
        masks[~some] = True
    return masks


def at_hand(run: Run, observation: Any, given: Any, count: int) -> npt.NDArray[np.bool_] | None:
    """Return the masks to act by: those that are given, else those in the observation.

    Parameters
    ----------
    run : Run
        If it learnt with masks, and there is none, it warns once.
    observation : element of the environment's space, or a batch of them
    given : array, [actions] or [count, actions], or None
    count : int
        Of the batch; 1: a single observation.

    Returns
    -------
    ndarray of bool, [count, actions], or None
    """
    actions = run.actions.count
    if given is not None:
        masks = masks_of(given, count, actions)
        if masks is None:
            raise ConfigError(
                f"action_masks: {shown(given)}: expected {actions} truth values"
                + (f" for each of {count} observations" if count > 1 else "")
            )
        return masks
    inside = observation.get("action_mask") if isinstance(observation, dict) else None
    masks = None if inside is None else masks_of(inside, count, actions)
    if masks is None:
        warn(run)
    return masks


def warn(run: Run) -> None:
    """Warn, once, of a run that learnt with masks and acts without one."""
    if run.masked and not run.told_of_masks:
        run.told_of_masks = True
        warnings.warn(
            "the run learnt with action masks and acts without one: it may choose a forbidden action; "
            "pass action_masks=",
            MaskWarning,
            stacklevel=5,
        )
