"""Delay and sum: a^H R a by one FFT."""

import numpy as np

from covariance import covariance
from grid import Grid
from peaks import decibels, peak_sines
from result import Result


class Bartlett:
    def __init__(self, positions, options):
        self.grid = Grid(positions, options["gridPoints"])
        self.options = options

    def estimate(self, y):
        power = self.grid.quadratic(covariance(y))
        spectrum = decibels(power / self.grid.elements**2)
        limits = self.options["maxPeaks"], self.options["dynamicRangeDb"]
        near, _ = peak_sines(spectrum, self.grid, *limits)
        u, top = self.grid.refine(near)
        azimuth_deg = np.degrees(np.arcsin(u))
        return Result(azimuth_deg, decibels(top / self.grid.elements**2), spectrum)
