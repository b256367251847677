"""Writes the files of this folder, as MATLAB (save -v7.3) and h5py lay arrays out.

Run with h5py and NumPy: python make.py
"""

from pathlib import Path

import h5py
import numpy as np

HERE = Path(__file__).parent


def matlab(name, variables):
    """A file as MATLAB's: a user block of 512 bytes that says so, axes backwards, a class to each variable."""
    path = HERE / name
    with h5py.File(path, "w", userblock_size=512, libver="earliest") as file:

        def put(group, name, value, kind):
            value = np.atleast_2d(np.asarray(value))
            stored = value.T
            if np.iscomplexobj(stored):
                part = np.dtype(stored.real.dtype)
                rows = np.empty(stored.shape, dtype=[("real", part), ("imag", part)])
                rows["real"], rows["imag"] = stored.real, stored.imag
                stored = rows
            options = {"chunks": stored.shape, "compression": "gzip"} if value.size > 20 else {}
            dataset = group.create_dataset(name, data=stored, **options)
            dataset.attrs["MATLAB_class"] = np.bytes_(kind)
            return dataset

        for key, (value, kind) in variables.items():
            put(file, key, value, kind)
        struct = file.create_group("board")
        struct.attrs["MATLAB_class"] = np.bytes_("struct")
        put(struct, "gain", [[1.5, 2.5]], "double")
        nothing = put(file, "nothing", np.array([[0, 0]], dtype=np.uint64), "double")
        nothing.attrs["MATLAB_empty"] = np.uint8(1)
        refs = file.create_group("#refs#")
        put(refs, "a", [[9.0]], "double")
    head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Mon Jan  1 00:00:00 2024 HDF5 schema 1.00 ."
    with open(path, "r+b") as file:
        file.write(head.ljust(116) + b"\0" * 8 + b"\x00\x02IM")


def index(shape):
    """1000 i + 100 j + 10 k + l, of indices from 1."""
    grids = np.meshgrid(*(np.arange(1, n + 1) for n in shape), indexing="ij")
    return sum(grid * 10.0 ** (len(shape) - 1 - axis) for axis, grid in enumerate(grids))


def main():
    x = index((3, 2))
    matlab(
        "matlab.mat",
        {
            "X": (x + 1j * (x + 0.5), "double"),
            "cube": (index((2, 3, 4, 2)), "double"),
            "single": ((index((1, 2)) - 0.25j).astype(np.complex64), "single"),
            "counts": (np.array([[-3, 0, 7]], dtype=np.int16), "int16"),
            "name": (np.frombuffer("radar".encode("utf-16-le"), dtype=np.uint16), "char"),
        },
    )
    with h5py.File(HERE / "one.h5", "w") as file:
        values = (x + 1j * (x + 0.5)).astype(np.complex64)
        file.create_dataset("frames/snapshots", data=values, chunks=(2, 2), compression="gzip", shuffle=True)
        file.create_dataset("title", data="words")
    with h5py.File(HERE / "several.h5", "w") as file:
        file["big"] = x.astype(">f4")
        file["whole"] = np.array([2**63 - 1, 0], dtype=np.uint64)
        file["beyond"] = np.array([2**63], dtype=np.uint64)
        file["number"] = 4.5


if __name__ == "__main__":
    main()
