# SPDX-License-Identifier: MIT
"""Finds and loads the library, and declares all of it.

The library is loaded twice, which costs nothing: ``call`` keeps the interpreter's lock, for calls
that are over in less than a microsecond; ``long_call`` releases it, for those that are not.
"""

from __future__ import annotations

import ctypes as c
import os
import sys
from pathlib import Path
from typing import Any

from .._version import __version__
from ..errors import LibraryError

# ------------------------------------------------------------------ structs

EXHIBITS = c.CFUNCTYPE(c.c_int, c.c_void_p, c.c_void_p, c.c_void_p, c.POINTER(c.c_uint8))
NAME = c.CFUNCTYPE(c.c_int, c.c_void_p, c.c_void_p, c.c_void_p, c.c_uint32)
WRITE = c.CFUNCTYPE(c.c_int, c.c_void_p, c.c_void_p, c.c_size_t)


STORE_READ = c.CFUNCTYPE(c.c_int, c.c_void_p, c.c_uint32, c.c_void_p, c.c_uint32)
STORE_WRITE = c.CFUNCTYPE(c.c_int, c.c_void_p, c.c_uint32, c.c_void_p, c.c_uint32)
STORE_ERASE = c.CFUNCTYPE(c.c_int, c.c_void_p, c.c_uint32, c.c_uint32)
STORE_SYNC = c.CFUNCTYPE(c.c_int, c.c_void_p)


class Sample(c.Structure):
    """``rlvc_sample``."""

    _fields_ = [("key", c.c_uint32), ("slot", c.c_uint32)]


class Samples(c.Structure):
    """``rlvc_samples``."""

    _fields_ = [
        ("percepts", c.c_void_p),
        ("sample", c.c_void_p),
        ("percept_bytes", c.c_uint32),
        ("count", c.c_uint32),
    ]


CANDIDATES = c.CFUNCTYPE(
    c.c_int, c.c_void_p, c.POINTER(Samples), c.c_uint32, c.c_uint32, c.c_void_p,
    c.POINTER(c.c_uint32),
)  # fmt: skip
DETECT = c.CFUNCTYPE(
    c.c_int, c.c_void_p, c.POINTER(Samples), c.c_uint32, c.c_uint32, c.c_void_p, c.c_uint32,
    c.POINTER(c.c_uint64),
)  # fmt: skip
ORACLE = c.CFUNCTYPE(
    c.c_int, c.c_void_p, c.POINTER(Samples), c.c_uint32, c.c_void_p, c.POINTER(c.c_uint32)
)


class Domain(c.Structure):
    """``rlvc_domain``."""

    _fields_ = [
        ("ctx", c.c_void_p),
        ("percept_bytes", c.c_uint32),
        ("feature_bytes", c.c_uint32),
        ("features_max", c.c_uint32),
        ("exhibits", EXHIBITS),
        ("candidates", CANDIDATES),
        ("detect", DETECT),
        ("oracle", ORACLE),
        ("name", NAME),
    ]


class Descriptors(c.Structure):
    """``rlvc_descriptors``."""

    _fields_ = [
        ("points", c.c_uint32),
        ("dimensions", c.c_uint32),
        ("candidates", c.c_uint32),
        ("draws", c.c_uint32),
        ("radius", c.c_float),
        ("margin", c.c_float),
        ("form", c.c_uint8),
        ("reserved", c.c_uint8 * 3),
    ]


class Thresholds(c.Structure):
    """``rlvc_thresholds``."""

    _fields_ = [
        ("components", c.c_uint32),
        ("cutpoints", c.c_uint32),
        ("oblique", c.c_uint8),
        ("reserved", c.c_uint8 * 3),
    ]


class Threshold(c.Structure):
    """``rlvc_threshold``."""

    _fields_ = [
        ("cutpoint", c.c_float),
        ("slope", c.c_float),
        ("component", c.c_uint16),
        ("other", c.c_uint16),
    ]


class Config(c.Structure):
    """``rlvc_config``."""

    _fields_ = [
        ("actions", c.c_uint32),
        ("capacity", c.c_uint32),
        ("classes", c.c_uint32),
        ("features_at_once", c.c_uint32),
        ("min_samples", c.c_uint32),
        ("max_sweeps", c.c_uint32),
        ("seed", c.c_uint32),
        ("criterion", c.c_uint8),
        ("score", c.c_uint8),
        ("solver", c.c_uint8),
        ("untried", c.c_uint8),
        ("continuing", c.c_uint8),
        ("successors", c.c_uint8),
        ("explore", c.c_uint8),
        ("gate", c.c_uint8),
        ("discount", c.c_float),
        ("epsilon", c.c_float),
        ("alpha", c.c_float),
        ("alpha_known", c.c_float),
        ("tolerance", c.c_float),
        ("learning_rate", c.c_float),
        ("optimistic_value", c.c_float),
    ]


class Choice(c.Structure):
    """``rlvc_choice``."""

    _fields_ = [("action", c.c_uint8), ("exploited", c.c_uint8)]


class Progress(c.Structure):
    """``rlvc_progress``."""

    _fields_ = [
        ("work", c.c_uint32),
        ("rounds", c.c_uint32),
        ("splits", c.c_uint32),
        ("done", c.c_uint8),
        ("reserved", c.c_uint8 * 3),
    ]


class Statistics(c.Structure):
    """``rlvc_statistics``."""

    _fields_ = [
        ("interactions", c.c_uint64),
        ("stored", c.c_uint32),
        ("step", c.c_uint32),
        ("classes", c.c_uint32),
        ("depth", c.c_uint32),
        ("last_split", c.c_uint32),
        ("refused", c.c_uint32),
        ("sweeps", c.c_uint32),
        ("residual", c.c_float),
    ]


class Split(c.Structure):
    """``rlvc_split``."""

    _fields_ = [
        ("class_id", c.c_uint32),
        ("step", c.c_uint32),
        ("action", c.c_uint32),
        ("samples", c.c_uint32),
        ("log_tests", c.c_float),
        ("score", c.c_float),
        ("log_p", c.c_float),
    ]


class PolicyConfig(c.Structure):
    """``rlvc_policy_config``."""

    _fields_ = [
        ("tolerance", c.c_float),
        ("percepts", c.c_uint32),
        ("entries", c.c_uint32),
        ("reserved", c.c_uint32),
        ("effort", c.c_uint64),
    ]


class PolicyInfo(c.Structure):
    """``rlvc_policy_info``."""

    _fields_ = [
        ("classes", c.c_uint32),
        ("collapsed", c.c_uint32),
        ("leaves", c.c_uint32),
        ("percepts", c.c_uint32),
        ("features", c.c_uint32),
        ("bytes", c.c_uint32),
        ("exact", c.c_uint8),
        ("as_agent", c.c_uint8),
        ("reserved", c.c_uint8 * 2),
    ]


class FewestTask(c.Structure):
    """``rlvc_fewest_task``."""

    _fields_ = [
        ("row", c.c_void_p),
        ("allowed", c.c_void_p),
        ("rows", c.c_uint32),
        ("features", c.c_uint32),
        ("entries", c.c_uint32),
        ("reserved", c.c_uint32),
        ("effort", c.c_uint64),
    ]


class FewestTree(c.Structure):
    """``rlvc_fewest_tree``."""

    _fields_ = [
        ("split", c.c_void_p),
        ("action", c.c_void_p),
        ("leaves", c.c_uint32),
        ("exact", c.c_uint8),
        ("reserved", c.c_uint8 * 3),
    ]


class Store(c.Structure):
    """``rlvc_store``."""

    _fields_ = [
        ("ctx", c.c_void_p),
        ("slot_bytes", c.c_uint32),
        ("read", STORE_READ),
        ("write", STORE_WRITE),
        ("erase", STORE_ERASE),
        ("sync", STORE_SYNC),
    ]


class SnapshotInfo(c.Structure):
    """``rlvc_snapshot_info``."""

    _fields_ = [
        ("version", c.c_uint32),
        ("sequence", c.c_uint32),
        ("slot", c.c_uint32),
        ("bytes", c.c_uint32),
        ("percept_bytes", c.c_uint32),
        ("feature_bytes", c.c_uint32),
        ("config", Config),
    ]


class Log(c.Structure):
    """``rlvc_shim_log``."""

    _fields_ = [
        ("percepts", c.c_void_p),
        ("next", c.c_void_p),
        ("choices", c.c_void_p),
        ("rewards", c.c_void_p),
        ("ends", c.c_void_p),
        ("count", c.c_size_t),
        ("bytes", c.c_uint32),
        ("actions", c.c_uint32),
        ("resume", c.c_uint32),
    ]


class Records(c.Structure):
    """``rlvc_shim_records``."""

    _fields_ = [
        ("percepts", c.c_void_p),
        ("next", c.c_void_p),
        ("choices", c.c_void_p),
        ("rewards", c.c_void_p),
        ("ends", c.c_void_p),
        ("interactions", c.c_size_t),
        ("fault_at", c.c_size_t),
        ("percept_bytes", c.c_uint32),
        ("actions", c.c_uint32),
        ("torn", c.c_uint32),
        ("reserved", c.c_uint32),
    ]


class VisionConfig(c.Structure):
    """``rlvc_vision_config``."""

    _fields_ = [
        ("descriptor", c.c_uint32),
        ("points", c.c_uint32),
        ("radius", c.c_uint32),
        ("form", c.c_uint8),
        ("normalise", c.c_uint8),
        ("axes", c.c_uint8),
        ("reserved", c.c_uint8),
        ("sd", c.c_float),
        ("si", c.c_float),
        ("k", c.c_float),
        ("threshold", c.c_float),
        ("sigma", c.c_float),
    ]


class VisionError(c.Structure):
    """``rlvc_vision_error``."""

    _fields_ = [("text", c.c_char * 256)]


class Point(c.Structure):
    """``rlvc_point``."""

    _fields_ = [("x", c.c_float), ("y", c.c_float), ("response", c.c_float)]


class Picture(c.Structure):
    """``rlvc_picture``."""

    _fields_ = [
        ("pixels", c.c_void_p),
        ("stride", c.c_ssize_t),
        ("width", c.c_uint32),
        ("height", c.c_uint32),
        ("format", c.c_uint32),
    ]


class Maze(c.Structure):
    """``gridworld_maze``."""

    _fields_ = [
        ("width", c.c_uint32),
        ("height", c.c_uint32),
        ("free_cells", c.c_uint32),
        ("cells", c.c_void_p),
    ]


class MazeFault(c.Structure):
    """``gridworld_error``."""

    _fields_ = [("line", c.c_uint32), ("column", c.c_uint32), ("what", c.c_char_p)]


class MazeRandom(c.Structure):
    """``gridworld_random``."""

    _fields_ = [("state", c.c_uint64)]


class World(c.Structure):
    """``gridworld``."""

    _fields_ = [
        ("maze", c.POINTER(Maze)),
        ("random", MazeRandom),
        ("distractors", c.c_uint32),
        ("slip", c.c_uint32),
        ("cell", c.c_uint32),
    ]


class _Entry(c.Structure):
    """``rlvc_shim_entry``."""

    _fields_ = [("name", c.c_char_p), ("value", c.c_size_t)]


STRUCTS: dict[str, type[c.Structure]] = {
    "rlvc_config": Config,
    "rlvc_choice": Choice,
    "rlvc_progress": Progress,
    "rlvc_statistics": Statistics,
    "rlvc_split": Split,
    "rlvc_sample": Sample,
    "rlvc_samples": Samples,
    "rlvc_domain": Domain,
    "rlvc_descriptors": Descriptors,
    "rlvc_policy_config": PolicyConfig,
    "rlvc_policy_info": PolicyInfo,
    "rlvc_fewest_task": FewestTask,
    "rlvc_fewest_tree": FewestTree,
    "rlvc_thresholds": Thresholds,
    "rlvc_threshold": Threshold,
    "rlvc_store": Store,
    "rlvc_snapshot_info": SnapshotInfo,
    "rlvc_shim_log": Log,
    "rlvc_shim_records": Records,
    "rlvc_vision_config": VisionConfig,
    "rlvc_vision_error": VisionError,
    "rlvc_point": Point,
    "rlvc_picture": Picture,
    "gridworld_maze": Maze,
    "gridworld_error": MazeFault,
    "gridworld_random": MazeRandom,
    "gridworld": World,
}

# ------------------------------------------------------------------ functions

_P = c.c_void_p  # an agent, a percept, an array, or a struct that byref() gave
_U32 = c.c_uint32

# Name: what it returns, what it takes.
FUNCTIONS: dict[str, tuple[Any, list[Any]]] = {
    # status.h, rlvc.h, bits.h, chi2.h
    "rlvc_status_text": (c.c_char_p, [c.c_int]),
    "rlvc_version": (c.c_char_p, []),
    "rlvc_bits_domain": (c.c_int, [_U32, _P]),
    "rlvc_chi2_survival": (c.c_int, [c.c_float, _U32, _P, _P]),
    "rlvc_chi2_critical": (c.c_int, [c.c_float, _U32, _P]),
    "rlvc_chi2_table": (c.c_int, [_U32, _U32, _U32, _U32, _P]),
    "rlvc_fisher_table": (c.c_int, [_U32, _U32, _U32, _U32, _P, _P]),
    # agent.h
    "rlvc_config_default": (c.c_int, [_P, _P, _U32]),
    "rlvc_config_check": (c.c_int, [_P, _P, _P]),
    "rlvc_agent_size": (c.c_int, [_P, _P, _P]),
    "rlvc_agent_init": (c.c_int, [_P, _P, _P, c.c_size_t, _P]),
    "rlvc_begin": (c.c_int, [_P, _P]),
    "rlvc_act": (c.c_int, [_P, _P]),
    "rlvc_observe": (c.c_int, [_P, Choice, c.c_float, _P, c.c_uint8]),
    "rlvc_learn": (c.c_int, [_P, _U32, _P]),
    "rlvc_prune": (c.c_int, [_P, c.c_float, c.c_float, _P]),
    "rlvc_predict": (c.c_int, [_P, _P, _P, _P]),
    "rlvc_stats": (c.c_int, [_P, _P]),
    "rlvc_q": (c.c_int, [_P, _U32, _U32, _P, _P]),
    "rlvc_value": (c.c_int, [_P, _U32, _P, _P]),
    "rlvc_split_at": (c.c_int, [_P, _U32, _P, _P]),
    "rlvc_print": (c.c_int, [_P, _U32, WRITE, _P]),
    "rlvc_agent_check": (c.c_int, [_P]),
    # export.h
    "rlvc_export_c": (c.c_int, [_P, _P, WRITE, _P, _P]),
    # policy.h, fewest.h
    "rlvc_fewest_size": (c.c_int, [_P, _P]),
    "rlvc_fewest": (c.c_int, [_P, _P, c.c_size_t, _P]),
    "rlvc_policy_default": (c.c_int, [_P, _P]),
    "rlvc_policy_size": (c.c_int, [_P, _P, _P]),
    "rlvc_policy_make": (c.c_int, [_P, _P, _P, c.c_size_t, _P, _P]),
    "rlvc_policy_act": (c.c_int, [_P, _P, _P]),
    "rlvc_policy_print": (c.c_int, [_P, _U32, WRITE, _P]),
    "rlvc_policy_export_c": (c.c_int, [_P, _P, WRITE, _P, _P]),
    # snapshot.h
    "rlvc_snapshot_size": (c.c_int, [_P, _P, _P]),
    "rlvc_save": (c.c_int, [_P, _P]),
    "rlvc_load": (c.c_int, [_P, _P, _P, c.c_size_t, _P, _P]),
    "rlvc_snapshot_peek": (c.c_int, [_P, _P]),
    # descriptors.h
    "rlvc_descriptors_default": (c.c_int, [_P, _U32, _U32, _U32, c.c_float]),
    "rlvc_descriptors_domain": (c.c_int, [_P, _P]),
    "rlvc_descriptors_radius": (c.c_float, [_P]),
    "rlvc_descriptors_nearest": (c.c_int, [_P, _P, _P, _P, _P]),
    # thresholds.h
    "rlvc_thresholds_default": (c.c_int, [_P, _U32]),
    "rlvc_thresholds_domain": (c.c_int, [_P, _P]),
    "rlvc_thresholds_check": (c.c_int, [_P, _P]),
    "rlvc_thresholds_feature": (Threshold, [_P]),
    # domain.h
    "rlvc_spell": (_U32, [c.c_float, _U32, _P, _U32]),
    # log.h, of which only the reader is used, through native/records.c
    "rlvc_log_open": (c.c_int, [_P, _U32, _U32, _P, _P]),
    "rlvc_log_begin": (c.c_int, [_P, _P]),
    "rlvc_log_observe": (c.c_int, [_P, Choice, c.c_float, _P, c.c_uint8]),
    "rlvc_log_read": (c.c_int, [_P, _U32, _U32, _P, _U32, _P, _P]),
    "rlvc_log_next": (c.c_int, [_P, _P]),
    # native/shim.h
    "rlvc_shim_layout": (c.POINTER(_Entry), []),
    "rlvc_shim_predict": (c.c_int, [_P, _P, _U32, c.c_size_t, _P, _P, _P]),
    "rlvc_shim_policy_act": (c.c_int, [_P, _P, _U32, c.c_size_t, _P, _P]),
    "rlvc_shim_act": (c.c_int, [_P, _P, _P]),
    "rlvc_shim_observe": (c.c_int, [_P, _P, _P]),
    "rlvc_shim_records_read": (c.c_int, [_P, c.c_size_t, _P, _P, _P]),
    "rlvc_shim_tables": (c.c_int, [_P, _U32, _U32, _P, _P, _P, _P]),
    "rlvc_shim_empty_act": (c.c_int, [_P, _P]),
    "rlvc_shim_empty_observe": (c.c_int, [_P, Choice, c.c_float, _P, c.c_uint8]),
    "rlvc_shim_sutton": (c.POINTER(Maze), []),
    "rlvc_shim_maze_parse": (c.c_int, [_P, _P, c.c_size_t, _P, c.c_size_t, _P]),
    "rlvc_shim_maze_bits": (_U32, [_P, _U32]),
    "rlvc_shim_maze_encode": (None, [_P, _U32, _U32, _P, _P]),
    "rlvc_shim_world_init": (c.c_int, [_P, _P, _U32, c.c_float, _U32]),
    "rlvc_shim_world_reset": (None, [_P]),
    "rlvc_shim_world_percept": (None, [_P, _P]),
    "rlvc_shim_world_step": (c.c_int, [_P, _U32, _P]),
}

# The same of rlvc/vision.h and of native/objects.h, whose libraries are there where OpenCV is.
VISION: dict[str, tuple[Any, list[Any]]] = {
    "rlvc_vision_status_text": (c.c_char_p, [c.c_int]),
    "rlvc_vision_config_default": (c.c_int, [_U32, _P]),
    "rlvc_vision_config_check": (c.c_int, [_P, _P]),
    "rlvc_descriptor_name": (c.c_char_p, [_U32]),
    "rlvc_descriptor_named": (c.c_int, [c.c_char_p, _P]),
    "rlvc_descriptor_dimensions": (_U32, [_U32]),
    "rlvc_vision_dimensions": (_U32, [_P]),
    "rlvc_vision_percept_bytes": (_U32, [_P]),
    "rlvc_metric_tau": (c.c_float, [_P]),
    "rlvc_metric_config": (None, [_P, _P]),
    "rlvc_metric_kind": (_U32, [_P]),
    "rlvc_metric_save": (c.c_int, [_P, c.c_char_p, _P]),
    "rlvc_metric_load": (c.c_int, [c.c_char_p, _P, _P]),
    "rlvc_metric_write": (c.c_int, [_P, _P, c.c_size_t, _P, _P]),
    "rlvc_metric_read": (c.c_int, [_P, c.c_size_t, _P, _P]),
    "rlvc_metric_destroy": (None, [_P]),
    "rlvc_extractor_create": (c.c_int, [_P, _P, _P, _P]),
    "rlvc_extractor_extract": (c.c_int, [_P, _P, _P, c.c_size_t, _P, _P]),
    "rlvc_extractor_step": (c.c_float, [_P]),
    "rlvc_extractor_destroy": (None, [_P]),
    "rlvc_fitter_create": (c.c_int, [_P, _P, _P]),
    "rlvc_fitter_add": (c.c_int, [_P, _P, _U32, _P]),
    "rlvc_fitter_pair": (c.c_int, [_P, _P, _P, _U32, _P]),
    "rlvc_fitter_fit": (c.c_int, [_P, _U32, c.c_float, _P, _P]),
    "rlvc_fitter_destroy": (None, [_P]),
}
OBJECTS: dict[str, tuple[Any, list[Any]]] = {
    "rlvc_shim_objects_find": (c.c_int, [_P, _P, _U32, _U32, _P, _P, c.c_size_t]),
    "rlvc_shim_objects_size": (None, [_P, _P, _P, _P]),
    "rlvc_shim_objects_name": (c.c_char_p, [_P, _U32]),
    "rlvc_shim_objects_copy": (None, [_P, _U32, c.c_int32, _P]),
    "rlvc_shim_objects_free": (None, [_P]),
}

# status.h, rlvc/agent.h
OK, E_NULL, E_CONFIG, E_MEMORY, E_ORDER, E_RANGE, E_REWARD, E_BUSY, E_CALLBACK, E_REENTERED = (
    -n for n in range(10)
)
E_STORE, E_EMPTY, E_DAMAGED, E_VERSION, E_MISMATCH = (-n for n in range(10, 15))
GOES_ON, TERMINATED, TRUNCATED = range(3)
PRINT_TEXT, PRINT_DOT, PRINT_JSON = range(3)
BUDGET_MIN = 64
DETECT_SAMPLES = DETECT_FEATURES = 64
NAME_BYTES = 64
BITS_MAX = 1024
COMPONENTS_MAX = 1024
NUMBER_MAX = 1e15
ALIGNMENT = 8
RECORDS_PERCEPT = 1 << 20
RECORDS_ROOM = RECORDS_PERCEPT + 13

# ------------------------------------------------------------------ loading

_SUFFIX = {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so")
_PREFIX = "" if sys.platform == "win32" else "lib"


def library_path() -> Path:
    """Where the library lies: inside the package, or where ``RLVC_PYTHON_LIBRARY`` says."""
    named = os.environ.get("RLVC_PYTHON_LIBRARY")
    if named:
        return Path(named)
    return Path(__file__).with_name(f"{_PREFIX}rlvc-python{_SUFFIX}")


def _load(path: Path, kind: type[c.CDLL]) -> Any:
    if not path.exists():
        raise LibraryError(
            f"{path}: no such library. It is made when the package is installed: pip install ."
        )
    try:
        return _declare(kind(str(path)), FUNCTIONS)
    except (OSError, AttributeError) as error:
        raise LibraryError(f"{path}: cannot be used: {error}") from error


def _declare(library: Any, functions: dict[str, tuple[Any, list[Any]]]) -> Any:
    for name, (result, arguments) in functions.items():
        function = getattr(library, name)
        function.restype = result
        function.argtypes = arguments
    return library


def load_seeing(name: str, functions: dict[str, tuple[Any, list[Any]]]) -> Any:
    """Load a library that is there where OpenCV is.

    Parameters
    ----------
    name : str
        Such as ``rlvc-vision``.
    functions : dict
        What is in it.

    Returns
    -------
    ctypes.CDLL

    Raises
    ------
    ImportError
        The package was made without it, or OpenCV is not here; the text says what to install.
    """
    path = PATH.with_name(f"{_PREFIX}{name}{_SUFFIX}")
    if not path.exists():
        raise ImportError(
            f"pictures need {path.name}, which is not in this installation of rlvc ({path.parent}). It "
            "is made where OpenCV's headers are found: on Debian 12, apt-get install libopencv-dev "
            "nlohmann-json3-dev, then install rlvc from its sources again: "
            f"{sys.executable} -m pip install ."
        )
    try:
        return _declare(c.CDLL(str(path)), functions)
    except (OSError, AttributeError) as error:
        raise ImportError(
            f"{path}: cannot be loaded: {error}. It needs the OpenCV that it was made with: on Debian "
            "12, apt-get install libopencv-dev"
        ) from error


def check_version(found: str, path: Path) -> None:
    """Refuses a library of another version than the package's."""
    if found != __version__:
        raise LibraryError(f"{path}: is of version {found}, and the package of {__version__}")


def check_layout(entries: dict[str, int], path: Path) -> None:
    """Refuses a library whose structs are laid out otherwise than those above."""
    for name, struct in STRUCTS.items():
        expected = {name: c.sizeof(struct)}
        for field in struct._fields_:
            expected[f"{name}.{field[0]}"] = getattr(struct, field[0]).offset
        for key, value in expected.items():
            if entries.get(key) != value:
                raise LibraryError(f"{path}: {key} lies at {entries.get(key)}, expected {value}")
    known = set(STRUCTS)
    for key in entries:
        owner, _, field_name = key.partition(".")
        if owner not in known or (field_name and not hasattr(STRUCTS[owner], field_name)):
            raise LibraryError(f"{path}: {key} is not known here")


def layout_of(library: Any) -> dict[str, int]:
    table = library.rlvc_shim_layout()
    entries = {}
    index = 0
    while table[index].name is not None:
        entries[table[index].name.decode()] = table[index].value
        index += 1
    return entries


PATH = library_path()
long_call: Any = _load(PATH, c.CDLL)
check_version(long_call.rlvc_version().decode(), PATH)
check_layout(layout_of(long_call), PATH)
call: Any = _load(PATH, c.PyDLL)


def status_text(status: int) -> str:
    """The library's own sentence for a status."""
    return str(call.rlvc_status_text(status).decode())
