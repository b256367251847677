"""Training steps that never wait for the host: data, forward and backward pass, matching, step and average are one CUDA
graph for each number of elements, replayed.

Arrays are drawn in advance, many for each number of elements, because drawing them takes decisions of the host. Without
a GPU the same steps run without a graph.
"""

import torch
from torch import nn

from ..arrays import placed, random_rows

SIZES = (8, 8, 10, 12, 14, 16, 18, 20, 22, 24, 28, 32, 36, 40, 44, 48, 52, 56, 60, 64, 70, 76, 82, 86)
"""Numbers of elements of arrays of any kind, equally often."""
ARRAYS = 1536
"""Arrays of each number of elements."""
AHEAD = 64
"""Steps that the host may be ahead of the GPU."""


class GraphSteps:
    """Steps of a task for snapshots of arrays, `tasks.AaetrTask`."""

    def __init__(self, task, model: nn.Module, ema: nn.Module, optimizer, settings, generator: torch.Generator):
        self.task, self.model, self.optimizer, self.settings = task, model, optimizer, settings
        self.generator = generator
        device = generator.device
        self.graphed = device.type == "cuda"
        self.parameters = [p for group in optimizer.param_groups for p in group["params"]]
        names = {id(p): name for name, p in model.named_parameters()}
        by_name = dict(ema.named_parameters())
        self.averaged = [by_name[names[id(p)].removeprefix("_orig_mod.")] for p in self.parameters]
        # What changes from step to step must be on the device for graphs to see it.
        self.rate, self.weight, self.close = (torch.zeros((), device=device) for _ in range(3))
        for group in optimizer.param_groups:
            group["lr"] = self.rate
        self.sizes = SIZES if task.any_array else (len(task.positions),)
        drawing = torch.Generator().manual_seed(settings.seed + 7)
        arrays = ARRAYS if self.graphed else 8
        self.rows = {
            size: random_rows(arrays, size, drawing).to(device) for size in sorted(set(self.sizes)) if task.any_array
        }
        self.positions = task.positions.to(device)
        self.graphs, self.results = {}, {}
        if self.graphed:
            self._capture()

    def run(self, step: int, seed: int, rate: float, decay: float, progress: float) -> dict[str, torch.Tensor]:
        """Runs one step and returns loss, gradient norm and parts of the loss, valid until the next step."""
        self.rate.fill_(rate)
        self.weight.fill_(1 - decay)
        self.close.fill_(self.task.close_share(progress))
        host = torch.Generator().manual_seed(seed)
        size = self.sizes[int(torch.randint(0, len(self.sizes), (), generator=host))]
        self.generator.manual_seed(seed)
        if not self.graphed:
            return self._step(size)
        self.graphs[size].replay()
        if step % AHEAD == 0:
            torch.cuda.synchronize()
        return self.results[size]

    def _step(self, size: int) -> dict[str, torch.Tensor]:
        s, generator = self.settings, self.generator
        positions = self.positions
        if self.rows:
            rows = self.rows[size]
            index = torch.randint(0, len(rows), (s.batch,), generator=generator, device=generator.device)
            positions = placed(rows[index], generator)
        data = self.task.draw_on(positions, s.batch, self.close, generator)
        # Without the cache of weights in half precision, which graphs cannot share.
        with torch.autocast(generator.device.type, torch.bfloat16, enabled=s.bfloat16, cache_enabled=False):
            loss, parts = self.task.loss(self.model, data)
        loss.backward()
        norm = nn.utils.clip_grad_norm_(self.parameters, s.clip, foreach=True)
        self.optimizer.step()
        with torch.no_grad():
            torch._foreach_lerp_(self.averaged, self.parameters, [self.weight] * len(self.parameters))
        for parameter in self.parameters:
            parameter.grad = None
        return {"loss": loss.detach(), "gradient": norm, **parts}

    def _capture(self) -> None:
        """Captures a graph for each number of elements, and leaves weights and moments as they were."""
        kept = [(t, t.clone()) for t in (*(p.data for p in self.parameters), *self.averaged)]
        moments = {p: {k: v.clone() for k, v in state.items()} for p, state in self.optimizer.state.items()}
        side = torch.cuda.Stream()
        side.wait_stream(torch.cuda.current_stream())
        with torch.cuda.stream(side):
            for size in sorted(set(self.sizes)):
                for _ in range(2):
                    self._step(size)
        torch.cuda.current_stream().wait_stream(side)
        torch.cuda.synchronize()
        pool = None
        for size in sorted(set(self.sizes)):
            graph = torch.cuda.CUDAGraph()
            graph.register_generator_state(self.generator)
            with torch.cuda.graph(graph, pool=pool):
                self.results[size] = self._step(size)
            pool = pool or graph.pool()
            self.graphs[size] = graph
        with torch.no_grad():
            for tensor, before in kept:
                tensor.copy_(before)
            for parameter, state in self.optimizer.state.items():
                for name, value in state.items():
                    before = moments.get(parameter, {}).get(name)
                    value.zero_() if before is None else value.copy_(before)
        torch.cuda.synchronize()
