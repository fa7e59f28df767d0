# SPDX-License-Identifier: MIT
"""The Tiled Gridworld (section 6.2): cells are seen as pictures of objects."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from .. import objects
from ..checks import whole
from ..errors import PictureError
from .gridworld import Gridworld


class TiledGridworld(Gridworld[npt.NDArray[np.uint8]]):
    """The Tiled Gridworld (section 6.2): observations are pictures of the objects in the cells.

    An observation is uint8 [height, width, 3], red first: a picture of the object in the agent's
    cell, from a random angle; at the exit it is black. See :class:`Gridworld` for rewards and
    episodes. :class:`rlvc.vision.Eye` turns observations into percepts.

    Parameters
    ----------
    maze : str, Path or None
        The text of a maze, such as :data:`SMALL`, or a file; None: Sutton's maze of 46 cells.
    pictures : ndarray, str, Path or None
        An array of uint8 [objects, height, width, 3] or [objects, views, height, width, 3]; a
        folder of pictures, such as COIL-100; None: rendered objects. Folders and rendering need the
        vision module: see :func:`rlvc.objects.find`.
    angles : sequence of int
        Angles of the pictures, in degrees; ignored with an array.
    placement : int or None
        Seed of a random assignment of objects to cells. None: in order.
    slip : float
        Probability that a move goes in one of the three other directions.
    render_mode : {"ansi"} or None

    Attributes
    ----------
    objects : rlvc.objects.Objects
    object_of : ndarray of int, [height * width]
        The object in each cell; -1: none.

    Raises
    ------
    MazeError
        The maze is invalid.
    PictureError
        There are fewer objects than cells, or a picture cannot be used.
    ConfigError
        ``slip`` is not in [0, 1], or ``placement`` not at least 0.
    ImportError
        The vision module is missing. The message says what to install.
    """

    def __init__(
        self,
        maze: str | Path | None = None,
        pictures: npt.NDArray[np.uint8] | str | Path | None = None,
        angles: Sequence[int] = (0,),
        placement: int | None = None,
        slip: float = 0.0,
        render_mode: str | None = None,
    ) -> None:
        super().__init__(maze, 0, slip, render_mode)
        signs = np.array([list(row) for row in self.maze.rows]).ravel()
        cells = np.flatnonzero(signs == ".")
        if pictures is None or isinstance(pictures, str | Path):
            self.objects = objects.find(pictures, angles, wanted=len(cells))
        else:
            self.objects = objects.given(pictures)
        count = len(self.objects.names)
        if count < len(cells):
            raise PictureError(f"pictures: {count} objects for {len(cells)} cells")
        order = np.arange(count)
        if placement is not None:
            placement = whole("placement", placement, 0, 2**63 - 1)
            np.random.default_rng(placement).shuffle(order)
        self.object_of = np.full(len(signs), -1)
        self.object_of[cells] = order[: len(cells)]
        self.observation_space = spaces.Box(0, 255, self.objects.pictures.shape[2:], np.uint8)

    def _observe(self) -> npt.NDArray[np.uint8]:
        here = self.object_of[self._world.cell]
        if here < 0:
            return np.zeros(self.objects.pictures.shape[2:], np.uint8)
        views = self.objects.pictures[here]
        return np.array(views[int(self.np_random.integers(len(views)))])
