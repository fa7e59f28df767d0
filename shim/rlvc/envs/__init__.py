# SPDX-License-Identifier: MIT
"""The paper's mazes as Gymnasium environments: ``rlvc/BinaryGridworld-v0``, ``rlvc/TiledGridworld-v0``.

They use the maze of ``examples/gridworld``, like the tool ``run_gridworld``. ``import rlvc.envs``
registers them.
"""

try:
    import gymnasium
except ImportError:
    raise ImportError("the environments need Gymnasium: pip install 'rlvc[gym]'") from None

from .gridworld import BinaryGridworld, Gridworld
from .maze import ACTIONS, SMALL, Maze
from .tiled import TiledGridworld

__all__ = ["ACTIONS", "SMALL", "BinaryGridworld", "Gridworld", "Maze", "TiledGridworld", "register"]


def register() -> None:
    """Register the environments. Calling it again does nothing."""
    for kind in (BinaryGridworld, TiledGridworld):
        name = f"rlvc/{kind.__name__}-v0"
        if name not in gymnasium.registry:
            gymnasium.register(name, entry_point=f"rlvc.envs:{kind.__name__}")


register()
