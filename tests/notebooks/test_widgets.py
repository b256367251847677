"""What widgets take, refuse and send, without a browser."""

import numpy as np
import pytest
import traitlets

import boresight_widget as bw
from boresight_widget import codec
from boresight_widget.elements import ELEMENTS
from boresight_widget.names import camel, snake

CLOUD = {"range_m": [1.0, 2.0], "azimuth_deg": [0, 5]}


def sent(widget, name):
    return codec.unpack(widget.get_state(name)[name])


def test_each_element_has_a_widget_with_all_that_it_takes_and_tells():
    assert bw.__all__[1:] == sorted(ELEMENTS)
    for name, element in ELEMENTS.items():
        traits = getattr(bw, name).class_traits()
        for trait in (*element.attributes, *element.properties, *element.events.values()):
            assert traits[trait].metadata["sync"], f"{name}.{trait}"
        for one in element.properties.values():
            assert one.shape, f"the shape of {one.type} is stated"
        for one in element.attributes.values():
            assert one.type in ("string", "number", "boolean") or one.choices, one.type
        assert element.description in getattr(bw, name).__doc__


def test_options_go_as_they_are_with_the_names_of_javascript():
    given = {"min_speed_mps": np.float64(3), "cfar": {"guard_cells": [4, 2], "peak_grouping": False}, "sources": "mdl"}
    assert sent(bw.Capture(options=given), "options") == {
        "minSpeedMps": 3,
        "cfar": {"guardCells": [4, 2], "peakGrouping": False},
        "sources": "mdl",
    }
    with pytest.raises(TypeError, match=r"options\.cfar is of object"):
        bw.Capture(options={"cfar": object()})


def test_a_switch_is_true_or_false():
    assert bw.PointCloud(drag_zooms=True).get_state("drag_zooms")["drag_zooms"] is True
    with pytest.raises(traitlets.TraitError):
        bw.PointCloud(drag_zooms="yes")


def test_the_part_shown_and_words_below():
    plot = bw.Spectrum(zoom={"x": [-10, 10], "y": (-40, 0)}, remarks=["one", "two"])
    assert sent(plot, "zoom") == {"x": [-10, 10], "y": [-40, 0]}
    assert sent(plot, "remarks") == ["one", "two"]
    with pytest.raises(TypeError, match="remarks is of str"):
        bw.Spectrum(remarks="one")


def test_names_go_both_ways():
    for name in ("azimuthDeg", "xM", "rangeDopplerDb", "yawRateDegps", "method"):
        assert camel(snake(name)) == name
    assert snake("floor-db") == "floor_db"


def test_keys_are_those_of_python_or_of_javascript_and_a_table_may_be_a_data_frame():
    pandas = pytest.importorskip("pandas")
    ways = [CLOUD, {"rangeM": [1.0, 2.0], "azimuthDeg": [0, 5]}, pandas.DataFrame({**CLOUD, "name": ["a", "b"]})]
    for points in ways:
        found = sent(bw.PointCloud(points=points), "points")
        assert sorted(found) == ["azimuthDeg", "rangeM"]
        np.testing.assert_array_equal(found["rangeM"], [1, 2])


def test_tables_of_two_dimensions_are_flat_with_their_last_axis_fastest():
    frame = {"range_m": [1, 2, 3], "rate_mps": [0, 1], "range_doppler_db": np.arange(6.0).reshape(3, 2)}
    for levels in (frame["range_doppler_db"], np.arange(6.0)):
        found = sent(bw.RangeDoppler(frame={**frame, "range_doppler_db": levels}), "frame")
        np.testing.assert_array_equal(found["rangeDopplerDb"], np.arange(6))
    view = sent(bw.BirdsEye(view={"x_m": [0, 2, 4], "y_m": [0, 2], "power": np.ones((3, 2))}), "view")
    assert (view["cellM"], view["shape"]) == (2, [3, 2])


def test_sources_are_columns_or_a_list_and_may_be_missing():
    for sources in ({"azimuth_deg": np.array([1.0, 2.0])}, [{"azimuthDeg": 1}, {"azimuthDeg": 2.0, "powerDb": 3}]):
        (found,) = sent(bw.Spectrum(estimates={"sources": sources}), "estimates")
        assert found["sources"] == [{"azimuthDeg": 1}, {"azimuthDeg": 2}]
    assert sent(bw.Spectrum(estimates=[{"method": "music"}, {}]), "estimates")[0]["sources"] == []


def test_files_are_paths_pairs_or_by_name(tmp_path):
    path = tmp_path / "a.csv"
    path.write_bytes(b"ab")
    for files in (path, str(path), [path], [("a.csv", b"ab")], {"a.csv": b"ab"}):
        (found,) = sent(bw.Drive(files=files), "files")
        assert found["name"] == "a.csv" and found["bytes"].tolist() == [97, 98]


def test_the_same_object_with_other_numbers_is_sent_again():
    points = {"range_m": np.array([1.0]), "azimuth_deg": np.array([0.0])}
    cloud = bw.PointCloud(points=points)
    told = []
    cloud.observe(told.append, "points")
    points["range_m"][0] = 9
    cloud.points = points
    assert len(told) == 1 and sent(cloud, "points")["rangeM"] == [9]
    cloud.points = None
    assert cloud.get_state("points") == {"points": None}


SHORT = {"azimuth_deg": [0, 1, 2], "values_db": [0, 1]}


@pytest.mark.parametrize(
    ("name", "given", "error", "words"),
    [
        ("Spectrum", {"headin": "x"}, TypeError, "Spectrum takes no headin; it takes bounds_deg, closed, cursor_group"),
        ("Spectrum", {"theme": "blue"}, traitlets.TraitError, "'light', 'dark', 'auto'"),
        ("Spectrum", {"floor_db": "60"}, traitlets.TraitError, "a finite number"),
        ("Spectrum", {"floor_db": np.nan}, traitlets.TraitError, "a finite number"),
        ("Spectrum", {"estimates": 3}, TypeError, "estimates is of int"),
        (
            "Spectrum",
            {"estimates": {"spectrum": SHORT}},
            ValueError,
            r"estimates\[0\].spectrum.values_db has 2 numbers",
        ),
        ("Spectrum", {"truth_deg": [[1]]}, ValueError, "truth_deg has 2 dimensions"),
        ("PointCloud", {"points": {**CLOUD, "weights": [1]}}, ValueError, "points.weights has 1 length, where"),
        ("PointCloud", {"points": {**CLOUD, "weight": [1, 1]}}, ValueError, "no weights; it has weight;"),
        ("PointCloud", {"points": {"range_m": [1]}}, ValueError, "points has no azimuth_deg; it takes range_m"),
        ("PointCloud", {"points": {**CLOUD, "range_m": [1j, 2]}}, TypeError, "range_m is of complex128"),
        ("PointCloud", {"mounting": {"x_m": 1, "y_m": None, "yaw_deg": 0}}, ValueError, "mounting has no y_m"),
        ("PointCloud", {"mounting": {"x_m": "1", "y_m": 0, "yaw_deg": 0}}, TypeError, "mounting.x_m is of str"),
        (
            "RangeDoppler",
            {"frame": {"range_m": [1, 2, 3], "rate_mps": [0, 1], "range_doppler_db": np.ones((2, 3))}},
            ValueError,
            "range_doppler_db has 2 range_m, where frame.range_m has 3",
        ),
        ("Drive", {"files": b"abc"}, TypeError, "files is of bytes"),
        ("Drive", {"files": [3]}, TypeError, r"files\[0\] is of int"),
        ("Drive", {"files": "missing.csv"}, FileNotFoundError, "missing.csv"),
        ("Capture", {"frame": 1.5j}, traitlets.TraitError, "a finite number"),
    ],
)
def test_what_does_not_fit_is_refused_with_its_place(name, given, error, words):
    with pytest.raises(error, match=words):
        getattr(bw, name)(**given)


def test_what_comes_back_has_names_of_python_and_arrays_of_numpy():
    angle = bw.MountingAngle()
    told = []
    angle.observe(lambda change: told.append(change["new"]), "alarm")
    angle.set_state({"alarm": {"alarm": "pass", "angleDeg": 1.5}})
    assert told == [{"alarm": "pass", "angle_deg": 1.5}] == [angle.alarm]
    drive = bw.Drive()
    drive.set_state({"result": memoryview(codec.pack({"history": {"timeS": np.arange(3)}}))})
    np.testing.assert_array_equal(drive.result["history"]["time_s"], [0, 1, 2])
