# SPDX-License-Identifier: MIT
"""What the columns of a log are, by the names in use."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Collection, Iterable, Sequence

from ..errors import LogError

NAMES = {
    "action": "action actions a act acts control",
    "reward": "reward rewards r rew rews next.reward",
    "terminated": "terminated terminateds terminal terminals termination terminations "
    "is_terminal terminate",
    "done": "done dones next.done is_done end ended episode_terminals episode_end",
    "truncated": "truncated truncation truncations truncateds timeout timeouts time_limit timelimit "
    "timelimit.truncated next.truncated truncate",
    "exploited": "exploited greedy",
    "episode": "episode episodes episode_id episode_ids episode_index episode_number ep eps_id "
    "trajectory trajectory_id traj traj_id trajectory_index",
    "first": "is_first first episode_start episode_starts",
    "last": "is_last last",
    "step": "step steps t timestep timesteps time_step time_index step_id frame_index index unnamed:_0",
}
"""For each role the names of its column."""

_ROLE = {name: role for role, names in NAMES.items() for name in names.split()}
_SEEN = "obs observation observations state states s"
_AFTER = {
    "obs2": "obs",
    "s2": "s",
    "sp": "s",
    "s_": "s",
    "s'": "s",
    "nextstate": "state",
    "nextobs": "obs",
}
_NEXT = re.compile(r"next[_. /](.+)|(.+?)[_. ](?:next|prime|tp1)|(.+)'")
_ASIDE = """
    info infos metadata log_prob log_probs logp logprob action_logp value values vf_preds q_values
    return returns return_to_go returns_to_go advantage advantages value_targets unroll_id
    agent_index agent_id env_id task_index task type action_prob action_dist_inputs seed id
    comment note time timestamp timestamps datetime date version
"""


@dataclasses.dataclass
class Roles:
    """Which columns are what.

    Attributes
    ----------
    one : dict of str to str
        For each role of :data:`NAMES` that there is the column.
    actions, seen, after : list of str
        The columns of the action, of the observation, and of the one after it.
    ignored : list of str
    """

    one: dict[str, str]
    actions: list[str]
    seen: list[str]
    after: list[str]
    ignored: list[str]

    def notes(self) -> list[str]:
        """Say what was understood, in lines."""
        lines = [f"action: {', '.join(self.actions)}"]
        for role, name in self.one.items():
            lines.append(f"{role}: {name}")
        lines.append(f"observation: {', '.join(self.seen)}")
        if self.after:
            lines.append(f"next observation: {', '.join(self.after)}")
        if self.ignored:
            lines.append(f"ignored: {', '.join(self.ignored)}")
        return lines


def _plain(name: str) -> str:
    name = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name.strip())  # nextState
    return re.sub(r"[\s-]+", "_", name.lower())


def _before(name: str, names: Collection[str]) -> str | None:
    """Of which column this is the next value; None if it is not so named."""
    if name in _AFTER:
        return _AFTER[name]
    match = _NEXT.fullmatch(name)
    if match:
        return next(part for part in match.groups() if part is not None)
    rest = name.removeprefix("new_")
    return rest if rest != name and (rest in names or _is_seen(rest)) else None


def _is_seen(name: str) -> bool:
    """Whether it is an observation by its name: ``state``, ``obs_0``, ``observation.x``."""
    head = re.split(r"[._\[/ ]|(?<=[a-z])\d", name, maxsplit=1)[0]
    return (
        name in _SEEN.split()
        or (head in _SEEN.split() and head != "s")
        or bool(re.fullmatch(r"s_?\d+", name))
    )


def roles_of(names: Iterable[str], where: str, columns: Sequence[str] | None = None) -> Roles:
    """Assign a role to each column.

    Parameters
    ----------
    names : iterable of str
    where : str
        The log, for errors.
    columns : sequence of str or None
        The columns of the observation; None: those that are named so, else all without a role.

    Returns
    -------
    Roles

    Raises
    ------
    LogError
        There is no column for actions, rewards or observations, or two for one.
    """
    listed = list(names)
    plains = [_plain(name) for name in listed]
    wanted = list(columns or ())
    for name in wanted:
        if name not in listed:
            raise LogError(f"{where}: no column {name} (present: {', '.join(listed) or 'none'})")
    one: dict[str, str] = {}
    actions, rest, after, ignored = [], [], [], []
    for name in listed:
        plain = _plain(name)
        role = _ROLE.get(plain)
        if name in wanted:
            rest.append(name)
        elif role == "action" or re.fullmatch(r"(action|act|a)[._\[]?\d+\]?", plain):
            actions.append(name)
        elif role is not None and role not in one:
            one[role] = name
        elif role is not None:
            _refuse_two(role, one[role], name, where)
            ignored.append(name)
        elif _before(plain, plains) is not None:
            after.append(name)
        elif plain.split(".")[0].split("/")[0] in _ASIDE.split() or plain.startswith("infos"):
            ignored.append(name)
        else:
            rest.append(name)
    named = [name for name in rest if _is_seen(_plain(name))] if columns is None else wanted
    ignored += [name for name in rest if named and name not in named]
    seen = named or rest
    _need(actions, one, seen, listed, where)
    return Roles(one, actions, seen, _matched(after, seen, ignored), ignored)


def _refuse_two(role: str, first: str, second: str, where: str) -> None:
    """Two columns may say when, but not twice what was rewarded."""
    if role not in ("step", "episode"):
        raise LogError(
            f"{where}: {first} and {second} are both names of {role}: rename or remove one of them"
        )


def _need(
    actions: list[str], one: dict[str, str], seen: list[str], listed: list[str], where: str
) -> None:
    present = f"(present: {', '.join(listed) or 'none'})"
    if not actions:
        raise LogError(f"{where}: no column action {present}: name it so")
    if "reward" not in one:
        raise LogError(f"{where}: no column reward {present}: name it so")
    if not seen:
        raise LogError(f"{where}: no column for the observation {present}: name them by columns=")


def _matched(after: list[str], seen: list[str], ignored: list[str]) -> list[str]:
    """Put the next observation's columns in the order of the observation's; none if one is missing."""
    plains = [_plain(name) for name in seen]
    of = {_before(_plain(name), plains): name for name in after}
    found = [of[plain] for plain in plains if plain in of]
    if len(found) < len(seen):
        if len(seen) == len(after) == 1:
            return after
        ignored += after
        return []
    ignored += [name for name in after if name not in found]
    return found
