# SPDX-License-Identifier: MIT
"""Worlds that are fully known: their exact solution, and what a learner observes of them.

A world is a table. In state s, action a leads to following[s, a, j] with probability chance[s, a, j],
earns reward[s, a, j], and ends the episode if over[s, a, j]. A learner does not observe s but a row of
bits; some of them, the distractors, are random at each observation.
"""

import dataclasses
import functools
import itertools

import gymnasium
import numpy as np
from gymnasium import spaces

DRAWS = 64  # of the distractors: every combination if there are 6
_CLOSE = 1e-9  # values nearer than this are equal


def binary(numbers, width):
    """Numbers [n] as rows of bits, lowest first: uint8 [n, width]."""
    return (np.asarray(numbers)[:, None] >> np.arange(width) & 1).astype(np.uint8)


def width_of(count):
    return max(1, int(count - 1).bit_length())


@dataclasses.dataclass(frozen=True, eq=False)
class World:
    """See the head of this file.

    ``parts`` are the columns [states, bits] that show the state, ``noise`` the number of distractors
    after each part, ``starts`` the probability of starting in each state, and ``limit`` the most moves
    of an episode.
    """

    following: np.ndarray
    chance: np.ndarray
    reward: np.ndarray
    over: np.ndarray
    starts: np.ndarray
    limit: int
    parts: tuple
    noise: tuple

    @property
    def actions(self):
        return self.following.shape[1]

    @functools.cached_property
    def distractors(self):
        """The columns of an observation that are distractors."""
        columns, place = [], 0
        for part, noise in zip(self.parts, self.noise, strict=True):
            place += part.shape[1]
            columns += range(place, place + noise)
            place += noise
        return np.array(columns, np.intp)

    @functools.cached_property
    def bits(self):
        """The observation of each state, with zeros as distractors: uint8 [states, bits]."""
        columns = []
        for part, noise in zip(self.parts, self.noise, strict=True):
            columns += [part, np.zeros((len(part), noise), np.uint8)]
        return np.concatenate(columns, axis=1)

    def see(self, states, random):
        """An observation of each state, with distractors of their own: int8 [n, bits]."""
        rows = self.bits[states].astype(np.int8)
        rows[:, self.distractors] = random.integers(2, size=(len(rows), len(self.distractors)))
        return rows

    @functools.cached_property
    def informative(self):
        """The columns that are not distractors."""
        return np.setdiff1d(np.arange(self.bits.shape[1]), self.distractors)

    @functools.cached_property
    def _numbers(self):
        return {row.tobytes(): s for s, row in enumerate(self.bits[:, self.informative])}

    def state_of(self, observation):
        """The state of an observation, for learners that see the state."""
        return self._numbers[np.asarray(observation, np.uint8)[self.informative].tobytes()]

    @functools.cached_property
    def reachable(self):
        """The states that an episode can reach, and in which it goes on."""
        found = self.starts > 0
        while True:
            steps = (self.chance > 0) & ~self.over & found[:, None, None]
            more = found.copy()
            more[self.following[steps]] = True
            if (more == found).all():
                return np.flatnonzero(found)
            found = more

    @functools.cached_property
    def looks(self):
        """Observations of every reachable state, DRAWS of each: int8 [states * DRAWS, bits]."""
        rows = np.repeat(self.bits[self.reachable], DRAWS, axis=0).astype(np.int8)
        count = len(self.distractors)
        if 2**count <= DRAWS:
            noise = binary(np.arange(DRAWS) % 2**count, count)
        else:
            noise = np.random.default_rng(0).integers(2, size=(DRAWS, count))
        rows[:, self.distractors] = np.tile(noise, (len(self.reachable), 1))
        return rows

    def _backup(self, values, discount):
        onward = np.where(self.over, 0.0, values[self.following])
        return (self.chance * (self.reward + discount * onward)).sum(axis=2)

    def solve(self, discount):
        """Q(s, a) of the optimal policy, by value iteration."""
        values = np.zeros(len(self.starts))
        while True:
            q = self._backup(values, discount)
            if np.abs(q.max(axis=1) - values).max() < _CLOSE / 1000:
                return q
            values = q.max(axis=1)

    @functools.cache  # noqa: B019 - worlds are few, and live as long as the program
    def best_actions(self, discount):
        """Whether an action is optimal: bool [reachable states, actions]."""
        q = self.solve(discount)[self.reachable]
        return q >= q.max(axis=1, keepdims=True) - _CLOSE

    def evaluate(self, chosen):
        """The exact mean undiscounted return of an episode.

        ``chosen`` [states * DRAWS] is the action at each of ``looks``. Distractors are random, so the
        policy is random too: it takes each action in a state as often as the draws there do.
        """
        shares = np.zeros((len(self.starts), self.actions))
        for action in range(self.actions):
            hits = (chosen == action).reshape(-1, DRAWS)
            shares[self.reachable, action] = hits.mean(axis=1)
        values = np.zeros(len(self.starts))
        for _ in range(self.limit):
            values = (shares * self._backup(values, 1.0)).sum(axis=1)
        return float(self.starts @ values)

    def optimal_states(self, chosen, discount):
        """The share of states with only optimal actions, whatever the distractors are."""
        best = np.repeat(self.best_actions(discount), DRAWS, axis=0)
        right = best[np.arange(len(chosen)), chosen].reshape(-1, DRAWS)
        return float(right.all(axis=1).mean())

    def best_return(self, discount):
        """The return of a policy that is optimal for that discount."""
        best = self.solve(discount)[self.reachable].argmax(axis=1)
        return self.evaluate(np.repeat(best, DRAWS))

    def random_walk(self):
        """The mean number of moves until a random walk first earns a reward.

        The walk starts again after ``limit`` moves.
        """
        there = self.starts.copy()
        found, moves = 0.0, 0.0
        for move in range(1, self.limit + 1):
            flow = there[:, None, None] * self.chance / self.actions
            now = flow[self.reward > 0].sum()
            found, moves = found + now, moves + move * now
            there = np.bincount(
                self.following[~self.over], flow[~self.over], minlength=len(there)
            )
        return (moves + (1 - found) * self.limit) / found

    def fewest_leaves(self, discount):
        """The number of leaves of the smallest tree over the bits that acts optimally everywhere.

        By dynamic programming over the cubes in the space of bits: each is a possible class. A cube is a
        leaf if one action is optimal in all its states; otherwise the best test splits it.
        """
        rows = self.bits[self.reachable][:, self.informative]
        count = rows.shape[1]
        best = self.best_actions(discount) @ (1 << np.arange(self.actions))
        allowed = np.full((2,) * count, (1 << self.actions) - 1)
        np.bitwise_and.at(allowed, tuple(rows.T), best)
        for axis in range(count):  # 0, 1, or 2 for both
            either = np.bitwise_and.reduce(allowed, axis=axis, keepdims=True)
            allowed = np.concatenate([allowed, either], axis=axis)
        allowed = allowed.ravel()
        cubes = np.arange(3**count)
        digits = cubes[:, None] // 3 ** np.arange(count)[::-1] % 3
        free = (digits == 2).sum(axis=1)
        leaves = np.where(allowed > 0, 1, len(cubes))
        for size in range(1, count + 1):
            here = cubes[(free == size) & (allowed == 0)]
            for axis in range(count):
                weight = 3 ** (count - 1 - axis)
                tested = here[digits[here, axis] == 2]
                both = leaves[tested - 2 * weight] + leaves[tested - weight]
                leaves[tested] = np.minimum(leaves[tested], both)
        return int(leaves[-1])


def maze_world(rows, distractors, start=None, earned=100.0, cost=-1.0, limit=100):
    """A maze, seen as bits of x, distractors, bits of y. The exit earns ``earned``."""
    signs = np.array([list(row) for row in rows])
    height, width = signs.shape
    cells = np.arange(height * width)
    x, y = cells % width, cells // width
    following = np.empty((len(cells), 4, 1), np.intp)
    for action, (dx, dy) in enumerate(((0, -1), (1, 0), (0, 1), (-1, 0))):
        to_x, to_y = np.clip(x + dx, 0, width - 1), np.clip(y + dy, 0, height - 1)
        blocked = signs[to_y, to_x] == "#"
        following[:, action, 0] = np.where(blocked, cells, to_y * width + to_x)
    over = (signs == "*").ravel()[following]
    free = (signs == ".").ravel()
    starts = (cells == start) if start is not None else free
    parts = (binary(x, width_of(width)), binary(y, width_of(height)))
    reward = np.where(over, earned, cost)
    chance = np.ones(following.shape)
    starts = starts / starts.sum()
    return World(following, chance, reward, over, starts, limit, parts, (distractors, 0))


def table_world(env, parts, distractors):
    """The world of one of Gymnasium's toy-text environments, from its table."""
    table, starts = env.unwrapped.P, np.asarray(env.unwrapped.initial_state_distrib, float)
    most = max(len(outcomes) for row in table.values() for outcomes in row.values())
    shape = (len(table), len(table[0]), most)
    following, over = np.zeros(shape, np.intp), np.ones(shape, bool)
    chance, reward = np.zeros(shape), np.zeros(shape)
    for s, a in itertools.product(*map(range, shape[:2])):
        for j, (probability, reached, earned, done) in enumerate(table[s][a]):
            chance[s, a, j], following[s, a, j] = probability, reached
            reward[s, a, j], over[s, a, j] = earned, done
    limit = env.spec.max_episode_steps
    parts = tuple(parts)
    noise = (0,) * (len(parts) - 1) + (distractors,)
    return World(following, chance, reward, over, starts / starts.sum(), limit, parts, noise)


class Seen(gymnasium.Wrapper):
    """An environment whose states are observed as a world's bits, and in no other way.

    So its info is dropped. Taxi's says which actions do something: a policy that was learnt by it does
    not know better than to do nothing for ever where it is not told.
    """

    def __init__(self, env, world, seed):
        super().__init__(env)
        self.world = world
        self.random = np.random.default_rng(seed)
        self.observation_space = spaces.MultiBinary(world.bits.shape[1])

    def _see(self, state):
        return self.world.see([state], self.random)[0]

    def reset(self, **given):
        return self._see(self.env.reset(**given)[0]), {}

    def step(self, action):
        state, *rest, _ = self.env.step(action)
        return (self._see(state), *rest, {})


class Played(gymnasium.Env):
    """A world as an environment; the observation is the number of the state."""

    def __init__(self, world):
        self.world = world
        self.observation_space = spaces.Discrete(len(world.starts))
        self.action_space = spaces.Discrete(world.actions)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.state = int(self.np_random.choice(len(self.world.starts), p=self.world.starts))
        self.moves = 0
        return self.state, {}

    def step(self, action):
        world, here = self.world, (self.state, int(action))
        outcome = 0
        if len(world.chance[here]) > 1:
            outcome = self.np_random.choice(len(world.chance[here]), p=world.chance[here])
        self.moves += 1
        reward, over = float(world.reward[here][outcome]), bool(world.over[here][outcome])
        self.state = int(world.following[here][outcome])
        return self.state, reward, over, not over and self.moves >= world.limit, {}


class Changing(gymnasium.Env):
    """An environment that another one, with the same spaces, replaces after so many interactions.

    The change waits for the end of an episode.
    """

    def __init__(self, first, second, after):
        self.now, self.second, self.left = first, second, after
        self.observation_space = first.observation_space
        self.action_space = first.action_space

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        if self.left <= 0 and self.second is not None:
            self.now, self.second = self.second, None
            seed = int(self.np_random.integers(2**32))
        return self.now.reset(seed=seed)

    def step(self, action):
        self.left -= 1
        return self.now.step(action)


class Nothing(gymnasium.Env):
    """Rewards are random, whatever the state and action.

    Six bits are a position on a ring, six more are random. If ``walked``, the two actions move the
    position up and down: observations predict the next ones, but nothing predicts a reward. Otherwise
    the position is random too. A reward is 0 or 1 for an even seed, a normal number for an odd one. An
    episode has 100 moves.
    """

    distractors = tuple(range(6, 12))

    def __init__(self, seed, walked):
        self.coin, self.walked = seed % 2 == 0, walked
        self.observation_space = spaces.MultiBinary(12)
        self.action_space = spaces.Discrete(2)

    def _see(self):
        noise = self.np_random.integers(2, size=6)
        return np.concatenate([binary([self.place], 6)[0], noise]).astype(np.int8)

    def _anywhere(self):
        return int(self.np_random.integers(64))

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.place, self.moves = self._anywhere(), 0
        return self._see(), {}

    def step(self, action):
        self.place = (self.place + (1 if action else -1)) % 64 if self.walked else self._anywhere()
        self.moves += 1
        random = self.np_random
        reward = float(random.integers(2)) if self.coin else float(random.standard_normal())
        return self._see(), reward, False, self.moves >= 100, {}
