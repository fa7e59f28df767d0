# SPDX-License-Identifier: MIT
"""Learning from logs, and what is said about damaged ones."""

import ctypes

import numpy as np
import pytest

import rlvc
from rlvc import _native, errors, logs


def episodes(count=60, seed=1):
    """Walks along cells 0 to 7, whose exit is 5: observations, actions, rewards, terminated."""
    random = np.random.default_rng(seed)
    walks = []
    for _ in range(count):
        cells, actions = [int(random.choice([0, 7]))], []
        while cells[-1] != 5:
            actions.append(int(random.integers(2)))
            cells.append(min(max(cells[-1] + (1 if actions[-1] else -1), 0), 7))
        walks.append((cells, actions))
    return walks


def arrays(**changes):
    walks = episodes()
    actions = np.concatenate([actions for _, actions in walks])
    ends = np.concatenate([np.arange(1, len(a) + 1) == len(a) for _, a in walks])
    parts = {
        "observations": np.concatenate([cells for cells, _ in walks]),
        "actions": actions,
        "rewards": ends.astype(np.float64),
        "terminated": ends,
    }
    return {k: v for k, v in {**parts, **changes}.items() if v is not None}


def optimal(run, observe=np.float64):
    return [run.act(observe(cell)) for cell in range(8) if cell != 5] == [1, 1, 1, 1, 1, 0, 0]


def test_arrays():
    run = rlvc.learn_from(arrays(), discount=0.9)
    assert optimal(run)
    assert run.agent.statistics.interactions == len(arrays()["actions"])
    # An episode's end takes no room of its own, as episodes are linked.
    assert run.agent.config.criterion == "residual"


def test_next_observations():
    walks = episodes()
    before = np.concatenate([cells[:-1] for cells, _ in walks])
    after = np.concatenate([cells[1:] for cells, _ in walks])
    run = rlvc.learn_from(arrays(observations=before, next_observations=after), discount=0.9)
    other = rlvc.learn_from(arrays(), discount=0.9)
    assert run.agent.print("json") == other.agent.print("json")


def test_bits():
    cells = arrays()["observations"]
    bits = (cells[:, None] >> np.arange(3) & 1).astype(bool)
    run = rlvc.learn_from(arrays(observations=bits), discount=0.9)
    assert run.encoder.names == ["bit 0", "bit 1", "bit 2"]
    assert [run.act(np.array([[c >> b & 1 for b in range(3)]], bool)[0]) for c in (0, 3, 6, 7)] == [
        1,
        1,
        0,
        0,
    ]


def test_npz(tmp_path):
    file = tmp_path / "log.npz"
    np.savez(file, **arrays())
    assert optimal(rlvc.learn_from(file, discount=0.9))
    assert optimal(rlvc.learn_from(str(file), discount=0.9))


def csv(rows, head="cell,action,reward,terminated"):
    return head + "\n" + "\n".join(rows) + "\n"


def csv_rows():
    rows = []
    for cells, actions in episodes():
        for i, action in enumerate(actions):
            last = int(i + 1 == len(actions))
            rows.append(f"{cells[i]},{action},{float(last)},{last}")
    return rows


def test_csv(tmp_path):
    file = tmp_path / "log.csv"
    file.write_text(csv(csv_rows()), encoding="utf-8")
    run = rlvc.learn_from(file, columns=["cell"], discount=0.9)
    assert optimal(run, lambda cell: np.array([cell]))
    assert "cell > 3.5?" in run.text()
    assert run.agent.print("json") == rlvc.learn_from(file, discount=0.9).agent.print("json")


def test_csv_of_truncated_episodes(tmp_path):
    file = tmp_path / "log.csv"
    head = "episode,x,action,reward,terminated,truncated"
    file.write_text(
        csv(["0,1,0,0,0,0", "0,2,1,0,0,1", "0,3,,,,", "1,4,0,0,0,0", "1,5,1,1,1,0", "2,6,0,0,false,True",
             "3,7,1,0,0,0", "4,8,0,1,1,0"], head), encoding="utf-8"
    )  # fmt: skip
    with pytest.warns(errors.LogWarning, match="2 interactions are left out"):
        log = logs.read(file)
    # What the sixth and the seventh line led to is not known.
    assert log.before["x"].tolist() == [1, 2, 4, 5, 8]
    assert log.after["x"][:3].tolist() == [2, 3, 5]
    assert log.ends.tolist() == [0, 2, 0, 1, 1]


def test_exploited_is_used(tmp_path):
    exploited = np.ones(len(arrays()["actions"]), bool)
    log = logs.read(arrays(exploited=exploited))
    assert log.exploited.all()
    run = rlvc.learn_from(log, criterion="returns", steps=3, discount=0.9)
    assert run.agent.statistics.step == 3
    with pytest.raises(errors.ConfigError, match="exploited"):
        rlvc.learn_from(arrays(), criterion="returns")


def test_a_log_that_stops_midway():
    log = arrays()
    cut = {key: value[:-3] for key, value in log.items()}
    assert rlvc.learn_from(cut).agent.statistics.interactions == len(log["actions"]) - 3


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"rewards": None}, "no column reward"),
        ({"actions": np.zeros(0, int)}, "no interaction"),
        ({"actions": np.zeros(7)}, "observations: 1236; 7 actions"),
        ({"rewards": np.zeros(7)}, r"rewards: \[7\]"),
        ({"observations": np.zeros(7)}, r"observations: \[7\]"),
        ({"terminated": np.full(len(arrays()["actions"]), "no")}, "terminated: <U2: no flags"),
        (
            {"rewards": np.where(np.arange(len(arrays()["actions"])) == 9, np.inf, 0)},
            "index 9: rewards: inf",
        ),
        ({"rewards": np.full(len(arrays()["actions"]), np.nan)}, "a reward: none in index 0"),
        ({"observations": np.full(len(arrays()["observations"]), np.nan)}, "none in index 0"),
        ({"next_observations": np.zeros(3)}, "observations: "),
    ],
)
def test_damaged_arrays(changes, said):
    with pytest.raises(errors.LogError, match=said):
        rlvc.learn_from(arrays(**changes))


ODD = [
    None, 5, "x", [], {}, [[1], [1, 2]], object(), np.array(3), np.zeros(0), np.zeros((20, 0)), np.zeros((0, 2)),
    np.zeros(19), np.zeros(21), np.zeros((20, 2), bool), np.zeros(20, bool), np.zeros((20, 2, 3)),
    np.zeros((20, 40, 40)), np.zeros(20, "U3"), np.zeros(20, "S2"), np.zeros(20, "M8[s]"), np.zeros(20, "m8[s]"),
    np.zeros(20, complex), np.zeros(20, [("a", "f4")]), np.full(20, np.nan), np.full(20, 300), np.full(20, -1),
    np.full(20, 2**63, np.uint64), np.full(20, 1e300), np.full(20, 1e13),
]  # fmt: skip


@pytest.mark.parametrize(
    "name",
    ["observations", "next_observations", "actions", "rewards", "terminated", "truncated", "exploited"],
)  # fmt: skip
def test_odd_arrays_are_read_or_refused(name):
    """By an error of the package, and without a warning of numpy."""
    good = {
        "observations": np.zeros((20, 2)), "next_observations": np.zeros((20, 2)),
        "actions": np.zeros(20, int), "rewards": np.zeros(20), "terminated": np.ones(20, bool),
    }  # fmt: skip
    refused = 0
    for values in ODD:
        try:
            rlvc.learn_from({**good, name: values})
        except errors.Error:
            refused += 1
    assert refused > len(ODD) / 2


@pytest.mark.parametrize("log", [None, 5, (1, 2), [1], np.zeros(3), {1: 2}, b"log.csv"], ids=repr)
def test_what_is_no_log(log):
    with pytest.raises(errors.LogError):
        rlvc.learn_from(log)


@pytest.mark.parametrize(
    "changes",
    [{"actions": "x"}, {"actions": 0}, {"actions": 256}, {"steps": "1"}, {"steps": 0}, {"seed": "x"}, {"seed": -1},
     {"thresholds": "x"}, {"nonsense": 1}, {"encoder": 3}],
    ids=repr,
)  # fmt: skip
def test_numbers_of_the_caller(changes):
    with pytest.raises(errors.ConfigError, match="cutpoints|" + next(iter(changes))):
        rlvc.learn_from(arrays(), **changes)


@pytest.mark.parametrize(("place", "bits"), [(6, 1), (8, 99)])
def test_npz_that_cannot_be_unpacked(tmp_path, place, bits):
    """Marked as encrypted, or compressed in an unknown way."""
    file = tmp_path / "log.npz"
    np.savez(file, **arrays())
    content = bytearray(file.read_bytes())
    entry = content.find(b"PK\x01\x02")
    content[place] |= bits
    content[entry + place + 2] |= bits
    file.write_bytes(content)
    with pytest.raises(errors.LogError, match="cannot be read as NPZ"):
        rlvc.learn_from(file)


def test_ctrl_c_keeps_what_was_learnt(monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(rlvc.Agent, "learn", interrupted)
    run = rlvc.learn_from(arrays())
    assert run.interrupted
    assert run.agent.statistics.interactions == len(arrays()["actions"])


def test_actions_out_of_range():
    with pytest.raises(errors.LogError, match=r"index \d+: 1 is not in \[0, 1\)"):
        rlvc.learn_from(arrays(), actions=1)


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 broken", b"\x93NUMPY", "cut", "pickle"])
def test_damaged_npz(tmp_path, content):
    file = tmp_path / "log.npz"
    if content == "cut":
        np.savez(file, **arrays())
        file.write_bytes(file.read_bytes()[:-200])
    elif content == "pickle":
        np.savez(file, **arrays(observations=np.array([{}], object)))
    else:
        file.write_bytes(content)
    with pytest.raises(errors.LogError, match=r"log\.npz"):
        rlvc.learn_from(file)


def test_what_is_masked_is_missing():
    given = arrays()
    hidden = np.ma.masked_array(given["observations"], mask=np.zeros(given["observations"].shape))
    hidden[3] = np.ma.masked
    with pytest.warns(errors.LogWarning):
        log = logs.read({**given, "observations": hidden})
    assert "1 row is left out, for want of an observation, first index 3" in log.describe()
    assert len(log) < len(given["actions"])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "is empty"),
        ("cell,reward,terminated\n", "line 1: no column action"),
        ("cell,action,reward\n1,0,0\n", "line 1: no column terminated"),
        ("action,reward,terminated\n0,0,1\n", "line 1: no column for the observation"),
        ("c,action,action,reward,terminated\n", "line 1: columns 2 and 3 have the same name"),
        (csv([]), "no interaction"),
        (csv(["1,0,0,0", "2,0,0"]), "line 3: 3 fields, not 4"),
        (csv(["1,0,0,0", "\n\n2,zero,0,1"]), "line 5: action: 'zero' is not a number"),
        (csv(["1,0,0,0", "2,0.5,0,1"]), "line 3: action: 0.5 is not a whole number"),
        (csv(["1,0,inf,1"]), "line 2: reward: inf"),
        (csv(["1,0,,1"]), "a reward: none in line 2"),
        (csv([",0,0,1"]), "none in line 2"),
        (csv(["1,0,0,2"]), "line 2: terminated: 2.0"),
        (csv(["1,,0,1"]), "line 2: terminated without an action"),
        ('cell,action,reward,terminated\n"1,0,0,1\n', "cannot be read as CSV"),
    ],
)
def test_damaged_csv(tmp_path, text, said):
    file = tmp_path / "log.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(errors.LogError, match=r"log\.csv: ") as caught:
        rlvc.learn_from(file)
    assert said in str(caught.value)


def test_other_files(tmp_path):
    file = tmp_path / "log.txt"
    file.write_text("", encoding="utf-8")
    with pytest.raises(errors.LogError, match="is empty"):
        rlvc.learn_from(file)
    other = tmp_path / "log.xyz"
    other.write_bytes(b"\x01\x00\x02\x00" * 9)
    with pytest.raises(errors.LogError, match="neither text"):
        rlvc.learn_from(other)
    with pytest.raises(errors.LogError, match="cannot be read"):
        rlvc.learn_from(tmp_path / "none.csv")
    binary = tmp_path / "log.csv"
    binary.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(errors.LogError, match="cannot be read"):
        rlvc.learn_from(binary)


@pytest.mark.filterwarnings("ignore::UserWarning")  # of what the data set does not say
def test_minari(tmp_path, monkeypatch):
    minari = pytest.importorskip("minari")
    from gymnasium import spaces
    from minari.data_collector import EpisodeBuffer

    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path))
    buffers = [
        EpisodeBuffer(
            observations=[np.int64(c) for c in cells],
            actions=[np.int64(a) for a in actions],
            rewards=[float(i + 1 == len(actions)) for i in range(len(actions))],
            terminations=[i + 1 == len(actions) for i in range(len(actions))],
            truncations=[False] * len(actions),
        )
        for cells, actions in episodes()
    ]
    dataset = minari.create_dataset_from_buffers(
        "test/line-v0", buffers, observation_space=spaces.Discrete(8), action_space=spaces.Discrete(2),
        author="x", author_email="x@example.org", code_permalink="https://example.org", algorithm_name="walk",
        description="A walk.",
    )  # fmt: skip
    run = rlvc.learn_from(dataset, space=dataset.spec.observation_space, discount=0.9)
    assert optimal(run, np.int64)
    assert optimal(
        rlvc.learn_from("test/line-v0", space=spaces.Discrete(8), discount=0.9), np.int64
    )
    with pytest.raises(errors.LogError, match="test/none-v0"):
        rlvc.learn_from("test/none-v0")


class Controller:
    """Writes a log by the library's writer, as a controller does; notes where each record ends."""

    def __init__(self, percept_bytes=1, actions=2):
        self.text, self.ends = bytearray(), []
        self.sink = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_uint32)(
            lambda _, data, count: self.text.extend(ctypes.string_at(data, count)) or 0
        )  # fmt: skip
        self.writer = ctypes.create_string_buffer(64)
        self.sizes = (percept_bytes, actions)
        self.open()

    def call(self, name, *arguments):
        assert getattr(_native.call, name)(self.writer, *arguments) == 0
        self.ends.append(len(self.text))

    def open(self):
        self.call("rlvc_log_open", *self.sizes, self.sink, None)

    def begin(self, percept):
        self.call("rlvc_log_begin", bytes(percept))

    def observe(self, action, reward, percept, end, exploited=0):
        choice = _native.Choice(action, exploited)
        self.call("rlvc_log_observe", choice, reward, bytes(percept) if percept else None, end)

    def walk(self, count=60, seed=1):
        for cells, actions in episodes(count, seed):
            self.begin([cells[0]])
            for i, action in enumerate(actions):
                last = i + 1 == len(actions)
                self.observe(
                    action, float(last), [cells[i + 1]] if not last else None, int(last), i % 2
                )
        return self


def kept(tmp_path, text):
    file = tmp_path / "walk.bin"
    file.write_bytes(bytes(text))
    return file


def test_a_controllers_log(tmp_path):
    file = kept(tmp_path, Controller().walk().text)
    log = logs.read(str(file))
    before = np.concatenate([cells[:-1] for cells, _ in episodes()])
    assert log.before[:, 0].tolist() == before.tolist()
    assert log.actions.tolist() == arrays()["actions"].tolist()
    assert log.rewards.tolist() == arrays()["rewards"].tolist()
    assert (log.ends == 1).tolist() == arrays()["terminated"].tolist()
    assert log.exploited.any() and not log.exploited.all()
    run = rlvc.learn_from(file, domain=3, discount=0.9)
    assert optimal(run, lambda cell: bytes([cell]))
    assert rlvc.learn_from(file, discount=0.9).agent.domain.bits == 8
    bits = (arrays()["observations"][:, None] >> np.arange(3) & 1).astype(bool)
    other = rlvc.learn_from(arrays(observations=bits), discount=0.9)
    assert other.agent.print("json") == run.agent.print("json")


def test_a_controllers_log_of_another_domain(tmp_path):
    writer = Controller(200, 3)
    for i in range(40):
        writer.begin(
            np.array([1], np.uint32).tobytes() + np.float32([i % 2]).tobytes() + bytes(192)
        )
        writer.observe(i // 2 % 2, float(i % 2 == i // 2 % 2), None, 1)
    file = kept(tmp_path, writer.text)
    with pytest.raises(errors.ConfigError, match="too many to be bits"):
        rlvc.learn_from(file)
    with pytest.raises(errors.ConfigError, match="200"):
        rlvc.learn_from(file, domain=3)
    domain = rlvc.Descriptors(points=49, dimensions=1, radius=0.5)
    run = rlvc.learn_from(file, domain=domain)
    assert run.agent.config.actions == 3
    assert run.act(np.zeros((1, 1), np.float32)) == 0
    assert run.act(np.ones((1, 1), np.float32)) == 1
    writer.begin(b"\xff" * 200)
    writer.observe(0, 0.0, None, 1)
    with pytest.raises(errors.PerceptError, match="more than 49 vectors"):
        rlvc.learn_from(kept(tmp_path, writer.text), domain=domain)


def test_every_torn_tail(tmp_path):
    """Wherever a log is cut, what came before is used, and what was going on is truncated."""
    writer = Controller().walk(4)
    whole = logs.read(kept(tmp_path, writer.text))
    for cut in range(writer.ends[2], len(writer.text)):
        log = logs.read(kept(tmp_path, writer.text[:cut]))
        count = len(log)
        assert 0 < count <= len(whole)
        assert (log.before == whole.before[:count]).all()
        assert log.ends[:-1].tolist() == whole.ends[: count - 1].tolist()
        assert log.ends[-1] == (whole.ends[count - 1] or 2)


def test_a_writer_that_was_opened_again(tmp_path):
    """After a record cut short a header follows, and the rest is used."""
    writer = Controller().walk(2)
    count = len(logs.read(kept(tmp_path, writer.text)))
    writer.begin([0])
    writer.observe(1, 0.0, [1], 0)
    writer.observe(1, 0.0, [2], 0)
    del writer.text[-7:]
    writer.open()
    writer.walk(3, seed=2)
    log = logs.read(kept(tmp_path, writer.text))
    assert log.ends[count] == 2
    assert len(log) == count + 1 + sum(len(a) for _, a in episodes(3, 2))


def test_damaged_logs_of_controllers(tmp_path):
    writer = Controller().walk(3)
    text, ends = writer.text, writer.ends
    for at in range(ends[0], ends[-2]):
        spoilt = bytearray(text)
        spoilt[at] ^= 0x10
        with pytest.raises(errors.LogError, match=r"walk\.bin: from byte \d+ on: ") as caught:
            logs.read(kept(tmp_path, spoilt))
        said = int(str(caught.value).split("byte ")[1].split()[0])
        assert said == max(end for end in ends if end <= at)
    without = text[: ends[4]] + text[ends[5] :]
    with pytest.raises(
        errors.LogError, match=f"from byte {ends[4]} on: bytes or records are missing"
    ):
        logs.read(kept(tmp_path, without))
    mixed = text + Controller(2).walk(0).text
    with pytest.raises(errors.LogError, match="other percepts"):
        logs.read(kept(tmp_path, mixed))
    for short in (text[:2], text[: ends[0]], text[: ends[1]]):
        with pytest.raises(errors.LogError, match="no interaction"):
            logs.read(kept(tmp_path, short))
    with pytest.raises(errors.LogError, match="neither"):
        logs.read(kept(tmp_path, text[1:]))
