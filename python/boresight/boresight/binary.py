"""Where the command line is."""

import os
import shutil
import subprocess
import sys
import sysconfig
from functools import cache
from pathlib import Path

from .errors import BoresightError
from .options import VERSION

NAME = "boresight.exe" if sys.platform == "win32" else "boresight"


def places() -> list[Path]:
    """Where it may be, in the order of preference: what BORESIGHT names, scripts of this installation, the path."""
    named = os.environ.get("BORESIGHT")
    if named:
        return [Path(named)]
    schemes = [sysconfig.get_default_scheme(), sysconfig.get_preferred_scheme("user")]
    found = [Path(sysconfig.get_path("scripts", scheme)) / NAME for scheme in schemes]
    # As `pip install --target` has it.
    found.append(Path(__file__).parent.parent / "bin" / NAME)
    on_path = shutil.which(NAME)
    return found + ([Path(on_path)] if on_path else [])


def binary() -> str:
    """The command line that this package is for.

    Raises `BoresightError`: `no-binary` where there is none, `other-version` where it is that of another version.
    """
    found = next((place for place in places() if os.access(place, os.X_OK) and place.is_file()), None)
    if found is None:
        given = ", ".join(str(place) for place in places())
        raise BoresightError("no-binary", "the command line", f"a program at {given}", "none")
    status = found.stat()
    return _checked(str(found), status.st_mtime_ns, status.st_size)


@cache
def _checked(path: str, _time: int, _size: int) -> str:
    try:
        told = subprocess.run([path, "--version"], capture_output=True, text=True, check=False, timeout=60).stdout
    except (OSError, subprocess.SubprocessError) as error:
        raise BoresightError("no-binary", path, "a program that runs here", str(error)) from error
    version = told.strip().removeprefix("boresight ")
    if version != VERSION:
        raise BoresightError("other-version", path, f"version {VERSION}, as the package is", version or "none")
    return path
