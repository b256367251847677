"""What a network was trained on, for its card."""

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
