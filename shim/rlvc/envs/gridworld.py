# SPDX-License-Identifier: MIT
"""The gridworld, and the Binary Gridworld (section 6.1)."""

from __future__ import annotations

import ctypes
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from .. import _native, files
from ..checks import one_of, real, whole
from ..errors import ConfigError, MazeError
from .maze import Maze
from .moving import Moving

_Observation = TypeVar("_Observation")


class Gridworld(Moving[_Observation], Generic[_Observation]):
    """Base class of the mazes: an agent in a maze.

    A move into the exit earns 100 and ends the episode; any other earns -1. An episode starts at a
    random free cell.

    Attributes
    ----------
    maze : Maze
    """

    metadata = {"render_modes": ["ansi"]}  # noqa: RUF012 - as Gymnasium has it

    def __init__(
        self, maze: str | Path | None, distractors: int, slip: float, render_mode: str | None
    ) -> None:
        super().__init__()
        if isinstance(maze, Path):
            try:
                maze = files.read(maze).decode()
            except (OSError, UnicodeDecodeError) as error:
                raise MazeError(f"{maze}: cannot be read: {error}") from error
        if render_mode is not None:
            one_of("render_mode", render_mode, ("ansi",))
        self.maze = Maze(maze)
        self.distractors = whole("distractors", distractors, 0, _native.BITS_MAX)
        self.slip = real("slip", slip)
        self.render_mode = render_mode
        if self.maze.bits(self.distractors) > _native.BITS_MAX:
            raise ConfigError(f"distractors: {distractors}: more than {_native.BITS_MAX} bits")
        self._world = _native.Gridworld()
        self._generator: np.random.Generator | None = None  # of the present sequence
        self._seed(0)

    def _seed(self, seed: int) -> None:
        status = _native.call.rlvc_shim_world_init(
            ctypes.byref(self._world),
            ctypes.byref(self.maze.native),
            self.distractors,
            self.slip,
            seed,
        )
        if status != 0:
            raise ConfigError(f"slip: {self.slip} is not in [0, 1]")

    def _info(self) -> dict[str, Any]:
        return {"x": self._world.cell % self.maze.width, "y": self._world.cell // self.maze.width}

    def _start(self) -> None:
        if self.np_random is self._generator:
            _native.call.rlvc_shim_world_reset(ctypes.byref(self._world))
        else:
            self._generator = self.np_random
            self._seed(int(self.np_random.integers(2**32)))

    def _move(self, action: int) -> tuple[float, bool, bool]:
        reward = ctypes.c_float()
        status = _native.call.rlvc_shim_world_step(
            ctypes.byref(self._world), action, ctypes.byref(reward)
        )
        return float(reward.value), status == 1, False

    def render(self) -> str | None:
        """Return the maze as text, with ``@`` for the agent."""
        if self.render_mode is None:
            return None
        rows = [list(row) for row in self.maze.rows]
        here = self._info()
        rows[here["y"]][here["x"]] = "@"
        return "\n".join("".join(row) for row in rows)


class BinaryGridworld(Gridworld[npt.NDArray[np.int8]]):
    """The Binary Gridworld (section 6.1): observations are bits.

    An observation is MultiBinary: x, lowest bit first; random distractors; y, lowest bit first. See
    :class:`Gridworld` for rewards and episodes.

    Parameters
    ----------
    maze : str, Path or None
        The text of a maze, or a file; None: the paper's maze.
    distractors : int
        Number of irrelevant bits.
    slip : float
        Probability that a move goes in one of the three other directions.
    render_mode : {"ansi"} or None

    Raises
    ------
    MazeError
        The maze is invalid.
    ConfigError
        ``slip`` is not in [0, 1], or an observation has more than 1024 bits.
    """

    def __init__(
        self,
        maze: str | Path | None = None,
        distractors: int = 11,
        slip: float = 0.0,
        render_mode: str | None = None,
    ) -> None:
        super().__init__(maze, distractors, slip, render_mode)
        self._bits = self.maze.bits(distractors)
        self.observation_space = spaces.MultiBinary(self._bits)
        self._percept = np.zeros((self._bits + 7) // 8, np.uint8)

    def _observe(self) -> npt.NDArray[np.int8]:
        _native.call.rlvc_shim_world_percept(ctypes.byref(self._world), self._percept.ctypes.data)
        return np.unpackbits(self._percept, count=self._bits, bitorder="little").astype(np.int8)
