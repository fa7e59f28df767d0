# SPDX-License-Identifier: MIT
"""Watching a run: callbacks, many seeds, hidden states, actions that are no numbers."""

import csv
import errno
import io
import pickle

import gymnasium
import numpy as np
import pytest
from gymnasium import spaces
from test_learning import Line

import rlvc
from rlvc import errors


def test_a_curve_without_exploring(tmp_path):
    watch = rlvc.EvalCallback(Line(limit=30), 200, 10, best=tmp_path / "best.rlvc", stop_at=1.0)
    keep = rlvc.CheckpointCallback(tmp_path / "at-{}.rlvc", 200)
    table = rlvc.CsvCallback(tmp_path / "history.csv")
    run = rlvc.learn(
        Line(limit=30), 5000, every=100, seed=1, discount=0.9, callback=[watch, keep, table, None]
    )
    assert run.interactions < 5000
    assert watch.interactions == list(range(200, run.interactions + 1, 200))
    assert watch.evaluations[-1].mean == 1.0
    assert rlvc.load(tmp_path / "best.rlvc").evaluate(Line(limit=30), 10).mean == 1.0
    assert rlvc.load(tmp_path / "at-200.rlvc").interactions == 200
    rows = list(csv.DictReader(io.StringIO((tmp_path / "history.csv").read_text(encoding="utf-8"))))
    assert [int(row["interactions"]) for row in rows] == [r.interactions for r in run.history]
    for file in (None, 3, b"at", ""):
        with pytest.raises(errors.ConfigError, match="file"):
            rlvc.CheckpointCallback(file)
        with pytest.raises(errors.ConfigError, match="file"):
            rlvc.CsvCallback(file)
    with pytest.raises(errors.ConfigError, match="file"):
        rlvc.EvalCallback(Line(), best=3)
    with pytest.raises(errors.ConfigError, match="every"):
        rlvc.EvalCallback(Line(), 0)


def test_tensorboard(tmp_path):
    pytest.importorskip("tensorboardX")
    rlvc.learn(Line(), 500, seed=1, callback=rlvc.TensorBoardCallback(tmp_path))
    assert any(tmp_path.iterdir())
    with pytest.raises(errors.ConfigError, match="folder"):
        rlvc.TensorBoardCallback(None)
    (tmp_path / "file").write_text("")
    with pytest.raises(errors.StoreError, match="file: cannot be written: "):
        rlvc.TensorBoardCallback(tmp_path / "file")


def test_a_callback_that_finds_the_disk_full_keeps_the_run(tmp_path):
    pytest.importorskip("tensorboardX")
    watch = rlvc.TensorBoardCallback(tmp_path)

    class Full:
        def add_scalar(self, *_):
            raise OSError(errno.ENOSPC, "No space left on device")

    watch.writer.close()
    watch.writer = Full()
    with pytest.raises(errors.StoreError, match="cannot be written: No space left") as raised:
        rlvc.learn(Line(), 500, every=100, seed=1, callback=watch)
    assert raised.value.run.interactions == 100


def test_many_seeds(tmp_path):
    arguments = {"points": 4, "episodes": 5}
    many = rlvc.learn_many("FrozenLake-v1", 2000, seeds=3, processes=2, discount=0.9, **arguments)
    again = rlvc.learn_many(
        "FrozenLake-v1", 2000, seeds=[2], processes=1, discount=0.9, **arguments
    )
    assert many.interactions.tolist() == [500, 1000, 1500, 2000]
    assert many.returns.shape == (3, 4)
    assert many.returns[1].tolist() == again.returns[0].tolist()
    assert many.runs[1].text() == again.runs[0].text()
    assert "3 runs" in repr(many)
    pytest.importorskip("matplotlib")
    many.plot(tmp_path / "band.svg")


class Corridor(gymnasium.Env):
    """A T-maze: the side of the reward is seen at the start, and asked for two steps later."""

    observation_space, action_space = spaces.Discrete(4), spaces.Discrete(3)

    def see(self):
        return np.int64(self.side if self.x == 0 else 3 if self.x == 2 else 2)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.x, self.age, self.side = 0, 0, int(self.np_random.integers(2))
        return self.see(), {}

    def step(self, action):
        self.age += 1
        if self.x == 2 and action > 0:
            return self.see(), 4.0 if action - 1 == self.side else -1.0, True, False, {}
        moved = action == 0 and self.x < 2
        self.x += moved
        return self.see(), 0.0 if moved else -0.1, False, self.age >= 40, {}


def test_a_hidden_state_is_remembered():
    env = rlvc.History(Corridor(), 3)
    assert env.observation_space.contains(env.reset(seed=1)[0])
    assert env.observation_space.contains(env.step(0)[0])
    returns = [
        rlvc.learn(rlvc.History(Corridor(), 3), 6000, seed=seed, discount=0.95)
        .evaluate(rlvc.History(Corridor(), 3), 50).mean
        for seed in range(10)
    ]  # fmt: skip
    assert sum(value == 4.0 for value in returns) >= 9, returns
    assert rlvc.learn(Corridor(), 6000, seed=1, discount=0.95).evaluate(Corridor(), 50).mean < 3
    run = rlvc.learn(rlvc.History(Corridor(), 3), 6000, seed=1, discount=0.95)
    assert "2 ago" in run.text()


def recorded(env, count, seed=1):
    """Random interactions: what was observed, done and rewarded, by names."""
    random = np.random.default_rng(seed)
    log = {name: [] for name in ("obs", "action", "reward", "next_obs", "terminated", "truncated")}
    observation, _ = env.reset(seed=seed)
    for _ in range(count):
        action = int(random.integers(3))
        following, reward, terminated, truncated, _ = env.step(action)
        for name, value in zip(log, (observation, action, reward, following, terminated, truncated), strict=True):
            log[name].append(value)
        observation = env.reset()[0] if terminated or truncated else following
    return log


def test_a_hidden_state_in_a_log():
    """The log of an environment, with its past, is the log of the environment with History."""
    plain, wrapped = (recorded(env, 6000) for env in (Corridor(), rlvc.History(Corridor(), 3)))
    log = rlvc.logs.with_history(rlvc.logs.read(plain), 3)
    for side, seen in ((log.before, wrapped["obs"]), (log.after, wrapped["next_obs"])):
        for name in seen[0]:
            part = side[name]["obs"] if isinstance(side[name], dict) else side[name]
            assert part.ravel().tolist() == [int(row[name]) for row in seen], name
    space = spaces.Discrete(4)
    run = rlvc.learn_from({k: np.array(v) for k, v in plain.items()}, history=3, space=space, discount=0.95)
    assert run.evaluate(rlvc.History(Corridor(), 3), 50).mean == 4.0
    blind = rlvc.learn_from({k: np.array(v) for k, v in plain.items()}, space=space, discount=0.95)
    assert blind.evaluate(Corridor(), 50).mean < 3
    with pytest.raises(rlvc.errors.ConfigError, match="history"):
        rlvc.learn_from(plain, history=65)


def test_the_past_of_logs_of_all_forms(tmp_path):
    """Columns, words and real actions have a past, and a saved run still knows it."""
    rows = [("a", 0.5, "go", 0.0, 0), ("b", 1.5, "stay", 1.0, 0), ("a", 2.5, "go", 0.0, 1)] * 40
    named = [dict(zip(("place", "x", "action", "reward", "done"), row, strict=True)) for row in rows]
    run = rlvc.learn_from(named, history=2, discount=0.5)
    past = {"now": {"place": "b", "x": 1.5}, "1 ago": {"place": "a", "x": 0.5}, "action 1 ago": "go"}
    assert run.predict(past) in ("go", "stay")
    assert run.predict({**past, "action 1 ago": ""}) in ("go", "stay")
    run.save(tmp_path / "run")
    assert rlvc.load(tmp_path / "run").predict(past) == run.predict(past)
    real = {"obs": np.arange(120)[:, None] % 7, "action": np.arange(120) % 5 / 4, "reward": np.ones(120),
            "done": np.arange(120) % 6 == 5}  # fmt: skip
    log = rlvc.logs.with_history(rlvc.logs.read(real, bins=5), 3)
    assert log.before["action 1 ago"][:8].tolist() == [0, 0, 0.25, 0.5, 0.75, 1, 0, 0.25]
    assert log.before["2 ago"][:8, 0].tolist() == [0, 0, 0, 1, 2, 3, 6, 6]


class Aim(gymnasium.Env):
    """One-step episodes: the action is to be near the observation."""

    observation_space = spaces.MultiBinary(2)

    def __init__(self, actions):
        self.action_space = actions
        self.taken = []

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.seen = self.np_random.integers(2, size=2).astype(np.int8)
        self.left = 3
        return self.seen, {}

    def step(self, action):
        assert self.action_space.contains(action), action
        self.taken.append(action)
        self.left -= 1
        low, high = np.ravel(self.action_space.low), np.ravel(self.action_space.high)
        share = (np.ravel(action) - low) / (high - low)
        return (
            self.seen,
            -float(np.abs(share - self.seen[: len(share)]).sum()),
            self.left == 0,
            False,
            {},
        )


def test_a_box_is_a_grid_that_is_held(tmp_path):
    env = Aim(spaces.Box(np.array([-2, 0], np.float32), np.array([2, 10], np.float32)))
    with pytest.raises(errors.SpaceError, match="bins="):
        rlvc.learn(env, 100)
    run = rlvc.learn(env, 1500, seed=1, bins=3, hold=3, discount=0.0)
    assert run.actions.count == 9
    assert run.predict(np.array([1, 0], np.int8)).tolist() == [2.0, 0.0]
    assert len(env.taken) == 3 * 1500
    assert run.evaluate(env, 20).mean == 0.0
    assert run.evaluate(env, 20).lengths.tolist() == [1] * 20
    text = run.export_c()
    assert "static const float policy_actions[9][2]" in text
    assert "#define POLICY_HOLD 3" in text
    assert "(2, 0)" in run.text()
    run.save(tmp_path / "run.rlvc")
    assert rlvc.load(tmp_path / "run.rlvc").predict(np.array([0, 1], np.int8)).tolist() == [
        -2.0,
        10.0,
    ]
    batch = run.predict(np.array([[1, 0], [0, 1]], np.int8))
    assert batch.tolist() == [[2.0, 0.0], [-2.0, 10.0]]
    for wrong in ({"bins": 0}, {"bins": 300}, {"bins": [3]}, {"bins": 3, "hold": 0}):
        with pytest.raises((errors.ConfigError, errors.SpaceError)):
            rlvc.learn(env, 10, **wrong)


@pytest.mark.parametrize(
    "space", [spaces.MultiDiscrete([2, 3], start=[0, 5]), spaces.MultiBinary(3)], ids=str
)
def test_combinations(space):
    class Match(Aim):
        def step(self, action):
            assert self.action_space.contains(action), action
            self.left -= 1
            return self.seen, float(action[0] == self.seen[0]), self.left == 0, False, {}

    run = rlvc.learn(Match(space), 1500, seed=1, discount=0.0)
    assert run.actions.count == {2: 6, 3: 8}[len(space.sample())]
    assert [int(run.predict(np.array([bit, 0], np.int8))[0]) for bit in (0, 1)] == [0, 1]


def acts_by_masks(run, env):
    """With a mask only what it allows; without one with a warning, and a comment in C."""
    seen = env.reset()[0]
    for mask in ([1, 0], [0, 1]):
        assert run.predict(seen, action_masks=mask) == int(np.argmax(mask))
    if isinstance(seen, dict):
        assert run.predict(seen | {"action_mask": np.array([1, 0], np.int8)}) == 0
        batch = {"cell": np.stack([seen["cell"]] * 2), "action_mask": np.eye(2, dtype=np.int8)}
        assert run.predict(batch).tolist() == [0, 1]
    else:
        batch = np.stack([seen] * 2)
    assert run.predict(batch, action_masks=[[0, 1], [1, 0]]).tolist() == [1, 0]
    with pytest.raises(errors.ConfigError, match=r"action_masks: .*expected 2 truth values"):
        run.predict(seen, action_masks=[1, 0, 1])
    copy = pickle.loads(pickle.dumps(run))
    assert run.masked
    assert copy.masked
    assert "forbidden" in copy.export_c().splitlines()[0] + copy.export_c().splitlines()[1]
    if not isinstance(seen, dict):
        with pytest.warns(errors.MaskWarning, match="pass action_masks="):
            copy.predict(seen)
        copy.predict(seen)  # it is said once
        with pytest.warns(errors.MaskWarning):
            pickle.loads(pickle.dumps(run)).evaluate(Line(limit=30), 1)
    plain = rlvc.learn(Line(limit=30), 300, seed=1)
    assert not plain.masked
    assert "forbidden" not in plain.export_c()


@pytest.mark.parametrize("where", ["info", "observation"])
def test_forbidden_actions_are_not_taken(where):
    class Masked(Line):
        def mask(self):
            return np.array([self.cell != 2, True], np.int8)  # from cell 2 only upwards

        def reset(self, **arguments):
            return self.told(super().reset(**arguments)[0])

        def told(self, seen):
            if where == "info":
                return seen, {"action_mask": self.mask()}
            return {"cell": seen, "action_mask": self.mask()}, {}

        def step(self, action):
            assert self.mask()[action], "a forbidden action"
            seen, reward, over, cut, _ = super().step(action)
            seen, info = self.told(seen)
            return seen, reward, over, cut, info

    env = Masked(limit=30)
    if where == "observation":
        env.observation_space = spaces.Dict(
            {"cell": env.observation_space, "action_mask": spaces.MultiBinary(2)}
        )
    run = rlvc.learn(env, 3000, seed=1, discount=0.9)
    assert run.evaluate(env, 30).mean == 1.0
    acts_by_masks(run, env)
    envs = (
        gymnasium.vector.SyncVectorEnv([lambda: Masked(limit=30)] * 3) if where == "info" else None
    )
    if envs is not None:
        assert rlvc.learn(envs, 3000, seed=1, discount=0.9).evaluate(envs, 30).mean == 1.0
