# SPDX-License-Identifier: MIT
"""The yardstick: what it knows of its worlds, what it measures, prints, refuses and leaves behind.

Needs Gymnasium, tqdm and the Python package, and is left out where they are not. Short runs; none depends
on the clock.
"""
import dataclasses
import json
import os
import pty
import re
import signal
import subprocess
import sys
import termios
import time
from pathlib import Path

import pytest

np = pytest.importorskip("numpy")
gymnasium = pytest.importorskip("gymnasium")
pytest.importorskip("tqdm")
rlvc = pytest.importorskip("rlvc")

TOOLS = Path(__file__).resolve().parents[2] / "tools"
sys.path.insert(0, str(TOOLS))

from suite import controls, learners, options, report, runs, tasks, worlds  # noqa: E402
from suite.learners import q_tree  # noqa: E402

ENVIRONMENT = {
    **os.environ, "PYTHONPATH": os.pathsep.join([str(TOOLS), os.environ.get("PYTHONPATH", "")]),
}
COMMAND = [sys.executable, "-B", "-m", "suite"]


def run(*arguments, cwd, program=COMMAND):
    return subprocess.run([*program, *arguments], cwd=cwd, env=ENVIRONMENT, capture_output=True,
                          text=True, timeout=300)


def files(folder):
    return sorted(path.name for path in folder.iterdir())


# ------------------------------------------------------------------------- the worlds

def sutton():
    return worlds.maze_world(tasks._maze("sutton"), 17)


def lake(slippery):
    env = gymnasium.make("FrozenLake-v1", is_slippery=slippery)
    return worlds.table_world(env, [worlds.binary(np.arange(16), 4)], 6)


def test_known_optima():
    assert lake(False).best_return(0.99) == pytest.approx(1)
    assert lake(True).best_return(0.99) == pytest.approx(0.7401649)
    assert len(sutton().reachable) == 46


@pytest.mark.parametrize(("world", "fewest"), [(lake(False), 5), (lake(True), 9)])
def test_fewest_leaves(world, fewest):
    assert world.fewest_leaves(0.99) == fewest


def test_fewest_leaves_by_trying_all_trees():
    """Against a search that knows nothing of cubes, on mazes of 3 x 3 cells."""

    def search(cells, best):
        if len(cells) == 0 or best[cells].all(axis=0).any():
            return 1
        found = [
            search(cells[bits[cells, b] == 0], best) + search(cells[bits[cells, b] == 1], best)
            for b in range(bits.shape[1])
            if 0 < bits[cells, b].sum() < len(cells)
        ]
        return min(found)

    random = np.random.default_rng(1)
    for _ in range(20):
        signs = np.where(random.random(9) < 0.2, "#", ".")
        signs[[0, 8]] = ".", "*"
        rows = ["".join(row) for row in signs.reshape(3, 3)]
        world = worlds.maze_world(rows, 0)
        bits = world.bits[world.reachable]
        best = world.best_actions(0.9)
        assert world.fewest_leaves(0.9) == search(np.arange(len(bits)), best), rows


def test_a_maze_is_what_the_environment_plays():
    world = sutton()
    env = gymnasium.make("rlvc/BinaryGridworld-v0", distractors=17)
    random = np.random.default_rng(2)
    observation, _ = env.reset(seed=3)
    for _ in range(2000):
        state, action = world.state_of(observation), int(random.integers(4))
        observation, reward, over, _, _ = env.step(action)
        assert (reward, over) == (world.reward[state, action, 0], world.over[state, action, 0])
        if over:
            observation, _ = env.reset()
        else:
            assert world.state_of(observation) == world.following[state, action, 0]


def test_an_exact_return_is_what_playing_gives():
    world, random = lake(True), np.random.default_rng(4)
    env = worlds.Seen(worlds.Played(world), world, seed=5)
    table_of = random.integers(4, size=2**10)  # a policy that looks at the distractors, too
    weights = 1 << np.arange(10)
    exact = world.evaluate(table_of[world.looks @ weights])
    total, episodes = 0.0, 4000
    env.reset(seed=6)
    for _ in range(episodes):
        observation, over = env.reset()[0], False
        while not over:
            observation, reward, ended, cut, _ = env.step(table_of[observation @ weights])
            total, over = total + reward, ended or cut
    assert total / episodes == pytest.approx(exact, abs=4 * (exact / episodes) ** 0.5)


def test_a_learner_is_told_nothing_but_bits():
    world = lake(True)
    env = worlds.Seen(gymnasium.make("FrozenLake-v1"), world, seed=1)
    told = env.reset(seed=1)[1], env.step(0)[-1]
    assert told == ({}, {})


def test_a_random_walk_takes_as_long_as_is_said():
    world = worlds.maze_world(["...", ".#.", "..*"], 0, 0, earned=1.0, cost=0.0, limit=7)
    env, random, taken, found = worlds.Played(world), np.random.default_rng(7), 0, 0
    env.reset(seed=8)
    while found < 3000:
        taken += 1
        _, reward, over, cut, _ = env.step(int(random.integers(4)))
        found += reward > 0
        if over or cut:
            env.reset()
    assert taken / found == pytest.approx(world.random_walk(), rel=0.08)


def test_walls_change_at_the_end_of_an_episode():
    envs = [worlds.Played(worlds.maze_world([row], 0)) for row in ("..*", "*..")]
    env = worlds.Changing(*envs, after=3)
    env.reset(seed=0)
    moves, over = 0, False
    while moves < 3 or not over:
        assert env.now is envs[0]
        _, _, over, _, _ = env.step(1)
        moves += 1
        if over and moves < 3:
            env.reset()
    env.reset()
    assert env.now is envs[1]


def test_reached():
    looks = [(n, tasks.Look(0.0, None, good)) for n, good in
             ((1, True), (2, False), (3, True), (4, True), (5, False), (6, True))]
    assert tasks.reached(looks) == 6
    assert tasks.reached(looks, last=4) == 3
    assert tasks.reached(looks, first=4) == 2
    assert tasks.reached(looks, last=2) is None


# ------------------------------------------------------------------------- tasks of control

def lean(rows):
    """Pushes a pole where it falls: it stands for some 200 steps."""
    return (rows[:, 2] + rows[:, 3] > 0).astype(np.int64)


def test_a_pole_played_at_once_falls_as_in_an_environment():
    one_by_one = controls.mean_return(lambda: gymnasium.make("CartPole-v1"), lean, 200)
    assert controls.balance(lean, 200) == pytest.approx(one_by_one, rel=0.1)


def test_a_ball_can_be_caught_by_two_leaves():
    def chase(rows):
        return np.where(rows[:, 4] > 0, 2, 1)

    def stay(rows):
        return np.zeros(len(rows), int)

    assert controls.mean_return(controls.Catch, chase, 200) == 1
    assert controls.mean_return(controls.Catch, stay, 200) < -0.5
    task = tasks.TASKS["catch"]()
    assert task.look(chase, 0).good and not task.look(stay, 0).good


@pytest.mark.parametrize("noise", [{"components": 4}, {"error": 0.02}])
def test_noise_is_what_is_said(noise):
    rows = []

    def act(seen):
        rows.append(seen)
        return lean(seen)

    controls.balance(act, 50, **noise)
    env = controls.Noise(gymnasium.make("CartPole-v1"), **noise)
    first = np.array([env.reset(seed=seed)[0] for seed in range(200)])
    assert first.dtype == rows[0].dtype == np.float32
    assert first.shape[1:] == rows[0].shape[1:] == env.observation_space.shape
    for seen in (first, np.concatenate(rows)):
        assert seen[:, 4:].std(axis=0) == pytest.approx([1] * noise.get("components", 0), rel=0.2)
    # Reset is within 0.05, evenly: a deviation of 0.0289.
    expected = np.hypot(0.05 / 3**0.5, noise.get("error", 0) * np.array([1, 1, 0.2, 1]))
    assert first[:, :4].std(axis=0) == pytest.approx(expected, rel=0.2)


def test_three_torques():
    env = controls.Torques(gymnasium.make("Pendulum-v1"))
    assert env.action_space.n == 3
    assert [float(env.action(a)[0]) for a in range(3)] == [-2, 0, 2]
    still = controls.mean_return(lambda: env, lambda rows: np.ones(len(rows), int), 1)
    assert -2000 < still < -500


def test_a_planner_on_a_task_of_control(monkeypatch):
    short = dataclasses.replace(tasks.TASKS["cartpole"](), interactions=600)
    monkeypatch.setitem(tasks.TASKS, "cartpole", lambda: short)
    record = runs.measure("cartpole", "rlvc", 1)
    assert record["looks"][-1][0] == 600
    assert record["value"] == record["kept"] == record["looks"][-1][1]
    assert record["leaves"] == record["compacted"] <= 16
    assert record["distractors"] is None
    assert "share of runs with a return of 475 by 12 leaves" in report.render([record], ["cartpole"], ["rlvc"])


def test_first_and_final_returns():
    record = {"looks": [[1000, 10, None], [2000, 480, None], [4000, 300, None], [6000, 480, None]]}
    assert tasks._first(475)([record]) == 2000
    assert tasks._first(490)([record]) == float("inf")
    assert [tasks._by(n, 475)([record]) for n in (500, 2500, 5000, 7000)] == [0, 1, 0, 1]


# ------------------------------------------------------------------------- measuring

def test_tasks_and_learners_are_those_of_the_help():
    assert list(tasks.TASKS) == list(options.TASKS)
    assert list(learners.LEARNERS) == list(options.LEARNERS)


def test_a_run_and_its_table(tmp_path):
    arguments = ["--tasks", "lake,nothing", "--learners", "rlvc,q", "--seeds", "1",
                 "--peer-seeds", "1", "--jobs", "2", "--json", "out.json"]
    done = run(*arguments, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert re.search(r"^\| lake +\| rlvc +\| +1 \|", done.stdout, re.MULTILINE)
    assert re.search(r"^\| lake +\| Q-learning", done.stdout, re.MULTILINE)
    assert re.search(r"^\| nothing +\| rlvc +\| +10 \|", done.stdout, re.MULTILINE)
    assert re.search(r"^- (met|MISSED): lake: return after 1,000", done.stdout, re.MULTILINE)
    assert "epsilon" in done.stdout
    assert files(tmp_path) == ["out.json"]
    made = json.loads((tmp_path / "out.json").read_text())
    assert made["ended"] is None
    assert len(made["runs"]) == 12
    first = made["runs"][0]
    assert (first["task"], first["learner"], first["seed"]) == ("lake", "rlvc", 1)
    assert first["looks"][-1][0] == 1000
    assert 1 < first["compacted"] <= first["leaves"]
    again = runs.measure("lake", "rlvc", 1)
    assert {k: v for k, v in again.items() if k != "seconds"} == \
        {k: v for k, v in first.items() if k != "seconds"}


def run_peer(name, task, seed):
    """What a learner returns, and its policy's actions for task.world.looks, at the end of a run."""
    ends = []
    made = learners.LEARNERS[name].learn(task, seed, lambda done, act: ends.append(act))
    return made, ends[-1](task.world.looks)


@pytest.mark.parametrize("learner", ["rmax", "vi"])
def test_a_learner_that_sees_the_state_solves_the_lake(learner):
    task = tasks.TASKS["lake"]()
    _, actions = run_peer(learner, task, 1)
    assert task.world.evaluate(actions) == pytest.approx(1)


def test_exploring_on_purpose_takes_fewer_interactions_than_a_random_walk():
    directed, walk = (runs.measure("binary", name, 1)["reached"] for name in ("rmax", "vi"))
    assert directed < walk / 4


def test_raw_bits_are_states_where_there_are_no_distractors():
    task = tasks.TASKS["lake"]()
    world = worlds.table_world(gymnasium.make("FrozenLake-v1", is_slippery=False), task.world.parts, 0)
    plain = dataclasses.replace(
        task, world=world,
        make=lambda seed: worlds.Seen(gymnasium.make("FrozenLake-v1", is_slippery=False), world, seed))
    made, actions = run_peer("q", plain, 2)
    made_raw, actions_raw = run_peer("q-raw", plain, 2)
    assert made == made_raw
    assert (actions == actions_raw).all()
    assert run_peer("q-raw", task, 2)[0]["bytes"] > 10 * made["bytes"]


def test_fitted_q_iteration_grows_a_tree():
    task = tasks.TASKS["slippery"]()
    made, actions = run_peer("fqi-rlvc", task, 1)
    assert made["leaves"] > 4
    assert task.world.evaluate(actions) > 0.5


def test_a_q_tree_splits_a_settled_leaf_by_the_bit_that_differs_most():
    stats = pytest.importorskip("scipy.stats")
    random = np.random.default_rng(1)
    rows = random.integers(2, size=(40, 5)).astype(bool)
    changes = random.standard_normal(40) + 2.0 * rows[:, 3] - 1.0
    t = [abs(stats.ttest_ind(changes[row], changes[~row], equal_var=False).statistic) for row in rows.T]
    assert q_tree._t(rows, changes) == pytest.approx(t)
    tree = q_tree.Tree(2, 5, 40)
    tree.q[0][1] = 7.0
    for row, change in zip(rows, changes, strict=True):
        assert tree.bit == [-1]
        tree.note(0, row, change, 3.0)
    assert tree.bit == [3, -1, -1]
    assert [tree.leaf(row) for row in rows] == [1 + int(row[3]) for row in rows]
    assert all(tree.q[leaf].tolist() == [0.0, 7.0] for leaf in (1, 2))
    one_way = q_tree.Tree(2, 5, 40)
    for row in rows:
        one_way.note(0, row, 5.0, 3.0)  # Q still goes up
    assert one_way.bit == [-1]


def test_a_q_tree_learns_what_follows_nothing_else():
    made, actions = run_peer("q-tree", tasks.TASKS["slippery"](), 1)
    assert made["leaves"] > 1
    assert len(set(actions.tolist())) > 1


def test_taxi_as_it_is_seen_as_one_number():
    task = tasks.TASKS["cab"]()
    best = task.world.solve(0.99).argmax(axis=1)
    look = task.look(lambda states: best[states], 0)
    assert look.good and look.optimal == 1 and look.value == pytest.approx(7.93, abs=0.005)


def test_the_cross_entropy_method_balances_the_pole():
    task = dataclasses.replace(tasks.TASKS["cartpole"](), interactions=2000)
    looked = []
    learners.LEARNERS["cem"].learn(task, 1, lambda done, act: looked.append((done, act)))
    assert looked[-1][0] >= 10 * task.interactions
    assert task.look(looked[-1][1], 0).value > 150


def test_a_record_of_a_change(monkeypatch):
    task = tasks.TASKS["changing"]()

    class Fake:
        about = ""

        def learn(self, task, seed, check):
            for n in range(1000, 7000, 1000):
                check(n, lambda rows, n=n: act(rows, n))
            return {"leaves": 1, "distractors": 0, "bytes": 1,
                    "compact": lambda: (1, lambda rows: act(rows, 0))}

    monkeypatch.setitem(learners.LEARNERS, "rlvc", Fake())

    def act(rows, n):
        """Optimal from 1,000 interactions on, and again 2,000 after the change."""
        name = "sutton_changed" if n >= 5000 else "sutton"
        world = worlds.maze_world(tasks._maze(name), 17)
        best = world.solve(0.9).argmax(axis=1)
        return best[[world.state_of(row) for row in rows]]

    record = runs.measure("changing", "rlvc", 1)
    assert (record["reached"], record["reached_again"], record["again"]) == (1000, 2000, 2)
    assert (record["compacted"], record["optimal"]) == (1, 1.0)
    assert record["kept"] < record["value"] == pytest.approx(task.world.best_return(0.9))
    text = report.render([record], ["changing"], ["rlvc"])
    assert re.search(r"changing, again.*2,000", text)
    assert f"- met: changing: {task.bars[0].text}: 2 " in text


# ------------------------------------------------------------------------- refusing, and ending early

@pytest.mark.parametrize("arguments", [
    ["--tasks", "lakes"], ["--learners", ""], ["--seeds", "0"], ["--jobs", "x"], ["more"],
])
def test_refuses(arguments, tmp_path):
    done = run(*arguments, cwd=tmp_path)
    assert done.returncode == 2
    assert "tools/yardstick: error" in done.stderr
    assert files(tmp_path) == []


def test_help_needs_nothing(tmp_path):
    program = [sys.executable, "-I", "-S", str(TOOLS / "suite" / "options.py")]
    done = run("--help", cwd=tmp_path, program=program)
    assert done.returncode == 0
    for option in "seeds peer-seeds tasks learners jobs json".split():
        assert f"--{option}" in done.stdout


def test_a_file_that_cannot_be_written(tmp_path):
    done = run("--tasks", "lake", "--json", "no/such/out.json", cwd=tmp_path)
    assert done.returncode == 1 and "no/such/out.json" in done.stderr
    assert done.stdout == ""


def test_a_reader_that_has_seen_enough(tmp_path):
    process = subprocess.Popen([*COMMAND, "--tasks", "lake", "--learners", "rlvc", "--seeds", "1",
                                "--json", "out.json"], cwd=tmp_path, env=ENVIRONMENT, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
    process.stdout.close()
    assert process.stderr.read() == ""
    process.stderr.close()
    assert process.wait() == 1
    assert len(json.loads((tmp_path / "out.json").read_text())["runs"]) == 1


def test_a_peer_that_is_missing_is_said_to_be(tmp_path):
    lacking = [sys.executable, "-B", "-c",
               "import sys; sys.modules['torch'] = None; from suite.__main__ import main; sys.exit(main())"]
    done = run("--tasks", "lake", "--learners", "dqn", cwd=tmp_path, program=lacking)
    assert done.returncode == 0, done.stderr
    assert re.search(r"^- not measured: DQN: needs python3-torch.*tools/setup peers", done.stdout, re.M)


def test_a_run_that_fails_does_not_end_the_others(tmp_path):
    (tmp_path / "sklearn.py").write_text("raise ImportError('broken on purpose')\n")
    environment = {**ENVIRONMENT, "PYTHONPATH": f"{tmp_path}{os.pathsep}{ENVIRONMENT['PYTHONPATH']}"}
    done = subprocess.run(
        [*COMMAND, "--tasks", "lake", "--learners", "rlvc,fqi", "--seeds", "1", "--peer-seeds", "1"],
        cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300)
    assert done.returncode == 1
    assert "lake fqi 1 failed" in done.stderr and "broken on purpose" in done.stderr
    assert re.search(r"^\| lake +\| rlvc +\| +1 \|", done.stdout, re.MULTILINE)


def group(number):
    """The processes of a group that are not over."""
    left = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _, of = stat.read_text().rpartition(")")[2].split()[:3]
        except OSError:
            continue  # over meanwhile
        if int(of) == number and state not in "ZX":
            left.append(stat.parent.name)
    return left


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_ended_early_it_prints_what_is_there(how, tmp_path):
    ours, theirs = pty.openpty()
    termios.tcsetwinsize(theirs, (24, 100))
    process = subprocess.Popen(
        [*COMMAND, "--tasks", "lake,far", "--learners", "rlvc", "--seeds", "2", "--jobs", "1",
         "--json", "out.json"],
        cwd=tmp_path, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=theirs, text=True,
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))  # a shell may have it ignored
    os.close(theirs)
    said = ""
    while "2/4" not in said:
        said += os.read(ours, 4096).decode(errors="replace")
    if how == signal.SIGINT:
        os.killpg(process.pid, how)  # as a terminal does
    else:
        os.kill(process.pid, how)
    out, _ = process.communicate(timeout=60)
    os.close(ours)
    assert process.returncode == 130
    assert re.search(r"^\| lake +\| rlvc +\| +2 \|", out, re.MULTILINE)
    assert files(tmp_path) == ["out.json"]
    made = json.loads((tmp_path / "out.json").read_text())
    assert made["ended"] == "interrupted"
    assert {r["task"] for r in made["runs"]} == {"lake"}
    for _ in range(6000):  # those that look after others see their parent's end and go
        if not group(process.pid):
            break
        time.sleep(0.01)
    assert group(process.pid) == []
