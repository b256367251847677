"""Regions of interest of FMCW data cubes, and their covariances, as the networks of Sang et al. (2021) take them.

A sample at time `t` after the start of its ramp is `alpha exp(j 2 pi (2 R(t) / c) (f_0 + S t))` (equation 9), with the
range `R` at that very moment; element `k` adds the phase `pi p_k . d`.
"""

from dataclasses import dataclass, replace
from math import radians

import torch

from .arrays import array, steering
from .snapshots import complex_normal, uniform

SPEED_OF_LIGHT = 299_792_458.0
LENGTH, CHIRPS = 65, 4
"""Range bins and chirps of a region."""
CLASSES = 21
"""Directions from -10 to 10 degrees in whole degrees."""


@dataclass(frozen=True)
class Waveform:
    """Timing and frequency plan of a frame, as `boresight` has it."""

    start_frequency_hz: float
    slope_hz_per_s: float
    sample_rate_hz: float
    samples: int
    chirp_interval_s: float
    transmitters: int
    adc_start_s: float = 0.0
    loops: int = CHIRPS

    @property
    def bin_m(self) -> float:
        """Width of a range bin."""
        return SPEED_OF_LIGHT * self.sample_rate_hz / (2 * self.slope_hz_per_s * self.samples)


WAVEFORMS = {
    "3dcnn-simulated": Waveform(77e9, 3.476e12, 256 * 3.476e12 / 0.15e9, 256, 50e-6, 1),
    "3dcnn-experiment": Waveform(77e9, 4.2e12, 512 * 4.2e12 / 3.5e9, 512, 850e-6, 2),
}


@dataclass(frozen=True)
class Reflectors:
    """Targets of a batch of cubes, each [batch, most]; where `valid` is false there is none."""

    range_m: torch.Tensor
    rate_mps: torch.Tensor
    azimuth: torch.Tensor
    """rad"""
    phase: torch.Tensor
    db: torch.Tensor
    """Power over that of the first, dB."""
    valid: torch.Tensor


@dataclass(frozen=True)
class Cubes:
    """How cubes are drawn (Tables 3 and 4); every quantity is uniform."""

    waveform: str = "3dcnn-simulated"
    targets: tuple[int, int] = (0, 2)
    range_m: tuple[float, float] = (70.0, 90.0)
    snr_db: tuple[float, float] = (0.0, 15.0)
    """Power of a target over the noise power, both of one raw sample."""
    shift_m: float = 0.0
    """Greatest shift in range by equation 10."""
    near: float = 0.0
    """Share of cubes whose targets all lie within a range bin of the first, the hard ones, in training alone."""
    second_db: tuple[float, float] = (0.0, 0.0)
    """Power of targets but the first over its power."""
    rate_mps: float = 0.0
    """Half of the targets approach or recede at up to this speed; the others stand still."""
    channel_db: float = 0.0
    """Deviation of an element's gain, in training alone; every cube has a board of its own."""
    channel_deg: float = 0.0
    """The same of its phase."""

    def elements(self) -> torch.Tensor:
        """Positions of the 8 virtual elements, transmitter-major."""
        return array("ula8" if WAVEFORMS[self.waveform].transmitters == 1 else "awr1642")


def draw_reflectors(cubes: Cubes, batch: int, generator: torch.Generator) -> Reflectors:
    """Random targets at distinct whole degrees; two of them at independent ranges."""
    fewest, most = cubes.targets
    device = generator.device
    count = torch.randint(fewest, most + 1, (batch, 1), generator=generator, device=device)
    degrees = torch.rand((batch, CLASSES), generator=generator, device=device).topk(most).indices - CLASSES // 2
    range_m = uniform((batch, most), *cubes.range_m, generator)
    if cubes.near > 0:
        bin_m = WAVEFORMS[cubes.waveform].bin_m
        beside = (range_m[:, :1] + uniform((batch, most - 1), -bin_m, bin_m, generator)).clamp(*cubes.range_m)
        near = uniform((batch, 1), 0.0, 1.0, generator) < cubes.near
        range_m[:, 1:] = torch.where(near, beside, range_m[:, 1:])
    phase = uniform((batch, most), 0.0, 2 * torch.pi, generator)
    db = torch.zeros(batch, most, dtype=torch.float64, device=device)
    rate_mps = torch.zeros_like(db)
    if cubes.second_db != (0, 0):
        db[:, 1:] = uniform((batch, most - 1), *cubes.second_db, generator)
    if cubes.rate_mps > 0:
        moves = uniform((batch, most), 0.0, 1.0, generator) < 0.5
        rate_mps = torch.where(moves, uniform((batch, most), -cubes.rate_mps, cubes.rate_mps, generator), 0.0)
    return Reflectors(
        range_m=range_m,
        rate_mps=rate_mps,
        azimuth=degrees.double() * radians(1),
        phase=phase,
        db=db,
        valid=torch.arange(most, device=device) < count,
    )


def tones(waveform: Waveform, reflectors: Reflectors) -> torch.Tensor:
    """What one element at the origin receives of each target, [batch, most, loops, transmitters, samples]."""
    w, device = waveform, reflectors.range_m.device
    fast = w.adc_start_s + torch.arange(w.samples, dtype=torch.float64, device=device) / w.sample_rate_hz
    chirps = torch.arange(w.loops * w.transmitters, dtype=torch.float64, device=device)
    time = (chirps * w.chirp_interval_s).view(w.loops, w.transmitters, 1) + fast

    def spread(x):
        return x[..., None, None, None]

    path = 2 * (spread(reflectors.range_m) + spread(reflectors.rate_mps) * time)
    turns = path / SPEED_OF_LIGHT * (w.start_frequency_hz + w.slope_hz_per_s * fast)
    phase = 2 * torch.pi * (turns - turns.floor()) + spread(reflectors.phase)
    return torch.polar(spread(amplitude(reflectors)).expand_as(phase), phase)


def amplitude(reflectors: Reflectors) -> torch.Tensor:
    """Of each target, 0 of what is none."""
    return reflectors.valid * 10 ** (reflectors.db / 20)


def shift(waveform: Waveform, shift_m: torch.Tensor) -> torch.Tensor:
    """Factor along the samples that moves everything by a range, [..., samples] (equation 10)."""
    w = waveform
    fast = w.adc_start_s + torch.arange(w.samples, dtype=torch.float64, device=shift_m.device) / w.sample_rate_hz
    turns = 2 * shift_m.unsqueeze(-1) / SPEED_OF_LIGHT * (w.start_frequency_hz + w.slope_hz_per_s * fast)
    return torch.polar(torch.ones_like(turns), 2 * torch.pi * (turns - turns.floor()))


def join(tones: torch.Tensor, waveform: Waveform, reflectors: Reflectors, positions: torch.Tensor) -> torch.Tensor:
    """Sums the targets over the array: [batch, loops, transmitters, receivers, samples]."""
    response = steering(positions, reflectors.azimuth.sin())
    response = response.unflatten(-1, (waveform.transmitters, -1))
    return torch.einsum("bmlts,bmtr->bltrs", tones, response.to(tones.dtype))


def range_spectra(
    waveform: Waveform, range_m: torch.Tensor, rate_mps: torch.Tensor, bins: torch.Tensor
) -> torch.Tensor:
    """Range spectra of targets of amplitude 1 at an element at the origin, [..., loops, transmitters, bins].

    The transform of a tone is Dirichlet's kernel around its frequency, which motion shifts by the Doppler frequency.
    What motion bends the phase within a ramp is left out.
    """
    w, device = waveform, range_m.device
    chirps = torch.arange(w.loops * w.transmitters, dtype=torch.float64, device=device)
    start = (chirps * w.chirp_interval_s).view(w.loops, w.transmitters) + w.adc_start_s
    range_m, rate_mps = range_m.double()[..., None, None], rate_mps.double()[..., None, None]
    sampled_hz = w.start_frequency_hz + w.slope_hz_per_s * w.adc_start_s
    range_m = range_m + rate_mps * start
    turns = 2 * range_m / SPEED_OF_LIGHT * sampled_hz
    beat_hz = 2 / SPEED_OF_LIGHT * (range_m * w.slope_hz_per_s + rate_mps * sampled_hz)
    distance = (beat_hz * w.samples / w.sample_rate_hz).unsqueeze(-1) - bins
    turns = (turns - turns.floor()).unsqueeze(-1) + distance * (0.5 * (w.samples - 1) / w.samples)
    below = w.samples * (torch.pi / w.samples * distance).sin()
    kernel = torch.where(below.abs() < 1e-6, 1.0, (torch.pi * distance).sin() / below).expand_as(turns)
    return torch.polar(kernel.float().abs(), (2 * torch.pi * turns + torch.pi * (kernel < 0)).float())


def regions(cubes: Cubes, batch: int, generator: torch.Generator):
    """Random regions of interest: targets, and range bins x elements x chirps, complex64, around the strongest bin.

    The range spectrum is scaled so that a tone in the middle of a bin keeps its amplitude. Only bins that a region
    can hold are simulated; those without targets have the noise of the whole spectrum, and bins wrap.
    """
    waveform, elements = WAVEFORMS[cubes.waveform], cubes.elements().to(generator.device)
    reflectors = draw_reflectors(cubes, batch, generator)
    range_m = reflectors.range_m
    if cubes.shift_m > 0:
        range_m = range_m + uniform((batch, 1), -cubes.shift_m, cubes.shift_m, generator)
    bin_m = waveform.bin_m
    nearest, farthest = cubes.range_m[0] - cubes.shift_m, cubes.range_m[1] + cubes.shift_m
    margin = LENGTH // 2 + 1
    bins = torch.arange(int(nearest / bin_m) - margin, int(farthest / bin_m) + 2 + margin, device=generator.device)
    # White noise stays white in the transform, at 1 / samples of its power.
    snr_db = uniform((batch, 1, 1, 1), *cubes.snr_db, generator, torch.float32)
    noise = (10 ** (-snr_db / 10) / waveform.samples).sqrt()
    response = steering(elements, reflectors.azimuth.sin()).to(torch.complex64)
    response = response * torch.polar(amplitude(reflectors), reflectors.phase).to(torch.complex64).unsqueeze(-1)
    response = response * channel_errors(cubes, batch, len(elements), generator)
    moves = cubes.rate_mps > 0
    # Chirps of what stands still are alike.
    timing = waveform if moves else replace(waveform, loops=1, transmitters=1)
    tone = range_spectra(timing, range_m, reflectors.rate_mps, bins)
    response = response.unflatten(-1, (timing.transmitters, -1))
    spectrum = torch.einsum("bmltn,bmtr->bntrl", tone, response).flatten(2, 3)
    spectrum = spectrum + noise * complex_normal((*spectrum.shape[:-1], CHIRPS), generator)
    power = torch.view_as_real(spectrum).square().sum((2, 3, 4))
    strongest = power[:, margin:-margin].argmax(1) + margin
    region = crop(spectrum, strongest)
    empty = torch.nonzero(~reflectors.valid.any(1)).flatten()
    if len(empty) > 0:
        spectrum = complex_normal((len(empty), waveform.samples, len(elements), CHIRPS), generator)
        power = torch.view_as_real(spectrum).square().sum((2, 3, 4))
        region[empty] = noise[empty] * crop(spectrum, power.argmax(1))
    return reflectors, region


def channel_errors(cubes: Cubes, batch: int, elements: int, generator: torch.Generator) -> torch.Tensor:
    """Factors of the elements of boards that are not calibrated, [batch, 1, elements]."""
    if cubes.channel_db == 0 and cubes.channel_deg == 0:
        return torch.ones(1, 1, 1, dtype=torch.complex64, device=generator.device)
    gain_db, phase_deg = torch.randn((2, batch, 1, elements), generator=generator, device=generator.device)
    return torch.polar(10 ** (cubes.channel_db / 20 * gain_db), radians(cubes.channel_deg) * phase_deg)


def crop(spectrum: torch.Tensor, centre: torch.Tensor) -> torch.Tensor:
    """LENGTH range bins around `centre` of [batch, bins, elements, chirps]; bins wrap."""
    index = (centre.unsqueeze(1) + torch.arange(LENGTH, device=centre.device) - LENGTH // 2) % spectrum.shape[1]
    return spectrum[torch.arange(len(centre), device=centre.device).unsqueeze(1), index]


def channels(region: torch.Tensor) -> torch.Tensor:
    """Magnitude, real and imaginary part on a last axis."""
    return torch.stack((region.abs(), region.real, region.imag), -1)


def covariance_features(region: torch.Tensor) -> torch.Tensor:
    """Upper triangle of the region's covariance over its largest entry (equation 8), [batch, 56]."""
    snapshots = region.transpose(1, 2).flatten(2)
    covariance = snapshots @ snapshots.mH
    largest = covariance.diagonal(dim1=1, dim2=2).real.amax(1).clamp_min(1e-30)
    row, column = torch.triu_indices(*covariance.shape[1:], offset=1, device=region.device)
    upper = covariance[:, row, column] / largest.unsqueeze(1)
    return torch.view_as_real(upper).flatten(1)


def labels(reflectors: Reflectors) -> torch.Tensor:
    """One or zero for each direction, [batch, CLASSES]."""
    index = reflectors.azimuth.rad2deg().round().long() + CLASSES // 2
    empty = torch.zeros(len(index), CLASSES, device=index.device)
    return empty.scatter_add(1, index, reflectors.valid.float()).clamp_max(1)
