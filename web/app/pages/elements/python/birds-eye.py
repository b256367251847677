import boresight_widget as bw
import numpy as np

settings = {}

x_m = np.arange(-5, 60, 0.5)  # ahead
y_m = np.arange(-25, 25, 0.5)  # to the left
places = [(20, 4), (35, -8), (50, 12)]
power = 1e-4 + sum(np.exp(-((x_m[:, None] - x) ** 2 + (y_m - y) ** 2)) for x, y in places)
view = bw.BirdsEye(view={"x_m": x_m, "y_m": y_m, "power": power, "cell_m": 0.5}, **settings)
view
