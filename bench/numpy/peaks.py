"""Peaks of a spectrum in dB over a grid that closes on itself."""

import numpy as np


def decibels(values):
    return 10.0 * np.log10(np.maximum(values, 1e-300))


def peaks(values_db, grid, count, dynamic_range_db=np.inf):
    """As peak_sines, with azimuths in degrees."""
    u, heights = peak_sines(values_db, grid, count, dynamic_range_db)
    return np.degrees(np.arcsin(u)), heights


def peak_sines(values_db, grid, count, dynamic_range_db=np.inf):
    """Up to count local maxima, strongest first, each moved to the top of the parabola through it
    and its two neighbours. Returns sines of azimuth and heights in dB."""
    left = np.empty_like(values_db)
    left[1:], left[0] = values_db[:-1], values_db[-1]
    right = np.empty_like(values_db)
    right[:-1], right[-1] = values_db[1:], values_db[0]
    found = np.flatnonzero((values_db > left) & (values_db >= right))
    heights = values_db[found]
    if len(found) > count:
        keep = np.argpartition(-heights, count - 1)[:count]
        found, heights = found[keep], heights[keep]
    order = np.argsort(-heights)
    found = found[order]
    if np.isfinite(dynamic_range_db):
        found = found[heights[order] >= values_db.max() - dynamic_range_db]
    middle, before, after = values_db[found], left[found], right[found]
    curvature = before - 2.0 * middle + after
    shift = np.where(curvature < 0.0, 0.5 * (before - after) / np.minimum(curvature, -1e-300), 0.0)
    u = np.clip(grid.u[found] + shift * (2.0 / grid.points), -1.0, 1.0)
    return u, middle - 0.25 * (before - after) * shift
