# SPDX-License-Identifier: MIT
"""Learning from logs: arrays, NPZ, CSV, Minari data sets, and the logs that a controller writes.

A log is a sequence of episodes of T interactions. In arrays, each episode has T + 1 observations:
the last one is the observation after the last interaction. All other arrays have T elements for
each episode. An episode ends where ``terminated`` or ``truncated`` is true; a log that stops in the
middle of an episode counts as truncated there.

The log of a controller (``core/include/rlvc/log.h``) holds percepts, not observations. A record
that a power failure cut short is skipped; other damage is an error.

All readers return a :class:`Log`. They raise :class:`~rlvc.errors.LogError` if the log cannot be
read or is damaged; the message names the file, the line or index, and the fault.
"""

from .array_log import from_arrays, from_npz
from .controller_log import from_records
from .csv_log import from_csv
from .learn_from import learn_from, read
from .log import Log
from .minari_log import from_minari

__all__ = [
    "Log",
    "from_arrays",
    "from_csv",
    "from_minari",
    "from_npz",
    "from_records",
    "learn_from",
    "read",
]
