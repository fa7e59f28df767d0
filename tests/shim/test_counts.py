# SPDX-License-Identifier: MIT
"""Counting: the loop in C against numpy, in any parts and any order; and what is refused."""

import dataclasses

import numpy as np
import pytest
import worlds

import rlvc
from rlvc.counts import rounds
from rlvc.counts.part import PAIR, ROW, Part, Question
from rlvc.counts.table import Columns, Table
from rlvc.errors import ConfigError, CountError, LogError, LogWarning, RangeError


def added(question, parts):
    table = Table(question)
    for part in parts:
        table.add(part)
    return table.part()


def random_columns(rng, bits, count, actions=3):
    size = -(-bits // 8)
    record = rng.integers(0, 256, (2, count, size), dtype=np.uint8)
    record[:, :, -1] &= (1 << (bits - 8 * (size - 1))) - 1
    record[:, rng.random(count) < 0.5] &= 3  # so that many are alike
    rewards = rng.choice(np.array([0.0, -0.0, 1.5, -7.25], np.float32), count)
    return Columns(record[0], record[1], rng.integers(0, actions, count, dtype=np.uint8), rewards,
                   rng.choice(np.array([0, 0, 1, 2], np.uint8), count), rewards)  # fmt: skip


def cells(packed, tested):
    bit = [packed[:, f // 8].astype(np.uint64) >> np.uint64(f % 8) & np.uint64(1) for f in tested]
    return sum((b << np.uint64(i) for i, b in enumerate(bit)), np.zeros(len(packed), np.uint64))


def reference(some, ask):
    """The same counts by numpy, slowly."""
    over = some.ends == 1
    now, after = (np.unpackbits(side, axis=1, count=ask.features, bitorder="little").astype(np.int64)
                  for side in (some.percepts, some.next_percepts))  # fmt: skip
    after[over] = 0
    next_cell = np.where(over, 0, cells(some.next_percepts, ask.tested)).astype(np.uint64)
    now_cell = cells(some.percepts, ask.tested)
    rows = {}
    for i in range(len(some)):
        reward = float(some.keys[i] + np.float32(0))
        key = (int(now_cell[i]), int(some.actions[i]), bool(over[i]), reward, int(next_cell[i]))
        rows.setdefault(key, []).append(i)
    return {key: (len(of), now[of].sum(0).tolist(), after[of].sum(0).tolist(), (now & after)[of].sum(0).tolist())
            for key, of in rows.items()}  # fmt: skip


def as_dict(part):
    keys = [(int(r["now"]), int(r["action"]), bool(r["terminated"]), float(r["reward"]), int(r["next"]))
            for r in part.row]  # fmt: skip
    follow = part.follow if part.follow is not None else [[None, None]] * len(keys)
    return {key: (int(r["count"]), here.tolist(), *(None if x is None else x.tolist() for x in then))
            for key, r, here, then in zip(keys, part.row, part.present, follow, strict=True)}  # fmt: skip


def counted(some, ask):
    table = Table(ask)
    table.count(some)
    return table.part()


@pytest.mark.parametrize(
    ("bits", "tested"),
    [(1, ()), (3, (0, 1, 2)), (8, (7,)), (18, (0, 9, 17)), (18, ()), (63, (1, 62)), (64, (0, 63)),
     (64, tuple(range(64))), (65, (64, 3)), (300, (299, 5, 128))],
)  # fmt: skip
def test_same_as_numpy(bits, tested):
    rng = np.random.default_rng(bits + len(tested))
    some = random_columns(rng, bits, 3000)
    ask = Question(bits, 3, tuple(sorted(tested)))
    expected = reference(some, ask)
    assert as_dict(counted(some, ask)) == expected
    less = as_dict(counted(some, Question(bits, 3, tuple(sorted(tested)), follow=False)))
    assert less == {key: (*value[:2], None, None) for key, value in expected.items()}


def test_parts_in_any_order_add_up():
    some = worlds.maze(20_000, rewards="tenths", slip=0.1)
    ask = Question(worlds.BITS, 4, (0, 1, 2, 15, 16), sums=True)
    whole = counted(some, ask).digest()
    rng = np.random.default_rng(1)
    for pieces in (1, 2, 4, 7, 300):
        order = rng.permutation(len(some))
        parts = [counted(worlds.part_of(some, index), ask) for index in np.array_split(order, pieces)]
        rng.shuffle(parts)
        assert added(ask, parts).digest() == whole, pieces
    two = counted(some, ask)
    twice = added(ask, [two, two])
    assert twice.interactions == 2 * len(some)
    assert (twice.present == 2 * two.present).all()


def test_sums_of_rewards_are_exact():
    from fractions import Fraction

    rng = np.random.default_rng(5)
    some = random_columns(rng, 4, 500)
    rewards = (rng.standard_normal(500) * 10.0 ** rng.integers(-40, 12, 500)).astype(np.float32)
    some = dataclasses.replace(some, rewards=rewards, keys=np.zeros(500, np.float32))
    part = counted(some, Question(4, 3, (0, 1), sums=True))
    sums = {}
    cell = cells(some.percepts, (0, 1))
    for i in range(500):
        key = int(cell[i]), int(some.actions[i])
        sums[key] = sums.get(key, 0) + Fraction(float(rewards[i]))
    for pair, words in zip(part.pair, part.reward, strict=True):
        number = sum(int(word) << 64 * k for k, word in enumerate(words))
        number -= (number >> 255) << 256
        assert Fraction(number, 2**149) == sums[int(pair["now"]), int(pair["action"])]


def test_table_grows_up_to_its_memory():
    rng = np.random.default_rng(2)
    some = random_columns(rng, 16, 10_000)
    ask = Question(16, 3, tuple(range(16)))
    assert as_dict(counted(some, ask)) == reference(some, ask)
    small = Table(ask, memory=2 << 20)
    with pytest.raises(CountError, match="more than 2097152 bytes"):
        small.count(some)


@pytest.mark.parametrize(
    ("field", "value", "text"),
    [("actions", 3, "interaction 41: action: 3 is not in"), ("ends", 3, "interaction 41: end: 3"),
     ("rewards", np.nan, "interaction 41: reward: nan"), ("rewards", 2e12, "reward: 1999999991808.0 is not"),
     ("rewards", -np.inf, "reward: -inf")],
)  # fmt: skip
def test_faults_are_named(field, value, text):
    some = random_columns(np.random.default_rng(3), 8, 100)
    array = getattr(some, field).copy()
    array[41] = value
    with pytest.raises(LogError, match=text):
        counted(dataclasses.replace(some, **{field: array}), Question(8, 3))


# ------------------------------------------------------------------ learning


def learn(some, tested=(), **config):
    """The agent that counts make, and the passes."""
    fields = {"capacity": 2000, "classes": 512, "discount": 0.99, "tolerance": 0.001, "dependence": False} | config
    agent = rlvc.Agent(worlds.BITS, rlvc.Config(4, **fields))
    progress = rounds.Progress()
    rounds.learn(agent, lambda cell: counted(some, rounds.question_of(agent, cell, False)), progress,
                 set(tested))  # fmt: skip
    return agent, progress


def expect_same(one, other):
    assert one.print("json") == other.print("json")
    assert one.q.tobytes() == other.q.tobytes()
    assert one.samples.tobytes() == other.samples.tobytes()


@pytest.mark.parametrize(
    ("slip", "rewards"), [(0.0, "plain"), (0.1, "plain"), (0.0, "tenths"), (0.1, "tenths"), (0.0, "normal")]
)
def test_same_tree_as_in_memory(slip, rewards):
    some = worlds.maze(20_000, slip=slip, rewards=rewards)
    expected = rlvc.learn_from(worlds.log_of(some), actions=4).agent
    agent, progress = learn(some)
    expect_same(agent, expected)
    assert progress.passes <= 1 + len(rounds.tested_by(agent))
    guessed, progress = learn(some, rounds.tested_by(agent))
    expect_same(guessed, expected)
    assert progress.passes == 1


def test_what_counts_cannot_do_is_refused():
    for config, text in (
        ({"criterion": "returns"}, "returns depend on the order"),
        ({"solver": "sarsa"}, "sarsa depends on the order"),
        ({"solver": "q_learning"}, "q_learning depends on the order"),
        ({"score": "ranks"}, "ranks are not made from counts"),
        ({"dependence": True}, "the order of interactions"),
    ):
        with pytest.raises(ConfigError, match=text):
            rounds.refuse(rlvc.Agent(8, rlvc.Config(2, **config)))
    with pytest.raises(ConfigError, match="counts are of bits"):
        rounds.refuse(rlvc.Agent(rlvc.Thresholds(2), 2))


CELL = (0, 1, 2, 3, 15, 16, 17)  # the bits of the maze that say where the walker is


def scaled(part, times):
    times = np.uint64(times)
    row = part.row.copy()
    row["count"] *= times
    follow = None if part.follow is None else part.follow * times
    return Part(row, part.present * times, follow, part.pair, None)


@pytest.mark.parametrize("total", [2**31, 2**32, 10**11, 2**47])
def test_more_than_any_ring_holds(total):
    """Scaled counts scale luck as well; but where rewards follow from the cell, luck ends with it."""
    some = worlds.maze(50_000)
    fields = {"classes": 60, "discount": 0.99, "tolerance": 0.001, "successors": False}
    agents = []
    for times in (1, total // len(some)):
        agent = rlvc.Agent(worlds.BITS, rlvc.Config(4, **fields))
        part = scaled(counted(some, rounds.question_of(agent, CELL, False)), times)
        rounds.learn(agent, lambda _cell, part=part: part, rounds.Progress(), set(CELL))
        agents.append(agent)
    small, large = agents
    assert rounds.tested_by(large) == rounds.tested_by(small) == set(CELL)
    assert large.statistics.interactions == total // len(some) * len(some)
    values = [agent.values[agent.predict(some.percepts[:2000]).class_id] for agent in agents]
    np.testing.assert_allclose(*values, atol=0.01)


def chance(total, shift, seed):
    """Counts of interactions that end at once: 18 bits by chance, and a reward of 0 or 1 that is more often 1, by
    ``shift``, where bit 3 is."""
    rng = np.random.default_rng(seed)
    row = np.zeros(16, ROW)
    row["action"], row["now"], row["reward"] = (np.arange(16) // n % m for n, m in ((4, 4), (2, 2), (1, 2)))
    row["terminated"] = 1
    cell = rng.multinomial(total, np.full(8, 1 / 8))
    ones = rng.binomial(cell, 0.5 + shift * row["now"][::2])
    row["count"] = np.stack([cell - ones, ones], axis=1).ravel()
    present = rng.binomial(row["count"][:, None].astype(np.int64), 0.5, (16, 18)).astype(np.uint64)
    present[:, 3] = row["count"] * row["now"]
    return Part(row, present, None, np.zeros(0, PAIR), None)


@pytest.mark.parametrize(
    ("shift", "smallest", "classes"), [(0.0, 0.0, 1), (0.002, 0.0, 2), (0.002, 0.01, 1), (0.02, 0.01, 2)]
)
def test_what_a_hundred_million_say(shift, smallest, classes):
    """Any effect is found, none is made up, and one that is worth too little is left alone, in 19 of 20 runs."""
    found = []
    for seed in range(20):
        agent = rlvc.Agent(18, rlvc.Config(4, successors=False, smallest_effect=smallest))
        part = chance(10**8, shift, seed)
        rounds.learn(agent, lambda _cell, part=part: part, rounds.Progress(), {3})
        found.append(agent.classes)
    assert found.count(classes) >= 19


def test_too_many_is_an_error():
    agent = rlvc.Agent(worlds.BITS, rlvc.Config(4, dependence=False))
    part = scaled(counted(worlds.maze(1000), rounds.question_of(agent, (), False)), 2**48)
    with pytest.raises(RangeError):
        agent.learn_counts(part.native(np.arange(18, dtype=np.uint16), np.zeros(0, np.uint32)))


def without_effect(rng, count, features, actions):
    """Counts of so many interactions in which all bits, actions and rewards are drawn by themselves."""
    row = np.zeros(2 * actions, ROW)
    row["count"] = rng.multinomial(count, np.full(2 * actions, 0.5 / actions))
    row["action"], row["reward"] = np.repeat(np.arange(actions), 2), np.tile([0, 1], actions)
    each = np.repeat(row["count"].astype(np.int64)[:, None], features, axis=1)
    present = rng.binomial(each, 0.5)
    both = rng.binomial(present, 0.5)
    after = both + rng.binomial(each - present, 0.5)
    follow = np.stack([after, both], axis=1)
    return Part(row, present.astype(np.uint64), follow.astype(np.uint64), np.zeros(0, PAIR), None)


@pytest.mark.parametrize("count", [10**8, 10**11])
def test_without_an_effect_there_is_no_split(count):
    """Counts can be drawn as they are: nobody has to count 100 million interactions for that."""
    false = 0
    for seed in range(20):
        part = without_effect(np.random.default_rng(seed), count, worlds.BITS, 4)
        agent = rlvc.Agent(worlds.BITS, rlvc.Config(4, dependence=False))
        native = part.native(np.arange(worlds.BITS, dtype=np.uint16), np.zeros(0, np.uint32))
        false += agent.learn_counts(native).splits > 0
    assert false <= 1


# ------------------------------------------------------------------ logs above the replay buffer


def test_a_long_log_is_counted_and_nothing_is_left_out(monkeypatch):
    some = worlds.maze(20_000, slip=0.1)
    log = worlds.log_of(some)
    expected = rlvc.learn_from(log, actions=4)
    monkeypatch.setattr("rlvc.learning.learn._CAPACITY_MAX", 30_000)
    run = rlvc.learn_from(log, actions=4)
    expect_same(run.agent, expected.agent)
    assert [(r.step, r.interactions, r.classes, r.splits) for r in run.history] == [(1, 20_000, 46, 45)]
    assert run.agent.statistics.interactions == 20_000
    assert run.agent.statistics.stored == 0
    assert rlvc.learn_from(log, actions=4, dependence=True).agent.config.capacity == 40_000
    whole = rlvc.learn_from(log | {"exploited": np.zeros(20_000, bool)}, actions=4, criterion="returns")
    assert whole.agent.config.capacity == 40_000


def test_a_short_ring_says_what_it_leaves_out():
    log = worlds.log_of(worlds.maze(3000))
    with pytest.warns(LogWarning, match=r"capacity 1000 holds the last \d+ of 3000 interactions"):
        run = rlvc.learn_from(log, actions=4, capacity=1000)
    assert run.history[0].interactions == run.agent.statistics.stored <= 1000


# ------------------------------------------------------------------ fuzzing


@pytest.mark.parametrize("seed", range(60))
def test_any_log_makes_the_same_tree(seed):
    """Small worlds by chance: bits that follow from each other, rewards of a few values or of any."""
    rng = np.random.default_rng(seed)
    bits, actions, count = int(rng.integers(1, 9)), int(rng.integers(1, 5)), int(rng.integers(50, 3000))
    state = rng.integers(0, 2, (count + 1, bits)).astype(bool)
    action = rng.integers(0, actions, count)
    rule = rng.integers(0, bits, (bits, 2))
    for f in range(bits):  # what follows, sometimes
        follows = rng.random(count) < rng.random()
        state[1:, f] = np.where(follows, state[:-1, rule[f, 0]] ^ (action % 2 == rule[f, 1] % 2), state[1:, f])
    kind = rng.integers(0, 3)
    rewards = (state[:-1, 0] * (action + 1.0) * [1.0, 0.1, 1e9][kind]).astype(np.float32)
    if rng.random() < 0.5:
        rewards += (rng.integers(0, 3, count) * 0.3).astype(np.float32)
    if rng.random() < 0.2:
        rewards += rng.standard_normal(count).astype(np.float32)
    terminated = rng.random(count) < 0.05
    log = {"observations": state[:-1], "next_observations": state[1:], "actions": action, "rewards": rewards,
           "terminated": terminated, "truncated": ~terminated & (rng.random(count) < 0.02)}  # fmt: skip
    config = {"discount": float(rng.choice([0.0, 0.5, 0.99])), "successors": bool(rng.integers(0, 2)),
              "explore": str(rng.choice(["uniform", "directed"])), "classes": int(rng.choice([3, 64])),
              "solver": str(rng.choice(["value_iteration", "policy_iteration"]))}  # fmt: skip
    expected = rlvc.learn_from(log, actions=actions, **config).agent
    monkey = pytest.MonkeyPatch()
    with monkey.context() as patch:
        patch.setattr("rlvc.learning.learn._CAPACITY_MAX", 10)
        agent = rlvc.learn_from(log, actions=actions, **config).agent
    assert agent.statistics.stored == 0
    expect_same(agent, expected)
