# SPDX-License-Identifier: MIT
"""The agent: reinforcement learning of classes (section 4.2.1)."""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..checks import flag
from ..domains.bits import Bits
from ..domains.domain import Domain
from ..errors import RangeError
from .batch import Batch, native_log
from .config import Config, to_native
from .handle import allocated
from .inspect import Queries
from .policy import Policy
from .results import CHOICE, Choice, Progress

_byref = ctypes.byref


class Agent(Queries):
    """Learns a decision tree from rewards alone: it maps percepts to classes, and classes to actions.

    Parameters
    ----------
    domain : Domain or int
        The percepts and features; an int is the number of bits of :class:`Bits`.
    config : Config or int
        How to learn; an int is the number of actions, with the defaults for the rest.
    **changes
        Fields of the config to change.

    Raises
    ------
    ConfigError
        A field of the config or the domain is out of range. The message names it.
    BlockError
        There is not enough memory.

    Notes
    -----
    Use an agent from one thread at a time: a call during another call raises
    :class:`~rlvc.errors.ReenteredError`. After :meth:`close` every call raises
    :class:`~rlvc.errors.ClosedError`.

    Examples
    --------
    >>> agent = Agent(3, 2)
    >>> agent.begin(bytes([5]))
    >>> choice = agent.act()
    >>> agent.observe(choice, 1.0, None, terminated=True)
    >>> agent.learn().done
    True
    """

    _size = "rlvc_agent_size"
    _slice = 1 << 20
    _end_is_seen = False
    _config_type = Config

    @staticmethod
    def _domain_of(domain: Domain | int) -> Domain:
        return domain if isinstance(domain, Domain) else Bits(domain)

    _to_native = staticmethod(to_native)

    # -------------------------------------------------------------- acting and observing

    def act(self) -> Choice:
        """Choose an action for the current percept: epsilon-greedy, in runs (section 4.2.1).

        Returns
        -------
        Choice
            (action, exploited)

        Raises
        ------
        OrderError
            There is no current percept: call :meth:`begin` first.
        """
        return self._act()

    def act_many(self, percepts: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Choose an action for each environment of a vector.

        Parameters
        ----------
        percepts : ndarray, [n, *percept_shape]
            The current percept of each environment.

        Returns
        -------
        ndarray of CHOICE, [n]
            Fields ``action`` and ``exploited``, both uint8. Pass it to :meth:`observe_many`.

        Raises
        ------
        PerceptError
            The array has the wrong dtype or shape, or is not C-contiguous.

        Notes
        -----
        Use the residual criterion with vectors: runs of exploitation mix the environments, which
        the criterion of returns cannot use.
        """
        packed = self._pack_many(percepts)
        count = len(packed)
        choices = np.empty(count, CHOICE)
        native = _native.ShimLog(packed.ctypes.data, None, choices.ctypes.data)
        native.count, native.bytes = count, self._native_domain.percept_bytes
        self._loop("rlvc_shim_act", native)
        return choices

    def observe_many(
        self,
        percepts: npt.NDArray[Any],
        choices: npt.NDArray[Any],
        rewards: npt.NDArray[np.float32],
        next_percepts: npt.NDArray[Any],
        ends: npt.NDArray[np.uint8],
        resume: bool = False,
    ) -> None:
        """Store many interactions: one for each environment of a vector, or a log.

        Parameters
        ----------
        percepts, next_percepts : ndarray, [n, *percept_shape]
            s and s'. Two successive interactions belong to one episode if the first has ``ends`` 0
            and its s' equals the s of the second.
        choices : ndarray of CHOICE, [n]
            The actions taken.
        rewards : ndarray of float32, [n]
            Finite, in [-1e12, 1e12].
        ends : ndarray of uint8, [n]
            0: the episode goes on; 1: terminated; 2: truncated.
        resume : bool
            Whether the first interaction continues from the current percept; else it begins an
            episode.

        Raises
        ------
        ArrayError
            An array has the wrong dtype or shape, or is not C-contiguous.
        RewardError, RangeError
            A value is out of range. The message names the interaction; nothing was stored.
        BusyError
            The replay buffer is full and in use by a learning step. Earlier interactions were
            stored.
        """
        before, after = self._pack_many(percepts), self._pack_many(next_percepts)
        size = self._native_domain.percept_bytes
        arrays = (before, choices, rewards, after, ends)
        native = native_log(size, self._config.actions, *arrays)
        native.resume = flag("resume", resume, RangeError)
        self._loop("rlvc_shim_observe", native)

    def _loop(self, name: str, native: _native.ShimLog) -> None:
        """Call a loop over interactions; errors name the interaction where it stopped."""
        done = ctypes.c_size_t()
        status = self._long(name, _byref(native), _byref(done))
        if status:
            self._fail(status, done.value)

    def batch(self, count: int) -> Batch:
        """Make the arrays for a vector of environments: the fastest way to act and observe in many.

        Parameters
        ----------
        count : int
            Maximum number of environments.

        Returns
        -------
        Batch

        Raises
        ------
        RangeError
            ``count`` is less than 1.
        """
        return Batch(self, count)

    # -------------------------------------------------------------- learning

    def learn(self, budget: int | None = None) -> Progress:
        """Do a learning step: refine every aliased class, then solve for the values (section 4.2.1).

        Parameters
        ----------
        budget : int or None
            Maximum work of this call, in samples, [64, 2**32 - 1]; call again until the result is
            ``done``. None: do the whole step. Ctrl-C interrupts it.

        Returns
        -------
        Progress

        Raises
        ------
        RangeError
            ``budget`` is out of range.

        Notes
        -----
        After an exception of a callback or Ctrl-C, the next call continues where this one stopped.
        Other threads run meanwhile: the interpreter's lock is released.
        """
        return self._learn(budget)

    @property
    def successors(self) -> bool:
        """Whether classes are also split by what follows: ``config.successors``, or its default."""
        return bool(self._native_config.successors)

    def learn_counts(self, counts: _native.Counts) -> Progress:
        """Do a round of a learning step from counts (``core/include/rlvc/counts.h``).

        Parameters
        ----------
        counts : rlvc_counts
            Of :meth:`rlvc.counts.part.Part.native`. Call it until the result is ``done``, or the tree
            tests a feature that no bit of a cell tells.

        Returns
        -------
        Progress

        Raises
        ------
        ConfigError
            The agent's criterion, solver, score or domain needs more than counts.
        RangeError
            The counts contradict each other, or are more than 2**48 - 1.
        """
        size = ctypes.c_size_t()
        self._check(self._long("rlvc_counts_size", _byref(counts), _byref(size)))
        memory = allocated(size.value, "counts", "round the rewards")
        progress = _native.Progress()
        self._check(
            self._long(
                "rlvc_learn_counts",
                _byref(counts),
                memory.ctypes.data,
                size.value,
                _byref(progress),
            )
        )
        return Progress(progress.work, progress.rounds, progress.splits, bool(progress.done))

    def abandon(self) -> None:
        """Give up a learning step that is under way; the next :meth:`learn` begins another.

        For a step that cannot be finished, since a method of the domain goes on raising, or for one
        that was interrupted while interactions go on. Splits made so far stay.

        Raises
        ------
        ReenteredError
            The agent is in a call.

        Notes
        -----
        After a :meth:`learn` that raised, :meth:`begin` and :meth:`observe` do the same where they
        would otherwise raise BusyError. Time is O(capacity + classes).
        """
        self._check(self._long("rlvc_learn_abandon"))

    def prune(self, tolerance: float = 0.0, deviations: float = 0.0) -> int:
        """Remove tests that the stored interactions do not support (section 7).

        A test is removed if both sides have the same greedy action, and for each action their Q
        differ by at most ``tolerance`` or by at most ``deviations`` standard errors of the
        difference.

        Parameters
        ----------
        tolerance : float
            In units of return, at least 0.
        deviations : float
            In standard errors, at least 0.

        Returns
        -------
        int
            Number of splits removed.

        Raises
        ------
        RangeError
            A number is out of range.
        BusyError
            A learning step is not finished.

        Notes
        -----
        No greedy action changes. The next :meth:`learn` may split the same classes again. Source:
        ``rlvc_prune`` in ``core/include/rlvc/agent.h``.
        """
        undone = ctypes.c_uint32()
        try:
            status = self._long("rlvc_prune", tolerance, deviations, _byref(undone))
        except ctypes.ArgumentError:
            raise RangeError("tolerance and deviations must be numbers") from None
        self._check(status)
        return undone.value

    # -------------------------------------------------------------- deploying

    def compact(
        self,
        tolerance: float | None = None,
        *,
        percepts: int | None = None,
        entries: int | None = None,
        effort: int | None = None,
    ) -> Policy:
        """Make the smallest policy that is worth as much as the agent's.

        It takes the agent's action, or one that is as good, on all percepts in the replay buffer.

        Parameters
        ----------
        tolerance : float or None
            What may be lost: of no class does the value fall by more than this share of the spread
            of Q, its largest less its smallest, [0, 1]. None: 0, nothing.
        percepts : int or None
            Maximum number of percepts that differ in the features of the tree. None: 16384, or the
            capacity of the replay buffer if that is less.
        entries : int or None
            Size of the table of subsets of percepts. None: 65536.
        effort : int or None
            Approximate limit of the work, in machine words read. None: 2**26, a few seconds at
            most.

        Returns
        -------
        Policy
            Its ``info`` has the leaves and the value before and after, and whether that is the minimum.

        Raises
        ------
        RangeError, ConfigError
            A number is out of range.
        BlockError
            There is not enough memory.

        Notes
        -----
        The agent is unchanged. With the criterion of returns the replay buffer is empty after a
        learning step: collect interactions first. Source: ``core/include/rlvc/policy.h``.
        """
        return Policy(self, tolerance=tolerance, percepts=percepts, entries=entries, effort=effort)
