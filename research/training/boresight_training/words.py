"""Architectures in words, and how each differs from its publication: for cards."""

from .aaetr import AaetrConfig
from .cnn3d import Cnn3dConfig
from .covariance_networks import CovarianceConfig
from .regions import LENGTH
from .steered import SteeredConfig
from .unrolled_iaa import UnrolledIaaConfig

PAPER = (
    "The publication has 6 + 6 layers of width 128, 1.6 million parameters, "
    "and 63 million snapshots of 35 dB on 16 GPUs."
)


def set_prediction(config: AaetrConfig | SteeredConfig) -> tuple[str, str]:
    """Of AAETR's forms and the learned pursuit."""
    sizes = f"{config.queries} queries, width {config.width}"
    if not isinstance(config, SteeredConfig) and not config.attend:
        return (
            f"No transformer, for it has no attention: a pursuit of {config.decoder_layers} learned steps, {sizes}. "
            "Queries stand on a grid over the sine of the azimuth. Before each step every query sees what the array, "
            "steered to where it stands and just beside, receives of the snapshot less what all queries explain so "
            f"far. A convolution over {config.neighbours} neighbouring queries and a feed-forward network move it.",
            f"It shares inputs, outputs, set loss and scores with AAETR, and nothing of its architecture. {PAPER}",
        )
    layers = f"A transformer: {config.encoder_layers} + {config.decoder_layers} layers, {config.heads} heads, {sizes}."
    if isinstance(config, SteeredConfig):
        return (
            f"{layers} Elements are tokens with self-attention. Queries stand at sines of the azimuth. Where they "
            "attend to elements, the values are turned by each element's phase from there, and elements attend to "
            "queries in turn. Each query answers with one target or none.",
            "Queries have places instead of learned embeddings, attention is steered by the positions of the "
            f"elements, and there is an attention from elements to queries. {PAPER}",
        )
    if config.steered:
        return (
            f"{layers} Elements are tokens with self-attention. Queries stand on a grid over the sine of the azimuth, "
            "attend to the tokens, and see before each layer what the array, steered to where they stand, receives of "
            "what is not explained yet.",
            f"Queries stand on a grid and see the residual. {PAPER}",
        )
    return (
        f"{layers} Elements are tokens with self-attention; learned queries attend to them, and each answers with one "
        "target or none.",
        f"The architecture is the publication's as far as it is told, without its dropout. {PAPER}",
    )


def fully_connected(hidden: int, layers: str) -> str:
    """Of the DNN and the counting network."""
    return f"Fully connected, {layers} hidden layers of {hidden} with batch normalisation, on the region's covariance."


def cnn3d(config: Cnn3dConfig) -> tuple[str, str]:
    """Of the 3D-CNN."""
    whole = Cnn3dConfig()
    smaller = (
        ""
        if config == whole
        else f" Table 2 has {whole.filters} filters, the first of {whole.range_kernel} x 5 x 3, on {LENGTH} range "
        "bins, and 5.6 million parameters."
    )
    return (
        f"Two three-dimensional convolutions of {config.filters} filters, the first of {config.range_kernel} x 5 x 3 "
        f"(range, element, chirp), on {config.bins} range bins, pooling, and hidden layers of 500, 200 and 100.",
        f"The first filters begin as beams, and there is no dropout.{smaller}",
    )


def counting_stages(lowest_db: float) -> str:
    """How the counting network's training differs."""
    stages = (
        "The second half of training begins at -5 dB, as the publication's"
        if lowest_db == -5
        else f"The second half of training begins at {lowest_db:g} dB, the publication's at -5 dB"
    )
    return f"{stages}. Every step draws its own data; the publication has 63,000 snapshots a stage."


def channel_errors(gain_db: float, phase_deg: float) -> str:
    """How boards of the data differ from exact ones; nothing of exact ones."""
    if gain_db == 0 and phase_deg == 0:
        return ""
    return f" Elements have errors of {gain_db:g} dB and {phase_deg:g} deg (deviations), new in every region."


def unlike(weaker_db: float, rate_mps: float) -> str:
    """How targets of the data differ from two of equal power that stand still; nothing where they do not."""
    weaker = (
        f" The second target is up to {weaker_db:g} dB weaker than the first in the second stage of training; the "
        "publication's have equal power."
        if weaker_db > 0
        else ""
    )
    moving = (
        f" Half of the targets move at up to {rate_mps:g} m/s, the publication's do not move." if rate_mps > 0 else ""
    )
    return weaker + moving


def equal_still_pairs(targets: int, weaker_db: float, rate_mps: float) -> str:
    """What a network for two targets of the publication's data cannot be used for; empty for other networks."""
    if targets != 2:
        return ""
    untrained = [] if weaker_db > 0 else ["whose powers differ by 3 dB or more"]
    if rate_mps == 0:
        untrained.append("that move")
    if not untrained:
        return ""
    return (
        f"Not for two targets {' or '.join(untrained)}: its training has none. The measured shares are in the "
        "documentation, experiments-doa, under Unequal powers and motion."
    )


def unrolled_iaa(config: UnrolledIaaConfig) -> tuple[str, str]:
    """Of UAA."""
    return (
        f"A recurrent network of {config.layers} layers that share their weights, each an iteration of IAA on a grid "
        f"of {config.points} sines. {config.gradients} steps of conjugate gradients a layer take the place of the "
        f"inverse of the covariance; a gated convolution over {config.kernel} neighbouring points, of width "
        f"{config.width}, takes that of its quadratic forms, and tells the noise.",
        "The publication tells that the iterations of IAA become layers without matrix inverses. What these layers are "
        "made of, the lobes they are trained to answer with, and data and loss are ours.",
    )


def _layers(config: CovarianceConfig) -> str:
    hidden = " and ".join(str(width) for width in config.hidden)
    return (
        f"four convolutions of {config.filters} filters, the first of 3 x 3 at every other element, then 2 x 2, and "
        f"hidden layers of {hidden}, with batch normalisation"
    )


def covariance_cnn(config: CovarianceConfig) -> tuple[str, str]:
    """Of Papageorgiou's CNN."""
    return (
        f"On the covariance of {config.elements} elements as an image of three channels: {_layers(config)}. "
        f"{config.points} outputs, the probability of a source at each sine of the azimuth.",
        "The publication has 256 filters, hidden layers of 4096, 2048 and 1024, dropout, and 121 whole degrees. "
        "Here the grid is of sines, and labels are lobes a step of the grid wide, so that angles between its points "
        "can be told. Covariances are those of 16 to 2,000 snapshots.",
    )


def deep_music(config: CovarianceConfig) -> tuple[str, str]:
    """Of DeepMUSIC."""
    return (
        f"{config.sectors} networks, each for a sector of the sine of the azimuth, on the covariance of "
        f"{config.elements} elements as an image of three channels. Each: {_layers(config)}.",
        "Networks are smaller than the publication's. They learn the pseudo-spectrum that MUSIC has of the exact "
        "covariance and the true number of sources, down to 30 dB below its largest value, from covariances of 16 to "
        "2,000 snapshots. Sources are anywhere, where the publication has one a sector.",
    )
