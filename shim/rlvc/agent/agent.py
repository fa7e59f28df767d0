# SPDX-License-Identifier: MIT
"""The agent: reinforcement learning of classes (section 4.2.1) in one block of memory."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..domains.domain import Domain, Percept
from ..errors import RangeError, ReenteredError, RewardError, SnapshotError
from .batch import Batch, native_log
from .config import Config
from .inspect import Looking
from .policy import Policy
from .results import CHOICE, Choice, Progress
from .snapshot import MemoryStore, read_file, write_file

_SLICE = 1 << 20  # of learning, between two looks at Ctrl-C: some milliseconds

_begin = _native.call.rlvc_begin
_act = _native.call.rlvc_act
_observe = _native.call.rlvc_observe
_byref = ctypes.byref
_new = tuple.__new__
_NOTHING = object()


class Agent(Looking):
    """Learns a decision tree that says what to do, from nothing but rewards.

    Parameters
    ----------
    domain : Domain or int
        What percepts and features are; a number means :class:`Bits` of so many bits.
    config : Config or int
        How to learn; a number means ``Config(actions=number)``.
    **changes
        Fields of the config to be changed.

    Raises
    ------
    ConfigError
        A field of the config or of the domain is out of range; the text names it.
    BlockError
        There is no memory for such an agent.

    Notes
    -----
    An agent is used by one thread at a time; a call while another one is under way raises
    :class:`ReenteredError`. After ``close``, each raises :class:`ClosedError`.

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
            raise ReenteredError("an agent is made once")
        self._make(domain, config, changes, None)

    def _make(self, *arguments: Any) -> None:
        """Make an agent, and what C reads choices from."""
        super()._make(*arguments)
        self._choice = _native.Choice()
        self._choice_reference = _byref(self._choice)
        self._chosen: object = _NOTHING  # the Choice that self._choice says

    # -------------------------------------------------------------- acting and observing

    def begin(self, percept: Percept) -> None:
        """Start an episode. One under way is torn, as if its last interaction had been truncated.

        Parameters
        ----------
        percept : bytes or ndarray
            The first of the episode; see the domain's ``pack``. It is copied.

        Raises
        ------
        PerceptError
            It is of the wrong size, dtype or shape.
        BusyError
            The ring is full of what is being learnt from.
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
            There is no current percept.
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
        """Store an interaction whose s is the current percept.

        Parameters
        ----------
        choice : Choice or int
            What was done: what ``act`` returned, or an action of one's own choice.
        reward : float
            Finite, within +-1e12.
        percept : bytes, ndarray or None
            s', the next current percept. None is allowed if ``terminated``.
        terminated : bool
            The episode is over by its own rules: nothing is to be had after it.
        truncated : bool
            It was cut short from outside: s' is still worth something.

        Raises
        ------
        PerceptError
            ``percept`` is of the wrong size, dtype or shape.
        RewardError
            ``reward`` is no finite number in range.
        RangeError
            There is no such action.
        OrderError
            There is no current percept.
        BusyError
            The ring is full of what is being learnt from.
        """
        if choice is not self._chosen:
            self._choose(choice)
        packed = None if percept is None else self._pack(percept)
        try:
            status = _observe(
                self._handle,
                self._choice,
                reward,
                packed,
                1 if terminated else 2 if truncated else 0,
            )
        except ctypes.ArgumentError:
            raise RewardError(f"a reward is a number, not {reward!r:.80}") from None
        if status:
            self._fail(status)

    def _choose(self, choice: Any) -> None:
        """Make self._choice say what the caller did."""
        try:
            action, exploited = choice if isinstance(choice, tuple) else (choice, False)
            number = int(action.__index__())
        except (AttributeError, TypeError, ValueError):
            raise RangeError(
                f"an action is a number, or what act() returned, not {choice!r:.80}"
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
            The current percept of each.

        Returns
        -------
        ndarray of CHOICE, [n]
            Its fields are ``action`` and ``exploited``, both uint8.

        Notes
        -----
        What ``begin`` and ``act`` do for one. Hand the result to ``observe_many``. Runs of exploitation
        go across the environments, so that this suits the residual criterion and not the returns.

        Raises
        ------
        PerceptError
            Wrong dtype or shape, or not C-contiguous.
        """
        packed = self._domain.pack_many(percepts)
        count = len(packed)
        choices = np.empty(count, CHOICE)
        native = _native.ShimLog(packed.ctypes.data, None, choices.ctypes.data)
        native.count, native.bytes = count, self._domain.percept_bytes
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
        """Store many interactions: one of each environment of a vector, or a log.

        Parameters
        ----------
        percepts, next_percepts : ndarray, [n, *percept_shape]
            s and s'. Where an interaction goes on and the next one's s equals its s', they are of one
            episode.
        choices : ndarray of CHOICE, [n]
            What was done.
        rewards : ndarray of float32, [n]
            Finite, within +-1e12.
        ends : ndarray of uint8, [n]
            0: goes on; 1: terminated; 2: truncated.
        resume : bool
            Whether the first one goes on from the current percept; otherwise it begins an episode.

        Raises
        ------
        ArrayError
            Wrong dtype or shape, or not C-contiguous.
        RewardError, RangeError
            The text says which interaction; nothing was stored.
        BusyError
            The ring is full of what is being learnt from; what came before it was stored.
        """
        arrays = (percepts, choices, rewards, next_percepts, ends)
        native = native_log(self._domain, self._config.actions, *arrays)
        native.resume = bool(resume)
        self._loop("rlvc_shim_observe", native)

    def _loop(self, name: str, native: _native.ShimLog) -> None:
        """Call a loop over interactions; its errors say at which one it stopped."""
        done = ctypes.c_size_t()
        status = self._long(name, _byref(native), _byref(done))
        if status:
            self._fail(status, done.value)

    def batch(self, count: int) -> Batch:
        """Make the arrays for a vector of environments: the fastest way to act and observe in many.

        Parameters
        ----------
        count : int
            The most environments.

        Returns
        -------
        Batch

        Raises
        ------
        RangeError
            ``count`` is not 1 or more.
        """
        return Batch(self, count)

    # -------------------------------------------------------------- learning

    def learn(self, budget: int | None = None) -> Progress:
        """Do a learning step: refine every aliased class, then solve for the values (section 4.2.1).

        Parameters
        ----------
        budget : int or None
            Samples to look at in this call, [64, 2**32 - 1]; call again until the result says
            ``done``. None: the whole step, in slices between which Ctrl-C is looked at.

        Returns
        -------
        Progress

        Raises
        ------
        RangeError
            ``budget`` is out of range.

        Notes
        -----
        What was done before a callback's exception, or before Ctrl-C, stands: the next call goes on
        from there. The interpreter's lock is released.
        """
        progress = _native.Progress()
        work = 0
        while True:
            portion = _SLICE if budget is None else budget
            if not isinstance(portion, int) or not _native.BUDGET_MIN <= portion < 2**32:
                raise RangeError(f"budget: {portion!r} is not in [{_native.BUDGET_MIN}, 2**32 - 1]")
            self._check(self._long("rlvc_learn", portion, _byref(progress)))
            work += progress.work
            if progress.done or budget is not None:
                return Progress(work, progress.rounds, progress.splits, bool(progress.done))

    def prune(self, tolerance: float = 0.0, deviations: float = 0.0) -> int:
        """Take tests out of the tree that the stored interactions do not support (section 7).

        Parameters
        ----------
        tolerance : float
            The two sides of a test agree if they act alike, and the Q of each action differ by no more
            than this, in units of return,
        deviations : float
            or than so many standard errors of the difference.

        Returns
        -------
        int
            How many splits were undone.

        Raises
        ------
        RangeError
            A number is out of range.
        BusyError
            A learning step is under way.

        Notes
        -----
        No greedy action changes. The next ``learn`` splits again what it finds to differ. Source:
        ``rlvc_prune`` in ``core/include/rlvc/agent.h``.
        """
        undone = ctypes.c_uint32()
        try:
            status = self._long("rlvc_prune", tolerance, deviations, _byref(undone))
        except ctypes.ArgumentError:
            raise RangeError("tolerance and deviations are numbers") from None
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
        """Make the smallest policy that acts as well as the agent at all percepts in its ring.

        Parameters
        ----------
        tolerance : float or None
            An action is as good as the agent's if it was tried and its Q is no more than this below, in
            units of return. 0: just the agent's action. None: twice the tolerance of the config, which
            the solver cannot tell from nothing.
        percepts : int or None
            Distinct ones that there is room for, by the features that the tree tests. None: 16384, or as
            many as the ring holds.
        entries : int or None
            Of the table in which subsets of percepts are kept. None: 65536.
        effort : int or None
            Words that may be looked at, about. None: 2**26, some seconds at worst.

        Returns
        -------
        Policy
            Its ``info`` says how many leaves there were, and are, and whether fewer are possible.

        Raises
        ------
        RangeError, ConfigError
            A number is out of range.
        BlockError
            There is no memory for it.

        Notes
        -----
        The agent is unchanged. After a learning step by the criterion of returns the ring is empty: let
        more interactions come first. Source: ``core/include/rlvc/policy.h``.
        """
        return Policy(self, tolerance=tolerance, percepts=percepts, entries=entries, effort=effort)

    # -------------------------------------------------------------- outliving the process

    def snapshot(self) -> bytes:
        """Give all that decides the agent's future, a learning step under way included.

        Returns
        -------
        bytes
            The same on every machine; ``core/SPEC.md`` says what is in it.
        """
        store = MemoryStore(self._snapshot_bytes())
        self._check(self._long("rlvc_save", _byref(store.native)))
        return store.newest()

    @classmethod
    def restore(cls, domain: Domain | int, config: Config | int, snapshot: bytes) -> Agent:
        """Make an agent out of a snapshot, which goes on as if it had never stopped.

        Parameters
        ----------
        domain : Domain or int
            As it was.
        config : Config or int
            As it was, in every field.
        snapshot : bytes
            What :meth:`snapshot` gave.

        Returns
        -------
        Agent

        Raises
        ------
        SnapshotError
            It is damaged, of another version, or of another config or domain.
        """
        agent = cls.__new__(cls)
        agent._make(domain, config, {}, bytes(snapshot))
        return agent

    def save(self, file: str | Path, names: Sequence[str] = ()) -> None:
        """Write the agent to a file, which is there as a whole or as it was before.

        Parameters
        ----------
        file : str or Path
        names : sequence of str
            What each bit says, for ``python -m rlvc show``.

        Raises
        ------
        StoreError
            The file cannot be written.
        """
        write_file(file, self, names)

    @classmethod
    def load(cls, file: str | Path, domain: Domain | None = None) -> Agent:
        """Read an agent from a file that :meth:`save` wrote.

        Parameters
        ----------
        file : str or Path
        domain : Domain or None
            As it was; None if it was :class:`Bits`, :class:`Descriptors` or
            :class:`Thresholds`.

        Returns
        -------
        Agent

        Raises
        ------
        StoreError
            The file cannot be read.
        SnapshotError
            It is no such file, is damaged, or needs a domain.
        """
        kept, config, _, snapshot = read_file(file)
        domain = kept if domain is None else domain
        if domain is None:
            raise SnapshotError(f"{file}: its agent has a domain of its own: give it")
        try:
            return cls.restore(domain, config, snapshot)
        except SnapshotError as error:
            raise SnapshotError(f"{file}: {error}") from None

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the agent; its domain must be one that can be pickled."""
        return type(self).restore, (self._domain, self._config, self.snapshot())
