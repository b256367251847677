import pickle
import shutil
import stat
import sys
import warnings
from pathlib import Path

import pytest
from conftest import DELPHI

import boresight
from boresight import binary as binary_module
from boresight.binary import binary
from boresight.errors import error_of, warn_of


def test_a_report_becomes_an_error():
    text = (
        "note: before\nerror: a file\nof two lines\n  what:     x.csv\n  expected: a number\n"
        "  given:    text\nand more\n  code:     malformed-file\n"
    )
    error = error_of(text, 1, {})
    assert (error.code, error.what, error.expected, error.given) == (
        "malformed-file",
        "x.csv",
        "a number",
        "text\nand more",
    )
    earlier = text.replace("malformed-file", "earlier").replace("of two lines", "of before")
    assert vars(error_of(earlier + text, 1, {})) == vars(error)
    assert error.message == "a file\nof two lines" and str(error) == "a file\nof two lines [malformed-file]"
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is boresight.BoresightError and vars(again) == vars(error)


def test_whatever_a_command_ends_with_is_told():
    names = {"--min-speed": "min_speed_mps", "--method": "method"}
    for text, status, code, what, given in (
        ("error: --min-speed is -4; expected a number\n\n\nUsage: boresight\n", 2, "option", "min_speed_mps", "-4"),
        (
            "error: invalid value 'f' for '--method <method>'\n  [possible values: a, b]\n\nFor",
            2,
            "option",
            "method",
            "f",
        ),
        ("error: invalid value 'x' for '--sensor <N>': invalid digit\n\nFor", 2, "option", "--sensor", "x"),
        (
            "error: unexpected argument '--x' found\n\nUsage",
            2,
            "usage",
            "the command",
            "unexpected argument '--x' found",
        ),
        ("", -9, "killed", "the command", "an end by signal 9"),
        ("", 3, "usage", "the command", ""),
        ("thread 'main' panicked", 134, "usage", "the command", "thread 'main' panicked"),
    ):
        error = error_of(text, status, names)
        assert (error.code, error.what, error.given) == (code, what, given)
        assert error.message


def test_options_are_called_as_they_were_given():
    with pytest.raises(boresight.BoresightError) as caught:
        boresight.calibrate(DELPHI, min_speed_mps=-3)
    error = caught.value
    assert (error.code, error.what, error.given) == ("option", "min_speed_mps", "-3")
    assert error.expected == "a number from 0 to 1000"
    with pytest.raises(boresight.BoresightError) as caught:
        boresight.calibrate(DELPHI, sensor=9)
    assert (caught.value.code, caught.value.what) == ("option", "sensor")
    with pytest.raises(boresight.BoresightError) as caught:
        boresight.calibrate("-none")
    assert caught.value.code == "file" and "-none" in caught.value.what


def test_lines_of_remarks():
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        warn_of("note: one: two\nwarning      three\nanything\nnotes\n", 1)
    assert [str(one.message) for one in caught] == ["one: two", "three"]


@pytest.fixture
def elsewhere(monkeypatch, tmp_path):
    """No command line beside the package or named by BORESIGHT; the folder that is the path."""
    monkeypatch.delenv("BORESIGHT", raising=False)
    monkeypatch.setattr(binary_module.sysconfig, "get_path", lambda *_: str(tmp_path / "none"))
    monkeypatch.setenv("PATH", str(tmp_path))
    return tmp_path


def test_the_command_line_is_beside_the_package_or_named_or_on_the_path(elsewhere, monkeypatch):
    with pytest.raises(boresight.BoresightError) as caught:
        boresight.calibrate(DELPHI)
    assert caught.value.code == "no-binary"
    program(elsewhere / binary_module.NAME)
    assert binary() == str(elsewhere / binary_module.NAME)
    scripts = elsewhere / "scripts"
    program(scripts / binary_module.NAME)
    monkeypatch.setattr(binary_module.sysconfig, "get_path", lambda *_: str(scripts))
    assert binary() == str(scripts / binary_module.NAME)
    named = program(elsewhere / "named" / "boresight")
    monkeypatch.setenv("BORESIGHT", str(named))
    assert binary() == str(named)
    monkeypatch.setenv("BORESIGHT", str(elsewhere / "absent"))
    with pytest.raises(boresight.BoresightError, match="absent"):
        binary()


@pytest.mark.skipif(sys.platform == "win32", reason="scripts of a shell")
def test_another_version_is_refused(elsewhere, monkeypatch):
    other = program(elsewhere / "boresight", "0.0.9")
    with pytest.raises(boresight.BoresightError) as caught:
        binary()
    error = caught.value
    assert (error.code, error.what, error.given) == ("other-version", str(other), "0.0.9")
    assert boresight.__version__ in error.expected
    # Replaced meanwhile, it is asked again.
    program(other)
    assert binary() == str(other)
    program(other).write_text("no program")
    with pytest.raises(boresight.BoresightError, match="no-binary"):
        binary()


def program(path, version=None):
    """A command line that tells its version alone."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\necho boresight {version or boresight.__version__}\n")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return path


def test_the_version_is_the_workspaces():
    manifest = (Path(__file__).parent.parent.parent / "Cargo.toml").read_text()
    assert f'\nversion = "{boresight.__version__}"\n' in manifest
    assert shutil.which(binary())
