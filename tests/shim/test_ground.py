# SPDX-License-Identifier: MIT
"""The camera over a photograph."""

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import rlvc.envs
from rlvc import errors


def test_a_proper_environment():
    made = gymnasium.make("rlvc/GroundView-v0", view=16)
    check_env(made.unwrapped, skip_render_check=True)


def test_what_is_seen():
    ramp = np.add.outer(np.arange(200), np.arange(240))[..., None] // 2 * np.ones(3, int)
    env = rlvc.envs.GroundView(ramp.astype(np.uint8), view=21, light=0, noise=0, scale=0)
    env.reset(seed=1)
    env.position = np.array([100.5, 60.0])
    seen = env.observe()
    assert abs(int(seen[10, 10, 0]) - 80) <= 1  # (100.5 + 60) / 2
    assert abs(int(seen[10, 20, 0]) - 85) <= 1
    assert abs(int(seen[0, 10, 0]) - 75) <= 1
    env.turn = 180.0
    turned = [env.observe() for _ in range(20)]
    assert all(abs(int(view[10, 10, 0]) - 80) <= 1 for view in turned)
    assert len({view.tobytes() for view in turned}) == 20


def test_moves_and_the_goal():
    env = rlvc.envs.GroundView(view=16, slip=0, goal=(0.5, 0.5))
    for episode in range(20):
        env.reset(seed=episode)
        total, over = 0.0, False
        while not over:
            before = env.position.copy()
            action = env.towards()
            _, reward, over, truncated, info = env.step(action)
            total += reward
            assert not truncated
            assert (info["position"] == env.position).all()
            moved = (env.position - before) / env.stride
            assert np.abs(moved - [(0, -1), (1, 0), (0, 1), (-1, 0)][action]).max() < 1e-9
        assert reward == 100.0
        assert np.hypot(*(env.position - env.goal)) < env.radius
        with pytest.raises(gymnasium.error.ResetNeeded):
            env.step(0)


def test_walls_edges_and_the_limit():
    env = rlvc.envs.GroundView(view=16, slip=0, limit=3, walls=[(100, 0, 120, 400)], goal=(1, 1))
    env.reset(seed=1)
    env.position = np.array([80.0, 30.0])
    assert env.step(1)[4]["position"].tolist() == [80.0, 30.0]  # 54 would be behind the wall
    assert env.step(3)[4]["position"].tolist() == [26.0, 30.0]
    _, _, terminated, truncated, info = env.step(0)
    assert info["position"][1] == env.low[1]
    assert truncated
    assert not terminated


def test_the_same_seed_the_same_world():
    first, second = (rlvc.envs.GroundView(view=16).reset(seed=7)[0] for _ in range(2))
    assert (first == second).all()


@pytest.mark.parametrize(
    ("changes", "kind", "named"),
    [
        ({"picture": np.zeros((100, 100), np.float32)}, errors.PictureError, "uint8"),
        ({"picture": np.zeros((300, 300, 4), np.uint8)}, errors.PictureError, "expected"),
        ({"picture": np.zeros((100, 300), np.uint8)}, errors.PictureError, "too few"),
        ({"slip": 2}, errors.ConfigError, "slip"),
        ({"goal": (2, 0)}, errors.ConfigError, "goal"),
        ({"view": 1}, errors.ConfigError, "view"),
        ({"turn": float("nan")}, errors.ConfigError, "turn"),
    ],
)
def test_what_is_refused(changes, kind, named):
    with pytest.raises(kind, match=named):
        rlvc.envs.GroundView(**changes)


def test_no_place_to_start():
    env = rlvc.envs.GroundView(walls=[(0, 0, 1000, 1000)])
    with pytest.raises(errors.ConfigError, match="no place"):
        env.reset(seed=1)
    with pytest.raises(gymnasium.error.InvalidAction):
        env.step(4)
