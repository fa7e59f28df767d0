# SPDX-License-Identifier: MIT
"""The encoder of pictures."""

from __future__ import annotations

from typing import Any

import numpy as np

from .extractor import Extractor, Sight
from .library import Order, Picture


class Eye:
    """An encoder of pictures for :func:`rlvc.learn`: an extractor with the domain of its percepts.

    Parameters
    ----------
    extractor : Extractor
    order : {"rgb", "bgr"}
        Order of the colours in the environment's pictures.
    cache : int
        Number of pictures whose percepts are cached, as environments often repeat pictures.
    **parameters
        ``radius``, ``pairs``, ``bags``, ``candidates``, ``draws`` and ``margin``, as for
        :meth:`Extractor.domain`. With pairs the extractor's config must have ``places``.

    Attributes
    ----------
    extractor : Extractor
    domain : Descriptors, Spatial or Bags
    """

    def __init__(
        self, extractor: Extractor, order: Order = "rgb", cache: int = 256, **parameters: Any
    ) -> None:
        self.extractor = extractor
        self.domain = extractor.domain(**parameters)
        self.names: list[str] = []
        self._order = order
        self._cache = cache
        self._known: dict[tuple[Any, bytes], bytes] = {}

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
