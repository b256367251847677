"""Azimuth grid of an array on half wavelengths, and the two transforms that live on it.

The grid is uniform in u = sin(azimuth), u_g = -1 + 2 g / G, which is where an FFT puts it. Element
k stands at p_k half wavelengths and answers a wave from u with exp(j pi p_k u).
"""

import numpy as np


class Grid:
    def __init__(self, positions, points):
        positions = np.asarray(positions, dtype=float)
        indices = np.rint(positions).astype(int)
        if np.abs(positions - indices).max() > 1e-9:
            raise ValueError("positions must be whole half wavelengths")
        span = indices.max() - indices.min() + 1
        if 2 * span > points:
            raise ValueError(f"a grid of {points} points is too coarse for {span} half wavelengths")
        self.positions = positions
        self.points = points
        self.elements = len(positions)
        self.u = -1.0 + 2.0 * np.arange(points) / points
        self.azimuth_deg = np.degrees(np.arcsin(self.u))
        self._bins = indices % points
        self._signs = np.where(indices % 2 == 0, 1.0, -1.0)
        self.lags = span
        rows, columns = np.tril_indices(self.elements)
        lags = indices[rows] - indices[columns]
        sign = np.where(lags % 2 == 0, 1.0, -1.0)
        self._lower = columns * self.elements + rows
        self._lag = np.abs(lags)
        self._lag_real = sign
        self._lag_imag = np.where(lags < 0, -sign, sign)
        self._lag_sign = np.where(np.arange(span) % 2 == 0, 1.0, -1.0)
        self._toeplitz = indices[None, :] - indices[:, None] + span - 1

    def steering(self, u=None):
        """Elements x points."""
        u = self.u if u is None else np.atleast_1d(u)
        return np.exp(1j * np.pi * np.outer(self.positions, u))

    def correlate(self, y):
        """a(u_g)^H y for the columns of y: points, or columns x points."""
        if y.ndim == 1:
            scattered = np.zeros(self.points, dtype=complex)
            scattered[self._bins] = y * self._signs
        else:
            scattered = np.zeros((y.shape[1], self.points), dtype=complex)
            scattered[:, self._bins] = y.T * self._signs
        return np.fft.fft(scattered)

    def quadratic(self, matrix):
        """a(u_g)^H M a(u_g) for a Hermitian M, best in Fortran order, of which the lower triangle
        is read."""
        lower = matrix.T.reshape(-1)[self._lower]
        sums = np.empty(self.lags, dtype=complex)
        sums.real = np.bincount(self._lag, self._lag_real * lower.real, self.lags)
        sums.imag = np.bincount(self._lag, self._lag_imag * lower.imag, self.lags)
        self._sums = sums
        return np.fft.hfft(sums, self.points)

    def refine(self, u, steps=2):
        """Moves points near extrema of the quadratic form evaluated last onto them, by Newton
        steps of at most a quarter of a grid step all at once."""
        lags = np.arange(1, self.lags)
        twice = 2.0 * self._lag_sign[1:] * self._sums[1:]
        factor = -1j * np.pi * lags
        rows = np.column_stack((twice, twice * factor, twice * factor**2))
        limit = 0.5 / self.points
        for _ in range(steps):
            value, slope, bend = (np.exp(np.outer(u, factor)) @ rows).real.T
            u = u - np.clip(slope / bend, -limit, limit)
        return np.clip(u, -1.0, 1.0), value + self._sums[0].real

    def covariance(self, powers):
        """sum_g powers_g a(u_g) a(u_g)^H in Fortran order, from one real FFT."""
        lags = np.fft.rfft(powers)[: self.lags] * self._lag_sign
        both = np.concatenate((lags[:0:-1], lags.conj()))
        return both[self._toeplitz].T
