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


def source_powers(steering, r):
    """Powers at one element of sources at known angles, by least squares, less the noise."""
    elements, sources = steering.shape
    adjoint = steering.conj().T
    gram = np.linalg.inv(adjoint @ steering)
    inverse = gram @ adjoint
    projected = inverse @ r
    noise = (r.trace() - np.einsum("ki,ik->", steering, projected)).real / (elements - sources)
    powers = np.einsum("ik,ik->i", projected, inverse.conj()).real - noise * gram.diagonal().real
    return np.maximum(powers, 0.0)
