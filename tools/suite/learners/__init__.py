# SPDX-License-Identifier: MIT
"""The learners: rlvc and its peers, one a file. Each file has ``learn(task, seed, check)``.

``check(interactions, act)`` is called now and then with the greedy policy so far; ``act`` maps an array
of observations to an array of actions. What ``learn`` returns says how large the result is. ``compact``
in it, if present, returns the number of leaves and the actions of the compacted policy.
"""

import dataclasses
import importlib
import importlib.util


@dataclasses.dataclass(frozen=True)
class Learner:
    """A learner: its file, its settings in words, and what it needs beyond tools/setup yardstick."""

    file: str
    about: str = ""
    needs: dict = dataclasses.field(default_factory=dict)  # module: the package that has it
    settings: dict = dataclasses.field(default_factory=dict)

    def learn(self, task, seed, check):
        """One run."""
        file = importlib.import_module(f"{__name__}.{self.file}")
        return file.learn(task, seed, check, **self.settings)

    def missing(self):
        """The packages that it needs and that are not installed."""
        return [package for module, package in self.needs.items()
                if not importlib.util.find_spec(module)]  # fmt: skip


_BASELINES3 = {
    "torch": "python3-torch", "pandas": "python3-pandas", "matplotlib": "python3-matplotlib",
    "stable_baselines3": "stable-baselines3",
}  # fmt: skip

LEARNERS = {
    "rlvc": Learner("rlvc"),
    "fqi-rlvc": Learner(
        "fitted_q_rlvc", "epsilon 0.9, a new tree in each of 10 rounds a learning step, 25 steps",
    ),
    "rmax": Learner(
        "r_max", "a pair is known after 1 sample, or 20 where outcomes are random",
    ),
    "vi": Learner("value_iteration", "on the counts of a random walk"),
    "q": Learner("q_learning", "rate 0.1, epsilon 0.1"),
    "q-raw": Learner(
        "q_learning", "rate 0.1, epsilon 0.1; each different observation is a state",
        settings={"raw": True},
    ),
    "q-tree": Learner(
        "q_tree", "rate 0.1, epsilon 0.3, the last 200 changes of Q in a leaf, split where t > 3",
    ),
    "fqi": Learner("fitted_q", "on random actions, 50 trees, 50 rounds at the end of the run", {
        "sklearn": "python3-sklearn",
    }),
    "cem": Learner(
        "cross_entropy", "50 policies a round, of which 10 stay; ten times the interactions",
        settings={"times": 10},
    ),
    "dqn": Learner(
        "baselines3", "Stable-Baselines3's, with its defaults but the discount", _BASELINES3,
        {"algorithm": "DQN"},
    ),
    "ppo": Learner(
        "baselines3", "Stable-Baselines3's, likewise; ten times the interactions", _BASELINES3,
        {"algorithm": "PPO", "times": 10},
    ),
}  # fmt: skip
