import boresight_widget as bw
import numpy as np

settings = {}

rng = np.random.default_rng(1)
time_s = np.arange(1, 60)
sigma_deg = 1 / np.sqrt(time_s)
angle_deg = -85 + sigma_deg * np.cumsum(rng.normal(size=59)) / np.sqrt(time_s)
angle = bw.MountingAngle(history={"time_s": time_s, "angle_deg": angle_deg, "sigma_deg": sigma_deg}, **settings)
angle
