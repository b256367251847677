"""The types that the package states, by mypy in strict mode."""

import subprocess
import sys

import pytest
from conftest import ROOT

PACKAGE = ROOT / "python" / "boresight"
RIGHT = """
import numpy as np
from distributed import Client
import boresight
from boresight import fleet

radars = boresight.calibrate("a", sensor=1, min_speed_mps=3, method="recursive", radar_topics=["/a"])
angle: float = radars[0]["angleDeg"]
advice: str = radars[0]["outlook"]["advice"] if radars[0]["outlook"] else ""
scenes = boresight.estimate(np.zeros(8, complex), array="ula8", method="music", sources="aic", iaa_threshold_db=30)
azimuth: float = scenes[0][0]["azimuthDeg"]
plan = fleet.plan(["a", {"path": "b", "vehicle": "c"}], vehicle="{vehicle}/*", joint=True)
keys: list[str] = [job["key"] for job in plan]
now: float = fleet.merge("records", plan=plan, alarm_deg=2)["vehicles"][0]["radars"][0]["angleDeg"]
fleet.dask(Client(), plan, out="out", progress=lambda done, total: print(done / total))
fleet.ray(["a"], out="out", vehicle="{vehicle}/*", min_speed_mps=3, batch=4)
fleet.ray(boresight.Validation("drives", parts=4, pieces=[25]), out="out")
code: str = boresight.BoresightError("a", "b", "c", "d").code
"""
#: Lines that are wrong, each with a word of what mypy says of it.
WRONG = {
    'boresight.calibrate("a", min_sped_mps=3)': "call-arg",
    'boresight.calibrate("a", min_speed_mps="3")': "arg-type",
    'boresight.calibrate("a", method="recursiv")': "arg-type",
    'boresight.calibrate("a")[0]["angle"]': "typeddict-item",
    'boresight.estimate([1j], array="ula8", method="musik")': "arg-type",
    'boresight.estimate([1j], array="ula8", sources="many")': "arg-type",
    'boresight.fleet.plan([{"path": "a", "car": "b"}])': "list-item",
    'boresight.fleet.ray(boresight.Validation("drives", parts=2), out="a", batch=2)': "call-overload",
}


def mypy(folder, *arguments):
    options = ["--config-file", str(PACKAGE / "pyproject.toml"), "--cache-dir", str(folder / "cache")]
    command = [sys.executable, "-m", "mypy", *options, *arguments]
    variables = {"MYPYPATH": str(PACKAGE)}
    ended = subprocess.run(command, cwd=PACKAGE, env=variables, capture_output=True, text=True, check=False)
    assert ended.returncode in (0, 1), ended.stderr
    return ended.stdout


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("types")


def test_the_package_passes(folder):
    assert mypy(folder).startswith("Success")
    assert (PACKAGE / "boresight" / "py.typed").exists()


def test_what_is_right_passes_and_what_is_wrong_does_not(folder):
    right = folder / "right.py"
    right.write_text(RIGHT)
    assert mypy(folder, str(right)).startswith("Success")
    wrong = folder / "wrong.py"
    wrong.write_text("import boresight\n" + "".join(f"{line}\n" for line in WRONG))
    told = mypy(folder, str(wrong)).splitlines()
    for number, (line, code) in enumerate(WRONG.items(), 2):
        about = [one for one in told if f"wrong.py:{number}:" in one]
        assert any(f"[{code}]" in one for one in about), (line, about)


def test_every_public_name_has_words():
    import inspect

    import boresight

    for module in (boresight, boresight.fleet):
        assert module.__doc__
        for name in module.__all__:
            value = getattr(module, name)
            if inspect.isfunction(value) or inspect.isclass(value):
                assert inspect.getdoc(value), name
                methods = vars(value).items() if inspect.isclass(value) else ()
                public = [one for method, one in methods if inspect.isfunction(one) and not method.startswith("_")]
                assert all(one.__doc__ for one in public), name
