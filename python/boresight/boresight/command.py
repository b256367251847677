"""Running the command line."""

import math
import os
import subprocess
import types
import typing
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from .binary import binary
from .errors import error_of, warn_of
from .options import Kind

Place = str | os.PathLike[str]
"""Where a file or a folder is."""


def flags(function: str, options: Mapping[str, object], known: Mapping[str, tuple[str, Kind]]) -> list[str]:
    """Flags of the options given; those that are None are not.

    Raises TypeError for an option that is not known.
    """
    given = []
    for name, value in options.items():
        if name not in known:
            raise TypeError(f"{function}() got an unexpected keyword argument {name!r}")
        if value is None:
            continue
        flag, kind = known[name]
        if kind in ("truth", "no"):
            if not is_truth(value):
                raise TypeError(f"{function}() takes True or False for {name!r}, not {value!r}")
            if bool(value) is (kind == "truth"):
                given.append(flag)
        elif kind == "list":
            # A list with a comma in one of its names is none that the command line can be given.
            items = [value] if isinstance(value, str) else list(typing.cast(Iterable[object], value))
            given += [flag, ",".join(map(str, items))] if items else []
        else:
            given += [flag, str(value)]
    return given


def is_truth(value: object) -> bool:
    """Whether a value is True or False, of Python or NumPy."""
    return isinstance(value, bool) or (type(value).__name__ in ("bool", "bool_") and type(value).__module__ == "numpy")


def names(known: Mapping[str, tuple[str, Kind]]) -> dict[str, str]:
    """The name in Python of each flag, for errors."""
    return {flag: name for name, (flag, _) in known.items()}


def paths(place: Place | Sequence[Place]) -> list[str]:
    """One path or several, where none can be taken for a flag."""
    several = [place] if isinstance(place, str | os.PathLike) else list(place)
    return [f"./{path}" if path.startswith("-") else path for path in (os.fspath(one) for one in several)]


def run(
    arguments: Sequence[str],
    *,
    named: Mapping[str, str] | None = None,
    given: str | None = None,
    stacklevel: int | None = 1,
) -> str:
    """What a command prints. What it remarks becomes a warning, `stacklevel` callers above; with None it is left out.

    Raises `BoresightError` where the command fails, whose options are called as `named` says.
    """
    ended = subprocess.run(
        [binary(), *arguments],
        input=given,
        stdin=subprocess.DEVNULL if given is None else None,
        capture_output=True,
        encoding="utf-8",
        errors="surrogateescape",
        check=False,
    )
    if ended.returncode != 0:
        raise error_of(ended.stderr, ended.returncode, named or {})
    if stacklevel is not None:
        warn_of(ended.stderr, stacklevel + 1)
    return ended.stdout


def finite_again(value: Any, of: Any) -> Any:
    """A result of type `of` in which null stands for no number no more.

    JSON knows no infinity, so that null stands in its place, and None for a number that may be absent. Standard
    deviations are infinite where nothing is known; any other such number is NaN.
    """
    return _restored(value, of, "")


def _restored(value: Any, of: Any, name: str) -> Any:
    origin, arguments = typing.get_origin(of), typing.get_args(of)
    if origin in (typing.NotRequired, typing.Required):
        return _restored(value, arguments[0], name)
    if origin in (types.UnionType, typing.Union):
        others = [one for one in arguments if one is not types.NoneType]
        return value if value is None or len(others) != 1 else _restored(value, others[0], name)
    if value is None and of is float:
        return math.inf if "sigma" in name.lower() else math.nan
    if origin is list and isinstance(value, list):
        return [_restored(one, arguments[0], name) for one in value]
    if isinstance(value, dict) and typing.is_typeddict(of):
        hints = typing.get_type_hints(of, include_extras=True)
        return {field: _restored(one, hints.get(field, Any), field) for field, one in value.items()}
    return value
