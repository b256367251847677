"""DeepEgo's data, losses and scores."""

from dataclasses import asdict, dataclass
from math import inf, log
from pathlib import Path

import numpy as np
import torch
from torch import nn

from ..ports import Port
from . import classical, losses, measures, weights_file
from .augment import BANDS, Batches, Examples, plain
from .dataset import DIRECTION_RAD, NOTHING_STATIC, QUEUE, TRAFFIC, Dataset, Frames
from .deepego import CONFIGS, DeepEgo


@dataclass(frozen=True)
class Condition:
    """Frames to score on."""

    window: int
    """What their windows were made like."""
    low: float
    high: float
    """Moving share from and below."""
    looks_deg: tuple[float, float] = (0.0, 181.0)
    """Angle between the radar's and the car's direction, from and below."""
    changes_mps2: tuple[float, float] = (0.0, inf)
    """Change of the radar's velocity, from and below."""

    def of(self, data: Dataset, share: np.ndarray) -> np.ndarray:
        """Whether frames of these moving shares are among them."""
        looks = np.abs(np.rad2deg(data.frames["direction"] * DIRECTION_RAD))
        fits = (data.frames["condition"] == self.window) & (share >= self.low) & (share < self.high)
        fits &= (looks >= self.looks_deg[0]) & (looks < self.looks_deg[1])
        return fits & (data.changes >= self.changes_mps2[0]) & (data.changes < self.changes_mps2[1])


CONDITIONS = {
    "up to 30 % moving": Condition(TRAFFIC, 0.0, 0.3),
    "up to 30 % moving, looking ahead": Condition(TRAFFIC, 0.0, 0.3, (10.0, 40.0)),
    "up to 30 % moving, looking aside": Condition(TRAFFIC, 0.0, 0.3, (70.0, 100.0)),
    "30 to 60 % moving": Condition(TRAFFIC, 0.3, 0.6),
    "60 to 90 % moving": Condition(TRAFFIC, 0.6, 0.9),
    "queues": Condition(QUEUE, 0.2, 0.9),
    "steady, below 0.5 m/s^2": Condition(TRAFFIC, 0.0, 0.6, changes_mps2=(0.0, 0.5)),
    "changing, 0.5 to 2 m/s^2": Condition(TRAFFIC, 0.0, 0.6, changes_mps2=(0.5, 2.0)),
    "changing, from 2 m/s^2": Condition(TRAFFIC, 0.0, 0.6, changes_mps2=(2.0, inf)),
}
"""What frames are scored on."""
WEIGHTS = {"motion": 1.0, "robust": 0.2, "weights": 2.0, "moves": 0.5, "doppler": 0.1}
"""Of the parts of the loss."""
BEFORE_LAST = 0.3
"""Weight of the fits but the last in the parts of the loss that all have."""


def factor_of(answers) -> float:
    """The factor on stated deviations, from frames that tell their motion, with velocities and covariances."""
    squared = []
    for frames, velocity, covariance in answers:
        error = velocity - frames.velocity
        good = plain(frames).determined & (error.norm(dim=-1) < measures.FAILED_MPS)
        squared.append(measures.whitened(error, covariance)[good])
    return measures.deviation_factor(torch.cat(squared))


class DeepEgoTask:
    """The single-frame network; with `doppler_loss_only` trained without labels and without true motion."""

    title = "DeepEgo, single frame"
    reference = "Zhu, Yarovoy and Fioranelli (2023), DeepEgo; Zhu et al. (2025), Radar mounting angle estimation"
    architecture = (
        "Detections are encoded one by one by two layers, pooled by mean and maximum, and weighed by three layers on "
        "both. Weighted least squares gives the motion. From the motion of a pair of detections that most weight "
        "agrees on, two refinements with shared layers (three in training) weigh anew by residuals. A factor scales "
        "equation 3's covariance. Once trained, precisions count less than in training. "
        "Beside its weight each detection is told whether it moves."
    )
    differences = (
        "The publications tell the pipeline, the weighted least squares and the Doppler loss, and not the layers: "
        "features, sizes, pairs, refinements, the precision beside each weight, the factor and the losses but one are "
        "ours. "
        "It is trained on simulated drives alone."
    )
    batch = 256
    learning_rate = 2e-3
    golden_batch = 64

    def __init__(
        self,
        config: str,
        data: list[dict] | None = None,
        doppler_loss_only: bool = False,
        folders: list[Path] | None = None,
        test: Path | None = None,
    ):
        self.config = CONFIGS[config]
        self.doppler_loss_only = doppler_loss_only
        self.data = data or []
        self.folders, self.test = folders, test
        self._batches: Batches | None = None
        if doppler_loss_only:
            self.title += ", by the Doppler loss alone"
        self.inputs = (
            Port(
                "points",
                ("batch", "points", 4),
                "of each detection azimuth to the left (rad), range rate (m/s), range (m) and cross-section (dBsm); "
                "the last two are not a number where they are not known",
            ),
            Port("mask", ("batch", "points"), "which detections are there"),
        )
        self.outputs = (
            Port(
                "motion",
                ("batch", 7),
                "velocity of the radar along boresight and to its left (m/s), its covariance as xx, xy, yy, mean "
                "weight, logarithm of the factor on equation 3's deviations",
            ),
            Port(
                "weights",
                ("batch", "points"),
                "of each detection from 0 to 1: how likely it is that it shows the motion",
            ),
            Port(
                "moves", ("batch", "points"), "of each detection from 0 to 1: how likely it is of something that moves"
            ),
        )

    def model(self) -> nn.Module:
        return DeepEgo(self.config)

    def draw(self, batch, progress, generator) -> list[Examples]:
        if self._batches is None:
            if not self.folders:
                raise ValueError("deepego is trained on stored data: expected --data")
            self._batches = Batches(Dataset(self.folders))
        return self._batches.draw(batch, progress, generator)

    def loss(self, model, data):
        count = sum(len(part.determined) for part in data)
        totals: dict[str, torch.Tensor] = {}
        for part in data:
            for name, value in self._parts(model, part).items():
                totals[name] = totals.get(name, 0) + value.sum() / count
        wanted = ("doppler",) if self.doppler_loss_only else tuple(WEIGHTS)
        loss = sum((1.0 if self.doppler_loss_only else WEIGHTS[name]) * totals[name] for name in wanted)
        return loss, {name: value.detach() for name, value in totals.items()}

    def _parts(self, model, part: Examples) -> dict[str, torch.Tensor]:
        frames = part.frames
        answer = model(frames.points, frames.mask)
        known = part.determined.float()
        error = answer.velocity - frames.velocity
        mask = frames.mask.float()
        stages = [BEFORE_LAST] * (len(error) - 1) + [1.0]
        return {
            "motion": known * losses.motion(error[-1], answer.covariance),
            "robust": sum(w * known * losses.robust(e) for w, e in zip(stages, error, strict=True)),
            "weights": sum(w * losses.weights(x, part.target, mask) for w, x in zip(stages, answer.logit, strict=True)),
            "moves": sum(
                w * losses.weights(x, frames.moving.float(), part.labelled.float())
                for w, x in zip(stages, answer.moves, strict=True)
            ),
            "doppler": sum(
                w * losses.doppler(frames.points, mask, v, x)
                for w, v, x in zip(stages, answer.velocity, answer.logit, strict=True)
            ),
        }

    def evaluate(self, model, count, generator):
        if self.test is None:
            return []
        data = Dataset([self.test])
        scores = []
        for name, condition in CONDITIONS.items():
            chosen = np.flatnonzero(condition.of(data, data.moving_share))
            if len(chosen):
                order = torch.randperm(len(chosen), generator=generator)[:count].numpy()
                scores.append({"frames": name, **self.score(model, data, np.sort(chosen[order]), generator)})
        nothing = np.flatnonzero(data.frames["condition"] == NOTHING_STATIC)[:count]
        if len(nothing):
            answers = [model(f.points, f.mask) for f in parts(data, nothing)]
            weight = torch.cat([answer.share for answer in answers])
            scores.append({"frames": "nothing static", "mean_weight": float(weight.mean())})
        return scores

    def score(self, model, data: Dataset, chosen: np.ndarray, generator) -> dict[str, float]:
        """Scores of the network and of RANSAC on frames by number."""
        found, classic, noise_weighted, gated, said, truths = [], [], [], [], [], []
        for frames in parts(data, chosen):
            truth = plain(frames)
            known = truth.determined
            answer = model(frames.points, frames.mask)
            found.append((answer.velocity[-1][known], answer.covariance[known]))
            velocity, inlier, covariance = classical.ransac(frames.points, frames.mask, generator)
            classic.append((velocity[known], covariance[known]))
            by_noise = classical.weighted(frames.points, inlier, velocity, losses.deviations)
            noise_weighted.append(tuple(x[known] for x in by_noise))
            speed = frames.velocity.norm(dim=-1)
            scale = 1 + classical.SPEED_SCALE * torch.randn(len(speed), generator=generator)
            speed = scale * speed + classical.SPEED_MPS * torch.randn(len(speed), generator=generator)
            velocity, _, covariance = classical.ransac(frames.points, frames.mask, generator, speed=speed)
            gated.append((velocity[known], covariance[known]))
            truths.append(frames.velocity[known])
            standing, weight = (-answer.moves[-1]).sigmoid(), answer.logit[-1].sigmoid()
            said.append([x[frames.mask] for x in (standing, weight, frames.moving, truth.target, inlier)])
        true = torch.cat(truths)
        standing, weight, moving, target, inlier = (torch.cat(x) for x in zip(*said, strict=True))
        all_there = torch.ones_like(moving)

        def of(parts_):
            return measures.motion(*(torch.cat(x) for x in zip(*parts_, strict=True)), true)

        of_network = torch.cat([v for v, _ in found])
        network, ransac, weighted, with_speed = of(found), of(classic), of(noise_weighted), of(gated)
        return {
            **network,
            **measures.labels(standing, all_there, moving),
            "f1_by_weight": measures.labels(weight, all_there, moving)["f1"],
            "f1_by_true_inliers": measures.labels(target, all_there, moving)["f1"],
            "inlier_f1": measures.labels(weight, all_there, target < 0.5)["f1_static"],
            **{f"ransac_{name}": value for name, value in ransac.items()},
            "ransac_f1": measures.labels(inlier.float(), all_there, moving)["f1"],
            **{f"weighted_ransac_{name}": weighted[name] for name in ("failed", "direction_variance_deg2")},
            **{f"gated_ransac_{name}": with_speed[name] for name in ("failed", "direction_variance_deg2")},
            "variance_over_gated_ransac": measures.variance_ratio(of_network, torch.cat([v for v, _ in gated]), true),
            "variance_over_ransac": measures.variance_ratio(of_network, torch.cat([v for v, _ in classic]), true),
            "variance_over_weighted": measures.variance_ratio(
                of_network, torch.cat([v for v, _ in noise_weighted]), true
            ),
        }

    def confidence(self, model, count, generator):
        return None

    @torch.no_grad()
    def deviations(self, model, count, generator):
        """One factor, of frames of all conditions whose motion they tell."""
        if self.test is None:
            return None
        data = Dataset([self.test])
        chosen = torch.randperm(len(data), generator=generator)[:count].sort().values.numpy()
        answers = ((frames, model(frames.points, frames.mask)) for frames in parts(data, chosen))
        return [factor_of((frames, answer.velocity[-1], answer.covariance) for frames, answer in answers)]

    def export_form(self, model, deviations=None):
        if deviations is not None:
            with torch.no_grad():
                model.spread[-1].bias += log(deviations[0])
        return _Motion(model)

    def write(self, form, path: Path, half_from: int | None) -> dict:
        """Writes the weights as `weights_file` has them beside an ONNX file, for its card."""
        return weights_file.write_beside(path, form.model.state_dict(), half_from)

    def example(self, batch, generator):
        """Synthetic frames; the first three have no, one and two detections where there are more than three."""
        frames = synthetic(batch, 40, generator)
        if batch > 3:
            for count in range(3):
                frames.mask[count] = torch.arange(40) < count
        return frames.points * frames.mask.unsqueeze(-1), frames.mask

    def describe(self):
        data = {"sets": self.data, "bands": [list(band) for band in BANDS]}
        loss = {"doppler": 1.0} if self.doppler_loss_only else dict(WEIGHTS)
        return {"model": asdict(self.config), "data": data, "loss": loss}


class _Motion(nn.Module):
    """Points and mask to motion, weights and what moves."""

    def __init__(self, model):
        super().__init__()
        self.model = model

    def forward(self, points, mask):
        answer = self.model(points, mask)
        told = torch.stack((answer.share, answer.factor), -1)
        motion = torch.cat((answer.velocity[-1], answer.covariance, told), -1)
        return motion, answer.logit[-1].sigmoid() * mask, answer.moves[-1].sigmoid() * mask


def parts(data: Dataset, chosen: np.ndarray, size: int = 250):
    """Frames by number, some at a time, those with few detections first, so that little is padded."""
    chosen = chosen[np.argsort(data.frames["count"][chosen], kind="stable")]
    for start in range(0, len(chosen), size):
        yield data.take(chosen[start : start + size])


def synthetic(count: int, most: int, generator) -> Frames:
    """Frames of standing things seen with noise and one in five detections of anything else; no simulated drives."""

    def unit(*shape):
        return torch.rand(shape, generator=generator)

    velocity = 30 * unit(count, 2) - torch.tensor([5.0, 15.0])
    azimuth = 2.4 * unit(count, most) - 1.2
    rate = -(velocity[:, :1] * azimuth.cos() + velocity[:, 1:] * azimuth.sin())
    rate = rate + 0.05 * torch.randn((count, most), generator=generator)
    moving = unit(count, most) < 0.2
    rate = torch.where(moving, 40 * unit(count, most) - 20, rate)
    points = torch.stack((azimuth, rate, 1 + 99 * unit(count, most), 40 * unit(count, most) - 20), -1)
    mask = torch.arange(most) < (3 + (unit(count, 1) * (most - 3)).long())
    points[unit(count) < 0.2, :, 2] = torch.nan
    points[unit(count) < 0.2, :, 3] = torch.nan
    return Frames(points * mask.unsqueeze(-1), mask, moving & mask, velocity)
