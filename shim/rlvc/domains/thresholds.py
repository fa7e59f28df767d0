# SPDX-License-Identifier: MIT
"""Percepts of real numbers."""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..errors import ConfigError, PerceptError
from .builtin import BuiltinDomain
from .callbacks import Guard
from .domain import Percept


class Thresholds(BuiltinDomain):
    """Percepts that are vectors of real numbers; a feature asks whether one lies above a cutpoint.

    Parameters
    ----------
    components : int
        Numbers of a percept, [1, 1024].
    cutpoints : int
        At most so many for each component, at quantiles of the class's own values, [1, 65535]; 0: every
        midpoint between neighbouring values, for small classes.
    oblique : bool
        Whether features may also weigh two components against each other, x[i] + w x[j] > c; of at most
        64 components.

    Raises
    ------
    ConfigError
        A parameter is out of range.

    Notes
    -----
    A percept is given as float32 [components], each number finite and at most 1e15 in absolute value:
    anything else, such as a NaN, is refused here, before the library sees it. A feature has the fields
    ``cutpoint``, ``slope``, ``component`` and ``other``. Source: ``core/include/rlvc/thresholds.h``.
    """

    def __init__(self, components: int, cutpoints: int = 15, oblique: bool = False) -> None:
        self.parameters = (components, cutpoints, oblique)
        self._made = _native.Thresholds(components, cutpoints, oblique)
        self._native = _native.Domain()
        status = _native.call.rlvc_thresholds_domain(
            ctypes.byref(self._made), ctypes.byref(self._native)
        )
        if status != _native.OK:
            raise ConfigError(f"thresholds: {_native.status_text(status)}")
        self.components = components
        super().__init__(
            np.float32, (components,), np.dtype(_native.Threshold), self._native.features_max
        )

    def pack(self, percept: Percept) -> bytes:
        """Like :meth:`Domain.pack`; the numbers are looked at."""
        record = super().pack(percept)
        self._look_at(np.frombuffer(record, np.float32))
        return record

    def pack_many(self, percepts: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Like :meth:`Domain.pack_many`; the numbers are looked at."""
        packed = super().pack_many(percepts)
        self._look_at(packed)
        return packed

    @staticmethod
    def _look_at(numbers: npt.NDArray[Any]) -> None:
        if not (np.abs(numbers) <= _native.THRESHOLDS_NUMBER_MAX).all():  # neither is a NaN
            raise PerceptError("a percept has a number in it that is a NaN, or beyond 1e15")

    def native(self, guard: Guard) -> _native.Domain:
        """The library's own domain, which calls no Python."""
        native = _native.Domain()
        _native.call.rlvc_thresholds_domain(ctypes.byref(self._made), ctypes.byref(native))
        native._keeps = self._made
        return native
