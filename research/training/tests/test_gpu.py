"""The kernel of the GPU, run on the processor, against SciPy's assignment; steps of the GPU without a graph."""

import ctypes
import json
import shutil
import subprocess

import pytest
import torch
from scipy.optimize import linear_sum_assignment

from boresight_training import checkpoint
from boresight_training.gpu import assignment
from boresight_training.processes import Processes
from boresight_training.tasks import task
from boresight_training.train import Settings, Training

COMPILER = shutil.which("cc")


@pytest.fixture(scope="module")
def kernel(tmp_path_factory):
    """The kernel compiled for the processor, as a function of costs and numbers of rows."""
    if COMPILER is None:
        pytest.skip("no C compiler to compile the kernel for the processor")
    library = tmp_path_factory.mktemp("kernel") / "assignment.so"
    shim = assignment.SOURCE.parents[2] / "tests" / "warp_on_host.h"
    source = ("-include", shim, "-x", "c", assignment.SOURCE)
    subprocess.run([COMPILER, "-O1", "-shared", "-fPIC", *source, "-o", library], check=True)
    run = ctypes.CDLL(str(library)).assign_on_host

    def assign(cost, rows):
        batch, most, columns = cost.shape
        cost, rows = cost.float().contiguous(), rows.long().contiguous()
        columns_of = torch.full((batch, most), -2)
        pointers = (ctypes.c_void_p(x.data_ptr()) for x in (cost, rows, columns_of))
        run(*pointers, batch, most, columns)
        return columns_of

    return assign


@pytest.mark.parametrize("most,columns,coarse", [(16, 16, False), (16, 96, False), (32, 128, True), (3, 40, True)])
def test_the_kernel_finds_what_scipy_finds(kernel, most, columns, coarse):
    generator = torch.Generator().manual_seed(columns)
    cost = torch.randn(100, most, columns, generator=generator)
    cost[:50] += 3 * torch.randn(50, 1, columns, generator=generator)  # all rows want the same columns
    if coarse:
        cost = cost.round()  # ties
    rows = torch.randint(0, most + 1, (100,), generator=generator)
    rows[:2] = torch.tensor([0, most])
    for problem, count, columns_of in zip(cost, rows.tolist(), kernel(cost, rows), strict=True):
        chosen = columns_of[:count]
        assert len(set(chosen.tolist())) == count and (chosen >= 0).all() and (columns_of[count:] == -1).all()
        expected = problem[:count][linear_sum_assignment(problem[:count].numpy())].sum()
        assert abs(problem[torch.arange(count), chosen].sum() - expected) < 1e-4


def test_problems_too_large_for_a_warp_are_refused():
    with pytest.raises(ValueError, match="33 rows and 40 columns: expected at most 32 and 128"):
        assignment.assign(torch.zeros(1, 33, 40), torch.ones(1))


@pytest.mark.parametrize("arrays", ["lrr48", "any"])
def test_steps_of_the_gpu_learn_and_resume_exactly(tmp_path, arrays):
    """Without a graph, on the processor."""

    def training(folder, stop_at_step=None):
        what = task("aaetr", "steered-attention-tiny", arrays=arrays, close_pairs=0.5)
        plan = Settings(
            8, 5e-3, steps=24, stop_at_step=stop_at_step, warmup_steps=5, log_seconds=0, evaluate_count=4, graph=True
        )
        identity = {"name": "aaetr", "config": "steered-attention-tiny", "arrays": arrays}
        return Training(what, plan, folder, identity, Processes(0, 1, torch.device("cpu")))

    training(tmp_path / "whole").run()
    for stop in (9, None):
        training(tmp_path / "parts", stop).run()
    whole, parts = (checkpoint.load(tmp_path / name) for name in ("whole", "parts"))
    assert whole["step"] == parts["step"] == 24 and whole["samples"] == 24 * 8
    for part in ("model", "ema"):
        assert all(torch.equal(whole[part][name], parts[part][name]) for name in whole[part])
    log = [json.loads(line) for line in (tmp_path / "whole" / "log.jsonl").read_text().splitlines()]
    losses = [entry["loss"] for entry in log if "loss" in entry]
    assert sum(losses[-8:]) < 0.9 * sum(losses[:8])
    # The averaged weights follow.
    moved = [(whole["ema"][name] - value).abs().max() for name, value in whole["model"].items()]
    assert 0 < max(moved) < 1


@pytest.mark.skipif(not torch.cuda.is_available(), reason="no GPU")
@pytest.mark.parametrize("arrays", ["lrr48", "any"])
def test_graphs_do_what_steps_without_them_do(arrays):
    trained = []
    for graphed in (True, False):
        what = task("aaetr", "steered-attention-tiny", arrays=arrays, close_pairs=0.5)
        plan = Settings(16, 1e-3, steps=20, graph=True)
        run = Training(what, plan, "unused", {}, Processes(0, 1, torch.device("cuda")))
        run.steps.graphed = graphed
        losses = torch.stack([run._step()["loss"].clone() for _ in range(20)])
        trained.append(losses)
    assert torch.allclose(*trained, rtol=1e-2)
