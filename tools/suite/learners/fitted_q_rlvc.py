# SPDX-License-Identifier: MIT
"""Fitted Q iteration (Ernst, Geurts and Wehenkel, 2005) with rlvc's tree:

    targets  t_i := r_i + discount * max over a of Q(class of s'_i, a), or r_i at the end of an episode
    Q        := the means of the classes of a new tree, grown from (s_i, a_i, t_i)

in several rounds at each learning step. Learning from rewards without a discount is learning a decision
tree (section 7). So each regression is an agent that receives the targets as rewards of episodes of one
interaction. Unlike rlvc itself, no split outlives the targets that it was made for, and values travel
one interaction a round.
"""

import numpy as np

import rlvc

CLASSES = 512  # the default of rlvc.learn


def _fit(domain, actions, log, targets, seed):
    """A tree of the class values: an agent that was told the targets."""
    percepts, choices, _, following, _ = log
    agent = rlvc.Agent(domain, actions, capacity=len(targets), classes=CLASSES, seed=seed,
                       discount=0.0, successors=False)  # fmt: skip
    made = np.zeros(len(targets), rlvc.CHOICE)
    made["action"] = choices
    ends = np.ones(len(targets), np.uint8)  # every episode is over after one interaction
    agent.observe_many(percepts, made, targets.astype(np.float32), following, ends)
    agent.learn()
    return agent


def learn(task, seed, check, epsilon=0.9, rounds=10, steps=25):
    """One run; see the head of this package."""
    env = task.make(seed)
    encoder = rlvc.Encoder(env.observation_space)
    random = np.random.default_rng([seed, 6])
    actions = int(env.action_space.n)
    rows, agent = [], None
    percept = encoder.encode(env.reset(seed=seed)[0])

    def act(observations):
        return agent.predict(np.ascontiguousarray(encoder.encode_many(observations))).action

    for done in range(1, task.interactions + 1):
        if agent is None or random.random() < epsilon:
            action = int(random.integers(actions))
        else:
            action = int(agent.predict(percept).action)
        observation, reward, over, cut, _ = env.step(action)
        reached = encoder.encode(observation)
        rows.append((percept, action, reward, reached, over))
        percept = encoder.encode(env.reset()[0]) if over or cut else reached
        if done % (task.interactions // steps):
            continue
        log = _columns(rows)
        for _ in range(rounds):
            targets = log[2] + task.discount * _values(agent, log)
            agent = _fit(encoder.domain, actions, log, targets, seed)
        check(done, act)
    return {"leaves": agent.classes, "bytes": agent.memory_bytes}


def _columns(rows):
    """Interactions as arrays: percepts, actions, rewards, next percepts, whether the episode ended."""
    percepts, actions, rewards, following, over = zip(*rows, strict=True)
    return (
        np.array([np.frombuffer(one, np.uint8) for one in percepts]),
        np.array(actions),
        np.array(rewards, float),
        np.array([np.frombuffer(one, np.uint8) for one in following]),
        np.array(over),
    )


def _values(agent, log):
    """The value of each next percept: 0 at first, and at the end of an episode."""
    if agent is None:
        return np.zeros(len(log[2]))
    return np.where(log[4], 0.0, agent.values[agent.predict(log[3]).class_id])
