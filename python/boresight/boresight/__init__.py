"""Automotive radar: mounting angles of one drive or a fleet's, and angles of arrival in NumPy arrays.

The functions call the command line, which comes with the package, and return what it prints as JSON: angles in
degrees, everything else in SI units, with the unit in the name.
"""

from . import fleet
from .calibration import Calibration, calibrate
from .errors import BoresightError, BoresightWarning
from .estimation import estimate
from .options import VERSION as __version__
from .results import Source
from .validation import Validation

__all__ = [
    "BoresightError",
    "BoresightWarning",
    "Calibration",
    "Source",
    "Validation",
    "__version__",
    "calibrate",
    "estimate",
    "fleet",
]
