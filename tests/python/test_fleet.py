import json
import os
import signal
import subprocess
import sys
import time

import pytest
from conftest import DELPHI, PATTERN, is_fleet, sorted_lines

import boresight
from boresight import fleet
from boresight.fleet.records import RecordFile
from boresight.fleet.work import FleetWork, run_batch


def test_a_plan_names_each_log_once_with_its_settings(drives, tmp_path):
    plan = fleet.plan(drives[:4], vehicle=PATTERN, min_speed_mps=3, joint=True, out=tmp_path / "jobs.jsonl")
    assert [(job["vehicle"], job["drive"]) for job in plan] == [
        ("car-0", "00"),
        ("car-0", "03"),
        ("car-1", "01"),
        ("car-2", "02"),
    ]
    assert len(plan) == 4 and json.loads(plan.lines[0])["settings"] == {
        "joint": True,
        "calibration": {"minSpeedMps": 3},
    }
    again = fleet.Plan.read(tmp_path / "jobs.jsonl")
    assert again.lines == plan.lines and os.listdir(tmp_path) == ["jobs.jsonl"]
    listed = fleet.plan([{"path": str(drives[0]), "vehicle": "v", "drive": "d", "timeS": 5.5}])
    assert (listed.jobs[0]["vehicle"], listed.jobs[0]["drive"], listed.jobs[0]["timeS"]) == ("v", "d", 5.5)
    assert len(fleet.plan(str(DELPHI), vehicle="one", nominal_deg=1)) == 1


def test_what_cannot_be_planned_is_told(tmp_path):
    with pytest.raises(boresight.BoresightError) as caught:
        fleet.plan([tmp_path / "none"])
    assert caught.value.code == "file"
    with pytest.raises(boresight.BoresightError) as caught:
        fleet.plan([DELPHI], min_speed_mps=-1)
    assert caught.value.what == "min_speed_mps"
    with pytest.raises(TypeError, match="unexpected keyword argument 'min_sped'"):
        fleet.plan([DELPHI], min_sped=-1)


def test_parts_come_to_what_one_process_comes_to(records_of_one_process, tmp_path):
    plan, lines, merged = records_of_one_process
    assert len(lines) == len(plan) == 13
    for part in ("2/3", "1/3", "3/3"):
        fleet.run(plan, tmp_path / "records", part)
    assert sorted(os.listdir(tmp_path / "records")) == [f"records-{k}-of-3.jsonl" for k in (1, 2, 3)]
    assert sorted_lines(tmp_path / "records") == lines
    found = fleet.merge(tmp_path / "records", plan=plan, out=tmp_path / "merged")
    assert (tmp_path / "merged" / "fleet.json").read_bytes() == merged
    assert is_fleet(found, merged)
    assert set(found) == set(fleet.Fleet.__annotations__)
    [radar] = found["vehicles"][0]["radars"]
    assert abs(radar["angleDeg"] - radar["nominalDeg"]) < 1
    assert [vehicle["name"] for vehicle in found["vehicles"]] == ["car-0", "car-1", "car-2"]
    assert (found["logs"]["done"], found["logs"]["failed"]) == (12, 1)


def test_records_tell_what_calibrate_tells(records_of_one_process, drives, tmp_path):
    plan, _, _ = records_of_one_process
    fleet.run(plan, tmp_path)
    found = {record["path"]: record for record in fleet.read_records(tmp_path)}
    [radar] = boresight.calibrate(drives[3])
    [told] = found[str(drives[3])]["done"]["radars"]
    assert told["result"]["angleDeg"] == radar["angleDeg"] and told["sensor"] == radar["sensor"]
    failed = found[str(drives[-1])]["failed"]
    assert set(failed) == {"code", "message", "what", "expected", "given"}


def test_merging_without_all_records_is_an_error_unless_partial(records_of_one_process, tmp_path):
    plan, _, _ = records_of_one_process
    fleet.run(plan, tmp_path, "1/2")
    with pytest.raises(boresight.BoresightError) as caught:
        fleet.merge(tmp_path, plan=plan)
    assert caught.value.code == "incomplete"
    assert fleet.merge(tmp_path, plan=plan, partial=True)["logs"]["missing"] == 6
    with pytest.raises(boresight.BoresightError) as caught:
        fleet.merge(tmp_path, alarm_deg=-1)
    assert caught.value.what == "alarm_deg"


def test_a_batch_gives_its_records_in_the_order_of_jobs(records_of_one_process):
    plan, lines, _ = records_of_one_process
    jobs = plan.lines[::-1][:5]
    found = run_batch([*jobs, jobs[0]])
    assert [json.loads(record)["key"] for record in found] == [json.loads(job)["key"] for job in jobs]
    assert {f"{record}\n".encode() for record in found} < set(lines)
    with pytest.raises(boresight.BoresightError) as caught:
        run_batch([plan.lines[0].replace(plan.jobs[0]["key"], "0" * 32)])
    assert caught.value.code == "edited-plan"


def test_work_leaves_out_what_has_a_record(records_of_one_process, tmp_path):
    """Whatever part of which run it is from; with `retry` only what did not fail."""
    plan, lines, _ = records_of_one_process
    failed = next(line for line in lines if b'"failed"' in line)
    (tmp_path / "records-2-of-7.jsonl").write_bytes(lines[0] + failed + lines[1][:-5])
    for retry, left in ((False, 11), (True, 12)):
        with FleetWork(plan, tmp_path, 3, retry) as work:
            assert (work.total, work.done, len(work.left)) == (13, 13 - left, left)
            assert [len(task) for task in work.tasks(2)] == [3] * (left // 3) + ([left % 3] if left % 3 else [])
    with FleetWork(plan, tmp_path, None, False) as work:
        assert {len(task) for task in work.tasks(1)} <= {2, 3} and {len(task) for task in work.tasks(100)} == {1}
        with pytest.raises(boresight.BoresightError) as caught:
            FleetWork(plan, tmp_path, None, False)
        assert caught.value.code == "busy"
    (tmp_path / "records-3-of-7.jsonl").write_text('{"key": "a"}\n')
    with pytest.raises(boresight.BoresightError) as caught:
        FleetWork(plan, tmp_path, None, False)
    assert caught.value.code == "malformed-record" and "line 1" in caught.value.what
    with pytest.raises(boresight.BoresightError, match="batch"):
        FleetWork(plan, tmp_path, 0, False)


@pytest.mark.parametrize("torn", [b"", b'{"key', b"x" * 200_000])
def test_a_file_of_records_grows_by_whole_lines(tmp_path, torn):
    path = tmp_path / "out" / "records.jsonl"
    path.parent.mkdir()
    path.write_bytes(b'{"a": 1}\n' + torn)
    with RecordFile(path) as file:
        file.append(['{"b": 2}', '{"c": 3}'])
    assert path.read_bytes() == b'{"a": 1}\n{"b": 2}\n{"c": 3}\n'
    path.write_bytes(torn)
    with RecordFile(path) as file:
        file.append(["{}"])
    assert path.read_bytes() == b"{}\n"


def test_damaged_records_are_run_again(records_of_one_process, tmp_path):
    plan, lines, _ = records_of_one_process
    file = tmp_path / "records.jsonl"
    turned = lines[0].replace(b'"sensor":1', b'"sensor":9', 1)
    assert turned != lines[0]
    file.write_bytes(turned + lines[1][:90] + b"\0" * 4096 + lines[2][90:] + lines[3])
    with FleetWork(plan, tmp_path, None, False) as work:
        assert (work.total, work.done) == (13, 1)
    assert [record["drive"] for record in fleet.read_records(tmp_path)] == [json.loads(lines[3])["drive"]]


def test_a_write_that_fails_leaves_whole_lines(tmp_path, monkeypatch):
    """The disk is full after so many bytes."""
    path = tmp_path / "records.jsonl"
    write = os.write
    with RecordFile(path) as file:
        file.append(["first"])
        room = [9]

        def full(to, data):
            if room[0] == 0:
                raise OSError(28, "no room")
            size = write(to, data[: room[0]])
            room[0] -= size
            return size

        monkeypatch.setattr(os, "write", full)
        with pytest.raises(OSError):
            file.append(["second", "third"])
        assert path.read_bytes() == b"first\nsecond\n"
        monkeypatch.setattr(os, "write", write)
        file.append(["third"])
    assert path.read_bytes() == b"first\nsecond\nthird\n"


CALLER = """
import sys, boresight
from boresight.fleet.engines import _work
plan = boresight.fleet.Plan.read(sys.argv[1])
with _work(plan, sys.argv[2], 1, False, {}) as work:
    for task in work.tasks(1):
        work.take(task, work.call(task))
        print(work.done, flush=True)
"""


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT])
def test_a_caller_that_is_stopped_goes_on(records_of_one_process, tmp_path, how):
    plan, lines, _ = records_of_one_process
    plan.write(tmp_path / "jobs.jsonl")
    arguments = [sys.executable, "-c", CALLER, str(tmp_path / "jobs.jsonl"), str(tmp_path / "out")]
    caller = subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    while int(caller.stdout.readline()) < 3:
        pass
    time.sleep(0.01)
    caller.send_signal(how)
    assert caller.wait() != 0
    before = sorted_lines(tmp_path / "out")
    assert 3 <= len(before) < len(lines) and set(before) < set(lines)
    subprocess.run(arguments, check=True, stdout=subprocess.DEVNULL)
    assert sorted_lines(tmp_path / "out") == lines
