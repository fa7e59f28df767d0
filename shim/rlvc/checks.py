# SPDX-License-Identifier: MIT
"""Checks of the caller's numbers: accepts those of Python and numpy; errors name the argument."""

from __future__ import annotations

import contextlib
import difflib
import itertools
import math
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import ArrayError, ConfigError, Error, SnapshotError

_LISTED_MAX = 1_000_000


def shown(value: Any) -> str:
    """Return a value as an error shows it: one line of 80 characters, also where it cannot be spelt.

    Parameters
    ----------
    value : object

    Returns
    -------
    str
    """
    try:
        return re.sub(r"\s*\n\s*", " ", f"{value!r:.160}")[:80]  # arrays take several lines
    except Exception:  # of a class of the caller, a list within itself, an int of 5,000 digits
        return f"<{type(value).__name__}>"


def named(path: Any) -> str:
    """Return the name of a file as an error shows it, also of what is no name.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    str
    """
    return f"{path!s:.300}" if isinstance(path, str | Path) and str(path) else shown(path)


def one_of(name: str, value: Any, words: Iterable[str], error: type[Error] = ConfigError) -> str:
    """Check that a value is one of some words.

    Parameters
    ----------
    name : str
        Its name in the error.
    value : str
    words : iterable of str
    error : type
        The exception to raise.

    Returns
    -------
    str
    """
    known = list(words)
    if not isinstance(value, str) or value not in known:
        raise error(f"{name}: {shown(value)} is not one of {', '.join(known)}")
    return value


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
    except Exception:  # what a class of the caller raises says no more
        raise error(f"{name}: {shown(value)} is not a whole number: give an int") from None
    if not least <= number <= most:
        raise error(f"{name}: {shown(number)} is not in [{least}, {most}]")
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
    except Exception:
        raise error(f"{name}: {shown(value)} is not a number: give a float") from None
    if not math.isfinite(number):
        raise error(f"{name}: {shown(value)} is not a finite number")
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
        raise error(f"{name}: {shown(value)} is not a list of {of}")
    try:
        found = list(itertools.islice(value, _LISTED_MAX + 1))
    except Exception as cause:
        raise error(f"{name}: to list its {of} raised {told(cause)}") from cause
    if len(found) > _LISTED_MAX:
        raise error(f"{name}: {shown(value)} lists more than {_LISTED_MAX} {of}")
    return found


def array(name: str, value: Any, error: type[Error] = ArrayError) -> npt.NDArray[Any]:
    """Take a value as an array of whatever dtype and shape.

    Parameters
    ----------
    name : str
        Its name in the error.
    value : array_like
    error : type
        The exception to raise.

    Returns
    -------
    ndarray
    """
    try:
        return np.asarray(value)
    except Exception as cause:  # of lists of several lengths, of a class of the caller
        raise error(f"{name}: {shown(value)} is not an array: {told(cause)}") from cause


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
    found = value
    with contextlib.suppress(Exception):
        if getattr(value, "size", 1) == 1 and hasattr(value, "item") and not np.ma.is_masked(value):
            found = value.item()
    if isinstance(found, bool | int | float) and found in (0, 1):
        return bool(found)
    raise error(f"{name}: {shown(value)} is not a truth value: give True or False")


def pickled(state: Any, *names: str) -> list[Any]:
    """Take the members of a pickle's state.

    Parameters
    ----------
    state : dict
    names : str

    Returns
    -------
    list

    Raises
    ------
    SnapshotError
        It is no dict, or lacks one of them.
    """
    if not isinstance(state, dict) or not all(name in state for name in names):
        raise SnapshotError(f"not a pickle of this package: it lacks {', '.join(names)}")
    return [state[name] for name in names]


def told(error: BaseException) -> str:
    """Return the kind of an exception and 300 characters of its text, which may itself raise one."""
    kind = type(error).__name__
    try:
        return f"{kind}: {error!s:.300}"
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
