"""Weighted least squares of a radar's motion on range rates of standing things, for batches and with derivatives.

A detection at azimuth `a` of something that stands has the range rate `-(vx cos a + vy sin a)` where `(vx, vy)` is the
radar's velocity along boresight and to its left (Kellner et al. 2013).
"""

import torch

RIDGE = 1e-6
"""Added to the normal matrix' diagonal: this, and this times the sum of weights."""
LEAST_VARIANCE = 1e-5
"""Of residuals, (m/s)^2."""


def sight(points):
    """Cosine and sine of the azimuths, [..., points] each."""
    return points[..., 0].cos(), points[..., 0].sin()


def fit(cos, sin, range_rate, weight):
    """Velocity [frames, 2] and the inverse normal matrix as xx, xy, yy [frames, 3]; weights are 0 where no point is.

    Sums are in double precision, for azimuths may be close together.
    """
    cos, sin, range_rate, weight = (x.double() for x in (cos, sin, range_rate, weight))
    ridge = RIDGE * (1 + weight.sum(-1))
    xx = (weight * cos * cos).sum(-1) + ridge
    xy = (weight * cos * sin).sum(-1)
    yy = (weight * sin * sin).sum(-1) + ridge
    bx = -(weight * cos * range_rate).sum(-1)
    by = -(weight * sin * range_rate).sum(-1)
    determinant = xx * yy - xy * xy
    inverse = torch.stack((yy, -xy, xx), -1) / determinant.unsqueeze(-1)
    x = inverse[..., 0] * bx + inverse[..., 1] * by
    y = inverse[..., 1] * bx + inverse[..., 2] * by
    velocity = torch.stack((x, y), -1)
    return velocity.float(), inverse.float()


def residuals(cos, sin, range_rate, velocity):
    """Measured less expected range rates, m/s, [frames, points]."""
    return range_rate + velocity[..., :1] * cos + velocity[..., 1:] * sin


def slopes(cos, sin, velocity):
    """By how much a range rate grows with an azimuth error, m/s a rad, without sign, [frames, points]."""
    return (velocity[..., 1:] * cos - velocity[..., :1] * sin).abs()


def equation_3(residual, inlier, weight, inverse):
    """Equation 3 of Zhu et al. (2025): covariance of the motion as xx, xy, yy, (m/s)^2.

    `inlier` are weights from 0 to 1, whose sum stands for that count, and `weight` those of the fit.
    """
    freedom = (inlier.sum(-1) - 2).clamp(min=1)
    variance = (weight * residual * residual).sum(-1) / freedom
    scale = (weight.sum(-1) + 1e-3) / (inlier.sum(-1) + 1e-3)
    return inverse * (variance + LEAST_VARIANCE * scale).unsqueeze(-1)
