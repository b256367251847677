"""Min-norm: the vector of the noise subspace with first entry 1 and least norm."""

import numpy as np

from covariance import covariance, signal_subspace
from grid import Grid
from nulls import search


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
        form = np.outer(vector.conj(), vector).T
        return search(self.grid, form, self.sources, self.grid, y)
