# SPDX-License-Identifier: MIT
"""Checks of the caller's numbers: accepts those of Python and numpy; errors name the argument."""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from .errors import ConfigError, Error


def whole(name: str, value: Any, least: int, most: int, error: type[Error] = ConfigError) -> int:
    """Check an integer.

    Parameters
    ----------
    name : str
        Its name in the error.
    value : int, or integer of numpy
    least, most : int
        Its range.
    error : type
        The exception to raise.

    Returns
    -------
    int
    """
    try:
        if isinstance(value, bool):
            raise TypeError
        number = int(value.__index__())
    except (AttributeError, TypeError):
        raise error(f"{name}: {value!r:.80} is not a whole number: give an int") from None
    if not least <= number <= most:
        raise error(f"{name}: {number:.80g} is not in [{least}, {most}]")
    return number


def real(name: str, value: Any, error: type[Error] = ConfigError) -> float:
    """Check a finite number: a float, an int, a bool, or an array of one of them.

    Parameters
    ----------
    name : str
        Its name in the error.
    value : number
    error : type
        The exception to raise.

    Returns
    -------
    float
    """
    try:
        if getattr(value, "size", 1) != 1 or isinstance(value, str | bytes):
            raise TypeError
        if np.ma.is_masked(value):  # it would be 0
            raise TypeError
        number = float(value.item()) if hasattr(value, "item") else float(value)
    except (AttributeError, OverflowError, TypeError, ValueError):
        raise error(f"{name}: {value!r:.80} is not a number: give a float") from None
    if not math.isfinite(number):
        raise error(f"{name}: {value!r:.80} is not a finite number")
    return number


def listed(name: str, value: Any, of: str, error: type[Error] = ConfigError) -> list[Any]:
    """Take the elements of a sequence, or of anything else that has some; not of a text.

    Parameters
    ----------
    name : str
        Its name in the error.
    value : iterable
    of : str
        What it should list, for the error.
    error : type
        The exception to raise.

    Returns
    -------
    list
    """
    if isinstance(value, str | bytes) or not isinstance(value, Iterable):
        raise error(f"{name}: {value!r:.80} is not a list of {of}")
    return list(value)


def flag(name: str, value: Any, error: type[Error] = ConfigError) -> bool:
    """Check a truth value: a bool, 0 or 1, or an array of one of them.

    Parameters
    ----------
    name : str
        Its name in the error.
    value : bool or number
    error : type
        The exception to raise.

    Returns
    -------
    bool
    """
    if getattr(value, "size", 1) == 1 and hasattr(value, "item") and not np.ma.is_masked(value):
        value = value.item()
    if isinstance(value, bool | int | float) and value in (0, 1):
        return bool(value)
    raise error(f"{name}: {value!r:.80} is not a truth value: give True or False")


def told(error: BaseException) -> str:
    """Return the kind and the text of an exception, whose text may itself raise one."""
    kind = type(error).__name__
    try:
        return f"{kind}: {error}"
    except Exception:
        return kind


_ELSEWHERE = {
    "gamma": "discount",
    "eps": "epsilon",
    "total_timesteps": "interactions",
    "n_steps": "interactions",
    "buffer_size": "capacity",
    "max_leaf_nodes": "classes",
    "random_state": "seed",
}


def known(changes: Iterable[str], fields: Iterable[str], kind: str) -> None:
    """Raise ConfigError if a field is not one of a config's.

    Parameters
    ----------
    changes : iterable of str
        Names by the caller.
    fields : iterable of str
        The names that there are.
    kind : str
        What has the fields, for the error.
    """
    there = list(fields)
    for name in changes:
        if name not in there:
            near = difflib.get_close_matches(name, there, 1)
            meant = _ELSEWHERE.get(name, near[0] if near else "")
            hint = f": do you mean {meant}?" if meant else f": it has {', '.join(there)}"
            raise ConfigError(f"{name}: {kind} has no such field{hint}")
