# SPDX-License-Identifier: MIT
"""An agent's file is whole whatever happens while it is written, and nothing else is taken for a file.

The test with kills does a thousand of them with

    RLVC_KILLS=1000 python -m pytest -s tests/shim/test_files.py -k kill
"""

import json
import multiprocessing
import os
import random
import resource
import signal
import stat
import subprocess
import sys
import time
import zlib

import numpy as np
import pytest
from conftest import without_vision

import rlvc
from rlvc import __main__ as command
from rlvc import errors, files, plot, report


@pytest.fixture
def agent(walk):
    agent = walk()
    agent.learn()
    return agent


def test_permissions_are_kept(agent, tmp_path):
    file = tmp_path / "agent"
    before = os.umask(0o027)
    try:
        agent.save(file)
        assert stat.S_IMODE(file.stat().st_mode) == 0o640
        file.chmod(0o604)
        agent.save(file)
        assert stat.S_IMODE(file.stat().st_mode) == 0o604
    finally:
        os.umask(before)
    assert os.listdir(tmp_path) == ["agent"]


def test_write_protection_is_respected(agent, tmp_path, monkeypatch):
    agent.save(tmp_path / "agent")
    before = (tmp_path / "agent").read_bytes()
    agent.begin(bytes(1))
    monkeypatch.setattr(os, "access", lambda *_, **__: False)  # root may write anything
    with pytest.raises(errors.StoreError, match="write-protected"):
        agent.save(tmp_path / "agent")
    assert (tmp_path / "agent").read_bytes() == before
    agent.save(tmp_path / "other")


def others(folder):
    """What is no file."""
    (folder / "file").write_text("precious", encoding="utf-8")
    (folder / "link").symlink_to("file")
    (folder / "dangling").symlink_to("none")
    os.mkfifo(folder / "fifo")
    (folder / "folder").mkdir()
    return [folder / name for name in ("link", "dangling", "fifo", "folder")]


def test_links_and_devices_are_not_replaced(agent, tmp_path):
    paths = others(tmp_path)
    for path in (*paths, "/dev/null", "/dev/full", tmp_path / "none" / "agent"):
        with pytest.raises(errors.StoreError, match="cannot be written: "):
            agent.save(path)
    assert sorted(os.listdir(tmp_path)) == sorted(["file", *(path.name for path in paths)])
    assert (tmp_path / "file").read_text(encoding="utf-8") == "precious"
    assert os.readlink(tmp_path / "dangling") == "none"


@pytest.mark.parametrize("name", ["a\0b", "", None, 7, 2.5, ["a"]], ids=repr)
def test_what_is_no_name(agent, name):
    for call in (agent.save, rlvc.Agent.load):
        with pytest.raises(errors.StoreError, match="name"):
            call(name)


READERS = {
    "agent": rlvc.Agent.load,
    "report": report.read,
    "npz": rlvc.learn_from,
    "csv": rlvc.learn_from,
    "log": rlvc.learn_from,
}


@pytest.mark.parametrize("kind", READERS)
def test_what_is_read_is_a_file(tmp_path, kind):
    """A FIFO would wait for its writer for ever."""
    fifo = tmp_path / f"fifo.{kind}"
    os.mkfifo(fifo)
    with pytest.raises(errors.Error, match="it is a FIFO"):
        READERS[kind](fifo)
    for other in ("/dev/zero", tmp_path):
        with pytest.raises(errors.Error):
            READERS[kind](other)


@pytest.mark.skipif(bool(without_vision()), reason="the package was made without vision")
def test_pictures_and_metrics_are_files(tmp_path):
    from rlvc import objects, vision

    os.mkfifo(tmp_path / "a.png")
    with pytest.raises(errors.PictureError, match=r"a\.png: not a regular file"):
        objects.find(tmp_path)
    with pytest.raises(errors.StoreError, match="FIFO"):
        vision.Metric.load(tmp_path / "a.png")


def test_what_is_written_is_a_file(agent, tmp_path):
    for name in ("a.png", "a.svg"):
        os.mkfifo(tmp_path / name)
        with pytest.raises(errors.StoreError, match="FIFO"):
            plot.tree(agent, tmp_path / name)
    os.mkfifo(tmp_path / "a.h")
    agent.save(tmp_path / "agent")
    assert command.main(["export", str(tmp_path / "agent"), "--c", str(tmp_path / "a.h")]) == 1


def test_a_full_disk_leaves_the_old_file(agent, tmp_path):
    file = tmp_path / "agent"
    agent.save(file)
    before, limit = file.read_bytes(), resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, limit[1]))
    try:
        with pytest.raises(errors.StoreError, match="File too large"):
            agent.save(file)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limit)
    assert file.read_bytes() == before
    assert os.listdir(tmp_path) == ["agent"]


@pytest.mark.parametrize("nameless", [True, False])
def test_what_a_killed_process_left_is_removed_and_nothing_else(
    agent, tmp_path, monkeypatch, nameless
):
    if not nameless:
        monkeypatch.delattr(os, "O_TMPFILE", raising=False)
    file = tmp_path / "agent"
    beginning = files._beginning("agent")
    kept = {"agent", files._beginning("other") + "0", ".rlvc", f"x{beginning}0", f"{beginning}busy"}
    for call in (lambda: agent.save(file), lambda: rlvc.Agent.load(file)):
        for name in (*kept - {"agent"}, f"{beginning}1", f"{beginning}2"):
            (tmp_path / name).write_bytes(b"half")
        with open(tmp_path / f"{beginning}busy", "rb") as busy:
            files._lock(busy, files.fcntl.LOCK_EX)
            call()
            assert set(os.listdir(tmp_path)) == kept
    assert stat.S_ISREG(file.stat().st_mode)


def test_the_head_is_checked(tmp_path):
    domain = rlvc.Descriptors(4, 2, 0.5)
    file = tmp_path / "agent"
    rlvc.Agent(domain, 2).save(file, ["one"])
    whole = file.read_bytes()
    for before, after in ((b"[4, 2, 0.5", b"[4, 2, 0.1"), (b'"one"', b'"two"')):
        assert before in whole
        file.write_bytes(whole.replace(before, after))
        with pytest.raises(errors.SnapshotError, match="checksum"):
            rlvc.Agent.load(file)


def sealed(head, snapshot, version=2):
    text = head if isinstance(head, bytes) else json.dumps(head).encode()
    content = b"rlvc agent %d\n%b\n%b" % (version, text, snapshot)
    return content + (zlib.crc32(content).to_bytes(4, "little") if version != 1 else b"")


def test_a_forged_head_is_an_error(agent, tmp_path):
    file = tmp_path / "agent"
    agent.save(file, ["a", "b", "c"])
    content = file.read_bytes()[:-4]
    line, snapshot = content.split(b"\n", 2)[1:]
    head = json.loads(line)

    def config(**changes):
        return {**head, "config": {**head["config"], **changes}}

    forged = [
        [], None, 7, b"[" * 200_000, b'{"bits":' + b"9" * 5000 + b"}", b"\xff\xfe",
        *({**head, "bits": value} for value in ([3], 10**30, {}, 3.5, "3", True, -1, float("inf"))),
        *({**head, "bits": None, "descriptors": value} for value in (
            5, ["a"] * 7, [2**32 + 4, 2, 0.5], [4, 2, "x"], [4, 2, 1e400], [1, 2], [4, 2, 0.5, 9])),
        *({**head, "bits": None, "thresholds": value} for value in (
            [float("nan")] * 3, [-1, 15, False], [2**32 + 2], [2, -1], [2, 15, "yes"], "ab", {})),
        {**head, "names": 5}, {**head, "config": "x"}, config(none=1), config(capacity=[1]),
        config(capacity=1_900_000_000), config(discount=float("nan")), config(score=[]),
        {key: value for key, value in head.items() if key != "bytes"}, {**head, "bytes": "all"},
    ]  # fmt: skip
    for other in forged:
        file.write_bytes(sealed(other, snapshot))
        with pytest.raises(errors.Error, match="agent"):
            rlvc.Agent.load(file)
    file.write_bytes(sealed(head, snapshot, version=3))
    with pytest.raises(errors.SnapshotError, match="version 3"):
        rlvc.Agent.load(file)
    for version in (1, 2):
        file.write_bytes(sealed(head, snapshot, version))
        assert rlvc.Agent.load(file).snapshot() == agent.snapshot()


def test_numbers_of_numpy_are_saved(tmp_path):
    domain = rlvc.Descriptors(np.int64(4), np.uint8(2), np.float32(0.5))
    agent = rlvc.Agent(
        domain, rlvc.Config(np.int64(2), seed=np.uint32(3), discount=np.float32(0.5))
    )
    agent.save(tmp_path / "agent")
    assert rlvc.Agent.load(tmp_path / "agent").snapshot() == agent.snapshot()


def save_for_ever(file, snapshot, config, begin):
    agent = rlvc.Agent.restore(3, config, snapshot)
    begin.wait()
    while True:
        agent.begin(bytes(1))
        agent.observe(agent.act(), 0.0, bytes(1))
        agent.save(file)


def test_two_savers_that_are_killed(agent, tmp_path):
    """Two at once: every load in between succeeds, and nothing else is in the folder."""
    file, drawn = tmp_path / "agent", random.Random(1)
    agent.save(file)
    context, loads = multiprocessing.get_context("fork"), 0
    for _ in range(int(os.environ.get("RLVC_KILLS", "20")) // 2):
        begin = context.Barrier(3)
        arguments = (file, agent.snapshot(), agent.config, begin)
        savers = [context.Process(target=save_for_ever, args=arguments) for _ in range(2)]
        for saver in savers:
            saver.start()
        begin.wait()
        for saver in savers:
            time.sleep(drawn.uniform(0, 0.05))
            rlvc.Agent.load(file)
            assert saver.is_alive()
            os.kill(saver.pid, signal.SIGKILL)
            saver.join()
            rlvc.Agent.load(file).check()
            loads += 2
    assert os.listdir(tmp_path) == ["agent"]
    print(f"{loads} loads")


def test_a_system_without_locks(agent, tmp_path, monkeypatch):
    """Saving still replaces files as a whole, and refuses what is no file."""
    monkeypatch.setattr(files, "fcntl", None)
    path = tmp_path / "agent"
    agent.save(path)
    path.chmod(0o640)
    agent.save(path)
    assert rlvc.Agent.load(path).snapshot() == agent.snapshot()
    assert path.stat().st_mode & 0o777 == 0o640
    (tmp_path / "link").symlink_to(path)
    for wrong in (tmp_path, tmp_path / "link", tmp_path / "none/agent", "/dev/null"):
        with pytest.raises(errors.StoreError):
            agent.save(wrong)
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["agent", "link"]


def test_the_package_needs_no_locks():
    program = "import sys; sys.modules['fcntl'] = None; import rlvc; assert rlvc.files.fcntl is None"
    subprocess.run([sys.executable, "-B", "-c", program], check=True)
