"""The 3D-CNN of Sang et al. (2021): a region of range bins, antennas and chirps to directions.

It answers with logits; an exported model answers with probabilities. It has none of the paper's dropout.
"""

from dataclasses import dataclass
from math import ceil, pi

import torch
from torch import nn
from torch.nn import functional

from .regions import CLASSES, LENGTH


@dataclass(frozen=True)
class Cnn3dConfig:
    """Sizes of a 3D-CNN."""

    filters: int = 256
    range_kernel: int = 30
    """Extent of the first convolution in range."""
    bins: int = LENGTH
    """Range bins it sees, in the middle of the region."""


CNN3D = {
    "paper": Cnn3dConfig(),
    # A target fills two bins, and two targets of Table 3 are at most 20 apart.
    "small": Cnn3dConfig(filters=64, range_kernel=5, bins=43),
}


class Cnn3d(nn.Module):
    """Table 2: a region [batch, 65, 8, 4, 3] to directions.

    The pooling rounds up, for the paper's sizes fit in no other way.
    """

    def __init__(self, config: Cnn3dConfig):
        super().__init__()
        self.bins, filters = config.bins, config.filters
        self.features = nn.Sequential(
            nn.Conv3d(3, filters, (config.range_kernel, 5, 3)),
            nn.ReLU(),
            nn.Conv3d(filters, filters, (2, 2, 2)),
            nn.ReLU(),
            nn.MaxPool3d((2, 2, 2), ceil_mode=True),
        )
        pooled = ceil((config.bins - config.range_kernel) / 2)
        self.classify = nn.Sequential(
            nn.Linear(filters * pooled * 2, 500),
            nn.ReLU(),
            nn.Linear(500, 200),
            nn.ReLU(),
            nn.Linear(200, 100),
            nn.ReLU(),
            nn.Linear(100, CLASSES),
        )
        self._begin_with_beams(pooled)

    def forward(self, region):
        largest = region[..., 0].amax((1, 2, 3)).clamp_min(1e-30)
        skip = (LENGTH - self.bins) // 2
        x = (region / largest.view(-1, 1, 1, 1, 1))[:, skip : skip + self.bins].permute(0, 4, 1, 2, 3)
        features = self._features_by_matrices if self.training and x.device.type == "cpu" else self.features
        return self.classify(features(x).flatten(1))

    def _features_by_matrices(self, x):
        """`features`, some 2.5 times as fast on a CPU."""
        first, _, second, _, pool = self.features
        filtered = functional.relu(correlate_along_range(x, first.weight, first.bias))
        return pool(functional.relu(correlate_by_taps(filtered, second.weight, second.bias)).permute(1, 4, 0, 2, 3))

    @torch.no_grad()
    def _begin_with_beams(self, pooled: int) -> None:
        """Weights to begin with: three quarters of the first filters are beams, the rest small.

        Beams have three phases each, so that after the rectifier their sum is close to the magnitude. The second
        convolution mixes magnitudes, and the first linear layer takes them from all of the region alike.
        """
        first, second, linear = self.features[0], self.features[2], self.classify[0]
        filters, phases = first.out_channels, 3
        directions = filters // 4
        element = torch.arange(5.0) - 2
        sine = torch.linspace(-0.5, 0.5, directions)
        phase = pi * element * sine[:, None, None]
        phase = (phase + 2 * pi / phases * torch.arange(phases)[:, None]).flatten(0, 1)
        beams = len(phase)
        first.weight[:beams] *= 0.1
        middle = first.weight[:beams, :, first.kernel_size[0] // 2]
        # The real part of what the conjugate response receives, over 5 elements and 3 chirps.
        middle[:, 1] += phase.cos().unsqueeze(-1) / 15
        middle[:, 2] += phase.sin().unsqueeze(-1) / 15
        first.bias.zero_()
        mix = torch.randn(filters, directions).div(4 * directions**0.5).repeat_interleave(phases, 1)
        second.weight *= 0.3
        second.weight[:, :beams] += mix[..., None, None, None]
        alike = torch.randn(linear.out_features, filters, 1) * (2 / pooled * (2 / filters) ** 0.5)
        linear.weight.mul_(0.3).view(linear.out_features, filters, -1).add_(alike)


def correlate_along_range(x, weight, bias):
    """`conv3d` for a long kernel in range, by the spectra of data and kernel over the range bins.

    From [batch, channels, range, antennas, chirps] to [range, batch, antennas, chirps, filters]. What wraps round in
    the product of spectra lies beyond the bins that a kernel wholly inside the data answers for.
    """
    batch, channels, bins, _, _ = x.shape
    filters, _, kernel, height, width = weight.shape
    to_spectrum, to_range = _spectrum_matrices(bins, bins - kernel + 1)
    patches = x.unfold(3, height, 1).unfold(4, width, 1)
    rows, columns = patches.shape[3:5]
    taps = channels * height * width
    patches = patches.permute(2, 0, 3, 4, 1, 5, 6).reshape(bins, -1)
    data = (to_spectrum.flatten(0, 1) @ patches).view(2, -1, batch * rows * columns, taps)
    taps_of_bins = weight.permute(2, 1, 3, 4, 0).reshape(kernel, -1)
    real, imaginary = (to_spectrum[..., :kernel].flatten(0, 1) @ taps_of_bins).view(2, -1, taps, filters)
    data = torch.cat(tuple(data), 2)
    # The product with the conjugate of the kernel's spectrum.
    products = (torch.cat((real, imaginary), 1), torch.cat((-imaginary, real), 1))
    out = sum(part @ torch.bmm(data, product).flatten(1) for part, product in zip(to_range, products, strict=True))
    return out.view(-1, batch, rows, columns, filters) + bias


def correlate_by_taps(x, weight, bias):
    """`conv3d` as one product of matrices for each tap, [range, batch, antennas, chirps, channels] to the same."""
    bins = x.shape[0] - weight.shape[2] + 1
    shape = (bins, x.shape[1], x.shape[2] - weight.shape[3] + 1, x.shape[3] - weight.shape[4] + 1, weight.shape[0])
    out = 0
    for row in range(weight.shape[3]):
        for column in range(weight.shape[4]):
            part = x[:, :, row : row + shape[2], column : column + shape[3]].reshape(x.shape[0], -1, x.shape[4])
            for tap in range(weight.shape[2]):
                out = out + part[tap : tap + bins] @ weight[:, :, tap, row, column].T
    return out.view(shape) + bias


def _spectrum_matrices(length: int, kept: int) -> tuple[torch.Tensor, torch.Tensor]:
    """Real and imaginary part of the discrete Fourier transform, and of its inverse to the first `kept` samples."""
    frequency = torch.arange(length // 2 + 1, dtype=torch.float64)
    sample = torch.arange(length, dtype=torch.float64)
    angle = 2 * pi / length * frequency[:, None] * sample
    share = torch.full_like(frequency, 2 / length)
    share[0] = 1 / length
    if length % 2 == 0:
        share[-1] = 1 / length
    forward = torch.stack((angle.cos(), -angle.sin()))
    back = (share[:, None] * forward).mT[:, :kept]
    return forward.float(), back.float()
