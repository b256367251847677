"""Training: every network learns, runs resume exactly, several processes agree, the command line works."""

import itertools
import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import onnx
import pytest
import torch
from onnx import numpy_helper

from boresight_training import checkpoint, export, train
from boresight_training.learning import learning_curve
from boresight_training.processes import Processes
from boresight_training.tasks import task
from boresight_training.train import Settings, Training

PACKAGE = Path(__file__).parents[1]
ALONE = Processes(0, 1, torch.device("cpu"))


def training(folder, steps, stop_at_step=None, network=("dnn", "small"), start_from=None, **settings):
    name, config = network
    what = task(name, config)
    s = Settings(
        batch=settings.pop("batch", 16),
        learning_rate=settings.pop("learning_rate", 1e-3),
        steps=steps,
        stop_at_step=stop_at_step,
        warmup_steps=5,
        log_seconds=0,
        evaluate_count=20,
        **settings,
    )
    identity = {"name": name, "config": config, "targets": None, "position_error": 0.0}
    return Training(what, s, folder, identity, ALONE, start_from)


def log(folder):
    return [json.loads(line) for line in (Path(folder) / "log.jsonl").read_text().splitlines()]


@pytest.mark.parametrize(
    "name,config,steps,batch,learning_rate",
    [
        ("aaetr", "tiny", 60, 16, 5e-3),
        ("aaetr", "paper", 40, 8, 1e-3),
        ("aaetr", "steered-attention-tiny", 60, 16, 5e-3),
        ("counting", "small", 150, 64, 3e-3),
        ("cnn3d", "small", 40, 8, 1e-3),
        ("dnn", "small", 200, 64, 5e-3),
        ("unrolled-iaa", "tiny", 500, 16, 2e-2),
        ("covariance-cnn", "tiny", 100, 64, 3e-3),
        ("deep-music", "tiny", 100, 64, 3e-3),
    ],
)
def test_every_network_lowers_its_loss(tmp_path, name, config, steps, batch, learning_rate):
    training(tmp_path, steps, network=(name, config), batch=batch, learning_rate=learning_rate).run()
    losses = torch.tensor([entry["loss"] for entry in log(tmp_path) if "loss" in entry])
    tenth = len(losses) // 10
    assert losses[-tenth:].mean() < 0.85 * losses[:tenth].mean()


def test_a_network_for_any_array_lowers_its_loss_and_is_scored_on_several():
    what = task("aaetr", "steered-attention-tiny", arrays="any")
    torch.manual_seed(0)
    network = what.model()
    optimizer = torch.optim.AdamW(network.parameters(), lr=5e-3)
    losses = []
    for step in range(60):
        loss, parts = what.loss(network, what.draw(16, 0.0, torch.Generator().manual_seed(step)))
        optimizer.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(network.parameters(), 1.0)
        optimizer.step()
        losses.append(parts["sine"].item() + parts["confidence"].item())
    assert sum(losses[-10:]) < 0.85 * sum(losses[:10])
    with torch.no_grad():
        scores = what.evaluate(network, 8, torch.Generator().manual_seed(1))
    assert {score["array"] for score in scores} == {"lrr48", "awr1642", "ula16", "cascade86"}
    with pytest.raises(ValueError, match="arrays 'any' of form paper"):
        task("aaetr", "paper", arrays="any")


@pytest.mark.parametrize("network", [("aaetr", "tiny"), ("aaetr", "paper"), ("cnn3d", "small")])
def test_bfloat16_trains_weights_in_single_precision(tmp_path, network):
    run = training(tmp_path, 2, network=network, batch=4, bfloat16=True)
    run.run()
    assert all(p.dtype == torch.float32 and p.isfinite().all() for p in run.network.parameters())
    assert log(tmp_path)[-1]["scores"]


@pytest.mark.parametrize("network", [("dnn", "small"), ("aaetr", "tiny")])
def test_a_resumed_run_goes_on_as_if_it_had_not_stopped(tmp_path, network):
    training(tmp_path / "whole", 12, network=network).run()
    for stop in (5, 6, None):
        training(tmp_path / "parts", 12, stop, network=network).run()
    whole, parts = (checkpoint.load(tmp_path / name) for name in ("whole", "parts"))
    assert whole["step"] == parts["step"] == 12 and whole["samples"] == parts["samples"] == 12 * 16
    for part in ("model", "ema"):
        assert all(torch.equal(whole[part][name], parts[part][name]) for name in whole[part])
    moments = [list(saved["optimizer"]["state"].values()) for saved in (whole, parts)]
    assert all(torch.equal(a[k], b[k]) for a, b in zip(*moments, strict=True) for k in a)


def test_another_networks_folder_is_refused(tmp_path):
    training(tmp_path, 2).run()
    with pytest.raises(ValueError, match="dnn"):
        training(tmp_path, 2, network=("counting", "small"))


def test_a_run_starts_from_the_weights_of_another(tmp_path):
    training(tmp_path / "first", 3).run()
    first = checkpoint.load(tmp_path / "first")
    second = training(tmp_path / "second", 2, start_from=tmp_path / "first", seed=1)
    assert all(torch.equal(value, first["ema"][name]) for name, value in second.network.state_dict().items())
    second.run()
    saved = checkpoint.load(tmp_path / "second")
    assert saved["step"] == 2
    assert [(leg["step"], leg["samples"], leg["settings"]["seed"]) for leg in saved["legs"]] == [(3, 48, 0)]
    with pytest.raises(ValueError, match="dnn"):
        training(tmp_path / "third", 2, network=("counting", "small"), start_from=tmp_path / "first")


def test_a_run_starts_from_a_published_model(tmp_path):
    path = PACKAGE.parent / "models" / "cnn3d-2.onnx"
    told = json.loads(path.with_suffix(".json").read_text())["legs"]
    seen = [leg["samplesSeen"] for leg in told]
    run = training(tmp_path, 1, network=("cnn3d", "small"), start_from=path, seed=70, batch=4)
    (bias,) = (w for w in onnx.load(path).graph.initializer if w.name == "0.classify.6.bias")
    assert torch.equal(run.ema.classify[6].bias, torch.from_numpy(numpy_helper.to_array(bias).copy()))
    assert [leg["samples"] for leg in run.legs] == seen
    run.run()
    legs = checkpoint.load(tmp_path)["legs"]
    assert [export._leg(leg) for leg in legs] == told
    with pytest.raises(ValueError, match="seed 0"):
        training(tmp_path / "again", 1, network=("cnn3d", "small"), start_from=path)


def test_a_file_of_weights_is_enough_to_start_from(tmp_path):
    training(tmp_path / "first", 3).run()
    first = checkpoint.load(tmp_path / "first")
    torch.save(checkpoint.weights(first), tmp_path / "weights.pt")
    second = training(tmp_path / "second", 2, start_from=tmp_path / "weights.pt", seed=1)
    for name, value in second.network.state_dict().items():
        # Half precision has 11 bits.
        assert torch.allclose(value, first["ema"][name], rtol=2**-11, atol=1e-7), name
    assert second.legs[0]["samples"] == 48
    size = (tmp_path / "weights.pt").stat().st_size
    assert size < (tmp_path / "first" / checkpoint.NAME).stat().st_size / 6


@pytest.mark.parametrize("seed", [0, 1])
def test_a_run_from_another_refuses_seeds_whose_batches_were_seen(tmp_path, seed):
    training(tmp_path / "first", 2).run()
    training(tmp_path / "second", 2, start_from=tmp_path / "first", seed=1).run()
    with pytest.raises(ValueError, match=f"seed {seed}"):
        training(tmp_path / "third", 2, start_from=tmp_path / "second", seed=seed)
    third = training(tmp_path / "third", 2, start_from=tmp_path / "second", seed=2)
    assert [leg["settings"]["seed"] for leg in third.legs] == [0, 1]


def test_a_checkpoint_is_replaced_whole(tmp_path, monkeypatch):
    checkpoint.save(tmp_path, {"step": 1})

    def broken(state, file):
        file.write(b"half of it")
        raise OSError("disk full")

    monkeypatch.setattr(checkpoint.torch, "save", broken)
    with pytest.raises(OSError, match="disk full"):
        checkpoint.save(tmp_path, {"step": 2})
    assert checkpoint.load(tmp_path) == {"step": 1}
    assert checkpoint.load(tmp_path / "nowhere") is None


def test_schedule_and_budget_follow_the_clock(tmp_path, monkeypatch):
    clock = itertools.count()
    monkeypatch.setattr(train.time, "monotonic", lambda: next(clock))  # every look at it takes a second
    monkeypatch.setattr(train.hardware, "clock", lambda device: train.time.monotonic)
    run = training(tmp_path, None, total_minutes=2.0, minutes=1.0)
    run.run()
    assert 0.4 < run.progress() < 0.6
    training(tmp_path, None, total_minutes=2.0).run()
    entries = log(tmp_path)
    assert run.step < entries[-1]["step"] and entries[-1]["seconds"] == pytest.approx(120, abs=10)
    rates = [entry["learning_rate"] for entry in entries]
    assert rates[-1] < 0.1 * max(rates)
    with pytest.raises(ValueError, match="steps or total_minutes"):
        training(tmp_path, None)


def test_the_second_stage_has_noisier_data():
    what = task("dnn", "small")
    what.cubes = replace(what.cubes, snr_db=(15.0, 15.0))
    what.lowest_db = -30.0
    first, second = (what.draw(200, progress, torch.Generator().manual_seed(1))[0] for progress in (0.4, 0.6))

    # Without noise every entry of the covariance of one target has magnitude 1.
    def magnitude(x):
        return x.unflatten(1, (28, 2)).norm(dim=2).mean()

    assert magnitude(first) > 0.98 and magnitude(second) < 0.9


def command(*arguments, processes=1, **options):
    start = [sys.executable, "-m"]
    if processes > 1:
        start += ["torch.distributed.run", "--standalone", "--nproc-per-node", str(processes), "-m"]
    environment = {**os.environ, "PYTHONPATH": str(PACKAGE), "OMP_NUM_THREADS": "1"}
    return subprocess.Popen(
        [*start, "boresight_training", *map(str, arguments)],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        **options,
    )


def finish(process):
    try:
        out, errors = process.communicate(timeout=240)
    finally:
        process.kill()
    assert process.returncode == 0, errors
    return out


SHORT = ("--batch", 32, "--device", "cpu", "--evaluate-count", 20, "--log-seconds", 0)


def test_two_processes_train_as_one_would(tmp_path):
    finish(
        command(
            "train",
            "aaetr",
            "--config",
            "tiny",
            "--steps",
            3,
            *SHORT,
            "--resume",
            tmp_path,
            "--warmup-steps",
            1,
            processes=2,
        )
    )
    assert checkpoint.load(tmp_path)["step"] == 3
    # The same gradient from both halves of each batch in one process.
    what = task("aaetr", "tiny")
    alone = Training(
        what,
        Settings(batch=32, learning_rate=what.learning_rate, steps=3, warmup_steps=1),
        tmp_path / "alone",
        {},
        ALONE,
    )
    halves = []

    def draw(batch, progress, generator):
        seed = generator.initial_seed()
        halves[:] = [type(what).draw(what, batch // 2, progress, generator.manual_seed(seed + rank)) for rank in (0, 1)]
        return halves

    def loss(model, data):
        losses = [type(what).loss(what, model, half)[0] for half in data]
        return sum(losses) / 2, {}

    what.draw, what.loss = draw, loss
    for _ in range(3):
        alone._step()
    together = checkpoint.load(tmp_path)["model"]
    for name, value in alone.network.state_dict().items():
        if name.endswith("key.bias"):
            continue  # no gradient but rounding, which the optimiser scales up
        assert torch.allclose(value, together[name], atol=2e-5), name


def test_the_command_line_trains_evaluates_and_exports(tmp_path):
    folder, path = tmp_path / "run", tmp_path / "models" / "counting.onnx"
    finish(command("train", "counting", "--config", "small", "--minutes", 0.05, *SHORT, "--resume", folder))
    scores = json.loads(finish(command("evaluate", folder, "--count", 50)))
    assert [condition["snr_db"] for condition in scores] == [-10, -5, 0, 5, 10, 15]
    for condition in scores:
        classes = [condition[f"accuracy_of_{name}"] for name in ("none", "one", "two")]
        assert min(classes) <= condition["accuracy"] <= max(classes) and min(classes) >= 0 and max(classes) <= 1
    finish(command("export", folder, path, "--precision", "half", "--count", 50))
    card = json.loads(path.with_suffix(".json").read_text())
    assert card["samplesSeen"] > 0 and card["architecture"] and card["differences"]
    (leg,) = card["legs"]
    assert leg["samplesSeen"] == card["samplesSeen"] and leg["hardware"] and leg["training"]["seed"] == 0
    assert card["bytes"] == path.stat().st_size and len(card["sha256"]) == 64
    assert [condition["snrDb"] for condition in card["metrics"]] == [-10, -5, 0, 5, 10, 15]


def test_a_learning_curve_counts_on_from_run_to_run(tmp_path):
    first, second = tmp_path / "first", tmp_path / "second"
    training(first, 3, network=("aaetr", "tiny"), batch=4).run()
    training(second, 2, network=("aaetr", "tiny"), batch=4, seed=1, start_from=first).run()
    one, two = learning_curve(first), learning_curve(second)
    assert one["title"] == "AAETR, form tiny" and two["title"] == "AAETR, form tiny, run 2"
    assert [point["samples"] for point in (one["points"][-1], two["points"][-1])] == [12, 20]
    assert two["points"][-1]["hours"] >= one["points"][-1]["hours"]
    scores = log(first)[-1]["scores"]
    assert one["points"][-1]["f1"] == pytest.approx(sum(s["f1"] for s in scores) / len(scores), abs=1e-5)
    # Of a network without F1 there is none.
    training(tmp_path / "counting", 2, network=("counting", "small"), batch=8).run()
    assert learning_curve(tmp_path / "counting") is None


def test_a_signal_saves_and_stops(tmp_path):
    process = command("train", "dnn", "--config", "small", "--minutes", 10, *SHORT, "--resume", tmp_path)
    until = time.monotonic() + 120
    while not (tmp_path / "log.jsonl").exists():
        assert time.monotonic() < until and process.poll() is None
        time.sleep(0.1)
    process.send_signal(signal.SIGTERM)
    finish(process)
    assert checkpoint.load(tmp_path)["step"] > 0


def test_mistakes_are_named(tmp_path):
    process = command("train", "dnn", "--config", "paper", "--minutes", 1)
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 2 and "expected small, large" in errors
    process = command("evaluate", tmp_path)
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 2 and "holds no checkpoint.pt" in errors
