# SPDX-License-Identifier: MIT
"""Learning from logs: arrays, NPZ, CSV, Minari data sets, and the logs that a controller writes.

A log is a list of episodes of T interactions. In arrays, the observations of all episodes follow
one another, T + 1 of each: the last one is what the last interaction led to. Everything else has T
elements an episode. An episode's end is where ``terminated`` or ``truncated`` is true; a log that
stops in the middle of an episode is taken as truncated there.

What a controller wrote holds percepts as they are, and is known by how it begins. What was cut
short when the power went is passed over; other damage is an error.
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
