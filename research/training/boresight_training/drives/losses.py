"""What DeepEgo is trained on: errors of motion against their covariance, weights, and the label-free Doppler loss."""

from torch.nn import functional

from . import fit

FREEDOM = 5.0
"""Of the t distribution that whitened errors are taken to have: errors have long tails."""
SIGMA_MPS, SIGMA_PER_SPEED = 0.06, 0.001
SIGMA_RAD, GROWTH, GROWTH_AT_RAD = 0.004, 4.0, 1.0472
"""Deviations of range rate and azimuth of what stands, for labels: white and lasting errors together."""
GATE = 4.0
"""A standing detection is an inlier within so many deviations."""
CONSENSUS_MPS = 0.15
"""Scale of residuals in the Doppler loss."""


def deviations(points, velocity):
    """Of the range rates of standing things, m/s, [frames, points]."""
    cos, sin = fit.sight(points)
    azimuth = SIGMA_RAD * (1 + GROWTH * (points[..., 0] / GROWTH_AT_RAD).square())
    speed = velocity.norm(dim=-1, keepdim=True)
    return ((SIGMA_MPS + SIGMA_PER_SPEED * speed).square() + (azimuth * fit.slopes(cos, sin, velocity)).square()).sqrt()


def inliers(points, mask, moving, velocity, factor=1.0):
    """Detections of standing things that show the motion: what weights should be."""
    cos, sin = fit.sight(points)
    residual = fit.residuals(cos, sin, points[..., 1], velocity).abs()
    return mask & ~moving & (residual < GATE * factor * deviations(points, velocity))


def motion(error, covariance):
    """Negative log likelihood of whitened errors [frames, 2], of a t distribution, [frames]."""
    xx, xy, yy = covariance.double().unbind(-1)
    determinant = (xx * yy - xy * xy).clamp(min=1e-16)
    x, y = error.double().unbind(-1)
    squared = (yy * x * x - 2 * xy * x * y + xx * y * y) / determinant
    return (0.5 * (FREEDOM + 2) * (squared / FREEDOM).log1p() + 0.5 * determinant.log()).float()


def robust(error):
    """Growth of errors of velocity that large ones do not rule, [frames]."""
    return (error.square().sum(-1) / 0.05**2).log1p()


def weights(logit, target, mask):
    """Mean cross-entropy of the weights, [frames]."""
    each = functional.binary_cross_entropy_with_logits(logit, target, reduction="none")
    return (each * mask).sum(-1) / mask.sum(-1).clamp(min=1)


def doppler(points, mask, velocity, logit):
    """Without labels and true motion: the motion that most detections agree on, and weights of those that do, [frames].

    Residuals of all detections cost their logarithm, so that many small ones pay more than none that is large. Weights
    are to be those that the residuals themselves suggest.
    """
    cos, sin = fit.sight(points)
    squared = (fit.residuals(cos, sin, points[..., 1], velocity) / CONSENSUS_MPS).square()
    agrees = (-0.5 * squared.detach()).exp()
    each = squared.log1p() + functional.binary_cross_entropy_with_logits(logit, agrees, reduction="none")
    return (each * mask).sum(-1) / mask.sum(-1).clamp(min=1)


def determined(inlier, points):
    """Whether inliers tell both components of the motion, [frames]."""
    cos, sin = fit.sight(points)
    n = inlier.float()
    xx, xy, yy = (n * cos * cos).sum(-1), (n * cos * sin).sum(-1), (n * sin * sin).sum(-1)
    half = 0.5 * (xx + yy)
    least = half - (half.square() - (xx * yy - xy * xy)).clamp(min=0).sqrt()
    return (n.sum(-1) >= 3) & (least > 0.05)
