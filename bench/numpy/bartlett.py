"""Delay and sum: one FFT of a single snapshot, or one FFT of the covariance's lag sums."""

from covariance import covariance
from grid import Grid
from peaks import decibels, peaks
from result import Result


class Bartlett:
    def __init__(self, positions, options):
        self.grid = Grid(positions, options["gridPoints"])
        self.options = options

    def estimate(self, y):
        if y.shape[1] == 1:
            z = self.grid.correlate(y[:, 0])
            power = z.real**2 + z.imag**2
        else:
            power = self.grid.quadratic(covariance(y))
        spectrum = decibels(power / self.grid.elements**2)
        return Result(
            *peaks(spectrum, self.grid, self.options["maxPeaks"], self.options["dynamicRangeDb"]),
            spectrum,
        )
