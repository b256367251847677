"""MUSIC: the nulls of a^H (I - E E^H) a."""

from covariance import covariance, signal_subspace
from grid import Grid
from nulls import noise_projector, search


class Music:
    def __init__(self, positions, options):
        self.grid = Grid(positions, options["gridPoints"])
        self.sources = options["sources"]

    def estimate(self, y):
        signal = signal_subspace(covariance(y), self.sources)
        return search(self.grid, noise_projector(signal), self.sources, self.grid, y)
