"""Mounting angles of the radars of one drive."""

import json
from collections.abc import Sequence
from typing import TypedDict, Unpack, cast

from .command import Place, finite_again, flags, names, paths, run
from .options import CALIBRATE_OPTIONS, CalibrateOptions, CalibrationMethod, DriveFormat, MotionMethod
from .results import CalibrationOutlook, CalibrationResult


class TrajectoryError(TypedDict):
    """How far trajectories by the radar are off those of the log, on average."""

    segmentM: float
    """Length of the pieces that are compared."""
    estimatedM: float
    """Error at their ends by the angle found."""
    nominalM: float | None
    """The same by the nominal angle, where there is one."""


class Calibration(CalibrationResult):
    """The mounting angle of one radar, and what it rests on."""

    sensor: int
    """The radar's number in the log."""
    joint: bool
    """Whether all radars of the log were estimated together."""
    method: CalibrationMethod
    """How the angle was estimated."""
    motion: MotionMethod
    """How the motion was estimated."""
    nominalDeg: float | None
    """The angle the radar should be mounted at."""
    covariance: list[list[float]]
    """Covariance of the angle, rad, and the scale of the yaw rate."""
    trajectoryError: TrajectoryError | None
    """How far trajectories are off; None where the log has no poses."""
    outlook: CalibrationOutlook | None
    """What driving on would bring; None of methods that do not tell."""


def calibrate(
    path: Place | Sequence[Place],
    *,
    sensor: int | None = None,
    joint: bool = False,
    sequence: str | None = None,
    format: DriveFormat | None = None,
    network: Place | None = None,
    **options: Unpack[CalibrateOptions],
) -> list[Calibration]:
    """The angle at which each radar of a drive log is mounted, by `boresight calibrate`.

    Arguments:

        path: The log: its folder, its one file, or its files.
        sensor: Only this radar.
        joint: All radars together, with one scale and bias of the yaw rate.
        sequence: Which sequence of a data set's folder.
        format: Format of the log, where it is not to be found from the files.
        network: Weights of the network of motion, for the motions "deepego" and "deepego-plus".
        options: How it is calibrated and read, by `CalibrateOptions`; angles in degrees, all else in SI units.

    A radar each in the order of the log. Raises `BoresightError`; what is remarked of the log is a `BoresightWarning`.
    """
    arguments = ["calibrate", "--json", *paths(path), *flags("calibrate", options, CALIBRATE_OPTIONS)]
    if sensor is not None:
        arguments += ["--sensor", str(sensor)]
    if joint:
        arguments.append("--joint")
    if sequence is not None:
        arguments += ["--sequence", sequence]
    if format is not None:
        arguments += ["--format", format]
    if network is not None:
        arguments += ["--network", *paths(network)]
    found = json.loads(run(arguments, named=names(CALIBRATE_OPTIONS) | NAMED, stacklevel=2))
    radars = found if isinstance(found, list) else [found]
    return [cast(Calibration, finite_again(radar, Calibration)) for radar in radars]


NAMED = {f"--{name}": name for name in ("sensor", "joint", "sequence", "format", "network")}
"""Arguments of the function itself, by their flags."""
