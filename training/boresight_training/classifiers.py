"""The networks of Sang et al. (2021): the counting network, the 3D-CNN, and the DNN it is compared with.

All answer with logits; exported models answer with probabilities.
"""

from itertools import pairwise

import torch
from torch import nn

from .regions import CLASSES

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


class Cnn3d(nn.Module):
    """Table 2: a region [batch, 65, 8, 4, 3] to directions.

    The pooling rounds up, for the paper's sizes fit in no other way.
    """

    def __init__(self, filters: int = 256):
        super().__init__()
        self.features = nn.Sequential(
            nn.Conv3d(3, filters, (30, 5, 3)),
            nn.ReLU(),
            nn.Conv3d(filters, filters, (2, 2, 2)),
            nn.ReLU(),
            nn.MaxPool3d((2, 2, 2), ceil_mode=True),
        )
        self.classify = nn.Sequential(
            nn.Linear(filters * 18 * 2, 500),
            nn.ReLU(),
            nn.Linear(500, 200),
            nn.ReLU(),
            nn.Linear(200, 100),
            nn.ReLU(),
            nn.Linear(100, CLASSES),
        )

    def forward(self, region):
        largest = region[..., 0].amax((1, 2, 3)).clamp_min(1e-30)
        x = (region / largest.view(-1, 1, 1, 1, 1)).permute(0, 4, 1, 2, 3)
        return self.classify(self.features(x).flatten(1))


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
