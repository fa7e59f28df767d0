# SPDX-License-Identifier: MIT
"""Why a policy acts as it does: the path through the tree, and what matters to it."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..agent.agent import Agent
from ..agent.planned_policy import PlannedPolicy
from ..agent.planner import Planner
from ..errors import RunError
from ..words import shortest
from .encode import Encoder

if TYPE_CHECKING:
    from .run import Run

_DRAWS = 5  # permutations of each element
_SEED = 1


class Seen:
    """At most a thousand percepts, evenly spaced over all that were seen.

    Parameters
    ----------
    percepts : list of bytes
    count : int
        How many were seen.
    stride : int
        Of how many one is kept.
    """

    room = 1000

    def __init__(
        self, percepts: list[bytes] | None = None, count: int = 0, stride: int = 1
    ) -> None:
        self.percepts, self.count, self.stride = percepts or [], count, stride

    def add(self, percept: bytes) -> None:
        """See a percept."""
        self.count += 1
        if self.count % self.stride:
            return
        self.percepts.append(percept)
        if len(self.percepts) >= self.room:
            self.percepts = self.percepts[1::2]
            self.stride *= 2


@dataclasses.dataclass(frozen=True)
class Step:
    """A test on the path of an observation.

    Attributes
    ----------
    test : str
    passed : bool
        The answer.
    value : float or None
        The component that was tested; None: a bit, an oblique test, or a feature of a picture.
    """

    test: str
    passed: bool
    value: float | None

    def __str__(self) -> str:
        """Describe it in one line."""
        value = "" if self.value is None else f" ({shortest(self.value)})"
        return f"{self.test}?{value} {'yes' if self.passed else 'no'}"


@dataclasses.dataclass(frozen=True)
class Explanation:
    """Why a policy acts as it does at an observation.

    Attributes
    ----------
    steps : list of Step
        The path from the root to the leaf.
    action : object
        Of the environment.
    action_name : str
    value : float or None
        Of the class, in units of return; None: the policy has no values.
    """

    steps: list[Step]
    action: Any
    action_name: str
    value: float | None

    def __str__(self) -> str:
        """Describe it in one line for each test."""
        value = "" if self.value is None else f", value {shortest(self.value)}"
        return "\n".join([*map(str, self.steps), f"-> {self.action_name}{value}"])


def explain(run: Run, observation: Any) -> Explanation:
    """Follow an observation through the tree: see :meth:`rlvc.Run.explain`."""
    percept = run.percept(observation)
    tree = run.tree
    nodes = {node["node"]: node for node in tree["nodes"]}
    exhibits = _tester(run, percept)
    node, steps = tree["nodes"][0], []
    while "test" in node:
        passed, value = exhibits(node)
        steps.append(Step(run.in_words(node["test"]), passed, value))
        node = nodes[node["present" if passed else "absent"]]
    action = int(node["action"])
    value = node.get("value")
    return Explanation(steps, run.actions.of(action), run.actions.name(action), value)


def _tester(run: Run, percept: Any) -> Any:
    """Return a function that answers a node's test, and gives the value that it compared."""
    domain = run.acting.domain
    record = np.frombuffer(domain.pack(percept), domain.percept_dtype)
    shaped = record.reshape(domain.percept_shape)
    features: dict[str, Any] = {}
    if isinstance(run.learner, Agent):
        features = {split.name: split.feature for split in run.learner.splits}

    flags = getattr(run.encoder, "flags", ())

    def value_of(component: int) -> float | None:
        flag = component < len(flags) and flags[component]
        return None if flag else float(shaped[component])

    def of_feature(node: dict[str, Any]) -> tuple[bool, float | None]:
        feature = features[node["test"]]
        names = getattr(feature.dtype, "names", None) or ()
        passed = bool(domain.exhibits(shaped, feature))
        if "cutpoint" not in names or float(feature["slope"]):
            return passed, None
        return passed, value_of(int(feature["component"]))

    def of_plan(node: dict[str, Any]) -> tuple[bool, float | None]:
        cutpoint, component, _, _ = planned.nodes[node["node"]]
        return bool(shaped[component] > cutpoint), value_of(component)

    acting = run.acting
    if isinstance(acting, Planner | PlannedPolicy):
        planned = acting.policy() if isinstance(acting, Planner) else acting
        return of_plan
    return of_feature


def importances(run: Run) -> dict[str, float]:
    """Measure what matters to a policy: see :meth:`rlvc.Run.importances`."""
    encoder = run.encoder
    if not isinstance(encoder, Encoder):
        raise RunError(
            "importances: the run has no rlvc.Encoder, and only that knows an observation's parts"
        )
    if len(run.seen.percepts) < 2:
        raise RunError("importances: fewer than two percepts were seen")
    flat = np.frombuffer(b"".join(run.seen.percepts), encoder.domain.percept_dtype)
    rows = flat.reshape(-1, *encoder.domain.percept_shape)
    columns = _columns(encoder, rows)
    random = np.random.default_rng(_SEED)
    before = np.asarray(run.indices(rows))
    found = {}
    for name, members in encoder.elements:
        changed = 0.0
        for _ in range(_DRAWS):
            other = columns.copy()
            other[:, members] = columns[random.permutation(len(columns))][:, members]
            changed += float(np.mean(np.asarray(run.indices(_rows(encoder, other))) != before))
        found[name] = changed / _DRAWS
    return dict(sorted(found.items(), key=lambda item: -item[1]))


def _columns(encoder: Encoder, rows: npt.NDArray[Any]) -> npt.NDArray[Any]:
    if rows.dtype == np.float32:
        return rows
    return np.unpackbits(rows, axis=1, count=len(encoder.names), bitorder="little")


def _rows(encoder: Encoder, columns: npt.NDArray[Any]) -> npt.NDArray[Any]:
    if columns.dtype == np.float32:
        return columns
    return np.packbits(columns, axis=1, bitorder="little")
