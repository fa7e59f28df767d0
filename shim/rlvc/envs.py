# SPDX-License-Identifier: MIT
"""The paper's mazes as Gymnasium environments: ``rlvc/BinaryGridworld-v0``, ``rlvc/TiledGridworld-v0``.

They play in the maze of ``examples/gridworld``, as the tool ``run_gridworld`` does. ``import rlvc.envs``
registers them.
"""

from __future__ import annotations

import abc
import ctypes
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy as np
import numpy.typing as npt

from . import _lib, objects
from .errors import ConfigError, MazeError, PictureError

try:
    import gymnasium
    from gymnasium import spaces
except ImportError:
    raise ImportError("the environments need Gymnasium: pip install 'rlvc[gym]'") from None

_CELLS_MAX = 256 * 256

ACTIONS = ("up", "right", "down", "left")
"""What the actions 0 to 3 are; y grows downwards."""


class Maze:
    """A maze.

    Parameters
    ----------
    text : str or None
        A line for each row from the top: ``#`` wall, ``.`` free, ``*`` exit. None: the maze of section
        6.1, Sutton's, of 9 x 6 cells.

    Attributes
    ----------
    rows : list of str
    width, height : int
        In cells.

    Raises
    ------
    MazeError
        The text is no maze; the message says in which line and column, and why.
    """

    def __init__(self, text: str | None = None) -> None:
        if text is None:
            self.native = _lib.call.rlvc_shim_sutton()[0]
        else:
            encoded = text.encode(errors="replace")
            self._cells = ctypes.create_string_buffer(min(len(encoded), _CELLS_MAX) + 1)
            self.native = _lib.Maze()
            fault = _lib.MazeFault()
            status = _lib.call.rlvc_shim_maze_parse(
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
        """Give the number of bits of a percept."""
        return int(_lib.call.rlvc_shim_maze_bits(ctypes.byref(self.native), distractors))

    def percepts(self, distractors: int, seed: int = 0) -> npt.NDArray[np.uint8]:
        """Give a percept of each cell, by rows from the top, with distractors drawn at random.

        Parameters
        ----------
        distractors : int
            Bits of a percept that say nothing.
        seed : int
            Of the distractors.

        Returns
        -------
        ndarray of uint8, [height * width, ceil(bits / 8)]
        """
        cells = self.width * self.height
        percepts = np.zeros((cells, (self.bits(distractors) + 7) // 8), np.uint8)
        random = _lib.MazeRandom(seed)
        for cell in range(cells):
            _lib.call.rlvc_shim_maze_encode(
                ctypes.byref(self.native),
                distractors,
                cell,
                ctypes.byref(random),
                percepts[cell].ctypes.data,
            )
        return percepts


SMALL = "....\n.#..\n...*\n"
"""A maze of ten cells, about as large as that of figure 4."""

_Observation = TypeVar("_Observation")


class Gridworld(gymnasium.Env[_Observation, np.int64], Generic[_Observation]):
    """What the two environments have in common: a maze, and an agent's place in it.

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
        if isinstance(maze, Path):
            try:
                maze = maze.read_text(encoding="utf-8")
            except (OSError, UnicodeDecodeError) as error:
                raise MazeError(f"{maze}: cannot be read: {error}") from error
        if render_mode not in (None, "ansi"):
            raise ConfigError(f"render_mode: {render_mode!r} is not ansi")
        self.maze = Maze(maze)
        self.distractors = distractors
        self.slip = slip
        self.render_mode = render_mode
        if not 0 <= distractors <= _lib.BITS_MAX or self.maze.bits(distractors) > _lib.BITS_MAX:
            raise ConfigError(f"distractors: {distractors}: at most {_lib.BITS_MAX} bits in all")
        self.action_space = spaces.Discrete(4)
        self._world = _lib.World()
        self._over = True
        self._seed(0)

    def _seed(self, seed: int) -> None:
        status = _lib.call.rlvc_shim_world_init(
            ctypes.byref(self._world),
            ctypes.byref(self.maze.native),
            self.distractors,
            self.slip,
            seed,
        )
        if status != 0:
            raise ConfigError(f"slip: {self.slip} is not in [0, 1]")

    @abc.abstractmethod
    def _observe(self) -> _Observation:
        """What is seen from the agent's cell."""

    def _info(self) -> dict[str, Any]:
        return {"x": self._world.cell % self.maze.width, "y": self._world.cell // self.maze.width}

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[_Observation, dict[str, Any]]:
        """Start an episode at a random free cell.

        Parameters
        ----------
        seed : int or None
            Of everything random from here on; None goes on.
        options : dict or None
            Not looked at.

        Returns
        -------
        tuple
            The observation, and {"x", "y"}: where the agent is, in cells.
        """
        fresh = self._np_random is None
        super().reset(seed=seed)
        if seed is not None or fresh:
            self._seed(int(self.np_random.integers(2**32)))
        else:
            _lib.call.rlvc_shim_world_reset(ctypes.byref(self._world))
        self._over = False
        return self._observe(), self._info()

    def step(self, action: Any) -> tuple[_Observation, float, bool, bool, dict[str, Any]]:
        """Move: 0 up, 1 right, 2 down, 3 left.

        Parameters
        ----------
        action : int

        Returns
        -------
        tuple
            The observation, the reward, terminated, truncated (never), and the place.

        Raises
        ------
        gymnasium.error.InvalidAction
            There is no such action.
        gymnasium.error.ResetNeeded
            The episode is over.
        """
        if not self.action_space.contains(action):
            raise gymnasium.error.InvalidAction(f"{action!r} is not in [0, 3]")
        if self._over:
            raise gymnasium.error.ResetNeeded("call reset first")
        reward = ctypes.c_float()
        status = _lib.call.rlvc_shim_world_step(
            ctypes.byref(self._world), int(action), ctypes.byref(reward)
        )
        self._over = status == 1
        return self._observe(), float(reward.value), self._over, False, self._info()

    def render(self) -> str | None:
        """Draw the maze as text, with ``@`` for the agent."""
        if self.render_mode is None:
            return None
        rows = [list(row) for row in self.maze.rows]
        here = self._info()
        rows[here["y"]][here["x"]] = "@"
        return "\n".join("".join(row) for row in rows)


class BinaryGridworld(Gridworld[npt.NDArray[np.int8]]):
    """The Binary Gridworld (section 6.1): a maze whose cells are seen as strings of bits.

    An observation is MultiBinary: x, lowest bit first; distractors, drawn anew each time; y, lowest bit
    first. See :class:`Gridworld` for the rest.

    Parameters
    ----------
    maze : str, Path or None
        A maze's text, or a file with it; None is the paper's.
    distractors : int
        Bits that say nothing.
    slip : float
        Probability that a move goes astray, in one of the three other directions.
    render_mode : {"ansi"} or None

    Raises
    ------
    MazeError
        The maze is none.
    ConfigError
        ``slip`` is not in [0, 1], or an observation would have more than 1024 bits.
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
        _lib.call.rlvc_shim_world_percept(ctypes.byref(self._world), self._percept.ctypes.data)
        return np.unpackbits(self._percept, count=self._bits, bitorder="little").astype(np.int8)


class TiledGridworld(Gridworld[npt.NDArray[np.uint8]]):
    """The Tiled Gridworld (section 6.2): a maze in whose cells objects lie, seen as pictures.

    An observation is a Box of uint8 [height, width, 3], red first: a picture of the object in the
    agent's cell, from one of its angles at random; black at the exit. See :class:`Gridworld` for the
    rest. An :class:`rlvc.vision.Eye` makes percepts of it.

    Parameters
    ----------
    maze : str, Path or None
        A maze's text, such as :data:`SMALL`, or a file with it; None is Sutton's, of 46 cells.
    pictures : ndarray, str, Path or None
        An array of uint8 [objects, height, width, 3] or [objects, views, height, width, 3]; or a folder
        such as that of COIL-100; None renders objects. The two last need the vision module:
        :func:`rlvc.objects.find` reads and renders.
    angles : sequence of int
        In degrees, from which objects are seen; of no meaning for an array.
    placement : int or None
        Of which objects lie where: a number puts them at random, with that seed; None in their order.
    slip : float
        Probability that a move goes astray, in one of the three other directions.
    render_mode : {"ansi"} or None

    Attributes
    ----------
    objects : rlvc.objects.Objects
    object_of : ndarray of int, [height * width]
        Which object lies in each cell; -1 where none does.

    Raises
    ------
    MazeError
        The maze is none.
    PictureError
        There are fewer objects than cells, or what is no picture that can be used.
    ConfigError
        ``slip`` is not in [0, 1].
    ImportError
        The package has no vision module; the text says what to install.
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
            raise PictureError(f"pictures: of {count} objects, and the maze has {len(cells)} cells")
        order = np.arange(count)
        if placement is not None:
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


def register() -> None:
    """Register the environments; doing so twice does nothing."""
    for kind in (BinaryGridworld, TiledGridworld):
        name = f"rlvc/{kind.__name__}-v0"
        if name not in gymnasium.registry:
            gymnasium.register(name, entry_point=f"rlvc.envs:{kind.__name__}")


register()
