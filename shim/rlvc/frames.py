# SPDX-License-Identifier: MIT
"""Learning from what a camera saw: the frames of a folder or of a video, and a log beside them.

Needs the vision module, as :mod:`rlvc.vision` does.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import objects
from ._native import TERMINATED
from .checks import named
from .errors import LogError, PictureError
from .files import checked_name
from .logs.csv_log import table_of
from .logs.learn_from import learn_from
from .logs.table import Table, from_table
from .vision.extractor import Extractor
from .vision.eye import Eye
from .vision.library import Picture
from .vision.metric import Metric

if TYPE_CHECKING:
    from .learning.run import Run

_SUFFIXES = (".png", ".jpg", ".jpeg", ".bmp", ".ppm", ".pgm", ".tif", ".tiff", ".webp")
_NAMES = ("frame", "frames", "picture", "image", "img", "photo", "file", "filename", "frame_index")
_FITTED = 64  # frames that a metric is fitted to


class Frames:
    """The frames of a folder or of a video.

    Parameters
    ----------
    source : str or Path
        A folder of pictures, in the order of their names (frame2 before frame10), or a video. A
        video needs OpenCV's package for Python: ``pip install 'rlvc[vision]'``.
    scale_depth : bool
        Whether to scale pictures of 16 bits a channel to 8; otherwise they are refused.

    Attributes
    ----------
    source : Path
    names : list of str
        The files of a folder. Empty for a video, whose frames have numbers only.

    Raises
    ------
    PictureError
        There is no frame.
    """

    def __init__(self, source: str | Path, scale_depth: bool = False) -> None:
        self.source = Path(checked_name("frames", source, PictureError))
        self._scale_depth = scale_depth
        self.names: list[str] = []
        if self.source.is_dir():
            found = (path.name for path in self.source.iterdir() if _is_picture(path))
            self.names = sorted(found, key=_in_order)
            if not self.names:
                raise PictureError(f"there is no picture in {named(source)}")
        elif not self.source.is_file():
            raise PictureError(f"{named(source)}: neither a folder of pictures nor a video")
        self._numbers = {Path(name).stem: i for i, name in enumerate(self.names)}
        self._numbers |= {name: i for i, name in enumerate(self.names)}
        self._in_names = _numbers_in(self.names)

    def number(self, word: Any) -> int | None:
        """Find the frame that an entry of a log means.

        Parameters
        ----------
        word : str or number
            A file of the folder, with its ending or without. Or a number: that in the names if each
            is the same text and a number, such as frame1.png, frame2.png; else from 0.

        Returns
        -------
        int or None
            The frame's place in the order, from 0; None: there is no such frame.
        """
        found = self._numbers.get(re.split(r"[/\\]", str(word))[-1])
        if found is not None or isinstance(word, str) or not float(word).is_integer():
            return found
        if self._in_names:
            return self._in_names.get(int(word))
        return int(word) if word >= 0 and not (self.names and word >= len(self.names)) else None

    def pictures(self, wanted: Collection[int] | None = None) -> Iterator[tuple[int, Picture]]:
        """Read frames in their order.

        Parameters
        ----------
        wanted : collection of int or None
            Numbers of frames, from 0. None: all.

        Yields
        ------
        tuple of int and ndarray of uint8, [height, width, 3]

        Raises
        ------
        PictureError
            A file is no picture, or was cut short. The message names it.
        ImportError
            A video, without OpenCV's package for Python.
        """
        if not self.names:
            yield from self._of_video(wanted)
            return
        for i in range(len(self.names)) if wanted is None else sorted(set(wanted)):
            path = self.source / self.names[i]
            yield i, objects.read(path, scale_depth=self._scale_depth)

    def _of_video(self, wanted: Collection[int] | None) -> Iterator[tuple[int, Picture]]:
        try:
            import cv2
        except ImportError:
            raise ImportError(
                f"{self.source}: a video needs OpenCV's package: pip install 'rlvc[vision]'; or write "
                "its frames into a folder: ffmpeg -i VIDEO FOLDER/%06d.png"
            ) from None
        video, chosen = cv2.VideoCapture(str(self.source)), None if wanted is None else set(wanted)
        last = None if chosen is None else max(chosen, default=-1)
        try:
            if not video.isOpened():
                raise PictureError(f"{self.source}: not a video that can be read")
            i = 0
            while last is None or i <= last:
                there, picture = video.read()
                if not there:
                    break
                if chosen is None or i in chosen:
                    yield i, np.ascontiguousarray(picture[:, :, ::-1])
                i += 1
        finally:
            video.release()


def _numbers_in(names: list[str]) -> dict[int, int]:
    """The place of each number in the names if these are one text and a number; else none."""
    parts = [re.fullmatch(r"(.*?)(\d{1,15})", Path(name).stem, re.ASCII) for name in names]
    texts = {part[1] if part else None for part in parts}
    places = {int(part[2]): i for i, part in enumerate(parts) if part}
    return places if len(texts) == 1 and len(places) == len(names) else {}


def _is_picture(path: Path) -> bool:
    return path.suffix.lower() in _SUFFIXES and not path.name.startswith(".")


def _in_order(name: str) -> tuple[list[tuple[int, str]], str]:
    """A key that sorts numbers in a name by their values; of 1 and 01 the text decides."""
    parts = re.split(r"(\d+)", name)
    return [(int(part), "") if part.isdecimal() else (-1, part) for part in parts], name


# ---------------------------------------------------------------------- the log beside


def find_log(source: str | Path) -> Path:
    """Find the log of frames.

    Parameters
    ----------
    source : str or Path
        A folder: its only file of CSV, or that beside it with its name. A video: the file of CSV
        beside it with its name.

    Returns
    -------
    Path

    Raises
    ------
    LogError
        There is none, or there are several.
    """
    source = Path(checked_name("frames", source, LogError))
    if _is_picture(source):
        raise LogError(f"{named(source)}: one picture: give the folder of the frames, or a video")
    beside = source.with_suffix(".csv") if not source.is_dir() else Path(f"{source.resolve()}.csv")
    inside = sorted(source.glob("*.csv")) if source.is_dir() else []
    if len(inside) > 1:
        listed = ", ".join(path.name for path in inside[:3])
        raise LogError(f"{source}: has several logs: {listed}: pass one as log")
    found = [path for path in (*inside, beside) if path.is_file()]
    if not found:
        where = f"as {beside.name} beside"
        where = f"neither in it nor {where}" if source.is_dir() else f"not {where}"
        raise LogError(f"{named(source)}: there is no log: {where}: pass one as log")
    return found[0]


def _column(table: Table, column: str | None) -> str | None:
    """The column that names the frames; None: there is none, and row i is of frame i."""
    if column is not None:
        if column not in table.columns:
            listed = ", ".join(table.columns)
            raise LogError(f"{table.where}: {table.head}: no column {column} (present: {listed})")
        return column
    found = [name for name in table.columns if name.strip().lower() in _NAMES]
    if len(found) > 1:
        raise LogError(
            f"{table.where}: {table.head}: {' and '.join(found)} may name the frames: pass column"
        )
    return found[0] if found else None


def _numbered(table: Table, column: str | None, frames: Frames) -> str:
    """Put the numbers of the frames in place of their names; return the column."""
    found = _column(table, column)
    rows = len(next(iter(table.columns.values())))
    if found is None:
        if frames.names and len(frames.names) != rows:
            raise LogError(
                f"{table.where}: {table.head}: no column names the frames, of which there are "
                f"{len(frames.names)} for {rows} rows: pass column"
            )
        table.columns["frame"] = np.arange(rows, dtype=float)
        table.notes.append("frame: row i is of frame i")
        return "frame"
    if table.columns[found].ndim > 1:
        raise table.wrong(0, found, "several numbers: write the name of a file, with its ending")
    numbers = np.full(rows, np.nan)
    for i, word in enumerate(table.columns[found]):
        if word is None or word == "" or word != word:  # NaN: the row has no frame
            continue
        number = frames.number(word)
        if number is None:
            name = word if isinstance(word, str) else f"{word:.15g}"
            raise table.wrong(i, found, f"{name} is no frame of {frames.source}")
        numbers[i] = number
    table.columns[found] = numbers
    return found


class _Seen:
    """An encoder of numbers of frames, each of which was looked at once."""

    def __init__(self, eye: Eye, percepts: dict[int, bytes]) -> None:
        self.domain, self.names, self._percepts = eye.domain, eye.names, percepts

    def encode(self, number: Any) -> bytes:
        return self._percepts[int(number)]


def _fitted_eye(frames: Frames, numbers: list[int]) -> Eye:
    """An eye whose metric is fitted to some of the frames."""
    chosen = numbers[:: -(-len(numbers) // _FITTED)]
    pictures = [picture for _, picture in frames.pictures(chosen)]
    return Eye(Extractor(metric=Metric.fit(pictures, form="int8", normalise=True)))


def learn_from_frames(
    source: str | Path,
    log: str | Path | None = None,
    *,
    eye: Eye | None = None,
    column: str | None = None,
    header: Sequence[str] | None = None,
    roles: Mapping[str, Any] | None = None,
    bins: int | None = None,
    scale_depth: bool = False,
    **options: Any,
) -> Run:
    """Learn from the frames of a camera, with actions and rewards in a CSV beside.

    Parameters
    ----------
    source : str or Path
        A folder of pictures or a video, as for :class:`Frames`.
    log : str, Path or None
        A file of CSV with a row for each frame: the frame that was seen, the action that was taken
        at it, the reward that came of it, and whether the episode ended with it; otherwise the next
        frame is in the next row. Names of columns are those of :func:`rlvc.learn_from`. None:
        :func:`find_log`.
    eye : Eye or None
        None: one whose metric is fitted to up to 64 of the frames.
    column : str or None
        The column of the frame, of which :meth:`Frames.number` says how it may be named. None: that
        which is named frame, picture, image, photo or file; without such a column row i is of
        frame i.
    header, roles, bins
        As for :func:`rlvc.learn_from`.
    scale_depth : bool
        As for :class:`Frames`.
    **options
        ``actions``, ``steps``, ``seed`` and fields of :class:`rlvc.Config`, as for
        :func:`rlvc.learn_from`.

    Returns
    -------
    Run
        Its ``encoder`` is the eye: it takes pictures.

    Raises
    ------
    LogError
        The log is damaged, or names a frame that there is not. The message names the line.
    PictureError
        A frame cannot be read. The message names it.
    """
    frames = Frames(source, scale_depth)
    table = table_of(find_log(source) if log is None else log, header)
    name = _numbered(table, column, frames)
    read = from_table(table, [name], bins, given=roles)
    read.after[name] = np.where(read.ends == TERMINATED, read.before[name], read.after[name])
    numbers = np.unique([read.before[name], read.after[name]]).astype(int).tolist()
    eye = _fitted_eye(frames, numbers) if eye is None else eye
    percepts = {number: eye.encode(picture) for number, picture in frames.pictures(numbers)}
    missing = [number for number in numbers if number not in percepts]
    if missing:
        raise LogError(f"{read.where}: {source} has no frame {missing[0]}: it ends before")
    run = learn_from(read, encoder=_Seen(eye, percepts), **options)
    run.encoder = eye  # type: ignore[assignment]
    return run
