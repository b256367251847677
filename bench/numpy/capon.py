"""Minimum-variance beamformer: 1 / a^H R^-1 a, the quadratic form by one FFT."""

import numpy as np
from scipy.linalg.lapack import zpotrf, zpotri

from covariance import covariance
from grid import Grid
from peaks import decibels, peak_sines
from result import Result


class Capon:
    def __init__(self, positions, options):
        self.grid = Grid(positions, options["gridPoints"])
        self.options = options

    def estimate(self, y):
        factor, failed = zpotrf(covariance(y), lower=1, overwrite_a=1)
        inverse, _ = zpotri(factor, lower=1, overwrite_c=1)
        if failed:
            raise ValueError("the covariance is singular")
        spectrum = decibels(1.0 / self.grid.quadratic(inverse))
        limits = self.options["maxPeaks"], self.options["dynamicRangeDb"]
        near, _ = peak_sines(spectrum, self.grid, *limits)
        u, bottom = self.grid.refine(near)
        return Result(np.degrees(np.arcsin(u)), decibels(1.0 / bottom), spectrum)
