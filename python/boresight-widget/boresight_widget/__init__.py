"""Radar plots in notebooks: the elements of Boresight as widgets, which take NumPy arrays and tell what is selected.

import boresight_widget as bw
bw.PointCloud(points={"range_m": r, "azimuth_deg": azimuth})
"""

from .elements import VERSION as __version__
from .widget import WIDGETS

globals().update(WIDGETS)
__all__ = ["__version__", *WIDGETS]
