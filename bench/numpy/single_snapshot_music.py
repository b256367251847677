"""MUSIC on the Hankel matrix of one snapshot of a uniform array."""

import numpy as np

from grid import Grid
from nulls import noise_projector, search


class SingleSnapshotMusic:
    def __init__(self, positions, options):
        rows = len(positions) // 2 + 1
        columns = len(positions) - rows + 1
        self.grid = Grid(positions[:rows], options["gridPoints"])
        self.full = Grid(positions, options["gridPoints"])
        self.sources = options["sources"]
        self.hankel = np.arange(rows)[:, None] + np.arange(columns)[None, :]

    def estimate(self, y):
        left = np.linalg.svd(y[self.hankel, 0], full_matrices=False)[0][:, : self.sources]
        return search(self.grid, noise_projector(left), self.sources, self.full, y)
