# SPDX-License-Identifier: MIT
"""Learning from Gymnasium environments: encoders, starts, ends, vectors, seeds."""

import gymnasium
import numpy as np
import pytest
from gymnasium import spaces
from gymnasium.utils.env_checker import check_env

import rlvc
import rlvc.envs
from rlvc import errors


class Line(gymnasium.Env):
    """Cells 0 to 7; the exit is 5. Writes down what it was asked."""

    metadata = {"render_modes": []}  # noqa: RUF012

    def __init__(self, observation="discrete", start=0, limit=0):
        self.kind, self.limit = observation, limit
        self.observation_space = {
            "discrete": spaces.Discrete(8, start=3),
            "dict": spaces.Dict({"a": spaces.Discrete(8), "b": spaces.MultiBinary(2)}),
            "tuple": spaces.Tuple((spaces.MultiDiscrete([8, 2]), spaces.Discrete(2))),
            "box": spaces.Box(-10, 10, (2,), np.float32),
        }[observation]
        self.action_space = spaces.Discrete(2, start=start)
        self.actions = []

    def see(self):
        cell, noise = self.cell, int(self.np_random.integers(2))
        return {
            "discrete": np.int64(cell + 3),
            "dict": {"a": np.int64(cell), "b": np.array([noise, 1], np.int8)},
            "tuple": (np.array([cell, noise]), np.int64(noise)),
            "box": np.array([cell, self.np_random.normal()], np.float32),
        }[self.kind]

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.cell, self.age = int(self.np_random.choice([0, 1, 2, 3, 4, 6, 7])), 0
        return self.see(), {}

    def step(self, action):
        assert self.action_space.contains(action), action
        self.actions.append(int(action))
        move = 1 if action == self.action_space.start + 1 else -1
        self.cell, self.age = min(max(self.cell + move, 0), 7), self.age + 1
        over = self.cell == 5
        return self.see(), float(over), over, bool(self.limit and self.age >= self.limit), {}


@pytest.mark.parametrize("observation", ["discrete", "dict", "tuple", "box"])
def test_every_space(observation):
    env = Line(observation)
    check_env(env, skip_render_check=True)
    run = rlvc.learn(env, 3000, method="classes", seed=1, discount=0.9)
    assert run.agent.statistics.interactions == 3000
    assert run.evaluate(env, 50, seed=2).mean == 1.0
    run.agent.check()


def test_tests_are_told_in_words():
    assert "number bit 2?" in rlvc.learn(Line(), 2000, seed=1, discount=0.9).text()
    assert "x[0] > " in rlvc.learn(Line("box", limit=20), 2000, seed=1).text()
    assert "a bit 2?" in rlvc.learn(Line("dict"), 2000, seed=1, discount=0.9).text()


def test_start_of_the_actions():
    env = Line(start=7)
    run = rlvc.learn(env, 1000, seed=1, discount=0.9)
    assert set(env.actions) == {7, 8}
    assert run.evaluate(env, 20).mean == 1.0


def test_truncated_is_not_terminated():
    run = rlvc.learn(Line(limit=3), 4000, seed=1, discount=0.9)
    # A cell far from the exit is worth what it is without the limit: 0.9 a step.
    far = run.agent.predict(run.encoder.encode(np.int64(0 + 3))).class_id
    assert run.agent.values[far] == pytest.approx(0.9**4, abs=0.02)


def test_the_same_seed_makes_the_same_tree():
    runs = [rlvc.learn(Line("box"), 2000, seed=seed, method="classes") for seed in (5, 5, 6)]
    trees = [run.agent.print("json") for run in runs]
    assert trees[0] == trees[1] != trees[2]


@pytest.mark.parametrize("mode", list(gymnasium.vector.AutoresetMode))
@pytest.mark.parametrize("kind", ["discrete", "dict", "tuple"])
def test_vectors(mode, kind):
    envs = [lambda: Line(kind) for _ in range(5)]
    vector = gymnasium.vector.SyncVectorEnv(envs, autoreset_mode=mode)
    run = rlvc.learn(vector, 3001, seed=1, discount=0.9)
    assert run.agent.statistics.interactions == 3001
    assert run.evaluate(Line(kind), 30).mean == 1.0
    # No dead transition was learnt from: next to the exit, on both sides, one step is worth 1.
    values = sorted(run.agent.values.tolist())
    assert values[-1] == pytest.approx(1.0, abs=0.01)
    assert all(min(abs(v - 0.9**k) for k in range(6)) < 0.02 for v in values)
    with pytest.raises(errors.ConfigError, match="criterion"):
        rlvc.learn(vector, 100, criterion="returns")


def test_the_returns_criterion():
    run = rlvc.learn(
        Line(), 40_000, every=4000, seed=1, discount=0.9, criterion="returns", explore="uniform"
    )
    assert run.agent.statistics.step == 10
    assert run.evaluate(Line(), 30).mean == 1.0


def test_history_and_callbacks():
    seen = []

    def callback(run):
        seen.append(run.history[-1])
        return len(seen) == 3

    run = rlvc.learn(Line(), 10_000, every=200, seed=1, callback=callback)
    assert [record.interactions for record in seen] == [200, 400, 600]
    assert run.history == seen
    assert all(record.episodes > 0 and 0 < record.mean_return <= 1 for record in seen)
    with pytest.raises(errors.ConfigError, match="EvalCallback is a class: make one"):
        rlvc.learn(Line(), 10, callback=rlvc.EvalCallback)


def test_ctrl_c_leaves_a_usable_run():
    def callback(run):
        if len(run.history) == 2:
            raise KeyboardInterrupt

    run = rlvc.learn(Line(), 10_000, every=200, seed=1, callback=callback)
    assert run.interrupted
    assert run.agent.statistics.interactions == 400
    run.agent.check()
    run.agent.learn()


def test_a_progress_bar(capsys):
    rlvc.learn(Line(), 500, seed=1, progress=True)
    assert "leaves=" in capsys.readouterr().err


def test_what_cannot_be_learnt():
    env = Line()
    env.action_space = spaces.Box(-1, 1)
    with pytest.raises(errors.SpaceError, match="finite"):
        rlvc.learn(env, 10)
    env.action_space = spaces.Discrete(300)
    with pytest.raises(errors.SpaceError, match="255"):
        rlvc.learn(env, 10)
    with pytest.raises(errors.SpaceError, match="Text"):
        rlvc.Encoder(spaces.Text(3))
    with pytest.raises(errors.SpaceError, match="bits"):
        rlvc.Encoder(spaces.MultiBinary(2000))
    with pytest.raises(errors.SpaceError, match="components"):
        rlvc.Encoder(spaces.Box(0, 1, (33, 32)))
    for wrong in ({"interactions": 0}, {"every": 0}, {"explore": "bravely"}, {"gamma": 1}):
        with pytest.raises(errors.ConfigError):
            rlvc.learn(Line(), **{"interactions": 10, **wrong})


@pytest.mark.parametrize(
    ("space", "wrong"),
    [
        (spaces.Discrete(4, start=2), 6),
        (spaces.MultiDiscrete([3, 3]), np.array([3, 0])),
        (spaces.MultiBinary(3), np.zeros(4, np.int8)),
        (spaces.Box(0, 1, (2,)), np.zeros(3)),
        (spaces.Box(0, 1, (2,)), np.array([np.nan, 0])),
        (spaces.Dict({"a": spaces.Discrete(2)}), {"b": 1}),
        (spaces.Tuple((spaces.Discrete(2),)), ()),
    ],
)
def test_observations_of_another_space(space, wrong):
    with pytest.raises(errors.PerceptError):
        rlvc.Encoder(space).encode(wrong)


def test_encodings():
    assert rlvc.Encoder(spaces.Discrete(5, start=10)).encode(14) == bytes([4])
    assert rlvc.Encoder(spaces.Discrete(1)).encode(0) == bytes([0])
    assert rlvc.Encoder(spaces.MultiDiscrete([4, 3])).encode(np.array([3, 1])) == bytes([0b0111])
    box = rlvc.Encoder(spaces.Box(0, 9, (1,)))
    assert box.names == ["x"] and box.domain.components == 1
    values = np.array([[0.1], [-np.inf], [np.inf]])
    expected = np.array([0.1, -1e15, 1e15], np.float32)
    assert b"".join(box.encode(row) for row in values) == expected.tobytes()
    assert box.encode_many(values).tobytes() == expected.tobytes()
    space = spaces.Dict({"a": spaces.Discrete(3), "b": spaces.Box(-1, 1, (2,))})
    both = rlvc.Encoder(space)
    assert both.names == ["a = 1", "a = 2", "b[0]", "b[1]"]
    record = both.encode({"a": 2, "b": np.array([0.5, -1])})
    assert np.frombuffer(record, np.float32).tolist() == [0, 1, 0.5, -1]
    assert both.explain("x[3] > 0.5, x[1] > 0.5") == "b[1] > 0.5, a = 2"


def test_constant_observations():
    env = gymnasium.wrappers.TransformObservation(
        Line("box"), lambda o: o * 0, spaces.Box(0, 0, (2,), np.float32)
    )
    assert rlvc.learn(env, 200, seed=1, method="classes").agent.classes == 1
    assert rlvc.learn(env, 400, seed=1).leaves == 1


def test_the_maze_is_a_proper_environment():
    env = gymnasium.make("rlvc/BinaryGridworld-v0")
    check_env(env.unwrapped, skip_render_check=True)
    assert env.observation_space == spaces.MultiBinary(18)
    assert (
        gymnasium.make("rlvc/BinaryGridworld-v0", render_mode="ansi").unwrapped.maze.rows[0]
        == ".......#*"
    )


def test_the_maze_is_learnt_and_drawn():
    env = rlvc.envs.BinaryGridworld(render_mode="ansi")
    run = rlvc.learn(env, 5000, seed=1, discount=0.9)
    assert run.agent.classes == 46
    bits = {int(split.feature) for split in run.agent.splits}
    assert bits == {0, 1, 2, 3, 15, 16, 17}
    env.reset(seed=1)
    assert env.render().count("@") == 1


def test_the_maze_is_deterministic():
    def play(seed):
        env = rlvc.envs.BinaryGridworld(slip=0.2)
        seen = [env.reset(seed=seed)[0]]
        for i in range(300):
            observation, _, over, _, info = env.step(i % 4)
            seen.append(observation)
            assert env.maze.rows[info["y"]][info["x"]] in ".*"
            if over:
                seen.append(env.reset()[0])
        return np.concatenate(seen).tobytes()

    assert play(3) == play(3) != play(4)


def test_other_mazes(tmp_path):
    file = tmp_path / "maze.txt"
    file.write_text("..*\n.#.\n", encoding="utf-8")
    env = rlvc.envs.BinaryGridworld(file, distractors=0)
    assert env.observation_space == spaces.MultiBinary(3)
    for text, place in (
        ("..\n", "maze"),
        ("..*\n.x.\n", "line 2, column 2"),
        ("..*\n.\n", "line 2"),
    ):
        with pytest.raises(errors.MazeError, match=place):
            rlvc.envs.BinaryGridworld(text)
    with pytest.raises(errors.MazeError, match="cannot be read"):
        rlvc.envs.BinaryGridworld(tmp_path / "none.txt")
    for wrong in (
        {"slip": 2.0},
        {"distractors": 1020},
        {"distractors": -1},
        {"render_mode": "human"},
    ):
        with pytest.raises(errors.ConfigError):
            rlvc.envs.BinaryGridworld(**wrong)


def test_wrong_steps_in_the_maze():
    env = rlvc.envs.BinaryGridworld("*.\n", distractors=0)
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.step(0)
    env.reset(seed=1)
    with pytest.raises(gymnasium.error.InvalidAction):
        env.step(4)
    assert env.step(3)[1:4] == (100.0, True, False)
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.step(0)
