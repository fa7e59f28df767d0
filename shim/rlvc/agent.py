# SPDX-License-Identifier: MIT
"""The agent: reinforcement learning of classes (section 4.2.1) in one block of memory."""

from __future__ import annotations

import ctypes
import dataclasses
import json
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _lib
from .config import Config, to_native
from .domain import Bits, Domain, Guard, Percept
from .errors import (
    ArrayError,
    BlockError,
    BusyError,
    CallbackError,
    ClosedError,
    ConfigError,
    Error,
    OrderError,
    PerceptError,
    RangeError,
    ReenteredError,
    RewardError,
    SnapshotError,
    StoreError,
)
from .snapshot import MemoryStore, read_file, write_file

_ERRORS: dict[int, type[Error]] = {
    _lib.E_CONFIG: ConfigError,
    _lib.E_MEMORY: BlockError,
    _lib.E_ORDER: OrderError,
    _lib.E_RANGE: RangeError,
    _lib.E_REWARD: RewardError,
    _lib.E_BUSY: BusyError,
    _lib.E_CALLBACK: CallbackError,
    _lib.E_REENTERED: ReenteredError,
    _lib.E_STORE: StoreError,
    _lib.E_EMPTY: SnapshotError,
    _lib.E_DAMAGED: SnapshotError,
    _lib.E_VERSION: SnapshotError,
    _lib.E_MISMATCH: SnapshotError,
}

CHOICE = np.dtype([("action", np.uint8), ("exploited", np.uint8)])
"""Of the arrays of choices: ``rlvc_choice``."""

_SLICE = 1 << 20  # of learning, between two looks at Ctrl-C: some milliseconds

_begin = _lib.call.rlvc_begin
_act = _lib.call.rlvc_act
_observe = _lib.call.rlvc_observe
_predict = _lib.call.rlvc_predict
_byref = ctypes.byref
_new = tuple.__new__
_NOTHING = object()

_DTYPES = {name: np.dtype(name) for name in ("float32", "uint8", "uint32", "bool")}


class Choice(NamedTuple):
    """What was done, and why.

    Attributes
    ----------
    action : int
        [0, actions).
    exploited : bool
        Whether it is the greedy action of the agent's policy, chosen because it is.
    """

    action: int
    exploited: bool


class Prediction(NamedTuple):
    """The class of a percept and its greedy action.

    Attributes
    ----------
    class_id : int, or ndarray of uint32 [n]
    action : int, or ndarray of uint32 [n]
    """

    class_id: Any
    action: Any


class Progress(NamedTuple):
    """How far a learning step is.

    Attributes
    ----------
    work : int
        Samples looked at by this call.
    rounds : int
        Rounds of refinement begun in this step so far.
    splits : int
        Splits made in this step so far.
    done : bool
        Whether the step is finished.
    """

    work: int
    rounds: int
    splits: int
    done: bool


@dataclasses.dataclass(frozen=True)
class Statistics:
    """Numbers about an agent.

    Attributes
    ----------
    interactions : int
        Observed since the agent was made.
    stored : int
        Of these, still in the ring.
    step : int
        k: learning steps finished.
    classes : int
        Leaves of the tree.
    depth : int
        Tests on its longest path.
    last_split : int
        The step k at which the newest split was made; 0 if none.
    refused : int
        Splits that proved real but found the tree full.
    sweeps : int
        Of the last solution.
    residual : float
        Of the last solution, in units of reward: max |V_new - V_old| of its last sweep.
    """

    interactions: int
    stored: int
    step: int
    classes: int
    depth: int
    last_split: int
    refused: int
    sweeps: int
    residual: float


@dataclasses.dataclass(frozen=True)
class Split:
    """One split of the tree: percepts with the feature got a new class.

    Attributes
    ----------
    index : int
        j: its place in the order of splits. The new class is j + 1.
    class_id : int
        The class that was split; it keeps the percepts without the feature.
    feature : scalar of the domain's feature_dtype
    name : str
        The feature's name.
    step : int
        k at that time.
    action : int or None
        Whose targets betrayed the aliasing; None if those of all actions did together.
    samples : int
        Of that class and action, or of the class.
    log_tests, score, log_p : float
        ln of the number of tests corrected for; the score; ln of the corrected p-value.
    """

    index: int
    class_id: int
    feature: Any
    name: str
    step: int
    action: int | None
    samples: int
    log_tests: float
    score: float
    log_p: float


def _checked(array: Any, name: str, dtype: str, shape: tuple[int, ...]) -> npt.NDArray[Any]:
    """Make sure that an array is what C takes it for."""
    if not isinstance(array, np.ndarray):
        raise ArrayError(f"{name}: an array is wanted, not {type(array).__name__}")
    if array.dtype != _DTYPES[dtype] or array.shape != shape:
        raise ArrayError(f"{name}: {array.dtype}{list(array.shape)}, not {dtype}{list(shape)}")
    if not array.flags.c_contiguous:
        raise ArrayError(f"{name}: not C-contiguous: numpy.ascontiguousarray makes it so")
    return array


class Agent:
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

    def _make(
        self,
        domain: Domain | int,
        config: Config | int,
        changes: dict[str, Any],
        snapshot: bytes | None,
    ) -> None:
        if isinstance(domain, int):
            domain = Bits(domain)
        if isinstance(config, int):
            config = Config(actions=config)
        if changes:
            try:
                config = config.replace(**changes)
            except TypeError as error:
                raise ConfigError(f"no such field: {error}") from None
        self._domain = domain
        self._config = config
        self._guard = Guard()
        self._pack = domain.pack
        self._native_domain = domain.native(self._guard)
        self._native_config = to_native(config, self._native_domain)
        references = (_byref(self._native_config), _byref(self._native_domain))
        size = ctypes.c_size_t()
        self._check(_lib.call.rlvc_agent_size(*references, _byref(size)))
        try:
            self._block: npt.NDArray[np.uint64] | None = np.empty(size.value // 8 + 1, np.uint64)
        except (MemoryError, ValueError):
            raise BlockError(
                f"no memory for an agent of {size.value} bytes: allow fewer with capacity or classes"
            ) from None
        agent = ctypes.c_void_p()
        place = (self._block.ctypes.data, size.value)
        if snapshot is None:
            status = _lib.call.rlvc_agent_init(*references, *place, _byref(agent))
        else:
            store = MemoryStore(self._snapshot_bytes(), snapshot)
            reference = _byref(store.native)
            status = _lib.long_call.rlvc_load(*references, *place, reference, _byref(agent))
        self._check(status)
        # None while a long call is under way, and after close(): C then answers RLVC_E_NULL.
        self._handle: int | None = agent.value
        self._address = agent.value
        self._memory_bytes = size.value
        self._choice = _lib.Choice()
        self._choice_reference = _byref(self._choice)
        self._chosen: object = _NOTHING  # the Choice that self._choice says
        self._class = ctypes.c_uint32()
        self._action = ctypes.c_uint32()
        self._answers = (_byref(self._class), _byref(self._action))

    # -------------------------------------------------------------- errors, the end

    def _check(self, status: int, index: int | None = None) -> None:
        if status != _lib.OK:
            self._fail(status, index)

    def _fail(self, status: int, index: int | None = None) -> None:
        error, self._guard.error = self._guard.error, None
        if error is not None:
            raise error
        if status == _lib.E_NULL:
            if getattr(self, "_address", 0) is None:
                raise ClosedError("the agent is closed")
            if self._handle is None:
                raise ReenteredError("the agent is in a call: of a callback, or of another thread")
            raise PerceptError("a percept is wanted unless the episode is terminated")
        text = _lib.status_text(status)
        if index is not None:
            text = f"interaction {index}: {text}"
        raise _ERRORS.get(status, Error)(text)

    def _long(self, name: str, *arguments: Any) -> int:
        """Call a function that releases the interpreter's lock; the agent is not to be had meanwhile."""
        handle = self._handle
        if handle is None:
            self._fail(_lib.E_NULL)
        try:
            self._handle = None
            return int(getattr(_lib.long_call, name)(handle, *arguments))
        finally:
            self._handle = handle

    def close(self) -> None:
        """Give the agent's memory back. Closing twice does nothing.

        Raises
        ------
        ReenteredError
            The agent is in a call.
        """
        if self._address is None:
            return
        if self._handle is None or self._guard.depth > 0:
            raise ReenteredError("the agent is in a call: it cannot be closed")
        self._handle = self._address = None
        self._block = None

    def __enter__(self) -> Agent:
        """Give the agent itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Close the agent."""
        self.close()

    def __repr__(self) -> str:
        """Say what it is."""
        if self._handle is None:
            return "<rlvc.Agent, closed>" if self._address is None else "<rlvc.Agent, in a call>"
        s = self.statistics
        return f"<rlvc.Agent of {s.classes} classes after {s.interactions} interactions>"

    @property
    def domain(self) -> Domain:
        """What percepts and features are."""
        return self._domain

    @property
    def config(self) -> Config:
        """How it learns."""
        return self._config

    @property
    def memory_bytes(self) -> int:
        """The size of the agent's block, in bytes."""
        return self._memory_bytes

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
        done = ctypes.c_size_t()
        self._chosen = _NOTHING
        status = self._long(
            "rlvc_shim_act",
            packed.ctypes.data,
            self._domain.percept_bytes,
            count,
            choices.ctypes.data,
            _byref(done),
        )
        if status:
            self._fail(status, done.value)
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
        domain = self._domain
        packed = domain.pack_many(percepts)
        count = len(packed)
        following = domain.pack_many(next_percepts)
        if len(following) != count:
            raise ArrayError(f"next_percepts: {len(following)} of them, not {count}")
        if (
            not isinstance(choices, np.ndarray)
            or choices.dtype != CHOICE
            or choices.shape != (count,)
        ):
            raise ArrayError(f"choices: not an array of CHOICE [{count}]")
        if not choices.flags.c_contiguous:
            raise ArrayError("choices: not C-contiguous: numpy.ascontiguousarray makes it so")
        shape = (count,)
        rewards = _checked(rewards, "rewards", "float32", shape)
        ends = _checked(ends, "ends", "uint8", shape)
        log = _lib.Log(
            packed.ctypes.data,
            following.ctypes.data,
            choices.ctypes.data,
            rewards.ctypes.data,
            ends.ctypes.data,
            count,
            domain.percept_bytes,
            self._config.actions,
        )
        done = ctypes.c_size_t()
        status = self._long("rlvc_shim_observe", _byref(log), resume, _byref(done))
        if status:
            self._fail(status, done.value)

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
        progress = _lib.Progress()
        work = 0
        while True:
            portion = _SLICE if budget is None else budget
            if not isinstance(portion, int) or not _lib.BUDGET_MIN <= portion < 2**32:
                raise RangeError(f"budget: {portion!r} is not in [{_lib.BUDGET_MIN}, 2**32 - 1]")
            self._check(self._long("rlvc_learn", portion, _byref(progress)))
            work += progress.work
            if progress.done or budget is not None:
                return Progress(work, progress.rounds, progress.splits, bool(progress.done))

    # -------------------------------------------------------------- asking

    def predict(
        self,
        percept: Percept,
        out: tuple[npt.NDArray[np.uint32] | None, npt.NDArray[np.uint32] | None] | None = None,
    ) -> Prediction:
        """Give the class of a percept and its greedy action, or those of an array of percepts.

        Parameters
        ----------
        percept : bytes, or ndarray [*percept_shape] or [n, *percept_shape]
            One percept, or n of them.
        out : pair of ndarray of uint32, [n], or None
            For n percepts, where to write the classes and the actions; a None in it leaves that out.

        Returns
        -------
        Prediction
            (class_id, action), numbers or arrays.

        Raises
        ------
        PerceptError
            Wrong size, dtype or shape, or not C-contiguous.
        ArrayError
            ``out`` is of the wrong dtype or shape, not C-contiguous, or read-only.
        """
        if not self._domain.is_one(percept):
            return self._predict_many(percept, out)
        status = _predict(self._handle, self._pack(percept), *self._answers)
        if status:
            self._fail(status)
        return Prediction(self._class.value, self._action.value)

    def _predict_many(self, percepts: Any, out: Any) -> Prediction:
        packed = self._domain.pack_many(percepts)
        count = len(packed)
        if out is None:
            out = (np.empty(count, np.uint32), np.empty(count, np.uint32))
        elif not isinstance(out, tuple) or len(out) != 2:
            raise ArrayError("out: a pair of arrays is wanted")
        pointers: list[int | None] = []
        for array in out:
            if array is not None and not _checked(array, "out", "uint32", (count,)).flags.writeable:
                raise ArrayError("out: read-only")
            pointers.append(None if array is None else array.ctypes.data)
        done = ctypes.c_size_t()
        status = self._long(
            "rlvc_shim_predict",
            packed.ctypes.data,
            self._domain.percept_bytes,
            count,
            *pointers,
            _byref(done),
        )
        if status:
            self._fail(status, done.value)
        return Prediction(*out)

    @property
    def statistics(self) -> Statistics:
        """Numbers about the agent."""
        native = _lib.Statistics()
        self._check(_lib.call.rlvc_stats(self._handle, _byref(native)))
        return Statistics(
            *(getattr(native, field.name) for field in dataclasses.fields(Statistics))
        )

    @property
    def classes(self) -> int:
        """How many classes the tree tells apart."""
        return self.statistics.classes

    def _tables(self) -> tuple[npt.NDArray[Any], ...]:
        classes, actions = self.classes, self._config.actions
        tables: tuple[npt.NDArray[Any], ...] = (
            np.empty((classes, actions), np.float32),
            np.empty((classes, actions), np.uint32),
            np.empty(classes, np.float32),
            np.empty(classes, np.uint32),
        )
        pointers = (table.ctypes.data for table in tables)
        self._check(self._long("rlvc_shim_tables", classes, actions, *pointers))
        return tables

    @property
    def q(self) -> npt.NDArray[np.float32]:
        """Q(class, action) of the last solution, float32 [classes, actions], in units of return."""
        return self._tables()[0]

    @property
    def samples(self) -> npt.NDArray[np.uint32]:
        """How many interactions each Q rests on, uint32 [classes, actions]; 0: untried."""
        return self._tables()[1]

    @property
    def values(self) -> npt.NDArray[np.float32]:
        """V(class) of the last solution, float32 [classes], in units of return."""
        return self._tables()[2]

    @property
    def policy(self) -> npt.NDArray[np.uint32]:
        """The greedy action of each class, uint32 [classes]."""
        return self._tables()[3]

    @property
    def splits(self) -> list[Split]:
        """The splits of the tree, in the order in which they were made."""
        native = _lib.Split()
        record = ctypes.create_string_buffer(self._domain.feature_bytes)
        splits = []
        for index in range(self.classes - 1):
            status = _lib.call.rlvc_split_at(self._handle, index, _byref(native), record)
            self._check(status)
            feature = self._domain.feature(record.raw)
            action = None if native.action == self._config.actions else native.action
            splits.append(
                Split(
                    index,
                    native.class_id,
                    feature,
                    self._domain.name(feature),
                    native.step,
                    action,
                    native.samples,
                    native.log_tests,
                    native.score,
                    native.log_p,
                )
            )
        return splits

    @property
    def tree(self) -> dict[str, Any]:
        """The tree as data: ``core/SPEC.md`` ("JSON of the tree") gives its form."""
        tree: dict[str, Any] = json.loads(self.print("json"))
        return tree

    def print(self, form: Literal["text", "dot", "json"] = "text") -> str:
        """Print the tree with the action, value and numbers of each class.

        Parameters
        ----------
        form : {"text", "dot", "json"}
            Indented text, a Graphviz digraph, or the JSON of ``core/SPEC.md``.

        Returns
        -------
        str

        Raises
        ------
        RangeError
            There is no such form.
        """
        forms = {"text": _lib.PRINT_TEXT, "dot": _lib.PRINT_DOT, "json": _lib.PRINT_JSON}
        if form not in forms:
            raise RangeError(f"form: {form!r} is none of {', '.join(forms)}")
        parts: list[bytes] = []
        self._check(self._long("rlvc_print", forms[form], self._writer(parts), None))
        return b"".join(parts).decode()

    def _writer(self, parts: list[bytes]) -> Any:
        """Make a callback that appends what the library writes."""
        guard = self._guard

        def write(_ctx: int | None, text: int, size: int) -> int:
            try:
                parts.append(ctypes.string_at(text, size))
            except BaseException as error:  # out of memory, or Ctrl-C
                guard.error = error
                return 1
            return 0

        return _lib.WRITE(write)

    def export_c(self, name: str = "policy") -> str:
        """Give the learnt policy as a C99 header for a controller that only acts.

        Parameters
        ----------
        name : str
            A C identifier of at most 48 characters; ``NAME_act(percept)`` is the function to call.

        Returns
        -------
        str

        Raises
        ------
        RangeError
            ``name`` is no such identifier.
        ConfigError
            The domain is not :class:`Bits`.

        Notes
        -----
        Source: ``core/include/rlvc/export.h``.
        """
        encoded = name.encode()
        parts: list[bytes] = []
        write = self._writer(parts)
        self._check(self._long("rlvc_export_c", encoded, write, None, None))
        return b"".join(parts).decode()

    # -------------------------------------------------------------- outliving the process

    def _snapshot_bytes(self) -> int:
        size = ctypes.c_uint32()
        references = (_byref(self._native_config), _byref(self._native_domain))
        self._check(_lib.call.rlvc_snapshot_size(*references, _byref(size)))
        return size.value

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
            As it was; None if it was :class:`Bits`.

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
        bits, config, _, snapshot = read_file(file)
        if domain is None:
            if bits is None:
                raise SnapshotError(f"{file}: its agent has a domain of its own: give it")
            domain = Bits(bits)
        try:
            return cls.restore(domain, config, snapshot)
        except SnapshotError as error:
            raise SnapshotError(f"{file}: {error}") from None

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the agent; its domain must be one that can be pickled."""
        return type(self).restore, (self._domain, self._config, self.snapshot())

    def check(self) -> None:
        """Check every invariant of the agent's memory, which ``core/SPEC.md`` lists.

        Raises
        ------
        BlockError
            The memory is damaged.
        """
        self._check(self._long("rlvc_agent_check"))
