"""Point clouds and tables as nuScenes lays them out, written here with NumPy, read by the command line."""

import csv
import json
import struct

import numpy as np
import pytest
from conftest import boresight, log

FIELDS = {
    "x": "f4",
    "y": "f4",
    "z": "f4",
    "dyn_prop": "i1",
    "id": "i2",
    "rcs": "f4",
    "vx": "f4",
    "vy": "f4",
    "vx_comp": "f4",
    "vy_comp": "f4",
    "is_quality_valid": "i1",
    "ambig_state": "i1",
    "x_rms": "i1",
    "y_rms": "i1",
    "invalid_state": "i1",
    "pdh0": "i1",
    "vx_rms": "i1",
    "vy_rms": "i1",
}
LOG = "n015-2018-07-24-11-22-45+0800"
FIRST_US = 1_532_402_927_000_000
RADARS = {"RADAR_BACK_RIGHT": ([-0.6, -0.6, 0.5], 3.0), "RADAR_FRONT": ([3.4, 0.0, 0.5], 0.02)}


def lzf(data):
    """LZF by the shortest matcher there is: runs of one byte and literals."""
    out, at, literal = bytearray(), 0, bytearray()

    def flush():
        for start in range(0, len(literal), 32):
            run = literal[start : start + 32]
            out.append(len(run) - 1)
            out.extend(run)
        literal.clear()

    while at < len(data):
        run = 1
        while at + run < len(data) and data[at + run] == data[at] and run < 200:
            run += 1
        if run >= 5:
            literal.append(data[at])
            flush()
            copy = run - 1 - 2
            out.extend([copy << 5, 0] if copy < 7 else [7 << 5, copy - 7, 0])
            at += run
        else:
            literal.extend(data[at : at + run])
            at += run
    flush()
    return bytes(out)


def write_pcd(path, rows, storage):
    kinds = [np.dtype(kind) for kind in FIELDS.values()]
    head = [
        "# .PCD v0.7 - Point Cloud Data file format",
        "VERSION 0.7",
        f"FIELDS {' '.join(FIELDS)}",
        f"SIZE {' '.join(str(kind.itemsize) for kind in kinds)}",
        f"TYPE {' '.join(kind.kind.upper() for kind in kinds)}",
        f"COUNT {' '.join('1' for _ in kinds)}",
        f"WIDTH {len(rows)}",
        "HEIGHT 1",
        "VIEWPOINT 0 0 0 1 0 0 0",
        f"POINTS {len(rows)}",
        f"DATA {storage}",
    ]
    if storage == "ascii":
        body = "".join(" ".join(repr(number.item()) for number in row) + "\n" for row in rows).encode()
    elif storage == "binary":
        body = rows.tobytes()
    else:
        columns = b"".join(rows[name].tobytes() for name in FIELDS)
        packed = lzf(columns)
        body = struct.pack("<II", len(packed), len(columns)) + packed
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes("\n".join(head).encode() + b"\n" + body)


def quaternion(yaw):
    return [np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)]


def pose(time):
    """A car at 8 m/s whose heading swings, in closed form but for its place, which is summed up finely."""
    steps = np.linspace(0, time, 2000)
    heading = 0.4 * np.sin(0.5 * steps)
    x, y = (np.trapezoid(8 * of(heading), steps) for of in (np.cos, np.sin))
    return x, y, 0.4 * np.sin(0.5 * time)


@pytest.fixture(params=["ascii", "binary", "binary_compressed"])
def folder(request, tmp_path):
    """Eight seconds of two radars, and what the reader should make of it."""
    random = np.random.default_rng(7)
    data, poses, expected = [], [], []
    for step in range(104):
        stamp = FIRST_US + 77_000 * step
        time = (stamp - FIRST_US) / 1e6
        x, y, yaw = pose(time)
        poses.append(
            {
                "token": f"p{step}",
                "timestamp": stamp,
                "translation": [600 + x, 1600 + y, 0.0],
                "rotation": quaternion(yaw),
            }
        )
        for number, (channel, (place, mounted)) in enumerate(RADARS.items(), 1):
            speed, rate = 8.0, 0.2 * np.cos(0.5 * time)
            rows = np.zeros(40, [(name, "<" + kind) for name, kind in FIELDS.items()])
            ranges, azimuths = random.uniform(5, 60, 40), random.uniform(-1, 1, 40)
            rows["x"], rows["y"] = ranges * np.cos(azimuths), ranges * np.sin(azimuths)
            car = np.array([speed - rate * place[1], rate * place[0]])
            own = np.array(
                [
                    np.cos(mounted) * car[0] + np.sin(mounted) * car[1],
                    np.cos(mounted) * car[1] - np.sin(mounted) * car[0],
                ]
            )
            # As nuScenes' radars state it: straight ahead or back, so that its part along the ray is what was measured.
            radial = -(own[0] * np.cos(azimuths) + own[1] * np.sin(azimuths))
            rows["vx"] = radial / np.cos(azimuths)
            rows["rcs"] = random.uniform(-10, 20, 40)
            rows["ambig_state"] = 3
            rows["invalid_state"][:2] = [4, 17]
            rows["dyn_prop"][2] = 7
            rows["ambig_state"][3] = 1
            name = f"sweeps/{channel}/{LOG}__{channel}__{stamp}.pcd"
            write_pcd(tmp_path / name, rows, request.param)
            data.append(
                {
                    "token": f"d{step}{number}",
                    "ego_pose_token": f"p{step}",
                    "calibrated_sensor_token": channel,
                    "timestamp": stamp,
                    "filename": name,
                    "is_key_frame": False,
                }
            )
            # NumPy's arithmetic on what was stored.
            kept = rows[4:].astype([(field, "f8") for field in FIELDS])
            norm = np.hypot(kept["x"], kept["y"])
            along = (kept["vx"] * kept["x"] + kept["vy"] * kept["y"]) / norm
            angle = np.arctan2(kept["y"], kept["x"])
            expected.extend(zip([time] * 36, [number] * 36, angle, along, norm, kept["rcs"], strict=True))
    tables = {
        "sample_data": data,
        "ego_pose": poses,
        "calibrated_sensor": [
            {"token": channel, "sensor_token": f"s{channel}", "translation": place, "rotation": quaternion(yaw)}
            for channel, (place, yaw) in RADARS.items()
        ],
        "sensor": [{"token": f"s{channel}", "channel": channel, "modality": "radar"} for channel in RADARS],
    }
    (tmp_path / "v1.0-mini").mkdir()
    for name, rows in tables.items():
        (tmp_path / "v1.0-mini" / f"{name}.json").write_text(json.dumps(rows, indent=0))
    return tmp_path, np.array(expected)


def test_clouds_and_tables_are_read_as_numpy_has_them(folder, tmp_path):
    where, expected = folder
    told = log(where / "sweeps", where / "v1.0-mini", "--export", tmp_path / "tables")
    assert told["format"] == "pcd" and told["mountings"] == "calibrated-sensor"
    assert told["dropped"] == {"invalid-state": 416, "ambiguous-doppler": 208, "dynamic-property": 208}
    for sensor, (place, yaw) in zip(told["sensors"], RADARS.values(), strict=True):
        assert sensor["mounting"]["xM"] == place[0] and sensor["mounting"]["yM"] == place[1]
        assert sensor["mounting"]["yawDeg"] == pytest.approx(np.degrees(yaw))
    with open(tmp_path / "tables" / "detections.csv") as file:
        read = np.array([[float(number) for number in row] for row in list(csv.reader(file))[1:]])
    order = np.lexsort((expected[:, 1], expected[:, 0]))
    np.testing.assert_allclose(read, expected[order], rtol=1e-5, atol=1e-5)
    with open(tmp_path / "tables" / "motion.csv") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 104
    for row in rows[1:-1]:
        time = float(row["time_s"])
        # Central differences over 154 ms: third derivatives times 0.077^2 / 6.
        assert float(row["yaw_rate_radps"]) == pytest.approx(0.2 * np.cos(0.5 * time), abs=6e-5)
        assert float(row["speed_mps"]) == pytest.approx(8, abs=3e-3)
    angles = json.loads(boresight("calibrate", where / "sweeps", where / "v1.0-mini", "--joint", "--json"))
    for found, (_, yaw) in zip(angles, RADARS.values(), strict=True):
        assert abs(found["angleDeg"] - np.degrees(yaw)) < max(3 * found["sigmaDeg"], 0.05), found


def test_a_recording_among_several_is_chosen_by_its_name(folder):
    where, _ = folder
    first = next((where / "sweeps" / "RADAR_FRONT").iterdir())
    first.with_name(first.name.replace("n015", "n008")).write_bytes(first.read_bytes())
    refused = boresight("log", where / "sweeps", check=False)
    assert refused.returncode != 0 and "clouds of one recording" in refused.stderr
    told = log(where / "sweeps", "--sequence", "n015")
    assert (told["scans"], told["motionSamples"], told["sequence"]["name"]) == (208, 0, LOG)
    assert boresight("log", where / "sweeps", "--sequence", "n016", check=False).returncode != 0
