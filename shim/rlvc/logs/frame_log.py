# SPDX-License-Identifier: MIT
"""Logs in data frames, Parquet and Feather."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..errors import LogError
from ..files import open_file
from .array_log import from_arrays
from .log import Log

FEATHER = b"ARROW1"
"""How a Feather file begins."""


def from_frame(frame: Any, where: str = "log", **arguments: Any) -> Log:
    """Make a log of a data frame of pandas, with a row for each interaction.

    Parameters
    ----------
    frame : pandas.DataFrame
    where : str
        Name of the log in errors.
    **arguments
        Of :func:`rlvc.logs.from_arrays`.
    """
    names = [str(name) for name in frame.columns]
    if len(set(names)) != len(names):
        raise LogError(f"{where}: two columns have the same name")
    if any(frame.index.names):  # episodes and steps are often there
        frame = frame.reset_index()
    columns = {str(name): _values(frame[name]) for name in frame.columns}
    return from_arrays(columns, where, **arguments)


def _values(series: Any) -> Any:
    """A column as an array: of numbers if it can be, else of objects."""
    kind = str(series.dtype)
    if kind.startswith(("datetime", "timedelta")):
        return series.astype("int64").to_numpy()
    if kind == "category":
        return series.astype(object).to_numpy()
    return series.to_numpy()


def from_parquet(path: str | Path, **arguments: Any) -> Log:
    """Read a log from Parquet, as that of LeRobot and RLlib, or from Feather.

    Parameters
    ----------
    path : str or Path
        A file, or a folder of Parquet files, or of a data set of LeRobot.
    **arguments
        Of :func:`rlvc.logs.from_arrays`.
    """
    try:
        import pandas
    except ImportError:
        raise ImportError(
            "Parquet files need pandas and pyarrow: pip install 'rlvc[logs]'"
        ) from None
    try:
        if Path(path, "meta", "info.json").is_file():  # LeRobot's
            frame = pandas.read_parquet(Path(path, "data"))
        elif Path(path).is_dir():
            frame = pandas.read_parquet(path)
        else:
            with open_file(path) as file:  # a regular file
                feather = file.read(6) == FEATHER
            frame = pandas.read_feather(path) if feather else pandas.read_parquet(path)
    except ImportError:
        raise ImportError("Parquet files need pyarrow: pip install 'rlvc[logs]'") from None
    except Exception as error:  # of pyarrow
        text = " ".join(str(error).split())
        raise LogError(f"{path}: cannot be read as Parquet: {text}") from error
    return from_frame(frame, str(path), **arguments)
