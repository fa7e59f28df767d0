# SPDX-License-Identifier: MIT
"""The command line of run_gridworld: what it prints, writes, refuses and leaves behind.

RLVC_RUN_GRIDWORLD is the path of the program. Short runs; none depends on the clock.
"""
import itertools
import json
import os
import pty
import re
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

PROGRAM = os.environ["RLVC_RUN_GRIDWORLD"]
MAZES = Path(__file__).resolve().parents[2] / "examples" / "gridworld" / "mazes"
ACTIONS = {"up": (0, -1), "right": (1, 0), "down": (0, 1), "left": (-1, 0)}
ENVIRONMENT = {**os.environ, "LC_ALL": "C.UTF-8"}


def run(*arguments, cwd, env=None, **more):
    return subprocess.run([PROGRAM, *map(str, arguments)], cwd=cwd, env=env or ENVIRONMENT,
                          capture_output=True, text=True, timeout=300, **more)


def report(*arguments, cwd):
    """The JSON report of a run that must succeed."""
    done = run("binary", *arguments, "--json", "report.json", cwd=cwd)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    return json.loads((cwd / "report.json").read_text())


def files(folder):
    return sorted(path.name for path in folder.iterdir())


# ------------------------------------------------------------------------- asking

@pytest.mark.parametrize("arguments", [["--help"], ["binary", "--help"]])
def test_help(tmp_path, arguments):
    done = run(*arguments, cwd=tmp_path)
    assert done.returncode == 0 and done.stderr == ""
    assert "binary" in done.stdout


def test_help_names_every_option(tmp_path):
    text = run("binary", "--help", cwd=tmp_path).stdout
    for option in ("solver criterion score interactions steps discount epsilon alpha alpha-known smallest-effect successors seed runs maze legend slip distractors "
                   "classes capacity json dot export-c help version").split():
        assert re.search(rf"--{option}\b", text), option


@pytest.mark.parametrize("arguments", [["--version"], ["binary", "--version"]])
def test_version(tmp_path, arguments):
    done = run(*arguments, cwd=tmp_path)
    assert done.returncode == 0 and done.stderr == ""
    assert re.fullmatch(r"run_gridworld \d+\.\d+\.\d+\n", done.stdout)


# ------------------------------------------------------------------------- refusing

def check_refused(done, *parts):
    assert done.returncode == 2
    assert done.stderr.startswith("run_gridworld: ")
    assert done.stderr.count("\n") == 1 and done.stderr.endswith("\n"), done.stderr
    for part in parts:
        assert part in done.stderr


@pytest.mark.parametrize("arguments, parts", [
    ([], ["binary"]),
    (["tilde"], ["tilde"]),
    (["binary", "--colour"], ["--colour"]),
    (["binary", "more"], ["more"]),
    (["binary", "--discount"], ["--discount: takes one value"]),
    (["binary", "--runs", "2", "--runs", "3"], ["--runs: takes one value, once"]),
    (["binary", "--solver", "dreamer"], ["--solver", "'dreamer'", "policy-iteration", "sarsa"]),
    (["binary", "--solver", ""], ["--solver", "''"]),
    (["binary", "--gamma", "1"], ["--discount", "'1'", "[0, 1)"]),  # the old name
    (["binary", "--discount", "1"], ["--discount", "'1'", "[0, 1)"]),
    (["binary", "--discount", "0.99999999999"], ["--discount"]),  # is 1 in binary32
    (["binary", "--discount", "-0.1"], ["--discount"]),
    (["binary", "--discount", "nan"], ["--discount", "nan"]),
    (["binary", "--discount", "0.9x"], ["--discount", "0.9x"]),
    (["binary", "--epsilon", "1.1"], ["--epsilon", "[0, 1]"]),
    (["binary", "--epsilon", "NaN"], ["--epsilon"]),
    (["binary", "--epsilon", "inf"], ["--epsilon"]),
    (["binary", "--alpha", "0"], ["--alpha", "(0, 1]"]),
    (["binary", "--alpha", "1e-60"], ["--alpha"]),  # is 0 in binary32
    (["binary", "--alpha", "nan"], ["--alpha"]),
    (["binary", "--alpha-known", "2"], ["--alpha-known", "(0, 1]"]),
    (["binary", "--smallest-effect", "-1"], ["--smallest-effect", "[0, 1e+12]"]),
    (["binary", "--successors", "maybe"], ["--successors", "yes", "no"]),
    (["binary", "--slip", "2"], ["--slip"]),
    (["binary", "--slip", "nan"], ["--slip"]),
    (["binary", "--slip", ""], ["--slip"]),
    (["binary", "--criterion", "best"], ["--criterion", "best", "returns", "residual"]),
    (["binary", "--score", "ranking"], ["--score", "'ranking'", "gain", "ranks"]),
    (["binary", "--score", "ranks", "--capacity", "2097152"], ["ranks", "2^21"]),
    (["binary", "--interactions", "0"], ["--interactions"]),
    (["binary", "--interactions", "-5"], ["--interactions", "-5"]),
    (["binary", "--interactions", "1e3"], ["--interactions", "1e3"]),
    (["binary", "--interactions", "2147483648"], ["--interactions"]),
    (["binary", "--interactions", "99999999999999999999999"], ["--interactions"]),
    (["binary", "--steps", "0"], ["--steps"]),
    (["binary", "--steps", "20", "--interactions", "10"], ["--steps", "only 10 interactions"]),
    (["binary", "--seed", "4294967296"], ["--seed"]),
    (["binary", "--seed", "one"], ["--seed", "one"]),
    (["binary", "--runs", "0"], ["--runs"]),
    (["binary", "--classes", "0"], ["--classes"]),
    (["binary", "--classes", "65536"], ["--classes"]),
    (["binary", "--capacity", "0"], ["--capacity"]),
    (["binary", "--distractors", "1025"], ["--distractors"]),
    (["binary", "--distractors", "1018"], ["--distractors", "1017"]),
    (["binary", "--runs", "2", "--dot", "tree.dot"], ["--dot", "--runs"]),
    (["binary", "--json", "same", "--dot", "same"], ["--dot", "--json", "same"]),
    (["binary", "--runs", "2", "--export-c", "maze.h"], ["--export-c", "--runs"]),
    (["binary", "--dot", "same", "--export-c", "same"], ["--export-c", "--dot", "same"]),
    (["binary", "--json", ""], ["--json"]),
    (["binary", "--maze", "absent.txt"], ["--maze", "absent.txt", "No such file"]),
    (["binary", "--maze", "."], ["--maze", "'.'", "directory"]),
    (["binary", "--json", "absent/report.json"], ["--json", "absent/report.json", "No such file"]),
    (["binary", "--dot", "absent/tree.dot"], ["--dot", "absent/tree.dot"]),
    (["binary", "--json", "/"], ["--json", "'/'", "directory"]),
])
def test_impossible_options(tmp_path, arguments, parts):
    done = run(*arguments, cwd=tmp_path)
    check_refused(done, *parts)
    assert done.stdout == "", "it is said before the work begins"
    assert files(tmp_path) == []


@pytest.mark.parametrize("text, place", [
    ("", "maze.txt: "),
    ("..\n..\n", "maze.txt: "),
    ("..\n.x\n.*\n", "maze.txt:2:2: "),
    ("...\n.*\n", "maze.txt:2:3: "),
    ("..*\n###\n#.#\n", "maze.txt:3:2: "),
    ("." * 257 + "*\n", "maze.txt:1:257: "),
    ("*." + "\n.." * 300, "maze.txt:257:1: "),
    ("\x00\x01", "maze.txt:1:1: "),
])
def test_broken_mazes(tmp_path, text, place):
    (tmp_path / "maze.txt").write_text(text)
    done = run("binary", "--maze", "maze.txt", "--json", "report.json", cwd=tmp_path)
    check_refused(done, place)
    assert done.stdout == ""
    assert files(tmp_path) == ["maze.txt"]


PLAIN = ["..#*", ".#..", "...."]


@pytest.mark.parametrize("text", [
    "..#*\r\n.#..\r\n....\r\n",
    "..#*\r.#..\r....",
    "\ufeff..#*\n.#..\n....\n\n\n",
    "..#*  \n.#..\t\n....\n",
    "# a maze for a test\n..#*\n.#..\n....\n",
    ". . # *\n. # . .\n. . . .\n",
    ".\t.\t#\t*\n.\t#\t.\t.\n.\t.\t.\t.\n",
    "S.#G\n.#..\n....\n",
    "  #E\n #  \n S  \n",
    "A #B\n #  \n   A\n",
    "S XG\n X  \n  P \n",
    "SFHG\nFHFF\nFFFF\n",
    "P %.\n %  \n   P\n",
    "3\n0 0 1 2\n0 1 0 0\n0 0 0 0\n",
    "0,2,1,3\n0,1,0,0\n0,0,0,0\n",
    "..\u2588*\n.\u2588..\n....\n",
], ids=ascii)
def test_dialects_of_mazes(tmp_path, text):
    (tmp_path / "maze.txt").write_bytes(text.encode())
    (tmp_path / "wide.txt").write_bytes(text.replace("\ufeff", "").encode("utf-16"))
    names = ["maze.txt"] if "\u2588" in text else ["maze.txt", "wide.txt"]
    for name in names:
        made = report("--maze", name, "--interactions", "100", cwd=tmp_path)
        assert made["maze"] == PLAIN


def test_a_legend_of_ones_own(tmp_path):
    (tmp_path / "maze.txt").write_text("oaXZ\noXoo\noooo\n")
    made = report("--maze", "maze.txt", "--legend", "wall=X,free=oa,exit=Z", "--interactions", "100",
                  cwd=tmp_path)
    assert made["maze"] == PLAIN
    for legend, said in (
        ("wall=X,free=o,exit=Z", ["maze.txt:1:2: ", "'a'", "--legend"]),
        ("walls=X", ["--legend", "wall=#,free=.,exit=*"]),
        ("wall", ["--legend", "wall=#,free=.,exit=*"]),
        ("wall=X", ["--legend", "free and exit"]),
    ):
        done = run("binary", "--maze", "maze.txt", "--legend", legend, cwd=tmp_path)
        check_refused(done, *said)


def test_a_legend_without_a_maze(tmp_path):
    check_refused(run("binary", "--legend", "wall=X,free=o,exit=Z", cwd=tmp_path), "--legend", "--maze")


def test_a_maze_from_the_standard_input(tmp_path):
    done = run("binary", "--maze", "-", "--interactions", "100", "--json", "report.json", cwd=tmp_path,
               input="..#*\n.#..\n....\n")
    assert done.returncode == 0, done.stderr
    assert json.loads((tmp_path / "report.json").read_text())["maze"] == PLAIN


@pytest.mark.parametrize("option", ["--json", "--dot", "--export-c"])
def test_a_dash_is_no_file_that_is_written(tmp_path, option):
    check_refused(run("binary", option, "-", cwd=tmp_path), option, "'-' is no file name")
    assert files(tmp_path) == []


def catches(process, number):
    """Whether a process has a handler for a signal yet."""
    status = Path(f"/proc/{process.pid}/status").read_text()
    return int(re.search(r"SigCgt:\s*(\w+)", status)[1], 16) >> (number - 1) & 1


@pytest.mark.parametrize("option", ["--json", "--maze"])
def test_a_pipe_without_another_end_can_be_left(tmp_path, option):
    """To open one waits; Ctrl-C, or another signal, ends that."""
    os.mkfifo(tmp_path / "pipe")
    with subprocess.Popen([PROGRAM, "binary", option, "pipe"], cwd=tmp_path, stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True) as process:
        while not catches(process, signal.SIGTERM):
            time.sleep(0.01)
        for _ in range(1000):  # it may come before the call that waits
            process.send_signal(signal.SIGTERM)
            try:
                process.wait(0.05)
                break
            except subprocess.TimeoutExpired:
                continue
        else:
            process.kill()
        assert process.returncode == 128 + signal.SIGTERM
        assert process.stderr.read() == "run_gridworld: interrupted after 0 interactions\n"


def test_full_tree(tmp_path):
    done = run("binary", "--classes", "8", "--json", "report.json", "--dot", "tree.dot",
               cwd=tmp_path)
    check_refused(done, "tree is full", "8 classes", "--classes", "seed 1")
    assert files(tmp_path) == []


def test_no_room_to_write(tmp_path):
    if not os.path.exists("/dev/full"):
        pytest.skip("no /dev/full here")
    done = run("binary", "--interactions", "100", "--json", "/dev/full", cwd=tmp_path)
    check_refused(done, "--json", "/dev/full", "No space left")
    with open("/dev/full", "w") as full:
        done = subprocess.run([PROGRAM, "binary", "--json", "report.json"], cwd=tmp_path,
                              stdout=full, stderr=subprocess.PIPE, text=True, timeout=300)
    check_refused(done, "standard output", "No space left")
    for asked in (["--help"], ["binary", "--help"], ["binary", "--version"]):
        with open("/dev/full", "w") as full:
            done = subprocess.run([PROGRAM, *asked], stdout=full, stderr=subprocess.PIPE, text=True, timeout=300)
        check_refused(done, "standard output", "No space left")
    assert files(tmp_path) == []


def test_files_too_large_for_the_process(tmp_path):
    (tmp_path / "report.json").write_text("old")

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (500, 500))

    with open(tmp_path / "screen", "w") as screen:
        done = subprocess.run([PROGRAM, "binary", "--help"], stdout=screen, stderr=subprocess.PIPE, text=True,
                              timeout=300, preexec_fn=limit)
    check_refused(done, "standard output", "File too large")
    done = run("binary", "--interactions", "100", "--json", "report.json", cwd=tmp_path, preexec_fn=limit)
    check_refused(done, "--json", "report.json", "File too large")
    assert (tmp_path / "report.json").read_text() == "old"
    assert files(tmp_path) == ["report.json", "screen"]


def test_nobody_reads(tmp_path):
    read_end, write_end = os.pipe()
    os.close(read_end)
    done = subprocess.run([PROGRAM, "binary", "--json", "report.json"], cwd=tmp_path,
                          stdout=write_end, stderr=subprocess.PIPE, text=True, timeout=300)
    os.close(write_end)
    assert done.returncode == 128 + signal.SIGPIPE and done.stderr == ""
    assert files(tmp_path) == []


# ------------------------------------------------------------------------- interrupting

@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interrupt(tmp_path, number):
    (tmp_path / "report.json").write_text("the report of before")
    arguments = [PROGRAM, "binary", "--criterion", "returns", "--steps", "1000000",
                 "--json", "report.json", "--dot", "tree.dot"]
    with subprocess.Popen(arguments, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True, env=ENVIRONMENT) as program:
        rows = (line for line in program.stdout if re.match(r" *\d+ +[\d,]+ +\d+ +\d+ ", line))
        next(rows)  # a learning step is done, more are to come
        program.send_signal(number)
        _, errors = program.communicate(timeout=300)
    assert program.returncode == 128 + number
    assert re.fullmatch(r"run_gridworld: interrupted after \d+ interactions and \d+ of 1000000 "
                        r"learning steps of the run with seed 1; nothing was written\n", errors)
    assert files(tmp_path) == ["report.json"]
    assert (tmp_path / "report.json").read_text() == "the report of before"


def test_an_interrupt_keeps_the_finished_runs(tmp_path):
    arguments = [PROGRAM, "binary", "--runs", "1000", "--interactions", "200", "--json", "report.json"]
    with subprocess.Popen(arguments, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True, env=ENVIRONMENT) as program:
        rows = (line for line in program.stdout if re.match(r" *\d+ +[\d,]+ ", line))
        next(rows)
        next(rows)  # two runs are done
        program.send_signal(signal.SIGINT)
        _, errors = program.communicate(timeout=300)
    assert program.returncode == 128 + signal.SIGINT
    said = re.fullmatch(r"run_gridworld: interrupted after (\d+) of 1000 runs, which were kept\n", errors)
    made = json.loads((tmp_path / "report.json").read_text())
    assert 2 <= int(said[1]) == len(made["runs"]) < 1000


# ------------------------------------------------------------------------- reporting

def neighbour(maze, x, y, step):
    to_x, to_y = x + step[0], y + step[1]
    inside = 0 <= to_x < len(maze[0]) and 0 <= to_y < len(maze)
    return (to_x, to_y) if inside and maze[to_y][to_x] != "#" else (x, y)


def optimal_actions(maze, discount, slip):
    """The optimal actions of each free cell, by plain value iteration."""
    free = [(x, y) for y, row in enumerate(maze) for x, sign in enumerate(row) if sign == "."]
    value = dict.fromkeys(free, 0.0)

    def gain(cell, step):
        x, y = neighbour(maze, *cell, step)
        return 100.0 if maze[y][x] == "*" else -1.0 + discount * value[x, y]

    def q(cell, action):
        others = [gain(cell, step) for name, step in ACTIONS.items() if name != action]
        return (1.0 - slip) * gain(cell, ACTIONS[action]) + slip * sum(others) / 3.0

    for _ in range(400):
        value = {cell: max(q(cell, action) for action in ACTIONS) for cell in free}
    return {cell: {a for a in ACTIONS if q(cell, a) >= value[cell] - 1e-7} for cell in free}


def check_run(run_report, discount=0.9, slip=0.0, distractors=11):
    maze = run_report["maze"]
    best = optimal_actions(maze, discount, slip)
    actions, classes = run_report["cell_actions"], run_report["cell_classes"]
    assert len(actions) == len(classes) == len(maze)
    optimal = 0
    for y, row in enumerate(maze):
        assert len(actions[y]) == len(classes[y]) == len(row)
        for x, sign in enumerate(row):
            if sign == ".":
                optimal += actions[y][x] in best[x, y]
                assert classes[y][x] is None or 0 <= classes[y][x] < run_report["classes"]
            else:
                assert actions[y][x] is None and classes[y][x] is None
    assert run_report["cells"] == len(best)
    assert run_report["optimal_cells"] == optimal <= run_report["near_optimal_cells"] <= len(best)
    check_history(run_report)
    check_policy(run_report, best, distractors)


def check_policy(run_report, best, distractors):
    """The small tree acts in each cell as well as it says, and no smaller one does."""
    names = ("up", "right", "down", "left")
    nodes = {node["node"]: node for node in run_report["policy"]["nodes"]}
    assert run_report["policy_leaves"] == sum("action" in node for node in nodes.values())
    assert run_report["policy_leaves"] <= run_report["classes"]
    assert run_report["policy_optimal_cells"] <= run_report["policy_near_optimal_cells"]
    if run_report["distractors_used"] > 0:
        return
    x_bits = (len(run_report["maze"][0]) - 1).bit_length()
    optimal = 0
    for (x, y), actions in best.items():
        percept, node = x | y << x_bits + distractors, nodes[0]
        while "action" not in node:
            bit = percept >> int(node["test"].split()[1]) & 1
            node = nodes[node["present" if bit else "absent"]]
        optimal += names[node["action"]] in actions
    assert optimal == run_report["policy_optimal_cells"]
    assert optimal < len(best) or run_report["policy_leaves"] >= run_report["fewest_leaves"]
    assert run_report["fewest_exact"]


def check_history(run_report):
    history = run_report["history"]
    assert [step["step"] for step in history] == list(range(len(history)))
    assert history[-1]["optimal_cells"] == run_report["optimal_cells"]
    assert history[-1]["interactions"] == run_report["interactions"]
    assert history[-1]["classes"] == run_report["classes"]
    assert 1 + sum(step["splits"] for step in history) == run_report["classes"]
    splitting = [step["step"] for step in history if step["splits"]]
    assert run_report["last_split_step"] == max(splitting, default=0)
    all_optimal = [step["optimal_cells"] == run_report["cells"] for step in history]
    first = next((s["interactions"] for s, o in zip(history, all_optimal) if o), None)
    assert run_report["interactions_to_first_optimal"] == first
    tail = list(itertools.takewhile(lambda pair: pair[1], zip(history[::-1], all_optimal[::-1])))
    stays = tail[-1][0]["interactions"] if tail else None
    assert run_report["interactions_to_optimal"] == stays


def test_report_of_one_run(tmp_path):
    made = report("--seed", "7", cwd=tmp_path)
    assert made["version"] == 1 and made["kind"] == "run_gridworld binary"
    assert made["seed"] == made["options"]["seed"] == 7
    assert made["options"]["discount"] == 0.9 and made["options"]["maze"] is None
    assert made["percept"]["bits"] == 18
    assert made["percept"]["x_bits"] == [0, 1, 2, 3] and made["percept"]["y_bits"] == [15, 16, 17]
    assert "runs" not in made
    assert made["maze"] == (MAZES / "sutton.txt").read_text().split()
    assert made["cells"] == 46
    assert isinstance(made["tree"], dict)
    assert made["policy_leaves"] == made["fewest_leaves"] == 10
    assert made["policy_optimal_cells"] == 46
    check_run(made)


def test_default_run_learns_the_maze(tmp_path):
    made = report(cwd=tmp_path)
    assert made["optimal_cells"] == 46
    assert made["bits_used"] == [0, 1, 2, 3, 15, 16, 17] and made["distractors_used"] == 0
    assert made["interactions_to_optimal"] <= 2500 <= made["interactions"] == 5000


def test_little_memory_learns_the_maze(tmp_path):
    made = report("--interactions", "2500", "--capacity", "1200", "--classes", "64", cwd=tmp_path)
    assert made["optimal_cells"] == 46 and made["distractors_used"] == 0
    if "RLVC_RED_ZONES" not in os.environ:  # which lie between the arrays of the agent's block
        assert made["memory_bytes"] <= 36 * 1024


def test_many_distractors_learn_the_maze(tmp_path):
    made = report("--interactions", "2000", "--distractors", "110", cwd=tmp_path)
    assert made["optimal_cells"] == 46 and made["distractors_used"] == 0
    assert made["options"]["successors"] == "yes"


def test_returns_criterion(tmp_path):
    made = report("--criterion", "returns", "--interactions", "2000", "--steps", "4", cwd=tmp_path)
    assert made["interactions"] == 8000 and len(made["history"]) == 4
    assert made["policy_leaves"] > 1, "a step leaves an empty ring, for which one would do"
    assert made["policy_optimal_cells"] >= made["optimal_cells"]
    check_run(made)


def test_ranks_learn_the_maze(tmp_path):
    made = report("--score", "ranks", cwd=tmp_path)
    assert made["options"]["score"] == "ranks" and made["optimal_cells"] == 46
    assert made["distractors_used"] == 0
    assert ", score ranks," in run("binary", "--score", "ranks", cwd=tmp_path).stdout
    check_run(made)


def test_report_of_several_runs(tmp_path):
    made = report("--runs", "3", "--seed", "5", "--interactions", "1500", cwd=tmp_path)
    assert [one["seed"] for one in made["runs"]] == [5, 6, 7]
    for one in made["runs"]:
        check_run(one)
    alone = report("--seed", "6", "--interactions", "1500", cwd=tmp_path)
    of_three = made["runs"][1]
    assert {name: alone[name] for name in of_three if name != "seconds"} == \
           {name: of_three[name] for name in of_three if name != "seconds"}


def test_maze_of_a_file_with_slip(tmp_path):
    (tmp_path / "maze.txt").write_text("....\n.##.\n..#*\n")
    made = report("--maze", "maze.txt", "--slip", "0.2", "--distractors", "3", "--discount", "0.8",
                  cwd=tmp_path)
    assert made["percept"]["bits"] == 2 + 3 + 2
    assert made["options"]["maze"] == "maze.txt"
    check_run(made, discount=0.8, slip=0.2, distractors=3)


def without_time(made):
    return {name: value for name, value in made.items() if name != "seconds"}


def test_same_seed_learns_the_same(tmp_path):
    first, again, other = (report("--seed", seed, "--interactions", "2000", cwd=tmp_path)
                           for seed in ("3", "3", "4"))
    assert without_time(first) == without_time(again)
    assert first["tree"] != other["tree"]


def test_built_in_maze_learns_as_the_file(tmp_path):
    built_in = without_time(report("--interactions", "1500", cwd=tmp_path))
    of_file = without_time(report("--interactions", "1500", "--maze", MAZES / "sutton.txt",
                                  cwd=tmp_path))
    built_in.pop("options"), of_file.pop("options")
    assert built_in == of_file


def test_field_is_what_its_script_makes():
    made = subprocess.run([sys.executable, "-B", MAZES / "make_field.py"], capture_output=True,
                          text=True, check=True).stdout
    assert made == (MAZES / "field64.txt").read_text()


def test_export_c(tmp_path):
    done = run("binary", "--interactions", "1500", "--export-c", "maze.h", cwd=tmp_path)
    assert done.returncode == 0
    assert "unsigned maze_act(const unsigned char *percept)" in (tmp_path / "maze.h").read_text()
    assert files(tmp_path) == ["maze.h"]


def test_dot(tmp_path):
    done = run("binary", "--interactions", "1500", "--dot", "tree.dot", cwd=tmp_path)
    assert done.returncode == 0
    assert (tmp_path / "tree.dot").read_text().startswith("digraph")
    assert files(tmp_path) == ["tree.dot"]


def test_report_through_a_link(tmp_path):
    (tmp_path / "target.json").write_text("old")
    (tmp_path / "target.json").chmod(0o640)
    (tmp_path / "report.json").symlink_to("target.json")
    report("--interactions", "500", cwd=tmp_path)
    assert (tmp_path / "report.json").is_symlink()
    assert (tmp_path / "target.json").stat().st_mode & 0o777 == 0o640
    assert files(tmp_path) == ["report.json", "target.json"]


@pytest.mark.parametrize("kept, mode", [(None, 0o640), (0o666, 0o666), (0o600, 0o600)])
def test_permissions_of_a_file(tmp_path, kept, mode):
    if kept is not None:
        (tmp_path / "tree.dot").touch()
        (tmp_path / "tree.dot").chmod(kept)
    done = run("binary", "--interactions", "500", "--dot", "tree.dot", cwd=tmp_path, umask=0o027)
    assert done.returncode == 0
    assert (tmp_path / "tree.dot").stat().st_mode & 0o777 == mode


# ------------------------------------------------------------------------- showing

def test_pictures(tmp_path):
    done = run("binary", cwd=tmp_path)
    lines = done.stdout.splitlines()
    title = next(i for i, line in enumerate(lines) if line.startswith("Classes"))
    assert lines[title].split() == ["Classes", "Policy"]
    first_row = lines[title + 2]
    assert first_row.count("*") == 2, "the exit, in both pictures"
    assert "█" in first_row
    assert set("".join(lines[title + 2:title + 8])) >= set("↑→↓")
    assert re.search(r"^ +bits used +0 1 2 3 15 16 17\b", done.stdout, re.MULTILINE)


def test_pictures_in_ascii(tmp_path):
    done = run("binary", cwd=tmp_path, env={**os.environ, "LC_ALL": "C"})
    assert done.returncode == 0 and done.stdout.isascii()
    assert set("^>v#*") <= set(done.stdout)


def test_line_a_step_on_a_pipe(tmp_path):
    done = run("binary", "--interactions", "1000", "--steps", "5", cwd=tmp_path)
    rows = re.findall(r"^ +(\d) +([\d,]+) +\d+ +\d+ +\d+ of 46$", done.stdout, re.MULTILINE)
    assert rows == [("0", "200"), ("1", "400"), ("2", "600"), ("3", "800"), ("4", "1,000")]
    assert "\r" not in done.stdout and "\033" not in done.stdout


def test_one_refreshed_line_on_a_terminal(tmp_path):
    here, there = pty.openpty()
    with subprocess.Popen([PROGRAM, "binary", "--interactions", "1000", "--steps", "5"],
                          cwd=tmp_path, stdout=there, env=ENVIRONMENT) as program:
        os.close(there)
        text = b""
        while True:
            try:
                part = os.read(here, 4096)
            except OSError:  # how Linux says that nobody is left at the other end
                break
            if not part:
                break
            text += part
    os.close(here)
    assert program.returncode == 0
    shown = text.decode().replace("\r\n", "\n")
    assert len(re.findall(r"\r\033\[Kstep [1-5] of 5: [\d,]+ interactions", shown)) == 5
    assert re.search(r"\r\033\[K\nClasses", shown), "the line is gone when the pictures come"


def test_table_of_runs(tmp_path):
    done = run("binary", "--runs", "3", "--interactions", "1000", cwd=tmp_path)
    rows = re.findall(r"^ +(\d+|median|min|max) .*$", done.stdout, re.MULTILINE)
    assert rows == ["1", "2", "3", "median", "min", "max"]
    assert re.search(r"optimal +all cells in \d of 3 runs", done.stdout)


# ------------------------------------------------------------------------- solvers

@pytest.mark.parametrize("solver", ["value-iteration", "policy-iteration", "q-learning", "sarsa"])
def test_each_solver(tmp_path, solver):
    made = report("--solver", solver, "--interactions", "2000", "--steps", "10", cwd=tmp_path)
    assert made["options"]["solver"] == solver
    check_run(made)


def test_old_names_of_options(tmp_path):
    old = report("--interactions", "500", "--learner", "sarsa", "--gamma", "0.8", cwd=tmp_path)
    new = report("--interactions", "500", "--solver", "sarsa", "--discount", "0.8", cwd=tmp_path)
    assert without_time(old) == without_time(new)
    shown = run("binary", "--help", cwd=tmp_path).stdout
    assert "--learner" not in shown and "--gamma" not in shown


def test_value_iteration_learns_by_default(tmp_path):
    default = report("--interactions", "1500", cwd=tmp_path)
    named = report("--interactions", "1500", "--solver", "value-iteration", cwd=tmp_path)
    assert without_time(default) == without_time(named)
