# SPDX-License-Identifier: MIT
"""Reinforcement learning of classes: a small, readable decision tree, learnt from rewards alone.

The method is *Reinforcement Learning of Visual Classes* (S. Jodogne and J. H. Piater, 2004); what is
said to be in a section is in that of "Interactive selection of visual features through reinforcement
learning".
"""

from ._version import __version__
from .agent import Agent
from .batch import Batch
from .config import Config
from .domain import Bits, Descriptors, Domain, Thresholds
from .encode import Encoder
from .errors import Error
from .fewest import Fewest, fewest
from .learning import Record, Run, learn
from .logs import learn_from
from .policy import Compaction, Policy
from .results import CHOICE, Choice, Prediction, Progress, Split, Statistics

__all__ = [
    "CHOICE",
    "Agent",
    "Batch",
    "Bits",
    "Choice",
    "Compaction",
    "Config",
    "Descriptors",
    "Domain",
    "Encoder",
    "Error",
    "Fewest",
    "Policy",
    "Prediction",
    "Progress",
    "Record",
    "Run",
    "Split",
    "Statistics",
    "Thresholds",
    "__version__",
    "fewest",
    "learn",
    "learn_from",
]
