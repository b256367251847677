"""The last steps of MUSIC and its relatives: nulls of a form, and powers of sources there."""

import numpy as np

from covariance import projector, source_powers
from peaks import decibels, peak_sines
from result import Result


def search(grid, form, sources, full, y):
    """The deepest nulls of a^H Q a on the grid, moved onto the exact ones; `full` is the grid of all
    elements of the snapshots y."""
    values = grid.quadratic(form)
    spectrum = decibels(grid.elements / np.maximum(values, 1e-15 * grid.elements))
    near, _ = peak_sines(spectrum, grid, sources)
    u, _ = grid.refine(near)
    powers = source_powers(full.steering(u), y)
    order = np.argsort(-powers)
    return Result(np.degrees(np.arcsin(u[order])), decibels(powers[order]), spectrum)


def noise_projector(basis):
    """I - B B^H, in Fortran order."""
    form = -projector(basis)
    form.flat[:: len(form) + 1] += 1.0
    return form
