"""What the edge service tells in OpenMetrics, and the dashboard that asks for it, by the parsers of Prometheus."""

import json
import re
import subprocess
from pathlib import Path

import promql_parser
import pytest
from prometheus_client.openmetrics.parser import text_string_to_metric_families

EDGE = Path(__file__).parents[2] / "examples" / "edge"
STRANGE = 'a "quoted" \\ path,\n{in} Prüfstand 3 = 車'


def radar(name, **change):
    told = {
        "radar": name,
        "angleDeg": 29.5,
        "sigmaDeg": 0.1,
        "nominalDeg": 30,
        "alarmDeg": 1,
        "alignment": "aligned",
        "misaligned": False,
        "timeS": 12.5,
        "frames": 40,
        "detections": 9000,
        "repeated": 2,
        "refused": {"time-backwards": 3},
        "verdicts": {"given": 40, "used": 30, "standing": 10},
    }
    return {**told, **change}


VEHICLES = [
    {
        "vehicle": STRANGE,
        "receivedMs": 1_700_000_000_500,
        "refused": {"malformed-json": 7},
        "radars": [
            radar("front"),
            radar("rear", angleDeg=-1e-7, sigmaDeg=None, alignment="misaligned", misaligned=True),
            radar("bare", nominalDeg=None, alignment=None, misaligned=None, timeS=None, refused={}),
        ],
    },
    {"vehicle": "new", "receivedMs": 0, "refused": {}, "radars": []},
]


@pytest.fixture(scope="module")
def families():
    program = """
      import { openMetrics } from './src/metrics.js';
      process.stdout.write(openMetrics(JSON.parse(process.argv[1])));
    """
    command = ["node", "--input-type=module", "--eval", program, json.dumps(VEHICLES)]
    told = subprocess.run(command, cwd=EDGE, capture_output=True, encoding="utf-8", check=True).stdout
    return {family.name: family for family in text_string_to_metric_families(told)}


def values(family, **labels):
    return [sample.value for sample in family.samples if labels.items() <= sample.labels.items()]


def test_values_come_back(families):
    angle = families["boresight_mounting_angle_degrees"]
    assert (angle.type, angle.unit) == ("gauge", "degrees")
    assert values(angle, vehicle=STRANGE, radar="front") == [29.5]
    assert values(angle, vehicle=STRANGE, radar="rear") == [-1e-7]
    assert values(families["boresight_mounting_angle_sigma_degrees"], radar="rear") == [float("inf")]
    assert values(families["boresight_misaligned"]) == [0, 1]
    assert values(families["boresight_alignment"], boresight_alignment="misaligned") == [0, 1]
    assert values(families["boresight_frames"], radar="front") == [40]
    assert values(families["boresight_frames_judged"], radar="front", verdict="standing") == [10]
    assert values(families["boresight_frames_refused"], radar="front", reason="time-backwards") == [3]
    assert values(families["boresight_lines_refused"], reason="malformed-json") == [7]
    assert values(families["boresight_received_timestamp_seconds"], vehicle=STRANGE) == [1_700_000_000.5]


def test_dashboard_is_promql_over_these_metrics(families):
    dashboard = json.loads((EDGE / "grafana" / "dashboard.json").read_text())
    known = {name + ("_total" if family.type == "counter" else "") for name, family in families.items()}
    asked = set()
    for panel in dashboard["panels"]:
        for target in panel["targets"]:
            # Variables of Grafana stand where durations and patterns do.
            query = target["expr"].replace("$__rate_interval", "1m").replace("$vehicle", ".*").replace("$radar", ".*")
            promql_parser.parse(query)
            asked |= set(re.findall(r"boresight_\w+(?=\{)", query))
    assert asked <= known and len(asked) > 8, asked - known
