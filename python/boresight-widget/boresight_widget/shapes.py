"""What elements take, by the names that their types have in TypeScript: which numbers there are, and of what lengths.

TypeScript's types say which columns there are and not that they are of one length, which is what goes wrong in
notebooks. A shape takes a value as a user has it (keys as in Python or as in JavaScript; lists, NumPy arrays, data
frames) and gives what is sent, or raises TypeError or ValueError with the place of what is wrong.
"""

import difflib
import math
import numbers
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .codec import Records, array
from .names import camel, snake


def _said(value):
    return type(value).__name__


@dataclass(frozen=True)
class Number:
    """A number."""

    def take(self, value, where, sizes):
        if isinstance(value, bool) or not isinstance(value, numbers.Real):
            raise TypeError(f"{where} is of {_said(value)}; it takes a number")
        return float(value) if not isinstance(value, numbers.Integral) else int(value)


@dataclass(frozen=True)
class Text:
    """A string."""

    def take(self, value, where, sizes):
        if not isinstance(value, str):
            raise TypeError(f"{where} is of {_said(value)}; it takes text")
        return value


@dataclass(frozen=True)
class Array:
    """An array of numbers. Of its dimensions each is as long as all others of the same name; `name+1` is one longer."""

    dims: tuple[str, ...]
    dtype: str | None = None

    def take(self, value, where, sizes):
        given = np.asarray(value)
        if given.dtype.kind not in "biuf":
            raise TypeError(f"{where} is of {given.dtype}; it takes real numbers")
        if given.ndim != len(self.dims) and given.ndim != 1:
            raise ValueError(f"{where} has {given.ndim} dimensions; it takes {' by '.join(self.dims)}")
        if given.ndim == len(self.dims):
            lengths = given.shape
        else:
            lengths = tuple(sizes.get(dim, (1,))[0] for dim in self.dims)
            if math.prod(lengths) != given.size:
                raise ValueError(
                    f"{where} has {given.size} numbers; it takes {' by '.join(self.dims)}, {lengths[0]} by {lengths[1]}"
                )
        for dim, length in zip(self.dims, lengths, strict=True):
            name, _, more = dim.partition("+")
            count = length - int(more or 0)
            known, first = sizes.setdefault(name, (count, where))
            if count != known:
                raise ValueError(f"{where} has {length} {snake(name)}, where {first} has {known}")
        return array(given.astype(self.dtype) if self.dtype else given, where)


def column(dim="length", dtype=None):
    """An array of one dimension."""
    return Array((dim,), dtype)


@dataclass(frozen=True)
class Fields:
    """A mapping. Fields whose name ends in `?` may be left out or None; others that the value has are left out."""

    fields: Mapping
    finish: object = None

    def take(self, value, where, sizes):
        # A data frame is a mapping of columns, too.
        if not hasattr(value, "items") or not hasattr(value, "keys"):
            raise TypeError(f"{where} is of {_said(value)}; it takes a mapping with {self.spelt()}")
        given = {camel(str(key)): item for key, item in value.items()}
        known = {name.rstrip("?") for name in self.fields}
        others = [key for key in given if key not in known]
        taken = {}
        for name, shape in self.fields.items():
            key = name.rstrip("?")
            if given.get(key) is not None:
                taken[key] = shape.take(given[key], f"{where}.{snake(key)}", sizes)
                continue
            near = difflib.get_close_matches(key, others, 1, 0.75)
            if near or not name.endswith("?"):
                instead = f"; it has {snake(near[0])}" if near else ""
                raise ValueError(f"{where} has no {snake(key)}{instead}; it takes {self.spelt()}")
        return self.finish(taken) if self.finish else taken

    def spelt(self):
        return ", ".join(
            f"{snake(name.rstrip('?'))}{' (optional)' if name.endswith('?') else ''}" for name in self.fields
        )


@dataclass(frozen=True)
class Items:
    """A sequence of one shape; a mapping alone is one item."""

    shape: Fields

    def take(self, value, where, sizes):
        if hasattr(value, "keys"):
            value = [value]
        if not isinstance(value, Iterable) or isinstance(value, str | bytes):
            raise TypeError(f"{where} is of {_said(value)}; it takes a list of mappings with {self.shape.spelt()}")
        return [self.shape.take(item, f"{where}[{i}]", {}) for i, item in enumerate(value)]


@dataclass(frozen=True)
class Rows:
    """A list of mappings of numbers, or a mapping of columns."""

    names: tuple[str, ...]

    def take(self, value, where, sizes):
        fields = Fields({name: column() for name in self.names})
        if not hasattr(value, "keys"):
            each = Items(Fields({name: Number() for name in self.names})).take(value, where, sizes)
            value = {name: np.array([item[name] for item in each], dtype="f8") for name in self.names}
        return Records(fields.take(value, where, {}))


@dataclass(frozen=True)
class Texts:
    """Strings."""

    def take(self, value, where, sizes):
        if isinstance(value, str) or not isinstance(value, Iterable):
            raise TypeError(f"{where} is of {_said(value)}; it takes a list of texts")
        return [Text().take(item, f"{where}[{i}]", {}) for i, item in enumerate(value)]


@dataclass(frozen=True)
class Options:
    """Options of a function of the package, which checks them itself: mappings, lists, texts, numbers and switches."""

    def take(self, value, where, sizes):
        if hasattr(value, "items"):
            return {camel(str(key)): self.take(item, f"{where}.{key}", {}) for key, item in value.items()}
        if isinstance(value, list | tuple):
            return [self.take(item, f"{where}[{i}]", {}) for i, item in enumerate(value)]
        if value is None or isinstance(value, bool | str):
            return value
        return Number().take(value, where, {})


@dataclass(frozen=True)
class Plain:
    """An array of one dimension that is sent as a list: a few numbers."""

    def take(self, value, where, sizes):
        return [float(number) for number in column(dtype="f8").take(value, where, {})]


@dataclass(frozen=True)
class Files:
    """Files: paths, pairs of name and bytes, or a mapping of bytes by name."""

    def take(self, value, where, sizes):
        if isinstance(value, str | os.PathLike):
            value = [value]
        if isinstance(value, Mapping):
            value = list(value.items())
        if not isinstance(value, Iterable) or isinstance(value, bytes | bytearray | memoryview):
            raise TypeError(f"{where} is of {_said(value)}; it takes paths, or bytes with their names")
        return [self._file(item, f"{where}[{i}]") for i, item in enumerate(value)]

    def _file(self, item, where):
        if isinstance(item, str | os.PathLike):
            path = Path(item)
            return {"name": path.name, "bytes": path.read_bytes()}
        if isinstance(item, tuple) and len(item) == 2:
            name, data = item
            if isinstance(name, str) and isinstance(data, bytes | bytearray | memoryview):
                return {"name": name, "bytes": bytes(data)}
        raise TypeError(f"{where} is of {_said(item)}; it takes a path, or a pair of name and bytes")


def _bird(taken):
    x = taken["xM"]
    cell = float(x[1] - x[0]) if x.size > 1 else 1.0
    return {"cellM": cell, **taken, "shape": [x.size, taken["yM"].size]}


def _estimate(taken):
    return {"method": "spectrum", "sources": [], **taken}


def _spectrum(taken):
    return {"elevationDeg": np.zeros(1), **taken}


WEIGHED = {"weights?": column(dtype="f4"), "moving?": column(dtype="u1")}
MOTION = Fields({"vxMps": Number(), "vyMps": Number()})

INTERVALS = {"x": Plain(), "y": Plain()}
GROUND = {"xM": Plain(), "yM": Plain()}

#: Types that hold functions, ports or signs of the browser's, which no notebook sends.
IN_JAVASCRIPT = (
    "(() => readonly string[])",
    "AsyncIterable<Uint8Array>",
    "BoardPort",
    "((xM: number, yM: number) => string)",
    "Layer[]",
    "LegendItem[]",
    "MotionCurve[]",
)

#: By the types of the elements' properties, without `readonly` and `| null`.
SHAPES = {
    "(Estimate | NamedEstimate)[]": Items(
        Fields(
            {
                "method?": Text(),
                "sources?": Rows(("azimuthDeg",)),
                "spectrum?": Fields(
                    {
                        "azimuthDeg": column("azimuth_deg", "f8"),
                        "elevationDeg?": column("elevation_deg", "f8"),
                        "valuesDb": Array(("elevation_deg", "azimuth_deg"), "f8"),
                    },
                    _spectrum,
                ),
            },
            _estimate,
        )
    ),
    "number": Number(),
    "string": Text(),
    "number[]": Plain(),
    "ArrayLike<number>": Plain(),
    "string[]": Texts(),
    "View": Fields(INTERVALS),
    "Ground": Fields(GROUND),
    "ShownTarget[]": Items(Fields({"azimuthDeg": Number(), "powerDb": Number()})),
    "{ azimuthDeg: number; label: string }[]": Items(Fields({"azimuthDeg": Number(), "label": Text()})),
    "RadarName[]": Items(Fields({"name": Text(), "title?": Text()})),
    "Cell": Fields({"rangeBin": Number(), "dopplerBin": Number(), "frame?": Number()}),
    "ChainOptions": Options(),
    "CalibrateDriveOptions": Options(),
    "RangeDopplerFrame": Fields(
        {
            "rangeM": column("range_m"),
            "rateMps": column("rate_mps"),
            "rangeDopplerDb": Array(("range_m", "rate_mps")),
            "detections?": Rows(("rangeM", "rateMps")),
        }
    ),
    "PointCloud": Fields(
        {
            "rangeM": column(),
            "azimuthDeg": column(),
            "elevationDeg?": column(),
            "rangeRateMps?": column(),
            "rcsDbsm?": column(),
            **WEIGHED,
        },
    ),
    "Place": Fields({"xM": Number(), "yM": Number(), "yawDeg": Number()}),
    "BirdsEyeView": Fields(
        {
            "xM": column("x_m", "f8"),
            "yM": column("y_m", "f8"),
            "power": Array(("x_m", "y_m"), "f4"),
            "cellM?": Number(),
        },
        _bird,
    ),
    "DopplerFrame": Fields({"azimuthDeg": column(), "rangeRateMps": column(), **WEIGHED, "motion?": MOTION}),
    "AngleOverTime": Fields(
        {"timeS": column(dtype="f8"), "angleDeg": column(dtype="f8"), "sigmaDeg": column(dtype="f8")}
    ),
    "NamedBytes[]": Files(),
    "Drive": Fields(
        {
            "sensors": Items(Fields({"id": Number(), "xM?": Number(), "yM?": Number(), "yawDeg?": Number()})),
            "scans": Fields(
                {
                    "timeS": column("scans", "f8"),
                    "sensor": column("scans", "u1"),
                    "offsets": column("scans+1", "u4"),
                }
            ),
            "detections": Fields(
                {
                    "azimuthDeg": column("detections", "f8"),
                    "rangeRateMps": column("detections", "f4"),
                    "rangeM?": column("detections", "f4"),
                    "rcsDbsm?": column("detections", "f4"),
                    "label?": column("detections", "u1"),
                }
            ),
            "motion": Fields(
                {
                    "timeS": column("samples", "f8"),
                    "yawRateDegps": column("samples", "f8"),
                    "speedMps?": column("samples", "f8"),
                    "pose?": Fields(
                        {
                            "xM": column("samples", "f8"),
                            "yM": column("samples", "f8"),
                            "yawDeg": column("samples", "f8"),
                        }
                    ),
                }
            ),
        }
    ),
}
