"""What every method returns."""

from dataclasses import dataclass

import numpy as np


@dataclass
class Result:
    azimuth_deg: np.ndarray
    power_db: np.ndarray | None = None
    spectrum_db: np.ndarray | None = None
    iterations: int = 0
