# SPDX-License-Identifier: MIT
"""Arrays of interactions: of one call, or of a vector of environments."""

from __future__ import annotations

import ctypes
from operator import attrgetter
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..checks import shown, whole
from ..domains.domain import Domain
from ..errors import ArrayError, DomainError, RangeError
from .results import CHOICE

if TYPE_CHECKING:
    from .agent import Agent

_DTYPES = {name: np.dtype(name) for name in ("float32", "uint8", "uint32")} | {"CHOICE": CHOICE}

_QUICK_BYTES = (
    4096  # up to this many bytes of percepts take microseconds: keep the interpreter's lock
)


def checked(array: Any, name: str, dtype: str, shape: tuple[int, ...]) -> npt.NDArray[Any]:
    """Return the array if it is as C expects it.

    Parameters
    ----------
    array : object
    name : str
        Its name in errors.
    dtype : {"float32", "uint8", "uint32", "CHOICE"}
    shape : tuple of int

    Returns
    -------
    ndarray

    Raises
    ------
    ArrayError
        It is not an array, has another dtype or shape, or is not C-contiguous.
    """
    if not isinstance(array, np.ndarray):
        raise ArrayError(f"{name}: must be an array, not {type(array).__name__}")
    if array.dtype != _DTYPES[dtype] or array.shape != shape:
        raise ArrayError(f"{name}: {array.dtype}{list(array.shape)}, expected {dtype}{list(shape)}")
    if not array.flags.c_contiguous:
        raise ArrayError(f"{name}: not C-contiguous: use numpy.ascontiguousarray")
    return array


def native_log(
    percept_bytes: int,
    actions: int,
    percepts: npt.NDArray[Any],
    choices: npt.NDArray[Any],
    rewards: npt.NDArray[Any],
    next_percepts: npt.NDArray[Any],
    ends: npt.NDArray[Any],
) -> _native.ShimLog:
    """Make the C struct of interactions, which keeps its arrays alive.

    Parameters
    ----------
    percept_bytes : int
        Size of a packed percept.
    actions : int
        Number of actions.
    percepts, choices, rewards, next_percepts, ends : ndarray, [n, ...]
        As for :meth:`rlvc.Agent.observe_many`, with packed percepts.

    Returns
    -------
    rlvc_shim_log

    Raises
    ------
    ArrayError
        An array has the wrong dtype or shape, or is not C-contiguous.
    """
    count = len(percepts)
    if len(next_percepts) != count:
        raise ArrayError(f"next_percepts: {len(next_percepts)}, expected {count}")
    checked(choices, "choices", "CHOICE", (count,))
    checked(rewards, "rewards", "float32", (count,))
    checked(ends, "ends", "uint8", (count,))
    arrays = (percepts, next_percepts, choices, rewards, ends)
    pointers = (array.ctypes.data for array in arrays)
    native = _native.ShimLog(*pointers, count, percept_bytes, actions)
    native._keeps = arrays
    return native


class Batch:
    """The arrays of a vector of environments, shared with C.

    :meth:`rlvc.Agent.batch` makes one. For each step of the vector: write ``percepts``, call
    :meth:`act`, step the environments, write ``rewards``, ``next_percepts`` and ``ends``, call
    :meth:`observe`. Write into the arrays, as in ``batch.rewards[...] = rewards``: they cannot be
    replaced. From 64 environments on, a step costs less than a tenth of the same number of calls of
    ``act`` and ``observe`` (``tools/bench/micro/shim.py`` measures it).

    Parameters
    ----------
    agent : Agent
    count : int
        Maximum number of environments.

    Attributes
    ----------
    percepts : ndarray, [count, *percept_shape]
        Input: the current percept of each environment.
    choices : ndarray of CHOICE, [count]
        Output of :meth:`act`; may be changed.
    rewards : ndarray of float32, [count]
        Input: finite, in [-1e12, 1e12].
    next_percepts : ndarray, [count, *percept_shape]
        Input: s'. Ignored where the interaction terminated.
    ends : ndarray of uint8, [count]
        Input. 0: the episode goes on; 1: terminated; 2: truncated.

    Raises
    ------
    RangeError
        ``count`` is less than 1.

    Notes
    -----
    Use the residual criterion with vectors: runs of exploitation mix the environments, which the
    criterion of returns cannot use.

    Examples
    --------
    >>> from rlvc import Agent
    >>> agent = Agent(3, 2)
    >>> batch = agent.batch(2)
    >>> batch.percepts[...] = [[5], [1]]
    >>> choices = batch.act()
    >>> batch.rewards[...], batch.ends[...] = [1.0, 0.0], 1
    >>> batch.observe()
    >>> agent.statistics.interactions
    2
    """

    def __init__(self, agent: Agent, count: int) -> None:
        count = whole("count", count, 1, 2**31 - 1, RangeError)
        domain, size = agent.domain, int(agent._native_domain.percept_bytes)
        percepts = ((count, *domain.percept_shape), domain.percept_dtype)
        numbers = (((count,), dtype) for dtype in (CHOICE, np.float32, np.uint8))
        # Views: numpy refuses to resize an array that has one.
        before, after, choices, rewards, ends = (
            np.zeros(shape, dtype)[:] for shape, dtype in (percepts, percepts, *numbers)
        )
        self._percepts, self._next_percepts = before, after
        self._choices, self._rewards, self._ends = choices, rewards, ends
        self._agent = agent
        self._domain = domain
        self._checked = type(domain).check_many is not Domain.check_many
        self._count = count
        arrays = (before, choices, rewards, after, ends)
        self._native = native_log(size, agent.config.actions, *arrays)
        self._taken: int | None = None
        self._done = ctypes.c_size_t()
        self._log, self._stopped = ctypes.byref(self._native), ctypes.byref(self._done)
        if count * size <= _QUICK_BYTES:
            self._act, self._observe = _native.call.rlvc_shim_act, _native.call.rlvc_shim_observe
        else:
            self._act = lambda _, *rest: agent._long("rlvc_shim_act", *rest)
            self._observe = lambda _, *rest: agent._long("rlvc_shim_observe", *rest)

    percepts = property(attrgetter("_percepts"))
    choices = property(attrgetter("_choices"))
    rewards = property(attrgetter("_rewards"))
    next_percepts = property(attrgetter("_next_percepts"))
    ends = property(attrgetter("_ends"))

    def _take(self, count: int | None) -> None:
        """Let C see the first `count` environments, or all of them."""
        number = self._count if count is None else whole("count", count, 0, self._count, RangeError)
        self._taken = -1  # should Ctrl-C come before the last line
        self._native.count = number
        self._taken = count

    def _check(self, percepts: npt.NDArray[Any]) -> None:
        answer = self._domain.check_many(percepts)  # type: ignore[func-returns-value]
        if answer is not None:
            raise DomainError(
                f"check_many() returned {shown(answer)}, expected None: it raises PerceptError"
            )

    def __reduce__(self) -> tuple[Any, ...]:
        """Refuse to be pickled."""
        raise TypeError("a batch is not pickled: pickle the agent, and call its batch() again")

    def act(self, count: int | None = None) -> npt.NDArray[Any]:
        """Choose an action for each environment.

        Parameters
        ----------
        count : int or None
            Use only the first ``count`` environments. None: all.

        Returns
        -------
        ndarray of CHOICE, [count]
            ``choices``, with the fields ``action`` and ``exploited``, both uint8.

        Raises
        ------
        RangeError
            ``count`` is out of range.
        PerceptError
            A percept has an invalid value, such as NaN.
        BusyError
            The replay buffer is full and in use by a learning step.
        """
        if count is not self._taken:
            self._take(count)
        if self._checked:
            self._check(self._percepts[:count])
        status = self._act(self._agent._handle, self._log, self._stopped)
        if status:
            self._agent._fail(status, self._done.value)
        return self._choices if count is None else self._choices[:count]

    def observe(self, count: int | None = None) -> None:
        """Store an interaction for each environment.

        Parameters
        ----------
        count : int or None
            Use only the first ``count`` environments. None: all.

        Raises
        ------
        RewardError, RangeError
            A reward, an action or an end is out of range. The message names the interaction;
            nothing was stored.
        PerceptError
            A percept has an invalid value, such as NaN; nothing was stored.
        BusyError
            The replay buffer is full and in use by a learning step. Earlier interactions were
            stored.
        """
        if count is not self._taken:
            self._take(count)
        if self._checked:
            goes_on = self._ends[:count] != _native.TERMINATED
            self._check(self._percepts[:count])
            self._check(self._next_percepts[:count][goes_on])
        status = self._observe(self._agent._handle, self._log, self._stopped)
        if status:
            self._agent._fail(status, self._done.value)
