import json
import math
import typing

import pytest
from conftest import DELPHI, command, simulate

import boresight
from boresight import command as command_module
from boresight.calibration import TrajectoryError
from boresight.options import CALIBRATE_OPTIONS, ESTIMATE_OPTIONS, MERGE_OPTIONS
from boresight.results import CalibrationOutlook, CalibrationResult


def test_calibrate_returns_what_the_command_prints():
    """The same numbers, and the fields that the types state."""
    [radar] = boresight.calibrate(DELPHI, min_speed_mps=3, method="recursive")
    assert radar == json.loads(command("calibrate", DELPHI, "--json", "--min-speed", "3"))
    # As recordings/delphi/README.md has it: the set's own extrinsics give -1.96 deg; 0.3 deg is three deviations.
    assert abs(radar["angleDeg"] + 1.96) < 0.3
    [other] = boresight.calibrate([DELPHI / "front_radar.csv.gz", DELPHI / "pose_10hz.csv.gz"])
    assert other["frames"]["slow"] < radar["frames"]["slow"]


def test_results_have_the_fields_of_their_types():
    [radar] = boresight.calibrate(DELPHI)
    may_be_absent = {"changedS"}
    assert set(radar) | may_be_absent == set(boresight.Calibration.__annotations__) | may_be_absent
    assert set(CalibrationResult.__annotations__) < set(radar) | may_be_absent
    assert set(radar["outlook"]) == set(CalibrationOutlook.__annotations__)
    assert set(radar["trajectoryError"]) == set(TrajectoryError.__annotations__)


def test_several_radars_come_in_order_one_alone_and_together(tmp_path):
    log = simulate(tmp_path / "log", 5, "--sensor", "3")
    both = boresight.calibrate(log)
    assert [radar["sensor"] for radar in both] == [1, 3]
    assert boresight.calibrate(log, sensor=3) == [both[1]]
    assert not both[0]["joint"]
    joint = boresight.calibrate(log, joint=True)
    assert [radar["joint"] for radar in joint] == [True, True]
    assert joint[0]["scale"] == joint[1]["scale"] and both[0]["scale"] != both[1]["scale"]


def test_a_number_that_is_not_finite_is_none_no_more():
    """Null in the place of a standard deviation that is infinite; a number that may be absent stays None."""
    given = {"angleDeg": 1.0, "sigmaDeg": None, "scale": None, "alignment": None, "frames": {"given": 3}, "extra": None}
    found = command_module.finite_again(given, boresight.Calibration)
    assert found["sigmaDeg"] == math.inf and math.isnan(found["scale"])
    assert found["alignment"] is None and found["frames"] == {"given": 3} and found["extra"] is None
    outlook = {"outlook": {"forecasts": [{"sigmaDeg": None, "minutes": None}]}, "nominalDeg": None}
    found = command_module.finite_again(outlook, boresight.Calibration)
    assert found["outlook"]["forecasts"] == [{"sigmaDeg": math.inf, "minutes": None}]
    assert found["nominalDeg"] is None


def example(hint):
    """A value of an option's type that is legal for most, and the same as text."""
    if hint is bool:
        return True
    if typing.get_origin(hint) is typing.Literal:
        return typing.get_args(hint)[-1]
    if hint is str or (typing.get_origin(hint) is not None and hint not in (int, float)):
        arguments = typing.get_args(hint)
        return 3 if int in arguments else ["a", "b"] if arguments == (str,) else "a"
    return 7 if hint is int else 0.5


@pytest.mark.parametrize(
    ("name", "known"),
    [("calibrate", CALIBRATE_OPTIONS), ("estimate", ESTIMATE_OPTIONS), ("fleet merge", MERGE_OPTIONS)],
)
def test_every_option_has_a_flag_that_the_command_line_knows(name, known):
    """Each by itself: a wrong value may be refused, an unknown flag not."""
    types = getattr(boresight.options, f"{name.split()[-1].capitalize()}Options")
    hints = typing.get_type_hints(types)
    assert set(hints) == set(known)
    flags = command(*name.split(), "--help").split()
    for option, hint in hints.items():
        given = command_module.flags(name, {option: example(hint)}, known)
        assert given[0] in flags, option
        assert len(given) == (1 if hint is bool else 2), option


def test_values_become_text():
    def flags(known, **given):
        return command_module.flags("f", given, known)

    known = {"a": ("--a", "truth"), "b": ("--no-b", "no"), "c": ("--c", "list"), "d": ("--d", "value")}
    assert flags(known, a=False, b=True, c=[], d=None) == []
    assert flags(known, a=True, b=False, c=("x", "y"), d=1e-08) == ["--a", "--no-b", "--c", "x,y", "--d", "1e-08"]
    with pytest.raises(TypeError, match="takes True or False for 'a'"):
        flags(known, a="no")
    with pytest.raises(TypeError, match="unexpected keyword argument 'min_sped_mps'"):
        boresight.calibrate(DELPHI, min_sped_mps=3)
