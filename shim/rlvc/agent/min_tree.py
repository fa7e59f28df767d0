# SPDX-License-Identifier: MIT
"""The smallest decision tree that does what is allowed."""

from __future__ import annotations

import ctypes
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .. import _native
from ..checks import whole
from ..errors import ArrayError, BlockError, RangeError

_byref = ctypes.byref


class MinTree(NamedTuple):
    """A tree of the fewest leaves.

    Attributes
    ----------
    leaves : int
    exact : bool
        Whether no tree has fewer; if not, table or effort did not suffice to know it.
    splits : ndarray of uint32, [leaves - 1, 2]
        Leaf and feature: split j leaves the rows without the feature in that leaf, and gives those
        with it the new leaf j + 1.
    actions : ndarray of uint8, [leaves]
    """

    leaves: int
    exact: bool
    splits: npt.NDArray[np.uint32]
    actions: npt.NDArray[np.uint8]


def min_tree(
    rows: npt.NDArray[np.bool_],
    allowed: npt.NDArray[np.bool_],
    *,
    entries: int = 1 << 20,
    effort: int = 1 << 30,
) -> MinTree:
    """Find the binary tree of the fewest leaves in which every row ends where an allowed action is done.

    Parameters
    ----------
    rows : ndarray of bool, [n, features]
        Which features each row exhibits.
    allowed : ndarray of bool, [n, actions]
        Which actions each row allows: at least one. At most 64 actions.
    entries : int
        Of the table in which subsets of rows are kept, [2, 2**28].
    effort : int
        Words that may be looked at, about, [1, 2**39].

    Returns
    -------
    MinTree

    Raises
    ------
    ArrayError
        An array is of the wrong dtype or shape.
    RangeError
        A number is out of range, a row allows nothing, or two rows that are alike in every feature
        allow no common action.
    BlockError
        There is no memory for it.

    Notes
    -----
    What a policy could be at best, when it is known what is optimal in each state: for what an
    agent has learnt, see :meth:`rlvc.Agent.compact`. Source: ``core/include/rlvc/min_tree.h``.

    Examples
    --------
    Action 1 is needed where both features are there:

    >>> both = np.array([[0, 0], [0, 1], [1, 0], [1, 1]], bool)
    >>> min_tree(both, np.array([[1, 0], [1, 0], [1, 0], [0, 1]], bool)).leaves
    3
    """
    rows, allowed = np.asarray(rows), np.asarray(allowed)
    for name, array in (("rows", rows), ("allowed", allowed)):
        if array.dtype != np.bool_ or array.ndim != 2 or len(array) != len(rows):
            raise ArrayError(f"{name}: {array.dtype}{list(array.shape)}, not bool[n, ...]")
    if allowed.shape[1] > 64:
        raise RangeError(f"allowed: {allowed.shape[1]} actions, not 64 at most")
    entries = whole("entries", entries, 1, 2**28, RangeError)
    effort = whole("effort", effort, 1, 2**39, RangeError)
    words, sets = _packed(rows), _packed(allowed)
    task = _native.MinTreeTask(words.ctypes.data, sets.ctypes.data, *rows.shape, entries, 0, effort)
    size, tree = ctypes.c_size_t(), _native.MinTreeResult()
    status = _native.call.rlvc_min_tree_size(_byref(task), _byref(size))
    if status == _native.OK:
        try:
            block = np.empty(size.value // 8 + 1, np.uint64)
        except (MemoryError, ValueError):
            raise BlockError(f"no memory for a block of {size.value} bytes") from None
        place = (block.ctypes.data, size.value)
        status = _native.long_call.rlvc_min_tree(_byref(task), *place, _byref(tree))
    if status != _native.OK:
        raise RangeError(
            "rows and entries are at least 1 and 2, every row allows an action, "
            "and rows alike in every feature a common one"
        )
    splits = np.zeros((tree.leaves - 1, 2), np.uint32)
    ctypes.memmove(splits.ctypes.data, tree.split, splits.nbytes)
    actions = np.zeros(tree.leaves, np.uint8)
    ctypes.memmove(actions.ctypes.data, tree.action, actions.nbytes)
    return MinTree(tree.leaves, bool(tree.exact), splits, actions)


def _packed(bits: npt.NDArray[np.bool_]) -> npt.NDArray[np.uint64]:
    """Rows of bits as words, the lowest bit first."""
    words = max(1, (bits.shape[1] + 63) // 64)
    padded = np.zeros((len(bits), 64 * words), np.bool_)
    padded[:, : bits.shape[1]] = bits
    return np.packbits(padded, axis=1, bitorder="little").view("<u8").astype(np.uint64)
