"""Records of jobs: a file that only grows, by whole lines."""

import json
import os
import re
import sys
import zlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, NotRequired, TypedDict

from ..command import Place
from ..errors import BoresightError
from ..results import CalibrationResult

CHECKSUM = re.compile(rb',"crc32":"([0-9a-f]{8})"}$')


class Failure(TypedDict):
    """Why a job failed."""

    code: str
    """A stable name in kebab case."""
    message: str
    """The message."""
    what: str
    """What was wrong."""
    expected: str
    """What would have been accepted."""
    given: str
    """What was given."""


class RadarRecord(TypedDict):
    """What was found of a radar."""

    sensor: int
    """Its number."""
    result: CalibrationResult
    """The angle, as `boresight.calibrate` tells it, with None for numbers that are not finite."""
    equations: NotRequired[dict[str, Any]]
    """What the drive says of the unknowns that drives share; only merging reads it."""


class Done(TypedDict):
    """What was found in a log."""

    format: str
    """Format of the log."""
    durationS: float
    """From the first scan to the last."""
    remarks: NotRequired[list[str]]
    """What to know of the reading."""
    radars: list[RadarRecord]
    """The radars."""


class Record(TypedDict):
    """What running a job gave."""

    key: str
    """Key of the job."""
    vehicle: str
    """The vehicle."""
    drive: str
    """The drive."""
    path: str
    """Where the log was."""
    timeS: NotRequired[float]
    """When the drive began, s since 1970 (UTC), where that is known."""
    done: NotRequired[Done]
    """What was found; absent where the job failed."""
    failed: NotRequired[Failure]
    """Why the job failed: `crashed` and `timed-out` where it ended or outlasted its process."""
    schema: NotRequired[int]
    """Version of the format; 1 if absent."""
    version: NotRequired[str]
    """Version of Boresight that ran the job."""
    crc32: NotRequired[str]
    """Checksum of the line before it."""


def files(out: Path) -> list[Path]:
    """The files of records in a folder."""
    return sorted(path for path in out.glob("*.jsonl") if path.is_file())


def lines(path: Path) -> Iterator[Record]:
    """The whole lines of a file of records, without damaged ones."""
    with path.open("rb") as file:
        for number, line in enumerate(file, 1):
            if not line.endswith(b"\n"):
                return
            if is_damaged(line[:-1]):
                continue
            yield record_of(line, f"{path}, line {number}")


def is_damaged(line: bytes) -> bool:
    """Whether a line differs from its checksum or has zeros, as files have after a loss of power."""
    found = CHECKSUM.search(line)
    return zlib.crc32(line[: found.start()]) != int(found[1], 16) if found else b"\0" in line


def record_of(line: str | bytes, place: str) -> Record:
    """The record in a line."""
    try:
        record: Record = json.loads(line)
        if isinstance(record["key"], str) and ("done" in record) is not ("failed" in record):
            return record
    except (ValueError, TypeError, KeyError):
        pass
    given = line.decode(errors="replace") if isinstance(line, bytes) else line
    raise BoresightError("malformed-record", place, "a record of `boresight fleet run`", given[:80])


def read_records(out: Place) -> list[Record]:
    """The records in a folder, in the order of its files; a log run again has several."""
    return [record for path in files(Path(out)) for record in lines(path)]


def keys(out: Path, retry: bool) -> set[str]:
    """Keys of the jobs that have a record; with `retry` only of those that did not fail."""
    found = (record for path in files(out) for record in lines(path))
    return {record["key"] for record in found if not (retry and "failed" in record)}


class RecordFile:
    """The file that a run adds records to, held by one run at a time."""

    def __init__(self, path: Path) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        self.path = path
        self.file = os.open(path, os.O_RDWR | os.O_CREAT | getattr(os, "O_BINARY", 0), 0o666)
        try:
            self._lock()
            self.size = self._whole()
            os.ftruncate(self.file, self.size)
        except BaseException:
            os.close(self.file)
            raise

    def _lock(self) -> None:
        try:
            if sys.platform == "win32":
                import msvcrt

                msvcrt.locking(self.file, msvcrt.LK_NBLCK, 1)
            else:
                import fcntl

                fcntl.flock(self.file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            expected = "one run a folder at a time"
            raise BoresightError("busy", str(self.path), expected, "a file that another run writes to") from error

    def _whole(self) -> int:
        """Size up to the end of the last whole line: a killed run may have left part of one behind it."""
        at = os.lseek(self.file, 0, os.SEEK_END)
        while at > 0:
            begin = max(0, at - (1 << 16))
            os.lseek(self.file, begin, os.SEEK_SET)
            end = os.read(self.file, at - begin).rfind(b"\n")
            if end >= 0:
                return begin + end + 1
            at = begin
        return 0

    def append(self, records: Sequence[str]) -> None:
        """Adds records, each whole or not at all."""
        data = "".join(f"{record}\n" for record in records).encode()
        os.lseek(self.file, self.size, os.SEEK_SET)
        written = 0
        try:
            while written < len(data):
                written += os.write(self.file, data[written:])
        except BaseException:
            self.size += data.rfind(b"\n", 0, written) + 1
            os.ftruncate(self.file, self.size)
            raise
        self.size += written

    def __enter__(self) -> "RecordFile":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        os.fsync(self.file)
        os.close(self.file)
