"""Networks: the papers' sizes, symmetries, and exported files that give the same numbers."""

import numpy as np
import onnx
import onnxruntime
import pytest
import torch
from onnx import numpy_helper

from boresight_training import export
from boresight_training.aaetr import CONFIGS, Aaetr
from boresight_training.arrays import LRR48_APERTURE, array
from boresight_training.classifiers import counting, folded, fully_connected
from boresight_training.deviations import fitted, with_one
from boresight_training.snapshots import Scenes, snapshots
from boresight_training.tasks import task

EVERY = [
    ("aaetr", "tiny", None),
    ("learned-pursuit", "small", None),
    ("aaetr", "paper", None),
    ("aaetr", "steered-attention-tiny", None),
    ("counting", "paper", None),
    ("cnn3d", "small", 1),
    ("cnn3d", "paper", 2),
    ("dnn", "small", 1),
    ("dnn", "large", 2),
    ("unrolled-iaa", "tiny", None),
    ("unrolled-iaa", "small", None),
    ("covariance-cnn", "small", None),
    ("deep-music", "small", None),
]
# What tract-onnx takes, as far as our graphs need it.
OPERATORS = {
    "Add",
    "Cast",
    "Clip",
    "Concat",
    "Constant",
    "ConstantOfShape",
    "Conv",
    "Cos",
    "Div",
    "Equal",
    "Exp",
    "Expand",
    "Flatten",
    "Gather",
    "Gemm",
    "Identity",
    "Log",
    "MatMul",
    "MaxPool",
    "Mul",
    "Neg",
    "Pow",
    "Reciprocal",
    "ReduceMax",
    "ReduceMean",
    "ReduceMin",
    "ReduceSum",
    "Relu",
    "Reshape",
    "Shape",
    "Sigmoid",
    "Sin",
    "Slice",
    "Softmax",
    "Split",
    "Sqrt",
    "Squeeze",
    "Sub",
    "Tanh",
    "Transpose",
    "Unsqueeze",
    "Where",
}


def parameters(network):
    return sum(p.numel() for p in network.parameters())


def test_the_papers_sizes():
    assert parameters(Aaetr(CONFIGS["paper"])) == 1_611_779
    linear = [m for m in counting() if isinstance(m, torch.nn.Linear)]
    assert [(m.in_features, m.out_features) for m in linear] == [(56, 1024), *3 * [(1024, 1024)], (1024, 3)]
    features = task("cnn3d", "paper").model().features
    x = torch.zeros(1, 3, 65, 8, 4)
    sizes = [tuple((x := layer(x)).shape[1:]) for layer in features]
    assert sizes == [*2 * [(256, 36, 4, 2)], *2 * [(256, 35, 3, 1)], (256, 18, 2, 1)]
    assert abs(parameters(task("dnn", "small").model()) / 0.135e6 - 1) < 0.01
    assert abs(parameters(task("dnn", "large").model()) / 11e6 - 1) < 0.01


@pytest.mark.parametrize("config", ["tiny", "paper", "steered-attention-tiny"])
def test_magnitudes_follow_the_snapshots_scale(config):
    torch.manual_seed(0)
    network = task("aaetr", config).model().eval()
    values = torch.view_as_real(snapshots(Scenes(), array("lrr48"), 4, torch.Generator().manual_seed(1))[1])
    positions = array("lrr48").float()
    with torch.no_grad():
        difference = network(1000 * values, positions) - network(values, positions)
    difference[..., 1] -= 60
    assert difference.abs().max() < 2e-3
    assert network(torch.zeros_like(values), positions).isfinite().all()


def test_steered_attention_takes_any_array_and_turns_with_it():
    torch.manual_seed(0)
    network = task("aaetr", "steered-attention-tiny").model().eval()
    generator = torch.Generator().manual_seed(4)
    for name in ("ula8", "lrr48", "ula86"):
        positions = array(name)
        _, values, _ = snapshots(Scenes(targets=(2, 2)), positions, 3, generator)
        with torch.no_grad():
            answer = network(torch.view_as_real(values), positions.float())
            # Where the array's origin is, and in which order its elements come, is nothing to the scene.
            order = torch.randperm(len(positions), generator=generator)
            moved = network(torch.view_as_real(values[:, order]), (positions[order] + torch.tensor([0, 7, 0])).float())
        assert answer.shape == (2, 3, 48, 5) and answer.isfinite().all()
        assert (answer - moved).abs().max() < 1e-2, name


def test_what_is_exported_for_any_array_takes_any_number_of_elements(tmp_path):
    torch.manual_seed(0)
    what = task("aaetr", "steered-attention-tiny", arrays="any")
    model = what.model().eval()
    form = export.exported_form(what, model, "single", 0.1 * torch.randn(2, model.config.width + 1))
    export.to_onnx(what, form, tmp_path / "any.onnx")
    session = onnxruntime.InferenceSession(tmp_path / "any.onnx", providers=["CPUExecutionProvider"])
    generator = torch.Generator().manual_seed(4)
    for name in ("ula8", "lrr48", "ula86"):
        positions = array(name)
        _, values, _ = snapshots(Scenes(targets=(2, 2)), positions, 3, generator)
        example = torch.view_as_real(values), positions.float()
        given = {port.name: part.numpy() for port, part in zip(what.inputs, example, strict=True)}
        with torch.no_grad():
            expected = form(*example)
        (answer,) = (torch.from_numpy(part) for part in session.run(None, given))
        assert answer.shape == (3, 48, 5) and (answer - expected).abs().max() < 1e-4, name


def test_stated_deviations_are_fitted_to_the_errors():
    torch.manual_seed(0)
    what = task("aaetr", "steered-attention-tiny", targets=1, snr_db=(30.0, 40.0))
    network = what.model().eval()
    # A network that answers where its anchors are: errors of tenths of a cell, and deviations of one.
    with torch.no_grad():
        network.head.bias[2] = 5.0
        network.head.weight.zero_()
    rows = what.deviations(network, 1000, torch.Generator().manual_seed(3))
    stated, unchanged = (what.export_form(network, given) for given in (rows, None))
    assert network.head.weight.abs().max() == 0
    errors = []
    for seed in range(4, 20):
        targets, values, positions = what.draw(250, 1.0, torch.Generator().manual_seed(seed))
        with torch.no_grad():
            answer, before = (form(values, positions) for form in (stated, unchanged))
        assert torch.equal(answer[..., :3], before[..., :3])
        off = (answer[..., :1] - targets.u.unsqueeze(1)).abs().masked_fill(~targets.valid.unsqueeze(1), torch.inf)
        right = (off[..., 0] <= 0.4 * 2 / LRR48_APERTURE) & (answer[..., 2] > 0.5)
        db = 20 * answer[..., 1].log10() - targets.db
        errors.append(torch.stack((off[..., 0], db.abs()), -1)[right] / answer[right][:, 3:])
    errors = torch.cat(errors)
    # Some 700 right predictions on either side: the difference of two shares deviates by 0.025.
    assert len(errors) > 500 and ((errors <= 1).double().mean(0) - 0.6827).abs().max() < 0.075


def test_small_deviations_are_fitted_apart_from_large_ones():
    generator = torch.Generator().manual_seed(5)
    features = torch.randn(20_000, 3, generator=generator)
    truth = torch.tensor([[0.5, -1.0, 0.0, -2.0], [0.0, 0.3, 0.8, 1.0]])
    deviations = (with_one(features) @ truth.T).exp()
    errors = deviations * torch.randn(20_000, 2, generator=generator).abs()
    rows = fitted(torch.zeros(2, 4), features, errors)
    assert (rows - truth).abs().max() < 0.05
    ratios = errors / (with_one(features.double()) @ rows.T).exp()
    for output in range(2):
        order = deviations[:, output].argsort()
        for part in order.tensor_split(4):
            # 5,000 errors: a share deviates by 0.007 and 0.003.
            one, two = ((ratios[part, output] <= times).double().mean() for times in (1, 2))
            assert abs(one - 0.6827) < 0.03 and abs(two - 0.9545) < 0.015


def test_the_steered_form_ignores_the_phase_of_the_whole():
    torch.manual_seed(0)
    network = Aaetr(CONFIGS["small"]).eval()
    values = snapshots(Scenes(), array("lrr48"), 4, torch.Generator().manual_seed(2))[1]
    positions = array("lrr48").float()
    turned = values * torch.polar(torch.tensor(1.0), torch.tensor(2.1))
    with torch.no_grad():
        first, second = (network(torch.view_as_real(v), positions) for v in (values, turned))
    assert (first - second).abs().max() < 1e-2  # dB; rounding, magnified over six layers


def test_positions_may_differ_from_snapshot_to_snapshot():
    torch.manual_seed(0)
    for config in ("tiny", "paper", "steered-attention-tiny"):
        network = task("aaetr", config).model().eval()
        scenes = Scenes(position_error=0.1)
        _, values, positions = snapshots(scenes, array("lrr48"), 3, torch.Generator().manual_seed(3))
        values, positions = torch.view_as_real(values), positions.float()
        with torch.no_grad():
            together = network(values, positions)
            alone = torch.cat([network(values[k : k + 1], positions[k]) for k in range(3)], 1)
        assert (together - alone).abs().max() < 1e-3


@pytest.mark.parametrize("config", ["paper", "small"])
def test_the_3d_cnn_trains_on_the_convolutions_that_it_answers_with(config):
    torch.manual_seed(5)
    network = task("cnn3d", config).model()
    region = torch.randn(3, 65, 8, 4, 3)
    answers, gradients = [], []
    for training in (True, False):
        network.train(training).zero_grad()
        answers.append(network(region))
        answers[-1].logsumexp(1).sum().backward()
        gradients.append([p.grad.clone() for p in network.parameters()])
    # Single precision, sums of up to 2,048 terms of order 0.1.
    torch.testing.assert_close(*answers, atol=2e-6, rtol=1e-5)
    for quick, plain in zip(*gradients, strict=True):
        torch.testing.assert_close(quick, plain, atol=2e-5 * float(plain.abs().max()), rtol=1e-4)


def test_batch_normalisation_folds_away():
    torch.manual_seed(0)
    network = fully_connected([5, 7, 3])
    for _ in range(20):
        network(torch.randn(32, 5) * 3 + 1)
    network.eval()
    plain = folded(network)
    assert all(not isinstance(layer, torch.nn.BatchNorm1d) for layer in plain)
    x = torch.randn(9, 5)
    assert (plain(x) - network(x)).abs().max() < 1e-5


@pytest.mark.parametrize("name,config,targets", EVERY)
def test_exports_equal_pytorch_with_common_operators(tmp_path, name, config, targets):
    torch.manual_seed(0)
    what = task(name, config, targets)
    path = tmp_path / "model.onnx"
    assert export.to_onnx(what, export.exported_form(what, what.model().eval(), False), path) < 1e-4
    model = onnx.load(path)
    assert {node.op_type for node in model.graph.node} <= OPERATORS
    for ports, values in ((what.inputs, model.graph.input), (what.outputs, model.graph.output)):
        for port, value in zip(ports, values, strict=True):
            axes = [d.dim_param or d.dim_value for d in value.type.tensor_type.shape.dim]
            assert (port.name, list(port.axes)) == (value.name, axes)


def test_weights_are_rounded_to_the_precision_asked_for(tmp_path):
    torch.manual_seed(0)
    what = task("dnn", "small", 1)
    network = what.model().eval()
    sizes, largest = {}, {}
    for precision in export.STORED_AS:
        path = tmp_path / f"{precision}.onnx"
        export.to_onnx(what, export.exported_form(what, network, precision), path, precision)
        weights = [numpy_helper.to_array(weight) for weight in onnx.load(path).graph.initializer]
        sizes[precision], largest[precision] = path.stat().st_size, max(weights, key=lambda weight: weight.size)
    assert max(sizes["half"], sizes["bfloat16"]) < 0.52 * sizes["single"]
    single, half, short = (largest[precision].astype(np.float32) for precision in export.STORED_AS)
    normal = np.abs(single) > 2.0**-14
    assert np.abs(half / single - 1)[normal].max() <= 2.0**-11
    assert np.abs(short / single - 1)[normal].max() <= 2.0**-8
    assert not np.any(short.view(np.uint32) & 0xFFFF)


def test_an_export_that_differs_is_refused(tmp_path, monkeypatch):
    what = task("dnn", "small", 1)
    monkeypatch.setattr(export, "PARITY", 0.0)
    monkeypatch.setattr(export, "_difference", lambda *_: 1e-3)
    with pytest.raises(ValueError, match="differs from PyTorch"):
        export.to_onnx(what, export.exported_form(what, what.model().eval(), False), tmp_path / "model.onnx")


def test_a_threshold_lies_between_right_and_wrong(monkeypatch):
    what = task("dnn", "small", 1)
    answer = torch.tensor([[3.0, -1.0, -2.0], [-4.0, -2.0, 2.0]])
    monkeypatch.setattr(what, "_answers", lambda *_: (answer, (answer > 0).float()))
    assert what.confidence(None, 1, None) == pytest.approx(torch.tensor(0.5).sigmoid().item())


def test_unknown_sizes_are_refused_by_name():
    with pytest.raises(ValueError, match="'huge' of dnn: expected small, large"):
        task("dnn", "huge")
