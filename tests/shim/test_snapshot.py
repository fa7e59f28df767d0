# SPDX-License-Identifier: MIT
"""Agents that outlive their process, whole or not at all."""

import copy
import pickle

import numpy as np
import pytest
from test_errors import Corridor

import rlvc
from rlvc import __main__ as command
from rlvc import errors


def go_on(agent):
    """What it does from here on."""
    done = []
    for _ in range(50):
        choice = agent.act()
        done.append(choice)
        agent.observe(choice, float(choice.action), bytes([len(done) % 8]))
    while not agent.learn(1000).done:
        pass
    return done, agent.print("json"), agent.statistics


@pytest.mark.parametrize("budget", [None, 64, 3000])
def test_a_restored_agent_goes_on_as_if_it_had_not_stopped(walk, budget, tmp_path):
    agent = walk(capacity=1000)
    agent.learn(budget)
    file = tmp_path / "agent"
    agent.save(file)
    others = [pickle.loads(pickle.dumps(agent)), copy.copy(agent), rlvc.Agent.load(file)]
    expected = go_on(agent)
    for other in others:
        other.check()
        assert go_on(other) == expected


def test_domains_of_ones_own(walk, tmp_path):
    agent = walk(Corridor())
    agent.learn()
    other = pickle.loads(pickle.dumps(agent))
    assert other.print() == agent.print()
    agent.save(tmp_path / "agent")
    with pytest.raises(errors.SnapshotError, match="domain"):
        rlvc.Agent.load(tmp_path / "agent")
    assert rlvc.Agent.load(tmp_path / "agent", Corridor()).print() == agent.print()


def test_damage_is_noticed(walk, tmp_path):
    agent = walk()
    agent.learn()
    file = tmp_path / "agent"
    agent.save(file)
    whole = file.read_bytes()
    random = np.random.default_rng(1)
    places = random.integers(len(whole), size=60).tolist()
    for place in [0, 5, 20, *places]:
        damaged = bytearray(whole)
        damaged[place] ^= 1 << int(random.integers(8))
        file.write_bytes(damaged)
        try:
            other = rlvc.Agent.load(file)
        except errors.Error:
            continue
        other.check()  # only a name or a space of the head may change without notice
        assert place < whole.index(b"\n", 14)
    for cut in (0, 10, 100, len(whole) - 1):
        file.write_bytes(whole[:cut])
        with pytest.raises(errors.SnapshotError, match="agent: "):
            rlvc.Agent.load(file)
    with pytest.raises(errors.StoreError, match="cannot be read"):
        rlvc.Agent.load(tmp_path / "none")
    with pytest.raises(errors.StoreError, match="cannot be written"):
        agent.save(tmp_path / "no" / "agent")


def test_another_config_or_domain_is_refused(walk):
    agent = walk()
    snapshot = agent.snapshot()
    config = agent.config
    for domain, changed in (
        (3, config.replace(seed=9)),
        (9, config),
        (3, config.replace(capacity=10)),
    ):
        with pytest.raises(errors.SnapshotError):
            rlvc.Agent.restore(domain, changed, snapshot)
    with pytest.raises(errors.SnapshotError):
        rlvc.Agent.restore(3, config, b"")
    assert rlvc.Agent.restore(3, config, snapshot).statistics == agent.statistics


def test_the_command_shows_and_exports(tmp_path, capsys):
    file, header = tmp_path / "agent", tmp_path / "policy.h"
    log = tmp_path / "log.csv"
    log.write_text("x,action,reward,terminated\n" + "1,0,0,1\n2,0,1,1\n" * 40, encoding="utf-8")
    assert command.main(["learn", "--log", str(log), "--save", str(file)]) == 0
    shown = capsys.readouterr().out
    assert command.main(["show", str(file)]) == 0
    assert capsys.readouterr().out == shown
    assert "x > 1.5?" in shown
    assert command.main(["export", str(file), "--c", str(header)]) == 0
    assert "policy_act" in header.read_text(encoding="utf-8")
    assert command.main(["show", str(log)]) == 1
    assert capsys.readouterr().err == f"rlvc: {log}: not the file of an agent\n"
