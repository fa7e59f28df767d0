# SPDX-License-Identifier: MIT
"""Logs that were forged: a file of some bytes takes neither minutes nor gigabytes, and changes nothing for the next."""

import json
import os
import pathlib
import pickle
import resource

import numpy as np
import pytest

import rlvc
from rlvc import errors
from rlvc.logs import roles


def arrays():
    return {
        "observations": np.zeros((9, 2), np.float32), "actions": np.arange(9) % 2, "rewards": np.ones(9),
        "terminals": np.arange(9) % 3 == 2,
    }  # fmt: skip


def repeated(depth):
    """A list of two elements, each of which is a list of two elements, and so on: all of them one object."""
    made = [0.0, 1.0]
    for _ in range(depth):
        made = [made, made]
    return made


def forged_pickles():
    """Some bytes that would take gigabytes, or change the reader for the next file."""
    log = pickle.dumps(arrays())
    yield b"\x80\x04K\x01r\xff\xff\xff\x0f0" + log[2:]  # the place 2**28 - 1 of what comes again
    yield b"\x80\x04K\x01p999999999\n0" + log[2:]
    for name in ("observations", "rewards", "more"):
        yield pickle.dumps(arrays() | {name: repeated(60)})
    objects = np.empty(1, object)
    objects[0] = repeated(60)
    yield pickle.dumps(arrays() | {"observations": objects})
    array = b"cnumpy.core.multiarray\n_reconstruct\n)R(K\x01K\x01\x85cnumpy\ndtype\nX\x02\x00\x00\x00u1\x85R\x89"
    yield b"\x80\x02" + array + b"J\xff\xff\xff\x7ftb."  # a number where its bytes should be
    for named in (b"_codecs\nencode", b"numpy\ndtype", b"numpy\nndarray", b"numpy.core.multiarray\nscalar"):
        yield b"\x80\x02c" + named + b"\nN}X\x0c\x00\x00\x00__defaults__Ns\x86b."
        yield b"\x80\x02c" + named + b"\nN}X\x04\x00\x00\x00madeNs\x86b."


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="memory is limited by what is in use")
def test_forged_pickles(tmp_path):
    """They are refused without delay, and the next file is read as before."""
    (tmp_path / "good.pkl").write_bytes(pickle.dumps(arrays(), 2))
    before = resource.getrlimit(resource.RLIMIT_AS)
    pages = int(pathlib.Path("/proc/self/statm").read_text().split()[0])
    limit = pages * resource.getpagesize() + (1 << 30)
    resource.setrlimit(resource.RLIMIT_AS, (limit, before[1]))
    try:
        for content in forged_pickles():
            (tmp_path / "log.pkl").write_bytes(content)
            with pytest.raises(errors.LogError, match=r"log\.pkl: (cannot be read|holds|.* not an array)"):
                rlvc.logs.read(tmp_path / "log.pkl")
            assert len(rlvc.logs.read(tmp_path / "good.pkl")) == len(arrays()["actions"])
    finally:
        resource.setrlimit(resource.RLIMIT_AS, before)


def test_what_comes_again_may(tmp_path):
    """A policy that sees the same thing again and again."""
    seen = [0.0, 1.0]
    log = {"observations": [seen, seen, [1.0, 0.0]] * 5, "actions": [0, 1, 0] * 5, "rewards": [0.0, 0.0, 1.0] * 5,
           "terminals": [False, False, True] * 5}  # fmt: skip
    (tmp_path / "log.pkl").write_bytes(pickle.dumps(log))
    found = rlvc.logs.read(tmp_path / "log.pkl")
    np.testing.assert_array_equal(found.before[:3], [seen, seen, [1.0, 0.0]])


def test_names_take_time_by_their_length(tmp_path):
    """A search for a unit or a time at the end of a name looks at no character again and again."""
    for sign in ("[", "(", " [a", "[t", "a ", "next_", "prev_", "t+1", "aA", "_", "new_to_"):
        name = sign * (100_000 // len(sign))
        for key in (name, f"state_{name}", f"{name}]"):
            (tmp_path / "log.json").write_text(json.dumps({key: [1, 2], "action": [0, 1], "reward": [0, 1]}))
            with pytest.raises(errors.LogError, match="no column"):
                rlvc.logs.read(tmp_path / "log.json")


def test_columns_of_one_name_take_time_by_their_number():
    twice = {f"w{i}": [f"w{i}_0", f"w{i}_1"] for i in range(10_000)}
    assert roles.are_numbered(twice, [*twice, *twice]) == set(twice)
    assert roles.are_numbered({"reward": ["reward_0", "reward_1"]}, ["reward", "reward"]) == set()


def test_an_error_is_read_however_long_its_names_are(tmp_path):
    file = tmp_path / "log.csv"
    for head in ("x" * 100_000, ",".join(f"column_{i}" for i in range(9_000))):
        file.write_text(head + "\n" + "1," * head.count(",") + "1\n")
        with pytest.raises(errors.LogError, match="no column action") as caught:
            rlvc.logs.read(file)
        assert len(str(caught.value)) < 1300
        assert str(caught.value).startswith(str(file))


@pytest.mark.filterwarnings("error::RuntimeWarning")
@pytest.mark.parametrize("action", [1e300, -1e19, 2**64 - 1, 2**63])
def test_actions_beyond_64_bits(action):
    dtype = np.float64 if isinstance(action, float) else np.uint64
    log = arrays() | {"actions": np.array([action, 1, 2] * 3, dtype)}
    with pytest.raises(errors.LogError, match=r"actions: .* is beyond a number of 64 bits"):
        rlvc.learn_from(log)
