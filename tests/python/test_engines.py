"""Fleets and validations on the workers of Dask and Ray, some of which are killed."""

import json
import os
import signal
import stat

import pytest
from conftest import PATTERN, command, is_fleet, sorted_lines

import boresight
from boresight import fleet
from boresight.binary import binary

#: The command line, but where a file `kill` or `fail` lies beside it: the one who takes it away kills the worker that
#: called it, or ends with an error. Only the commands that workers run do so.
WRAPPER = """#!/bin/sh
case "$*" in "fleet run - "*|"validate "*" --part "*)
  mv "{folder}/kill" "{folder}/killed" 2>/dev/null && {{ kill -9 $PPID; exit 1; }}
  [ -e "{folder}/fail" ] && {{ echo "error: no memory" >&2; exit 3; }}
esac
exec "{binary}" "$@"
"""
PIECES = [4, 8]


@pytest.fixture(scope="module")
def wishes(tmp_path_factory):
    """The folder of what is wished of the workers' command line."""
    folder = tmp_path_factory.mktemp("wishes")
    script = folder / "boresight"
    script.write_text(WRAPPER.format(folder=folder, binary=binary()))
    script.chmod(script.stat().st_mode | stat.S_IXUSR)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("BORESIGHT", str(script))
        yield folder


@pytest.fixture(scope="module")
def client(wishes):
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(n_workers=3, threads_per_worker=1, dashboard_address=":0") as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client


@pytest.fixture(scope="module")
def ray_cluster(wishes):
    ray = pytest.importorskip("ray")
    ray.init(num_cpus=3, include_dashboard=False, log_to_driver=False, configure_logging=False)
    yield
    ray.shutdown()


@pytest.fixture(params=["dask", "ray"])
def engine(request):
    """The function of an engine with three workers."""
    if request.param == "dask":
        client = request.getfixturevalue("client")
        return lambda logs, **more: fleet.dask(client, logs, **more)
    request.getfixturevalue("ray_cluster")
    return fleet.ray


class Told:
    """Keeps what progress is told."""

    def __init__(self, then=lambda done: None):
        self.calls, self.then = [], then

    def __call__(self, done, total):
        self.calls.append((done, total))
        self.then(done)


def test_a_worker_that_dies_in_a_batch_loses_nothing(engine, wishes, records_of_one_process, tmp_path):
    plan, lines, merged = records_of_one_process
    (wishes / "kill").touch()
    told = Told()
    found = engine(plan, out=tmp_path, batch=2, progress=told)
    assert not (wishes / "kill").exists(), "no worker was killed"
    assert sorted_lines(tmp_path) == lines
    assert (tmp_path / "fleet.json").read_bytes() == merged and is_fleet(found, merged)
    done = [done for done, _ in told.calls]
    assert (done[0], done[-1], len(done)) == (0, 13, 8) and done == sorted(done)
    assert {total for _, total in told.calls} == {13}


def test_a_worker_of_dask_that_is_killed_from_without_loses_nothing(client, records_of_one_process, tmp_path):
    plan, lines, merged = records_of_one_process
    pids = set(client.run(os.getpid).values())
    assert len(pids) == 3
    killed = min(pids)
    fleet.dask(
        client, plan, out=tmp_path, batch=1, progress=Told(lambda done: done == 2 and os.kill(killed, signal.SIGKILL))
    )
    assert sorted_lines(tmp_path) == lines
    assert (tmp_path / "fleet.json").read_bytes() == merged
    client.wait_for_workers(3, timeout=60)
    assert killed not in client.run(os.getpid).values()


def test_what_has_a_record_is_not_run_again(engine, wishes, records_of_one_process, tmp_path):
    plan, lines, merged = records_of_one_process
    (tmp_path / "records.jsonl").write_bytes(b"".join(lines[:9]) + lines[9][:-7])
    told = Told()
    engine(plan, out=tmp_path, progress=told)
    assert told.calls[0] == (9, 13) and sorted_lines(tmp_path) == lines
    assert (tmp_path / "fleet.json").read_bytes() == merged
    # With all of them there, workers are not asked.
    (wishes / "fail").touch()
    try:
        assert is_fleet(engine(plan, out=tmp_path), merged)
    finally:
        (wishes / "fail").unlink()


def test_logs_are_planned_by_the_caller(engine, drives, tmp_path, monkeypatch):
    """Paths of the plan are absolute, wherever workers are; settings are those given."""
    monkeypatch.chdir(drives[0].parent)
    found = engine([drives[0].name], out=tmp_path, vehicle=PATTERN, min_speed_mps=5)
    [record] = fleet.read_records(tmp_path)
    assert record["path"] == str(drives[0]) and record["vehicle"] == "car-0"
    [radar] = boresight.calibrate(drives[0], min_speed_mps=5)
    assert record["done"]["radars"][0]["result"]["angleDeg"] == radar["angleDeg"]
    assert found["logs"]["done"] == 1


def test_what_stops_a_run_leaves_whole_records(engine, wishes, records_of_one_process, tmp_path):
    plan, lines, merged = records_of_one_process

    def stop(done):
        if done >= 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        engine(plan, out=tmp_path, batch=1, progress=Told(stop))
    assert len(sorted_lines(tmp_path)) == 3 and set(sorted_lines(tmp_path)) < set(lines)
    (wishes / "fail").touch()
    try:
        with pytest.raises(boresight.BoresightError, match="no memory"):
            engine(plan, out=tmp_path, batch=1, retries=1)
    finally:
        (wishes / "fail").unlink()
    assert len(sorted_lines(tmp_path)) == 3
    engine(plan, out=tmp_path)
    assert sorted_lines(tmp_path) == lines
    assert (tmp_path / "fleet.json").read_bytes() == merged


@pytest.fixture(scope="module")
def folder_of_drives(tmp_path_factory):
    folder = tmp_path_factory.mktemp("drives")
    for seed in range(4):
        place = folder / f"drive-{seed}"
        command("simulate", "drive", "--scenario", "city", "--duration", "9", "--seed", str(seed), "--out", place)
    return folder


@pytest.fixture(scope="module")
def validation_of_one_process(folder_of_drives, tmp_path_factory):
    folder = tmp_path_factory.mktemp("validation")
    command("validate", folder_of_drives, "--pieces", "4,8", "--threads", "1", "--out", folder)
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_a_validation_in_parts_is_that_of_one_process(
    engine, wishes, folder_of_drives, validation_of_one_process, tmp_path
):
    validation = boresight.Validation(folder_of_drives, parts=4, pieces=PIECES)
    (wishes / "kill").touch()
    told = Told()
    found = engine(validation, out=tmp_path, progress=told)
    assert not (wishes / "kill").exists(), "no worker was killed"
    assert [done for done, _ in told.calls] == [0, 1, 2, 3, 4]
    files = {path.name: path.read_bytes() for path in tmp_path.iterdir() if path.is_file()}
    assert files == validation_of_one_process
    assert found == json.loads(files["calibration-drives.json"])
    # A part that is missing is run again, and no other.
    (tmp_path / "parts" / "2-of-4" / "calibration-drives-2-of-4.jsonl").unlink()
    (tmp_path / "parts" / "2-of-4").rmdir()
    told = Told()
    assert engine(validation, out=tmp_path, progress=told) == found and told.calls == [(3, 4), (4, 4)]
    with pytest.raises(boresight.BoresightError) as caught:
        engine(boresight.Validation(folder_of_drives, parts=4, pieces=[5]), out=tmp_path)
    assert caught.value.code == "other-run"


def test_arguments_that_do_not_go_together_are_refused(engine, records_of_one_process, tmp_path):
    plan, _, _ = records_of_one_process
    with pytest.raises(TypeError, match="a plan has its settings; it takes no joint"):
        engine(plan, out=tmp_path, joint=True)
    with pytest.raises(TypeError, match="a validation takes no vehicle, batch"):
        engine(boresight.Validation("drives", parts=2), out=tmp_path, vehicle="a", batch=3)
    with pytest.raises(boresight.BoresightError) as caught:
        boresight.Validation("drives", parts=0)
    assert caught.value.what == "parts"
    with pytest.raises(boresight.BoresightError) as caught:
        engine(boresight.Validation("none", parts=1, unknown=1), out=tmp_path, retries=0)
    assert caught.value.code == "usage" and "unknown" in caught.value.message


def test_options_of_a_validation_are_flags():
    from pathlib import Path

    options = {
        "pieces": [25, 60],
        "json": True,
        "csv": False,
        "threads": None,
        "merge": (),
        "out": Path("a"),
    }
    validation = boresight.Validation("drives", parts=1, **options)
    here = Path.cwd()
    expected = [str(here / "drives"), "--pieces", "25", "--pieces", "60", "--json", "--out", str(here / "a")]
    assert validation.arguments == expected
