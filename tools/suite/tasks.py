# SPDX-License-Identifier: MIT
"""The tasks, and the bars that rlvc must meet on them.

All tasks are learnt with one configuration: a task sets the number of interactions and the seed of
``rlvc.learn`` and, on bits, the discount, and nothing else.
"""

import dataclasses
import functools
import math
import statistics
from collections.abc import Callable
from pathlib import Path

import gymnasium
import numpy as np

import rlvc.envs  # noqa: F401 - registers the mazes

from . import controls, options, worlds

MAZES = Path(__file__).resolve().parents[2] / "examples" / "gridworld" / "mazes"
DISTRACTORS = 6
EPISODES = 100  # that are played where the return cannot be computed
_CLOSE = 1e-6


@dataclasses.dataclass(frozen=True)
class Look:
    """How good a policy is.

    ``value``: mean return of an episode. ``optimal``: share of states in which it takes only optimal
    actions, None where that is not known. ``good``: whether it is as good as the task asks.
    """

    value: float
    optimal: float | None
    good: bool


@dataclasses.dataclass(frozen=True)
class Bar:
    """A limit for a figure over all runs of a task.

    ``peer``: a learner; if it has runs, too, the limit is its own figure.
    """

    text: str
    figure: Callable[[list], float]
    limit: float
    least: bool = False  # whether the limit is a minimum; otherwise it is a maximum
    peer: str = ""

    def met(self, figure):
        return figure >= self.limit if self.least else figure <= self.limit


@dataclasses.dataclass(frozen=True)
class Task:
    """A task: ``make(seed)`` makes its environment, ``look(act, interactions)`` judges a policy.

    ``act`` maps an array of observations to an array of greedy actions.
    """

    name: str
    about: str  # what the title does not say
    discount: float
    interactions: int
    make: Callable
    look: Callable
    bars: tuple
    world: worlds.World | None = None
    changed: int | None = None  # interactions before the world changes
    peers: tuple = ("fqi-rlvc", "rmax", "vi", "q", "q-raw", "q-tree", "fqi", "dqn")
    runs_a_seed: int = 1
    distractors: tuple = ()  # bits that are, where there is no world that says so

    @property
    def title(self):
        return options.TASKS[self.name]

    @functools.cached_property
    def fewest(self):
        """Leaves of the smallest tree that acts optimally; None where it is not known."""
        return self.world.fewest_leaves(self.discount) if self.world else None


def reached(looks, first=0, last=math.inf):
    """After how many interactions every look was good, among those after ``first`` and up to ``last``.

    Counted from ``first``. ``looks`` are pairs (interactions, Look). None if the last one is not good.
    """
    found = None
    for interactions, look in looks:
        if first < interactions <= last:
            found = (found or interactions) if look.good else None
    return None if found is None else found - first


# ------------------------------------------------------------------ figures over the runs of a task


def _values(records, key):
    return [math.inf if record[key] is None else record[key] for record in records]


def median(key):
    """Of a figure over runs; None, for a run that never got there, counts as infinite."""
    return lambda records: statistics.median(_values(records, key))


def worst(key):
    return lambda records: max(_values(records, key))


def share(holds):
    return lambda records: statistics.fmean(bool(holds(record)) for record in records)


def _small(limit):
    return Bar("leaves after compaction, median", median("compacted"), limit)


CLEAN = Bar(
    "share of runs without a test on a distractor",
    share(lambda record: record["distractors"] == 0),
    0.95,
    True,
)

# ------------------------------------------------------------------ the tasks


def _judge(world, act, discount, asked):
    """Judge a policy in a world; ``asked(value, optimal)`` decides whether it is good."""
    chosen = act(world.looks)
    value, optimal = world.evaluate(chosen), world.optimal_states(chosen, discount)
    return Look(value, optimal, asked(value, optimal))


def _everywhere(value, optimal):
    return optimal == 1


def _maze(name):
    return (MAZES / f"{name}.txt").read_text(encoding="utf-8").split()


def binary():
    noise, discount = 11 + DISTRACTORS, 0.9
    world = worlds.maze_world(_maze("sutton"), noise)
    return Task(
        "binary", "asked: all cells optimal", discount, 2500,
        lambda seed: gymnasium.make("rlvc/BinaryGridworld-v0", distractors=noise),
        lambda act, done: _judge(world, act, discount, _everywhere),
        (
            Bar("interactions to all cells optimal, median", median("reached"), 1000),
            Bar("the same, worst run", worst("reached"), 2500),
            _small(1.2 * world.fewest_leaves(discount)),
            CLEAN,
        ),
        world,
    )  # fmt: skip


def _text(name, make, parts, interactions, wanted, leaves):
    discount, wanted = 0.99, wanted - _CLOSE
    world = worlds.table_world(make(), parts, DISTRACTORS)
    return Task(
        name, f"asked: a return of {wanted:.4g}", discount, interactions,
        lambda seed: worlds.Seen(make(), world, seed),
        lambda act, done: _judge(world, act, discount, lambda value, _: value >= wanted),
        (
            Bar(f"return after {interactions:,} interactions, median", median("value"), wanted, True),
            _small(leaves),
            CLEAN,
        ),
        world,
    )  # fmt: skip


def slippery():
    make = functools.partial(gymnasium.make, "FrozenLake-v1", is_slippery=True)
    return _text("slippery", make, [worlds.binary(np.arange(16), 4)], 7500, 0.73, 11)


def lake():
    make = functools.partial(gymnasium.make, "FrozenLake-v1", is_slippery=False)
    return _text("lake", make, [worlds.binary(np.arange(16), 4)], 1000, 1.0, 6)


def large():
    make = functools.partial(gymnasium.make, "FrozenLake-v1", map_name="8x8", is_slippery=True)
    task = _text("large", make, [worlds.binary(np.arange(64), 6)], 30000, 0, 64)
    kept = share(lambda record: record["kept"] >= record["value"] - _CLOSE)
    about = "asked: no loss by compaction, and the return of R-max"
    return dataclasses.replace(task, about=about, bars=(
        Bar("share of runs whose compact policy has the return of the tree", kept, 1.0, True),
        Bar("return, median, beside that of R-max", median("value"), 0, True, "rmax"),
        CLEAN,
    ))  # fmt: skip


def _taxi():
    newest = max(name for name in gymnasium.registry if name.startswith("Taxi-v"))
    return gymnasium.make(newest)


def taxi():
    s = np.arange(500)
    row, column, passenger, destination = s // 100, s // 20 % 5, s // 4 % 5, s % 4
    numbers = ((row, 3), (column, 3), (passenger, 3), (destination, 2))
    parts = [worlds.binary(*number) for number in numbers]
    return _text("taxi", _taxi, parts, 30000, 7.8, 80)


def cab():
    wanted = 7.8
    world = worlds.table_world(_taxi(), [worlds.binary(np.arange(500), 9)], 0)

    def look(act, done):
        chosen = np.repeat(act(world.reachable), worlds.DRAWS)
        value = world.evaluate(chosen)
        return Look(value, world.optimal_states(chosen, 0.99), value >= wanted)

    return Task(
        "cab", f"asked: a return of {wanted}; all in one number, whose bits mix row, column, passenger "
        "and destination", 0.99, 30000, lambda seed: _taxi(), look,
        (Bar("return after 30,000 interactions, median", median("value"), wanted, True),), world,
        peers=(),
    )  # fmt: skip


def _share(wanted, leaves, limit):
    """A bar: the share of runs whose policy has at least that return, and at most so many leaves."""
    good = share(lambda record: record["kept"] >= wanted and record["compacted"] <= leaves)
    text = f"share of runs with a return of {wanted} by {leaves} leaves"
    return Bar(text, good, limit, True)


def _first(wanted):
    """Interactions after which a policy first had that return; infinite if none had."""

    def first(record):
        return min((n for n, value, _ in record["looks"] if value >= wanted), default=math.inf)

    return lambda records: statistics.median(map(first, records))


def _by(interactions, wanted):
    """The share of runs whose policy has that return after so many interactions."""

    def good(record):
        values = [value for n, value, _ in record["looks"] if n <= interactions]
        return bool(values) and values[-1] >= wanted

    return share(good)


def _control(name, make, play, interactions, wanted, bars, peers=("cem", "dqn", "ppo")):
    def look(act, done):
        value = play(act, EPISODES)
        return Look(value, None, value >= wanted)

    return Task(
        name, f"asked: a return of {wanted}, mean of {EPISODES} episodes", 0.98, interactions,
        lambda seed: make(), look, bars, peers=peers,
    )  # fmt: skip


def cartpole():
    bars = (
        _share(475, 12, 1.0),
        Bar("share of runs with a return of 475 after 5,000 interactions", _by(5000, 475), 0.95, True),
        Bar("interactions to the first return of 475, median", _first(475), 1500),
        Bar("leaves, median", median("compacted"), 5),
    )
    make = functools.partial(gymnasium.make, "CartPole-v1")
    return _control("cartpole", make, controls.balance, 20000, 475, bars, ("fqi", "cem", "dqn", "ppo"))


def _noisy_pole(name, wanted, **noise):
    def make():
        return controls.Noise(gymnasium.make("CartPole-v1"), **noise)

    play = functools.partial(controls.balance, **noise)
    return _control(name, make, play, 10000, wanted, (_share(wanted, 12, 0.95),))


def _classic(name, make, interactions, wanted, leaves, limit):
    play = functools.partial(controls.mean_return, make)
    return _control(name, make, play, interactions, wanted, (_share(wanted, leaves, limit),))


def noise():
    return _noisy_pole("noise", 475, components=4)


def sensors():
    return _noisy_pole("sensors", 450, error=0.02)


def car():
    make = functools.partial(gymnasium.make, "MountainCar-v0")
    return _classic("car", make, 5000, -110, 8, 1.0)


def acrobot():
    make = functools.partial(gymnasium.make, "Acrobot-v1")
    return _classic("acrobot", make, 10000, -95, 12, 0.9)


def pendulum():
    def make():
        return controls.Torques(gymnasium.make("Pendulum-v1"))

    return _classic("pendulum", make, 10000, -250, 16, 0.8)


def lander():
    make = functools.partial(gymnasium.make, "LunarLander-v3")
    return _classic("lander", make, 50000, 100, 16, 0.5)


def catch():
    return _classic("catch", controls.Catch, 10000, 0.95, 6, 0.95)


def grid():
    def make():
        from minigrid.wrappers import FullyObsWrapper, ImgObsWrapper

        return ImgObsWrapper(FullyObsWrapper(gymnasium.make("MiniGrid-Empty-5x5-v0")))

    play = functools.partial(controls.mean_return, make)
    good = share(lambda record: record["value"] >= 0.95)
    bars = (Bar("share of runs with a return of 0.95", good, 0.9, True),)
    return _control("grid", make, play, 10000, 0.95, bars, peers=())


def far():
    discount = 0.99
    world = worlds.maze_world(_maze("rooms20"), DISTRACTORS, 0, earned=1.0, cost=0.0, limit=300)
    best = world.solve(discount)[0].max()
    shortest = 1 + round(math.log(best) / math.log(discount))
    sprint = dataclasses.replace(world, limit=shortest)

    def look(act, done):
        found = sprint.evaluate(act(world.looks))
        return _judge(world, act, discount, lambda value, optimal: found >= 1 - _CLOSE)

    return Task(
        "far", f"asked: the shortest path, {shortest} moves; a random walk finds the reward after "
        f"{world.random_walk():,.0f} moves in the mean", discount, 30000,
        lambda seed: worlds.Seen(worlds.Played(world), world, seed), look,
        (
            Bar("interactions to the shortest path, median", median("reached"), 30000),
            CLEAN,
        ),
        world,
    )  # fmt: skip


def _random_rewards(name, asked, walked, bars):
    return Task(
        name, asked, 0.9, 2000, lambda seed: worlds.Nothing(seed, walked),
        lambda act, done: Look(math.nan, None, True), bars, peers=(), runs_a_seed=10,
        distractors=worlds.Nothing.distractors,
    )  # fmt: skip


def nothing():
    grown = share(lambda record: record["leaves"] > 1)
    bar = Bar("share of runs whose tree has a test", grown, 0.05)
    return _random_rewards("nothing", "asked: nothing", False, (bar,))


def wander():
    # The agent moves: tests of where it is are structure, and any policy is as good. Noise is not.
    asked = "asked: no test but of the place, which the actions change"
    return _random_rewards("wander", asked, True, (CLEAN,))


def changing():
    noise, discount, after = 11 + DISTRACTORS, 0.9, 3000
    names = ("sutton", "sutton_changed")
    before, later = (worlds.maze_world(_maze(name), noise) for name in names)

    def make(seed):
        envs = (
            gymnasium.make("rlvc/BinaryGridworld-v0", maze=MAZES / f"{n}.txt", distractors=noise)
            for n in names
        )
        return worlds.Changing(*envs, after)

    def look(act, done):
        return _judge(later if done > after else before, act, discount, _everywhere)

    return Task(
        "changing", f"asked: all cells optimal before the walls change, after {after:,} interactions, "
        "and again after that", discount, 2 * after, make, look,
        (
            Bar("interactions to all cells optimal after the change, over those before it, median",
                median("again"), 3),
            CLEAN,
        ),
        later, changed=after, peers=("q", "q-raw", "dqn"),
    )  # fmt: skip


_MAKERS = (
    binary, lake, slippery, large, taxi, cab, cartpole, noise, sensors, car, acrobot, pendulum, lander,
    catch, grid, far, nothing, wander, changing,
)  # fmt: skip
TASKS = {make.__name__: functools.cache(make) for make in _MAKERS}
