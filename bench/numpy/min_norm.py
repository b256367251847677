"""Min-norm: the vector of the noise subspace with first entry 1 and least norm, one FFT."""

import numpy as np

from covariance import covariance, signal_subspace
from grid import Grid
from peaks import decibels, peaks
from result import Result


class MinNorm:
    def __init__(self, positions, options):
        self.grid = Grid(positions, options["gridPoints"])
        self.sources = options["sources"]

    def estimate(self, y):
        signal = signal_subspace(covariance(y), self.sources)
        first = signal[0].conj()
        vector = -(signal @ first)
        vector[0] += 1.0
        vector /= 1.0 - np.vdot(first, first).real
        z = self.grid.correlate(vector)
        spectrum = decibels(1.0 / np.maximum(z.real**2 + z.imag**2, 1e-12))
        return Result(*peaks(spectrum, self.grid, self.sources), spectrum)
