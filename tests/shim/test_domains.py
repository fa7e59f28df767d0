# SPDX-License-Identifier: MIT
"""What a domain returns, and what it is asked, is checked before C reads it."""

import copy
import pickle

import numpy as np
import pytest
from test_errors import Corridor

import rlvc
from rlvc import errors

READY = [rlvc.Bits(5), rlvc.Thresholds(2), rlvc.Descriptors(4, 2, 0.5)]


@pytest.mark.parametrize("domain", READY)
def test_no_percepts_have_no_candidates_but_all_bits(domain):
    none = np.zeros((0, *domain.percept_shape), domain.percept_dtype)
    found = domain.candidates(none)
    assert found.dtype == domain.feature_dtype
    assert len(found) == (5 if isinstance(domain, rlvc.Bits) else 0)


class Packing(Corridor):
    """Packs percepts as it is told."""

    def __init__(self, one, many):
        super().__init__()
        self.one, self.many = one, many

    def pack(self, percept):
        return self.one

    def pack_many(self, percepts):
        return self.many


MANY = [
    None, b"", [1, 2], np.zeros((4, 2), np.uint8), np.zeros((4, 0), np.uint8), np.zeros(4, np.uint16),
    np.zeros((4, 2), np.uint8)[:, :1], np.uint8(3),
]  # fmt: skip


@pytest.mark.parametrize("packed", [b"", bytes(2), None, "x", bytearray(1), np.zeros(1, np.uint8)])
def test_a_pack_that_returns_something_else(packed):
    agent = rlvc.Agent(Packing(packed, None), 2)
    for call in (agent.begin, agent.predict, lambda percept: agent.observe(0, 0.0, percept)):
        with pytest.raises(errors.DomainError, match=r"pack\(\) returned"):
            call(np.zeros(1, np.uint8))


@pytest.mark.parametrize("packed", MANY, ids=repr)
def test_a_pack_many_that_returns_something_else(packed):
    agent = rlvc.Agent(Packing(b"", packed), 2)
    percepts = np.zeros((4, 1), np.uint8)
    log = (np.zeros(4, rlvc.CHOICE), np.zeros(4, np.float32), percepts, np.zeros(4, np.uint8))
    for call in (
        agent.predict,
        agent.act_many,
        lambda percepts: agent.observe_many(percepts, *log),
    ):
        with pytest.raises(errors.DomainError, match=r"pack_many\(\) returned"):
            call(percepts)


@pytest.mark.parametrize("domain", [*READY, Corridor()])
def test_types_and_sizes_stay(domain):
    for name in (
        "percept_dtype",
        "percept_shape",
        "percept_bytes",
        "feature_dtype",
        "feature_bytes",
    ):
        with pytest.raises(errors.DomainError, match=name):
            setattr(domain, name, getattr(domain, name))
    for other in (copy.copy(domain), pickle.loads(pickle.dumps(domain))):
        assert other.percept_bytes == domain.percept_bytes


@pytest.mark.parametrize(
    "arguments",
    [
        ("no such type",), (object,), (np.uint8, 3), (np.uint8, (2.5,)), (np.uint8, (-1,)), (np.uint8, (0,)),
        (np.uint8, (2**21,)), (np.uint8, (1,), "none"), (np.uint8, (1,), np.int8, -1),
        (np.uint8, (1,), np.int8, 2**32), (np.uint8, (1,), np.int8, "many"),
    ],
    ids=repr,
)  # fmt: skip
def test_wrong_types_and_sizes(arguments):
    class Other(Corridor):
        def __init__(self):
            rlvc.Domain.__init__(self, *arguments)

    with pytest.raises(errors.ConfigError):
        Other()


@pytest.mark.parametrize(
    "value", ["3", 3.5, None, 0, -1, 2**32 + 3, 2**70, [3], True, np.float32(3)]
)
def test_wrong_parameters_of_domains(value):
    for make in (
        rlvc.Bits, rlvc.Thresholds, lambda v: rlvc.Descriptors(v, 2, 0.5),
        lambda v: rlvc.Descriptors(4, v, 0.5), lambda v: rlvc.Descriptors(4, 2, 0.5, "float", v),
        lambda v: rlvc.Descriptors(4, 2, 0.5, "float", 4, v), lambda v: rlvc.Agent(v, 2),
        lambda v: rlvc.Agent(3, v),
    ):  # fmt: skip
        with pytest.raises(errors.ConfigError):
            make(value)
    for value in ("x", None, float("nan"), float("inf"), 0.0, -1.0, [1.0, 2.0]):
        with pytest.raises(errors.ConfigError):
            rlvc.Descriptors(4, 2, value)


def test_numbers_of_numpy_are_numbers():
    agent = rlvc.Agent(np.uint8(5), np.int64(2), seed=np.uint32(7), discount=np.float32(0.5))
    agent.begin(bytes(1))
    agent.observe(np.int8(1), np.float64(1.0), bytes(1), terminated=np.bool_(True))
    assert agent.learn(np.int64(10_000)).done
    assert agent.batch(np.int32(3)).act(np.int16(2)).shape == (2,)


def test_features_that_are_none_of_the_domain():
    thresholds, descriptors = READY[1:]
    beyond = np.zeros((), thresholds.feature_dtype)
    beyond["component"] = 2
    percepts = {thresholds: np.ones(2, np.float32), descriptors: np.ones((4, 2), np.float32)}
    for domain, percept in percepts.items():
        for feature in (np.uint8(0), 3, "x", None, np.zeros(2, domain.feature_dtype), beyond):
            with pytest.raises(errors.DomainError):
                domain.exhibits(percept, feature)
            with pytest.raises(errors.DomainError):
                domain.name(feature)


def packed(numbers):
    """A record of descriptors with one vector."""
    return (1).to_bytes(4, "little") + np.array([*numbers, *[0.0] * 6], np.float32).tobytes()


@pytest.mark.parametrize("number", [np.nan, np.inf, -np.inf])
def test_numbers_that_are_none(number):
    agent = rlvc.Agent(rlvc.Descriptors(4, 2, 0.5), 2)
    agent.begin(packed([1.0, 2.0]))
    records = np.frombuffer(packed([1.0, number]), np.uint8)[None]
    for call in (agent.begin, agent.predict):
        for percept in (packed([1.0, number]), np.array([[1.0, number]], np.float32)):
            with pytest.raises(errors.PerceptError):
                call(percept)
    with pytest.raises(errors.PerceptError):
        agent.predict(records)


@pytest.mark.parametrize("number", [np.nan, np.inf, 2e15])
def test_batches_refuse_what_is_no_number(number):
    agent = rlvc.Agent(rlvc.Thresholds(2), 2, capacity=100)
    batch = agent.batch(4)
    batch.act()
    batch.observe()
    for array, calls in (
        (batch.percepts, (batch.act, batch.observe)),
        (batch.next_percepts, (batch.observe,)),
    ):
        array[1, 1] = number
        for call in calls:
            with pytest.raises(errors.PerceptError):
                call()
        call(1)  # that of the other environments
        array[1, 1] = 0.0
    batch.next_percepts[1, 1] = number  # nobody looks at it after the end
    batch.ends[1] = 1
    batch.observe()
    assert agent.statistics.interactions == 4 + 1 + 1 + 4
    assert agent.learn().done


def test_the_action_of_a_split():
    """Nothing is ever paid, but an action turns a bit round: only what follows shows that."""
    agent = rlvc.Agent(2, 2, epsilon=1.0, capacity=4000, successors=True)
    random = np.random.default_rng(1)
    percept = 0
    agent.begin(bytes([percept]))
    for _ in range(2000):
        choice = agent.act()
        following = ((percept & 1) ^ choice.action) | int(random.integers(2)) << 1
        agent.observe(choice, 0.0, bytes([following]))
        percept = following
    agent.learn()
    splits = agent.splits
    assert {split.action for split in splits} <= {None, 0, 1}
    assert splits
    assert all(split.successors and split.action is None for split in splits)


class Checked(Corridor):
    """Vouches for percepts and features below 8; fails on demand."""

    def __init__(self):
        super().__init__()
        self.answer = None  # instead of the truth

    def check_percept(self, percept):
        return self.said(bool(percept[0] < 8))

    def check_feature(self, feature):
        return self.said(bool(feature < 8))

    def said(self, truth):
        if isinstance(self.answer, Exception):
            raise self.answer
        return truth if self.answer is None else self.answer


def test_a_domain_refuses_percepts():
    agent = rlvc.Agent(Checked(), 2)
    agent.begin(bytes([7]))
    for call in (
        lambda: agent.begin(bytes([8])),
        lambda: agent.observe(0, 0.0, bytes([200])),
        lambda: agent.observe_many(
            np.zeros((1, 1), np.uint8), np.zeros(1, rlvc.CHOICE), np.zeros(1, np.float32),
            np.full((1, 1), 9, np.uint8), np.zeros(1, np.uint8)),
    ):  # fmt: skip
        with pytest.raises(errors.PerceptError):
            call()
    agent.observe(0, 0.0, bytes([3]))
    assert agent.statistics.interactions == 1


@pytest.mark.parametrize("answer", [1, None, "yes", np.array([True, False])], ids=repr)
def test_a_check_that_returns_something_else(answer):
    domain = Checked()
    domain.said = lambda truth: answer
    with pytest.raises(errors.DomainError, match=r"check_percept\(\) returned"):
        rlvc.Agent(domain, 2).begin(bytes(1))


def test_a_check_that_raises():
    domain = Checked()
    domain.answer = KeyError("mine")
    with pytest.raises(KeyError, match="mine"):
        rlvc.Agent(domain, 2).begin(bytes(1))


def test_forged_records_of_a_domain_of_ones_own(walk):
    """What a snapshot says of percepts and features is checked, and what a check raises comes out."""
    domain = Checked()
    agent = walk(domain)
    agent.learn()
    assert agent.statistics.classes > 1
    snapshot = agent.snapshot()
    assert rlvc.Agent.restore(domain, agent.config, snapshot).snapshot() == snapshot
    for answer in (False, np.False_):
        domain.answer = answer
        with pytest.raises(errors.SnapshotError):
            rlvc.Agent.restore(domain, agent.config, snapshot)
    domain.answer = KeyError("mine")
    for call in (lambda: rlvc.Agent.restore(domain, agent.config, snapshot), agent.check):
        with pytest.raises(KeyError, match="mine"):
            call()


METHODS = (
    "exhibits", "candidates", "name", "feature", "pack", "pack_many", "check_many", "is_one",
    "detect", "oracle", "check_percept", "check_feature",
)  # fmt: skip


@pytest.mark.parametrize("name", METHODS)
def test_a_method_that_is_none(name):
    domain = Corridor()
    setattr(domain, name, 5)
    with pytest.raises(errors.DomainError, match=f"{name}: 5 is not a method"):
        rlvc.Agent(domain, 2)


def test_a_domain_without_sizes():
    class Unfinished(Corridor):
        def __init__(self):
            pass

    with pytest.raises(errors.DomainError, match="__init__"):
        rlvc.Agent(Unfinished(), 2)
    domain = Corridor()
    domain.features_max = -1
    with pytest.raises(errors.ConfigError, match="features_max"):
        rlvc.Agent(domain, 2)


class Raising:
    """An object of the caller that raises at whatever is asked of it."""

    def _no(self, *arguments):
        raise RuntimeError("no")

    __iter__ = __len__ = __array__ = __bool__ = __repr__ = __getattr__ = _no


@pytest.mark.parametrize("answer", [None, 2, "yes", np.array([True, False]), Raising()], ids=type)
def test_an_is_one_that_returns_something_else(answer):
    domain = Corridor()
    domain.is_one = lambda percept: answer
    with pytest.raises(errors.DomainError, match=r"is_one\(\)"):
        rlvc.Agent(domain, 2).predict(np.zeros(1, np.uint8))


@pytest.mark.parametrize("answer", [False, True, 0, np.zeros(2), Raising()], ids=type)
def test_a_check_many_that_returns_something(answer):
    """It raises where a percept is invalid; one that returns False would let it pass."""

    class Answering(Corridor):
        def check_many(self, packed):
            return answer

    batch = rlvc.Agent(Answering(), 2).batch(2)
    for call in (batch.act, batch.observe):
        with pytest.raises(errors.DomainError, match=r"check_many\(\) returned"):
            call()


def test_a_check_many_that_raises():
    class Failing(Corridor):
        said = KeyError("mine")

        def check_many(self, packed):
            raise self.said

    domain = Failing()
    agent = rlvc.Agent(domain, 2)
    batch = agent.batch(2)
    for call in (batch.act, batch.observe):
        with pytest.raises(KeyError, match="mine"):
            call()
    domain.said = errors.PerceptError("not mine")
    with pytest.raises(errors.PerceptError, match="not mine"):
        batch.observe()
    assert agent.statistics.interactions == 0


@pytest.mark.parametrize("method", ["candidates", "oracle"])
def test_answers_that_raise_when_looked_at(method, walk):
    domain = Corridor()
    setattr(domain, method, lambda *arguments: Raising())
    with pytest.raises(errors.DomainError, match=rf"{method}\(\) returned <Raising>"):
        walk(domain).learn()


@pytest.mark.parametrize("packed", [b"", bytes(5), None, np.zeros(2, np.float32)])
def test_a_policy_does_not_trust_a_domain_either(packed):
    """A subclass of a ready-made domain is the caller's: what it packs is checked, as an agent does."""

    class Own(rlvc.Thresholds):
        def pack(self, percept):
            return packed

    policy = rlvc.PlannedPolicy(Own(2), 2, [(0.0, 65535, 0, 1)])
    with pytest.raises(errors.DomainError, match=r"pack\(\) returned"):
        policy.act(np.zeros(2, np.float32))
