"""A fleet on Dask: python dask_fleet.py OUT LOG...

With DASK_SCHEDULER_ADDRESS in the environment the cluster is the one there, else three processes of this machine.
"""

import os
import sys

from distributed import Client, LocalCluster

import boresight


def main(out: str, *logs: str) -> None:
    address = os.environ.get("DASK_SCHEDULER_ADDRESS")
    with Client(address or LocalCluster(n_workers=3, threads_per_worker=1, dashboard_address=":0")) as client:
        fleet = boresight.fleet.dask(
            client,
            logs,
            out=out,
            vehicle=os.environ.get("VEHICLE"),
            progress=lambda done, total: print(f"{done} of {total} logs", file=sys.stderr),
        )
    for vehicle in fleet["vehicles"]:
        for radar in vehicle["radars"]:
            print(vehicle["name"], radar["sensor"], f"{radar['angleDeg']:.3f} deg", sep="\t")


if __name__ == "__main__":
    main(*sys.argv[1:])
