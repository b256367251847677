"""Recordings that others' writers make: what they hold, and files of it."""

import json
import math
import struct
from io import BytesIO
from pathlib import Path
from random import Random

from mcap.writer import CompressionType
from mcap.writer import Writer as PlainWriter
from mcap_ros2.writer import Writer

LINE = "=" * 80
TIME = "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec"
HEADER = f"MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n{LINE}\n{TIME}"
VECTOR = "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z"
QUATERNION = "MSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1"


def definition(*parts):
    return f"\n{LINE}\n".join(parts)


DEFINITIONS = {
    "radar_msgs/msg/RadarScan": definition(
        "std_msgs/Header header\nradar_msgs/RadarReturn[] returns",
        HEADER,
        "MSG: radar_msgs/RadarReturn\nfloat32 range\nfloat32 azimuth  # Positive angles are anticlockwise.\n"
        "float32 elevation\nfloat32 doppler_velocity\nfloat32 amplitude",
    ),
    "sensor_msgs/msg/PointCloud2": definition(
        "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool is_bigendian\n"
        "uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense",
        HEADER,
        "MSG: sensor_msgs/PointField\nuint8 INT8=1\nuint8 FLOAT32=7\nstring name\nuint32 offset\nuint8 datatype\n"
        "uint32 count",
    ),
    "nav_msgs/msg/Odometry": definition(
        "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
        "geometry_msgs/TwistWithCovariance twist",
        HEADER,
        VECTOR,
        QUATERNION,
        "MSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z",
        "MSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation",
        "MSG: geometry_msgs/Twist\ngeometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular",
        "MSG: geometry_msgs/PoseWithCovariance\ngeometry_msgs/Pose pose\nfloat64[36] covariance",
        "MSG: geometry_msgs/TwistWithCovariance\ngeometry_msgs/Twist twist\nfloat64[36] covariance",
    ),
    "tf2_msgs/msg/TFMessage": definition(
        "geometry_msgs/TransformStamped[] transforms",
        "MSG: geometry_msgs/TransformStamped\nstd_msgs/Header header\nstring child_frame_id\n"
        "geometry_msgs/Transform transform",
        "MSG: geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation",
        HEADER,
        VECTOR,
        QUATERNION,
    ),
    "sensor_msgs/msg/Image": definition(
        "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\n"
        "uint8[] data",
        HEADER,
    ),
}

START = 1_790_000_000_123_456_789


def header(time_ns, frame):
    return {"stamp": {"sec": time_ns // 10**9, "nanosec": time_ns % 10**9}, "frame_id": frame}


def vector(x=0.0, y=0.0, z=0.0):
    return {"x": x, "y": y, "z": z}


def turn(yaw):
    return {"x": 0.0, "y": 0.0, "z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}


def scan(time_ns, k):
    returns = [
        {
            "range": 10.0 + i + k,
            "azimuth": -0.5 + 0.1 * i,
            "elevation": 0.0,
            "doppler_velocity": -8.0 + 0.37 * i,
            "amplitude": 20.0 + i,
        }
        for i in range(11)
    ]
    return {"header": header(time_ns, "radar_front"), "returns": returns}


def cloud(time_ns, k):
    points = b"".join(
        struct.pack("<ffffx", 5.0 + i, 2.0 - i, 0.5, -3.0 + 0.1 * k + (math.nan if i == 2 else 0)) for i in range(6)
    )
    fields = [
        {"name": name, "offset": 4 * i, "datatype": 7, "count": 1}
        for i, name in enumerate(["x", "y", "z", "radial_velocity"])
    ]
    return {
        "header": header(time_ns, "radar_left"),
        "height": 2,
        "width": 3,
        "fields": fields,
        "is_bigendian": False,
        "point_step": 17,
        "row_step": 51,
        "data": points,
        "is_dense": False,
    }


def odometry(time_ns, k):
    none = [0.0] * 36
    pose = {"position": vector(0.1 * k, -0.2 * k), "orientation": turn(0.01 * k)}
    twist = {"linear": vector(10.0 + 0.1 * k), "angular": vector(z=0.02 * k)}
    return {
        "header": header(time_ns, "odom"),
        "child_frame_id": "base_link",
        "pose": {"pose": pose, "covariance": none},
        "twist": {"twist": twist, "covariance": none},
    }


def transforms():
    one = {
        "header": header(START, "base_link"),
        "child_frame_id": "radar_left",
        "transform": {"translation": vector(3.5, 0.75, 0.5), "rotation": turn(0.5)},
    }
    return {"transforms": [one]}


def image(time_ns, k):
    return {
        "header": header(time_ns, "camera"),
        "height": 100,
        "width": 100,
        "encoding": "rgb8",
        "is_bigendian": 0,
        "step": 300,
        "data": Random(k).randbytes(30_000),
    }


def messages(count=20):
    """Topic, type, message and time of recording of each message."""
    yield "/tf_static", "tf2_msgs/msg/TFMessage", transforms(), START
    for k in range(count):
        time = START + k * 50_000_000
        yield "/odom", "nav_msgs/msg/Odometry", odometry(time, k), time + 1_000_000
        yield "/radar/front", "radar_msgs/msg/RadarScan", scan(time, k), time + 2_000_000
        yield "/radar/left", "sensor_msgs/msg/PointCloud2", cloud(time + 7_000_000, k), time + 9_000_000
        yield "/camera", "sensor_msgs/msg/Image", image(time, k), time


def by_mcap(path, compression, chunked=True):
    """Written by mcap-ros2-support."""
    with Path(path).open("wb") as file:
        # Without chunks the package's own writer begins a file that is not kept.
        begun = file if chunked else BytesIO()
        writer = Writer(begun, chunk_size=40_000, compression=CompressionType[compression.upper()])
        if not chunked:
            writer._writer = PlainWriter(file, use_chunking=False)
            writer._writer.start(profile="ros2", library="interop")
        schemas = {kind: writer.register_msgdef(kind, text) for kind, text in DEFINITIONS.items()}
        for topic, kind, message, time in messages():
            writer.write_message(topic, schemas[kind], message, log_time=time, publish_time=time)
        writer.finish()


def by_rosbags(folder, compression):
    """Written by rosbags in the layout of rosbag2."""
    from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    returned = DEFINITIONS["radar_msgs/msg/RadarScan"].split("MSG: radar_msgs/RadarReturn\n")[1].split(LINE)[0]
    store.register(get_types_from_msg(returned, "radar_msgs/msg/RadarReturn"))
    store.register(
        get_types_from_msg("std_msgs/Header header\nradar_msgs/RadarReturn[] returns", "radar_msgs/msg/RadarScan")
    )
    writer = Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP)
    if compression != "none":
        writer.set_compression(CompressionMode.STORAGE, CompressionFormat[compression.upper()])
    with writer:
        connections = {}
        for topic, kind, message, time in messages():
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=store)
            value = made(store, kind, message)
            writer.write(connections[topic], time, store.serialize_cdr(value, kind))


def made(store, kind, message):
    """A message of rosbags' own classes."""
    import numpy as np
    from rosbags.interfaces import Nodetype

    def value(node, given):
        of, detail = node
        if of == Nodetype.BASE:
            return given
        if of == Nodetype.NAME:
            return made(store, detail, given)
        inner = detail[0]
        if inner[0] == Nodetype.BASE and inner[1][0] != "string":
            name = {"float32": "f4", "float64": "f8", "uint8": "u1"}[inner[1][0]]
            return np.frombuffer(given, name) if isinstance(given, bytes) else np.array(given, name)
        return [value(inner, one) for one in given]

    fields = store.get_msgdef(kind).fields
    return store.types[kind](**{name: value(node, message[name]) for name, node in fields})


def plain(value):
    """A decoded message as JSON has it."""
    if isinstance(value, bytes | bytearray | memoryview):
        return list(value)
    if isinstance(value, float):
        return None if not math.isfinite(value) else value
    if isinstance(value, list | tuple):
        return [plain(one) for one in value]
    names = getattr(value, "__slots__", None)
    if names:
        return {name: plain(getattr(value, name)) for name in names if not name.startswith("_")}
    return value


def as_lines(text):
    return [json.loads(line) for line in text.splitlines()]
