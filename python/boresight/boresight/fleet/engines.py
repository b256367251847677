"""Work on the workers of Dask and of Ray."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Unpack, overload

from ..command import Place
from ..options import CalibrateOptions, DriveFormat
from ..results import Fleet
from ..validation import Validation, ValidationWork
from .plan import Logs, Plan, absolute, plan
from .work import FleetWork, Work

if TYPE_CHECKING:
    from distributed import Client

Progress = Callable[[int, int], object]
"""Told how many logs or parts are done, and how many there are."""


@overload
def dask(
    client: "Client",
    logs: Validation,
    *,
    out: Place,
    retries: int = 3,
    progress: Progress | None = None,
) -> dict[str, Any]: ...


@overload
def dask(
    client: "Client",
    logs: Logs | Plan,
    *,
    out: Place,
    retries: int = 3,
    batch: int | None = None,
    progress: Progress | None = None,
    retry: bool = False,
    vehicle: str | None = None,
    sensor: int | None = None,
    joint: bool = False,
    format: DriveFormat | None = None,
    **options: Unpack[CalibrateOptions],
) -> Fleet: ...


def dask(
    client: "Client",
    logs: Logs | Plan | Validation,
    *,
    out: Place,
    retries: int = 3,
    batch: int | None = None,
    progress: Progress | None = None,
    retry: bool = False,
    **settings: Any,
) -> Fleet | dict[str, Any]:
    """Calibrates a fleet's drives on the workers of Dask, or runs a validation there.

    Arguments:

        client: A client of the cluster. Its workers need this package, and the logs by the same paths.
        logs: Logs as for `plan`, a plan, or a `Validation`.
        out: Folder on this machine for records and results. What was done there before is not done again.
        retries: How often a batch may end in an exception, such as a process that ran out of memory, and is tried
            again. How many workers may die over one batch is the scheduler's `allowed-failures`.
        batch: Jobs a batch; up to eight if absent, and fewer where there are few.
        progress: Called as records come, with the number of logs done and of all.
        retry: Run logs again that failed.
        settings: Of `plan`: vehicle, sensor, joint, format and options.

    What the fleet comes to, as `merge` tells it, or the validation. A log that cannot be calibrated is a record that
    says so. An exception is what stops the run: `BoresightError`, or one of Dask. Records that came before are kept.
    """
    from distributed import as_completed

    with _work(logs, out, batch, retry, settings) as work:
        _tell(progress, work)
        tasks = work.tasks(sum(client.nthreads().values()))
        futures = {client.submit(work.call, task, pure=False, retries=retries): task for task in tasks}
        try:
            for future in as_completed(list(futures)):
                work.take(futures[future], future.result())
                _tell(progress, work)
                del futures[future]
        finally:
            client.cancel(list(futures))
        return work.finish()  # type: ignore[no-any-return]


@overload
def ray(
    logs: Validation,
    *,
    out: Place,
    retries: int = 3,
    progress: Progress | None = None,
) -> dict[str, Any]: ...


@overload
def ray(
    logs: Logs | Plan,
    *,
    out: Place,
    retries: int = 3,
    batch: int | None = None,
    progress: Progress | None = None,
    retry: bool = False,
    vehicle: str | None = None,
    sensor: int | None = None,
    joint: bool = False,
    format: DriveFormat | None = None,
    **options: Unpack[CalibrateOptions],
) -> Fleet: ...


def ray(
    logs: Logs | Plan | Validation,
    *,
    out: Place,
    retries: int = 3,
    batch: int | None = None,
    progress: Progress | None = None,
    retry: bool = False,
    **settings: Any,
) -> Fleet | dict[str, Any]:
    """Calibrates a fleet's drives on Ray, or runs a validation there; a core a task.

    Arguments and results are those of `dask`. `ray.init` says which cluster; without it Ray begins one on this machine.
    `retries` counts both workers that died over a batch and exceptions.
    """
    import ray as engine

    with _work(logs, out, batch, retry, settings) as work:
        _tell(progress, work)
        if not engine.is_initialized():
            engine.init()
        tasks = work.tasks(int(engine.cluster_resources().get("CPU", 1)))
        remote = engine.remote(num_cpus=1, max_retries=retries, retry_exceptions=True)(work.call)
        pending = {remote.remote(task): task for task in tasks}
        try:
            while pending:
                ready, _ = engine.wait(list(pending), num_returns=1)
                for future in ready:
                    work.take(pending[future], engine.get(future))
                    _tell(progress, work)
                    del pending[future]
        finally:
            for future in pending:
                engine.cancel(future)
        return work.finish()  # type: ignore[no-any-return]


def _work(logs: Logs | Plan | Validation, out: Place, batch: int | None, retry: bool, settings: dict[str, Any]) -> Work:
    if isinstance(logs, Validation):
        if settings or retry or batch is not None:
            given = [*settings, *(["retry"] if retry else []), *(["batch"] if batch is not None else [])]
            raise TypeError(f"a validation takes no {', '.join(given)}")
        return ValidationWork(logs, out)
    if isinstance(logs, Plan):
        if settings:
            raise TypeError(f"a plan has its settings; it takes no {', '.join(settings)}")
        return FleetWork(logs, out, batch, retry)
    return FleetWork(plan(absolute(logs), **settings), out, batch, retry)


def _tell(progress: Progress | None, work: Work) -> None:
    if progress:
        progress(work.done, work.total)
