# SPDX-License-Identifier: MIT
"""Fleets: the same bytes from any files and any engine, also when workers and drivers are killed.

Clusters listen on this machine alone and have a home of their own. RLVC_FLEET_LONG=1 asks for more
interactions.
"""

import json
import multiprocessing
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest
import worlds

import rlvc
from rlvc.errors import ConfigError, CountError, Error, LogError, StoreError

pytest.importorskip("pyarrow")
import pyarrow as pa
import pyarrow.parquet as pq

import rlvc.fleet
from rlvc.fleet import checkpoint, engines, layout, sources

COUNT = 1_000_000 if os.environ.get("RLVC_FLEET_LONG") else 20_000


def expect_same(run, expected):
    assert run.agent.print("json") == expected.print("json")
    assert run.agent.q.tobytes() == expected.q.tobytes()
    assert run.agent.samples.tobytes() == expected.samples.tobytes()


def write(path, some, bits=worlds.BITS, actions=4):
    writer = layout.Writer(str(path), bits, actions)
    writer.write(some)
    writer.close()


def shards(folder, some, count, rng=None):
    """Files of a log, in order or shuffled, rows and files."""
    folder.mkdir()
    order = np.arange(len(some)) if rng is None else rng.permutation(len(some))
    names = [f"part-{i}.parquet" for i in range(count)]
    if rng is not None:
        rng.shuffle(names)
    for name, index in zip(names, np.array_split(order, count), strict=True):
        write(folder / name, worlds.part_of(some, index))
    return folder


@pytest.fixture(scope="module")
def some():
    return worlds.maze(COUNT, slip=0.1, rewards="tenths")


@pytest.fixture(scope="module")
def expected(some):
    return rlvc.learn_from(worlds.log_of(some), actions=4, capacity=2 * COUNT).agent


@pytest.fixture(scope="module")
def folder(tmp_path_factory, some):
    return shards(tmp_path_factory.mktemp("log") / "7", some, 7)


# ------------------------------------------------------------------ any files


@pytest.mark.parametrize("count", [1, 2, 4, 7])
def test_any_shards(tmp_path, some, expected, count):
    run = rlvc.fleet.learn_from(shards(tmp_path / "a", some, count))
    expect_same(run, expected)
    assert run.report.interactions == run.interactions == COUNT
    assert run.report.passes <= 1 + len({split.feature for split in run.agent.splits})
    shuffled = shards(tmp_path / "b", some, count, np.random.default_rng(count))
    expect_same(rlvc.fleet.learn_from(shuffled), expected)


@pytest.mark.parametrize(("slip", "rewards"), [(0.0, "plain"), (0.0, "tenths"), (0.1, "plain")])
def test_any_rewards(tmp_path, slip, rewards):
    some = worlds.maze(COUNT, seed=3, slip=slip, rewards=rewards)
    expected = rlvc.learn_from(worlds.log_of(some), actions=4, capacity=2 * COUNT).agent
    expect_same(rlvc.fleet.learn_from(shards(tmp_path / "a", some, 3)), expected)


@pytest.mark.parametrize("name", ["FrozenLake-v1", "Taxi-v4"])
def test_logs_of_environments(tmp_path, name):
    gymnasium = pytest.importorskip("gymnasium")
    env = gymnasium.make(name)
    encoder = rlvc.Encoder(env.observation_space)
    log = worlds.walk(env, encoder, 6000, 1)
    actions = int(env.action_space.n)
    expected = rlvc.learn_from(log, actions=actions).agent
    files = rlvc.fleet.convert(log, tmp_path / "log", actions=actions, file_rows=1000)
    assert len(files) > 2
    expect_same(rlvc.fleet.learn_from(tmp_path / "log"), expected)


def test_a_sample_saves_passes(folder, expected):
    run = rlvc.fleet.learn_from(folder, sample=0)
    assert run.report.passes > 1
    guessed = rlvc.fleet.learn_from(folder, sample=COUNT // 8)
    assert guessed.report.passes <= 2
    expect_same(guessed, expected)


def test_files_of_other_kinds(tmp_path, some, expected):
    rlvc.fleet.export(shards(tmp_path / "a", some, 2), tmp_path / "log.npz")
    expect_same(rlvc.fleet.learn_from(tmp_path / "log.npz"), expected)
    again = rlvc.learn_from(tmp_path / "log.npz", actions=4, capacity=2 * COUNT).agent
    assert again.print("json") == expected.print("json")


def test_columns_of_rllib(tmp_path, some, expected):
    log = worlds.log_of(some)
    flat = {name: pa.FixedSizeListArray.from_arrays(pa.array(log[key].ravel()), worlds.BITS)
            for name, key in (("obs", "observations"), ("new_obs", "next_observations"))}  # fmt: skip
    table = pa.table(flat | {
        "eps_id": np.zeros(COUNT, np.int64), "actions": some.actions.astype(np.int64), "rewards": some.rewards,
        "terminateds": log["terminated"], "truncateds": log["truncated"], "t": np.arange(COUNT),
    })  # fmt: skip
    pq.write_table(table, tmp_path / "log.parquet", row_group_size=7000)
    expect_same(rlvc.fleet.learn_from(tmp_path / "log.parquet", actions=4), expected)
    with pytest.raises(ConfigError, match="actions"):
        rlvc.fleet.learn_from(tmp_path / "log.parquet")
    pq.write_table(table.drop_columns(["new_obs"]), tmp_path / "log.parquet")
    with pytest.raises(LogError, match="column new_obs: missing"):
        rlvc.fleet.learn_from(tmp_path / "log.parquet", actions=4)


def test_an_address(tmp_path, some, expected):
    folder = shards(tmp_path / "a", some, 2)
    expect_same(rlvc.fleet.learn_from(folder.as_uri()), expected)


def test_rounded_rewards(tmp_path):
    some = worlds.maze(COUNT, rewards="normal")
    folder = shards(tmp_path / "a", some, 3, np.random.default_rng(0))
    exact = rlvc.fleet.learn_from(folder)
    for options in ({"reward_bits": 7}, {"reward_grid": 0.001}):
        run = rlvc.fleet.learn_from(folder, **options)
        assert {s.feature for s in run.agent.splits} == {s.feature for s in exact.agent.splits}
        assert run.report.rows < exact.report.rows
        probe = some.percepts[:500]
        values = [r.agent.values[r.agent.predict(probe).class_id] for r in (run, exact)]
        np.testing.assert_allclose(*values, atol=0.1)
        again = rlvc.fleet.learn_from(shards(tmp_path / str(options), some, 2), **options)
        expect_same(again, run.agent)
    with pytest.raises(ConfigError, match="give one of them"):
        rlvc.fleet.learn_from(folder, reward_bits=7, reward_grid=0.1)


# ------------------------------------------------------------------ broken files


def test_whole_episodes_in_each_file(tmp_path, some):
    files = rlvc.fleet.convert(worlds.log_of(some), tmp_path / "log", actions=4, file_rows=3000)
    assert len(files) > 3
    ends = [pq.read_table(file)["end"][-1].as_py() for file in files]
    assert 0 not in ends
    kept = np.concatenate([pq.read_table(file)["reward"].to_numpy() for file in files])
    np.testing.assert_array_equal(kept, some.rewards)


def test_a_conversion_that_fails_leaves_no_empty_folder(tmp_path, some, monkeypatch):
    log, folder = worlds.log_of(some), tmp_path / "logs/today"
    with pytest.raises(StoreError, match="File name too long"):
        rlvc.fleet.convert(log, folder, actions=4, prefix="x" * 300)
    assert os.listdir(tmp_path) == []
    folder.mkdir(parents=True)
    with pytest.raises(StoreError, match="File name too long"):
        rlvc.fleet.convert(log, folder, actions=4, prefix="x" * 300)
    assert os.listdir(folder) == []
    module = sys.modules["rlvc.fleet.convert"]
    put = module._put

    def interrupted(filesystem, path, content):
        if path.endswith("-00001.parquet"):
            raise KeyboardInterrupt
        put(filesystem, path, content)

    monkeypatch.setattr(module, "_put", interrupted)
    with pytest.raises(KeyboardInterrupt):
        rlvc.fleet.convert(log, tmp_path / "half", actions=4, file_rows=3000)
    assert os.listdir(tmp_path / "half") == ["part-00000.parquet"]


def test_another_version(tmp_path, some):
    write(tmp_path / "a.parquet", some)
    table = pq.read_table(tmp_path / "a.parquet")
    for meta, text in (
        ({b"rlvc.version": b"2", b"rlvc.bits": b"18", b"rlvc.actions": b"4"}, "rlvc.version is 2"),
        ({b"rlvc.version": b"1", b"rlvc.bits": b"x", b"rlvc.actions": b"4"}, "are not numbers"),
        ({b"rlvc.version": b"1", b"rlvc.bits": b"99", b"rlvc.actions": b"4"}, "column percept: "),
        ({}, "rlvc.version is missing"),
    ):
        pq.write_table(table.replace_schema_metadata(meta), tmp_path / "a.parquet")
        with pytest.raises(LogError, match=text):
            rlvc.fleet.learn_from(tmp_path)


def test_files_that_do_not_fit_together(tmp_path, some):
    write(tmp_path / "a.parquet", some)
    write(tmp_path / "b.parquet", some, actions=5)
    with pytest.raises(LogError, match=r"b\.parquet: 5 actions"):
        rlvc.fleet.learn_from(tmp_path)
    write(tmp_path / "b.parquet", some, bits=24)
    with pytest.raises(LogError, match=r"b\.parquet: 24 bits"):
        rlvc.fleet.learn_from(tmp_path)


def test_a_broken_row_group_is_named(tmp_path, some, monkeypatch):
    monkeypatch.setattr(layout, "GROUP_ROWS", 4000)
    good, bad = tmp_path / "a.parquet", tmp_path / "b.parquet"
    write(good, worlds.part_of(some, slice(0, 12_000)))
    write(bad, worlds.part_of(some, slice(12_000, 20_000)))
    column = pq.ParquetFile(bad).metadata.row_group(1).column(3)
    content = bytearray(bad.read_bytes())
    place = column.data_page_offset + 30
    content[place : place + 400] = bytes(400)
    bad.write_bytes(content)
    with pytest.raises(LogError, match=r"b\.parquet: row group 1: column next_percept"):
        rlvc.fleet.learn_from(tmp_path)
    run = rlvc.fleet.learn_from(tmp_path, skip_broken=True)
    assert run.report.interactions == 16_000
    assert len(run.report.skipped) == 1
    assert "row group 1" in run.report.skipped[0]
    rest = worlds.part_of(some, slice(0, 16_000))
    expected = rlvc.learn_from(worlds.log_of(rest), actions=4)
    expect_same(run, expected.agent)


def test_an_interaction_out_of_range_is_named(tmp_path, some):
    some = worlds.part_of(some, slice(0, 20_000))  # one row group
    actions = some.actions.copy()
    actions[17] = 200
    write(tmp_path / "a.parquet", worlds.Columns(some.percepts, some.next_percepts, actions, some.rewards,
                                                 some.ends, some.keys))  # fmt: skip
    with pytest.raises(LogError, match="row group 0: interaction 17: action: 200"):
        rlvc.fleet.learn_from(tmp_path)
    with pytest.raises(LogError, match="holds no interaction"):
        rlvc.fleet.learn_from(tmp_path, skip_broken=True)


def test_a_truncated_file(tmp_path, some):
    write(tmp_path / "a.parquet", some)
    content = (tmp_path / "a.parquet").read_bytes()
    (tmp_path / "a.parquet").write_bytes(content[: len(content) // 2])
    with pytest.raises(LogError, match=r"a\.parquet: cannot be read as Parquet"):
        rlvc.fleet.learn_from(tmp_path)
    with pytest.raises(LogError, match="no such file or folder"):
        rlvc.fleet.learn_from(tmp_path / "nothing")
    (tmp_path / "empty").mkdir()
    with pytest.raises(LogError, match="holds no file that ends in"):
        rlvc.fleet.learn_from(tmp_path / "empty")


@pytest.mark.parametrize(
    ("options", "text"),
    [({"criterion": "returns"}, "returns depend on the order"), ({"solver": "sarsa"}, "sarsa depends"),
     ({"cluster": "spark://x"}, "cluster: 'spark://x' is neither"), ({"reward_bits": 23}, "reward_bits"),
     ({"reward_grid": -1.0}, "reward_grid"), ({"domain": 40}, "domain: 40 bits"),
     ({"domain": rlvc.Thresholds(3)}, "counts are of bits"), ({"dependence": True}, "the order of interactions"), ({"no_such": 1}, "no such field")],
)  # fmt: skip
def test_refusals(folder, options, text):
    with pytest.raises(ConfigError, match=text):
        rlvc.fleet.learn_from(folder, **options)


def test_memory_is_bounded(tmp_path):
    some = worlds.maze(COUNT, rewards="normal")
    write(tmp_path / "a.parquet", some)
    with pytest.raises(CountError, match="reward_bits or reward_grid"):
        rlvc.fleet.learn_from(tmp_path, memory=1 << 20)


# ------------------------------------------------------------------ checkpoints


def test_a_driver_that_is_killed_goes_on(tmp_path, folder, expected):
    file = tmp_path / "checkpoint"
    for kill_after in (1, 1, 2):
        child = multiprocessing.get_context("fork").Process(target=_killed, args=(folder, file, kill_after))
        child.start()
        child.join()
        assert child.exitcode == -signal.SIGKILL
        assert file.exists()
    run = rlvc.fleet.learn_from(folder, checkpoint=file, sample=0, progress=False)
    expect_same(run, expected)
    whole = rlvc.fleet.learn_from(folder, sample=0)
    assert run.report == whole.report
    assert run.agent.snapshot() == whole.agent.snapshot()
    with pytest.raises(ConfigError, match="made from other data or options"):
        rlvc.fleet.learn_from(folder, checkpoint=file, discount=0.5)
    file.write_bytes(file.read_bytes()[:-100])
    with pytest.raises(LogError, match="damaged"):
        rlvc.fleet.learn_from(folder, checkpoint=file)


def test_forged_checkpoints(tmp_path, folder):
    """C would read beyond arrays that are shorter than they should be."""
    file = tmp_path / "checkpoint"
    rlvc.fleet.learn_from(folder, checkpoint=file, sample=0, reward_bits=8)
    with np.load(file) as archive:
        members = {name: archive[name] for name in archive.files}
    head = json.loads(members["head"].tobytes())
    head["progress"]["done"] = False

    def learn(**changes):
        said = {key: value for key, value in changes.items() if key in head}
        arrays = members | {key: value for key, value in changes.items() if key not in head}
        arrays["head"] = np.frombuffer(json.dumps(head | said).encode(), np.uint8)
        np.savez(tmp_path / "forged.npz", **{k: v for k, v in arrays.items() if v is not None})
        return rlvc.fleet.learn_from(folder, checkpoint=tmp_path / "forged.npz", sample=0, reward_bits=8)

    assert learn().agent.classes > 1
    forged = [
        *({name: array[:-1]} for name, array in members.items() if name not in ("head", "snapshot", "sample", "pair", "row")),
        *({name: np.asfortranarray(members[name][:, :2])} for name in ("present", "follow")),
        *({name: None} for name in ("row", "present", "follow", "pair", "reward")),
        {"present": members["present"].astype(np.uint32)}, {"row": members["row"]["count"]}, {"pair": np.uint64(3)},
        {"present": members["present"] + np.uint64(10**9)}, {"reward": members["reward"][:, :2]},
        {"sample": np.zeros(3, np.uint8)}, {"sample": np.zeros((3, 9), np.uint8)}, {"snapshot": np.zeros(9, np.uint8)},
        {"cell": [70000]}, {"cell": [-1]}, {"cell": [1, 1]}, {"cell": list(range(99))}, {"cell": 3}, {"seen": [1, 2]},
        {"seen": ["a", 2, []]}, {"progress": {"passes": "x", "rounds": 0, "splits": 0, "done": False}}, {"progress": []},
    ]  # fmt: skip
    for changes in forged:
        with pytest.raises(Error):
            learn(**changes)


def _killed(folder, file, after):
    """Dies as soon as it has saved so many checkpoints."""
    saved = []
    save = checkpoint.save

    def save_and_die(*arguments):
        save(*arguments)
        saved.append(1)
        if len(saved) == after:
            os.kill(os.getpid(), signal.SIGKILL)

    checkpoint.save = save_and_die
    rlvc.fleet.learn_from(folder, checkpoint=file, sample=0)


# ------------------------------------------------------------------ engines


def deadly(marker):
    """The task of an engine, whose first worker is killed at work."""

    def count(counting, pieces):
        import os
        import signal

        try:
            os.close(os.open(marker, os.O_CREAT | os.O_EXCL))
        except FileExistsError:
            return counting.pieces(pieces)
        os.kill(os.getpid(), signal.SIGKILL)
        return None

    return count


@pytest.mark.parametrize("cluster", ["dask", "ray"])
def test_engines_and_a_worker_that_is_killed(tmp_path, folder, expected, monkeypatch, cluster):
    pytest.importorskip({"dask": "distributed", "ray": "ray"}[cluster])
    monkeypatch.setenv("HOME", str(tmp_path))
    marker = tmp_path / "killed"
    monkeypatch.setattr(engines, "count", deadly(str(marker)))
    monkeypatch.setattr(engines, "_TASK_ROWS", 1)  # as many tasks as may be, whose parts
    monkeypatch.setattr(engines, "_FAN_IN", 2)  # workers add up by twos
    run = rlvc.fleet.learn_from(folder, cluster=cluster, workers=2, sample=0)
    assert marker.exists()
    expect_same(run, expected)
    assert run.report == rlvc.fleet.learn_from(folder, sample=0).report


@pytest.mark.parametrize(("workers", "rows"), [(1, [5]), (0, [0, 0]), (2, [1] * 100), (3, [9, 1, 0, 4, 100, 7])])
def test_tasks_hold_each_piece_once(monkeypatch, workers, rows):
    pieces = [sources.Piece(str(i), rows=count) for i, count in enumerate(rows)]
    for least, each in ((1, 4), (1000, 1), (10, sum(rows) // (10 * max(1, workers)))):
        monkeypatch.setattr(engines, "_TASK_ROWS", least)
        tasks = engines.tasks_of(pieces, workers)
        assert [piece for task in tasks for piece in task] == pieces
        most = max(1, workers) * min(max(each, 1), 4)
        assert 1 <= len(tasks) <= most
        assert max(sum(piece.rows for piece in task) for task in tasks) <= sum(rows) / most + max(rows)


def test_importing_imports_no_engine():
    program = textwrap.dedent("""
        import sys, rlvc, rlvc.fleet
        found = {"ray", "dask", "distributed", "pyarrow", "fsspec"} & set(sys.modules)
        assert not found, found
    """)
    subprocess.run([sys.executable, "-c", program], check=True)


def test_pieces_hold_some_row_groups(tmp_path, some, monkeypatch):
    monkeypatch.setattr(layout, "GROUP_ROWS", 1000)
    write(tmp_path / "a.parquet", some)
    found = sources.opened(tmp_path)
    assert [len(piece.groups) for piece in found.pieces] == [4] * (COUNT // 4000)
    assert found.rows == COUNT
    assert (found.bits, found.actions) == (18, 4)


# ------------------------------------------------------------------ back to the robots


def test_a_controller_goes_on_from_the_snapshot(tmp_path, folder, some, expected):
    run = rlvc.fleet.learn_from(folder)
    run.agent.save(tmp_path / "agent.rlvc")
    agent = rlvc.Agent.load(tmp_path / "agent.rlvc")
    assert agent.config.capacity == 2000
    assert agent.print("json") == expected.print("json")
    first = worlds.part_of(some, slice(0, 1000))
    agent.observe_many(first.percepts, np.zeros(1000, rlvc.CHOICE), first.rewards, first.next_percepts,
                       np.where(first.ends == 1, 1, 2).astype(np.uint8))  # fmt: skip
    assert agent.learn().done
    agent.check()
    assert agent.classes >= expected.classes
    assert "if" in run.agent.export_c()


def test_the_command(tmp_path, some, expected):
    def rlvc_fleet(*arguments, status=0):
        done = subprocess.run([sys.executable, "-m", "rlvc", "fleet", *map(str, arguments)],
                              capture_output=True, text=True)  # fmt: skip
        assert done.returncode == status, done.stderr
        return done

    np.savez(tmp_path / "log.npz", **worlds.log_of(some))
    files = rlvc_fleet("convert", tmp_path / "log.npz", tmp_path / "log", "--actions", 4,
                       "--file-rows", COUNT // 3).stdout.split()  # fmt: skip
    assert len(files) == 3
    done = rlvc_fleet("learn", *files, "--quiet", "--save", tmp_path / "run", "--c", tmp_path / "policy.h",
                      "--checkpoint", tmp_path / "checkpoint")  # fmt: skip
    assert f"{expected.classes} classes after {COUNT} interactions" in done.stdout
    assert rlvc.load(tmp_path / "run").agent.print("json") == expected.print("json")
    assert "policy_act" in (tmp_path / "policy.h").read_text()
    done = rlvc_fleet("export", *files, tmp_path / "back.npz")
    assert done.stdout == f"{COUNT} interactions\n"
    with np.load(tmp_path / "back.npz") as back:
        np.testing.assert_array_equal(back["actions"], some.actions)
    done = rlvc_fleet("learn", tmp_path / "none", status=1)
    assert done.stderr.count("\n") == 1


@pytest.mark.skipif("RLVC_FLEET_LONG" not in os.environ, reason="takes a minute: RLVC_FLEET_LONG=1")
def test_a_node_that_is_lost(tmp_path, folder, expected, monkeypatch):
    ray = pytest.importorskip("ray")
    from ray.cluster_utils import Cluster

    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("RAY_USAGE_STATS_ENABLED", "0")
    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 0, "include_dashboard": False})
    nodes = [cluster.add_node(num_cpus=1) for _ in range(2)]
    ray.init(cluster.address, log_to_driver=False, logging_level="ERROR")
    begun = tmp_path / "begun"
    begun.mkdir()
    folder_of_marks = str(begun)

    def slow(counting, pieces):
        import time
        import uuid

        with open(f"{folder_of_marks}/{uuid.uuid4()}", "w"):
            time.sleep(0.5)
        return counting.pieces(pieces)

    def lose():
        while len(list(begun.iterdir())) < 3:
            time.sleep(0.05)
        cluster.remove_node(nodes[0], allow_graceful=False)

    monkeypatch.setattr(engines, "count", slow)
    monkeypatch.setattr(engines, "_TASK_ROWS", 1)
    monkeypatch.setattr(engines, "_TASKS", 100)  # a task for each of the 7 files, also by the node that is left
    killer = threading.Thread(target=lose)
    killer.start()
    try:
        run = rlvc.fleet.learn_from(folder, cluster="ray", sample=0)
    finally:
        killer.join()
        ray.shutdown()
        cluster.shutdown()
    expect_same(run, expected)
    assert len(list(begun.iterdir())) > 7 * run.report.passes  # some were done again


def test_a_fleet_is_compacted_by_a_sample(tmp_path, some, folder):
    run = rlvc.fleet.learn_from(folder)
    again = rlvc.fleet.learn_from(shards(tmp_path / "a", some, 3, np.random.default_rng(1)))
    np.testing.assert_array_equal(run.sample, again.sample)
    assert len(np.unique(run.sample, axis=0)) == len(run.sample) == 2000
    file = tmp_path / "checkpoint"
    for _ in range(2):
        kept = rlvc.fleet.learn_from(folder, checkpoint=file, sample=0)
        np.testing.assert_array_equal(kept.sample, run.sample)
    leaves = run.compact().small.info
    assert leaves.leaves < run.agent.classes
    assert leaves.percepts > 40
    assert run.policy() is run.small
    assert again.policy().info.leaves == leaves.leaves
    assert run.agent.statistics.stored == 0
    for percept in run.sample[:500]:
        q = run.agent.q[run.agent.predict(percept).class_id]
        assert q[run.small.act(percept)] >= q.max() - 2 * run.agent.config.tolerance
