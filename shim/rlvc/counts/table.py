# SPDX-License-Identifier: MIT
"""A table that interactions are counted into: the arrays of ``rlvc_shim_table``."""

from __future__ import annotations

import ctypes
import dataclasses
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..errors import CountError, LogError
from .part import PAIR, ROW, Part, Question, in_order

MEMORY = 1 << 30  # bytes that a table may grow to, if nothing else is said
_FIRST_ROWS, _FIRST_PAIRS = 1 << 10, 1 << 6
_ENDS = 2  # the highest value of `ends`


@dataclasses.dataclass(frozen=True)
class Columns:
    """Interactions, as arrays of n elements that C reads as they are.

    Attributes
    ----------
    percepts, next_percepts : ndarray of uint8, [n, ceil(features / 8)]
    actions, ends : ndarray of uint8, [n]
        Ends: 0 the episode goes on, 1 terminated, 2 truncated.
    rewards : ndarray of float32, [n]
    keys : ndarray of float32, [n]
        The rewards as rows tell them apart: rounded, or the same array.
    """

    percepts: npt.NDArray[np.uint8]
    next_percepts: npt.NDArray[np.uint8]
    actions: npt.NDArray[np.uint8]
    rewards: npt.NDArray[np.float32]
    ends: npt.NDArray[np.uint8]
    keys: npt.NDArray[np.float32]

    def __len__(self) -> int:
        """Return the number of interactions."""
        return len(self.actions)


def _gathering(tested: tuple[int, ...]) -> tuple[npt.NDArray[np.uint64], npt.NDArray[np.uint32]]:
    """Return what the values of each byte add to a cell, and which bytes these are."""
    at = np.unique([feature // 8 for feature in tested]).astype(np.uint32)
    tables = np.zeros((len(at), 256), np.uint64)
    value = np.arange(256, dtype=np.uint64)
    for place, feature in enumerate(tested):
        index = int(np.searchsorted(at, feature // 8))
        bit = value >> np.uint64(feature % 8) & np.uint64(1)
        tables[index] |= bit << np.uint64(place)
    return tables, at


def _spreading() -> npt.NDArray[np.uint64]:
    """Return a table of bytes whose bit i is byte i."""
    bits = np.unpackbits(np.arange(256, dtype=np.uint8)[:, None], axis=1, bitorder="little")
    return np.ascontiguousarray(bits).view(np.uint64)[:, 0]


class Table:
    """Counts of interactions, by an open-addressed table that grows up to a limit.

    Parameters
    ----------
    question : Question
        What is counted.
    memory : int
        Bytes that it may grow to.
    """

    def __init__(self, question: Question, memory: int = MEMORY) -> None:
        self.question = question
        self._memory = memory
        self._gather, self._gather_byte = _gathering(question.tested)
        self._spread = _spreading()
        self._open(_FIRST_ROWS, _FIRST_PAIRS)

    def _shapes(self, rows: int, pairs: int) -> dict[str, tuple[tuple[int, ...], Any]]:
        ask = self.question
        kinds = 3 if ask.follow else 1
        shapes: dict[str, tuple[tuple[int, ...], Any]] = {
            "row": ((rows,), ROW),
            "with": ((rows, ask.features), np.uint64),
            "lanes": ((rows, kinds, -(-ask.features // 8)), np.uint64),
            "pending": ((rows,), np.uint8),
            "row_index": ((2 * rows,), np.uint32),
        }
        if ask.follow:
            shapes["follow"] = ((rows, 2, ask.features), np.uint64)
        if ask.sums:
            shapes["reward"] = ((pairs, _native.EXACT_SUM_WORDS), np.uint64)
            shapes["row_pair"] = ((rows,), np.uint32)
            shapes["pair"] = ((pairs,), PAIR)
            shapes["pair_index"] = ((2 * pairs,), np.uint32)
        return shapes

    def _open(self, rows: int, pairs: int) -> None:
        shapes = self._shapes(rows, pairs)
        needed = sum(
            int(np.prod(shape)) * np.dtype(kind).itemsize for shape, kind in shapes.values()
        )
        if needed > self._memory:
            raise CountError(
                f"the counts need more than {self._memory} bytes: {rows // 2} rows are full. Rewards "
                "with many values? Round them (reward_bits or reward_grid), or allow more (memory)"
            )
        self._arrays = {name: np.zeros(shape, kind) for name, (shape, kind) in shapes.items()}
        for name in ("row_index", "pair_index"):
            if name in self._arrays:
                self._arrays[name].fill(0xFFFFFFFF)
        native = _native.ShimTable()
        for name, array in self._arrays.items():
            setattr(native, name, array.ctypes.data)
        native.gather, native.gather_bytes = self._gather.ctypes.data, len(self._gather_byte)
        native.gather_byte = self._gather_byte.ctypes.data
        native.spread = self._spread.ctypes.data
        native.rows_max, native.pairs_max = rows, pairs
        native.features, native.actions = self.question.features, self.question.actions
        native.percept_bytes = -(-self.question.features // 8)
        self._native = native

    def _grow(self, rows: int = 0, pairs: int = 0) -> None:
        """Make room for so many more rows and pairs; at least for twice as many where it is full."""
        native = self._native
        so_far = self.part()
        sizes = []
        for used, most, more in (
            (native.rows, native.rows_max, rows),
            (native.pairs, native.pairs_max, pairs),
        ):
            size = 2 * most if used == most else most
            while size < used + more:
                size *= 2
            sizes.append(size)
        self._open(*sizes)
        self._add(so_far)

    def count(self, columns: Columns, where: str = "log") -> None:
        """Count interactions.

        Parameters
        ----------
        columns : Columns
        where : str
            Their name in errors.

        Raises
        ------
        LogError
            An action, an end or a reward is out of range.
        CountError
            There are too many distinct rows.
        """
        native = _native.ShimColumns(
            columns.percepts.ctypes.data,
            columns.next_percepts.ctypes.data,
            columns.keys.ctypes.data,
            columns.rewards.ctypes.data,
            columns.actions.ctypes.data,
            columns.ends.ctypes.data,
            len(columns),
        )
        done = ctypes.c_size_t(0)
        while True:
            status = _native.long_call.rlvc_shim_count(
                ctypes.byref(self._native), ctypes.byref(native), ctypes.byref(done)
            )
            if status == _native.OK:
                return
            if status != _native.E_MEMORY:
                raise LogError(self._fault(columns, done.value, where))
            self._grow()

    def _fault(self, columns: Columns, i: int, where: str) -> str:
        """Say what is wrong with an interaction."""
        where = f"{where}: interaction {i}"
        if columns.actions[i] >= self.question.actions:
            return f"{where}: action: {columns.actions[i]} is not in [0, {self.question.actions})"
        if columns.ends[i] > _ENDS:
            return f"{where}: end: {columns.ends[i]} is not in [0, {_ENDS}]"
        return f"{where}: reward: {columns.rewards[i]} is not in [-1e12, 1e12]"

    def add(self, part: Part) -> None:
        """Add the counts of another part.

        Parameters
        ----------
        part : Part
        """
        native = self._native
        if (
            native.rows + len(part.row) > native.rows_max
            or native.pairs + len(part.pair) > native.pairs_max
        ):
            self._grow(len(part.row), len(part.pair))
        self._add(part)

    def _add(self, part: Part) -> None:
        counts = part.native(np.zeros(self.question.features, np.uint16), np.zeros(0, np.uint32))
        status = _native.long_call.rlvc_shim_count_add(
            ctypes.byref(self._native), ctypes.byref(counts)
        )
        assert status == _native.OK  # there is room

    def part(self) -> Part:
        """Return the counts so far, in the order of their keys."""
        native, arrays = self._native, self._arrays
        _native.long_call.rlvc_shim_count_end(ctypes.byref(native))
        return in_order(
            Part(
                arrays["row"][: native.rows],
                arrays["with"][: native.rows],
                arrays["follow"][: native.rows] if self.question.follow else None,
                arrays["pair"][: native.pairs] if self.question.sums else np.zeros(0, PAIR),
                arrays["reward"][: native.pairs] if self.question.sums else None,
            )
        )
