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
    """Positions [elements, 3] of `lrr48` and `awr1642` (transmitter-major), `cascade86` (by place) or `ulaN`."""
    if name == "lrr48":
        return along_y([tx + rx for tx in LRR48_TX for rx in LRR48_RX])
    if name == "awr1642":
        return along_y([-k for k in range(8)])
    if name == "cascade86":
        return along_y([k - 85 for k in range(86)])
    if name.startswith("ula") and name[3:].isdigit() and int(name[3:]) > 0:
        return along_y(range(int(name[3:])))
    raise ValueError(f"array {name!r}: expected lrr48, awr1642, cascade86 or ulaN")


ELEMENTS = (8, 86)
"""Fewest and most elements of random arrays."""
_KINDS = ("uniform", "mimo", "thinned", "scattered")


def random_arrays(batch: int, generator: torch.Generator) -> torch.Tensor:
    """Different arrays of one number of elements, [batch, elements, 3], each about its own origin.

    They are rows of elements half a wavelength apart or nearly so, sparse MIMO arrays, rows with elements missing, and
    elements scattered at random, 0.5 half wavelengths apart or more. Elements of half of the arrays are then displaced
    in each direction, with a standard deviation of up to 0.05 half wavelengths.
    """
    return placed(random_rows(batch, _whole(*ELEMENTS, generator), generator), generator)


def random_rows(batch: int, elements: int, generator: torch.Generator) -> torch.Tensor:
    """Places along y of the elements of different arrays, [batch, elements], each about its mean."""
    kinds = torch.randint(0, len(_KINDS), (batch,), generator=generator, device=generator.device).tolist()
    rows = torch.stack([_row(_KINDS[kind], elements, generator) for kind in kinds])
    return rows - rows.mean(-1, keepdim=True)


def placed(rows: torch.Tensor, generator: torch.Generator) -> torch.Tensor:
    """Positions [batch, elements, 3] of rows, half of them mirrored and half of them displaced."""
    batch, elements = rows.shape
    turned = torch.where(torch.rand(batch, 1, generator=generator, device=generator.device) < 0.5, -1.0, 1.0)
    positions = torch.zeros(batch, elements, 3, dtype=torch.float64, device=generator.device)
    positions[..., 1] = rows * turned
    displaced = torch.rand(batch, 1, 1, generator=generator, device=generator.device, dtype=torch.float64) - 0.5
    errors = torch.randn(positions.shape, generator=generator, device=generator.device, dtype=torch.float64)
    return positions + 0.1 * displaced.clamp_min(0) * errors


def _row(kind: str, elements: int, generator: torch.Generator) -> torch.Tensor:
    """Places of the elements of an array in a row, half wavelengths."""
    if kind == "uniform":
        return torch.arange(elements, device=generator.device).double() * _number(0.9, 1.1, generator)
    if kind == "scattered":
        gaps = torch.rand(elements, generator=generator, device=generator.device, dtype=torch.float64)
        return (0.5 + gaps * _number(0.5, 2.0, generator)).cumsum(0)
    places = _mimo(elements, generator) if kind == "mimo" else None
    if places is None:
        most = max(elements, round(elements * _number(1.0, 2.2, generator)))
        places = torch.randperm(most, generator=generator, device=generator.device)[:elements]
    places = places.sort().values.double()
    # No row without a gap: uniform arrays of half a wavelength are what networks are scored on.
    places[-1] += places[-1] - places[0] == elements - 1
    return places


def _mimo(elements: int, generator: torch.Generator) -> torch.Tensor | None:
    """Sums of transmitters' and receivers' places, of which some may be missing; none where they are too few."""
    receivers = _whole(3, min(16, elements // 2), generator)
    transmitters = -(-elements // receivers)
    span = receivers + _whole(0, receivers, generator)
    near = torch.randperm(span, generator=generator, device=generator.device)[:receivers]
    steps = torch.randint(receivers, span + 1, (transmitters,), generator=generator, device=generator.device)
    sums = (near.unsqueeze(0) + (steps.cumsum(0) - steps[0]).unsqueeze(1)).unique()
    if len(sums) < elements:
        return None
    return sums[torch.randperm(len(sums), generator=generator, device=generator.device)[:elements]]


def _whole(low: int, high: int, generator: torch.Generator) -> int:
    return int(torch.randint(low, high + 1, (), generator=generator, device=generator.device))


def _number(low: float, high: float, generator: torch.Generator) -> float:
    return low + (high - low) * float(torch.rand((), generator=generator, device=generator.device))


def resolution(positions: torch.Tensor) -> torch.Tensor:
    """Rayleigh's resolution in the sine of the azimuth, from the extent along y: [1], or [batch, 1] for many arrays."""
    left = positions[..., 1]
    extent = left.amax(-1, keepdim=True) - left.amin(-1, keepdim=True)
    return 2 / extent.clamp_min(1.0)


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
