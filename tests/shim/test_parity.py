# SPDX-License-Identifier: MIT
"""The package and a C program make the same trees of the same calls, bit for bit."""

import subprocess

import hypothesis
import hypothesis.strategies as st
import numpy as np

import rlvc
from rlvc import errors
from rlvc.agent.config import CHOICES

STATUS = {
    errors.PerceptError: -1, errors.OrderError: -4, errors.RangeError: -5, errors.RewardError: -6,
    errors.BusyError: -7,
}  # fmt: skip


def status_of(error):
    return next(status for kind, status in STATUS.items() if isinstance(error, kind))


@st.composite
def programs(draw):
    """A config, and calls in the order in which a user might make them, or might not."""
    config = {
        "bits": draw(st.integers(1, 12)),
        "actions": draw(st.integers(1, 4)),
        "capacity": draw(st.sampled_from([1, 7, 60, 500])),
        "classes": draw(st.sampled_from([1, 2, 16])),
        "seed": draw(st.integers(0, 2**32 - 1)),
        "solver": draw(st.integers(0, 3)),
        "criterion": draw(st.integers(0, 1)),
    }
    # The world: the reward of a percept is that of its lowest bits, so that there is much to learn.
    seed = draw(st.integers(0, 2**32 - 1))
    blocks = draw(
        st.lists(
            st.one_of(
                st.tuples(st.just("walk"), st.integers(1, 120)),
                st.tuples(st.just("learn"), st.sampled_from([64, 500, 2**32 - 1])),
                st.tuples(st.just("wrong"), st.sampled_from(["reward", "act", "action"])),
                st.tuples(st.just("predict"), st.integers(1, 3)),
            ),
            min_size=1,
            max_size=12,
        )
    )
    return config, seed, blocks


class Python:
    """Makes calls through the package and writes them down."""

    def __init__(self, config):
        names = {name: CHOICES[name][config[name]] for name in ("solver", "criterion")}
        sizes = {name: config[name] for name in ("capacity", "classes", "seed")}
        self.agent = rlvc.Agent(config["bits"], config["actions"], **sizes, **names)
        self.lines = [" ".join(str(value) for value in config.values())]
        self.answers = []

    def call(self, line, function):
        self.lines.append(line)
        try:
            answer = function()
        except rlvc.Error as error:
            answer = (status_of(error), *((0, 0) if line[0] in "alp" else ()))
        else:
            answer = (0, *(answer or ()))
        self.answers.append(" ".join(str(int(value)) for value in answer))
        return answer

    def observe(self, action, exploited, reward, percept, end):
        hexadecimal = percept.hex() if percept else "-"
        self.call(
            f"o {action} {int(exploited)} {np.float32(reward).item().hex()} {hexadecimal} {end}",
            lambda: self.agent.observe(
                rlvc.Choice(action, exploited), reward, percept, end == 1, end == 2
            ),
        )


def play(python, config, seed, blocks):
    random = np.random.default_rng(seed)
    size = (config["bits"] + 7) // 8
    agent = python.agent

    def percept():
        return random.integers(256, size=size, dtype=np.uint8).tobytes()

    def begin():
        packed = percept()
        python.call(f"b {packed.hex()}", lambda: agent.begin(packed))

    def learn(budget):
        def call():
            progress = agent.learn(budget)
            return progress.splits, progress.done

        python.call(f"l {budget}", call)

    begin()
    for kind, argument in blocks:
        if kind == "walk":
            current = percept()
            for _ in range(argument):
                status, action, exploited = python.call("a", agent.act)
                if status != 0:
                    begin()
                    continue
                following = percept()
                reward = float(current[0] % 4 * (action + 1)) + float(random.normal()) * 0.01
                end = int(random.choice([0, 0, 0, 1, 2]))
                python.observe(action, exploited, np.float32(reward).item(), following, end)
                current = following
        elif kind == "learn":
            learn(argument)
        elif kind == "predict":
            for _ in range(argument):
                packed = percept()
                python.call(f"p {packed.hex()}", lambda packed=packed: agent.predict(packed))
        elif argument == "reward":
            python.observe(0, False, float("inf"), percept(), 0)
        elif argument == "act":
            python.call("a", agent.act)


@hypothesis.settings(max_examples=150)
@hypothesis.given(programs())
def test_same_calls_same_tree(caller, program):
    config, seed, blocks = program
    python = Python(config)
    play(python, config, seed, blocks)
    python.agent.check()
    done = subprocess.run(
        [caller], input="\n".join(python.lines) + "\n", capture_output=True, text=True, check=True
    )
    answers = done.stdout.splitlines()
    count = len(python.answers)
    assert answers[:count] == python.answers
    assert "\n".join(answers[count:]).strip() == python.agent.print("json").strip()


def test_batches_equal_single_calls():
    random = np.random.default_rng(5)
    percepts = random.integers(256, size=(301, 2), dtype=np.uint8)
    ends = random.choice([0, 0, 0, 1, 2], size=300).astype(np.uint8)
    choices = np.zeros(300, rlvc.CHOICE)
    choices["action"] = random.integers(3, size=300)
    rewards = (percepts[:-1, 0] % 4 * choices["action"]).astype(np.float32)
    one, many = (rlvc.Agent(12, 3, classes=32) for _ in range(2))
    many.observe_many(percepts[:-1], choices, rewards, percepts[1:], ends)
    for i in range(300):
        if i == 0 or ends[i - 1]:
            one.begin(percepts[i])
        choice = rlvc.Choice(int(choices[i]["action"]), False)
        one.observe(choice, float(rewards[i]), percepts[i + 1], ends[i] == 1, ends[i] == 2)
    assert one.learn().splits == many.learn().splits > 0
    assert one.print("json") == many.print("json")
    assert one.statistics == many.statistics
    classes, actions = many.predict(percepts)
    assert [tuple(one.predict(percept)) for percept in percepts] == list(
        zip(classes.tolist(), actions.tolist(), strict=True)
    )


def test_a_batch_equals_arrays():
    """Over some steps of a vector whose last environment is dead in every third."""
    random = np.random.default_rng(6)
    arrays, batched = (rlvc.Agent(12, 3, classes=32, epsilon=0.5) for _ in range(2))
    batch = batched.batch(9)
    for step in range(200):
        count = 8 if step % 3 == 0 else 9
        percepts, after = random.integers(256, size=(2, count, 2), dtype=np.uint8)
        ends = random.choice([0, 0, 1, 2], size=count).astype(np.uint8)
        batch.percepts[:count] = percepts
        choices = batch.act(count)
        assert (choices == arrays.act_many(percepts)).all()
        rewards = (percepts[:, 0] % 4 * choices["action"]).astype(np.float32)
        batch.rewards[:count], batch.ends[:count] = rewards, ends
        batch.next_percepts[:count] = after
        batch.observe(count)
        arrays.observe_many(percepts, choices, rewards, after, ends)
        if step == 100:
            assert arrays.learn() == batched.learn()
    assert arrays.learn().splits == batched.learn().splits
    assert arrays.classes > 2
    assert arrays.snapshot() == batched.snapshot()


def test_a_large_batch_equals_a_small_one():
    """A large one releases the interpreter's lock."""
    large = rlvc.Agent(12, 3).batch(4000)
    small = rlvc.Agent(12, 3).batch(100)
    for batch in (large, small):
        batch.percepts[:100] = np.arange(200, dtype=np.uint8).reshape(100, 2)
    assert (large.act(100) == small.act()).all()
