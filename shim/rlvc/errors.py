# SPDX-License-Identifier: MIT
"""What can go wrong, one exception for each cause.

Every exception of the package is an :class:`Error`, and beside it the built-in exception that fits,
so that ``except ValueError`` works as one expects. An agent that raised is as it was before the call,
unless the text of the method says otherwise.
"""

from __future__ import annotations


class Error(Exception):
    """Any error of this package."""


class LibraryError(Error, ImportError):
    """The package's library is missing, of another version, or laid out in another way."""


class ConfigError(Error, ValueError):
    """A field of the config, or a size of the domain, is out of range (``RLVC_E_CONFIG``)."""


class BlockError(Error, MemoryError):
    """There is no room for the agent, or its block of memory is damaged (``RLVC_E_MEMORY``)."""


class OrderError(Error, RuntimeError):
    """There is no current percept: call ``begin`` first (``RLVC_E_ORDER``)."""


class RangeError(Error, ValueError):
    """An action, a class, an index or a budget is out of range (``RLVC_E_RANGE``)."""


class RewardError(Error, ValueError):
    """A reward is no finite number within +-1e12 (``RLVC_E_REWARD``)."""


class BusyError(Error, RuntimeError):
    """The ring is full of what is being learnt from: finish the step (``RLVC_E_BUSY``)."""


class ReenteredError(Error, RuntimeError):
    """A callback, or another thread, used an agent that was in a call (``RLVC_E_REENTERED``)."""


class ClosedError(Error, RuntimeError):
    """The agent was closed: its memory is gone."""


class CallbackError(Error, RuntimeError):
    """A callback failed without saying why (``RLVC_E_CALLBACK``)."""


class StoreError(Error, OSError):
    """What a snapshot is kept in cannot be read or written (``RLVC_E_STORE``)."""


class SnapshotError(Error, ValueError):
    """A snapshot is missing, damaged, of another version, or of another config or domain."""


class DomainError(Error, TypeError):
    """A method of one's own domain returned something else than it must."""


class ArrayError(Error, ValueError):
    """An array is of the wrong dtype or shape, not C-contiguous, or read-only where it is written."""


class PerceptError(ArrayError):
    """A percept is of the wrong size, dtype or shape."""


class PictureError(ArrayError):
    """A picture is of the wrong dtype, shape or size, or the pictures of a folder cannot be used."""


class MetricError(Error, ValueError):
    """A metric's text is damaged, it belongs to other vectors, is missing, or cannot be fitted."""


class SpaceError(Error, TypeError):
    """A Gymnasium space that cannot be encoded into bits, or has no finite set of actions."""


class LogError(Error, ValueError):
    """A log is damaged; the text says in which file, where, and what is wrong."""


class MazeError(Error, ValueError):
    """The text of a maze is not one; the text says in which line and column, and why."""


class RunError(Error, ValueError):
    """A run's JSON is damaged, or is none."""
