# SPDX-License-Identifier: MIT
"""Learning from the frames of a camera with a log beside them."""

import numpy as np
import pytest
from conftest import without_vision

from rlvc import __main__ as command
from rlvc import errors, objects

pytestmark = pytest.mark.skipif(bool(without_vision()), reason=without_vision())
THINGS = 4


@pytest.fixture(scope="module")
def views():
    return objects.find(wanted=THINGS).pictures[:, 0]


def write(path, picture, depth=8):
    """A picture as PPM."""
    height, width = picture.shape[:2]
    high = 255 if depth == 8 else 65535
    pixels = picture if depth == 8 else (picture.astype(np.uint16) * 257).astype(">u2")
    path.write_bytes(f"P6 {width} {height} {high}\n".encode() + pixels.tobytes())


@pytest.fixture
def folder(tmp_path, views):
    """160 looks at four things, of which the odd ones belong in box 1; frame2 is before frame10."""
    random, made = np.random.default_rng(1), tmp_path / "frames"
    made.mkdir()
    lines = ["frame,action,reward,done"]
    for i in range(160):
        thing, action = i % THINGS, int(random.integers(2))
        write(made / f"frame{i}.ppm", views[thing])
        lines.append(f"frame{i}.ppm,{action},{int(action == thing % 2)},1")
    (made / "log.csv").write_text("\n".join(lines) + "\n")
    return made


def change(folder, old, new):
    log = folder / "log.csv"
    log.write_text(log.read_text().replace(old, new))


def sorts(run, views):
    return [run.predict(view) for view in views] == [0, 1, 0, 1]


def test_a_folder_with_its_log(folder, views):
    from rlvc import frames, vision

    run = frames.learn_from_frames(folder, discount=0.0)
    assert sorts(run, views)
    assert run.agent.statistics.stored == 160
    assert isinstance(run.encoder, vision.Eye)
    again = frames.learn_from_frames(folder, folder / "log.csv", eye=run.encoder, discount=0.0)
    assert again.text() == run.text()


@pytest.mark.parametrize("how", ["without ending", "number", "paths", "in order", "other name"])
def test_how_frames_are_named(folder, views, how):
    from rlvc import frames

    options = {}
    if how == "without ending":
        change(folder, ".ppm", "")
    elif how == "number":
        change(folder, ".ppm", "")
        change(folder, "\nframe", "\n")
    elif how == "paths":
        change(folder, "\nframe", "\nC:\\camera\\frame")
    elif how == "in order":
        rows = (folder / "log.csv").read_text().split("\n")
        (folder / "log.csv").write_text("\n".join(row.partition(",")[2] for row in rows))
    else:
        change(folder, "frame,", "seen,")
        options["column"] = "seen"
    assert sorts(frames.learn_from_frames(folder, discount=0.0, **options), views)


def test_a_number_is_that_in_the_names(tmp_path, views):
    from rlvc import frames

    def found(names, *words):
        made = tmp_path / "-".join(names)
        made.mkdir()
        for name in names:
            (made / f"{name}.png").touch()
        return [frames.Frames(made).number(word) for word in words]

    assert found(["000001", "000002", "000004"], 1.0, 4.0, 0.0, 3.0) == [0, 2, None, None]
    assert found(["frame3", "frame10"], 3.0, 10.0, "frame10", 0.0) == [0, 1, 1, None]
    assert found(["left", "right"], 0.0, 1.0, 2.0, -1.0, 0.5) == [0, 1, None, None, None]
    assert found(["a1", "b2"], 0.0, 2.0) == [0, None]  # several texts
    assert found(["1", "01"], 0.0, "01", 2.0) == [0, 0, None]  # one number twice


def test_the_next_frame_is_in_the_next_row(tmp_path, views):
    """A walk over three things in a row, of which entering the third pays and ends it."""
    from rlvc import frames

    for i in range(3):
        write(tmp_path / f"{i}.ppm", views[i])
    random, lines, at = np.random.default_rng(2), ["image;action;reward;done"], 0
    for _ in range(400):
        action = int(random.integers(2))
        to = min(at + 1, 2) if action else max(at - 1, 0)
        lines.append(f"{at}.ppm;{action};{int(to == 2)};{int(to == 2)}")
        at = to % 2
    (tmp_path.parent / f"{tmp_path.name}.csv").write_text("\n".join(lines) + "\n")
    run = frames.learn_from_frames(tmp_path, discount=0.9)
    assert [run.predict(view) for view in views[:2]] == [1, 1]
    values = run.agent.q.max(1)
    classes = [run.agent.predict(run.encoder.encode(view)).class_id for view in views[:2]]
    assert values[classes].tolist() == pytest.approx([0.9, 1.0], abs=0.02)


def test_what_is_wrong_is_named(folder, tmp_path):
    from rlvc import frames

    def told(error, match, where=folder, *arguments, **options):
        with pytest.raises(error, match=match):
            frames.learn_from_frames(where, *arguments, discount=0.0, **options)

    content = (folder / "log.csv").read_text()
    told(errors.PictureError, "neither a folder of pictures nor a video", tmp_path / "none")
    told(errors.LogError, r"no column seen \(present: frame, action", folder, column="seen")
    told(errors.LogError, "frame3.ppm: one picture: give the folder", folder / "frame3.ppm")
    (folder / "log.csv").write_text("frame,action,reward,done\n00,1,0,1\n01,1,0,1\n")
    told(errors.LogError, "line 2: frame: several numbers: write the name of a file")
    (folder / "log.csv").write_text(content)
    change(folder, "frame7.ppm", "frame700.ppm")
    told(errors.LogError, r"line 9: frame: frame700\.ppm is no frame of")
    (folder / "log.csv").write_text(content.replace("done", "image", 1))
    told(errors.LogError, "frame and image may name the frames: pass column")
    (folder / "log.csv").write_text(content.replace("frame", "x", 1).rsplit("\n", 2)[0] + "\n")
    told(errors.LogError, "no column names the frames, of which there are 160 for 159 rows")
    (folder / "other.csv").write_text(content)
    told(errors.LogError, "several logs: log.csv, other.csv")
    (folder / "other.csv").unlink()
    (folder / "log.csv").unlink()
    told(errors.LogError, "there is no log: neither in it nor as frames.csv beside")
    (folder / "log.csv").write_text(content)
    (folder / "frame3.ppm").write_bytes(b"P6 64")
    told(errors.PictureError, "frame3.ppm: not a picture")
    empty = tmp_path / "empty"
    empty.mkdir()
    told(errors.PictureError, "there is no picture in", empty)


@pytest.mark.parametrize("value", [None, 3, "", "a\0b", "\ud800", [[]]], ids=repr)
def test_what_is_no_name(value):
    from rlvc import frames

    for call, error in (
        (frames.Frames, errors.PictureError),
        (frames.find_log, errors.LogError),
        (objects.read, errors.PictureError),
    ):
        with pytest.raises(error, match=r"^(frames|picture): .*: not the name of a file$"):
            call(value)
    with pytest.raises(errors.ConfigError, match="scale_depth: "):
        objects.read("some.png", scale_depth=2)


def test_sixteen_bits(folder, views):
    from rlvc import frames

    write(folder / "frame3.ppm", views[3], 16)
    with pytest.raises(errors.PictureError, match=r"frame3\.ppm: not 8 bits a channel"):
        frames.learn_from_frames(folder)
    assert sorts(frames.learn_from_frames(folder, scale_depth=True, discount=0.0), views)
    assert (objects.read(folder / "frame3.ppm", scale_depth=True) == views[3]).all()
    assert objects.read(folder / "frame2.ppm", resize=16).shape == (16, 16, 3)


def test_a_video(tmp_path, views):
    cv2 = pytest.importorskip("cv2")
    from rlvc import frames

    height, width = views.shape[1:3]
    video = cv2.VideoWriter(
        str(tmp_path / "seen.avi"), cv2.VideoWriter_fourcc(*"MJPG"), 10, (width, height)
    )
    random, lines = np.random.default_rng(1), ["action,reward,done"]
    for i in range(160):
        video.write(np.ascontiguousarray(views[i % THINGS][:, :, ::-1]))
        action = int(random.integers(2))
        lines.append(f"{action},{int(action == i % THINGS % 2)},1")
    video.release()
    (tmp_path / "seen.csv").write_text("\n".join(lines) + "\n")
    run = frames.learn_from_frames(tmp_path / "seen.avi", discount=0.0)
    shown = dict(frames.Frames(tmp_path / "seen.avi").pictures(range(4, 8)))
    assert list(shown) == [4, 5, 6, 7]
    assert all(abs(shown[4 + i].astype(int) - views[i]).mean() < 5 for i in range(4))
    assert sorts(run, shown.values())
    (tmp_path / "seen.csv").write_text("\n".join([*lines, *lines[1:]]) + "\n")
    with pytest.raises(errors.LogError, match=r"seen\.avi has no frame 160: it ends before"):
        frames.learn_from_frames(tmp_path / "seen.avi")
    (tmp_path / "seen.avi").write_bytes(b"no video")
    with pytest.raises(errors.PictureError, match="not a video that can be read"):
        frames.learn_from_frames(tmp_path / "seen.avi")


def test_a_damaged_eye_is_refused(folder):
    from rlvc import frames
    from rlvc.agent.kept import pack, unpack
    from rlvc.learning import store

    head, body = unpack("run", store.packed(frames.learn_from_frames(folder, discount=0.0)))
    eye = head["eye"]
    assert store.unpacked(pack("run", head, body)).encoder.to_dict() == eye
    for wrong in (
        3, [], {}, eye | {"metric": "{}"}, eye | {"metric": 3}, eye | {"metric": None}, eye | {"order": "x"},
        eye | {"cache": -1}, eye | {"config": {"points": 5}}, eye | {"config": {"x": 1}},
        eye | {"parameters": {"radius": -1.0}}, eye | {"parameters": 3}, eye | {"second": 3}, eye | {"second": {}},
    ):  # fmt: skip
        with pytest.raises(errors.SnapshotError, match="damaged: "):
            store.unpacked(pack("run", head | {"eye": wrong}, body))
    with pytest.raises(errors.SnapshotError, match="pass it as encoder"):
        store.unpacked(pack("run", head | {"eye": None}, body))


def test_from_a_shell(folder, tmp_path, capsys, views):
    from rlvc import frames, vision

    made = tmp_path / "metric.json"
    arguments = ["learn", "--frames", str(folder), "--discount", "0", "--save-metric", str(made)]
    assert command.main([*arguments, "--c", str(tmp_path / "sort.h"), "--quiet"]) == 0
    assert "classes after 160 interactions" in capsys.readouterr().out
    text = (tmp_path / "sort.h").read_text()
    assert "policy_act(const void *percept)" in text
    eye = vision.Eye(vision.Extractor(metric=vision.Metric.load(made)))
    assert sorts(frames.learn_from_frames(folder, eye=eye, discount=0.0), views)
    kept, picture = str(tmp_path / "sort.rlvc"), str(folder / "frame3.ppm")
    assert command.main([*arguments, "--save", kept, "--quiet"]) == 0
    learnt = capsys.readouterr().out
    assert command.main(["show", kept]) == 0
    assert capsys.readouterr().out == learnt
    assert command.main(["explain", kept, picture]) == 0
    assert "-> action 1, value 1" in capsys.readouterr().out
    assert command.main(["explain", kept, "5"]) == 1
    assert "rlvc: 5: " in capsys.readouterr().err
    assert command.main(["export", kept, "--c", "-"]) == 0
    assert capsys.readouterr().out == text
    pytest.importorskip("matplotlib")
    drawn = tmp_path / "path.svg"
    assert command.main(["plot", kept, "path", str(drawn), "--observation", picture]) == 0
    assert drawn.exists()
    for wrong in (
        ["learn", "--frames", str(folder), "--seeds", "2"],
        ["learn", "--frames", str(folder), "--columns", "frame"],
        ["learn", "--frames", str(tmp_path)],
        ["learn", "--frames", str(folder), "--log", "a.csv", "b.csv"],
        ["learn", "--frames", str(folder), "FrozenLake-v1"],
        ["learn", "FrozenLake-v1", "--save-metric", "x"],
    ):
        assert command.main([*wrong, "--quiet"]) in (1, 2)
        told = capsys.readouterr()
        assert told.out == "" and told.err.startswith("rlvc: ") and told.err.count("\n") == 1


