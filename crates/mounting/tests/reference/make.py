"""Writes reference.json: ego-motion and mounting angle worked out from their definitions.

Nothing is shared with the Rust code: normal equations by numpy.linalg, rotations by its singular value
decomposition, orthogonal distance regression by scipy.odr (ODRPACK). Run `python make.py` (NumPy 2,
SciPy 1.17) to write it again.
"""

import json
import warnings
from pathlib import Path

import numpy as np

with warnings.catch_warnings():
    warnings.simplefilter("ignore", DeprecationWarning)
    from scipy import odr

FRAMES, DETECTIONS = 40, 24
X, Y = 3.6, 0.5
ANGLE, SCALE = 0.5, 1.15
RANGE_RATE_SIGMA, AZIMUTH_SIGMA = 0.05, 0.01
BIAS_SIGMA, YAW_RATE_SIGMA, SCALE_SIGMA = np.radians(0.1), np.radians(0.1), 0.02
INLIER_RESIDUAL = 1.0


def rounded(values):
    """Single precision, as detections are."""
    return np.float32(np.round(values, 5)).astype(float)


def drive(rng):
    for index in range(FRAMES):
        time = 0.4 * index
        speed = 11.0 + 3.0 * np.sin(0.3 * time)
        rate = 0.45 * np.sin(0.9 * time)
        car = np.array([speed - rate * Y, rate * X])
        cos, sin = np.cos(ANGLE), np.sin(ANGLE)
        velocity = np.array([[cos, sin], [-sin, cos]]) @ car
        azimuth = rng.uniform(-1.0, 1.0, DETECTIONS)
        approach = velocity[0] * np.cos(azimuth) + velocity[1] * np.sin(azimuth)
        yield {
            "time_s": time,
            "speed_mps": round(speed, 4),
            "yaw_rate_radps": round(SCALE * rate + 0.002 * rng.standard_normal(), 6),
            "azimuth_rad": rounded(azimuth + AZIMUTH_SIGMA * rng.standard_normal(DETECTIONS)),
            "range_rate_mps": rounded(-approach + RANGE_RATE_SIGMA * rng.standard_normal(DETECTIONS)),
        }


def least_squares(a, b, weights):
    """Solution and inverse of the normal matrix."""
    inverse = np.linalg.inv(a.T @ (weights[:, None] * a))
    return inverse @ a.T @ (weights * b), inverse


def variances(velocity, azimuth):
    slope = velocity[1] * np.cos(azimuth) - velocity[0] * np.sin(azimuth)
    return RANGE_RATE_SIGMA**2 + slope**2 * AZIMUTH_SIGMA**2


def motions(frame):
    """Equation 3 for plain least squares; for the others the noise's, times the residuals' where larger."""
    azimuth, d = frame["azimuth_rad"], -frame["range_rate_mps"]
    a = np.column_stack([np.cos(azimuth), np.sin(azimuth)])
    freedom = DETECTIONS - 2
    plain, inverse = least_squares(a, d, np.ones(DETECTIONS))
    residual = d - a @ plain
    assert np.abs(residual).max() < INLIER_RESIDUAL
    result = {"ransac": (plain, inverse * (residual @ residual) / freedom)}
    velocity = plain
    for _ in range(100):
        weights = 1.0 / variances(velocity, azimuth)
        velocity, inverse = least_squares(a, d, weights)
    residual = d - a @ velocity
    inflation = max(1.0, (weights * residual**2).sum() / freedom)
    result["weighted-least-squares"] = (velocity, inverse * inflation)
    fit = odr.ODR(
        odr.Data(azimuth, d, wd=AZIMUTH_SIGMA**-2, we=RANGE_RATE_SIGMA**-2),
        odr.Model(lambda v, x: v[0] * np.cos(x) + v[1] * np.sin(x)),
        beta0=velocity,
        maxit=200,
        sstol=1e-15,
        partol=1e-15,
    ).run()
    result["orthogonal-distance"] = (fit.beta, fit.cov_beta * max(1.0, fit.res_var))
    return result


class Samples:
    """What equations 7 to 13 take, one entry a frame."""

    def __init__(self, frames, motion):
        v = np.array([frame["motions"][motion][0] for frame in frames])
        c = np.array([frame["motions"][motion][1] for frame in frames])
        self.v = v
        self.rate = np.array([frame["yaw_rate_radps"] for frame in frames])
        self.car_speed = np.array([frame["speed_mps"] for frame in frames])
        self.speed = np.hypot(v[:, 0], v[:, 1])
        self.beta = np.arctan2(v[:, 1], v[:, 0])
        self.trace = c[:, 0, 0] + c[:, 1, 1]
        across = np.column_stack([-v[:, 1], v[:, 0]]) / self.speed[:, None] ** 2
        along = v / self.speed[:, None]
        self.beta_variance = np.einsum("ti,tij,tj->t", across, c, across)
        self.speed_variance = np.einsum("ti,tij,tj->t", along, c, along)
        self.chi = self.rate * X / self.speed
        self.lever = X / self.speed
        self.chi_variance = (self.lever * YAW_RATE_SIGMA) ** 2 + (self.chi / self.speed) ** 2 * self.speed_variance


def weighted_mean(s):
    weights = 1.0 / s.beta_variance
    angles = np.arcsin(s.chi) - s.beta
    angle = (weights * angles).sum() / weights.sum()
    inflation = max(1.0, (weights * (angles - angle) ** 2).sum() / (FRAMES - 1))
    pull = (weights * s.lever / np.sqrt(1.0 - s.chi**2)).sum() / weights.sum()
    stretch = (weights * s.chi / np.sqrt(1.0 - s.chi**2)).sum() / weights.sum()
    variance = inflation / weights.sum() + (pull * BIAS_SIGMA) ** 2 + (stretch * SCALE_SIGMA) ** 2
    return [angle, 1.0], [[variance, 0.0], [0.0, 0.0]]


def kabsch(s):
    """Rotation from the radar's velocities to the car's; its covariance is not compared."""
    car = np.column_stack([s.car_speed - s.rate * Y, s.rate * X])
    h = (s.v / s.trace[:, None]).T @ car
    left, _, right = np.linalg.svd(h)
    rotation = right.T @ np.diag([1.0, np.linalg.det(right.T @ left.T)]) @ left.T
    return [np.arctan2(rotation[1, 0], rotation[0, 0]), 1.0], None


def regression(s):
    """Equations 11 to 13, linearised anew at each solution; the first step is the paper's own."""
    weights = 1.0 / s.trace
    scale = 1.0
    for _ in range(100):
        root = np.sqrt(1.0 - (scale * s.chi) ** 2)
        y = s.beta - np.arcsin(scale * s.chi) + scale * s.chi / root
        u = np.column_stack([-np.ones(FRAMES), s.chi / root])
        (angle, scale), inverse = least_squares(u, y, weights)
    residual = s.beta + angle - np.arcsin(scale * s.chi)
    middle = u.T @ ((weights**2 * s.beta_variance)[:, None] * u)
    inflation = max(1.0, (residual**2 / s.beta_variance).sum() / (FRAMES - 2))
    pull = inverse @ u.T @ (weights * scale * s.lever / root)
    return [angle, scale], inflation * inverse @ middle @ inverse + np.outer(pull, pull) * BIAS_SIGMA**2


def orthogonal_distance(s):
    fit = odr.ODR(
        odr.RealData(s.chi, s.beta, sx=np.sqrt(s.chi_variance), sy=np.sqrt(s.beta_variance)),
        odr.Model(lambda p, x: np.arcsin(p[1] * x) - p[0]),
        beta0=[ANGLE, 1.0],
        maxit=200,
        sstol=1e-15,
        partol=1e-15,
    ).run()
    scale = fit.beta[1]
    root = np.sqrt(1.0 - (scale * s.chi) ** 2)
    weights = 1.0 / (s.beta_variance + (scale / root) ** 2 * s.chi_variance)
    u = np.column_stack([-np.ones(FRAMES), s.chi / root])
    pull = fit.cov_beta @ u.T @ (weights * scale * s.lever / root)
    return fit.beta, fit.cov_beta * max(1.0, fit.res_var) + np.outer(pull, pull) * BIAS_SIGMA**2


def main():
    rng = np.random.default_rng(7)
    frames = list(drive(rng))
    for frame in frames:
        frame["motions"] = motions(frame)
    angles = {
        "weighted-mean": weighted_mean(Samples(frames, "ransac")),
        "kabsch": kabsch(Samples(frames, "ransac")),
        "least-squares": regression(Samples(frames, "weighted-least-squares")),
        "orthogonal-distance": orthogonal_distance(Samples(frames, "orthogonal-distance")),
    }
    written = {
        "x_m": X,
        "y_m": Y,
        "range_rate_sigma_mps": RANGE_RATE_SIGMA,
        "azimuth_sigma_rad": AZIMUTH_SIGMA,
        "inlier_residual_mps": INLIER_RESIDUAL,
        "angles": {
            name: {"solution": list(solution), "covariance": covariance}
            for name, (solution, covariance) in angles.items()
        },
        "frames": [
            {
                **frame,
                "motions": {name: {"velocity_mps": v, "covariance": c} for name, (v, c) in frame["motions"].items()},
            }
            for frame in frames
        ],
    }
    for frame in written["frames"]:
        for name in ("azimuth_rad", "range_rate_mps"):
            frame[name] = [round(x, 5) for x in frame[name]]

    def plain(x):
        return x.tolist() if isinstance(x, np.ndarray) else float(x)

    path = Path(__file__).with_name("reference.json")
    path.write_text(json.dumps(written, default=plain, separators=(",", ":")) + "\n")
    for name, (solution, covariance) in angles.items():
        print(name, solution, covariance)


if __name__ == "__main__":
    main()
