# SPDX-License-Identifier: MIT
"""Two extractors as one."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from ..checks import real, shown
from ..domains.bags import Bags
from ..domains.descriptors import Descriptors
from ..errors import ConfigError, MetricError
from .extractor import Extractor, Sight
from .library import Order, Picture

_APART = 127  # the last number of a vector: 127 of the first extractor, -127 of the second


class Joined:
    """Two extractors as one: a percept has the vectors of both.

    For pictures of which one kind of vector does not tell enough: corners beside the colours of the
    whole (``quarters``), or windows of two sizes. Each extractor has a metric of its own. Its
    vectors are scaled so that tau is the same of both, the shorter ones end in zeros, and one more
    number keeps apart what comes from different extractors.

    Parameters
    ----------
    first, second : Extractor
        With a metric, form int8 and places none.

    Attributes
    ----------
    first, second : Extractor
    points, dimensions, percept_bytes : int
        As of :class:`Extractor`.
    radius : float
        tau in units of the elements in the percept.

    Raises
    ------
    MetricError
        An extractor has no metric.
    ConfigError
        An extractor has another form, or places, or all 256 dimensions.

    Examples
    --------
    >>> pictures = np.random.default_rng(1).integers(256, size=(9, 48, 48, 3), dtype=np.uint8)
    >>> corners, colours = (
    ...     Extractor(metric=Metric.fit(pictures, config=name, kind="plain"), form="int8")
    ...     for name in ("sift-upright", "quarters")
    ... )
    >>> joined = Joined(corners, colours)
    >>> joined.points, joined.dimensions
    (31, 129)
    """

    def __init__(self, first: Extractor, second: Extractor) -> None:
        self.first, self.second = first, second
        self._radii = (_radius(first), _radius(second))
        self.radius = min(*self._radii, float(_APART))
        self.points = first.points + second.points
        self.dimensions = max(first.dimensions, second.dimensions) + 1
        self._domain = Descriptors(self.points, self.dimensions, self.radius, "int8")
        self.percept_bytes = self._domain.percept_bytes

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle both extractors."""
        return type(self), (self.first, self.second)

    def _vectors(self, sight: Sight, of_first: bool) -> npt.NDArray[np.int8]:
        count, length = sight.vectors.shape
        scale = self.radius / self._radii[0 if of_first else 1]
        vectors = np.zeros((count, self.dimensions), np.int8)
        vectors[:, :length] = np.rint(scale * sight.vectors)
        vectors[:, -1] = _APART if of_first else -_APART
        return vectors

    def look(self, picture: Picture, order: Order = "rgb") -> Sight:
        """Like :meth:`extract`, and also return the vectors and their points, those of first first."""
        first, second = self.first.look(picture, order), self.second.look(picture, order)
        vectors = np.concatenate([self._vectors(first, True), self._vectors(second, False)])
        points = np.concatenate([first.points, second.points])
        return Sight(self._domain.pack(vectors), vectors, points)

    def extract(self, picture: Picture, order: Order = "rgb") -> bytes:
        """Return the percept of a picture.

        Parameters
        ----------
        picture : ndarray of uint8, [height, width] or [height, width, 3]
        order : {"rgb", "bgr"}

        Returns
        -------
        bytes
            For an agent on :meth:`domain`.

        Raises
        ------
        PictureError
            The picture has the wrong dtype, shape or size.
        """
        return self.look(picture, order).percept

    def extract_many(self, pictures: Iterable[Picture], order: Order = "rgb") -> Picture:
        """Return the percepts of pictures as an array, uint8 [n, percept_bytes]."""
        records = b"".join(self.extract(picture, order) for picture in pictures)
        return np.frombuffer(records, np.uint8).reshape(-1, self.percept_bytes)

    def domain(self, bags: bool | int = False, **parameters: Any) -> Descriptors | Bags:
        """Return the domain of the percepts.

        Parameters
        ----------
        bags : bool or int
            Whether features are bags of vectors (:class:`rlvc.Bags`), and of how many at most
            (True: 32).
        **parameters
            ``candidates``, ``draws`` and ``margin`` of :class:`rlvc.Descriptors`; of bags
            ``candidates``.

        Returns
        -------
        Descriptors or Bags

        Raises
        ------
        ConfigError
            A parameter is out of range.
        """
        if real("margin", parameters.get("margin", 1.8)) * self.radius >= 2 * _APART:
            raise ConfigError(
                f"margin: {shown(parameters['margin'])} times tau reaches the other extractor's vectors"
            )
        if bags is False:
            return Descriptors(self.points, self.dimensions, self.radius, "int8", **parameters)
        if bags is not True:
            parameters["size"] = bags
        return Bags(self.points, self.dimensions, self.radius, "int8", **parameters)


def _radius(extractor: Extractor) -> float:
    """Return an extractor's tau in the units of its percepts."""
    if extractor.metric is None:
        raise MetricError("Joined: both extractors need a metric")
    if extractor.config.form != "int8" or extractor.config.places != "none":
        raise ConfigError("Joined: extractors have form int8 and places none")
    if extractor.dimensions > 255:
        raise ConfigError("Joined: vectors have at most 255 numbers, one less than a percept's")
    return float(extractor.metric.tau / extractor.step)
