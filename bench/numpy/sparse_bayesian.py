"""Off-grid sparse Bayesian inference (Yang, Xie and Zhang 2013), in the form that inverts a matrix
of the array's size: C = s I + Phi diag(alpha) Phi^H with Phi = A + B diag(beta)."""

import numpy as np

from grid import Grid
from peaks import decibels, peaks
from result import Result


class SparseBayesian:
    def __init__(self, positions, options):
        self.grid = Grid(positions, options["gridPoints"])
        self.options = options
        self.a = self.grid.steering()
        self.b = (1j * np.pi * self.grid.positions)[:, None] * self.a
        self.rho, self.c, self.d = 0.01, 1e-4, 1e-4

    def estimate(self, y):
        elements, snapshots = y.shape
        half = 1.0 / self.grid.points
        scale = np.sqrt((y.real**2 + y.imag**2).mean())
        y = y / scale
        phi = self.a
        beta = np.zeros(self.grid.points)
        alpha = np.abs(phi.conj().T @ y).mean(axis=1) / elements
        noise = 0.01
        for iteration in range(self.options["maxIterations"]):
            c = (phi * alpha) @ phi.conj().T
            c.flat[:: elements + 1] += noise
            inverse = np.linalg.inv(c)
            weighted = inverse @ phi
            mu = (weighted.conj().T @ y) * alpha[:, None]
            share = alpha * np.einsum("kg,kg->g", phi.conj(), weighted).real
            variance = alpha * (1.0 - share)
            energy = (mu.real**2 + mu.imag**2).sum(axis=1) + snapshots * variance
            residual = y - phi @ mu
            error = (residual.real**2 + residual.imag**2).sum()
            noise = (error + snapshots * noise * share.sum() + self.d) / (
                snapshots * elements + self.c - 1.0
            )
            before = alpha
            alpha = (np.sqrt(snapshots**2 + 4.0 * self.rho * energy) - snapshots) / (2.0 * self.rho)
            active = self.active(alpha, elements - 1)
            beta = self.offsets(y, before, mu, weighted, phi, active, half)
            phi = self.a + self.b * beta
            change = np.linalg.norm(alpha - before) / np.linalg.norm(before)
            if change < self.options["tolerance"]:
                break
        return self.result(alpha, beta, mu, scale, iteration + 1)

    def active(self, alpha, most):
        """The highest local maxima, most of them at most."""
        left, right = np.roll(alpha, 1), np.roll(alpha, -1)
        found = np.flatnonzero((alpha > left) & (alpha >= right))
        return found[np.argsort(-alpha[found])[:most]]

    def offsets(self, y, alpha, mu, weighted, phi, active, half):
        """Minimises the expected misfit over the offsets of the active points."""
        snapshots = y.shape[1]
        b, mu_active = self.b[:, active], mu[active]
        alpha_active = alpha[active]
        cross = phi[:, active].conj().T @ weighted[:, active]
        sigma = np.diag(alpha_active) - alpha_active[:, None] * cross * alpha_active
        second = mu_active @ mu_active.conj().T + snapshots * sigma
        p = ((b.conj().T @ b).conj() * second).real
        # A Sigma restricted to the active columns.
        a_alpha = self.a * alpha
        a_sigma = a_alpha[:, active] - (a_alpha @ phi.conj().T) @ (
            weighted[:, active] * alpha_active
        )
        left = y - self.a @ mu
        v = (mu_active.conj() * (b.conj().T @ left)).sum(axis=1).real
        v -= snapshots * np.einsum("ki,ki->i", b.conj(), a_sigma).real
        beta = np.zeros(self.grid.points)
        try:
            solved = np.linalg.solve(p, v)
        except np.linalg.LinAlgError:
            solved = v / np.maximum(p.diagonal(), 1e-300)
        beta[active] = np.clip(solved, -half, half)
        return beta

    def result(self, alpha, beta, mu, scale, iterations):
        power = alpha * scale**2
        spectrum = decibels(power)
        left, right = np.roll(spectrum, 1), np.roll(spectrum, -1)
        found = np.flatnonzero((spectrum > left) & (spectrum >= right))
        found = found[np.argsort(-spectrum[found])]
        found = found[spectrum[found] >= spectrum.max() - self.options["dynamicRangeDb"]]
        found = found[: self.options["maxPeaks"]]
        u = np.clip(self.grid.u[found] + beta[found], -1.0, 1.0)
        return Result(np.degrees(np.arcsin(u)), spectrum[found], spectrum, iterations)
