"""Validation of mounting angles on many drives, in parts that run anywhere."""

import json
import os
import shutil
import tempfile
from pathlib import Path
from types import TracebackType
from typing import Any

from .command import Place, is_truth, run
from .errors import BoresightError
from .options import VERSION

Task = tuple[list[str], int, int]
"""Arguments of `boresight validate`, which part, of how many."""


class Validation:
    """`boresight validate` on a folder of drives, to run in parts by `boresight.fleet.dask` or `boresight.fleet.ray`.

    Options are its flags, with underscores for dashes: `Validation("drives", parts=8, pieces=[25, 60])`. The workers
    read the drives, by the same path.
    """

    def __init__(self, drives: Place, *, parts: int, **options: object) -> None:
        if parts < 1:
            raise BoresightError("out-of-range", "parts", "a number from 1", str(parts))
        self.parts = parts
        self.arguments = [os.path.abspath(drives), *_flags(options)]
        """Arguments of `boresight validate`."""


def _flags(options: dict[str, object]) -> list[str]:
    """Flags: each item of a list is given by itself."""
    given = []
    for name, value in options.items():
        flag = f"--{name.replace('_', '-')}"
        if is_truth(value):
            given += [flag] if value else []
        elif value is not None:
            for item in value if isinstance(value, list | tuple) else [value]:
                given += [flag, os.path.abspath(item) if isinstance(item, os.PathLike) else str(item)]
    return given


def run_part(task: Task) -> dict[str, str]:
    """Runs a part on one thread; its files of records, by name."""
    arguments, part, parts = task
    with tempfile.TemporaryDirectory(prefix="boresight-") as folder:
        place = ["--part", f"{part}/{parts}", "--threads", "1", "--out", folder]
        run(["validate", *arguments, *place], stacklevel=None)
        found = {path.name: path.read_text(encoding="utf-8") for path in sorted(Path(folder).glob("*.jsonl"))}
    if not found:
        raise BoresightError("malformed-record", f"part {part}", "files of records", "none")
    return found


class ValidationWork:
    """The parts of a validation that have no records in a folder."""

    def __init__(self, validation: Validation, out: Place) -> None:
        self.validation, self.out = validation, Path(out)
        self.parts = self.out / "parts"
        self.parts.mkdir(parents=True, exist_ok=True)
        self._hold()
        numbers = range(1, validation.parts + 1)
        self.left = [number for number in numbers if not self._folder(number).is_dir()]
        self.total = validation.parts
        self.done = self.total - len(self.left)

    call = staticmethod(run_part)

    def tasks(self, places: int) -> list[Task]:
        """The parts left."""
        return [(self.validation.arguments, number, self.validation.parts) for number in self.left]

    def take(self, task: Task, result: dict[str, str]) -> None:
        """Keeps the records of a part, all or none."""
        folder = self._folder(task[1])
        beside = folder.with_name(f".{folder.name}.{os.getpid()}")
        shutil.rmtree(beside, ignore_errors=True)
        beside.mkdir()
        for name, text in result.items():
            (beside / Path(name).name).write_text(text, encoding="utf-8")
        beside.replace(folder)
        self.done += 1

    def finish(self) -> dict[str, Any]:
        """Puts the parts together, by `boresight validate --merge`."""
        folders = [f"--merge={self._folder(number)}" for number in range(1, self.validation.parts + 1)]
        merged: dict[str, Any] = json.loads(
            run(["validate", *folders, "--out", str(self.out), "--json", "--force"], stacklevel=3)
        )
        return merged

    def _folder(self, part: int) -> Path:
        return self.parts / f"{part}-of-{self.validation.parts}"

    def _hold(self) -> None:
        """Sees that the folder is of this validation: parts of another would be taken for its own."""
        of = self.validation
        wanted = json.dumps({"version": VERSION, "arguments": of.arguments, "parts": of.parts})
        file = self.parts / "validation.json"
        if file.exists():
            given = file.read_text(encoding="utf-8").strip()
            if given != wanted:
                raise BoresightError("other-run", str(self.parts), f"parts of {wanted}", given)
        else:
            file.write_text(f"{wanted}\n", encoding="utf-8")

    def __enter__(self) -> "ValidationWork":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        return None
