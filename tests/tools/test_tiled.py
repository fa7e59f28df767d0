# SPDX-License-Identifier: MIT
"""run_gridworld tiled and the camera example, on rendered objects and on pictures made here.

RLVC_COIL100 names a folder of COIL-100 photographs for the tests that want them."""

import json
import os
import re
import resource
import signal
import subprocess

import numpy
import pytest

PROGRAM = os.environ["RLVC_RUN_GRIDWORLD"]
CAMERA = os.environ.get("RLVC_CAMERA")
COIL100 = os.environ.get("RLVC_COIL100")


def run(*arguments, program=PROGRAM, cwd=None, preexec_fn=None):
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True,
                          errors="replace", timeout=500, cwd=cwd, preexec_fn=preexec_fn)


def tiled(*arguments):
    return run("tiled", *arguments)


LEFT_OUT = "built without vision" in tiled("--maze", "small", "--interactions", 10).stderr


@pytest.fixture(autouse=True)
def vision(request):
    if LEFT_OUT and request.node.name != "test_left_out":
        pytest.skip("built without vision")


@pytest.mark.skipif(not LEFT_OUT, reason="built with vision")
def test_left_out():
    result = tiled("--help")
    assert result.returncode == 2
    assert "libopencv-dev" in result.stderr


def test_bags_and_pairs():
    result = tiled("--bags", "--pairs")
    assert result.returncode == 2
    assert "--bags" in result.stderr and "--pairs" in result.stderr
    assert result.stderr.count("\n") == 1


def report(tmp_path, *arguments):
    file = tmp_path / "report.json"
    result = tiled(*arguments, "--json", file)
    assert result.returncode == 0, result.stderr
    return json.loads(file.read_text())


def picture(number, shift=0, size=(64, 64), channels=3):
    """Blocks of colour: few points to find would be none to learn from."""
    random = numpy.random.default_rng(number)
    blocks = random.integers(0, 255, (12, 12, channels), dtype=numpy.uint8)
    large = numpy.kron(blocks, numpy.ones((8, 8, 1), dtype=numpy.uint8))
    return large[shift:shift + size[0], shift:shift + size[1]]


def write(path, pixels):
    """Binary PPM or PGM."""
    height, width, channels = pixels.shape
    path.write_bytes(b"P%d %d %d 255\n" % (6 if channels == 3 else 5, width, height)
                     + pixels.tobytes())


@pytest.fixture
def folder(tmp_path):
    made = tmp_path / "pictures"
    made.mkdir()
    for i in range(10):
        write(made / f"a{i}.ppm", picture(i))
    return made


@pytest.mark.parametrize("descriptor", ["invariants", "sqrt-invariants", "sift-upright", "sift",
                                        "orb"])
def test_fixed_pictures(tmp_path, descriptor):
    made = report(tmp_path, "--maze", "small", "--interactions", 800, "--descriptor", descriptor)
    assert made["optimal_seen"] == made["optimal_heldout"] == 1.0
    assert made["runs"][0]["optimal_cells"] == made["runs"][0]["cells"] == 10
    assert made["runs"][0]["classes"] <= 10


def test_returns(tmp_path):
    made = report(tmp_path, "--maze", "small", "--criterion", "returns", "--interactions", 1000,
                  "--steps", 8, "--descriptor", "invariants")
    assert made["optimal_seen"] == 1.0


def test_poses_never_seen(tmp_path):
    """Bar: of the rendered objects, at a size that continuous integration can afford."""
    made = report(tmp_path, "--maze", "small", "--poses", "0,20,-20", "--test-poses", "10,-10",
                  "--noise", 3, "--light", 0.05, "--interactions", 1500, "--runs", 3)
    assert made["optimal_seen"] >= 0.99
    assert made["optimal_heldout"] >= 0.97
    assert max(one["classes"] for one in made["runs"]) <= 15


def test_report_and_tree(tmp_path):
    dot = tmp_path / "tree.dot"
    made = report(tmp_path, "--maze", "small", "--interactions", 800, "--dot", dot)
    assert "object" in dot.read_text() and "digraph" in dot.read_text()
    assert made["kind"] == "run_gridworld tiled"
    assert all(one["points"] for one in made["objects"])
    assert made["features"]["dimensions"] == 128  # nothing changes: there is nothing to discriminate
    once = made["runs"][0]
    assert len(once["tests"]) == once["classes"] - 1
    for test in once["tests"]:  # a feature is a point of some object
        points = made["objects"][test["object"]]["points"]
        assert [test["x"], test["y"]] in [point[:2] for point in points]
    assert {cell["object"] for cell in once["cell"]} == set(range(10))


def test_axes_and_snapshot(tmp_path):
    kept = tmp_path / "agent"
    arguments = ("--maze", "small", "--noise", 3, "--interactions", 200)
    made = report(tmp_path, *arguments, "--axes", 7, "--snapshot", kept)
    features = made["features"]
    assert (features["form"], features["dimensions"], features["candidates"]) == ("int8", 7, 64)
    data = kept.read_bytes()
    assert data[:4] == b"RLVS" and int.from_bytes(data[12:16], "little") == len(data)
    assert int.from_bytes(data[16:20], "little") == 4 + (30 * 7 + 3) // 4 * 4
    assert report(tmp_path, *arguments, "--axes", 0)["features"]["dimensions"] == 128


@pytest.mark.parametrize("descriptor", ["sift-upright", "sift"])
def test_pairs(tmp_path, descriptor):
    made = report(tmp_path, "--maze", "small", "--interactions", 800, "--pairs",
                  "--descriptor", descriptor)
    assert made["optimal_seen"] == 1.0
    assert made["options"]["pairs"] is True
    for test in made["runs"][0]["tests"]:
        assert test["name"].startswith("vector " if test["second"] is None else "pair ")


def test_bags(tmp_path):
    dot = tmp_path / "tree.dot"
    made = report(tmp_path, "--maze", "small", "--interactions", 1500, "--noise", 2, "--bags",
                  "--dot", dot)
    assert made["optimal_seen"] >= 0.9
    options, features = made["options"], made["features"]
    assert options["bags"] is True and options["points"] == 120 and options["sigma"] == 2.5
    assert features["candidates"] == 16
    tests = made["runs"][0]["tests"]
    assert tests
    for test in tests:
        bag = test["bag"]
        assert test["name"].startswith("bag ") and test["radius"] is test["x"] is None
        assert 0 < bag["needed"] <= len(bag["points"]) <= bag["count"] <= 32
        points = made["objects"][test["object"]]["points"]
        assert all([p["x"], p["y"]] in [point[:2] for point in points] for p in bag["points"])
    assert "needed" in dot.read_text()
    refused = tiled("--bags", "--pairs")
    assert refused.returncode == 2 and "--pairs" in refused.stderr


def test_same_seed_same_run(tmp_path):
    arguments = ("--maze", "small", "--noise", 3, "--copies", 2, "--interactions", 500)
    one, other = (report(tmp_path, *arguments) for _ in range(2))
    for made in one, other:
        del made["milliseconds_a_picture"], made["runs"][0]["seconds"]
    assert one == other


def test_an_interrupt_keeps_the_finished_runs(tmp_path):
    file = tmp_path / "report.json"
    arguments = [PROGRAM, "tiled", "--maze", "small", "--interactions", "100", "--runs", "1000",
                 "--json", str(file)]
    environment = {**os.environ, "LC_ALL": "C"}
    with subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          env=environment) as program:
        rows = (line for line in program.stdout if re.match(r" *\d+ ", line))
        next(rows)
        next(rows)  # two runs are done
        program.send_signal(signal.SIGINT)
        _, errors = program.communicate(timeout=300)
    assert program.returncode == 128 + signal.SIGINT, errors
    said = re.fullmatch(r"run_gridworld: interrupted after (\d+) of 1000 runs, which were kept\n", errors)
    made = json.loads(file.read_text())
    assert 2 <= int(said[1]) == len(made["runs"]) < 1000


def test_a_file_an_object(tmp_path, folder):
    made = report(tmp_path, "--maze", "small", "--images", folder, "--interactions", 800)
    assert made["optimal_seen"] == 1.0
    assert [one["name"] for one in made["objects"]] == [f"a{i}" for i in range(10)]


def test_a_picture_without_a_point_is_legal(tmp_path, folder):
    write(folder / "a3.ppm", numpy.full((64, 64, 3), 9, numpy.uint8))
    made = report(tmp_path, "--maze", "small", "--images", folder, "--interactions", 1500)
    assert made["objects"][3]["points"] == []
    assert made["optimal_seen"] == 1.0


def test_metric_is_kept(tmp_path, folder):
    metric = tmp_path / "metric.json"
    arguments = ("--maze", "small", "--images", folder, "--interactions", 100)
    assert tiled(*arguments, "--save-metric", metric).returncode == 0
    assert tiled(*arguments, "--metric", metric).returncode == 0
    refused = tiled(*arguments, "--metric", metric, "--descriptor", "orb")
    assert refused.returncode == 2
    assert "sift-upright" in refused.stderr and "orb" in refused.stderr


def spoil(folder, how):
    if how == "not a picture":
        (folder / "a5.ppm").write_text("hello")
    elif how == "empty file":
        (folder / "a5.ppm").write_bytes(b"")
    elif how == "grey among colour":
        write(folder / "a5.ppm", picture(5, channels=1))
    elif how == "among pictures of 64 x 64":
        write(folder / "a5.ppm", picture(5, size=(63, 64)))
    elif how == "8 bits":
        (folder / "a5.ppm").write_bytes(b"P6 64 64 65535\n" + bytes(64 * 64 * 6))
    elif how == "only 9 objects":
        (folder / "a5.ppm").unlink()
    elif how == "a5.ppm: not a regular file":
        (folder / "a5.ppm").unlink()
        (folder / "a5.ppm").symlink_to("a5.ppm")
    elif how == "no picture":
        for file in folder.iterdir():
            file.unlink()
    elif how == "cannot read":
        for file in folder.iterdir():
            file.unlink()
        folder.rmdir()


@pytest.mark.parametrize("how", ["not a picture", "empty file", "grey among colour",
                                 "among pictures of 64 x 64", "8 bits", "only 9 objects",
                                 "a5.ppm: not a regular file", "no picture", "cannot read"])
def test_bad_pictures(tmp_path, folder, how):
    spoil(folder, how)
    kept = tmp_path / "report.json"
    kept.write_text("as it was")
    result = tiled("--maze", "small", "--images", folder, "--interactions", 100, "--json", kept)
    assert result.returncode == 2
    assert how in result.stderr
    assert len(result.stderr.splitlines()) == 1
    assert kept.read_text() == "as it was"
    assert [file.name for file in tmp_path.iterdir() if "report" in file.name] == ["report.json"]


def test_folders_of_pictures(tmp_path):
    """A folder an object, upper-case endings, other sizes, 16 bits; what is hidden is left alone."""
    for i in range(10):
        made = tmp_path / "pictures" / f"thing{i}"
        made.mkdir(parents=True)
        for view in range(2):
            write(made / f"{view}.PPM", picture(i, view, size=(64 + i, 64)))
        write(made / ".hidden.ppm", picture(99))
    wide = tmp_path / "pictures/thing0/0.PPM"
    wide.write_bytes(b"P6 64 64 65535\n" + numpy.repeat(picture(0), 2, axis=2).tobytes())
    arguments = ("--maze", "small", "--images", tmp_path / "pictures", "--interactions", 600, "--poses", "0,1")
    refused = tiled(*arguments)
    assert refused.returncode == 2 and "thing0/0.PPM: not 8 bits a channel" in refused.stderr
    assert "among pictures of" in tiled(*arguments, "--scale-depth").stderr
    made = report(tmp_path, *arguments, "--scale-depth", "--resize", 64)
    assert [one["name"] for one in made["objects"]] == [f"thing{i}" for i in range(10)]
    assert made["optimal_seen"] == 1.0


@pytest.mark.parametrize("suffix", [".png", ".jpg", ".webp", ".bmp"])
def test_a_file_that_was_cut_short(tmp_path, folder, suffix):
    cv2 = pytest.importorskip("cv2")
    file = folder / f"a5{suffix}"
    (folder / "a5.ppm").unlink()
    assert cv2.imwrite(str(file), picture(5))
    assert tiled("--maze", "small", "--images", folder, "--interactions", 50).returncode == 0
    file.write_bytes(file.read_bytes()[:-200])
    refused = tiled("--maze", "small", "--images", folder, "--interactions", 50)
    assert refused.returncode == 2
    assert f"a5{suffix}: cut short" in refused.stderr


def test_orientation_is_honoured(tmp_path, folder):
    """A photograph that lies on its side, and says so, is that which stands."""
    cv2 = pytest.importorskip("cv2")
    upright = picture(5, size=(64, 64))
    _, coded = cv2.imencode(".jpg", upright)
    _, turned = cv2.imencode(".jpg", numpy.rot90(upright))
    tiff = b"II*\0\x08\0\0\0\x01\0" + b"\x12\x01\x03\0\x01\0\0\0\x06\0\0\0" + bytes(4)
    exif = b"\xff\xe1" + (len(tiff) + 8).to_bytes(2, "big") + b"Exif\0\0" + tiff
    (folder / "a5.ppm").unlink()
    points = []
    for bytes_ in (coded.tobytes(), turned.tobytes()[:2] + exif + turned.tobytes()[2:]):
        (folder / "a5.jpg").write_bytes(bytes_)
        made = report(tmp_path, "--maze", "small", "--images", folder, "--interactions", 50)
        points.append({tuple(point[:2]) for one in made["objects"] if one["name"] == "a5"
                       for point in one["points"]})
    assert len(points[0] & points[1]) > 0.8 * len(points[0] | points[1])


def test_scenery(tmp_path, folder):
    """Other backgrounds and covers change the pictures, and only those that they are asked for."""
    arguments = ("--maze", "small", "--interactions", 1500, "--copies", 4)
    plain = report(tmp_path, *arguments)
    behind = report(tmp_path, *arguments, "--backgrounds", folder)
    test_only = report(tmp_path, *arguments, "--test-backgrounds", folder, "--test-cover", 0.1)
    assert test_only["objects"] == plain["objects"] != behind["objects"]
    assert test_only["options"]["copies"] == 4 and plain["options"]["copies"] == 1
    assert behind["optimal_seen"] > 0.9
    refused = tiled(*arguments, "--backgrounds", tmp_path / "none")
    assert refused.returncode == 2 and "--backgrounds: cannot read" in refused.stderr


@pytest.mark.parametrize("arguments, parts", [
    (["--poses", "0,x"], ["--poses: 'x'", "from -359 to 359"]),
    (["--poses", ""], ["--poses: ''"]),
    (["--test-poses", "10,360"], ["--test-poses: '360'"]),
    (["--poses", "20,0,-340"], ["--poses: '-340' is there already"]),
    (["--noise", " 3"], ["--noise: ' 3'"]),
    (["--noise", "0x10"], ["--noise: '0x10'"]),
    (["--jpeg", "0"], ["--jpeg: '0'", "from 1 to 100"]),
    (["--seed", "-1"], ["--seed: '-1'"]),
    (["--runs", "1e3"], ["--runs: '1e3'"]),
    (["--light", "1"], ["--light: '1'", "[0, 0.99]"]),
    (["--discount", "nan"], ["--discount: 'nan'", "[0, 1)"]),
    (["--noise", "3", "--noise", "4"], ["--noise: takes one value, once"]),
    (["--raw-light=yes"], ["--raw-light: takes no value"]),
    (["--descriptor", "eyes"], ["--descriptor: 'eyes'", "sift-upright"]),
    (["--criterion", "hope"], ["--criterion: 'hope'", "residual"]),
    (["--maze", "nowhere"], ["--maze: ", "'nowhere'", "No such file"]),
    (["--images", ""], ["--images: ", "empty"]),
    (["--metric", "nowhere", "--maze", "small"], ["--metric: ", "nowhere", "No such file"]),
    (["--save-metric", "absent/m", "--maze", "small"], ["--save-metric: ", "absent/m"]),
    (["--json", "same", "--dot", "same"], ["--dot: 'same'", "--json"]),
    (["--steps", "30", "--interactions", "20"], ["--steps: ", "20 interactions"]),
    (["--huh"], ["--huh: unknown option"]),
    (["more"], ["more: unknown option"]),
])
def test_bad_options(tmp_path, arguments, parts):
    result = run("tiled", *arguments, cwd=tmp_path)
    assert result.returncode == 2
    assert len(result.stderr.splitlines()) == 1
    for part in parts:
        assert part in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_help_names_options_as_they_are_typed():
    options = [line.split()[0] for line in tiled("--help").stdout.splitlines()
               if line.startswith("  -")]
    assert "--raw-light" in options
    assert all(re.fullmatch(r"(-h,)?--[a-z-]+", option) for option in options)


def test_one_pixel(tmp_path):
    for i in range(10):
        write(tmp_path / f"a{i}.ppm", picture(i, size=(1, 1)))
    result = tiled("--maze", "small", "--images", tmp_path, "--interactions", 10)
    assert result.returncode == 2
    assert "tau" in result.stderr


def test_blur_and_jpeg(tmp_path):
    made = report(tmp_path, "--maze", "small", "--blur", 1, "--jpeg", 75, "--interactions", 800)
    assert made["optimal_seen"] == 1.0


@pytest.mark.skipif(not CAMERA, reason="the camera example was not built")
def test_camera(tmp_path):
    for thing in range(3):
        for name, shifts in ("learn", (0, 2, 4, 6)), ("run", (1, 3, 5)):
            frames = tmp_path / f"{name}{thing}"
            frames.mkdir()
            for shift in shifts:
                write(frames / f"{shift}.ppm", picture(thing, shift))
    model, overlay = tmp_path / "model", tmp_path / "overlay"
    overlay.mkdir()
    taught = run("learn", model, *(tmp_path / f"learn{i}" for i in range(3)), program=CAMERA)
    assert taught.returncode == 0, taught.stderr
    for thing in range(3):
        done = run("run", model, tmp_path / f"run{thing}", "--overlay", overlay, program=CAMERA)
        assert done.returncode == 0, done.stderr
        lines = done.stdout.splitlines()
        assert len(lines) == 3
        assert all(line.endswith(f"action {thing}") for line in lines)
    assert len(list(overlay.iterdir())) == 3
    for wrong in ("run", tmp_path / "nowhere", tmp_path / "run0"), ("run", model, overlay / "no"):
        assert run(*wrong, program=CAMERA).returncode == 2


@pytest.mark.skipif(not CAMERA, reason="the camera example was not built")
@pytest.mark.parametrize("kept", ["metric", "agent"])
def test_camera_and_files_too_large_for_the_process(tmp_path, kept):
    for thing in range(2):
        (tmp_path / f"learn{thing}").mkdir()
        write(tmp_path / f"learn{thing}/0.ppm", picture(thing, 0))
    sources = tmp_path / "learn0", tmp_path / "learn1"
    model = tmp_path / "model"
    assert run("learn", model, *sources, program=CAMERA).returncode == 0
    before = {file.name: file.read_bytes() for file in tmp_path.glob("model*")}
    room = 10 if kept == "metric" else len(before["model.metric"])

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (room, room))

    refused = run("learn", model, *sources, program=CAMERA, preexec_fn=limit)
    assert refused.returncode == 2
    assert f"model.{kept}" in refused.stderr
    assert {file.name: file.read_bytes() for file in tmp_path.glob("model*")} == before


@pytest.mark.skipif(not COIL100, reason="RLVC_COIL100 does not name a folder of COIL-100 pictures")
def test_photographs(tmp_path):
    fixed = ("--images", COIL100, "--descriptor", "invariants", "--raw-light", "--margin", 1,
             "--runs", 20)
    made = report(tmp_path, *fixed)
    assert made["optimal_seen"] == 1.0
    assert max(one["classes"] for one in made["runs"]) <= 46
    made = report(tmp_path, "--images", COIL100, "--noise", 3, "--light", 0.05, "--runs", 3,
                  "--poses", "0,20,-20", "--test-poses", "10,-10")
    assert made["optimal_seen"] >= 0.99
    assert made["optimal_heldout"] >= 0.97
    assert max(one["classes"] for one in made["runs"]) <= 69
