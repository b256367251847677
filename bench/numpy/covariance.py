"""Sample covariance and what follows from it."""

import numpy as np


def covariance(y):
    """Y Y^H / N in Fortran order."""
    return (y.conj() @ y.T).T / y.shape[1]


def projector(basis):
    """B B^H for orthonormal columns, in Fortran order."""
    return (basis.conj() @ basis.T).T


def signal_subspace(r, sources):
    """Eigenvectors of the largest eigenvalues, elements x sources."""
    return np.linalg.eigh(r)[1][:, -sources:]


def source_powers(steering, y):
    """Mean powers over the snapshots of sources at known angles, fitted by least squares."""
    adjoint = steering.conj().T
    signals = np.linalg.solve(adjoint @ steering, adjoint @ y)
    return (signals.real**2 + signals.imag**2).mean(axis=1)
