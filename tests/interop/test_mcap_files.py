"""MCAP files of the command line, checked by MCAP's own package for Python."""

import base64
import csv
import json

import numpy as np
import pytest
from conftest import boresight
from jsonschema import Draft202012Validator
from mcap.reader import SeekingReader
from mcap.records import Chunk, DataEnd, Footer, Header, Message
from mcap.stream_reader import StreamReader

NUMBERS = {1: "u1", 7: "<f4"}


def points(cloud):
    """The points of a foxglove.PointCloud as a structured array."""
    fields = {field["name"]: (NUMBERS[field["type"]], field["offset"]) for field in cloud["fields"]}
    of = np.dtype(
        {
            "names": list(fields),
            "formats": [fmt for fmt, _ in fields.values()],
            "offsets": [offset for _, offset in fields.values()],
            "itemsize": cloud["point_stride"],
        }
    )
    return np.frombuffer(base64.b64decode(cloud["data"]), of)


@pytest.fixture(scope="module")
def files(drive, tmp_path_factory):
    """A drive and its calibration as a file, and the tables and the result to compare with."""
    folder = tmp_path_factory.mktemp("mcap")
    path = folder / "angles.mcap"
    result = json.loads(boresight("calibrate", drive, "--joint", "--json", "--mcap", path))
    boresight("log", drive, "--export", folder)
    return path, folder, result


def test_checksums_index_and_order_hold(files):
    path, _, _ = files
    with path.open("rb") as file:
        records = list(StreamReader(file, validate_crcs=True, emit_chunks=True).records)
    chunks = [record for record in records if isinstance(record, Chunk)]
    assert isinstance(records[0], Header) and records[0].library.startswith("boresight ")
    assert chunks and all(chunk.compression == "" and chunk.uncompressed_crc for chunk in chunks)
    assert [record.data_section_crc for record in records if isinstance(record, DataEnd)] != [0]
    footer = next(record for record in records if isinstance(record, Footer))
    assert footer.summary_start and footer.summary_offset_start and footer.summary_crc
    with path.open("rb") as file:
        messages = [r for r in StreamReader(file, validate_crcs=True).records if isinstance(r, Message)]
    times = [message.log_time for message in messages]
    assert times == sorted(times)
    by_channel = {}
    for message in messages:
        assert message.sequence == by_channel.setdefault(message.channel_id, 0)
        by_channel[message.channel_id] += 1
    with path.open("rb") as file:
        summary = SeekingReader(file, validate_crcs=True).get_summary()
    assert summary.statistics.message_count == len(messages)
    assert summary.statistics.channel_message_counts == by_channel
    assert len(summary.chunk_indexes) == len(chunks)


def test_every_message_is_of_its_schema(files):
    path, _, _ = files
    with path.open("rb") as file:
        reader = SeekingReader(file, validate_crcs=True)
        schemas = {key: json.loads(schema.data) for key, schema in reader.get_summary().schemas.items()}
        for schema in schemas.values():
            Draft202012Validator.check_schema(schema)
            # What is not described is not sent.
            closed(schema)
        validators = {key: Draft202012Validator(schema) for key, schema in schemas.items()}
        seen = {}
        for schema, channel, message in reader.iter_messages():
            seen[channel.topic] = seen.get(channel.topic, 0) + 1
            if seen[channel.topic] % 7 == 1:
                validators[schema.id].validate(json.loads(message.data))
    assert len(seen) == 4 + 5 * 4


def closed(schema):
    """Forbids properties that the schema does not name."""
    if isinstance(schema, dict):
        if "properties" in schema:
            schema["additionalProperties"] = False
        for value in schema.values():
            closed(value)
    elif isinstance(schema, list):
        for value in schema:
            closed(value)


def test_points_and_angles_are_those_of_tables_and_result(files):
    path, folder, result = files
    clouds, angles = {}, {}
    with path.open("rb") as file:
        reader = SeekingReader(file, validate_crcs=True)
        for _, channel, message in reader.iter_messages():
            _, kind, *rest = channel.topic.split("/")
            if kind == "radar" and rest[1] == "detections":
                clouds.setdefault(int(rest[0]), []).append(points(json.loads(message.data)))
            elif kind == "radar" and rest[1] == "mounting":
                angles[int(rest[0])] = json.loads(message.data)
    with (folder / "detections.csv").open() as file:
        rows = list(csv.DictReader(file))
    for sensor, scans in clouds.items():
        got = np.concatenate(scans)
        own = [row for row in rows if int(row["sensor"]) == sensor]
        assert len(got) == len(own) > 1000
        for name in ("range_m", "azimuth_rad", "range_rate_mps", "rcs_dbsm"):
            assert np.array_equal(got[name], np.array([float(row[name]) for row in own], "f4")), name
        assert np.allclose(got["x"], got["range_m"] * np.cos(got["azimuth_rad"]), atol=1e-4)
        assert set(got["label"]) <= set(range(12)) and 11 in got["label"]
        weights = got["static_weight"]
        assert weights.min() >= 0 and weights.max() <= 1 and weights.mean() > 0.3
    for one in result:
        told = angles[one["sensor"]]
        assert told["angleDeg"] == one["angleDeg"] and told["sigmaDeg"] == one["sigmaDeg"]
        assert told["joint"] and told["frames"] == one["frames"]
        assert told["driftDeg"] == pytest.approx(one["angleDeg"] - one["nominalDeg"], abs=1e-9)
