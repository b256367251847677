"""The command line under test, and a drive that it simulated."""

import json
import os
import subprocess

import pytest


def boresight(*arguments, check=True):
    """Runs the command line; its standard output, or the finished process with check=False."""
    command = [os.environ["BORESIGHT"], *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    if not check:
        return done
    assert done.returncode == 0, done.stderr
    return done.stdout


def log(path, *arguments):
    """What `boresight log` says of a drive."""
    return json.loads(boresight("log", path, "--json", *arguments))


@pytest.fixture(scope="session", params=["contiguous", "packed"])
def drive(request, tmp_path_factory):
    """The folder of a simulated drive whose second radar is misaligned."""
    folder = tmp_path_factory.mktemp(request.param)
    packed = ["--packed"] if request.param == "packed" else []
    boresight(
        "simulate",
        "drive",
        "--scenario",
        "city",
        "--seed",
        1,
        "--duration",
        20,
        "--misalign",
        "2=1.5",
        *packed,
        "--out",
        folder,
    )
    return folder
