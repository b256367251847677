"""Root-MUSIC on a uniform array: the roots nearest the unit circle, by np.roots."""

import numpy as np

from covariance import covariance, signal_subspace, source_powers
from peaks import decibels
from result import Result


class RootMusic:
    def __init__(self, positions, options):
        self.positions = np.asarray(positions, dtype=float)
        self.sources = options["sources"]
        elements = len(positions)
        rows, columns = np.indices((elements, elements))
        self.diagonal = (columns - rows + elements - 1).reshape(-1)

    def estimate(self, y):
        r = covariance(y)
        signal = signal_subspace(r, self.sources)
        projector = np.eye(len(r)) - signal @ signal.conj().T
        flat = projector.reshape(-1)
        count = 2 * len(r) - 1
        lags = np.bincount(self.diagonal, flat.real, count) + 1j * np.bincount(self.diagonal, flat.imag, count)
        # a^H P a = sum_m lags[m] z^m with z = exp(j pi u) and m the column minus the row.
        roots = np.roots(lags[::-1])
        inside = roots[np.abs(roots) < 1.0]
        nearest = inside[np.argsort(1.0 - np.abs(inside))[: self.sources]]
        u = np.angle(nearest) / np.pi
        steering = np.exp(1j * np.pi * np.outer(self.positions, u))
        powers = source_powers(steering, y)
        order = np.argsort(-powers)
        return Result(np.degrees(np.arcsin(u[order])), decibels(powers[order]))
