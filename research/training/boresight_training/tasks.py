"""What is trained: for each network its model, its data, its loss, its scores and its exported form."""

from copy import deepcopy
from dataclasses import asdict, dataclass, replace
from functools import partial
from math import log
from pathlib import Path
from typing import Any, Protocol

import torch
from torch import nn
from torch.nn import functional

from . import steered, unrolled_iaa, words
from .aaetr import CONFIGS, Aaetr
from .arrays import ELEMENTS, array, random_arrays, resolution
from .classifiers import COVARIANCE_FEATURES, DNN_HIDDEN, counting, dnn, folded
from .cnn3d import CNN3D, Cnn3d
from .covariance_networks import CNN_CONFIGS, MUSIC_CONFIGS
from .deviations import SHARE, fitted
from .drives import deepego, smoother
from .drives.smoother_task import DeepEgoPlusTask
from .drives.task import DeepEgoTask
from .ports import Port, snapshot_ports
from .regions import CHIRPS, CLASSES, LENGTH, Cubes, channels, covariance_features, labels, regions
from .score import best_f1
from .setloss import SetLossConfig, set_loss
from .snapshots import Scenes, snapshots
from .spectra import CovarianceTask, UnrolledIaaTask


class Task(Protocol):
    """One network and all that training it takes."""

    title: str
    reference: str
    """Where the network is published."""
    architecture: str
    """What the network is, in words."""
    differences: str
    """How it and its training differ from the publication."""
    inputs: tuple[Port, ...]
    outputs: tuple[Port, ...]
    batch: int
    learning_rate: float

    def model(self) -> nn.Module:
        """A new network."""

    def draw(self, batch: int, progress: float, generator: torch.Generator) -> Any:
        """A batch of data; `progress` through training goes from 0 to 1."""

    def loss(self, model: nn.Module, data: Any) -> tuple[torch.Tensor, dict[str, torch.Tensor]]:
        """What is minimised, and parts worth a log."""

    def evaluate(self, model: nn.Module, count: int, generator: torch.Generator) -> list[dict[str, float]]:
        """Conditions with their scores, over `count` examples each."""

    def confidence(self, model: nn.Module, count: int, generator: torch.Generator) -> float | None:
        """Threshold on the exported confidence with the largest F1 over all conditions; none where none is needed."""

    def deviations(self, model: nn.Module, count: int, generator: torch.Generator) -> Any:
        """What makes the deviations that the model states those of its errors; none where it states none."""

    def export_form(self, model: nn.Module, deviations: Any = None) -> nn.Module:
        """The module whose graph is exported, with these deviations."""

    def example(self, batch: int, generator: torch.Generator) -> tuple[torch.Tensor, ...]:
        """Inputs of the exported form."""

    def describe(self) -> dict:
        """Settings of data and model, for the card."""


AAETRS = CONFIGS | steered.CONFIGS
TRANSFORMERS = tuple(name for name, config in AAETRS.items() if getattr(config, "attend", True))
PURSUITS = tuple(name for name in AAETRS if name not in TRANSFORMERS)
EVALUATED = {"lrr48": (2, 6, 10), "awr1642": (1, 2), "ula16": (2, 4), "cascade86": (4, 10)}
"""Arrays that a network for any array is scored on, with numbers of targets. It is trained on none of them."""
WITHIN_CELLS = 0.4
"""How far from a target a prediction is right where deviations are fitted: half a degree on lrr48."""

ZHU = "Zhu, Chen and Yang (2024), Angle of Arrival Estimation with Transformer"


class AaetrTask:
    """AAETR or the learned pursuit: up to 16 targets in one snapshot, of `lrr48` or of any array."""

    def __init__(
        self,
        config: str,
        position_error: float = 0.0,
        targets: int = 16,
        arrays: str = "lrr48",
        snr_db: tuple[float, float] | None = None,
        matched_last: bool = False,
        close_pairs: float = 0.0,
    ):
        self.config = AAETRS[config]
        self.any_array = arrays == "any"
        if self.any_array and not isinstance(self.config, steered.SteeredConfig):
            raise ValueError(f"arrays 'any' of form {config}: expected a form with steered attention")
        if self.any_array and position_error:
            raise ValueError("a position error with arrays 'any': expected none, for these have their own")
        of = ", any array" if self.any_array else ", displaced elements" if position_error else ""
        pursuit = config in PURSUITS
        self.title = f"{'Learned pursuit' if pursuit else 'AAETR'}, form {config}{of}"
        self.reference = f"{'Boresight, after ' if pursuit else ''}{ZHU}"
        self.architecture, self.differences = words.set_prediction(self.config)
        self.scenes = Scenes(targets=(0, targets), position_error=position_error)
        self.close_pairs = close_pairs
        if snr_db is not None:
            self.scenes = replace(self.scenes, snr_db=snr_db)
        self.loss_config = SetLossConfig(matched_last=matched_last)
        self.positions = array("lrr48")
        self.batch, self.learning_rate = (1024, 4e-4) if config == "paper" else (32, 2e-3)
        elements = "elements" if self.any_array else 48
        self.inputs = snapshot_ports(elements)
        meaning = "sine of azimuth, amplitude at one element, confidence from 0 to 1"
        if self._states_deviations:
            meaning += ", standard deviations of the sine and of the amplitude in dB"
        values = 5 if self._states_deviations else 3
        self.outputs = (Port("targets", ("batch", self.config.queries, values), meaning),)

    @property
    def _states_deviations(self):
        return isinstance(self.config, steered.SteeredConfig)

    def model(self):
        return steered.SteeredAaetr(self.config) if self._states_deviations else Aaetr(self.config)

    def close_share(self, progress: float) -> float:
        """Share of scenes with a close pair; none at the end, so that confidences fit random scenes."""
        return self.close_pairs * max(0.0, min(1.0, (0.85 - progress) / 0.25))

    def draw(self, batch, progress, generator):
        positions = random_arrays(batch, generator) if self.any_array else self.positions
        return self.draw_on(positions, batch, self.close_share(progress), generator)

    def draw_on(self, positions, batch, close_share, generator):
        """A batch of data of arrays [elements, 3] or [batch, elements, 3]; `close_share` may be a tensor."""
        scenes = replace(self.scenes, close_pairs=close_share)
        if self.any_array:
            # A third of the elements is what lrr48 has targets at most.
            most = max(1, min(scenes.targets[1], positions.shape[-2] // 3))
            scenes = replace(scenes, targets=(scenes.targets[0], most))
        targets, values, positions = snapshots(scenes, positions, batch, generator)
        return targets, torch.view_as_real(values), positions.float()

    def loss(self, model, data):
        targets, values, positions = data
        return set_loss(model(values, positions), targets, self.loss_config, resolution(positions))

    def evaluate(self, model, count, generator):
        scores = []
        for name, numbers in (EVALUATED if self.any_array else {"lrr48": (2, 4, 6, 8, 10)}).items():
            for snr_db in (15, 25, 35):
                for number in numbers:
                    scenes = replace(self.scenes, targets=(number, number), snr_db=(snr_db, snr_db))
                    score = self._score(model, scenes, array(name), count, generator)
                    of = {"array": name} if self.any_array else {}
                    scores.append({**of, "targets": number, "snr_db": snr_db, **score})
        return scores

    def confidence(self, model, count, generator):
        best = self._score(model, self.scenes, self.positions, 4 * count, generator)
        return torch.tensor(best["threshold"]).sigmoid().item()

    def deviations(self, model, count, generator):
        if not self._states_deviations:
            return None
        # The array it is trained for, or arrays as it is trained on.
        parts = [self._errors(model, self.draw(250, 1.0, generator)) for _ in range(max(1, 4 * count // 250))]
        features, errors = (torch.cat(part) for part in zip(*parts, strict=True))
        head = model.head
        rows = torch.cat((head.weight[3:], head.bias[3:, None]), 1).detach()
        # The head has logarithms of variances.
        return fitted(0.5 * rows, features, errors) if len(errors) else 0.5 * rows

    def _errors(self, model, data):
        """Right predictions that are more likely than not: what their head sees, [predictions, width], and errors of
        sine (cells) and dB, [predictions, 2]."""
        targets, values, positions = data
        seen = []
        hook = model.head.register_forward_pre_hook(lambda _, inputs: seen.append(inputs[0]))
        try:
            with torch.no_grad():
                u, db, logit, *_ = model(values, positions)[-1].double().unbind(-1)
        finally:
            hook.remove()
        cell = steered.Places(positions).cell.double()
        off = (u.unsqueeze(2) - targets.u.unsqueeze(1)).abs() / cell.unsqueeze(-1)
        least, nearest = off.masked_fill(~targets.valid.unsqueeze(1), torch.inf).min(2)
        right = (least <= WITHIN_CELLS) & (logit > 0)
        errors = torch.stack((least, (db - targets.db.gather(1, nearest)).abs()), -1)
        return seen[-1][right], errors[right]

    def _score(self, model, scenes, positions, count, generator):
        targets, values, positions = snapshots(scenes, positions, count, generator)
        parts = zip(values.split(250), positions.float().expand(count, -1, -1).split(250), strict=True)
        answers = torch.cat([model(torch.view_as_real(v), p)[-1] for v, p in parts]).double()
        return best_f1(answers[..., 0].clamp(-1, 1).asin(), answers[..., 1], answers[..., 2], targets)

    def export_form(self, model, deviations=None):
        if deviations is not None:
            model = deepcopy(model)
            with torch.no_grad():
                model.head.weight[3:] = 2 * deviations[:, :-1]
                model.head.bias[3:] = 2 * deviations[:, -1]
        return _Targets(model, self._states_deviations)

    def example(self, batch, generator):
        _, values, _ = snapshots(replace(self.scenes, position_error=0.0), self.positions, batch, generator)
        return torch.view_as_real(values), self.positions.float().to(generator.device)

    def describe(self):
        arrays = {"array": "any", "elements": list(ELEMENTS)} if self.any_array else {"array": "lrr48"}
        data = {**arrays, **asdict(replace(self.scenes, close_pairs=self.close_pairs))}
        told = {"model": asdict(self.config), "data": data, "loss": asdict(self.loss_config)}
        if self._states_deviations:
            told["deviations"] = {"share": SHARE, "within_cells": WITHIN_CELLS}
        return told


class _Targets(nn.Module):
    def __init__(self, model, states_deviations):
        super().__init__()
        self.model, self.states_deviations = model, states_deviations

    def forward(self, snapshots, positions):
        sine, db, logit, *spread = self.model(snapshots, positions)[-1].split(1, -1)
        # No dB: those of empty queries magnify rounding.
        answer = (sine, (db * (log(10) / 20)).exp(), logit.sigmoid())
        if not self.states_deviations:
            return torch.cat(answer, -1)
        in_cells, in_db = ((0.5 * s.clamp(-20, 10)).exp() for s in spread)
        return torch.cat((*answer, in_cells * steered.Places(positions).cell, in_db), -1)


REGION = Port(
    "region",
    ("batch", LENGTH, 8, CHIRPS, 3),
    "range bins around the strongest, elements, chirps; magnitude, real and imaginary part; any scale",
)
COVARIANCE = Port(
    "covariance",
    ("batch", COVARIANCE_FEATURES),
    "upper triangle of the region's covariance by rows, real and imaginary parts, over its largest diagonal entry",
)

POWER_DIFFERENCES_DB = (-3, -6, -9, -12, -15)
"""Of the second target to the first, that networks of two targets are scored with."""
MOVING_MPS = 20.0
"""Largest speed, to either side, of half of the targets. The phase turns by up to half a turn from chirp to chirp."""


@dataclass
class ClassifierTask:
    """A network of Sang et al.: number of targets, or directions of a known number of them."""

    title: str
    reference: str
    architecture: str
    differences: str
    network: Any
    """Makes the model."""
    sizes: dict
    cubes: Cubes
    lowest_db: float
    """Lowest SNR of the second stage of training; that of the first is the cubes'."""
    on_covariance: bool
    batch: int
    learning_rate: float
    weaker_db: float = 0.0
    """Second targets are up to this much weaker in the second stage, and as strong as the first in the first stage."""
    second_stage_only: bool = False
    """Whether all of training is its second stage, for runs that start from another's weights."""

    def __post_init__(self):
        self.counts = self.cubes.targets[0] != self.cubes.targets[1]
        self.inputs = (COVARIANCE if self.on_covariance else REGION,)
        if self.counts:
            self.outputs = (Port("probability", ("batch", 3), "of 0, 1 and 2 targets, each for itself"),)
        else:
            meaning = "of a target at each whole degree of azimuth from -10 to 10"
            self.outputs = (Port("probability", ("batch", CLASSES), meaning),)

    @property
    def limits(self) -> str:
        """What the network cannot be used for."""
        targets = 0 if self.counts else self.cubes.targets[1]
        return words.equal_still_pairs(targets, self.weaker_db, self.cubes.rate_mps)

    def model(self):
        return self.network()

    def draw(self, batch, progress, generator):
        cubes = self.cubes
        if progress >= 0.5 or self.second_stage_only:
            cubes = replace(cubes, snr_db=(self.lowest_db, cubes.snr_db[1]), second_db=(-self.weaker_db, 0.0))
        return self._features(*regions(cubes, batch, generator))

    def _features(self, reflectors, region):
        values = covariance_features(region) if self.on_covariance else channels(region)
        if self.counts:
            return values, functional.one_hot(reflectors.valid.sum(1), 3).float()
        return values, labels(reflectors)

    def loss(self, model, data):
        values, label = data
        answer = model(values).float()
        loss = functional.binary_cross_entropy_with_logits(answer, label)
        return loss * label.shape[1], {}

    def evaluate(self, model, count, generator):
        scores = []
        for snr_db in (-10, -5, 0, 5, 10, 15):
            answer, label = self._answers(model, (snr_db, snr_db), count, generator)
            if self.counts:
                right, true = (answer.argmax(1) == label.argmax(1)).float(), label.argmax(1)
                by_class = {
                    f"accuracy_of_{name}": float(right[true == number].mean())
                    for number, name in enumerate(("none", "one", "two"))
                }
                scores.append({"snr_db": snr_db, "accuracy": float(right.mean()), **by_class})
            else:
                scores.append({"snr_db": snr_db, **self._directions(answer, label)})
            if self.cubes.targets == (2, 2):
                harder = {f"second_{-db}_db": {"second_db": (db, db)} for db in POWER_DIFFERENCES_DB}
                harder["moving"] = {"rate_mps": MOVING_MPS}
                for name, change in harder.items():
                    answer, label = self._answers(model, (snr_db, snr_db), count, generator, **change)
                    scores[-1][f"{name}_within_1_deg"] = self._directions(answer, label)["within_1_deg"]
        return scores

    def _answers(self, model, snr_db, count, generator, **change):
        """Answers and labels where ranges are independent, powers equal, elements exact, and nothing moves."""
        still = {"near": 0.0, "rate_mps": 0.0, "channel_db": 0.0, "channel_deg": 0.0}
        cubes = replace(self.cubes, snr_db=snr_db, **(still | change))
        values, label = self._features(*regions(cubes, count, generator))
        return torch.cat([model(part) for part in values.split(250)]), label

    def confidence(self, model, count, generator):
        if self.counts:
            return None
        answer, label = self._answers(model, (self.lowest_db, self.cubes.snr_db[1]), 4 * count, generator)
        logit, order = answer.flatten().sort(descending=True)
        hits = label.flatten()[order].double().cumsum(0)
        f1 = 2 * hits / (label.sum() + torch.arange(1, len(order) + 1))
        at = f1.argmax()
        # Between the last answer above the threshold and the first below.
        return logit[at : at + 2].mean().sigmoid().item()

    def _directions(self, answer, label):
        most = self.cubes.targets[1]
        given = answer.topk(most).indices.sort(1).values
        true = label.topk(most).indices.sort(1).values
        error = (given - true).abs()
        scores = {f"within_{allowed}_deg": float((error <= allowed).all(1).float().mean()) for allowed in (0, 1, 2, 4)}
        scores["rmse_deg"] = float(error.float().square().mean().sqrt())
        if most == 2:
            close = (true[:, 1] - true[:, 0]) < 4
            scores["close_pairs_within_1_deg"] = float((error[close] <= 1).all(1).float().mean())
        return scores

    def deviations(self, model, count, generator):
        return None

    def export_form(self, model, deviations=None):
        return nn.Sequential(folded(model) if isinstance(model, nn.Sequential) else model, nn.Sigmoid())

    def example(self, batch, generator):
        return (self._features(*regions(self.cubes, batch, generator))[0],)

    def describe(self):
        data = {**asdict(self.cubes), "second_stage_lowest_snr_db": self.lowest_db}
        if self.weaker_db > 0:
            data["second_stage_weaker_db"] = self.weaker_db
        if self.second_stage_only:
            data["second_stage_only"] = True
        targets = {} if self.counts else {"targets": self.cubes.targets[1]}
        return {**targets, "model": self.sizes, "data": data}


SANG = "Sang et al. (2021), DoA Estimation for FMCW Radar by 3D-CNN"
CHEN = "Chen, Gong and Mao (2020), Deep Neural Network for Estimation of Direction of Arrival with Antenna Array"


SETUPS = {
    "simulated": {},
    "experiment": {"waveform": "3dcnn-experiment", "range_m": (9.7, 10.3), "shift_m": 0.3},
}
"""Radars and ranges of Tables 3 and 4; the latter's targets stood at 10 m, and are shifted in range (equation 10)."""
NEAR = 0.5
"""Share of pairs within a range bin, of all networks for two targets alike; of independent ranges one in ten are."""


def classifier(
    name: str,
    config: str,
    targets: int,
    setup: str = "simulated",
    snr_db: tuple[float, float] | None = None,
    near: float = NEAR,
    channel_error: tuple[float, float] = (0.0, 0.0),
    weaker_db: float = 0.0,
    moving: bool = False,
    second_stage_only: bool = False,
) -> ClassifierTask:
    """The counting network, the 3D-CNN or the DNN, for one or two targets; `channel_error` in dB and degrees."""
    counts = name == "counting"
    low, high = snr_db or (-10.0 if counts else -5.0, 15.0)
    of = "" if setup == "simulated" else ", radar of Table 4"
    gain_db, phase_deg = channel_error
    cubes = Cubes(snr_db=(max(0.0, low), high), channel_db=gain_db, channel_deg=phase_deg, **SETUPS[setup])
    if moving:
        if setup != "simulated":
            raise ValueError("moving targets: expected the radar of Table 3; ramps of Table 4 are too long for them")
        cubes = replace(cubes, rate_mps=MOVING_MPS)
    boards = words.channel_errors(gain_db, phase_deg) + words.unlike(weaker_db, cubes.rate_mps)
    stages = {"lowest_db": low, "weaker_db": weaker_db, "second_stage_only": second_stage_only}
    if counts:
        hidden = {"small": 256, "paper": 1024}[config]
        return ClassifierTask(
            title=f"Number of targets, form {config}{of}",
            reference=SANG,
            architecture=words.fully_connected(hidden, "four"),
            differences=words.counting_stages(low) + boards,
            network=partial(counting, hidden),
            sizes={"hidden": hidden},
            cubes=cubes,
            **stages,
            on_covariance=True,
            batch=256,
            learning_rate=1e-3,
        )
    cubes = replace(cubes, targets=(targets, targets), near=near if targets == 2 else 0.0)
    of = f"form {config}, {'one target' if targets == 1 else 'two targets'}{of}"
    pairs = (
        f" {near:.0%} of its pairs are put within a range bin of each other; of independent ranges a tenth are."
        if cubes.near > 0
        else ""
    ) + boards
    if name == "dnn":
        hidden = DNN_HIDDEN[config]
        return ClassifierTask(
            title=f"DNN, {of}",
            reference=CHEN,
            architecture=words.fully_connected(hidden, "three"),
            differences=f"Sizes of the layers are ours, of the numbers of parameters that Sang et al. state.{pairs}",
            network=partial(dnn, hidden),
            sizes={"hidden": hidden},
            cubes=cubes,
            **stages,
            on_covariance=True,
            batch=256,
            learning_rate=2e-3,
        )
    sizes = CNN3D[config]
    architecture, differences = words.cnn3d(sizes)
    return ClassifierTask(
        title=f"3D-CNN, {of}",
        reference=SANG,
        architecture=architecture,
        differences=differences + pairs,
        network=partial(Cnn3d, sizes),
        sizes=asdict(sizes),
        cubes=cubes,
        **stages,
        on_covariance=False,
        batch=32,
        learning_rate=2e-3,
    )


NETWORKS = {
    "aaetr": TRANSFORMERS,
    "learned-pursuit": PURSUITS,
    "counting": ("small", "paper"),
    "cnn3d": tuple(CNN3D),
    "dnn": tuple(DNN_HIDDEN),
    "unrolled-iaa": tuple(unrolled_iaa.CONFIGS),
    "covariance-cnn": tuple(CNN_CONFIGS),
    "deep-music": tuple(MUSIC_CONFIGS),
    "deepego": tuple(deepego.CONFIGS),
    "deepego-plus": tuple(smoother.CONFIGS),
}


def task(
    name: str,
    config: str,
    targets: int | None = None,
    position_error: float = 0.0,
    arrays: str = "lrr48",
    setup: str = "simulated",
    snr_db: tuple[float, float] | None = None,
    near: float = NEAR,
    channel_error: tuple[float, float] = (0.0, 0.0),
    weaker_db: float = 0.0,
    moving: bool = False,
    second_stage_only: bool = False,
    matched_last: bool = False,
    close_pairs: float = 0.0,
    data: list[dict] | None = None,
    doppler_loss_only: bool = False,
    single_digest: str | None = None,
    folders: list[Path] | None = None,
    test: Path | None = None,
    weights: dict | None = None,
) -> Task:
    """A network by name and size.

    `targets` is the most that it is trained on (16, of covariances 3), or how many a classifier sees (1). `data` tells
    what stored data are, which lie in `folders` and, to score on, in `test`. deepego-plus is trained on the
    single-frame network with `weights`, which `single_digest` tells.
    """
    if config not in NETWORKS[name]:
        raise ValueError(f"config {config!r} of {name}: expected {', '.join(NETWORKS[name])}")
    if name == "deepego":
        return DeepEgoTask(config, data, doppler_loss_only, folders, test)
    if name == "deepego-plus":
        return DeepEgoPlusTask(config, data, single_digest, folders, test, weights)
    snr_db = None if snr_db is None else tuple(snr_db)
    if name in ("aaetr", "learned-pursuit"):
        most = 16 if targets is None else targets
        return AaetrTask(config, position_error, most, arrays, snr_db, matched_last, close_pairs)
    if name == "unrolled-iaa":
        return UnrolledIaaTask(config, 16 if targets is None else targets)
    if name in ("covariance-cnn", "deep-music"):
        return CovarianceTask(name, config, 3 if targets is None else targets)
    harder = {"weaker_db": weaker_db, "moving": moving, "second_stage_only": second_stage_only}
    return classifier(name, config, 1 if targets is None else targets, setup, snr_db, near, channel_error, **harder)
