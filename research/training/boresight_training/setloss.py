"""A set loss after AAETR's: bipartite matching, then classification and regression, after every decoder layer."""

from dataclasses import dataclass
from math import pi

import torch
from torch.nn import functional

from .matching import assign


@dataclass(frozen=True)
class SetLossConfig:
    """Weights of the parts of the loss, in the matching too."""

    confidence: float = 1.0
    sine: float = 1.0
    """Per Rayleigh cell, 2 over the aperture."""
    magnitude: float = 0.1
    """Per dB."""
    focal: float = 0.0
    """Exponent of the focal loss; 0 is cross-entropy."""
    spread: float = 0.1
    """Of how badly the stated variances tell the size of the errors, where outputs state them."""
    matched_last: bool = False
    """Whether the last layer's matching is that of all layers, in place of one each: much less work on a GPU."""


def set_loss(outputs, targets, config: SetLossConfig, cell, slots=None):
    """Loss of `outputs` [layers, batch, queries, 3 or 5]: its sum over layers, and the parts of the last.

    Outputs are sine, dB, logit, and the logarithms of the variances of sine (in cells) and dB, where there are any.
    `cell` is Rayleigh's resolution in sine of each array, [batch, 1], or of all, [1]. Every part is a sum over a
    batch divided by its number of targets. With `slots` [queries], sines, each target is assigned to a query by the
    distance of its slot, whatever the outputs.
    """
    layers, batch = outputs.shape[:2]
    u, db, logit, *spread = outputs.float().unbind(-1)
    true_u, true_db = targets.u.float(), targets.db.float()
    cell = cell.to(u).view(-1, 1)
    with torch.no_grad():
        matched = slice(-1 if config.matched_last else 0, None)
        far = (u[matched].unsqueeze(-2) - true_u.unsqueeze(-1)).abs().div(cell.unsqueeze(-1))
        cost = config.sine * far + config.magnitude * (db[matched].unsqueeze(-2) - true_db.unsqueeze(-1)).abs()
        cost = cost + config.confidence * _gain(logit[matched], config).unsqueeze(-2)
        if slots is not None:
            cost = (slots - true_u.unsqueeze(-1)).abs().expand_as(cost)
        rows = targets.valid.sum(1).repeat(len(cost))
        columns = assign(cost.flatten(0, 1), rows).view(len(cost), batch, -1).expand(layers, -1, -1)
        there = (columns >= 0).float()
        columns = columns.clamp_min(0)
        label = torch.zeros_like(logit).scatter_add_(2, columns, there)
    count = targets.valid.sum().clamp_min(1)
    confidence = (_classification(logit, label, config)).sum((1, 2)) / count
    error_u = (u.gather(2, columns) - true_u).abs() / cell
    sine = (error_u * there).sum((1, 2)) / count
    error_db = (db.gather(2, columns) - true_db).abs()
    magnitude = (error_db * there).sum((1, 2)) / count
    total = config.confidence * confidence + config.sine * sine + config.magnitude * magnitude
    parts = {"confidence": confidence[-1], "sine": sine[-1], "magnitude": magnitude[-1]}
    if spread:
        of_u, of_db = (_surprise(s.gather(2, columns), e) for s, e in zip(spread, (error_u, error_db), strict=True))
        parts["spread"] = (((of_u + of_db) * there).sum((1, 2)) / count)[-1]
        total = total + config.spread * ((of_u + of_db) * there).sum((1, 2)) / count
    return total.sum(), {k: v.detach() for k, v in parts.items()}


def _surprise(log_variance, error):
    """Least where the deviation is what a normal error of this mean size has; only the variance learns from it.

    The negative log-likelihood of a Laplace distribution but for a constant: squares would let the few errors of
    targets that were confused decide the deviations of all.
    """
    half = 0.5 * log_variance.clamp(-20, 10)
    return half + (pi / 2) ** 0.5 * error.detach().abs() * (-half).exp()


def _classification(logit, label, config):
    loss = functional.binary_cross_entropy_with_logits(logit, label, reduction="none")
    if config.focal > 0:
        loss = loss * 2**config.focal * (logit.sigmoid() - label).abs().detach() ** config.focal
    return loss


def _gain(logit, config):
    """What a query's confidence costs more as a target than as none."""
    one, zero = torch.ones_like(logit), torch.zeros_like(logit)
    return _classification(logit, one, config) - _classification(logit, zero, config)
