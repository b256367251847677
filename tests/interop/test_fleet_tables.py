"""The tables of a fleet, read by PyArrow."""

import datetime
import json

import pyarrow.parquet
from conftest import boresight


def test_tables_hold_what_the_json_holds(drive, tmp_path):
    sequence = drive / "data" / "sequence_1"
    listed = tmp_path / "logs.jsonl"
    listed.write_text(json.dumps({"path": str(sequence), "vehicle": "Wägelchen", "timeS": 1777629600.25}) + "\n")
    plan, records, results = (tmp_path / name for name in ("jobs.jsonl", "records", "results"))
    boresight("fleet", "plan", "--list", listed, "--out", plan)
    boresight("fleet", "run", plan, "--out", records)
    boresight("fleet", "merge", records, "--plan", plan, "--out", results)
    fleet = json.loads((results / "fleet.json").read_text())
    [vehicle] = fleet["vehicles"]

    drives = pyarrow.parquet.read_table(results / "drives.parquet").to_pylist()
    assert [row["sensor"] for row in drives] == [1, 2, 3, 4]
    for row, radar in zip(drives, vehicle["radars"], strict=True):
        [angle] = radar["drives"]
        assert (row["vehicle"], row["path"]) == ("Wägelchen", str(sequence))
        assert row["time"] == datetime.datetime(2026, 5, 1, 10, 0, 0, 250_000, datetime.UTC)
        assert (row["angle_deg"], row["sigma_deg"]) == (angle["angleDeg"], angle["sigmaDeg"])
        assert row["converged"] is angle["converged"]

    radars = pyarrow.parquet.read_table(results / "radars.parquet").to_pylist()
    for row, radar in zip(radars, vehicle["radars"], strict=True):
        assert (row["nominal_deg"], row["angle_deg"]) == (radar["nominalDeg"], radar["angleDeg"])
        assert (row["alignment"], row["source"], row["knocks"]) == (radar["alignment"], radar["source"], 0)
        assert row["drift_deg"] is None
        assert row["scale"] == vehicle["shared"]["scale"]
