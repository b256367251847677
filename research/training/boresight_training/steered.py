"""AAETR with steered attention: a transformer after AAETR, whose attention knows what a wave does to an array.

Elements are the tokens of an encoder; queries attend to them, and each answers with one target or none, as in AAETR.
The rest is ours. Every query stands at a sine of the azimuth, its anchor, and each layer moves it. Where a query
attends to elements, their values are complex and turned by the phase that a wave from the anchor has there, so that a
mean over the elements is a beam and the weights of attention are its taper: rotary position embedding with the
element's position and the anchor as its frequency. And attention goes both ways: after each layer elements attend to
the queries, whose values are turned back, so that they learn what the queries account for. Queries attend to each
other too, as DETR's do; AAETR's, as described, do not. Positions enter through these phases and through features
relative to the aperture, so that one network takes any array and any number of elements.

Complex numbers are pairs of real tensors, for ONNX has no others.
"""

from dataclasses import dataclass
from functools import cache
from math import pi

import torch
from torch import nn

from .aaetr import AaetrConfig, Attention, EncoderLayer, Feedforward
from .arrays import resolution


@dataclass(frozen=True)
class SteeredConfig:
    """Sizes of an AAETR with steered attention."""

    width: int = 64
    heads: int = 2
    feedforward: int = 128
    encoder_layers: int = 2
    decoder_layers: int = 5
    queries: int = 96
    half_view: float = 0.9
    """Anchors start on a grid within plus and minus this sine."""


CONFIGS = {
    "steered-attention": SteeredConfig(),
    "steered-attention-tiny": SteeredConfig(
        width=16, heads=2, feedforward=32, encoder_layers=1, decoder_layers=2, queries=48
    ),
}

WAVES = (0.5, 1.0, 2.0, 4.0, 8.0, 16.0)
"""Half turns over the aperture, or over the sine, of the features of places."""
FLOOR = 1e-6


def turned(re, im, cos, sin):
    """Complex numbers times the conjugate of `cos + j sin`."""
    return re * cos + im * sin, im * cos - re * sin


@cache
def _rates(device: torch.device) -> torch.Tensor:
    """Made once: a CUDA graph cannot copy from the host."""
    return pi * torch.tensor(WAVES, device=device)


def waves(x):
    """Sines and cosines of places from -1 to 1, [..., 2 * len(WAVES)]."""
    phase = x.unsqueeze(-1) * _rates(x.device)
    return torch.cat((phase.sin(), phase.cos()), -1)


class Places:
    """Positions of the elements about their mean, and the resolution in sine that their extent gives."""

    def __init__(self, positions):
        positions = positions.float()
        centred = positions - positions.mean(-2, keepdim=True)
        self.forward, self.left = centred[..., 0], centred[..., 1]
        self.cell = resolution(positions)
        """Rayleigh's resolution in sine, [1] or [batch, 1]."""

    def phases(self, u):
        """Cosine and sine of the phase of waves from sines `u` [batch, waves], each [batch, waves, elements]."""
        forward = (1 - u * u).clamp_min(FLOOR).sqrt()
        phase = pi * (u.unsqueeze(-1) * self.left.unsqueeze(-2) + forward.unsqueeze(-1) * self.forward.unsqueeze(-2))
        return phase.cos(), phase.sin()


class SteeredAttention(nn.Module):
    """Queries attend to tokens whose complex values are turned, each head's by an offset of its own."""

    def __init__(self, width: int, heads: int):
        super().__init__()
        self.heads, self.pairs = heads, width // heads // 2
        self.query, self.key = nn.Linear(width, width), nn.Linear(width, width)
        self.value = nn.Linear(width, width)

    def weights(self, query, key):
        """What each query takes of each token, [batch, heads, queries, tokens]."""
        q, k = self._split(self.query(query)), self._split(self.key(key))
        return (q @ k.transpose(-1, -2) * (2 * self.pairs) ** -0.5).softmax(-1)

    def values(self, tokens):
        """Real and imaginary parts of the values, each [batch, heads, tokens, pairs]."""
        return self._split(self.value(tokens)).split(self.pairs, -1)

    def mixed(self, weights, re, im, cos, sin):
        """Values turned by `-phase` and summed by weight: real and imaginary parts, [batch, queries, heads * pairs]."""
        both = torch.cat((re, im), -1)
        by_cos, by_sin = (weights * cos.unsqueeze(-3)) @ both, (weights * sin.unsqueeze(-3)) @ both
        cos_re, cos_im = by_cos.split(self.pairs, -1)
        sin_re, sin_im = by_sin.split(self.pairs, -1)
        return self._joined(cos_re + sin_im), self._joined(cos_im - sin_re)

    def _split(self, x):
        return x.reshape(-1, x.shape[1], self.heads, 2 * self.pairs).transpose(1, 2)

    def _joined(self, x):
        return x.transpose(1, 2).reshape(-1, x.shape[2], self.heads * self.pairs)


class Look(nn.Module):
    """What the queries' beams receive, relative in phase to the beam at the anchor."""

    def __init__(self, c: SteeredConfig):
        super().__init__()
        self.attention = SteeredAttention(c.width, c.heads)
        pairs = self.attention.pairs
        offsets = torch.linspace(-1.0, 1.0, c.heads * pairs).reshape(pairs, c.heads).transpose(0, 1)
        self.offset = nn.Parameter(offsets.reshape(c.heads, 1, pairs).clone())
        """Where each of the values looks beside the anchor, in cells."""
        self.out = nn.Linear(2 * c.width, c.width)

    def forward(self, query, tokens, position, places, phases, reference):
        weights = self.attention.weights(query, tokens + position)
        beside = pi * self.offset * (places.left * places.cell).unsqueeze(-1).unsqueeze(-3)
        re, im = turned(*self.attention.values(tokens), beside.cos(), beside.sin())
        re, im = turned(*self.attention.mixed(weights, re, im, *phases), *reference)
        size = (re * re + im * im + FLOOR).sqrt()
        # Weak targets beside strong ones.
        compressed = (1 + 50 * size).log() / size
        return self.out(torch.cat((re, im, re * compressed, im * compressed), -1))


class Account(nn.Module):
    """What the elements receive of what the queries hold: their values, with phase and size of the anchor's beam."""

    def __init__(self, c: SteeredConfig):
        super().__init__()
        self.attention = SteeredAttention(c.width, c.heads)
        self.out = nn.Linear(c.width, c.width)
        nn.init.zeros_(self.out.weight)
        nn.init.zeros_(self.out.bias)
        self.most = 16.0
        """Sum of the weights an element gives to all queries."""

    def forward(self, tokens, query, phases, reference, own):
        weights = self.most * self.attention.weights(tokens, query)
        re, im = self.attention.values(query)
        cos, sin = (part.unsqueeze(1) for part in reference)
        re, im = turned(re, im, cos, -sin)
        own = own.unsqueeze(1)
        cos, sin = (part.transpose(-1, -2) for part in phases)
        return self.out(torch.cat(self.attention.mixed(weights, own * re, own * im, cos, -sin), -1))


class DecoderLayer(nn.Module):
    """Queries look at the elements and at each other, then a feed-forward network; elements take account of them."""

    def __init__(self, c: SteeredConfig, is_last: bool):
        super().__init__()
        self.levels = nn.Linear(4, c.width)
        self.before_look, self.look = nn.LayerNorm(c.width), Look(c)
        self.before_attention, self.attention = nn.LayerNorm(c.width), Attention(c.width, c.heads)
        self.before_feedforward, self.feedforward = nn.LayerNorm(c.width), Feedforward(c.width, c.feedforward)
        self.account = None
        if not is_last:
            self.before_account, self.before_elements = nn.LayerNorm(c.width), nn.LayerNorm(c.width)
            self.account = Account(c)


class SteeredAaetr(nn.Module):
    """Snapshots to targets.

    `forward(values, positions)` takes real and imaginary parts [batch, elements, 2] and positions [elements, 3] or
    [batch, elements, 3] in half wavelengths, and returns for each decoder layer, the last one last, sines of azimuth,
    magnitudes in dB, confidences as logits, and logarithms of the variances of the sine (in cells) and the magnitude,
    [layers, batch, queries, 5].
    """

    def __init__(self, config: SteeredConfig):
        super().__init__()
        self.config = c = config
        self.query = nn.Parameter(torch.randn(c.queries, c.width) * 0.5)
        self.embed_value, self.embed_position = nn.Linear(3, c.width), nn.Linear(2 * len(WAVES), c.width)
        layer = AaetrConfig(width=c.width, heads=c.heads, feedforward=c.feedforward)
        self.encoder = nn.ModuleList(EncoderLayer(layer) for _ in range(c.encoder_layers))
        last = c.decoder_layers - 1
        self.decoder = nn.ModuleList(DecoderLayer(c, index == last) for index in range(c.decoder_layers))
        self.embed_anchor = nn.Linear(2 * len(WAVES), c.width)
        self.norm = nn.LayerNorm(c.width)
        self.head = nn.Linear(c.width, 5)
        nn.init.normal_(self.head.weight, std=0.02)
        nn.init.zeros_(self.head.bias)

    def forward(self, values, positions):
        c = self.config
        scale = values.square().sum((-1, -2), keepdim=True).div(values.shape[1]).clamp_min(1e-20).sqrt()
        values = (values / scale).float()
        scale_db = 20 * scale.squeeze(-1).log10()
        places = Places(positions)
        position = self.embed_position(waves(places.left * places.cell))
        size = values.square().sum(-1, keepdim=True).add(FLOOR).sqrt()
        tokens = self.embed_value(torch.cat((values, size), -1))
        for layer in self.encoder:
            tokens = layer(tokens, position)
        anchor = torch.linspace(-c.half_view, c.half_view, c.queries, device=values.device).expand(values.shape[0], -1)
        spacing = (places.cell * (c.queries / (2 * c.half_view))).log()
        query = self.query.expand(values.shape[0], -1, -1)
        outputs = []
        for layer in self.decoder:
            # Phases and sines need more digits than bfloat16 has.
            with torch.autocast(values.device.type, enabled=False):
                phases = places.phases(anchor)
                own_re, own_im = _beam(values, *phases)
                own = (own_re.square() + own_im.square() + FLOOR).sqrt()
                reference = (own_re / own).unsqueeze(-1), (own_im / own).unsqueeze(-1)
                levels = torch.stack((own.log(), own, anchor, spacing + torch.zeros_like(anchor)), -1)
            place = self.embed_anchor(waves(anchor))
            query = query + layer.levels(levels)
            query = query + layer.look(layer.before_look(query) + place, tokens, position, places, phases, reference)
            others = layer.before_attention(query)
            query = query + layer.attention(others + place, others + place, others)
            query = query + layer.feedforward(layer.before_feedforward(query))
            if layer.account is not None:
                holds = layer.before_account(query)
                wants = layer.before_elements(tokens) + position
                tokens = tokens + layer.account(wants, holds, phases, reference, own.unsqueeze(-1))
            with torch.autocast(values.device.type, enabled=False):
                step, correction, confidence, *spread = self.head(self.norm(query.float())).unbind(-1)
                u = anchor + places.cell * step
                db = 20 * own.log10() + 10 * correction + scale_db
                outputs.append(torch.stack((u, db, confidence, *spread), -1))
                anchor = u.clamp(-1, 1)
        return torch.stack(outputs)


def _beam(values, cos, sin):
    """What beams at the anchors receive, real and imaginary part, [batch, queries]."""
    re, im = values.unbind(-1)
    elements = values.shape[1]
    re, im = turned(re.unsqueeze(1), im.unsqueeze(1), cos, sin)
    return re.sum(-1) / elements, im.sum(-1) / elements
