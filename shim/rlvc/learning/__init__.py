# SPDX-License-Identifier: MIT
"""Learning from Gymnasium environments."""

from .encode import Columns, Encoder, Numbers, explain
from .run import Record, Run

__all__ = ["Columns", "Encoder", "Numbers", "Record", "Run", "explain"]
