# SPDX-License-Identifier: MIT
"""Environments for Gymnasium: the paper's mazes and a camera.

``rlvc/BinaryGridworld-v0`` and ``rlvc/TiledGridworld-v0`` use the maze of ``examples/gridworld``, like
the tool ``run_gridworld``; in ``rlvc/GroundView-v0`` a camera moves over a photograph. ``import
rlvc.envs`` registers them.
"""

try:
    import gymnasium
except ImportError:
    raise ImportError("the environments need Gymnasium: pip install 'rlvc[gym]'") from None

from .gridworld import BinaryGridworld, Gridworld
from .ground import GroundView
from .maze import ACTIONS, SMALL, Maze
from .tiled import TiledGridworld

__all__ = [
    "ACTIONS",
    "SMALL",
    "BinaryGridworld",
    "Gridworld",
    "GroundView",
    "Maze",
    "TiledGridworld",
    "register",
]


def register() -> None:
    """Register the environments. Calling it again does nothing."""
    for kind in (BinaryGridworld, GroundView, TiledGridworld):
        name = f"rlvc/{kind.__name__}-v0"
        if name not in gymnasium.registry:
            gymnasium.register(name, entry_point=f"rlvc.envs:{kind.__name__}")


register()
