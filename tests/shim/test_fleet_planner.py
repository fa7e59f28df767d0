# SPDX-License-Identifier: MIT
"""A planner learns from a sample of a fleet's log of real numbers: the same bytes for any files and any engine."""

import hashlib
import json

import numpy as np
import pytest
import worlds

import rlvc
from rlvc.errors import ConfigError, LogError

pytest.importorskip("pyarrow")
import pyarrow as pa
import pyarrow.parquet as pq

import rlvc.fleet
from rlvc.fleet import engines, episodes

TERMINATED, TRUNCATED = 1, 2
NAMES = ("observations", "next_observations", "actions", "rewards", "terminated", "truncated")


def line(count, seed=1, act=None):
    """Episodes on a line: right or left by a tenth, some astray; beyond 1 it is won, after 40 steps it is over."""
    rng = np.random.default_rng(seed)
    rows, x, steps = [], rng.uniform(-1, 0.5), 0
    while len(rows) < count or steps:
        seen = np.float32([x, -x])
        action = int(rng.integers(2)) if act is None else act(seen)
        to = x + (0.1 if action else -0.1) + rng.normal(0, 0.02)
        steps += 1
        end = TERMINATED if to > 1 else TRUNCATED if steps == 40 else 0
        rows.append((seen, np.float32([to, -to]), action, np.float32(1.0 if to > 1 else -0.1), end))
        x, steps = (rng.uniform(-1, 0.5), 0) if end else (to, steps)
    before, after, actions, rewards, ends = (np.array(column) for column in zip(*rows, strict=True))
    return dict(zip(NAMES, (before, after, actions, rewards, ends == TERMINATED, ends == TRUNCATED), strict=True))


def earned(run):
    """Mean return of a policy: by chance it is -3.4, straight to the right -0.2."""
    made = line(1000, 5, run.act)
    return float(np.mean([part["rewards"].sum() for part in cut(made)]))


def cut(log):
    """The episodes of a log."""
    stops = np.flatnonzero(log["terminated"] | log["truncated"]) + 1
    return [{name: values[a:b] for name, values in log.items()} for a, b in zip([0, *stops[:-1]], stops, strict=True)]


def save(folder, parts):
    """Some episodes in each file."""
    folder.mkdir()
    for i, part in enumerate(parts):
        np.savez(folder / f"{i}.npz", **{name: np.concatenate([each[name] for each in part]) for name in NAMES})
    return folder


def shared(parts, count, rng=None):
    order = np.arange(len(parts)) if rng is None else rng.permutation(len(parts))
    return [[parts[i] for i in some] for some in np.array_split(order, count)]


@pytest.fixture(scope="module")
def log():
    return line(12_000)


@pytest.fixture(scope="module")
def folder(tmp_path_factory, log):
    return save(tmp_path_factory.mktemp("line") / "3", shared(cut(log), 3))


@pytest.fixture(scope="module")
def run(folder):
    return rlvc.fleet.learn_from(folder, method="planner", sample=1500)


# ------------------------------------------------------------------ the sample


def records(part):
    """The content of an episode, by hand."""
    ends = np.where(part["terminated"], TERMINATED, np.where(part["truncated"], TRUNCATED, 0)).astype(np.uint8)
    rows = (part["observations"], part["actions"].astype(np.uint8), part["rewards"], part["next_observations"], ends)
    return [b"".join(np.asarray(value).tobytes() for value in row) for row in zip(*rows, strict=True)]


def lowest(parts, room):
    """Episodes by hash, as long as they fit."""
    chosen, left = [], room
    for rows in sorted(parts, key=lambda rows: hashlib.blake2b(b"".join(rows), digest_size=16).digest()):
        if len(rows) > left:
            break
        chosen.append(rows)
        left -= len(rows)
    return chosen


@pytest.mark.parametrize("room", [100, 777, 3000, 10**6])
def test_a_sample_holds_the_lowest_hashes_of_each_kind_of_end(log, room):
    all_of_it = cut(log)
    strata = [[records(part) for part in all_of_it if part["terminated"][-1] == over] for over in (True, False)]
    some = lowest(strata[0], room // 2)
    others = lowest(strata[1], room - sum(map(len, some)))
    some = lowest(strata[0], room - sum(map(len, others)))
    expected = {b"".join(rows) for rows in some + others}
    rng = np.random.default_rng(room)
    for parts in (shared(all_of_it, 1), shared(all_of_it, 5, rng), shared(all_of_it, len(all_of_it), rng)):
        total = episodes.Episodes(room)
        for part in parts:
            drawn = episodes.Episodes(room)
            for several in np.array_split(np.arange(len(part)), 2):  # the room of a task is filled twice
                if len(several):
                    joined = {name: np.concatenate([part[i][name] for i in several]) for name in NAMES}
                    ends = np.where(joined["terminated"], TERMINATED, 2 * joined["truncated"])
                    drawn.see(episodes.rows_of(joined["observations"], joined["actions"], joined["rewards"],
                                               joined["next_observations"], ends))  # fmt: skip
            total.add(drawn)
        chosen = [rows.tobytes() for rows in total.chosen()]
        assert len(chosen) == len(expected)
        assert set(chosen) == expected
        digests = [hashlib.blake2b(rows, digest_size=16).digest() for rows in chosen]
        assert digests == sorted(digests)
        assert sum(map(len, total.chosen())) <= room


def one(count, end, start=0.0):
    x = np.arange(count + 1, dtype=np.float32)[:, None] + np.float32(start)
    ends = np.zeros(count, np.uint8)
    ends[-1] = end
    return episodes.rows_of(x[:-1], np.zeros(count), np.ones(count), x[1:], ends)


def chosen(room, *parts):
    drawn = episodes.Episodes(room)
    for part in parts:
        drawn.see(part)
    return [(len(rows), int(rows["end"][-1])) for rows in drawn.chosen()]


def test_episodes_without_an_end_count_only_if_there_are_no_others():
    assert chosen(10, one(4, 0), one(3, TERMINATED)) == [(3, TERMINATED)]
    assert chosen(10, one(4, 0), one(4, 0, 100.5)) == [(4, 0), (4, 0)]
    two = np.concatenate([one(4, 0), one(5, 0, 9.5)])  # the second begins where the first does not lead
    assert chosen(10, two) == [(4, TRUNCATED)]


def test_an_episode_longer_than_the_sample_is_cut_short():
    assert chosen(10, one(40, TERMINATED)) == [(10, TRUNCATED)]
    assert chosen(10, one(40, 0)) == [(10, TRUNCATED)]
    both = [chosen(10, one(40, TERMINATED), one(3, TERMINATED, start)) for start in range(50)]
    assert {tuple(found) for found in both} == {((10, TRUNCATED),), ((3, TERMINATED),)}  # as their hashes are
    assert chosen(10) == []


# ------------------------------------------------------------------ learning


def test_a_tree_is_learnt(run, log):
    assert run.report.interactions == len(log["actions"])
    assert 1300 < run.report.rows <= 1500
    assert run.planner.statistics.interactions == run.report.rows
    assert earned(run) > -0.5
    assert "action 1" in run.text()
    assert run.warning == ""


@pytest.mark.parametrize("count", [1, 2, 7])
def test_any_files(tmp_path, run, log, count):
    shuffled = shared(cut(log), count, np.random.default_rng(count))
    again = rlvc.fleet.learn_from(save(tmp_path / "a", shuffled), method="planner", sample=1500)
    assert again.planner.snapshot() == run.planner.snapshot()
    assert again.text() == run.text()


def test_on_a_cluster(tmp_path, folder, run, monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setattr(engines, "_TASK_ROWS", 1)
    again = rlvc.fleet.learn_from(folder, method="planner", sample=1500, cluster="dask", workers=2)
    assert again.planner.snapshot() == run.planner.snapshot()
    assert again.report == run.report


def test_of_parquet_and_lerobot(tmp_path, run, log):
    parts = shared(cut(log), 2)
    set_ = tmp_path / "set"
    (set_ / "data/chunk-000").mkdir(parents=True)
    (set_ / "meta").mkdir()
    (set_ / "meta/info.json").write_text(json.dumps({"codebase_version": "v3.0"}))
    (tmp_path / "rllib").mkdir()
    for i, part in enumerate(parts):
        flat = {name: np.concatenate([each[name] for each in part]) for name in NAMES}

        def lists(name, flat=flat):
            return pa.FixedSizeListArray.from_arrays(pa.array(flat[name].ravel()), 2)

        episode = np.concatenate([np.full(len(each["actions"]), number) for number, each in enumerate(part)])
        pq.write_table(pa.table({
            "obs": lists("observations"), "actions": flat["actions"], "rewards": flat["rewards"], "eps_id": episode,
            "new_obs": lists("next_observations"), "terminateds": flat["terminated"], "truncateds": flat["truncated"],
        }), tmp_path / f"rllib/{i}.parquet")  # fmt: skip
        pq.write_table(pa.table({
            "observation.state": lists("observations"), "action": flat["actions"], "episode_index": episode,
            "next.reward": flat["rewards"], "next.done": flat["terminated"],
        }), set_ / f"data/chunk-000/file-{i:03d}.parquet")  # fmt: skip
    asked = {"method": "planner", "sample": 1500, "actions": 2}
    again = rlvc.fleet.learn_from(tmp_path / "rllib", **asked)
    assert again.planner.snapshot() == run.planner.snapshot()
    with pytest.raises(LogError, match=r"file-000\.parquet: what was observed as episodes terminated is not in the log"):
        rlvc.fleet.learn_from(set_, **asked)
    for file in set_.rglob("*.parquet"):  # episodes end with their numbers, and nobody knows why
        pq.write_table(pq.read_table(file).drop_columns(["next.done"]), file)
    other = rlvc.fleet.learn_from(set_, **asked)
    assert other.report.lost == len(cut(log))
    assert other.report.interactions == len(log["actions"]) - other.report.lost
    assert 1300 < other.report.rows <= 1500


def test_a_robot_goes_on(tmp_path, run):
    run.planner.save(tmp_path / "planner.rlvc")
    robot = rlvc.Planner.load(tmp_path / "planner.rlvc")
    x = np.float32([0.3, -0.3])
    assert robot.act_at(x) == run.planner.act_at(x)
    robot.begin(x)
    for step in range(40):
        robot.observe(robot.act(), -0.1, x, step == 39)
    robot.learn()
    assert robot.statistics.episodes == run.planner.statistics.episodes + 1


# ------------------------------------------------------------------ refused


@pytest.mark.parametrize(("options", "text"), [
    ({"reward_bits": 4}, "reward_bits: a planner learns from rewards as they are"), ({"reward_grid": 0.1}, "reward_grid"),
    ({"checkpoint": "x"}, "checkpoint: a planner's sample takes one pass"), ({"domain": 3}, "domain"),
    ({"sample": 63}, "sample: 63"), ({"capacity": 2999}, "capacity: 2999 is less than twice the sample, 3000"),
    ({"discount": 0.9}, "discount: a planner has no such field"), ({"method": "x"}, "method: 'x' is not one of"),
    ({"actions": 1}, "a planner has 2 to 64 actions"), ({"cluster": "spark://x"}, "cluster"),
])  # fmt: skip
def test_refusals(folder, options, text):
    with pytest.raises(ConfigError, match=text):
        rlvc.fleet.learn_from(folder, **({"method": "planner", "sample": 1500} | options))


def test_logs_that_are_refused(tmp_path, log, folder):
    asked = {"method": "planner", "sample": 1500}
    rlvc.fleet.convert(worlds.log_of(worlds.maze(500)), tmp_path / "bits", actions=4)
    with pytest.raises(LogError, match=r"part-00000\.parquet: percepts of bits"):
        rlvc.fleet.learn_from(tmp_path / "bits", **asked)
    np.savez(tmp_path / "bits.npz", **worlds.log_of(worlds.maze(500)))
    with pytest.raises(LogError, match=r"bits\.npz: observations of bits: a planner needs real numbers"):
        rlvc.fleet.learn_from(tmp_path / "bits.npz", **asked)
    with pytest.raises(LogError, match="real numbers, not bits"):
        rlvc.fleet.learn_from(folder)
    parts = save(tmp_path / "two", shared(cut(log), 2))
    with np.load(parts / "1.npz") as archive:
        wrong = dict(archive)
    np.savez(parts / "1.npz", **(wrong | {"actions": wrong["actions"] + 1}))
    with pytest.raises(LogError, match=r"1\.npz: interaction \d+: action: 2 is not in \[0, 2\)"):
        rlvc.fleet.learn_from(parts, actions=2, **asked)
    wide = {name: np.repeat(wrong[name], 2, axis=1) for name in ("observations", "next_observations")}
    np.savez(parts / "1.npz", **(wrong | wide))
    with pytest.raises(LogError, match=r"1\.npz: .*observation"):
        rlvc.fleet.learn_from(parts, **asked)
    left = rlvc.fleet.learn_from(parts, actions=2, skip_broken=True, **asked)
    assert len(left.report.skipped) == 1
    assert left.report.interactions < len(log["actions"])
