# SPDX-License-Identifier: MIT
"""The domain of vectors with places, from Python."""

import pickle

import numpy as np
import pytest
from conftest import without_vision

import rlvc
from rlvc import errors


@pytest.fixture(params=[("float", False), ("int8", True)], ids=["float", "int8 directed"])
def domain(request):
    form, directed = request.param
    return rlvc.Spatial(points=5, dimensions=3, radius=20.0, form=form, directed=directed)


def scene(domain, left, random):
    """Two things beside each other, and something else; in a directed domain the whole is turned."""
    things = np.array([[60, 0, 0], [0, 60, 0], [0, 0, 60]]) + random.integers(-1, 2, (3, 3))
    along = np.array([[0.0, 0.0], [40.0 + random.integers(5), 0.0], random.uniform(-50, 50, 2)])
    order = random.permutation(3)
    places = along[[0, 1, 2] if left == 0 else [1, 0, 2]]
    angle = random.uniform(0, 2 * np.pi) if domain.directed else 0.0
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    percept = (things.astype(domain.vector_dtype)[order], (100 + places @ turn)[order])
    return (*percept, np.full(3, angle)) if domain.directed else percept


def taught(domain):
    random = np.random.default_rng(1)
    agent = rlvc.Agent(domain, 2, discount=0.0)
    for i in range(200):
        agent.begin(scene(domain, i % 2, random))
        agent.observe(i // 2 % 2, float(i % 2 == i // 2 % 2), None, terminated=True)
    agent.learn()
    return agent


def test_which_is_left(domain, tmp_path):
    agent = taught(domain)
    assert agent.classes == 2
    (split,) = agent.splits
    assert split.name.startswith("pair ")
    assert domain.is_pair(split.feature)
    random = np.random.default_rng(2)
    percepts = [scene(domain, i % 2, random) for i in range(50)]
    assert [agent.predict(percept).action for percept in percepts] == [0, 1] * 25
    records = np.stack([np.frombuffer(domain.pack(p), np.uint8) for p in percepts])
    assert agent.predict(records).action.tolist() == [0, 1] * 25
    for percept in percepts:
        first, second, distance = domain.nearest(percept, split.feature)
        assert first != second
        assert domain.exhibits(percept, split.feature) == (distance <= split.feature["radius"])
    agent.save(tmp_path / "agent.rlvc")
    again = rlvc.Agent.load(tmp_path / "agent.rlvc")
    assert again.domain.parameters == domain.parameters
    assert again.print() == agent.print() == pickle.loads(pickle.dumps(agent)).print()
    assert "int16_t x, y" in agent.export_c("seen")


def test_single_vectors_are_not_enough():
    domain = rlvc.Descriptors(points=5, dimensions=3, radius=20.0)
    random, agent = np.random.default_rng(1), rlvc.Agent(domain, 2, discount=0.0)
    for i in range(200):
        vectors, _ = scene(rlvc.Spatial(5, 3, 20.0), i % 2, random)
        agent.begin(vectors)
        agent.observe(i // 2 % 2, float(i % 2 == i // 2 % 2), None, terminated=True)
    agent.learn()
    assert agent.classes == 1


@pytest.mark.parametrize(
    ("percept", "named"),
    [
        (np.zeros((2, 3), np.float32), "no places"),
        ((np.zeros((2, 3), np.float32),), "tuple of 1"),
        ((np.zeros((2, 3), np.float32), [[0, 0]]), "places are"),
        ((np.zeros((2, 3), np.float32), [[0, 0], [0, 1e6]]), "32767"),
        ((np.zeros((2, 3), np.float32), [[0, 0], [0, np.nan]]), "32767"),
        ((np.zeros((6, 3), np.float32), np.zeros((6, 2))), "more than 5"),
        ((np.zeros((2, 4), np.float32), np.zeros((2, 2))), "expected"),
        (b"12", "2 bytes"),
    ],
)
def test_wrong_percepts(percept, named):
    with pytest.raises(errors.PerceptError, match=named):
        rlvc.Spatial(points=5, dimensions=3, radius=4.0).pack(percept)


@pytest.mark.parametrize(
    "changes", [{"pairs": 0}, {"pairs": 70_000}, {"directed": 2}, {"radius": -1.0}]
)
def test_wrong_parameters(changes):
    with pytest.raises(errors.ConfigError):
        rlvc.Spatial(**{"points": 5, "dimensions": 3, "radius": 4.0, **changes})


@pytest.mark.skipif(bool(without_vision()), reason=without_vision())
def test_percepts_of_pictures():
    from rlvc import vision

    pictures = np.random.default_rng(1).integers(256, size=(4, 48, 48, 3), dtype=np.uint8)
    metric = vision.Metric.fit(pictures, form="int8")
    plain = vision.Extractor(metric=metric, form="int8")
    for places in ("points", "directed"):
        seeing = vision.Extractor(metric=metric, form="int8", places=places)
        domain, sight = seeing.domain(), seeing.look(pictures[0])
        assert isinstance(domain, rlvc.Spatial)
        assert domain.directed == (places == "directed")
        assert domain.pack(sight) == sight.percept == seeing.extract(pictures[0])
        assert sight.percept.startswith(plain.extract(pictures[0]))
    domain = plain.domain(pairs=7)
    assert domain.pairs == 7
    assert len(domain.pack(plain.look(pictures[0]))) == domain.percept_bytes
    with pytest.raises(errors.ConfigError, match="places"):
        seeing.domain(pairs=False)
