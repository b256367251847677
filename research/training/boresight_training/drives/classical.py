"""RANSAC and least squares on its inliers (Kellner et al. 2013): what networks are held against."""

import torch

from . import fit

INLIER_MPS = 0.3
"""Residual within which RANSAC takes a detection as an inlier, as `boresight calibrate` by default."""
DRAWS = 64
LEAST_SINE = 0.01
GATE_MPS, GATE_SHARE = 0.2, 0.02
"""How far from a measured speed a motion's may be: in itself, and by the speed."""
SPEED_SCALE, SPEED_MPS = 0.003, 0.03
"""Deviations of a measured speed: of its scale, and white."""


def ransac(points, mask, generator, draws=DRAWS, speed=None):
    """Velocity [frames, 2], inliers [frames, points] and equation 3's covariance as xx, xy, yy [frames, 3].

    With `speed` [frames], m/s, as a car measures its radar's, motions of other speeds are not taken.
    """
    cos, sin = fit.sight(points)
    rate = points[..., 1]
    count = mask.sum(-1).clamp(min=1)
    frames = len(points)
    pair = (torch.rand((2, frames, draws), generator=generator) * count.unsqueeze(-1)).long()
    (c1, c2), (s1, s2), (r1, r2) = ((x.gather(1, pair[0]), x.gather(1, pair[1])) for x in (cos, sin, rate))
    cross = c1 * s2 - c2 * s1
    usable = cross.abs() > LEAST_SINE
    cross = torch.where(usable, cross, 1.0)
    candidates = torch.stack(((s1 * r2 - s2 * r1) / cross, (c2 * r1 - c1 * r2) / cross), -1)
    if speed is not None:
        gate = GATE_MPS + GATE_SHARE * speed
        usable &= (candidates.norm(dim=-1) - speed.unsqueeze(-1)).abs() < gate.unsqueeze(-1)
    best = torch.full((frames,), -1)
    velocity = torch.zeros(frames, 2)
    for i in range(draws):
        residual = fit.residuals(cos, sin, rate, candidates[:, i]).abs()
        votes = ((residual < INLIER_MPS) & mask).sum(-1).masked_fill(~usable[:, i], -1)
        better = votes > best
        best = torch.where(better, votes, best)
        velocity = torch.where(better.unsqueeze(-1), candidates[:, i], velocity)
    for _ in range(2):
        inlier = (fit.residuals(cos, sin, rate, velocity).abs() < INLIER_MPS) & mask
        velocity, inverse = fit.fit(cos, sin, rate, inlier.float())
    residual = fit.residuals(cos, sin, rate, velocity)
    n = inlier.float()
    return velocity, inlier, fit.equation_3(residual, n, n, inverse)


def weighted(points, inlier, velocity, deviation):
    """Least squares on given inliers, weighted by the noise that labels are made with; velocity and covariance."""
    cos, sin = fit.sight(points)
    weight = inlier / deviation(points, velocity).square()
    velocity, inverse = fit.fit(cos, sin, points[..., 1], weight)
    residual = fit.residuals(cos, sin, points[..., 1], velocity)
    return velocity, fit.equation_3(residual, inlier.float(), weight, inverse)
