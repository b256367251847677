"""How good motions and weights are, over frames whose motion is known."""

from math import log

import torch

MOVES_MPS = 3.0
"""Directions count where the radar is faster."""
FAILED_MPS, FAILED_DEG = 1.0, 5.0
"""Errors of speed or direction of a frame that has failed."""
WITHIN = {"within_68": 0.6827, "within_95": 0.9545}
IT = 0.5
"""Weight from which a detection is an inlier, as in the paper."""


def directions(velocity, truth):
    """Error of the direction of motion, deg, [frames]."""
    cross = velocity[:, 1] * truth[:, 0] - velocity[:, 0] * truth[:, 1]
    return torch.atan2(cross, (velocity * truth).sum(-1)).rad2deg()


def whitened(error, covariance):
    """Squares of errors [..., 2] over covariances given as xx, xy, yy, [...]."""
    xx, xy, yy = covariance.double().unbind(-1)
    x, y = error.double().unbind(-1)
    return (yy * x * x - 2 * xy * x * y + xx * y * y) / (xx * yy - xy * xy).clamp(min=1e-20)


def deviation_factor(squared) -> float:
    """By which deviations are multiplied for 68 and 95 % of whitened errors to be within what they should be.

    Errors have longer tails than normal ones, so that no factor has both: the mean of the two.
    """
    factors = [(squared.quantile(share) / _bound(share)).sqrt() for share in WITHIN.values()]
    return float(sum(factors) / len(factors))


def _bound(share: float) -> float:
    """Below which a share of whitened squares lies: those of two normal errors are exponential."""
    return -2 * log(1 - share)


def motion(velocity, covariance, truth) -> dict[str, float]:
    """Errors of direction and speed of frames, and how the covariance states them."""
    direction = directions(velocity, truth)
    speed = velocity.norm(dim=-1) - truth.norm(dim=-1)
    moves = truth.norm(dim=-1) > MOVES_MPS
    failed = (speed.abs() > FAILED_MPS) | (moves & (direction.abs() > FAILED_DEG))
    good = moves & ~failed
    squared = whitened(velocity - truth, covariance)[~failed]
    return {
        "failed": _mean(failed.float()),
        "direction_median_deg": _median(direction[moves].abs()),
        "direction_variance_deg2": _mean(direction[good].square()),
        "speed_median_mps": _median(speed.abs()),
        **{name: _mean((squared <= _bound(share)).float()) for name, share in WITHIN.items()},
    }


def variance_ratio(velocity, other, truth) -> float:
    """Variance of directions over that of another method's, of frames where neither has failed."""
    errors = [directions(v, truth) for v in (velocity, other)]
    good = truth.norm(dim=-1) > MOVES_MPS
    for v, error in zip((velocity, other), errors, strict=True):
        good &= ((v.norm(dim=-1) - truth.norm(dim=-1)).abs() < FAILED_MPS) & (error.abs() < FAILED_DEG)
    return _mean(errors[0][good].square()) / _mean(errors[1][good].square())


def labels(weight, mask, moving, threshold=IT) -> dict[str, float]:
    """F1 of movers, of standing things, and of both weighed alike, of detections told apart by weight."""
    said = (weight < threshold)[mask]
    true = moving[mask]
    scores = []
    for wanted in (True, False):
        hits = ((said == wanted) & (true == wanted)).sum()
        scores.append(float(2 * hits / ((said == wanted).sum() + (true == wanted).sum()).clamp(min=1)))
    return {"f1_moving": scores[0], "f1_static": scores[1], "f1": 0.5 * (scores[0] + scores[1])}


def reliability(weight, target, mask, bins=10) -> list[dict[str, float]]:
    """Of detections by weight: how many, their mean weight, and the share that are inliers."""
    weight, target = weight[mask], target[mask]
    place = (weight * bins).long().clamp(max=bins - 1)
    rows = []
    for i in range(bins):
        here = place == i
        if here.any():
            rows.append(
                {"count": int(here.sum()), "weight": _mean(weight[here]), "inliers": _mean(target[here].float())}
            )
    return rows


def _mean(values) -> float:
    return float(values.double().mean()) if len(values) else float("nan")


def _median(values) -> float:
    return float(values.median()) if len(values) else float("nan")
