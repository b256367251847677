"""Why the form `paper` of AAETR does not learn: short trainings of variants, each with one change.

    python -m boresight_training.paper_study overfit|learn --minutes 6 --out runs/paper-study

`overfit` trains on one batch again and again, `learn` on new data in every step. A folder gets one JSON file for each
variant, and a variant with a file is not trained again. Prints a Markdown table of all.
"""

import argparse
import json
import time
from dataclasses import replace
from pathlib import Path

import torch
from torch import nn

from .aaetr import CONFIGS, Aaetr
from .arrays import array, resolution
from .score import best_f1
from .setloss import SetLossConfig, set_loss
from .snapshots import Scenes, snapshots

PAPER = CONFIGS["paper"]
WAVES = replace(PAPER, positions="waves")
VARIANTS = {
    "paper": {},
    "sines and cosines as positional encoding": {"config": WAVES},
    "a learned vector for each element": {"config": replace(PAPER, positions="learned")},
    "learning rate / 4": {"rate": 2e-4},
    "learning rate x 4": {"rate": 3.2e-3},
    "warm-up 10 times as long": {"warmup": 500},
    "queries of standard deviation 0.02": {"config": replace(PAPER, query_scale=0.02)},
    "queries attend to each other": {"config": replace(PAPER, query_attention=True)},
    "fixed slots, no matching": {"slots": True},
    "sines and cosines, fixed slots": {"config": WAVES, "slots": True},
    "sines and cosines, queries attend to each other": {"config": replace(WAVES, query_attention=True)},
}
BATCH = 32
SCENES = Scenes(targets=(1, 4), snr_db=(35.0, 35.0))
MARKS = (0.1, 0.25, 0.5, 1.0)
"""Parts of the time at which scores are taken."""


def draw(seed: int, count: int = BATCH):
    """Targets, values and positions of lrr48."""
    targets, values, positions = snapshots(SCENES, array("lrr48"), count, torch.Generator().manual_seed(seed))
    return targets, torch.view_as_real(values), positions.float()


def train(kind: str, minutes: float, config=PAPER, rate=8e-4, warmup=50, slots=False) -> dict:
    """Trains a variant for so much processor time of a thread; loss, F1 and steps at each of MARKS."""
    torch.manual_seed(0)
    network = Aaetr(config)
    optimizer = torch.optim.AdamW(network.parameters(), lr=rate, betas=(0.9, 0.98), weight_decay=1e-2)
    places = torch.linspace(-config.half_view, config.half_view, config.queries) if slots else None
    cell = resolution(array("lrr48").float())
    marks, step, losses = [], 0, []
    begin = time.process_time()
    while len(marks) < len(MARKS):
        progress = (time.process_time() - begin) / (60 * minutes)
        if progress >= MARKS[len(marks)]:
            seed, count = (0, BATCH) if kind == "overfit" else (1_000_000, 250)
            marks.append({"step": step, "loss": sum(losses) / len(losses), **score(network, seed, count)})
            losses = []
            continue
        for group in optimizer.param_groups:
            group["lr"] = rate * min(1.0, (step + 1) / warmup)
        targets, values, positions = draw(0 if kind == "overfit" else step + 1)
        loss, _ = set_loss(network(values, positions), targets, SetLossConfig(), cell, places)
        optimizer.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(network.parameters(), 1.0)
        optimizer.step()
        losses.append(loss.item() / config.decoder_layers)
        step += 1
    return {"minutes": minutes, "batch": BATCH, "marks": marks}


def score(network, seed, count) -> dict:
    """F1 and strict F1 on data of a seed."""
    targets, values, positions = draw(seed, count)
    with torch.no_grad():
        u, db, logit = network(values, positions)[-1].double().unbind(-1)
    best = best_f1(u.clamp(-1, 1).asin(), db, logit, targets)
    return {name: best[name] for name in ("f1", "strict_f1")}


def table(results: dict) -> str:
    """Loss and strict F1 of each variant at each of MARKS."""
    heads = " | ".join(f"{100 * mark:.0f} % of the time" for mark in MARKS)
    lines = [f"| variant | steps | {heads} |", "|---|---|" + "---|" * len(MARKS)]
    for name, result in results.items():
        cells = [f"{mark['loss']:.2f}, {mark['strict_f1']:.3f}" for mark in result["marks"]]
        lines.append(" | ".join([f"| {name}", str(result["marks"][-1]["step"]), *cells]) + " |")
    return "\n".join(lines)


def main() -> None:
    """Trains the variants that have no file yet."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=("overfit", "learn"))
    parser.add_argument("--minutes", type=float, default=6.0, help="processor time of each variant on one thread")
    parser.add_argument("--out", type=Path, default=Path("runs/paper-study"))
    parser.add_argument("--only", action="append", choices=VARIANTS, help="train these variants alone")
    arguments = parser.parse_args()
    torch.set_num_threads(1)
    results = {}
    for number, (name, change) in enumerate(VARIANTS.items()):
        if arguments.only and name not in arguments.only:
            continue
        path = arguments.out / f"{arguments.kind}-{number:02}.json"
        if not path.exists():
            path.parent.mkdir(parents=True, exist_ok=True)
            result = {"variant": name, **train(arguments.kind, arguments.minutes, **change)}
            path.write_text(json.dumps(result, indent=2) + "\n")
        results[name] = json.loads(path.read_text())
        print(f"{name}: {results[name]['marks'][-1]}", flush=True)
    print(table(results))


if __name__ == "__main__":
    main()
