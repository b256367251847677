"""Exact minimum-cost assignment on a GPU, by the kernel in assignment.cu."""

from functools import cache
from pathlib import Path

import torch

SOURCE = Path(__file__).with_name("assignment.cu")
MOST_ROWS, MOST_COLUMNS = 32, 128
"""What the kernel holds in a warp."""
WARPS = 4
"""Problems of a block."""


@cache
def _kernel():
    import cupy

    return cupy, cupy.RawKernel(SOURCE.read_text(), "assign_rows")


def assign(cost: torch.Tensor, rows: torch.Tensor) -> torch.Tensor:
    """As `matching.assign`, in single precision and without waiting for the GPU."""
    batch, most, columns = cost.shape
    if most > MOST_ROWS or columns > MOST_COLUMNS:
        raise ValueError(f"{most} rows and {columns} columns: expected at most {MOST_ROWS} and {MOST_COLUMNS}")
    cupy, kernel = _kernel()
    cost, rows = cost.float().contiguous(), rows.long().contiguous()
    columns_of = torch.empty(batch, most, dtype=torch.int64, device=cost.device)
    sizes = (cupy.int32(size) for size in (batch, most, columns))
    with cupy.cuda.ExternalStream(torch.cuda.current_stream(cost.device).cuda_stream):
        pointers = (cost.data_ptr(), rows.data_ptr(), columns_of.data_ptr())
        kernel((-(-batch // WARPS),), (32 * WARPS,), (*pointers, *sizes))
    return columns_of
