# SPDX-License-Identifier: MIT
"""Fleets learn from LeRobot's and Minari's data sets as they are: what rlvc.learn_from makes of all of it."""

import itertools
import json
import os

import numpy as np
import pytest
import worlds

import rlvc
from rlvc import errors
from rlvc.errors import ConfigError, LogError

pytest.importorskip("pyarrow")
import pyarrow as pa
import pyarrow.parquet as pq

import rlvc.fleet

COUNT = 6000


@pytest.fixture(scope="module")
def some():
    return worlds.maze(COUNT, seed=5, slip=0.1, walkers=40)


def episodes(some):
    """Slices of a log, one for each episode."""
    stops = np.flatnonzero(some.ends) + 1
    return [slice(a, b) for a, b in zip([0, *stops[:-1]], stops, strict=True)]


def expect_same(run, expected):
    assert run.agent.print("json") == expected.agent.print("json")
    assert run.agent.q.tobytes() == expected.agent.q.tobytes()


# ------------------------------------------------------------------ LeRobot


def frames(some, first, stop, kind):
    """Rows of LeRobot: a frame for each interaction; what comes next is in the next frame."""
    log = worlds.log_of(some)
    cut = episodes(some)[first:stop]
    rows = np.concatenate([np.arange(each.start, each.stop) for each in cut])
    index = np.concatenate([np.full(each.stop - each.start, first + i) for i, each in enumerate(cut)])
    frame = np.concatenate([np.arange(each.stop - each.start) for each in cut])
    state = pa.array(log["observations"][rows].ravel().astype(kind))
    return pa.table({
        "observation.state": pa.FixedSizeListArray.from_arrays(state, worlds.BITS),
        "observation.image": pa.array([{"bytes": b"", "path": "x"}] * len(rows)),  # is not read
        "action": pa.FixedSizeListArray.from_arrays(pa.array(some.actions[rows].astype(np.int64)), 1),
        "timestamp": frame / 10.0, "frame_index": frame, "episode_index": index, "index": rows,
        "task_index": np.zeros(len(rows), np.int64),
        "next.reward": some.rewards[rows], "next.done": some.ends[rows] == 1,
    })  # fmt: skip


def lerobot(folder, some, version, files, kind=np.float32):
    (folder / "meta/episodes").mkdir(parents=True)
    (folder / "meta/info.json").write_text(json.dumps({"codebase_version": version, "fps": 10}))
    pq.write_table(pa.table({"task_index": [0], "task": ["leave"]}), folder / "meta/tasks.parquet")
    count = len(episodes(some))
    cuts = np.linspace(0, count, files + 1).astype(int) if files else np.arange(count + 1)
    for i, (first, stop) in enumerate(itertools.pairwise(cuts)):
        chunk = folder / f"data/chunk-{i // 1000:03d}"
        chunk.mkdir(parents=True, exist_ok=True)
        name = f"file-{i:03d}" if files else f"episode_{i:06d}"
        pq.write_table(frames(some, first, stop, kind), chunk / f"{name}.parquet")
    return folder


def whole_log(some):
    """What a LeRobot data set tells: episodes that are cut short lack what came after their last frame."""
    log = worlds.log_of(some)
    kept = some.ends != 2
    log["truncated"] = np.append(some.ends[1:] == 2, False) & kept
    return {name: values[kept] for name, values in log.items()}


@pytest.mark.parametrize(("version", "files", "kind"), [("v2.1", 0, np.float32), ("v3.0", 1, np.bool_),
                                                        ("v3.0", 3, np.float32)])  # fmt: skip
def test_lerobot(tmp_path, some, version, files, kind):
    folder = lerobot(tmp_path / "set", some, version, files, kind)
    log = whole_log(some)
    expected = rlvc.learn_from(log, actions=4)
    run = rlvc.fleet.learn_from(folder, actions=4)
    expect_same(run, expected)
    assert run.agent.classes > 5
    lost = int((some.ends == 2).sum())
    assert (run.report.interactions, run.report.lost) == (COUNT - lost, lost)
    assert lost > 0
    expect_same(rlvc.fleet.learn_from(folder.as_uri(), actions=4, checkpoint=tmp_path / "saved"), expected)
    assert rlvc.fleet.learn_from(folder, actions=4, checkpoint=tmp_path / "saved2").report.lost == lost
    if files == 1:
        expect_same(rlvc.fleet.learn_from(folder), expected)
    else:
        with pytest.raises(ConfigError, match="actions"):
            rlvc.fleet.learn_from(folder)


def test_lerobot_of_what_is_no_bits(tmp_path, some):
    folder = lerobot(tmp_path / "set", some, "v3.0", 2)
    file = folder / "data/chunk-000/file-001.parquet"
    table = pq.read_table(file)
    half = pa.FixedSizeListArray.from_arrays(pa.array(np.full(18 * len(table), 0.5, np.float32)), 18)
    pq.write_table(table.set_column(0, "observation.state", half), file)
    with pytest.raises(LogError, match=r"file-001\.parquet: observations: real numbers, not bits"):
        rlvc.fleet.learn_from(folder, actions=4)
    run = rlvc.fleet.learn_from(folder, actions=4, skip_broken=True)
    assert len(run.report.skipped) == 1
    for column, values, text in (("action", np.linspace(0, 1, len(table)), "is not a whole number"),
                                 ("action", np.arange(len(table)) % 2 * 300, "are not numbers from 0 to 254"),
                                 ("action", np.arange(len(table)) % 2 - 1, "-1 is not in")):  # fmt: skip
        changed = table.set_column(table.column_names.index(column), column, pa.array(values))
        pq.write_table(changed, file)
        with pytest.raises(LogError, match=rf"file-001\.parquet: .*{text}"):
            rlvc.fleet.learn_from(folder, actions=4)
    (folder / "meta/info.json").write_text("{")
    with pytest.raises(LogError, match=r"info\.json: no JSON"):
        rlvc.fleet.learn_from(folder, actions=4)


def test_actions_are_the_same_numbers_in_each_file(tmp_path):
    """A file in which no action is 0 does not begin to count at its least one."""
    rng = np.random.default_rng(3)
    for i, least in enumerate((0, 1)):
        seen, actions = rng.integers(0, 2, (3000, 4)).astype(bool), rng.integers(least, 3, 3000)
        rewards = (actions == 1 + seen[:, 2]).astype(np.float32)
        np.savez(tmp_path / f"{i}.npz", observations=seen, next_observations=seen, actions=actions, rewards=rewards,
                 terminated=np.ones(3000, bool))  # fmt: skip
    run = rlvc.fleet.learn_from(tmp_path, discount=0.5)
    assert run.agent.config.actions == 3
    for value in (False, True):
        assert run.act(np.array([False, True, value, True])) == 1 + value


@pytest.mark.parametrize(("text", "says"), [
    ("", "no JSON"), ("[" * 100_000, "no JSON"), ("9" * 5000, "no JSON"), ("null", "column obs: missing"),
    ("5", "column obs: missing"), ('["codebase_version"]', "column obs: missing"),
])  # fmt: skip
def test_a_folder_that_is_not_quite_lerobots(tmp_path, some, text, says):
    folder = lerobot(tmp_path / "set", some, "v3.0", 1)
    (folder / "meta/info.json").write_text(text)
    with pytest.raises(LogError, match=says):
        rlvc.fleet.learn_from(folder, actions=4)


def test_lerobot_in_one_go_or_with_a_file_without_rows(tmp_path, some):
    folder = lerobot(tmp_path / "set", some, "v3.0", 2)
    expected = rlvc.fleet.learn_from(folder, actions=4)
    with pytest.warns(errors.LogWarning):
        run = rlvc.learn_from(folder, actions=4, columns=["observation.state"])
    assert run.interactions == expected.report.interactions
    file = folder / "data/chunk-000/file-000.parquet"
    pq.write_table(pq.read_table(file).slice(0, 0), folder / "data/chunk-000/file-00.parquet")
    expect_same(rlvc.fleet.learn_from(folder, actions=4), expected)
    for each in file.parent.iterdir():
        pq.write_table(pq.read_table(each).slice(0, 0), each)
    with pytest.raises(LogError, match="there is no interaction"):
        rlvc.fleet.learn_from(folder, actions=4)


def forged(table, how):
    """Frames of which something is wrong."""
    if how == "other bits":
        state = pa.array(np.ones(17 * len(table), np.float32))
        return table.set_column(0, "observation.state", pa.FixedSizeListArray.from_arrays(state, 17))
    if how == "huge actions":
        return table.set_column(table.column_names.index("action"), "action", [np.full(len(table), 1e300)])
    return pa.Table.from_arrays([*table.columns, table.column("action")], [*table.column_names, "action"])


@pytest.mark.parametrize(("how", "says"), [
    ("other bits", "percepts of 17 bits, not of 18"), ("huge actions", r"actions: \d+ is not in"),
    ("a name twice", "two columns have the same name"),
])  # fmt: skip
def test_forged_frames(tmp_path, some, how, says):
    folder = lerobot(tmp_path / "set", some, "v3.0", 2)
    file = folder / "data/chunk-000/file-001.parquet"
    pq.write_table(forged(pq.read_table(file), how), file)
    with pytest.raises(LogError, match=rf"file-001\.parquet: {says}"):
        rlvc.fleet.learn_from(folder, actions=4)


def test_damaged_frames_are_refused_by_one_sentence(tmp_path, some):
    folder = lerobot(tmp_path / "set", some, "v3.0", 1)
    file = folder / "data/chunk-000/file-000.parquet"
    whole, rng, said = file.read_bytes(), np.random.default_rng(5), []
    for _ in range(60):
        damaged = bytearray(whole)
        for place in len(whole) - 1 - rng.integers(0, 3000, 2):  # in the footer: names, types, places
            damaged[place] = rng.integers(256)
        file.write_bytes(damaged)
        try:
            rlvc.fleet.learn_from(folder, actions=4)
        except errors.Error as error:
            said.append(str(error))
    assert len(said) > 30
    assert not any("\n" in text for text in said)


def test_links_that_lead_back(tmp_path, some):
    """Two loops in one folder have as many paths as there are binary numbers."""
    folder = lerobot(tmp_path / "set", some, "v3.0", 2)
    lost = rlvc.fleet.learn_from(folder, actions=4).report.lost
    chunk = folder / "data/chunk-000"
    for name, to in (("again", "."), ("up", ".."), ("out", "../.."), ("far", tmp_path)):
        (chunk / name).symlink_to(to, target_is_directory=True)
    (folder / "data/chunk-001").symlink_to(chunk, target_is_directory=True)
    (folder / "data/a.parquet").symlink_to(chunk / "file-000.parquet")
    (chunk / "gone.parquet").symlink_to("nowhere")
    (chunk / "itself.parquet").symlink_to("itself.parquet")
    report = rlvc.fleet.learn_from(folder, actions=4).report
    assert (report.interactions, report.lost) == (COUNT - lost, lost)


def test_links_to_elsewhere(tmp_path, some):
    """As in the caches of those who share data sets: the files themselves have other names."""
    folder = lerobot(tmp_path / "set", some, "v3.0", 2)
    lost = rlvc.fleet.learn_from(folder, actions=4).report.lost
    (tmp_path / "kept").mkdir()
    for file in sorted((folder / "data/chunk-000").iterdir()):
        kept = file.rename(tmp_path / "kept" / file.stem)
        file.symlink_to(kept)
    report = rlvc.fleet.learn_from(folder, actions=4).report
    assert (report.interactions, report.lost) == (COUNT - lost, lost)


def test_names_that_are_not_utf8(tmp_path, some):
    folder = lerobot(tmp_path / "set", some, "v3.0", 1)
    try:
        (folder / "data" / os.fsdecode(b"\xff.parquet")).write_bytes(b"")
    except OSError:
        pytest.skip("this file system has no such names")
    with pytest.raises(LogError, match="not UTF-8"):
        rlvc.fleet.learn_from(folder, actions=4)


# ------------------------------------------------------------------ Minari


@pytest.fixture
def minari_set(tmp_path, monkeypatch, some):
    minari = pytest.importorskip("minari")
    from gymnasium import spaces
    from minari.data_collector import EpisodeBuffer

    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path))
    log = worlds.log_of(some)
    seen, led_to = (log[name].astype(np.int8) for name in ("observations", "next_observations"))
    buffers = [
        EpisodeBuffer(
            observations=[*seen[each], led_to[each.stop - 1]],
            actions=[np.int64(a) for a in some.actions[each]], rewards=some.rewards[each].tolist(),
            terminations=log["terminated"][each].tolist(), truncations=log["truncated"][each].tolist(),
        )
        for each in episodes(some)
    ]  # fmt: skip
    return minari.create_dataset_from_buffers(
        "test/maze-v0", buffers, observation_space=spaces.MultiBinary(18), action_space=spaces.Discrete(4),
        author="x", author_email="x@example.org", code_permalink="https://example.org", algorithm_name="walk",
        description="A walk.",
    )  # fmt: skip


@pytest.mark.filterwarnings("ignore::UserWarning")  # of what the data set does not say
def test_minari(tmp_path, monkeypatch, some, minari_set):
    monkeypatch.setattr(rlvc.fleet.datasets, "EPISODES_ROWS", COUNT // 5)
    expected = rlvc.learn_from(worlds.log_of(some), actions=4)
    for source in ("test/maze-v0", tmp_path / "test/maze-v0", minari_set):
        run = rlvc.fleet.learn_from(source)
        expect_same(run, expected)
        assert (run.report.interactions, run.report.lost) == (COUNT, 0)
    percept = worlds.log_of(some)["observations"][7]
    assert run.act(percept.astype(np.int8)) == run.agent.predict(percept).action  # by the data set's space
    with pytest.raises(LogError, match="no such file or folder"):
        rlvc.fleet.learn_from("test/none-v0")
