# SPDX-License-Identifier: MIT
"""What the columns of a log are, by the names in use."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any

from ..checks import listed, shown
from ..errors import ConfigError, LogError

NAMES = {
    "action": "action actions a act acts ac acs control action_taken chosen_action selected_action "
    "action_id action_index",
    "reward": "reward rewards r rew rews reward_received immediate_reward",
    "terminated": "terminated terminateds terminal terminals termination terminations "
    "is_terminal terminate term",
    "done": "done dones is_done end ended episode_terminals episode_end finished game_over",
    "truncated": "truncated truncation truncations truncateds timeout timeouts time_limit timelimit "
    "timelimit.truncated truncate trunc",
    "exploited": "exploited greedy",
    "episode": "episode episodes episode_id episode_ids episode_index episode_number ep eps_id "
    "trajectory trajectory_id traj traj_id trajectory_index",
    "first": "is_first first episode_start episode_starts",
    "last": "is_last last",
    "step": "step steps t timestep timesteps time_step time_index step_id frame_index index unnamed:_0",
}
"""For each role the names of its column."""

_LATE = {
    "reward": "next.reward next_reward reward_next r_next",
    "done": "next.done next_done done_next",
    "truncated": "next.truncated",
    "action": "u command cmd",
}
"""Names that count if a role has no other column."""

_GIVEN = (*NAMES, "observation", "next_observation")
_ROLE = {name: role for role, names in NAMES.items() for name in names.split()}
_SEEN = "obs ob observation observations state states s"
_AFTER = {"obs2": "obs", "s2": "s", "state2": "state", "sp": "s", "s_": "s", "nextstate": "state",
          "nextobs": "obs"}  # fmt: skip
_NEXT = re.compile(r"next[_. /](.+)|(.+?)[_. ](?:next|prime|after)|(.+)'")
_AHEAD = re.compile(r"(?:after|future|following)[_. ](.+)|(.+)[_. ](?:new|future|following)")
_BEFORE = re.compile(
    r"(?:prev|previous|last|old|from)_(s|state|obs|observation)|(state|obs)_before"
)
_ASIDE = """
    info infos metadata log_prob log_probs logp logprob action_logp value values vf_preds q_values
    return returns return_to_go returns_to_go advantage advantages value_targets unroll_id
    agent_index agent_id env_id task_index task type action_prob action_dist_inputs seed id
    comment note date version weights_seq_no batch_id prev_action prev_actions prev_reward
    prev_rewards total_reward cumulative_reward episode_return episode_returns episode_length
"""
_CLOCK = re.compile(
    r"(header[._/])?(time|timestamps?|unix|unix_?time|epoch_time|date_?time|stamp|clock)"
    r"([._/](s|ms|us|ns|secs?|nsecs?|utc))?|t_(s|ms|us|ns)"
)


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
    named : bool
        Whether the columns of the observation are named so, and not just all others.
    alone : list of str
        Of the ignored ones those that would be observed, if there were a column for their next value.
    """

    one: dict[str, str]
    actions: list[str]
    seen: list[str]
    after: list[str]
    ignored: list[str]
    named: bool
    alone: list[str]

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


# ------------------------------------------------------------------ names


def _spelled(name: str) -> str:
    """A name in small letters with underscores, without its unit."""
    name = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name.strip().lstrip("%#_/"))  # nextState
    name = re.sub(r"_?[\[({]t( ?\+ ?1)?[\])}]$", lambda m: "_t+1" if m[1] else "_t", name)
    name = re.sub(r"(?<!\s)\s*(\[[^\[\]\d]*\]|\([^()\d]*\))$", "", name)  # a unit
    name = re.sub(r"[\s-]+", "_", name.lower())
    return re.sub(r"(?<=.)[./]data$", "", name)  # of ROS


def _plains(listed: Sequence[str]) -> list[str]:
    """The names of all columns, without what all of them begin with, and without their times."""
    names = [_spelled(name) for name in listed]
    heads = {re.split(r"[./]", name)[0] for name in names if not _CLOCK.fullmatch(name)}
    if len(heads) == 1 and len(names) > 2:
        head = heads.pop()
        names = [name[len(head) + 1 :] if name.startswith(head) else name for name in names]
    names = [re.sub(r"^current_(?=(s|state|obs|observation)$)", "", name) for name in names]
    ahead = re.compile(r"(.+?)_?(t\+1|tp1|t1)")
    if not any(ahead.fullmatch(name) for name in names):
        return names
    names = [re.sub(rf"^{ahead.pattern}$", r"\1_next", name) for name in names]
    return [re.sub(r"^(.+)_t$", r"\1", name) for name in names]


def _before(name: str, names: Collection[str]) -> str | None:
    """Of which column this is the next value; None if it is not so named."""
    if name in _AFTER and (_AFTER[name] in names or not name[-1].isdigit()):
        return _AFTER[name]
    match = _NEXT.fullmatch(name)
    if match:
        return next(part for part in match.groups() if part is not None)
    match = re.fullmatch(r"(.+?)([_. ])(?:next|prime)([_. ].+)", name)  # obs_next_0
    if match:
        return match[1] + match[3]
    match = _AHEAD.fullmatch(name)
    if match and (match[1] or match[2]) in names:
        return match[1] or match[2]
    rest = re.sub(r"^(new|to)_", "", name)
    pairs = name.startswith("new_") or f"from_{rest}" in names
    return rest if rest != name and pairs and (rest in names or _is_seen(rest)) else None


def are_numbered(numbered: Mapping[str, Sequence[str]], listed: Sequence[str]) -> set[str]:
    """Of columns of one name those that are, numbered, what one of them is: of the observation.

    Parameters
    ----------
    numbered : dict
        For each such name the names that its columns would have.
    listed : sequence of str
        The names of all columns.

    Returns
    -------
    set of str
    """
    every = [*numbered, *(name for made in numbered.values() for name in made), *listed]
    plains = dict(zip(every, _plains(every), strict=True))
    known = set(plains.values())
    alike = set()
    for name, made in numbered.items():
        group = [plains[each] for each in (name, *made)]
        after = {_before(plain, known) is not None for plain in group}
        if len(after) == 1 and not any(plain in _ROLE for plain in group):
            alike.add(name)
    return alike


def _is_seen(name: str) -> bool:
    """Whether it is an observation by its name: ``state``, ``obs_0``, ``observation.x``."""
    head = re.split(r"[._\[/ ]|(?<=[a-z])\d", name, maxsplit=1)[0]
    return (
        name in _SEEN.split()
        or (head in _SEEN.split() and head != "s")
        or bool(re.fullmatch(r"s_?\d+", name))
    )


def _is_aside(name: str) -> bool:
    return (
        name.split(".")[0].split("/")[0] in _ASIDE.split()
        or name.startswith("infos")
        or bool(_CLOCK.fullmatch(name))
    )


def _paired(plains: list[str]) -> list[str]:
    """Of ``prev_state`` and ``state`` the first is the observation, the second the one after it."""
    renamed = dict(zip(plains, plains, strict=True))
    known = set(plains)
    followed = {_before(name, known) for name in plains}
    for name in plains:
        match = _BEFORE.fullmatch(name)
        if match is None:
            continue
        base = match[1] or match[2]
        if base in renamed and base not in followed:
            renamed[base] = f"next_{base}"
        renamed[name] = base if renamed.get(base) == f"next_{base}" or f"next_{base}" in known else name
        if f"to_{base}" in renamed:
            renamed |= {name: base, f"to_{base}": f"next_{base}"}
    return [renamed[name] for name in plains]


# ------------------------------------------------------------------ roles


def roles_of(
    names: Iterable[str],
    where: str,
    columns: Sequence[str] | None = None,
    given: Mapping[str, Any] | None = None,
    clocks: Collection[str] = (),
) -> Roles:
    """Assign a role to each column.

    Parameters
    ----------
    names : iterable of str
    where : str
        The log, for errors.
    columns : sequence of str or None
        The columns of the observation; None: those that are named so, else all without a role.
    given : mapping or None
        Columns for roles, by the caller.
    clocks : collection of str
        Columns that are no observation unless they are named so.

    Returns
    -------
    Roles

    Raises
    ------
    LogError
        There is no column for actions, rewards or observations, or two for one.
    """
    there = list(names)
    chosen = _checked(given, there, where)
    if columns is not None and "observation" in chosen:
        raise ConfigError("roles: columns= names the observation already")
    wanted = chosen.pop("observation", [])
    if columns is not None:
        asked = listed("columns", columns, "names")
        wanted = [name if isinstance(name, str) else shown(name) for name in asked]
    after = chosen.pop("next_observation", [])
    for name in wanted:
        if name not in there:
            raise LogError(f"{where}: no column {name} (present: {', '.join(there) or 'none'})")
    plains = dict(zip(there, _paired(_plains(there)), strict=True))
    actions = chosen.pop("action", [])
    one = {role: found[0] for role, found in chosen.items()}
    given_one = {*wanted, *after, *actions, *one.values()}
    free = [n for n in there if n not in given_one]
    taken, more = _by_name(free, plains, set(chosen) | ({"action"} if actions else set()), where)
    one |= {role: found[0] for role, found in taken.items() if role != "action"}
    actions = actions or taken.get("action", [])
    ignored = [n for found in more for n in found]
    used = {*actions, *one.values(), *ignored}
    rest, next_ones, known = [], [], set(plains.values())
    for name in (n for n in free if n not in used):
        if _before(plains[name], known) is not None:
            next_ones.append(name)
        elif _is_aside(plains[name]):
            ignored.append(name)
        else:
            rest.append(name)
    named = wanted or [name for name in rest if _is_seen(plains[name])]
    seen = named or [name for name in rest if name not in clocks] or rest
    kept = set(seen)
    ignored += [name for name in rest if name not in kept]
    _need(actions, one, seen, there, where)
    if after and len(after) != len(seen):
        raise LogError(f"{where}: roles: {len(after)} next observations for {', '.join(seen)}")
    before = list(seen)
    after = after or _matched(next_ones, seen, plains, ignored, bool(wanted))
    kept = set(seen)
    alone = [name for name in before if name not in kept]
    return Roles(one, actions, seen, after, ignored, bool(named), alone)


def _checked(
    given: Mapping[str, Any] | None, there: list[str], where: str
) -> dict[str, list[str]]:
    """The roles by the caller: for each a list of columns that are there."""
    chosen: dict[str, list[str]] = {}
    if not isinstance(given, Mapping | None):
        raise ConfigError(f"roles: {shown(given)}: give a dict such as {{'action': 'steering'}}")
    for role, value in (given or {}).items():
        if role not in _GIVEN:
            raise ConfigError(f"roles: {shown(role)} is not one of {', '.join(_GIVEN)}")
        value = [value] if isinstance(value, str) else listed(f"roles: {role}", value, "names")
        chosen[role] = [str(name) for name in value]
        for name in chosen[role]:
            if name not in there:
                raise LogError(
                    f"{where}: roles: no column {name} (present: {', '.join(there) or 'none'})"
                )
    return chosen


def _by_name(
    names: list[str], plains: dict[str, str], known: set[str], where: str
) -> tuple[dict[str, list[str]], list[list[str]]]:
    """The columns of each role, by their names; and those of a role that has another column."""
    found: dict[str, list[str]] = {}
    for name in names:
        role = _ROLE.get(plains[name])
        if re.fullmatch(r"(action|act|a)[._\[]?\d+\]?", plains[name]):
            role = "action"
        if role is not None:
            found.setdefault(role, []).append(name)
    for role, late in _LATE.items():
        more = [name for name in names if plains[name] in late.split()]
        if role not in found and role not in known and more:
            found[role] = more[:1]
    if {"a", "r"} <= set(plains.values()) and not {"done", "terminated"} & set(found):
        ends = [name for name in names if plains[name] == "d"]
        found |= {"done": ends} if ends else {}
    if "action" not in found and "action" not in known:  # action_left, action_right
        split = [name for name in names if re.fullmatch(r"act(ion)?[._/].+", plains[name])]
        found |= {"action": split} if len(split) > 1 else {}
    more_than_one = []
    for role, several in found.items():
        if role != "action" and len(several) > 1:
            _refuse_two(role, several, where)
        if role != "action":
            more_than_one.append(several if role in known else several[1:])
    return {role: several for role, several in found.items() if role not in known}, more_than_one


def _refuse_two(role: str, several: list[str], where: str) -> None:
    """Two columns may say when, but not twice what was rewarded."""
    if role not in ("step", "episode"):
        raise LogError(
            f"{where}: {several[0]} and {several[1]} are both names of {role}: say which it is by "
            f"roles={{'{role}': ...}}"
        )


def _need(
    actions: list[str], one: dict[str, str], seen: list[str], listed: list[str], where: str
) -> None:
    present = f"(present: {', '.join(listed) or 'none'})"
    missing = ([] if actions else ["action"]) + ([] if "reward" in one else ["reward"])
    if missing:
        said = ", ".join(f"'{role}': ..." for role in missing)
        raise LogError(
            f"{where}: no column {' and no '.join(missing)} {present}: name it so, or say which it is "
            f"by roles={{{said}}}"
        )
    if not seen:
        raise LogError(f"{where}: no column for the observation {present}: name them by columns=")


def _matched(
    after: list[str], seen: list[str], plains: dict[str, str], ignored: list[str], wanted: bool
) -> list[str]:
    """Put the next observation's columns in the order of the observation's; none if one is missing.

    But columns of the observation that the caller did not name are left out if they have none.
    """
    names = set(plains.values())
    of = {_before(plains[name], names): name for name in after}
    found = [of[plains[name]] for name in seen if plains[name] in of]
    if found and not wanted:  # what has no next value is no part of these tuples
        ignored += [name for name in seen if plains[name] not in of]
        seen[:] = [name for name in seen if plains[name] in of]
    if len(found) < len(seen):
        if len(seen) == len(after) == 1:
            return after
        ignored += after
        return []
    kept = set(found)
    ignored += [name for name in after if name not in kept]
    return found
