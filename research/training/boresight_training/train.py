"""The training loop: data drawn as it is needed, a schedule over steps or over time, and a stop at any moment."""

import json
import signal
import time
from contextlib import nullcontext
from dataclasses import asdict, dataclass
from math import cos, pi
from pathlib import Path

import torch
from torch import nn
from torch.nn.parallel import DistributedDataParallel

from . import checkpoint, hardware, published
from .gpu.steps import GraphSteps
from .processes import Processes
from .tasks import Task


@dataclass(frozen=True)
class Settings:
    """How to train. The schedule runs over `steps`, or else over `total_minutes` of training, however often resumed.

    A minute of training is one by `hardware.clock`: a busy machine makes a run longer, and not worse.
    """

    batch: int
    """Examples a step, of all processes together."""
    learning_rate: float
    steps: int | None = None
    total_minutes: float | None = None
    minutes: float | None = None
    """This run stops after so long by the clock on the wall."""
    stop_at_step: int | None = None
    """This run stops there, wherever the schedule ends."""
    warmup_steps: int = 200
    weight_decay: float = 1e-2
    clip: float = 1.0
    ema: float = 0.999
    seed: int = 0
    bfloat16: bool = False
    compile: bool = False
    graph: bool = False
    """Whether steps are CUDA graphs (`gpu.steps`); on a CPU the same steps run without."""
    log_seconds: float = 10.0
    checkpoint_seconds: float = 120.0
    evaluate_seconds: float = 300.0
    evaluate_count: int = 250

    def __post_init__(self):
        if self.steps is None and self.total_minutes is None:
            raise ValueError("the schedule needs a length: steps or total_minutes")


class Training:
    """A network being trained; `run` goes on from the checkpoint in `folder` where there is one."""

    def __init__(
        self,
        task: Task,
        settings: Settings,
        folder: Path,
        identity: dict,
        processes: Processes,
        start_from: Path | None = None,
    ):
        self.task, self.settings, self.folder, self.processes = task, settings, Path(folder), processes
        self.identity = identity
        """Which network this is; a checkpoint of another one is refused."""
        torch.manual_seed(settings.seed)
        self.network = task.model().to(processes.device)
        self.ema = task.model().to(processes.device).requires_grad_(False)
        self.ema.load_state_dict(self.network.state_dict())
        self.optimizer = torch.optim.AdamW(
            _groups(self.network, settings.weight_decay),
            lr=0.0,
            betas=(0.9, 0.98),
            fused=True,
            capturable=settings.graph and processes.device.type == "cuda",
        )
        self.generator = torch.Generator(device=processes.device)
        self.step, self.samples, self.seconds = 0, 0, 0.0
        self.legs: list[dict] = []
        """The runs that this one started from, first to last: of each what `leg` tells."""
        self.stop_requested = False
        saved = checkpoint.load(self.folder)
        if saved is not None:
            self._restore(saved)
        elif start_from is not None:
            self._start_from(Path(start_from))
        model: nn.Module = self.network
        if settings.compile:
            model = torch.compile(model)
        self.model = DistributedDataParallel(model) if processes.count > 1 else model
        self.steps = None
        if settings.graph:
            if processes.count > 1:
                raise ValueError(f"steps as graphs in {processes.count} processes: expected one")
            self.steps = GraphSteps(task, model, self.ema, self.optimizer, settings, self.generator)

    def run(self) -> list[dict[str, float]]:
        """Trains until the schedule ends, the time is up or a signal comes; scores of the averaged weights."""
        s = self.settings
        handlers = {number: signal.signal(number, self._request_stop) for number in (signal.SIGTERM, signal.SIGINT)}
        start = time.monotonic()
        clock = hardware.clock(self.processes.device)
        last = clock()
        due = {"log": s.log_seconds, "checkpoint": s.checkpoint_seconds, "evaluate": s.evaluate_seconds}
        sums: dict[str, torch.Tensor] = {}
        counted = logged_samples = 0
        logged_at = start
        try:
            while not self._finished(time.monotonic() - start):
                for name, value in self._step().items():
                    sums[name] = sums.get(name, 0) + value
                counted += 1
                trained = clock()
                self.seconds += trained - last
                last = trained
                now = time.monotonic()
                elapsed = now - start
                if elapsed >= due["log"]:
                    due["log"] = elapsed + s.log_seconds
                    rate = (self.samples - logged_samples) / (now - logged_at) if logged_samples else 0.0
                    self._log({k: float(v) / counted for k, v in sums.items()} | {"samples_per_second": rate})
                    sums, counted, logged_samples, logged_at = {}, 0, self.samples, now
                if self.processes.first and elapsed >= due["evaluate"]:
                    due["evaluate"] = elapsed + s.evaluate_seconds
                    self._log({"scores": self.evaluate()})
                if elapsed >= due["checkpoint"]:
                    due["checkpoint"] = elapsed + s.checkpoint_seconds
                    self.save()
            self.save()
            scores = self.evaluate() if self.processes.first else []
            self._log({"scores": scores, "stopped": True})
            self.processes.wait()
        finally:
            for number, handler in handlers.items():
                signal.signal(number, handler)
        return scores

    def progress(self) -> float:
        """How far through the schedule, from 0 to 1."""
        s = self.settings
        done = self.step / s.steps if s.steps is not None else self.seconds / (60 * s.total_minutes)
        return min(1.0, done)

    def evaluate(self, count: int | None = None) -> list[dict[str, float]]:
        """Scores of the averaged weights on fixed examples."""
        generator = torch.Generator(device=self.processes.device).manual_seed(20_000)
        self.ema.eval()
        with torch.no_grad(), self._autocast():
            return self.task.evaluate(self.ema, count or self.settings.evaluate_count, generator)

    def leg(self) -> dict:
        """What this run is and has taken so far."""
        return {
            "identity": self.identity,
            "settings": asdict(self.settings),
            "hardware": hardware.describe(self.processes.device, self.processes.count),
            "step": self.step,
            "samples": self.samples,
            "seconds": self.seconds,
        }

    def save(self) -> None:
        """Writes a checkpoint."""
        if self.processes.first:
            checkpoint.save(
                self.folder,
                {
                    **self.leg(),
                    "legs": self.legs,
                    "model": self.network.state_dict(),
                    "ema": self.ema.state_dict(),
                    "optimizer": self.optimizer.state_dict(),
                },
            )

    def _restore(self, saved: dict) -> None:
        if saved["identity"] != self.identity:
            raise ValueError(f"{self.folder} holds {saved['identity']}, not {self.identity}")
        self.network.load_state_dict(saved["model"])
        self.ema.load_state_dict(saved["ema"])
        self.optimizer.load_state_dict(saved["optimizer"])
        self.step, self.samples, self.seconds = saved["step"], saved["samples"], saved["seconds"]
        self.legs = saved["legs"]

    def _start_from(self, folder: Path) -> None:
        """Takes the averaged weights of another run of the same network: its folder, a file of weights or a model.

        Everything else begins anew.
        """
        is_published = folder.suffix == ".onnx"
        saved = published.load(folder) if is_published else checkpoint.load(folder)
        if saved is None:
            raise FileNotFoundError(f"{folder} holds no {checkpoint.NAME}")
        same = ("name", "config")
        if any(saved["identity"][k] != self.identity[k] for k in same):
            raise ValueError(f"{folder} holds {saved['identity']}, not {self.identity}")
        self.legs = saved["legs"] if is_published else [*saved["legs"], {name: saved[name] for name in self.leg()}]
        if any(leg["settings"]["seed"] == self.settings.seed for leg in self.legs):
            raise ValueError(
                f"seed {self.settings.seed}: {folder} was trained with it, and the same batches would come again; "
                "expected another"
            )
        self.network.load_state_dict(saved["ema"])
        self.ema.load_state_dict(saved["ema"])

    def _finished(self, elapsed: float) -> bool:
        s = self.settings
        ended = self.progress() >= 1 or self.stop_requested
        ended |= s.stop_at_step is not None and self.step >= s.stop_at_step
        ended |= s.minutes is not None and elapsed >= 60 * s.minutes
        return self.processes.agree(float(ended)) > 0

    def _step(self) -> dict[str, torch.Tensor]:
        s = self.settings
        progress = self.processes.agree(self.progress())
        warmup = min(1.0, (self.step + 1) / s.warmup_steps)
        rate = s.learning_rate * warmup * (0.01 + 0.99 * 0.5 * (1 + cos(pi * progress)))
        # Data depend on seed, process and step alone, so that a resumed run sees what it would have seen.
        seed = (s.seed * 1_000_003 + self.step) * 4096 + self.processes.rank + 1
        if self.steps is not None:
            self.network.train()
            told = self.steps.run(self.step, seed, rate, self._decay(self.step + 1), progress)
            self.step += 1
            self.samples += s.batch
            return told
        for group in self.optimizer.param_groups:
            group["lr"] = rate
        self.generator.manual_seed(seed)
        data = self.task.draw(s.batch // self.processes.count, progress, self.generator)
        self.network.train()
        with self._autocast():
            loss, parts = self.task.loss(self.model, data)
        self.optimizer.zero_grad(set_to_none=True)
        loss.backward()
        norm = nn.utils.clip_grad_norm_(self.network.parameters(), s.clip)
        self.optimizer.step()
        self.step += 1
        self.samples += s.batch
        self._average()
        return {"loss": loss.detach(), "gradient": norm, **parts}

    def _decay(self, step: int) -> float:
        """How much of the averaged weights a step leaves, less at first."""
        return min(self.settings.ema, (1 + step) / (10 + step))

    @torch.no_grad()
    def _average(self) -> None:
        """Moves the averaged weights."""
        decay = self._decay(self.step)
        averaged, current = self.ema.state_dict(), self.network.state_dict()
        floats = [name for name, value in current.items() if value.is_floating_point()]
        torch._foreach_lerp_([averaged[n] for n in floats], [current[n] for n in floats], 1 - decay)
        for name in current.keys() - floats:
            averaged[name].copy_(current[name])

    def _autocast(self):
        on = self.settings.bfloat16
        return torch.autocast(self.processes.device.type, torch.bfloat16) if on else nullcontext()

    def _request_stop(self, *_):
        self.stop_requested = True

    def _log(self, entry: dict) -> None:
        if not self.processes.first:
            return
        at = {"step": self.step, "samples": self.samples, "seconds": round(self.seconds, 1)}
        at["learning_rate"] = float(self.optimizer.param_groups[0]["lr"])
        self.folder.mkdir(parents=True, exist_ok=True)
        with open(self.folder / "log.jsonl", "a") as file:
            file.write(json.dumps(at | entry) + "\n")


def _groups(model: nn.Module, decay: float) -> list[dict]:
    """Weight decay for matrices only."""
    matrices = [p for p in model.parameters() if p.ndim > 1]
    others = [p for p in model.parameters() if p.ndim <= 1]
    return [{"params": matrices, "weight_decay": decay}, {"params": others, "weight_decay": 0.0}]
