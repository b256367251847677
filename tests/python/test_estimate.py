import json
import subprocess
import warnings

import numpy as np
import pytest
from conftest import ROOT, command, simulated_response

import boresight
from boresight.binary import binary


def azimuths(scene):
    return sorted(source["azimuthDeg"] for source in scene)


@pytest.mark.parametrize("dtype", [np.complex64, np.complex128])
def test_one_source_without_noise_is_where_it_is(dtype):
    """In each of the three shapes, at one or several sources; MUSIC is exact up to rounding and its search."""
    one = simulated_response([10.0]).astype(dtype)
    for snapshots in (one[:, 0], one, one[None]):
        [scene] = boresight.estimate(snapshots, array="ula8", method="single-snapshot-music", sources=1)
        assert azimuths(scene) == pytest.approx([10.0], abs=1e-3)
        assert scene[0]["powerDb"] == pytest.approx(0.0, abs=1e-3) and scene[0]["elevationDeg"] == 0
    both = simulated_response([-20.0, 35.0]) @ np.array([[1, 1j, -1, 0.5], [1, -1, 1j, 1]])
    [scene] = boresight.estimate(both, array="ula8", method="music", sources=2)
    assert azimuths(scene) == pytest.approx([-20.0, 35.0], abs=1e-2)


def test_scenes_come_in_order_also_those_without_sources():
    scenes = np.stack([simulated_response([azimuth]) for azimuth in (-30.0, 0.0, 45.0)])
    scenes[1] = 0
    with pytest.warns(boresight.BoresightWarning, match="no source stands out"):
        found = boresight.estimate(scenes, array="ula8", method="nomp")
    assert [azimuths(scene)[:1] for scene in found] == [
        pytest.approx([-30.0], abs=0.1),
        [],
        pytest.approx([45.0], abs=0.1),
    ]
    # Whatever its order in memory.
    with pytest.warns(boresight.BoresightWarning):
        assert boresight.estimate(np.asfortranarray(scenes), array="ula8", method="nomp") == found


def test_an_array_is_a_name_or_positions():
    snapshots = simulated_response([20.0])
    by_name = boresight.estimate(snapshots, array="ula8", method="bartlett")
    assert boresight.estimate(snapshots, array=np.arange(8), method="bartlett") == by_name
    in_space = np.zeros((8, 3))
    in_space[:, 1] = np.arange(8)
    assert boresight.estimate(snapshots, array=in_space, method="bartlett") == by_name
    sparse = simulated_response([20.0], 8)[[0, 1, 4, 6]]
    [scene] = boresight.estimate(sparse, array=[0, 1, 4, 6], max_peaks=1)
    assert azimuths(scene) == pytest.approx([20.0], abs=0.2)


def test_options_and_networks_reach_the_command_line(tmp_path):
    snapshots = simulated_response([10.0])
    [many] = boresight.estimate(snapshots, array="ula8", dynamic_range_db=60)
    [few] = boresight.estimate(snapshots, array="ula8", dynamic_range_db=60, max_peaks=2)
    assert len(few) == 2 < len(many)
    file = tmp_path / "long-range.npy"
    command("simulate", "snapshots", "--array", "lrr48", "--target", "azimuth=5", "--seed", "1", "--out", file)
    model = ROOT / "models" / "learned-pursuit.onnx"
    options = {"array": "lrr48", "method": "learned-pursuit", "model": model, "field_of_view_deg": 60}
    [scene] = boresight.estimate(np.load(file), **options)
    # At 20 dB and 48 elements the bound is below 0.1 deg.
    assert scene[0]["azimuthDeg"] == pytest.approx(5.0, abs=0.5) and 0 < scene[0]["confidence"] <= 1


def test_what_is_wrong_is_told():
    snapshots = simulated_response([10.0])
    for given, code, what in (
        ({"array": "ula9"}, "shape", None),
        ({"array": "none"}, None, None),
        ({"array": np.zeros((8, 2))}, "shape", "array"),
        ({"array": "ula8", "grid_points": 3}, "option", "grid_points"),
        ({"array": "ula8", "iaa_threshold_db": -1}, "option", "iaa_threshold_db"),
        ({"array": "ula8", "method": "aaetr"}, "option", "model"),
        ({"array": "ula8", "method": "esprit", "sources": 20}, "too-many-sources", "sources"),
    ):
        with pytest.raises(boresight.BoresightError) as caught:
            boresight.estimate(snapshots, **given)
        assert code is None or caught.value.code == code, given
        assert what is None or caught.value.what == what, given
        assert caught.value.expected and caught.value.given
    with pytest.raises(boresight.BoresightError, match="snapshots"):
        boresight.estimate(np.zeros((1, 1, 8, 1), complex), array="ula8")
    with pytest.raises(boresight.BoresightError):
        boresight.estimate(np.full(8, np.nan, complex), array="ula8")
    with pytest.raises(ValueError):
        boresight.estimate(["a"] * 8, array="ula8")


def test_remarks_are_warnings_where_the_function_was_called(tmp_path):
    options = {"method": "maximum-likelihood", "max_iterations": 1, "sources": 3}
    random = np.random.default_rng(2)
    snapshots = random.normal(size=(8, 20)) + 1j * random.normal(size=(8, 20))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        boresight.estimate(snapshots, array="ula8", **options)
    # Noise holds no targets, so one remark is about the iteration and one about sources that are not significant.
    assert len(caught) == 2
    assert {(one.category, one.filename) for one in caught} == {(boresight.BoresightWarning, __file__)}
    np.save(tmp_path / "x.npy", snapshots)
    flags = ["--array", "ula8", "--method", options["method"], "--max-iterations", "1", "--sources", "3", "--json"]
    ended = subprocess.run([binary(), "estimate", str(tmp_path / "x.npy"), *flags], capture_output=True, text=True)
    assert ended.stderr == "".join(f"note: {one.message}\n" for one in caught)
    assert len(json.loads(ended.stdout)) == 3
