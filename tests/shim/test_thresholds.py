# SPDX-License-Identifier: MIT
"""The domain of thresholds, from Python."""

import gc
import pickle
import subprocess

import numpy as np
import pytest

import rlvc
from rlvc import __main__ as command
from rlvc import errors


@pytest.fixture(params=[False, True])
def domain(request):
    return rlvc.Thresholds(3, oblique=request.param)


def numbers(count, seed=1):
    return np.random.default_rng(seed).normal(size=(count, 3)).astype(np.float32)


def wanted(x):
    return (x[..., 1] > 0.5).astype(int)


def taught(domain):
    agent = rlvc.Agent(domain, 2)
    percepts = numbers(1500)
    for i, (percept, action) in enumerate(zip(percepts, wanted(percepts), strict=True)):
        agent.begin(percept)
        agent.observe(i % 2, float(i % 2 == action), None, terminated=True)
    agent.learn()
    return agent


def test_a_shift_is_found_in_noise():
    percepts, noise = numbers(600), np.random.default_rng(3)
    agent = rlvc.Agent(rlvc.Thresholds(3, cutpoints=8), 1, score="ranks")
    for percept in percepts:
        agent.begin(percept)
        agent.observe(0, 0.5 * wanted(percept) + noise.normal(), None, terminated=True)
    agent.learn()
    assert [split.feature["component"] for split in agent.splits] == [1]
    assert agent.splits[0].log_tests == pytest.approx(np.log(3 * 8))


def test_the_cutpoint_is_found(domain):
    agent = taught(domain)
    gc.collect()
    first = agent.splits[0]
    assert first.feature["component"] == 1 and first.feature["slope"] == 0
    assert first.feature["cutpoint"] == pytest.approx(0.5, abs=0.1)
    assert first.name.startswith("x[1] > 0.") and first.name in agent.print()
    percepts = numbers(300, seed=2)
    predicted = agent.predict(percepts)
    assert (predicted.action == wanted(percepts)).mean() > 0.95
    assert [agent.predict(p).class_id for p in percepts] == predicted.class_id.tolist()
    shown = [domain.exhibits(p, first.feature) for p in percepts]
    assert shown == (percepts[:, 1] > first.feature["cutpoint"]).tolist()
    assert pickle.loads(pickle.dumps(agent)).print() == agent.print()


def test_the_export_acts_like_the_agent(domain, tmp_path):
    agent = taught(domain)
    percepts = numbers(200, seed=3)
    (tmp_path / "p.h").write_text(agent.export_c("p"))
    (tmp_path / "p.c").write_text(
        '#include "p.h"\n#include <stdio.h>\nint main(void) {\n    float x[3];\n'
        "    while (fread(x, sizeof x, 1, stdin) == 1)\n        putchar('0' + (int)p_act(x));\n"
        "    return 0;\n}\n"
    )
    program = tmp_path / "p"
    subprocess.run(
        ["gcc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-ffp-contract=off", tmp_path / "p.c",
         "-o", program],
        check=True,
    )  # fmt: skip
    shown = subprocess.run([program], input=percepts.tobytes(), capture_output=True, check=True)
    assert [int(c) for c in shown.stdout.decode()] == agent.predict(percepts).action.tolist()


def test_saved_and_loaded(domain, tmp_path, capsys):
    agent = taught(domain)
    agent.save(tmp_path / "agent", ["left", "middle", "right"])
    again = rlvc.Agent.load(tmp_path / "agent")
    assert again.print() == agent.print() and again.domain.parameters == domain.parameters
    assert command.main(["show", str(tmp_path / "agent")]) in (0, None)
    assert "middle > 0." in capsys.readouterr().out


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf, 2e15])
def test_what_is_no_number_is_refused(domain, wrong):
    agent = rlvc.Agent(domain, 2)
    percept = np.array([0, wrong, 0], np.float32)
    with pytest.raises(errors.PerceptError, match="NaN"):
        agent.begin(percept)
    with pytest.raises(errors.PerceptError, match="NaN"):
        agent.begin(percept.tobytes())
    with pytest.raises(errors.PerceptError, match="NaN"):
        agent.predict(np.stack([np.zeros_like(percept), percept]))
    assert agent.statistics.interactions == 0


@pytest.mark.parametrize("wrong", [(0,), (1025,), (65, 15, True), (3, 65536)])
def test_parameters_out_of_range(wrong):
    with pytest.raises(errors.ConfigError):
        rlvc.Thresholds(*wrong)


def test_candidates_of_a_class():
    domain = rlvc.Thresholds(2, cutpoints=0)
    found = domain.candidates(np.array([[1, 5], [3, 5], [2, 5]], np.float32))
    assert found["cutpoint"][:2].tolist() == [1.5, 2.5]
    assert (found["cutpoint"][2:] > 1e38).all() and len(found) == 6
    assert domain.name(found[0]) == "x[0] > 1.5"
