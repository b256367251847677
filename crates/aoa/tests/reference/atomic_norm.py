"""Reference minima of atomic norm denoising, by the semidefinite program of Bhaskar, Tang and Recht (2013) and Yang
and Xie (2016), solved by the alternating direction method of multipliers, written to atomic_norm.json. Needs NumPy; run
it in this folder.

The atoms are the whole line of places, of which elements are some. With unit amplitudes at the elements the program is

    min 1/2 ||Y - S X||^2 + tau / 2 (t_0 + tr W)   with   [[T(t), X], [X^H, W]] >= 0 ,

where T(t) is the Hermitian Toeplitz matrix of the first row t, and S takes the places of the elements.
"""

import json

import numpy as np


def toeplitz(t):
    places = np.arange(len(t))
    lags = places[:, None] - places[None, :]
    return np.where(lags >= 0, t[np.abs(lags)], t[np.abs(lags)].conj())


def solve(places, y, tau, rounds=60000, rho=None):
    span, snapshots = places[-1] + 1, y.shape[1]
    size = span + snapshots
    rho = rho or tau
    seen = np.zeros(span)
    seen[places] = 1.0
    whole = np.zeros((span, snapshots), complex)
    whole[places] = y
    z, multiplier = np.zeros((size, size), complex), np.zeros((size, size), complex)
    counts = span - np.arange(span)
    for _ in range(rounds):
        target = z + multiplier / rho
        # The block X enters twice, the data term once.
        x = (whole + 2 * rho * target[:span, span:]) / (seen[:, None] + 2 * rho)
        w = target[span:, span:] - tau / 2 / rho * np.eye(snapshots)
        t = np.array([np.trace(target[:span, :span], -lag) for lag in range(span)]) / counts
        t[0] -= tau / 2 / rho / span
        block = np.block([[toeplitz(t), x], [x.conj().T, (w + w.conj().T) / 2]])
        values, vectors = np.linalg.eigh(block - multiplier / rho)
        before, z = z, (vectors * np.maximum(values, 0)) @ vectors.conj().T
        multiplier = multiplier + rho * (z - block)
        if np.linalg.norm(z - block) + np.linalg.norm(z - before) < 1e-10 * np.linalg.norm(z):
            break
    value = 0.5 * np.linalg.norm(y - x[places]) ** 2 + tau / 2 * (t[0].real + np.trace(w).real)
    return float(value)


def case(places, sines, snapshots, noise, tau, seed):
    rng = np.random.default_rng(seed)
    places = np.array(places)
    a = np.exp(1j * np.pi * np.outer(places, sines))
    s = np.exp(2j * np.pi * rng.random((len(sines), snapshots)))
    n = rng.normal(size=(2, len(places), snapshots)) * np.sqrt(noise / 2)
    y = np.round(a @ s + n[0] + 1j * n[1], 6)
    value = solve(places, y, tau)
    return {"places": places.tolist(), "tau": tau, "re": y.real.tolist(), "im": y.imag.tolist(), "minimum": value}


if __name__ == "__main__":
    cases = [
        case(range(8), [-0.3, 0.4], 1, 0.01, 1.0, 1),
        case(range(8), [-0.05, 0.12], 1, 0.1, 2.0, 2),
        case([0, 1, 2, 5, 7, 11, 12], [-0.5, 0.1, 0.33], 1, 0.02, 1.0, 3),
        case(range(10), [0.1, 0.2], 4, 0.05, 2.0, 4),
    ]
    with open("atomic_norm.json", "w", encoding="utf-8") as file:
        json.dump(cases, file)
        file.write("\n")
