"""What fleets cost: a worker of Dask and one of Ray killed, weak scaling on Dask, and overhead a log.

    BORESIGHT=target/release/boresight PYTHONPATH=python/boresight python bench/fleet/measure.py --logs 60 --seconds 60

with the packages of tests/python/requirements.txt. Logs are simulated drives of so many seconds by one radar. Times are
medians of rounds in which what is compared takes turns, so that a machine that is busy for a while slows all of it.
Where more processes want to run than there are cores, scaling tells about the machine.
"""

import argparse
import contextlib
import os
import platform
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import psutil
import ray
from distributed import Client, LocalCluster

import boresight
from boresight import fleet
from boresight.binary import binary


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--logs", type=int, default=60, help="logs")
    parser.add_argument("--seconds", type=float, default=60, help="length of each drive")
    parser.add_argument("--rounds", type=int, default=5, help="rounds of which the median is told")
    given = parser.parse_args()
    if given.logs < 4 or given.rounds < 1:
        parser.error("at least 4 logs and 1 round")
    load = f"{os.getloadavg()[0]:.1f} processes busy before" if hasattr(os, "getloadavg") else ""
    print(f"{os.cpu_count()} cores, {load}, {platform.platform()}, {given.logs} logs of {given.seconds:g} s")
    with tempfile.TemporaryDirectory(prefix="boresight-bench-") as place:
        folder = Path(place)
        plan = planned(folder, given.logs, given.seconds)
        one_process(folder, plan)
        killed_of_dask(folder, plan)
        killed_of_ray(folder, plan)
        scaling(folder, plan, given.rounds)
        overhead(folder, plan, given.rounds)


def planned(folder: Path, count: int, seconds: float) -> fleet.Plan:
    """Drives of ten vehicles."""
    logs = []
    for seed in range(count):
        log = folder / "logs" / f"vehicle-{seed % 10}" / f"{seed:05}"
        options = ["--seed", str(seed), "--sensor", "1", "--duration", str(seconds), "--out", str(log)]
        subprocess.run([binary(), "simulate", "drive", *options], check=True, capture_output=True)
        logs.append(log)
    return fleet.plan(logs, vehicle="{vehicle}/{drive}/data/*")


def cluster(workers: int) -> LocalCluster:
    return LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=":0")


def sorted_lines(out: Path) -> list[bytes]:
    return sorted(line for path in out.glob("*.jsonl") for line in path.read_bytes().splitlines())


def one_process(folder: Path, plan: fleet.Plan) -> None:
    """What the others are held against."""
    fleet.run(plan, folder / "one")
    fleet.merge(folder / "one", plan=plan, out=folder / "one")


class Killer:
    """Kills one busy worker when a third of the logs are done; `busy` gives processes by their numbers."""

    def __init__(self, busy: Callable[[], list[int]]):
        self.busy = busy
        self.victim: int | None = None

    def __call__(self, done: int, total: int) -> None:
        if self.victim is None and done >= total / 3:
            for process in self.busy()[:1]:
                self.victim = process
                os.kill(process, signal.SIGKILL)


def killed_of_dask(folder: Path, plan: fleet.Plan) -> None:
    with cluster(3) as workers, Client(workers) as client:
        pids = client.run(os.getpid)
        kill = Killer(lambda: [pids[worker] for worker, tasks in client.processing().items() if tasks])
        out = folder / "dask"
        took = timed(lambda: fleet.dask(client, plan, out=out, batch=1, progress=kill))
    held_against_one_process("Dask", out, plan, kill, took)


def killed_of_ray(folder: Path, plan: fleet.Plan) -> None:
    ray.init(num_cpus=3, include_dashboard=False, log_to_driver=False, configure_logging=False)
    try:
        kill = Killer(busy_with_ray)
        out = folder / "ray"
        took = timed(lambda: fleet.ray(plan, out=out, batch=1, progress=kill))
    finally:
        ray.shutdown()
    held_against_one_process("Ray", out, plan, kill, took)


def busy_with_ray() -> list[int]:
    """Processes beneath this one that run the command line: Ray tells no numbers of its workers."""
    busy = []
    for process in psutil.Process().children(recursive=True):
        with contextlib.suppress(psutil.NoSuchProcess):
            if process.name() == Path(binary()).name:
                busy.append(process.ppid())
    return busy


def held_against_one_process(engine: str, out: Path, plan: fleet.Plan, kill: Killer, took: float) -> None:
    keys = [record["key"] for record in fleet.read_records(out)]
    once = sorted(keys) == sorted(job["key"] for job in plan)
    one = out.parent / "one"
    same = sorted_lines(out) == sorted_lines(one)
    files = ["fleet.json", "drives.parquet", "radars.parquet"]
    merged = all((out / name).read_bytes() == (one / name).read_bytes() for name in files)
    victim = "none was busy" if kill.victim is None else "yes"
    print(f"\nkill -9 of one of 3 workers of {engine}: {victim}, {len(keys)} records in {took:.1f} s")
    print(f"  every log once: {once}; records equal to one process's: {same}; merged files equal: {merged}")
    if not (kill.victim and once and same and merged):
        sys.exit("a log was lost, or the result differs")


def rounds(count: int, ways: dict[str, Callable[[int], float]]) -> dict[str, float]:
    """The median of what each way takes, where they take turns."""
    times: dict[str, list[float]] = {name: [] for name in ways}
    for turn in range(count):
        for name in list(ways) if turn % 2 == 0 else list(ways)[::-1]:
            times[name].append(ways[name](turn))
    return {name: statistics.median(all_of_it) for name, all_of_it in times.items()}


def timed(work: Callable[[], object]) -> float:
    began = time.perf_counter()
    work()
    return time.perf_counter() - began


def scaling(folder: Path, plan: fleet.Plan, count: int) -> None:
    """Half of the logs on one worker, all of them on two: with no loss both take the same time."""
    half = fleet.Plan(plan.lines[::2])
    both = fleet.Plan(plan.lines[: 2 * len(half.lines)])
    with cluster(1) as one, cluster(2) as two, Client(one) as on_one, Client(two) as on_two:

        def run(client: Client, jobs: fleet.Plan, name: str) -> Callable[[int], float]:
            return lambda turn: timed(lambda: fleet.dask(client, jobs, out=folder / f"{name}-{turn}"))

        took = rounds(count, {"one": run(on_one, half, "one"), "two": run(on_two, both, "two")})
    print(f"\nweak scaling: {len(half)} logs on 1 worker {took['one']:.2f} s, {len(both)} on 2 {took['two']:.2f} s")
    work = len(both) / len(half)
    print(f"  speed-up {work * took['one'] / took['two']:.2f}, efficiency {work * took['one'] / took['two'] / 2:.2f}")


def overhead(folder: Path, plan: fleet.Plan, count: int) -> None:
    """A log by each way, one after another on one thread, beside the command line's own time."""
    logs = [job["path"] for job in plan]

    def calibrate(_: int) -> float:
        command = [binary(), "calibrate", "--json"]
        return timed(lambda: [subprocess.run([*command, log], check=True, capture_output=True) for log in logs])

    with cluster(1) as workers, Client(workers) as client:
        ways: dict[str, Callable[[int], float]] = {
            "boresight calibrate": calibrate,
            "boresight.calibrate": lambda _: timed(lambda: [boresight.calibrate(log) for log in logs]),
            "fleet run": lambda turn: timed(lambda: fleet.run(plan, folder / f"run-{turn}", threads=1)),
            "a Dask worker": lambda turn: timed(lambda: fleet.dask(client, plan, out=folder / f"dask-{turn}")),
        }
        took = rounds(count, ways)
    print(f"\n{'a log, ms':<22}{'all':>8}{'over boresight calibrate':>28}")
    for name, seconds in took.items():
        more = (seconds - took["boresight calibrate"]) / len(logs) * 1e3
        print(f"{name:<22}{seconds / len(logs) * 1e3:8.1f}{more:28.1f}")
    print("Dask's is without planning, and with merging. Records have no outlook, which is part of calibrate's time.")


if __name__ == "__main__":
    main()
