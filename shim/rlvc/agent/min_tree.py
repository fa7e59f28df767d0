# SPDX-License-Identifier: MIT
"""The decision tree with the fewest leaves for a table of allowed actions."""

from __future__ import annotations

import ctypes
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .. import _native
from ..checks import array, whole
from ..errors import ArrayError, BlockError, RangeError

_byref = ctypes.byref


class MinTree(NamedTuple):
    """A decision tree with the minimum number of leaves.

    Attributes
    ----------
    leaves : int
    exact : bool
        Whether the minimum is proven: ``entries`` and ``effort`` were sufficient.
    splits : ndarray of uint32, [leaves - 1, 2]
        Leaf and feature of each split. Split j keeps rows without the feature in the leaf, and
        moves rows with it to the new leaf j + 1.
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
    """Find the binary tree with the fewest leaves that gives every row an allowed action.

    Parameters
    ----------
    rows : ndarray of bool, [n, features]
        The features of each row.
    allowed : ndarray of bool, [n, actions]
        The allowed actions of each row: at least one. At most 64 actions.
    entries : int
        Size of the table of subsets of rows, [2, 2**28].
    effort : int
        Approximate limit of the work, in machine words read, [1, 2**39].

    Returns
    -------
    MinTree

    Raises
    ------
    ArrayError
        An array has the wrong dtype or shape.
    RangeError
        A number is out of range, a row allows no action, or two rows with the same features allow
        no common action.
    BlockError
        There is not enough memory.

    Notes
    -----
    This is a lower bound for the size of a policy, if the optimal actions of all states are known.
    For the policy of an agent see :meth:`rlvc.Agent.compact`. Source:
    ``core/include/rlvc/min_tree.h``.

    Examples
    --------
    Action 1 is needed if both features are present:

    >>> both = np.array([[0, 0], [0, 1], [1, 0], [1, 1]], bool)
    >>> min_tree(both, np.array([[1, 0], [1, 0], [1, 0], [0, 1]], bool)).leaves
    3
    """
    rows, allowed = array("rows", rows), array("allowed", allowed)
    for name, given in (("rows", rows), ("allowed", allowed)):
        if given.dtype != np.bool_ or given.ndim != 2 or len(given) != len(rows):
            raise ArrayError(f"{name}: {given.dtype}{list(given.shape)}, expected bool[n, ...]")
    if allowed.shape[1] > 64:
        raise RangeError(f"allowed: {allowed.shape[1]} actions, more than 64")
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
            raise BlockError(f"not enough memory for {size.value} bytes") from None
        place = (block.ctypes.data, size.value)
        status = _native.long_call.rlvc_min_tree(_byref(task), *place, _byref(tree))
    if status != _native.OK:
        raise RangeError(
            "rows must be at least 1, entries at least 2, every row must allow an action, and rows with "
            "the same features a common action"
        )
    splits = np.zeros((tree.leaves - 1, 2), np.uint32)
    ctypes.memmove(splits.ctypes.data, tree.split, splits.nbytes)
    actions = np.zeros(tree.leaves, np.uint8)
    ctypes.memmove(actions.ctypes.data, tree.action, actions.nbytes)
    return MinTree(tree.leaves, bool(tree.exact), splits, actions)


def _packed(bits: npt.NDArray[np.bool_]) -> npt.NDArray[np.uint64]:
    """Pack rows of bits into words, lowest bit first."""
    words = max(1, (bits.shape[1] + 63) // 64)
    padded = np.zeros((len(bits), 64 * words), np.bool_)
    padded[:, : bits.shape[1]] = bits
    return np.packbits(padded, axis=1, bitorder="little").view("<u8").astype(np.uint64)
