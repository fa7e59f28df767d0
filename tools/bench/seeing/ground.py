#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Learns to find a goal on photographs that packages ship, from what a camera sees below it.

    tools/bench/seeing/ground.py [PHOTOGRAPH ...] [--runs N] [--seed N] [--heading-unknown]

rlvc/GroundView-v0 on pictures of scikit-image and scikit-learn. A run has a goal of its own, metrics that
are fitted to 60 views of its photograph, one for corners and one for the view's quarters, and 4,000
interactions: the first eighth at random, then of ten episodes seven in which three moves of four are what
has been learnt so far. With --heading-unknown the camera is turned by any angle, and it has 8,000. A line
tells the share of 25 episodes that find the goal within 60 moves, how many moves they take in relation to
those of an oracle that knows where it is, both also for a camera that never takes back its last move but
makes the best of the other three, and how many classes there are. Needs scikit-image, scikit-learn and
OpenCV."""

import numpy as np

import command_line
import objects
import rlvc
import rlvc.envs
import rlvc.vision

EPISODES, VIEWS, STEPS = 25, 60, 16
CHANGES = 0.7  # of the moves of a wandering camera
SHARE, SHARE_WHOLE = 0.1, 0.03  # of the views look alike: by a corner, by the colours of the whole
WANDERS = 0.125  # of the interactions before the camera follows what it has learnt,
FOLLOWED, FOLLOWS = 0.7, 0.75  # in such a share of the episodes, and there of the moves


def make_eye(env, random, unknown):
    """An encoder of corners and of the whole view's colours: metrics fitted to views of the ground."""
    env.reset(seed=int(random.integers(2**31)))
    views, pairs = [], []
    for _ in range(VIEWS):
        env.position = random.uniform(env.low, env.high)
        views.append(env.observe())
        pairs.append((views[-1], env.observe(), "views"))
        env.position = np.clip(env.position + random.uniform(-9, 9, 2), env.low, env.high)
        pairs.append((views[-1], env.observe(), "views"))
    if unknown:
        config, kind = rlvc.vision.VisionConfig("sqrt-invariants"), "change"
    else:
        config, kind = rlvc.vision.VisionConfig("sift-upright", axes=16, sigma=2.5), "discriminant"
    whole = rlvc.vision.VisionConfig("quarters", axes=8)
    extractors = [
        rlvc.vision.Extractor(
            metric=rlvc.vision.Metric.fit(views, pairs=pairs, config=of, kind=by, share=share),
            form="int8")
        for of, by, share in ((config, kind, SHARE), (whole, "discriminant", SHARE_WHOLE))]
    return rlvc.vision.Eye(rlvc.vision.Joined(*extractors), margin=1.0)


def evaluate(env, act, seed):
    """The share of episodes that find the goal, and the mean number of moves. A move is chosen by what is seen, and
    by the last move (None at first)."""
    found, moves = 0, 0
    for episode in range(EPISODES):
        observation, _ = env.reset(seed=seed + episode)
        over, last = False, None
        while not over:
            last = act(observation, last)
            observation, _, terminated, truncated, _ = env.step(last)
            over, moves = terminated or truncated, moves + 1
        found += terminated
    return found / EPISODES, moves / EPISODES


def wander(env, eye, interactions, seed, random):
    """An agent that has learnt while the camera wandered, where each move is the last one again or random, and
    while it followed what had been learnt: that leads where it is wrong."""
    agent = rlvc.Agent(eye.domain, rlvc.Config(4, capacity=interactions + interactions // 20, classes=512,
                                               discount=0.9, tolerance=0.01, seed=seed))
    over, action = True, 0
    for i in range(interactions):
        if over:
            observation, _ = env.reset()
            seen = eye.encode(observation)
            agent.begin(seen)
            follows = i > WANDERS * interactions and random.random() < FOLLOWED
        if follows and random.random() < FOLLOWS:
            action = agent.predict(seen).action
        elif random.random() < CHANGES:
            action = int(random.integers(4))
        observation, reward, terminated, truncated, _ = env.step(action)
        seen = None if terminated else eye.encode(observation)
        agent.observe(action, reward, seen, terminated=terminated, truncated=truncated)
        over = terminated or truncated
        if (i + 1) % (interactions // STEPS) == 0:
            agent.learn()
    return agent


def onwards(worth, last):
    """The best move of those that do not take back the last one."""
    if last is None:
        return int(worth.argmax())
    back = (last + 2) % 4
    return max((move for move in range(4) if move != back), key=lambda move: worth[move])


def run(name, seed, unknown):
    """The share of episodes that find the goal and their moves in relation to the oracle's, by the policy, and by it
    when it never turns back; and the number of classes."""
    random = np.random.default_rng(seed)
    env = rlvc.envs.GroundView(objects.photograph(name), turn=180 if unknown else 0,
                               goal=tuple(random.uniform(0.1, 0.9, 2)))
    eye = make_eye(env, random, unknown)
    interactions = 8000 if unknown else 4000
    agent = wander(env, eye, interactions, seed, random)
    _, best = evaluate(env, lambda seen, last: env.towards(), 10**6)
    found, moves = evaluate(env, lambda seen, last: agent.predict(eye.encode(seen)).action, 10**6)
    q = agent.q
    further, fewer = evaluate(
        env, lambda seen, last: onwards(q[agent.predict(eye.encode(seen)).class_id], last), 10**6)
    return found, moves / best, further, fewer / best, agent.classes


def main():
    parser = command_line.parser_of(__doc__, runs=10)
    parser.add_argument("photographs", nargs="*", default=["china", "coffee", "chelsea"],
                        metavar="PHOTOGRAPH", help="china, flower, or a picture of skimage.data")
    parser.add_argument("--heading-unknown", action="store_true")
    options = parser.parse_args()
    for name in options.photographs:
        found, times, further, fewer, classes = np.array(
            [run(name, options.seed + i, options.heading_unknown) for i in range(options.runs)]).T
        print(f"{name:10}  found {found.mean():.3f} (least {found.min():.2f})  moves {times.mean():.2f} of "
              f"the oracle's; never turning back {further.mean():.3f} (least {further.min():.2f}) and "
              f"{fewer.mean():.2f}; classes {np.median(classes):.0f}", flush=True)


if __name__ == "__main__":
    main()
