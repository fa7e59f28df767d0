# SPDX-License-Identifier: MIT
"""The encoder of pictures."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from ..checks import one_of, whole
from ..errors import PictureError
from .config import VisionConfig
from .extractor import Extractor, Sight
from .joined import Joined
from .library import Order, Picture
from .metric import Metric


class Eye:
    """An encoder of pictures for :func:`rlvc.learn`: an extractor with the domain of its percepts.

    Parameters
    ----------
    extractor : Extractor or Joined
    order : {"rgb", "bgr"}
        Order of the colours in the environment's pictures.
    cache : int
        Number of pictures whose percepts are cached, as environments often repeat pictures.
    **parameters
        ``radius``, ``pairs``, ``bags``, ``candidates``, ``draws`` and ``margin``, as for
        :meth:`Extractor.domain` or :meth:`Joined.domain`. With pairs the extractor's config must
        have ``places``.

    Attributes
    ----------
    extractor : Extractor or Joined
    domain : Descriptors, Spatial or Bags

    Raises
    ------
    PictureError
        There is no such order.
    ConfigError
        A parameter is out of range.
    """

    def __init__(
        self,
        extractor: Extractor | Joined,
        order: Order = "rgb",
        cache: int = 256,
        **parameters: Any,
    ) -> None:
        self.extractor = extractor
        self.domain = extractor.domain(**parameters)
        self.names: list[str] = []
        self._order: Order = one_of("order", order, ("rgb", "bgr"), PictureError)  # type: ignore[assignment]
        self._cache = whole("cache", cache, 0, 2**63 - 1)
        self._parameters = parameters
        self._known: dict[tuple[Any, bytes], bytes] = {}

    def to_dict(self) -> dict[str, Any]:
        """Return what the eye is made of, for JSON.

        Returns
        -------
        dict
        """
        seen = self.extractor
        first, second = (seen.first, seen.second) if isinstance(seen, Joined) else (seen, None)
        return {
            **_extractor_to_dict(first),
            "second": None if second is None else _extractor_to_dict(second),
            "order": self._order,
            "cache": self._cache,
            "parameters": self._parameters,
        }

    @classmethod
    def from_dict(cls, fields: dict[str, Any]) -> Eye:
        """Make an eye of a result of :meth:`to_dict`.

        Parameters
        ----------
        fields : dict

        Returns
        -------
        Eye

        Raises
        ------
        Error
            A field is out of range, or the metric is damaged.
        """
        first = _extractor_from_dict(fields)
        second = fields.get("second")  # files of earlier builds have none
        extractor = first if second is None else Joined(first, _extractor_from_dict(second))
        return cls(extractor, fields["order"], fields["cache"], **fields["parameters"])

    def encode(self, observation: Picture) -> bytes:
        """Return the percept of a picture.

        Parameters
        ----------
        observation : ndarray of uint8, [height, width] or [height, width, 3]

        Returns
        -------
        bytes

        Raises
        ------
        PictureError
            The picture has the wrong dtype, shape or size.
        """
        if not isinstance(observation, np.ndarray):
            return self.extractor.extract(observation, self._order)  # which raises
        key = ((observation.shape, observation.dtype), observation.tobytes())
        known = self._known.pop(key, None)
        if known is None:
            known = self.extractor.extract(observation, self._order)
            if len(self._known) >= self._cache > 0:
                del self._known[next(iter(self._known))]  # the least recently used
        if self._cache > 0:
            self._known[key] = known
        return known

    def look(self, picture: Picture) -> Sight:
        """Like :meth:`encode`, and also return the vectors and their points."""
        return self.extractor.look(picture, self._order)

    def explain(self, text: str) -> str:
        """Return the text unchanged: features of pictures have no other names.

        Parameters
        ----------
        text : str

        Returns
        -------
        str
        """
        return text


def _extractor_to_dict(extractor: Extractor) -> dict[str, Any]:
    metric = extractor.metric
    return {
        "config": dataclasses.asdict(extractor.config),
        "metric": None if metric is None else metric.write().decode(),
    }


def _extractor_from_dict(fields: dict[str, Any]) -> Extractor:
    text = fields["metric"]
    metric = None if text is None else Metric.read(text.encode())
    return Extractor(VisionConfig(**fields["config"]), metric)
