# SPDX-License-Identifier: MIT
"""A process that is killed while it saves, at each moment, leaves the old file or the new one, and
nothing else.

``test_files.py`` kills at random moments, and two savers at once.
"""

import os
import pathlib
import signal
import subprocess
import sys

import pytest

import rlvc
from rlvc import files

NAMELESS = sys.platform == "linux"
SAVER = """
import os, sys, rlvc
os.setpgid(0, 0)
os.environ["RLVC_SAVER"] = str(os.getpid())
agent = rlvc.Agent.load(sys.argv[1])
agent.begin(bytes(1))
agent.save(sys.argv[1])
"""


def killed_before(number, work):
    """Do the work in another process, which is killed before its n-th call of a C function in files.py.

    Returns whether it was killed, and so has more calls.
    """
    process = os.fork()
    if process == 0:
        calls = 0

        def watch(frame, event, _argument):
            nonlocal calls
            if event == "c_call" and frame.f_code.co_filename == files.__file__:
                if calls == number:
                    os.kill(os.getpid(), signal.SIGKILL)
                calls += 1

        sys.setprofile(watch)
        work()
        os._exit(0)
    status = os.waitpid(process, 0)[1]
    assert status in (0, signal.SIGKILL)
    return status == signal.SIGKILL


@pytest.mark.parametrize("replaced", [True, False])
@pytest.mark.parametrize("nameless", [NAMELESS, False])
def test_a_kill_at_each_call(tmp_path, monkeypatch, replaced, nameless):
    if not nameless:
        monkeypatch.delattr(os, "O_TMPFILE", raising=False)
    file, old, new = tmp_path / "agent", rlvc.Agent(3, 2), rlvc.Agent(3, 2)
    new.begin(bytes(1))
    number, ends = 0, set()
    while True:
        file.unlink(missing_ok=True)
        if replaced:
            old.save(file)
        killed = killed_before(number, lambda: new.save(file))
        assert not nameless or set(os.listdir(tmp_path)) <= {"agent"}, f"call {number}"
        assert len(os.listdir(tmp_path)) <= 2
        files.tidy(file)
        assert set(os.listdir(tmp_path)) <= {"agent"}, f"call {number}"
        ends.add(rlvc.Agent.load(file).snapshot() if file.exists() else None)
        if not killed:
            break
        number += 1
    assert number > 10
    assert ends == {old.snapshot() if replaced else None, new.snapshot()}


@pytest.mark.skipif(not NAMELESS, reason="of Linux: files without a name")
def test_a_kill_between_naming_and_replacing(tmp_path):
    """The one moment at which two files have names: what was begun is ended."""
    library = tmp_path / "kill_saver.so"
    source = pathlib.Path(__file__).with_name("kill_saver.c")
    subprocess.run(["cc", "-shared", "-fPIC", "-o", library, source], check=True)
    folder = tmp_path / "folder"
    folder.mkdir()
    agent = rlvc.Agent(3, 2)
    agent.save(folder / "agent")
    before = agent.snapshot()
    environment = {**os.environ, "LD_PRELOAD": os.environ.get("LD_PRELOAD", "") + f" {library}"}
    ended, held = os.pipe()  # whoever still works holds it open
    saver = subprocess.Popen(
        [sys.executable, "-c", SAVER, folder / "agent"], pass_fds=[held], env=environment
    )
    os.close(held)
    assert saver.wait() == -signal.SIGKILL
    assert os.read(ended, 1) == b""
    os.close(ended)
    assert os.listdir(folder) == ["agent"]
    assert rlvc.Agent.load(folder / "agent").snapshot() != before


@pytest.mark.skipif(not NAMELESS, reason="of Linux: files without a name")
def test_what_cannot_be_named(tmp_path, monkeypatch):
    agent = rlvc.Agent(3, 2)
    agent.save(tmp_path / "agent")
    before = (tmp_path / "agent").read_bytes()
    agent.begin(bytes(1))
    monkeypatch.setattr(files.secrets, "token_hex", lambda _bytes: "x" * 300)
    with pytest.raises(rlvc.errors.StoreError, match="File name too long"):
        agent.save(tmp_path / "agent")
    assert (tmp_path / "agent").read_bytes() == before
    assert os.listdir(tmp_path) == ["agent"]
