"""Values with arrays as bytes, and back; web/notebook/codec.ts is the other end and says what the bytes are."""

import json
import math
import numbers
from collections.abc import Mapping

import numpy as np

KINDS = {name: np.dtype(f"<{name}") for name in ("i1", "u1", "i2", "u2", "i4", "u4", "f4", "f8")}

# Beyond it a double does not hold every integer.
SAFE = 2**53


class Records(dict):
    """Columns of one length that become a list of objects on the other side."""


def _padded(length):
    return -(-length // 8) * 8


def array(value, where="an array"):
    """An array as one of `KINDS`, flat, the last axis fastest.

    Truth values become bytes, half floats single ones, and complex numbers pairs of real and imaginary part. Integers
    of 64 bits become those of 32 where they fit, and doubles otherwise. Raises TypeError for what is no number,
    ValueError for integers that no double holds.
    """
    given = np.asarray(value)
    if given.dtype.kind not in "biufc":
        raise TypeError(f"{where} is of {given.dtype}; it takes numbers")
    if given.dtype.kind == "b":
        given = given.astype("u1")
    elif given.dtype.kind == "c":
        given = np.ascontiguousarray(given)
        given = given.view(given.real.dtype)
    elif given.dtype.kind in "iu" and given.dtype.itemsize == 8:
        least, most = (given.min(), given.max()) if given.size else (0, 0)
        if least >= -(2**31) and most < 2**31:
            given = given.astype("i4")
        elif max(-int(least), int(most)) > SAFE:
            raise ValueError(f"{where} has integers beyond 2^53, which JavaScript's numbers do not hold")
        else:
            given = given.astype("f8")
    if given.dtype.kind == "f" and given.dtype.itemsize != 4:
        given = given.astype("f4" if given.dtype.itemsize == 2 else "f8")
    return np.ascontiguousarray(given, dtype=given.dtype.newbyteorder("<")).reshape(-1)


def pack(value):
    """The bytes of a value of None, bool, numbers, str, bytes, arrays, mappings with str for keys, and sequences."""
    places, pieces, size = [], [], 0

    def put(numbers_):
        nonlocal size
        places.append([numbers_.dtype.str[1:], size, numbers_.size])
        pieces.append(numbers_.tobytes())
        pieces.append(bytes(_padded(numbers_.nbytes) - numbers_.nbytes))
        size += _padded(numbers_.nbytes)
        return {"$array": len(places) - 1}

    def plain(value):
        if value is None or isinstance(value, bool | str):
            return value
        if isinstance(value, np.bool_):
            return bool(value)
        if isinstance(value, numbers.Integral):
            return int(value)
        if isinstance(value, numbers.Real):
            value = float(value)
            return value if math.isfinite(value) else {"$number": json.dumps(value)}
        if isinstance(value, numbers.Complex):
            return [plain(value.real), plain(value.imag)]
        if isinstance(value, bytes | bytearray | memoryview):
            return put(np.frombuffer(value, dtype="u1"))
        if isinstance(value, Records):
            return {"$records": {key: plain(column) for key, column in value.items()}}
        if isinstance(value, Mapping):
            for key in value:
                if not isinstance(key, str) or key.startswith("$"):
                    raise TypeError(f"{key!r} is no key that can be sent: it takes text that does not begin with $")
            return {key: plain(item) for key, item in value.items()}
        if isinstance(value, list | tuple):
            return [plain(item) for item in value]
        if hasattr(value, "__array__"):
            return put(array(value))
        raise TypeError(f"{type(value).__name__} cannot be sent")

    header = json.dumps({"value": plain(value), "arrays": places}, allow_nan=False, separators=(",", ":")).encode()
    start = len(header).to_bytes(4, "little") + header
    return b"".join([start, bytes(_padded(len(start)) - len(start)), *pieces])


def unpack(data):
    """The value of bytes; arrays are NumPy's, of one dimension."""
    data = memoryview(data).cast("B")
    length = int.from_bytes(data[:4], "little")
    header = json.loads(bytes(data[4 : 4 + length]))
    body = data[_padded(4 + length) :]
    arrays = [
        np.frombuffer(body, dtype=KINDS[kind], count=count, offset=start).copy()
        for kind, start, count in header["arrays"]
    ]

    def restored(value):
        if isinstance(value, list):
            return [restored(item) for item in value]
        if not isinstance(value, dict):
            return value
        if "$array" in value:
            return arrays[value["$array"]]
        if "$number" in value:
            return float(value["$number"])
        if "$records" in value:
            columns = {key: np.asarray(restored(column)).tolist() for key, column in value["$records"].items()}
            return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
        return {key: restored(item) for key, item in value.items()}

    return restored(header["value"])
