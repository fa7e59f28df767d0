# SPDX-License-Identifier: MIT
"""Actions: the numbers 0, 1, ... of a tree as elements of an action space of Gymnasium.

==================  =====================================================================
space               actions
==================  =====================================================================
Discrete            each number, from ``start`` on
MultiDiscrete       each combination, the last element fastest
MultiBinary         each combination, the last element fastest
Box                 a grid: ``bins`` numbers for each element, from low to high
==================  =====================================================================

There are at most 255.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ..checks import listed, shown, whole
from ..errors import ConfigError, LogError, SpaceError
from ..words import shortest

MOST = 255
HOLD_MAX = 10**6


class Actions:
    """The actions of a space.

    Parameters
    ----------
    count : int
        Number of actions, [1, 255].
    start : int
        The first action of a Discrete space.
    table : ndarray or None
        The actions of another space, [count, *shape].
    hold : int
        For how many steps of the environment each is taken.
    words : sequence of str
        Names of the actions; empty: none.
    """

    def __init__(
        self,
        count: int,
        start: int = 0,
        table: npt.NDArray[Any] | None = None,
        hold: int = 1,
        words: Sequence[str] = (),
    ) -> None:
        self.count, self.start, self.table, self.hold = count, start, table, hold
        self.words = [str(word) for word in listed("words", words, "names")]

    def of(self, index: int) -> Any:
        """Return an action: an int of a Discrete space, else an array."""
        if self.table is not None:
            return np.asarray(self.table[index]).copy()
        return self.words[index] if self.words else index + self.start

    def of_many(self, indices: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Return the actions of indices [n]: int64 [n], or [n, *shape]."""
        if self.table is not None:
            return np.asarray(self.table[indices])
        if self.words:
            return np.asarray(np.array(self.words)[indices])
        return np.asarray(np.add(indices, self.start, dtype=np.int64))

    def name(self, index: int) -> str:
        """Return an action as text, for trees and figures."""
        if self.table is None:
            return self.words[index] if self.words else f"action {index + self.start}"
        spelled = str if self.table.dtype.kind in "biu" else shortest
        numbers = ", ".join(spelled(value) for value in np.ravel(self.table[index]))
        return numbers if np.size(self.table[index]) == 1 else f"({numbers})"

    def plain(self) -> bool:
        """Whether the names are the numbers of the tree."""
        return self.table is None and self.start == 0 and not self.words

    def within(self, space: Any) -> bool:
        """Whether each of these is an action of a space.

        Parameters
        ----------
        space : gymnasium.Space

        Returns
        -------
        bool
            Words, which a log may have, are not looked for: True.
        """
        from gymnasium import spaces

        if self.words:
            return True
        if not isinstance(space, spaces.Box):
            return all(space.contains(self.of(index)) for index in range(self.count))
        table = self.table
        return (
            table is not None
            and table.shape[1:] == space.shape
            and bool(((table >= space.low) & (table <= space.high)).all())
        )

    def fit(self, space: Any) -> bool:
        """Whether these are all actions of a space, or of a Box some within its bounds.

        What it takes and returns is as for :meth:`within`.

        Raises
        ------
        SpaceError
            The space is of another kind, or there are more than 255 actions.
        """
        from gymnasium import spaces

        if self.words or isinstance(space, spaces.Box):
            return self.within(space)
        other = actions_of(space)
        if other.table is None or self.table is None:
            return other.table is self.table and (other.count, other.start) == (self.count, self.start)
        return np.array_equal(other.table, self.table)

    def to_dict(self) -> dict[str, Any]:
        """Return the actions, for JSON."""
        table = None if self.table is None else self.table.tolist()
        dtype = None if self.table is None else str(self.table.dtype)
        return {
            "count": self.count,
            "start": self.start,
            "table": table,
            "dtype": dtype,
            "hold": self.hold,
            "words": self.words,
        }

    @classmethod
    def from_dict(cls, fields: dict[str, Any]) -> Actions:
        """Make the actions of :meth:`to_dict`."""
        table = fields["table"]
        array = None if table is None else np.array(table, fields["dtype"])
        count = whole("count", fields["count"], 1, MOST)
        start = whole("start", fields["start"], -(2**62), 2**62)
        words = [str(word) for word in fields["words"]]
        if array is not None and (len(array) != count or array.dtype.kind not in "biuf"):
            raise ConfigError(f"table: {array.dtype}[{len(array)}], expected {count} actions")
        if len(words) not in (0, count):
            raise ConfigError(f"words: {len(words)}, expected {count}")
        return cls(count, start, array, whole("hold", fields["hold"], 1, HOLD_MAX), words)


def actions_of(space: Any, bins: int | Sequence[int] | None = None, hold: int = 1) -> Actions:
    """List the actions of a space.

    Parameters
    ----------
    space : gymnasium.Space
    bins : int, sequence of int or None
        Of a Box: numbers for each element, or for all.
    hold : int
        For how many steps of the environment each action is taken.

    Returns
    -------
    Actions

    Raises
    ------
    SpaceError
        The space is of another kind, has no bounds, or there are more than 255 actions.
    ConfigError
        ``bins`` or ``hold`` is out of range.
    """
    from gymnasium import spaces

    if isinstance(space, spaces.Space) and 0 in (space.shape or ()):
        raise SpaceError(f"{space} has no elements, so that there is nothing to choose")
    hold = whole("hold", hold, 1, HOLD_MAX)
    finite = isinstance(space, spaces.Discrete | spaces.MultiDiscrete | spaces.MultiBinary)
    if bins is not None and finite:
        raise ConfigError(f"bins: {space} is finite already: leave bins out")
    if isinstance(space, spaces.Discrete):
        return Actions(_count(space, int(space.n)), int(space.start), hold=hold)
    if isinstance(space, spaces.MultiDiscrete):
        counts, starts = np.ravel(space.nvec).tolist(), np.ravel(space.start).tolist()
        each = [range(s, s + n) for s, n in zip(starts, counts, strict=True)]
    elif isinstance(space, spaces.MultiBinary):
        each = [range(2)] * math.prod(space.shape)
    elif isinstance(space, spaces.Box):
        return Actions(*_grid(space, bins), hold=hold)
    else:
        raise SpaceError(
            f"an agent needs a finite set of actions, or a Box with bins, not {shown(space)}"
        )
    count = _count(space, math.prod(len(values) for values in each))
    table = np.array(list(itertools.product(*each)), space.dtype).reshape(-1, *space.shape)
    return Actions(count, 0, table, hold)


def _count(space: Any, count: int) -> int:
    if not 1 <= count <= MOST:
        raise SpaceError(f"{shown(space)} has {_number(count)} actions, allowed are [1, {MOST}]")
    return count


def _number(count: int) -> str:
    """A count for an error: of a picture's elements it would have thousands of digits."""
    return str(count) if count < 10**9 else "over 10**9"


def _grid(space: Any, bins: int | Sequence[int] | None) -> tuple[int, int, npt.NDArray[Any]]:
    """The count, start and table of a Box."""
    if bins is None:
        raise SpaceError(
            f"{space} has infinitely many actions: pass bins=, the number of actions for each "
            "element, such as bins=3, and hold=, for how many steps each is taken"
        )
    if not space.is_bounded():
        raise SpaceError(
            f"{space} has no bounds: wrap the environment so that its actions have some"
        )
    low, high = np.ravel(space.low), np.ravel(space.high)
    given = list(bins) if isinstance(bins, Sequence | np.ndarray) else [bins] * len(low)
    if len(given) != len(low):
        raise ConfigError(f"bins: {len(given)} numbers, expected {len(low)} for {space}")
    numbers = [whole("bins", n, 1, MOST) for n in given]
    count = math.prod(numbers)
    if count > MOST:
        raise SpaceError(f"bins: {_number(count)} actions, more than {MOST}: use fewer bins")
    each = [
        np.linspace(a, b, n) if n > 1 else [(a + b) / 2]
        for a, b, n in zip(low.astype(float), high.astype(float), numbers, strict=True)
    ]
    if space.dtype.kind in "iu":
        each = [np.rint(values) for values in each]
    table = np.array(list(itertools.product(*each)), space.dtype).reshape(-1, *space.shape)
    return count, 0, table


def indices_of(actions: Any, known: Actions, where: str) -> npt.NDArray[np.int64]:
    """Return the numbers of a log's actions.

    Parameters
    ----------
    actions : array, [n] or [n, *shape]
    known : Actions
    where : str
        The log, for errors.

    Returns
    -------
    ndarray of int64, [n]

    Raises
    ------
    LogError
        An action is not among those that are known.
    """
    actions = np.asarray(actions)
    if known.table is None:
        indices = actions.astype(np.int64).reshape(len(actions), -1)[:, 0] - known.start
        bad = np.flatnonzero((indices < 0) | (indices >= known.count))
    else:
        flat = known.table.reshape(known.count, -1).astype(np.float64)
        rows = actions.reshape(len(actions), -1).astype(np.float64)
        distances = np.abs(rows[:, None, :] - flat[None]).max(axis=2)
        indices = distances.argmin(axis=1)
        bad = np.flatnonzero(distances.min(axis=1) > 1e-6 * (1 + np.abs(flat).max()))
    if len(bad):
        raise LogError(
            f"{where}: actions: index {bad[0]}: {shown(actions[bad[0]])} is not an action of the space"
        )
    return np.asarray(indices, np.int64)
