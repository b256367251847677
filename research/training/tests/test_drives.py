"""DeepEgo: the reader of data, augmentation, the fit, losses, and that training learns."""

import json
import math
import os
import subprocess

import numpy as np
import pytest
import torch

from boresight_training import checkpoint, export
from boresight_training.__main__ import evaluate, parser, train
from boresight_training.drives import (
    augment,
    classical,
    fit,
    losses,
    measures,
    radarscenes,
    smoother,
    smoother_task,
    weights_file,
)
from boresight_training.drives.dataset import DETECTION, FRAME, NOTHING_STATIC, Dataset, Frames
from boresight_training.drives.deepego import CONFIGS, DeepEgo, scale
from boresight_training.drives.task import DeepEgoTask, synthetic
from boresight_training.tasks import task


def write(folder, frames, detections, **card):
    """A set of data from structured arrays."""
    folder.mkdir(parents=True, exist_ok=True)
    frames.tofile(folder / "frames.bin")
    detections.tofile(folder / "detections.bin")
    told = {"format": "boresight-drive-dataset", "version": 1, "window": 8, "seed": 1}
    told |= {"frames": len(frames), "detections": len(detections)}
    (folder / "dataset.json").write_text(json.dumps(told | card))


def stored(folder, count=400, most=30, seed=5, **card):
    """A set of data of synthetic frames."""
    made = synthetic(count, most, torch.Generator().manual_seed(seed))
    frames = np.zeros(count, FRAME)
    frames["velocity"] = made.velocity.numpy()
    frames["count"] = made.mask.sum(1).numpy()
    frames["moving"] = made.moving.sum(1).numpy()
    detections = np.zeros(int(made.mask.sum()), DETECTION)
    points = made.points[made.mask].nan_to_num(0.0).numpy()
    for i, (name, step) in enumerate((("azimuth", 5e-5), ("range_rate", 0.005), ("range", 0.01), ("rcs", 0.5))):
        detections[name] = np.round(points[:, i] / step)
    detections["moving"] = made.moving[made.mask].numpy()
    write(folder, frames, detections, **card)
    return made


@pytest.fixture(scope="module")
def trained():
    """A tiny network after a minute on synthetic frames."""
    what = DeepEgoTask("tiny")
    torch.manual_seed(1)
    network = what.model()
    optimizer = torch.optim.AdamW(network.parameters(), 5e-3)
    generator = torch.Generator().manual_seed(2)
    losses_ = []
    for _ in range(300):
        loss, _ = what.loss(network, [augment.plain(synthetic(64, 40, generator))])
        optimizer.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(network.parameters(), 1.0)
        optimizer.step()
        losses_.append(float(loss.detach()))
    return network.eval(), losses_


def test_frames_come_back_as_they_were_written(tmp_path):
    made = stored(tmp_path / "a", 50, seed=1)
    more = stored(tmp_path / "b", 30, seed=2)
    data = Dataset([tmp_path / "a", tmp_path / "b"])
    assert len(data) == 80
    # From both folders at once, in any order.
    chosen = np.array([79, 3, 50, 49])
    frames = data.take(chosen)
    for row, source, at in ((0, more, 29), (1, made, 3), (2, more, 0), (3, made, 49)):
        count = int(source.mask[at].sum())
        assert int(frames.mask[row].sum()) == count
        expected = source.points[at, :count].nan_to_num(0.0)
        steps = torch.tensor([5e-5, 0.005, 0.01, 0.5])
        assert ((frames.points[row, :count] - expected).abs() <= 0.51 * steps).all()
        assert torch.equal(frames.moving[row, :count], source.moving[at, :count])
        assert torch.equal(frames.velocity[row], source.velocity[at])


def test_a_share_of_the_detections_is_kept(tmp_path):
    stored(tmp_path, 400, 60)
    data = Dataset([tmp_path])
    everything = data.take(np.arange(400))
    half = data.take(np.arange(400), np.full(400, 0.5))
    share = int(half.mask.sum()) / int(everything.mask.sum())
    assert abs(share - 0.5) < 0.03
    assert torch.equal(half.points, data.take(np.arange(400), np.full(400, 0.5)).points)
    assert int(data.take(np.arange(400), np.zeros(400)).mask.sum()) == 0


def test_damaged_data_are_refused(tmp_path):
    stored(tmp_path, 20)
    card = json.loads((tmp_path / "dataset.json").read_text())
    for broken, message in (({"version": 2}, "expected boresight-drive-dataset 1"), ({"frames": 21}, "bytes")):
        (tmp_path / "dataset.json").write_text(json.dumps(card | broken))
        with pytest.raises(ValueError, match=message):
            Dataset([tmp_path])
    with pytest.raises(FileNotFoundError, match=r"dataset\.json"):
        Dataset([tmp_path / "nowhere"])


def test_the_fit_finds_a_motion_without_noise():
    generator = torch.Generator().manual_seed(3)
    azimuth = 2 * torch.rand((5, 20), generator=generator) - 1
    velocity = 20 * torch.rand((5, 2), generator=generator) - 10
    cos, sin = azimuth.cos(), azimuth.sin()
    rate = -(velocity[:, :1] * cos + velocity[:, 1:] * sin)
    found, inverse = fit.fit(cos, sin, rate, torch.rand((5, 20), generator=generator))
    assert (found - velocity).abs().max() < 1e-3
    assert (inverse[:, 0] > 0).all() and (inverse[:, 2] > 0).all()
    # Nothing at all gives no motion, and numbers.
    found, inverse = fit.fit(cos, sin, rate, torch.zeros(5, 20))
    assert (found == 0).all() and inverse.isfinite().all()


def test_equation_3_states_the_scatter():
    generator = torch.Generator().manual_seed(4)
    azimuth = (2 * torch.rand(40, generator=generator) - 1).expand(20_000, -1)
    cos, sin = azimuth.cos(), azimuth.sin()
    rate = -10 * cos + 0.1 * torch.randn((20_000, 40), generator=generator)
    ones = torch.ones_like(rate)
    found, inverse = fit.fit(cos, sin, rate, ones)
    covariance = fit.equation_3(fit.residuals(cos, sin, rate, found), ones, ones, inverse)
    stated = covariance.mean(0)
    real = torch.cov(found.T.double())
    assert abs(float(stated[0] / real[0, 0]) - 1) < 0.05
    assert abs(float(stated[2] / real[1, 1]) - 1) < 0.05


def test_the_scale_is_the_nearest_rank():
    rate = torch.zeros(3, 12)
    rate[0, :10] = torch.arange(10.0)
    rate[1, :2] = torch.tensor([-7.0, 3.0])
    mask = torch.zeros(3, 12, dtype=torch.bool)
    mask[0, :10] = mask[1, :2] = True
    assert scale(rate, mask).tolist() == [8.0, 7.0, 1.0]


def test_order_and_padding_change_nothing_and_oddities_give_numbers(trained):
    network, _ = trained
    frames = synthetic(6, 40, torch.Generator().manual_seed(6))
    with torch.no_grad():
        answer = network(frames.points, frames.mask)
        order = torch.randperm(40, generator=torch.Generator().manual_seed(7))
        other = network(frames.points[:, order], frames.mask[:, order])
        padded = network(
            torch.cat((frames.points, torch.zeros(6, 9, 4)), 1),
            torch.cat((frames.mask, torch.zeros(6, 9, dtype=torch.bool)), 1),
        )
    for changed in (other, padded):
        assert torch.allclose(changed.velocity, answer.velocity, atol=2e-3)
        assert torch.allclose(changed.covariance, answer.covariance, rtol=1e-2)
    points = torch.zeros(4, 3, 4)
    mask = torch.tensor([[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1]], dtype=torch.bool)
    points[..., 2:] = torch.nan
    with torch.no_grad():
        odd = network(points, mask)
    assert odd.velocity.isfinite().all() and odd.covariance.isfinite().all() and odd.share.isfinite().all()
    # So does the loss, and its gradient, where nothing is there.
    example = augment.plain(Frames(points.nan_to_num(0.0), mask, torch.zeros_like(mask), torch.ones(4, 2)))
    what, fresh = DeepEgoTask("tiny"), DeepEgo(CONFIGS["tiny"])
    what.loss(fresh, [example])[0].backward()
    assert all(p.grad is None or p.grad.isfinite().all() for p in fresh.parameters())


def test_it_learns_and_beats_least_squares_on_everything(trained):
    network, curve = trained
    assert np.mean(curve[-20:]) < np.mean(curve[:20]) - 5
    frames = synthetic(500, 40, torch.Generator().manual_seed(8))
    known = augment.plain(frames).determined
    with torch.no_grad():
        answer = network(frames.points, frames.mask)
    cos, sin = fit.sight(frames.points)
    plain, _ = fit.fit(cos, sin, frames.points[..., 1], frames.mask.float())
    error = [(v - frames.velocity).norm(dim=-1)[known].median() for v in (answer.velocity[-1], plain)]
    assert error[0] < 0.1 * error[1]
    scores = measures.labels(answer.logit[-1].sigmoid(), frames.mask, frames.moving)
    assert scores["f1"] > 0.9


def test_labels_of_weights_are_what_shows_the_motion():
    frames = synthetic(200, 40, torch.Generator().manual_seed(9))
    target = losses.inliers(frames.points, frames.mask, frames.moving, frames.velocity)
    standing = frames.mask & ~frames.moving
    assert not (target & frames.moving).any()
    assert float(target[standing].float().mean()) > 0.99
    ghosts = frames.points.clone()
    ghosts[..., 1] += 5.0
    assert not losses.inliers(ghosts, frames.mask, frames.moving, frames.velocity).any()
    assert not losses.determined(torch.ones(1, 4, dtype=torch.bool), torch.zeros(1, 4, 4)).item()


def test_the_doppler_loss_is_least_at_the_motion_of_most():
    frames = synthetic(100, 40, torch.Generator().manual_seed(10))
    mask = frames.mask.float()
    right = torch.where(augment.plain(frames).target > 0, 10.0, -10.0)
    at = losses.doppler(frames.points, mask, frames.velocity, right)
    for velocity, logit in ((frames.velocity + 1.0, right), (frames.velocity, -right)):
        assert (losses.doppler(frames.points, mask, velocity, logit) >= at).float().mean() > 0.98


def test_mirroring_keeps_frames_true_and_noise_is_scaled():
    frames = synthetic(3000, 30, torch.Generator().manual_seed(11))
    varied = augment.varied(frames, torch.Generator().manual_seed(12))
    mirrored = varied.frames.velocity[:, 1] != frames.velocity[:, 1]
    assert 0.45 < float(mirrored.float().mean()) < 0.55
    cos, sin = fit.sight(varied.frames.points)
    residual = fit.residuals(cos, sin, varied.frames.points[..., 1], varied.frames.velocity)
    inlier = varied.target > 0
    for chosen in (mirrored, ~mirrored):
        deviation = float(residual[chosen][inlier[chosen]].std())
        assert float(inlier[chosen].sum() / frames.mask[chosen].sum()) > 0.6
        # 0.05 m/s times 0.5 to 2.
        assert 0.05 < deviation < 0.07
    dropped = varied.frames.points[:, 0, 2].isnan().float().mean()
    assert 0.25 < float(dropped) < 0.55


def test_clusters_of_ghosts_have_one_motion_and_no_weight():
    frames = synthetic(1000, 40, torch.Generator().manual_seed(14))
    varied = augment.varied(frames, torch.Generator().manual_seed(15))
    cos, sin = fit.sight(varied.frames.points)
    residual = fit.residuals(cos, sin, varied.frames.points[..., 1], varied.frames.velocity)
    assert float(residual[varied.target > 0].abs().max()) < 2.5
    standing = frames.mask & ~frames.moving
    lost = (standing & (varied.target == 0)).sum(1) / standing.sum(1).clamp(min=1)
    # Seven in ten frames have no clusters, and at most a tenth of single ghosts.
    assert 0.6 < float((lost < 0.2).float().mean()) < 0.95
    assert float((lost > 0.25).float().mean()) > 0.05


def test_curriculum_begins_with_little_traffic(tmp_path):
    stored(tmp_path, 600)
    batches = augment.Batches(Dataset([tmp_path]))
    shares = []
    for progress in (0.0, 0.9):
        parts = batches.draw(512, progress, torch.Generator().manual_seed(1))
        shares.append(max(float((p.frames.moving.sum(1) / p.frames.mask.sum(1).clamp(min=1)).mean()) for p in parts))
        assert sum(len(p.determined) for p in parts) == 512
    assert batches.data.moving_share[batches.order[batches.within[0][1] - 1]] <= 0.3
    assert shares[0] < shares[1]


def test_ransac_finds_the_motion():
    frames = synthetic(200, 40, torch.Generator().manual_seed(13))
    known = augment.plain(frames).determined
    velocity, inlier, covariance = classical.ransac(frames.points, frames.mask, torch.Generator().manual_seed(1))
    error = (velocity - frames.velocity).norm(dim=-1)[known]
    assert error.median() < 0.05
    assert not (inlier & ~frames.mask).any() and (covariance[:, 0] > 0).all()
    # Most detections move as one; the measured speed tells which do not.
    points = frames.points.clone()
    queue = torch.arange(40) % 4 > 0
    points[..., 1] = torch.where(queue, 0.2 * points[..., 1], points[..., 1])
    generator = torch.Generator().manual_seed(2)
    speed = frames.velocity.norm(dim=-1)
    errors = []
    for gate in (None, speed):
        velocity, _, _ = classical.ransac(points, frames.mask, generator, 200, gate)
        errors.append(float((velocity - frames.velocity).norm(dim=-1)[known & (speed > 5)].median()))
    assert errors[0] > 3 and errors[1] < 0.3


def test_measures_count_failures_and_coverage():
    truth = torch.tensor([[10.0, 0.0]]).expand(20_000, 2)
    noise = 0.1 * torch.randn((20_000, 2), generator=torch.Generator().manual_seed(1))
    covariance = torch.tensor([0.01, 0.0, 0.01]).expand(20_000, 3)
    scores = measures.motion(truth + noise, covariance, truth)
    assert abs(scores["within_68"] - 0.6827) < 0.02 and abs(scores["within_95"] - 0.9545) < 0.01
    assert abs(scores["direction_variance_deg2"] - math.degrees(0.01) ** 2) < 0.02
    assert scores["failed"] == 0
    assert measures.motion(truth + 2, covariance, truth)["failed"] == 1
    assert abs(measures.deviation_factor(measures.whitened(2 * noise, covariance)) - 2) < 0.03
    assert abs(measures.variance_ratio(truth + noise, truth + 2 * noise, truth) - 0.25) < 0.01


def arguments(folder, *extra):
    sets = ["--data", str(folder / "data"), "--test", str(folder / "test")]
    fixed = ["train", "deepego", "--config", "tiny", "--device", "cpu", "--threads", "1", "--batch", "32"]
    return parser().parse_args([*fixed, *sets, "--evaluate-count", "40", "--folder", str(folder / "run"), *extra])


def test_the_command_line_trains_resumes_and_scores(tmp_path):
    stored(tmp_path / "data", seed=1)
    stored(tmp_path / "test", seed=2)
    train(arguments(tmp_path, "--steps", "6"))
    saved = checkpoint.load(tmp_path / "run")
    assert saved["step"] == 6 and saved["identity"]["data"][0]["seed"] == 1
    assert "folder" not in json.dumps(saved["identity"])
    scores = evaluate(parser().parse_args(["evaluate", str(tmp_path / "run"), "--test", str(tmp_path / "test")]))
    assert scores[0]["frames"] == "up to 30 % moving" and 0 <= scores[0]["f1"] <= 1
    # What is exported states its deviations on data of a size that tests have.
    path = tmp_path / "out" / "deepego.onnx"
    card = export.export(tmp_path / "run", path, "half", 100, tmp_path / "golden", test=tmp_path / "test")
    assert card["deviationFactors"][0] > 0 and card["weights"]["bytes"] == path.with_suffix(".bin").stat().st_size
    assert (tmp_path / "golden" / "deepego" / "weights.bin").read_bytes() == path.with_suffix(".bin").read_bytes()
    # Other data are another network.
    stored(tmp_path / "data", seed=1, scenarioLeftOut="city")
    with pytest.raises(ValueError, match="holds"):
        train(arguments(tmp_path, "--steps", "8"))


def test_the_doppler_loss_alone_trains(tmp_path):
    what = task("deepego", "tiny", doppler_loss_only=True)
    torch.manual_seed(1)
    network = what.model()
    optimizer = torch.optim.AdamW(network.parameters(), 5e-3)
    generator = torch.Generator().manual_seed(2)
    for _ in range(300):
        loss, parts = what.loss(network, [augment.plain(synthetic(64, 40, generator))])
        assert float(loss.detach()) == pytest.approx(float(parts["doppler"]), rel=1e-5)
        optimizer.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(network.parameters(), 1.0)
        optimizer.step()
    frames = synthetic(500, 40, torch.Generator().manual_seed(8))
    known = augment.plain(frames).determined
    with torch.no_grad():
        answer = network(frames.points, frames.mask)
    error = (answer.velocity[-1] - frames.velocity).norm(dim=-1)[known]
    assert error.median() < 0.3


@pytest.mark.skipif("BORESIGHT" not in os.environ, reason="no command line was built")
def test_the_command_lines_data_show_their_motion(tmp_path):
    command = [os.environ["BORESIGHT"], "simulate", "drive", "--dataset", tmp_path, "--frames", "4000", "--seed", "3"]
    done = subprocess.run([str(x) for x in command], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    data = Dataset([tmp_path])
    assert len(data) == 4000
    frames = data.take(np.arange(0, 4000, 9))
    share = (frames.moving.sum(1) / frames.mask.sum(1).clamp(min=1)).numpy()
    assert np.allclose(share, data.moving_share[::9], atol=1e-6)
    assert (data.frames["condition"] == NOTHING_STATIC).any()
    cos, sin = fit.sight(frames.points)
    residual = fit.residuals(cos, sin, frames.points[..., 1], frames.velocity).abs()
    assert float(residual[frames.mask & ~frames.moving].median()) < 0.1


def test_weights_come_back_and_damage_is_found(tmp_path):
    torch.manual_seed(4)
    state = DeepEgo(CONFIGS["tiny"]).state_dict()
    path = tmp_path / "w.bin"
    weights_file.write(path, state)
    assert all(torch.equal(weights_file.read(path)[name], value) for name, value in state.items())
    size = path.stat().st_size
    weights_file.write(path, state, 64)
    assert path.stat().st_size < size
    assert all((weights_file.read(path)[name] - value).abs().max() < 1e-3 for name, value in state.items())
    whole = path.read_bytes()
    for broken, message in (
        (whole[:-9] + bytes([whole[-9] ^ 1]) + whole[-8:], "check sum"),
        (whole[: len(whole) // 2], "check sum"),
        (b"BORESMUT" + whole[8:], "no file of weights"),
        (b"", "no file of weights"),
        (weights_file.encoded({"a": torch.tensor([torch.inf])}, None), "not finite"),
    ):
        path.write_bytes(broken)
        with pytest.raises(ValueError, match=message):
            weights_file.read(path)


@pytest.mark.parametrize("name", ["deepego", "deepego-plus"])
def test_the_exported_form_is_the_same_in_onnx(tmp_path, name):
    what = task(name, "tiny")
    torch.manual_seed(5)
    form = export.exported_form(what, what.model().eval(), "half")
    assert export.to_onnx(what, form, tmp_path / "n.onnx", "half") < 1e-4
    card = what.write(form, tmp_path / "n.onnx", export.ROUNDED_FROM)
    read = weights_file.read(tmp_path / card["weights"]["file"])
    assert all(torch.equal(read[key], value) for key, value in form.model.state_dict().items())
    export.golden(what, form, tmp_path / "golden")
    assert len(np.load(tmp_path / "golden" / "motion.npy")) == what.golden_batch


def test_linear_equations_are_solved():
    generator = torch.Generator().manual_seed(1)
    root = torch.randn((7, 6, 6), generator=generator, dtype=torch.float64)
    matrix = root @ root.mT + 0.1 * torch.eye(6, dtype=torch.float64)
    right = torch.randn((7, 6, 3), generator=generator, dtype=torch.float64)
    assert torch.allclose(smoother.solved(matrix, right), torch.linalg.solve(matrix, right), atol=1e-8)


def windows(count, generator, noise=0.1):
    """Answers on steady accelerations with known noise, and the true motions."""
    start = 20 * torch.rand((count, 1, 2), generator=generator) - 10
    gain = 2 * torch.rand((count, 1, 2), generator=generator) - 1
    dt = 0.074 * torch.ones(count, 8)
    dt[:, 0] = 0
    truth = start + gain * dt.cumsum(1).unsqueeze(-1)
    velocity = truth + noise * torch.randn(truth.shape, generator=generator)
    covariance = noise**2 * torch.tensor([1.0, 0.0, 1.0]).expand(count, 8, 3)
    return smoother.Singles(velocity, covariance, torch.zeros(count, 8, 6), dt), truth


def test_smoothing_lessens_noise_before_and_turns_with_the_radar():
    singles, truth = windows(2000, torch.Generator().manual_seed(2))
    torch.manual_seed(1)
    network = smoother.Smoother(smoother.CONFIGS["tiny"]).eval()
    with torch.no_grad():
        answer = network(singles)
        error = (answer.velocity - truth).square().mean()
        # Three parameters of eight points.
        assert float(error / 0.01) < 0.42
        stated = (answer.covariance[..., 0] + answer.covariance[..., 2]).mean() / 2
        assert 0.7 < float(stated / error) < 1.4
        cos, sin = torch.tensor(0.6), torch.tensor(0.8)
        velocity, covariance = smoother.turned(singles.velocity, singles.covariance, cos, sin)
        other = network(singles._replace(velocity=velocity, covariance=covariance))
        expected = smoother.turned(answer.velocity, answer.covariance, cos, sin)
    assert torch.allclose(other.velocity, expected[0], atol=1e-3)
    assert torch.allclose(other.covariance, expected[1], atol=1e-5)


def test_windows_are_those_of_the_frames_whatever_their_counts(tmp_path):
    stored(tmp_path, 80, 30)
    data = Dataset([tmp_path])
    torch.manual_seed(3)
    network = task("deepego-plus", "tiny").model().eval()
    indices = np.arange(80)
    frames = data.take(indices)
    with torch.no_grad():
        singles = smoother_task._windows(network, frames, data, indices, 16)
        answer = network.single(frames.points, frames.mask)
    assert torch.allclose(singles.velocity.flatten(0, 1), answer.velocity[-1], rtol=1e-3, atol=1e-3)
    assert torch.allclose(singles.told.flatten(0, 1)[:, 2:], answer.context, atol=1e-5)
    assert singles.dt.shape == (10, 8)


def test_the_smoother_trains_on_a_trained_network_and_resumes(tmp_path):
    stored(tmp_path / "data", seed=1)
    stored(tmp_path / "test", seed=2)
    train(arguments(tmp_path, "--steps", "4"))
    plus = arguments(tmp_path, "--steps", "6", "--single", str(tmp_path / "run"))
    plus.network, plus.folder, plus.batch = "deepego-plus", tmp_path / "plus", 16
    scores = train(plus)
    assert scores[0]["frames"] == "up to 30 % moving" and scores[0]["variance_over_single"] > 0
    first, second = checkpoint.load(tmp_path / "run"), checkpoint.load(tmp_path / "plus")
    assert all(torch.equal(second["ema"][f"single.{key}"], value) for key, value in first["ema"].items())
    _, _, network = export.restore(tmp_path / "plus")
    points, mask, dt = task("deepego-plus", "tiny").example(2, torch.Generator().manual_seed(1))
    assert network(points, mask, dt).velocity.shape == (2, 8, 2)


@pytest.mark.skipif("BORESIGHT_RADARSCENES" not in os.environ, reason="no sequence of RadarScenes is there")
def test_a_real_sequence_is_read_and_ransac_scatters_as_known(trained):
    pytest.importorskip("h5py")
    rows = radarscenes.check(trained[0], os.environ["BORESIGHT_RADARSCENES"], torch.Generator().manual_seed(1))
    assert [row["sensor"] for row in rows] == [1, 2, 3, 4]
    # What docs/simulated-drives.md says of sequence 105.
    for row, known in zip(rows, (0.069, 0.148, 0.182, 0.067), strict=True):
        assert abs(row["ransac"]["scatter_deg"] / known - 1) < 0.15
