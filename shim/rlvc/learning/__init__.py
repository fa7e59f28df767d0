# SPDX-License-Identifier: MIT
"""Learning from Gymnasium environments."""

from .encode import Encoder, Numbers, explain
from .run import Record, Run

__all__ = ["Encoder", "Numbers", "Record", "Run", "explain"]
