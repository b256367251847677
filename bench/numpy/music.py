"""MUSIC: 1 / |En^H a|^2 = 1 / (K - |Es^H a|^2), by one FFT of a projector's lag sums."""

import numpy as np

from covariance import covariance, projector, signal_subspace
from grid import Grid
from peaks import decibels, peaks
from result import Result


class Music:
    def __init__(self, positions, options):
        self.grid = Grid(positions, options["gridPoints"])
        self.sources = options["sources"]

    def estimate(self, y):
        signal = signal_subspace(covariance(y), self.sources)
        inside = self.grid.quadratic(projector(signal))
        spectrum = decibels(1.0 / np.maximum(self.grid.elements - inside, 1e-12))
        return Result(*peaks(spectrum, self.grid, self.sources), spectrum)
