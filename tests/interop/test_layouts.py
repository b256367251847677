"""RadarScenes files in the layouts that h5py writes, read back by the command line."""

import h5py
import numpy as np
import pytest
from conftest import log

NUMBERS = ["range_sc", "azimuth_sc", "rcs", "vr", "vr_compensated", "x_cc", "y_cc", "x_seq", "y_seq"]
ROWS = 3000
CHUNKED = {"chunks": (500,)}


def tables(width=32, order="<", real="f4"):
    """Scans of 10 detections, radars 1 and 2 in turn every 20 ms; 50 rows end in NaN."""
    random = np.random.default_rng(1)
    radar = np.zeros(
        ROWS,
        [("timestamp", order + "i8"), ("sensor_id", "u1")]
        + [(name, order + real) for name in NUMBERS]
        + [("uuid", f"S{width}"), ("track_id", f"S{width}"), ("label_id", "u1")],
    )
    scan = np.arange(ROWS) // 10
    radar["timestamp"] = 156862647501 + 20_000 * scan
    radar["sensor_id"] = 1 + scan % 2
    for name in NUMBERS:
        radar[name] = random.uniform(-1, 1, ROWS)
    for name in ("x_seq", "y_seq", "vr_compensated"):
        radar[name][-50:] = np.nan
    radar["uuid"] = b"0123456789abcdef"
    radar["label_id"] = 11
    odometry = np.zeros(
        600,
        [("timestamp", order + "i8")]
        + [(name, order + real) for name in ("x_seq", "y_seq", "yaw_seq", "vx", "yaw_rate")],
    )
    odometry["timestamp"] = 156862647501 + 10_000 * np.arange(600)
    odometry["vx"] = 10
    return radar, odometry


LAYOUTS = {
    "contiguous": ({}, {}, "earliest"),
    "strings of 64": ({"width": 64}, {}, "earliest"),
    "strings of 16": ({"width": 16}, {}, "earliest"),
    "big endian": ({"order": ">"}, {}, "earliest"),
    "double": ({"real": "f8"}, {}, "earliest"),
    "chunked": ({}, CHUNKED, "earliest"),
    "gzip": ({}, {**CHUNKED, "compression": "gzip", "compression_opts": 9}, "earliest"),
    "shuffle and gzip": ({}, {**CHUNKED, "compression": "gzip", "shuffle": True}, "earliest"),
    "lzf": ({}, {**CHUNKED, "compression": "lzf"}, "earliest"),
    "checksums": ({}, {**CHUNKED, "fletcher32": True}, "earliest"),
    "growing": ({}, {**CHUNKED, "maxshape": (None,)}, "earliest"),
    "v110": ({}, {}, ("v110", "v110")),
    "v114 gzip": ({"width": 64}, {**CHUNKED, "compression": "gzip"}, ("v110", "v114")),
    "v114 growing": ({}, {**CHUNKED, "maxshape": (None,)}, ("v110", "v114")),
}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_is_read(layout, tmp_path):
    types, options, libver = LAYOUTS[layout]
    radar, odometry = tables(**types)
    with h5py.File(tmp_path / "radar_data.h5", "w", libver=libver) as file:
        file.create_dataset("radar_data", data=radar, **options)
        file.create_dataset("odometry", data=odometry, **options)
    told = log(tmp_path)
    assert told["format"] == "radarscenes"
    assert (told["scans"], told["detections"], told["motionSamples"]) == (300, ROWS, 600)
    assert [(s["id"], s["scans"], s["detections"]) for s in told["sensors"]] == [
        (1, 150, 1500),
        (2, 150, 1500),
    ]
    assert told["radarSpan"] == {"startS": 0, "endS": pytest.approx(5.98)}
    assert told["dropped"] == {}
    assert told["incomplete"] == {"detections": 50, "motion": 0}
