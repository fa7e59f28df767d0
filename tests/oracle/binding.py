# SPDX-License-Identifier: MIT
"""The C core as the tests of this folder see it: structs and calls of the public headers, no more."""
import ctypes
import os

import numpy

LIBRARY = ctypes.CDLL(os.environ["RLVC_TESTING_LIB"])

U8, U32, U64, FLOAT = ctypes.c_uint8, ctypes.c_uint32, ctypes.c_uint64, ctypes.c_float
POINTER, SIZE = ctypes.c_void_p, ctypes.c_size_t

RETURNS, RESIDUAL = 0, 1
GAIN, RANKS = 0, 3
VALUE_ITERATION, POLICY_ITERATION = 0, 1
GOES_ON, TERMINATED, TRUNCATED = 0, 1, 2


def struct(name, /, **fields):
    return type(name, (ctypes.Structure,), {"_fields_": list(fields.items())})


Domain = struct("Domain", ctx=POINTER, percept_bytes=U32, feature_bytes=U32, features_max=U32, kind=U32,
                exhibits=POINTER, candidates=POINTER, detect=POINTER, oracle=POINTER, name=POINTER,
                check_percept=POINTER, check_feature=POINTER, percept_words=U32, feature_words=U32,
                feature_halves=U32, method=POINTER)
Config = struct("Config", method=POINTER, actions=U32, capacity=U32, classes=U32, features_at_once=U32,
                min_samples=U32, max_sweeps=U32, seed=U32, criterion=U8, score=U8, solver=U8,
                continuing=U8, successors=U8, explore=U8, dependence=U8,
                reserved=U8, discount=FLOAT, epsilon=FLOAT, alpha=FLOAT,
                alpha_known=FLOAT, tolerance=FLOAT, learning_rate=FLOAT, smallest_effect=FLOAT, sample=U32,
                model_leaves=U32, leaves=U32, horizon=U32, random=U32, candidates=U32, patience=U32)
Choice = struct("Choice", action=U8, exploited=U8)
Progress = struct("Progress", work=U32, rounds=U32, splits=U32, done=U8, reserved=U8 * 3)
Statistics = struct("Statistics", interactions=U64, stored=U32, step=U32, classes=U32, depth=U32,
                    last_split=U32, refused=U32, sweeps=U32, residual=FLOAT, solution=U32, reserved=U32)
Split = struct("Split", class_id=U32, step=U32, action=U32, samples=U32, log_tests=FLOAT,
               score=FLOAT, log_p=FLOAT)

for function, arguments in {
    "bits_domain": [U32, POINTER],
    "config_default": [POINTER, POINTER, U32],
    "agent_size": [POINTER, POINTER, POINTER],
    "agent_init": [POINTER, POINTER, POINTER, SIZE, POINTER],
    "agent_check": [POINTER],
    "begin": [POINTER, POINTER],
    "act": [POINTER, POINTER],
    "observe": [POINTER, Choice, FLOAT, POINTER, U8],
    "learn": [POINTER, U32, POINTER],
    "predict": [POINTER, POINTER, POINTER, POINTER],
    "stats": [POINTER, POINTER],
    "q": [POINTER, U32, U32, POINTER, POINTER],
    "value": [POINTER, U32, POINTER, POINTER],
    "split_at": [POINTER, U32, POINTER, POINTER],
}.items():
    getattr(LIBRARY, "rlvc_" + function).argtypes = arguments


def call(function, *arguments):
    """Calls rlvc_<function>; structs and numbers to fill in are passed by reference."""
    passed = [ctypes.byref(a) if isinstance(a, (ctypes.Structure, ctypes._SimpleCData, ctypes.Array))
              and not isinstance(a, Choice) else a for a in arguments]
    status = getattr(LIBRARY, "rlvc_" + function)(*passed)
    assert status == 0, f"rlvc_{function}: status {status}"


class Agent:
    """An agent whose percepts are vectors of 0 and 1."""

    def __init__(self, bits, actions, **fields):
        domain, self.config, size = Domain(), Config(), SIZE()
        call("bits_domain", bits, domain)
        call("config_default", self.config, domain, actions)
        for name, value in fields.items():
            setattr(self.config, name, value)
        call("agent_size", self.config, domain, size)
        self.memory = numpy.zeros(size.value // 8, numpy.uint64)
        made = POINTER()
        call("agent_init", self.config, domain, self.memory.ctypes.data, size.value, made)
        self.pointer, self.bits = made.value, bits

    @staticmethod
    def record(percept):
        return numpy.packbits(numpy.asarray(percept, numpy.uint8), bitorder="little").tobytes()

    def begin(self, percept):
        call("begin", self.pointer, self.record(percept))

    def act(self):
        choice = Choice()
        LIBRARY.rlvc_act(self.pointer, ctypes.byref(choice))
        return choice.action, choice.exploited

    def observe(self, action, exploited, reward, percept, end):
        record = None if percept is None else self.record(percept)
        call("observe", self.pointer, Choice(action, exploited), reward, record, end)

    def learn(self):
        progress = Progress()
        call("learn", self.pointer, 2**32 - 1, progress)
        call("agent_check", self.pointer)
        assert progress.done

    def stats(self):
        statistics = Statistics()
        call("stats", self.pointer, statistics)
        return statistics

    def predict(self, percept):
        class_id, action = U32(), U32()
        call("predict", self.pointer, self.record(percept), class_id, action)
        return class_id.value, action.value

    def splits(self):
        """(Split, bit) for each split, in order."""
        result = []
        for j in range(self.stats().classes - 1):
            split, feature = Split(), ctypes.c_uint16()
            call("split_at", self.pointer, j, split, feature)
            result.append((split, feature.value))
        return result

    def tables(self):
        """Q, how often tried, V and the greedy actions."""
        classes, actions = self.stats().classes, self.config.actions
        q, tried = numpy.zeros((classes, actions)), numpy.zeros((classes, actions), int)
        values, policy = numpy.zeros(classes), numpy.zeros(classes, int)
        number, count = FLOAT(), U32()
        for c in range(classes):
            for a in range(actions):
                call("q", self.pointer, c, a, number, count)
                q[c, a], tried[c, a] = number.value, count.value
            call("value", self.pointer, c, number, count)
            values[c], policy[c] = number.value, count.value
        return q, tried, values, policy
