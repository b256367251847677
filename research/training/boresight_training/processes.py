"""One process, or several under torchrun."""

import gc
import os
from dataclasses import dataclass

import torch
from torch import distributed


@dataclass(frozen=True)
class Processes:
    """Which of how many this is, and where it computes."""

    rank: int
    count: int
    device: torch.device

    @property
    def first(self) -> bool:
        """Whether this one writes."""
        return self.rank == 0

    def agree(self, value: float) -> float:
        """The largest of all processes' values: what all act upon."""
        if self.count == 1:
            return value
        shared = torch.tensor(value, dtype=torch.float64, device=self.device)
        distributed.all_reduce(shared, distributed.ReduceOp.MAX)
        return shared.item()

    def wait(self) -> None:
        """Until all are here."""
        self.agree(0.0)


def start(device: str) -> Processes:
    """Joins the other processes if torchrun started this one."""
    count = int(os.environ.get("WORLD_SIZE", "1"))
    rank = int(os.environ.get("RANK", "0"))
    kind = torch.device(device)
    if kind.type == "cuda":
        kind = torch.device("cuda", int(os.environ.get("LOCAL_RANK", "0")))
        torch.cuda.set_device(kind)
    if count > 1:
        distributed.init_process_group("nccl" if kind.type == "cuda" else "gloo")
    return Processes(rank, count, kind)


def end() -> None:
    """Leaves the other processes."""
    if distributed.is_initialized():
        # What DistributedDataParallel leaves in cycles still holds the group, whose threads must end before the
        # interpreter.
        gc.collect()
        distributed.destroy_process_group()
