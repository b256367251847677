"""`python -m boresight_training train|evaluate|export`."""

import argparse
import json
import sys
from pathlib import Path

import torch

from . import export, processes
from .drives import smoother_task
from .drives.dataset import Dataset
from .tasks import NEAR, NETWORKS, SETUPS, task
from .train import Settings, Training


def parser() -> argparse.ArgumentParser:
    """What the command takes."""
    top = argparse.ArgumentParser(prog="boresight_training", description=__doc__)
    commands = top.add_subparsers(dest="command", required=True)

    sizes = "; ".join(f"{name}: {', '.join(configs)}" for name, configs in NETWORKS.items())
    train = commands.add_parser("train", help="train a network, or go on where a folder's training stopped")
    train.add_argument("network", choices=NETWORKS)
    train.add_argument("--config", default="small", help=f"size: {sizes}")
    train.add_argument("--targets", type=int, help="most targets of aaetr (16); targets cnn3d and dnn see (1), 1 or 2")
    train.add_argument("--position-error", type=float, default=0.0, help="aaetr: perturb positions, half wavelengths")
    train.add_argument(
        "--snr-db",
        type=float,
        nargs=2,
        metavar=("LOW", "HIGH"),
        help="signal-to-noise ratio of the data; counting, cnn3d and dnn have 0 dB and more in their first half",
    )
    train.add_argument("--near", type=float, default=NEAR, help="cnn3d, dnn: share of pairs put within a range bin")
    train.add_argument(
        "--channel-error",
        type=float,
        nargs=2,
        metavar=("DB", "DEG"),
        help="counting, cnn3d, dnn: deviations of the elements' gain and phase, for boards that are not calibrated",
    )
    weaker = "cnn3d, dnn: in the second half, second targets are up to so much weaker than first"
    train.add_argument("--weaker-db", type=float, default=0.0, metavar="DB", help=weaker)
    moving = "counting, cnn3d, dnn: half of the targets move"
    train.add_argument("--moving", action="store_true", help=moving)
    second = "counting, cnn3d, dnn: data of the second half from the beginning, for --start-from"
    train.add_argument("--second-stage-only", action="store_true", help=second)
    radars = "counting, cnn3d, dnn: radar of Table 3 or of Table 4"
    train.add_argument("--setup", choices=tuple(SETUPS), default="simulated", help=radars)
    train.add_argument("--arrays", choices=("lrr48", "any"), default="lrr48", help="aaetr: arrays to train on")
    close = "aaetr: share of scenes with two close targets, which falls to none towards the end of the schedule"
    train.add_argument("--close-pairs", type=float, default=0.0, metavar="SHARE", help=close)
    once = "aaetr: match targets by the last layer's answers for all layers, in place of by each layer's"
    train.add_argument("--matched-last", action="store_true", help=once)
    stored = "deepego, deepego-plus: folder of simulate drive --dataset to train on; may be given several times"
    train.add_argument("--data", type=Path, action="append", default=[], metavar="DIR", help=stored)
    scored = "deepego, deepego-plus: folder of simulate drive --dataset, of another seed, to score on"
    train.add_argument("--test", type=Path, metavar="DIR", help=scored)
    on = "deepego-plus: folder of the training of the single-frame network that it smooths"
    train.add_argument("--single", type=Path, metavar="DIR", help=on)
    alone = "deepego: train by the Doppler loss alone, which needs no labels and no true motion"
    train.add_argument("--doppler-loss-only", action="store_true", help=alone)
    train.add_argument(
        "--resume",
        "--folder",
        dest="folder",
        type=Path,
        metavar="DIR",
        help="folder of checkpoint and log; goes on from its checkpoint (runs/NETWORK-CONFIG)",
    )
    begin = "begin with the weights of another run: its folder, a file of export --weights, or a model with its card"
    train.add_argument("--start-from", type=Path, metavar="DIR|F.pt|F.onnx", help=begin)
    train.add_argument("--minutes", type=float, help="stop this run after so long")
    train.add_argument(
        "--total-minutes",
        type=float,
        help="length of the schedule over all runs, on a CPU in processor time of a thread (as --minutes)",
    )
    train.add_argument("--steps", type=int, help="length of the schedule in steps instead")
    train.add_argument("--batch", type=int, help="examples a step, of all processes together")
    train.add_argument("--learning-rate", type=float)
    train.add_argument("--warmup-steps", type=int, default=200)
    train.add_argument("--ema", type=float, default=0.999)
    train.add_argument("--seed", type=int, default=0)
    train.add_argument("--device", default="cuda" if torch.cuda.is_available() else "cpu")
    train.add_argument("--threads", type=int, help="threads on the CPU")
    train.add_argument("--bfloat16", action=argparse.BooleanOptionalAction, help="default: on a GPU")
    train.add_argument("--compile", action=argparse.BooleanOptionalAction, help="default: on a GPU")
    graph = "aaetr: draw arrays in advance and run each step as a CUDA graph; default: on one GPU"
    train.add_argument("--graph", action=argparse.BooleanOptionalAction, help=graph)
    train.add_argument("--evaluate-minutes", type=float, default=5.0)
    train.add_argument("--evaluate-count", type=int, default=250)
    train.add_argument("--checkpoint-minutes", type=float, default=2.0)
    train.add_argument("--log-seconds", type=float, default=10.0)

    evaluate = commands.add_parser("evaluate", help="score the network of a training folder")
    evaluate.add_argument("folder", type=Path)
    evaluate.add_argument("--count", type=int, default=4000, help="examples a condition")
    evaluate.add_argument("--test", type=Path, metavar="DIR", help=scored)

    write = commands.add_parser("export", help="write the network of a training folder as ONNX, with its card")
    write.add_argument("folder", type=Path, help="folder of a training, or a file of export --weights")
    write.add_argument("out", type=Path, metavar="F.onnx")
    write.add_argument("--precision", choices=export.STORED_AS, default="single", help="of large weights")
    write.add_argument("--count", type=int, default=4000, help="examples a condition for the card's metrics")
    beside = "show the learning curve of another run on the card, too; may be given several times"
    write.add_argument("--beside", type=Path, action="append", default=[], metavar="DIR", help=beside)
    write.add_argument("--golden", type=Path, metavar="DIR", help="write a golden batch to a folder in there")
    write.add_argument("--test", type=Path, metavar="DIR", help=scored)
    write.add_argument("--weights", type=Path, metavar="F.pt", help="write what another run can start from")
    return top


def train(arguments) -> list[dict]:
    """Trains as the arguments say; final scores."""
    a = arguments
    if a.threads:
        torch.set_num_threads(a.threads)
    identity = {"name": a.network, "config": a.config, "targets": a.targets, "position_error": a.position_error}
    if a.arrays != "lrr48":
        identity["arrays"] = a.arrays
    if a.setup != "simulated":
        identity["setup"] = a.setup
    if a.near != NEAR:
        identity["near"] = a.near
    if a.snr_db is not None:
        identity["snr_db"] = a.snr_db
    if a.channel_error is not None:
        identity["channel_error"] = a.channel_error
    for name in ("weaker_db", "moving", "second_stage_only", "matched_last", "close_pairs"):
        if value := getattr(a, name):
            identity[name] = value
    if a.data:
        identity["data"] = Dataset(a.data).told()
    if a.doppler_loss_only:
        identity["doppler_loss_only"] = True
    places = {"folders": a.data, "test": a.test} if a.data else {}
    if a.single is not None:
        places["weights"] = smoother_task.single(a.single)
        identity["single_digest"] = smoother_task.digest(places["weights"])
    what = task(**identity, **places)
    group = processes.start(a.device)
    on_gpu = group.device.type == "cuda"
    graph = on_gpu and group.count == 1 and a.network in ("aaetr", "learned-pursuit") if a.graph is None else a.graph
    settings = Settings(
        batch=a.batch or what.batch,
        learning_rate=a.learning_rate or what.learning_rate,
        steps=a.steps,
        minutes=a.minutes,
        total_minutes=a.total_minutes or (None if a.steps else a.minutes),
        warmup_steps=a.warmup_steps,
        ema=a.ema,
        seed=a.seed,
        bfloat16=on_gpu if a.bfloat16 is None else a.bfloat16,
        # Compiling takes minutes for the many numbers of elements of arrays of any kind.
        compile=on_gpu and a.arrays != "any" if a.compile is None else a.compile,
        graph=graph,
        log_seconds=a.log_seconds,
        checkpoint_seconds=60 * a.checkpoint_minutes,
        evaluate_seconds=60 * a.evaluate_minutes,
        evaluate_count=a.evaluate_count,
    )
    folder = a.folder or Path("runs") / f"{a.network}-{a.config}"
    try:
        return Training(what, settings, folder, identity, group, a.start_from).run()
    finally:
        processes.end()


def evaluate(arguments) -> list[dict]:
    """Scores of a training folder."""
    _, what, network = export.restore(arguments.folder, **({"test": arguments.test} if arguments.test else {}))
    with torch.no_grad():
        return what.evaluate(network, arguments.count, torch.Generator().manual_seed(30_000))


def main() -> int:
    """Runs the command."""
    arguments = parser().parse_args()
    try:
        if arguments.command == "train":
            result = train(arguments)
        elif arguments.command == "evaluate":
            result = evaluate(arguments)
        else:
            a = arguments
            beside = tuple(a.beside)
            result = export.export(a.folder, a.out, a.precision, a.count, a.golden, a.weights, beside, a.test)
    except (ValueError, FileNotFoundError) as error:
        print(f"boresight_training: {error}", file=sys.stderr)
        return 2
    if result:
        print(json.dumps(result, indent=2))
    return 0


if __name__ == "__main__":
    sys.exit(main())
