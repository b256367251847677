"""Running a plan on this machine, and merging records."""

import json
import os
import tempfile
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Unpack, cast

from ..command import Place, finite_again, flags, names, paths
from ..command import run as command
from ..options import MERGE_OPTIONS, MergeOptions
from ..results import Fleet
from .plan import Plan

NAMED = {f"--{name}": name for name in ("out", "part", "threads", "retry", "plan", "partial", "force")}


def run(
    plan: Plan | Place, out: Place, part: str | None = None, *, threads: int | None = None, retry: bool = False
) -> Path:
    """Runs a plan or a part of it on this machine, by `boresight fleet run`; the folder of the records.

    Arguments:

        plan: The plan, or its file.
        out: Folder of the records. Logs that have one there are not run again.
        part: Such as "2/8": the second of eight parts; "auto" as the variables of Slurm, Kubernetes or HTCondor say.
        threads: Threads; as many as there are cores if absent.
        retry: Run logs again that failed.
    """
    with ExitStack() as stack:
        arguments = ["fleet", "run", *_file(plan, stack), "--out", *paths(out)]
        if part is not None:
            arguments += ["--part", part]
        if threads is not None:
            arguments += ["--threads", str(threads)]
        if retry:
            arguments.append("--retry")
        command(arguments, named=NAMED, stacklevel=2)
    return Path(out)


def merge(
    records: Place | Sequence[Place],
    plan: Plan | Place | None = None,
    out: Place | None = None,
    *,
    partial: bool = False,
    force: bool = False,
    threads: int | None = None,
    **options: Unpack[MergeOptions],
) -> Fleet:
    """What records come to, by `boresight fleet merge`.

    Arguments:

        records: Files of records, or folders of them.
        plan: The plan: each of its logs must have a record, and others are left out.
        out: Folder for `fleet.json`, the tables and the report.
        partial: Take the records that are there, though logs of the plan have none.
        force: Replace the files of an earlier merge.
        threads: Threads; as many as there are cores if absent.
        options: How drives are put together, by `MergeOptions`.
    """
    with ExitStack() as stack:
        arguments = ["fleet", "merge", "--json", *paths(records), *flags("merge", options, MERGE_OPTIONS)]
        if plan is not None:
            arguments += ["--plan", *_file(plan, stack)]
        if out is not None:
            arguments += ["--out", *paths(out)]
        if threads is not None:
            arguments += ["--threads", str(threads)]
        if partial:
            arguments.append("--partial")
        if force:
            arguments.append("--force")
        found = json.loads(command(arguments, named=names(MERGE_OPTIONS) | NAMED, stacklevel=2))
    return cast(Fleet, finite_again(found, Fleet))


def _file(plan: Plan | Place, stack: ExitStack) -> list[str]:
    """The path of a plan's file, which may be there for as long as the stack is open."""
    if not isinstance(plan, Plan):
        return paths(os.fspath(plan))
    file = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="boresight-")), "jobs.jsonl")
    plan.write(file)
    return [str(file)]
