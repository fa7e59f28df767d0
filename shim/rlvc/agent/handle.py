# SPDX-License-Identifier: MIT
"""What agents, planners and policies share: their memory, errors, printing, export and closing."""

from __future__ import annotations

import ctypes
import json
from types import TracebackType
from typing import Any, Literal, TypeVar

import numpy as np
import numpy.typing as npt

from .. import _native
from ..checks import one_of, shown
from ..domains.callbacks import Guard
from ..domains.domain import Domain
from ..errors import (
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

_ERRORS: dict[int, type[Error]] = {
    _native.E_CONFIG: ConfigError,
    _native.E_MEMORY: BlockError,
    _native.E_ORDER: OrderError,
    _native.E_RANGE: RangeError,
    _native.E_REWARD: RewardError,
    _native.E_BUSY: BusyError,
    _native.E_CALLBACK: CallbackError,
    _native.E_REENTERED: ReenteredError,
    _native.E_STORE: StoreError,
    _native.E_EMPTY: SnapshotError,
    _native.E_DAMAGED: SnapshotError,
    _native.E_VERSION: SnapshotError,
    _native.E_MISMATCH: SnapshotError,
    _native.E_PERCEPT: PerceptError,
}
# What a method of the domain makes a function return if it raises.
_FAILED_METHODS = (_native.E_CALLBACK, _native.E_MEMORY, _native.E_DAMAGED, _native.E_PERCEPT)
_TEXT_ROOM = 1 << 16  # bytes; a longer text is written once more
_WRITE = ctypes.cast(_native.call.rlvc_shim_text_write, _native.WRITE)
_byref = ctypes.byref
_Self = TypeVar("_Self", bound="Handle")


def allocated(size: int, what: str, hint: str) -> npt.NDArray[np.uint64]:
    """Allocate memory for the library, aligned to 8 bytes.

    Parameters
    ----------
    size : int
        In bytes.
    what, hint : str
        For the error: what needs the memory, and how to need less.

    Returns
    -------
    ndarray of uint64

    Raises
    ------
    BlockError
        There is not enough memory.
    """
    try:
        return np.empty(size // 8 + 1, np.uint64)
    except (MemoryError, ValueError):
        raise BlockError(f"not enough memory for {what} of {size} bytes: {hint}") from None


class Handle:
    """Base class of :class:`rlvc.Agent`, :class:`rlvc.Planner` and :class:`rlvc.Policy`."""

    _noun = "agent"
    _block: npt.NDArray[np.uint64] | None
    _guard: Guard
    _domain: Any
    _memory_bytes: int
    # None during a long call and after close(): C then returns RLVC_E_NULL.
    _handle: int | None
    _address: int | None
    _print, _export = "rlvc_print", "rlvc_export_c"

    # -------------------------------------------------------------- errors

    def _check(self, status: int, index: int | None = None) -> None:
        if status != _native.OK:
            self._fail(status, index)

    def _fail(self, status: int, index: int | None = None) -> None:
        if status in _FAILED_METHODS:
            self._guard.reraise()
        if status == _native.E_NULL:
            if getattr(self, "_address", 0) is None:
                raise ClosedError(f"the {self._noun} is closed")
            raise ReenteredError(
                f"the {self._noun} is in use: a callback or another thread called it"
            )
        text = _native.status_text(status)
        if index is not None:
            text = f"interaction {index}: {text}"
        raise _ERRORS.get(status, Error)(text)

    def _long(self, name: str, *arguments: Any) -> int:
        """Call a function without the interpreter's lock; the agent cannot be used meanwhile."""
        handle = self._handle
        if handle is None:
            self._fail(_native.E_NULL)
        try:
            self._handle = None
            return int(getattr(_native.long_call, name)(handle, *arguments))
        finally:
            self._handle = handle

    # -------------------------------------------------------------- printing and export

    @property
    def tree(self) -> dict[str, Any]:
        """The tree as data; ``core/SPEC.md`` ("JSON of the tree") describes it."""
        tree: dict[str, Any] = json.loads(self.print("json"))
        return tree

    def print(self, form: Literal["text", "dot", "json"] = "text") -> str:
        """Return the tree as text, with the action of each leaf; of an agent also its value and samples.

        Parameters
        ----------
        form : {"text", "dot", "json"}
            Indented text, a Graphviz digraph, or JSON as in ``core/SPEC.md``.

        Returns
        -------
        str

        Raises
        ------
        RangeError
            ``form`` is unknown.
        """
        forms = {"text": _native.PRINT_TEXT, "dot": _native.PRINT_DOT, "json": _native.PRINT_JSON}
        return self._written(self._print, forms[one_of("form", form, forms, RangeError)])

    def export_c(self, name: str = "policy") -> str:
        """Return the policy as a C99 header for a controller.

        Parameters
        ----------
        name : str
            A C identifier of at most 48 characters. The header defines ``NAME_act(percept)``.

        Returns
        -------
        str

        Raises
        ------
        RangeError
            ``name`` is not such an identifier.
        ConfigError
            The domain is not one of :class:`Bits`, :class:`Descriptors`, :class:`Spatial` and
            :class:`Thresholds`.

        Notes
        -----
        A percept of bits is packed as by the domain's ``pack``. A percept of descriptors is the
        record that ``pack`` returns or ``rlvc_extractor_extract`` fills, aligned to 4 bytes. A
        percept of thresholds is an array of float. Compiled with ``-ffp-contract=off``, the header
        gives the same action as ``predict`` for every percept. Source:
        ``core/include/rlvc/export.h``.
        """
        return self._written(self._export, self._identifier(name), None)

    @staticmethod
    def _identifier(name: str) -> bytes:
        """Encode the name of an exported policy; C checks that it is an identifier."""
        if not isinstance(name, str) or not name.isascii() or "\0" in name:
            raise RangeError(f"name: {shown(name)} is not a C identifier")
        return name.encode()

    def _written(self, name: str, what: Any, *rest: Any) -> str:
        """Return the output of a function of the library."""
        room = _TEXT_ROOM
        while True:
            buffer = np.empty(room, np.uint8)
            text = _native.ShimText(buffer.ctypes.data, room)
            self._check(self._long(name, what, _WRITE, _byref(text), *rest))
            if text.size <= room:
                return buffer[: text.size].tobytes().decode()
            room = text.size

    # -------------------------------------------------------------- closing

    def close(self) -> None:
        """Free the memory. Closing twice does nothing.

        Raises
        ------
        ReenteredError
            The agent is in use.
        """
        if self._address is None:
            return
        if self._handle is None or self._guard.inside:
            raise ReenteredError(f"the {self._noun} is in use: it cannot be closed")
        self._handle = self._address = None
        self._block = None

    def __enter__(self: _Self) -> _Self:
        """Return the object itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Close the object."""
        self.close()

    @property
    def domain(self) -> Domain:
        """The domain: percepts and features."""
        domain: Domain = self._domain
        return domain

    @property
    def memory_bytes(self) -> int:
        """Size of the memory, in bytes."""
        return self._memory_bytes
