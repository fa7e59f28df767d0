# SPDX-License-Identifier: MIT
"""Ctrl-C at any moment: KeyboardInterrupt comes out, the agent is sound, and no result is wrong or short.

The first tests send it before one bytecode after another. The last one sends signals at moments that a seeded
generator draws; more of them with

    RLVC_SIGNALS=20000 python -m pytest -s tests/shim/test_interrupts.py -k real
"""

import collections
import ctypes
import os
import pathlib
import random
import signal
import subprocess
import sys

import gymnasium
import numpy as np
import pytest
from gymnasium import spaces
from test_errors import Batched, Corridor, Own

import rlvc

WATCHED = (str(pathlib.Path(rlvc.__file__).parent), str(pathlib.Path(__file__).parent))


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    file = tmp_path_factory.mktemp("ctrl_c") / "ctrl_c.so"
    source = pathlib.Path(__file__).with_name("ctrl_c.c")
    subprocess.run(["gcc", "-O1", "-shared", "-fPIC", "-o", file, source], check=True)
    made = ctypes.PyDLL(str(file))
    made.ctrl_c_arm.argtypes, made.ctrl_c_left.restype = [ctypes.c_long], ctypes.c_long
    made.ctrl_c_trace.argtypes, made.ctrl_c_trace.restype = [ctypes.py_object] * 3, None
    return made


@pytest.fixture
def ctrl_c(library):
    """Makes a call with Ctrl-C before the bytecode of a number: whether there was one that late.

    With number 0 there is none, and the result is how many bytecodes there are.
    """

    def start(frame, _event, _argument):
        if not frame.f_code.co_filename.startswith(WATCHED):
            return None
        frame.f_trace_opcodes, frame.f_trace_lines = True, False
        return library.ctrl_c_trace

    def run(number, call):
        library.ctrl_c_arm(number)
        try:
            try:
                sys.settrace(start)
                call()
            finally:
                sys.settrace(None)
        except KeyboardInterrupt:
            return True
        left = library.ctrl_c_left()
        assert number == 0 or left > 0, f"Ctrl-C before bytecode {number} was swallowed"
        return -left if number == 0 else False

    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell may have it ignored
    yield run
    signal.signal(signal.SIGINT, before)


def unclosed(test):
    """A file may have been opened just before Ctrl-C; Python closes it and says so."""
    for warning in ("ResourceWarning", "pytest.PytestUnraisableExceptionWarning"):
        test = pytest.mark.filterwarnings(f"ignore::{warning}")(test)
    return test


def chosen(count, most):
    """Of so many bytecodes the first ones, and others drawn from all."""
    first = range(1, min(count, most) + 1)
    return sorted({*first, *random.Random(1).choices(range(1, count + 1), k=most)})


@pytest.mark.parametrize("make", [Corridor, Batched, Own])
def test_learning_with_a_domain_of_ones_own(walk, ctrl_c, make):
    whole = walk(make(), capacity=120)
    snapshot = whole.snapshot()
    count = ctrl_c(0, whole.learn)
    wanted = whole.print("json")
    for number in chosen(count, 25):
        agent = rlvc.Agent.restore(make(), whole.config, snapshot)
        assert ctrl_c(number, agent.learn), number
        agent.check()
        while not agent.learn().done:
            pass
        assert agent.print("json") == wanted, number
        agent.close()


@pytest.mark.parametrize("make", [lambda: 3, Corridor], ids=["bits", "own"])
@pytest.mark.parametrize("what", ["print", "snapshot", "predict", "act", "many"])
def test_calls_that_change_nothing(walk, ctrl_c, make, what):
    agent = walk(make(), capacity=120)
    agent.learn()
    percepts = np.arange(8, dtype=np.uint8)[:, None]
    agent.begin(percepts[0])
    calls = {
        "print": lambda: agent.print("json"),
        "snapshot": agent.snapshot,
        "predict": lambda: agent.predict(percepts[5]),
        "many": lambda: agent.predict(percepts),
        "act": agent.act,
    }
    wanted = agent.snapshot()
    for number in chosen(ctrl_c(0, calls[what]), 60):
        ctrl_c(number, calls[what])
        agent.check()
        if what != "act":
            assert agent.snapshot() == wanted, number
    agent.close()


def due():
    """A planner before its first model."""
    planner = rlvc.Planner(1, 2, random=32, candidates=20, patience=10)
    numbers = np.random.default_rng(1).uniform(-1, 1, (41, 1)).astype(np.float32)
    planner.begin(numbers[0])
    for i, x in enumerate(numbers[1:]):
        action = planner.act()
        planner.observe(action, float((x[0] > 0) == action), x, truncated=i == 39)
    return planner


def test_a_planners_learning_step(ctrl_c):
    whole = due()
    count = ctrl_c(0, whole.learn)
    for number in chosen(count, 60):
        planner = due()
        assert ctrl_c(number, planner.learn), number
        while not planner.learn().done:
            pass
        assert planner.print("json") == whole.print("json"), number
        assert planner.statistics == whole.statistics, number


class Coin(gymnasium.Env):
    observation_space, action_space = spaces.Discrete(2), spaces.Discrete(2)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.side = int(self.np_random.integers(2))
        return self.side, {}

    def step(self, action):
        return self.side, float(action == self.side), True, False, {}


def test_learning_from_an_environment(ctrl_c):
    """It ends early with a run that can be used, or, before anything was learnt, with KeyboardInterrupt."""
    runs = []

    def learn():
        runs.append(rlvc.learn(Coin(), 30, seed=1, every=15))
        if runs[-1].interrupted:
            raise KeyboardInterrupt

    for number in chosen(ctrl_c(0, learn), 60):
        ctrl_c(number, learn)
        runs[-1].agent.check()
        assert runs[-1].act(1) in (0, 1)
        assert runs[-1].agent.statistics.interactions <= 30
    assert any(run.interrupted for run in runs)


@unclosed
def test_saving(walk, ctrl_c, tmp_path, monkeypatch):
    file = tmp_path / "agent"
    old, new = walk(capacity=120), walk(capacity=130)
    contents = []
    for agent in (new, old):
        agent.save(file)
        contents.append(file.read_bytes())
    for nameless in (True, False):
        if not nameless:
            monkeypatch.delattr(os, "O_TMPFILE", raising=False)
        for number in range(1, ctrl_c(0, lambda: new.save(file)) + 1, 5):
            old.save(file)
            ctrl_c(number, lambda: new.save(file))
            assert os.listdir(tmp_path) == ["agent"], number
            assert file.read_bytes() in contents, number


def test_what_was_done_is_what_the_last_finished_act_said(walk, ctrl_c):
    """An interrupted act() may have chosen another action, which is not taken for the one before."""
    for number in range(1, 30):
        agent = walk(capacity=500)
        agent.learn()
        choice = agent.act()
        while ctrl_c(number, agent.act):
            number += 30
        before = agent.statistics.interactions
        agent.observe(choice, 0.0, bytes(1))
        assert agent.statistics.interactions == before + 1
        assert agent._choice.action == choice.action


@unclosed
def test_real_signals(walk, tmp_path):
    """Signals at random moments in learn, save, export_c and print."""

    def saved(agent):
        agent.save(tmp_path / "agent")
        return agent.snapshot()

    def right_file(snapshot):
        loaded = rlvc.Agent.load(tmp_path / "agent", Corridor())
        return os.listdir(tmp_path) == ["agent"] and loaded.snapshot() == snapshot

    def interrupt(*_):
        fired.append(1)
        raise KeyboardInterrupt

    whole, bits = walk(Corridor(), capacity=120), walk(capacity=300)
    snapshot, config = whole.snapshot(), whole.config
    whole.learn()
    bits.learn()
    wanted = whole.print("json"), bits.export_c()
    calls = [  # the call, whether its result is right, and how long it takes at most
        (lambda agent: agent.statistics.step or agent.learn().done, bool, 2e-2),
        (saved, right_file, 5e-2),
        (lambda agent: agent.print("json"), wanted[0].__eq__, 1e-3),
        (lambda _: bits.export_c(), wanted[1].__eq__, 3e-4),
    ]
    drawn, fired, results = random.Random(1), [], collections.Counter()
    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        while len(fired) < int(os.environ.get("RLVC_SIGNALS", "150")):
            agent = rlvc.Agent.restore(Corridor(), config, snapshot)
            for call, right, longest in calls:
                result = None
                while result is None:
                    try:
                        signal.setitimer(signal.ITIMER_REAL, drawn.uniform(1e-5, longest))
                        result = call(agent)
                        signal.setitimer(signal.ITIMER_REAL, 0)
                    except KeyboardInterrupt:
                        results["raised"] += 1
                    finally:
                        signal.setitimer(signal.ITIMER_REAL, 0)
                results["right" if right(result) else "wrong"] += 1
            agent.close()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    print(f"{len(fired)} signals: {dict(results)}")
    assert results["wrong"] == 0
    assert results["raised"] == len(fired)
