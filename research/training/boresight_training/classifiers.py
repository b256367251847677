"""The networks of Sang et al. (2021) that see a covariance: the counting network, and the DNN they compare with.

Both answer with logits; exported models answer with probabilities. Neither has the paper's dropout.
"""

from itertools import pairwise

from torch import nn
from torch.nn.utils.fusion import fuse_conv_bn_eval, fuse_linear_bn_eval

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
    """The same function without batch normalisation, for its evaluation mode."""
    layers = []
    for layer in network:
        if isinstance(layer, nn.BatchNorm1d | nn.BatchNorm2d):
            fuse = fuse_linear_bn_eval if isinstance(layers[-1], nn.Linear) else fuse_conv_bn_eval
            layers.append(fuse(layers.pop(), layer))
        else:
            layers.append(layer)
    return nn.Sequential(*layers)
