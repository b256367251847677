"""Assignment against SciPy's, scores against hand counts, the set loss against its own parts."""

from dataclasses import replace
from math import log, pi, radians

import pytest
import torch
from scipy.optimize import linear_sum_assignment

from boresight_training.arrays import LRR48_APERTURE
from boresight_training.matching import assign
from boresight_training.score import best_f1
from boresight_training.setloss import SetLossConfig, set_loss
from boresight_training.snapshots import Targets


@pytest.mark.parametrize("columns,coarse", [(16, False), (16, True), (80, False), (96, True)])
def test_assignments_cost_what_scipy_finds(columns, coarse):
    generator = torch.Generator().manual_seed(columns)
    cost = torch.randn(200, 16, columns, generator=generator)
    cost[:100] += 3 * torch.randn(100, 1, columns, generator=generator)  # all rows want the same columns
    if coarse:
        cost = cost.round()  # ties
    rows = torch.randint(0, 17, (200,), generator=generator)
    given = assign(cost, rows)
    for problem, count, columns_of in zip(cost, rows.tolist(), given, strict=True):
        best = linear_sum_assignment(problem[:count].numpy())
        chosen = columns_of[:count]
        assert len(set(chosen.tolist())) == count and (columns_of[count:] == -1).all()
        expected = problem[:count][best].sum()
        assert abs(problem[torch.arange(count), chosen].sum() - expected) < 1e-4


def test_more_rows_than_columns_are_refused():
    with pytest.raises(ValueError, match="3 rows"):
        assign(torch.zeros(1, 3, 2), torch.tensor([3]))


CELL = torch.tensor([2 / LRR48_APERTURE])


def truth(*scenes):
    """Targets from lists of (azimuth in deg, dB)."""
    most = max(map(len, scenes))

    def padded(part):
        return torch.tensor([[t[part] for t in s] + [0.0] * (most - len(s)) for s in scenes], dtype=torch.float64)

    count = torch.tensor([[len(s)] for s in scenes])
    azimuth = padded(0).deg2rad()
    return Targets(azimuth, padded(1), torch.zeros_like(azimuth), torch.arange(most) < count)


def test_two_predictions_on_one_target_are_right_twice_and_strictly_once():
    targets = truth([(10, 0), (20, -5)], [(-30, -2)])
    azimuth = torch.tensor([[10.3, 9.8, -40.0], [-30.1, 0.0, 50.0]]).deg2rad()
    db = torch.tensor([[-0.1, -3.1, -8.1], [-3.0, 0.0, 0.0]])
    confidence = torch.tensor([[0.9, 0.8, 0.1], [0.7, 0.05, 0.01]])
    best = best_f1(azimuth, db, confidence, targets)
    # At 0.7: three right of three, two found of three targets.
    assert best["threshold"] == pytest.approx(0.7)
    assert (best["precision"], best["recall"]) == (1.0, pytest.approx(2 / 3))
    assert best["f1"] == pytest.approx(0.8)
    assert best["angle_error_deg"] == pytest.approx((0.3 + 0.2 + 0.1) / 3, rel=1e-5)
    assert best["magnitude_error_db"] == pytest.approx((0.1 + 3.1 + 1.0) / 3, rel=1e-5)
    # Strictly two of three predictions and two of three targets.
    assert best["strict_f1"] == pytest.approx(2 / 3)


def test_one_prediction_between_two_targets_finds_both():
    best = best_f1(torch.tensor([[radians(5.2)]]), torch.zeros(1, 1), torch.ones(1, 1), truth([(5, 0), (5.5, 0)]))
    assert best["f1"] == pytest.approx(1.0) and best["strict_f1"] == pytest.approx(2 / 3)


def test_predictions_that_hit_nothing_score_nothing():
    best = best_f1(torch.tensor([[0.5]]), torch.zeros(1, 1), torch.ones(1, 1), truth([(0, 0)]))
    assert best["f1"] == best["strict_f1"] == 0.0


@pytest.mark.parametrize("focal", [0.0, 2.0])
def test_the_loss_vanishes_at_the_truth_and_matches_in_any_order(focal):
    targets = truth([(10, 0), (-20, -5), (33, -9)], [(0, -1)])
    u = torch.full((2, 2, 5), 0.9)
    db = torch.zeros(2, 2, 5)
    logit = torch.full((2, 2, 5), -30.0)
    for scene, queries in enumerate([[3, 0, 4], [2]]):
        for target, query in enumerate(queries):
            u[:, scene, query] = targets.u[scene, target].float()
            db[:, scene, query] = targets.db[scene, target].float()
            logit[:, scene, query] = 30.0
    config = replace(SetLossConfig(), focal=focal)
    loss, parts = set_loss(torch.stack((u, db, logit), -1), targets, config, CELL)
    assert loss < 1e-4 and all(value < 1e-4 for value in parts.values())
    wrong = db.clone()
    wrong[1, 0, 3] += 4.0
    loss, parts = set_loss(torch.stack((u, wrong, logit), -1), targets, config, CELL)
    assert parts["magnitude"] == pytest.approx(1.0, rel=1e-4)  # 4 dB over four targets
    assert loss == pytest.approx(config.magnitude, rel=1e-3)


def test_the_last_layers_matching_can_be_that_of_all():
    targets = truth([(10, 0), (-20, 0)])
    last = torch.stack((targets.u[0].float(), torch.zeros(2), torch.full((2,), 30.0)), -1)
    answers = torch.stack((last.flip(0), last)).unsqueeze(1)
    each, _ = set_loss(answers, targets, SetLossConfig(), CELL)
    assert each < 1e-4
    apart = (targets.u[0, 0] - targets.u[0, 1]).abs().item() / (2 / LRR48_APERTURE)
    by_last, parts = set_loss(answers, targets, SetLossConfig(matched_last=True), CELL)
    assert by_last.item() == pytest.approx(apart, rel=1e-4) and parts["sine"] < 1e-4


def test_stated_variances_are_best_at_those_of_normal_errors_of_that_size_and_leave_the_answers_alone():
    targets = truth([(0, -3)])
    cell = 2 / LRR48_APERTURE
    answers = torch.tensor([0.25 * cell, -1.0, 30.0]).repeat(1, 1, 1, 1).requires_grad_()
    spread = (torch.tensor([0.25, 2.0]).square() * pi / 2).log().repeat(1, 1, 1, 1).requires_grad_()
    loss, _ = set_loss(torch.cat((answers, spread), -1), targets, SetLossConfig(), CELL)
    without, _ = set_loss(answers, targets, SetLossConfig(), CELL)
    given = torch.autograd.grad(loss, (answers, spread))
    assert given[1].abs().max() < 1e-6
    assert torch.allclose(given[0], torch.autograd.grad(without, answers)[0])
    # Half the deviation costs 2 - 1 - log 2 more.
    narrow, parts = set_loss(torch.cat((answers, spread - 2 * log(2)), -1), targets, SetLossConfig(), CELL)
    assert (narrow - loss).item() == pytest.approx(0.1 * 2 * (1 - log(2)), rel=1e-4)
    assert parts["spread"].item() == pytest.approx((narrow - without).item() / 0.1, rel=1e-3)
