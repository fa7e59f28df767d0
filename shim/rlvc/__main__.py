# SPDX-License-Identifier: MIT
"""The command ``python -m rlvc``."""

from __future__ import annotations

import contextlib
import os
import sys
import warnings
from typing import TextIO

from .cli.commands import COMMANDS, INTERRUPTED
from .cli.parser import make_parser
from .errors import Error, LogWarning

_CLOSED_PIPE = 141  # exit status: 128 and the number of the signal


def _warned(
    message: Warning | str,
    category: type[Warning],
    filename: str,
    lineno: int,
    file: TextIO | None = None,
    line: str | None = None,
) -> None:
    """Print a warning about a log in one line, and others as Python does."""
    if issubclass(category, LogWarning):
        print(f"rlvc: {message}", file=sys.stderr)
    else:
        sys.stderr.write(warnings.formatwarning(message, category, filename, lineno))


def main(arguments: list[str] | None = None) -> int:
    """Run the command.

    Parameters
    ----------
    arguments : list of str or None
        None: the arguments of the process.

    Returns
    -------
    int
        The exit status: 0; 1 after an error, which is printed on one line; 130 after Ctrl-C; 141 if
        the reader closed the output.
    """
    try:
        try:
            parsed = make_parser().parse_args(arguments)
            with warnings.catch_warnings():
                warnings.simplefilter("always", LogWarning)
                warnings.showwarning = _warned
                return COMMANDS[parsed.command](parsed)
        finally:
            if sys.stdout is not None:
                sys.stdout.flush()
    except KeyboardInterrupt:
        print("rlvc: interrupted", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:
        with contextlib.suppress(
            OSError
        ):  # what is left in the buffer must not be written at the end
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return _CLOSED_PIPE
    except (Error, ImportError, OSError) as error:
        print(f"rlvc: {' '.join(str(error).split())}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
