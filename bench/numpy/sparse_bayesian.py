"""Off-grid sparse Bayesian inference (Yang, Xie and Zhang 2013), in the form that inverts a matrix
of the array's size: C = s I + Phi diag(alpha) Phi^H with Phi = A + B diag(beta). Offsets beta are
zero but at a few points, so that sums over the grid are FFTs and those points a correction."""

import numpy as np

from grid import Grid
from peaks import decibels
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
        scale = np.sqrt((y.real**2 + y.imag**2).mean())
        y = y / scale
        alpha = np.abs(self.grid.correlate(y)).mean(axis=0) / elements
        noise = 0.01
        active = np.empty(0, dtype=int)
        offsets = np.empty(0)
        for iteration in range(self.options["maxIterations"]):  # noqa: B007 (read after the loop)
            b_active = self.b[:, active]
            phi = self.a[:, active] + b_active * offsets
            powers = alpha[active]
            plain = alpha.copy()
            plain[active] = 0.0
            adjoint = phi.conj().T
            c = self.grid.covariance(plain) + (phi * powers) @ adjoint
            c.flat[:: elements + 1] += noise
            inverse = np.linalg.inv(c)
            z = inverse @ y
            seen = self.grid.correlate(z)
            response = (seen.real**2 + seen.imag**2).sum(axis=0)
            share = self.grid.quadratic(inverse)
            phi_z = adjoint @ z
            response[active] = (phi_z.real**2 + phi_z.imag**2).sum(axis=1)
            share[active] = np.einsum("ik,ki->i", adjoint, inverse @ phi).real
            share *= alpha
            energy = alpha**2 * response + snapshots * alpha * (1.0 - share)
            before = alpha
            alpha = (np.sqrt(snapshots**2 + 4.0 * self.rho * energy) - snapshots) / (2.0 * self.rho)
            old_noise = noise
            error = noise**2 * (z.real**2 + z.imag**2).sum()
            noise = (error + snapshots * noise * share.sum() + self.d) / (snapshots * elements + self.c - 1.0)
            moved = b_active * (offsets * powers)
            known = np.zeros(self.grid.points)
            known[active] = offsets
            active = self.active(alpha, elements - 1)
            offsets = self.offsets(active, known[active], before[active], z, inverse, old_noise, moved, adjoint)
            change = np.linalg.norm(alpha - before) / np.linalg.norm(before)
            if change < self.options["tolerance"]:
                break
        beta = np.zeros(self.grid.points)
        beta[active] = offsets
        return self.result(alpha, beta, scale, iteration + 1)

    def active(self, alpha, most):
        """The highest local maxima, most of them at most."""
        left, right = np.roll(alpha, 1), np.roll(alpha, -1)
        found = np.flatnonzero((alpha > left) & (alpha >= right))
        return found[np.argsort(-alpha[found])[:most]]

    def offsets(self, active, known, alpha, z, inverse, noise, moved, old_adjoint):
        """Minimises the expected misfit over the offsets of the active points."""
        snapshots = z.shape[1]
        a, b = self.a[:, active], self.b[:, active]
        phi = a + b * known
        weighted = inverse @ phi
        mu = alpha[:, None] * (phi.conj().T @ z)
        sigma = np.diag(alpha) - alpha[:, None] * (phi.conj().T @ weighted) * alpha
        second = mu @ mu.conj().T + snapshots * sigma
        p = ((b.conj().T @ b).conj() * second).real
        # y - A mu, and A Sigma over alpha, from C^-1 and what was displaced.
        left = noise * z + moved @ (old_adjoint @ z)
        spread = a - phi + noise * weighted + moved @ (old_adjoint @ weighted)
        v = (mu.conj() * (b.conj().T @ left)).sum(axis=1).real
        v -= snapshots * alpha * np.einsum("ki,ki->i", b.conj(), spread).real
        half = 1.0 / self.grid.points
        try:
            solved = np.linalg.solve(p, v)
        except np.linalg.LinAlgError:
            solved = v / np.maximum(p.diagonal(), 1e-300)
        return np.clip(solved, -half, half)

    def result(self, alpha, beta, scale, iterations):
        power = alpha * scale**2
        spectrum = decibels(power)
        left, right = np.roll(spectrum, 1), np.roll(spectrum, -1)
        found = np.flatnonzero((spectrum > left) & (spectrum >= right))
        found = found[np.argsort(-spectrum[found])]
        found = found[spectrum[found] >= spectrum.max() - self.options["dynamicRangeDb"]]
        found = found[: self.options["maxPeaks"]]
        u = np.clip(self.grid.u[found] + beta[found], -1.0, 1.0)
        return Result(np.degrees(np.arcsin(u)), spectrum[found], spectrum, iterations)
