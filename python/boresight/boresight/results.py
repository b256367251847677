"""Results of the command line.

Written by `npm run generate` from the descriptions in Rust; not edited by hand.
"""

from typing import Literal, NotRequired, TypedDict

Alignment = Literal["aligned", "misaligned", "undecided"]


class CalibrationCounts(TypedDict):
    """How many frames became what; every frame given is counted once."""

    given: float
    """Frames given."""
    offSpeed: float
    """What agrees is not the car's own measured speed."""
    slow: float
    """Slower than the gate."""
    sparse: float
    """Too few detections or inliers."""
    standing: float
    """The car stood."""
    turning: float
    """Turning faster than the gate."""
    used: float
    """In the angle."""
    withoutMotion: float
    """Without a yaw rate (or speed) at their time."""


class Warning(TypedDict):
    """Something to know of a result; not an error."""

    code: str
    """A stable name for programs, in kebab case."""
    message: str
    """What a reader should know."""


class CalibrationResult(TypedDict):
    """A mounting angle and what it rests on. Standard deviations are infinite where the drive says nothing."""

    alignment: Alignment | None
    """Whether the radar is where it should be; none without a nominal angle."""
    angleDeg: float
    """Mounting angle (yaw of boresight in the car's frame), within half a turn."""
    biasDegps: float
    """Bias of the yaw rate."""
    biasSigmaDegps: float
    """Its standard deviation; infinite where nothing is known of it."""
    changedS: NotRequired[float]
    """When the angle last changed by a knock, on the clock of the frames then."""
    clockResets: float
    """Sessions started because times jumped back."""
    converged: bool
    """The angle has settled: its standard deviation is below the limit of the options and it moved by no more than that
    lately.
    """
    delayS: float
    """How long before its time stamp a scan was measured; 0 where it was not estimated."""
    delaySigmaS: float
    """Its standard deviation; 0 where it was not estimated."""
    frames: CalibrationCounts
    """What became of the frames."""
    inlierShare: float
    """Static detections over all, of the frames used; 0 without any."""
    lastFrameS: NotRequired[float]
    """Time of the last accepted frame, on the clock of the frames; absent before the first frame of a session."""
    misaligned: bool | None
    """Whether the angle differs from the nominal one beyond limit and chance; none without a nominal angle."""
    rejectedDetections: float
    """Detections left out because no sensor measures their azimuth or range rate."""
    rejectedFrames: float
    """Frames rejected for their time; they are not among those given."""
    scale: float
    """Scale factor of the yaw rate (measured over true)."""
    scaleSigma: float
    """Its standard deviation; 0 where it was not estimated."""
    sigmaDeg: float
    """Its standard deviation."""
    slipGradientDeg: float
    """Slip angle of the rear axle over lateral acceleration, rad/(m/s^2), outside Rust in degrees; 0 where it was not
    estimated.
    """
    slipGradientSigmaDeg: float
    """Its standard deviation; 0 where it was not estimated."""
    speedScale: float
    """Scale factor of the car's measured speed (measured over the radar's); 1 where it was not estimated."""
    speedScaleSigma: float
    """Its standard deviation; 0 where it was not estimated."""
    stale: bool
    """Whether the last five frames or more were rejected, so that the estimate says nothing of the present."""
    warnings: list[Warning]
    """What to know of it."""


Manoeuvre = Literal["straight", "speeds", "stop", "turns", "bends"]


class Forecast(TypedDict):
    """What a minute of a manoeuvre would bring."""

    instruction: str
    """The same in words."""
    manoeuvre: Manoeuvre
    """How to drive."""
    minutes: float | None
    """Minutes of it until the angle is settled and, where there is a nominal one, the verdict stands; none where twenty
    are too few.
    """
    sigmaDeg: float
    """Standard deviation of the angle after a minute."""


class CalibrationOutlook(TypedDict):
    """What driving on would bring. The angle is taken to stay as it is."""

    advice: str
    """What to do, in a sentence."""
    forecasts: list[Forecast]
    """Manoeuvres, the one first that brings most."""
    leastDeg: float
    """Standard deviation below which no drive brings it, at the share of static detections so far."""
    neededDeg: float
    """Standard deviation with which it is settled and the verdict stands."""
    sigmaDeg: float
    """Standard deviation of the angle now."""


class SourceDeviation(TypedDict):
    """Standard deviations of what is told of a source."""

    azimuthDeg: float
    """Of the azimuth."""
    powerDb: float
    """Of the power."""


class Source(TypedDict):
    """One source found."""

    amplitude: NotRequired[list[float]]
    """Its complex amplitude at the array's origin, where a single snapshot determines it."""
    azimuthDeg: float
    """Azimuth, counter-clockwise from boresight (positive to the left)."""
    confidence: NotRequired[float]
    """How sure a network is of it, from 0 to 1; absent from other methods."""
    deviation: NotRequired[SourceDeviation]
    """Standard deviations that a network states of its answer; absent where the method states none."""
    elevationDeg: float
    """Elevation, positive upwards."""
    powerDb: float
    """Its power at one element."""


class FleetFailureCount(TypedDict):
    """Logs that failed for one reason."""

    code: str
    """Code of the error."""
    count: float
    """How many."""
    message: str
    """The message of the first, by path."""
    path: str
    """Its path."""


class FleetLogCounts(TypedDict):
    """What became of the logs; every one is counted once."""

    done: float
    """Calibrated."""
    failed: float
    """Failed."""
    foreign: float
    """Logs with a record that are not in the plan, left out."""
    missing: float
    """Planned and without a record."""
    planned: float
    """Logs of the plan, or without a plan those with a record."""


class FleetRadar(TypedDict):
    """A radar of the fleet's vehicles."""

    centreDeg: float
    """Centre of the vehicles' angles off nominal."""
    outlying: list[str]
    """Names of the vehicles beyond it."""
    sensor: float
    """Its number."""
    spreadDeg: float
    """Their spread, beyond what their deviations have."""
    threshold: float
    """Deviations from which a vehicle is called outlying."""
    vehicles: float
    """Vehicles whose angle off nominal (or where none states a nominal one, angle) is known."""


class FleetCarValues(TypedDict):
    """Unknowns of a car beside the angles, by the joint estimate; none of those that belong elsewhere."""

    biasDegps: float | None
    """Bias of the yaw rate."""
    biasSigmaDegps: float | None
    """Its standard deviation."""
    delayS: float | None
    """How long before its time stamp a scan was measured."""
    delaySigmaS: float | None
    """Its standard deviation."""
    scale: float | None
    """Scale factor of the yaw rate (measured over true)."""
    scaleSigma: float | None
    """Its standard deviation."""
    slipGradientDeg: float | None
    """Slip angle of the rear axle over lateral acceleration, rad/(m/s^2), outside Rust in degrees."""
    slipGradientSigmaDeg: float | None
    """Its standard deviation."""


class FleetDrive(TypedDict):
    """A drive of a vehicle."""

    at: float
    """Its place in time: days since the vehicle's first drive, or drives."""
    durationS: float
    """From its first scan to its last."""
    name: str
    """Its name."""
    own: FleetCarValues
    """What this drive has of its own, by the joint estimate; what drives share is with the vehicle."""
    path: str
    """Where the log was."""
    timeS: float | None
    """When it began, s since 1970, where that is known."""


class FleetDrift(TypedDict):
    """A steady change of the angle."""

    rateDeg: float
    """Change a day, or a drive where drives have no times."""
    sigmaDeg: float
    """Its standard deviation."""


class FleetDriveAngle(TypedDict):
    """The angle by one drive."""

    angleDeg: float
    """The angle."""
    converged: bool
    """Whether it had settled."""
    drive: float
    """Which drive of the vehicle, from 0."""
    fittedDeg: float
    """The angle that the history has at this drive."""
    outlying: bool
    """Whether it is further from the history than chance has it."""
    sigmaDeg: float
    """Its standard deviation; infinite where the drive says nothing."""
    warnings: list[str]
    """Codes of its warnings."""


class FleetKnock(TypedDict):
    """A change of the angle from one drive to the next."""

    after: float
    """Place in time of the drive before, days or drives."""
    before: float
    """Place in time of that drive."""
    drive: float
    """The first drive after it, from 0."""
    sigmaDeg: float
    """Its standard deviation."""
    stepDeg: float
    """By how much the angle changed."""


FleetAngleSource = Literal["history", "joint"]


class FleetVehicleRadar(TypedDict):
    """A radar of a vehicle over its drives."""

    alignment: Alignment | None
    """Whether it is where it should be; none without a nominal angle."""
    angleDeg: float
    """The angle now: that at the last drive, after the last knock."""
    drift: FleetDrift | None
    """How the angle drifts; none where it does not by more than chance."""
    drives: list[FleetDriveAngle]
    """Each drive's own angle."""
    knocks: list[FleetKnock]
    """When the angle changed at once."""
    nominalDeg: float | None
    """The angle that it should be mounted at, as the last drive that says so does."""
    outlying: float | None
    """How far this vehicle is from the others, in deviations, where it is further than chance has it; none otherwise.
    """
    scatter: float
    """Factor on the drives' stated deviations that their scatter speaks for."""
    sensor: float
    """Its number."""
    sigmaDeg: float
    """Its standard deviation; infinite where no drive tells."""
    source: FleetAngleSource
    """Where the angle comes from."""


class FleetVehicle(TypedDict):
    """A vehicle."""

    drives: list[FleetDrive]
    """Its drives, in their order."""
    name: str
    """Its name."""
    radars: list[FleetVehicleRadar]
    """Its radars, by number."""
    shared: FleetCarValues | None
    """What its drives share beside the angles; none where no drive could tell."""
    timed: bool
    """Whether drives are placed by their times, in days; otherwise by their order, one drive apart."""


class Fleet(TypedDict):
    """A fleet's drives, put together."""

    failures: list[FleetFailureCount]
    """Why logs failed, the most frequent first."""
    logs: FleetLogCounts
    """What became of the logs."""
    radars: list[FleetRadar]
    """Radars by their number, and how the vehicles' lie about each other."""
    vehicles: list[FleetVehicle]
    """The vehicles, by name."""
