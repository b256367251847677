"""Angles of arrival in snapshots of an array."""

import json
import math
import tempfile
from pathlib import Path
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt

from .command import Place, flags, names, paths, run
from .errors import BoresightError
from .options import ESTIMATE_OPTIONS, EstimateOptions, Method
from .results import Source

NAMED = {
    f"--{name.replace('_', '-')}": name
    for name in ("array", "method", "model", "card", "counting_model", "calibration")
}


def estimate(
    snapshots: npt.ArrayLike,
    *,
    array: str | npt.ArrayLike,
    method: Method = "bartlett",
    model: Place | None = None,
    card: Place | None = None,
    counting_model: Place | None = None,
    calibration: Place | None = None,
    **options: Unpack[EstimateOptions],
) -> list[list[Source]]:
    """Sources of each scene, strongest first, by `boresight estimate`.

    Arguments:

        snapshots: Complex samples of shape (elements,), (elements, snapshots) or (scenes, elements, snapshots).
        array: The array by name, such as "ula8" or "lrr48", or where its elements are, in half wavelengths: of shape
            (elements,) along y, to the left, or (elements, 3) with x forward, y left and z up.
        method: Method of angle estimation.
        model: The ONNX file of a method that is a network.
        card: Its card; without it the .json file of its name.
        counting_model: The ONNX file of a network that counts, for `sources="network"`.
        calibration: Calibration of the array, a file of `boresight array calibrate`.
        options: Further options, by `EstimateOptions`; angles in degrees.

    Raises `BoresightError`; what is remarked of an estimate is a `BoresightWarning`.
    """
    samples = np.asarray(snapshots)
    if samples.dtype != np.complex64:
        samples = samples.astype(np.complex128)
    if samples.ndim not in (1, 2, 3):
        expected = "(elements,), (elements, snapshots) or (scenes, elements, snapshots)"
        raise BoresightError("shape", "snapshots", expected, str(samples.shape))
    arguments = ["--method", method, *flags("estimate", options, ESTIMATE_OPTIONS)]
    files = {"--model": model, "--card": card, "--counting-model": counting_model, "--calibration": calibration}
    for flag, file in files.items():
        if file is not None:
            arguments += [flag, *paths(file)]
    with tempfile.TemporaryDirectory(prefix="boresight-") as folder:
        file = Path(folder, "snapshots.npy")
        np.save(file, np.ascontiguousarray(samples), allow_pickle=False)
        if isinstance(array, str):
            arguments += ["--array", array]
        else:
            positions = Path(folder, "array.json")
            positions.write_text(json.dumps({"positions": _positions(array).tolist()}), encoding="utf-8")
            arguments += ["--array", str(positions)]
        named = names(ESTIMATE_OPTIONS) | NAMED
        rows = json.loads(run(["estimate", str(file), "--json", *arguments], named=named, stacklevel=2))
    scenes: list[list[Source]] = [[] for _ in range(samples.shape[0] if samples.ndim == 3 else 1)]
    for row in rows:
        scenes[row["scene"]].append(_source(row))
    return scenes


def _positions(array: npt.ArrayLike) -> npt.NDArray[np.float64]:
    given = np.asarray(array, dtype=np.float64)
    if given.ndim == 1:
        return np.stack([np.zeros_like(given), given, np.zeros_like(given)], axis=1)
    if given.ndim != 2 or given.shape[1] != 3:
        raise BoresightError(
            "shape", "array", "a name, or positions of shape (elements,) or (elements, 3)", str(given.shape)
        )
    return given


def _source(row: dict[str, Any]) -> Source:
    """A row of the command line's table; null is a power of zero, or what the method does not tell."""
    power = row["powerDb"]
    source: Source = {
        "azimuthDeg": row["azimuthDeg"],
        "elevationDeg": row["elevationDeg"],
        "powerDb": -math.inf if power is None else power,
    }
    if row.get("confidence") is not None:
        source["confidence"] = row["confidence"]
    if row.get("azimuthDeviationDeg") is not None:
        source["deviation"] = {"azimuthDeg": row["azimuthDeviationDeg"], "powerDb": row["powerDeviationDb"]}
    return source
