# SPDX-License-Identifier: MIT
"""Logs in the files and objects that are in use: each is read as the same interactions, or refused by name."""

import bz2
import collections
import contextlib
import dataclasses
import gzip
import io
import json
import lzma
import pickle
import zipfile

import numpy as np
import pytest
from walk import BASE, ROWS, table

import rlvc
from rlvc import errors, logs

HEAD = "state,action,reward,next_state,done,truncated"
NAMES = HEAD.split(",")
EPISODES = [[row for row in ROWS if row[0] == episode] for episode in range(60)]


def flat(e, t, s, a, r, n, d, u):
    return s, a, r, n, int(d or u), int(u)


def column(side):
    """The cells of a side of a log, whatever the form."""
    if isinstance(side, dict):
        side = next(iter(side.values()))
    cells = np.asarray(side).reshape(len(side), -1)
    if cells.shape[1] == 4:  # bits, the first one highest
        return cells @ [8, 4, 2, 1]
    return cells.argmax(axis=1) if cells.shape[1] == 7 else cells[:, 0]


def is_the_walk(log, truncated=True, last=True):
    """Whether a log is the walk; some dialects cannot say what was truncated, or what came last."""
    rows = ROWS if last else [row for row in ROWS if not row[7]]
    assert column(log.before).tolist() == [row[2] for row in rows]
    acting = np.array([row[3] for row in rows])
    words = {"left": 0, "right": 1}
    named = [log.known.of(int(index)) for index in log.actions]
    assert [words.get(name, name) for name in np.ravel(named).tolist()] == acting.tolist()
    assert log.rewards.tolist() == [row[4] for row in rows]
    assert (log.ends == 1).tolist() == [row[6] for row in rows]
    on = [not row[6] for row in rows]
    assert column(log.after)[on].tolist() == [row[5] for row in rows if not row[6]]
    if truncated:
        assert (log.ends == 2).tolist() == [row[7] for row in rows]
    assert not any("next" in name for name in getattr(log.space, "columns", ()))


TEXTS = {
    "Excel's line": table(HEAD.replace(",", ";"), flat, sep=";", start="sep=;\n"),
    "a clock": table(
        f"unix,{HEAD}", lambda *row: (1_700_000_000_000 + 100 * row[0] + row[1], *flat(*row))
    ),
    "an index": table(f",{HEAD}", lambda *row: (9 * row[0] + row[1], *flat(*row))),
    "ROS": table(
        "%time,field.state,field.action,field.reward,field.next_state,field.done,field.truncated",
        lambda *row: (10**18 + 9 * row[0] + row[1], *flat(*row)),
    ),
    "topics": table(
        "__time,/state/data,/action/data,/reward/data,/next_state/data,/done/data,/timeout/data",
        lambda *row: (row[1], *flat(*row)),
    ),
    "two actions": table(
        "state,action_left,action_right,reward,next_state,done,truncated",
        lambda *row: (row[2], 1 - row[3], row[3], *flat(*row)[2:]),
    ),
    "previous": table("prev_state,action,reward,state,done,truncated", flat),
    "from and to": table("from_state,action,reward,to_state,done,truncated", flat),
    "time in names": table("s_t,a_t,r_t+1,s_t+1,done,truncated", flat),
    "time in letters": table("S_t,A_t,R_t1,S_t1,Done,Truncated", flat),
    "long names": table("currentState,actionTaken,rewardReceived,newState,isDone,isTruncated", flat)
    .replace("isTruncated", "timeLimit"),
    "units": table("cell [m],action,reward [-],next cell [m],done,truncated", flat),
    "measures": table(
        HEAD, lambda *row: (f"{row[2]} m", *flat(*row)[1:3], f"{row[5]} m", *flat(*row)[4:])
    ),
    "percent": table(
        HEAD, lambda *row: (f"{row[2]}%", *flat(*row)[1:3], f"{row[5]}%", *flat(*row)[4:])
    ),
    "base 16": table(
        HEAD, lambda *row: (f"0x{row[2]:02X}", *flat(*row)[1:3], f"0x{row[5]:02X}", *flat(*row)[4:])
    ),
    "bits": table(
        HEAD, lambda *row: (f"{row[2]:04b}", *flat(*row)[1:3], f"{row[5]:04b}", *flat(*row)[4:])
    ),
    "a delimiter at the end": table(HEAD, lambda *row: (*flat(*row), "")),
    "a delimiter at each end": table(f"{HEAD},", lambda *row: (*flat(*row), "")),
    "names in a comment": table(f"% {HEAD.replace(',', ' ')}", flat, sep="  "),
    "aligned": table(
        f"  {HEAD.replace(',', '   ')}", lambda *row: (f"{x:8}" for x in flat(*row)), sep=" "
    ),
    "a word or none": table(
        HEAD, lambda *row: (*flat(*row)[:4], *("DONE" if x else "" for x in flat(*row)[4:]))
    ),
    "decimal commas in quotes": table(
        HEAD, lambda *row: (f'"{row[2]},0"', row[3], f'"{int(row[4])},0"', f'"{row[5]},0"', *flat(*row)[4:])
    ),
}  # fmt: skip


@pytest.mark.parametrize("dialect", TEXTS)
def test_texts(dialect, tmp_path):
    (tmp_path / "run.log").write_text(TEXTS[dialect], encoding="utf-8")
    is_the_walk(logs.read(tmp_path / "run.log"))


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be", "latin-1", "utf-8-sig"])
def test_encodings(encoding, tmp_path):
    text = table(HEAD.replace("state", "cellé"), flat)
    content = text.encode(encoding)
    (tmp_path / "log").write_bytes(b"\xfe\xff" + content if encoding == "utf-16-be" else content)
    is_the_walk(logs.read(tmp_path / "log"))


def zipped(content, inside="log.csv", **others):
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr(inside, content)
        for name, text in others.items():
            archive.writestr(name, text)
    return buffer.getvalue()


@pytest.mark.parametrize("pack", [gzip.compress, bz2.compress, lzma.compress, zipped])
def test_packed_files(pack, tmp_path):
    packed = pack(table(HEAD, flat).encode())
    (tmp_path / "log.csv.packed").write_bytes(packed)
    is_the_walk(logs.read(tmp_path / "log.csv.packed"))
    (tmp_path / "log.csv.packed").write_bytes(packed[:-9])
    with pytest.raises(errors.LogError, match="cannot be unpacked"):
        logs.read(tmp_path / "log.csv.packed")


def arrays():
    return {
        "observations": BASE["cell"][:, None].astype(np.float32), "actions": BASE["action"],
        "rewards": BASE["reward"], "next_observations": BASE["next"][:, None].astype(np.float32),
        "terminals": BASE["terminated"], "timeouts": BASE["truncated"],
    }  # fmt: skip


def records():
    fields = [("state", "f4"), ("action", "i4"), ("reward", "f8"), ("next_state", "f4"), ("done", "?"), ("truncated", "?")]  # fmt: skip
    return np.array([flat(*row) for row in ROWS], fields)


def expert():
    """As Stable-Baselines 2 recorded experts, with the end of each episode."""
    named = arrays()
    return {"obs": named["observations"], "actions": named["actions"][:, None], "rewards": named["rewards"],
            "new_obs": named["next_observations"], "dones": named["terminals"], "timeouts": named["timeouts"],
            "episode_returns": np.ones(60), "episode_starts": BASE["step"] == 0}  # fmt: skip


def buffer():
    """As the buffers of Stable-Baselines3 are: with an axis for environments."""
    named = arrays()
    over = (named["terminals"] | named["timeouts"])[:, None]
    return {"observations": named["observations"][:, None], "actions": named["actions"][:, None, None],
            "rewards": named["rewards"][:, None], "next_observations": named["next_observations"][:, None],
            "dones": over, "timeouts": named["timeouts"][:, None]}  # fmt: skip


def pixels():
    named = arrays()
    for name, cells in (("observations", BASE["cell"]), ("next_observations", BASE["next"])):
        named[name] = (255 * np.eye(7, dtype=np.uint8))[cells].reshape(-1, 1, 7, 1)
    return {**named, "actions": np.eye(2)[BASE["action"]]}


def objects():
    named = arrays()
    for name in ("actions", "rewards", "observations"):
        named[name] = named[name].astype(object)
    return named


def words():
    return {**arrays(), "actions": np.where(BASE["action"] == 1, "right", "left")}


@pytest.mark.parametrize(
    "made", [arrays, expert, buffer, pixels, objects, words], ids=lambda f: f.__name__
)
def test_npz(made, tmp_path):
    np.savez_compressed(tmp_path / "log.npz", **made())
    is_the_walk(logs.read(tmp_path / "log.npz"))


def test_npy(tmp_path):
    np.save(tmp_path / "records.npy", records())
    np.save(tmp_path / "dict.npy", arrays(), allow_pickle=True)
    np.save(tmp_path / "rows.npy", np.array([flat(*row) for row in ROWS], np.float64))
    for name in ("records.npy", "dict.npy"):
        is_the_walk(logs.read(tmp_path / name))
    is_the_walk(logs.read(tmp_path / "rows.npy", header=NAMES))
    with pytest.raises(errors.LogError, match=r"rows\.npy: .*header=\[...\], the 6 names"):
        logs.read(tmp_path / "rows.npy")


def by_name(row):
    return dict(zip(NAMES, flat(*row), strict=True))


Transition = collections.namedtuple("Transition", ["state", "action", "next_state", "reward"])


@dataclasses.dataclass
class Seen:
    obs: list
    act: int
    rew: float
    next_obs: list
    terminated: bool
    truncated: bool


def episodes():
    return [{key: values[BASE["episode"] == e] for key, values in arrays().items()} for e in range(60)]  # fmt: skip


LISTS = {
    "dicts": lambda: [by_name(row) for row in ROWS],
    "rows": lambda: [flat(*row) for row in ROWS],
    "dataclasses": lambda: [
        Seen([row[2]], row[3], row[4], [row[5]], row[6], row[7]) for row in ROWS
    ],
    "deque": lambda: collections.deque(by_name(row) for row in ROWS),
    "episodes of dicts": lambda: [[by_name(row) for row in rows] for rows in EPISODES],
    "episodes of arrays": episodes,
    "arrays of episodes": lambda: {
        key: [episode[key] for episode in episodes()] for key in arrays()
    },
    "episodes with steps": lambda: {
        "episodes": [{"id": i, "steps": [by_name(row) for row in rows]} for i, rows in enumerate(EPISODES)]
    },
    "columns and data": lambda: {"columns": NAMES, "data": [list(flat(*row)) for row in ROWS]},
    "columns by index": lambda: {
        name: {str(i): flat(*row)[k] for i, row in enumerate(ROWS)} for k, name in enumerate(NAMES)
    },
}  # fmt: skip


@pytest.mark.parametrize("form", LISTS)
def test_lists(form, tmp_path):
    found = LISTS[form]()
    header = NAMES if form == "rows" else None
    is_the_walk(logs.read(found, header=header))
    if form != "dataclasses":
        (tmp_path / "log.pkl").write_bytes(pickle.dumps(found))
        is_the_walk(logs.read(tmp_path / "log.pkl", header=header))
    if "arrays" not in form and form not in ("dataclasses", "deque"):
        (tmp_path / "log.json").write_text(json.dumps(found), encoding="utf-8")
        is_the_walk(logs.read(tmp_path / "log.json", header=header))


def test_nothing_next_is_an_end():
    """As PyTorch's tutorial has it: a named tuple, and None after the last interaction."""
    memory = [Transition([row[2]], row[3], None if row[6] else [row[5]], row[4]) for row in ROWS]
    log = logs.read(memory)
    is_the_walk(log, truncated=False)
    assert "43 interactions are without a next observation: taken as terminated" in log.describe()


def test_a_pickle_runs_nothing(tmp_path):
    class Evil:
        def __reduce__(self):
            return print, ("run",)

    for made, said in ((Evil(), "builtins.print"), ({"a": Transition(0, 0, 0, 0)}, "Transition")):
        (tmp_path / "log.pkl").write_bytes(pickle.dumps(made))
        with pytest.raises(errors.LogError, match=rf"log\.pkl: holds .*{said}.*is not taken"):
            logs.read(tmp_path / "log.pkl")
    pandas = pytest.importorskip("pandas")
    pandas.DataFrame(arrays()["rewards"]).to_pickle(tmp_path / "frame.pkl")
    with pytest.raises(errors.LogError, match=r"pass pandas\.read_pickle"):
        logs.read(tmp_path / "frame.pkl")


@pytest.mark.parametrize("protocol", range(2, 6))
def test_damaged_pickles(protocol, tmp_path):
    """Cut or changed, a pickle is refused or read: nothing else is raised."""
    content = pickle.dumps(arrays(), protocol)
    random = np.random.default_rng(protocol)
    for _ in range(60):
        at = int(random.integers(2, len(content)))
        changed = bytearray(content if random.random() < 0.7 else content[:at])
        changed[min(at, len(changed) - 1)] ^= int(random.integers(1, 256))
        (tmp_path / "log.pkl").write_bytes(changed)
        with contextlib.suppress(errors.LogError):
            logs.described(tmp_path / "log.pkl")


def test_sets_of_d3rlpy(tmp_path):
    class Episode:
        def __init__(self, rows):
            self.observations = np.array([[row[2]] for row in rows], np.float32)
            self.actions = np.array([[row[3]] for row in rows])
            self.rewards = np.array([[row[4]] for row in rows], np.float32)
            self.terminated = bool(rows[-1][6])

    class Set:
        episodes = tuple(Episode(rows) for rows in EPISODES)

    with pytest.warns(errors.LogWarning, match="17 interactions are left out"):
        is_the_walk(logs.read(Set()), truncated=False, last=False)
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "buffer.h5", "w") as file:
        for i, episode in enumerate(Set.episodes):
            for name, values in vars(episode).items():
                file[f"{name}_{i}"] = values
        file["total_step"] = 0
    with pytest.warns(errors.LogWarning, match="17 interactions are left out"):
        is_the_walk(logs.read(tmp_path / "buffer.h5"), truncated=False, last=False)


def test_robomimic_and_transitions(tmp_path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "demo.hdf5", "w") as file:
        for i, e in enumerate(episodes()):
            group = file.create_group(f"data/demo_{i}")
            group["obs/place"], group["next_obs/place"] = e["observations"], e["next_observations"]
            group["actions"], group["rewards"] = e["actions"], e["rewards"]
            group["terminated"], group["truncated"] = e["terminals"], e["timeouts"]
            group["states"] = np.zeros((len(e["actions"]), 5))
    with pytest.warns(errors.LogWarning, match="states: left out, as no column has the next value"):
        log = logs.read(tmp_path / "demo.hdf5")
    is_the_walk(log)
    assert "ignored: states" in log.describe()
    with h5py.File(tmp_path / "log.hdf5", "w") as file:
        for name, values in arrays().items():
            file[f"transitions/{name}"] = values
    is_the_walk(logs.read(tmp_path / "log.hdf5"))


def test_folders_and_tables_of_arrow(tmp_path):
    pandas = pytest.importorskip("pandas")
    pyarrow = pytest.importorskip("pyarrow")
    frame = pandas.DataFrame(
        {
            name: BASE[name]
            for name in ("episode", "step", "action", "reward", "terminated", "truncated")
        }
    )
    frame["observation.state"] = [[float(cell)] for cell in BASE["cell"]]
    frame["next.observation.state"] = [[float(cell)] for cell in BASE["next"]]
    folder = tmp_path / "data" / "chunk-000"
    folder.mkdir(parents=True)
    for i in range(60):
        frame[frame.episode == i].to_parquet(folder / f"episode_{i:06}.parquet")
    is_the_walk(logs.read(tmp_path / "data"))
    frame.to_feather(tmp_path / "log.feather")
    is_the_walk(logs.read(tmp_path / "log.feather"))
    is_the_walk(logs.read(pyarrow.Table.from_pandas(frame)))
    is_the_walk(logs.read(frame.set_index(["episode", "step"])))
    (tmp_path / "empty").mkdir()
    with pytest.raises(errors.LogError, match="a folder without Parquet files"):
        logs.read(tmp_path / "empty")


def test_names_by_the_caller(tmp_path):
    file = tmp_path / "log.csv"
    file.write_text(
        table("zustand;aktion;belohnung;folgezustand;ende;abbruch", flat, sep=";"), encoding="utf-8"
    )
    with pytest.raises(
        errors.LogError, match=r"no column action and no reward .* roles=\{'action'"
    ):
        logs.read(file)
    named = {"action": "aktion", "reward": "belohnung", "done": "ende", "truncated": "abbruch",
             "observation": "zustand", "next_observation": ["folgezustand"]}  # fmt: skip
    is_the_walk(logs.read(file, roles=named))
    assert rlvc.learn_from(file, roles=named, discount=0.9).leaves > 1
    with pytest.raises(errors.ConfigError, match="roles: 'acton' is not one of"):
        logs.read(file, roles={"acton": "aktion"})
    with pytest.raises(errors.LogError, match="roles: no column x"):
        logs.read(file, roles={**named, "action": "x"})


def test_what_has_no_next_value_is_left_out():
    log = {"x": BASE["cell"], "order": BASE["step"], "a": BASE["action"], "r": BASE["reward"],
           "next_x": BASE["next"], "d": BASE["terminated"]}  # fmt: skip
    with pytest.warns(errors.LogWarning, match="order: left out"):
        read = logs.read(log)
    is_the_walk(read, truncated=False)
    with pytest.warns(errors.LogWarning, match="left out, as what was observed next"):
        both = logs.read({**log, "episode": BASE["episode"]}, columns=["x", "order"])
    assert list(both.space.columns) == ["x", "order"]


def test_the_future_is_not_observed(tmp_path):
    """A column that is another one a row ahead is refused, whatever it is called."""
    file = tmp_path / "log.csv"
    for ahead in ("nx", "x2", "x_follow", "target"):
        file.write_text(table(f"x,action,reward,{ahead},done,truncated", flat), encoding="utf-8")
        with pytest.raises(errors.LogError, match=f"{ahead} is what x is in the next row"):
            logs.read(file)
        log = logs.read(file, roles={"observation": ["x"], "next_observation": [ahead]})
        is_the_walk(log)
        assert list(log.space.columns) == ["x"]


def test_texts_of_numbers_and_arrays_of_records():
    named = arrays()
    texts = {**named, "rewards": named["rewards"].astype(str), "actions": [str(a) for a in BASE["action"]]}
    texts["observations"] = named["observations"].astype(str)
    is_the_walk(logs.read(texts))
    made = {**named, "observations": np.array([(c,) for c in BASE["cell"]], [("x", "f4")]),
            "next_observations": np.array([(c,) for c in BASE["next"]], [("x", "f4")])}  # fmt: skip
    is_the_walk(logs.read(made))
    short = {"x": BASE["cell"], "a": BASE["action"], "r": BASE["reward"], "t": BASE["terminated"], "next_x": BASE["next"]}
    log = logs.read(short)
    is_the_walk(log, truncated=False)
    assert "t: 0 and 1, so it tells of ends" in log.describe()


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (zipped("<x/>", "xl/workbook.xml"), "is of Excel: pass what pandas.read_excel returns"),
        (zipped("", "archive/data.pkl"), "is of PyTorch"),
        (zipped("a", "a.csv", **{"b.csv": "b"}), "a ZIP of 2 files, and not one log"),
        (b"SQLite format 3\0" + bytes(99), "a data base"),
        (b"MATLAB 5.0 MAT-file" + bytes(99), "of MATLAB"),
        (b"\1\2\0\3" * 99, "neither text, JSON"),
        (json.dumps([[1, 0, 0.5]]).encode(), "header=[...], the 3 names"),
        (json.dumps([1, 2]).encode(), "index 0: 1 is no object of columns"),
        (json.dumps({"obs": "BCJNGGhAXg==", "actions": [0], "rewards": [1], "dones": [1]}).encode(), "obs: not an array but 'BCJNGGhAXg==': write it unpacked"),
        (b'state,action,reward,done\n"1,000",0,1,1\n', "line 2: state: 1,000 may be a thousand"),
        (b"x,action,reward,status\n1,0,1,end\n", "no column terminated"),
        (b"x,action,reward,done\n1,0,1,maybe\n2,0,1,sure\n", "done: words (maybe, sure) are no flags"),
        (b"x,action,reward,done\n1,0,1e300,1\n", "line 2: reward: 1e+300 is not in"),
    ],
)  # fmt: skip
def test_one_sentence_says_what_it_is(content, said, tmp_path):
    (tmp_path / "log.file").write_bytes(content)
    with pytest.raises(errors.LogError) as caught:
        logs.read(tmp_path / "log.file")
    assert said in str(caught.value)
    assert "log.file" in str(caught.value)
    assert "\n" not in str(caught.value)
