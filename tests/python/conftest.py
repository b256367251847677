"""Simulated drives for the tests, and the command line that they use: what BORESIGHT names."""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

import boresight
from boresight.binary import binary
from boresight.command import finite_again

ROOT = Path(__file__).parent.parent.parent
DELPHI = ROOT / "recordings" / "delphi"
#: Where vehicle and drive stand in the paths of the drives below.
PATTERN = "{vehicle}/{drive}/data/*"


def command(*arguments):
    """Runs the command line by itself; what it prints."""
    return subprocess.run([binary(), *map(str, arguments)], capture_output=True, text=True, check=True).stdout


def simulate(folder, seed, *options):
    """A drive of half a minute, by one radar unless options name more; the folder of the log."""
    common = ["--sensor", "1", "--duration", "30", "--seed", seed, "--out", folder]
    command("simulate", "drive", *common, *options)
    return folder / "data" / "sequence_1"


@pytest.fixture(scope="session")
def drives(tmp_path_factory):
    """Twelve drives of three cars, and a log that is none."""
    folder = tmp_path_factory.mktemp("drives")
    logs = [simulate(folder / f"car-{seed % 3}" / f"{seed:02}", seed) for seed in range(12)]
    broken = folder / "car-0" / "broken.csv"
    broken.write_text("time_s,azimuth_deg\n1,2\n")
    return [*logs, broken]


@pytest.fixture(scope="session")
def records_of_one_process(drives, tmp_path_factory):
    """The plan of the drives, and the lines of their records by one process, sorted."""
    folder = tmp_path_factory.mktemp("one")
    plan = plan_of(drives)
    boresight.fleet.run(plan, folder / "records")
    boresight.fleet.merge(folder / "records", plan=plan, out=folder / "merged")
    return plan, sorted_lines(folder / "records"), (folder / "merged" / "fleet.json").read_bytes()


def plan_of(drives):
    """A plan that says of each log which vehicle's and which drive it is."""
    logs = []
    for log in drives:
        vehicle = next(part for part in log.parts if part.startswith("car-"))
        drive = log.parts[log.parts.index(vehicle) + 1]
        logs.append({"path": str(log), "vehicle": vehicle, "drive": drive})
    return boresight.fleet.plan(logs)


def sorted_lines(folder):
    """The lines of the records in a folder, sorted: they come in no order."""
    return sorted(line for path in folder.glob("*.jsonl") for line in path.read_bytes().splitlines(keepends=True))


def simulated_response(azimuths_deg, elements=8):
    """Snapshots, one a column, of unit sources before evenly spaced elements, half a wavelength apart."""
    phases = np.pi * np.arange(elements)[:, None] * np.sin(np.radians(np.asarray(azimuths_deg)))
    return np.exp(1j * phases)


def is_fleet(found, merged):
    """Whether a result is what the bytes of a `fleet.json` say, numbers that are not finite included."""
    told = finite_again(json.loads(merged), boresight.fleet.Fleet)
    return json.dumps(found, sort_keys=True) == json.dumps(told, sort_keys=True)
