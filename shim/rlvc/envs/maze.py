# SPDX-License-Identifier: MIT
"""Mazes: their text, and the percepts of their cells."""

from __future__ import annotations

import ctypes

import numpy as np
import numpy.typing as npt

from .. import _native
from ..checks import shown, whole
from ..errors import MazeError

_CELLS_MAX = 256 * 256

ACTIONS = ("up", "right", "down", "left")
"""The actions 0 to 3; y grows downwards."""


class Maze:
    """A maze.

    Parameters
    ----------
    text : str or None
        One line for each row, from the top: ``#`` wall, ``.`` free, ``*`` exit. None: the maze of
        section 6.1 (Sutton's), 9 x 6 cells.

    Attributes
    ----------
    rows : list of str
    width, height : int
        Size in cells.

    Raises
    ------
    MazeError
        The text is invalid. The message names the line, the column and the fault.
    """

    def __init__(self, text: str | None = None) -> None:
        if text is not None and not isinstance(text, str):
            raise MazeError(f"maze: {shown(text)} is not text")
        if text is None:
            self.native = _native.call.rlvc_shim_sutton()[0]
        else:
            encoded = text.encode(errors="replace")
            self._cells = ctypes.create_string_buffer(min(len(encoded), _CELLS_MAX) + 1)
            self.native = _native.GridworldMaze()
            fault = _native.GridworldError()
            status = _native.call.rlvc_shim_maze_parse(
                ctypes.byref(self.native),
                encoded,
                len(encoded),
                self._cells,
                len(self._cells),
                ctypes.byref(fault),
            )
            if status != 0:
                where = f"line {fault.line}, column {fault.column}: " if fault.line else ""
                raise MazeError(f"maze: {where}{(fault.what or b'').decode()}")
        self.width, self.height = int(self.native.width), int(self.native.height)
        signs = ctypes.string_at(self.native.cells, self.width * self.height).decode()
        self.rows = [signs[y * self.width : (y + 1) * self.width] for y in range(self.height)]

    def bits(self, distractors: int) -> int:
        """Return the number of bits of a percept."""
        distractors = whole("distractors", distractors, 0, _native.BITS_MAX)
        return int(_native.call.rlvc_shim_maze_bits(ctypes.byref(self.native), distractors))

    def percepts(self, distractors: int, seed: int = 0) -> npt.NDArray[np.uint8]:
        """Return a percept of each cell, by rows from the top, with random distractors.

        Parameters
        ----------
        distractors : int
            Number of irrelevant bits.
        seed : int
            Seed of the distractors.

        Returns
        -------
        ndarray of uint8, [height * width, ceil(bits / 8)]
        """
        distractors = whole("distractors", distractors, 0, _native.BITS_MAX)
        seed = whole("seed", seed, 0, 2**64 - 1)
        cells = self.width * self.height
        percepts = np.zeros((cells, (self.bits(distractors) + 7) // 8), np.uint8)
        random = _native.GridworldRandom(seed)
        for cell in range(cells):
            _native.call.rlvc_shim_maze_encode(
                ctypes.byref(self.native),
                distractors,
                cell,
                ctypes.byref(random),
                percepts[cell].ctypes.data,
            )
        return percepts


SMALL = "....\n.#..\n...*\n"
"""A maze of ten cells, about as large as in figure 4."""
