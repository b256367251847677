"""The methods by name."""

from bartlett import Bartlett
from capon import Capon
from esprit import Esprit
from iaa import DenseIaa, FastIaa
from maximum_likelihood import MaximumLikelihood
from min_norm import MinNorm
from music import Music
from nomp import Nomp
from root_music import RootMusic
from single_snapshot_music import SingleSnapshotMusic
from sparse_bayesian import SparseBayesian

METHODS = {
    "bartlett": Bartlett,
    "capon": Capon,
    "music": Music,
    "single-snapshot-music": SingleSnapshotMusic,
    "root-music": RootMusic,
    "esprit": Esprit,
    "min-norm": MinNorm,
    "iaa": FastIaa,
    "iaa-dense": DenseIaa,
    "nomp": Nomp,
    "maximum-likelihood": MaximumLikelihood,
    "sparse-bayesian": SparseBayesian,
}
