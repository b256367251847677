"""Frames of a RadarScenes sequence, to check networks on real drives.

`python -m boresight_training.drives.radarscenes RUN SEQUENCE` prints how a trained network does beside RANSAC.

Nothing here trains. Labels of the data set tell what moves. Its true motion is not known at the range rates' time, so
that motions are judged by the car's speed and by how mounting angles scatter from frame to frame. It needs h5py.
"""

import argparse
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch

from . import classical, losses, measures
from .dataset import Frames
from .smoother import DeepEgoPlus, Singles

STATIC = 11
"""Label of what stands."""
SLIP = 0.0045
"""Slip angle of the rear axle over lateral acceleration, rad/(m/s^2), outwards."""
DRIVES_MPS = 3.0
PIECE_S = 25.0
WINDOW = 8


@dataclass
class Scans:
    """The scans of one radar."""

    sensor: int
    time_s: np.ndarray
    speed_mps: np.ndarray
    """Of the rear axle, by the car."""
    yaw_rate: np.ndarray
    place: tuple[float, float, float]
    """Of the radar from the rear axle: x, y, m, yaw, rad."""
    frames: Frames
    """`velocity` is what the car's speed, yaw rate and slip make of the place."""


def read(folder: Path) -> list[Scans]:
    """The scans of a sequence's folder, radar by radar; `sensors.json` lies in the folder above."""
    import h5py

    folder = Path(folder)
    with h5py.File(folder / "radar_data.h5") as file:
        data, odometry = file["radar_data"][:], file["odometry"][:]
    mountings = json.loads((folder.parent / "sensors.json").read_text())
    scenes = json.loads((folder / "scenes.json").read_text())["scenes"]
    found = []
    for number in (1, 2, 3, 4):
        chosen = sorted((int(t), s) for t, s in scenes.items() if s["sensor_id"] == number)
        mounting = mountings[f"radar_{number}"]
        place = (mounting["x"], mounting["y"], mounting["yaw"])
        times = np.array([t for t, _ in chosen]) * 1e-6
        car = [np.interp(times, odometry["timestamp"] * 1e-6, odometry[name]) for name in ("vx", "yaw_rate")]
        ranges = [slice(*scene["radar_indices"]) for _, scene in chosen]
        found.append(Scans(number, times, *car, place, _frames(data, ranges, *car, place)))
    return found


def _frames(data, ranges, speed, yaw_rate, place) -> Frames:
    most = max(r.stop - r.start for r in ranges)
    points = np.zeros((len(ranges), most, 4), np.float32)
    mask, moving = np.zeros((2, len(ranges), most), bool)
    for i, rows in enumerate(ranges):
        scan = data[rows]
        for k, name in enumerate(("azimuth_sc", "vr", "range_sc", "rcs")):
            points[i, : len(scan), k] = scan[name]
        mask[i, : len(scan)] = True
        moving[i, : len(scan)] = scan["label_id"] != STATIC
    x, y, yaw = place
    forward = speed - yaw_rate * y
    left = yaw_rate * x - SLIP * speed * speed * yaw_rate
    cos, sin = np.cos(yaw), np.sin(yaw)
    velocity = np.stack((forward * cos + left * sin, left * cos - forward * sin), -1).astype(np.float32)
    return Frames(*(torch.from_numpy(x) for x in (points, mask, moving, velocity)))


def scatter(scans: Scans, velocity: torch.Tensor) -> dict[str, float]:
    """Of directions of motion against what the car's sensors make of them: robust deviations, deg.

    That of all frames, that from frame to frame, and that of the means of 25 s.
    """
    drives = (scans.speed_mps > DRIVES_MPS) & (scans.frames.mask.sum(1).numpy() >= 5)
    error = measures.directions(velocity, scans.frames.velocity).numpy()[drives]
    piece = (scans.time_s[drives] // PIECE_S).astype(int)
    means = [np.median(error[piece == i]) for i in np.unique(piece) if (piece == i).sum() > 50]
    speed = (velocity - scans.frames.velocity).norm(dim=-1).numpy()[drives]
    return {
        "mean_deg": float(np.median(error)),
        "scatter_deg": _robust(error - np.median(error)),
        "scatter_from_frame_to_frame_deg": _robust(np.diff(error)) / 2**0.5,
        "pieces_variance_deg2": float(np.var(means)),
        "over_1_mps_off": float((speed > measures.FAILED_MPS).mean()),
    }


def _robust(values) -> float:
    return float(1.4826 * np.median(np.abs(values)))


def smoothed(network: DeepEgoPlus, scans: Scans, singles: Singles) -> torch.Tensor:
    """Velocities of windows of successive frames, [frames, 2]; those of a last window that is not full as they were."""
    whole = len(scans.time_s) // WINDOW * WINDOW
    times = torch.from_numpy(scans.time_s[:whole]).view(-1, WINDOW)
    dt = torch.cat((torch.zeros(len(times), 1), times.diff(dim=1)), 1).float()
    windows = Singles(*(x[:whole].view(-1, WINDOW, x.shape[-1]) for x in singles[:3]), dt)
    return torch.cat((network.smoother(windows).velocity.flatten(0, 1), singles.velocity[whole:]))


@torch.no_grad()
def check(network, folder: Path, generator) -> list[dict]:
    """A network beside RANSAC on each radar of a sequence; of one for windows of frames its smoothing, too."""
    rows = []
    plus = network if isinstance(network, DeepEgoPlus) else None
    network = network.single if plus is not None else network
    for scans in read(folder):
        frames = scans.frames
        answers = []
        for start in range(0, len(frames.points), 250):
            part = slice(start, start + 250)
            most = int(frames.mask[part].sum(1).max())
            points, mask = frames.points[part, :most], frames.mask[part, :most]
            answer = network(points, mask)
            ransac, inlier, _ = classical.ransac(points, mask, generator)
            by_noise, _ = classical.weighted(points, inlier, ransac, losses.deviations)
            standing = (-answer.moves[-1]).sigmoid()
            told = torch.cat((answer.share.unsqueeze(-1), answer.factor.unsqueeze(-1), answer.context), -1)
            found = (answer.velocity[-1], answer.covariance, told)
            answers.append((*found, ransac, by_noise, standing[mask], inlier[mask]))
        found, covariance, told, ransac, by_noise, standing, inlier = (torch.cat(x) for x in zip(*answers, strict=True))
        of_windows = {}
        if plus is not None:
            of_windows["smoothed"] = scatter(scans, smoothed(plus, scans, Singles(found, covariance, told, None)))
        moving = frames.moving[frames.mask]
        there = torch.ones_like(moving)
        stated = (covariance[:, 0] + covariance[:, 2]).sqrt() / frames.velocity.norm(dim=-1).clamp(min=1)
        rows.append(
            {
                "sensor": scans.sensor,
                "network": scatter(scans, found),
                **of_windows,
                "ransac": scatter(scans, ransac),
                "ransac_weighted_by_noise": scatter(scans, by_noise),
                "labels": measures.labels(standing, there, moving),
                "ransac_labels": measures.labels(inlier.float(), there, moving),
                "moving_share": float(moving.float().mean()),
                "stated_deviation_deg": float(stated.rad2deg().median()),
            }
        )
    return rows


def main() -> int:
    """Prints how a trained network does on a sequence."""
    from .. import export

    parser = argparse.ArgumentParser(prog="boresight_training.drives.radarscenes", description=__doc__)
    parser.add_argument("run", type=Path, help="folder of a training of deepego or deepego-plus")
    parser.add_argument("sequence", type=Path, help="folder of a sequence, with radar_data.h5 and scenes.json")
    arguments = parser.parse_args()
    _, _, network = export.restore(arguments.run)
    print(json.dumps(check(network, arguments.sequence, torch.Generator().manual_seed(1)), indent=2))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
