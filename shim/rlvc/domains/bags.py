# SPDX-License-Identifier: MIT
"""Percepts of local descriptors of which a part is enough."""

from __future__ import annotations

import ctypes
from typing import Any, Literal

import numpy as np

from .. import _native
from ..checks import whole
from ..errors import PerceptError
from .descriptors import Descriptors


class Bags(Descriptors):
    """Percepts of local descriptors; features are bags of vectors of which a part is enough.

    Each vector of a bag that is a distance d < radius away from the nearest of a percept's vectors
    scores radius^2 - d^2. A percept exhibits the feature if the sum is at least what the feature
    needs. Such features survive clutter and covered parts better than the single vectors of
    :class:`rlvc.Descriptors`; learning takes longer. A bag is gathered from every second
    sample of a class, refused if the others do not bear it out, and else gathered once more from
    all: with random rewards one of 200 runs tested noise. Many samples of a class must have equal
    targets, as where rewards are a few numbers; where all differ no bag is found.

    Parameters
    ----------
    points, dimensions, radius, form
        As for :class:`rlvc.Descriptors`.
    candidates : int
        Maximum number of candidate bags for one class, [1, 65535].
    size : int
        Maximum number of vectors of a bag, [1, 32].

    Raises
    ------
    ConfigError
        A parameter is out of range.

    Notes
    -----
    Percepts are those of :class:`rlvc.Descriptors`. A feature has the fields ``needed``, ``count``
    and ``vectors``, of which the first ``count`` are the bag's. Source: ``core/include/rlvc/bags.h``.

    Examples
    --------
    >>> domain = Bags(points=10, dimensions=3, radius=4.0, size=8)
    >>> len(domain.pack(np.eye(2, 3, dtype=np.float32))) == domain.percept_bytes
    True
    """

    _function = "rlvc_bags_domain"

    def __init__(
        self,
        points: int,
        dimensions: int,
        radius: float,
        form: Literal["float", "int8"] = "float",
        candidates: int = 16,
        size: int = 32,
    ) -> None:
        self.size = whole("size", size, 1, _native.BAGS_SIZE_MAX)
        super().__init__(points, dimensions, radius, form, candidates)
        self.parameters = (points, dimensions, self.parameters[2], form, candidates, self.size)

    def _native_parameters(self, vectors: _native.Descriptors) -> ctypes.Structure:
        return _native.Bags(vectors, self.size)

    def _fields(self) -> list[Any]:
        size = self.vector_dtype.itemsize * self.dimensions * self.size
        return [
            ("needed", np.float32),
            ("count", np.uint32),
            ("vectors", self.vector_dtype, (self.size, self.dimensions)),
            ("padding", np.uint8, (-size % 4,)),
        ]

    def nearest(self, percept: Any, feature: Any) -> list[tuple[int, float]]:
        """Return, for each vector of a feature, the nearest of a percept.

        Parameters
        ----------
        percept : as for :meth:`pack`
        feature : scalar of feature_dtype

        Returns
        -------
        list of tuple of int and float
            The index of the percept's vector, and its distance. The vector counts if the distance
            is less than the domain's radius.

        Raises
        ------
        PerceptError
            The percept has no vectors.
        """
        record, wanted = self.pack(percept), self._record(feature)
        point, squared, found = ctypes.c_uint32(), ctypes.c_float(), []
        for which in range(int(feature["count"])):
            places = (ctypes.byref(point), ctypes.byref(squared))
            if _native.call.rlvc_bags_nearest(
                ctypes.byref(self._made), record, wanted, which, *places
            ):
                raise PerceptError("the percept has no vectors")
            found.append((point.value, float(np.sqrt(squared.value))))
        return found
