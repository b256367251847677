"""What is handed to workers: batches of a fleet's jobs, or parts of a validation."""

import json
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Protocol

from ..command import Place, run
from ..errors import BoresightError
from ..results import Fleet
from .plan import Plan
from .records import RecordFile, files, keys, record_of
from .steps import merge

LARGEST_BATCH = 8
"""Jobs of a batch at most, unless asked otherwise: starting a process for each would take longer than a short log."""
BATCHES = 4
"""Batches a place of work at least, so that none is idle while others have many left."""


class Work(Protocol):
    """Work in tasks, of which those are left out that were done before."""

    total: int
    """How much there is, in logs or parts."""
    done: int
    """How much of it is done."""

    @property
    def call(self) -> Callable[[Any], Any]:
        """What a worker does with a task."""

    def tasks(self, places: int) -> list[Any]:
        """The tasks left, for so many places of work."""

    def take(self, task: Any, result: Any) -> None:
        """Keeps what a task came to."""

    def finish(self) -> Any:
        """What all of them come to."""

    def __enter__(self) -> "Work": ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...


def run_batch(jobs: Sequence[str]) -> list[str]:
    """Runs jobs, lines of a plan, on one thread; their records, in the order of the jobs."""
    text = "".join(f"{job}\n" for job in jobs)
    found = run(["fleet", "run", "-", "--threads", "1"], given=text, stacklevel=None).splitlines()
    records = {record_of(line, "a worker")["key"]: line for line in found}
    wanted = [str(json.loads(job)["key"]) for job in jobs]
    if set(records) != set(wanted):
        raise BoresightError("malformed-record", "a worker", f"records of {len(set(wanted))} jobs", str(len(records)))
    return [records[key] for key in dict.fromkeys(wanted)]


class FleetWork:
    """The jobs of a plan that have no record in a folder."""

    def __init__(self, plan: Plan, out: Place, batch: int | None, retry: bool) -> None:
        if batch is not None and batch < 1:
            raise BoresightError("out-of-range", "batch", "a number of jobs from 1", str(batch))
        self.plan, self.out, self.batch = plan, Path(out), batch
        self.records = RecordFile(self.out / "records.jsonl")
        try:
            there = keys(self.out, retry)
        except BaseException:
            self.records.__exit__(None, None, None)
            raise
        known = {job["key"]: line for job, line in zip(plan.jobs, plan.lines, strict=True)}
        self.left = [line for key, line in known.items() if key not in there]
        self.total = len(known)
        self.done = self.total - len(self.left)

    call = staticmethod(run_batch)

    def tasks(self, places: int) -> list[list[str]]:
        """Batches of jobs."""
        spread = math.ceil(len(self.left) / (BATCHES * max(1, places)))
        size = self.batch or max(1, min(LARGEST_BATCH, spread))
        return [self.left[at : at + size] for at in range(0, len(self.left), size)]

    def take(self, task: list[str], result: list[str]) -> None:
        """Adds records to the file."""
        self.records.append(result)
        self.done += len(task)

    def finish(self) -> Fleet:
        """Merges the records of the folder."""
        return merge(files(self.out), plan=self.plan, out=self.out, force=True)

    def __enter__(self) -> "FleetWork":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.records.__exit__(kind, error, trace)
