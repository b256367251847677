"""Checkpoints: one file, replaced in one step, from which training goes on as if it had not stopped."""

import os
from pathlib import Path

import torch

NAME = "checkpoint.pt"


def save(folder: Path, state: dict) -> None:
    """Writes the state beside the last one, then puts it in its place."""
    folder.mkdir(parents=True, exist_ok=True)
    temporary = folder / f"{NAME}.{os.getpid()}.new"
    with open(temporary, "wb") as file:
        torch.save(state, file)
        file.flush()
        os.fsync(file.fileno())
    os.replace(temporary, folder / NAME)


def weights(state: dict) -> dict:
    """What another run can start from: the averaged weights in half precision, and where they are from."""
    told = ("identity", "settings", "hardware", "step", "samples", "seconds", "legs")
    half = {name: value.half() if value.is_floating_point() else value for name, value in state["ema"].items()}
    return {name: state[name] for name in told} | {"ema": half}


def load(path: Path) -> dict | None:
    """The state last saved in a folder, or in a file of weights, on the CPU; `None` where there is none."""
    path = Path(path) if Path(path).is_file() else Path(path) / NAME
    return torch.load(path, map_location="cpu", weights_only=True) if path.exists() else None
