# SPDX-License-Identifier: MIT
"""A run: the policy that acts is the one that is predicted by, saved, loaded, exported and shown."""

import ctypes
import pickle
import re
import subprocess

import gymnasium
import numpy as np
import pytest
from gymnasium import spaces
from test_learning import Line

import rlvc
from rlvc import errors

OBSERVATIONS = 3_000


class Guess(gymnasium.Env):
    """One-step episodes: the best action depends on the observation, by a rule for each space."""

    metadata = {"render_modes": []}  # noqa: RUF012

    def __init__(self, kind):
        self.observation_space = {
            "bits": spaces.MultiBinary(20),
            "number": spaces.Discrete(300, start=-7),
            "thresholds": spaces.Box(-5, 5, (3,), np.float64),
            "picture": spaces.Box(0, 255, (8, 8, 3), np.uint8),
            "mixed": spaces.Dict({
                "mode": spaces.Discrete(3, start=1),
                "inner": spaces.Tuple((spaces.Box(-1, 1, (2,), np.float32), spaces.MultiBinary(3))),
                "many": spaces.MultiDiscrete([4, 9]),
            }),
        }[kind]  # fmt: skip
        self.rule = {
            "bits": lambda o: int(o[3] and not o[17]) + 2 * int(o[5]),
            "number": lambda o: int(o + 7 >> 5 & 1) + int(o + 7 >> 7 & 1),
            "thresholds": lambda o: int(o[1] > 0.3) + int(o[2] > -2.0),
            "picture": lambda o: int(o[2, 3, 1] > 100) + int(o[7, 7, 0] > 60),
            "mixed": lambda o: int(o["mode"] == 2) + int(o["inner"][0][1] > 0.25),
        }[kind]
        self.action_space = spaces.Discrete(4, start=5)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        if seed is not None:
            self.observation_space.seed(seed)
        self.seen = self.observation_space.sample()
        return self.seen, {}

    def step(self, action):
        reward = float(action - 5 == self.rule(self.seen))
        self.seen = self.observation_space.sample()
        return self.seen, reward, True, False, {}


def compiled(header, name, folder):
    """The exported policy, as a function of the address of a percept."""
    (folder / "policy.h").write_text(header, encoding="utf-8")
    (folder / "policy.c").write_text(
        f'#include "policy.h"\nunsigned act(const void *p) {{ return {name}_act(p); }}\n',
        encoding="utf-8",
    )
    subprocess.run(
        ["gcc", "-std=c99", "-O1", "-ffp-contract=off", "-shared", "-fPIC", "-o", folder / "policy.so",
         folder / "policy.c"],
        check=True,
    )  # fmt: skip
    act = ctypes.CDLL(str(folder / "policy.so")).act
    act.restype, act.argtypes = ctypes.c_uint, [ctypes.c_void_p]
    return act


def pole(kind):
    """CartPole, and the same seen as a Dict."""
    env = gymnasium.make("CartPole-v1")
    if kind == "thresholds":
        return env
    inner = spaces.Dict({"pole": env.observation_space, "side": spaces.Discrete(2)})
    return gymnasium.wrappers.TransformObservation(
        env, lambda o: {"pole": o, "side": np.int64(o[2] > 0)}, inner
    )


@pytest.mark.parametrize("compact", [False, True], ids=["whole", "compact"])
@pytest.mark.parametrize("kind", ["bits", "number", "thresholds", "picture", "mixed"])
def test_what_an_agents_run_is(kind, compact, tmp_path):
    env = Guess(kind)
    run = rlvc.learn(env, 2000, seed=1, method="classes", discount=0.0)
    if compact:
        run.compact()
    env.observation_space.seed(3)
    observations = [env.observation_space.sample() for _ in range(OBSERVATIONS)]
    expected = what_acts_is_saved_and_exported(run, observations, tmp_path)
    evaluation = run.evaluate(env, 50, seed=9)
    again = rlvc.load(tmp_path / "run.rlvc").evaluate(env, 50, seed=9)
    assert np.array_equal(evaluation.returns, again.returns)
    assert run.evaluate(env, 2000, seed=9).mean == pytest.approx(
        np.mean([a - 5 == env.rule(o) for o, a in zip(observations, expected, strict=True)]),
        abs=0.05,
    )


@pytest.mark.parametrize("kind", ["thresholds", "mixed"])
def test_what_a_planners_run_is(kind, tmp_path):
    env = pole(kind)
    run = rlvc.learn(env, 1500, seed=1, method="planner")
    draws = 0.3 * np.random.default_rng(3).normal(size=(OBSERVATIONS, 4)).astype(np.float32)
    if kind == "mixed":
        draws = [{"pole": draw, "side": int(draw[2] > 0)} for draw in draws]
    what_acts_is_saved_and_exported(run, list(draws), tmp_path)


def what_acts_is_saved_and_exported(run, observations, tmp_path):
    expected = [run.predict(observation) for observation in observations]
    assert len(set(expected)) > 1, "a policy of one action shows nothing"
    run.save(tmp_path / "run.rlvc")
    loaded, copied = rlvc.load(tmp_path / "run.rlvc"), pickle.loads(pickle.dumps(run))
    # As text the planner's copy is its policy; so is the tree.
    assert [loaded.act(observation) for observation in observations] == expected
    assert [copied.act(observation) for observation in observations[:1000]] == expected[:1000]
    for other in (loaded, copied):
        assert other.text() == run.text()
        assert other.history == run.history
        assert other.seen.percepts == run.seen.percepts
    act = compiled(run.export_c(tmp_path / "kept.h", name="kept"), "kept", tmp_path)
    assert (tmp_path / "kept.h").read_text(encoding="utf-8") == run.export_c(name="kept")
    percepts = [np.frombuffer(run.encoder.encode(o), np.uint8).copy() for o in observations]
    assert [run.actions.of(act(percept.ctypes.data)) for percept in percepts] == expected
    for observation, action in zip(observations[:100], expected, strict=False):
        assert run.explain(observation).action == action
    return expected


def test_learning_goes_on_where_it_stopped(tmp_path):
    env = Line()
    run = rlvc.learn(env, 1000, seed=1, discount=0.9, capacity=5000)
    run.save(tmp_path / "run.rlvc")
    other = rlvc.load(tmp_path / "run.rlvc")
    assert run.learn(env, 500, seed=2) is run
    assert rlvc.learn(env, 500, seed=2, run=other) is other
    assert run.agent.snapshot() == other.agent.snapshot()
    assert run.history == other.history
    assert run.history[-1].interactions == run.interactions == 1500
    run.compact()
    assert run.small is not None
    run.learn(env, 100, seed=3)
    assert run.small is None
    with pytest.raises(errors.ConfigError, match="keeps"):
        run.learn(env, 100, discount=0.5)


def test_batches_are_predicted_as_one_by_one():
    for kind in ("bits", "thresholds", "picture"):
        env = Guess(kind)
        run = rlvc.learn(env, 1000, seed=1, method="classes", discount=0.0)
        rows = np.array([env.observation_space.sample() for _ in range(100)])
        assert run.predict(rows).tolist() == [run.predict(row) for row in rows]
    env = Guess("mixed")
    run = rlvc.learn(env, 1000, seed=1, method="classes", discount=0.0)
    envs = gymnasium.vector.SyncVectorEnv([lambda: Guess("mixed")] * 3)
    batch, _ = envs.reset(seed=1)
    listed = list(gymnasium.vector.utils.iterate(envs.observation_space, batch))
    assert run.predict(batch).tolist() == [run.predict(o) for o in listed]


def test_evaluation_of_vectors():
    run = rlvc.learn(Line(limit=30), 2000, seed=1, discount=0.9)
    for mode in gymnasium.vector.AutoresetMode:
        envs = gymnasium.vector.SyncVectorEnv([lambda: Line(limit=30)] * 3, autoreset_mode=mode)
        evaluation = run.evaluate(envs, 10, seed=1)
        assert evaluation.returns.tolist() == [1.0] * 10
        assert 1 <= evaluation.lengths.min() <= evaluation.lengths.max() <= 5
    assert (evaluation.mean, evaluation.std, float(evaluation)) == (1.0, 0.0, 1.0)
    assert str(evaluation) == "1 +- 0 (10 episodes)"


def test_episodes_that_never_end_are_cut_off():
    class Circles(gymnasium.Env):
        """Nothing ends, and no action matters."""

        observation_space = gymnasium.spaces.Discrete(2)
        action_space = gymnasium.spaces.Discrete(2)

        def reset(self, seed=None, options=None):
            return 0, {}

        def step(self, action):
            return int(action), 1.0, False, False, {}

    run = rlvc.learn(Circles(), 100, seed=1)
    evaluation = run.evaluate(Circles(), 3, max_steps=7)
    assert evaluation.lengths.tolist() == [7, 7, 7] and evaluation.returns.tolist() == [7.0] * 3
    assert str(evaluation) == "7 +- 0 (3 episodes, 3 cut off after 7 decisions)"
    envs = gymnasium.vector.SyncVectorEnv([Circles] * 2)
    evaluation = run.evaluate(envs, 6, max_steps=5)
    assert evaluation.lengths.tolist() == [5, 5] and evaluation.cut == 2
    with pytest.raises(errors.ConfigError, match="max_steps"):
        run.evaluate(Circles(), max_steps=0)


def test_names_and_words(tmp_path):
    run = rlvc.learn(Guess("thresholds"), 500, seed=1, method="classes", names=["a", "b", "c"])
    assert "b > 0." in run.text()
    assert "b > 0." in run.text("dot")
    assert next(iter(run.importances())) in ("b", "c")
    with pytest.raises(errors.ConfigError, match="3 names"):
        rlvc.learn(Guess("thresholds"), 10, names=["a"])
    with pytest.raises(errors.ConfigError, match="a name is empty"):
        rlvc.learn(Guess("thresholds"), 10, names=["a", "", "c"])
    pole = gymnasium.make("CartPole-v1")
    assert rlvc.learn(pole, 300, seed=1).encoder.names[2] == "angle"
    mixed = rlvc.learn(Guess("mixed"), 1000, seed=1, method="classes", discount=0.0)
    assert "mode = 2?" in mixed.text()
    assert set(list(mixed.importances())[:2]) == {"mode", "inner.0[1]"}
    assert "mode = 2? yes" in str(mixed.explain({
        "mode": 2, "inner": (np.zeros(2, np.float32), np.zeros(3, np.int8)), "many": np.array([0, 0])
    }))  # fmt: skip
    assert "action 5" in mixed.text()  # as the environment calls it
    assert mixed._repr_html_().startswith(("<svg", "<pre>"))


def test_files_of_runs_that_are_damaged(tmp_path):
    file = tmp_path / "run.rlvc"
    rlvc.learn(Line(), 500, seed=1).save(file)
    content = file.read_bytes()
    for at in (0, 11, 40, len(content) // 2, len(content) - 1):
        file.write_bytes(content[:at] + bytes([content[at] ^ 1]) + content[at + 1 :])
        with pytest.raises(errors.SnapshotError, match=r"run\.rlvc"):
            rlvc.load(file)
    file.write_bytes(content[:-50])
    with pytest.raises(errors.SnapshotError, match="damaged"):
        rlvc.load(file)
    with pytest.raises(errors.StoreError):
        rlvc.load(tmp_path / "none")


def test_a_planner_goes_on_where_it_stopped(tmp_path):
    env = gymnasium.make("CartPole-v1")
    run = rlvc.learn(env, 600, seed=1)
    run.save(tmp_path / "run.rlvc")
    other = rlvc.load(tmp_path / "run.rlvc")
    for each in (run, other):
        each.learn(env, 400, seed=2)
    assert run.text() == other.text()
    assert run.history == other.history
    assert run.interactions == 1000


def test_numbers_read_back_from_every_form(tmp_path):
    """Values and cutpoints as text, DOT, JSON and C are the floats that act."""
    run = rlvc.learn(Guess("thresholds"), 3000, seed=1, method="classes", discount=0.0)
    leaves = [node for node in run.tree["nodes"] if "value" in node]
    cuts = {np.float32(node["test"].split(" > ")[1]) for node in run.tree["nodes"] if "test" in node}
    values = {np.float32(leaf["value"]) for leaf in leaves}
    assert values == set(run.agent.q.max(axis=1))
    for form, tests in (("text", r"x\[\d\] > (\S+)\?"), ("dot", r'"x\[\d\] > (\S+)"')):
        text = run.text(form)
        assert {np.float32(v) for v in re.findall(r"value (-?[\d.e+-]+)", text)} == values
        assert {np.float32(v) for v in re.findall(tests, text)} == cuts
    header = run.export_c()
    kept = {np.float32(v) for v in re.findall(r"(-?\d[\d.e+-]*)f\b", header)}
    assert kept >= {np.float32(n["test"].split(" > ")[1]) for n in run.compact().tree["nodes"] if "test" in n}
    seen = np.array([0.1, 0.3, -2.0])
    first = run.explain(seen).steps[0]
    assert np.float32(re.search(r"\((\S+)\)", str(first))[1]) == np.float32(first.value)


def test_names_are_put_in_once():
    run = rlvc.learn(Guess("number"), 3000, seed=1, discount=0.0)
    assert "number bit" in run.text("dot")
    assert "number number" not in run.text("dot")


def test_interrupted_before_the_first_learning_step():
    class Stopped(Line):
        def step(self, action):
            self.steps = getattr(self, "steps", 0) + 1
            if self.steps == 50:
                raise KeyboardInterrupt
            return super().step(action)

    run = rlvc.learn(Stopped(), 1000, seed=1)
    assert run.interrupted
    assert run.warning.startswith("nothing was learnt: the first learning step was not reached")
    assert run.text().endswith(f"{run.warning}\n")
    assert rlvc.learn(Line(), 1000, seed=1, run=run).warning == ""


def test_a_tree_without_a_reward_says_so():
    """What follows the actions makes classes before there is a reward; the policy is still arbitrary."""
    env = gymnasium.make("FrozenLake-v1")
    run = rlvc.learn(env, 4000, epsilon=0.5, seed=2)
    assert run.leaves > 1
    assert not run.learner.values.any()
    assert run.text().splitlines()[-1] == run.warning
    assert run.warning.startswith("no reward other than 0 was seen")
    assert rlvc.learn(env, 8000, seed=1).warning == ""
