# SPDX-License-Identifier: MIT
"""What acts, learns and is saved, whatever its method."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Generic, TypeVar

from .. import _native
from ..checks import flag, shown, whole
from ..domains.callbacks import Guard
from ..domains.domain import Domain, Percept
from ..domains.packing import packing
from ..errors import Error, PerceptError, RangeError, ReenteredError, RewardError, SnapshotError
from .handle import Handle, allocated
from .results import Choice, Progress
from .snapshot import MemoryStore, read_file, write_file

_D = TypeVar("_D", bound=Domain)
_C = TypeVar("_C")
_Self = TypeVar("_Self", bound="Learner[Any, Any]")

_begin = _native.call.rlvc_begin
_act = _native.call.rlvc_act
_observe = _native.call.rlvc_observe
_byref = ctypes.byref
_new = tuple.__new__
_NOTHING = object()


class Learner(Handle, Generic[_D, _C]):
    """Base class of :class:`rlvc.Agent` and :class:`rlvc.Planner`."""

    _size: str  # the function that gives the size of its block
    _slice: int  # budget of a slice of learning, after which Ctrl-C is noticed: milliseconds
    _end_is_seen: bool  # s' is needed also where an episode terminated
    _config_type: type[_C]

    def __init__(self, domain: _D | int, config: _C | int, **changes: Any) -> None:
        if "_address" in self.__dict__:
            raise ReenteredError(f"the {self._noun} is initialized already")
        self._make(domain, config, changes, None)

    @staticmethod
    def _domain_of(domain: Any) -> Any:
        """Return the domain that a caller names."""
        raise NotImplementedError

    @staticmethod
    def _to_native(config: Any, domain: _native.Domain) -> _native.Config:
        """Make the C struct of a config and check it."""
        raise NotImplementedError

    def _make(
        self, domain: _D | int, config: _C | int, changes: dict[str, Any], snapshot: bytes | None
    ) -> None:
        """Allocate memory and make an agent in it: a new one, or that of a snapshot."""
        self._domain = made = self._domain_of(domain)
        kept: Any = config
        if not isinstance(kept, self._config_type):
            kept = self._config_type(actions=whole("actions", kept, 1, 255))  # type: ignore[call-arg]
        self._config: Any = kept.replace(**changes) if changes else kept
        self._guard = Guard()
        self._native_domain = made.native(self._guard)
        self._pack, self._pack_many, self._is_one = packing(made)
        self._native_config = self._to_native(self._config, self._native_domain)
        references = (_byref(self._native_config), _byref(self._native_domain))
        size = ctypes.c_size_t()
        self._check(getattr(_native.call, self._size)(*references, _byref(size)))
        what = f"{'an' if self._noun == 'agent' else 'a'} {self._noun}"
        self._block = allocated(size.value, what, "reduce capacity")
        agent = ctypes.c_void_p()
        place = (self._block.ctypes.data, size.value)
        if snapshot is None:
            status = _native.call.rlvc_agent_init(*references, *place, _byref(agent))
        else:
            store = MemoryStore(self._snapshot_bytes(), snapshot)  # owns what C reads
            reference = _byref(store.native)
            status = _native.long_call.rlvc_load(*references, *place, reference, _byref(agent))
            if status == _native.OK:
                self._guard.forget()  # a learning step that cannot go on is given up
        self._check(status)
        self._handle = self._address = agent.value
        self._memory_bytes = size.value
        self._action = ctypes.c_uint32()
        self._choice = _native.Choice()
        self._choice_reference = _byref(self._choice)
        self._chosen: object = _NOTHING  # the Choice that self._choice holds

    def _snapshot_bytes(self) -> int:
        size = ctypes.c_uint32()
        references = (_byref(self._native_config), _byref(self._native_domain))
        self._check(_native.call.rlvc_snapshot_size(*references, _byref(size)))
        return size.value

    @property
    def config(self) -> _C:
        """The config."""
        config: _C = self._config
        return config

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
            The percept has the wrong size, dtype or shape, or an element out of range.
        BusyError
            The replay buffer is full and in use by a learning step.
        """
        status = _begin(self._handle, self._pack(percept))
        if status:
            self._fail(status)

    def _act(self) -> Choice:
        """Choose an action for the current percept."""
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
            The action taken: the result of ``act``, or any other action.
        reward : float
            Finite, in [-1e12, 1e12].
        percept : bytes, ndarray or None
            s', the next current percept. Of an agent it may be None if ``terminated``.
        terminated : bool
            Whether the episode ended: no reward can follow.
        truncated : bool
            Whether the episode was cut short, for example by a time limit: s' still has a value.

        Raises
        ------
        PerceptError
            ``percept`` has the wrong size, dtype or shape, or an element out of range.
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
        if terminated.__class__ is not bool or truncated.__class__ is not bool:
            terminated = flag("terminated", terminated, RangeError)
            truncated = flag("truncated", truncated, RangeError)
        packed = None
        if percept is not None:
            packed = self._pack(percept)
        elif self._end_is_seen or not terminated:
            only = "" if self._end_is_seen else " but where the episode terminated"
            raise PerceptError(f"percept: None is not allowed{only}")
        try:
            status = _observe(
                self._handle,
                self._choice,
                reward,
                packed,
                1 if terminated else 2 if truncated else 0,
            )
        except ctypes.ArgumentError:
            raise RewardError(f"a reward must be a number, not {shown(reward)}") from None
        if status:
            self._fail(status)

    def _choose(self, choice: Any) -> None:
        """Write the action that the caller took to self._choice."""
        try:
            action, exploited = choice if isinstance(choice, tuple) else (choice, False)
            number = int(action.__index__())
        except Exception:
            raise RangeError(
                f"an action must be an int or the result of act(), not {shown(choice)}"
            ) from None
        if not 0 <= number < self._config.actions:
            raise RangeError(f"action {shown(number)} is not in [0, {self._config.actions})")
        self._chosen = _NOTHING
        self._choice.action = number
        self._choice.exploited = flag("exploited", exploited, RangeError)

    # -------------------------------------------------------------- learning

    def _learn(self, budget: int | None) -> Progress:
        """Do a learning step, or a part of one."""
        progress, least = _native.Progress(), self.budget_min
        portion, work = max(self._slice, least), 0
        if budget is not None:
            portion = whole("budget", budget, least, 2**32 - 1, RangeError)
        while True:
            self._check(self._long("rlvc_learn", portion, _byref(progress)))
            work += progress.work
            if progress.done or budget is not None:
                return Progress(work, progress.rounds, progress.splits, bool(progress.done))

    @property
    def budget_min(self) -> int:
        """The least budget of ``learn``: what cannot be divided."""
        least = ctypes.c_uint32()
        self._check(_native.call.rlvc_budget_min(self._handle, _byref(least)))
        return least.value

    # -------------------------------------------------------------- saving and loading

    def snapshot(self) -> bytes:
        """Return the complete state. Of an agent also in the middle of a learning step.

        Returns
        -------
        bytes
            The same on every machine. ``core/SPEC.md`` describes the format.

        Raises
        ------
        BusyError
            A planner's step of learning is under way: call ``learn`` until it is done.
        """
        store = MemoryStore(self._snapshot_bytes())
        self._check(self._long("rlvc_save", _byref(store.native)))
        return store.newest()

    @classmethod
    def restore(cls: type[_Self], domain: Any, config: Any, snapshot: bytes) -> _Self:
        """Make one from a snapshot. It continues exactly as the original would have.

        Parameters
        ----------
        domain : Domain or int
            The domain of the original.
        config : Config, PlannerConfig or int
            The config of the original, the same in every field.
        snapshot : bytes
            The result of :meth:`snapshot`.

        Returns
        -------
        Agent or Planner

        Raises
        ------
        SnapshotError
            It is corrupt, or has another version, config or domain.
        """
        if not isinstance(snapshot, bytes | bytearray | memoryview):
            raise SnapshotError(f"a snapshot is bytes, not {type(snapshot).__name__}")
        learner = cls.__new__(cls)
        learner._make(domain, config, {}, bytes(snapshot))
        return learner

    def save(self, file: str | Path, names: Sequence[str] = ()) -> None:
        """Write to a file, to learn on later. If that fails, an existing file stays as it was.

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
        BusyError
            As of :meth:`snapshot`.

        Notes
        -----
        The new file replaces the old one at once, when all of it is on the disk, and has its
        permissions. This also removes what a process that was killed while it saved to this file
        left in the folder. Memory is that of three snapshots.
        """
        write_file(file, self, names)

    @classmethod
    def load(cls: type[_Self], file: str | Path, domain: Domain | None = None) -> _Self:
        """Read what :meth:`save` wrote.

        Parameters
        ----------
        file : str or Path
        domain : Domain or None
            The domain of an agent. None if that is :class:`rlvc.Bags`, :class:`rlvc.Bits`,
            :class:`rlvc.Descriptors`, :class:`rlvc.Spatial` or :class:`rlvc.Thresholds`, which are
            in the file.

        Returns
        -------
        Agent or Planner

        Raises
        ------
        StoreError
            The file cannot be read.
        SnapshotError
            It is not such a file, is corrupt, or needs a domain.
        """
        kept, config, _, snapshot = read_file(file, cls._noun, cls._config_type)
        domain = kept if domain is None else domain
        if domain is None:
            raise SnapshotError(
                f"{file}: the {cls._noun} has a user-defined domain: pass it as domain"
            )
        try:
            return cls.restore(domain, config, snapshot)
        except Error as error:
            raise type(error)(f"{file}: {error}") from None

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle it; its domain must be one that can be pickled."""
        return type(self).restore, (self._domain, self._config, self.snapshot())
