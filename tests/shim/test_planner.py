# SPDX-License-Identifier: MIT
"""The planner: what it learns on real numbers, what it refuses, what it says when it has learnt nothing."""

import copy
import ctypes
import dataclasses
import json
import pickle
import subprocess
import zlib
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium import spaces
from gymnasium.wrappers import TransformObservation

import rlvc
import rlvc.report
from rlvc import __main__ as command
from rlvc import _native, errors
from rlvc.domains.callbacks import Guard
from rlvc.learning.planning import default_config

F32 = np.float32
GOLDEN = Path(__file__).parents[1] / "golden"


class Drift(gymnasium.Env):
    """A number that is to be kept near 0, beside one that says nothing."""

    observation_space = spaces.Box(-10, 10, (2,), F32)
    action_space = spaces.Discrete(2, start=5)

    def __init__(self, limit=50, pays=True):
        self.limit, self.pays = limit, pays

    def see(self):
        return np.array([self.at, self.np_random.normal()], F32)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.at, self.age = float(self.np_random.uniform(-3, 3)), 0
        return self.see(), {}

    def step(self, action):
        assert self.action_space.contains(action), action
        self.at = float(np.clip(self.at + (0.3 if action == 6 else -0.3), -3, 3))
        self.age += 1
        return self.see(), -abs(self.at) * self.pays, False, self.age == self.limit, {}


def fed(seed=1, budget=None, interactions=600, **config):
    """A planner that lived in Drift, and slices of learning that it took."""
    planner, env = rlvc.Planner(2, 2, seed=seed, **config), Drift()
    planner.begin(env.reset(seed=seed)[0])
    slices = 0
    for _ in range(interactions):
        action = planner.act()
        x, reward, _, truncated, _ = env.step(action + 5)
        planner.observe(action, reward, x, truncated=truncated)
        if truncated:
            while not planner.learn(budget).done:
                slices += 1
            planner.begin(env.reset()[0])
    return planner, slices


@pytest.fixture(scope="module")
def learnt():
    return fed()[0]


def rows(count=300, seed=3):
    return np.random.default_rng(seed).uniform(-3, 3, (count, 2)).astype(F32)


# ------------------------------------------------------------------------- learning


def test_it_learns_what_matters(learnt):
    s = learnt.statistics
    assert (s.interactions, s.episodes, s.verdict) == (600, 12, "learnt")
    assert s.searches > 0 and s.candidates > 0 and s.fits > 0
    assert 2 <= s.leaves <= 16
    assert [learnt.predict(np.array([x, 0], F32)) for x in (-2, 2)] == [1, 0]
    assert "leaves after 600 interactions" in repr(learnt)
    assert learnt.config.leaves == 16 and learnt.domain.components == 2


def test_what_is_learnt_does_not_depend_on_the_slices(learnt):
    sliced, slices = fed(budget=10 * rlvc.Planner(2, 2).budget_min)  # tests/core takes the least
    assert slices > 10
    assert sliced.print("json") == learnt.print("json")
    assert sliced.statistics == learnt.statistics


def test_its_block_has_room_for_what_saves_time(learnt):
    config, domain = learnt._native_config, learnt._native_domain
    least, ample = ctypes.c_size_t(), ctypes.c_size_t()
    for call, size in (("agent", least), ("planner_ample", ample)):
        call = getattr(_native.call, f"rlvc_{call}_size")
        assert call(ctypes.byref(config), ctypes.byref(domain), ctypes.byref(size)) == _native.OK
    assert least.value < ample.value == learnt.memory_bytes


def test_many_percepts_at_once_are_predicted_as_one_by_one(learnt):
    x = rows()
    assert learnt.predict(x).tolist() == [learnt.predict(row) for row in x]
    assert learnt.predict(x[0].tobytes()) == learnt.predict(x[0])
    assert learnt.predict(x[:0]).tolist() == []


def test_the_policy_acts_as_the_planner_does(learnt, tmp_path):
    x, policy = rows(), learnt.policy()
    assert policy.act(x).tolist() == learnt.predict(x).tolist()
    assert policy.info.leaves == learnt.statistics.leaves and policy.info.as_agent
    assert policy.print() == learnt.print() and policy.tree == learnt.tree
    (tmp_path / "p.h").write_text(learnt.export_c("p"), encoding="utf-8")
    (tmp_path / "p.c").write_text(
        '#include "p.h"\n#include <stdio.h>\nint main(void) {\n    float x[2];\n'
        "    while (fread(x, sizeof x, 1, stdin) == 1)\n        putchar('0' + (int)p_act(x));\n"
        "    return 0;\n}\n",
        encoding="utf-8",
    )
    command = ["gcc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-ffp-contract=off"]
    subprocess.run([*command, tmp_path / "p.c", "-o", tmp_path / "p"], check=True)
    told = subprocess.run([tmp_path / "p"], input=x.tobytes(), capture_output=True, check=True)
    assert [int(c) for c in told.stdout.decode()] == policy.act(x).tolist()


def check_damage_is_told(saved, file, places):
    """Change a bit at each of the places of its file; look for a file that is not there; give wrong names."""
    content = file.read_bytes()
    for i in places:
        file.write_bytes(content[:i] + bytes([content[i] ^ 1]) + content[i + 1 :])
        with pytest.raises(errors.SnapshotError):
            type(saved).load(file)
    with pytest.raises(errors.StoreError):
        type(saved).load(file.with_name("none"))
    with pytest.raises(errors.ConfigError, match="names"):
        saved.save(file, "at")


def test_a_policy_is_saved_and_pickled(learnt, tmp_path):
    x, policy, file = rows(), learnt.policy(), tmp_path / "policy"
    policy.save(file, ["at", "noise"])
    for other in (rlvc.PlannedPolicy.load(file), pickle.loads(pickle.dumps(policy))):
        assert other.print("json") == policy.print("json")
        assert other.nodes == policy.nodes and other.info == policy.info
        assert other.act(x).tolist() == policy.act(x).tolist()
    check_damage_is_told(policy, file, range(0, file.stat().st_size, 3))


def test_a_planner_is_saved_and_goes_on(tmp_path):
    planner, file = fed(interactions=420)[0], tmp_path / "planner"
    planner.save(file, ["at", "noise"])
    others = [rlvc.Planner.load(file), pickle.loads(pickle.dumps(planner))]
    random = np.random.default_rng(3).standard_normal((400, 2)).astype(F32)
    for one in (planner, *others):
        for i, x in enumerate(random):
            one.observe(one.act(), float(x[0]), x, truncated=i % 40 == 39)
            if i % 40 == 39:
                one.learn()
                one.begin(x)
    assert {one.snapshot() for one in others} == {planner.snapshot()}
    assert others[0].config == planner.config and others[0].domain.components == 2
    check_damage_is_told(planner, file, (*range(0, 400, 7), file.stat().st_size - 1))


def test_snapshots_that_are_refused(tmp_path):
    planner, file = fed(interactions=420)[0], tmp_path / "planner"
    snapshot = planner.snapshot()
    for wrong in (
        snapshot[:-1],
        snapshot[:100] + b"x" + snapshot[101:],
        b"",
        rlvc.Agent(2, 2).snapshot(),
    ):
        with pytest.raises(errors.SnapshotError):
            rlvc.Planner.restore(2, planner.config, wrong)
    with pytest.raises(errors.SnapshotError, match="another config"):
        rlvc.Planner.restore(2, planner.config.replace(seed=9), snapshot)
    with pytest.raises(errors.SnapshotError, match="bytes"):
        rlvc.Planner.restore(2, planner.config, "x")
    content = planner_file(b'{"thresholds": [2]}\n')
    file.write_bytes(content)
    with pytest.raises(errors.SnapshotError, match="damaged"):
        rlvc.Planner.load(file)
    planner.observe(0, 1.0, np.zeros(2, F32), truncated=True)
    assert not planner.learn(planner.budget_min).done
    with pytest.raises(errors.BusyError):
        planner.snapshot()


def test_a_file_of_the_first_version_is_read(tmp_path):
    """What was saved before agents and planners had one interface."""
    old, again = GOLDEN / "planner_1.rlvc", tmp_path / "planner"
    planner = rlvc.Planner.load(old)
    assert planner.statistics.interactions == 120
    assert planner.predict(np.array([[0.48, 0], [0.5, 0]], F32)).tolist() == [0, 1]
    planner.save(again, ("left", "right"))
    assert rlvc.Planner.load(again).snapshot() == planner.snapshot()


def planner_file(content):
    whole = b"rlvc planner 1\n" + content
    return whole + zlib.crc32(whole).to_bytes(4, "little")


LEAF = (0.0, 65535, 0, 1)


@pytest.mark.parametrize(
    "nodes",
    [[], [LEAF, LEAF], [(0.5, 0, 1, 0), LEAF], [(0.5, 2, 1, 0), LEAF, LEAF], [(np.nan, 0, 1, 0), LEAF, LEAF],
     [(1e300, 0, 1, 0), LEAF, LEAF], [(0.5, 0, 0, 0), LEAF, LEAF], [(0.5, 0, 257, 0), LEAF, LEAF],
     [(0.5, 0, 1, 0), LEAF, (0.0, 65535, 0, 2)], [(0.5, 0, 1, 0), LEAF, (0.0, -1, 0, 1)],
     [("x", 0, 1, 0), LEAF, LEAF]],
)  # fmt: skip
def test_nodes_that_are_no_tree(nodes):
    with pytest.raises(errors.RangeError):
        rlvc.PlannedPolicy(rlvc.Thresholds(2), 2, nodes)


def test_a_copy_of_a_run_acts():
    run = rlvc.learn(Drift(), 400, seed=1)
    for other in (pickle.loads(pickle.dumps(run)), copy.deepcopy(run)):
        assert (other.text(), other.leaves, other.interactions) == (run.text(), run.leaves, 400)
        assert (other.warning, other.policy().nodes) == ("", run.policy().nodes)
        assert rlvc.report.make(other)["tree"] == rlvc.report.make(run)["tree"]
        x = np.array([[a, 0] for a in (-2, 2)], F32)
        assert [other.act(row) for row in x] == [run.act(row) for row in x]
        assert other.planner.snapshot() == run.planner.snapshot()


def test_the_command(tmp_path, capsys):
    names = {name: str(tmp_path / name) for name in ("save", "json", "c")}
    files = [part for name, file in names.items() for part in (f"--{name}", file)]
    arguments = ["--interactions", "600", "--episodes", "2", "--quiet", *files]
    assert command.main(["learn", "CartPole-v1", *arguments]) == 0
    said = capsys.readouterr().out
    assert ("after 600 interactions" in said and "leaves after" in said) or "leaf after" in said
    assert command.main(["show", names["save"]]) == 0
    assert said.startswith(capsys.readouterr().out)
    assert command.main(["export", names["save"], "--c", "-"]) == 0
    assert capsys.readouterr().out == (tmp_path / "c").read_text(encoding="utf-8")
    assert json.loads((tmp_path / "json").read_text(encoding="utf-8"))["interactions"] == 600
    wrong = ["learn", "CartPole-v1", "--quiet", "--discount", "0.9", *files]
    assert command.main(wrong) == 1
    assert "discount" in capsys.readouterr().err
    classes = ["learn", "CartPole-v1", "--method", "classes", "--discount", "0.9", *arguments]
    assert command.main(classes) == 0
    assert rlvc.load(names["save"]).interactions == 600


def test_figures():
    pytest.importorskip("matplotlib")
    from rlvc import plot

    run = rlvc.learn(Drift(), 600, seed=1)
    for source, action in ((run, 6), (run.planner, 1), (run.policy(), 1)):
        assert f"action {action}" in plot.tree(source).source
    assert plot.learning_curve(run).axes[0].get_ylabel() == "leaves"
    with pytest.raises(errors.RunError, match="planner"):
        plot.splits(run)


def test_a_policy_outlives_its_planner():
    planner, _ = fed(interactions=300)
    policy, text = planner.policy(), planner.print()
    planner.close()
    assert policy.print() == text
    policy.close()
    with pytest.raises(errors.ClosedError, match="policy"):
        policy.print()


def test_the_defaults_are_those_of_c():
    native, domain = _native.Config(), rlvc.Thresholds(3).native(Guard())
    _native.call.rlvc_config_default(ctypes.byref(native), ctypes.byref(domain), 5)
    assert native.method == _native.METHOD_PLANNER
    config = dataclasses.asdict(rlvc.PlannerConfig(5))
    assert {name: getattr(native, name) for name in config} == config


# ------------------------------------------------------------------------- what is refused


@pytest.mark.parametrize(
    ("field", "value"),
    [("actions", 1), ("actions", 65), ("capacity", 63), ("capacity", 10**8 + 1), ("sample", 31),
     ("sample", 2001), ("model_leaves", 0), ("model_leaves", 257), ("leaves", 1), ("leaves", 17),
     ("horizon", 0), ("random", 31), ("random", 1001), ("candidates", 0), ("patience", 0),
     ("patience", 10**6 + 1), ("seed", -1), ("seed", 2**32), ("leaves", 2.5), ("leaves", "x"), ("none", 1)],
)  # fmt: skip
def test_fields_out_of_range_are_named(field, value):
    with pytest.raises(errors.ConfigError, match=field):
        rlvc.Planner(2, 2, **{field: value})


def test_the_limits_themselves_are_taken():
    rlvc.Planner(1, 2, capacity=64, sample=32, random=32, model_leaves=1, leaves=2, horizon=1)
    rlvc.Planner(
        64, 64, leaves=16, model_leaves=4, candidates=10**6, patience=10**6, seed=2**32 - 1
    )
    for components in (0, 65, "x"):
        with pytest.raises(errors.ConfigError, match="domain"):
            rlvc.Planner(components, 2)
    with pytest.raises(errors.ConfigError, match="components"):
        rlvc.Planner(rlvc.Thresholds(65), 2)


def test_misuse_changes_nothing():
    planner, x = rlvc.Planner(2, 2), np.zeros(2, F32)
    with pytest.raises(errors.OrderError):
        planner.act()
    with pytest.raises(errors.OrderError):
        planner.observe(0, 1.0, x)
    for wrong in (x[:1], x.astype(float), [0, 0], b"123", x * np.nan, x + F32(2e9)):
        with pytest.raises(errors.PerceptError):
            planner.begin(wrong)
        with pytest.raises(errors.PerceptError):
            planner.predict(wrong)
    planner.begin(x)
    for action in (-1, 2, 0.5, None):
        with pytest.raises(errors.RangeError, match="action"):
            planner.observe(action, 1.0, x)
    for reward in (np.nan, np.inf, 2e12, "x", None):
        with pytest.raises(errors.RewardError):
            planner.observe(0, reward, x)
    with pytest.raises(errors.PerceptError, match="1e\\+09"):
        planner.observe(0, 1.0, x - F32(2e9))
    with pytest.raises(errors.PerceptError, match="percept 1"):
        planner.predict(np.array([[0, 0], [0, 2e9]], F32))
    for budget in (0, planner.budget_min - 1, 2**32, 1.5):
        with pytest.raises(errors.RangeError, match="budget"):
            planner.learn(budget)
    assert planner.statistics.interactions == 0
    with pytest.raises(errors.ReenteredError):
        planner.__init__(2, 2)
    planner.observe(1, 1.0, x, terminated=True)
    planner.close()
    planner.close()
    assert "closed" in repr(planner)
    with pytest.raises(errors.ClosedError, match="planner"):
        planner.begin(x)


# ------------------------------------------------------------------------- rlvc.learn


def test_learn_uses_it_on_real_numbers():
    env = Drift()
    run = rlvc.learn(env, 1000, seed=1)
    assert run.learner is run.planner and run.warning == ""
    assert run.planner.statistics.interactions == 1000
    assert len(run.history) == 20 == run.planner.statistics.episodes
    assert run.history[-1].classes == run.leaves > 1
    assert run.evaluate(Drift(), 20).mean > -25
    assert run.compact().small is None  # a planner's policy is small already
    assert run.act(np.array([-2, 0], F32)) == 6
    assert run.text() == run.in_words(run.policy().print())
    assert rlvc.learn(env, 1000, seed=1).text() == run.text()
    with pytest.raises(errors.RunError, match="planner"):
        _ = run.agent
    made = rlvc.report.make(run)
    assert made == json.loads(json.dumps(made))
    assert made["tree"] == run.policy().tree and made["classes"] == run.leaves


def test_a_pole_is_balanced():
    run = rlvc.learn(gymnasium.make("CartPole-v1"), 4000, seed=1)
    assert run.leaves <= 16
    assert run.evaluate(gymnasium.make("CartPole-v1"), 20).mean >= 475


def test_the_method_of_classes_by_a_keyword():
    run = rlvc.learn(Drift(), 500, seed=1, method="classes", discount=0.9)
    assert run.learner is run.agent and run.agent.statistics.interactions == 500
    with pytest.raises(errors.RunError, match="agent"):
        _ = run.planner
    for name, value in {"discount": 0.9, "criterion": "returns", "leafs": 3, "leaves": 99}.items():
        with pytest.raises(errors.ConfigError, match=name):
            rlvc.learn(Drift(), 100, **{name: value})
    with pytest.raises(errors.ConfigError, match="method"):
        rlvc.learn(Drift(), 100, method="guess")
    with pytest.raises(errors.ConfigError, match="real numbers"):
        rlvc.learn(gymnasium.make("FrozenLake-v1"), 100, method="planner")


def test_what_a_planner_does_not_learn():
    wide = TransformObservation(Drift(), lambda x: np.resize(x, 65), spaces.Box(-9, 9, (65,), F32))
    assert isinstance(rlvc.learn(wide, 100, seed=1).learner, rlvc.Agent)
    with pytest.raises(errors.ConfigError, match="64 components"):
        rlvc.learn(wide, 100, method="planner")
    vector = gymnasium.vector.SyncVectorEnv([Drift, Drift])
    run = rlvc.learn(vector, 200, seed=1, method="classes")
    assert run.agent.statistics.interactions == 200


@pytest.mark.parametrize("mode", list(gymnasium.vector.AutoresetMode))
def test_environments_side_by_side(mode):
    limits = (50, 30, 17)  # so that episodes end at different times
    vector = gymnasium.vector.SyncVectorEnv(
        [lambda limit=limit: Drift(limit) for limit in limits], autoreset_mode=mode
    )
    run = rlvc.learn(vector, 1500, seed=1)
    s = run.planner.statistics
    assert s.episodes > 20 and s.searches > 3 and s.verdict == "learnt"
    assert 1300 < s.interactions <= 1500  # some episodes were cut off
    assert run.evaluate(Drift(), 20).mean > -40
    again = rlvc.learn(vector, 1500, seed=1)
    assert again.text() == run.text()


def test_a_horizon_side_by_side():
    vector = gymnasium.vector.SyncVectorEnv([lambda: Drift(10**6)] * 2)  # endless
    run = rlvc.learn(vector, 1000, seed=1, horizon=40)
    assert run.planner.statistics.episodes >= 20
    masked = gymnasium.vector.SyncVectorEnv([Masked] * 2)
    run = rlvc.learn(masked, 600, seed=1)
    assert run.masked
    acted = [run.act(np.array([x, 0], F32), action_masks=[True, False]) for x in (-2, 2)]
    assert acted == [5, 5]


class Masked(Drift):
    """Drift, which forbids the second action at the left end."""

    def info(self):
        return {"action_mask": np.array([1, self.at < 2], np.int8)}

    def reset(self, *, seed=None, options=None):
        x, _ = super().reset(seed=seed)
        return x, self.info()

    def step(self, action):
        assert self.info()["action_mask"][action - 5]
        x, *rest, _ = super().step(action)
        return x, *rest, self.info()


def test_bits_beside_real_numbers():
    space = spaces.Dict({"side": spaces.Discrete(2), "x": spaces.Box(-10, 10, (1,), F32)})
    env = TransformObservation(
        Drift(), lambda x: {"side": np.int64(x[0] > 0), "x": x[1:]}, space
    )  # what tells is the bit
    run = rlvc.learn(env, 1000, seed=1)
    assert "side = 1?" in run.text()
    assert [run.act({"side": np.int64(b), "x": np.zeros(1, F32)}) for b in (0, 1)] == [6, 5]


def test_large_numbers_are_clipped():
    env = TransformObservation(Drift(), lambda x: x * [1, np.inf], Drift.observation_space)
    run = rlvc.learn(env, 300, seed=1)
    assert run.act(np.array([-2, np.inf], F32)) in (5, 6)


def test_an_episode_that_never_ends_is_cut_at_the_horizon():
    run = rlvc.learn(Drift(limit=None), 1500, seed=1, horizon=60)
    assert run.planner.statistics.episodes == 25 == len(run.history)
    assert all(np.isnan(record.mean_return) for record in run.history)
    assert [run.act(np.array([x, 0], F32)) for x in (-2, 2)] == [6, 5]


def test_a_callback_ends_it():
    run = rlvc.learn(Drift(), 1000, seed=1, callback=lambda run: len(run.history) == 3)
    assert [record.interactions for record in run.history] == [50, 100, 150]


def test_ctrl_c_leaves_a_usable_run():
    def callback(run):
        if len(run.history) == 7:
            raise KeyboardInterrupt

    run = rlvc.learn(Drift(), 10_000, seed=1, callback=callback)
    assert run.interrupted and run.planner.statistics.interactions == 350
    assert "action" in run.text()


def test_the_default_config_holds_all_interactions():
    assert default_config(2, 10_000, 7, {}).capacity == 20_000
    assert default_config(2, 100, 7, {}).capacity == 2000
    assert default_config(2, 10**9, 7, {}).capacity == 10**6
    assert default_config(2, 100, 7, {"leaves": 5, "capacity": 500, "sample": 99}).leaves == 5


# ------------------------------------------------------------------------- nothing was learnt


@pytest.mark.parametrize(
    ("env", "interactions", "says"),
    [
        (Drift(limit=None), 400, "no episode ended"),
        (Drift(), 60, "only one episode ended"),
        (Drift(), 100, "too few interactions"),
        (Drift(pays=False), 600, "all episodes had the same return"),
    ],
)
def test_a_run_says_why_it_learnt_nothing(env, interactions, says):
    run = rlvc.learn(env, interactions, seed=1)
    assert run.warning == f"nothing was learnt: {run.warning.partition(': ')[2]}"
    assert says in run.warning
    assert run.text().splitlines()[-1] == run.warning
    assert rlvc.report.make(run)["warning"] == run.warning


def test_one_class_is_said_to_be_one():
    lake = TransformObservation(gymnasium.make("FrozenLake-v1"), lambda _: 0, spaces.Discrete(2))
    run = rlvc.learn(lake, 200, seed=1)
    assert run.text().splitlines()[-1] == run.warning
    assert run.warning.startswith("one class: no difference in rewards or in what follows")
    assert rlvc.learn(gymnasium.make("FrozenLake-v1"), 4000, seed=1).warning == ""
