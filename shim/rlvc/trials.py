# SPDX-License-Identifier: MIT
"""Small policies on real numbers, and trials that find a good one.

Of real numbers a tree never knows enough: each new class makes values a little truer, and the policy
of a class-level model that is nearly right may be a bad one. So a small tree is made of the agent's
values (:func:`shrink`), it is this tree that acts, and what it earns decides (:class:`Trials`). Of many
that are tried for a few episodes the best may be one that was lucky; so it is tried again in the end.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import RangeError

_CUTPOINTS = 32  # of a component, at quantiles of all percepts
_EPISODES = 5  # of a trial, at most
_DOUBT = 0.3  # episodes that earn nothing, added to those of a policy when it is compared
_LEAST = 1e-6  # gain of a test that is worth a leaf, as a share of what is at stake

Reals = npt.NDArray[Any]


class SmallPolicy:
    """A policy that is a tree of few leaves, with tests x[i] > c.

    Attributes
    ----------
    leaves : int
    """

    def __init__(self) -> None:
        self._test: list[int] = [-1]  # of a node: the component, or -1 at a leaf
        self._cutpoint: list[float] = [0.0]
        # The node below, if not above the cutpoint; the next one if above.
        self._absent: list[int] = [0]
        self._action: list[int] = [0]

    @property
    def leaves(self) -> int:
        """How many leaves there are."""
        return self._test.count(-1)

    def act(self, percepts: Reals) -> Any:
        """Give actions.

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
        """Print the tree, as :meth:`rlvc.Agent.print` does the agent's."""
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
        """Give the policy as a C99 header.

        Parameters
        ----------
        name : str
            A C identifier; ``NAME_act(x)`` is the function to call, x an array of float.

        Returns
        -------
        str

        Raises
        ------
        RangeError
            ``name`` is no identifier.
        """
        if not (name.isidentifier() and name.isascii()):
            raise RangeError(f"name: {name!r} is no identifier of C")
        return (
            f"/* A policy learnt by rlvc, of {self.leaves} leaves. */\n"
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
        """The same policy without tests whose answers lead to the same action."""
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


class _Growth:
    """A small policy that grows: which rows each leaf has, and its best split."""

    def __init__(self, rows: Reals, values: Reals) -> None:
        order = np.sort(values, axis=1)
        stake = order[:, -1] - order[:, -2] if values.shape[1] > 1 else order[:, -1] * 0
        stake = np.sqrt(stake)
        self.weight = np.zeros(values.shape)
        self.weight[np.arange(len(rows)), values.argmax(axis=1)] = stake
        ranks = np.arange(1, _CUTPOINTS + 1) / (_CUTPOINTS + 1)
        self.cutpoints = [
            np.unique(np.quantile(column, ranks).astype(np.float32)) for column in rows.T
        ]
        self.bins = [
            np.searchsorted(cut, column) for cut, column in zip(self.cutpoints, rows.T, strict=True)
        ]
        self.least = _LEAST * float(stake.sum())
        self.policy = SmallPolicy()
        self.leaves: dict[int, npt.NDArray[Any]] = {}
        self.best: dict[int, tuple[float, int, int]] = {}
        self.put(0, np.arange(len(rows)))

    def put(self, node: int, rows: npt.NDArray[Any]) -> None:
        self.leaves[node] = rows
        self.best[node] = self.search(rows)
        self.policy._action[node] = int(self.weight[rows].sum(axis=0).argmax())

    def search(self, rows: npt.NDArray[Any]) -> tuple[float, int, int]:
        """The gain of the best split of some rows, its component, and its cutpoint's number."""
        found = (self.least, -1, 0)
        weight = self.weight[rows]
        for i, cut in enumerate(self.cutpoints):
            below = np.stack(
                [np.bincount(self.bins[i][rows], w, len(cut) + 1) for w in weight.T], axis=1
            ).cumsum(axis=0)
            whole = below[-1]
            gains = _impurity(whole) - _impurity(below[:-1]) - _impurity(whole - below[:-1])
            if len(cut) and gains.max() > found[0]:
                found = (float(gains.max()), i, int(gains.argmax()))
        return found

    def grow(self) -> bool:
        """Split the leaf where that gains most; whether there was one."""
        node = max(self.best, key=lambda leaf: self.best[leaf][0])
        _, test, number = self.best.pop(node)
        if test < 0:
            return False
        rows = self.leaves.pop(node)
        above = self.bins[test][rows] > number
        absent, present = self.policy._split(node, test, float(self.cutpoints[test][number]))
        self.put(absent, rows[~above])
        self.put(present, rows[above])
        return True


def _impurity(weight: Reals) -> Any:
    """Gini's, times what is weighed: 0 where there is but one action."""
    whole = weight.sum(axis=-1)
    return whole - (weight**2).sum(axis=-1) / np.maximum(whole, 1e-30)


def shrink(percepts: Reals, values: Reals, leaves: int) -> SmallPolicy:
    """Make a small policy that loses as little as can be of what is at stake, by a greedy search.

    Each percept wants the action of the greatest value, by the square root of how much that is above
    the second: by as much itself, what goes before a fall would take all leaves, and none be left for
    what keeps one far from falling. The leaf is split, and the cutpoint taken, by which the impurity
    of these wishes falls most.

    Parameters
    ----------
    percepts : ndarray of float32, [n, components]
        That were met.
    values : ndarray, [n, actions]
        Q of each action at each of them.
    leaves : int
        At most.

    Returns
    -------
    SmallPolicy

    Raises
    ------
    RangeError
        ``leaves`` is less than 1.
    """
    if leaves < 1:
        raise RangeError("leaves are at least 1")
    growth = _Growth(np.asarray(percepts, np.float32), np.asarray(values, np.float64))
    while len(growth.leaves) < leaves and growth.grow():
        pass
    return growth.policy._merge()


class Trials:
    """Which policy acts, and which has done best.

    A policy is tried for a few episodes, and no longer than its mean return is at least that of the
    best so far. Then the next is made. The best is the one with the greatest mean return, of which a
    little is taken off for doubt, the less the more episodes it was tried for.
    """

    def __init__(self) -> None:
        self._tried: list[tuple[SmallPolicy, list[float]]] = []
        self._now: tuple[SmallPolicy, list[float]] | None = None

    @property
    def policy(self) -> SmallPolicy | None:
        """The one on trial."""
        return self._now[0] if self._now else None

    @property
    def best(self) -> SmallPolicy | None:
        """The one that has done best of those that had an episode."""
        return self._best()[0] if self._tried else None

    def _best(self) -> tuple[SmallPolicy, list[float]]:
        """With its returns; of equals the last."""
        return max(reversed(self._tried), key=lambda tried: _score(tried[1]))

    def start(self, policy: SmallPolicy) -> None:
        """Put a policy on trial."""
        self._now = (policy, [])

    def end_episode(self, gained: float) -> bool:
        """Note the return of an episode; whether the trial is over."""
        assert self._now is not None
        returns = self._now[1]
        if not returns:
            self._tried.append(self._now)
        returns.append(gained)
        return len(returns) >= _EPISODES or np.mean(returns) < np.mean(self._best()[1])

    def resume(self) -> None:
        """Put the best on trial again; what it earned before counts on."""
        self._now = self._best()


def _score(returns: list[float]) -> float:
    """The mean, less doubt."""
    mean = float(np.mean(returns))
    return mean - abs(mean) * _DOUBT / (len(returns) + _DOUBT)
