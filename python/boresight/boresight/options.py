"""Options by their names in Python, and their flags on the command line.

Written by `npm run generate` from the descriptions in Rust; not edited by hand.
"""

from collections.abc import Sequence
from typing import Literal, TypedDict

VERSION = "0.1.0"
"""The version of the command line that they are of."""

Kind = Literal["truth", "no", "list", "value"]
"""How a flag is given: where its option is true, where it is false, with a list, with a value."""

AzimuthSign = Literal["left", "right", "auto"]
CalibrationMethod = Literal["weighted-mean", "kabsch", "least-squares", "orthogonal-distance", "recursive"]
DriveFormat = Literal["radarscenes", "delphi", "csv", "pcd", "view-of-delft", "mcap"]
EspritForm = Literal["least-squares", "total-least-squares"]
FrameWeights = Literal["direction", "motion", "equal"]
IaaForm = Literal["auto", "fast", "dense"]
IaaPrecision = Literal["auto", "double"]
Method = Literal[
    "bartlett",
    "capon",
    "music",
    "single-snapshot-music",
    "root-music",
    "esprit",
    "min-norm",
    "coarray-music",
    "iaa",
    "nomp",
    "atomic-norm",
    "maximum-likelihood",
    "sparse-bayesian",
    "aaetr",
    "learned-pursuit",
    "dnn",
    "cnn3d",
    "unrolled-iaa",
    "covariance-cnn",
    "deep-music",
]
MotionMethod = Literal["ransac", "weighted-least-squares", "orthogonal-distance", "tracked", "deepego", "deepego-plus"]
RangeRateSign = Literal["receding", "approaching", "auto"]
Sharing = Literal["shared", "drive"]
Thresholding = Literal["none", "hard", "soft"]


class CalibrateOptions(TypedDict, total=False):
    """Options of all methods. Those a method has no use for are ignored. The car's frame is centred on the rear axle, x
    forward, y left; angles are positive to the left.
    """

    alarm_deg: float
    """The alarm is raised where the angle differs from nominal by more than this, beyond chance (1e-9 to 180 deg;
    default 1).
    """
    azimuth_bias_sigma_deg: float
    """Standard deviation of what all azimuths of the radar, and the way the car points as it goes straight, are off by,
    beyond the mounting: no drive tells it from the angle (0 to 180 deg; default 0.045).
    """
    azimuth_sigma_deg: float
    """Standard deviation of a detection's azimuth (0 to 180 deg; default 0.5)."""
    bias_sigma_degps: float
    """Standard deviation of the yaw rate's bias before anything is known of it (above 0 deg/s; default 0.1)."""
    confidence: float
    """Probability that RANSAC draws a pair of inliers at least once (0 to 1; default 0.999)."""
    converged_deg: float
    """Standard deviation below which the estimate may count as converged (1e-9 to 180 deg; default 0.1)."""
    delay_s: float
    """How long before its time stamp a scan is expected to have been measured (-1 to 1 s; default 0.04)."""
    delay_sigma_s: float
    """Its standard deviation before anything is known of it (above 0 s; default 0.03)."""
    frame_weights: FrameWeights
    """What frames weigh in the weighted mean; the other methods weigh them in their own way (default "direction")."""
    inlier_ratio_threshold: float
    """Frames with a smaller share of inliers are left out (IRT) (0 to 1; default 0.3)."""
    inlier_residual_mps: float
    """RANSAC takes a detection as an inlier where its range rate is within this of the fitted curve (above 0 m/s;
    default 0.3).
    """
    inlier_threshold: float
    """Weight from which a detection is an inlier (IT) (0 to 1; default 0.5)."""
    lasting_sigma_deg: float
    """Standard deviation of the error that the angles of all frames within five seconds and fifty metres share, before
    the drive tells it (above 0 deg; default 0.1).
    """
    max_gap_s: float
    """Largest gap in the yaw rate over which it is interpolated (above 0 s; default 0.25)."""
    max_yaw_rate_degps: float
    """Frames turning faster than this are left out (0.1 to 180 deg/s; default 140)."""
    memory_s: float
    """Time of driving after which what was seen counts for a third (recursive method) (60 to 1000000000 s; default
    3600).
    """
    method: CalibrationMethod
    """How the angle is estimated (default "recursive")."""
    min_inliers: int
    """Frames with fewer inliers are left out (3 to 1000000; default 5)."""
    min_speed_mps: float
    """Frames below this speed of the radar are left out (0 to 1000 m/s; default 1)."""
    motion: MotionMethod
    """How the motion is estimated; by default in the way that belongs to the method: RANSAC for the mean and Kabsch,
    its weighted forms for the regressions, tracking for the recursive one.
    """
    nominal_deg: float
    """The angle the radar should be mounted at, if known: where the search begins, and what the alarm compares with
    (-180 to 180 deg).
    """
    range_rate_sigma_mps: float
    """Standard deviation of a detection's range rate (above 0 m/s; default 0.1)."""
    scale_sigma: float
    """Standard deviation of the yaw rate's scale before anything is known of it (above 0; default 0.02)."""
    seed: int
    """Seed of RANSAC's draws (0 or more; default 0)."""
    slip_gradient_deg: float
    """Slip angle of the rear axle over lateral acceleration that is expected, rad/(m/s^2), outside Rust in degrees (-5
    to 5 deg; default 0.2).
    """
    slip_gradient_sigma_deg: float
    """Its standard deviation before anything is known of it (above 0 deg; default 0.15)."""
    traffic_sigma_deg: float
    """Standard deviation of what detections that move and pass for static would turn the angle by if all moved; it
    counts by the share of detections that do (0 to 180 deg; default 0.15).
    """
    x_m: float
    """The radar's place ahead of the rear axle (-100 to 100 m; default 0)."""
    y_m: float
    """The radar's place left of the centre line (-100 to 100 m; default 0)."""
    azimuth_sign: AzimuthSign
    """The side on which azimuths are positive (default "left")."""
    base_frame: str
    """Frame of the car, centred on the rear axle, in which an MCAP file states where radars sit; base_link by default.
    """
    motion_topics: Sequence[str]
    """Topics of the car's motion in an MCAP file; by default one with the speed, and one with the yaw rate alone if
    there is one.
    """
    radar_topics: Sequence[str]
    """Topics of radars in an MCAP file; by default all with detections, and those with tracks where there are no
    others.
    """
    range_rate_sign: RangeRateSign
    """When range rates are positive (default "receding")."""


CALIBRATE_OPTIONS: dict[str, tuple[str, Kind]] = {
    "alarm_deg": ("--alarm", "value"),
    "azimuth_bias_sigma_deg": ("--azimuth-bias-sigma", "value"),
    "azimuth_sigma_deg": ("--azimuth-sigma", "value"),
    "bias_sigma_degps": ("--bias-sigma", "value"),
    "confidence": ("--confidence", "value"),
    "converged_deg": ("--converged", "value"),
    "delay_s": ("--delay", "value"),
    "delay_sigma_s": ("--delay-sigma", "value"),
    "frame_weights": ("--frame-weights", "value"),
    "inlier_ratio_threshold": ("--inlier-ratio-threshold", "value"),
    "inlier_residual_mps": ("--inlier-residual", "value"),
    "inlier_threshold": ("--inlier-threshold", "value"),
    "lasting_sigma_deg": ("--lasting-sigma", "value"),
    "max_gap_s": ("--max-gap", "value"),
    "max_yaw_rate_degps": ("--max-yaw-rate", "value"),
    "memory_s": ("--memory", "value"),
    "method": ("--method", "value"),
    "min_inliers": ("--min-inliers", "value"),
    "min_speed_mps": ("--min-speed", "value"),
    "motion": ("--motion", "value"),
    "nominal_deg": ("--nominal", "value"),
    "range_rate_sigma_mps": ("--range-rate-sigma", "value"),
    "scale_sigma": ("--scale-sigma", "value"),
    "seed": ("--seed", "value"),
    "slip_gradient_deg": ("--slip-gradient", "value"),
    "slip_gradient_sigma_deg": ("--slip-gradient-sigma", "value"),
    "traffic_sigma_deg": ("--traffic-sigma", "value"),
    "x_m": ("--x", "value"),
    "y_m": ("--y", "value"),
    "azimuth_sign": ("--azimuth-sign", "value"),
    "base_frame": ("--base-frame", "value"),
    "motion_topics": ("--motion-topics", "list"),
    "radar_topics": ("--radar-topics", "list"),
    "range_rate_sign": ("--range-rate-sign", "value"),
}


class MergeOptions(TypedDict, total=False):
    """Options of what the records of a fleet come to."""

    alarm_deg: float
    """The alarm is raised where an angle differs from nominal by more than this, beyond chance (1e-9 to 180 deg;
    default 1).
    """
    drift_chance: float
    """Share of radars without a drift in which one is told (1e-9 to 0.5; default 0.001)."""
    joint_bias: Sharing
    """Bias of the yaw rate (default "drive")."""
    joint_delay: Sharing
    """Delay of the radars (default "shared")."""
    joint_drive_sigma_deg: float
    """Standard deviation, before the drives tell it, of what a radar's angle is off by in one drive and not in another:
    load, tyre pressures, weather, and how straight the car goes (above 0 deg; default 0.03).
    """
    joint_scale: Sharing
    """Scale of the yaw rate (default "shared")."""
    joint_slip: Sharing
    """Slip gradient of the rear axle (default "shared")."""
    knock_chance: float
    """Share of radars without a knock in which one is told (1e-9 to 0.5; default 0.001)."""
    least_change_deg: float
    """Knocks and drifts that change the angle by less, over all drives, are not told (0 to 180 deg; default 0.05)."""


MERGE_OPTIONS: dict[str, tuple[str, Kind]] = {
    "alarm_deg": ("--alarm", "value"),
    "drift_chance": ("--drift-chance", "value"),
    "joint_bias": ("--joint-bias", "value"),
    "joint_delay": ("--joint-delay", "value"),
    "joint_drive_sigma_deg": ("--joint-drive-sigma", "value"),
    "joint_scale": ("--joint-scale", "value"),
    "joint_slip": ("--joint-slip", "value"),
    "knock_chance": ("--knock-chance", "value"),
    "least_change_deg": ("--least-change", "value"),
}


class EstimateOptions(TypedDict, total=False):
    """Options of all estimators. Those a method has no use for are ignored."""

    confidence: float
    """Least confidence of a network's sources; that of its card if absent (0 to 1)."""
    dynamic_range_db: float
    """Peaks this far below the strongest are not reported (spectral methods) (0.1 to 300 dB; default 20)."""
    elevation_field_of_view_deg: float
    """Half width of the field of view in elevation (arrays that span an area) (0.1 to 90 deg; default 30)."""
    elevation_points: int
    """Points of the elevation grid (arrays that span an area) (3 to 1024; default 61)."""
    esprit: EspritForm
    """How ESPRIT solves for the rotation (default "total-least-squares")."""
    field_of_view_deg: float
    """Half width of the field of view in azimuth (0.1 to 90 deg; default 90)."""
    forward_backward: bool
    """Average the covariance with its reversal, which decorrelates coherent sources (evenly spaced arrays) (default
    false).
    """
    grid_points: int
    """Points of the azimuth grid, uniform in sin(azimuth) over [-1, 1) (16 to 65536; default 1024)."""
    iaa_form: IaaForm
    """Fast or dense (default "auto")."""
    iaa_iterations: int
    """Iterations (1 to 10000; default 15)."""
    iaa_precision: IaaPrecision
    """Precision of the fast form (default "auto")."""
    iaa_regularisation: float
    """Noise power added to the diagonal, as a share of the mean element power; 0 for plain IAA (0 to 1000000; default
    0).
    """
    iaa_threshold_db: float
    """Threshold below the strongest power (positive) (0 to 300 dB; default 40)."""
    iaa_thresholding: Thresholding
    """Treatment of weak powers (default "none")."""
    loading: float
    """Diagonal loading as a share of the mean element power (0 to 1000000; default 0)."""
    max_iterations: int
    """Most iterations of maximum likelihood and sparse Bayesian learning (1 to 100000; default 200)."""
    max_peaks: int
    """Most sources reported by spectral methods (1 to 1024; default 16)."""
    mismatch_db: float
    """Power of the array's unknown error over that of each source, for methods that would take it for further sources:
    NOMP, refinement, and counting. Gains and phases off by 1 dB and 10 deg are -13.6. If absent, what the array's
    calibration leaves (in the chain), or none (-100 to 0 dB).
    """
    nomp_cyclic_refinements: int
    """Rounds of Newton steps over all sources after each new one (0 to 100; default 3)."""
    nomp_false_alarm: float
    """Probability that noise alone adds a source (1e-12 to 0.5; default 0.01)."""
    nomp_max_sources: int
    """Most sources (1 to 1024; default 16)."""
    nomp_noise_power: float
    """Noise power at one element; estimated from the residual if absent (above 0)."""
    nomp_oversampling: int
    """Grid points per element of aperture (1 to 64; default 4)."""
    nomp_single_refinements: int
    """Newton steps on a new source (0 to 100; default 3)."""
    refine: bool
    """Refine the sources on the matched model: those that noise explains are dropped, what stands out of the rest is
    added, and all are taken to the best fit by Gauss-Newton steps, with the false-alarm probability and noise power
    of `nomp` (default false).
    """
    smoothing: int
    """Length of the subarrays of spatial smoothing (evenly spaced arrays); none if absent (2 to 1024)."""
    sources: int | Literal["auto", "aic", "mdl", "network"]
    """Number of sources, or how they are counted, for methods that need it (default "auto")."""
    tolerance: float
    """Change of angle (rad) or relative change of power at which iterations stop (1e-15 to 1; default 1e-8)."""


ESTIMATE_OPTIONS: dict[str, tuple[str, Kind]] = {
    "confidence": ("--confidence", "value"),
    "dynamic_range_db": ("--dynamic-range", "value"),
    "elevation_field_of_view_deg": ("--elevation-field-of-view", "value"),
    "elevation_points": ("--elevation-points", "value"),
    "esprit": ("--esprit", "value"),
    "field_of_view_deg": ("--field-of-view", "value"),
    "forward_backward": ("--forward-backward", "truth"),
    "grid_points": ("--grid-points", "value"),
    "iaa_form": ("--iaa-form", "value"),
    "iaa_iterations": ("--iaa-iterations", "value"),
    "iaa_precision": ("--iaa-precision", "value"),
    "iaa_regularisation": ("--iaa-regularisation", "value"),
    "iaa_threshold_db": ("--iaa-threshold", "value"),
    "iaa_thresholding": ("--iaa-thresholding", "value"),
    "loading": ("--loading", "value"),
    "max_iterations": ("--max-iterations", "value"),
    "max_peaks": ("--max-peaks", "value"),
    "mismatch_db": ("--mismatch", "value"),
    "nomp_cyclic_refinements": ("--nomp-cyclic-refinements", "value"),
    "nomp_false_alarm": ("--nomp-false-alarm", "value"),
    "nomp_max_sources": ("--nomp-max-sources", "value"),
    "nomp_noise_power": ("--nomp-noise-power", "value"),
    "nomp_oversampling": ("--nomp-oversampling", "value"),
    "nomp_single_refinements": ("--nomp-single-refinements", "value"),
    "refine": ("--refine", "truth"),
    "smoothing": ("--smoothing", "value"),
    "sources": ("--sources", "value"),
    "tolerance": ("--tolerance", "value"),
}
