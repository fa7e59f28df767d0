# SPDX-License-Identifier: MIT
"""What a caller, an environment or an object of the caller's hands over by mistake is refused by an error of
the package that names it."""

import sys

import gymnasium
import numpy as np
import pytest
from gymnasium import spaces

import rlvc
from rlvc import _native, errors


class Line(gymnasium.Env):
    """Eight places in a line; `seen` makes the observation of one."""

    def __init__(self, space=None, actions=None, seen=None):
        self.observation_space = space or spaces.Discrete(8)
        self.action_space = actions or spaces.Discrete(2)
        self.seen = seen or (lambda place: place)

    def reset(self, *, seed=None, options=None):
        self.place = 0
        return self.seen(0), {}

    def step(self, action):
        self.place = min(7, max(0, self.place + 2 * int(np.ravel(action)[0]) - 1))
        return self.seen(self.place), float(self.place == 7), self.place == 7, False, {}


def many(**changes):
    return rlvc.learn_many(Line, 50, **{"seeds": 2, "processes": 1, "episodes": 1, "points": 1, **changes})


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"seeds": ["a"]}, "seeds: 'a' is not a whole number"),
        ({"seeds": 2.5}, r"seeds: 2\.5 is not a list of numbers"),
        ({"seeds": 0}, r"seeds: 0 is not in \[1"),
        ({"seeds": []}, "seeds: give at least one"),
        ({"seeds": [-1]}, "seeds: -1 is not in"),
        ({"processes": 0}, "processes: 0 is not in"),
        ({"processes": 1.5}, r"processes: 1\.5 is not a whole number"),
        ({"seed": 3}, "seed: learn_many gives each run its own"),
        ({"callback": None}, "callback: learn_many gives each run its own"),
        ({"run": None}, "run: learn_many gives each run its own"),
    ],
    ids=str,
)
def test_many_runs(changes, said):
    with pytest.raises(errors.ConfigError, match=said):
        many(**changes)


def test_more_processes_than_seeds():
    """A pool would begin them all."""
    found = many(seeds=np.int64(2), processes=1_000_000)
    assert found.seeds == [1, 2]


def fails():
    raise ZeroDivisionError("mine")


@pytest.mark.parametrize(
    "env", ["Nope-v0", "", fails, lambda needed: needed], ids=["none", "empty", "fails", "needs"]
)
def test_environments_that_cannot_be_made(env):
    with pytest.raises(errors.EnvError, match="env: making one raised"):
        rlvc.learn_many(env, 50, seeds=1, processes=1)


@pytest.mark.parametrize("run", [3, "run", rlvc.Agent(3, 2)], ids=["int", "str", "Agent"])
def test_what_is_no_run(run):
    with pytest.raises(errors.ConfigError, match=r"run: .* is not a run"):
        rlvc.learn(Line(), 10, run=run)


def box(low, high, *shape):
    return spaces.Box(low, high, shape, np.float32)


@pytest.mark.parametrize(
    ("actions", "other", "bins"),
    [
        (spaces.Discrete(2), spaces.Discrete(3), None),
        (spaces.Discrete(3), spaces.Discrete(2), None),
        (spaces.Discrete(2), spaces.Discrete(2, start=1), None),
        (spaces.Discrete(4), spaces.MultiBinary(2), None),
        (spaces.MultiBinary(2), spaces.Discrete(4), None),
        (spaces.MultiBinary(2), spaces.MultiBinary(3), None),
        (spaces.MultiDiscrete([2, 3]), spaces.MultiDiscrete([3, 2]), None),
        (box(-1, 1, 1), box(-0.5, 1, 1), 3),
        (box(-1, 1, 1), box(-1, 1, 2), 3),
        (spaces.Discrete(3), box(-1, 1, 1), None),
        (box(-1, 1, 1), spaces.Discrete(3), 3),
    ],
    ids=str,
)
def test_a_run_goes_on_and_plays_with_its_own_actions_only(actions, other, bins):
    def line(space):
        env = Line()
        env.action_space = space
        return env

    run = rlvc.learn(line(actions), 30, bins=bins)
    assert run.learn(line(actions), 30).interactions == 60
    with pytest.raises(errors.ConfigError, match=r"^run: its .* actions, .* are not those of .*: begin"):
        run.learn(line(other), 30)
    assert run.interactions == 60
    assert len(run.evaluate(line(actions), 2, max_steps=9).returns) == 2
    if (actions, other) == (spaces.Discrete(2), spaces.Discrete(3)):  # it has both, and one more
        run.evaluate(line(other), 2, max_steps=9)
        return
    with pytest.raises(errors.ConfigError, match=r"^run: its .* actions, .* are not those of .*: pass"):
        run.evaluate(line(other), 2)


@pytest.mark.parametrize(
    ("seen", "other"),
    [
        (spaces.Discrete(4), spaces.Discrete(5)),
        (spaces.Discrete(4), spaces.Discrete(4, start=1)),
        (spaces.Discrete(4), spaces.MultiBinary(2)),
        (box(-1, 4, 2), box(-1, 4, 3)),
        (box(-1, 4, 1), spaces.Discrete(4)),
        (spaces.Discrete(4), spaces.Dict(place=spaces.Discrete(4))),
    ],
    ids=str,
)
def test_a_run_goes_on_and_plays_with_its_own_observations_only(seen, other):
    def line(space):
        return Line(space, seen=lambda place: np.full(space.shape or (), 1 + place % 3, np.int64))

    run = rlvc.learn(line(seen), 30)
    assert run.learn(line(seen), 30).interactions == 60
    with pytest.raises(errors.ConfigError, match=r"^run: its observations, .* not those of .*: begin"):
        run.learn(line(other), 30)
    assert len(run.evaluate(line(seen), 2, max_steps=9).returns) == 2
    with pytest.raises(errors.ConfigError, match=r"^run: its observations, .* not those of .*: pass"):
        run.evaluate(line(other), 2)
    assert run.interactions == 60


def test_numbers_beyond_any_float():
    box = spaces.Box(-1, 1, (2,), np.float32)
    with pytest.raises(errors.PerceptError, match="not an element of the observation space"):
        rlvc.learn(Line(box, seen=lambda _place: [10**400, 1]), 10)


class Speechless(Exception):
    def __str__(self):
        raise ZeroDivisionError


def test_an_exception_without_a_text():
    def seen(_place):
        raise Speechless

    with pytest.raises(errors.EnvError, match=r"reset\(\) of the environment raised Speechless"):
        rlvc.learn(Line(seen=seen), 10)


@pytest.mark.parametrize("bins", [None, 3])
@pytest.mark.parametrize("actions", [spaces.Tuple([spaces.Discrete(2)]), spaces.Text(3), "x"], ids=str)
def test_actions_that_are_not_learnt(actions, bins):
    with pytest.raises(errors.SpaceError, match="needs a finite set of actions"):
        rlvc.learn(Line(actions=actions), 10, bins=bins)


@pytest.mark.parametrize("env", [None, 7, "CartPole-v1"], ids=repr)
def test_a_history_of_no_environment(env):
    with pytest.raises(errors.EnvError, match="not a single environment"):
        rlvc.History(env, 2)


def log(**changes):
    rng = np.random.default_rng(1)
    columns = {
        "observations": rng.integers(0, 2, (60, 4)).astype(bool),
        "actions": rng.integers(0, 2, 60),
        "rewards": rng.random(60),
        "terminated": np.arange(60) % 5 == 4,
    }
    return {**columns, **changes}


class Hostile:
    def __array__(self, *_arguments, **_named):
        raise ZeroDivisionError("mine")


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"observations": np.ma.masked_array(np.zeros((60, 2)), True)}, "no interaction"),
        ({"rewards": Hostile()}, "rewards: not an array: mine"),
    ],
    ids=["observations", "hostile"],
)
def test_columns_that_are_none(changes, said):
    with pytest.raises(errors.LogError, match=said):
        rlvc.learn_from(log(**changes))


def test_a_dict_within_itself():
    within = log()
    within["observations"] = within
    with pytest.raises(errors.LogError, match="without an end"):
        rlvc.learn_from(within)


def test_a_mask_that_hides_nothing_is_harmless():
    plain, rewards = log(), log()["rewards"]
    masked = log(rewards=np.ma.masked_array(rewards, False))
    assert rlvc.learn_from(masked).text() == rlvc.learn_from(plain).text()


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"roles": 3}, "roles: 3: give a dict"),
        ({"roles": {"action": 3}}, "roles: action: 3 is not a list of names"),
        ({"columns": 3}, "columns: 3 is not a list of names"),
        ({"names": 3}, "names: 3 is not a list of names"),
        ({"domain": 4}, "domain: goes with the log of a controller"),
    ],
    ids=str,
)
def test_what_a_log_is_read_with(changes, said):
    with pytest.raises(errors.ConfigError, match=said):
        rlvc.learn_from(log(), **changes)


@pytest.mark.parametrize(
    ("source", "error"),
    [
        (None, errors.ConfigError),
        (3, errors.ConfigError),
        ("conv\0", errors.LogError),
        ("http://127.0.0.1:9/x.parquet", errors.LogError),
    ],
    ids=repr,
)
def test_sources_of_a_fleet(source, error):
    from rlvc import fleet

    with pytest.raises(error):
        fleet.learn_from(source, workers=1)


@pytest.mark.parametrize("file", [None, 3, ""], ids=repr)
def test_where_a_fleet_is_exported_to(file, tmp_path):
    from rlvc import fleet

    with pytest.raises(errors.ConfigError, match=r"does not end in \.npz"):
        fleet.export(tmp_path, file)


@pytest.mark.parametrize(
    ("changes", "error", "said"),
    [
        ({"folder": None}, errors.ConfigError, "folder: None is not"),
        ({"folder": 3}, errors.ConfigError, "folder: 3 is not"),
        ({"folder": ""}, errors.ConfigError, "folder: '' is not"),
        ({"folder": "file"}, errors.StoreError, "file: cannot be written"),
        ({"prefix": "a/b"}, errors.ConfigError, "prefix: 'a/b' cannot"),
        ({"prefix": "../b"}, errors.ConfigError, r"prefix: '\.\./b' cannot"),
        ({"prefix": 3}, errors.ConfigError, "prefix: 3 cannot"),
        ({"prefix": "a\0"}, errors.ConfigError, "prefix: .* cannot"),
    ],
    ids=str,
)
def test_where_a_log_is_converted_to(changes, error, said, tmp_path, monkeypatch):
    from rlvc import fleet

    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").write_bytes(b"precious")
    given = {"folder": "folder", "actions": 2, **changes}
    with pytest.raises(error, match=said):
        fleet.convert(log(), given.pop("folder"), **given)
    assert [path.name for path in tmp_path.iterdir() if path.is_file()] == ["file"]


def bits_log(bits):
    seen = np.random.default_rng(bits).random((41, bits)) < 0.5
    return {
        "observations": seen[:-1], "next_observations": seen[1:], "actions": np.arange(40) % 2,
        "rewards": np.ones(40), "terminated": np.zeros(40, bool), "truncated": np.arange(40) == 39,
    }  # fmt: skip


def test_a_fleet_of_as_many_bits_as_the_log(tmp_path):
    """A log of whole bytes may be a controller's, which has bits to spare."""
    from rlvc import fleet

    for bits, good in ((5, {5}), (13, {13}), (8, set(range(1, 9)))):
        fleet.convert(bits_log(bits), tmp_path / str(bits), actions=2)
        for domain in range(1, 20):
            if domain in good:
                assert fleet.learn_from(tmp_path / str(bits), domain=domain).agent.domain.bits == domain
                continue
            said = f"domain: {domain} bits, but the log's percepts have {bits}"
            with pytest.raises(errors.ConfigError, match=said):
                fleet.learn_from(tmp_path / str(bits), domain=domain)


@pytest.mark.parametrize("address", [True, False], ids=["address", "folder"])
@pytest.mark.parametrize("fault", [KeyboardInterrupt, OSError, MemoryError])
def test_a_conversion_that_is_interrupted_leaves_whole_files(address, fault, tmp_path, monkeypatch):
    """Whatever fails, in the midst of the second file: the first is there, or the old one."""
    from rlvc import fleet
    from rlvc.fleet import layout

    pytest.importorskip("fsspec")
    import fsspec
    from pyarrow import fs

    where = (fs.PyFileSystem(fs.FSSpecHandler(fsspec.filesystem("file"))), str(tmp_path / "log"))
    if address:
        monkeypatch.setattr(sys.modules["rlvc.fleet.convert"], "filesystem_of", lambda _folder: where)
    names = fleet.convert(log(), tmp_path / "log", actions=2, file_rows=5)
    old = {path.name: path.read_bytes() for path in (tmp_path / "log").iterdir()}
    assert len(names) == len(old) > 2
    write, written = layout.Writer.write, []

    def fails(self, *columns):
        write(self, *columns)
        written.append(1)
        if len(written) == 2:
            raise fault("planted")

    monkeypatch.setattr(layout.Writer, "write", fails)
    with pytest.raises((fault, errors.StoreError)):
        fleet.convert(log(), tmp_path / "log", actions=2, file_rows=5)
    assert {path.name: path.read_bytes() for path in (tmp_path / "log").iterdir()} == old


@pytest.mark.parametrize("changes", [{"workers": 0}, {"workers": "x"}, {"checkpoint": 3}], ids=str)
def test_how_a_fleet_learns(changes, tmp_path):
    from rlvc import fleet

    fleet.convert(log(), tmp_path / "log", actions=2)
    with pytest.raises(errors.ConfigError, match=next(iter(changes))):
        fleet.learn_from(tmp_path / "log", **changes)


def test_a_ctrl_c_that_meets_a_pool_before_it_has_begun(monkeypatch):
    def begun(*_arguments):
        try:
            raise KeyboardInterrupt
        except KeyboardInterrupt:
            raise RuntimeError("cannot join thread before it is started")  # noqa: B904

    monkeypatch.setattr(rlvc.learning.many, "ProcessPoolExecutor", begun)
    with pytest.raises(KeyboardInterrupt):
        many(processes=2)


def test_a_ctrl_c_while_a_domain_is_made():
    """Numpy must not take it for a type that it does not know."""
    made = rlvc.Thresholds(2).feature_dtype
    assert made == np.dtype(_native.Threshold)

    def strike(frame, event, _argument):
        if "numpy" in frame.f_code.co_filename and event == "call":
            raise KeyboardInterrupt
        return

    sys.settrace(strike)
    try:
        rlvc.Thresholds(2)
    except KeyboardInterrupt:
        pass
    finally:
        sys.settrace(None)
    assert rlvc.Thresholds(2).feature_dtype == made


def test_names_that_look_like_comments():
    """What is exported is one comment, whatever the numbers are called."""
    box = spaces.Box(-1, 1, (2,), np.float32)
    env = Line(box, seen=lambda place: np.array([place / 8, place % 2], np.float32))
    text = rlvc.learn(env, 20, names=["*/ int evil; /*", "//*"]).export_c()
    assert text.count("/*") == text.count("*/")
    assert "*/ int" not in text
