# SPDX-License-Identifier: MIT
"""The planner: learns a small tree on real numbers, by searching in a learnt model of the world."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from .. import _native
from ..checks import whole
from ..domains.callbacks import Guard
from ..domains.domain import Percept
from ..domains.thresholds import Thresholds
from ..errors import Error, PerceptError, RangeError, ReenteredError, RewardError, SnapshotError
from .handle import Handle, allocated
from .planned_policy import PlannedPolicy
from .planner_config import PlannerConfig, to_native
from .planner_file import read_file, write_file
from .results import PlannerStatistics, Progress
from .snapshot import MemoryStore

_SLICE = 1 << 22  # budget of a slice of learning, after which Ctrl-C is noticed: milliseconds

_begin = _native.call.rlvc_planner_begin
_act = _native.call.rlvc_planner_act
_act_at = _native.call.rlvc_planner_act_at
_observe = _native.call.rlvc_planner_observe
_predict = _native.call.rlvc_planner_predict
_byref = ctypes.byref


class Planner(Handle):
    """Learns a small decision tree on real numbers from rewards alone.

    It fits a model of what each action changes, searches in that model for a small tree of tests
    x[i] > c that earns much, and lets the tree act for an episode. The real returns decide between
    the trees that were tried. It maximises the sum of the rewards of an episode, without a discount.

    Parameters
    ----------
    domain : Thresholds or int
        The percepts; an int is the number of components, [1, 64].
    config : PlannerConfig or int
        How to learn; an int is the number of actions, with the defaults for the rest.
    **changes
        Fields of the config to change.

    Raises
    ------
    ConfigError
        A field of the config is out of range, or the domain is not one of real numbers.
    BlockError
        There is not enough memory.

    Notes
    -----
    Use a planner from one thread at a time, as an :class:`rlvc.Agent`. A percept is float32
    [components], each element in [-1e9, 1e9]. Source: ``core/include/rlvc/planner.h``.

    Examples
    --------
    >>> import numpy as np
    >>> planner = Planner(1, 2, random=32)
    >>> random, x = np.random.default_rng(1), np.zeros(1, np.float32)
    >>> for _ in range(200):
    ...     planner.begin(x)
    ...     action = planner.act()
    ...     x, reward = random.random(1, np.float32), float((x[0] > 0.5) == action)
    ...     planner.observe(action, reward, x, terminated=True)
    ...     _ = planner.learn()
    >>> planner.statistics.episodes
    200
    """

    _noun = "planner"

    def __init__(
        self, domain: Thresholds | int, config: PlannerConfig | int, **changes: Any
    ) -> None:
        if "_address" in self.__dict__:
            raise ReenteredError("the planner is initialized already")
        self._create(domain, config, changes, None)

    def _create(
        self,
        domain: Thresholds | int,
        config: PlannerConfig | int,
        changes: dict[str, Any],
        snapshot: bytes | None,
    ) -> None:
        """Allocate memory and make a planner in it: a new one, or that of a snapshot."""
        if not isinstance(domain, Thresholds):
            domain = Thresholds(whole("domain", domain, 1, _native.PLANNER_COMPONENTS_MAX))
        if not isinstance(config, PlannerConfig):
            config = PlannerConfig(config)
        if changes:
            config = config.replace(**changes)
        native, size = to_native(config, domain.components), ctypes.c_size_t()
        self._native_planner = native
        self._guard = Guard()
        self._domain = self._thresholds = domain
        self._settings = config
        self._native_domain = domain.native(self._guard)
        self._pack, self._pack_many = domain.pack, domain.pack_many
        self._check(_native.call.rlvc_planner_size(_byref(native), _byref(size)))
        self._block = allocated(size.value, "a planner", "reduce capacity")
        planner = ctypes.c_void_p()
        place = (self._block.ctypes.data, size.value)
        if snapshot is None:
            status = _native.call.rlvc_planner_init(_byref(native), *place, _byref(planner))
        else:
            store = MemoryStore(self._snapshot_bytes(), snapshot)  # owns what C reads
            reference = _byref(store.native)
            status = _native.call.rlvc_planner_load(
                _byref(native), *place, reference, _byref(planner)
            )
        self._check(status)
        self._handle = self._address = planner.value
        self._memory_bytes = size.value
        self._action = ctypes.c_uint32()
        self._answer = _byref(self._action)

    # -------------------------------------------------------------- acting and observing

    def begin(self, percept: Percept) -> None:
        """Start an episode. An unfinished episode is cut off, and its return does not count.

        Parameters
        ----------
        percept : bytes or ndarray of float32, [components]
            The first percept. It is copied.

        Raises
        ------
        PerceptError
            The percept has the wrong size, dtype or shape, or an element out of range.
        BusyError
            The memory is full of what a model is being fitted to: finish the learning step.
        """
        self._check_percept(_begin(self._handle, self._pack(percept)))

    def act(self) -> int:
        """Choose an action for the current percept, by the policy that acts in this episode.

        Returns
        -------
        int

        Raises
        ------
        OrderError
            There is no current percept: call :meth:`begin` first.
        """
        status = _act(self._handle, self._answer)
        if status:
            self._fail(status)
        return self._action.value

    def act_at(self, percept: Percept) -> int:
        """Choose an action for any percept, by the policy that acts in the next episode.

        For episodes in several environments at once. Each is observed when it has ended, by
        :meth:`begin` and :meth:`observe`, before the next step of learning.

        Parameters
        ----------
        percept : bytes or ndarray of float32, [components]

        Returns
        -------
        int

        Raises
        ------
        PerceptError
            The percept has the wrong size, dtype or shape, or an element out of range.
        """
        self._check_percept(_act_at(self._handle, self._pack(percept), self._answer))
        return self._action.value

    def observe(
        self,
        action: int,
        reward: float,
        percept: Percept,
        terminated: bool = False,
        truncated: bool = False,
    ) -> None:
        """Store an interaction that started at the current percept.

        Parameters
        ----------
        action : int
            The action taken.
        reward : float
            Finite, in [-1e12, 1e12].
        percept : bytes or ndarray of float32, [components]
            s', the next current percept; needed also if ``terminated``.
        terminated : bool
            Whether the episode ended: no reward can follow.
        truncated : bool
            Whether the episode was cut short, for example by a time limit.

        Raises
        ------
        PerceptError
            The percept has the wrong size, dtype or shape, or an element out of range.
        RewardError
            ``reward`` is not a finite number in range.
        RangeError
            The action does not exist.
        OrderError
            There is no current percept.
        BusyError
            The memory is full of what a model is being fitted to: finish the learning step.
        """
        number = whole("action", action, 0, self._settings.actions - 1, RangeError)
        packed = self._pack(percept)
        try:
            status = _observe(
                self._handle, number, reward, packed, 1 if terminated else 2 if truncated else 0
            )
        except ValueError:
            raise RangeError("terminated and truncated must be True or False") from None
        except ctypes.ArgumentError:
            raise RewardError(f"a reward must be a number, not {reward!r:.80}") from None
        self._check_percept(status)

    def _check_percept(self, status: int, index: int | None = None) -> None:
        """Raise the error of a status; of the arguments in question only a percept can be wrong."""
        if status == _native.E_RANGE:
            where = "" if index is None else f"percept {index}: "
            raise PerceptError(f"{where}an element is beyond {_native.PLANNER_NUMBER_MAX:g}")
        if status:
            self._fail(status, index)

    def predict(self, percept: Percept) -> int | npt.NDArray[np.uint32]:
        """Return the action of the learnt policy at a percept, or at each percept of an array.

        Parameters
        ----------
        percept : bytes, or ndarray of float32, [components] or [n, components]
            One percept, or n percepts.

        Returns
        -------
        int or ndarray of uint32, [n]
            0 while nothing is learnt.

        Raises
        ------
        PerceptError
            A percept has the wrong size, dtype or shape, or an element out of range, or the array
            is not C-contiguous.
        """
        if self._domain.is_one(percept):
            self._check_percept(_predict(self._handle, self._pack(percept), self._answer))
            return self._action.value
        packed = self._pack_many(percept)
        actions, done = np.empty(len(packed), np.uint32), ctypes.c_size_t()
        status = self._long(
            "rlvc_shim_planner_predict",
            packed.ctypes.data,
            self._native_domain.percept_bytes,
            len(packed),
            actions.ctypes.data,
            _byref(done),
        )
        self._check_percept(status, done.value)
        return actions

    # -------------------------------------------------------------- learning

    def learn(self, budget: int | None = None) -> Progress:
        """Do a learning step, if an episode ended since the last: chooses the next episode's policy.

        Parameters
        ----------
        budget : int or None
            Maximum work of this call, in multiplications of floats, [``budget_min``, 2**32 - 1]; call
            again until the result is ``done``. None: do the whole step. Ctrl-C interrupts it.

        Returns
        -------
        Progress
            Its ``rounds`` and ``splits`` are 0.

        Raises
        ------
        RangeError
            ``budget`` is out of range.

        Notes
        -----
        What is learnt does not depend on the budgets. After Ctrl-C the next call continues where
        this one stopped. Other threads run meanwhile: the interpreter's lock is released.
        """
        progress = _native.Progress()
        portion, work = max(_SLICE, self.budget_min), 0
        if budget is not None:
            portion = whole("budget", budget, self.budget_min, 2**32 - 1, RangeError)
        while True:
            self._check(self._long("rlvc_planner_learn", portion, _byref(progress)))
            work += progress.work
            if progress.done or budget is not None:
                return Progress(work, 0, 0, bool(progress.done))

    @property
    def budget_min(self) -> int:
        """The least budget of :meth:`learn`: what cannot be divided."""
        least = ctypes.c_uint32()
        self._check(_native.call.rlvc_planner_budget_min(self._handle, _byref(least)))
        return least.value

    @property
    def statistics(self) -> PlannerStatistics:
        """Statistics of the planner."""
        native = _native.PlannerStatistics()
        self._check(_native.call.rlvc_planner_stats(self._handle, _byref(native)))
        return PlannerStatistics.of(native)

    @property
    def config(self) -> PlannerConfig:
        """The config of the planner."""
        return self._settings

    # -------------------------------------------------------------- deploying

    def policy(self) -> PlannedPolicy:
        """Make a policy of what was learnt: to print, export, save, and act without the planner.

        Returns
        -------
        PlannedPolicy
            It is independent of the planner.
        """
        native, nodes = _native.PlannerTest(), []
        for index in range(2 * self.statistics.leaves - 1):
            self._check(_native.call.rlvc_planner_node(self._handle, index, _byref(native)))
            nodes.append((native.cutpoint, native.component, native.child, native.action))
        return PlannedPolicy(self._thresholds, self._settings.actions, nodes)

    def print(self, form: Literal["text", "dot", "json"] = "text") -> str:
        """Return the tree of the learnt policy: see :meth:`rlvc.PlannedPolicy.print`."""
        return self.policy().print(form)

    def export_c(self, name: str = "policy") -> str:
        """Return the learnt policy as a C99 header: see :meth:`rlvc.PlannedPolicy.export_c`."""
        return self.policy().export_c(name)

    # -------------------------------------------------------------- snapshots

    def _snapshot_bytes(self) -> int:
        size = ctypes.c_uint32()
        self._check(
            _native.call.rlvc_planner_snapshot_size(_byref(self._native_planner), _byref(size))
        )
        return size.value

    def snapshot(self) -> bytes:
        """Return the complete state of the planner, between two steps of learning.

        Returns
        -------
        bytes
            The same on every machine. ``core/SPEC.md`` describes the format.

        Raises
        ------
        BusyError
            A step of learning is under way: call :meth:`learn` until it is done.
        """
        store = MemoryStore(self._snapshot_bytes())
        self._check(_native.call.rlvc_planner_save(self._handle, _byref(store.native)))
        return store.newest()

    @classmethod
    def restore(
        cls, domain: Thresholds | int, config: PlannerConfig | int, snapshot: bytes
    ) -> Planner:
        """Make a planner from a snapshot. It continues exactly as the original would have.

        Parameters
        ----------
        domain : Thresholds or int
            The domain of the original.
        config : PlannerConfig or int
            The config of the original, the same in every field.
        snapshot : bytes
            The result of :meth:`snapshot`.

        Returns
        -------
        Planner

        Raises
        ------
        SnapshotError
            It is corrupt, or has another version, config or domain.
        """
        if not isinstance(snapshot, bytes | bytearray | memoryview):
            raise SnapshotError(f"a snapshot is bytes, not {type(snapshot).__name__}")
        planner = cls.__new__(cls)
        planner._create(domain, config, {}, bytes(snapshot))
        return planner

    def save(self, file: str | Path, names: Sequence[str] = ()) -> None:
        """Write the planner to a file, to learn on later. A failure leaves the old file.

        Parameters
        ----------
        file : str or Path
        names : sequence of str
            Names of the components.

        Raises
        ------
        StoreError
            The file cannot be written, or is a link, a folder, a FIFO or a device.
        BusyError
            A step of learning is under way: call :meth:`learn` until it is done.
        """
        write_file(file, self, names)

    @classmethod
    def load(cls, file: str | Path) -> Planner:
        """Read a planner from a file that :meth:`save` wrote.

        Parameters
        ----------
        file : str or Path

        Returns
        -------
        Planner

        Raises
        ------
        StoreError
            The file cannot be read.
        SnapshotError
            It is not such a file, or is corrupt.
        """
        domain, config, _, snapshot = read_file(file)
        try:
            return cls.restore(domain, config, snapshot)
        except Error as error:
            raise type(error)(f"{file}: {error}") from None

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the planner."""
        return type(self).restore, (self._thresholds, self._settings, self.snapshot())

    def __repr__(self) -> str:
        """Describe the planner."""
        if self._handle is None:
            return "<rlvc.Planner, closed>" if self._address is None else "<rlvc.Planner, in use>"
        s = self.statistics
        return f"<rlvc.Planner of {s.leaves} leaves after {s.interactions} interactions>"
