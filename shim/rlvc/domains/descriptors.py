# SPDX-License-Identifier: MIT
"""Percepts of local descriptors (sections 3 and 6.2)."""

from __future__ import annotations

import ctypes
import sys
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from .. import _native
from ..errors import ConfigError, PerceptError
from .builtin import BuiltinDomain
from .callbacks import Guard
from .domain import Percept


class Descriptors(BuiltinDomain):
    """Percepts that are the vectors found at a picture's interest points (sections 3 and 6.2).

    A feature is a vector with a radius; a percept exhibits it if the nearest of its vectors is at most
    the radius away.

    Parameters
    ----------
    points : int
        The most vectors of a percept, [1, 1000].
    dimensions : int
        Numbers of a vector, [1, 256].
    radius : float
        tau, in units of the percept's numbers, (0, 1e15].
    form : {"float", "int8"}
        How the numbers are kept: as float32 or as int8.
    candidates : int
        The most features looked at for one class, [1, 65535].
    draws : int
        A candidate is the best of so many vectors by the margin rule, [1, 64].
    margin : float
        m, [1, 16]: each feature has a radius of its own in [tau / m, m tau]; 1: all have tau.

    Raises
    ------
    ConfigError
        A parameter is out of range.

    Notes
    -----
    A percept is given as an array of float32 or int8 [n, dimensions], n at most ``points``, or as its
    record, which :meth:`pack` makes; arrays of percepts are arrays of records, uint8
    [n, percept_bytes]. Source: ``core/include/rlvc/descriptors.h``.
    """

    def __init__(
        self,
        points: int,
        dimensions: int,
        radius: float,
        form: Literal["float", "int8"] = "float",
        candidates: int = 64,
        draws: int = 8,
        margin: float = 1.8,
    ) -> None:
        self.parameters = (points, dimensions, radius, form, candidates, draws, margin)
        if form not in ("float", "int8"):
            raise ConfigError(f"form: {form!r} is none of float, int8")
        self._made = _native.Descriptors(
            points, dimensions, candidates, draws, radius, margin, int(form == "int8")
        )
        self._native = _native.Domain()
        status = _native.call.rlvc_descriptors_domain(
            ctypes.byref(self._made), ctypes.byref(self._native)
        )
        if status != _native.OK:
            raise ConfigError(f"descriptors: {_native.status_text(status)}")
        self.vector_dtype = np.dtype(np.int8 if form == "int8" else np.float32)
        self.points, self.dimensions = points, dimensions
        vector = (self.vector_dtype, (dimensions,))
        padding = self._native.feature_bytes - 4 - self.vector_dtype.itemsize * dimensions
        feature = [("radius", np.float32), ("vector", *vector), ("padding", np.uint8, (padding,))]
        super().__init__(
            np.uint8, (self._native.percept_bytes,), feature, self._native.features_max
        )

    def pack(self, percept: Percept) -> bytes:
        """Give the record of a percept: also from an array [n, dimensions] of its vectors."""
        if isinstance(percept, np.ndarray) and percept.ndim == 2:
            if percept.dtype != self.vector_dtype or percept.shape[1] != self.dimensions:
                raise PerceptError(
                    f"a percept of {percept.dtype}{list(percept.shape)}, not "
                    f"{self.vector_dtype}['n', {self.dimensions}]"
                )
            if len(percept) > self.points:
                raise PerceptError(
                    f"a percept of {len(percept)} vectors, not {self.points} at most"
                )
            if not np.isfinite(percept).all():
                raise PerceptError("a percept has a number in it that is not finite")
            record = len(percept).to_bytes(4, sys.byteorder) + percept.tobytes()
            return record.ljust(self.percept_bytes, b"\0")
        record = super().pack(percept)
        if int.from_bytes(record[:4], sys.byteorder) > self.points:
            raise PerceptError(f"a percept of more than {self.points} vectors")
        return record

    def pack_many(self, percepts: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Like :meth:`Domain.pack_many`, of records; their counts are looked at."""
        packed = super().pack_many(percepts)
        if (packed[:, :4].copy().view(np.uint32) > self.points).any():
            raise PerceptError(f"a percept of more than {self.points} vectors")
        return packed

    def is_one(self, percept: Any) -> bool:
        """Whether this is one percept: vectors or a record, and not an array of records."""
        return isinstance(percept, bytes) or not (
            np.ndim(percept) == 2 and getattr(percept, "dtype", None) == np.uint8
        )

    def native(self, guard: Guard) -> _native.Domain:
        """The library's own domain, which calls no Python."""
        native = _native.Domain()
        _native.call.rlvc_descriptors_domain(ctypes.byref(self._made), ctypes.byref(native))
        native._keeps = self._made
        return native
