"""The command line that the simulators are held against; one thread, for several wait for one another."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import torch

sys.path.insert(0, str(Path(__file__).parents[1]))
torch.set_num_threads(1)


@pytest.fixture
def boresight(tmp_path):
    """Runs `boresight simulate` and returns the array it writes."""

    def run(*arguments):
        out = tmp_path / "out.npy"
        command = [os.environ["BORESIGHT"], "simulate", *map(str, arguments), "--seed", "1", "--out", out]
        done = subprocess.run(command, capture_output=True, text=True, timeout=60)
        assert done.returncode == 0, done.stderr
        return torch.from_numpy(np.load(out))

    return run
