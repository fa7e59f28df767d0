# SPDX-License-Identifier: MIT
"""What the domains that are implemented in C have in common."""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..errors import PerceptError
from .domain import Domain


class BuiltinDomain(Domain):
    """A ready-made domain whose callbacks are the library's, with parameters of its own."""

    parameters: tuple[Any, ...]
    _native: _native.Domain

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the parameters."""
        return type(self), self.parameters

    def exhibits(self, percept: npt.NDArray[Any], feature: Any) -> bool:
        """Whether a percept exhibits a feature, as the library says."""
        present = ctypes.c_uint8()
        record = np.ascontiguousarray(feature).tobytes()
        if self._native.exhibits(self._native.ctx, self.pack(percept), record, present):
            raise PerceptError("a percept that is none of the domain")
        return bool(present.value)

    def candidates(self, percepts: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """List the features that the library looks at first for such a class."""
        records = self.pack_many(percepts)
        pairs = np.zeros((len(records), 2), np.uint32)
        pairs[:, 1] = np.arange(len(records))
        samples = _native.Samples(
            records.ctypes.data, pairs.ctypes.data, self.percept_bytes, len(records)
        )
        found = np.zeros(_native.DETECT_FEATURES, self.feature_dtype)
        written = ctypes.c_uint32()
        if self._native.candidates(
            self._native.ctx, samples, 0, len(found), found.ctypes.data, written
        ):
            raise PerceptError("a percept that is none of the domain")
        return found[: written.value]

    def name(self, feature: Any) -> str:
        """Name a feature as the library does."""
        text = ctypes.create_string_buffer(_native.NAME_BYTES)
        record = np.ascontiguousarray(feature).tobytes()
        address = ctypes.cast(text, ctypes.c_void_p)
        self._native.name(self._native.ctx, record, address, _native.NAME_BYTES)
        return text.value.decode()
