# SPDX-License-Identifier: MIT
"""Two extractors as one, where the package has the vision module."""

import pickle

import numpy as np
import pytest
from conftest import without_vision

import rlvc
from rlvc import errors

if reason := without_vision():
    pytest.skip(reason, allow_module_level=True)

from rlvc import vision

U8 = np.uint8
BRIGHTEST = 180


def blocks(number):
    """A picture of many corners."""
    random = np.random.default_rng(number)
    return np.kron(random.integers(0, 255, (6, 8, 3), U8), np.ones((8, 8, 1), U8))


def plain(number, level):
    """A picture of one colour and noise, which has no corner."""
    noise = np.random.default_rng(number).normal(level, 1, (48, 64, 3))
    return np.clip(noise.round(), 0, 255).astype(U8)


def extractor(descriptor, **changes):
    pictures = [blocks(i) for i in range(20)]
    metric = vision.Metric.fit(pictures, config=descriptor, kind="plain")
    return vision.Extractor(metric=metric, **{"form": "int8", **changes})


@pytest.fixture(scope="module")
def joined():
    return vision.Joined(extractor("sift-upright"), extractor("quarters"))


def test_the_vectors_of_both(joined):
    """Each extractor's vectors in units of its own tau, and further apart than a feature reaches."""
    picture = blocks(30)
    sight = joined.look(picture)
    parts = [joined.first.look(picture), joined.second.look(picture)]
    count = len(parts[0].vectors)
    assert count > 3
    assert len(sight.vectors) == count + 1
    assert np.array_equal(sight.points, np.concatenate([part.points for part in parts]))
    for rows, part, of in (
        (sight.vectors[:count], parts[0], joined.first),
        (sight.vectors[count:], parts[1], joined.second),
    ):
        expected = part.vectors * of.step / of.metric.tau
        length = of.dimensions
        assert np.abs(rows[:, :length] / joined.radius - expected).max() <= 0.5001 / joined.radius
        assert not rows[:, length:-1].any()
    assert (sight.vectors[:count, -1] == 127).all()
    assert (sight.vectors[count:, -1] == -127).all()
    assert joined.radius * 1.8 < 254


def test_the_record(joined):
    sight = joined.look(blocks(31))
    assert joined.extract(blocks(31)) == sight.percept
    assert sight.percept == joined.domain().pack(sight.vectors)
    assert joined.extract(blocks(31)[:, :, ::-1].copy(), "bgr") == sight.percept
    assert joined.extract_many([blocks(30), blocks(31)])[1].tobytes() == sight.percept
    assert len(sight.percept) == joined.percept_bytes
    assert len(joined.look(plain(1, 100)).vectors) == 1


def test_colours_are_learnt_where_there_are_no_corners(joined):
    """What to do depends on the light of a plain picture, of which corners say nothing."""
    for seen, classes in ((joined, 2), (joined.first, 1)):
        eye = vision.Eye(seen)
        agent = rlvc.Agent(eye.domain, 2, capacity=200, discount=0.0, seed=1)
        random = np.random.default_rng(1)
        for i in range(200):
            bright = int(random.integers(2))
            agent.begin(eye.encode(plain(i, BRIGHTEST if bright else 60)))
            choice = agent.act()
            agent.observe(choice, float(choice.action == bright), None, terminated=True)
        agent.learn()
        assert agent.classes == classes
    eye = vision.Eye(joined, bags=2)
    assert isinstance(eye.domain, rlvc.Bags)
    assert eye.domain.size == 2
    assert isinstance(vision.Eye(joined, bags=True).domain, rlvc.Bags)


def test_kept(joined):
    picture = blocks(32)
    copy = pickle.loads(pickle.dumps(joined))
    eye = vision.Eye(joined, candidates=9)
    again = vision.Eye.from_dict(eye.to_dict())
    assert copy.extract(picture) == again.encode(picture) == joined.extract(picture)
    assert again.domain.parameters == eye.domain.parameters


def test_an_eye_of_an_earlier_build():
    """Then there was no second extractor."""
    eye = vision.Eye(extractor("sift-upright"))
    fields = eye.to_dict()
    assert fields.pop("second") is None
    assert vision.Eye.from_dict(fields).encode(blocks(33)) == eye.encode(blocks(33))


def test_refused(joined):
    sift = joined.first
    for wrong, error, named in (
        (vision.Extractor("sift", form="int8"), errors.MetricError, "metric"),
        (extractor("quarters", form="float"), errors.ConfigError, "form int8"),
        (extractor("quarters", places="points"), errors.ConfigError, "places none"),
        (extractor("orb"), errors.ConfigError, "255"),
    ):
        with pytest.raises(error, match=named):
            vision.Joined(sift, wrong)
        with pytest.raises(error, match=named):
            vision.Joined(wrong, sift)
    with pytest.raises(errors.ConfigError, match="margin"):
        joined.domain(margin=16.0)
    with pytest.raises(errors.ConfigError, match="candidates"):
        joined.domain(candidates=0)
