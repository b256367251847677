"""Writes reference.json: the estimators worked out with NumPy straight from their definitions.

Nothing is shared with the Rust code: dense quadratic forms with numpy.linalg.eigh and inv, roots by
numpy.roots, minima by golden section. Run `python make.py` (NumPy 2) to write it again.
"""

import json
from pathlib import Path

import numpy as np

GRID = 64
SOURCES = 2
SNAPSHOTS = 24


def steering(y, u):
    """Elements x directions, for positions y along the array in half wavelengths."""
    return np.exp(1j * np.pi * np.outer(y, u))


def golden_section(function, low, high):
    ratio = (np.sqrt(5.0) - 1.0) / 2.0
    for _ in range(200):
        left, right = high - ratio * (high - low), low + ratio * (high - low)
        if function(left) < function(right):
            high = right
        else:
            low = left
    return (low + high) / 2.0


def minima(function):
    """The two deepest local minima over u, found on a fine grid and refined."""
    u = np.linspace(-0.999, 0.999, 40001)
    values = np.array([function(x) for x in u])
    inner = np.flatnonzero((values[1:-1] < values[:-2]) & (values[1:-1] < values[2:])) + 1
    deepest = inner[np.argsort(values[inner])[:SOURCES]]
    found = [golden_section(function, u[k - 1], u[k + 1]) for k in deepest]
    return sorted(float(np.arcsin(x)) for x in found)


def case(name, y, seed):
    y = np.asarray(y, dtype=float)
    rng = np.random.default_rng(seed)

    def normal(*shape):
        return (rng.standard_normal(shape) + 1j * rng.standard_normal(shape)) / np.sqrt(2.0)

    truth = np.radians([-8.0, 11.0])
    signals = normal(SOURCES, SNAPSHOTS) * np.sqrt([[1.0], [0.4]])
    data = steering(y, np.sin(truth)) @ signals + normal(len(y), SNAPSHOTS) * 0.3
    data = np.round(data, 6)
    r = data @ data.conj().T / SNAPSHOTS
    values, vectors = np.linalg.eigh(r)
    noise = vectors[:, : len(y) - SOURCES]
    projector = noise @ noise.conj().T
    inverse = np.linalg.inv(r)
    shortest = projector[:, 0] / projector[0, 0].real
    u = -1.0 + 2.0 * np.arange(GRID) / GRID
    a = steering(y, u)

    def form(matrix):
        return np.einsum("kg,kl,lg->g", a.conj(), matrix, a).real

    result = {
        "name": name,
        "y": y.tolist(),
        "real": data.real.tolist(),
        "imag": data.imag.tolist(),
        "eigenvalues": values[::-1].tolist(),
        "bartlett": (form(r) / len(y) ** 2).tolist(),
        "capon": (1.0 / form(inverse)).tolist(),
        "music": (len(y) / form(projector)).tolist(),
        "minNorm": (len(y) / np.abs(a.conj().T @ shortest) ** 2).tolist(),
        "musicAzimuths": minima(lambda x: (steering(y, [x]).conj().T @ projector @ steering(y, [x])).real.item()),
    }
    if np.allclose(y, np.arange(len(y))):
        n = len(y)
        lags = [np.trace(projector, offset=m) for m in range(-(n - 1), n)]
        roots = np.roots(lags[::-1])
        inside = roots[np.abs(roots) < 1.0]
        nearest = inside[np.argsort(1.0 - np.abs(inside))[:SOURCES]]
        result["rootMusicAzimuths"] = np.sort(np.arcsin(np.angle(nearest) / np.pi)).tolist()
        signal = vectors[:, n - SOURCES :]
        rotation = np.linalg.lstsq(signal[:-1], signal[1:], rcond=None)[0]
        turns = np.linalg.eigvals(rotation)
        result["espritAzimuths"] = np.sort(np.arcsin(np.angle(turns) / np.pi)).tolist()
        pair = np.hstack((signal[:-1], signal[1:]))
        right = np.linalg.svd(pair)[2].conj().T[:, SOURCES:]
        rotation = -right[:SOURCES] @ np.linalg.inv(right[SOURCES:])
        turns = np.linalg.eigvals(rotation)
        result["totalEspritAzimuths"] = np.sort(np.arcsin(np.angle(turns) / np.pi)).tolist()
    return result


cases = [
    case("uniform", np.arange(9), 1),
    case("gaps", [0, 1, 4, 7, 9, 12], 2),
    case("no lattice", [0, 0.9, 2.3, 2.3 + np.sqrt(2), 5.1, 6.77], 3),
]
Path(__file__).with_name("reference.json").write_text(json.dumps(cases) + "\n")
