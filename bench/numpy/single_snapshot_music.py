"""MUSIC on the Hankel matrix of one snapshot of a uniform array."""

import numpy as np

from covariance import projector
from grid import Grid
from peaks import decibels, peaks
from result import Result


class SingleSnapshotMusic:
    def __init__(self, positions, options):
        rows = len(positions) // 2 + 1
        columns = len(positions) - rows + 1
        self.grid = Grid(positions[:rows], options["gridPoints"])
        self.sources = options["sources"]
        self.hankel = np.arange(rows)[:, None] + np.arange(columns)[None, :]

    def estimate(self, y):
        left = np.linalg.svd(y[self.hankel, 0], full_matrices=False)[0][:, : self.sources]
        inside = self.grid.quadratic(projector(left))
        spectrum = decibels(1.0 / np.maximum(self.grid.elements - inside, 1e-12))
        return Result(*peaks(spectrum, self.grid, self.sources), spectrum)
