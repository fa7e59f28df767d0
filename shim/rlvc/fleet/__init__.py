# SPDX-License-Identifier: MIT
"""Learning from the logs of a fleet: more interactions than one machine holds.

Interactions are counted where they are, by this process or by tasks of Ray or Dask, and the counts are
added up. The tree depends on the counts alone, so that it is the one that :func:`rlvc.learn_from` would
make of all interactions, bit for bit.
"""

from .convert import convert, export
from .learn import FleetRun, Report, learn_from

__all__ = ["FleetRun", "Report", "convert", "export", "learn_from"]
