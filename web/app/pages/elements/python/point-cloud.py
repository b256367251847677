import boresight_widget as bw
import numpy as np

settings = {}

rng = np.random.default_rng(1)
azimuth_deg = rng.uniform(-60, 60, 80)
scan = {
    "azimuth_deg": azimuth_deg,
    "range_m": rng.uniform(5, 60, 80),
    "range_rate_mps": -12 * np.cos(np.radians(azimuth_deg)),
    "weights": np.ones(80),
}
cloud = bw.PointCloud(points=scan, mounting={"x_m": 3.7, "y_m": 0.6, "yaw_deg": 30}, **settings)
cloud
