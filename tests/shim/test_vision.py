# SPDX-License-Identifier: MIT
"""Pictures as percepts, where the package has the vision module."""

import ctypes
import gc
import pickle
import subprocess
import threading

import numpy as np
import pytest
from conftest import ROOT, without_vision

import rlvc
from rlvc import errors

if reason := without_vision():
    pytest.skip(reason, allow_module_level=True)

from rlvc import _native, objects, vision

U8 = np.uint8


def noise(number, height=48, width=64, channels=3):
    """Blocks of colour, with many points."""
    random = np.random.default_rng(number)
    blocks = random.integers(0, 255, (16, 16, channels), U8)
    large = np.kron(blocks, np.ones((8, 8, 1), U8))[:height, :width]
    return large if channels == 3 else large[:, :, 0]


@pytest.fixture(scope="module")
def metric():
    return vision.Metric.fit([noise(i) for i in range(6)], form="int8")


@pytest.fixture
def extractor(metric):
    return vision.Extractor(metric=metric)


@pytest.fixture(scope="session")
def seer(tmp_path_factory):
    """The C program that sees one picture by the library that the package uses."""
    program = tmp_path_factory.mktemp("seer") / "seer"
    library = _native.PATH.with_name("librlvc-vision.so")
    subprocess.run(
        ["gcc", "-std=c99", f"-I{ROOT / 'core/include'}", f"-I{ROOT / 'vision/include'}", "-o", program,
         ROOT / "tests/shim/seer.c", library, f"-Wl,-rpath,{library.parent}"],
        check=True,
    )  # fmt: skip
    return program


@pytest.mark.parametrize("descriptor", vision.DESCRIPTORS)
@pytest.mark.parametrize("order", ["rgb", "bgr", "grey"])
def test_parity_with_c(seer, descriptor, order, tmp_path):
    """The same percept and points, bit for bit, with a metric and without."""
    whole = descriptor in ("sift-upright", "sift", "orb", "quarters")
    least = 1 if descriptor == "quarters" else 4
    picture = noise(1, channels=1 if order == "grey" else 3)
    fitted = vision.Metric.fit([noise(i) for i in range(5)], config=descriptor)
    fitted.save(tmp_path / "metric.json")
    for chosen, file in ((None, "-"), (fitted, tmp_path / "metric.json")):
        looking = vision.Extractor(descriptor, chosen, form="int8" if whole else "float")
        sight = looking.look(picture, "bgr" if order == "bgr" else "rgb")
        done = subprocess.run(
            [seer, descriptor, str(int(whole)), "64", "48", str(["grey", "bgr", "rgb"].index(order)), file],
            input=picture.tobytes(), capture_output=True, check=True,
        )  # fmt: skip
        assert len(sight.vectors) == len(sight.points) >= least
        assert done.stdout == sight.percept + sight.points.tobytes()


def test_defaults_are_the_librarys():
    for number, name in enumerate(vision.DESCRIPTORS):
        assert vision.library.library.rlvc_descriptor_name(number).decode() == name
        native = _native.VisionConfig()
        assert vision.library.library.rlvc_vision_config_default(number, ctypes.byref(native)) == 0
        assert bytes(vision.VisionConfig(name).native()) == bytes(native)
        assert vision.VisionConfig.of(native) == vision.VisionConfig(name)


def test_any_layout(extractor):
    picture = noise(2)
    expected = extractor.extract(picture)
    spaced = np.zeros((96, 64, 3), U8)[::2]
    spaced[...] = picture
    read_only = picture.copy()
    read_only.flags.writeable = False
    wide = np.zeros((48, 200, 3), U8)[:, 100:164]
    wide[...] = picture
    layouts = [
        spaced, read_only, wide, picture[::-1].copy()[::-1], picture[:, ::-1].copy()[:, ::-1],
        np.asfortranarray(picture), picture.transpose(2, 0, 1).copy().transpose(1, 2, 0),
    ]  # fmt: skip
    for layout in layouts:
        assert extractor.extract(layout) == expected
    assert extractor.extract(picture[:, :, ::-1], "bgr") == expected
    assert extractor.extract(picture[:, :, ::-1].copy(), "bgr") == expected
    assert extractor.extract_many([picture, noise(3)])[0].tobytes() == expected
    repeated = np.broadcast_to(picture[:1], picture.shape)
    assert extractor.extract(repeated) == extractor.extract(repeated.copy())


@pytest.mark.parametrize("shape", [(1, 1), (1, 1, 3), (1, 50, 3), (50, 1), (3, 3, 3), (2, 400)])
def test_small_pictures(extractor, shape):
    for picture in (np.zeros(shape, U8), np.full(shape, 255, U8)):
        sight = extractor.look(picture)
        assert len(sight.percept) == extractor.percept_bytes
        assert len(sight.points) == 0


WRONG = [
    None, "x.png", [[0]], np.zeros((4, 4)), np.zeros((4, 4), np.int8), np.zeros((4, 4), bool),
    np.zeros((0, 4), U8), np.zeros((4, 0, 3), U8), np.zeros((4, 4, 4), U8), np.zeros((4, 4, 1), U8),
    np.zeros((1, 4, 4, 3), U8), np.zeros(4, U8), np.zeros((), U8), np.zeros((1, 32768), U8), b"x",
]  # fmt: skip


@pytest.mark.parametrize(
    "picture", WRONG, ids=lambda p: f"{getattr(p, 'dtype', '')}{getattr(p, 'shape', p)}"
)
def test_wrong_pictures(extractor, picture):
    for call in (
        extractor.extract,
        extractor.look,
        vision.Eye(extractor).encode,
        lambda p: extractor.extract_many([p]),
        lambda p: vision.Metric.fit([noise(1), p]),
        lambda p: vision.Metric.fit([noise(1)], pairs=[(noise(1), p, "copies")]),
    ):
        with pytest.raises(errors.PictureError):
            call(picture)


def test_a_wrong_order(extractor):
    with pytest.raises(errors.PictureError, match="order"):
        extractor.extract(noise(1), "hsv")


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"points": 0}, "points"), ({"points": 2.5}, "points"), ({"radius": -1}, "radius"),
        ({"sigma": 99.0}, "sigma"), ({"k": float("nan")}, "k"), ({"descriptor": "eyes"}, "descriptor"),
        ({"form": "double"}, "form"), ({"nonsense": 1}, "nonsense"), ({"sd": "wide"}, "sd"),
    ],
)  # fmt: skip
def test_wrong_configs(changes, named):
    with pytest.raises(errors.ConfigError, match=named):
        vision.Extractor(**changes)


def test_metrics_are_kept(metric, tmp_path):
    file = tmp_path / "metric.json"
    metric.save(file)
    copies = [vision.Metric.load(file), vision.Metric.read(metric.write())]
    copies.append(pickle.loads(pickle.dumps(metric)))
    for copy in copies:
        assert (copy.tau, copy.kind, copy.config) == (metric.tau, metric.kind, metric.config)
        assert copy.write() == metric.write() == file.read_bytes()
    extractor = vision.Extractor(metric=metric)
    assert extractor.config.form == "int8"
    del metric, copies
    gc.collect()
    other = pickle.loads(pickle.dumps(extractor))
    assert other.extract(noise(1)) == extractor.extract(noise(1))


def test_wrong_metrics(metric, tmp_path):
    with pytest.raises(errors.StoreError, match="none"):
        vision.Metric.load(tmp_path / "none.json")
    with pytest.raises(errors.StoreError):
        metric.save(tmp_path / "no" / "such" / "folder.json")
    for text in (b"", b"{}", metric.write()[:-20], b"\xff" * 9):
        with pytest.raises(errors.MetricError):
            vision.Metric.read(text)
    with pytest.raises(errors.MetricError):
        vision.Metric.fit([noise(1)])
    with pytest.raises(errors.MetricError):
        vision.Extractor("orb", metric)
    with pytest.raises(errors.MetricError):
        vision.Extractor("invariants", form="int8")
    with pytest.raises(errors.MetricError, match="radius"):
        vision.Extractor().domain()


def test_what_was_never_made(extractor):
    """Objects of ``__new__`` alone are refused, whatever one does with them."""
    metric, other = (kind.__new__(kind) for kind in (rlvc.vision.Metric, rlvc.vision.Extractor))
    for call in (
        metric.write, lambda: metric.tau, lambda: pickle.dumps(metric),
        lambda: other.extract(np.zeros((40, 40), np.uint8)),
        lambda: rlvc.vision.Extractor("sift", metric=metric),
    ):  # fmt: skip
        with pytest.raises(errors.Error, match="was not made"):
            call()


@pytest.mark.parametrize(
    "changes",
    [{"share": 1.5}, {"share": "all"}, {"kind": "best"}, {"objects": [1]}, {"objects": [-1, 0]},
     {"pairs": [(noise(1), noise(2), "twins")]}],
)  # fmt: skip
def test_wrong_fits(changes):
    with pytest.raises(errors.RangeError):
        vision.Metric.fit([noise(1), noise(2)], **changes)


def test_a_metric_of_change():
    pictures = [noise(i) for i in range(8)]
    darker = [(p * 0.8).astype(U8) for p in pictures]
    pairs = [(a, b, "copies") for a, b in zip(pictures, darker, strict=True)]
    metric = vision.Metric.fit(
        pictures, range(8), pairs=pairs, config="sqrt-invariants", kind="change"
    )
    assert metric.kind == "change"
    assert metric.tau > 0


def test_discriminant_axes(tmp_path):
    pairs = [(noise(i), noise(i), "copies") for i in range(3)]
    metric = vision.Metric.fit(
        [noise(i) for i in range(9)], pairs=pairs, kind="discriminant", axes=5
    )
    metric.save(tmp_path / "metric")
    metric = vision.Metric.load(tmp_path / "metric")
    assert (metric.kind, metric.config.axes) == ("discriminant", 5)
    extractor = vision.Extractor(metric=metric)
    sight = extractor.look(noise(1))
    assert sight.vectors.shape == (len(sight.points), 5) and len(sight.points) > 0
    with pytest.raises(errors.RangeError, match="axes"):
        vision.Metric.fit([noise(1), noise(2)], kind="plain", axes=5)
    with pytest.raises(errors.ConfigError, match="axes"):
        vision.VisionConfig(axes=256)


def test_an_agent_learns_what_is_seen(extractor):
    """Two kinds of pictures call for two actions; the feature is one of theirs."""
    agent = rlvc.Agent(extractor.domain(), 2)
    sights = [extractor.look(noise(i)) for i in range(6)]
    random = np.random.default_rng(1)
    for i in random.integers(6, size=600):
        agent.begin(sights[i].percept)
        action = int(random.integers(2))
        agent.observe(action, float(action == i % 2), None, terminated=True)
    agent.learn()
    records = extractor.extract_many([noise(i) for i in range(6)])
    assert agent.predict(records).action.tolist() == [0, 1] * 3
    assert agent.predict(sights[1].percept).action == 1
    vectors = {tuple(v) for sight in sights for v in sight.vectors.tolist()}
    assert {tuple(s.feature["vector"].tolist()) for s in agent.splits} <= vectors
    header = agent.export_c("seen")
    assert "seen_act(const void *percept)" in header


def test_an_eye_remembers_a_few(extractor, monkeypatch):
    eye = vision.Eye(extractor, cache=2)
    seen, original = [], extractor.extract
    monkeypatch.setattr(extractor, "extract", lambda *a: seen.append(1) or original(*a))
    for number in (1, 2, 1, 1, 3, 1, 2):
        assert eye.encode(noise(number)) == original(noise(number))
    assert len(seen) == 4
    flat = noise(4, channels=1)
    assert eye.encode(flat[:24]) != eye.encode(flat[:24].reshape(48, 32))


def test_threads_share_an_extractor(extractor):
    pictures = [noise(i, 40 + i, 60 + i) for i in range(8)]
    expected = [extractor.extract(p) for p in pictures]
    found = [None] * 8

    def look(i):
        for _ in range(5):
            found[i] = extractor.extract(pictures[i])

    threads = [threading.Thread(target=look, args=(i,)) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == expected


def test_objects(tmp_path):
    rendered = objects.find(wanted=3, angles=(0, 20))
    assert rendered.pictures.shape == (3, 2, 128, 128, 3)
    assert rendered.names == ["object1", "object2", "object3"]
    assert (rendered.view(1, 20) == rendered.pictures[1, 1]).all()
    for i in range(2):
        picture = noise(i)
        (tmp_path / f"{'ab'[i]}.ppm").write_bytes(b"P6 64 48 255\n" + picture.tobytes())
    found = objects.find(tmp_path)
    assert found.names == ["a", "b"]
    assert (found.view(1, 0) == noise(1)).all()
    with pytest.raises(errors.PictureError, match="only 2 objects"):
        objects.find(tmp_path, wanted=3)
    with pytest.raises(errors.PictureError, match="cannot read"):
        objects.find(tmp_path / "none")
    for wrong in ({"angles": []}, {"angles": [360]}, {"wanted": 0}):
        with pytest.raises(errors.RangeError):
            objects.find(**wrong)
    (tmp_path / "c.ppm").write_text("hello")
    with pytest.raises(errors.PictureError, match=r"c\.ppm"):
        objects.find(tmp_path)
