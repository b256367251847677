"""Reads sets of data that `boresight simulate drive --dataset` writes.

`crates/simulate/src/drive/dataset/file.rs` has the format. Frames are those of all folders, one after the other.
"""

import json
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import torch

FORMAT, VERSION = "boresight-drive-dataset", 1
FRAME = np.dtype(
    [
        ("drive", "<u4"),
        ("velocity", "<f4", 2),
        ("yaw_rate", "<f4"),
        ("dt", "<f4"),
        ("count", "<u2"),
        ("moving", "<u2"),
        ("direction", "<i2"),
        ("scenario", "u1"),
        ("condition", "u1"),
    ]
)
DETECTION = np.dtype([("azimuth", "<i2"), ("range_rate", "<i2"), ("range", "<u2"), ("rcs", "i1"), ("moving", "u1")])
STEPS = {"azimuth": 5e-5, "range_rate": 0.005, "range": 0.01, "rcs": 0.5}
"""Of the whole numbers, in rad, m/s, m and dBsm."""
DIRECTION_RAD = 1e-4
SCENARIOS = ("city", "country-road", "motorway", "car-park", "stop-and-go", "dense-traffic")
TRAFFIC, QUEUE, NOTHING_STATIC = range(3)
"""Conditions of windows."""


@dataclass
class Frames:
    """Frames with their detections."""

    points: torch.Tensor
    """Azimuth (rad), range rate (m/s), range (m) and cross-section (dBsm), [frames, most, 4]."""
    mask: torch.Tensor
    """Which points are there, [frames, most]."""
    moving: torch.Tensor
    """Which come from movers, [frames, most]."""
    velocity: torch.Tensor
    """True velocity of the radar in its own frame, m/s, [frames, 2]."""


class Dataset:
    """One or several folders."""

    def __init__(self, folders: list[Path]):
        self.cards = [_card(Path(folder)) for folder in folders]
        self.window = self.cards[0]["window"]
        if any(card["window"] != self.window for card in self.cards):
            raise ValueError("sets of data with windows of different lengths: expected one length")
        self.frames = np.concatenate([_column(folder, "frames.bin", FRAME, "frames") for folder in folders])
        self._detections = [_column(folder, "detections.bin", DETECTION, "detections") for folder in folders]
        counts = self.frames["count"].astype(np.int64)
        ends = np.cumsum(counts)
        self.starts = ends - counts
        """Of the frames' detections, over all folders."""
        self._bounds = np.cumsum([0, *(len(column) for column in self._detections)])
        if (ends[-1] if len(ends) else 0) != self._bounds[-1]:
            raise ValueError(f"frames have {ends[-1]} detections, the files {self._bounds[-1]}")
        self.moving_share = self.frames["moving"] / np.maximum(counts, 1)

    def __len__(self):
        return len(self.frames)

    @cached_property
    def changes(self) -> np.ndarray:
        """By how much the radar's velocity changes in each frame's window, m/s^2."""
        velocity = self.frames["velocity"].reshape(-1, self.window, 2)
        seconds = self.frames["dt"].reshape(-1, self.window).sum(1)
        change = np.linalg.norm(velocity[:, -1] - velocity[:, 0], axis=1) / np.maximum(seconds, 1e-3)
        return np.repeat(change, self.window)

    def told(self) -> list[dict]:
        """What the sets of data are, without their places."""
        return [dict(card) for card in self.cards]

    def take(self, indices: np.ndarray, keep: np.ndarray | None = None) -> Frames:
        """Frames by number; `keep` is the share of the detections that each keeps, those with the lowest hash."""
        counts = self.frames["count"][indices].astype(np.int64)
        frame = np.repeat(np.arange(len(indices)), counts)
        place = np.arange(len(frame)) - np.repeat(np.cumsum(counts) - counts, counts)
        at = np.repeat(self.starts[indices], counts) + place
        if keep is not None:
            # Multiplicative hashing: the same detections for the same share, without a generator.
            kept = (at.astype(np.uint64) * np.uint64(11400714819323198485) >> np.uint64(40)) < keep[frame] * 2**24
            frame, at = frame[kept], at[kept]
            counts = np.bincount(frame, minlength=len(indices))
            place = np.arange(len(frame)) - np.repeat(np.cumsum(counts) - counts, counts)
        found = np.empty(len(at), DETECTION)
        for column, low, high in zip(self._detections, self._bounds, self._bounds[1:], strict=False):
            here = (at >= low) & (at < high)
            found[here] = column[at[here] - low]
        most = max(1, int(counts.max(initial=0)))
        points = np.zeros((len(indices), most, 4), np.float32)
        for i, (name, step) in enumerate(STEPS.items()):
            points[frame, place, i] = found[name] * np.float32(step)
        mask = np.zeros((len(indices), most), bool)
        mask[frame, place] = True
        moving = np.zeros((len(indices), most), bool)
        moving[frame, place] = found["moving"] > 0
        velocity = torch.from_numpy(self.frames["velocity"][indices].copy())
        return Frames(*(torch.from_numpy(x) for x in (points, mask, moving)), velocity)


def _card(folder: Path) -> dict:
    path = folder / "dataset.json"
    if not path.exists():
        raise FileNotFoundError(f"{folder} holds no dataset.json: expected what simulate drive --dataset writes")
    card = json.loads(path.read_text())
    if (card.get("format"), card.get("version")) != (FORMAT, VERSION):
        raise ValueError(f"{path} is {card.get('format')} {card.get('version')}: expected {FORMAT} {VERSION}")
    return card


def _column(folder: Path, name: str, dtype: np.dtype, counted: str) -> np.ndarray:
    path, count = Path(folder) / name, _card(Path(folder))[counted]
    if path.stat().st_size != count * dtype.itemsize:
        raise ValueError(f"{path} has {path.stat().st_size} bytes: expected {count * dtype.itemsize}")
    return np.memmap(path, dtype, "r") if count else np.empty(0, dtype)
