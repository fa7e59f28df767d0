# SPDX-License-Identifier: MIT
"""Extraction of percepts from pictures."""

from __future__ import annotations

import ctypes
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ..domains.bags import Bags
from ..domains.descriptors import Descriptors
from ..domains.spatial import Spatial
from ..errors import ConfigError, MetricError
from .config import VisionConfig, config_of
from .library import Order, Owned, Picture, call, library, native_picture
from .metric import Metric


class Sight(NamedTuple):
    """The percept of a picture, and its points.

    Attributes
    ----------
    percept : bytes
        For an agent on :meth:`Extractor.domain`.
    vectors : ndarray of float32 or int8, [n, dimensions]
        One for each point, strongest point first.
    points : ndarray of float32, [n, 3]
        x and y in pixels, and the response.
    """

    percept: bytes
    vectors: npt.NDArray[Any]
    points: npt.NDArray[np.float32]


class Extractor(Owned):
    """Turns pictures into percepts.

    Parameters
    ----------
    config : VisionConfig, str or None
        A str names a descriptor with its defaults. None: the config of the metric, or SIFT upright.
    metric : Metric or None
        None: vectors are not transformed.
    **changes
        Fields of the config to change.

    Attributes
    ----------
    config : VisionConfig
    metric : Metric or None
    points : int
        P, the maximum number of vectors of a percept.
    dimensions : int
        D, the length of a vector.
    percept_bytes : int
    step : float
        Quantization step of the elements in the percept: tau / step is tau in their units.

    Raises
    ------
    ConfigError
        A field of the config is out of range.
    MetricError
        The metric is for other vectors, or this config needs a metric.

    Examples
    --------
    >>> pictures = np.random.default_rng(1).integers(256, size=(4, 48, 48, 3), dtype=np.uint8)
    >>> metric = Metric.fit(pictures, form="int8")
    >>> extractor = Extractor(metric=metric, form="int8")
    >>> len(extractor.extract(pictures[0])) == extractor.percept_bytes
    True
    """

    def __init__(
        self,
        config: VisionConfig | str | None = None,
        metric: Metric | None = None,
        **changes: Any,
    ) -> None:
        if config is None:
            config = VisionConfig() if metric is None else metric.config
        self.config = config_of(config, changes)
        self.metric = metric
        native = self.config.native()
        super().__init__(
            "rlvc_extractor_create",
            "rlvc_extractor_destroy",
            ctypes.byref(native),
            None if metric is None else metric._handle,
        )
        self.points = int(native.points)
        self.dimensions = int(library.rlvc_vision_dimensions(ctypes.byref(native)))
        self.percept_bytes = int(library.rlvc_vision_percept_bytes(ctypes.byref(native)))
        self.step = float(library.rlvc_extractor_step(self._handle))

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle config and metric."""
        return type(self), (self.config, self.metric)

    def _record(self, picture: Picture, order: Order, points: Any) -> bytes:
        native = native_picture(picture, order)
        record = np.empty(self.percept_bytes // 4, np.uint32)  # aligned to 4
        place = (record.ctypes.data, self.percept_bytes)
        with self._lock:
            call("rlvc_extractor_extract", self._handle, ctypes.byref(native), *place, points)
        return record.tobytes()

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
        return self._record(picture, order, None)

    def extract_many(self, pictures: Iterable[Picture], order: Order = "rgb") -> Picture:
        """Return the percepts of pictures as an array.

        Parameters
        ----------
        pictures : iterable of ndarray
        order : {"rgb", "bgr"}

        Returns
        -------
        ndarray of uint8, [n, percept_bytes]

        Raises
        ------
        PictureError
            A picture has the wrong dtype, shape or size.
        """
        records = b"".join(self.extract(picture, order) for picture in pictures)
        return np.frombuffer(records, np.uint8).reshape(-1, self.percept_bytes)

    def look(self, picture: Picture, order: Order = "rgb") -> Sight:
        """Like :meth:`extract`, and also return the vectors and their points."""
        points = np.zeros((self.points, 3), np.float32)
        record = self._record(picture, order, points.ctypes.data)
        count = int(np.frombuffer(record, np.uint32, 1)[0])
        dtype = np.int8 if self.config.form == "int8" else np.float32
        numbers = np.frombuffer(record, dtype, count * self.dimensions, 4)
        return Sight(record, numbers.reshape(count, self.dimensions), points[:count])

    def domain(
        self,
        radius: float | None = None,
        pairs: bool | int | None = None,
        bags: bool | int = False,
        **parameters: Any,
    ) -> Descriptors:
        """Return the domain of the percepts.

        Parameters
        ----------
        radius : float or None
            In units of the elements in the percept. None: the metric's tau.
        pairs : bool, int or None
            Whether pairs of points are features, too, and how many are candidates for one class
            (True: 64). None: if the config has ``places``. If it has none, only what :meth:`look`
            returns is a percept of the domain.
        bags : bool or int
            Whether features are bags of vectors (:class:`rlvc.Bags`), and of how many at most
            (True: 32). Not together with pairs.
        **parameters
            ``candidates``, ``draws`` and ``margin`` of :class:`rlvc.Descriptors`; of bags
            ``candidates``.

        Returns
        -------
        Descriptors, Spatial or Bags

        Raises
        ------
        MetricError
            There is no radius and no metric.
        ConfigError
            A parameter is out of range.
        """
        if radius is None:
            if self.metric is None:
                raise MetricError("radius: pass one, or make the extractor with a metric")
            radius = self.metric.tau / self.step
        form: Any = self.config.form
        places = self.config.places
        if bags is not False:
            if pairs or places != "none":
                raise ConfigError("bags: percepts with places have pairs; make it with places none")
            if bags is not True:
                parameters["size"] = bags
            return Bags(self.points, self.dimensions, radius, form, **parameters)
        if pairs is None:
            pairs = places != "none"
        if pairs is False:
            if places != "none":
                raise ConfigError("pairs: percepts with places have pairs; make it with places none")
            return Descriptors(self.points, self.dimensions, radius, form, **parameters)
        if pairs is not True:
            parameters["pairs"] = pairs
        parameters["directed"] = places == "directed"
        return Spatial(self.points, self.dimensions, radius, form, **parameters)
