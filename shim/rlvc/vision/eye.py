# SPDX-License-Identifier: MIT
"""The encoder of pictures."""

from __future__ import annotations

from typing import Any

import numpy as np

from .extractor import Extractor, Sight
from .library import Order, Picture


class Eye:
    """An encoder of pictures for :func:`rlvc.learn`: an extractor, and the domain of its percepts.

    Parameters
    ----------
    extractor : Extractor
    order : {"rgb", "bgr"}
        Of the environment's pictures.
    cache : int
        How many pictures are remembered with their percepts: environments show the same ones again.
    **parameters
        ``radius``, ``candidates``, ``draws`` and ``margin``, as for :meth:`Extractor.domain`.

    Attributes
    ----------
    extractor : Extractor
    domain : Descriptors
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
        """Give the percept of a picture.

        Parameters
        ----------
        observation : ndarray of uint8, [height, width] or [height, width, 3]

        Returns
        -------
        bytes

        Raises
        ------
        PictureError
            The picture is of the wrong dtype, shape or size.
        """
        if not isinstance(observation, np.ndarray):
            return self.extractor.extract(observation, self._order)  # which says what is wrong
        key = ((observation.shape, observation.dtype), observation.tobytes())
        known = self._known.pop(key, None)
        if known is None:
            known = self.extractor.extract(observation, self._order)
            if len(self._known) >= self._cache > 0:
                del self._known[next(iter(self._known))]  # the longest not seen
        if self._cache > 0:
            self._known[key] = known
        return known

    def look(self, picture: Picture) -> Sight:
        """Give the percept of a picture, and where its vectors were found.

        Parameters
        ----------
        picture : ndarray of uint8, [height, width] or [height, width, 3]

        Returns
        -------
        Sight

        Raises
        ------
        PictureError
            The picture is of the wrong dtype, shape or size.
        """
        return self.extractor.look(picture, self._order)

    def explain(self, text: str) -> str:
        """Leave a tree's text as it is: a feature's name says all there is in words.

        Parameters
        ----------
        text : str

        Returns
        -------
        str
        """
        return text
