# SPDX-License-Identifier: MIT
"""Percepts of local descriptors (sections 3 and 6.2)."""

from __future__ import annotations

import ctypes
import sys
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from .. import _native
from ..checks import array, one_of, real, whole
from ..errors import ConfigError, PerceptError
from .builtin import BuiltinDomain
from .domain import Percept


class Descriptors(BuiltinDomain):
    """Percepts of local descriptors: the vectors at a picture's interest points (sections 3 and 6.2).

    A feature is a vector with a radius. A percept exhibits it if one of the percept's vectors is
    within the radius.

    Parameters
    ----------
    points : int
        Maximum number of vectors in a percept, [1, 1000].
    dimensions : int
        Length of a vector, [1, 256].
    radius : float
        tau, in units of the vectors' elements, (0, 1e15].
    form : {"float", "int8"}
        Type of the vectors' elements: float32 or int8.
    candidates : int
        Maximum number of candidate features for one class, [1, 65535].
    draws : int
        Each candidate is the best of this many random vectors by the margin rule, [1, 64].
    margin : float
        m, [1, 16]: each feature has its own radius in [tau / m, m tau]; 1: all have radius tau.

    Raises
    ------
    ConfigError
        A parameter is out of range.

    Notes
    -----
    A percept is float32 or int8 [n, dimensions], with n at most ``points``, or the bytes that
    :meth:`pack` returns. An array of percepts is uint8 [n, percept_bytes]. Source:
    ``core/include/rlvc/descriptors.h``.
    """

    _function = "rlvc_descriptors_domain"

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
        points = whole("points", points, 1, _native.DESCRIPTORS_POINTS_MAX)
        dimensions = whole("dimensions", dimensions, 1, _native.DESCRIPTORS_DIMENSIONS_MAX)
        candidates = whole("candidates", candidates, 1, _native.DESCRIPTORS_CANDIDATES_MAX)
        draws = whole("draws", draws, 1, _native.DESCRIPTORS_DRAWS_MAX)
        radius, margin = real("radius", radius), real("margin", margin)
        if not 0.0 < radius <= 1e15:
            raise ConfigError(f"radius: {radius} is not in (0, 1e15]")
        if not 1.0 <= margin <= 16.0:
            raise ConfigError(f"margin: {margin} is not in [1, 16]")
        one_of("form", form, ("float", "int8"))
        self.parameters = (points, dimensions, radius, form, candidates, draws, margin)
        self._build(
            self._native_parameters(
                _native.Descriptors(
                    points, dimensions, candidates, draws, radius, margin, int(form == "int8")
                )
            )
        )
        self.vector_dtype = np.dtype(np.int8 if form == "int8" else np.float32)
        self.points, self.dimensions = points, dimensions
        super().__init__(
            np.uint8, (self._domain.percept_bytes,), self._fields(), self._domain.features_max
        )

    def _native_parameters(self, vectors: _native.Descriptors) -> ctypes.Structure:
        """Return the parameters of the C domain."""
        return vectors

    def _fields(self) -> list[Any]:
        """Return the fields of a feature's record."""
        size = self.vector_dtype.itemsize * self.dimensions
        padding = ("padding", np.uint8, (-size % 4,))
        return [("radius", np.float32), ("vector", self.vector_dtype, (self.dimensions,)), padding]

    def pack(self, percept: Percept) -> bytes:
        """Like :meth:`Domain.pack`, and also accepts the vectors [n, dimensions]."""
        if isinstance(percept, np.ndarray) and percept.ndim == 2:
            return self._head(percept).ljust(self.percept_bytes, b"\0")
        record = super().pack(percept)
        self.check_many(np.frombuffer(record, np.uint8)[None])
        return record

    def _head(self, percept: npt.NDArray[Any]) -> bytes:
        """Return the number of vectors and the vectors as bytes."""
        if percept.dtype != self.vector_dtype or percept.shape[1] != self.dimensions:
            raise PerceptError(
                f"a percept is {percept.dtype}{list(percept.shape)}, expected "
                f"{self.vector_dtype}[n, {self.dimensions}]"
            )
        if len(percept) > self.points:
            raise PerceptError(
                f"a percept has {len(percept)} vectors, more than {self.points} vectors"
            )
        if not np.isfinite(percept).all():
            raise PerceptError("a percept has an element that is not finite")
        return len(percept).to_bytes(4, sys.byteorder) + percept.tobytes()

    def pack_many(self, percepts: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Like :meth:`Domain.pack_many`, for packed percepts; also checks their numbers of vectors."""
        packed = super().pack_many(percepts)
        self.check_many(packed)
        return packed

    def check_many(self, packed: npt.NDArray[Any]) -> None:
        """Check the numbers of vectors and their elements."""
        if (packed[:, :4].copy().view(np.uint32) > self.points).any():
            raise PerceptError(f"a percept has more than {self.points} vectors")
        size = 4 + self.points * self.dimensions * self.vector_dtype.itemsize
        vectors = np.ascontiguousarray(packed[:, 4:size]).view(self.vector_dtype)
        if not np.isfinite(vectors).all():
            raise PerceptError("a percept has an element that is not finite")

    def is_one(self, percept: Any) -> bool:
        """Whether this is a single percept, not an array of packed percepts."""
        if isinstance(percept, bytes):
            return True
        found = array("percept", percept, PerceptError)
        return found.ndim != 2 or found.dtype != np.uint8
