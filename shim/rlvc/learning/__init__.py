# SPDX-License-Identifier: MIT
"""Learning from Gymnasium environments."""

from .encode import Encoder, Numbers, explain
from .run import Record, Run
from .shrink import shrink
from .small_policy import SmallPolicy
from .trials import Trials

__all__ = ["Encoder", "Numbers", "Record", "Run", "SmallPolicy", "Trials", "explain", "shrink"]
