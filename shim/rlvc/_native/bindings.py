# SPDX-License-Identifier: MIT
"""The C interface: constants, structs and functions. Written by tools/check/bindings.py --write."""

from __future__ import annotations

import ctypes as c
from typing import Any

Functions = dict[str, tuple[Any, list[Any]]]  # a name: what it returns, what it takes

OK = 0
E_NULL = -1
E_CONFIG = -2
E_MEMORY = -3
E_ORDER = -4
E_RANGE = -5
E_REWARD = -6
E_BUSY = -7
E_CALLBACK = -8
E_REENTERED = -9
E_STORE = -10
E_EMPTY = -11
E_DAMAGED = -12
E_VERSION = -13
E_MISMATCH = -14
E_PERCEPT = -15
DETECT_SAMPLES = 64
DETECT_FEATURES = 64
DOMAIN_OWN = 0
DOMAIN_BITS = 1
DOMAIN_DESCRIPTORS = 2
DOMAIN_THRESHOLDS = 3
DOMAIN_SPATIAL = 4
DOMAIN_BAGS = 5
NAME_BYTES = 64
ALIGNMENT = 8
REWARD_MAX = 1000000000000.0
CRITERION_RETURNS = 0
CRITERION_RESIDUAL = 1
SCORE_GAIN = 0
SCORE_RANKS = 3
SOLVER_VALUE_ITERATION = 0
SOLVER_POLICY_ITERATION = 1
SOLVER_Q_LEARNING = 2
SOLVER_SARSA = 3
EXPLORE_UNIFORM = 0
EXPLORE_DIRECTED = 1
AGENT_FIXED_BYTES = 1024
SPLIT_BYTES = 32
GOES_ON = 0
TERMINATED = 1
TRUNCATED = 2
BUDGET_MIN = 64
BUDGET_UNBOUNDED = 4294967295
SOLUTION_CONVERGED = 0
SOLUTION_CUT_SHORT = 1
SOLUTION_ENDLESS = 2
RESIDUAL_ENDLESS = 1e+30
PRINT_TEXT = 0
PRINT_DOT = 1
PRINT_JSON = 2
DESCRIPTORS_FLOAT = 0
DESCRIPTORS_INT8 = 1
DESCRIPTORS_POINTS_MAX = 1000
DESCRIPTORS_DIMENSIONS_MAX = 256
DESCRIPTORS_CANDIDATES_MAX = 65535
DESCRIPTORS_DRAWS_MAX = 64
BAGS_SIZE_MAX = 32
BITS_MAX = 1024
BITS_FEATURE_BYTES = 2
CHI2_DEGREES_MAX = 255
FISHER_EXPECTED_MAX = 25
COUNTS_FEATURES_MAX = 1024
CELL_BITS_MAX = 64
COUNTS_MAX = 281474976710655
EXACT_SUM_WORDS = 4
LOG_VERSION = 1
LOG_END = 0
LOG_HEADER = 1
LOG_BEGIN = 2
LOG_OBSERVE = 3
LOG_LENGTHS = 4
MIN_TREE_ACTIONS_MAX = 64
MIN_TREE_ROWS_MAX = 16777216
MIN_TREE_FEATURES_MAX = 65535
MIN_TREE_ENTRIES_MAX = 268435456
MIN_TREE_EFFORT_MAX = 549755813888
SNAPSHOT_VERSION = 1
STORE_UNIT = 64
SLOT_BYTES_MAX = 2147483584
SNAPSHOT_FIXED_BYTES = 225
PLANNER_COMPONENTS_MAX = 64
PLANNER_ACTIONS_MAX = 64
PLANNER_CAPACITY_MAX = 100000000
PLANNER_MODEL_LEAVES_MAX = 256
PLANNER_LEAVES_MAX = 16
PLANNER_CANDIDATES_MAX = 1000000
PLANNER_NUMBER_MAX = 1000000000.0
PLANNER_LEAF = 65535
PLANNER_POLICY_BYTES = 2048
PLANNER_RANDOM = 0
PLANNER_EXPLORE = 1
PLANNER_NEW = 2
PLANNER_AGAIN = 3
PLANNER_LEARNT = 0
PLANNER_NO_EPISODE = 1
PLANNER_NO_DIFFERENCE = 2
PLANNER_SNAPSHOT_VERSION = 65538
THRESHOLDS_COMPONENTS_MAX = 1024
THRESHOLDS_OBLIQUE_MAX = 64
THRESHOLDS_CUTPOINTS_MAX = 65535
THRESHOLDS_NUMBER_MAX = 1000000000000000.0
THRESHOLDS_FEATURE_BYTES = 12
THRESHOLDS_NONE = 3e+38
SHIM_RECORDS_PERCEPT = 1048576
SHIM_RECORDS_ROOM = 1048589
VISION_OK = 0
VISION_E_NULL = -101
VISION_E_CONFIG = -102
VISION_E_PICTURE = -103
VISION_E_ROOM = -104
VISION_E_RANGE = -105
VISION_E_FEW = -106
VISION_E_FILE = -107
VISION_E_FORMAT = -108
VISION_E_DESCRIPTOR = -109
VISION_E_METRIC = -110
VISION_E_MEMORY = -111
VISION_E_INTERNAL = -112
DESCRIPTOR_INVARIANTS = 0
DESCRIPTOR_SQRT_INVARIANTS = 1
DESCRIPTOR_SIFT_UPRIGHT = 2
DESCRIPTOR_SIFT = 3
DESCRIPTOR_ORB = 4
DESCRIPTOR_QUARTERS = 5
DESCRIPTORS = 6
DIMENSIONS_INVARIANTS = 8
DIMENSIONS_SIFT = 128
DIMENSIONS_ORB = 256
DIMENSIONS_QUARTERS = 12
DIMENSIONS_MAX = 256
FORM_FLOAT = 0
FORM_INT8 = 1
PLACES_NONE = 0
PLACES_POINTS = 1
PLACES_DIRECTED = 2
POINTS_MAX = 1000
PICTURE_GREY = 0
PICTURE_BGR = 1
PICTURE_RGB = 2
PICTURE_SIDE_MAX = 32767
METRIC_PLAIN = 0
METRIC_COVARIANCE = 1
METRIC_CHANGE = 2
METRIC_DISCRIMINANT = 3
PAIR_COPIES = 0
PAIR_VIEWS = 1


class Sample(c.Structure):
    """``rlvc_sample``."""

    _fields_ = [("key", c.c_uint32), ("slot", c.c_uint32)]


class Samples(c.Structure):
    """``rlvc_samples``."""

    _fields_ = [
        ("percepts", c.c_void_p), ("sample", c.c_void_p), ("percept_bytes", c.c_uint32),
        ("count", c.c_uint32),
    ]


DOMAIN_EXHIBITS = c.CFUNCTYPE(c.c_int, c.c_void_p, c.c_void_p, c.c_void_p, c.POINTER(c.c_uint8))


DOMAIN_CANDIDATES = c.CFUNCTYPE(
    c.c_int, c.c_void_p, c.POINTER(Samples), c.c_uint32, c.c_uint32, c.c_void_p,
    c.POINTER(c.c_uint32),
)


DOMAIN_DETECT = c.CFUNCTYPE(
    c.c_int, c.c_void_p, c.POINTER(Samples), c.c_uint32, c.c_uint32, c.c_void_p, c.c_uint32,
    c.POINTER(c.c_uint64),
)


DOMAIN_ORACLE = c.CFUNCTYPE(
    c.c_int, c.c_void_p, c.POINTER(Samples), c.c_uint32, c.c_void_p, c.POINTER(c.c_uint32),
)


DOMAIN_NAME = c.CFUNCTYPE(c.c_int, c.c_void_p, c.c_void_p, c.c_void_p, c.c_uint32)


DOMAIN_CHECK_PERCEPT = c.CFUNCTYPE(c.c_int, c.c_void_p, c.c_void_p)


DOMAIN_CHECK_FEATURE = c.CFUNCTYPE(c.c_int, c.c_void_p, c.c_void_p)


class Domain(c.Structure):
    """``rlvc_domain``."""

    _fields_ = [
        ("ctx", c.c_void_p), ("percept_bytes", c.c_uint32), ("feature_bytes", c.c_uint32),
        ("features_max", c.c_uint32), ("kind", c.c_uint32), ("exhibits", DOMAIN_EXHIBITS),
        ("candidates", DOMAIN_CANDIDATES), ("detect", DOMAIN_DETECT), ("oracle", DOMAIN_ORACLE),
        ("name", DOMAIN_NAME), ("check_percept", DOMAIN_CHECK_PERCEPT),
        ("check_feature", DOMAIN_CHECK_FEATURE), ("percept_words", c.c_uint32),
        ("feature_words", c.c_uint32), ("feature_halves", c.c_uint32), ("method", c.c_void_p),
    ]


class Config(c.Structure):
    """``rlvc_config``."""

    _fields_ = [
        ("method", c.c_void_p), ("actions", c.c_uint32), ("capacity", c.c_uint32),
        ("classes", c.c_uint32), ("features_at_once", c.c_uint32), ("min_samples", c.c_uint32),
        ("max_sweeps", c.c_uint32), ("seed", c.c_uint32), ("criterion", c.c_uint8),
        ("score", c.c_uint8), ("solver", c.c_uint8), ("continuing", c.c_uint8),
        ("successors", c.c_uint8), ("explore", c.c_uint8), ("dependence", c.c_uint8),
        ("reserved", c.c_uint8), ("discount", c.c_float), ("epsilon", c.c_float),
        ("alpha", c.c_float), ("alpha_known", c.c_float), ("tolerance", c.c_float),
        ("learning_rate", c.c_float), ("smallest_effect", c.c_float), ("sample", c.c_uint32),
        ("model_leaves", c.c_uint32), ("leaves", c.c_uint32), ("horizon", c.c_uint32),
        ("random", c.c_uint32), ("candidates", c.c_uint32), ("patience", c.c_uint32),
    ]


class Choice(c.Structure):
    """``rlvc_choice``."""

    _fields_ = [("action", c.c_uint8), ("exploited", c.c_uint8)]


class Progress(c.Structure):
    """``rlvc_progress``."""

    _fields_ = [
        ("work", c.c_uint32), ("rounds", c.c_uint32), ("splits", c.c_uint32),
        ("done", c.c_uint8), ("reserved", c.c_uint8 * 3),
    ]


class Statistics(c.Structure):
    """``rlvc_statistics``."""

    _fields_ = [
        ("interactions", c.c_uint64), ("stored", c.c_uint32), ("step", c.c_uint32),
        ("classes", c.c_uint32), ("depth", c.c_uint32), ("last_split", c.c_uint32),
        ("refused", c.c_uint32), ("sweeps", c.c_uint32), ("residual", c.c_float),
        ("solution", c.c_uint32), ("reserved", c.c_uint32),
    ]


class Split(c.Structure):
    """``rlvc_split``."""

    _fields_ = [
        ("class_id", c.c_uint32), ("step", c.c_uint32), ("action", c.c_uint32),
        ("samples", c.c_uint32), ("log_tests", c.c_float), ("score", c.c_float),
        ("log_p", c.c_float),
    ]


WRITE = c.CFUNCTYPE(c.c_int, c.c_void_p, c.c_void_p, c.c_size_t)


class Descriptors(c.Structure):
    """``rlvc_descriptors``."""

    _fields_ = [
        ("points", c.c_uint32), ("dimensions", c.c_uint32), ("candidates", c.c_uint32),
        ("draws", c.c_uint32), ("radius", c.c_float), ("margin", c.c_float),
        ("form", c.c_uint8), ("reserved", c.c_uint8 * 3),
    ]


class Bags(c.Structure):
    """``rlvc_bags``."""

    _fields_ = [("vectors", Descriptors), ("size", c.c_uint32)]


class ExactSum(c.Structure):
    """``rlvc_exact_sum``."""

    _fields_ = [("word", c.c_uint64 * 4)]


class CountRow(c.Structure):
    """``rlvc_count_row``."""

    _fields_ = [
        ("count", c.c_uint64), ("now", c.c_uint64), ("next", c.c_uint64), ("reward", c.c_float),
        ("action", c.c_uint8), ("terminated", c.c_uint8), ("reserved", c.c_uint8 * 2),
    ]


class CountPair(c.Structure):
    """``rlvc_count_pair``."""

    _fields_ = [("now", c.c_uint64), ("action", c.c_uint32), ("reserved", c.c_uint32)]


class Counts(c.Structure):
    """``rlvc_counts``."""

    _fields_ = [
        ("row", c.c_void_p), ("with", c.c_void_p), ("follow", c.c_void_p), ("pair", c.c_void_p),
        ("reward", c.c_void_p), ("feature", c.c_void_p), ("tested", c.c_void_p),
        ("rows", c.c_uint32), ("pairs", c.c_uint32), ("features", c.c_uint32),
        ("cell_bits", c.c_uint32),
    ]


class ExportInfo(c.Structure):
    """``rlvc_export_info``."""

    _fields_ = [("leaves", c.c_uint32), ("compact", c.c_uint32), ("bytes", c.c_uint32)]


LOG_WRITER_WRITE = c.CFUNCTYPE(c.c_int, c.c_void_p, c.c_void_p, c.c_uint32)


class LogWriter(c.Structure):
    """``rlvc_log_writer``."""

    _fields_ = [
        ("write", LOG_WRITER_WRITE), ("ctx", c.c_void_p), ("percept_bytes", c.c_uint32),
        ("percept_words", c.c_uint32), ("sequence", c.c_uint16), ("actions", c.c_uint8),
    ]


class LogRecord(c.Structure):
    """``rlvc_log_record``."""

    _fields_ = [
        ("percept", c.c_void_p), ("reward", c.c_float), ("choice", Choice), ("end", c.c_uint8),
        ("kind", c.c_uint8),
    ]


class LogCrc(c.Structure):
    """``rlvc_log_crc``."""

    _fields_ = [("at", c.c_uint64), ("crc", c.c_uint32)]


class LogShift(c.Structure):
    """``rlvc_log_shift``."""

    _fields_ = [("multiple", c.c_uint32 * 16)]


LOG_READER_READ = c.CFUNCTYPE(c.c_int, c.c_void_p, c.c_void_p, c.c_uint32, c.POINTER(c.c_uint32))


class LogReader(c.Structure):
    """``rlvc_log_reader``."""

    _fields_ = [
        ("read", LOG_READER_READ), ("ctx", c.c_void_p), ("buffer", c.c_void_p),
        ("room", c.c_uint32), ("percept_bytes", c.c_uint32), ("percept_words", c.c_uint32),
        ("actions", c.c_uint32), ("from", c.c_uint32), ("held", c.c_uint32), ("at", c.c_uint64),
        ("start", LogCrc), ("reach", LogCrc * 4), ("furthest", c.c_uint64),
        ("shift", LogShift * 4), ("skipped", c.c_uint64), ("damaged", c.c_uint32),
        ("lost", c.c_uint32), ("torn", c.c_uint8), ("skipping", c.c_uint8),
        ("counting", c.c_uint8), ("linked", c.c_uint8), ("sequence", c.c_uint16),
    ]


class MinTreeTask(c.Structure):
    """``rlvc_min_tree_task``."""

    _fields_ = [
        ("row", c.c_void_p), ("allowed", c.c_void_p), ("rows", c.c_uint32),
        ("features", c.c_uint32), ("entries", c.c_uint32), ("reserved", c.c_uint32),
        ("effort", c.c_uint64),
    ]


class MinTreeSplit(c.Structure):
    """``rlvc_min_tree_split``."""

    _fields_ = [("leaf", c.c_uint32), ("feature", c.c_uint32)]


class MinTreeResult(c.Structure):
    """``rlvc_min_tree_result``."""

    _fields_ = [
        ("split", c.c_void_p), ("action", c.c_void_p), ("leaves", c.c_uint32),
        ("exact", c.c_uint8), ("reserved", c.c_uint8 * 3),
    ]


class PolicyConfig(c.Structure):
    """``rlvc_policy_config``."""

    _fields_ = [
        ("tolerance", c.c_float), ("percepts", c.c_uint32), ("entries", c.c_uint32),
        ("reserved", c.c_uint32), ("effort", c.c_uint64),
    ]


class PolicyInfo(c.Structure):
    """``rlvc_policy_info``."""

    _fields_ = [
        ("classes", c.c_uint32), ("collapsed", c.c_uint32), ("leaves", c.c_uint32),
        ("percepts", c.c_uint32), ("features", c.c_uint32), ("bytes", c.c_uint32),
        ("exact", c.c_uint8), ("as_agent", c.c_uint8), ("reserved", c.c_uint8 * 2),
        ("value_before", c.c_float), ("value_after", c.c_float),
    ]


STORE_READ = c.CFUNCTYPE(c.c_int, c.c_void_p, c.c_uint32, c.c_void_p, c.c_uint32)


STORE_WRITE = c.CFUNCTYPE(c.c_int, c.c_void_p, c.c_uint32, c.c_void_p, c.c_uint32)


STORE_ERASE = c.CFUNCTYPE(c.c_int, c.c_void_p, c.c_uint32, c.c_uint32)


STORE_SYNC = c.CFUNCTYPE(c.c_int, c.c_void_p)


class Store(c.Structure):
    """``rlvc_store``."""

    _fields_ = [
        ("ctx", c.c_void_p), ("slot_bytes", c.c_uint32), ("read", STORE_READ),
        ("write", STORE_WRITE), ("erase", STORE_ERASE), ("sync", STORE_SYNC),
    ]


class SnapshotInfo(c.Structure):
    """``rlvc_snapshot_info``."""

    _fields_ = [
        ("version", c.c_uint32), ("sequence", c.c_uint32), ("slot", c.c_uint32),
        ("bytes", c.c_uint32), ("percept_bytes", c.c_uint32), ("feature_bytes", c.c_uint32),
        ("config", Config),
    ]


class PlannerTest(c.Structure):
    """``rlvc_planner_test``."""

    _fields_ = [
        ("cutpoint", c.c_float), ("component", c.c_uint16), ("child", c.c_uint8),
        ("action", c.c_uint8),
    ]


class PlannerStatistics(c.Structure):
    """``rlvc_planner_statistics``."""

    _fields_ = [
        ("interactions", c.c_uint32), ("episodes", c.c_uint32), ("explored", c.c_uint32),
        ("fits", c.c_uint32), ("searches", c.c_uint32), ("candidates", c.c_uint32),
        ("leaves", c.c_uint32), ("tried", c.c_uint32), ("score", c.c_float),
        ("beta", c.c_float), ("deviation", c.c_float), ("acting", c.c_uint8),
        ("verdict", c.c_uint8), ("reserved", c.c_uint8 * 2),
    ]


class Spatial(c.Structure):
    """``rlvc_spatial``."""

    _fields_ = [
        ("vectors", Descriptors), ("pairs", c.c_uint32), ("directed", c.c_uint8),
        ("reserved", c.c_uint8 * 3),
    ]


class Thresholds(c.Structure):
    """``rlvc_thresholds``."""

    _fields_ = [
        ("components", c.c_uint32), ("cutpoints", c.c_uint32), ("oblique", c.c_uint8),
        ("reserved", c.c_uint8 * 3),
    ]


class Threshold(c.Structure):
    """``rlvc_threshold``."""

    _fields_ = [
        ("cutpoint", c.c_float), ("slope", c.c_float), ("component", c.c_uint16),
        ("other", c.c_uint16),
    ]


class GridworldMaze(c.Structure):
    """``gridworld_maze``."""

    _fields_ = [
        ("width", c.c_uint32), ("height", c.c_uint32), ("free_cells", c.c_uint32),
        ("cells", c.c_void_p),
    ]


class GridworldError(c.Structure):
    """``gridworld_error``."""

    _fields_ = [("line", c.c_uint32), ("column", c.c_uint32), ("what", c.c_char_p)]


class GridworldRandom(c.Structure):
    """``gridworld_random``."""

    _fields_ = [("state", c.c_uint64)]


class Gridworld(c.Structure):
    """``gridworld``."""

    _fields_ = [
        ("maze", c.c_void_p), ("random", GridworldRandom), ("distractors", c.c_uint32),
        ("slip", c.c_uint32), ("cell", c.c_uint32),
    ]


class ShimEntry(c.Structure):
    """``rlvc_shim_entry``."""

    _fields_ = [("name", c.c_char_p), ("value", c.c_size_t)]


class ShimLog(c.Structure):
    """``rlvc_shim_log``."""

    _fields_ = [
        ("percepts", c.c_void_p), ("next", c.c_void_p), ("choices", c.c_void_p),
        ("rewards", c.c_void_p), ("ends", c.c_void_p), ("count", c.c_size_t),
        ("bytes", c.c_uint32), ("actions", c.c_uint32), ("resume", c.c_uint32),
    ]


class ShimRecords(c.Structure):
    """``rlvc_shim_records``."""

    _fields_ = [
        ("percepts", c.c_void_p), ("next", c.c_void_p), ("choices", c.c_void_p),
        ("rewards", c.c_void_p), ("ends", c.c_void_p), ("interactions", c.c_size_t),
        ("fault_at", c.c_size_t), ("percept_bytes", c.c_uint32), ("actions", c.c_uint32),
        ("torn", c.c_uint32), ("reserved", c.c_uint32),
    ]


class ShimColumns(c.Structure):
    """``rlvc_shim_columns``."""

    _fields_ = [
        ("percepts", c.c_void_p), ("next", c.c_void_p), ("keys", c.c_void_p),
        ("rewards", c.c_void_p), ("actions", c.c_void_p), ("ends", c.c_void_p),
        ("count", c.c_size_t),
    ]


class ShimTable(c.Structure):
    """``rlvc_shim_table``."""

    _fields_ = [
        ("row", c.c_void_p), ("with", c.c_void_p), ("follow", c.c_void_p),
        ("lanes", c.c_void_p), ("pending", c.c_void_p), ("row_index", c.c_void_p),
        ("reward", c.c_void_p), ("row_pair", c.c_void_p), ("pair", c.c_void_p),
        ("pair_index", c.c_void_p), ("gather", c.c_void_p), ("spread", c.c_void_p),
        ("gather_byte", c.c_void_p), ("rows", c.c_uint32), ("rows_max", c.c_uint32),
        ("pairs", c.c_uint32), ("pairs_max", c.c_uint32), ("features", c.c_uint32),
        ("percept_bytes", c.c_uint32), ("gather_bytes", c.c_uint32), ("actions", c.c_uint32),
    ]


class ShimText(c.Structure):
    """``rlvc_shim_text``."""

    _fields_ = [("bytes", c.c_void_p), ("room", c.c_size_t), ("size", c.c_size_t)]


class ShimMemory(c.Structure):
    """``rlvc_shim_memory``."""

    _fields_ = [("bytes", c.c_void_p), ("size", c.c_size_t)]


class ShimPython(c.Structure):
    """``rlvc_shim_python``."""

    _fields_ = [
        ("exhibits", c.c_void_p), ("candidates", c.c_void_p), ("detect", c.c_void_p),
        ("oracle", c.c_void_p), ("name", c.c_void_p), ("check_percept", c.c_void_p),
        ("check_feature", c.c_void_p), ("type", c.c_void_p), ("value", c.c_void_p),
        ("traceback", c.c_void_p), ("depth", c.c_uint32), ("reserved", c.c_uint32),
    ]


class VisionError(c.Structure):
    """``rlvc_vision_error``."""

    _fields_ = [("text", c.c_char * 256)]


class VisionConfig(c.Structure):
    """``rlvc_vision_config``."""

    _fields_ = [
        ("descriptor", c.c_uint32), ("points", c.c_uint32), ("radius", c.c_uint32),
        ("form", c.c_uint8), ("normalise", c.c_uint8), ("axes", c.c_uint8),
        ("places", c.c_uint8), ("sd", c.c_float), ("si", c.c_float), ("k", c.c_float),
        ("threshold", c.c_float), ("sigma", c.c_float), ("noise", c.c_float),
    ]


class Point(c.Structure):
    """``rlvc_point``."""

    _fields_ = [("x", c.c_float), ("y", c.c_float), ("response", c.c_float)]


class Picture(c.Structure):
    """``rlvc_picture``."""

    _fields_ = [
        ("pixels", c.c_void_p), ("stride", c.c_ssize_t), ("width", c.c_uint32),
        ("height", c.c_uint32), ("format", c.c_uint32),
    ]


STRUCTS: dict[str, type[c.Structure]] = {
    "rlvc_sample": Sample,
    "rlvc_samples": Samples,
    "rlvc_domain": Domain,
    "rlvc_config": Config,
    "rlvc_choice": Choice,
    "rlvc_progress": Progress,
    "rlvc_statistics": Statistics,
    "rlvc_split": Split,
    "rlvc_descriptors": Descriptors,
    "rlvc_bags": Bags,
    "rlvc_exact_sum": ExactSum,
    "rlvc_count_row": CountRow,
    "rlvc_count_pair": CountPair,
    "rlvc_counts": Counts,
    "rlvc_export_info": ExportInfo,
    "rlvc_log_writer": LogWriter,
    "rlvc_log_record": LogRecord,
    "rlvc_log_crc": LogCrc,
    "rlvc_log_shift": LogShift,
    "rlvc_log_reader": LogReader,
    "rlvc_min_tree_task": MinTreeTask,
    "rlvc_min_tree_split": MinTreeSplit,
    "rlvc_min_tree_result": MinTreeResult,
    "rlvc_policy_config": PolicyConfig,
    "rlvc_policy_info": PolicyInfo,
    "rlvc_store": Store,
    "rlvc_snapshot_info": SnapshotInfo,
    "rlvc_planner_test": PlannerTest,
    "rlvc_planner_statistics": PlannerStatistics,
    "rlvc_spatial": Spatial,
    "rlvc_thresholds": Thresholds,
    "rlvc_threshold": Threshold,
    "gridworld_maze": GridworldMaze,
    "gridworld_error": GridworldError,
    "gridworld_random": GridworldRandom,
    "gridworld": Gridworld,
    "rlvc_shim_entry": ShimEntry,
    "rlvc_shim_log": ShimLog,
    "rlvc_shim_records": ShimRecords,
    "rlvc_shim_columns": ShimColumns,
    "rlvc_shim_table": ShimTable,
    "rlvc_shim_text": ShimText,
    "rlvc_shim_memory": ShimMemory,
    "rlvc_shim_python": ShimPython,
    "rlvc_vision_error": VisionError,
    "rlvc_vision_config": VisionConfig,
    "rlvc_point": Point,
    "rlvc_picture": Picture,
}

CORE: Functions = {
    "rlvc_status_text": (c.c_char_p, [c.c_int]),
    "rlvc_spell": (c.c_uint32, [c.c_float, c.c_uint32, c.c_void_p, c.c_uint32]),
    "rlvc_config_default": (c.c_int, [c.c_void_p, c.c_void_p, c.c_uint32]),
    "rlvc_config_check": (c.c_int, [c.c_void_p, c.c_void_p, c.c_void_p]),
    "rlvc_agent_size": (c.c_int, [c.c_void_p, c.c_void_p, c.c_void_p]),
    "rlvc_agent_init": (c.c_int, [c.c_void_p, c.c_void_p, c.c_void_p, c.c_size_t, c.c_void_p]),
    "rlvc_begin": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_act": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_observe": (c.c_int, [c.c_void_p, Choice, c.c_float, c.c_void_p, c.c_uint8]),
    "rlvc_budget_min": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_learn": (c.c_int, [c.c_void_p, c.c_uint32, c.c_void_p]),
    "rlvc_learn_abandon": (c.c_int, [c.c_void_p]),
    "rlvc_prune": (c.c_int, [c.c_void_p, c.c_float, c.c_float, c.c_void_p]),
    "rlvc_predict": (c.c_int, [c.c_void_p, c.c_void_p, c.c_void_p, c.c_void_p]),
    "rlvc_stats": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_q": (c.c_int, [c.c_void_p, c.c_uint32, c.c_uint32, c.c_void_p, c.c_void_p]),
    "rlvc_value": (c.c_int, [c.c_void_p, c.c_uint32, c.c_void_p, c.c_void_p]),
    "rlvc_split_at": (c.c_int, [c.c_void_p, c.c_uint32, c.c_void_p, c.c_void_p]),
    "rlvc_print": (c.c_int, [c.c_void_p, c.c_uint32, WRITE, c.c_void_p]),
    "rlvc_agent_check": (c.c_int, [c.c_void_p]),
    "rlvc_descriptors_default": (c.c_int, [
        c.c_void_p, c.c_uint32, c.c_uint32, c.c_uint32, c.c_float,
    ]),
    "rlvc_descriptors_domain": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_descriptors_radius": (c.c_float, [c.c_void_p]),
    "rlvc_descriptors_nearest": (c.c_int, [
        c.c_void_p, c.c_void_p, c.c_void_p, c.c_void_p, c.c_void_p,
    ]),
    "rlvc_bags_default": (c.c_int, [c.c_void_p, c.c_uint32, c.c_uint32, c.c_uint32, c.c_float]),
    "rlvc_bags_domain": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_bags_count": (c.c_uint32, [c.c_void_p]),
    "rlvc_bags_needed": (c.c_float, [c.c_void_p]),
    "rlvc_bags_nearest": (c.c_int, [
        c.c_void_p, c.c_void_p, c.c_void_p, c.c_uint32, c.c_void_p, c.c_void_p,
    ]),
    "rlvc_bags_weigh": (c.c_int, [
        c.c_void_p, c.c_void_p, c.c_void_p, c.c_void_p, c.c_void_p, c.c_void_p, c.c_void_p,
    ]),
    "rlvc_bits_domain": (c.c_int, [c.c_uint32, c.c_void_p]),
    "rlvc_chi2_survival": (c.c_int, [c.c_float, c.c_uint32, c.c_void_p, c.c_void_p]),
    "rlvc_chi2_critical": (c.c_int, [c.c_float, c.c_uint32, c.c_void_p]),
    "rlvc_chi2_table": (c.c_int, [c.c_uint32, c.c_uint32, c.c_uint32, c.c_uint32, c.c_void_p]),
    "rlvc_fisher_table": (c.c_int, [
        c.c_uint32, c.c_uint32, c.c_uint32, c.c_uint32, c.c_void_p, c.c_void_p,
    ]),
    "rlvc_exact_sum_add": (None, [c.c_void_p, c.c_float, c.c_uint64]),
    "rlvc_exact_sum_join": (None, [c.c_void_p, c.c_void_p]),
    "rlvc_counts_size": (c.c_int, [c.c_void_p, c.c_void_p, c.c_void_p]),
    "rlvc_learn_counts": (c.c_int, [c.c_void_p, c.c_void_p, c.c_void_p, c.c_size_t, c.c_void_p]),
    "rlvc_export_c": (c.c_int, [c.c_void_p, c.c_void_p, WRITE, c.c_void_p, c.c_void_p]),
    "rlvc_log_open": (c.c_int, [c.c_void_p, c.c_uint32, c.c_uint32, c.c_void_p, c.c_void_p]),
    "rlvc_log_begin": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_log_observe": (c.c_int, [c.c_void_p, Choice, c.c_float, c.c_void_p, c.c_uint8]),
    "rlvc_log_read": (c.c_int, [
        c.c_void_p, c.c_uint32, c.c_uint32, c.c_void_p, c.c_uint32, c.c_void_p, c.c_void_p,
    ]),
    "rlvc_log_next": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_min_tree_size": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_min_tree": (c.c_int, [c.c_void_p, c.c_void_p, c.c_size_t, c.c_void_p]),
    "rlvc_policy_default": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_policy_size": (c.c_int, [c.c_void_p, c.c_void_p, c.c_void_p]),
    "rlvc_policy_make": (c.c_int, [
        c.c_void_p, c.c_void_p, c.c_void_p, c.c_size_t, c.c_void_p, c.c_void_p,
    ]),
    "rlvc_policy_act": (c.c_int, [c.c_void_p, c.c_void_p, c.c_void_p]),
    "rlvc_policy_print": (c.c_int, [c.c_void_p, c.c_uint32, WRITE, c.c_void_p]),
    "rlvc_policy_export_c": (c.c_int, [c.c_void_p, c.c_void_p, WRITE, c.c_void_p, c.c_void_p]),
    "rlvc_snapshot_size": (c.c_int, [c.c_void_p, c.c_void_p, c.c_void_p]),
    "rlvc_save": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_load": (c.c_int, [
        c.c_void_p, c.c_void_p, c.c_void_p, c.c_size_t, c.c_void_p, c.c_void_p,
    ]),
    "rlvc_snapshot_peek": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_planner_ample_size": (c.c_int, [c.c_void_p, c.c_void_p, c.c_void_p]),
    "rlvc_planner_act_at": (c.c_int, [c.c_void_p, c.c_void_p, c.c_void_p]),
    "rlvc_planner_node": (c.c_int, [c.c_void_p, c.c_uint32, c.c_void_p]),
    "rlvc_planner_policy_of": (c.c_int, [
        c.c_void_p, c.c_uint32, c.c_uint32, c.c_void_p, c.c_void_p, c.c_size_t, c.c_void_p,
    ]),
    "rlvc_planner_stats": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_spatial_default": (c.c_int, [
        c.c_void_p, c.c_uint32, c.c_uint32, c.c_uint32, c.c_uint32, c.c_float,
    ]),
    "rlvc_spatial_domain": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_spatial_is_pair": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_spatial_nearest": (c.c_int, [c.c_void_p, c.c_void_p, c.c_void_p, c.c_void_p, c.c_void_p]),
    "rlvc_thresholds_default": (c.c_int, [c.c_void_p, c.c_uint32]),
    "rlvc_thresholds_domain": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_thresholds_policy_domain": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_thresholds_check": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_thresholds_feature": (Threshold, [c.c_void_p]),
    "rlvc_version": (c.c_char_p, []),
    "rlvc_shim_layout": (c.POINTER(ShimEntry), []),
    "rlvc_shim_predict": (c.c_int, [
        c.c_void_p, c.c_void_p, c.c_uint32, c.c_size_t, c.c_void_p, c.c_void_p, c.c_void_p,
    ]),
    "rlvc_shim_policy_act": (c.c_int, [
        c.c_void_p, c.c_void_p, c.c_uint32, c.c_size_t, c.c_void_p, c.c_void_p,
    ]),
    "rlvc_shim_act": (c.c_int, [c.c_void_p, c.c_void_p, c.c_void_p]),
    "rlvc_shim_observe": (c.c_int, [c.c_void_p, c.c_void_p, c.c_void_p]),
    "rlvc_shim_records_read": (c.c_int, [
        c.c_void_p, c.c_size_t, c.c_void_p, c.c_void_p, c.c_void_p,
    ]),
    "rlvc_shim_count": (c.c_int, [c.c_void_p, c.c_void_p, c.c_void_p]),
    "rlvc_shim_count_end": (None, [c.c_void_p]),
    "rlvc_shim_count_add": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_shim_tables": (c.c_int, [
        c.c_void_p, c.c_uint32, c.c_uint32, c.c_void_p, c.c_void_p, c.c_void_p, c.c_void_p,
    ]),
    "rlvc_shim_text_write": (c.c_int, [c.c_void_p, c.c_void_p, c.c_size_t]),
    "rlvc_shim_memory_store": (None, [c.c_void_p, c.c_uint32, c.c_void_p]),
    "rlvc_shim_python_init": (None, [
        c.c_void_p, c.c_void_p, c.c_void_p, c.c_void_p, c.c_void_p, c.c_void_p, c.c_void_p,
    ]),
    "rlvc_shim_python_domain": (None, [c.c_void_p, c.c_void_p]),
    "rlvc_shim_python_raise": (c.c_int, [c.c_void_p]),
    "rlvc_shim_python_forget": (None, [c.c_void_p]),
    "rlvc_shim_give_name": (c.c_int, [c.c_int, c.c_int, c.c_void_p, c.c_void_p]),
    "rlvc_shim_empty_act": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_shim_empty_observe": (c.c_int, [c.c_void_p, Choice, c.c_float, c.c_void_p, c.c_uint8]),
    "rlvc_shim_sutton": (c.POINTER(GridworldMaze), []),
    "rlvc_shim_maze_parse": (c.c_int, [
        c.c_void_p, c.c_void_p, c.c_size_t, c.c_void_p, c.c_size_t, c.c_void_p,
    ]),
    "rlvc_shim_maze_bits": (c.c_uint32, [c.c_void_p, c.c_uint32]),
    "rlvc_shim_maze_encode": (None, [c.c_void_p, c.c_uint32, c.c_uint32, c.c_void_p, c.c_void_p]),
    "rlvc_shim_world_init": (c.c_int, [c.c_void_p, c.c_void_p, c.c_uint32, c.c_float, c.c_uint32]),
    "rlvc_shim_world_reset": (None, [c.c_void_p]),
    "rlvc_shim_world_percept": (None, [c.c_void_p, c.c_void_p]),
    "rlvc_shim_world_step": (c.c_int, [c.c_void_p, c.c_uint32, c.c_void_p]),
}

VISION: Functions = {
    "rlvc_vision_status_text": (c.c_char_p, [c.c_int]),
    "rlvc_vision_config_default": (c.c_int, [c.c_uint32, c.c_void_p]),
    "rlvc_vision_config_check": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_vision_dimensions": (c.c_uint32, [c.c_void_p]),
    "rlvc_descriptor_name": (c.c_char_p, [c.c_uint32]),
    "rlvc_descriptor_named": (c.c_int, [c.c_void_p, c.c_void_p]),
    "rlvc_descriptor_dimensions": (c.c_uint32, [c.c_uint32]),
    "rlvc_vision_percept_bytes": (c.c_uint32, [c.c_void_p]),
    "rlvc_metric_tau": (c.c_float, [c.c_void_p]),
    "rlvc_metric_config": (None, [c.c_void_p, c.c_void_p]),
    "rlvc_metric_kind": (c.c_uint32, [c.c_void_p]),
    "rlvc_metric_save": (c.c_int, [c.c_void_p, c.c_void_p, c.c_void_p]),
    "rlvc_metric_load": (c.c_int, [c.c_void_p, c.c_void_p, c.c_void_p]),
    "rlvc_metric_write": (c.c_int, [c.c_void_p, c.c_void_p, c.c_size_t, c.c_void_p, c.c_void_p]),
    "rlvc_metric_read": (c.c_int, [c.c_void_p, c.c_size_t, c.c_void_p, c.c_void_p]),
    "rlvc_metric_destroy": (None, [c.c_void_p]),
    "rlvc_extractor_create": (c.c_int, [c.c_void_p, c.c_void_p, c.c_void_p, c.c_void_p]),
    "rlvc_extractor_extract": (c.c_int, [
        c.c_void_p, c.c_void_p, c.c_void_p, c.c_size_t, c.c_void_p, c.c_void_p,
    ]),
    "rlvc_extractor_step": (c.c_float, [c.c_void_p]),
    "rlvc_extractor_destroy": (None, [c.c_void_p]),
    "rlvc_fitter_create": (c.c_int, [c.c_void_p, c.c_void_p, c.c_void_p]),
    "rlvc_fitter_add": (c.c_int, [c.c_void_p, c.c_void_p, c.c_uint32, c.c_void_p]),
    "rlvc_fitter_pair": (c.c_int, [c.c_void_p, c.c_void_p, c.c_void_p, c.c_uint32, c.c_void_p]),
    "rlvc_fitter_fit": (c.c_int, [c.c_void_p, c.c_uint32, c.c_float, c.c_void_p, c.c_void_p]),
    "rlvc_fitter_destroy": (None, [c.c_void_p]),
}

OBJECTS: Functions = {
    "rlvc_shim_objects_find": (c.c_int, [
        c.c_void_p, c.c_void_p, c.c_uint32, c.c_uint32, c.c_uint32, c.c_uint32, c.c_void_p,
        c.c_void_p, c.c_size_t,
    ]),
    "rlvc_shim_objects_read": (c.c_int, [
        c.c_void_p, c.c_uint32, c.c_uint32, c.c_void_p, c.c_void_p, c.c_size_t,
    ]),
    "rlvc_shim_objects_size": (None, [c.c_void_p, c.c_void_p, c.c_void_p, c.c_void_p]),
    "rlvc_shim_objects_name": (c.c_char_p, [c.c_void_p, c.c_uint32]),
    "rlvc_shim_objects_copy": (None, [c.c_void_p, c.c_uint32, c.c_int32, c.c_void_p]),
    "rlvc_shim_objects_free": (None, [c.c_void_p]),
}
