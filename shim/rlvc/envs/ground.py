# SPDX-License-Identifier: MIT
"""A camera that moves over a photograph."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from ..checks import listed, real, shown, whole
from ..errors import ConfigError, PictureError
from .moving import Moving

_Picture: TypeAlias = "npt.NDArray[np.uint8]"
_MOVES = np.array([(0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)])
_WAY = np.arange(1, 9) / 8  # where on the way of a move walls are looked for
_SPREAD = 2.0  # an episode starts at least this many radii from the goal


def _drawn(width: int = 480, height: int = 360) -> _Picture:
    """A ground of patches of colour, the same each time."""
    random = np.random.default_rng(1)
    ground = np.zeros((height, width, 3))
    for cell in (60, 24, 10):
        shape = (height // cell + 1, width // cell + 1, 3)
        patches = random.uniform(0, 85, shape)
        ground += np.kron(patches, np.ones((cell, cell, 1)))[:height, :width]
    return ground.astype(np.uint8)


class GroundView(Moving[_Picture]):
    """A camera looks down on a photograph, moves over it and searches a goal.

    An observation is uint8 [view, view, 3]: the part of the photograph below the camera, whose
    position is real-valued, with other turn, scale, light and noise each time. A move that ends at
    the goal earns 100 and ends the episode; any other earns -1. An episode starts at a random
    position at least two radii from the goal. :class:`rlvc.vision.Eye` turns observations into
    percepts.

    Parameters
    ----------
    picture : ndarray of uint8, [height, width] or [height, width, 3], or None
        The photograph, red first. None: a drawn ground.
    view : int
        Side of an observation in pixels, [8, 1024].
    stride : float
        Length of a move in pixels.
    slip : float
        Standard deviation of a move's error, as a share of ``stride``, [0, 1].
    turn : float
        The camera is turned by up to so many degrees, [0, 180]. 180: its heading is unknown.
    scale, light : float
        By which share size and light vary, [0, 0.5].
    noise : float
        Standard deviation of the noise, in grey levels, [0, 100].
    goal : tuple of float
        Position of the goal as shares of the width and height that the camera can reach, [0, 1].
    radius : float or None
        Radius of the goal in pixels. None: 0.75 ``stride``.
    walls : sequence of tuple of float
        Rectangles (left, top, right, bottom) in pixels that the camera cannot enter; at least an
        eighth of ``stride`` thick.
    limit : int
        An episode is truncated after so many moves.

    Attributes
    ----------
    low, high : ndarray of float, [2]
        The smallest and the largest position of the camera.
    goal : ndarray of float, [2]
        Position of the goal in pixels.
    position : ndarray of float, [2]
        Position of the camera in pixels; may be set.

    Raises
    ------
    PictureError
        The photograph has the wrong dtype or shape, or is smaller than what the camera sees.
    ConfigError
        A parameter is out of range.
    """

    metadata = {"render_modes": []}  # noqa: RUF012 - as Gymnasium has it

    def __init__(
        self,
        picture: _Picture | None = None,
        view: int = 96,
        stride: float = 54.0,
        slip: float = 0.1,
        turn: float = 0.0,
        scale: float = 0.03,
        light: float = 0.05,
        noise: float = 3.0,
        goal: tuple[float, float] = (0.85, 0.2),
        radius: float | None = None,
        walls: Sequence[tuple[float, float, float, float]] = (),
        limit: int = 60,
    ) -> None:
        super().__init__()
        self.picture = _checked(_drawn() if picture is None else picture)
        self.view = whole("view", view, 8, 1024)
        self.limit = whole("limit", limit, 1, 2**31)
        self.stride = _within("stride", stride, 1.0, 1e4)
        self.slip, self.turn = _within("slip", slip, 0, 1), _within("turn", turn, 0, 180)
        self.scale, self.light = _within("scale", scale, 0, 0.5), _within("light", light, 0, 0.5)
        self.noise = _within("noise", noise, 0, 100)
        self.radius = 0.75 * self.stride if radius is None else _within("radius", radius, 1, 1e4)
        self.walls = [_numbers("wall", wall, 4) for wall in listed("walls", walls, "walls")]
        margin = self.view / 2 * (np.sqrt(2) if self.turn else 1) * (1 + self.scale) + 1
        self.low = np.array([margin, margin])
        self.high = np.array(self.picture.shape[1::-1]) - margin
        if (self.high - self.low < self.stride).any():
            raise PictureError(
                f"picture: {self.picture.shape[1]} x {self.picture.shape[0]} pixels are too few for a "
                f"view of {self.view} and moves of {self.stride:g}"
            )
        shares = [_within("goal", share, 0, 1) for share in _numbers("goal", goal, 2)]
        self.goal = self.low + np.array(shares) * (self.high - self.low)
        self.observation_space = spaces.Box(0, 255, (self.view, self.view, 3), np.uint8)
        self.position = self.low.copy()
        self._moves = 0

    def observe(self) -> _Picture:
        """Return what the camera sees at its position, as in :meth:`step`.

        Returns
        -------
        ndarray of uint8, [view, view, 3]
        """
        random = self.np_random
        angle = np.deg2rad(random.uniform(-self.turn, self.turn)) if self.turn else 0.0
        size = 1 + self.scale * random.uniform(-1, 1)
        steps = (np.arange(self.view) - (self.view - 1) / 2) * size
        x, y = np.meshgrid(steps, steps)
        across, down = np.cos(angle), np.sin(angle)
        seen = _sampled(
            self.picture,
            self.position[0] + x * across - y * down,
            self.position[1] + x * down + y * across,
        )
        seen *= 1 + self.light * random.uniform(-1, 1)
        seen += self.noise * random.standard_normal(seen.shape, np.float32)
        return np.clip(seen, 0, 255).astype(np.uint8)

    def _observe(self) -> _Picture:
        return self.observe()

    def _blocked(self, position: npt.NDArray[np.float64]) -> bool:
        x, y = position
        inside = any(a <= x <= c and b <= y <= d for a, b, c, d in self.walls)
        return inside or bool((position < self.low).any() or (position > self.high).any())

    def _info(self) -> dict[str, Any]:
        return {"position": self.position.copy()}

    def _start(self) -> None:
        for _ in range(10_000):
            self.position = self.np_random.uniform(self.low, self.high)
            far = np.hypot(*(self.position - self.goal)) > _SPREAD * self.radius
            if far and not self._blocked(self.position):
                self._moves = 0
                return
        raise ConfigError("goal and walls leave no place to start an episode")

    def _move(self, action: int) -> tuple[float, bool, bool]:
        error = self.slip * self.np_random.standard_normal(2)
        moved = self.position + self.stride * (_MOVES[action] + error)
        moved = np.clip(moved, self.low, self.high)
        way = moved - self.position
        if not any(self._blocked(self.position + share * way) for share in _WAY):
            self.position = moved
        arrived = bool(np.hypot(*(self.position - self.goal)) < self.radius)
        self._moves += 1
        return 100.0 if arrived else -1.0, arrived, not arrived and self._moves >= self.limit

    def towards(self) -> int:
        """Return the move along the longer way to the goal, walls aside: a yardstick for learners.

        Returns
        -------
        int
        """
        x, y = self.goal - self.position
        if abs(x) > abs(y):
            return 1 if x > 0 else 3
        return 2 if y > 0 else 0


def _within(name: str, value: Any, low: float, high: float) -> float:
    number = real(name, value)
    if not low <= number <= high:
        raise ConfigError(f"{name}: {shown(value)} is not in [{low:g}, {high:g}]")
    return number


def _numbers(name: str, value: Any, count: int) -> tuple[float, ...]:
    numbers = tuple(real(name, number) for number in listed(name, value, "numbers"))
    if len(numbers) != count:
        raise ConfigError(f"{name}: {shown(value)} has {len(numbers)} numbers, expected {count}")
    return numbers


def _checked(picture: Any) -> _Picture:
    if not isinstance(picture, np.ndarray) or picture.dtype != np.uint8:
        raise PictureError("picture: must be an array of uint8")
    if picture.ndim == 2:
        picture = np.stack([picture] * 3, 2)
    if picture.ndim != 3 or picture.shape[2] != 3:
        raise PictureError(
            f"picture: is {list(picture.shape)}, expected [height, width] or [height, width, 3]"
        )
    checked: _Picture = picture
    return checked


def _sampled(
    picture: _Picture, x: npt.NDArray[np.float64], y: npt.NDArray[np.float64]
) -> npt.NDArray[np.float32]:
    """Return the picture's colours at real-valued places, by bilinear interpolation."""
    height, width = picture.shape[:2]
    x, y = np.clip(x, 0, width - 1.001), np.clip(y, 0, height - 1.001)
    left, top = x.astype(np.intp), y.astype(np.intp)
    right = (x - left).astype(np.float32)[..., None]
    down = (y - top).astype(np.float32)[..., None]
    above = picture[top, left] * (1 - right) + picture[top, left + 1] * right
    below = picture[top + 1, left] * (1 - right) + picture[top + 1, left + 1] * right
    return np.asarray(above * (1 - down) + below * down, np.float32)
