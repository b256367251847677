"""A fleet on Ray: python ray_fleet.py OUT LOG...

With RAY_ADDRESS in the environment the cluster is the one there, else one of this machine.
"""

import os
import sys

import boresight


def main(out: str, *logs: str) -> None:
    fleet = boresight.fleet.ray(
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
