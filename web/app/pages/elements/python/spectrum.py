import boresight_widget as bw
import numpy as np

settings = {}

rng = np.random.default_rng(1)
truth = [-12, 20]  # deg, positive to the left


def steering(azimuth_deg):
    return np.exp(1j * np.pi * np.outer(np.arange(16), np.sin(np.radians(azimuth_deg))))


def noise(*shape):
    return rng.normal(size=shape) + 1j * rng.normal(size=shape)


snapshots = steering(truth) @ noise(2, 50) + 0.1 * noise(16, 50)
grid = np.linspace(-60, 60, 481)
inverse = np.linalg.inv(snapshots @ snapshots.conj().T / 50)
capon = 1 / np.einsum("en,ef,fn->n", steering(grid).conj(), inverse, steering(grid)).real
peaks = 1 + np.flatnonzero((capon[1:-1] > capon[:-2]) & (capon[1:-1] > capon[2:]))
strongest = peaks[np.argsort(capon[peaks])[-2:]]

spectrum = bw.Spectrum(
    estimates={
        "method": "capon",
        "sources": {"azimuth_deg": grid[strongest]},
        "spectrum": {"azimuth_deg": grid, "values_db": 10 * np.log10(capon)},
    },
    truth_deg=truth,
    **settings,
)
spectrum
