"""Trained networks as ONNX files with their cards."""

import hashlib
import json
import platform
import re
import shutil
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import onnx
import onnxruntime
import torch
from onnx import TensorProto, helper, numpy_helper

from . import checkpoint
from .classifiers import folded
from .learning import learning_curve
from .tasks import Task, task

OPSET = 16
STORED_AS = {"single": "float32", "half": "float16", "bfloat16": "float16 of 8 significant bits"}
"""Precisions of weights, and how the file has them. Half precision is what every runtime reads; our module reads large
layers of 8 significant bits in half the time."""
ROUNDED_FROM = 256
"""Smaller weights stay in single precision."""
SHAPING = (
    "batch",
    "learning_rate",
    "steps",
    "total_minutes",
    "warmup_steps",
    "weight_decay",
    "clip",
    "ema",
    "seed",
    "bfloat16",
)
"""Settings of training that bear on its result."""
PARITY = 1e-4
"""Largest difference of the exported model from PyTorch, relative to the largest output of its kind or 1."""
GOLDEN_BATCH = 4
SEEDS = {"example": 7, "metrics": 30_000, "confidence": 40_000, "deviations": 50_000}
"""Seeds of data that no training sees, each for one use."""


def restore(folder: Path, **places: Path) -> tuple[dict, Task, torch.nn.Module]:
    """Checkpoint, task and averaged network of a training folder or a file of weights.

    `places` are those of stored data.
    """
    saved = checkpoint.load(folder)
    if saved is None:
        raise FileNotFoundError(f"{folder} holds no {checkpoint.NAME}")
    what = task(**saved["identity"], **places)
    network = what.model()
    network.load_state_dict(saved["ema"])
    return saved, what, network.eval()


def exported_form(what: Task, network: torch.nn.Module, precision: str, deviations: Any = None) -> torch.nn.Module:
    """What is exported, in PyTorch, with its weights rounded to a precision in place."""
    form = what.export_form(network, deviations).eval()
    with torch.no_grad():
        for value in form.parameters():
            if precision != "single" and value.numel() >= ROUNDED_FROM:
                rounded = value.bfloat16() if precision == "bfloat16" else value
                value.copy_(rounded.half())
    return form


def to_onnx(what: Task, form: torch.nn.Module, path: Path, precision: str = "single") -> float:
    """Writes the exported form and returns its largest difference from PyTorch.

    Weights that are not of single precision are stored in half precision and widened when the model loads; `form` has
    them rounded, so that the difference speaks of the export alone.
    """
    generator = torch.Generator().manual_seed(SEEDS["example"])
    example = what.example(3, generator)
    free = {
        port.name: {axis: name for axis, name in enumerate(port.axes) if isinstance(name, str)}
        for port in (*what.inputs, *what.outputs)
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        torch.onnx.export(
            form,
            example,
            str(path),
            dynamo=False,
            opset_version=OPSET,
            input_names=[port.name for port in what.inputs],
            output_names=[port.name for port in what.outputs],
            dynamic_axes={name: axes for name, axes in free.items() if axes},
        )
    model = onnx.load(path)
    for port, value in zip(what.outputs, model.graph.output, strict=True):
        for axis, dimension in zip(port.axes, value.type.tensor_type.shape.dim, strict=True):
            if isinstance(axis, int):
                dimension.dim_value = axis
    if precision != "single":
        _store_half(model.graph)
    onnx.checker.check_model(model, full_check=True)
    onnx.save(model, path)
    difference = max(_difference(what, form, path, batch, generator) for batch in (1, 5))
    if not difference <= PARITY:
        raise ValueError(f"{path} differs from PyTorch by {difference:.2g}, more than {PARITY}")
    return difference


def _difference(what, form, path, batch, generator) -> float:
    example = what.example(batch, generator)
    session = onnxruntime.InferenceSession(path, providers=["CPUExecutionProvider"])
    names = [port.name for port in what.inputs]
    all_given = session.run(None, {name: x.numpy() for name, x in zip(names, example, strict=True)})
    differences = []
    for given, value in zip(all_given, _answers(form, example), strict=True):
        expected, kinds = value.numpy(), tuple(range(given.ndim - 1))
        off = np.abs(given - expected).max(kinds) / np.maximum(1.0, np.abs(expected).max(kinds))
        differences.append(float(off.max()))
    return max(differences)


def _answers(form, example) -> tuple[torch.Tensor, ...]:
    """What PyTorch answers, one tensor for each output."""
    with torch.no_grad():
        answer = form(*example)
    return answer if isinstance(answer, tuple) else (answer,)


def _store_half(graph) -> None:
    """Stores large weights in half precision, each followed by a cast."""
    casts = []
    for weight in graph.initializer:
        values = numpy_helper.to_array(weight)
        if values.dtype == np.float32 and values.size >= ROUNDED_FROM:
            name = weight.name
            weight.CopyFrom(numpy_helper.from_array(values.astype(np.float16), f"{name}_half"))
            casts.append(helper.make_node("Cast", [f"{name}_half"], [name], to=TensorProto.FLOAT))
    for cast in reversed(casts):
        graph.node.insert(0, cast)


def golden(what: Task, form: torch.nn.Module, folder: Path) -> None:
    """Writes a batch of inputs, and what PyTorch answers to it, as .npy files named as the ports are."""
    folder.mkdir(parents=True, exist_ok=True)
    batch = getattr(what, "golden_batch", GOLDEN_BATCH)
    example = what.example(batch, torch.Generator().manual_seed(SEEDS["example"]))
    for port, value in zip((*what.inputs, *what.outputs), (*example, *_answers(form, example)), strict=True):
        np.save(folder / f"{port.name}.npy", value.numpy())


def export(
    folder: Path,
    path: Path,
    precision: str = "single",
    count: int = 4000,
    golden_in: Path | None = None,
    weights: Path | None = None,
    beside: tuple[Path, ...] = (),
    test: Path | None = None,
) -> dict:
    """Writes the network of a training folder or a file of weights to `path`, its card beside it, and returns the card.

    With `golden_in` a golden batch is written to a folder there of the model's name, with `weights` a file that another
    run can start from. The card has the learning curve of the folder, and of those `beside`. `test` holds stored data
    to score on. Networks with a form for our module have that written, too, under the same name and into the golden
    folder, where the card stands beside.
    """
    saved, what, network = restore(folder, **({} if test is None else {"test": test}))
    parameters = sum(p.numel() for p in network.parameters())
    if isinstance(network, torch.nn.Sequential):
        # The metrics below are then those of the rounded weights.
        network = folded(network)
    if weights is not None:
        torch.save(checkpoint.weights(saved), weights)
    path.parent.mkdir(parents=True, exist_ok=True)
    deviations = what.deviations(network, count, torch.Generator().manual_seed(SEEDS["deviations"]))
    form = exported_form(what, network, precision, deviations)
    difference = to_onnx(what, form, path, precision)
    own = what.write(form, path, None if precision == "single" else ROUNDED_FROM) if hasattr(what, "write") else {}
    if golden_in is not None:
        golden(what, form, golden_in / path.stem)
        if own:
            shutil.copy(path.with_suffix(".bin"), golden_in / path.stem / "weights.bin")
    with torch.no_grad():
        metrics = what.evaluate(network, count, torch.Generator().manual_seed(SEEDS["metrics"]))
        confidence = what.confidence(network, count, torch.Generator().manual_seed(SEEDS["confidence"]))
    # A file of weights has no log.
    runs = [one for one in (folder, *beside) if one.is_dir()]
    curves = [curve for one in runs if (curve := learning_curve(one)) is not None]
    identity, legs = saved["identity"], [*saved["legs"], saved]
    card = {
        "name": path.stem,
        "title": what.title,
        "reference": what.reference,
        "architecture": what.architecture,
        "differences": what.differences,
        **({"limits": limits} if (limits := getattr(what, "limits", "")) else {}),
        "network": identity["name"],
        "form": identity["config"],
        **({} if confidence is None else {"confidence": round(confidence, 3)}),
        **({"deviation_factors": [round(f, 4) for f in deviations]} if isinstance(deviations, list) else {}),
        "inputs": _ports(what.inputs),
        "outputs": _ports(what.outputs),
        "parameters": parameters,
        **what.describe(),
        "legs": [_leg(leg) for leg in legs],
        "samplesSeen": sum(leg["samples"] for leg in legs),
        "hours": round(sum(leg["seconds"] for leg in legs) / 3600, 3),
        "software": f"PyTorch {torch.__version__.split('+')[0]}, Python {platform.python_version()}",
        "metrics": [{name: _rounded(value) for name, value in condition.items()} for condition in metrics],
        "metricsExamples": count,
        **({"learning": curves} if curves else {}),
        **own,
        "onnx": {"opset": OPSET, "weights": STORED_AS[precision], "parity": difference},
        "bytes": path.stat().st_size,
        "sha256": hashlib.sha256(path.read_bytes()).hexdigest(),
    }
    card = _camel_case(card)
    text = json.dumps(card, indent=2) + "\n"
    path.with_suffix(".json").write_text(text)
    if golden_in is not None and own:
        (golden_in / path.stem / "card.json").write_text(text)
    return card


def _rounded(value):
    return round(value, 5) if isinstance(value, float) else value


def _leg(leg: dict) -> dict:
    """One run of training: its data, its settings, and what it took."""
    if "card" in leg:
        return leg["card"]
    what = task(**leg["identity"])
    return {
        "title": what.title,
        "data": what.describe()["data"],
        "training": {name: leg["settings"][name] for name in SHAPING},
        "steps": leg["step"],
        "samplesSeen": leg["samples"],
        "hours": round(leg["seconds"] / 3600, 3),
        "hardware": leg["hardware"],
    }


def _camel_case(value):
    """The same with keys as JavaScript and Rust's files have them."""
    if isinstance(value, list):
        return [_camel_case(item) for item in value]
    if not isinstance(value, dict):
        return value
    return {re.sub(r"_([a-z0-9])", lambda m: m[1].upper(), key): _camel_case(item) for key, item in value.items()}


def _ports(ports) -> list[dict]:
    return [{"name": p.name, "axes": list(p.axes), "meaning": p.meaning} for p in ports]
