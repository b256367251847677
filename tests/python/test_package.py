"""The wheel and the source distribution of the package, in the folder that BORESIGHT_PACKAGE names."""

import os
import subprocess
import sys
import tarfile
import venv
import zipfile
from pathlib import Path

import numpy
import pytest
from conftest import DELPHI, ROOT

import boresight

FOLDER = os.environ.get("BORESIGHT_PACKAGE")
pytestmark = pytest.mark.skipif(not FOLDER, reason="`npm run test:python` builds the package")
USE = """
import sys, boresight
from importlib.metadata import version
assert version("boresight") == boresight.__version__
from boresight.binary import binary
assert binary().startswith(sys.prefix), binary()
[radar] = boresight.calibrate(sys.argv[1])
print(radar["angleDeg"])
"""


def only(pattern):
    [path] = Path(FOLDER).glob(pattern)
    return path


def test_the_wheel_works_where_nothing_else_is(tmp_path):
    """But NumPy, which it asks for, and no command line but its own."""
    wheel = only("wheel/*.whl")
    assert wheel.name.startswith(f"boresight-{boresight.__version__}-py3-none-")
    venv.create(tmp_path / "venv", with_pip=False)
    scripts = "Scripts" if sys.platform == "win32" else "bin"
    python = next((tmp_path / "venv" / scripts).glob("python*"))
    pip = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check", "--python", str(python)]
    subprocess.run([*pip, "install", "--no-index", "--no-deps", str(wheel)], check=True)
    beside = tmp_path / "numpy"
    beside.mkdir()
    for part in Path(numpy.__file__).parent.parent.glob("numpy*"):
        (beside / part.name).symlink_to(part)
    environment = {"PATH": "", "PYTHONPATH": str(beside)}
    ended = subprocess.run(
        [python, "-c", USE, str(DELPHI)], env=environment, capture_output=True, text=True, check=True
    )
    assert float(ended.stdout) == boresight.calibrate(DELPHI)[0]["angleDeg"]


def test_the_wheel_holds_modules_types_licences_and_the_command_line():
    with zipfile.ZipFile(only("wheel/*.whl")) as wheel:
        names = wheel.namelist()
        told = next(name for name in names if name.endswith("METADATA"))
        metadata = wheel.read(told).decode()
    package = ROOT / "python" / "boresight"
    modules = {str(path.relative_to(package)) for path in (package / "boresight").rglob("*.py")}
    assert modules | {"boresight/py.typed"} < set(names)
    assert any("/scripts/boresight" in name for name in names)
    assert {Path(name).name for name in names} >= {"LICENSE", "LICENSE-APACHE", "NOTICE"}
    for line in (
        "Requires-Python: >=3.11",
        "Requires-Dist: numpy>=1.26",
        "Provides-Extra: dask",
        "Provides-Extra: ray",
    ):
        assert f"\n{line}\n" in metadata


def test_the_source_distribution_holds_all_that_the_wheel_is_built_of():
    """It was: what the crates take in from above themselves is there, and nothing of tests' data."""
    with tarfile.open(only("*.tar.gz")) as archive:
        names = {name.split("/", 1)[1]: archive.getmember(name).size for name in archive.getnames()}
    weights = "models/motion/deepego-plus.bin"
    assert names[weights] == (ROOT / weights).stat().st_size
    assert {"Cargo.toml", "Cargo.lock", "crates/cli/src/main.rs", "boresight/options.py", "LICENSE", "NOTICE"} < set(
        names
    )
    assert not any(name.startswith(("tests/", "recordings/", "target/")) for name in names)
