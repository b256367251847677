import boresight_widget as bw
import numpy as np

settings = {}

rng = np.random.default_rng(1)
azimuth_deg = rng.uniform(-60, 60, 80)
moving = np.arange(80) < 8
vx_mps, vy_mps = 12.0, -0.8  # of the radar, in its own frame
azimuth = np.radians(azimuth_deg)
doppler = bw.DopplerAzimuth(
    frame={
        "azimuth_deg": azimuth_deg,
        "range_rate_mps": -(vx_mps * np.cos(azimuth) + vy_mps * np.sin(azimuth)) + 7 * moving,
        "weights": 1.0 - moving,
        "motion": {"vx_mps": vx_mps, "vy_mps": vy_mps},
    },
    **settings,
)
doppler
