# SPDX-License-Identifier: MIT
"""A sample of a fleet's episodes, of real numbers: the same however the episodes are spread over files.

Each episode has a hash of its content. Those that terminated, those that were truncated, and those
in the middle of which a log stops are three strata. Of each, episodes with the lowest hashes are
kept, whole, until they have as many interactions as the sample. The first two get half of the sample
each; what one does not need the other gets. A planner takes the longest truncated episode for how
long episodes are, so that the third stratum is drawn from only if the others are empty, and no episode
is cut short but one that is longer than the sample.
"""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..errors import LogError
from .counting import Seen
from .logs import reals_of_log
from .sources import Piece, log_of

Rows = npt.NDArray[Any]
_Kept = tuple[bytes, Rows]  # an episode and its hash


def rows_of(before: Any, actions: Any, rewards: Any, after: Any, ends: Any) -> Rows:
    """Return interactions as records ``before``, ``action``, ``reward``, ``after``, ``end``.

    Parameters
    ----------
    before, after : ndarray of float32, [n, components]
    actions, rewards, ends : ndarray, [n]
    """
    real = (np.float32, (before.shape[1],))
    kinds = [
        ("before", *real),
        ("action", np.uint8),
        ("reward", np.float32),
        ("after", *real),
        ("end", np.uint8),
    ]
    made = np.zeros(len(actions), np.dtype(kinds))
    for name, values in zip(
        made.dtype.names or (), (before, actions, rewards, after, ends), strict=True
    ):
        made[name] = values
    return made


def episodes_of(rows: Rows) -> list[Rows]:
    """Cut a log into episodes: where it says so, and where the next row begins elsewhere.

    Parameters
    ----------
    rows : ndarray
        Of :func:`rows_of`. Where the next row begins elsewhere the episode is marked as truncated.
    """
    elsewhere = (rows["after"][:-1] != rows["before"][1:]).any(axis=1)
    going = rows["end"][:-1] == 0
    rows["end"][:-1][elsewhere & going] = _native.TRUNCATED
    return np.split(rows, np.flatnonzero(elsewhere | ~going) + 1)


def _shortened(rows: Rows, count: int) -> Rows:
    """The first interactions of an episode."""
    if len(rows) <= count:
        return rows
    made = rows[:count].copy()
    made["end"][-1] = _native.TRUNCATED
    return made


def _lowest(kept: list[_Kept], room: int) -> list[_Kept]:
    """The first episodes that have together at most so many interactions, at least one of them."""
    sizes = np.cumsum([len(rows) for _, rows in kept])
    fitting = kept[: int(np.searchsorted(sizes, room, side="right"))]
    return fitting or [(digest, _shortened(rows, room)) for digest, rows in kept[:1] if room]


def _size(kept: list[_Kept]) -> int:
    return sum(len(rows) for _, rows in kept)


class Episodes:
    """A sample that grows.

    Parameters
    ----------
    room : int
        Interactions.
    """

    def __init__(self, room: int) -> None:
        self._room = room
        self._kept: tuple[list[_Kept], ...] = ([], [], [])  # by hash: for each kind of end

    def see(self, rows: Rows) -> None:
        """Draw from some whole episodes as well.

        Parameters
        ----------
        rows : ndarray
            Of :func:`rows_of`.
        """
        more: tuple[list[_Kept], ...] = ([], [], [])
        for episode in episodes_of(rows):
            digest = hashlib.blake2b(episode.tobytes(), digest_size=16).digest()
            more[episode["end"][-1]].append((digest, _shortened(episode, self._room)))
        self._merge(more)

    def add(self, other: Episodes) -> None:
        """Draw from what another one has drawn from as well.

        Parameters
        ----------
        other : Episodes
        """
        self._merge(other._kept)

    def _merge(self, more: tuple[list[_Kept], ...]) -> None:
        for kept, new in zip(self._kept, more, strict=True):
            kept += new
            kept.sort(key=lambda episode: episode[0])
            sizes = np.cumsum([len(rows) for _, rows in kept])
            del kept[int(np.searchsorted(sizes, self._room)) + 1 :]
        # Views would keep whole files in memory.
        for kept in self._kept:
            kept[:] = [
                (digest, rows if rows.base is None else rows.copy()) for digest, rows in kept
            ]

    def part(self) -> Episodes:
        """Return what was drawn so far: this one."""
        return self

    def chosen(self) -> list[Rows]:
        """Return the episodes of the sample, in the order of their hashes."""
        unended, terminated, truncated = self._kept
        some = _lowest(terminated, self._room // 2)
        others = _lowest(truncated, self._room - _size(some))
        some = _lowest(terminated, self._room - _size(others))
        drawn = some + others or _lowest(unended, self._room)
        return [rows for _, rows in sorted(drawn, key=lambda episode: episode[0])]


def _lacks_last(before: Rows, after: Rows, ends: Rows) -> bool:
    """Whether what terminated interactions led to is just the next row, or, of the last, its own."""
    over = np.flatnonzero(ends == _native.TERMINATED)
    following = np.append(before[1:], before[-1:], axis=0)
    return len(over) > 0 and bool((after[over] == following[over]).all())


@dataclasses.dataclass(frozen=True)
class Drawing:
    """What a pass asks of each piece of a log of real numbers.

    Attributes
    ----------
    names : tuple of str
        Of the components.
    actions : int
    room : int
        Interactions of the sample.
    skip : bool
        Whether files that are broken are left out; else they are an error.
    """

    names: tuple[str, ...]
    actions: int
    room: int
    skip: bool = False

    def nothing(self) -> Episodes:
        """Return a sample of nothing."""
        return Episodes(self.room)

    def pieces(
        self, pieces: Sequence[Piece], note: Callable[[int], None] | None = None
    ) -> tuple[Episodes, Seen]:
        """Draw from pieces.

        Parameters
        ----------
        pieces : sequence of Piece
        note : callable or None
            Hears of the interactions of each piece that is done.
        """
        drawn, seen = self.nothing(), Seen()
        for piece in pieces:
            before = seen.rows
            try:
                self._into(drawn, piece, seen)
            except LogError as error:
                if not self.skip:
                    raise
                seen.skipped.append(str(error))
            if note:
                note(seen.rows - before)
        return drawn, seen

    def _into(self, drawn: Episodes, piece: Piece, seen: Seen) -> None:
        log = log_of(piece)
        before, after, encoder = reals_of_log(log)
        if tuple(encoder.names) != self.names:
            raise LogError(
                f"{log.where}: observations: {', '.join(encoder.names)}, not {', '.join(self.names)}"
            )
        wrong = np.flatnonzero((log.actions < 0) | (log.actions >= self.actions))
        if len(wrong):
            found = log.actions[wrong[0]]
            raise LogError(
                f"{log.where}: interaction {wrong[0]}: action: {found} is not in [0, {self.actions})"
            )
        if _lacks_last(before, after, log.ends):
            raise LogError(
                f"{log.where}: what was observed as episodes terminated is not in the log, of which a "
                "planner learns where they do: columns next_..., or a row without an action after each, "
                "would give it"
            )
        rows = rows_of(before, log.actions, log.rewards, after, log.ends)
        if piece.kind == "table" and rows["end"][-1] == 0:
            rows["end"][-1] = _native.TRUNCATED  # such a file holds whole episodes
        drawn.see(rows)
        seen.rows += len(log)
        seen.bytes += piece.bytes
        seen.lost += piece.rows - len(log) if piece.kind == "table" else 0
