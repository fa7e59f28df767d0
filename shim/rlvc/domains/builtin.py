# SPDX-License-Identifier: MIT
"""What the domains of the library have in common."""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..checks import array, shown
from ..errors import ConfigError, DomainError, PerceptError
from .callbacks import Guard
from .domain import Domain


class BuiltinDomain(Domain):
    """A domain of the library: its callbacks are in C."""

    parameters: tuple[Any, ...]
    _function: str  # of the library: makes the domain from its parameters
    _made: ctypes.Structure  # the parameters as a C struct
    _domain: _native.Domain

    def _build(self, made: ctypes.Structure) -> None:
        """Make the C domain, which this object keeps alive."""
        self._made = made
        self._domain = _native.Domain()
        function = getattr(_native.call, self._function)
        status = function(ctypes.byref(made), ctypes.byref(self._domain))
        if status != _native.OK:
            name = type(self).__name__.lower()
            raise ConfigError(f"{name}: {_native.status_text(status)}")

    def native(self, guard: Guard) -> _native.Domain:
        """Return the library's domain, which calls no Python."""
        self._domain._keeps = self._made
        return self._domain

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the parameters only."""
        return type(self), self.parameters

    def _record(self, feature: Any) -> bytes:
        """Return the bytes of a feature."""
        value = array("feature", feature, DomainError)
        if value.dtype != self.feature_dtype or value.shape != ():
            raise DomainError(f"{shown(feature)} is not a feature of {type(self).__name__}")
        return value.tobytes()

    def exhibits(self, percept: npt.NDArray[Any], feature: Any) -> bool:
        """Whether a percept exhibits a feature."""
        present = ctypes.c_uint8()
        record = self._record(feature)
        if self._domain.exhibits(self._domain.ctx, self.pack(percept), record, present):
            raise PerceptError("the percept is not valid in this domain")
        return bool(present.value)

    def candidates(self, percepts: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Return the first candidates of the library's search for a class with these percepts."""
        records = self.pack_many(percepts)
        if len(records) == 0:
            return np.zeros(0, self.feature_dtype)
        pairs = np.zeros((len(records), 2), np.uint32)
        pairs[:, 1] = np.arange(len(records))
        samples = _native.Samples(
            records.ctypes.data, pairs.ctypes.data, self.percept_bytes, len(records)
        )
        found = np.zeros(_native.DETECT_FEATURES, self.feature_dtype)
        written = ctypes.c_uint32()
        if self._domain.candidates(
            self._domain.ctx, samples, 0, len(found), found.ctypes.data, written
        ):
            raise PerceptError("the percept is not valid in this domain")
        return found[: written.value]

    def name(self, feature: Any) -> str:
        """Return the name of a feature."""
        text = ctypes.create_string_buffer(_native.NAME_BYTES)
        record = self._record(feature)
        address = ctypes.cast(text, ctypes.c_void_p)
        self._domain.name(self._domain.ctx, record, address, _native.NAME_BYTES)
        return text.value.decode()
