"""Tasks of networks that answer with a spectrum: UAA, Papageorgiou's CNN and DeepMUSIC.

All have a grid of points evenly spaced in the sine of the azimuth, the first at -1.
"""

from dataclasses import asdict, replace
from math import pi

import torch
from torch import nn
from torch.nn import functional

from . import words
from .arrays import array, steering
from .covariance_networks import CNN_CONFIGS, FLOOR, MUSIC_CONFIGS, CovarianceNetwork
from .ports import Port, snapshot_ports
from .score import best_f1
from .snapshots import Scenes, covariances, snapshots
from .unrolled_iaa import CONFIGS, Powers, UnrolledIaa

ZHENG = "Zheng, Liu, Sun and Li (2023), Deep Learning Based Computationally Efficient Unrolling IAA"
PAPAGEORGIOU = (
    "Papageorgiou, Sellathurai and Eldar (2021), Deep Networks for Direction-of-Arrival Estimation in Low SNR"
)
ELBIR = "Elbir (2020), DeepMUSIC: Multiple Signal Classification via Deep Learning"


def grid(points: int, device=None) -> torch.Tensor:
    """Sines of the azimuth of the points."""
    return torch.arange(points, dtype=torch.float64, device=device) * (2 / points) - 1


def peaks(values: torch.Tensor, most: int):
    """The highest maxima of spectra in dB, [batch, points]: sines between the points and heights, [batch, most].

    Each is the top of the parabola through a point and its neighbours; where there are fewer, heights are -inf.
    """
    left, right = values.roll(1, -1), values.roll(-1, -1)
    height, at = values.masked_fill((values <= left) | (values < right), -torch.inf).topk(most, -1)
    left, middle, right = (x.gather(-1, at) for x in (left, values, right))
    bend = (left - 2 * middle + right).clamp_max(-1e-9)
    offset = (0.5 * (left - right) / bend).clamp(-0.5, 0.5)
    points = values.shape[-1]
    return (at + offset) * (2 / points) - 1, height


def lobes(sine: torch.Tensor, points: int) -> torch.Tensor:
    """Squared distances of the points from sines [batch, targets], in steps of the grid, [batch, targets, points]."""
    apart = grid(points, sine.device) - sine.unsqueeze(-1)
    return ((apart + 1).remainder(2) - 1).mul(points / 2).square()


class UnrolledIaaTask:
    """UAA: the spectrum of one snapshot of `lrr48`."""

    DROP_DB = 8.0
    """By which a target's lobe is lower a step of the grid beside it; in dB lobes are parabolas."""
    FLOOR_DB = -35.0
    """Least power of the labels, over the mean power of the snapshot at an element."""
    MOST = 24
    """Peaks that are scored."""

    def __init__(self, config: str, targets: int = 16):
        self.config = CONFIGS[config]
        self.title = f"UAA (unrolled IAA), form {config}"
        self.reference = ZHENG
        self.architecture, self.differences = words.unrolled_iaa(self.config)
        self.scenes = Scenes(targets=(0, targets))
        self.positions = array("lrr48")
        self.batch, self.learning_rate = 32, 2e-3
        self.inputs = snapshot_ports(len(self.positions))
        meaning = "power at one element, at sines of the azimuth -1 + 2 g / points"
        self.outputs = (Port("spectrum", ("batch", self.config.points), meaning),)

    def model(self):
        return UnrolledIaa(self.config)

    def draw(self, batch, progress, generator):
        targets, values, positions = snapshots(self.scenes, self.positions, batch, generator)
        return torch.view_as_real(values), positions.float(), self._labels(targets, values)

    def _labels(self, targets, values):
        """In dB, [batch, points]."""
        lobe = targets.db.unsqueeze(-1) - self.DROP_DB * lobes(targets.u, self.config.points)
        highest = lobe.masked_fill(~targets.valid.unsqueeze(-1), -torch.inf).amax(1)
        floor = 10 * values.abs().square().mean(1, keepdim=True).log10() + self.FLOOR_DB
        return torch.maximum(highest, floor.double()).float()

    def loss(self, model, data):
        values, positions, label = data
        answers = model(values, positions)
        floor = label.amin(-1, keepdim=True)
        # Below the floor nothing is asked for.
        off = functional.smooth_l1_loss(torch.maximum(answers, floor) / 10, (label / 10).expand_as(answers))
        last = functional.smooth_l1_loss(torch.maximum(answers[-1], floor) / 10, label / 10)
        return off + last, {"last": last.detach()}

    def evaluate(self, model, count, generator):
        scores = []
        for snr_db in (15, 25, 35):
            for number in (2, 4, 6, 8, 10):
                scenes = replace(self.scenes, targets=(number, number), snr_db=(snr_db, snr_db))
                targets, values, positions = snapshots(scenes, self.positions, count, generator)
                parts = torch.view_as_real(values).split(250)
                answers = torch.cat([model(part, positions.float())[-1] for part in parts]).double()
                sine, db = peaks(answers, self.MOST)
                score = best_f1(sine.clamp(-1, 1).asin(), db, db, targets)
                scores.append({"targets": number, "snr_db": snr_db, **score})
        return scores

    def confidence(self, model, count, generator):
        return None

    def deviations(self, model, count, generator):
        return None

    def export_form(self, model, deviations=None):
        return Powers(model)

    def example(self, batch, generator):
        _, values, _ = snapshots(self.scenes, self.positions, batch, generator)
        return torch.view_as_real(values), self.positions.float()

    def describe(self):
        return {"model": asdict(self.config), "data": {"array": "lrr48", **asdict(self.scenes)}}


class CovarianceTask:
    """Papageorgiou's CNN or DeepMUSIC: sources in a sample covariance of `ula16`."""

    SNAPSHOTS = (16, 2000)
    """Fewest and most that a covariance is the mean of."""

    def __init__(self, name: str, config: str, targets: int = 3):
        self.music = name == "deep-music"
        self.config = (MUSIC_CONFIGS if self.music else CNN_CONFIGS)[config]
        kind = "DeepMUSIC" if self.music else "Covariance CNN"
        self.title = f"{kind}, form {config}"
        self.reference = ELBIR if self.music else PAPAGEORGIOU
        self.architecture, self.differences = (words.deep_music if self.music else words.covariance_cnn)(self.config)
        self.scenes = Scenes(targets=(1, targets), db=(-3.0, 0.0), snr_db=(-20.0, 10.0))
        n = self.config.elements
        self.array = f"ula{n}"
        self.positions = array(self.array)
        self.batch, self.learning_rate = 256, 1e-3
        channels = "real part, imaginary part and phase over pi of the covariance over its mean diagonal entry"
        self.inputs = (Port("covariance", ("batch", 3, n, n), channels),)
        where = "at sines of the azimuth -1 + 2 g / points"
        what = "MUSIC's pseudo-spectrum, at most 1" if self.music else "of a source"
        name = "spectrum" if self.music else "probability"
        self.outputs = (Port(name, ("batch", self.config.points), f"{what}, {where}"),)

    def model(self):
        return CovarianceNetwork(self.config)

    def draw(self, batch, progress, generator):
        targets, matrix = covariances(self.scenes, self.positions, batch, self.SNAPSHOTS, generator)
        return image(matrix), self._labels(targets)

    def _labels(self, targets):
        """Decades of MUSIC's spectrum over its least value, or the CNN's probabilities, [batch, points]."""
        if not self.music:
            near = (-0.5 * lobes(targets.u, self.config.points)).exp()
            return near.masked_fill(~targets.valid.unsqueeze(-1), 0).amax(1).float()
        # Its least value is where the whole steering vector is noise, and FLOOR of its largest.
        return -null_spectrum(self.positions, targets, self.config.points).log10().float()

    def loss(self, model, data):
        values, label = data
        answer = model(values)
        if self.music:
            return functional.mse_loss(answer, label), {}
        return functional.binary_cross_entropy_with_logits(answer, label) * 20, {}

    def evaluate(self, model, count, generator):
        scores = []
        for snr_db in (-20, -15, -10, -5, 0, 5):
            scenes = replace(self.scenes, targets=(2, 2), db=(0.0, 0.0), snr_db=(snr_db, snr_db))
            targets, matrix = covariances(scenes, self.positions, count, (200, 200), generator)
            answer = torch.cat([model(part) for part in image(matrix).split(250)]).double()
            sine, _ = peaks(answer if self.music else functional.logsigmoid(answer), 2)
            found, true = sine.clamp(-1, 1).asin().sort(-1).values, targets.azimuth.sort(-1).values
            error = (found - true).rad2deg().abs()
            within = (error <= 2).all(-1)
            rmse = error[within].square().mean().sqrt() if within.any() else torch.tensor(0.0)
            scores.append({"snr_db": snr_db, "within_2_deg": float(within.double().mean()), "rmse_deg": float(rmse)})
        return scores

    def confidence(self, model, count, generator):
        if self.music:
            return None
        targets, matrix = covariances(self.scenes, self.positions, 4 * count, self.SNAPSHOTS, generator)
        sine, height = peaks(torch.cat([model(part) for part in image(matrix).split(250)]).double(), 6)
        best = best_f1(sine.clamp(-1, 1).asin(), height, height, targets)
        return torch.tensor(best["threshold"]).sigmoid().item()

    def deviations(self, model, count, generator):
        return None

    def export_form(self, model, deviations=None):
        return nn.Sequential(model.fold(), Decades() if self.music else nn.Sigmoid())

    def example(self, batch, generator):
        return (image(covariances(self.scenes, self.positions, batch, self.SNAPSHOTS, generator)[1]),)

    def describe(self):
        data = {"array": self.array, "snapshots": list(self.SNAPSHOTS), **asdict(self.scenes)}
        return {"model": asdict(self.config), "data": data}


class Decades(nn.Module):
    """From decades over the floor to MUSIC's spectrum, at most 1."""

    def forward(self, x):
        return FLOOR * 10**x


def image(matrix: torch.Tensor) -> torch.Tensor:
    """Real part, imaginary part and phase over pi of covariances over their mean diagonal entry, [batch, 3, N, N]."""
    mean = matrix.diagonal(dim1=-2, dim2=-1).real.mean(-1).clamp_min(1e-30)
    scaled = matrix / mean[:, None, None]
    return torch.stack((scaled.real, scaled.imag, matrix.angle() / pi), 1)


def null_spectrum(positions, targets, points: int) -> torch.Tensor:
    """Of the exact covariance: the share of a steering vector that lies in the noise subspace, at least FLOOR."""
    waves = torch.where(targets.valid.unsqueeze(-1), steering(positions, targets.u), 0)
    towards = steering(positions, grid(points))
    elements = len(positions)
    # Without a target a row is zero, and the identity leaves it so.
    gram = waves @ waves.mH + torch.diag_embed((~targets.valid).to(waves.dtype))
    gram = gram + 1e-9 * elements * torch.eye(gram.shape[-1])
    inside = waves.conj() @ towards.mT
    share = (inside.conj() * torch.linalg.solve(gram.conj(), inside)).real.sum(-2) / elements
    return (1 - share).clamp(FLOOR, 1)
