"""Learning curves: scores on the way of a training, from its log."""

import json
from pathlib import Path

from . import checkpoint
from .tasks import task


def learning_curve(folder: Path) -> dict | None:
    """Mean of F1 over all conditions against samples and hours, those of the runs it started from included.

    Nothing of a network that has no F1, or was never scored.
    """
    saved = checkpoint.load(folder)
    if saved is None:
        raise FileNotFoundError(f"{folder} holds no {checkpoint.NAME}")
    before = {name: sum(leg[name] for leg in saved["legs"]) for name in ("samples", "seconds")}
    points = []
    for line in (folder / "log.jsonl").read_text().splitlines():
        entry = json.loads(line)
        f1 = [condition["f1"] for condition in entry.get("scores", []) if "f1" in condition]
        if f1:
            points.append(
                {
                    "samples": before["samples"] + entry["samples"],
                    "hours": round((before["seconds"] + entry["seconds"]) / 3600, 3),
                    "f1": round(sum(f1) / len(f1), 5),
                }
            )
    if not points:
        return None
    title = task(**saved["identity"]).title
    run = len(saved["legs"]) + 1
    return {"title": title if run == 1 else f"{title}, run {run}", "points": points}
