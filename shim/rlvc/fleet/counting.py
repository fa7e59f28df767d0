# SPDX-License-Identifier: MIT
"""The task of a worker: pieces of a log become counts."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from .. import _native
from ..counts.part import Part, Question
from ..counts.table import MEMORY, Columns, Table
from ..errors import LogError
from .sample import Sample, empty
from .sources import Piece, blocks

_EXPONENT_BITS = 23  # of a float32's fraction


@dataclasses.dataclass(frozen=True)
class Rounding:
    """How rewards are told apart: to so many bits of their fraction, or on a grid; else exactly.

    Attributes
    ----------
    bits : int or None
        [0, 22].
    grid : float or None
        Width of the grid.
    """

    bits: int | None = None
    grid: float | None = None

    def __bool__(self) -> bool:
        """Whether rewards are rounded at all."""
        return self.bits is not None or self.grid is not None

    def keys(self, rewards: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
        """Return the rounded rewards.

        Parameters
        ----------
        rewards : ndarray of float32
        """
        if self.grid is not None:
            width = np.float64(self.grid)
            return (np.round(rewards.astype(np.float64) / width) * width).astype(np.float32)
        if self.bits is None:
            return rewards
        lost = _EXPONENT_BITS - self.bits
        half, mask = np.uint32(1 << (lost - 1)), np.uint32(0xFFFFFFFF << lost & 0xFFFFFFFF)
        return ((rewards.view(np.uint32) + half) & mask).view(np.float32)


@dataclasses.dataclass
class Seen:
    """What was read.

    Attributes
    ----------
    rows, bytes : int
    lost : int
        Interactions of tables of which nobody knows what came next: as the last of an episode of
        LeRobot that is cut short.
    skipped : list of str
        What was left out, and why.
    sample : Sample or None
        Some of the percepts, if they were asked for.
    """

    rows: int = 0
    bytes: int = 0
    lost: int = 0
    skipped: list[str] = dataclasses.field(default_factory=list)
    sample: Sample | None = None

    def __add__(self, other: Seen) -> Seen:
        """Return the sum."""
        samples = [seen.sample for seen in (self, other) if seen.sample is not None]
        return Seen(
            self.rows + other.rows,
            self.bytes + other.bytes,
            self.lost + other.lost,
            self.skipped + other.skipped,
            samples[0] + samples[1] if len(samples) == 2 else next(iter(samples), None),
        )


@dataclasses.dataclass(frozen=True)
class Counting:
    """What a pass asks of each piece.

    Attributes
    ----------
    question : Question
    rounding : Rounding
    memory : int
        Bytes that a table may grow to.
    skip : bool
        Whether row groups that are broken are left out; else they are an error.
    keep : int
        How many percepts are kept as a sample.
    """

    question: Question
    rounding: Rounding = Rounding()
    memory: int = MEMORY
    skip: bool = False
    keep: int = 0

    def nothing(self) -> Table:
        """Return counts of nothing."""
        return Table(self.question, self.memory)

    def into(self, table: Table, piece: Piece, seen: Seen) -> None:
        """Count a piece into a table.

        Parameters
        ----------
        table : Table
        piece : Piece
        seen : Seen
            Is added to.

        Raises
        ------
        LogError
            The piece is broken; the message names the file, the row group and the fault.
        """
        seen.bytes += piece.bytes
        for where, block in blocks(piece, self.question.features):
            try:
                if isinstance(block, LogError):
                    raise block
                if self.skip:
                    self._check(block, where)
                if self.rounding:
                    block = dataclasses.replace(block, keys=self.rounding.keys(block.rewards))
                table.count(block, where)
                seen.rows += len(block)
                seen.lost += piece.rows - len(block) if piece.kind == "table" else 0
                if seen.sample is not None:
                    seen.sample = seen.sample.with_more(block.percepts)
            except LogError as error:
                if not self.skip:
                    raise
                seen.skipped.append(str(error))

    def _check(self, block: Columns, where: str) -> None:
        """Find faults before anything is counted."""
        wrong = block.actions >= self.question.actions
        wrong |= block.ends > _native.TRUNCATED
        wrong |= ~(np.abs(block.rewards) <= _native.REWARD_MAX)
        if wrong.any():
            raise LogError(
                f"{where}: interaction {int(np.argmax(wrong))}: action, end or reward is out of range"
            )

    def pieces(
        self, pieces: Sequence[Piece], note: Callable[[int], None] | None = None
    ) -> tuple[Part, Seen]:
        """Count pieces into a table of their own.

        Parameters
        ----------
        pieces : sequence of Piece
        note : callable or None
            Hears of the interactions of each piece that is done.
        """
        sample = empty(-(-self.question.features // 8), self.keep) if self.keep else None
        table, seen = self.nothing(), Seen(sample=sample)
        for piece in pieces:
            before = seen.rows
            self.into(table, piece, seen)
            if note:
                note(seen.rows - before)
        return table.part(), seen
