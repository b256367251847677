"""Recordings by mcap-ros2-support and rosbags: what their own readers see, and what the command line sees."""

import csv
import json
import math
import struct

import numpy as np
import pytest
import recordings
from conftest import boresight, log
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

WRITERS = ["mcap none", "mcap lz4", "mcap zstd", "mcap unchunked", "rosbags none", "rosbags zstd"]


@pytest.fixture(scope="module", params=WRITERS)
def recording(request, tmp_path_factory):
    """A recording: what is given to the command line, and its one file."""
    writer, compression = request.param.split()
    folder = tmp_path_factory.mktemp(f"{writer}_{compression}")
    if writer == "mcap":
        path = folder / "recording.mcap"
        chunked = compression != "unchunked"
        recordings.by_mcap(path, compression if chunked else "none", chunked)
        return path, path
    recordings.by_rosbags(folder / "bag", compression)
    [path] = (folder / "bag").glob("*.mcap")
    return folder / "bag", path


def seen(path, topic=None):
    """Topic, time of recording and message as mcap's own reader decodes them."""
    with path.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        return [
            (channel.topic, message.log_time, decoded)
            for _, channel, message, decoded in reader.iter_decoded_messages(topics=topic, log_time_order=False)
        ]


def equal(ours, theirs):
    """Whether numbers are the same to the last digit, NaN being null."""
    if isinstance(theirs, dict):
        return ours.keys() == theirs.keys() and all(equal(ours[name], theirs[name]) for name in theirs)
    if isinstance(theirs, list):
        return len(ours) == len(theirs) and all(map(equal, ours, theirs))
    return ours == theirs


@pytest.mark.parametrize("topic", ["/odom", "/radar/front", "/radar/left", "/camera", "/tf_static"])
def test_every_field_of_every_message_is_the_same(recording, topic):
    _, path = recording
    ours = recordings.as_lines(boresight("log", path, "--messages", topic))
    theirs = seen(path, topic)
    assert len(ours) == len(theirs) == (1 if topic == "/tf_static" else 20)
    for own, (_, time, message) in zip(ours, theirs, strict=True):
        assert own["logTimeNs"] == time
        assert equal(own["message"], recordings.plain(message)), topic


def test_the_drive_is_made_of_what_their_reader_sees(recording, tmp_path):
    given, path = recording
    told = log(given, "--export", tmp_path / "tables")
    assert told["format"] == "mcap"
    counts = {}
    for topic, _, _ in seen(path):
        counts[topic] = counts.get(topic, 0) + 1
    assert {topic["name"]: topic["messages"] for topic in told["topics"]} == counts
    used = {topic["name"]: (topic["usedAs"], topic["sensor"], topic["clock"]) for topic in told["topics"]}
    assert used == {
        "/camera": ("unused", None, None),
        "/odom": ("motion", None, "stamp"),
        "/radar/front": ("radar", 1, "stamp"),
        "/radar/left": ("radar", 2, "stamp"),
        "/tf_static": ("mountings", None, None),
    }
    start = recordings.START
    assert told["startS"] == pytest.approx(start / 1e9, abs=1e-6)
    detections, dropped = [], 0
    for topic, _, message in seen(path):
        stamp = getattr(message, "header", None) and message.header.stamp
        time = stamp and (stamp.sec * 10**9 + stamp.nanosec - start) / 1e9
        if topic == "/radar/front":
            for one in message.returns:
                detections.append((time, 1, one.azimuth, one.doppler_velocity, one.range))
        elif topic == "/radar/left":
            for i in range(message.width * message.height):
                x, y, z, rate = struct.unpack_from("<ffff", bytes(message.data), i * message.point_step)
                if math.isnan(rate):
                    dropped += 1
                    continue
                detections.append((time, 2, math.atan2(y, x), rate, math.hypot(x, y, z)))
    assert told["dropped"] == {"not-finite": dropped}
    assert told["rowsRead"]["detections"] == len(detections) + dropped
    with (tmp_path / "tables" / "detections.csv").open() as file:
        rows = list(csv.DictReader(file))
    own = np.array(
        [
            [float(row[name]) for name in ("time_s", "sensor", "azimuth_rad", "range_rate_mps", "range_m")]
            for row in rows
        ]
    )
    np.testing.assert_array_equal(own.astype("f4"), np.array(sorted(detections, key=lambda d: d[:2])).astype("f4"))
    np.testing.assert_allclose(own[:, 0], [d[0] for d in sorted(detections, key=lambda d: d[:2])], rtol=0, atol=1e-12)
    with (tmp_path / "tables" / "motion.csv").open() as file:
        motion = list(csv.DictReader(file))
    poses = [message for topic, _, message in seen(path) if topic == "/odom"]
    assert len(motion) == len(poses)
    for row, message in zip(motion, poses, strict=True):
        twist, pose = message.twist.twist, message.pose.pose
        assert float(row["speed_mps"]) == twist.linear.x
        assert float(row["yaw_rate_radps"]) == twist.angular.z
        assert (float(row["x_m"]), float(row["y_m"])) == (pose.position.x, pose.position.y)
        assert float(row["yaw_rad"]) == pytest.approx(2 * math.atan2(pose.orientation.z, pose.orientation.w), abs=1e-15)
    [_, left] = told["sensors"]
    assert left["mounting"] == pytest.approx({"xM": 3.5, "yM": 0.75, "yawDeg": math.degrees(0.5)}, abs=1e-12)
    assert told["mountings"] == "tf-static"


def test_a_cut_recording_is_read_as_far_as_it_goes(recording, tmp_path):
    _, path = recording
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(path.read_bytes()[: path.stat().st_size // 3])
    done = boresight("log", cut, "--json", check=False)
    assert "no end" in done.stderr
    if "rosbags_zstd" in str(path):
        # It is one chunk, of which what is unpacked comes out at its end.
        assert done.returncode != 0 and "no topics" in done.stderr
        return
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert 0 < told["scans"] < 40


def test_topics_can_be_named(recording):
    given, _ = recording
    told = log(given, "--radar-topics", "/radar/left", "--base-frame", "radar_left")
    assert [sensor["mounting"]["yawDeg"] for sensor in told["sensors"]] == [0]
    done = boresight("log", given, "--radar-topics", "/radar/rear", check=False)
    assert done.returncode != 0 and "/radar/rear" in done.stderr and "/radar/left" in done.stderr
