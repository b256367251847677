"""Small RadarScenes files in every layout that HDF5 libraries write; needs h5py and numpy.

All hold the same drive, so that a reader must give the same log for each: 3 scans of 2 sensors with
4 detections, one of them with NaN in the columns that may hold it, one with NaN in vr.
"""

import pathlib

import h5py
import numpy as np

# The newest layouts of HDF5 1.x: chunk indices that are no B-tree of version 1.
NEWEST = ("v110", "v114")
HERE = pathlib.Path(__file__).parent
NUMBERS = ["range_sc", "azimuth_sc", "rcs", "vr", "vr_compensated", "x_cc", "y_cc", "x_seq", "y_seq"]
# timestamp, sensor, range, azimuth, rcs, vr, and whether the columns beside are NaN
ROWS = [
    (156862647501, 1, 10.5, -0.25, 3.0, -2.5, False),
    (156862647501, 1, 20.5, 0.125, -7.5, -2.25, True),
    (156862667501, 2, 30.5, 0.5, 1.5, np.nan, False),
    (156862721501, 1, 40.5, 0.75, 2.5, -1.5, False),
]
ODOMETRY = [(156862647000 + 10000 * k, 0.1 * k, 0.5, 0.25, 10.0 + k, 0.5 * k) for k in range(10)]


def tables(width=32, order="<", kind="f4", stamp="i8"):
    radar = np.dtype(
        [("timestamp", order + stamp), ("sensor_id", "u1")]
        + [(name, order + kind) for name in NUMBERS]
        + [("uuid", f"S{width}"), ("track_id", f"S{width}"), ("label_id", "u1")]
    )
    rows = np.zeros(len(ROWS), radar)
    for row, (stamp_us, sensor, rng, azimuth, rcs, vr, nan) in zip(rows, ROWS, strict=True):
        row["timestamp"], row["sensor_id"], row["range_sc"], row["azimuth_sc"] = stamp_us, sensor, rng, azimuth
        row["rcs"], row["vr"], row["label_id"], row["uuid"] = rcs, vr, 11 if sensor == 1 else 0, b"ab"
        for name in ("vr_compensated", "x_seq", "y_seq"):
            row[name] = np.nan if nan else 1
    motion = np.dtype(
        [("timestamp", order + stamp)]
        + [(name, order + kind) for name in ("x_seq", "y_seq", "yaw_seq", "vx", "yaw_rate")]
    )
    return rows, np.array(ODOMETRY, motion)


def write(name, libver="earliest", options=None, **types):
    rows, motion = tables(**types)
    with h5py.File(HERE / f"{name}.h5", "w", libver=libver, track_order=False) as file:
        file.create_dataset("radar_data", data=rows, **(options or {}))
        file.create_dataset("odometry", data=motion, **(options or {}))


chunked = {"chunks": (2,)}
write("contiguous")
write("wide", width=64)
write("narrow", width=1)
write("big_endian", order=">", kind="f8")
write("chunked", options=chunked)
write("deflated", options={**chunked, "compression": "gzip"})
write("filtered", options={**chunked, "compression": "gzip", "shuffle": True, "fletcher32": True})
write("growing", options={**chunked, "maxshape": (None,), "compression": "gzip"})
write("latest_contiguous", libver=NEWEST)
write("latest_chunked", libver=NEWEST, options=chunked)
write("latest_filtered", libver=NEWEST, options={**chunked, "compression": "gzip", "shuffle": True})
write("latest_growing", libver=NEWEST, options={**chunked, "maxshape": (None,), "compression": "gzip"})
# Data layout version 5, which only HDF5 2.0 and later write.
write("hdf5_2", libver="latest", options={**chunked, "compression": "gzip"})

rows, motion = tables()
with h5py.File(HERE / "no_vr.h5", "w") as file:
    file.create_dataset("radar_data", data=rows[[n for n in rows.dtype.names if n != "vr"]])
    file.create_dataset("odometry", data=motion)
with h5py.File(HERE / "no_odometry.h5", "w") as file:
    file.create_dataset("radar_data", data=rows)
with h5py.File(HERE / "backwards.h5", "w") as file:
    file.create_dataset("radar_data", data=rows[::-1])
    file.create_dataset("odometry", data=motion)


# Files whose structure runs in circles, or claims more than it holds.
def hostile(name, fill, libver="earliest"):
    with h5py.File(HERE / f"{name}.h5", "w", libver=libver) as file:
        file.create_dataset("odometry", data=motion)
        fill(file)


def groups_in_themselves(file):
    file.create_dataset("radar_data", data=rows)
    group = file.create_group("group")
    group["itself"] = group
    file["root"] = file["/"]


def links_in_circles(file):
    file["radar_data"] = h5py.SoftLink("/a")
    file["a"] = h5py.SoftLink("/radar_data")


def rows_of_nothing(file):
    file.create_dataset("radar_data", (2**40,), rows.dtype, chunks=(2**20,), compression="gzip")


def a_chunk_of_zeros(file):
    zeros = file.create_dataset("radar_data", (4,), rows.dtype, chunks=(2**18,), maxshape=(None,), compression=9)
    zeros[:] = rows


hostile("groups_in_themselves", groups_in_themselves)
hostile("links_in_circles", links_in_circles)
hostile("latest_links_in_circles", links_in_circles, NEWEST)
hostile("rows_of_nothing", rows_of_nothing)
hostile("a_chunk_of_zeros", a_chunk_of_zeros)
