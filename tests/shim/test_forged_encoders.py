# SPDX-License-Identifier: MIT
"""The text of an encoder with members that none has: it is refused by an error of the package, or the encoder that
it makes answers an observation by a percept or a PerceptError."""

import copy
import json
import pickle

import numpy as np
import pytest
from gymnasium import spaces

import rlvc
from rlvc import errors

HOSTILE = [None, True, -1, 0, 3, 10**9, 10**30, 1.5, float("nan"), "", "x", "number", [], [1], [[["a"]]], {}, {"a": 1}]
SPACES = {
    "number": spaces.Discrete(5, start=2),
    "numbers": spaces.MultiDiscrete([3, 4]),
    "flags": spaces.MultiBinary(3),
    "reals": spaces.Box(-1, 1, (2,)),
    "parts": spaces.Dict(a=spaces.Discrete(3), b=spaces.Box(0, 1, (1,))),
    "table": rlvc.encode.Columns({"a": None, "b": ["x", "y"]}),
}
OBSERVATIONS = [
    2, None, np.array([1, 1]), np.zeros(3, np.int8), np.zeros(2, np.float32), np.zeros((2, 2)),
    {"a": 1, "b": np.zeros(1)}, {"a": 1, "b": "x"},
]  # fmt: skip


def forged(value):
    """Copies of a JSON value, each with one member, at whatever depth, replaced, left out or added."""
    members = list(value.items()) if isinstance(value, dict) else list(enumerate(value))
    for key, inner in members:
        below = forged(inner) if isinstance(inner, dict | list) else ()
        for replaced in (*HOSTILE, *below):
            made = copy.copy(value)
            made[key] = replaced
            yield made
        made = copy.copy(value)
        del made[key]
        yield made
    if isinstance(value, dict):
        yield value | {"unknown": 1}


def answer(error, call, *arguments):
    """What a call returns; None where it raises an error of the package, whose text is one sentence."""
    said = "one sentence"
    try:
        return call(*arguments)
    except error as raised:
        said = str(raised)
    assert 10 < len(said) < 500
    assert "\n" not in said
    return None


def read(text):
    return answer(errors.SpaceError, rlvc.Encoder.from_json, text)


@pytest.mark.parametrize("kind", SPACES)
def test_the_text_of_an_encoder(kind):
    text = rlvc.Encoder(SPACES[kind]).to_json()
    assert rlvc.Encoder.from_json(text).to_json() == text
    tried = refused = 0
    for members in forged(json.loads(text)):
        tried += 1
        encoder = read(json.dumps(members))
        if encoder is None:
            refused += 1
            continue
        for observation in OBSERVATIONS:
            answer(errors.PerceptError, encoder.encode, observation)
            answer(errors.PerceptError, encoder.encode_many, [observation, observation])
    assert tried > 100
    assert refused > tried // 2


@pytest.mark.parametrize("text", ["", "{", "null", "5", "[]", "{}", '{"parts": []}', None, 5, b"\xff"])
def test_what_is_no_text_of_an_encoder(text):
    assert read(text) is None


@pytest.mark.parametrize("state", [None, 5, {}, {"made_of": None}, {"made_of": "{}"}, {"content": 5, "encoder": 0, "domain": 0}])
@pytest.mark.parametrize("kind", [rlvc.Encoder, rlvc.Run])
def test_forged_pickles(kind, state):
    with pytest.raises(errors.Error):
        kind.__new__(kind).__setstate__(state)


def test_a_pickle_of_an_encoder():
    encoder = rlvc.Encoder(SPACES["parts"], names=["mode", "speed"])
    copied = pickle.loads(pickle.dumps(encoder))
    assert copied.to_json() == encoder.to_json()
    assert copied.names == encoder.names


@pytest.mark.parametrize("kind", ["Numbers", "Flags", "Number", "Word", "Named", "Columns"])
def test_spaces_of_logs_of_odd_sizes(kind):
    """Also ones too large to be kept: they are counted before anything is made for each number."""
    values = (*HOSTILE, (10**9, 10**9), (-1,), ("a",), (1.5,), {"a": 5}, object())
    taken = 0
    for value in values:
        make = getattr(rlvc.encode, kind)
        taken += answer(errors.SpaceError, lambda v=value, m=make: rlvc.Encoder(m(v))) is not None
    assert taken < len(values) // 2


def test_thresholds_are_checked_for_bits_too():
    with pytest.raises(errors.ConfigError, match="thresholds"):
        rlvc.Encoder(spaces.Discrete(3), thresholds="x")
