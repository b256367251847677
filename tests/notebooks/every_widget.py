# A cell with the widgets that docs/notebooks.md has no snippet of, in the shapes that it states.
import numpy as np
from IPython.display import display

import boresight_widget as bw

range_bins, rate_bins = np.arange(64) * 0.5, np.linspace(-8, 8, 32, dtype="f4")
levels = -90 + 60 * np.exp(-((range_bins[:, None] - 20) ** 2 + (rate_bins - 3) ** 2))
found = [{"range_m": 20.0, "rate_mps": 3.0}]
range_doppler = bw.RangeDoppler(
    frame={"range_m": range_bins, "rate_mps": rate_bins, "range_doppler_db": levels, "detections": found}
)

ahead, left = np.arange(40) * 0.5, np.arange(-30, 30) * 0.5
birds_eye = bw.BirdsEye(view={"x_m": ahead, "y_m": left, "power": 1 + 0 * np.add.outer(ahead, left)})

mounting_angle = bw.MountingAngle(
    history={"time_s": np.arange(60), "angle_deg": np.full(60, 1.5), "sigma_deg": np.full(60, 0.1)},
    nominal_deg=np.int64(1),
    tolerance_deg=1,
)

capture = bw.Capture(files=["xwr16xx_crw_dca_module_2018_1015v2.bin", "profile.cfg"], frame=1)

# A radar 3.5 m ahead of the rear axle that looks 2 deg to the left, on a road that winds, among what stands.
draws = np.random.default_rng(2)
time_s = np.arange(400) / 15
yaw_rate = 0.2 * np.sin(time_s)
azimuth = draws.uniform(-60, 60, (400, 30))
vx_mps, vy_mps = 10.0, 3.5 * yaw_rate[:, None]
bearing = np.radians(azimuth + 2)
range_rate = -(vx_mps * np.cos(bearing) + vy_mps * np.sin(bearing)) + draws.normal(0, 0.05, azimuth.shape)
drive_of_arrays = bw.Drive(
    drive={
        "sensors": {"id": 1, "x_m": 3.5, "y_m": 0, "yaw_deg": 0},
        "scans": {"time_s": time_s, "sensor": np.ones(400), "offsets": 30 * np.arange(401)},
        "detections": {"azimuth_deg": azimuth.ravel(), "range_rate_mps": range_rate.ravel()},
        "motion": {"time_s": time_s, "yaw_rate_degps": np.degrees(yaw_rate), "speed_mps": np.full(400, 10.0)},
    },
    heading="Of arrays",
)
display(range_doppler, birds_eye, mounting_angle, capture, drive_of_arrays)
