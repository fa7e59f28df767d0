# SPDX-License-Identifier: MIT
"""The agent: reinforcement learning of classes (section 4.2.1)."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..checks import whole
from ..domains.domain import Domain, Percept
from ..errors import Error, PerceptError, RangeError, ReenteredError, RewardError, SnapshotError
from .batch import Batch, native_log
from .config import Config
from .handle import allocated
from .inspect import Queries
from .policy import Policy
from .results import CHOICE, Choice, Progress
from .snapshot import MemoryStore, read_file, write_file

_SLICE = 1 << 20  # budget of a slice of learning, after which Ctrl-C is noticed: milliseconds

_begin = _native.call.rlvc_begin
_act = _native.call.rlvc_act
_observe = _native.call.rlvc_observe
_byref = ctypes.byref
_new = tuple.__new__
_NOTHING = object()


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

    def __init__(self, domain: Domain | int, config: Config | int, **changes: Any) -> None:
        if "_address" in self.__dict__:
            raise ReenteredError("the agent is initialized already")
        self._make(domain, config, changes, None)

    def _make(self, *arguments: Any) -> None:
        """Make the agent, and the struct through which C reads choices."""
        super()._make(*arguments)
        self._choice = _native.Choice()
        self._choice_reference = _byref(self._choice)
        self._chosen: object = _NOTHING  # the Choice that self._choice holds

    # -------------------------------------------------------------- acting and observing

    def begin(self, percept: Percept) -> None:
        """Start an episode. An unfinished episode ends as if its last interaction had been truncated.

        Parameters
        ----------
        percept : bytes or ndarray
            The first percept, in a form that the domain's ``pack`` accepts. It is copied.

        Raises
        ------
        PerceptError
            The percept has the wrong size, dtype or shape.
        BusyError
            The replay buffer is full and in use by a learning step.
        """
        status = _begin(self._handle, self._pack(percept))
        if status:
            self._fail(status)

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
        choice = self._choice
        self._chosen = _NOTHING  # should Ctrl-C come between the call and the next line
        status = _act(self._handle, self._choice_reference)
        if status:
            self._fail(status)
        chosen = self._chosen = _new(Choice, (choice.action, choice.exploited == 1))
        return chosen

    def observe(
        self,
        choice: Choice | tuple[int, bool] | int,
        reward: float,
        percept: Percept | None,
        terminated: bool = False,
        truncated: bool = False,
    ) -> None:
        """Store an interaction that started at the current percept.

        Parameters
        ----------
        choice : Choice or int
            The action taken: the result of :meth:`act`, or any other action.
        reward : float
            Finite, in [-1e12, 1e12].
        percept : bytes, ndarray or None
            s', the next current percept. May be None if ``terminated``.
        terminated : bool
            Whether the episode ended: no reward can follow.
        truncated : bool
            Whether the episode was cut short, for example by a time limit: s' still has a value.

        Raises
        ------
        PerceptError
            ``percept`` has the wrong size, dtype or shape.
        RewardError
            ``reward`` is not a finite number in range.
        RangeError
            The action does not exist.
        OrderError
            There is no current percept.
        BusyError
            The replay buffer is full and in use by a learning step.
        """
        if choice is not self._chosen:
            self._choose(choice)
        packed = None
        if percept is not None:
            packed = self._pack(percept)
        elif not terminated:
            raise PerceptError("percept: None is only allowed if the episode terminated")
        try:
            status = _observe(
                self._handle,
                self._choice,
                reward,
                packed,
                1 if terminated else 2 if truncated else 0,
            )
        except ValueError:
            raise RangeError("terminated and truncated must be True or False") from None
        except ctypes.ArgumentError:
            raise RewardError(f"a reward must be a number, not {reward!r:.80}") from None
        if status:
            self._fail(status)

    def _choose(self, choice: Any) -> None:
        """Write the action that the caller took to self._choice."""
        try:
            action, exploited = choice if isinstance(choice, tuple) else (choice, False)
            number = int(action.__index__())
        except (AttributeError, TypeError, ValueError):
            raise RangeError(
                f"an action must be an int or the result of act(), not {choice!r:.80}"
            ) from None
        if not 0 <= number < self._config.actions:
            raise RangeError(f"action {number} is not in [0, {self._config.actions})")
        self._chosen = _NOTHING
        self._choice.action = number
        self._choice.exploited = bool(exploited)

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
        native.resume = bool(resume)
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
        progress = _native.Progress()
        portion, work = _SLICE, 0
        if budget is not None:
            portion = whole("budget", budget, _native.BUDGET_MIN, 2**32 - 1, RangeError)
        while True:
            self._check(self._long("rlvc_learn", portion, _byref(progress)))
            work += progress.work
            if progress.done or budget is not None:
                return Progress(work, progress.rounds, progress.splits, bool(progress.done))

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

    # -------------------------------------------------------------- saving and loading

    def snapshot(self) -> bytes:
        """Return the complete state of the agent, also in the middle of a learning step.

        Returns
        -------
        bytes
            The same on every machine. ``core/SPEC.md`` describes the format.
        """
        store = MemoryStore(self._snapshot_bytes())
        self._check(self._long("rlvc_save", _byref(store.native)))
        return store.newest()

    @classmethod
    def restore(cls, domain: Domain | int, config: Config | int, snapshot: bytes) -> Agent:
        """Make an agent from a snapshot. It continues exactly as the original would have.

        Parameters
        ----------
        domain : Domain or int
            The domain of the original.
        config : Config or int
            The config of the original, the same in every field.
        snapshot : bytes
            The result of :meth:`snapshot`.

        Returns
        -------
        Agent

        Raises
        ------
        SnapshotError
            It is corrupt, or has another version, config or domain.
        """
        if not isinstance(snapshot, bytes | bytearray | memoryview):
            raise SnapshotError(f"a snapshot is bytes, not {type(snapshot).__name__}")
        agent = cls.__new__(cls)
        agent._make(domain, config, {}, bytes(snapshot))
        return agent

    def save(self, file: str | Path, names: Sequence[str] = ()) -> None:
        """Write the agent to a file. If that fails, an existing file stays as it was.

        Parameters
        ----------
        file : str or Path
        names : sequence of str
            Names of the bits or components, for ``python -m rlvc show``.

        Raises
        ------
        StoreError
            The file cannot be written, or is a link, a folder, a FIFO or a device.
        ConfigError
            ``names`` is not a list of str.

        Notes
        -----
        The new file replaces the old one at once, when all of it is on the disk, and has its
        permissions. This also removes what a process that was killed while it saved to this file
        left in the folder. Time is O(capacity + classes); memory is that of three snapshots.
        """
        write_file(file, self, names)

    @classmethod
    def load(cls, file: str | Path, domain: Domain | None = None) -> Agent:
        """Read an agent from a file that :meth:`save` wrote.

        Parameters
        ----------
        file : str or Path
        domain : Domain or None
            The domain of the agent. None if that is :class:`Bits`, :class:`Descriptors`,
            :class:`Spatial` or :class:`Thresholds`, which are in the file.

        Returns
        -------
        Agent

        Raises
        ------
        StoreError
            The file cannot be read.
        SnapshotError
            It is not such a file, is corrupt, or needs a domain.
        """
        kept, config, _, snapshot = read_file(file)
        domain = kept if domain is None else domain
        if domain is None:
            raise SnapshotError(f"{file}: the agent has a user-defined domain: pass it as domain")
        try:
            return cls.restore(domain, config, snapshot)
        except Error as error:
            raise type(error)(f"{file}: {error}") from None

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the agent; its domain must be one that can be pickled."""
        return type(self).restore, (self._domain, self._config, self.snapshot())
