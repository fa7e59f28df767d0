# SPDX-License-Identifier: MIT
"""The domain of bags of vectors, from Python."""

import pickle

import numpy as np
import pytest
from conftest import without_vision

import rlvc
from rlvc import errors

PARTS = 4


@pytest.fixture(params=["float", "int8"])
def domain(request):
    return rlvc.Bags(points=8, dimensions=32, radius=4.0, form=request.param, size=PARTS)


def scene(domain, thing, missing, random):
    """A thing of four parts, of which some are missing, before four parts of something else."""
    kept = random.permutation(PARTS)[missing:]
    vectors = np.zeros((len(kept) + 4, 32), domain.vector_dtype)
    vectors[np.arange(len(kept)), PARTS * thing + kept] = 10
    behind = np.arange(len(kept), len(vectors))
    vectors[behind, 16 + random.integers(8, size=4)] = -10
    vectors[behind, 24 + random.integers(8, size=4)] = 10
    return random.permutation(vectors)


def taught(domain):
    random = np.random.default_rng(1)
    agent = rlvc.Agent(domain, 2, discount=0.0)
    for i in range(400):
        agent.begin(scene(domain, i % 4, random.integers(2), random))
        action = int(random.integers(2))
        agent.observe(action, float(action == (i % 4 == 0)), None, terminated=True)
    agent.learn()
    return agent


def test_half_of_a_thing_is_enough(domain, tmp_path):
    agent = taught(domain)
    assert agent.classes == 2
    (split,) = agent.splits
    assert split.name.startswith("bag ")
    assert 0 < split.feature["count"] <= PARTS
    random = np.random.default_rng(2)
    for i in range(100):
        percept = scene(domain, i % 4, 2, random)
        assert agent.predict(percept).action == (i % 4 == 0)
        found = domain.nearest(percept, split.feature)
        squares = np.array([min(distance, 4.0) ** 2 for _, distance in found])
        enough = (16 - squares).sum() >= split.feature["needed"]
        assert domain.exhibits(percept, split.feature) == enough
    agent.save(tmp_path / "agent.rlvc")
    again = rlvc.Agent.load(tmp_path / "agent.rlvc")
    assert again.domain.parameters == domain.parameters
    assert again.print() == agent.print() == pickle.loads(pickle.dumps(agent)).print()


def test_the_export_acts_like_the_agent(domain, acts_of_export):
    agent, random = taught(domain), np.random.default_rng(3)
    scenes = [scene(domain, i % 4, i % 5, random) for i in range(300)]
    records = [domain.pack(s) for s in [*scenes, scenes[0][:0]]]
    acts = [agent.predict(r).action for r in records]
    assert acts_of_export(agent, records) == acts
    assert 0 < sum(acts) < len(acts)


def test_the_bag_that_has_most_is_weighed(domain):
    """Blurred, a quarter of a thing is not enough of its bag, but more than of any other."""
    agent, random = taught(domain), np.random.default_rng(4)
    (split,) = agent.splits
    for i in range(40):
        percept = scene(domain, i % 4, 3, random)
        percept[percept == 10] = 7 if random.integers(2) else 10
        found = domain.nearest(percept, split.feature)
        score = sum(max(0.0, 16 - distance**2) for _, distance in found)
        ratio = score / split.feature["needed"]
        class_id, action = agent.weigh(percept)
        assert class_id == (ratio > 0.6)
        assert action == agent.policy[class_id]


def test_only_bags_are_weighed():
    agent = rlvc.Agent(rlvc.Bits(8), 2)
    with pytest.raises(errors.ConfigError, match="not of bags"):
        agent.weigh(np.zeros(8, np.uint8))


def test_empty_percepts_have_nothing_near(domain):
    feature = taught(domain).splits[0].feature
    with pytest.raises(errors.PerceptError, match="no vectors"):
        domain.nearest(np.zeros((0, 32), domain.vector_dtype), feature)


@pytest.mark.parametrize("size", [0, 33, 1.5])
def test_sizes(size):
    with pytest.raises(errors.ConfigError, match="size"):
        rlvc.Bags(points=5, dimensions=3, radius=4.0, size=size)


@pytest.mark.skipif(bool(without_vision()), reason=without_vision())
def test_extractors_have_a_domain_of_bags():
    import rlvc.vision

    pictures = np.random.default_rng(1).integers(256, size=(4, 48, 48, 3), dtype=np.uint8)
    metric = rlvc.vision.Metric.fit(pictures, form="int8")
    extractor = rlvc.vision.Extractor(metric=metric, form="int8")
    assert extractor.domain(bags=True).parameters[5] == 32
    domain = extractor.domain(bags=8, candidates=5)
    assert domain.parameters[4:] == (5, 8)
    assert domain.pack(extractor.look(pictures[0]).vectors) == extractor.extract(pictures[0])
    with pytest.raises(errors.ConfigError, match="bags"):
        extractor.domain(bags=True, pairs=True)
    placed = rlvc.vision.Extractor(metric=metric, form="int8", places="points")
    with pytest.raises(errors.ConfigError, match="bags"):
        placed.domain(bags=True)
