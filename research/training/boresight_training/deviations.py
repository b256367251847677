"""Stated deviations fitted to the errors that a trained network makes.

Deviations learn together with all else, from every matched target, and end a tenth off: too small in noise, too large
without. Their rows of the last layer are therefore fitted again, to errors of right predictions alone.
"""

import torch

SHARE = 0.6827
"""Share of normal errors within one standard deviation, and of a network's errors within what it states."""
STEPS = 1500
RATE = 1e-2
LEAST = 1e-7
"""Smaller errors count as this."""


def fitted(rows: torch.Tensor, features: torch.Tensor, errors: torch.Tensor) -> torch.Tensor:
    """Rows whose product with features is the logarithm of the deviation, [outputs, features + 1], bias last.

    Quantile regression (Koenker and Bassett 1978): SHARE of the errors [predictions, outputs] lie within the deviation,
    for any half space of `features` [predictions, features] as for all. Begins with `rows`.
    """
    features = with_one(features.double())
    logs = errors.double().clamp_min(LEAST).log()
    rows = rows.double().clone().requires_grad_()
    optimizer = torch.optim.Adam([rows], lr=RATE)
    for step in range(STEPS):
        for group in optimizer.param_groups:
            group["lr"] = RATE * (1 - step / STEPS)
        above = logs - features @ rows.T
        loss = torch.maximum(SHARE * above, (SHARE - 1) * above).mean()
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
    return rows.detach()


def with_one(features: torch.Tensor) -> torch.Tensor:
    """Features and a one for the bias."""
    return torch.cat((features, torch.ones_like(features[..., :1])), -1)
