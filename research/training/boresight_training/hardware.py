"""What a network is trained on, and the time that training takes there."""

import time
from collections.abc import Callable
from pathlib import Path

import torch


def describe(device: torch.device, processes: int) -> str:
    """Processor or GPU, and how many of it."""
    if device.type == "cuda":
        return f"{processes} x {torch.cuda.get_device_name(device)}"
    info = Path("/proc/cpuinfo")
    lines = info.read_text().splitlines() if info.exists() else []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    threads = torch.get_num_threads()
    return f"{processes} x {names[0] if names else 'CPU'}, {threads} thread{'s' if threads > 1 else ''}"


def clock(device: torch.device) -> Callable[[], float]:
    """Seconds of training: on a CPU processor time of a thread, on a GPU elapsed time."""
    if device.type == "cuda":
        return time.monotonic
    threads = torch.get_num_threads()
    return lambda: time.process_time() / threads
