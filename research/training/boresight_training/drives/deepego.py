"""DeepEgo, single frame: a network weighs detections, and weighted least squares gives the radar's motion.

Detections are encoded one by one and pooled, so that their order and number do not matter. From the motion that most of
the weight agrees on, weights are refined from the residuals of the fit, by the same layers each time. After Zhu,
Yarovoy and Fioranelli (2023) and Zhu et al. (2025); sizes and features are ours.
"""

from dataclasses import dataclass

import torch
from torch import nn

from . import fit, hypotheses

FEATURES, OWN, SAID = 9, 4, 3
"""Numbers of a detection, of its residual, and of what is said of it: weight, precision, whether it moves."""
RESIDUAL_MPS = 0.05
AZIMUTH_RAD = 0.005
"""Scales of residuals: of range rates, and of what an azimuth error makes of the slope."""
LEAST_SLOPE = 0.05
"""Of the scale of range rates, where the slope is smaller."""
PRECISION_RANGE = 3.0
"""The logarithm of a point's precision is within plus and minus this."""
TEMPER = 0.7
"""What the logarithm of a precision counts once trained: real errors depend less on places than simulated ones.

Chosen on frames of a second noise model (Laplace azimuths), where it is the best of 0, 0.3, 0.5, 0.7 and 1 up to 30 %
moving; it costs a twentieth of the variance on frames as those of training.
"""
REFINEMENTS = 2
"""Once trained: the third that training has brings nothing more to frames as those of training."""
FACTOR_RANGE = (-2.0, 4.0)
"""Of the logarithm of the factor on deviations."""


@dataclass(frozen=True)
class DeepEgoConfig:
    """Sizes."""

    point: int = 32
    width: int = 64
    narrow: int = 16
    """Of what the refinements see of a point's and a frame's features."""
    refine: int = 32
    refinements: int = 3
    """In training."""


CONFIGS = {"small": DeepEgoConfig(), "tiny": DeepEgoConfig(point=8, width=16, narrow=4, refine=8)}


@dataclass
class Answer:
    """What the network says of frames."""

    velocity: torch.Tensor
    """After each fit, m/s along boresight and to its left, [fits, frames, 2]."""
    logit: torch.Tensor
    """Of each detection's weight from 0 to 1, before each fit, [fits, frames, points]."""
    moves: torch.Tensor
    """The same of whether it is of something that moves."""
    covariance: torch.Tensor
    """Of the last velocity as xx, xy, yy, (m/s)^2, [frames, 3]."""
    context: torch.Tensor
    """What smoothing sees of a frame, [frames, narrow]."""
    share: torch.Tensor
    """Sum of the weights over the number of detections, [frames]."""
    factor: torch.Tensor
    """Logarithm of the factor on equation 3's deviations, [frames]."""


def scale(range_rate, mask):
    """S: the 90 % quantile of range rates without sign, by nearest rank, or 1 m/s where that is less, [frames]."""
    speed = range_rate.abs().masked_fill(~mask, torch.inf).sort(-1).values
    count = mask.sum(-1, keepdim=True)
    rank = ((9 * count + 9) // 10 - 1).clamp(min=0)
    chosen = speed.gather(-1, rank).squeeze(-1)
    return torch.where(count.squeeze(-1) > 0, chosen, torch.zeros_like(chosen)).clamp(min=1.0)


def features(points, mask, size):
    """Nine numbers a detection; range and cross-section that are not numbers are missing."""
    azimuth, rate, distance, rcs = points.unbind(-1)
    has_range, has_rcs = ~distance.isnan(), ~rcs.isnan()
    size = size.unsqueeze(-1)
    rate = rate / size
    found = torch.stack(
        (
            azimuth.sin(),
            azimuth.cos(),
            rate,
            rate.abs(),
            distance.nan_to_num(0.0).clamp(min=0.0).log1p() / 5,
            rcs.nan_to_num(0.0) / 20,
            has_range.float(),
            has_rcs.float(),
            (size / 30).expand_as(rate),
        ),
        -1,
    )
    return found * mask.unsqueeze(-1)


def _asinh(x):
    """The inverse hyperbolic sine, of operators that ONNX has."""
    size = x.abs()
    return x.sign() * (size + size * size / (1 + (1 + size * size).sqrt())).log1p()


class DeepEgo(nn.Module):
    """Frames to motion. `forward(points, mask)` takes [frames, points, 4] and which points are there."""

    def __init__(self, config: DeepEgoConfig):
        super().__init__()
        self.config = c = config
        self.encode = nn.Sequential(nn.Linear(FEATURES, c.point), nn.ReLU(), nn.Linear(c.point, c.width), nn.ReLU())
        self.pool = nn.Sequential(nn.Linear(2 * c.width, c.width), nn.ReLU())
        # One layer on what belongs to the point and to the frame, in two parts, as the frame's is the same for all.
        self.weigh_point = nn.Linear(c.width, c.width)
        self.weigh_frame = nn.Linear(c.width, c.width, bias=False)
        self.weigh = nn.Sequential(
            nn.ReLU(), nn.Linear(c.width, c.width // 2), nn.ReLU(), nn.Linear(c.width // 2, SAID)
        )
        self.narrow_point = nn.Linear(c.width, c.narrow)
        self.narrow_frame = nn.Linear(c.width, c.narrow)
        self.refine_point = nn.Linear(OWN + c.narrow, c.refine)
        self.refine_frame = nn.Linear(c.narrow, c.refine, bias=False)
        self.refine = nn.Sequential(nn.ReLU(), nn.Linear(c.refine, c.refine), nn.ReLU(), nn.Linear(c.refine, SAID))
        self.spread = nn.Sequential(nn.Linear(c.width + 5, c.refine), nn.ReLU(), nn.Linear(c.refine, 1))
        nn.init.zeros_(self.spread[-1].weight)
        nn.init.constant_(self.spread[-1].bias, 1.0)
        nn.init.zeros_(self.weigh[-1].weight)
        nn.init.zeros_(self.weigh[-1].bias)

    def forward(self, points, mask) -> Answer:
        rate = points[..., 1] * mask
        size = scale(rate, mask)
        cos, sin = fit.sight(points)
        there = mask.float()
        h = self.encode(features(points, mask, size))
        count = there.sum(-1, keepdim=True).clamp(min=1)
        mean = (h * there.unsqueeze(-1)).sum(1) / count
        # Encodings are not negative.
        g = self.pool(torch.cat((mean, (h * there.unsqueeze(-1)).amax(1)), -1))
        out = self.weigh(self.weigh_point(h) + self.weigh_frame(g).unsqueeze(1))
        narrow_h, narrow_g = self.narrow_point(h), self.narrow_frame(g)
        frame = self.refine_frame(narrow_g).unsqueeze(1)
        velocity, inlier = points.new_zeros((len(points), 2)), there
        most = PRECISION_RANGE * (1.0 if self.training else TEMPER)
        refinements = self.config.refinements if self.training else REFINEMENTS
        velocities, logits, moves = [], [], []
        for i in range(refinements + 1):
            if i == 1:
                velocity = hypotheses.start(points, cos, sin, rate, inlier, mask, velocity)
            if i > 0:
                residual = fit.residuals(cos, sin, rate, velocity)
                slope = fit.slopes(cos, sin, velocity)
                wide = AZIMUTH_RAD * (slope + LEAST_SLOPE * size.unsqueeze(-1))
                own = torch.stack(
                    (
                        _asinh(residual / RESIDUAL_MPS),
                        _asinh(residual.abs() / wide),
                        inlier,
                        slope / size.unsqueeze(-1),
                    ),
                    -1,
                )
                out = self.refine(self.refine_point(torch.cat((own, narrow_h), -1)) + frame)
            logit, precision, moving = out.unbind(-1)
            inlier = logit.sigmoid() * there
            weight = inlier * (most * (precision / PRECISION_RANGE).tanh()).exp()
            velocity, inverse = fit.fit(cos, sin, rate, weight)
            velocities.append(velocity)
            logits.append(logit)
            moves.append(moving)
        residual = fit.residuals(cos, sin, rate, velocity)
        covariance = fit.equation_3(residual, inlier, weight, inverse)
        sum_w = inlier.sum(-1)
        share = sum_w / count.squeeze(-1)
        typical = ((inlier * residual * residual).sum(-1) / (sum_w + 1e-3) + 1e-6).sqrt()
        told = torch.stack(
            (
                typical.log(),
                sum_w.log1p(),
                share,
                (0.5 * (covariance[:, 0] + covariance[:, 2])).log(),
                (velocity.square().sum(-1) + 1e-4).sqrt() / size,
            ),
            -1,
        )
        factor = self.spread(torch.cat((g, told), -1)).squeeze(-1).clamp(*FACTOR_RANGE)
        covariance = covariance * (2 * factor).exp().unsqueeze(-1)
        return Answer(
            velocity=torch.stack(velocities),
            logit=torch.stack(logits),
            moves=torch.stack(moves),
            covariance=covariance,
            context=narrow_g,
            share=share,
            factor=factor,
        )
