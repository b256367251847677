"""IAA, fast (three FFTs and one factorisation an iteration) and dense."""

import numpy as np
from scipy.linalg.lapack import zpotrf, zpotri, zpotrs

from grid import Grid
from peaks import decibels, peaks
from result import Result


class FastIaa:
    def __init__(self, positions, options):
        self.grid = Grid(positions, options["gridPoints"])
        self.options = options

    def estimate(self, y):
        grid = self.grid
        power = start(grid, y)
        for _ in range(self.options["iterations"]):
            factor, failed = zpotrf(grid.covariance(power), lower=1, overwrite_a=1)
            if failed:
                raise ValueError("the model covariance is singular")
            weighted, _ = zpotrs(factor, y, lower=1)
            inverse, _ = zpotri(factor, lower=1, overwrite_c=1)
            power = mean_power(grid.correlate(weighted).T) / grid.quadratic(inverse) ** 2
        return finish(grid, power, self.options)


class DenseIaa:
    def __init__(self, positions, options):
        self.grid = Grid(positions, options["gridPoints"])
        self.steering = self.grid.steering()
        self.adjoint = self.steering.conj().T.copy()
        self.options = options

    def estimate(self, y):
        power = start(self.grid, y)
        for _ in range(self.options["iterations"]):
            r = (self.steering * power) @ self.adjoint
            factor, failed = zpotrf(r, lower=1)
            if failed:
                raise ValueError("the model covariance is singular")
            weighted, _ = zpotrs(factor, self.steering, lower=1)
            # a^H R^-1 y and a^H R^-1 a from the columns of R^-1 A.
            numerator = weighted.conj().T @ y
            denominator = np.einsum("kg,kg->g", self.steering.conj(), weighted).real
            power = mean_power(numerator) / denominator**2
        return finish(self.grid, power, self.options)


def start(grid, y):
    return mean_power(grid.correlate(y).T) / grid.elements**2


def mean_power(z):
    """Mean of |z|^2 over snapshots: points x snapshots."""
    return (z.real**2 + z.imag**2).mean(axis=1)


def finish(grid, power, options):
    spectrum = decibels(power)
    return Result(
        *peaks(spectrum, grid, options["maxPeaks"], options["dynamicRangeDb"]),
        spectrum,
        options["iterations"],
    )
