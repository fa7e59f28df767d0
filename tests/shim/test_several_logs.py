# SPDX-License-Identifier: MIT
"""Several files are one log: no episode goes on from one to the next."""

import numpy as np
import pytest
from walk import BASE, ROWS, table

import rlvc
from rlvc import errors, logs

HEAD = "cell,action,reward,terminated"


def write(file, rows, head=HEAD):
    file.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    return file


def parts(tmp_path, cuts, kinds=("csv", "npz", "jsonl")):
    """The walk in files of several kinds, cut where it is told."""
    text = table(
        "state,action,reward,next_state,terminated,truncated",
        lambda e, t, s, a, r, n, d, u: (s, a, r, n, int(d), int(u)),
    )
    lines, files = text.splitlines(), []
    for i, (low, high) in enumerate(zip((0, *cuts), (*cuts, len(ROWS)), strict=True)):
        kind = kinds[i % len(kinds)]
        file = tmp_path / f"part{i}.{kind}"
        if kind == "npz":
            inside = slice(low, high)
            arrays = {name: BASE[key][inside] for name, key in (
                ("state", "cell"), ("action", "action"), ("reward", "reward"), ("next_state", "next"),
                ("terminated", "terminated"), ("truncated", "truncated"))}  # fmt: skip
            np.savez(file, **arrays)
        else:
            write(file, lines[1 + low : 1 + high], lines[0])
            if kind == "jsonl":
                rows = [dict(zip(lines[0].split(","), map(float, line.split(",")), strict=True))
                        for line in lines[1 + low : 1 + high]]  # fmt: skip
                file.write_text("\n".join(str(row).replace("'", '"') for row in rows) + "\n")
        files.append(file)
    return files


@pytest.mark.parametrize("cuts", [(40,), (40, 41), (100, 150, 200)])
def test_the_parts_of_a_walk(cuts, tmp_path):
    """Cut anywhere, into files of any kind, it is the walk, with a cut that counts as truncated."""
    files = parts(tmp_path, cuts)
    log = logs.read(files)
    ends = np.where(BASE["terminated"], 1, np.where(BASE["truncated"], 2, 0))
    for cut in (*cuts, len(ROWS)):
        ends[cut - 1] = ends[cut - 1] or 2
    assert log.ends.tolist() == ends.tolist()
    assert next(iter(log.before.values())).tolist() == BASE["cell"].tolist()
    assert log.actions.tolist() == BASE["action"].tolist()
    whole = logs.read(files[0])
    assert rlvc.learn_from(files[:1]).text() == rlvc.learn_from(whole).text()


def test_no_row_of_one_file_is_next_in_another(tmp_path):
    """Without columns for the next observation the last row of each file has none."""
    files = [
        write(tmp_path / f"{i}.csv", [f"{10 * i + t},0,0,0" for t in range(3)]) for i in range(2)
    ]
    log = logs.read(files)
    assert log.before["cell"].tolist() == [0, 1, 10, 11]
    assert log.after["cell"].tolist() == [1, 2, 11, 12]
    assert log.ends.tolist() == [0, 2, 0, 2]


def test_what_occurs_in_one_file_only_counts(tmp_path):
    one = write(tmp_path / "a.csv", ["red,go,0,1", "red,stop,1,1"])
    other = write(tmp_path / "b.csv", ["blue,go,1,1", "blue,wait,0,1"])
    log = logs.read((one, str(other)))
    assert log.known.words == ["go", "stop", "wait"]
    assert log.space.columns == {"cell": ["blue", "red"]}
    assert log.actions.tolist() == [0, 1, 0, 2]
    assert "a.csv: 2 interactions" in log.describe()
    assert "b.csv: 2 interactions" in log.describe()
    numbers = [write(tmp_path / f"{n}.csv", [f"0,{n},0,1"]) for n in (5, 7, 6)]
    assert logs.read(numbers).known.start == 5
    assert logs.read(numbers).actions.tolist() == [0, 2, 1]


@pytest.mark.parametrize(
    ("rows", "head", "said"),
    [
        (["0,0,0,0,1"], f"other,{HEAD}", "observes the columns other, cell"),
        (["red,0,0,1"], HEAD, r"observes the columns cell \(words\)"),
        (["0,go,0,1"], HEAD, "its actions are words, those of"),
        (["0,0,0"], HEAD.replace(",terminated", ""), "b.csv: line 1: no column terminated"),
    ],
)
def test_files_that_differ_are_refused(rows, head, said, tmp_path):
    one = write(tmp_path / "a.csv", ["0,1,0,1"])
    with pytest.raises(errors.LogError, match=said) as caught:
        logs.read([one, write(tmp_path / "b.csv", rows, head)])
    assert "b.csv" in str(caught.value)


def test_grids_of_files_are_refused(tmp_path):
    files = [write(tmp_path / f"{i}.csv", [f"0,{i}.5,0,1"]) for i in range(2)]
    with pytest.raises(errors.ConfigError, match="bins: each file"):
        logs.read(files, bins=3)
