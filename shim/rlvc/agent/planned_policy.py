# SPDX-License-Identifier: MIT
"""The policy of a planner, and its file.

The JSON of the file (:mod:`rlvc.agent.kept`) has ``thresholds``, the parameters of the domain,
``names`` (of the components), ``actions`` and ``nodes``.
"""

from __future__ import annotations

import ctypes
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .. import _native
from ..checks import listed, real, shown, whole
from ..domains.callbacks import Guard
from ..domains.thresholds import Thresholds
from ..errors import Error, RangeError, SnapshotError
from .handle import allocated
from .kept import is_kind, read_content, unpack, write_named
from .policy import Compaction, Policy

_byref = ctypes.byref


class PlannedPolicy(Policy):
    """The policy of a planner: a small tree of tests x[i] > c. It is saved, loaded and pickled.

    :meth:`rlvc.Planner.policy` makes one.

    Parameters
    ----------
    domain : Thresholds
        The percepts.
    actions : int
        Number of actions, [1, 64].
    nodes : sequence of (cutpoint, component, child, action)
        The tree, [1, 31] nodes: x[component] > cutpoint leads to node child + 1, else to node child;
        of a leaf the component is 65535. The j-th test's child is 2j + 1.

    Attributes
    ----------
    info : Compaction
        Numbers of leaves.
    nodes : list of tuple
    actions : int

    Raises
    ------
    RangeError
        The nodes are not such a tree.
    """

    def __init__(self, domain: Thresholds, actions: int, nodes: Sequence[Sequence[Any]]) -> None:
        self.actions = whole("actions", actions, 1, _native.PLANNER_ACTIONS_MAX, RangeError)
        self.nodes = [_node(node) for node in listed("nodes", nodes, "nodes", RangeError)]
        size, guard = _native.PLANNER_POLICY_BYTES, Guard()
        block = allocated(size, "a policy", "close what is not needed")
        native = domain.native(guard)
        tests = (_native.PlannerTest * max(1, len(self.nodes)))(
            *(_native.PlannerTest(*node) for node in self.nodes)
        )
        policy, place = ctypes.c_void_p(), (block.ctypes.data, size)
        tree = (tests, len(self.nodes), self.actions)
        self._check(
            _native.call.rlvc_planner_policy_of(*tree, _byref(native), *place, _byref(policy))
        )
        inner = {node[:2] for node in self.nodes if node[1] != _native.PLANNER_LEAF}
        leaves = len(self.nodes) // 2 + 1
        info = Compaction(
            leaves, leaves, leaves, 0, len(inner), size, False, True, math.nan, math.nan
        )
        self._settle(domain, guard, native, block, policy.value, info)

    def save(self, file: str | Path, names: Sequence[str] = ()) -> None:
        """Write the policy to a file. A failure leaves the old file.

        Parameters
        ----------
        file : str or Path
        names : sequence of str
            Names of the components.

        Raises
        ------
        StoreError
            The file cannot be written, or is a link, a folder, a FIFO or a device.
        """
        head = {"thresholds": self._thresholds.parameters, "actions": self.actions}
        write_named(file, "policy", names, head | {"nodes": self.nodes})

    @property
    def _thresholds(self) -> Thresholds:
        domain = self._domain
        assert isinstance(domain, Thresholds)
        return domain

    @classmethod
    def load(cls, file: str | Path) -> PlannedPolicy:
        """Read a policy from a file.

        Parameters
        ----------
        file : str or Path

        Returns
        -------
        PlannedPolicy

        Raises
        ------
        StoreError
            The file cannot be read.
        SnapshotError
            It is not such a file, or is corrupt.
        """
        return read_file(file)[0]

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the nodes."""
        return type(self), (self._thresholds, self.actions, self.nodes)


def _node(node: Any) -> tuple[float, int, int, int]:
    """Check the types of a node, and that its numbers fit into C's."""
    fields = listed("node", node, "fields", RangeError)
    if len(fields) != 4:
        raise RangeError(f"node: {shown(node)} is not (cutpoint, component, child, action)")
    cutpoint, component, child, action = fields
    return (
        real("cutpoint", cutpoint, RangeError),
        whole("component", component, 0, 2**16 - 1, RangeError),
        whole("child", child, 0, 2**8 - 1, RangeError),
        whole("action", action, 0, 2**8 - 1, RangeError),
    )


def is_policy(file: str | Path) -> bool:
    """Whether a file can be read and begins as that of a policy."""
    return is_kind(file, "policy")


def read_file(file: str | Path) -> tuple[PlannedPolicy, list[str]]:
    """Read a policy and the names of its components: see :meth:`PlannedPolicy.load`.

    Parameters
    ----------
    file : str or Path

    Returns
    -------
    PlannedPolicy, list of str
    """
    content = read_content(file)
    try:
        head, _ = unpack("policy", content)
        policy = PlannedPolicy(Thresholds(*head["thresholds"]), head["actions"], head["nodes"])
        return policy, [str(name) for name in head["names"]]
    except SnapshotError as error:
        raise SnapshotError(f"{file}: {error}") from None
    except (Error, KeyError, TypeError, ValueError) as error:
        raise SnapshotError(f"{file}: damaged: {error}") from error
