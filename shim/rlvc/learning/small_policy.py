# SPDX-License-Identifier: MIT
"""Policies that are small trees of tests x[i] > c."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ..errors import RangeError

Reals = npt.NDArray[Any]


class SmallPolicy:
    """A policy that is a small tree of tests x[i] > c.

    Attributes
    ----------
    leaves : int
    """

    def __init__(self) -> None:
        self._test: list[int] = [-1]  # component that a node tests, or -1 at a leaf
        self._cutpoint: list[float] = [0.0]
        # Child of a node if x[i] <= c; the next node is the child if x[i] > c.
        self._absent: list[int] = [0]
        self._action: list[int] = [0]

    @property
    def leaves(self) -> int:
        """Number of leaves."""
        return self._test.count(-1)

    def act(self, percepts: Reals) -> Any:
        """Return the action at a percept, or at each percept of an array.

        Parameters
        ----------
        percepts : ndarray, [n, components] or [components]

        Returns
        -------
        ndarray of intp, [n], or one number
        """
        if np.ndim(percepts) == 1:
            leaf = 0
            while self._test[leaf] >= 0:
                leaf = self._absent[leaf] + int(percepts[self._test[leaf]] > self._cutpoint[leaf])
            return self._action[leaf]
        rows = np.asarray(percepts, np.float32)
        node = np.zeros(len(rows), np.intp)
        test, absent = np.array(self._test), np.array(self._absent)
        cutpoint = np.array(self._cutpoint, np.float32)
        inner = np.flatnonzero(test[node] >= 0)
        while len(inner):
            at = node[inner]
            node[inner] = absent[at] + (rows[inner, test[at]] > cutpoint[at])
            inner = inner[test[node[inner]] >= 0]
        return np.array(self._action)[node]

    def text(self) -> str:
        """Return the tree as text."""
        return "".join(self._lines(0, "", ""))

    def _lines(self, node: int, indent: str, answer: str) -> list[str]:
        if self._test[node] < 0:
            return [f"{indent}{answer}action {self._action[node]}\n"]
        below, deeper = self._absent[node], indent + "  "
        return [
            f"{indent}{answer}x[{self._test[node]}] > {self._cutpoint[node]:.6g}?\n",
            *self._lines(below, deeper, "no: "),
            *self._lines(below + 1, deeper, "yes: "),
        ]

    def export_c(self, name: str = "policy") -> str:
        """Return the policy as a C99 header.

        Parameters
        ----------
        name : str
            A C identifier. The header defines ``NAME_act(x)``, with x an array of float.

        Returns
        -------
        str

        Raises
        ------
        RangeError
            ``name`` is not an identifier.
        """
        if not (name.isidentifier() and name.isascii()):
            raise RangeError(f"name: {name!r} is not a C identifier")
        return (
            f"/* A policy learnt by rlvc: {self.leaves} leaves. */\n"
            f"#ifndef {name}_policy_h\n#define {name}_policy_h\n\n"
            f"static inline unsigned {name}_act(const float *x) {{\n    (void)x;\n"
            f"    return {self._expression(0)};\n}}\n\n#endif\n"
        )

    def _expression(self, node: int) -> str:
        if self._test[node] < 0:
            return f"{self._action[node]}u"
        below = self._absent[node]
        test = f"x[{self._test[node]}] > {float(np.float32(self._cutpoint[node]))!r}f"
        return f"({test} ? {self._expression(below + 1)} : {self._expression(below)})"

    def _split(self, node: int, test: int, cutpoint: float) -> tuple[int, int]:
        below = len(self._test)
        self._test[node], self._cutpoint[node], self._absent[node] = test, cutpoint, below
        self._test += [-1, -1]
        self._cutpoint += [0.0, 0.0]
        self._absent += [0, 0]
        self._action += [0, 0]
        return below, below + 1

    def _merge(self) -> SmallPolicy:
        """Return the same policy without tests whose leaves all have the same action."""
        made = SmallPolicy()

        def alike(node: int) -> bool:
            return len(actions(node)) == 1

        def actions(node: int) -> set[int]:
            if self._test[node] < 0:
                return {self._action[node]}
            return actions(self._absent[node]) | actions(self._absent[node] + 1)

        def copy(node: int, to: int) -> None:
            if alike(node):
                made._action[to] = min(actions(node))
                return
            pair = made._split(to, self._test[node], self._cutpoint[node])
            for side in (0, 1):
                copy(self._absent[node] + side, pair[side])

        copy(0, 0)
        return made
