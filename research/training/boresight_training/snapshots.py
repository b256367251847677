"""Snapshots of an array with random targets: `y = sum_m alpha_m a(theta_m) + n` (equations 4 to 6 of AAETR's paper)."""

from dataclasses import dataclass
from math import log, radians, sin

import torch

from .arrays import resolution, steering


@dataclass(frozen=True)
class Targets:
    """Targets of a batch of scenes, each [batch, most]; where `valid` is false there is none."""

    azimuth: torch.Tensor
    """rad"""
    db: torch.Tensor
    """20 log10 of the amplitude"""
    phase: torch.Tensor
    """rad, at the array's origin"""
    valid: torch.Tensor

    @property
    def u(self) -> torch.Tensor:
        """Sine of the azimuth."""
        return self.azimuth.sin()

    @property
    def amplitude(self) -> torch.Tensor:
        """Complex amplitude, 0 where there is no target."""
        return torch.polar(torch.where(self.valid, 10 ** (self.db / 20), 0), self.phase)


@dataclass(frozen=True)
class Scenes:
    """How scenes are drawn; every quantity is uniform."""

    targets: tuple[int, int] = (0, 16)
    field_of_view_deg: float = 60.0
    db: tuple[float, float] = (-13.0, 0.0)
    snr_db: tuple[float, float] = (10.0, 40.0)
    """Power of a 0 dB target over the noise power, both at one element."""
    position_error: float = 0.0
    """Standard deviation of each coordinate of the elements, drawn anew for each scene; half wavelengths."""
    close_pairs: float | torch.Tensor = 0.0
    """Share of the scenes whose second target is CLOSE_CELLS from the first."""


CLOSE_CELLS = (0.2, 2.0)
"""Least and largest distance of close pairs, in cells of Rayleigh's resolution."""


def uniform(shape, low, high, generator, dtype=torch.float64):
    """Uniform numbers on the generator's device."""
    return torch.rand(shape, generator=generator, device=generator.device, dtype=dtype) * (high - low) + low


def complex_normal(shape, generator, dtype=torch.float32):
    """Circular complex normal numbers of power 1 on the generator's device."""
    parts = torch.randn((*shape, 2), generator=generator, device=generator.device, dtype=dtype)
    return torch.view_as_complex(parts * 0.5**0.5)


def draw_targets(scenes: Scenes, batch: int, generator: torch.Generator, cell: torch.Tensor | None = None) -> Targets:
    """Random targets of `batch` scenes. Close pairs need the array's resolution in sine, `cell` [1] or [batch, 1]."""
    fewest, most = scenes.targets
    count = torch.randint(fewest, most + 1, (batch, 1), generator=generator, device=generator.device)
    half = radians(scenes.field_of_view_deg)
    azimuth = uniform((batch, most), -half, half, generator)
    if cell is not None and most > 1:
        azimuth = _with_pairs(azimuth, scenes.close_pairs, cell.double(), half, generator)
    return Targets(
        azimuth=azimuth,
        db=uniform((batch, most), *scenes.db, generator),
        phase=uniform((batch, most), 0.0, 2 * torch.pi, generator),
        valid=torch.arange(most, device=generator.device) < count,
    )


def _with_pairs(azimuth, share, cell, half, generator):
    """Azimuths of which a share of the scenes has the second one beside the first."""
    batch = len(azimuth)
    apart = uniform((batch, 1), *CLOSE_CELLS, generator) * cell
    side = torch.where(uniform((batch, 1), 0.0, 1.0, generator) < 0.5, -1.0, 1.0)
    beside = (azimuth[:, :1].sin() + side * apart).clamp(-sin(half), sin(half)).asin()
    close = uniform((batch, 1), 0.0, 1.0, generator) < share
    return torch.cat((azimuth[:, :1], torch.where(close, beside, azimuth[:, 1:2]), azimuth[:, 2:]), 1)


def responses(targets: Targets, positions: torch.Tensor) -> torch.Tensor:
    """What the elements receive without noise, [batch, elements], in double precision."""
    waves = steering(positions.double(), targets.u.double())
    return (targets.amplitude.to(torch.complex128).unsqueeze(-1) * waves).sum(-2)


def snapshots(scenes: Scenes, positions: torch.Tensor, batch: int, generator: torch.Generator):
    """Random scenes: targets, snapshots (complex64, [batch, elements]) and the positions as simulated.

    With position errors those are [batch, elements, 3], else as given.
    """
    positions = positions.to(generator.device)
    # No random numbers are drawn for pairs where there are none.
    cell = resolution(positions) if isinstance(scenes.close_pairs, torch.Tensor) or scenes.close_pairs > 0 else None
    targets = draw_targets(scenes, batch, generator, cell)
    if scenes.position_error > 0:
        shape = (batch, *positions.shape)
        errors = torch.randn(shape, generator=generator, device=generator.device, dtype=torch.float64)
        positions = positions + scenes.position_error * errors
    values = responses(targets, positions).to(torch.complex64)
    noise = 10 ** (-uniform((batch, 1), *scenes.snr_db, generator, torch.float32) / 20)
    return targets, values + noise * complex_normal(values.shape, generator), positions


def covariances(
    scenes: Scenes, positions: torch.Tensor, batch: int, snapshots: tuple[int, int], generator: torch.Generator
):
    """Random scenes of uncorrelated targets: these, and sample covariances (complex64, [batch, elements, elements]).

    Numbers of snapshots are uniform in their logarithm, at least as many as elements. Covariances are drawn as such,
    from Wishart's distribution by Bartlett's decomposition.
    """
    targets = draw_targets(scenes, batch, generator)
    positions = positions.to(generator.device)
    waves = steering(positions.double(), targets.u)
    noise = 10 ** (-uniform((batch, 1, 1), *scenes.snr_db, generator) / 10)
    power = targets.amplitude.abs().square().unsqueeze(-1)
    elements = len(positions)
    exact = (waves * power).mT @ waves.conj() + noise * torch.eye(elements, device=generator.device)
    fewest, most = (log(count) for count in snapshots)
    count = uniform((batch, 1), fewest, most, generator).exp().round()
    degrees = count - torch.arange(elements, device=generator.device)
    # Of the standard gamma distribution by its generator on the CPU, which takes one.
    diagonal = torch._standard_gamma(degrees, generator=generator).sqrt()
    lower = complex_normal((batch, elements, elements), generator, torch.float64).tril(-1)
    factor = torch.linalg.cholesky(exact) @ (lower + torch.diag_embed(diagonal).to(lower.dtype))
    return targets, (factor @ factor.mH / count.unsqueeze(-1)).to(torch.complex64)
