"""Minimum-variance beamformer: 1 / a^H R^-1 a, the quadratic form by one FFT."""

from scipy.linalg.lapack import zpotrf, zpotri

from covariance import covariance
from grid import Grid
from peaks import decibels, peaks
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
        return Result(
            *peaks(spectrum, self.grid, self.options["maxPeaks"], self.options["dynamicRangeDb"]),
            spectrum,
        )
