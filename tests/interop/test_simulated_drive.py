"""What `simulate drive` writes, read by the data set's own package and by h5py."""

import json

import h5py
import numpy as np
import pytest
from conftest import log
from radar_scenes.sensors import get_mounting
from radar_scenes.sequence import Sequence, get_training_sequences

RADAR = np.dtype(
    [("timestamp", "<i8"), ("sensor_id", "u1")]
    + [
        (name, "<f4")
        for name in (
            "range_sc",
            "azimuth_sc",
            "rcs",
            "vr",
            "vr_compensated",
            "x_cc",
            "y_cc",
            "x_seq",
            "y_seq",
        )
    ]
    + [("uuid", "S32"), ("track_id", "S32"), ("label_id", "u1")]
)
ODOMETRY = np.dtype(
    [("timestamp", "<i8")] + [(name, "<f4") for name in ("x_seq", "y_seq", "yaw_seq", "vx", "yaw_rate")]
)


@pytest.fixture(scope="module")
def sequence(drive):
    [name] = get_training_sequences(str(drive / "data" / "sequences.json"))
    return Sequence.from_json(str(drive / "data" / name / "scenes.json"))


def test_types_and_storage(drive):
    with h5py.File(drive / "data" / "sequence_1" / "radar_data.h5") as file:
        assert set(file) == {"radar_data", "odometry"}
        assert file["radar_data"].dtype == RADAR
        assert file["odometry"].dtype == ODOMETRY
        packed = "packed" in drive.name
        assert (file["radar_data"].chunks is not None) == packed
        assert file["radar_data"].compression == ("gzip" if packed else None)


def test_scenes_tell_of_the_same_drive_as_the_log(drive, sequence):
    told = log(drive / "data" / "sequence_1")
    assert len(sequence) == told["scans"]
    assert len(sequence.radar_data) == told["detections"] == told["rowsRead"]["detections"]
    assert len(sequence.odometry_data) == told["motionSamples"]
    assert told["dropped"] == {} and told["format"] == "radarscenes"
    assert told["sequence"] == {"name": sequence.sequence_name, "category": "train"}
    assert told["mountings"] == "sensors-json"
    for sensor in told["sensors"]:
        mounting = get_mounting(sensor["id"], json_path=str(drive / "data" / "sensors.json"))
        assert sensor["mounting"]["xM"] == mounting["x"]
        assert sensor["mounting"]["yM"] == mounting["y"]
        assert sensor["mounting"]["yawDeg"] == pytest.approx(np.degrees(mounting["yaw"]), abs=1e-9)
    first = sequence.odometry_data["timestamp"][0]
    for stamp, key in ((sequence.first_timestamp, "startS"), (sequence.last_timestamp, "endS")):
        assert told["radarSpan"][key] == pytest.approx((stamp - first) / 1e6, abs=1e-9)
    for sensor in told["sensors"]:
        scenes = list(sequence.scenes(sensor_id=sensor["id"]))
        assert len(scenes) == sensor["scans"]
        assert sum(len(scene.radar_data) for scene in scenes) == sensor["detections"]


def test_every_number_is_that_of_the_log(drive, sequence, tmp_path):
    log(drive / "data" / "sequence_1", "--export", tmp_path)

    def table(name):
        return np.genfromtxt(tmp_path / name, delimiter=",", names=True)

    rows, motion = sequence.radar_data, sequence.odometry_data
    origin = motion["timestamp"][0]
    detections = table("detections.csv")
    seconds = (rows["timestamp"] - origin) / 1e6
    np.testing.assert_array_equal(detections["time_s"], seconds)
    np.testing.assert_array_equal(detections["sensor"], rows["sensor_id"])
    for column, field in (
        ("azimuth_rad", "azimuth_sc"),
        ("range_rate_mps", "vr"),
        ("range_m", "range_sc"),
        ("rcs_dbsm", "rcs"),
    ):
        np.testing.assert_array_equal(detections[column].astype("f4"), rows[field])
    samples = table("motion.csv")
    np.testing.assert_array_equal(samples["time_s"], (motion["timestamp"] - origin) / 1e6)
    for column, field in (
        ("yaw_rate_radps", "yaw_rate"),
        ("speed_mps", "vx"),
        ("x_m", "x_seq"),
        ("y_m", "y_seq"),
        ("yaw_rad", "yaw_seq"),
    ):
        np.testing.assert_array_equal(samples[column].astype("f4"), motion[field])


def test_scenes_follow_one_another(sequence):
    scenes = list(sequence.scenes())
    stamps = [scene.timestamp for scene in scenes]
    assert stamps == sorted(set(stamps)) == sequence.timestamps
    assert len(scenes) == len(sequence)
    rows = 0
    for scene in scenes:
        rows += len(scene.radar_data)
        assert (scene.radar_data["timestamp"] == scene.timestamp).all()
        assert (scene.radar_data["sensor_id"] == scene.sensor_id).all()
        assert scene.odometry_data["timestamp"] == scene.odometry_timestamp
        # 100 Hz: the nearest sample is at most half a step away.
        assert abs(scene.odometry_timestamp - scene.timestamp) <= 5000
    assert rows == len(sequence.radar_data)
    backwards = sequence.get_scene(sequence.last_timestamp)
    back = [backwards.timestamp]
    while (backwards := sequence.prev_scene_before(backwards.timestamp)) is not None:
        back.append(backwards.timestamp)
    assert back[::-1] == stamps


def test_places_and_rates_follow_from_mounting_and_motion(drive, sequence):
    for scene in list(sequence.scenes())[::50]:
        rows, motion = scene.radar_data, scene.odometry_data
        mounting = get_mounting(scene.sensor_id, json_path=str(drive / "data" / "sensors.json"))
        x, y, azimuth = mounting["x"], mounting["y"], rows["azimuth_sc"] + mounting["yaw"]
        cos, sin = np.cos(azimuth), np.sin(azimuth)
        compensated = rows["vr"] + (motion["vx"] - motion["yaw_rate"] * y) * cos + motion["yaw_rate"] * x * sin
        # Single precision at up to 100 m from the car, some hundred m from the start and 20 m/s.
        np.testing.assert_allclose(rows["vr_compensated"], compensated, atol=2e-5)
        np.testing.assert_allclose(rows["x_cc"], x + rows["range_sc"] * cos, atol=5e-5)
        np.testing.assert_allclose(rows["y_cc"], y + rows["range_sc"] * sin, atol=5e-5)
        cos, sin = np.cos(motion["yaw_seq"]), np.sin(motion["yaw_seq"])
        x_seq = motion["x_seq"] + rows["x_cc"] * cos - rows["y_cc"] * sin
        y_seq = motion["y_seq"] + rows["x_cc"] * sin + rows["y_cc"] * cos
        np.testing.assert_allclose(rows["x_seq"], x_seq, atol=2e-4)
        np.testing.assert_allclose(rows["y_seq"], y_seq, atol=2e-4)


def test_labels_and_tracks(sequence):
    rows = sequence.radar_data
    static = rows["label_id"] == 11
    assert 0.5 < static.mean() < 1
    assert (rows["label_id"] <= 11).all()
    assert (rows["track_id"][static] == b"").all()
    assert (np.char.str_len(rows["track_id"][~static]) == 32).all()
    assert len(set(rows["uuid"])) == len(rows)
    # What stands still has no rate left but noise; most of what moves has.
    standing = np.abs(rows["vr_compensated"][static])
    assert np.median(standing) < 0.5 < np.median(np.abs(rows["vr_compensated"][~static]))


def test_truth_has_the_misalignment_that_sensors_json_lacks(drive):
    truth = json.loads((drive / "truth.json").read_text())
    for sensor in truth["sensors"]:
        mounting = get_mounting(sensor["id"], json_path=str(drive / "data" / "sensors.json"))
        assert np.degrees(mounting["yaw"]) == pytest.approx(sensor["nominalYawDeg"], abs=1e-9)
        off = sensor["yawDeg"] - sensor["nominalYawDeg"]
        assert off == pytest.approx(1.5 if sensor["id"] == 2 else 0, abs=1e-9)
        assert (mounting["x"], mounting["y"]) == (sensor["xM"], sensor["yM"])
