# SPDX-License-Identifier: MIT
"""Figures of a run.

All functions take the same parameters:

``source``
    A report as a dict, the file of a report (``run_gridworld --json`` and ``python -m rlvc learn
    --json`` write them), a :class:`~rlvc.Run`, or an :class:`~rlvc.Agent`, :class:`~rlvc.Planner` or
    :class:`~rlvc.Policy`. Each function lists the members of the report that it needs.
``file``
    Where to save the figure: a .png, a .svg or a .pdf. None: it is not saved.
``objects``
    The pictures of the Tiled Gridworld: the ``objects`` of its environment. None: they are read
    from the folder that the report names, or rendered; this needs the vision module.
``ax``
    Matplotlib's axes to draw into, of the figures that are a single picture. None: a new figure.

:func:`regions`, :func:`importances`, :func:`path` and :func:`grid` ask the policy itself how it acts:
their source is a :class:`~rlvc.Run`. The policy that is drawn is always the one that acts.

They return the figure, and raise :class:`~rlvc.errors.RunError` if the source lacks a member or the
file is no .png, .svg or .pdf.

The colours are those of the cividis map and of Okabe and Ito's palette, which colour-blind people
can tell apart. No information is in colour alone.
"""

from __future__ import annotations

try:
    import matplotlib as _  # noqa: F401
except ImportError:
    raise ImportError("rlvc.plot needs Matplotlib: pip install 'rlvc[plot]'") from None

from .curves import learning_curve, returns, splits
from .explanations import importances, path
from .grids import grid
from .mazes import maze, tiles, values
from .regions import regions
from .trees import features, tree

KINDS = {
    "maze": maze,
    "values": values,
    "curve": learning_curve,
    "splits": splits,
    "tree": tree,
    "tiles": tiles,
    "features": features,
    "regions": regions,
    "importances": importances,
    "path": path,
    "grid": grid,
}
"""The functions by the names that ``python -m rlvc plot`` uses."""

__all__ = [
    "KINDS",
    "features",
    "grid",
    "importances",
    "learning_curve",
    "maze",
    "path",
    "regions",
    "returns",
    "splits",
    "tiles",
    "tree",
    "values",
]
