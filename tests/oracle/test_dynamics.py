# SPDX-License-Identifier: MIT
"""Model trees: the core's in binary32 against the method in numpy and double."""
import ctypes
import math

import numpy
import pytest

import binding
from binding import FLOAT, POINTER, U8, U32

U16 = ctypes.c_uint16

CUTS, QUANTILE_ROWS, LEAF, FLOOR = 3, 63, 0xFFFF, 1e-6

Experience = binding.struct("Experience", percept=POINTER, reward=POINTER, low=POINTER, high=POINTER, action=POINTER,
                            end=POINTER, components=U32, rows=U32, head=U32, count=U32, total=U32, spare=U32,
                            frozen=U8)
Basis = binding.struct("Basis", mean=POINTER, scale=POINTER, components=U32, actions=U32)
Tree = binding.struct("Tree", node=POINTER, leaf=POINTER, coefficient=POINTER, mean=FLOAT, scale=FLOAT, terms=U16,
                      leaves=U16)
Input = binding.struct("Input", experience=POINTER, basis=POINTER, row=POINTER, count=U32, output=U32, terms=U32,
                       leaves_max=U32, leaf_rows=U32, ridge=FLOAT, slack=FLOAT)
Space = binding.struct("Space", node=POINTER, total=POINTER, bucket=POINTER * CUTS, factor=POINTER, x=POINTER,
                       work=POINTER, sorted=POINTER)
NODE = numpy.dtype([("cut", "f4"), ("test", "u2"), ("child", "u2")])

LIBRARY = binding.LIBRARY
LIBRARY.rlvc_tree_fit_begin.argtypes = 4 * [POINTER]
LIBRARY.rlvc_tree_fit_begin.restype = None
LIBRARY.rlvc_tree_fit_step.argtypes = [POINTER, U32]


class Data:
    """Percepts of two components, three actions, and what follows of the first component."""

    def __init__(self, law, count, seed):
        rng = numpy.random.default_rng(seed)
        self.s = rng.uniform(-1, 1, (count, 2)).astype("f4")
        self.a = rng.integers(0, 3, count).astype("u1")
        follows = law(self.s.astype(float), self.a) + rng.normal(0, 0.02, count)
        self.percept = numpy.zeros((2 * count, 2), "f4")
        self.percept[::2] = self.s
        self.percept[1::2] = self.s
        self.percept[1::2, 0] += follows.astype("f4")
        self.y = (self.percept[1::2, 0] - self.percept[::2, 0]).astype(float)
        self.centre, self.spread = self.s.mean(0), self.s.std(0)
        self.mean, self.scale = numpy.float32(self.y.mean()), numpy.float32(self.y.std())

    def basis(self, terms):
        z = (self.s.astype(float) - self.centre) / self.spread
        columns = [numpy.ones(len(z)), z[:, 0], z[:, 1], self.a == 1, self.a == 2, z[:, 0] ** 2, z[:, 1] * z[:, 0],
                   z[:, 1] ** 2]
        return numpy.stack(columns[:terms], 1).astype(float)


def by_core(data, terms, leaves, ridge, slack):
    """Its nodes, leaves [low, high, noise] and coefficients."""
    count, stride = len(data.s), (terms + 3) // 4 * 4
    actions = numpy.repeat(data.a, 2)
    reward = numpy.zeros(2 * count, "f4")
    rows = numpy.arange(0, 2 * count, 2, dtype="u4")
    experience = Experience(percept=data.percept.ctypes.data, reward=reward.ctypes.data, action=actions.ctypes.data,
                            components=2, rows=2 * count, count=2 * count, head=2 * count - 1)
    basis = Basis(data.centre.ctypes.data, data.spread.ctypes.data, 2, 3)
    arrays = [numpy.zeros(size, "f4") for size in [500] * 10]
    space = Space(arrays[0].ctypes.data, arrays[1].ctypes.data,
                  (POINTER * CUTS)(*(array.ctypes.data for array in arrays[2:5])),
                  *(array.ctypes.data for array in arrays[5:9]))
    nodes, ends = numpy.zeros(2 * leaves - 1, NODE), numpy.zeros((leaves, 3), "f4")
    coefficients = numpy.zeros((leaves, stride), "f4")
    tree = Tree(nodes.ctypes.data, ends.ctypes.data, coefficients.ctypes.data, float(data.mean), float(data.scale))
    given = Input(ctypes.addressof(experience), ctypes.addressof(basis), rows.ctypes.data, count, 0, terms, leaves, 15,
                  ridge, slack)
    fit = numpy.zeros(500, "u1")  # rlvc_tree_fit_cursor is smaller
    LIBRARY.rlvc_tree_fit_begin(fit.ctypes.data, ctypes.addressof(given), ctypes.addressof(space),
                                ctypes.addressof(tree))
    LIBRARY.rlvc_tree_fit_step(fit.ctypes.data, 2**32 - 1)
    return nodes[:2 * tree.leaves - 1], ends[:tree.leaves], coefficients[:tree.leaves, :terms]


class Oracle:
    """The same, as tree_fit.h says, in double. Rows keep the order that the core's partition gives them, as the
    quartiles are those of 63 rows at even distances."""

    def __init__(self, data, terms, leaves, ridge, slack):
        self.x, self.y = data.basis(terms), (data.y - float(data.mean)) / float(data.scale)
        self.data, self.ridge, self.slack, self.leaves_max = data, ridge, slack, leaves
        self.least = max(15, 2 * terms)
        self.price = 1.5 * terms * math.log(len(self.y)) + 2 * math.log(3 * 2 + 3)
        self.tests, self.leaf_of, self.leaf = [(LEAF, 0.0, 0)], [0], {}
        self.rows, self.gain, self.split = [numpy.arange(len(self.y))], {}, {}
        self.fit(0, numpy.zeros(terms))
        while len(self.leaf) < leaves and self.grow():
            pass

    def regress(self, x, e):
        """The coefficients, and the least sum of squares and ridge."""
        penalty = self.ridge * len(e) * numpy.eye(x.shape[1])
        b = numpy.linalg.solve(x.T @ x + penalty, x.T @ e)
        return b, ((e - x @ b) ** 2).sum() + self.ridge * len(e) * b @ b

    @staticmethod
    def length(squares, count):
        return count * math.log(squares / count + FLOOR)

    def fit(self, node, begun):
        rows = self.rows[node]
        x, y = self.x[rows], self.y[rows]
        b = begun + self.regress(x, y - x @ begun)[0]
        left = y - x @ b
        low, high = y.min(), y.max()
        free = max(len(y) - x.shape[1] / 2, 1)
        self.leaf[node] = b, [low - self.slack * (high - low), high + self.slack * (high - low),
                              math.sqrt((left**2).sum() / free)]
        self.gain[node] = 0.0
        if len(rows) < 2 * self.least:
            return
        for test, cut, holds in self.candidates(rows):
            if min(holds.sum(), (~holds).sum()) < self.least:
                continue
            gain = self.length((left**2).sum(), len(y)) - self.price
            for side in (holds, ~holds):
                gain -= self.length(self.regress(x[side], left[side])[1], side.sum())
            if gain > self.gain[node]:
                self.gain[node], self.split[node] = gain, (test, cut)

    def candidates(self, rows):
        count = min(len(rows), QUANTILE_ROWS)
        chosen = rows[numpy.arange(count) * len(rows) // count]
        for component in range(2):
            values = numpy.sort(self.data.s[chosen, component])
            for k in range(1, CUTS + 1):
                at = k * count // 4
                cut = numpy.float32(0.5) * (values[at] + values[at + 1])
                yield component, cut, self.data.s[rows, component] > cut
        for action in range(3):
            yield 2 + action, 0.0, self.data.a[rows] == action

    def grow(self):
        """Splits the leaf that gains most; False if none gains."""
        node = max(sorted(self.leaf), key=lambda k: self.gain[k])
        if self.gain[node] <= 0:
            return False
        (test, cut), rows = self.split[node], list(self.rows[node])
        at, end = 0, len(rows)
        while at < end:
            row = rows[at]
            holds = self.data.s[row, test] > cut if test < 2 else self.data.a[row] == test - 2
            if holds:
                end -= 1
                rows[at], rows[end] = rows[end], row
            else:
                at += 1
        child = len(self.rows)
        self.tests[node] = test, cut, child
        self.tests += [(LEAF, 0.0, 0)] * 2
        self.rows += [numpy.array(rows[:end]), numpy.array(rows[end:])]
        begun = self.leaf.pop(node)[0]
        self.leaf_of += [self.leaf_of[node], len(self.leaf) + 1]
        self.fit(child, begun)
        self.fit(child + 1, begun)
        return True


def bent(s, a):
    return numpy.where(s[:, 0] > 0.2, 1 - s[:, 0], s[:, 0]) * numpy.where(a == 1, -1, 1)


def smooth(s, a):
    return 0.3 * s[:, 0] - 0.2 * s[:, 1] + 0.1 * a


def waves(s, a):
    return numpy.sin(4 * s[:, 0]) + s[:, 1] * (a == 1)


@pytest.mark.parametrize("law", [bent, smooth, waves])
@pytest.mark.parametrize("terms", [5, 8])
@pytest.mark.parametrize("seed", range(4))
def test_tree(law, terms, seed):
    data = Data(law, 700, seed)
    nodes, ends, coefficients = by_core(data, terms, 6, 1e-3, 0.5)
    ours = Oracle(data, terms, 6, 1e-3, 0.5)
    assert len(nodes) == len(ours.tests)
    for node, (test, cut, child), leaf in zip(nodes, ours.tests, ours.leaf_of, strict=True):
        assert node["test"] == test
        assert node["child"] == (leaf if test == LEAF else child)
        if test < 2:
            assert node["cut"] == cut
    for node, (b, about) in ours.leaf.items():
        assert coefficients[ours.leaf_of[node]] == pytest.approx(b, rel=2e-3, abs=2e-3)
        assert ends[ours.leaf_of[node]] == pytest.approx(about, rel=1e-3, abs=1e-4)
    if law is not smooth:
        assert len(ours.leaf) > 1
