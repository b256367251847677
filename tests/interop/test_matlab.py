"""Snapshots and cubes as MATLAB saves them (-v7.3), written by h5py, estimated as the same numbers in .npy."""

import h5py
import numpy as np
import pytest
from conftest import boresight

HEAD = b"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Mon Jan  1 00:00:00 2024 HDF5 schema 1.00 ."


def save(path, **variables):
    """Axes backwards, complex numbers as real and imag, a class each, and a user block of 512 bytes."""
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, value in variables.items():
            stored = np.asarray(value).T
            part = stored.real.dtype
            rows = np.empty(stored.shape, [("real", part), ("imag", part)])
            rows["real"], rows["imag"] = stored.real, stored.imag
            chunked = {"chunks": True, "compression": "gzip"} if stored.size > 100 else {}
            dataset = file.create_dataset(name, data=rows, **chunked)
            dataset.attrs["MATLAB_class"] = np.bytes_("double" if part == "f8" else "single")
    with open(path, "r+b") as file:
        file.write(HEAD.ljust(116) + b"\0" * 8 + b"\x00\x02IM")


@pytest.fixture(scope="module")
def snapshots():
    """Two scenes of eight elements and five snapshots: one source each."""
    random = np.random.default_rng(3)
    angles = np.radians([12, -31])
    steering = np.exp(1j * np.pi * np.arange(8)[None, :] * np.sin(angles)[:, None])
    signal = np.exp(2j * np.pi * random.uniform(size=(2, 1, 5)))
    noise = random.normal(size=(2, 8, 5, 2)) @ [0.05, 0.05j]
    return steering[:, :, None] * signal + noise


@pytest.mark.parametrize("kind", ["c16", "c8"])
def test_matlab_h5py_and_npy_give_the_same_angles(snapshots, kind, tmp_path):
    data = snapshots.astype(kind)
    np.save(tmp_path / "x.npy", data)
    save(tmp_path / "x.mat", X=data)
    save(tmp_path / "several.mat", A=data[0], X=data)
    with h5py.File(tmp_path / "x.h5", "w") as file:
        file.create_dataset("run/frames", data=data, chunks=(1, 4, 5), compression="gzip")

    def estimate(name, *more):
        return boresight("estimate", tmp_path / name, "--array", "ula8", "--method", "music", "--json", *more)

    expected = estimate("x.npy")
    assert "scene" in expected
    assert estimate("x.mat") == estimate("x.h5") == expected
    assert estimate("several.mat", "--dataset", "X") == expected
    unnamed = boresight("estimate", tmp_path / "several.mat", "--array", "ula8", check=False)
    assert unnamed.returncode != 0 and "A [8, 5], X [2, 8, 5]" in unnamed.stderr


def test_a_cube_of_matlab_is_a_cube(tmp_path):
    boresight(
        "simulate",
        "cube",
        "--waveform",
        "awr1642",
        "--array",
        "awr1642",
        "--seed",
        1,
        "--target",
        "range=5,azimuth=10",
        "--out",
        tmp_path / "cube.npy",
    )
    cube = np.load(tmp_path / "cube.npy")
    save(tmp_path / "cube.mat", cube=cube)
    radar = ("--waveform", "awr1642", "--array", "awr1642", "--json")
    expected = boresight("estimate", tmp_path / "cube.npy", *radar)
    assert boresight("estimate", tmp_path / "cube.mat", *radar) == expected


def test_files_of_matlab_5_say_what_to_do(tmp_path):
    (tmp_path / "old.mat").write_bytes(b"MATLAB 5.0 MAT-file, Platform: GLNXA64".ljust(300))
    refused = boresight("estimate", tmp_path / "old.mat", "--array", "ula8", check=False)
    assert refused.returncode != 0 and "save it with '-v7.3'" in refused.stderr
