# SPDX-License-Identifier: MIT
"""Whatever one gets wrong is a named exception, and the agent is as it was before."""

import gc
import signal
import threading

import numpy as np
import pytest

import rlvc
from rlvc import errors


class Corridor(rlvc.Domain):
    """Percepts are a place and noise; a feature is a place: is the percept's there or beyond."""

    def __init__(self):
        super().__init__(np.uint8, (1,), np.int16)
        self.fault = None

    def hook(self, name):
        if self.fault and self.fault[0] == name:
            return self.fault[1]()
        return None

    def exhibits(self, percept, feature):
        fault = self.hook("exhibits")
        return fault if fault is not None else bool(percept[0] >= feature)

    def candidates(self, percepts):
        fault = self.hook("candidates")
        return fault if fault is not None else np.unique(percepts).astype(np.int16)

    def name(self, feature):
        fault = self.hook("name")
        return fault if fault is not None else f"at {feature} or beyond"


class Batched(Corridor):
    def detect(self, percepts, features):
        fault = self.hook("detect")
        return fault if fault is not None else percepts[:, :1] >= features[None, :]


class Own(Corridor):
    def oracle(self, percepts, below):
        fault = self.hook("oracle")
        if fault is not None:
            return fault
        best = max(
            range(1, 8),
            key=lambda f: abs(np.mean(percepts[:below] >= f) - np.mean(percepts[below:] >= f)),
        )
        return np.int16(best), 7


def state(agent):
    agent.check()
    return (agent.statistics, agent.samples.tolist(), agent.q.tolist(), agent.policy.tolist())


def learnt(agent):
    """What a failing callback leaves as it was: all but values that were solved for before it."""
    agent.check()
    s = agent.statistics
    return s.interactions, s.stored, s.step, s.classes, agent.splits, agent.policy.tolist()


@pytest.mark.parametrize("make", [Corridor, Batched, Own])
def test_own_domains_learn(walk, make):
    agent = walk(make())
    assert agent.learn().done
    agent.check()
    assert agent.classes >= 3
    assert "or beyond" in agent.print()
    assert agent.predict(np.array([4], np.uint8)).action == 1
    assert agent.predict(np.array([6], np.uint8)).action == 0
    many = agent.predict(np.arange(8, dtype=np.uint8)[:, None])
    assert [
        agent.predict(np.array([i], np.uint8)).class_id for i in range(8)
    ] == many.class_id.tolist()
    assert all(split.name == f"at {split.feature} or beyond" for split in agent.splits)


def test_a_batch_detector_changes_nothing(walk):
    trees = []
    for domain in (Corridor(), Batched()):
        agent = walk(domain)
        agent.learn()
        trees.append(agent.print("json"))
    assert trees[0] == trees[1]


class Trouble(Exception):
    pass


def trouble():
    raise Trouble("here")


FAULTS = [
    *[(Corridor, name, trouble, Trouble) for name in ("exhibits", "candidates", "name")],
    (Batched, "detect", trouble, Trouble),
    (Own, "oracle", trouble, Trouble),
    *[(Corridor, "exhibits", lambda v=v: v, errors.DomainError) for v in (1, "yes", 0.5)],
    *[
        (Corridor, "candidates", lambda v=v: v, errors.DomainError)
        for v in ([1, 2], np.zeros(2), np.zeros((2, 2), np.int16), "no")
    ],
    *[
        (Batched, "detect", lambda v=v: v, errors.DomainError)
        for v in (np.zeros((1, 1), bool), np.zeros((64, 64)), "no")
    ],
    *[
        (Own, "oracle", lambda v=v: v, errors.DomainError)
        for v in (3, (1,), (1, 0), (1, -1), ("x", 1), (1, 2**32), (1.5, 1), (1, 2, 3))
    ],
    *[
        (Corridor, "name", lambda v=v: v, errors.DomainError)
        for v in (7, 'a "quote"', "a\nline", "x" * 64, "back\\slash", "\N{SNOWMAN}" * 22)
    ],
    (Corridor, "exhibits", lambda: (_ for _ in ()).throw(KeyboardInterrupt), KeyboardInterrupt),
]


@pytest.mark.parametrize(("make", "name", "fault", "error"), FAULTS)
def test_a_callback_that_fails(walk, make, name, fault, error):
    domain = make()
    agent = walk(domain)
    if name == "name":
        agent.learn()
    before = learnt(agent)
    domain.fault = (name, fault)
    with pytest.raises(error):
        agent.print() if name == "name" else agent.learn()
    domain.fault = None
    assert learnt(agent) == before
    while not agent.learn().done:
        pass
    agent.check()
    assert agent.classes >= 3
    # The same tree as without the fault.
    other = walk(make())
    other.learn()
    if name != "name":
        assert agent.print("json") == other.print("json")


def test_a_fault_in_predict_and_act(walk):
    domain = Corridor()
    agent = walk(domain)
    agent.learn()
    before = state(agent)
    domain.fault = ("exhibits", trouble)
    with pytest.raises(Trouble):
        agent.predict(bytes([3]))
    with pytest.raises(Trouble):
        agent.predict(np.zeros((5, 1), np.uint8))
    assert state(agent) == before
    domain.fault = None
    assert agent.predict(bytes([3])).action == 1


REENTRIES = {
    "begin": lambda agent: agent.begin(bytes(1)),
    "act": lambda agent: agent.act(),
    "observe": lambda agent: agent.observe(0, 0.0, bytes(1)),
    "learn": lambda agent: agent.learn(),
    "predict": lambda agent: agent.predict(bytes(1)),
    "predict_many": lambda agent: agent.predict(np.zeros((2, 1), np.uint8)),
    "act_many": lambda agent: agent.act_many(np.zeros((2, 1), np.uint8)),
    "batch": lambda agent: agent.batch(2).act(),
    "prune": lambda agent: agent.prune(),
    "abandon": lambda agent: agent.abandon(),
    "print": lambda agent: agent.print(),
    "export_c": lambda agent: agent.export_c(),
    "close": lambda agent: agent.close(),
    "statistics": lambda agent: agent.statistics,
    "init": lambda agent: agent.__init__(3, 2),
}


@pytest.mark.parametrize("caller", ["learn", "predict", "print"])
@pytest.mark.parametrize("reentry", REENTRIES)
def test_a_callback_that_reenters(walk, caller, reentry):
    domain = Corridor()
    agent = walk(domain)
    if caller != "learn":
        agent.learn()
    before = learnt(agent)
    domain.fault = ("name" if caller == "print" else "exhibits", lambda: REENTRIES[reentry](agent))
    calls = {
        "learn": agent.learn,
        "predict": lambda: agent.predict(bytes([3])),
        "print": agent.print,
    }
    with pytest.raises(errors.ReenteredError):
        calls[caller]()
    domain.fault = None
    assert learnt(agent) == before


def test_another_thread_is_kept_out(walk):
    domain = Corridor()
    agent = walk(domain)
    found = []

    def other():
        try:
            agent.act()
        except errors.ReenteredError as error:
            found.append(error)

    def wait():
        if not found:
            thread = threading.Thread(target=other)
            thread.start()
            thread.join()

    domain.fault = ("exhibits", wait)
    agent.learn()
    assert found


@pytest.fixture
def agent():
    agent = rlvc.Agent(12, 3, epsilon=1.0)
    agent.begin(bytes(2))
    return agent


U8 = np.uint8
PERCEPTS = [
    bytes(1), bytes(3), b"", "xx", 7, None, [0, 0], np.zeros(2), np.zeros(3, U8), np.zeros((1, 2, 1), U8),
    np.zeros(2, np.int8), np.zeros(12, np.int64), np.zeros(11, bool), np.zeros((), U8), bytearray(2),
]  # fmt: skip


@pytest.mark.parametrize("percept", PERCEPTS, ids=repr)
def test_wrong_percepts(agent, percept):
    before = state(agent)
    for call in (
        lambda: agent.begin(percept),
        lambda: agent.observe(0, 0.0, percept),
        lambda: agent.predict(percept),
    ):
        with pytest.raises(errors.PerceptError):
            call()
    assert state(agent) == before


@pytest.mark.parametrize(
    "percepts",
    [
        np.zeros((4, 3), U8), np.zeros((4, 2), np.int8), np.zeros((4, 2)), np.zeros((4, 2, 1), U8),
        np.zeros((4, 4), U8)[:, ::2], np.asfortranarray(np.arange(8, dtype=U8).reshape(4, 2)),
        np.zeros((4, 11), bool), [[0, 0]], None,
    ],
    ids=lambda p: f"{getattr(p, 'dtype', '')}{getattr(p, 'shape', p)}",
)  # fmt: skip
def test_wrong_arrays_of_percepts(agent, percepts):
    before = state(agent)
    good = np.zeros((4, 2), U8)
    rest = (np.zeros(4, rlvc.CHOICE), np.zeros(4, np.float32))
    for call in (
        lambda: agent.predict(percepts),
        lambda: agent.act_many(percepts),
        lambda: agent.observe_many(percepts, *rest, good, np.zeros(4, U8)),
        lambda: agent.observe_many(good, *rest, percepts, np.zeros(4, U8)),
    ):
        with pytest.raises(errors.PerceptError):
            call()
    assert state(agent) == before


def log(**changes):
    parts = {
        "percepts": np.zeros((4, 2), U8), "choices": np.zeros(4, rlvc.CHOICE),
        "rewards": np.zeros(4, np.float32), "next_percepts": np.zeros((4, 2), U8),
        "ends": np.zeros(4, U8),
    }  # fmt: skip
    return list({**parts, **changes}.values())


def choices_of(action, exploited):
    choices = np.zeros(4, rlvc.CHOICE)
    choices[3] = (action, exploited)
    return choices


@pytest.mark.parametrize(
    ("changes", "error"),
    [
        ({"rewards": np.array([0, 0, np.nan, 0], np.float32)}, errors.RewardError),
        ({"rewards": np.array([0, 0, 2e12, 0], np.float32)}, errors.RewardError),
        ({"rewards": np.zeros(4)}, errors.ArrayError),
        ({"rewards": np.zeros(3, np.float32)}, errors.ArrayError),
        ({"rewards": np.zeros(8, np.float32)[::2]}, errors.ArrayError),
        ({"rewards": [0, 0, 0, 0]}, errors.ArrayError),
        ({"ends": np.full(4, 3, U8)}, errors.RangeError),
        ({"ends": np.zeros(4, bool)}, errors.ArrayError),
        ({"choices": choices_of(3, 0)}, errors.RangeError),
        ({"choices": choices_of(0, 2)}, errors.RangeError),
        ({"choices": np.zeros(4, U8)}, errors.ArrayError),
        ({"choices": np.zeros(8, rlvc.CHOICE)[::2]}, errors.ArrayError),
        ({"next_percepts": np.zeros((3, 2), U8)}, errors.ArrayError),
    ],
)
def test_wrong_logs(agent, changes, error):
    before = state(agent)
    with pytest.raises(error):
        agent.observe_many(*log(**changes))
    assert state(agent) == before


@pytest.mark.parametrize(
    "out",
    [
        (np.zeros(4, np.int32), None), (None, np.zeros(3, np.uint32)), (np.zeros(8, np.uint32)[::2], None),
        np.zeros(4, np.uint32), (None, None, None), ([0] * 4, None), "readonly",
    ],
    ids=str,
)  # fmt: skip
def test_wrong_out(agent, out):
    if isinstance(out, str):
        array = np.zeros(4, np.uint32)
        array.flags.writeable = False
        out = (array, None)
    with pytest.raises(errors.ArrayError):
        agent.predict(np.zeros((4, 2), U8), out)


def test_read_only_and_strided_percepts_are_as_good_as_others(agent):
    percept = np.arange(4, dtype=U8)[::2]
    percept.flags.writeable = False
    agent.observe(1, 0.0, percept)
    percepts = np.zeros((4, 2), U8)
    percepts.flags.writeable = False
    assert agent.predict(percepts, (None, np.zeros(4, np.uint32))).class_id is None
    assert agent.predict(np.zeros(12, bool)) == (0, 0)
    assert agent.predict(np.zeros((0, 2), U8)).action.shape == (0,)


@pytest.mark.parametrize("reward", [np.nan, np.inf, -np.inf, 1.1e12, 1e300, None, "1", [1.0], 1j])
def test_wrong_rewards(agent, reward):
    before = state(agent)
    with pytest.raises(errors.RewardError):
        agent.observe(0, reward, bytes(2))
    assert state(agent) == before


@pytest.mark.parametrize(
    "choice", [3, -1, 256, 2**40, 0.5, None, "a", (0,), (3, True), (0, True, 1)]
)
def test_wrong_actions(agent, choice):
    before = state(agent)
    with pytest.raises(errors.RangeError):
        agent.observe(choice, 0.0, bytes(2))
    assert state(agent) == before


def test_what_was_done_is_what_act_said(agent):
    choice = agent.act()
    agent.observe(2, 0.0, bytes(2))
    agent.observe(choice, 0.0, bytes(2))
    agent.learn()
    samples = agent.samples[0]
    assert samples[2] + samples[choice.action] >= 2


def test_order():
    agent = rlvc.Agent(12, 3)
    for call in (agent.act, lambda: agent.observe(0, 0.0, bytes(2))):
        with pytest.raises(errors.OrderError):
            call()
    with pytest.raises(errors.PerceptError):
        agent.begin(None)


def test_busy(walk):
    agent = walk(capacity=50)
    agent.learn(64)
    with pytest.raises(errors.BusyError):
        for _ in range(100):
            agent.observe(0, 0.0, bytes(1))
    while not agent.learn(64).done:
        pass
    agent.observe(0, 0.0, bytes(1))


def test_a_step_that_is_given_up(walk):
    agent = walk(capacity=50)
    agent.learn(64)
    agent.abandon()
    for _ in range(100):
        agent.observe(0, 0.0, bytes(1))
    assert agent.statistics.step == 0
    assert agent.learn().done
    agent.abandon()
    agent.close()
    with pytest.raises(errors.ClosedError):
        agent.abandon()


def test_a_method_that_goes_on_failing_stops_nobody(walk):
    domain = Corridor()
    agent = walk(domain, capacity=50)
    domain.fault = ("exhibits", trouble)
    with pytest.raises(Trouble):
        agent.learn()
    for _ in range(100):
        agent.observe(0, 0.0, bytes(1))
    domain.fault = None
    assert agent.learn().done
    agent.check()


@pytest.mark.parametrize("budget", [0, 63, -1, 2**32, 0.5, "all"])
def test_wrong_budgets(agent, budget):
    with pytest.raises(errors.RangeError):
        agent.learn(budget)


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"discount": 1.5}, "discount"), ({"capacity": 0}, "capacity"), ({"capacity": 2**40}, "capacity"),
        ({"capacity": "many"}, "capacity"), ({"score": "best"}, "score"), ({"alpha": float("nan")}, "alpha"),
        ({"nonsense": 1}, "nonsense"), ({"epsilon": None, "discount": -1.0}, "discount"),
        ({"classes": 1.5}, "classes"), ({"seed": -1}, "seed"), ({"score": "gini"}, "score"),
    ],
)  # fmt: skip
def test_wrong_configs(changes, named):
    with pytest.raises(errors.ConfigError, match=named):
        rlvc.Agent(3, 2, **changes)


def test_other_configs():
    for actions in (0, 256):
        with pytest.raises(errors.ConfigError, match="actions"):
            rlvc.Agent(3, actions)
    for bits in (0, 1025):
        with pytest.raises(errors.ConfigError, match="bits"):
            rlvc.Agent(bits, 2)
    with pytest.raises(errors.BlockError):
        rlvc.Agent(1024, 255, capacity=2**31 - 1, classes=65535)
    with pytest.raises(errors.ConfigError, match="ranks"):
        rlvc.Agent(Own(), 2, score="ranks")


@pytest.mark.parametrize("count", [0, -1, 2.0, None])
def test_wrong_sizes_of_batches(agent, count):
    with pytest.raises(errors.RangeError):
        agent.batch(count)


@pytest.mark.parametrize("size", [4, 4000])
def test_wrong_steps_of_batches(agent, size):
    batch = agent.batch(size)
    for count in (-1, size + 1, 1.0):
        for call in (batch.act, batch.observe):
            with pytest.raises(errors.RangeError, match="count"):
                call(count)
    with pytest.raises(AttributeError):
        batch.rewards = np.zeros(4)
    with pytest.raises(ValueError, match="own"):
        batch.rewards.resize(8)
    before = state(agent)
    for name, value, error in (
        ("rewards", np.nan, errors.RewardError),
        ("ends", 3, errors.RangeError),
        ("choices", (3, 0), errors.RangeError),
    ):
        array = getattr(batch, name)
        array[2] = value
        with pytest.raises(error, match="interaction 2"):
            batch.observe()
        array[2] = 0
    assert state(agent) == before
    batch.observe()
    agent.close()
    for call in (batch.act, batch.observe):
        with pytest.raises(errors.ClosedError):
            call()


def test_a_closed_agent(agent):
    agent.close()
    agent.close()
    assert "closed" in repr(agent)
    gc.collect()
    percepts = np.zeros((4, 2), U8)
    for call in (
        agent.act, agent.learn, agent.print, agent.check, lambda: agent.begin(bytes(2)),
        lambda: agent.observe(0, 0.0, bytes(2)), lambda: agent.predict(bytes(2)),
        lambda: agent.predict(percepts), lambda: agent.act_many(percepts),
        lambda: agent.observe_many(*log()), lambda: agent.statistics, lambda: agent.q,
        lambda: agent.splits,
    ):  # fmt: skip
        with pytest.raises(errors.ClosedError):
            call()


def test_a_context_closes_its_agent():
    with rlvc.Agent(3, 2) as agent:
        agent.begin(bytes(1))
    with pytest.raises(errors.ClosedError):
        agent.act()


def test_ctrl_c_between_slices(walk, monkeypatch):
    agent = walk()
    original, calls = agent._long, []

    def interrupted(name, *arguments):
        if name == "rlvc_learn":
            calls.append(name)
            if len(calls) == 3:
                raise KeyboardInterrupt
        return original(name, *arguments)

    monkeypatch.setattr(rlvc.Agent, "_slice", 64)
    monkeypatch.setattr(agent, "_long", interrupted)
    with pytest.raises(KeyboardInterrupt):
        agent.learn()
    agent.check()
    assert agent.act().action in (0, 1)
    assert agent.learn().done
    other = walk()
    other.learn()
    assert agent.print("json") == other.print("json")


def test_buffers_and_callbacks_live_as_long_as_the_agent(walk):
    agent = walk(Corridor())
    gc.collect()
    junk = [np.zeros(1000) for _ in range(100)]
    assert agent.learn().done
    del junk
    assert agent.classes > 1


def test_ctrl_c_stops_a_long_step():
    """A signal ends seconds of learning within a slice, and the agent can be used."""
    random = np.random.default_rng(1)
    count = 200_000
    agent = rlvc.Agent(256, 4, capacity=count, classes=500)
    percepts = random.integers(256, size=(count, 32), dtype=np.uint8)
    choices = np.zeros(count, rlvc.CHOICE)
    choices["action"] = random.integers(4, size=count)
    rewards = (percepts[:, 0] + 1.0 * percepts[:, 1]).astype(np.float32)
    agent.observe_many(percepts, choices, rewards, percepts, np.ones(count, np.uint8))
    timer = threading.Timer(0.2, signal.raise_signal, [signal.SIGINT])
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell may have it ignored
    try:
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            agent.learn()
    finally:
        signal.signal(signal.SIGINT, before)
    assert agent.statistics.step == 0
    agent.check()
    agent.predict(percepts[:10])
    assert agent.learn(1000).done is False


def test_an_error_is_one_line():
    """Also one that quotes an exception of another library."""
    for kind in (errors.Error, errors.LogError, errors.StoreError, errors.LibraryError):
        assert str(kind("log.parquet: cannot be read: bad header\n  at byte 5\n")) == (
            "log.parquet: cannot be read: bad header at byte 5"
        )
