"""Batches of frames from a set of data: how much moves grows with training, and frames are varied."""

from dataclasses import dataclass

import numpy as np
import torch

from . import fit, losses
from .dataset import Dataset, Frames

BANDS = ((0.0, 0.3), (0.2, 0.6), (0.45, 1.01))
"""Progress from which on frames have up to which moving share."""
HARD, HARDEST = 0.3, 0.25
"""Share of a batch that is drawn from the frames with the largest moving share alone, and how much of all these are."""
WHOLE = 0.3
"""Share of the frames that keep all detections."""
THINNEST = 0.1
NOISE = (0.5, 2.0)
GHOSTS = (0.5, 0.1)
"""Share of the frames with more ghosts, and their most."""
BODIES, BODY_MPS = 3, 20.0
BODY_FRAMES, BODY_HALF_RAD = 0.3, (0.02, 0.25)
"""Clusters of ghosts of one motion each: most a frame, most speed along each axis, share of the frames, extent."""
DROPPED = (0.3, 0.6)
"""Share of the frames without ranges, and without cross-sections."""
RCS_OFFSET_DB, RCS_SCALE, RANGE_SCALE = 10.0, (0.3, 1.5), (0.7, 1.4)
"""By how much cross-sections are moved either way, and they and ranges stretched: kinds of radar differ in them."""
CHUNK = 32
"""Frames that are padded to one number of detections."""


@dataclass
class Examples:
    """Frames and what the network should say of them."""

    frames: Frames
    target: torch.Tensor
    """Weights, 0 or 1, [frames, points]."""
    labelled: torch.Tensor
    """Whether what moves is known of a detection, [frames, points]."""
    determined: torch.Tensor
    """Whether detections tell the motion, [frames]."""


class Batches:
    """Draws batches."""

    def __init__(self, data: Dataset):
        self.data = data
        self.order = np.argsort(data.moving_share, kind="stable")
        """Frames by moving share."""
        share = data.moving_share[self.order]
        self.within = [(start, int(np.searchsorted(share, most, "right"))) for start, most in BANDS]

    def draw(self, batch: int, progress: float, generator: torch.Generator) -> list[Examples]:
        """A batch in parts of frames with about as many detections."""
        random = np.random.default_rng(int(torch.randint(2**62, (1,), generator=generator)))
        most = [count for start, count in self.within if progress >= start][-1]
        place = random.random(batch)
        place = np.where(random.random(batch) < HARD, 1 - HARDEST * (1 - place), place)
        chosen = self.order[(place * most).astype(np.int64)]
        keep = np.where(random.random(batch) < WHOLE, 1.0, random.uniform(THINNEST, 1.0, batch))
        by_count = np.argsort(self.data.frames["count"][chosen] * keep, kind="stable")
        chosen, keep = chosen[by_count], keep[by_count]
        return [
            varied(self.data.take(chosen[i : i + CHUNK], keep[i : i + CHUNK]), generator)
            for i in range(0, batch, CHUNK)
        ]


def varied(frames: Frames, generator: torch.Generator, window: int = 1) -> Examples:
    """Frames mirrored, with more or less noise, more ghosts, and other or no ranges and cross-sections.

    As many successive frames as a window has are varied alike.
    """
    count, most = frames.mask.shape

    def unit(*shape):
        if shape[-1] == most and len(shape) > 1:
            return torch.rand(shape, generator=generator)
        alike = torch.rand((shape[0] // window, *shape[1:]), generator=generator)
        return alike.repeat_interleave(window, 0)

    points, velocity = frames.points.clone(), frames.velocity.clone()
    mirrored = torch.where(unit(count) < 0.5, -1.0, 1.0)
    points[..., 0] *= mirrored.unsqueeze(-1)
    velocity[:, 1] *= mirrored
    inlier = losses.inliers(points, frames.mask, frames.moving, velocity)
    noise = NOISE[0] * (NOISE[1] / NOISE[0]) ** unit(count, 1)
    cos, sin = fit.sight(points)
    residual = fit.residuals(cos, sin, points[..., 1], velocity)
    points[..., 1] += torch.where(inlier, (noise - 1) * residual, 0.0)
    share = torch.where(unit(count, 1) < GHOSTS[0], GHOSTS[1] * unit(count, 1), 0.0)
    ghost = unit(count, most) < share
    widest = velocity.norm(dim=-1, keepdim=True) + 6
    points[..., 1] = torch.where(ghost, widest * (2 * unit(count, most) - 1), points[..., 1])
    body = _bodies(points, unit)
    points[..., 1] += body
    true = ~ghost & (body == 0)
    inlier &= true
    points[..., 2] *= _between(RANGE_SCALE, unit(count, 1))
    points[..., 3] = points[..., 3] * _between(RCS_SCALE, unit(count, 1)) + RCS_OFFSET_DB * (2 * unit(count, 1) - 1)
    for column, share in zip((2, 3), DROPPED, strict=True):
        points[unit(count) < share, :, column] = torch.nan
    varied_frames = Frames(points, frames.mask, frames.moving, velocity)
    return Examples(varied_frames, inlier.float(), frames.mask & true, losses.determined(inlier, points))


def _between(limits, unit):
    return limits[0] + (limits[1] - limits[0]) * unit


def _bodies(points, unit):
    """What clusters of ghosts, each with a motion of its own, add to range rates, [frames, points]."""
    count = len(points)
    azimuth = points[..., 0]
    cos, sin = fit.sight(points)
    some = unit(count, 1) < BODY_FRAMES
    added = torch.zeros_like(azimuth)
    for _ in range(BODIES):
        centre = 2.4 * unit(count, 1) - 1.2
        half = _between(BODY_HALF_RAD, unit(count, 1))
        share = 0.3 + 0.7 * unit(count, 1)
        x, y = (BODY_MPS * (2 * unit(count, 1) - 1) for _ in range(2))
        within = some & ((azimuth - centre).abs() < half) & (unit(*azimuth.shape) < share)
        added = torch.where(within, x * cos + y * sin, added)
    return added


def plain(frames: Frames) -> Examples:
    """Frames as they are."""
    inlier = losses.inliers(frames.points, frames.mask, frames.moving, frames.velocity)
    return Examples(frames, inlier.float(), frames.mask, losses.determined(inlier, frames.points))
