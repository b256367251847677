"""DeepEgo+, multi frame: a recurrent network smooths the motions of successive frames of one radar.

A gated recurrent network reads the frames' motions both ways and weighs them, and a quadratic in time is fitted to them
with priors on its terms: the second-order motion model of Zhu et al. (2025). Sizes and priors are ours.
"""

from dataclasses import dataclass
from typing import NamedTuple

import torch
from torch import nn

from .deepego import DeepEgo, DeepEgoConfig, _asinh

MOTION, CYCLE_S = 9, 0.074
SCALE_MPS = 0.05
"""Of deviations from the window's mean motion."""
WEIGHT_RANGE = 4.0
"""The logarithm of a frame's weight is within plus and minus this."""
PRIORS_MPS = (1.0, 0.3, 0.3, 0.1)
"""Deviations of the linear and quadratic terms along and across the motion before learning, over half a window."""
PRIOR_RANGE = 3.0
LEAST_VARIANCE = 1e-6
"""Added to the frames' variances, (m/s)^2."""
TERMS = 3


@dataclass(frozen=True)
class DeepEgoPlusConfig:
    """Sizes."""

    single: DeepEgoConfig
    """Of the single-frame network."""
    frame: int = 24
    state: int = 48
    """Of the recurrent network, each way."""


CONFIGS = {
    "small": DeepEgoPlusConfig(DeepEgoConfig()),
    "tiny": DeepEgoPlusConfig(DeepEgoConfig(point=8, width=16, narrow=4, refine=8), frame=8, state=8),
}


class Singles(NamedTuple):
    """What the single-frame network says of windows of frames."""

    velocity: torch.Tensor
    """m/s, [windows, frames, 2]."""
    covariance: torch.Tensor
    """xx, xy, yy, (m/s)^2, [windows, frames, 3]."""
    told: torch.Tensor
    """Mean weight, logarithm of the factor and the context, [windows, frames, 2 + narrow]."""
    dt: torch.Tensor
    """Time since the frame before, 0 of the first, s, [windows, frames]."""


class Smoothed(NamedTuple):
    """Smoothed motions."""

    velocity: torch.Tensor
    """m/s, [windows, frames, 2]."""
    covariance: torch.Tensor
    """xx, xy, yy, (m/s)^2, [windows, frames, 3]."""
    weight: torch.Tensor
    """Of the frames, logarithms, [windows, frames]."""


def turned(velocity, covariance, cos, sin):
    """Vectors and covariances in axes turned to the left by an angle; all [..., 2], [..., 3], [...]."""
    x, y = velocity.unbind(-1)
    xx, xy, yy = covariance.unbind(-1)
    vector = torch.stack((x * cos + y * sin, y * cos - x * sin), -1)
    cross = (yy - xx) * sin * cos + xy * (cos * cos - sin * sin)
    both = 2 * xy * sin * cos
    along = xx * cos * cos + yy * sin * sin + both
    across = xx * sin * sin + yy * cos * cos - both
    return vector, torch.stack((along, cross, across), -1)


def solved(matrix, right):
    """Solutions of `matrix x = right` for positive definite matrices [..., n, n] (Gauss and Jordan)."""
    size = matrix.shape[-1]
    rows = torch.cat((matrix, right), -1)
    unit = torch.eye(size, dtype=matrix.dtype)
    for i in range(size):
        pivot = rows[..., i : i + 1, :] / rows[..., i : i + 1, i : i + 1]
        others = rows[..., :, i : i + 1] * (1 - unit[i].unsqueeze(-1))
        rows = rows * (1 - unit[i].unsqueeze(-1)) - others * pivot + unit[i].unsqueeze(-1) * pivot
    return rows[..., size:]


class Smoother(nn.Module):
    """Windows of single-frame motions to smoothed ones."""

    def __init__(self, config: DeepEgoPlusConfig):
        super().__init__()
        c = config
        self.encode = nn.Sequential(nn.Linear(MOTION + c.single.narrow, c.frame), nn.ReLU())
        self.recur = nn.GRU(c.frame, c.state, batch_first=True, bidirectional=True)
        self.weigh = nn.Linear(2 * c.state, 1)
        self.window = nn.Linear(2 * c.state, len(PRIORS_MPS) + 1)
        for head in (self.weigh, self.window):
            nn.init.zeros_(head.weight)
            nn.init.zeros_(head.bias)
        self.register_buffer("priors", torch.tensor(PRIORS_MPS).log(), persistent=False)

    def forward(self, singles: Singles) -> Smoothed:
        covariance = singles.covariance + LEAST_VARIANCE * torch.tensor([1.0, 0.0, 1.0])
        trust = 1 / (covariance[..., 0] + covariance[..., 2])
        mean = (trust.unsqueeze(-1) * singles.velocity).sum(1) / trust.sum(1, keepdim=True)
        speed = (mean.square().sum(-1) + 1e-6).sqrt()
        # At standstill any direction does.
        cos = torch.where(speed > 0.01, mean[:, 0] / speed, torch.ones_like(speed)).unsqueeze(1)
        sin = torch.where(speed > 0.01, mean[:, 1] / speed, torch.zeros_like(speed)).unsqueeze(1)
        velocity, covariance = turned(singles.velocity, covariance, cos, sin)
        ahead = torch.stack((mean[:, :1] * cos + mean[:, 1:] * sin, mean[:, 1:] * cos - mean[:, :1] * sin), -1)
        deviation = velocity - ahead
        xx, xy, yy = covariance.unbind(-1)
        sx, sy = xx.sqrt(), yy.sqrt()
        features = torch.cat(
            (
                _asinh(deviation / SCALE_MPS),
                torch.stack(
                    (
                        sx.log(),
                        sy.log(),
                        xy / (sx * sy),
                        singles.dt / CYCLE_S,
                        (speed / 30).unsqueeze(1).expand_as(sx),
                    ),
                    -1,
                ),
                singles.told,
            ),
            -1,
        )
        state, _ = self.recur(self.encode(features))
        log_weight = (WEIGHT_RANGE * (self.weigh(state) / WEIGHT_RANGE).tanh()).squeeze(-1)
        window = self.window(state.mean(1))
        priors, factor = window.split((len(PRIORS_MPS), 1), -1)
        sigma = (self.priors + PRIOR_RANGE * (priors / PRIOR_RANGE).tanh()).exp()
        fitted, spread = _quadratic(deviation, covariance, log_weight, singles.dt, sigma)
        spread = spread * (2 * factor.clamp(-2, 4)).exp().unsqueeze(-1)
        return Smoothed(*turned(fitted + ahead, spread, cos, -sin), log_weight)


def _quadratic(deviation, covariance, log_weight, dt, sigma):
    """Motions on the weighted quadratic in time, and their covariances."""
    deviation, covariance, log_weight, dt, sigma = (x.double() for x in (deviation, covariance, log_weight, dt, sigma))
    time = dt.cumsum(1)
    half = 0.5 * time[:, -1:].clamp(min=1e-3)
    time = time / half - 1
    basis = torch.stack((torch.ones_like(time), time, time * time), -1)
    xx, xy, yy = covariance.unbind(-1)
    scale = log_weight.exp() / (xx * yy - xy * xy).clamp(min=1e-14)
    blocks = [[yy * scale, -xy * scale], [-xy * scale, xx * scale]]
    outer = basis.unsqueeze(-1) * basis.unsqueeze(-2)
    rows = [
        torch.cat([(blocks[i][j].unsqueeze(-1).unsqueeze(-1) * outer).sum(1) for j in range(2)], -1) for i in range(2)
    ]
    normal = torch.cat(rows, -2)
    x, y = deviation.unbind(-1)
    right = torch.cat(
        [((blocks[i][0] * x + blocks[i][1] * y).unsqueeze(-1) * basis).sum(1) for i in range(2)], -1
    ).unsqueeze(-1)
    # No prior on the constant terms but what keeps the matrix regular.
    open_ = torch.full_like(sigma[:, :1], 1e3)
    deviations = torch.cat((open_, sigma[:, 0:2], open_, sigma[:, 2:4]), -1)
    normal = normal + torch.eye(2 * TERMS, dtype=normal.dtype) * deviations.pow(-2).unsqueeze(-1)
    unit = torch.eye(2 * TERMS, dtype=normal.dtype).expand_as(normal)
    answer = solved(normal, torch.cat((right, unit), -1))
    terms, inverse = answer[..., 0], answer[..., 1:]
    along, across = terms.split(TERMS, -1)
    fitted = torch.stack([(basis * part.unsqueeze(1)).sum(-1) for part in (along, across)], -1)

    def spread(i, j):
        block = inverse[:, TERMS * i : TERMS * (i + 1), TERMS * j : TERMS * (j + 1)]
        return ((basis @ block) * basis).sum(-1)

    return fitted.float(), torch.stack((spread(0, 0), spread(0, 1), spread(1, 1)), -1).float()


class DeepEgoPlus(nn.Module):
    """Windows of frames to smoothed motions, on a single-frame network that is not trained any more.

    `forward(points, mask, dt)` takes [windows, frames, points, 4], which points are there, and times [windows, frames].
    """

    def __init__(self, config: DeepEgoPlusConfig):
        super().__init__()
        self.single = DeepEgo(config.single).requires_grad_(False)
        self.smoother = Smoother(config)

    def singles(self, points, mask, dt) -> Singles:
        """The single-frame network's answers."""
        windows, frames = mask.shape[:2]
        answer = self.single(points.flatten(0, 1), mask.flatten(0, 1))
        told = torch.cat((answer.share.unsqueeze(-1), answer.factor.unsqueeze(-1), answer.context), -1)
        parts = (answer.velocity[-1], answer.covariance, told)
        return Singles(*(x.reshape(windows, frames, -1) for x in parts), dt)

    def forward(self, points, mask, dt) -> Smoothed:
        return self.smoother(self.singles(points, mask, dt))
