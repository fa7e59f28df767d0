# SPDX-License-Identifier: MIT
"""What an environment returns is taken as it was meant, or refused by an error that says what to do."""

import copy
import pickle

import gymnasium
import numpy as np
import pytest
from gymnasium import spaces
from test_values import Raises

import rlvc
from rlvc import errors


class Ring(gymnasium.Env):
    """Four places in a ring, an episode of five steps; what it returns can be changed."""

    def __init__(self, space=None, returned=None, **changed):
        self.observation_space = space or spaces.Discrete(4)
        self.action_space = spaces.Discrete(2)
        self.changed = changed
        self.returned = returned
        self.steps = 0

    def value(self, name, value):
        change = self.changed.get(name)
        return value if change is None else change(value)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.place, self.left = 0, 5
        return self.value("reset", (self.value("observation", 0), {}))

    def step(self, action):
        assert isinstance(action, int | np.int64)
        self.steps += 1
        self.place, self.left = (self.place + 2 * action - 1) % 4, self.left - 1
        return self.value("step", (
            self.value("observation", self.place), self.value("reward", float(self.place == 2)),
            self.value("terminated", self.left == 0), self.value("truncated", False), {},
        ))  # fmt: skip


def learnt(**changed):
    run = rlvc.learn(Ring(**changed), 500, seed=1)
    return run.text(), run.history


HARMLESS = [
    {name: change}
    for name in ("terminated", "truncated")
    for change in (int, float, np.bool_, np.int64, np.array, lambda v: np.array([v]), lambda v: [v][0])
] + [
    {"reward": change}
    for change in (int, bool, np.float32, np.int8, np.array, lambda v: np.array([v]), lambda v: np.array([[v]]))
] + [
    {"observation": change}
    for change in (np.int8, np.uint64, np.array, lambda v: np.array([v]), lambda v: np.array([v], np.uint8))
]  # fmt: skip


@pytest.mark.parametrize("changed", HARMLESS, ids=lambda changed: next(iter(changed)))
def test_what_is_harmless_is_the_same(changed):
    assert repr(learnt(**changed)) == repr(learnt())


class Walk(gymnasium.Env):
    """A walk to and fro, which always returns one array, written over, if it is shared."""

    action_space = spaces.Discrete(2)

    def __init__(self, space, shared):
        self.observation_space, self.shared = space, shared
        self.seen = np.zeros(2, space.dtype)
        self.info = {"action_mask": np.ones(2, np.int8)}

    def tell(self):
        seen = self.seen if self.shared else np.zeros_like(self.seen)
        info = self.info if self.shared else {"action_mask": np.ones(2, np.int8)}
        seen[:] = abs(self.place), self.left % 2
        info["action_mask"][:] = 1, self.left % 3 != 0
        return seen, info

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.place, self.left = int(self.np_random.integers(-2, 3)), 9
        return self.tell()

    def step(self, action):
        self.place, self.left = self.place + 2 * int(action) - 1, self.left - 1
        return self.tell()[0], float(self.place == 2), abs(self.place) == 4, self.left == 0, self.tell()[1]


@pytest.mark.parametrize("space", [spaces.MultiDiscrete([5, 2]), spaces.Box(0, 5, (2,), np.float32)])
@pytest.mark.parametrize("hold", [1, 2])
def test_an_environment_may_write_over_its_observation(space, hold):
    """Most of all when it is reset: what ended an episode was seen before."""
    runs = [rlvc.learn(Walk(space, shared), 800, seed=1, hold=hold) for shared in (False, True)]
    texts = [run.text() for run in runs]
    assert texts[0] == texts[1]
    assert repr(runs[0].history) == repr(runs[1].history)
    past = [rlvc.learn(rlvc.History(Walk(space, shared), 3), 400, seed=1).text() for shared in (False, True)]
    assert past[0] == past[1]
    for env in (Walk(space, False), Walk(space, True)):
        assert runs[0].evaluate(env, 20).returns.tolist() == runs[1].evaluate(env, 20).returns.tolist()


@pytest.mark.parametrize("space", [spaces.MultiDiscrete([5, 2]), spaces.Box(0, 5, (2,), np.float32)])
@pytest.mark.parametrize("mode", ["NEXT_STEP", "DISABLED"])
def test_a_vector_may_write_over_its_batch(space, mode):
    runs = []
    for shared in (False, True):
        env = gymnasium.vector.SyncVectorEnv([lambda: Walk(space, shared)] * 3, copy=not shared,  # noqa: B023
                                             autoreset_mode=gymnasium.vector.AutoresetMode[mode])  # fmt: skip
        runs.append(rlvc.learn(env, 900, seed=1))
    assert runs[0].text() == runs[1].text()
    assert repr(runs[0].history) == repr(runs[1].history)


def fifth(value):
    """That value from the fifth call on."""
    calls = []

    def change(right):
        calls.append(1)
        return value if len(calls) >= 5 else right

    return change


REFUSED = [
    *[("reward", value, errors.RewardError) for value in (
        None, "1", b"1", [1.0], np.zeros(2), np.zeros(0), np.nan, np.inf, 1j, 2e12, 10**400, {}, object(),
        np.ma.masked)],
    *[(name, value, errors.EnvError) for name in ("terminated", "truncated") for value in (
        None, "no", 2, -1, 0.5, np.nan, np.zeros(2), np.zeros(0), [], {}, object(), np.ma.masked)],
    *[("observation", value, errors.PerceptError) for value in (
        None, "a", 4, -1, 1.0, np.nan, [0, 1], np.zeros(2, int), {}, [[1], [1, 2]], 2**70, object())],
    *[("step", value, errors.EnvError) for value in (
        None, 3, (0, 0.0, False, {}), (), [0, 0.0, False, False, {}], (0, 0.0, False, False, {}, 1))],
]  # fmt: skip


@pytest.mark.parametrize(("name", "value", "error"), REFUSED)
def test_what_is_refused_names_the_place_and_the_field(name, value, error):
    said = {"step": r"step\(\) returned", "observation": "observation: "}.get(name, f"{name}: ")
    with pytest.raises(error, match=rf"^interaction [34], episode 0: {said}") as caught:
        rlvc.learn(Ring(**{name: fifth(value)}), 100, seed=1)
    assert caught.value.run.agent.statistics.interactions in (3, 4)
    caught.value.run.agent.check()
    run = rlvc.learn(Ring(), 100, seed=1)
    with pytest.raises(error, match=said):
        run.evaluate(Ring(**{name: fifth(value)}))


def test_the_place_is_counted():
    def reward(value, calls=[]):  # noqa: B006
        calls.append(1)
        return None if len(calls) == 24 else value

    with pytest.raises(errors.RewardError, match=r"^interaction 23, episode 4: reward: None"):
        rlvc.learn(Ring(reward=reward), 100, seed=1)


@pytest.mark.parametrize("copies", [1, 3])
def test_an_evaluation_names_the_place(copies):
    """Episodes of five steps; environments of a vector reset in a step of its own."""

    def reward(value, calls=[]):  # noqa: B006
        calls.append(1)
        return None if len(calls) == 13 * copies else value

    run = rlvc.learn(Ring(), 100, seed=1)
    env, said = Ring(reward=reward), "episode 2, step 2"
    if copies > 1:
        env = gymnasium.vector.SyncVectorEnv([lambda: Ring(reward=reward)] * copies)
        said = "episode 6, step 14"
    with pytest.raises(errors.Error, match=f"^{said}: "):
        run.evaluate(env, 100)


@pytest.mark.parametrize("value", [0, (0, 1), None, (0,), (0, {}, 1)])
def test_a_reset_that_returns_something_else(value):
    with pytest.raises(errors.EnvError, match=r"reset\(\) returned"):
        rlvc.learn(Ring(reset=lambda _: value), 100)


def test_environments_of_the_old_interface():
    class Old(Ring):
        def reset(self):
            return 0

        def step(self, action):
            return 0, 0.0, False, {}

    class Seeded(Old):
        def reset(self, *, seed=None, options=None):
            return 0, {}

    with pytest.raises(errors.EnvError, match=r"takes no seed.*wrap it"):
        rlvc.learn(Old(), 100)
    with pytest.raises(errors.EnvError, match=r"4 values.*wrap it"):
        rlvc.learn(Seeded(), 100)


def test_numbers_that_are_none_name_their_component():
    space = spaces.Dict({"a": spaces.Box(-9, 9, (2, 2)), "b": spaces.Discrete(2)})
    broken = {"a": np.array([[1, 2], [np.nan, 3]]), "b": 0}
    with pytest.raises(errors.PerceptError, match=r"a\[2\] is NaN"):
        rlvc.learn(Ring(space, observation=lambda _: broken), 100)
    with pytest.raises(errors.PerceptError, match="without 'b'"):
        rlvc.learn(Ring(space, observation=lambda _: {"a": np.zeros((2, 2))}), 100)


@pytest.mark.parametrize("value", [
    np.array([1, 1j]), np.array(["NaT"] * 2, "M8[s]"), np.zeros(2, [("a", "f4")]), np.array(["1", "2"]),
    np.ma.array([0.0, 1.0], mask=[True, False]),
])  # fmt: skip
def test_arrays_of_what_is_no_number(value):
    space = spaces.Box(-9, 9, (2,))
    with pytest.raises(errors.PerceptError, match="observation: "):
        rlvc.learn(Ring(space, observation=lambda _: value), 100, method="classes")
    run = rlvc.learn(Ring(space, observation=lambda _: np.zeros(2)), 100, method="classes")
    with pytest.raises(errors.PerceptError):
        run.predict(value[None])


@pytest.mark.parametrize("info", [
    None, 5, [1], np.zeros(0), np.zeros(3), *({"action_mask": mask} for mask in (
        [[1], [1, 2]], "x", np.zeros(0), np.ones((3, 3)), object(), np.array(["a", "b"]))),
])  # fmt: skip
def test_infos_that_say_nothing(info):
    def step(value):
        return (*value[:4], info)

    assert learnt(step=step) == learnt()


def test_actions_without_elements():
    env = Ring()
    for space in (spaces.MultiDiscrete([]), spaces.Box(-1, 1, (0,))):
        env.action_space = space
        with pytest.raises(errors.SpaceError, match="no elements"):
            rlvc.learn(env, 100, bins=3 if isinstance(space, spaces.Box) else None)


def test_runs_on_percepts_take_batches():
    run = rlvc.learn(Ring(), 100, seed=1)
    run.encoder = None
    percepts = np.arange(4, dtype=np.uint8)[:, None]
    assert run.predict(percepts).tolist() == [run.predict(percept) for percept in percepts]


@pytest.mark.parametrize(
    "name", ["reward", "terminated", "truncated", "step"],
)  # fmt: skip
def test_vectors(name):
    envs = gymnasium.vector.SyncVectorEnv([Ring for _ in range(3)])
    step = envs.step

    def stepped(actions):
        observation, reward, terminated, truncated, info = step(actions)
        values = {"reward": reward, "terminated": terminated, "truncated": truncated}
        if envs.envs[0].steps > 20:
            values[name] = values[name].astype(object) if name != "step" else None
            if name == "step":
                return observation, reward, terminated, {}
            values[name][1] = None
        return observation, *values.values(), info

    envs.step = stepped
    said = {"reward": r"rewards\[1\]", "step": "4 values"}.get(name, rf"{name}\[1\]")
    with pytest.raises((errors.EnvError, errors.RewardError), match=said) as caught:
        rlvc.learn(envs, 1000, seed=1)
    assert caught.value.run.agent.statistics.interactions > 20


def test_a_vector_whose_steps_all_end():
    """Also the step that only resets says that it ends the episode: it counts for nothing."""
    envs = gymnasium.vector.SyncVectorEnv([Ring for _ in range(3)])
    step = envs.step
    envs.step = lambda actions: (*step(actions)[:2], np.ones(3, np.bool_), np.zeros(3, np.bool_), {})
    run = rlvc.learn(envs, 90, seed=1)
    assert run.agent.statistics.interactions == 90
    assert run.evaluate(envs, 6).lengths.tolist() == [1] * 6


@pytest.mark.parametrize("fault", ["final_obs", "batch", "fewer"])
def test_vectors_whose_observations_are_missing(fault):
    mode = gymnasium.vector.AutoresetMode.SAME_STEP
    envs = gymnasium.vector.SyncVectorEnv([Ring for _ in range(3)], autoreset_mode=mode)
    step = envs.step

    def stepped(actions):
        observation, *rest, info = step(actions)
        if fault == "final_obs":
            info.pop("final_obs", None)
        elif envs.envs[0].steps > 7:
            observation = None if fault == "batch" else observation[:2]
        return observation, *rest, info

    envs.step = stepped
    with pytest.raises(
        errors.EnvError, match="final_obs" if fault == "final_obs" else "observations"
    ):
        rlvc.learn(envs, 1000, seed=1)


def test_the_run_outlives_what_the_environment_raises():
    class Broken(Ring):
        def step(self, action):
            if self.steps == 420:
                raise ZeroDivisionError("here")
            return super().step(action)

    class Stubborn(Exception):
        def __setattr__(self, name, value):
            raise AttributeError(name)

    def stop(_):
        raise Stubborn

    said = r"interaction 420, episode 84: step\([01]\) of the environment raised ZeroDivisionError: here"
    with pytest.raises(errors.EnvError, match=said) as caught:
        rlvc.learn(Broken(), 1000, seed=1)
    assert isinstance(caught.value.__cause__, ZeroDivisionError)
    run = caught.value.run
    assert run.agent.statistics.interactions == 420
    assert run.history[-1].interactions == 400
    assert run.act(0) in (0, 1)
    with pytest.raises(Stubborn):
        rlvc.learn(Ring(), 1000, callback=stop)


def test_what_is_no_environment():
    for env, said in (
        ("FrozenLake-v1", "gymnasium.make"),
        (None, "NoneType"),
        (3, "int"),
        (Ring, "Ring|type"),
    ):
        with pytest.raises((errors.EnvError, TypeError), match=said):
            rlvc.learn(env, 100)
    with pytest.raises(errors.EnvError, match=r"gymnasium\.make"):
        rlvc.learn(Ring(), 100, seed=1).evaluate("FrozenLake-v1")


@pytest.mark.parametrize("value", [1e4, "10", 0, -1, None, True, 2**70, np.float64(100)])
def test_numbers_of_the_caller(value):
    wanted = [{"interactions": value}, {"every": value}, {"leaves": value}]
    if value not in (0, None):
        wanted.append({"seed": value})
    for arguments in wanted:
        if list(arguments.values()) == [None] and "interactions" not in arguments:
            continue
        if arguments in ({"leaves": 0},):
            continue
        with pytest.raises(errors.ConfigError, match=next(iter(arguments))):
            rlvc.learn(Ring(), **{"interactions": 100, **arguments})
    run = rlvc.learn(Ring(), 100, seed=1)
    with pytest.raises(errors.ConfigError, match="episodes"):
        run.evaluate(Ring(), value)


def test_numbers_of_numpy():
    wanted = rlvc.learn(Ring(), 300, seed=3, every=50)
    run = rlvc.learn(Ring(), np.int64(300), seed=np.uint8(3), every=np.int32(50))
    assert repr(run.history) == repr(wanted.history)
    assert run.evaluate(Ring(), np.int64(3), np.int64(1)).mean >= 0.0


def test_other_arguments():
    class NoEncoder:
        pass

    class Short:
        bits = 20

        def encode(self, observation):
            return b"x"

    for arguments, said in (
        ({"callback": 3}, "callback"), ({"encoder": NoEncoder()}, "encoder"), ({"nonsense": 1}, "nonsense"),
        ({"capacity": "x"}, "capacity"), ({"encoder": Short()}, "expected 3 bytes"),
    ):  # fmt: skip
        with pytest.raises(errors.Error, match=said):
            rlvc.learn(Ring(), 100, **arguments)


@pytest.mark.parametrize(
    "space", [None, spaces.Box(-9, 9, (1,)), spaces.Tuple((spaces.Box(0, 9), spaces.Discrete(3)))]
)
def test_runs_are_pickled(space):
    def observation(place):
        return (
            (np.array([place], np.float32), 1)
            if isinstance(space, spaces.Tuple)
            else np.array([place])
        )

    run = rlvc.learn(Ring(space, observation=observation), 400, seed=1)
    for other in (pickle.loads(pickle.dumps(run)), copy.deepcopy(run)):
        assert other.text() == run.text() and other.interactions == 400
        assert repr(other.history) == repr(run.history)
        for place in range(4):
            assert other.act(observation(place)) == run.act(observation(place))
    if isinstance(run.learner, rlvc.Planner):
        return
    with pytest.raises(TypeError, match="compact"):
        pickle.dumps(run.agent.compact())
    with pytest.raises(TypeError, match="batch"):
        pickle.dumps(run.agent.batch(2))


@pytest.mark.parametrize("value", [-1, 2**32 - 1, 1025, 1.5, "x", None, True])
def test_mazes_of_other_sizes(value):
    from rlvc import envs

    with pytest.raises(errors.ConfigError, match="distractors"):
        envs.BinaryGridworld(distractors=value)
    with pytest.raises(errors.ConfigError, match="distractors"):
        envs.BinaryGridworld().maze.percepts(value)
    for slip in ("x", np.nan, 2.0, -0.1, None, [0.1, 0.2]):
        with pytest.raises(errors.ConfigError, match="slip"):
            envs.BinaryGridworld(slip=slip)
    for maze in (5, b"..*", "", "x"):
        with pytest.raises(errors.MazeError):
            envs.BinaryGridworld(maze)


def test_what_cannot_be_drawn():
    from rlvc import plot

    for source in (5, None, [], {"runs": 5}, {"runs": []}, {"runs": [3]}):
        for draw in plot.KINDS.values():
            with pytest.raises(errors.RunError):
                draw(source)


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: rlvc.learn(Ring(), 100, discont=0.9), "discont: an agent has no such field: do you mean discount?"),
        (lambda: rlvc.learn(Ring(), 100, gamma=0.9), "do you mean discount?"),
        (lambda: rlvc.learn(Ring(), 100, leaves=5), "leaves: an agent has no such field, the method 'planner' has it"),
        (lambda: rlvc.learn(Ring(), 100, xyz=5), "xyz: an agent has no such field: it has capacity"),
        (lambda: rlvc.PlannerConfig(2).replace(horizn=5), "a planner has no such field: do you mean horizon?"),
        (lambda: rlvc.EvalCallback("FrozenLake-v1"), "pass gymnasium.make"),
        (lambda: rlvc.learn_many(Ring(), 100, seeds=1, processes=1), "give its name, or a function that makes one"),
        (lambda: rlvc.learn(Ring(), 100, seed=1).predict((0, {})), "a pair (observation, info)"),
        (lambda: rlvc.learn(Ring(), 100, seed=1).export_c(name="1a"), "name: '1a' is not an identifier"),
    ],
)  # fmt: skip
def test_what_newcomers_do_is_answered(call, said):
    with pytest.raises(errors.Error) as caught:
        call()
    assert said in str(caught.value)


class Both(gymnasium.vector.SyncVectorEnv):
    """Two rings, one of whose five answers is replaced."""

    def __init__(self, index, value):
        super().__init__([Ring, Ring])
        self.index, self.value = index, value

    def step(self, actions):
        answers = list(super().step(actions))
        answers[self.index] = self.value
        return tuple(answers)


@pytest.mark.parametrize("index", range(4))
@pytest.mark.parametrize("value", [[], [0], [0, 1, 0], np.zeros(3), "xy", None, Raises()], ids=type)
def test_a_vector_that_answers_for_another_number(index, value):
    with pytest.raises(errors.Error):
        rlvc.learn(Both(index, value), 50)


def test_a_box_of_actions_as_large_as_a_picture():
    env = Ring()
    env.action_space = spaces.Box(0, 255, (84, 84, 3), np.uint8)
    with pytest.raises(errors.SpaceError, match=r"over 10\*\*9 actions"):
        rlvc.learn(env, 50, bins=3)


@pytest.mark.parametrize("name", ["spec", "unwrapped"])
def test_what_names_a_task_may_be_odd(name):
    """The names of a known task's numbers are a help: without them it learns all the same."""
    odd = type("Odd", (Ring,), {name: Raises()})
    assert rlvc.learn(odd(), 50, seed=1).text() == rlvc.learn(Ring(), 50, seed=1).text()


@pytest.mark.parametrize("name", ["action_space", "reset"])
def test_an_environment_that_raises_when_looked_at(name):
    env = Ring()
    setattr(env, name, Raises())
    with pytest.raises(errors.Error):
        rlvc.learn(env, 50)


def test_an_encoder_that_raises_when_looked_at():
    with pytest.raises(errors.ConfigError, match="encoder"):
        rlvc.learn(Ring(), 50, encoder=Raises())
