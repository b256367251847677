"""The networks of Sang et al. (2021) that see a covariance: the counting network, and the DNN they compare with.

Both answer with logits; exported models answer with probabilities. Neither has the paper's dropout.
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
