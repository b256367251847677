"""Networks that see a covariance as an image of three channels: Papageorgiou's CNN, and DeepMUSIC.

Both answer over a grid of the sine of the azimuth: the CNN of Papageorgiou, Sellathurai and Eldar (2021) with the
probability of a source at each point, DeepMUSIC (Elbir 2020) with the spectrum that MUSIC would have of the exact
covariance, by a convolutional network for each sector. Forms are smaller than those published.
"""

from dataclasses import dataclass

import torch
from torch import nn

from .classifiers import folded


@dataclass(frozen=True)
class CovarianceConfig:
    """Sizes of a network on a covariance."""

    elements: int = 16
    points: int = 128
    """Of the grid, evenly spaced in the sine of the azimuth from -1."""
    sectors: int = 1
    """Networks side by side, one for each part of the grid."""
    filters: int = 48
    hidden: tuple[int, ...] = (320, 160)


CNN_CONFIGS = {
    "paper": CovarianceConfig(filters=256, hidden=(4096, 2048, 1024)),
    "small": CovarianceConfig(),
    "tiny": CovarianceConfig(elements=8, points=32, filters=4, hidden=(16,)),
}
MUSIC_CONFIGS = {
    "small": CovarianceConfig(sectors=8, filters=12, hidden=(96,)),
    "tiny": CovarianceConfig(elements=8, points=32, sectors=2, filters=4, hidden=(16,)),
}
FLOOR = 1e-3
"""Least of the null spectrum of DeepMUSIC's labels, of which 1 is the largest."""


def sector(c: CovarianceConfig) -> nn.Sequential:
    """Four convolutions, the first every other element, then hidden layers; a number for each point of a sector."""
    layers, size, channels = [], c.elements, 3
    for kernel, stride in ((3, 2), (2, 1), (2, 1), (2, 1)):
        if size < kernel:
            break
        layers += [nn.Conv2d(channels, c.filters, kernel, stride), nn.BatchNorm2d(c.filters), nn.ReLU()]
        size, channels = (size - kernel) // stride + 1, c.filters
    layers.append(nn.Flatten())
    inputs = c.filters * size * size
    for hidden in c.hidden:
        layers += [nn.Linear(inputs, hidden), nn.BatchNorm1d(hidden), nn.ReLU()]
        inputs = hidden
    return nn.Sequential(*layers, nn.Linear(inputs, c.points // c.sectors))


class CovarianceNetwork(nn.Module):
    """Covariances [batch, 3, elements, elements] to a number a point of the grid, [batch, points]."""

    def __init__(self, config: CovarianceConfig):
        super().__init__()
        self.config = config
        self.sectors = nn.ModuleList(sector(config) for _ in range(config.sectors))

    def forward(self, covariance):
        return torch.cat([one(covariance) for one in self.sectors], -1)

    def fold(self) -> "CovarianceNetwork":
        """The same function without batch normalisation, for its evaluation mode."""
        same = CovarianceNetwork(self.config)
        same.sectors = nn.ModuleList(folded(one) for one in self.sectors)
        return same
