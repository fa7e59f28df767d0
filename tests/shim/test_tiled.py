# SPDX-License-Identifier: MIT
"""The Tiled Gridworld: the environment, and an agent that learns it from pictures.

RLVC_RUN_GRIDWORLD names the tool for the test that holds the package to it."""

import json
import os
import pickle
import subprocess

import gymnasium
import numpy as np
import pytest
from conftest import without_vision
from gymnasium import spaces
from gymnasium.utils.env_checker import check_env
from matplotlib.patches import Circle
from test_run import compiled

import rlvc
import rlvc.envs
from rlvc import errors, objects, plot, report

U8 = np.uint8
TOOL = os.environ.get("RLVC_RUN_GRIDWORLD")
sees = pytest.mark.skipif(bool(without_vision()), reason=without_vision())


def flat(count=10, views=1):
    """A picture of one colour for each object and view."""
    numbers = np.arange(count * views, dtype=U8).reshape(count, views, 1, 1, 1)
    return np.broadcast_to(numbers, (count, views, 5, 7, 3)).copy()


def test_a_proper_environment():
    made = gymnasium.make("rlvc/TiledGridworld-v0", maze=rlvc.envs.SMALL, pictures=flat())
    check_env(made.unwrapped, skip_render_check=True)
    assert made.observation_space == spaces.Box(0, 255, (5, 7, 3), U8)


def test_each_cell_has_its_object():
    env = rlvc.envs.TiledGridworld(rlvc.envs.SMALL, flat(12, 2), placement=5)
    assert env.object_of[[5, 11]].tolist() == [-1, -1]
    assert len(set(env.object_of.tolist())) == 11
    seen = {}
    for seed in range(300):
        observation, info = env.reset(seed=seed)
        seen.setdefault(4 * info["y"] + info["x"], set()).add(int(observation[0, 0, 0]))
    assert {cell: {2 * o, 2 * o + 1} for cell, o in enumerate(env.object_of) if o >= 0} == seen
    other = rlvc.envs.TiledGridworld(rlvc.envs.SMALL, flat(12, 2), placement=5)
    assert (other.object_of == env.object_of).all()
    env = rlvc.envs.TiledGridworld("*.\n", flat(1))
    env.reset(seed=1)
    observation, reward, terminated, _, _ = env.step(3)
    assert (reward, terminated, observation.max()) == (100.0, True, 0)


@pytest.mark.parametrize(
    "pictures", [flat(9), flat()[0], flat().astype(float), np.zeros((0, 5, 7, 3), U8), 5]
)
def test_wrong_pictures(pictures):
    with pytest.raises(errors.PictureError, match="pictures"):
        rlvc.envs.TiledGridworld(rlvc.envs.SMALL, pictures)


@pytest.fixture(scope="module")
def learnt():
    """A small maze, whose objects are seen from two angles, and a run in it."""
    from rlvc import vision

    env = rlvc.envs.TiledGridworld(rlvc.envs.SMALL, angles=(0, 10))
    pictures = env.objects.pictures
    metric = vision.Metric.fit(
        pictures.reshape(-1, *pictures.shape[2:]), np.repeat(np.arange(10), 2),
        sigma=4.0, form="int8", normalise=True, share=0.035,
    )  # fmt: skip
    eye = vision.Eye(vision.Extractor(metric=metric))
    return env, eye, rlvc.learn(env, 1500, encoder=eye, every=500, seed=1, discount=0.9)


@sees
def test_it_is_learnt_from_pictures(learnt):
    env, eye, run = learnt
    check_env(env, skip_render_check=True)
    again = rlvc.learn(env, 1500, encoder=eye, every=500, seed=1, discount=0.9)
    assert run.text() == again.text()
    assert isinstance(run.agent.domain, rlvc.Descriptors)
    best = [[(1, 2), 1, (1, 2), 2], [2, None, (1, 2), 2], [1, 1, 1, None]]
    for cell, number in enumerate(env.object_of):
        for picture in env.objects.pictures[number] if number >= 0 else ():
            wanted = best[cell // 4][cell % 4]
            assert run.act(picture) in (wanted if isinstance(wanted, tuple) else (wanted,)), cell
    with pytest.raises(errors.PictureError):
        run.act(picture.astype(float))


def seen_otherwise(pictures, count):
    """Pictures that are shifted, lighter or darker, and noisy."""
    random = np.random.default_rng(3)
    for _ in range(count):
        picture = pictures[random.integers(len(pictures))].astype(np.float32)
        shifted = np.roll(picture, random.integers(-9, 10, 2), (0, 1)) + random.integers(-30, 31)
        noise = random.normal(0, 12 * random.random(), picture.shape)
        yield (shifted + noise).clip(0, 255).astype(np.uint8)


@sees
def test_an_eye_acts_as_its_copies_and_its_c(learnt, tmp_path):
    """As test_run.py shows of other encoders. RLVC_PICTURES=10000 takes 100 s."""
    from rlvc import vision

    env, known, run = learnt
    eye = vision.Eye(known.extractor, cache=1 << 20)
    run = rlvc.learn(env, 1500, encoder=eye, every=500, seed=1, discount=0.9)
    pictures = env.objects.pictures.reshape(-1, *env.objects.pictures.shape[2:])
    seen = list(seen_otherwise(pictures, int(os.environ.get("RLVC_PICTURES", "300"))))
    expected = [run.predict(picture) for picture in seen]
    assert len(set(expected)) > 1
    run.save(tmp_path / "run.rlvc")
    loaded, copied = rlvc.load(tmp_path / "run.rlvc"), pickle.loads(pickle.dumps(run))
    assert [loaded.predict(picture) for picture in seen] == expected
    assert rlvc.load(tmp_path / "run.rlvc", encoder=eye).encoder is eye
    assert [copied.predict(picture) for picture in seen[:100]] == expected[:100]
    act = compiled(run.export_c(name="kept"), "kept", tmp_path)
    percepts = [np.frombuffer(eye.encode(picture), np.uint8).copy() for picture in seen]
    assert [act(percept.ctypes.data) for percept in percepts] == expected


@sees
def test_a_log_of_pictures():
    from rlvc import vision

    pictures = objects.find(wanted=4).pictures[:, 0]
    eye = vision.Eye(vision.Extractor(metric=vision.Metric.fit(pictures)))
    shown = np.arange(200) % 4
    actions = np.arange(200) // 4 % 2
    log = {
        "observations": pictures[shown], "next_observations": pictures[shown], "actions": actions,
        "rewards": (actions == shown % 2) * 1.0, "terminated": np.ones(200, bool),
    }  # fmt: skip
    run = rlvc.learn_from(log, encoder=eye)
    assert [run.act(picture) for picture in pictures] == [0, 1, 0, 1]


@sees
@pytest.mark.parametrize("suffix", ["png", "svg"])
@pytest.mark.parametrize("kind", ["tiles", "features", "maze", "values", "splits"])
def test_every_picture(learnt, kind, suffix, tmp_path):
    env, _, run = learnt
    made = json.loads(json.dumps(report.make(run, env)))
    plot.KINDS[kind](made, tmp_path / f"picture.{suffix}")
    content = (tmp_path / f"picture.{suffix}").read_bytes()
    assert content.startswith(b"\x89PNG" if suffix == "png" else b"<?xml")
    assert len(content) > 10_000


def shown(figure):
    """How many pictures and circles there are, and what is written; all of it lies within the figure."""
    figure.canvas.draw()
    width, height = figure.get_size_inches()
    box = figure.get_tightbbox()
    assert box.x0 > -0.1 and box.y0 > -0.1
    assert box.x1 < width + 0.1 and box.y1 < height + 0.1
    pictures = sum(len(axes.images) for axes in figure.axes)
    circles = sum(isinstance(patch, Circle) for axes in figure.axes for patch in axes.patches)
    return pictures, circles, {text.get_text() for axes in figure.axes for text in axes.texts}


@sees
def test_what_is_shown(learnt):
    env, eye, run = learnt
    made = report.make(run, env)
    pictures, circles, said = shown(plot.tiles(made))
    assert pictures == 10
    assert circles == 2 * sum(len(eye.look(views[0]).points) for views in env.objects.pictures)
    classes = run.agent.classes
    assert {str(c) for c in range(classes)} <= said
    pictures, circles, said = shown(plot.features(made))
    assert circles == 2 * (classes - 1)
    assert pictures >= classes - 1 + 10
    assert {f"class {c}" for c in range(classes)} == {t.split("\n")[0] for t in said if "\n" in t}
    for test, split in zip(made["tests"], run.agent.splits, strict=True):
        sight = eye.look(env.objects.view(test["object"], test["angle"]))
        at = sight.points[:, :2].tolist().index([test["x"], test["y"]])
        assert (sight.vectors[at] == split.feature["vector"]).all()


@sees
def test_a_pair_is_two_circles_and_a_line(learnt):
    env, _, run = learnt
    made = report.make(run, env)
    made["tests"][0]["second"] = {"x": made["tests"][0]["x"], "y": made["tests"][0]["y"] + 40.0}
    figure = plot.features(made)
    assert sum(len(axes.lines) for axes in figure.axes) == 2
    assert shown(figure)[1] == 2 * run.agent.classes


@sees
def test_a_bag_is_shown_where_most_of_it_is(learnt):
    from rlvc import vision

    env = learnt[0]
    metric = vision.Metric.fit(env.objects.pictures[:, 0], sigma=2.5, points=60, form="int8")
    eye = vision.Eye(vision.Extractor(metric=metric), bags=8)
    run = rlvc.learn(env, 1500, encoder=eye, every=500, seed=1, discount=0.9)
    made = report.make(run, env)
    assert len(made["tests"]) == run.agent.classes - 1 > 3
    circles = 0
    for test, split in zip(made["tests"], run.agent.splits, strict=True):
        sight = eye.look(env.objects.view(test["object"], test["angle"]))
        assert run.agent.domain.exhibits(sight.vectors, split.feature)
        found = run.agent.domain.nearest(sight.vectors, split.feature)
        near = [point for point, distance in found if distance < run.agent.domain.parameters[2]]
        x, y = sight.points[near, :2].T.tolist()
        assert test["bag"]["points"] == [{"x": x, "y": y} for x, y in zip(x, y, strict=True)]
        assert 0 < test["bag"]["needed"] <= len(near) <= test["bag"]["count"] <= 8
        circles += len(near)
    figure = plot.features(made)
    assert shown(figure)[1] == 2 * circles
    assert not any(axes.lines for axes in figure.axes)


@sees
def test_pictures_that_were_given(learnt):
    env, eye, _ = learnt
    other = rlvc.envs.TiledGridworld(rlvc.envs.SMALL, env.objects.pictures)
    run = rlvc.learn(other, 1500, encoder=eye, every=500, seed=1, discount=0.9)
    made = report.make(run, other)
    for draw in (plot.tiles, plot.features):
        with pytest.raises(errors.RunError, match="no options"):
            draw(made)
        with pytest.raises(errors.RunError, match=r"\.png, a \.svg or a \.pdf"):
            draw(made, "picture.jpg", other.objects)
    shown(plot.features(made, objects=other.objects))


@sees
@pytest.mark.skipif(not TOOL, reason="RLVC_RUN_GRIDWORLD is not set")
def test_parity_with_the_tool(tmp_path):
    """The same objects, and the same points of their pictures by the metric that the tool fitted."""
    from rlvc import vision

    subprocess.run(
        [TOOL, "tiled", "--maze", "small", "--interactions", "200", "--json", tmp_path / "run.json",
         "--save-metric", tmp_path / "metric.json"],
        check=True, capture_output=True,
    )  # fmt: skip
    made = json.loads((tmp_path / "run.json").read_text(encoding="utf-8"))
    metric = vision.Metric.load(tmp_path / "metric.json")
    assert metric.tau == np.float32(made["tau"])
    extractor = vision.Extractor(metric=metric)
    found = objects.find(wanted=10)
    for i, told in enumerate(made["objects"]):
        assert told["name"] == found.names[i]
        # Blue first, as the tool has it: a sum over channels depends on their order in its last bit.
        points = extractor.look(found.view(i, told["angle"])[:, :, ::-1], "bgr").points
        assert np.array_equal(np.array(told["points"], np.float32), points)
    domain, names = extractor.domain(), set()
    for test in made["runs"][0]["tests"]:
        feature = np.zeros(1, domain.feature_dtype)
        feature["radius"] = test["radius"]
        view = found.view(test["object"], test["angle"])[:, :, ::-1]
        sight = extractor.look(view, "bgr")
        for vector in sight.vectors:
            feature["vector"] = vector
            names.add(domain.name(feature[0]))
    assert {test["name"] for test in made["runs"][0]["tests"]} <= names
    assert shown(plot.tiles(made))[0] == 10
    assert shown(plot.features(made))[1] == 2 * len(made["runs"][0]["tests"])
