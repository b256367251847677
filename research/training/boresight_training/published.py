"""Weights of an exported model, to start another run from."""

import json
from pathlib import Path

import onnx
import torch
from onnx import numpy_helper


def load(path: Path) -> dict:
    """Averaged weights of a model and the runs that its card tells of, as a checkpoint has them.

    Models whose batch normalisation was folded into other layers cannot be started from.
    """
    card = json.loads(path.with_suffix(".json").read_text())
    legs = [
        {
            "card": leg,
            "settings": {"seed": leg["training"]["seed"]},
            "samples": leg["samplesSeen"],
            "seconds": 3600 * leg["hours"],
        }
        for leg in card["legs"]
    ]
    weights = {
        # The exported form holds the network as its first part.
        initializer.name.removesuffix("_half").removeprefix("0."): torch.from_numpy(
            numpy_helper.to_array(initializer).copy()
        ).float()
        for initializer in onnx.load(path).graph.initializer
    }
    return {"identity": {"name": card["network"], "config": card["form"]}, "legs": legs, "ema": weights}
