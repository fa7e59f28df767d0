# SPDX-License-Identifier: MIT
"""The domain of local descriptors, from Python."""

import gc
import pickle

import numpy as np
import pytest

import rlvc
from rlvc import __main__ as command
from rlvc import errors


@pytest.fixture(params=["float", "int8"])
def domain(request):
    return rlvc.Descriptors(points=5, dimensions=3, radius=4.0, form=request.param)


def scenes(domain, count, seed=1):
    """Pictures of noise, of which every second has a vector near (50, 50, 50)."""
    random = np.random.default_rng(seed)
    pictures = []
    for i in range(count):
        vectors = random.integers(-100, 20, size=(int(random.integers(1, 5)), 3))
        if i % 2:
            vectors[int(random.integers(len(vectors)))] = 50 + random.integers(-1, 2, size=3)
        pictures.append(vectors.astype(domain.vector_dtype))
    return pictures


def taught(domain):
    agent = rlvc.Agent(domain, 2)
    for i, picture in enumerate(scenes(domain, 400)):
        agent.begin(picture)
        agent.observe(i // 2 % 2, float(i % 2 == i // 2 % 2), None, terminated=True)
    agent.learn()
    return agent


def test_the_feature_is_found(domain):
    agent = taught(domain)
    gc.collect()
    assert agent.classes == 2
    (split,) = agent.splits
    assert np.abs(split.feature["vector"].astype(float) - 50).max() <= 1
    assert split.feature["radius"] > 0
    assert split.name in agent.print()
    pictures = scenes(domain, 100, seed=2)
    records = np.stack([np.frombuffer(domain.pack(p), np.uint8) for p in pictures])
    classes = agent.predict(records).class_id.tolist()
    assert classes == [i % 2 for i in range(100)]
    assert [agent.predict(p).class_id for p in pictures] == classes
    assert [domain.exhibits(p, split.feature) for p in pictures] == [c == 1 for c in classes]
    assert pickle.loads(pickle.dumps(agent)).print() == agent.print()


def test_the_export_acts_like_the_agent(domain, acts_of_export):
    agent = taught(domain)
    records = [domain.pack(p) for p in [*scenes(domain, 300, seed=3), scenes(domain, 1)[0][:0]]]
    assert acts_of_export(agent, records) == [agent.predict(r).action for r in records]


def test_a_saved_agent_knows_its_domain(domain, tmp_path, capsys):
    agent = taught(domain)
    file = tmp_path / "agent.rlvc"
    agent.save(file)
    again = rlvc.Agent.load(file)
    assert again.snapshot() == agent.snapshot()
    assert again.domain.parameters == domain.parameters
    assert command.main(["export", str(file), "--c", str(tmp_path / "seen.h")]) == 0
    assert "policy_act(const void *percept)" in (tmp_path / "seen.h").read_text(encoding="utf-8")
    assert command.main(["show", str(file)]) == 0
    assert "2 classes" in capsys.readouterr().out
    content = file.read_bytes()
    for wrong in (b'"int4"', b"4.0, {}", b"[]"):
        at = content.index(b'"descriptors": ') + 15
        end = content.index(b"]", at) + 1
        file.write_bytes(content[:at] + b"[5, 3, " + wrong + b"]" + content[end:])
        with pytest.raises(errors.SnapshotError, match="damaged"):
            rlvc.Agent.load(file)


def test_candidates_are_vectors_of_the_percepts(domain):
    pictures = scenes(domain, 50)
    records = np.stack([np.frombuffer(domain.pack(p), np.uint8) for p in pictures])
    found = domain.candidates(records)
    vectors = {tuple(v) for p in pictures for v in p.tolist()}
    found = found[found["radius"] >= 0]  # the others were refused
    assert len(found) > 0
    assert {tuple(v) for v in found["vector"].tolist()} <= vectors


@pytest.mark.parametrize(
    "wrong",
    [
        np.zeros((6, 3), np.float32),
        np.zeros((2, 4), np.float32),
        np.zeros((2, 3), np.float64),
        np.full((1, 3), np.nan, np.float32),
        (6).to_bytes(4, "little") + bytes(60),
        bytes(5),
    ],
)
def test_wrong_percepts(wrong):
    agent = rlvc.Agent(rlvc.Descriptors(5, 3, 1.0), 2)
    with pytest.raises(errors.PerceptError):
        agent.begin(wrong)
    with pytest.raises(errors.PerceptError):
        agent.predict(wrong)


@pytest.mark.parametrize(
    "wrong",
    [{"points": 0}, {"dimensions": 300}, {"radius": 0.0}, {"margin": 0.5}, {"form": "int4"}],
)
def test_wrong_parameters(wrong):
    name, *_ = wrong
    for domain in (rlvc.Descriptors, rlvc.Spatial, rlvc.Bags):
        if name != "margin" or domain is not rlvc.Bags:
            with pytest.raises(errors.ConfigError, match=f"{name}: .* not (in|one of) "):
                domain(**{"points": 5, "dimensions": 3, "radius": 1.0, **wrong})
