# SPDX-License-Identifier: MIT
"""The golden snapshots, read by what core/SPEC.md says of them and by nothing of the core."""

import pathlib
import struct
import zlib

import pytest

GOLDEN = pathlib.Path(__file__).resolve().parents[1] / "golden"


@pytest.mark.parametrize("name, phase", [("snapshot_idle.bin", 0), ("snapshot_search.bin", 7)])
def test_golden(name, phase):
    data = (GOLDEN / name).read_bytes()
    at = 0

    def take(form):
        nonlocal at
        values = struct.unpack_from("<" + form, data, at)
        at += struct.calcsize("<" + form)
        return values if len(values) > 1 else values[0]

    assert take("4sIII") == (b"RLVS", 1, 1, len(data))
    assert len(data) % 64 == 0
    assert struct.unpack("<I", data[-4:])[0] == zlib.crc32(data[:-4])
    percept_bytes, feature_bytes = take("II")
    actions, capacity, classes_max = take("III")
    take("IIII")
    assert take("8B")[5:] == (0, 1, 0)
    discount, epsilon = take("ff")
    take("5f")
    assert (percept_bytes, feature_bytes, actions, capacity, classes_max) == (1, 2, 4, 100, 5)
    assert (round(discount, 6), round(epsilon, 6)) == (0.9, 0.9)
    assert take("QQ")[0] == 90
    take("IIIIIf")
    _, count, stored, _, _ = take("IIIIB")
    flags = [take(f"{percept_bytes}sfHBB")[-1] for _ in range(count)]
    assert sum(flag & 1 for flag in flags) == stored == 90
    classes = take("I")
    for j in range(classes - 1):
        assert take("IIIIfff")[0] <= j
        take(f"{feature_bytes}s")
    assert 1 < classes <= classes_max
    for _ in range(classes):
        _, policy, trial, _ = take("fBBH")
        assert policy < actions and trial < actions
        for _ in range(actions):
            take("ffI")
    least, last = take("BB")
    assert least in (0, 3, 5) and last < actions
    for _ in range(classes):
        assert take("B") in (*range(actions), 255)
    assert sum(take("B") for _ in range(classes * actions)) >= stored
    assert take("BB")[0] == phase
    learner = take("7I10I")
    assert phase != 0 or not any(learner)
    assert len(data) - 64 < at + 4 <= len(data)
    assert not any(data[at:-4])
