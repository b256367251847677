"""ESPRIT by total least squares on a uniform array."""

import numpy as np

from covariance import covariance, signal_subspace, source_powers
from peaks import decibels
from result import Result


class Esprit:
    def __init__(self, positions, options):
        self.positions = np.asarray(positions, dtype=float)
        self.sources = options["sources"]

    def estimate(self, y):
        d = self.sources
        r = covariance(y)
        signal = signal_subspace(r, d)
        pair = np.hstack((signal[:-1], signal[1:]))
        smallest = np.linalg.eigh(pair.conj().T @ pair)[1][:, :d]
        rotation = -np.linalg.solve(smallest[d:].T, smallest[:d].T).T
        u = np.angle(np.linalg.eigvals(rotation)) / np.pi
        steering = np.exp(1j * np.pi * np.outer(self.positions, u))
        powers = source_powers(steering, y)
        order = np.argsort(-powers)
        return Result(np.degrees(np.arcsin(u[order])), decibels(powers[order]))
