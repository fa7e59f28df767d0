# SPDX-License-Identifier: MIT
"""Percepts of real numbers."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..checks import flag, shown, whole
from ..errors import DomainError, PerceptError
from .builtin import BuiltinDomain
from .domain import Percept

# Field by field: of a struct of ctypes numpy makes it in Python, and drops a Ctrl-C that strikes then.
_FEATURE = np.dtype(
    [("cutpoint", np.float32), ("slope", np.float32), ("component", np.uint16), ("other", np.uint16)]
)


class Thresholds(BuiltinDomain):
    """Percepts of real numbers; a feature is a test x[i] > c.

    Parameters
    ----------
    components : int
        Length of a percept, [1, 1024].
    cutpoints : int
        Maximum number of cutpoints c for each component, at quantiles of the class's values, [1,
        65535]. 0: every midpoint between neighbouring values.
    oblique : bool
        Whether to also use oblique tests x[i] + w x[j] > c; needs at most 64 components.

    Raises
    ------
    ConfigError
        A parameter is out of range.

    Notes
    -----
    A percept is float32 [components], each element in [-1e15, 1e15]; others, such as NaN, raise
    :class:`~rlvc.errors.PerceptError`. A feature has the fields ``cutpoint``, ``slope``,
    ``component`` and ``other``. Source: ``core/include/rlvc/thresholds.h``.
    """

    _function = "rlvc_thresholds_domain"

    def __init__(self, components: int, cutpoints: int = 15, oblique: bool = False) -> None:
        components = whole("components", components, 1, _native.THRESHOLDS_COMPONENTS_MAX)
        cutpoints = whole("cutpoints", cutpoints, 0, _native.THRESHOLDS_CUTPOINTS_MAX)
        oblique = flag("oblique", oblique)
        self.parameters = (components, cutpoints, oblique)
        self._build(_native.Thresholds(components, cutpoints, oblique))
        self.components = components
        super().__init__(
            np.float32, (components,), _FEATURE, self._domain.features_max
        )

    def pack(self, percept: Percept) -> bytes:
        """Like :meth:`Domain.pack`; also checks the range of the elements."""
        record = super().pack(percept)
        self.check_many(np.frombuffer(record, np.float32))
        return record

    def pack_many(self, percepts: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Like :meth:`Domain.pack_many`; also checks the range of the elements."""
        packed = super().pack_many(percepts)
        self.check_many(packed)
        return packed

    def _record(self, feature: Any) -> bytes:
        record = super()._record(feature)
        if max(int(feature["component"]), int(feature["other"])) >= self.components:
            raise DomainError(f"{shown(feature)} tests a component that there is not")
        return record

    def check_many(self, packed: npt.NDArray[Any]) -> None:
        """Check the range of the elements."""
        if not (np.abs(packed) <= _native.THRESHOLDS_NUMBER_MAX).all():  # neither is a NaN
            raise PerceptError("a percept has an element that is NaN or beyond 1e15")
