"""Reference results of IAA and off-grid sparse Bayesian learning, straight from their papers'
formulas over whole matrices, written to sparse.json. Needs NumPy; run it in this folder."""

import json

import numpy as np


def steering(positions, u):
    return np.exp(1j * np.pi * np.outer(positions, u))


def scene(positions, sines, snapshots, noise, rng):
    s = np.exp(2j * np.pi * rng.random((len(sines), snapshots)))
    n = rng.normal(size=(2, len(positions), snapshots)) * np.sqrt(noise / 2)
    return steering(positions, sines) @ s + n[0] + 1j * n[1]


def iaa(a, y, iterations):
    """Yardibi et al. 2010, table II."""
    elements = a.shape[0]
    power = (np.abs(a.conj().T @ y) ** 2).mean(axis=1) / elements**2
    for _ in range(iterations):
        inverse = np.linalg.inv(a @ np.diag(power) @ a.conj().T)
        denominator = np.real(np.sum(a.conj() * (inverse @ a), axis=0))
        power = (np.abs(a.conj().T @ inverse @ y) ** 2).mean(axis=1) / denominator**2
    return power


def ogsbi(positions, points, y, iterations):
    """Yang, Xie and Zhang 2013, with the posterior covariance of the whole grid."""
    elements, snapshots = y.shape
    u = -1 + 2 * np.arange(points) / points
    a = steering(positions, u)
    b = 1j * np.pi * positions[:, None] * a
    rho, c, d, half = 0.01, 1e-4, 1e-4, 1 / points
    scale = np.sqrt((np.abs(y) ** 2).mean())
    y = y / scale
    alpha = np.sqrt((np.abs(a.conj().T @ y) ** 2).mean(axis=1)) / elements
    noise, beta = 0.01, np.zeros(points)
    for _ in range(iterations):
        phi = a + b * beta
        model = noise * np.eye(elements) + phi @ np.diag(alpha) @ phi.conj().T
        gain = np.diag(alpha) @ phi.conj().T @ np.linalg.inv(model)
        mu = gain @ y
        sigma = np.diag(alpha) - gain @ phi @ np.diag(alpha)
        energy = (np.abs(mu) ** 2).sum(axis=1) + snapshots * np.real(np.diag(sigma))
        gamma = 1 - np.real(np.diag(sigma)) / alpha
        error = (np.abs(y - phi @ mu) ** 2).sum()
        noise = (error + snapshots * noise * gamma.sum() + d) / (snapshots * elements + c - 1)
        alpha = (np.sqrt(snapshots**2 + 4 * rho * energy) - snapshots) / (2 * rho)
        left, right = np.roll(alpha, 1), np.roll(alpha, -1)
        peaks = np.flatnonzero((alpha > left) & (alpha >= right))
        peaks = peaks[np.argsort(-alpha[peaks])[: elements - 1]]
        second = mu @ mu.conj().T + snapshots * sigma
        p = np.real((b.conj().T @ b).conj() * second)
        v = np.real(np.sum(mu.conj() * (b.conj().T @ (y - a @ mu)), axis=1))
        v -= snapshots * np.real(np.diag(b.conj().T @ a @ sigma))
        beta = np.zeros(points)
        solved = np.linalg.solve(p[np.ix_(peaks, peaks)], v[peaks])
        beta[peaks] = np.clip(solved, -half, half)
    return alpha * scale**2


def case(positions, points, sines, snapshots, noise, rng):
    positions = np.array(positions, dtype=float)
    y = scene(positions, np.array(sines), snapshots, noise, rng)
    return (
        positions,
        y,
        {
            "positions": positions.tolist(),
            "points": points,
            "re": y.real.tolist(),
            "im": y.imag.tolist(),
        },
    )


def main():
    rng = np.random.default_rng(1)
    tx, rx = [0, 18, 30, 42, 62, 78], [0, 3, 4, 5, 7, 8, 13, 14]
    lrr48 = [t + r for t in tx for r in rx]
    cases = []
    for positions, points, snapshots in [
        (lrr48, 128, 1),
        (range(10), 64, 3),
        ([0, 0.5, 1.5, 2, 3.5], 40, 2),
        ([0, 1.1, 1.9, 3.2, 5.3], 40, 1),
    ]:
        positions, y, stored = case(positions, points, [-0.31, 0.2], snapshots, 0.01, rng)
        u = -1 + 2 * np.arange(points) / points
        stored["method"] = "iaa"
        stored["iterations"] = 10
        stored["power"] = iaa(steering(positions, u), y, 10).tolist()
        cases.append(stored)
    for positions, points, snapshots in [
        (range(8), 48, 1),
        (range(8), 48, 12),
        ([0, 1, 4, 6, 9, 11], 64, 3),
        ([0, 1.1, 1.9, 3.2, 5.3], 32, 2),
    ]:
        positions, y, stored = case(positions, points, [-0.31, 0.2], snapshots, 0.01, rng)
        stored["method"] = "sparse-bayesian"
        stored["iterations"] = 12
        stored["power"] = ogsbi(positions, points, y, 12).tolist()
        cases.append(stored)
    with open("sparse.json", "w") as file:
        json.dump(cases, file, separators=(",", ":"))
        file.write("\n")


if __name__ == "__main__":
    main()
