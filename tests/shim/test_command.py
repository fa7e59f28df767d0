# SPDX-License-Identifier: MIT
"""``python -m rlvc``: what goes wrong is told in one line, and what was learnt is kept."""

import json
import os
import signal
import subprocess
import sys
import textwrap

import pytest

import rlvc
from rlvc import __main__ as command
from rlvc.cli import parser


def started(*arguments, cwd=None, **options):
    names = ("PYTHONPATH", "RLVC_PYTHON_LIBRARY", "PATH", "HOME")
    return subprocess.Popen(
        [sys.executable, "-B", "-m", "rlvc", *map(str, arguments)], text=True, cwd=cwd,
        env={name: os.environ[name] for name in names if name in os.environ},
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options,
    )  # fmt: skip


@pytest.fixture
def saved(walk, tmp_path):
    agent = walk()
    agent.learn()
    agent.save(tmp_path / "agent")
    return tmp_path / "agent"


WRONG = [
    [], ["fly"], ["learn"], ["learn", "--interactions", "many"], ["learn", "FrozenLake-v1", "--interactions", "0"],
    ["learn", "FrozenLake-v1", "--seed", "-1"], ["learn", "FrozenLake-v1", "--seed", str(2**70)],
    ["learn", "FrozenLake-v1", "--discount", "2"], ["learn", "FrozenLake-v1", "--discount", "x"],
    ["learn", "FrozenLake-v1", "--solver", "guess"], ["learn", "FrozenLake-v1", "--log", "x"],
    ["learn", "FrozenLake-v1", "--columns", "x"], ["learn", "none.csv", "--env-arg", "a=1"],
    ["learn", "NoSuchLake-v1"], ["learn", ""], ["learn", "no_such_module:Lake-v1"], ["learn", "a b c"],
    ["learn", "--log", "none.csv"], ["learn", "--log", "none.npz"], ["learn", "--log", "/dev/null"],
    ["show", "none"], ["show", "/dev/zero"], ["export", "none"], ["export", "none", "--c", "x"],
    ["plot", "none", "tree", "x.png"], ["plot", "none", "none", "x.png"],
]  # fmt: skip


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("arguments", WRONG, ids=" ".join)
def test_wrong_arguments_are_told_in_one_line(arguments, capsys, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    try:
        status = command.main([*arguments, *(["--quiet"] if "learn" in arguments else [])])
    except SystemExit as end:
        status = end.code
    told = capsys.readouterr()
    assert status in (1, 2)
    assert told.out == ""
    assert told.err.startswith("rlvc: ")
    assert told.err.count("\n") == 1
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["learn", "x", "--interactions", "many"], "--interactions: 'many' is not a whole number of at least 1"),
        (["learn", "x", "--capacity", "1.5"], "--capacity: '1.5' is not a whole number"),
        (["learn", "x", "--bins", "2,b"], "--bins: '2,b' is not a whole number, or a list A,B,..."),
        (["learn", "x", "--discount", "x"], "--discount: 'x' is not a number"),
        (["learn", "x", "--successors", "perhaps"], "--successors: 'perhaps' is not one of yes, no"),
        (["learn", "x", "--score", "guess"], "--score: 'guess' is not one of gain, ranks"),
        (["learn", "x", "--names", ""], "--names: '' has an empty name"),
        (["learn", "x", "--columns", "a,,b"], "--columns: 'a,,b' has an empty name"),
        (["learn", "x", "--roles", "action"], "--roles: 'action' is not ROLE=COLUMN"),
        (["fleet", "learn", "x", "--workers", "0"], "--workers: '0' is not a whole number of at least 1"),
        (["fleet", "learn", "x", "--reward-grid", "x"], "--reward-grid: 'x' is not a number"),
        (["fleet", "learn", "x", "--method", "guess"], "--method: 'guess' is not one of classes, planner"),
    ],
)  # fmt: skip
def test_values_of_a_kind_are_refused_in_the_same_words(arguments, said, capsys):
    with pytest.raises(SystemExit):
        command.main(arguments)
    assert f"rlvc: {said}; python -m rlvc" in capsys.readouterr().err


@pytest.mark.parametrize(
    "report",
    ["[" * 100_000, "{}", "[]", '{"version": 2}', '{"version": 1, "tree": 5}', '{"version": 1, "runs": 7}',
     '{"version": 1, "tree": {"nodes": [{}]}}', "\xff", "", "NaN", '{"version": 1, "history": [1]}'],
    ids=range(11),
)  # fmt: skip
@pytest.mark.parametrize("kind", parser.FIGURES)
def test_damaged_reports(report, kind, capsys, tmp_path):
    (tmp_path / "run.json").write_bytes(report.encode("latin1"))
    arguments = ["plot", str(tmp_path / "run.json"), kind, str(tmp_path / "a.svg")]
    assert command.main(arguments) == 1
    told = capsys.readouterr().err
    assert told.startswith("rlvc: ")
    assert told.count("\n") == 1


def test_a_pipe_that_is_closed(saved):
    read, write = os.pipe()
    os.close(read)
    for arguments in (["show", saved], ["export", saved, "--c", "-"], ["--help"]):
        process = started(*arguments)
        process.stdout.close()
        _, told = process.communicate()
        assert told == ""
        assert process.returncode in (0, 141)
    os.close(write)


def test_what_is_learnt_is_written_though_nobody_reads(tmp_path):
    log = tmp_path / "log.csv"
    log.write_text("x,action,reward,terminated\n" + "1,0,0,1\n2,0,1,1\n" * 40, encoding="utf-8")
    names = [tmp_path / name for name in ("agent", "run.json", "policy.h")]
    files = zip(("--save", "--json", "--c"), names, strict=True)
    process = started("learn", "--log", log, *(part for pair in files for part in pair))
    process.stdout.close()
    _, told = process.communicate()
    assert (process.returncode, told) == (141, "")
    assert rlvc.load(names[0]).agent.classes == 2
    assert json.loads(names[1].read_text(encoding="utf-8"))["classes"] == 2
    assert "policy_act" in names[2].read_text(encoding="utf-8")


def test_output_to_a_full_disk(saved):
    with open("/dev/full", "w", encoding="utf-8") as full:
        done = subprocess.run(
            [sys.executable, "-B", "-m", "rlvc", "show", saved], stdout=full, stderr=subprocess.PIPE,
            text=True, check=False,
        )  # fmt: skip
    assert "No space left" in done.stderr.splitlines()[0]
    assert done.returncode != 0


MODULE = """
    import os, signal
    import gymnasium
    from gymnasium import spaces

    class Lake(gymnasium.Env):
        observation_space, action_space = spaces.Discrete(4), spaces.Discrete(2)
        steps = 0

        def reset(self, *, seed=None, options=None):
            super().reset(seed=seed)
            self.place, self.left = 0, 5
            return 0, {}

        def step(self, action):
            Lake.steps += 1
            if Lake.steps == 450:
                FAULT
            self.place, self.left = (self.place + 2 * action - 1) % 4, self.left - 1
            return self.place, float(self.place == 2), self.left == 0, False, {}

    gymnasium.register("Lake-v0", Lake)
"""
FAULTS = {
    "os.kill(os.getpid(), signal.SIGINT)": (130, "rlvc: interrupted: the result is incomplete\n"),
    "raise ZeroDivisionError('here')": (1, "rlvc: interaction 449, episode 89: step(0) of the environment raised ZeroDivisionError: here\n"),
    "return 0, None, False, False, {}": (
        1, "rlvc: interaction 449, episode 89: reward: None is not a number: give a float\n"),
}  # fmt: skip


@pytest.mark.parametrize("fault", FAULTS)
def test_what_was_learnt_is_kept(fault, tmp_path):
    """Also when Ctrl-C, or the environment, ends it."""
    (tmp_path / "lake.py").write_text(
        textwrap.dedent(MODULE).replace("FAULT", fault), encoding="utf-8"
    )
    arguments = (
        "learn",
        "lake:Lake-v0",
        "--interactions",
        1000,
        "--quiet",
        "--save",
        "agent",
        "--json",
        "run.json",
    )
    process = started(
        *arguments,
        cwd=tmp_path,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    out, told = process.communicate()
    assert (process.returncode, told) == FAULTS[fault]
    assert "classes after 4" in out
    assert rlvc.load(tmp_path / "agent").interactions in (449, 450)
    report = json.loads((tmp_path / "run.json").read_text(encoding="utf-8"))
    assert report["history"][-1]["interactions"] == 400


def test_policies_are_printed(saved, capsys):
    assert command.main(["export", str(saved), "--c", "-"]) == 0
    assert "policy_act" in capsys.readouterr().out


def test_fewer_names_than_bits(walk, tmp_path, capsys):
    agent = walk()
    agent.learn()
    agent.save(tmp_path / "agent", ["low"])
    assert command.main(["show", str(tmp_path / "agent")]) == 0
    shown = capsys.readouterr().out
    assert "low?" in shown
    assert "bit 2?" in shown
    for names in (5, "low", [1], None):
        with pytest.raises(rlvc.errors.ConfigError, match="names"):
            agent.save(tmp_path / "agent", names)


def test_the_commands_do_what_the_package_does(tmp_path, capsys):
    run, lake = str(tmp_path / "run"), ["FrozenLake-v1", "--env-arg", "is_slippery=False"]
    learn = ["learn", *lake, "--quiet", "--discount", "0.9", "--interactions", "2000"]
    assert command.main([*learn, "--save", run, "--compact", "--capacity", "5000"]) == 0
    assert "5 leaves after 2000" in capsys.readouterr().out
    kept = rlvc.load(run)
    assert kept.agent.config.capacity == 5000
    assert command.main(["evaluate", run, *lake, "--episodes", "3"]) == 0
    assert "return 1 +- 0 (3 episodes)" in capsys.readouterr().out
    assert command.main(["explain", run, "14"]) == 0
    assert capsys.readouterr().out == f"{kept.explain(14)}\n"
    assert command.main(["importances", run]) == 0
    assert "number" in capsys.readouterr().out
    assert command.main(["export", run, "--c", "-", "--name", "lake"]) == 0
    assert capsys.readouterr().out == kept.export_c(name="lake")
    assert (
        command.main(
            ["learn", *lake, "--run", run, "--interactions", "500", "--save", run, "--quiet"]
        )
        == 0
    )
    assert rlvc.load(run).interactions == 2500
    assert command.main(["explain", run, "{"]) == 1
    assert command.main(["evaluate", run, "FrozenLake-v1", "--env-arg", "slippery"]) == 1
    assert "NAME=VALUE" in capsys.readouterr().err


def test_logs_are_shown_and_converted(tmp_path, capsys):
    log = tmp_path / "log.csv"
    rows = "1,5;left;0;1\n1,5;right;1;1\n2,5;right;0;1\n2,5;left;1;1\n"
    log.write_text("x;a;r;done\n" + rows * 40, encoding="utf-8")
    assert command.main(["log", str(log)]) == 0
    shown = capsys.readouterr().out
    assert "2 actions: left, right" in shown
    assert "decimal comma" in shown
    assert command.main(["convert", str(log), str(tmp_path / "log.npz")]) == 0
    capsys.readouterr()
    for file in (log, tmp_path / "log.npz"):
        assert command.main(["learn", "--log", str(file)]) == 0
    assert "x > 2" in capsys.readouterr().out
    episodes = "x,a,r,done,episode\n" + "".join(f"1,0,0,0,{i}\n" for i in range(5)) + "1,0,0,1,9\n"
    log.write_text(episodes, encoding="utf-8")
    assert command.main(["learn", "--log", str(log)]) == 0
    assert "5 interactions are left out" in capsys.readouterr().err


LOG = "x,a,r,done\n" + "1,0,0,1\n1,1,1,1\n" * 20


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["learn", "log.csv", "--json", "log.csv"], "--json: log.csv is also the log"),
        (["learn", "log.csv", "--save", "./log.csv"], "--save: ./log.csv is also the log"),
        (["learn", "log.csv", "--c", "link.csv"], "it is a link, not a file"),
        (["learn", "log.csv", "--c", "a", "--json", "a"], "--c: a is also the file of --json"),
        (["learn", "log.csv", "--save", ""], "'': cannot be written: not the name of a file"),
        (["learn", "FrozenLake-v1", "--save", "no/run"], "no/run: cannot be written: No such file or directory"),
        (["learn", "FrozenLake-v1", "--json", "folder"], "folder: cannot be written: it is a folder, not a file"),
        (["learn", "FrozenLake-v1", "--c", "folder/old/x"], "folder/old/x: cannot be written: Not a directory"),
        (["learn", "FrozenLake-v1", "--save", "pipe"], "pipe: cannot be written: it is a FIFO, not a file"),
        (["fleet", "learn", "log.csv", "--save", "log.csv"], "--save: log.csv is also the log"),
        (["convert", "log.csv", "other.csv"], "other.csv: is written, so that its name has to end in .npz"),
        (["convert", "log.csv", "no/log.npz"], "no/log.npz: cannot be written: No such file or directory"),
    ],
)  # fmt: skip
def test_files_are_checked_before_the_work(arguments, said, tmp_path, monkeypatch, capsys):
    """What takes hours must not end by the name of a file, nor replace its own log."""
    monkeypatch.chdir(tmp_path)
    for name in ("log.csv", "other.csv", "folder/old"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(LOG, encoding="utf-8")
    (tmp_path / "link.csv").symlink_to("log.csv")
    os.mkfifo(tmp_path / "pipe")
    monkeypatch.setattr("rlvc.cli.commands.learn", None)  # is not called
    before = sorted(path.name for path in tmp_path.rglob("*"))
    assert command.main(arguments) == 1
    assert said in capsys.readouterr().err
    assert sorted(path.name for path in tmp_path.rglob("*")) == before
    assert {(tmp_path / name).read_text() for name in ("log.csv", "other.csv")} == {LOG}


def test_several_files_of_logs(tmp_path, capsys):
    """Files are told from environments, and learnt from as one log."""
    files = []
    for number in (1, 2):
        rows = [f"{number},{action},{float(action == number - 1)},1" for action in (0, 1)]
        file = tmp_path / f"{number}.csv"
        file.write_text("\n".join(["x,action,reward,done", *50 * rows]) + "\n", encoding="utf-8")
        files.append(str(file))
    assert command.main(["learn", *files, "--discount", "0.5"]) == 0
    assert "2 classes after 200 interactions" in capsys.readouterr().out
    assert command.main(["learn", files[0]]) == 0
    assert "1 class after 100 interactions" in capsys.readouterr().out
    assert command.main(["log", *files]) == 0
    assert "1.csv and 1 more: 200 interactions" in capsys.readouterr().out
    assert command.main(["learn", str(tmp_path / "none.csv")]) == 1
    assert "none.csv: cannot be read" in capsys.readouterr().err


def test_roles_and_the_past(tmp_path, capsys):
    (tmp_path / "log.csv").write_text("druck,ventil,lohn,ende\n" + "1,0,0,0\n5,1,1,0\n1,1,1,1\n" * 40, encoding="utf-8")
    log, run = str(tmp_path / "log.csv"), str(tmp_path / "run")
    assert command.main(["log", log]) == 1
    assert "roles={'action': ..., 'reward': ...}" in capsys.readouterr().err
    roles = ["--roles", "action=ventil,reward=lohn,terminated=ende"]
    assert command.main(["log", log, *roles]) == 0
    assert "action: ventil" in capsys.readouterr().out
    learn = ["learn", "--log", log, *roles, "--history", "2", "--discount", "0.5", "--save", run]
    assert command.main(learn) == 0
    names = rlvc.load(run).encoder.names
    assert names[:2] == ["now.druck", "1 ago.druck"]
    assert names[2].startswith("action 1 ago")
    pytest.importorskip("gymnasium")
    lake = ["FrozenLake-v1", "--env-arg", "is_slippery=False", "--history", "2"]
    played = ["--episodes", "5"]
    assert command.main(["learn", *lake, "--interactions", "500", "--quiet", "--save", run, *played]) == 0
    assert command.main(["evaluate", run, *lake, *played]) == 0
    assert command.main(["evaluate", run, *lake[:-2], *played]) == 1
    assert "its observations, 3 numbers, are not those of Discrete(16)" in capsys.readouterr().err


def test_several_seeds(capsys):
    pytest.importorskip("gymnasium")
    lake = ["learn", "FrozenLake-v1", "--env-arg", "is_slippery=False", "--quiet", "--interactions", "1500"]
    assert command.main([*lake, "--seed", "4", "--seeds", "2", "--discount", "0.9", "--episodes", "3"]) == 0
    told = capsys.readouterr().out.splitlines()
    assert [line.split(":")[0] for line in told] == ["seed 4", "seed 5", "2 seeds"]
    assert told[0].startswith("seed 4: return 1 +- 0 (3 episodes); ")
    assert command.main([*lake, "--seeds", "2", "--save", "run"]) == 1
    assert "leave --save out" in capsys.readouterr().err
