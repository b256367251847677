"""Where refinements start: the motion that most weight agrees on, of those that pairs of detections tell.

A fit that trusts every weight a little is pulled far off by what moves, and refinements then start from a motion that
nothing agrees with. Pairs are drawn by weight, as in guided sampling (Brachmann and Rother 2019, Neural-guided RANSAC),
from a sequence that fills the square evenly (Roberts 2018, R2), so that the same frame has the same pairs.
"""

import torch

from . import fit

DRAWS = 48
CONSENSUS_MPS = 0.3
"""Residual from which a detection does not agree with a motion."""
LEAST_SINE = 0.01
"""Of the angle between two lines of sight that tell a motion."""
TIE_BREAK = 1e-12
"""Of range rates, m/s, which order detections of the same azimuth, rad."""
STEPS = (0.7548776662466927, 0.5698402909980532)
"""Of the sequence along each axis: 1/p and 1/p^2, with p the real root of p^3 = p + 1."""


def start(points, cos, sin, rate, weight, mask, first):
    """Velocity that the most weight agrees on, fitted to what agrees, [frames, 2].

    `first` [frames, 2] is taken where no pair has more. Neither order nor padding of the detections matters.
    """
    with torch.no_grad():
        candidates, usable = _pairs(points, cos, sin, rate, weight, mask)
        candidates = torch.cat((first.unsqueeze(1), candidates), 1)
        usable = torch.cat((torch.ones_like(usable[:, :1]), usable), 1)
        votes = (weight.unsqueeze(1) * _agreement(cos, sin, rate, candidates)).sum(-1)
        best = votes.masked_fill(~usable, -1.0).argmax(1)
        velocity = candidates.gather(1, best.view(-1, 1, 1).expand(-1, 1, 2))
        agreement = _agreement(cos, sin, rate, velocity).squeeze(1)
    return fit.fit(cos, sin, rate, weight * agreement)[0]


def _agreement(cos, sin, rate, velocity):
    """From 1 for no residual to 0 for `CONSENSUS_MPS` and more, [frames, motions, points]."""
    x, y = velocity[..., :1], velocity[..., 1:]
    residual = rate.unsqueeze(1) + x * cos.unsqueeze(1) + y * sin.unsqueeze(1)
    return (1 - (residual / CONSENSUS_MPS).square()).clamp(min=0)


def _pairs(points, cos, sin, rate, weight, mask):
    """Motions by pairs, [frames, draws, 2], and whether pairs tell them."""
    place = points[..., 0].double() + TIE_BREAK * rate.double()
    order = place.masked_fill(~mask, torch.inf).sort(-1).indices
    filled = weight.gather(1, order).double().cumsum(-1)
    last = (mask.sum(-1, keepdim=True) - 1).clamp(min=0)
    n = torch.arange(1, DRAWS + 1, dtype=torch.float64)
    ends = []
    for step in STEPS:
        level = (0.5 + n * step) % 1.0 * filled[:, -1:]
        rank = (filled.unsqueeze(1) <= level.unsqueeze(-1)).sum(-1)
        place = order.gather(1, torch.minimum(rank, last))
        ends.append([x.gather(1, place) for x in (cos, sin, rate)])
    (c1, s1, r1), (c2, s2, r2) = ends
    cross = c1 * s2 - c2 * s1
    usable = cross.abs() > LEAST_SINE
    cross = torch.where(usable, cross, 1.0)
    return torch.stack(((s1 * r2 - s2 * r1) / cross, (c2 * r1 - c1 * r2) / cross), -1), usable
