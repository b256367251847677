"""The models in the repository: what their cards say of them."""

import hashlib
import json
from pathlib import Path

import numpy as np
import onnxruntime
import pytest
import torch

from boresight_training.arrays import array
from boresight_training.score import best_f1
from boresight_training.snapshots import Scenes, snapshots
from boresight_training.tasks import task

ROOT = Path(__file__).parents[3]
MODELS = sorted([*(ROOT / "models").glob("*.onnx"), *(ROOT / "research" / "models").glob("*.onnx")])
GOLDEN = {
    ROOT / "models": ROOT / "tests" / "golden" / "networks",
    ROOT / "research" / "models": ROOT / "research" / "models" / "golden",
}


def card_of(path):
    return json.loads(path.with_suffix(".json").read_text())


def task_of(card):
    data, more = card["data"], {}
    if "positionError" in data:
        more["position_error"] = data["positionError"]
        more["arrays"] = data["array"]
    else:
        more["near"] = data.get("near") or 0.0
        more["setup"] = "experiment" if data["waveform"] == "3dcnn-experiment" else "simulated"
        more["channel_error"] = (data.get("channelDb", 0.0), data.get("channelDeg", 0.0))
        more["snr_db"] = (data["secondStageLowestSnrDb"], data["snrDb"][1])
        more["weaker_db"] = data.get("secondStageWeakerDb", 0.0)
        more["moving"] = data.get("rateMps", 0.0) > 0
    return task(card["network"], card["form"], card.get("targets"), **more)


def session_of(path):
    return onnxruntime.InferenceSession(path, providers=["CPUExecutionProvider"])


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.stem)
def test_a_card_describes_its_file(path):
    card, session = card_of(path), session_of(path)
    assert card["bytes"] == path.stat().st_size < 24e6
    assert card["sha256"] == hashlib.sha256(path.read_bytes()).hexdigest()
    assert card["name"] == path.stem
    what = task_of(card)
    for told in ("title", "reference", "architecture", "differences"):
        assert card[told] == getattr(what, told)
    assert card.get("limits", "") == getattr(what, "limits", "")
    for sum_of, digits in (("samplesSeen", 0), ("hours", 2)):
        assert card[sum_of] == pytest.approx(sum(leg[sum_of] for leg in card["legs"]), abs=10**-digits)
    without = ("counting", "unrolled-iaa", "deep-music")
    assert card["network"] in without or 0 < card["confidence"] < 1
    for ports, named, given in (
        (what.inputs, card["inputs"], session.get_inputs()),
        (what.outputs, card["outputs"], session.get_outputs()),
    ):
        assert [(p.name, list(p.axes)) for p in ports] == [(p["name"], p["axes"]) for p in named]
        assert [(p.name, list(p.axes)) for p in ports] == [(p.name, p.shape) for p in given]


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.stem)
def test_a_golden_batch_is_what_card_and_file_say(path):
    card = card_of(path)

    def read(ports):
        values = {port["name"]: np.load(GOLDEN[path.parent] / path.stem / f"{port['name']}.npy") for port in ports}
        for port in ports:
            given = values[port["name"]]
            assert given.dtype == np.float32
            # A network for any array is asked about one of 48 elements.
            free = {"batch": 4, "elements": 48}
            assert given.shape == tuple(free.get(axis, axis) for axis in port["axes"])
        return values

    inputs, outputs = read(card["inputs"]), read(card["outputs"])
    assert len(list((GOLDEN[path.parent] / path.stem).iterdir())) == len(inputs) + len(outputs)
    answers = session_of(path).run(list(outputs), inputs)
    for given, expected in zip(answers, outputs.values(), strict=True):
        # Relative to values above 1: standard deviations of power reach several dB.
        assert (np.abs(given - expected) / np.maximum(1.0, np.abs(expected))).max() < 1e-4


def test_all_weights_together_are_within_the_limit():
    assert sum(path.stat().st_size for path in MODELS) < 64e6


SETS = [path for path in MODELS if card_of(path)["network"] in ("aaetr", "learned-pursuit")]


@pytest.mark.parametrize("path", SETS, ids=lambda path: path.stem)
def test_a_network_of_snapshots_scores_what_its_card_says(path):
    what = task_of(card_of(path))
    for condition in card_of(path)["metrics"]:
        number, snr_db = condition["targets"], condition["snrDb"]
        if snr_db != 15:
            continue
        scenes = Scenes(targets=(number, number), snr_db=(15, 15))
        positions = array(condition["array"]) if "array" in condition else what.positions
        targets, values, _ = snapshots(scenes, positions, 200, torch.Generator().manual_seed(number))
        feeds = {"snapshots": torch.view_as_real(values).numpy(), "positions": positions.float().numpy()}
        (answer,) = session_of(path).run(None, feeds)
        u, amplitude, confidence, *_ = torch.from_numpy(answer).unbind(-1)
        db = 20 * amplitude.log10()
        f1 = condition["f1"]
        # Four standard deviations of such a share of the targets, or of one of 0.99 in 400; F1 is at most as noisy.
        allowed = max(0.02, 4 * (f1 * (1 - f1) / (200 * number)) ** 0.5)
        assert abs(best_f1(u.clamp(-1, 1).asin(), db, confidence, targets)["f1"] - f1) < allowed
