"""Networks that answer with a spectrum: what they are trained to say, and the algebra they are made of."""

from dataclasses import replace

import pytest
import torch

from boresight_training.arrays import along_y, array, steering
from boresight_training.covariance_networks import CNN_CONFIGS, FLOOR, CovarianceNetwork
from boresight_training.snapshots import Scenes, Targets, covariances, snapshots
from boresight_training.spectra import grid, image, lobes, null_spectrum, peaks
from boresight_training.tasks import task
from boresight_training.unrolled_iaa import CONFIGS, UnrolledIaa, conjugate_gradients, wave_matrix


def generator(seed=0):
    return torch.Generator().manual_seed(seed)


def targets(azimuth, db):
    azimuth, db = (torch.tensor([values], dtype=torch.float64) for values in (azimuth, db))
    return Targets(azimuth, db, torch.zeros_like(db), torch.ones_like(db, dtype=torch.bool))


def test_conjugate_gradients_end_at_the_inverse():
    positions = array("lrr48").float()
    waves = steering(positions.double(), grid(64))
    p = torch.rand(3, 64, generator=generator(), dtype=torch.float64)
    noise = torch.tensor([[0.5], [1.0], [2.0]], dtype=torch.float64)
    y = torch.randn(3, 48, 2, generator=generator(1), dtype=torch.float64)
    matrix = (waves.mT * p.unsqueeze(1)) @ waves.conj() + noise.unsqueeze(-1) * torch.eye(48)
    expected = torch.linalg.solve(matrix, torch.view_as_complex(y).unsqueeze(-1)).squeeze(-1)
    real, imaginary = waves.real.mT, waves.imag.mT
    parts = torch.cat((torch.cat((real, -imaginary), 1), torch.cat((imaginary, real), 1)))
    y, powers = y.mT.flatten(1), torch.cat((p, p), -1)
    # As many steps as elements are exact up to rounding; a second run continues where the first ended.
    z, _ = conjugate_gradients(torch.zeros_like(y), y, parts, powers, noise, 30)
    z, beams = conjugate_gradients(z, y, parts, powers, noise, 30)
    z, beams = (torch.complex(*x.chunk(2, -1)) for x in (z, beams))
    torch.testing.assert_close(z, expected, atol=1e-9, rtol=1e-7)
    torch.testing.assert_close(beams, expected @ waves.conj().mT, atol=1e-8, rtol=1e-7)


def test_beams_of_the_wave_matrix_are_those_of_steering():
    positions = array("lrr48").float()
    waves = steering(positions.double(), grid(64))
    y = torch.randn(3, 48, dtype=torch.complex128, generator=generator(1))
    given = torch.cat((y.real, y.imag), -1) @ wave_matrix(positions, 64).double()
    torch.testing.assert_close(torch.complex(*given.chunk(2, -1)), y @ waves.conj().mT, atol=1e-3, rtol=1e-4)


def test_peaks_lie_between_the_points():
    points, sine = 128, torch.tensor([[-0.9973, -0.2, 0.3141]], dtype=torch.float64)
    lobe = torch.tensor([[-1.0, 0.0, -20.0]]).unsqueeze(-1) - 8 * lobes(sine, points)
    found, height = peaks(lobe.amax(1).clamp_min(-60), 4)
    torch.testing.assert_close(found[:, :3], sine[:, [1, 0, 2]])
    assert (height[0, :3].diff() < 0).all() and height[0, 3] == -torch.inf


@pytest.mark.parametrize("name", ["unrolled-iaa", "covariance-cnn", "deep-music"])
def test_labels_have_their_peaks_at_the_targets(name):
    what = task(name, "small")
    truth = targets([-0.4, 0.1, 0.9], [0.0, -3.0, -12.0])
    values = torch.ones(1, 48, dtype=torch.complex64)
    label = what._labels(truth, values) if name == "unrolled-iaa" else what._labels(truth)
    found, height = peaks((label + 1e-9).log() if name == "covariance-cnn" else label, 3)
    # Next to the nulls MUSIC's spectrum is no parabola in dB: off by less than half a step of the grid.
    allowed = 1e-3 if name != "deep-music" else 0.5 * 2 / 128
    assert (found.sort().values - truth.u.sort().values).abs().max() < allowed
    if name == "unrolled-iaa":
        assert label.min() == pytest.approx(what.FLOOR_DB)
        order = found[0].argsort()
        # A parabola's top lies up to 2 dB above the highest point.
        above = truth.db[0] - height[0, order]
        assert (above > -1e-3).all() and (above < 2.01).all()


def test_the_null_spectrum_is_that_of_a_projection():
    positions = along_y(range(6))
    truth = targets([-0.3, 0.5], [0.0, 0.0])
    waves = steering(positions, truth.u)[0]
    # The noise subspace by the eigenvectors of the exact covariance.
    _, vectors = torch.linalg.eigh(waves.mT @ waves.conj())
    noise = vectors[:, :4]
    towards = steering(positions, grid(32))
    expected = (towards @ noise.conj()).abs().square().sum(-1) / 6
    torch.testing.assert_close(null_spectrum(positions, truth, 32)[0], expected.clamp(FLOOR, 1), atol=1e-7, rtol=1e-6)
    # Of no target all is noise.
    none = replace(truth, valid=torch.zeros_like(truth.valid))
    torch.testing.assert_close(null_spectrum(positions, none, 32), torch.ones(1, 32).double())


def test_sample_covariances_have_the_moments_of_wisharts_distribution():
    scenes = Scenes(targets=(1, 1), db=(0.0, 0.0), snr_db=(0.0, 0.0), field_of_view_deg=0.0)
    n, count, trials = 4, 10, 4000
    _, found = covariances(scenes, along_y(range(n)), trials, (count, count), generator())
    exact = torch.ones(n, n) + torch.eye(n)
    # Entries have a variance of R_ii R_kk / count; the mean of 4000 deviates by 0.01, four times which is allowed.
    assert (found.mean(0) - exact).abs().max() < 0.04
    spread = (found - exact).abs().square().mean(0) * count
    diagonal = exact.diagonal()
    # Relative deviation of a mean square of 4000 trials: 0.03 at most, four times which is allowed.
    torch.testing.assert_close(spread, torch.outer(diagonal, diagonal), rtol=0.12, atol=0.0)


def test_an_image_holds_real_and_imaginary_part_and_phase():
    matrix = torch.tensor([[[2.0, 1j], [-1j, 4.0]]], dtype=torch.complex64)
    expected = torch.tensor([[[2 / 3, 0], [0, 4 / 3]], [[0, 1 / 3], [-1 / 3, 0]], [[0, 0.5], [-0.5, 0]]])
    torch.testing.assert_close(image(matrix)[0], expected)


def test_folding_leaves_a_covariance_network_as_it_is():
    torch.manual_seed(0)
    network = CovarianceNetwork(CNN_CONFIGS["tiny"])
    for _ in range(20):
        network(torch.randn(16, 3, 8, 8) * 2 + 1)
    network.eval()
    plain, x = network.fold(), torch.randn(5, 3, 8, 8)
    assert not any("BatchNorm" in type(module).__name__ for module in plain.modules())
    torch.testing.assert_close(plain(x), network(x), atol=1e-5, rtol=1e-5)


def test_unrolled_iaa_answers_in_proportion():
    torch.manual_seed(0)
    network = UnrolledIaa(CONFIGS["tiny"])
    for parameter in network.parameters():
        torch.nn.init.normal_(parameter, std=0.1)
    _, values, positions = snapshots(Scenes(), array("lrr48"), 3, generator())
    given = torch.view_as_real(values)
    with torch.no_grad():
        once, ten_times = network(given, positions.float()), network(10 * given, positions.float())
    torch.testing.assert_close(ten_times, once + 20, atol=1e-2, rtol=0.0)
