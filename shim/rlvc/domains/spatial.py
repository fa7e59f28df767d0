# SPDX-License-Identifier: MIT
"""Percepts of local descriptors and their places (section 7)."""

from __future__ import annotations

import ctypes
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from .. import _native
from ..checks import flag, whole
from ..errors import PerceptError
from .descriptors import Descriptors


class Spatial(Descriptors):
    """Percepts of local descriptors and their places: also arrangements of points are features.

    A feature is a vector with a radius, as in :class:`rlvc.Descriptors`, or a pair: two vectors and
    the displacement from the point of the first to that of the second. A percept exhibits a pair if
    two of its points have such vectors and are so displaced.

    Parameters
    ----------
    points, dimensions, radius, form, candidates, draws, margin
        As for :class:`rlvc.Descriptors`; ``candidates`` is the number of single vectors.
    pairs : int
        Maximum number of candidate pairs for one class, [1, 65535].
    directed : bool
        Whether points have directions. A displacement is then relative to the direction of its
        first point, so that rotations of the picture do not change it.

    Raises
    ------
    ConfigError
        A parameter is out of range.

    Notes
    -----
    A percept is a tuple of vectors [n, dimensions] and places [n, 2] in pixels; if ``directed``
    also of directions [n], in radians, clockwise on the screen; or what
    :meth:`rlvc.vision.Extractor.look` or :meth:`pack` return. An array of percepts is uint8
    [n, percept_bytes]. A feature has the fields ``radius``, ``vector``, ``scale`` (0: a single
    vector), ``displacement`` and ``second``. Source: ``core/include/rlvc/spatial.h``.

    Examples
    --------
    >>> domain = Spatial(points=10, dimensions=3, radius=4.0)
    >>> vectors = np.eye(2, 3, dtype=np.float32)
    >>> places = np.array([[5, 5], [45, 6]])
    >>> len(domain.pack((vectors, places))) == domain.percept_bytes
    True
    """

    _function = "rlvc_spatial_domain"

    def __init__(
        self,
        points: int,
        dimensions: int,
        radius: float,
        form: Literal["float", "int8"] = "float",
        candidates: int = 64,
        draws: int = 8,
        margin: float = 1.8,
        pairs: int = 64,
        directed: bool = False,
    ) -> None:
        self.pairs = whole("pairs", pairs, 1, _native.DESCRIPTORS_CANDIDATES_MAX)
        self.directed = flag("directed", directed)
        super().__init__(points, dimensions, radius, form, candidates, draws, margin)
        self.parameters = (*self.parameters, self.pairs, self.directed)

    def _native_parameters(self, vectors: _native.Descriptors) -> ctypes.Structure:
        return _native.Spatial(vectors, self.pairs, self.directed)

    def _fields(self) -> list[Any]:
        vector = (self.vector_dtype, (self.dimensions,))
        size = 2 * self.vector_dtype.itemsize * self.dimensions
        return [
            ("radius", np.float32),
            ("scale", np.float32),
            ("displacement", np.float32, (2,)),
            ("vector", *vector),
            ("second", *vector),
            ("padding", np.uint8, (-size % 4,)),
        ]

    def pack(self, percept: Any) -> bytes:
        """Like :meth:`Descriptors.pack`, and also accepts vectors with their places."""
        if not isinstance(percept, tuple):
            if isinstance(percept, np.ndarray) and percept.ndim == 2:
                raise PerceptError("a percept has vectors, but no places: pass a tuple of both")
            return super().pack(percept)
        if len(percept) == 3 and isinstance(percept[0], bytes):  # what Extractor.look returns
            if len(percept[0]) == self.percept_bytes:
                return super().pack(percept[0])
            percept = (percept[1], percept[2][:, :2])
        if len(percept) != 2 + self.directed:
            raise PerceptError(
                f"a percept is a tuple of {len(percept)}, expected vectors and places"
                + (" and directions" if self.directed else "")
            )
        head = self._head(np.asarray(percept[0]))
        size = 4 + -(-self.points * self.dimensions * self.vector_dtype.itemsize // 4) * 4
        places = self._places(percept[1], len(percept[0]))
        record = head.ljust(size, b"\0") + places.ljust(4 * self.points, b"\0")
        if self.directed:
            angles = np.asarray(percept[2], float).reshape(len(percept[0]))
            units = np.stack([np.cos(angles), np.sin(angles)], 1)
            directions: bytes = np.rint(127 * units).astype(np.int8).tobytes()
            record += directions
        return record.ljust(self.percept_bytes, b"\0")

    def _places(self, places: npt.ArrayLike, count: int) -> bytes:
        array = np.asarray(places, float)
        if array.shape != (count, 2):
            raise PerceptError(f"places are {list(array.shape)}, expected [{count}, 2]")
        if not (np.abs(array) <= 32767).all():  # neither is a NaN
            raise PerceptError("a place is not in [-32767, 32767] pixels")
        packed: bytes = np.rint(array).astype("<i2").tobytes()
        return packed

    def is_one(self, percept: Any) -> bool:
        """Whether this is a single percept, not an array of packed percepts."""
        return isinstance(percept, tuple) or super().is_one(percept)

    def is_pair(self, feature: Any) -> bool:
        """Whether a feature is a pair.

        Parameters
        ----------
        feature : scalar of feature_dtype

        Returns
        -------
        bool
        """
        return bool(feature["scale"] > 0)

    def nearest(self, percept: Any, feature: Any) -> tuple[int, int, float]:
        """Return the points of a percept that are nearest to a feature, and their distance.

        Parameters
        ----------
        percept : as for :meth:`pack`
        feature : scalar of feature_dtype

        Returns
        -------
        tuple of int, int and float
            The indices of the points, twice the same for a single vector; the distance, of which
            the percept exhibits the feature if it is at most its radius.

        Raises
        ------
        PerceptError
            The percept has fewer points than the feature.
        """
        record, wanted = self.pack(percept), self._record(feature)
        points, squared = (ctypes.c_uint32 * 2)(), ctypes.c_float()
        if _native.call.rlvc_spatial_nearest(
            ctypes.byref(self._made), record, wanted, points, ctypes.byref(squared)
        ):
            raise PerceptError("the percept has fewer points than the feature")
        return int(points[0]), int(points[1]), float(np.sqrt(squared.value))
