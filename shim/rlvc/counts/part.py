# SPDX-License-Identifier: MIT
"""What a part of a log comes to when it is counted."""

from __future__ import annotations

import ctypes
import dataclasses
import hashlib
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..errors import CountError

ROW = np.dtype(_native.CountRow)
PAIR = np.dtype(_native.CountPair)


@dataclasses.dataclass(frozen=True)
class Question:
    """What is counted: the same for all parts.

    Attributes
    ----------
    features : int
        Bits of a percept.
    actions : int
    tested : tuple of int
        The features that a cell consists of, at most 64.
    follow : bool
        Whether features of s' are counted, for what follows an action.
    sums : bool
        Whether rewards are summed exactly, since the rows' are rounded.
    """

    features: int
    actions: int
    tested: tuple[int, ...] = ()
    follow: bool = True
    sums: bool = False


@dataclasses.dataclass(frozen=True)
class Part:
    """Counts: rows and pairs in the order of their keys, so that equal counts are equal bytes.

    Attributes
    ----------
    row : ndarray of ROW, [rows]
    present : ndarray of uint64, [rows, features]
        How many interactions of the row have s with each feature.
    follow : ndarray of uint64, [rows, 2, features], or None
        How many have s' with each feature, and how many s and s'.
    pair : ndarray of PAIR, [pairs]
        Cells and actions whose rewards are summed.
    reward : ndarray of uint64, [pairs, 4], or None
        Exact sums.
    """

    row: npt.NDArray[Any]
    present: npt.NDArray[np.uint64]
    follow: npt.NDArray[np.uint64] | None
    pair: npt.NDArray[Any]
    reward: npt.NDArray[np.uint64] | None

    @property
    def interactions(self) -> int:
        """How many were counted."""
        return int(self.row["count"].sum(dtype=np.uint64))

    @property
    def nbytes(self) -> int:
        """Size of the arrays."""
        return sum(array.nbytes for array in self._arrays())

    def _arrays(self) -> list[npt.NDArray[Any]]:
        arrays = (self.row, self.present, self.follow, self.pair, self.reward)
        return [array for array in arrays if array is not None]

    def check(self, question: Question) -> None:
        """Raise CountError unless the arrays are those of a question: C relies on their shapes.

        Parameters
        ----------
        question : Question
        """
        rows, pairs, features = len(self.row), len(self.pair), question.features
        words = _native.EXACT_SUM_WORDS
        wanted: dict[str, tuple[Any, tuple[int, ...]] | None] = {
            "row": (ROW, (rows,)),
            "present": (np.dtype(np.uint64), (rows, features)),
            "follow": (np.dtype(np.uint64), (rows, 2, features)) if question.follow else None,
            "pair": (PAIR, (pairs,)),
            "reward": (np.dtype(np.uint64), (pairs, words)) if question.sums else None,
        }
        for name, expected in wanted.items():
            array = getattr(self, name)
            found = None if array is None else (array.dtype, array.shape)
            if found != expected or (array is not None and not array.flags.c_contiguous):
                raise CountError(f"{name}: {found}, expected {expected}")

    def digest(self) -> str:
        """Return a hash that is equal for equal counts."""
        made = hashlib.sha256()
        for array in self._arrays():
            made.update(array.tobytes())
        return made.hexdigest()

    def native(self, feature: npt.NDArray[Any], tested: npt.NDArray[np.uint32]) -> _native.Counts:
        """Make the C struct, which keeps its arrays alive.

        Parameters
        ----------
        feature : ndarray, [features]
            Records of the domain's features.
        tested : ndarray of uint32
            The features that a cell consists of.
        """

        def address(array: npt.NDArray[Any] | None) -> int | None:
            return None if array is None else array.ctypes.data

        made = _native.Counts()
        for name, array in (
            ("row", self.row), ("with", self.present), ("pair", self.pair),
            ("follow", self.follow), ("reward", self.reward), ("feature", feature),
            ("tested", tested),
        ):  # fmt: skip
            setattr(made, name, ctypes.c_void_p(address(array)))
        made.rows, made.pairs = len(self.row), len(self.pair)
        made.features, made.cell_bits = len(feature), len(tested)
        made._keeps = (self, feature, tested)
        return made


def in_order(part: Part) -> Part:
    """Return the same counts with rows and pairs in the order of their keys.

    Parameters
    ----------
    part : Part
    """
    row, pair = part.row, part.pair
    reward = row["reward"].view(np.uint32) if row["reward"].flags.c_contiguous else None
    if reward is None:
        reward = np.ascontiguousarray(row["reward"]).view(np.uint32)
    rows = np.lexsort((row["next"], reward, row["terminated"], row["action"], row["now"]))
    pairs = np.lexsort((pair["action"], pair["now"]))
    return Part(
        row[rows],
        part.present[rows],
        None if part.follow is None else part.follow[rows],
        pair[pairs],
        None if part.reward is None else part.reward[pairs],
    )
