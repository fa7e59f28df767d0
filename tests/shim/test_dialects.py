# SPDX-License-Identifier: MIT
"""The same walk in the dialects of logs that are in use: each is read as what it is."""

import json

import numpy as np
import pytest
from walk import BASE, ROWS, table

import rlvc
from rlvc import errors, logs


def expected():
    arrays = {k: BASE[k] for k in ("reward", "terminated", "truncated")}
    return rlvc.learn_from(
        {**arrays, "actions": BASE["action"], "observations": BASE["cell"][:, None],
         "next_observations": BASE["next"][:, None]}, discount=0.9,
    ).agent.print("json")  # fmt: skip


CSV = {
    "tuple": table("state,action,reward,next_state,terminated,truncated", lambda e, t, s, a, r, n, d, u: (s, a, r, n, d, u)),
    "done and timeout": table("obs,act,rew,next_obs,done,timeout", lambda e, t, s, a, r, n, d, u: (s, a, r, n, int(d or u), int(u))),
    "semicolons": table("episode;s;a;r;s_next;terminal;timeouts", lambda e, t, s, a, r, n, d, u: (e, f"{s},0", a, str(r).replace(".", ","), n, int(d), int(u)), sep=";"),
    "tabs": table("State\tAction\tReward\tNext State\tDone\tTruncated", lambda e, t, s, a, r, n, d, u: (s, a, r, n, d, u), sep="\t"),
    "bars": table("state|action|reward|next_state|dones|truncations", lambda e, t, s, a, r, n, d, u: (s, a, r, n, d, u), sep="|"),
    "blanks between": table("state action reward next_state terminal truncated", lambda e, t, s, a, r, n, d, u: (s, a, r, n, int(d), int(u)), sep="  "),
    "byte order mark": table("state,action,reward,nextState,terminated,truncated", lambda e, t, s, a, r, n, d, u: (s, a, r, n, d, u), end="\r\n", start="\ufeff"),
    "old ends of lines": table("state,action,reward,next_state,terminated,truncated", lambda e, t, s, a, r, n, d, u: (s, a, r, n, d, u), end="\r"),
    "comments": table("state,action,reward,next_state,terminated,truncated", lambda e, t, s, a, r, n, d, u: (s, a, r, n, d, u), start="# made by hand\n# {}\n"),
    "names in the comment": table("# state,action,reward,next_state,terminated,truncated", lambda e, t, s, a, r, n, d, u: (s, a, r, n, int(d), int(u))),
    "blanks and quotes": table('"state" , "action", "reward" , "next_state", "terminated", "truncated"', lambda e, t, s, a, r, n, d, u: (f' "{s}" ', a, r, f" {n}", f'"{d}"', u), sep=", "),
    "yes and no": table("state,action,reward,next_state,terminated,truncated", lambda e, t, s, a, r, n, d, u: (s, a, r, n, "Yes" if d else "No", "y" if u else "n")),
    "whole as real": table("state,action,reward,next_state,terminated,truncated", lambda e, t, s, a, r, n, d, u: (f"{s}.0", f"{a}.0", r, f"{n}.0", float(d), float(u))),
    "arrays": table("state,action,reward,next_state,terminated,truncated", lambda e, t, s, a, r, n, d, u: (f'"[{s}]"', a, r, f"({n},)", d, u)),
    "aside": table("time,state,action,reward,next_state,terminated,truncated,info,log_prob,value", lambda e, t, s, a, r, n, d, u: (f"10:00:0{t}", s, a, r, n, d, u, "{}", -0.7, 3.0)),
    "names of episodes": table("trajectory_id,step,state,action,reward,next_state,terminated,truncated", lambda e, t, s, a, r, n, d, u: (f"run-{e}", t, s, a, r, n, d, u)),
}  # fmt: skip


@pytest.mark.parametrize("dialect", CSV)
def test_tables(dialect, tmp_path):
    file = tmp_path / ("log.tsv" if dialect == "tabs" else "log.csv")
    file.write_text(CSV[dialect], encoding="utf-8", newline="")
    run = rlvc.learn_from(file, discount=0.9)
    assert run.agent.print("json") == expected(), logs.described(file)
    assert "next" not in run.text()


def test_without_next_columns_the_next_row_counts(tmp_path):
    rows = sorted(ROWS, key=lambda row: (row[1], row[0]))  # the episodes alternate
    file = tmp_path / "log.csv"
    lines = [f"{e},{t},{s},{a},{r},{int(d)}" for e, t, s, a, r, n, d, u in rows]
    file.write_text("\n".join(["episode,t,cell,action,reward,done", *lines]), encoding="utf-8")
    with pytest.warns(errors.LogWarning, match="left out"):
        log = logs.read(file)
    kept = [row for row in ROWS if not row[7]]
    assert log.before["cell"].tolist() == [row[2] for row in kept]
    assert [n for n, e in zip(log.after["cell"], log.ends, strict=True) if e == 0] == [
        row[5] for row in kept if not row[6]
    ]
    assert "alternate" in log.describe()


def test_files_that_were_written_one_after_the_other(tmp_path):
    """The numbers of the episodes begin again, and no row of one is in the other."""
    text = table(
        "episode,cell,action,reward,done", lambda e, t, s, a, r, n, d, u: (e, s, a, r, int(d))
    )
    file = tmp_path / "log.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.warns(errors.LogWarning, match="left out"):
        once = logs.read(file)
    file.write_text(2 * text, encoding="utf-8")
    with pytest.warns(errors.LogWarning, match="left out"):
        twice = logs.read(file)
    assert len(twice) == 2 * len(once)
    on = once.ends == 0
    assert twice.after["cell"][twice.ends == 0].tolist() == 2 * once.after["cell"][on].tolist()


def test_words(tmp_path):
    words, moves = ["a", "b", "c", "d", "e", "f", "g"], ["left", "right"]
    file = tmp_path / "log.csv"
    file.write_text(
        table("place,action,reward,next_place,terminated,truncated",
              lambda e, t, s, a, r, n, d, u: (words[s], moves[a], r, words[n], d, u)), encoding="utf-8",
    )  # fmt: skip
    run = rlvc.learn_from(file, discount=0.9)
    assert run.predict({"place": "a"}) == run.predict(["d"]) == "right"
    assert run.predict({"place": np.array(["a", "g"])}).tolist() == ["right", "left"]
    assert 'place = "' in run.text()
    assert ": left" in run.text()
    with pytest.raises(errors.PerceptError, match="none of the words"):
        run.predict({"place": "z"})
    run.save(tmp_path / "run.rlvc")
    loaded = rlvc.load(tmp_path / "run.rlvc")
    assert [loaded.predict([w]) for w in words] == [run.predict([w]) for w in words]
    assert "left" in run.export_c()
    assert 'place = \\"' in run.text("dot")


JSON = {
    "list": json.dumps([
        {"state": [s], "action": a, "reward": r, "next_state": [n], "done": d or u, "truncated": u}
        for e, t, s, a, r, n, d, u in ROWS
    ]),
    "lines": "\n".join(
        json.dumps({"obs": {"cell": s}, "action": a, "reward": r, "next_obs": {"cell": n},
                    "terminated": d, "truncated": u})
        for e, t, s, a, r, n, d, u in ROWS
    ),
    "columns": json.dumps({
        "observations": BASE["cell"][:, None].tolist(), "actions": BASE["action"].tolist(),
        "rewards": BASE["reward"].tolist(), "next_observations": BASE["next"][:, None].tolist(),
        "terminals": BASE["terminated"].tolist(), "timeouts": BASE["truncated"].tolist(),
    }),
    "episodes": "\n".join(
        json.dumps({
            "observations": [[row[2]] for row in ROWS if row[0] == e] + [[[r for r in ROWS if r[0] == e][-1][5]]],
            "actions": [row[3] for row in ROWS if row[0] == e],
            "rewards": [row[4] for row in ROWS if row[0] == e],
            "terminated": [row[6] for row in ROWS if row[0] == e],
            "truncated": [row[7] for row in ROWS if row[0] == e],
        })
        for e in range(60)
    ),
}  # fmt: skip


@pytest.mark.parametrize("dialect", JSON)
def test_json(dialect, tmp_path):
    file = tmp_path / "log.jsonl"
    file.write_text(JSON[dialect], encoding="utf-8")
    assert rlvc.learn_from(file, discount=0.9).agent.print("json") == expected()


def d4rl():
    return {
        "observations": BASE["cell"][:, None].astype(np.float32), "actions": BASE["action"],
        "rewards": BASE["reward"], "next_observations": BASE["next"][:, None].astype(np.float32),
        "terminals": BASE["terminated"], "timeouts": BASE["truncated"], "infos/qpos": np.zeros(len(ROWS)),
    }  # fmt: skip


def test_hdf5(tmp_path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "flat.hdf5", "w") as file:
        for name, values in d4rl().items():
            file[name] = values
        file["metadata/name"] = "walk"
    with h5py.File(tmp_path / "groups.h5", "w") as file:
        for e in range(60):
            inside, last = BASE["episode"] == e, BASE["next"][BASE["episode"] == e][-1]
            group = file.create_group(f"data/demo_{e}")
            group["obs/cell"] = np.append(BASE["cell"][inside], last)[:-1]
            group["next_obs/cell"] = BASE["next"][inside]
            group["actions"], group["rewards"] = BASE["action"][inside], BASE["reward"][inside]
            group["terminated"], group["truncated"] = (
                BASE["terminated"][inside], BASE["truncated"][inside],
            )  # fmt: skip
    for name in ("flat.hdf5", "groups.h5"):
        run = rlvc.learn_from(tmp_path / name, discount=0.9)
        assert run.agent.print("json") == expected(), logs.described(tmp_path / name)


def test_frames(tmp_path):
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame({
        "observation.state": [[float(s)] for s in BASE["cell"]], "action": BASE["action"],
        "next.reward": BASE["reward"], "next.done": BASE["terminated"] | BASE["truncated"],
        "next.truncated": BASE["truncated"], "next.observation.state": [[float(s)] for s in BASE["next"]],
        "episode_index": BASE["episode"], "frame_index": BASE["step"], "task_index": 0,
    })  # fmt: skip
    assert rlvc.learn_from(frame, discount=0.9).agent.print("json") == expected()
    pytest.importorskip("pyarrow")
    frame.to_parquet(tmp_path / "log.parquet")
    assert rlvc.learn_from(tmp_path / "log.parquet", discount=0.9).agent.print("json") == expected()


def test_the_buffers_of_another_library():
    class Buffer:  # the arrays of Stable-Baselines3's: [place, environment, ...], filled beyond its end
        full, pos = True, 5
        turn = np.roll(np.arange(len(ROWS)), 5)
        observations = BASE["cell"][turn][:, None, None].astype(np.float32)
        next_observations = BASE["next"][turn][:, None, None].astype(np.float32)
        actions = BASE["action"][turn][:, None, None]
        rewards = BASE["reward"][turn][:, None].astype(np.float32)
        dones = (BASE["terminated"] | BASE["truncated"])[turn][:, None].astype(np.float32)
        timeouts = BASE["truncated"][turn][:, None].astype(np.float32)

    assert rlvc.learn_from(Buffer(), discount=0.9).agent.print("json") == expected()


def test_steps_of_rlds():
    """The last step of an episode has an observation, and an action that does not count."""
    rows = []
    for e, t, s, a, r, n, d, u in ROWS:
        last = [(e, t + 1, n, 0, 0.0, 0, True, d)] if d or u else []
        rows += [(e, t, s, a, r, t == 0, False, False), *last]
    _, _, cells, actions, rewards, first, ended, terminal = map(np.array, zip(*rows, strict=True))
    steps = {"observation": cells[:, None], "action": actions, "reward": rewards,
             "is_first": first, "is_last": ended, "is_terminal": terminal}  # fmt: skip
    log = logs.read(steps)
    assert len(log) == len(ROWS)
    assert (log.ends == 1).tolist() == BASE["terminated"].tolist()
    assert rlvc.learn_from(log, discount=0.9).agent.print("json") == expected()


def test_real_actions_and_combinations():
    random = np.random.default_rng(1)
    x, a = random.random((900, 1)), random.uniform(-1, 1, 900)
    log = {"observations": x, "next_observations": x, "actions": a,
           "rewards": -((a - (x[:, 0] > 0.5)) ** 2), "terminated": np.ones(900, bool)}  # fmt: skip
    with pytest.raises(errors.LogError, match="bins="):
        rlvc.learn_from(log)
    run = rlvc.learn_from(log, bins=3, discount=0.0)
    assert run.predict([0.9]) == pytest.approx(1.0, abs=0.01)
    assert run.predict([0.1]) == pytest.approx(0.0, abs=0.01)
    both = np.stack([random.integers(2, size=900), random.integers(10, 12, size=900)], axis=1)
    pairs = rlvc.learn_from(
        {**log, "actions": both, "rewards": (both[:, 1] == 11) * 1.0}, discount=0.0
    )
    assert pairs.predict([0.5]).tolist()[1] == 11


def test_what_is_lost_is_said():
    count = 640
    x = (1.7e9 + np.arange(count) % 8)[:, None]
    log = {"observations": x, "next_observations": x, "actions": np.arange(count) % 2,
           "rewards": np.arange(count) % 2 * 1.0, "terminated": np.ones(count, bool)}  # fmt: skip
    with pytest.warns(errors.LogWarning, match="8 different numbers become 1 in binary32"):
        rlvc.learn_from(log)
    assert "ignored: weather" in logs.described({**log, "weather": np.zeros(count)})


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("1,0,0.5,1\n2,1,0.5,1\n", "header=[...], the 4 names"),
        ("x,action,reward,terminated\n0x1G,0,0,1\n1,1,0,1\n", "line 2: x: '0x1G'"),
        (f"x,action,reward,terminated\n0x{'f' * 9000},0,0,1\n1,1,0,1\n", "line 2: x: '0xfff"),
        (f"x,action,reward,terminated\n0x{'f' * 200},0,0,1\n", "is beyond 1e15: scale it"),
        ("x,action,reward,terminated\n1e17,0,0,1\n", "line 2: x: 1e+17 is beyond 1e15"),
        ("x,action,reward,terminated\n1e400,0,0,1\n", "line 2: x: 1e400 is beyond 1e15"),
        ("x,action,reward,terminated\n1,0,\1,1\n", "line 2: a control character"),
        ("x,action,reward,terminated\n1,0,inf,1\n", "line 2: reward: inf is not a finite"),
        ("x,action,reward,terminated\n1,0,,1\n", "no interaction with a reward: none in line 2"),
        ("x,action,reward,terminated\n1,0,good,1\n", "line 2: reward: 'good' is not a number"),
        ("x,action,reward,terminated\n", "names of columns, and no row"),
        ("\n\n", "is empty"),
        ("x,action,reward,reward,done\n1,0,0,1,1\n", "line 1: columns 3 and 4 have the same name reward"),
        ("s2,s2,s,action,reward,done\n1,0,0,1,1,1\n", "columns 1 and 2 have the same name s2"),
        ('x,action,reward,done\n1,0,"0,1\n1,0,0,1\n', "line 2: cannot be read as CSV"),
        ("x,action,reward,done\n1,0,0,1\n1,0\n", "line 3: 2 fields, not 4"),
        ("x,reward,r,action,done\n1,0,0,1,1\n", "reward and r are both"),
        (
            "state,action,reward,done\n[1 2],0,0,1\n[1],0,0,1\n",
            "line 3: state: 1 numbers, expected 2",
        ),
    ],
)
def test_one_sentence_says_what_to_do(text, said, tmp_path):
    file = tmp_path / "log.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(errors.LogError) as caught:
        logs.read(file)
    assert said in str(caught.value)
    assert "log.csv" in str(caught.value)


HEAD = "x,action,reward,terminated\n"


@pytest.mark.parametrize(
    ("cells", "values", "said"),
    [
        ("\u0661\u0662 1", [12, 1], "beyond ASCII"),  # Arabic
        ("\u06f1 \u06f2", [1, 2], "beyond ASCII"),  # Persian
        ("\uff11\uff10 7", [10, 7], "beyond ASCII"),  # of full width
        ("\u22121 2", [-1, 2], "beyond ASCII"),  # minus
        ("1\u200b 2", [1, 2], "beyond ASCII"),  # a blank of no width
        ("0x1F 1", [31, 1], "base 16"),
        ("-0b11 0o17", [-3, 15], "base 16"),
        ("1_0 1", [10, 1], "in groups"),
        ("1_000 2_500", [1000, 2500], "in groups"),
        ("1'000.5 7", [1000.5, 7], "in groups"),
        ("1.5D+03 -2d0", [1500, -2], "exponent D"),
        ("1.#INF -1.#INF", [np.inf, -np.inf], "2 infinite numbers"),
        ("-inf 3", [-np.inf, 3], "1 infinite number"),
    ],
)
def test_spellings_of_numbers(cells, values, said, tmp_path):
    """Each has one obvious meaning, and what was read is said."""
    file = tmp_path / "log.csv"
    rows = [f"{cell},{i},0,1" for i, cell in enumerate(cells.split(" "))]
    file.write_text(HEAD + "\n".join(rows) + "\n", encoding="utf-8")
    log = logs.read(file)
    assert log.before["x"].tolist() == values
    assert said in log.describe()


@pytest.mark.parametrize("ahead", ["x_new", "future_x", "x_future", "after_x", "following_x", "x_after"])
def test_names_of_what_comes_next(ahead, tmp_path):
    """A column so named is never observed, also where its values do not give it away."""
    file = tmp_path / "log.csv"
    file.write_text(f"x,action,reward,{ahead},done\n1,0,0,5,0\n2,1,1,7,1\n", encoding="utf-8")
    log = logs.read(file)
    assert list(log.before) == ["x"]
    assert log.after["x"].tolist() == [5, 7]


def test_places_are_words(tmp_path):
    """Where no text is a plain number, 1_0 is a row and a column."""
    file = tmp_path / "log.csv"
    file.write_text(HEAD + "1_0,0,0,1\n0_1,1,1,1\n", encoding="utf-8")
    assert logs.read(file).before["x"].tolist() == ["1_0", "0_1"]


def test_infinite_numbers_act_as_large_ones(tmp_path):
    file = tmp_path / "log.csv"
    rows = [f"{x},{a},{float((x == 'inf') == a)},1" for x in ("1", "inf") for a in (0, 1)]
    file.write_text(HEAD + "\n".join(50 * rows) + "\n", encoding="utf-8")
    run = rlvc.learn_from(file)
    assert run.predict({"x": 1.0}) == 0
    assert run.predict({"x": np.inf}) == run.predict({"x": 1e15}) == 1


@pytest.mark.parametrize(
    ("text", "count", "said"),
    [
        ("1,0,0,1\n2,1,,1\n3,1,1,1\n", 2, "1 row is left out, for want of a reward, first line 3"),
        ("1,\0001,0,1\n3,1,1,1\n", 2, "1 byte is 0"),
        ("1,1,0,1\n3,1,1,1\n" + 600 * "\0", 2, "600 bytes are 0"),
        ("1,1,0,1\n3,1,1,1\n3,1", 2, "line 4 is cut off"),
        ("1,1,0,True\n3,1,1,False\n3,1,1,True\n3,1,0,Fal", 3, "line 5 is cut off"),
        ('"[1, 2]",1,0,1\n"[3, 2]",1,1,1\n"[3,', 2, "line 4 is cut off"),
    ],
)
def test_what_is_damaged_is_left_out_and_said(text, count, said, tmp_path):
    file = tmp_path / "log.csv"
    file.write_bytes((HEAD + text).encode())
    with pytest.warns(errors.LogWarning) as caught:
        log = logs.read(file)
    assert len(log) == count
    assert any(said in str(warning.message) for warning in caught)
    assert said in log.describe()


def test_a_line_of_json_that_is_cut_off(tmp_path):
    file = tmp_path / "log.jsonl"
    whole = [json.dumps({"x": i, "action": i, "reward": 0, "terminated": True}) for i in (0, 1)]
    file.write_text("\n".join([*whole, whole[0][:-3]]), encoding="utf-8")
    with pytest.warns(errors.LogWarning, match="line 3 is cut off"):
        assert len(logs.read(file)) == 2
    file.write_text("\n".join([whole[0][:-3], *whole]), encoding="utf-8")
    with pytest.raises(errors.LogError, match="line 1: is not JSON"):
        logs.read(file)


@pytest.mark.parametrize("end", ["\x1a", "\r\n\x1a\r\n"])
def test_an_old_end_of_file(end, tmp_path):
    file = tmp_path / "log.csv"
    file.write_bytes((HEAD + "1,1,0,1").encode() + end.encode())
    assert len(logs.read(file)) == 1


def test_columns_of_one_name(tmp_path):
    """They are numbered, and what comes next stays next to what it is the next of."""
    file = tmp_path / "log.csv"
    file.write_text(
        table("s,s,action,reward,s_next,s_next,terminated,truncated",
              lambda e, t, s, a, r, n, d, u: (0, s, a, r, 0, n, int(d), int(u))), encoding="utf-8",
    )  # fmt: skip
    log = logs.read(file)
    assert list(log.before) == ["s_0", "s_1"]
    assert log.after["s_1"].tolist() == BASE["next"].tolist()
    assert "2 columns are named s: taken as s_0, s_1" in log.describe()


def test_a_grid_of_real_actions(tmp_path):
    """Few real numbers that occur often are the actions; of others it is asked what to do."""
    file = tmp_path / "log.csv"
    rows = [f"0,{(-0.5, 0.5)[i % 2]},{i % 2},1" for i in range(16)]
    file.write_text(HEAD + "\n".join(rows) + "\n", encoding="utf-8")
    assert rlvc.learn_from(file, discount=0.0).predict({"x": 0.0}) == 0.5
    file.write_text(HEAD + "\n".join(rows[:15]) + "\n", encoding="utf-8")
    with pytest.raises(errors.LogError, match="pass bins="):
        logs.read(file)


def test_a_header_that_is_missing(tmp_path):
    file = tmp_path / "log.csv"
    file.write_text(
        table("", lambda e, t, s, a, r, n, d, u: (s, a, r, n, int(d), int(u))).lstrip(),
        encoding="utf-8",
    )
    names = ["state", "action", "reward", "next_state", "terminated", "truncated"]
    assert rlvc.learn_from(file, header=names, discount=0.9).agent.print("json") == expected()


@pytest.mark.parametrize("state", ["1", '"[1.0, 2.0]"'])
def test_a_log_of_one_row(state, tmp_path):
    """As a log is that was cut off after its first line: it has an interaction, and no episode that ends."""
    log = tmp_path / "log.csv"
    log.write_text(f"state,action,reward,next_state,done\n{state},0,1.0,{state},False\n", encoding="utf-8")
    read = logs.read(log)
    assert len(read.actions) == 1
    assert any("no episode ends" in note for note in read.notes)
