"""Mounting angles of many drives, on this machine or on the workers of Dask or Ray.

A plan has a job a log; running one gives a record, which depends on the job alone; records are merged to what the
fleet comes to. `run` and `merge` are steps by themselves; `dask` and `ray` do all of it.
"""

from ..results import Fleet
from .engines import dask, ray
from .plan import Job, Plan, plan
from .records import Failure, Record, read_records
from .steps import merge, run

__all__ = [
    "Failure",
    "Fleet",
    "Job",
    "Plan",
    "Record",
    "dask",
    "merge",
    "plan",
    "ray",
    "read_records",
    "run",
]
