# SPDX-License-Identifier: MIT
"""The exceptions of the package, one for each cause.

Each is an :class:`Error` and also the built-in exception that fits best, so that ``except
ValueError`` works as expected. When a method of an agent raises, the agent is unchanged, unless the
documentation of the method says otherwise.
"""

from __future__ import annotations

import re

_BEGINNING, _END = 900, 300


def _readable(text: str) -> str:
    """One line, whatever it quotes; of a long one, as of ten thousand columns, beginning and end."""
    line = re.sub(r"(?<!\s)\s*\n\s*", " ", text.strip())
    if len(line) <= _BEGINNING + _END:
        return line
    return f"{line[:_BEGINNING]} ... {line[-_END:]}"


class Error(Exception):
    """Any error of this package. Its text is one line that can be read, whatever it quotes."""

    def __str__(self) -> str:
        """Return the text."""
        return _readable(super().__str__())


class LibraryError(Error, ImportError):
    """The C library is missing, has another version, or another layout of its structs."""


class ConfigError(Error, ValueError):
    """A field of the config, or a size of the domain, is out of range (``RLVC_E_CONFIG``)."""


class BlockError(Error, MemoryError):
    """There is not enough memory, or the agent's memory is corrupt (``RLVC_E_MEMORY``)."""


class OrderError(Error, RuntimeError):
    """There is no current percept: call ``begin`` first (``RLVC_E_ORDER``)."""


class RangeError(Error, ValueError):
    """An action, a class, an index or a budget is out of range (``RLVC_E_RANGE``)."""


class RewardError(Error, ValueError):
    """A reward is not a finite number in [-1e12, 1e12] (``RLVC_E_REWARD``)."""


class BusyError(Error, RuntimeError):
    """The replay buffer is full and in use by a learning step: finish it (``RLVC_E_BUSY``)."""


class ReenteredError(Error, RuntimeError):
    """A callback or another thread used an agent during a call (``RLVC_E_REENTERED``)."""


class ClosedError(Error, RuntimeError):
    """The agent was closed."""


class CallbackError(Error, RuntimeError):
    """A callback failed without an exception (``RLVC_E_CALLBACK``)."""


class StoreError(Error, OSError):
    """The store of a snapshot cannot be read or written (``RLVC_E_STORE``)."""


class SnapshotError(Error, ValueError):
    """A snapshot is missing, corrupt, or has another version, config or domain."""


class DomainError(Error, TypeError):
    """A method of a user-defined domain returned a wrong type or value."""


class ArrayError(Error, ValueError):
    """An array has the wrong dtype or shape, is not C-contiguous, or is read-only."""


class PerceptError(ArrayError):
    """A percept has the wrong size, dtype or shape."""


class PictureError(ArrayError):
    """A picture has the wrong dtype, shape or size, or a folder of pictures cannot be used."""


class MetricError(Error, ValueError):
    """A metric is missing, corrupt, made for other vectors, or cannot be fitted."""


class EnvError(Error, ValueError):
    """An environment returned what Gymnasium's interface does not allow, or is no environment."""


class SpaceError(Error, TypeError):
    """Observations of this space cannot be encoded, or its actions are not finite."""


class LogError(Error, ValueError):
    """A log is damaged. The message names the file, the place and the fault."""


class CountError(Error, ValueError):
    """Interactions cannot be counted: there are too many, or too many kinds of them."""


class LogWarning(UserWarning):
    """Something of a log is left out or lost. The text says what, and how to keep it."""

    def __str__(self) -> str:
        """Return the text, shortened like that of an error."""
        return _readable(super().__str__())


class MaskWarning(UserWarning):
    """A run that learnt with action masks acts without one: it may choose a forbidden action."""


class MazeError(Error, ValueError):
    """The text of a maze is invalid. The message names the line, the column and the fault."""


class RunError(Error, ValueError):
    """The report of a run is invalid, or has no data for this figure."""
