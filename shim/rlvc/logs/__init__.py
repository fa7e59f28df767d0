# SPDX-License-Identifier: MIT
"""Learning from logs of any kind: tables, arrays, data sets, and the logs that a controller writes.

A log is a sequence of interactions, in episodes. Each has an observation, an action, a reward, and
what was observed next: in a column of its own, in the next row, or, if an episode of T interactions
has T + 1 observations, in the next of these. An episode ends where it is ``terminated`` or
``truncated``, or with its number; a log that stops in the middle of one counts as truncated there.

==================  =====================================================================
log                 what is read
==================  =====================================================================
CSV, TSV            a row for each interaction; comma, semicolon, tab, bar or blanks, decimal
                    comma, byte order mark, UTF-16, comments, units, arrays in brackets, words
JSON, JSON Lines    an object for each interaction, or for each episode; rows by header=
NPZ, NPY, dict      arrays, as of D4RL; records
lists, pickles      of dicts, named tuples or episodes; of a file nothing is run
HDF5                the same, or a group for each episode: D4RL, d3rlpy, robomimic, Minari
Parquet, Feather    a row for each interaction, as of LeRobot and RLlib; a folder of Parquet
data frames         of pandas and polars, tables of Arrow, data sets of Hugging Face
Minari              data sets, with their spaces
d3rlpy              data sets with episodes
replay buffers      of Stable-Baselines3
rlvc/log.h          percepts; a record that a power failure cut short is skipped
==================

Text, NPZ and pickles may be compressed: gzip, bzip2, xz, or one file in a ZIP. :mod:`rlvc.logs.roles`
lists the names of columns that are understood; ``roles=`` says what others are. ``next_...`` is never a
part of the observation, nor is a column that is another one a row ahead. :meth:`Log.describe` says what
became of each column; :class:`rlvc.errors.LogWarning` says what is left out or lost.

All readers return a :class:`Log`. They raise :class:`~rlvc.errors.LogError` if the log cannot be
read or is damaged; the message names the file, the line, index or column, and the fault.
"""

from .array_log import from_arrays, from_hdf5
from .buffer_log import from_buffer
from .content import SUFFIXES
from .controller_log import from_records
from .csv_log import from_csv
from .frame_log import from_frame, from_parquet
from .joined import joined
from .learn_from import learn_from
from .log import Log
from .minari_log import from_minari
from .object_log import from_json, from_npz, from_objects, from_pickle
from .past import with_history
from .read import described, read

__all__ = [
    "SUFFIXES",
    "Log",
    "described",
    "from_arrays",
    "from_buffer",
    "from_csv",
    "from_frame",
    "from_hdf5",
    "from_json",
    "from_minari",
    "from_npz",
    "from_objects",
    "from_parquet",
    "from_pickle",
    "from_records",
    "joined",
    "learn_from",
    "read",
    "with_history",
]
