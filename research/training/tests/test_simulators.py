"""Simulated data: the same as the native command line's on the same targets, and with the statistics they claim."""

import json
from dataclasses import replace
from math import pi, radians

import pytest
import torch

from boresight_training.arrays import ELEMENTS, array, random_arrays
from boresight_training.regions import (
    SPEED_OF_LIGHT,
    WAVEFORMS,
    Cubes,
    Reflectors,
    channels,
    covariance_features,
    crop,
    draw_reflectors,
    join,
    labels,
    range_spectra,
    regions,
    shift,
    tones,
)
from boresight_training.snapshots import Scenes, Targets, responses, snapshots

SAME = 1e-5


def row(*values):
    return torch.tensor([values], dtype=torch.float64)


@pytest.mark.parametrize("displaced", [False, True])
def test_snapshots_are_those_of_the_command_line(boresight, tmp_path, displaced):
    positions, name = array("lrr48"), "lrr48"
    if displaced:
        moved = torch.randn(48, 3, generator=torch.Generator().manual_seed(3), dtype=torch.float64)
        moved[:, 2] = 0
        positions = positions + 0.1 * moved
        name = tmp_path / "array.json"
        name.write_text(json.dumps({"positions": positions.tolist()}))
    given = boresight(
        "snapshots",
        "--array",
        name,
        "--snr",
        300,
        "--target",
        "azimuth=-60,power=-13,phase=200",
        "--target",
        "azimuth=12.34,phase=70",
        "--target",
        "azimuth=55,power=-3,phase=-20",
    )
    targets = Targets(
        azimuth=row(-60, 12.34, 55, 0).deg2rad(),
        db=row(-13, 0, -3, 0),
        phase=row(200, 70, -20, 0).deg2rad(),
        valid=torch.tensor([[True, True, True, False]]),
    )
    ours = responses(targets, positions)
    assert (ours[0] - given.reshape(48)).abs().max() < SAME


@pytest.mark.parametrize("waveform", WAVEFORMS)
def test_cubes_are_those_of_the_command_line(boresight, waveform):
    w = WAVEFORMS[waveform]
    name = "ula8" if w.transmitters == 1 else "awr1642"
    far = 80.3 if w.transmitters == 1 else 10.01
    given = boresight(
        "cube",
        "--array",
        name,
        "--waveform",
        waveform,
        "--snr",
        300,
        "--target",
        f"range={far},azimuth=-7,phase=30",
        "--target",
        f"range={far / 2},rate=3.5,azimuth=10,phase=-100,power=-6",
    )
    reflectors = Reflectors(
        range_m=row(far, far / 2),
        rate_mps=row(0, 3.5),
        azimuth=row(-7, 10).deg2rad(),
        phase=row(30, -100).deg2rad(),
        db=row(0, -6),
        valid=torch.tensor([[True, True]]),
    )
    ours = join(tones(w, reflectors), w, reflectors, Cubes(waveform).elements())
    assert ours.shape[1:] == given.shape[1:]
    assert (ours[0] - given[0]).abs().max() < SAME


def test_a_shift_by_equation_10_moves_the_target():
    w = WAVEFORMS["3dcnn-experiment"]

    def at(range_m):
        one = torch.tensor([[True]])
        return tones(w, Reflectors(row(range_m), row(0), row(0), row(0.5), row(0), one))

    moved = at(10.0) * shift(w, torch.tensor(0.23, dtype=torch.float64))
    assert (moved - at(10.23)).abs().max() < 1e-9


@pytest.mark.parametrize("waveform", WAVEFORMS)
def test_range_spectra_are_those_of_the_samples(waveform):
    w = WAVEFORMS[waveform]
    range_m = row(9.9, 10.3 * w.bin_m, 100 * w.bin_m, 200.5 * w.bin_m)
    still = torch.zeros_like(range_m)
    rates = (still, row(20, -20, -7, 0.3)) if w.transmitters == 1 else (still,)
    for rate_mps in rates:
        reflectors = Reflectors(range_m, rate_mps, still, still, still, torch.ones_like(range_m, dtype=torch.bool))
        expected = torch.fft.fft(tones(w, reflectors), norm="forward")
        given = range_spectra(w, range_m, rate_mps, torch.arange(w.samples))
        # Motion bends the phase within a ramp, by a thousandth of a turn at 20 m/s.
        assert (given - expected).abs().max() < (SAME if rate_mps is still else 5e-3)


def test_second_targets_have_the_stated_powers_and_half_of_the_targets_move():
    cubes = Cubes(targets=(2, 2), second_db=(-15, 0), rate_mps=20)
    drawn = draw_reflectors(cubes, 4000, torch.Generator().manual_seed(8))
    assert (drawn.db[:, 0] == 0).all()
    # Within five deviations of uniform means over 4,000 and of a share of 8,000.
    assert drawn.db[:, 1].min() >= -15 and drawn.db[:, 1].max() <= 0
    assert (drawn.db[:, 1].mean() + 7.5).abs() < 5 * 15 / 12**0.5 / 4000**0.5
    moves = drawn.rate_mps != 0
    assert abs(moves.double().mean() - 0.5) < 5 * 0.5 / 8000**0.5
    assert drawn.rate_mps.abs().max() <= 20


def test_a_moving_target_turns_from_chirp_to_chirp():
    cubes = Cubes(targets=(1, 1), snr_db=(60, 60), rate_mps=10)
    reflectors, region = regions(cubes, 200, torch.Generator().manual_seed(9))
    w = WAVEFORMS[cubes.waveform]
    turned = (region[:, 32, :, 1:] * region[:, 32, :, :-1].conj()).sum((1, 2)).angle()
    expected = 4 * pi * w.start_frequency_hz / SPEED_OF_LIGHT * w.chirp_interval_s * reflectors.rate_mps[:, 0]
    assert (torch.polar(torch.ones(200), turned - expected.float()).angle().abs() < 1e-2).all()


def test_the_strongest_bin_of_two_is_in_the_middle():
    _, region = regions(Cubes(targets=(2, 2), snr_db=(-5, -5)), 300, torch.Generator().manual_seed(7))
    assert (region.abs().square().sum((2, 3)).argmax(1) == 32).all()
    _, region = regions(Cubes(targets=(0, 0)), 300, torch.Generator().manual_seed(7))
    power = region.abs().square().mean((2, 3))
    assert (power.argmax(1) == 32).all()
    # The largest of 256 means of 32 exponentials: 1.55 times the mean, within 0.1 of it in each case.
    assert abs(float((power[:, 32] / power[:, :32].mean(1)).mean()) - 1.55) < 0.05


def test_regions_are_around_the_target_with_its_noise():
    cubes = Cubes(targets=(1, 1), snr_db=(10, 10))
    reflectors, region = regions(cubes, 400, torch.Generator().manual_seed(1))
    power = region.abs().square()
    assert (power.mean((2, 3)).argmax(1) == 32).all()
    # Far from the target lie the noise, 0.1 / 256, and sidelobes of at most 1 / (20 pi)^2 that vary.
    far = power[:, :8].mean((1, 2, 3)).quantile(0.05)
    assert abs(float(far) * 256 / 0.1 - 1) < 0.15
    assert (labels(reflectors).sum(1) == 1).all()
    assert channels(region).shape == (400, 65, 8, 4, 3)


def test_elements_of_boards_that_are_not_calibrated_have_the_stated_errors():
    cubes = Cubes(targets=(1, 1), snr_db=(60, 60))

    def received(**errors):
        _, region = regions(replace(cubes, **errors), 2000, torch.Generator().manual_seed(9))
        return region[:, 32, :, 0]

    # Errors are drawn after the target, so that both have the same ones.
    factor = received(channel_db=1.0, channel_deg=10.0) / received()
    db, deg = 20 * factor.abs().log10(), factor.angle().rad2deg()
    # Of 16,000 values a deviation is known to 0.6 %; the noise is 60 dB down in a raw sample and 84 dB in a bin.
    assert float(db.std()) == pytest.approx(1.0, rel=0.03)
    assert float(deg.std()) == pytest.approx(10.0, rel=0.03)


def test_near_targets_are_within_a_bin():
    apart = (
        draw_reflectors(Cubes(targets=(2, 2), near=0.5), 4000, torch.Generator().manual_seed(8))
        .range_m.diff(dim=1)
        .abs()
    )
    # Half of them, and of independent ranges over 20 bins nearly a tenth; two standard deviations of a share are 0.016.
    assert abs(float((apart < 1).float().mean()) - (0.5 + 0.5 * 0.0975)) < 0.03


def test_a_crop_wraps():
    spectrum = torch.arange(100.0).view(1, 100, 1, 1).to(torch.complex64)
    assert crop(spectrum, torch.tensor([3]))[0, :, 0, 0].real.tolist() == [float(k % 100) for k in range(71, 136)]


def test_the_covariance_of_one_target_is_its_steering():
    cubes = Cubes(targets=(1, 1), snr_db=(60, 60))
    reflectors, region = regions(cubes, 20, torch.Generator().manual_seed(2))
    features = torch.view_as_complex(covariance_features(region).unflatten(1, (28, 2)))
    row_of, column_of = torch.triu_indices(8, 8, offset=1)
    phase = pi * (row_of - column_of) * reflectors.azimuth.sin()
    assert (features - torch.polar(torch.ones_like(phase), phase)).abs().max() < 0.02
    assert (features.abs() <= 1 + 1e-6).all()


def test_scenes_have_the_statistics_they_claim():
    scenes = Scenes(targets=(0, 16), snr_db=(10, 10))
    generator = torch.Generator().manual_seed(4)
    targets, values, _ = snapshots(scenes, array("lrr48"), 4000, generator)
    count = targets.valid.sum(1)
    assert count.min() == 0 and count.max() == 16
    # 4,000 draws of a standard deviation of 4.9 give the mean to 0.08.
    assert abs(float(count.float().mean()) - 8) < 0.4
    assert targets.azimuth.abs().max() <= radians(60) and targets.db.min() >= -13 and targets.db.max() <= 0
    empty = values[count == 0]
    assert abs(float(empty.abs().square().mean()) / 0.1 - 1) < 0.05


def test_close_pairs_are_as_frequent_and_as_close_as_asked_for():
    cell = 2 / 92
    for share in (0.0, 0.5, torch.tensor(0.5)):
        scenes = Scenes(targets=(2, 2), close_pairs=share)
        targets, _, _ = snapshots(scenes, array("lrr48"), 4000, torch.Generator().manual_seed(9))
        apart = (targets.u[:, 0] - targets.u[:, 1]).abs() / cell
        assert targets.azimuth.abs().max() <= radians(60) + 1e-9
        # Of random targets some 2 in 100 are as close, and so are pairs moved back to the edge of the sector. 4,000
        # scenes: a share deviates by 0.008.
        by_chance = 0.025
        close = (apart <= 2).double().mean()
        assert abs(close - (share + (1 - share) * by_chance)) < 0.03, share
        if share > 0:
            assert 0.15 < apart[apart <= 2].median() / 1.1 < 1.3 and (apart[apart < 0.19]).numel() < 40


def test_displaced_elements_are_reported_as_simulated():
    scenes = Scenes(targets=(3, 3), snr_db=(200, 200), position_error=0.05)
    targets, values, positions = snapshots(scenes, array("lrr48"), 50, torch.Generator().manual_seed(5))
    assert (responses(targets, positions) - values).abs().max() < SAME
    errors = positions - array("lrr48")
    assert abs(float(errors.std()) / 0.05 - 1) < 0.05


def test_the_generator_alone_decides():
    def drawn(seed):
        generator = torch.Generator().manual_seed(seed)
        return snapshots(Scenes(), array("lrr48"), 8, generator)[1], regions(Cubes(shift_m=0.1), 8, generator)[1]

    assert all(torch.equal(a, b) for a, b in zip(drawn(6), drawn(6), strict=True))
    assert not any(torch.equal(a, b) for a, b in zip(drawn(6), drawn(7), strict=True))


def test_random_arrays_are_as_promised():
    generator = torch.Generator().manual_seed(8)
    sizes = set()
    for _ in range(60):
        arrays = random_arrays(16, generator)
        batch, elements, axes = arrays.shape
        sizes.add(elements)
        assert (batch, axes) == (16, 3) and ELEMENTS[0] <= elements <= ELEMENTS[1]
        rows = arrays[..., 1].sort(1).values
        assert arrays.mean(1).abs().max() < 0.1
        # Half a half wavelength apart, less five deviations of the difference of two displacements.
        assert rows.diff(dim=1).min() > 0.5 - 5 * 0.05 * 2**0.5
        extent = rows[:, -1] - rows[:, 0]
        assert ((extent > 0.6 * (elements - 1)) & (extent < 3 * elements + 3)).all()
        # None is a full row of half wavelengths, which networks are scored on.
        assert (rows.diff(dim=1) - 1).abs().amax(1).min() > 1e-9
        straight = arrays[..., 0].abs().amax(1) == 0
        assert (arrays[..., 2].abs().amax(1)[straight] == 0).all()
    assert min(sizes) < 16 and max(sizes) > 76 and len(sizes) > 30
    # Different arrays, in a batch and between batches; the same again from the same seed.
    assert len({tuple(row.round(decimals=6).tolist()) for row in rows}) == 16
    again = [random_arrays(4, torch.Generator().manual_seed(9)) for _ in range(2)]
    assert torch.equal(*again)
