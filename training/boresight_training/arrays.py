"""Antenna arrays: positions of the virtual elements in half wavelengths, x forward, y left, z up."""

import torch

LRR48_TX = (0, 18, 30, 42, 62, 78)
LRR48_RX = (0, 3, 4, 5, 7, 8, 13, 14)
LRR48_APERTURE = 92.0


def along_y(ys) -> torch.Tensor:
    """Positions [elements, 3] of elements in a row."""
    positions = torch.zeros(len(ys), 3, dtype=torch.float64)
    positions[:, 1] = torch.tensor(ys, dtype=torch.float64)
    return positions


def array(name: str) -> torch.Tensor:
    """Positions [elements, 3] of `lrr48` and `awr1642` (transmitter-major) or `ulaN`."""
    if name == "lrr48":
        return along_y([tx + rx for tx in LRR48_TX for rx in LRR48_RX])
    if name == "awr1642":
        return along_y([-k for k in range(8)])
    if name.startswith("ula") and name[3:].isdigit() and int(name[3:]) > 0:
        return along_y(range(int(name[3:])))
    raise ValueError(f"array {name!r}: expected lrr48, awr1642 or ulaN")


def steering(positions: torch.Tensor, u: torch.Tensor) -> torch.Tensor:
    """Response `exp(j pi p . d)` of each element to waves in the horizontal plane.

    `positions` [..., elements, 3] and `u` [..., waves], the sine of the azimuth, of the same leading shape or one
    that broadcasts; the result is [..., waves, elements] in the complex type of their precision.
    """
    forward = (1 - u * u).clamp_min(0).sqrt()
    phase = torch.pi * (
        u.unsqueeze(-1) * positions[..., 1].unsqueeze(-2) + forward.unsqueeze(-1) * positions[..., 0].unsqueeze(-2)
    )
    return torch.polar(torch.ones_like(phase), phase)
