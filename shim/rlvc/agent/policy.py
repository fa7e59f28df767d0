# SPDX-License-Identifier: MIT
"""Small policies for deployment."""

from __future__ import annotations

import ctypes
import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..checks import real, whole
from ..domains.callbacks import Guard
from ..domains.domain import Domain, Percept
from ..domains.packing import packing
from .handle import Handle, allocated

if TYPE_CHECKING:
    from .agent import Agent

_policy_act = _native.call.rlvc_policy_act
_byref = ctypes.byref


@dataclasses.dataclass(frozen=True)
class Compaction:
    """The sizes of a policy and of the tree that it was made from.

    Attributes
    ----------
    classes : int
        Leaves of the agent's tree.
    collapsed : int
        Leaves after each subtree with one action became one leaf.
    leaves : int
        Leaves of the policy.
    percepts : int
        Number of different percepts in the replay buffer; 0: more than there was room for.
    features : int
        Number of different features in the agent's tree.
    bytes : int
        Memory of the policy in C, in bytes.
    exact : bool
        Whether the minimum is proven: no tree over these features has fewer leaves.
    as_agent : bool
        Whether the policy acts as the agent on every possible percept, because it is the collapsed
        tree. If not, it may act otherwise on percepts that were not in the replay buffer.
    value_before : float
        Mean value of the agent's policy, in the model of the interactions that it has learnt from;
        NaN for a planner.
    value_after : float
        The same of this policy, or less where it takes several actions in one class.
    """

    classes: int
    collapsed: int
    leaves: int
    percepts: int
    features: int
    bytes: int
    exact: bool
    as_agent: bool
    value_before: float
    value_after: float


class Policy(Handle):
    """A policy by itself: of an agent the smallest that acts as well on all percepts in its memory.

    :meth:`rlvc.Agent.compact` and :meth:`rlvc.Planner.policy` make one. It is independent of them.

    Attributes
    ----------
    info : Compaction
        Numbers of leaves before and after.

    Notes
    -----
    Use a policy from one thread at a time. Source: ``core/include/rlvc/policy.h``.

    Examples
    --------
    >>> from rlvc import Agent
    >>> agent = Agent(3, 2)
    >>> policy = agent.compact()
    >>> policy.info.leaves, policy.act(bytes([5]))
    (1, 0)
    """

    _noun = "policy"
    _print, _export = "rlvc_policy_print", "rlvc_policy_export_c"

    def __init__(self, agent: Agent, **changes: Any) -> None:
        native, size = _native.PolicyConfig(), ctypes.c_size_t()
        agent._check(_native.call.rlvc_policy_default(agent._handle, _byref(native)))
        for field, value in changes.items():
            if value is not None:
                _set(native, field, value)
        agent._check(_native.call.rlvc_policy_size(agent._handle, _byref(native), _byref(size)))
        block = allocated(size.value, "a policy", "reduce percepts or entries")
        policy, info = ctypes.c_void_p(), _native.PolicyInfo()
        place = (block.ctypes.data, size.value)
        agent._check(
            agent._long("rlvc_policy_make", _byref(native), *place, _byref(policy), _byref(info))
        )
        fields = {field.name: getattr(info, field.name) for field in dataclasses.fields(Compaction)}
        flags = {name: bool(fields[name]) for name in ("exact", "as_agent")}
        made = Compaction(**(fields | flags))
        place_of = (agent._domain, agent._guard, agent._native_domain)
        self._settle(*place_of, block, policy.value, made)

    def _settle(
        self,
        domain: Domain,
        guard: Guard,
        native: _native.Domain,
        block: npt.NDArray[np.uint64],
        address: int | None,
        info: Compaction,
    ) -> None:
        """Take over the policy that was made in a block."""
        self._domain, self._guard, self._native_domain = domain, guard, native
        self._pack, self._pack_many, self._is_one = packing(domain)
        self._block = block
        self._handle = self._address = address
        self._memory_bytes = 8 * block.size
        self._action = ctypes.c_uint32()
        self._answer = _byref(self._action)
        self.info = info

    def act(self, percept: Percept) -> int | npt.NDArray[np.uint32]:
        """Return the action at a percept, or at each percept of an array.

        Parameters
        ----------
        percept : bytes, or ndarray [*percept_shape] or [n, *percept_shape]
            One percept, or n percepts.

        Returns
        -------
        int or ndarray of uint32, [n]

        Raises
        ------
        PerceptError
            A percept has the wrong size, dtype or shape, or the array is not C-contiguous.
        """
        if self._is_one(percept):
            status = _policy_act(self._handle, self._pack(percept), self._answer)
            if status:
                self._fail(status)
            return self._action.value
        packed = self._pack_many(percept)
        actions, done = np.empty(len(packed), np.uint32), ctypes.c_size_t()
        status = self._long(
            "rlvc_shim_policy_act",
            packed.ctypes.data,
            self._native_domain.percept_bytes,
            len(packed),
            actions.ctypes.data,
            _byref(done),
        )
        if status:
            self._fail(status, done.value)
        return actions

    def __reduce__(self) -> tuple[Any, ...]:
        """Refuse to be pickled."""
        raise TypeError("a policy is not pickled: pickle the agent, and call its compact() again")

    def __repr__(self) -> str:
        """Describe the policy."""
        return f"<rlvc.Policy of {self.info.leaves} leaves>"


def _set(native: _native.PolicyConfig, field: str, value: Any) -> None:
    """Set a field of the config; C checks its range."""
    if field == "tolerance":
        native.tolerance = real(field, value)
    else:
        setattr(
            native, field, whole(field, value, 0, 2**64 - 1 if field == "effort" else 2**32 - 1)
        )
