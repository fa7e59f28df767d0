# SPDX-License-Identifier: MIT
"""What the configs of all methods have in common."""

from __future__ import annotations

import dataclasses
from typing import ClassVar, TypeVar

from ..checks import known

Made = TypeVar("Made", bound="Fields")


@dataclasses.dataclass(frozen=True)
class Fields:
    """Fields that are fixed when a learner is made."""

    _learner: ClassVar[str]  # what has these fields, for errors

    def replace(self: Made, **changes: object) -> Made:
        """Return a copy with some fields changed.

        Parameters
        ----------
        **changes
            Fields of the config and their new values.

        Returns
        -------
        config
            The copy.

        Raises
        ------
        ConfigError
            There is no such field. The message names one that may be meant.
        """
        known(changes, (field.name for field in dataclasses.fields(self)), self._learner)
        return dataclasses.replace(self, **changes)
