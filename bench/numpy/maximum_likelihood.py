"""Deterministic maximum likelihood: alternating projection on the grid (Ziskind and Wax 1988),
then Gauss-Newton steps on the concentrated likelihood to the tolerance."""

import numpy as np

from covariance import covariance, projector, source_powers
from grid import Grid
from peaks import decibels
from result import Result


class MaximumLikelihood:
    def __init__(self, positions, options):
        self.grid = Grid(positions, options["gridPoints"])
        self.positions = self.grid.positions
        self.sources = options["sources"]
        self.iterations = options["maxIterations"]
        self.tolerance = options["tolerance"]
        self.identity = np.eye(self.grid.elements)

    def estimate(self, y):
        r = covariance(y)
        chosen = []
        for _ in range(self.sources):
            chosen.append(self.best(r, chosen))
        for _ in range(self.iterations):
            before = list(chosen)
            for i in range(self.sources):
                chosen[i] = self.best(r, chosen[:i] + chosen[i + 1 :])
            if chosen == before:
                break
        u, iterations = self.polish(r, self.grid.u[chosen])
        powers = source_powers(self.grid.steering(u), y)
        order = np.argsort(-powers)
        return Result(
            np.degrees(np.arcsin(np.clip(u[order], -1.0, 1.0))),
            decibels(powers[order]),
            iterations=iterations,
        )

    def best(self, r, others):
        """Grid point that explains most of what the others leave."""
        if not others:
            return int(self.grid.quadratic(r).argmax())
        basis = np.linalg.qr(self.grid.steering(self.grid.u[others]))[0]
        left = self.identity - projector(basis)
        numerator = self.grid.quadratic((left @ r) @ left)
        denominator = self.grid.elements - self.grid.quadratic(projector(basis))
        near = denominator < 1e-9 * self.grid.elements
        return int(np.where(near, 0.0, numerator / np.where(near, 1.0, denominator)).argmax())

    def polish(self, r, u):
        cap = 2.0 / self.grid.points
        for iteration in range(self.iterations):  # noqa: B007 (read after the loop)
            a = self.grid.steering(u)
            slope = (1j * np.pi * self.positions)[:, None] * a
            adjoint = a.conj().T
            inverse = np.linalg.solve(adjoint @ a, adjoint)
            explained = inverse @ r
            slope_left = slope - a @ (inverse @ slope)
            gradient = np.einsum("ik,ki->i", explained, slope_left).real
            hessian = (slope_left.conj().T @ slope_left) * (explained @ inverse.conj().T).T
            step = np.clip(np.linalg.solve(hessian.real, gradient), -cap, cap)
            u = u + step
            if np.abs(step).max() < self.tolerance:
                break
        return u, iteration + 1
