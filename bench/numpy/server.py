"""Times and runs the NumPy methods for the bench, which talks to it in lines of JSON.

A request is one JSON object a line on standard input; the answer is one line on standard output.

    {"do": "versions"}
    {"do": "prepare", "id", "method", "positions", "options", "data", "shape"}
        data: path of little-endian float64, interleaved re, im, C order; shape: scenes, elements,
        snapshots. Builds the plan outside of any timing.
    {"do": "estimate", "id"}          the angles and powers of every scene
    {"do": "time", "id", "calls"}     seconds of that many calls, taking the scenes in turn
    {"do": "prepare-chain", "id", "data", "shape", "options"}, {"do": "chain", "id"}
        the same for range and Doppler transforms and CFAR: loops, channels, samples of float32
    {"do": "prepare-motion", "id", "data", "shape", "options"}, {"do": "motion", "id"}
        the same for RANSAC: frames, 2 (azimuth in rad, range rate), detections of float64
"""

import json
import platform
import sys
import time

import numpy as np
import scipy

from chain import Chain
from methods import METHODS
from ransac import Ransac

WORK = {}


def versions(_):
    blas = np.show_config(mode="dicts")["Build Dependencies"]["blas"]
    return {
        "python": platform.python_version(),
        "numpy": np.__version__,
        "scipy": scipy.__version__,
        "blas": f"{blas.get('name')} {blas.get('version')}",
    }


def prepare(request):
    scenes, elements, snapshots = request["shape"]
    data = np.fromfile(request["data"], dtype="<f8").view(np.complex128)
    data = data.reshape(scenes, elements, snapshots)
    method = METHODS[request["method"]](request["positions"], request["options"])
    WORK[request["id"]] = (method.estimate, [np.ascontiguousarray(y) for y in data])
    return {}


def estimate(request):
    run, scenes = WORK[request["id"]]
    results = [run(y) for y in scenes]
    return {
        "azimuthDeg": [r.azimuth_deg.tolist() for r in results],
        "powerDb": [r.power_db.tolist() for r in results],
        "iterations": [int(r.iterations) for r in results],
    }


def prepare_chain(request):
    cube = np.fromfile(request["data"], dtype="<f4").view(np.complex64).reshape(request["shape"])
    WORK[request["id"]] = (Chain(cube.shape, request["options"]).run, [cube])
    return {}


def chain(request):
    run, scenes = WORK[request["id"]]
    return {"detections": run(scenes[0]).tolist()}


def prepare_motion(request):
    frames = np.fromfile(request["data"], dtype="<f8").reshape(request["shape"])
    WORK[request["id"]] = (Ransac(request["options"]).motion, list(frames))
    return {}


def motion(request):
    run, frames = WORK[request["id"]]
    return {"velocityMps": [run(frame)[0].tolist() for frame in frames]}


def measure(request):
    run, scenes = WORK[request["id"]]
    count = len(scenes)
    calls = range(request["calls"])
    start = time.perf_counter()
    for call in calls:
        run(scenes[call % count])
    return {"seconds": time.perf_counter() - start}


HANDLERS = {
    "versions": versions,
    "prepare": prepare,
    "estimate": estimate,
    "time": measure,
    "prepare-chain": prepare_chain,
    "chain": chain,
    "prepare-motion": prepare_motion,
    "motion": motion,
}


def main():
    for line in sys.stdin:
        request = json.loads(line)
        try:
            answer = HANDLERS[request["do"]](request)
        except Exception as error:  # the bench shows it beside the method's name
            answer = {"error": f"{type(error).__name__}: {error}"}
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
