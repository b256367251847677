"""The networks of Sang et al. (2021): the counting network, the 3D-CNN, and the DNN it is compared with.

All answer with logits; exported models answer with probabilities. None has the paper's dropout.
"""

from dataclasses import dataclass
from itertools import pairwise
from math import ceil

import torch
from torch import nn

from .regions import CLASSES, LENGTH

COVARIANCE_FEATURES = 56


def fully_connected(sizes: list[int]) -> nn.Sequential:
    """Linear layers with batch normalisation, rectifiers between."""
    layers = []
    for inputs, outputs in pairwise(sizes):
        layers += [nn.Linear(inputs, outputs), nn.BatchNorm1d(outputs), nn.ReLU()]
    return nn.Sequential(*layers[:-1])


def counting(hidden: int = 1024) -> nn.Sequential:
    """Table 1: covariance to the number of targets, 0, 1 or 2."""
    return fully_connected([COVARIANCE_FEATURES, hidden, hidden, hidden, hidden, 3])


def dnn(hidden: int) -> nn.Sequential:
    """Covariance to directions: three hidden layers, after Chen, Gong and Mao (2020), whose sizes are ours."""
    return fully_connected([COVARIANCE_FEATURES, hidden, hidden, hidden, CLASSES])


DNN_HIDDEN = {"small": 239, "large": 2320}


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
        return self.classify(self.features(x).flatten(1))

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
        phase = torch.pi * element * sine[:, None, None]
        phase = (phase + 2 * torch.pi / phases * torch.arange(phases)[:, None]).flatten(0, 1)
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


def folded(network: nn.Sequential) -> nn.Sequential:
    """The same function in linear layers alone, for batch normalisation in its evaluation mode."""
    layers = []
    for layer in network:
        if isinstance(layer, nn.BatchNorm1d):
            before = layers.pop()
            gain = layer.weight / (layer.running_var + layer.eps).sqrt()
            linear = nn.Linear(before.in_features, before.out_features)
            with torch.no_grad():
                linear.weight.copy_(before.weight * gain.unsqueeze(1))
                linear.bias.copy_((before.bias - layer.running_mean) * gain + layer.bias)
            layers.append(linear)
        else:
            layers.append(layer)
    return nn.Sequential(*layers)
