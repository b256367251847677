"""UAA: the iterations of IAA as the layers of a recurrent network (after Zheng, Liu, Sun and Li 2023).

IAA's spectrum follows from the covariance `R = A diag(p) A^H + v I` that the last one implies: with `q = A^H R^-1 y`
and `d = a^H R^-1 a` the new amplitudes are `q / d`. Here `R^-1 y` comes from a few steps of conjugate gradients, each
layer's beginning where the last one ended, and `d` and the noise `v` from a small convolutional network over the grid,
so that no layer has a matrix inverse. Publications tell the idea and not the layers; these, their sizes, data and loss
are ours.
"""

from dataclasses import dataclass
from math import log, pi

import torch
from torch import nn
from torch.nn import functional


@dataclass(frozen=True)
class UnrolledIaaConfig:
    """Sizes of an unrolled IAA."""

    points: int = 256
    """Of the grid, evenly spaced in the sine of the azimuth from -1."""
    layers: int = 8
    gradients: int = 3
    """Steps of conjugate gradients a layer."""
    width: int = 24
    """Numbers that each point of the grid remembers from layer to layer."""
    kernel: int = 5


CONFIGS = {"small": UnrolledIaaConfig(), "tiny": UnrolledIaaConfig(points=64, layers=2, gradients=1, width=4)}

FEATURES = 3
LOG10 = log(10)


class UnrolledIaa(nn.Module):
    """Snapshots to spectra.

    `forward(values, positions)` takes real and imaginary parts [batch, elements, 2] and positions [elements, 3] in half
    wavelengths, and returns after each layer, the last one last, powers at one element in dB, [layers, batch, points].
    """

    def __init__(self, config: UnrolledIaaConfig):
        super().__init__()
        self.config = c = config
        around = c.kernel // 2
        self.mix = nn.Conv1d(c.width + FEATURES, c.width, c.kernel, padding=around, padding_mode="circular")
        self.remember = nn.Conv1d(c.width, 2 * c.width, 1)
        self.update = nn.Conv1d(c.width, 2, 1)
        self.noise = nn.Linear(c.width, 1)
        self.start = nn.Conv1d(1, c.width, c.kernel, padding=around, padding_mode="circular")
        for head in (self.update, self.noise):
            nn.init.zeros_(head.weight)
            nn.init.zeros_(head.bias)

    def forward(self, values, positions):
        c = self.config
        waves = wave_matrix(positions, c.points)
        elements = values.shape[1]
        mean = values.square().sum((1, 2), keepdim=True).clamp_min(1e-30) / elements
        y = (values * mean.rsqrt()).transpose(1, 2).reshape(-1, 2 * elements)
        log_p = (squared(y @ waves) / elements**2 + 1e-6).log()
        memory = functional.relu(self.start(log_p.unsqueeze(1)))
        z = torch.zeros_like(y)
        answers = []
        for _ in range(c.layers):
            log_noise = self.noise(memory.mean(-1)) - 3
            p, noise = log_p.clamp(-20, 8).exp(), log_noise.clamp(-12, 4).exp()
            z, q = conjugate_gradients(z, y, waves, torch.cat((p, p), -1), noise, c.gradients)
            log_q = (squared(q) + 1e-12).log()
            features = torch.stack((log_p, log_p + 0.5 * log_q, log_noise.expand_as(log_p)), 1) / 5
            mixed = functional.relu(self.mix(torch.cat((memory, features), 1)))
            keep, new = self.remember(mixed).split(c.width, 1)
            memory = memory + keep.sigmoid() * (new.tanh() - memory)
            # Towards p^2 |q|^2, the power of the mean of a Gaussian amplitude given the snapshot, by a share learned.
            share, more = self.update(memory).unbind(1)
            log_p = log_p + share.sigmoid() * (log_p + log_q) + 5 * more
            answers.append(log_p)
        # No expansion of the mean: tract fails on one before a sum.
        return torch.stack(answers) * (10 / LOG10) + (10 / LOG10) * mean.squeeze(-1).log()


def wave_matrix(positions, points):
    """Matrix [2 * elements, 2 * points] whose product with a snapshot is the beams along the grid.

    Snapshots and beams have their real parts first, then their imaginary parts: products of whole matrices take a third
    of the operators that products of the parts do.
    """
    sine = torch.arange(points, device=positions.device) * (2 / points) - 1
    forward = (1 - sine * sine).clamp_min(0).sqrt()
    phase = pi * (positions[..., 1:2] * sine + positions[..., :1] * forward)
    cos, sin = phase.cos(), phase.sin()
    return torch.cat((torch.cat((cos, -sin), -1), torch.cat((sin, cos), -1)), -2)


def squared(x):
    """Squared magnitudes of complex numbers, real parts first."""
    re, im = x.chunk(2, -1)
    return re * re + im * im


def applied(x, waves, p, noise):
    """The covariance of powers `p` on the grid and noise, times `x`; and the beams of `x`."""
    beams = x @ waves
    return (p * beams) @ waves.transpose(0, 1) + noise * x, beams


def dot(x, y):
    """Real part of the scalar product, [batch, 1]."""
    return (x * y).sum(-1, keepdim=True)


def conjugate_gradients(z, y, waves, p, noise, steps):
    """Steps from `z` towards the inverse of the covariance times `y`; and the beams of where they end."""
    turned, beams = applied(z, waves, p, noise)
    r = y - turned
    along, size = r, dot(r, r)
    for _ in range(steps):
        turned, along_beams = applied(along, waves, p, noise)
        step = size / (dot(along, turned) + 1e-20)
        z = z + step * along
        beams = beams + step * along_beams
        r = r - step * turned
        left = dot(r, r)
        along, size = r + left / (size + 1e-20) * along, left
    return z, beams


class Powers(nn.Module):
    """The exported form: linear powers after the last layer."""

    def __init__(self, model: UnrolledIaa):
        super().__init__()
        self.model = model

    def forward(self, snapshots, positions):
        return (self.model(snapshots, positions)[-1] * (LOG10 / 10)).exp()
