"""Plans: which logs are calibrated, and how."""

import json
import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NotRequired, TypedDict, Unpack

from ..command import Place, flags, names, run
from ..options import CALIBRATE_OPTIONS, CalibrateOptions, DriveFormat


class Job(TypedDict):
    """What a plan says of a log; the lines of a plan have more, which only the command line reads."""

    key: str
    """Digest of all that the record depends on: the log's bytes and the settings."""
    path: str
    """Where the log is."""
    vehicle: str
    """The vehicle."""
    drive: str
    """The drive."""
    timeS: NotRequired[float]
    """When the drive began, s since 1970 (UTC), where that is known."""


class Log(TypedDict):
    """A log to plan, and what is known of it."""

    path: str
    """Where it is."""
    vehicle: NotRequired[str]
    """The vehicle."""
    drive: NotRequired[str]
    """The drive."""
    timeS: NotRequired[float]
    """When the drive began, s since 1970 (UTC)."""


Logs = Place | Iterable[Place | Log]
"""One log or several."""


class Plan:
    """Jobs as `boresight fleet plan` writes them, a line of JSON each."""

    def __init__(self, lines: Iterable[str]) -> None:
        self.lines = [line for line in lines if line.strip()]
        """The lines, without their ends."""
        self.jobs: list[Job] = [json.loads(line) for line in self.lines]
        """What they say of the logs."""

    @classmethod
    def read(cls, path: Place) -> "Plan":
        """The plan in a file."""
        return cls(Path(path).read_text(encoding="utf-8").splitlines())

    def write(self, path: Place) -> None:
        """Writes the plan to a file, at once."""
        target = Path(path)
        beside = target.with_name(f".{target.name}.{os.getpid()}")
        beside.write_text("".join(f"{line}\n" for line in self.lines), encoding="utf-8")
        beside.replace(target)

    def __len__(self) -> int:
        return len(self.lines)

    def __iter__(self) -> Iterator[Job]:
        return iter(self.jobs)


def plan(
    logs: Logs,
    *,
    vehicle: str | None = None,
    out: Place | None = None,
    sensor: int | None = None,
    joint: bool = False,
    format: DriveFormat | None = None,
    threads: int | None = None,
    **options: Unpack[CalibrateOptions],
) -> Plan:
    """Plans logs, by `boresight fleet plan`: reads each for its digest, and calibrates none.

    Arguments:

        logs: Paths, or `Log` where more is known of one than its path.
        vehicle: Where in a path vehicle, drive and time stand, such as "{vehicle}/{drive}.mcap", or the name of the one
            vehicle. The folder that holds the log names the vehicle if absent.
        out: Write the plan to this file too.
        sensor, joint, format, options: How logs are calibrated, as for `boresight.calibrate`.
        threads: Threads that read; as many as there are cores if absent.
    """
    arguments = ["fleet", "plan", "--list", "-", *flags("plan", options, CALIBRATE_OPTIONS)]
    given = {"--vehicle": vehicle, "--sensor": sensor, "--format": format, "--threads": threads}
    for flag, value in given.items():
        arguments += [] if value is None else [flag, str(value)]
    if joint:
        arguments.append("--joint")
    several = [logs] if isinstance(logs, str | os.PathLike) else logs
    listed = (log if isinstance(log, dict) else {"path": os.fspath(log)} for log in several)
    text = "".join(f"{json.dumps(log)}\n" for log in listed)
    named = names(CALIBRATE_OPTIONS) | {flag: flag.removeprefix("--") for flag in [*given, "--joint"]}
    planned = Plan(run(arguments, named=named, given=text, stacklevel=2).splitlines())
    if out is not None:
        planned.write(out)
    return planned


def absolute(logs: Logs) -> list[Place | Log]:
    """Logs by paths that mean the same wherever they are read."""
    several = [logs] if isinstance(logs, str | os.PathLike) else logs
    return [
        {**log, "path": os.path.abspath(log["path"])} if isinstance(log, dict) else os.path.abspath(log)
        for log in several
    ]
