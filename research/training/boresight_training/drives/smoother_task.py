"""DeepEgo+'s data, loss and scores."""

import hashlib
from dataclasses import asdict
from math import log
from pathlib import Path

import numpy as np
import torch
from torch import nn

from .. import checkpoint
from ..ports import Port
from . import losses, measures, weights_file
from .augment import THINNEST, WHOLE, plain, varied
from .dataset import Dataset
from .smoother import CONFIGS, DeepEgoPlus, Singles, Smoothed, Smoother
from .task import CONDITIONS, factor_of, synthetic

WINDOWS = 15_000
"""Windows that the single-frame network is run on before training, drawn from all."""
PLAIN = 0.5
"""Share of them that are not varied."""
TOLD, TOLD_WEIGHT = 3, 5.0
"""Frame of a window whose motion Boresight takes, and its weight in the loss beside those of the others."""


def digest(state: dict) -> str:
    """Which single-frame network this is."""
    return hashlib.sha256(weights_file.encoded(state, None)).hexdigest()[:16]


def single(folder: Path) -> dict:
    """The averaged weights of a single-frame network's training."""
    saved = checkpoint.load(Path(folder))
    if saved is None:
        raise FileNotFoundError(f"{folder} holds no {checkpoint.NAME}: expected a training of deepego")
    if saved["identity"]["name"] != "deepego":
        raise ValueError(f"{folder} holds {saved['identity']['name']}: expected deepego")
    return saved["ema"]


class DeepEgoPlusTask:
    """The smoother of 8 frames on a trained single-frame network."""

    title = "DeepEgo+, eight frames"
    reference = "Zhu et al. (2025), DeepEgo+; Zhu et al. (2025), Radar mounting angle estimation"
    architecture = (
        "A gated recurrent network reads the single-frame network's motions, covariances and contexts both ways, "
        "weighs each motion, and states priors; a weighted quadratic in time with these priors gives the motions and "
        "their covariances."
    )
    differences = (
        "The publications tell a temporal network over 8 frames and a second-order motion model, and not the layers. "
        "Weights of detections are the single-frame network's. It is trained on simulated drives alone."
    )
    batch = 128
    learning_rate = 2e-3
    golden_batch = 8

    def __init__(
        self,
        config: str,
        data: list[dict] | None = None,
        single_digest: str | None = None,
        folders: list[Path] | None = None,
        test: Path | None = None,
        weights: dict | None = None,
    ):
        self.config = CONFIGS[config]
        self.data, self.folders, self.test = data or [], folders, test
        self.single_digest, self._weights = single_digest, weights
        self._cache: tuple[Singles, torch.Tensor, torch.Tensor] | None = None
        self.inputs = (
            Port("points", ("batch", 8, "points", 4), "detections of 8 successive frames, as deepego has them"),
            Port("mask", ("batch", 8, "points"), "which detections are there"),
            Port("dt", ("batch", 8), "time since the frame before, s; 0 of the first"),
        )
        self.outputs = (
            Port("motion", ("batch", 8, 5), "velocity along boresight and to the left (m/s), covariance as xx, xy, yy"),
        )

    def model(self) -> nn.Module:
        network = DeepEgoPlus(self.config)
        if self._weights is not None:
            network.single.load_state_dict(self._weights)
        return network

    def draw(self, batch, progress, generator):
        if self._cache is None:
            if not self.folders or self._weights is None:
                raise ValueError(
                    "deepego-plus is trained on stored data and a trained deepego: expected --data, --single"
                )
            self._cache = self._run_single()
        singles, truth, known = self._cache
        chosen = torch.randint(len(known), (batch,), generator=generator)
        return Singles(*(x[chosen] for x in singles)), truth[chosen], known[chosen]

    @torch.no_grad()
    def _run_single(self):
        """Answers, true motions and which frames tell theirs, of windows drawn once."""
        data = Dataset(self.folders)
        network = self.model().eval()
        random = np.random.default_rng(1)
        generator = torch.Generator().manual_seed(1)
        count = len(data) // data.window
        starts = data.window * np.sort(random.permutation(count)[:WINDOWS])
        singles, truths, known = [], [], []
        for i in range(0, len(starts), 32):
            indices = (starts[i : i + 32, None] + np.arange(data.window)).ravel()
            is_plain = random.random() < PLAIN
            keep = np.repeat(random.uniform(THINNEST, 1.0, len(indices) // data.window), data.window)
            keep = None if is_plain or random.random() < WHOLE else keep
            frames = data.take(indices, keep)
            examples = plain(frames) if is_plain else varied(frames, generator, data.window)
            singles.append(_windows(network, examples.frames, data, indices))
            truths.append(examples.frames.velocity.view(-1, data.window, 2))
            known.append(examples.determined.view(-1, data.window))
        joined = Singles(*(torch.cat(parts) for parts in zip(*singles, strict=True)))
        return joined, torch.cat(truths), torch.cat(known)

    def loss(self, model, data):
        singles, truth, known = data
        answer = model.smoother(singles)
        each = losses.motion(answer.velocity - truth, answer.covariance)
        error = losses.robust(answer.velocity - truth)
        weight = known.float()
        weight[:, TOLD] *= TOLD_WEIGHT
        total = weight.sum().clamp(min=1)
        parts = {"motion": (each * weight).sum() / total, "robust": (error * weight).sum() / total}
        return parts["motion"] + 0.2 * parts["robust"], {name: value.detach() for name, value in parts.items()}

    def evaluate(self, model, count, generator):
        if self.test is None:
            return []
        data = Dataset([self.test])
        starts = np.arange(0, len(data), data.window)
        of_window = data.moving_share.reshape(-1, data.window).mean(1)
        scores = []
        for name, condition in CONDITIONS.items():
            fits = condition.of(data, np.repeat(of_window, data.window))
            chosen = np.flatnonzero(fits[starts])
            if len(chosen):
                order = torch.randperm(len(chosen), generator=generator)[: max(1, count // data.window)].numpy()
                scores.append({"frames": name, **self._score(model, data, starts[np.sort(chosen[order])])})
        return scores

    @torch.no_grad()
    def _score(self, model, data, starts):
        # Before learning a smoother is the quadratic with fixed priors: what a Kalman smoother gives.
        fixed = Smoother(self.config).eval()
        singles, smoothed, quadratic, truths, known = [], [], [], [], []
        for i in range(0, len(starts), 32):
            indices = (starts[i : i + 32, None] + np.arange(data.window)).ravel()
            frames = data.take(indices)
            single = _windows(model, frames, data, indices)
            singles.append(single)
            smoothed.append(model.smoother(single))
            quadratic.append(fixed(single).velocity)
            truths.append(frames.velocity)
            known.append(plain(frames).determined)
        single = Singles(*(torch.cat(parts) for parts in zip(*singles, strict=True)))
        answer = Smoothed(*(torch.cat(parts) for parts in zip(*smoothed, strict=True)))
        truth, known = torch.cat(truths), torch.cat(known)
        trust = 1 / (single.covariance[..., 0] + single.covariance[..., 2] + 1e-9)
        average = (trust.unsqueeze(-1) * single.velocity).sum(1, keepdim=True) / trust.sum(1).view(-1, 1, 1)
        average = average.expand_as(single.velocity)

        def flat(x):
            return x.flatten(0, 1)[known]

        told = torch.zeros_like(known.view(-1, data.window))
        told[:, TOLD] = known.view(-1, data.window)[:, TOLD]
        told = told.flatten()

        def told_over_single(x):
            return measures.variance_ratio(x.flatten(0, 1)[told], single.velocity.flatten(0, 1)[told], truth[told])

        found, alone = flat(answer.velocity), flat(single.velocity)
        before = measures.motion(alone, flat(single.covariance), truth[known])
        return {
            **measures.motion(found, flat(answer.covariance), truth[known]),
            **{f"single_{name}": value for name, value in before.items()},
            "variance_over_single": measures.variance_ratio(found, alone, truth[known]),
            "variance_of_average_over_single": measures.variance_ratio(flat(average), alone, truth[known]),
            "variance_of_quadratic_over_single": measures.variance_ratio(
                flat(torch.cat(quadratic)), alone, truth[known]
            ),
            "told_variance_over_single": told_over_single(answer.velocity),
            "told_variance_of_average_over_single": told_over_single(average),
            "told_variance_of_quadratic_over_single": told_over_single(torch.cat(quadratic)),
        }

    def confidence(self, model, count, generator):
        return None

    @torch.no_grad()
    def deviations(self, model, count, generator):
        """One factor, of windows of all conditions."""
        if self.test is None:
            return None
        data = Dataset([self.test])
        count = max(1, min(count, len(data)) // data.window)
        order = torch.randperm(len(data) // data.window, generator=generator)[:count]
        windows = data.window * order.sort().values.numpy()[:, None] + np.arange(data.window)

        def answers():
            for rows in np.array_split(windows, max(1, count // 32)):
                frames = data.take(rows.ravel())
                answer = model.smoother(_windows(model, frames, data, rows.ravel()))
                yield frames, answer.velocity.flatten(0, 1), answer.covariance.flatten(0, 1)

        return [factor_of(answers())]

    def export_form(self, model, deviations=None):
        if deviations is not None:
            with torch.no_grad():
                model.smoother.window.bias[-1] += log(deviations[0])
        return _Motions(model)

    def write(self, form, path: Path, half_from: int | None) -> dict:
        """Writes both networks' weights as `weights_file` has them beside an ONNX file, for its card."""
        return weights_file.write_beside(path, form.model.state_dict(), half_from)

    def example(self, batch, generator):
        frames = synthetic(8 * batch, 40, generator)
        velocity = frames.velocity.view(batch, 8, 2)
        # The first frame's motion, a little faster from frame to frame.
        steady = (velocity[:, :1] * torch.linspace(1.0, 1.05, 8).view(1, 8, 1)).reshape(-1, 2)
        change = steady - frames.velocity
        cos, sin = frames.points[..., 0].cos(), frames.points[..., 0].sin()
        frames.points[..., 1] -= change[:, :1] * cos + change[:, 1:] * sin
        points = (frames.points * frames.mask.unsqueeze(-1)).view(batch, 8, -1, 4)
        dt = 0.074 * torch.ones(batch, 8)
        dt[:, 0] = 0
        return points, frames.mask.view(batch, 8, -1), dt

    def describe(self):
        data = {"sets": self.data, "windows": WINDOWS, "single": self.single_digest}
        return {"model": asdict(self.config), "data": data, "loss": {"motion": 1.0, "robust": 0.2, "told": TOLD_WEIGHT}}


class _Motions(nn.Module):
    """Points, mask and times to smoothed motions."""

    def __init__(self, model):
        super().__init__()
        self.model = model

    def forward(self, points, mask, dt):
        answer = self.model(points, mask, dt)
        return torch.cat((answer.velocity, answer.covariance), -1)


def _windows(network, frames, data, indices, size: int = 64) -> Singles:
    """The single-frame network's answers, of frames with about as many detections together."""
    dt = torch.from_numpy(data.frames["dt"][indices].copy()).view(-1, data.window)
    count = frames.mask.sum(1)
    order = count.argsort()
    answers = []
    for rows in order.split(size):
        most = max(1, int(count[rows].max()))
        answers.append(
            network.singles(frames.points[rows, :most].unsqueeze(1), frames.mask[rows, :most].unsqueeze(1), dt)
        )
    back = order.argsort()
    joined = (torch.cat([answer[i] for answer in answers])[back] for i in range(3))
    return Singles(*(x.reshape(-1, data.window, x.shape[-1]) for x in joined), dt)
