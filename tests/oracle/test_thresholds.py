# SPDX-License-Identifier: MIT
"""The domain of thresholds against numpy: its candidates, and an agent that learns with it."""
import ctypes

import numpy
import pytest

from binding import LIBRARY, Domain, struct

Thresholds = struct("Thresholds", components=ctypes.c_uint32, cutpoints=ctypes.c_uint32,
                    oblique=ctypes.c_uint8, reserved=ctypes.c_uint8 * 3)
CANDIDATES = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_uint32, ctypes.c_uint32,
                              ctypes.c_void_p, ctypes.POINTER(ctypes.c_uint32))
DETECT = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_uint32, ctypes.c_uint32,
                          ctypes.c_void_p, ctypes.c_uint32, ctypes.c_void_p)
Samples = struct("Samples", percepts=ctypes.c_void_p, sample=ctypes.c_void_p,
                 percept_bytes=ctypes.c_uint32, count=ctypes.c_uint32)
FEATURE = numpy.dtype([("cutpoint", "f4"), ("slope", "f4"), ("component", "u2"), ("other", "u2")])
NONE = numpy.float32(3e38)
FACTORS = (1, -1, 2, -2, 0.5, -0.5)


class Class:
    """Percepts [n, D] of one class, as the domain's callbacks see them."""

    def __init__(self, percepts, cutpoints, oblique):
        self.x = numpy.ascontiguousarray(percepts, numpy.float32)
        count, components = self.x.shape
        self.pairs = numpy.zeros((count, 2), numpy.uint32)
        self.pairs[:, 1] = numpy.arange(count)
        self.made = Thresholds(components, cutpoints, oblique)
        self.domain = Domain()
        assert LIBRARY.rlvc_thresholds_domain(ctypes.byref(self.made), ctypes.byref(self.domain)) == 0
        self.call_candidates = CANDIDATES(self.domain.candidates)
        self.call_detect = DETECT(self.domain.detect)
        self.samples = Samples(self.x.ctypes.data, self.pairs.ctypes.data, 4 * components, count)

    def candidates(self):
        made, written = [], ctypes.c_uint32(64)
        while written.value == 64:
            block = numpy.zeros(64, FEATURE)
            assert self.call_candidates(self.domain.ctx, ctypes.addressof(self.samples),
                                          sum(map(len, made)), 64, block.ctypes.data, written) == 0
            made.append(block[:written.value])
        return numpy.concatenate(made)

    def detect(self, features, first, count):
        columns = numpy.zeros(len(features), numpy.uint64)
        assert self.call_detect(self.domain.ctx, ctypes.addressof(self.samples), first, count,
                                  features.ctypes.data, len(features), columns.ctypes.data) == 0
        return columns[None, :] >> numpy.arange(count, dtype=numpy.uint64)[:, None] & 1 == 1


def cuts(values, most):
    """The cutpoints of one direction, one a candidate."""
    ordered = numpy.sort(values)
    n = len(ordered)
    m = most if 0 < most < n else n
    lows = ordered[numpy.arange(m) * n // m]
    found = numpy.full(m, NONE)
    for b, low in enumerate(lows):
        above = ordered[ordered > low]
        if len(above) and not (b and lows[b - 1] == low):
            middle = low / numpy.float32(2) + above[0] / numpy.float32(2)
            found[b] = middle if middle < above[0] else low
    return found


def directions(x, oblique):
    """(i, j, w) and the values along each."""
    columns = x.shape[1]
    for i in range(columns):
        yield (i, 0, numpy.float32(0)), x[:, i]
    if not oblique:
        return
    ordered, n = numpy.sort(x, axis=0), len(x)
    spread = ordered[3 * n // 4] - ordered[n // 4]
    for i in range(columns):
        for j in range(i + 1, columns):
            for factor in FACTORS:
                slope = numpy.float32(factor) * (spread[i] / spread[j])
                yield (i, j, slope), x[:, i] + slope * x[:, j]


@pytest.mark.parametrize("count, cutpoints, oblique", [
    (2, 0, 0), (2, 1, 0), (3, 15, 0), (17, 0, 0), (17, 15, 1), (400, 0, 0), (400, 1, 0), (400, 15, 0),
    (400, 15, 1), (400, 64, 1)])
def test_candidates(count, cutpoints, oblique):
    random = numpy.random.default_rng(count)
    x = random.normal(0, [1e-3, 1, 1e5], (count, 3)).astype(numpy.float32)
    x[:, 1] = numpy.round(x[:, 1] * 2) + numpy.arange(count) % 3  # values that recur, and vary
    seen = Class(x, cutpoints, oblique)
    features = seen.candidates()
    expected = [(*direction, cut) for direction, values in directions(x, oblique)
                for cut in cuts(values, cutpoints)]
    assert [(f["component"], f["other"], f["slope"], f["cutpoint"]) for f in features] == expected
    for first in range(0, len(features), 64):
        block = features[first:first + 64].copy()
        here = min(count, 64)
        shown = seen.detect(block, count - here, here)
        value = x[-here:, block["component"]] + block["slope"] * x[-here:, block["other"]]
        assert (shown == (value > block["cutpoint"])).all()
