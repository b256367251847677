"""Angles of arrival as set prediction: AAETR, a transformer, and the learned pursuit, which has no attention.

In AAETR (Zhu, Chen and Yang 2024) the elements of a snapshot are the tokens of an encoder; learned queries attend to
them, and each answers with one target or none. The form `paper` has its layers, width and number of queries; heads and
the size of the feed-forward networks are ours, and there is no dropout, which theirs has.
The steered forms give what physics knows: their queries stand on a grid over the sine of the azimuth, and before each
layer every query sees what the array, steered to where it stands, receives of the snapshot less what all queries
explain so far. `small` does without tokens and attention: it is no transformer, but a pursuit whose steps are learned.
"""

from dataclasses import dataclass

import torch
from torch import nn
from torch.nn import functional

from .arrays import LRR48_APERTURE


@dataclass(frozen=True)
class AaetrConfig:
    """Sizes of an AAETR, or of a learned pursuit."""

    elements: int = 48
    width: int = 128
    heads: int = 8
    feedforward: int = 256
    encoder_layers: int = 6
    decoder_layers: int = 6
    queries: int = 80
    steered: bool = False
    """Whether queries stand on a grid and see what the array, steered there, receives."""
    attend: bool = True
    """Whether there are tokens that queries attend to; the steered form can do without."""
    neighbours: int = 0
    """Length of the convolution over neighbouring queries of the steered form; 0 for none."""
    half_view: float = 0.9
    """Queries of the steered form start within plus and minus this sine."""
    positions: str = "linear"
    """Positional encoding of the elements: `linear` projection of their positions, `waves` (their sines and cosines at
    several frequencies, then linear), or `learned`, one vector for each element."""
    query_scale: float = 0.5
    """Standard deviation of the queries and their positions before training."""
    query_attention: bool = False
    """Whether queries attend to each other before they attend to elements, as in DETR."""


CONFIGS = {
    "paper": AaetrConfig(),
    "plain": AaetrConfig(width=84, heads=4, feedforward=168, encoder_layers=2, decoder_layers=5, queries=96),
    "steered": AaetrConfig(encoder_layers=2, queries=96, steered=True, neighbours=3),
    "small": AaetrConfig(
        width=48, feedforward=96, encoder_layers=0, queries=96, steered=True, attend=False, neighbours=3
    ),
    "tiny": AaetrConfig(
        width=16, heads=2, feedforward=32, encoder_layers=1, decoder_layers=2, queries=96, steered=True, neighbours=3
    ),
}


class Attention(nn.Module):
    """Multi-head attention in operators every ONNX runtime has."""

    def __init__(self, width: int, heads: int):
        super().__init__()
        self.heads = heads
        self.query, self.key = nn.Linear(width, width), nn.Linear(width, width)
        self.value, self.out = nn.Linear(width, width), nn.Linear(width, width)

    def forward(self, query, key, value):
        width, heads = query.shape[-1], self.heads

        def split(x):
            return x.reshape(-1, x.shape[1], heads, width // heads).transpose(1, 2)

        mixed = functional.scaled_dot_product_attention(
            split(self.query(query)),
            split(self.key(key)),
            split(self.value(value)),
        )
        return self.out(mixed.transpose(1, 2).reshape(-1, query.shape[1], width))


class Feedforward(nn.Sequential):
    """Two linear layers with a rectifier between."""

    def __init__(self, width: int, hidden: int):
        super().__init__(nn.Linear(width, hidden), nn.ReLU(), nn.Linear(hidden, width))


class EncoderLayer(nn.Module):
    """Self-attention of the elements, then a feed-forward network; each normalised before."""

    def __init__(self, c: AaetrConfig):
        super().__init__()
        self.before_attention, self.before_feedforward = nn.LayerNorm(c.width), nn.LayerNorm(c.width)
        self.attention, self.feedforward = Attention(c.width, c.heads), Feedforward(c.width, c.feedforward)

    def forward(self, x, position):
        n = self.before_attention(x)
        x = x + self.attention(n + position, n + position, n)
        return x + self.feedforward(self.before_feedforward(x))


class DecoderLayer(nn.Module):
    """Cross-attention of the queries to the elements, then a feed-forward network; each normalised before."""

    def __init__(self, c: AaetrConfig):
        super().__init__()
        self.before_feedforward, self.feedforward = nn.LayerNorm(c.width), Feedforward(c.width, c.feedforward)
        if c.attend:
            self.before_attention, self.attention = nn.LayerNorm(c.width), Attention(c.width, c.heads)
        self.own = None
        if c.query_attention:
            self.before_own, self.own = nn.LayerNorm(c.width), Attention(c.width, c.heads)
        self.mix = None
        if c.neighbours:
            self.before_mix = nn.LayerNorm(c.width)
            self.mix = nn.Conv1d(c.width, c.width, c.neighbours, padding=c.neighbours // 2)

    def forward(self, x, query_position=None, elements=None, position=None):
        if self.own is not None:
            n = self.before_own(x)
            x = x + self.own(n + query_position, n + query_position, n)
        if elements is not None:
            x = x + self.attention(self.before_attention(x) + query_position, elements + position, elements)
        if self.mix is not None:
            x = x + self.mix(self.before_mix(x).transpose(1, 2)).transpose(1, 2)
        return x + self.feedforward(self.before_feedforward(x))


class Aaetr(nn.Module):
    """Snapshots to targets.

    `forward(values, positions)` takes real and imaginary parts [batch, elements, 2] and positions [elements, 3] or
    [batch, elements, 3] in half wavelengths, and returns for each decoder layer, the last one last, sines of azimuth,
    magnitudes in dB and confidences as logits, [layers, batch, queries, 3].
    """

    def __init__(self, config: AaetrConfig):
        super().__init__()
        self.config = c = config
        self.query = nn.Parameter(torch.randn(c.queries, c.width) * c.query_scale)
        self.decoder = nn.ModuleList(DecoderLayer(c) for _ in range(c.decoder_layers))
        self.norm = nn.LayerNorm(c.width)
        if c.attend:
            self.query_position = nn.Parameter(torch.randn(c.queries, c.width) * c.query_scale)
            self.embed_value = nn.Linear(2, c.width)
            self.embed_position = _position_encoding(c)
            self.encoder = nn.ModuleList(EncoderLayer(c) for _ in range(c.encoder_layers))
        if c.steered:
            self.steer = nn.ModuleList(Steer(c) for _ in range(c.decoder_layers))
        else:
            self.head = nn.Linear(c.width, 3)

    def forward(self, values, positions):
        scale = (values * values).sum((-1, -2), keepdim=True).div(self.config.elements).clamp_min(1e-20).sqrt()
        values = values / scale
        scale_db = 20 * scale.squeeze(-1).log10()
        memory = self._encode(values, positions) if self.config.attend else ()
        query = self.query.expand(values.shape[0], -1, -1)
        steering = Steering(self.config, values, positions) if self.config.steered else None
        outputs = []
        for index, layer in enumerate(self.decoder):
            if steering is not None:
                query = self.steer[index].look(query, steering)
            query = layer(query, *memory)
            # Sines need more digits than bfloat16 has.
            with torch.autocast(query.device.type, enabled=False):
                answer = self.norm(query.float())
                if steering is not None:
                    u, db, confidence = self.steer[index].answer(answer, steering)
                else:
                    u, db, confidence = self.head(answer).unbind(-1)
                    db = 10 * db
            outputs.append(torch.stack((u, db + scale_db, confidence), -1))
        return torch.stack(outputs)

    def _encode(self, values, positions):
        """What decoder layers attend with: positions of the queries, tokens, positions of the tokens."""
        x = self.embed_value(values)
        position = self.embed_position(positions * (2 / LRR48_APERTURE))
        for layer in self.encoder:
            x = layer(x, position)
        return self.query_position, x, position


def _position_encoding(c: AaetrConfig) -> nn.Module:
    """Positions over half of the aperture, [elements, 3] or [batch, elements, 3], to vectors."""
    if c.positions == "linear":
        return nn.Linear(3, c.width)
    if c.positions == "waves":
        return nn.Sequential(Waves(), nn.Linear(2 * len(WAVES), c.width))
    return Learned(c.elements, c.width)


WAVES = tuple(float(2**k) for k in range(-1, 7))
"""Half turns over the aperture: from a wave of the whole length to one of twice the element spacing."""


class Waves(nn.Module):
    """Sines and cosines of positions along y."""

    def forward(self, positions):
        phase = positions[..., 1:2] * (torch.pi / 2 * torch.tensor(WAVES, device=positions.device))
        return torch.cat((phase.sin(), phase.cos()), -1)


class Learned(nn.Module):
    """A vector for each element of one array, whatever its position."""

    def __init__(self, elements: int, width: int):
        super().__init__()
        self.vectors = nn.Parameter(torch.randn(elements, width) * 0.5)

    def forward(self, positions):
        return self.vectors


class Steering:
    """Where the queries stand, the amplitudes they hold, and what these leave of the snapshot.

    Complex numbers are pairs of real tensors, for ONNX has no others.
    """

    def __init__(self, config: AaetrConfig, values, positions):
        self.re, self.im = values.float().unbind(-1)
        centred = positions.float() - positions.float().mean(-2, keepdim=True)
        self.forward, self.left = centred[..., 0], centred[..., 1]
        self.cell = 2 / LRR48_APERTURE
        """Rayleigh's resolution in sine."""
        grid = torch.linspace(-config.half_view, config.half_view, config.queries, device=values.device)
        self.u = grid.expand(values.shape[0], -1)
        self.amplitude_re = self.amplitude_im = torch.zeros_like(self.u)
        offsets = torch.tensor(OFFSETS, device=values.device) * self.cell
        shift = torch.pi * self.left.unsqueeze(-1) * offsets
        self.shifts = shift.cos(), shift.sin()

    def response(self):
        """Parts of the response to waves from where the queries stand, [batch, queries, elements]."""
        forward = (1 - self.u * self.u).clamp_min(1e-6).sqrt()
        phase = torch.pi * (
            self.u.unsqueeze(-1) * self.left.unsqueeze(-2) + forward.unsqueeze(-1) * self.forward.unsqueeze(-2)
        )
        return phase.cos(), phase.sin()

    def beams(self):
        """What beams at each of OFFSETS beside the queries receive of the residual, [batch, queries, offsets]."""
        re, im = self.response()
        a_re, a_im = self.amplitude_re.unsqueeze(1), self.amplitude_im.unsqueeze(1)
        left_re = self.re - (a_re @ re - a_im @ im).squeeze(1)
        left_im = self.im - (a_re @ im + a_im @ re).squeeze(1)
        self.left_over = (left_re**2 + left_im**2).mean(-1, keepdim=True)
        # conj(a) r, then times the conjugate of the shifts.
        r_re, r_im = left_re.unsqueeze(1) / self.re.shape[-1], left_im.unsqueeze(1) / self.re.shape[-1]
        steered_re, steered_im = re * r_re + im * r_im, re * r_im - im * r_re
        cos, sin = self.shifts
        return steered_re @ cos + steered_im @ sin, steered_im @ cos - steered_re @ sin


OFFSETS = (-1.0, -0.5, 0.0, 0.5, 1.0)
MIDDLE = 2
FEATURES = 4 * (len(OFFSETS) + 1) + 4
WEIGHTS = 2 * (len(OFFSETS) + 1)


class Steer(nn.Module):
    """One look of the queries at the residual, and their answers after the layer."""

    def __init__(self, c: AaetrConfig):
        super().__init__()
        self.look_in = nn.Linear(FEATURES, c.width)
        self.head = nn.Linear(c.width, WEIGHTS + 3)
        nn.init.normal_(self.head.weight, std=0.02)
        nn.init.zeros_(self.head.bias)

    def look(self, query, s: Steering):
        """Adds to the queries what their beams receive, relative in phase to their own target's likely amplitude."""
        with torch.autocast(query.device.type, enabled=False):
            beam_re, beam_im = s.beams()
            # All that is linear in the snapshot: beams, and the amplitude held.
            s.parts_re = torch.cat((beam_re, s.amplitude_re.unsqueeze(-1)), -1)
            s.parts_im = torch.cat((beam_im, s.amplitude_im.unsqueeze(-1)), -1)
            own_re = beam_re[..., MIDDLE] + s.amplitude_re
            own_im = beam_im[..., MIDDLE] + s.amplitude_im
            s.own = (own_re**2 + own_im**2 + 1e-6).sqrt()
            cos, sin = (own_re / s.own).unsqueeze(-1), (own_im / s.own).unsqueeze(-1)
            turned_re = s.parts_re * cos + s.parts_im * sin
            turned_im = s.parts_im * cos - s.parts_re * sin
            size = (turned_re**2 + turned_im**2 + 1e-6).sqrt()
            compressed = (1 + 50 * size).log() / size
            left_over = s.left_over.clamp_min(1e-8)
            contrast = s.own / left_over.clamp_min(1e-4).sqrt()
            likely = s.own.log()
            # Spread over the queries by arithmetic: tract 0.23 fails on a concatenation of something expanded.
            spread = likely - (likely - left_over.log())
            more = (likely, spread, contrast, s.u)
            features = torch.cat(
                (turned_re, turned_im, turned_re * compressed, turned_im * compressed, torch.stack(more, -1)), -1
            )
        return query + self.look_in(features)

    def answer(self, query, s: Steering):
        """Moves the queries and their amplitudes; sine, magnitude relative to the snapshot's (dB), logit."""
        out = self.head(query)
        w_re, w_im = out[..., : WEIGHTS // 2], out[..., WEIGHTS // 2 : WEIGHTS]
        s.amplitude_re = (w_re * s.parts_re - w_im * s.parts_im).sum(-1)
        s.amplitude_im = (w_re * s.parts_im + w_im * s.parts_re).sum(-1)
        step, correction, confidence = out[..., WEIGHTS:].unbind(-1)
        u = s.u + s.cell * step
        s.u = u.clamp(-1, 1)
        db = 20 * s.own.log10() + 10 * correction
        return u, db, confidence
