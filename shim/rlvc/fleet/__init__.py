# SPDX-License-Identifier: MIT
"""Learning from the logs of a fleet: more interactions than one machine holds.

Interactions are counted where they are, by this process or by tasks of Ray or Dask, and the counts are
added up. The tree depends on the counts alone, so that it is the one that :func:`rlvc.learn_from` would
make of all interactions, bit for bit. Of real numbers a planner learns from a sample that depends on the
content alone.
"""

from .convert import convert, export
from .learn import learn_from
from .run import FleetRun, Report

__all__ = ["FleetRun", "Report", "convert", "export", "learn_from"]
