# SPDX-License-Identifier: MIT
"""Percepts of bits (section 6.1)."""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..checks import whole
from ..errors import DomainError, PerceptError
from .callbacks import Guard
from .domain import Domain, Percept

_UINT8 = np.dtype(np.uint8)
_BOOL = np.dtype(np.bool_)


class Bits(Domain):
    """Percepts of bits; a feature is the index of a bit (section 6.1).

    Parameters
    ----------
    bits : int
        Number of bits, [1, 1024].

    Raises
    ------
    ConfigError
        ``bits`` is out of range.

    Notes
    -----
    A percept is bool [bits], or packed: bytes or uint8 [ceil(bits / 8)], with bit i in bit i % 8 of
    byte i // 8 (bit 0 is the lowest). Source: ``core/include/rlvc/bits.h``.
    """

    def __init__(self, bits: int) -> None:
        bits = whole("bits", bits, 1, _native.BITS_MAX)
        super().__init__(np.uint8, ((bits + 7) // 8,), np.uint16, bits)
        self.bits = bits

    def exhibits(self, percept: npt.NDArray[Any], feature: Any) -> bool:
        """Whether the bit is 1."""
        record, bit = self.pack(percept), self._bit(feature)
        return bool(record[bit // 8] >> bit % 8 & 1)

    def candidates(self, percepts: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Return all bits, in order."""
        return np.arange(self.bits, dtype=np.uint16)

    def name(self, feature: Any) -> str:
        """Return ``bit`` and the index."""
        return f"bit {self._bit(feature)}"

    def _bit(self, feature: Any) -> int:
        return whole("feature", feature, 0, self.bits - 1, DomainError)

    def pack(self, percept: Percept) -> bytes:
        """Like :meth:`Domain.pack`, and also accepts bool [bits]."""
        if type(percept) is np.ndarray:
            if percept.dtype is _UINT8 and percept.shape == self.percept_shape:
                return percept.tobytes()
            if percept.dtype is _BOOL and percept.shape == (self.bits,):
                return np.packbits(percept, bitorder="little").tobytes()
        return super().pack(percept)

    def pack_many(self, percepts: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Like :meth:`Domain.pack_many`, and also accepts bool [n, bits]."""
        if isinstance(percepts, np.ndarray) and percepts.dtype == _BOOL:
            if percepts.ndim != 2 or percepts.shape[1] != self.bits:
                raise PerceptError(
                    f"percepts are bool{list(percepts.shape)}, expected bool[n, {self.bits}]"
                )
            return np.packbits(percepts, axis=1, bitorder="little")
        return super().pack_many(percepts)

    def native(self, guard: Guard) -> _native.Domain:
        """Return the library's domain, which calls no Python."""
        native = _native.Domain()
        _native.call.rlvc_bits_domain(self.bits, ctypes.byref(native))
        return native
