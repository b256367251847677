"""Precision, recall and F1 of predicted targets, at every threshold on confidence.

A prediction within half a degree of a true target is right, else false; a target with such a prediction is found.
Precision is right over all predictions, recall found over all targets. The strict form matches one to one, the most
confident prediction first: of two predictions on one target, one is false.
"""

from math import radians

import torch

WITHIN = radians(0.5)


def best_f1(azimuth, db, confidence, targets) -> dict:
    """Scores at the threshold of the largest F1.

    Predictions are [scenes, queries]: azimuth (rad), magnitude (dB), confidence in any monotonic measure.
    """
    azimuth, db, confidence = (x.detach().double().cpu() for x in (azimuth, db, confidence))
    valid = targets.valid.cpu()
    distance = (azimuth.unsqueeze(2) - targets.azimuth.double().cpu().unsqueeze(1)).abs()
    distance = distance.masked_fill(~valid.unsqueeze(1), torch.inf)
    near = distance <= WITHIN
    if valid.sum() == 0 or near.sum() == 0:
        return dict.fromkeys(
            ("f1", "precision", "recall", "threshold", "angle_error_deg", "magnitude_error_db", "strict_f1"), 0.0
        )
    found = confidence.unsqueeze(2).masked_fill(~near, -torch.inf).amax(1)[valid]
    least, nearest = distance.min(2)
    right = least <= WITHIN
    magnitude = (db - targets.db.double().cpu().gather(1, nearest)).abs()
    order = confidence.flatten().argsort(descending=True)
    thresholds = confidence.flatten()[order]
    last = torch.ones_like(thresholds, dtype=torch.bool)
    last[:-1] = thresholds[1:] != thresholds[:-1]

    def so_far(values):
        return values.flatten()[order].double().cumsum(0)[last]

    def f1(hits, recalled):
        precision, recall = hits / every, recalled / valid.sum()
        return torch.where(hits > 0, 2 * precision * recall / (precision + recall), 0.0), precision, recall

    every = so_far(torch.ones_like(right))
    rights = so_far(right)
    levels = thresholds[last]
    recalled = torch.searchsorted(-found.sort(descending=True).values, -levels, right=True)
    values, precision, recall = f1(rights, recalled)
    at = int(values.argmax())
    strict = so_far(_matched(distance, confidence))
    none = torch.zeros(())
    return {
        "f1": float(values[at]),
        "precision": float(precision[at]),
        "recall": float(recall[at]),
        "threshold": float(levels[at]),
        "angle_error_deg": float((so_far(torch.where(right, least, none)) / rights)[at].rad2deg()),
        "magnitude_error_db": float((so_far(torch.where(right, magnitude, none)) / rights)[at]),
        "strict_f1": float(f1(strict, strict)[0].max()),
    }


def _matched(distance, confidence):
    """Which predictions take a free target within reach, in order of confidence, each the nearest."""
    scenes = torch.arange(len(distance))
    free = distance.masked_fill(distance > WITHIN, torch.inf)
    matched = torch.zeros_like(confidence, dtype=torch.bool)
    for prediction in confidence.argsort(1, descending=True).T:
        least, target = free[scenes, prediction].min(1)
        hit = least < torch.inf
        matched[scenes, prediction] = hit
        free[scenes[hit], :, target[hit]] = torch.inf
    return matched
