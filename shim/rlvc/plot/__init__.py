# SPDX-License-Identifier: MIT
"""Pictures that explain what was learnt.

Each function draws from a report (a dict, or the file that ``run_gridworld --json`` or
:mod:`rlvc.report` wrote), a :class:`~rlvc.Run` or an :class:`~rlvc.Agent`, as far as it has what is to
be drawn, and saves to a PNG or an SVG if it is given a file's name.

The colours are those of the cividis map and of Okabe and Ito's palette, which the colour-blind can
tell apart; nothing is said by colour alone.
"""

from __future__ import annotations

try:
    import matplotlib as _  # noqa: F401
except ImportError:
    raise ImportError("rlvc.plot needs Matplotlib: pip install 'rlvc[plot]'") from None

from .curves import learning_curve, splits
from .mazes import maze, tiles, values
from .trees import features, tree

KINDS = {
    "maze": maze,
    "values": values,
    "curve": learning_curve,
    "splits": splits,
    "tree": tree,
    "tiles": tiles,
    "features": features,
}
"""The functions by the names that the command ``python -m rlvc plot`` knows them by."""

__all__ = ["KINDS", "features", "learning_curve", "maze", "splits", "tiles", "tree", "values"]
