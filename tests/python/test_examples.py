"""The examples for clusters, each run as far as a machine without one can."""

import os
import re
import shlex
import subprocess
import sys

import pytest
import yaml
from conftest import PATTERN, ROOT, sorted_lines

import boresight
from boresight.binary import binary

EXAMPLES = ROOT / "examples" / "fleet"


@pytest.fixture
def place(records_of_one_process, tmp_path):
    """A folder with the plan, and a command line that is found as `boresight`."""
    records_of_one_process[0].write(tmp_path / "jobs.jsonl")
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "boresight").symlink_to(binary())
    return tmp_path


def run(command, place, **variables):
    kept = {name: value for name, value in os.environ.items() if not re.match("SLURM|JOB_|CONDOR|_CONDOR", name)}
    path = f"{place / 'bin'}{os.pathsep}{kept['PATH']}"
    environment = {**kept, "PATH": path, **variables}
    return subprocess.run(command, cwd=place, env=environment, capture_output=True, text=True, check=True).stdout


def test_slurm(place, records_of_one_process):
    """Tasks 3 to 5 of an array that begins at 3, one of them twice."""
    script = EXAMPLES / "slurm.sh"
    counts = {"SLURM_ARRAY_TASK_COUNT": "3", "SLURM_ARRAY_TASK_MIN": "3", "SLURM_CPUS_PER_TASK": "2"}
    for task in ("4", "3", "5", "4"):
        run(["sh", str(script)], place, SLURM_ARRAY_TASK_ID=task, **counts)
    assert sorted_lines(place / "records") == records_of_one_process[1]
    assert len(list((place / "records").iterdir())) == 3
    options = [line for line in script.read_text().splitlines() if line.startswith("#SBATCH ")]
    assert all(re.fullmatch(r"#SBATCH --[a-z-]+(=\S+)?", option) for option in options) and len(options) == 6


def test_kubernetes(place, records_of_one_process):
    """Each index by the manifest's own command, with its paths moved here."""
    manifest = yaml.safe_load((EXAMPLES / "kubernetes.yaml").read_text())
    assert (manifest["apiVersion"], manifest["kind"]) == ("batch/v1", "Job")
    spec = manifest["spec"]
    assert spec["completionMode"] == "Indexed" and spec["parallelism"] <= spec["completions"]
    [container] = spec["template"]["spec"]["containers"]
    variables = {one["name"]: one["value"] for one in container["env"]}
    assert variables == {"JOB_COMPLETIONS": str(spec["completions"])}
    assert {mount["name"] for mount in container["volumeMounts"]} == {
        volume["name"] for volume in spec["template"]["spec"]["volumes"]
    }
    command = [word.replace("/data", str(place)) for word in container["command"]]
    # Three pods; the other indices find nothing to do.
    for index in range(3):
        run(command, place, JOB_COMPLETION_INDEX=str(index), JOB_COMPLETIONS="3")
    assert sorted_lines(place / "records") == records_of_one_process[1]
    last = spec["completions"] - 1
    run(command, place, JOB_COMPLETION_INDEX=str(last), **variables)
    assert sorted_lines(place / "records") == records_of_one_process[1]


@pytest.mark.parametrize("told", ["variables", "description"])
def test_htcondor(place, records_of_one_process, told):
    lines = (EXAMPLES / "htcondor.sub").read_text().splitlines()
    given = [line.split("=", 1) for line in lines if "=" in line and not line.startswith("#")]
    settings = {name.strip(): value.strip() for name, value in given}
    assert lines[-1] == "queue $(parts)" and int(settings["parts"]) > 1
    command = [settings["executable"].rsplit("/", 1)[1], *shlex.split(settings["arguments"])]
    for process in range(3):
        if told == "variables":
            text = settings["environment"].strip('"').replace("$(Process)", str(process)).replace("$(parts)", "3")
            variables = dict(word.split("=") for word in text.split())
        else:
            (place / "ad").write_text(f'Owner = "a"\nProcId = {process}\nTotalSubmitProcs = 3\n')
            variables = {"_CONDOR_JOB_AD": str(place / "ad")}
        run(command, place, **variables)
    assert sorted_lines(place / "records") == records_of_one_process[1]


@pytest.mark.parametrize("engine", ["dask", "ray"])
def test_scripts(engine, drives, place, records_of_one_process):
    variables = {"PYTHONPATH": str(ROOT / "python" / "boresight"), "VEHICLE": PATTERN, "BORESIGHT": binary()}
    logs = [str(log) for log in drives[:6]]
    printed = run([sys.executable, str(EXAMPLES / f"{engine}_fleet.py"), "out", *logs], place, **variables)
    table = [line.split("\t") for line in printed.splitlines() if "\t" in line]
    assert [row[:2] for row in table] == [["car-0", "1"], ["car-1", "1"], ["car-2", "1"]]
    keys = {record["key"] for record in boresight.fleet.read_records(place / "out")}
    planned = {job["path"]: job["key"] for job in records_of_one_process[0]}
    assert keys == {planned[log] for log in logs}
