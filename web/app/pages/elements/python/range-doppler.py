import boresight_widget as bw
import numpy as np

settings = {}

rng = np.random.default_rng(1)
loops, samples = 64, 128
bins = np.array([[30, 10], [70, -20]])  # of range and Doppler
phase = np.einsum(
    "tk,kij->tij", 2 * np.pi * bins, np.indices((samples, loops)) / np.array([samples, loops])[:, None, None]
)
cube = np.exp(1j * phase).sum(axis=0) + rng.normal(size=(samples, loops))
window = np.outer(np.hanning(samples), np.hanning(loops))
power = np.abs(np.fft.fftshift(np.fft.fft2(cube * window), axes=1)) ** 2

range_m = np.arange(samples) * 0.5
rate_mps = (np.arange(loops) - loops // 2) * 0.25
heat = bw.RangeDoppler(
    frame={
        "range_m": range_m,
        "rate_mps": rate_mps,
        "range_doppler_db": 10 * np.log10(power + 1e-6),
        "detections": {"range_m": range_m[bins[:, 0]], "rate_mps": rate_mps[bins[:, 1] + loops // 2]},
    },
    **settings,
)
heat
