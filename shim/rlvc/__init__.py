# SPDX-License-Identifier: MIT
"""Reinforcement learning of classes: learns a small, readable decision tree from rewards alone.

The method is *Reinforcement Learning of Visual Classes* (S. Jodogne and J. H. Piater, 2004).
Section numbers in the documentation are those of "Interactive selection of visual features through
reinforcement learning".
"""

# The rooms of the package, from the ground up. A room is a folder or a file; it imports only rooms
# above it in this list (tests/shim/test_rooms.py).
#
#     errors     one exception for each cause
#     checks     numbers that a caller gives
#     _native    the C library: loaded, checked, declared
#     files      reading files, and replacing them as a whole
#     domains    percepts and features (section 5)
#     agent      the agent and the planner, their configurations, snapshots, policies
#     vision     pictures to percepts (sections 3 and 6.2)
#     objects    the pictures of the Tiled Gridworld
#     envs       the paper's mazes as Gymnasium environments
#     words      tests of a tree in the words of a space
#     report     a run as JSON
#     plot       figures
#     learning   the loop around a Gymnasium environment (section 4.2.1), and its result
#     counts     learning from counts of interactions
#     logs       learning from recorded interactions
#     frames     learning from the frames of a camera, with a log beside them
#     fleet      learning from the logs of many machines
#     bench      what the package's calls cost
#     cli        the commands of python -m rlvc
import importlib
from typing import Any

from ._version import __version__
from .agent.agent import Agent
from .agent.batch import Batch
from .agent.config import Config
from .agent.min_tree import MinTree, min_tree
from .agent.planned_policy import PlannedPolicy
from .agent.planner import Planner
from .agent.planner_config import PlannerConfig
from .agent.policy import Compaction, Policy
from .agent.results import (
    CHOICE,
    Choice,
    PlannerStatistics,
    Prediction,
    Progress,
    Split,
    Statistics,
)
from .domains.bags import Bags
from .domains.bits import Bits
from .domains.descriptors import Descriptors
from .domains.domain import Domain
from .domains.spatial import Spatial
from .domains.thresholds import Thresholds
from .errors import Error
from .learning import encode
from .learning.actions import Actions
from .learning.callbacks import CheckpointCallback, CsvCallback, EvalCallback, TensorBoardCallback
from .learning.encode import Encoder
from .learning.evaluation import Evaluation
from .learning.explanation import Explanation
from .learning.learn import learn
from .learning.many import Many, learn_many
from .learning.run import Record, Run
from .learning.store import load
from .logs import learn_from

__all__ = [
    "CHOICE",
    "Actions",
    "Agent",
    "Bags",
    "Batch",
    "Bits",
    "CheckpointCallback",
    "Choice",
    "Compaction",
    "Config",
    "CsvCallback",
    "Descriptors",
    "Domain",
    "Encoder",
    "Error",
    "EvalCallback",
    "Evaluation",
    "Explanation",
    "History",
    "Many",
    "MinTree",
    "PlannedPolicy",
    "Planner",
    "PlannerConfig",
    "PlannerStatistics",
    "Policy",
    "Prediction",
    "Progress",
    "Record",
    "Run",
    "Spatial",
    "Split",
    "Statistics",
    "TensorBoardCallback",
    "Thresholds",
    "__version__",
    "encode",
    "learn",
    "learn_from",
    "learn_many",
    "load",
    "min_tree",
]


def __getattr__(name: str) -> Any:
    """Import what needs Gymnasium or Matplotlib only when it is asked for."""
    if name in ("envs", "plot", "vision"):
        return importlib.import_module(f"{__name__}.{name}")
    if name == "History":
        from .envs.history import History

        return History
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
