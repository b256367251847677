"""docs/notebooks.md names the versions that the tests run on, and all that widgets take and tell."""

import re
from importlib.metadata import version
from pathlib import Path

from boresight_widget.elements import ELEMENTS

TEXT = (Path(__file__).parents[2] / "docs" / "notebooks.md").read_text(encoding="utf-8")


def test_versions_are_those_of_the_requirements():
    for name in ("JupyterLab", "anywidget", "marimo", "Streamlit"):
        (named,) = re.findall(rf"{name} (\d+\.\d+\.\d+)", TEXT)
        assert named == version(name), name


def test_data_and_events_are_named():
    for element in ELEMENTS.values():
        assert f"`{element.name}`" in TEXT
        for name in (*element.properties, *element.events.values()):
            assert f"`{name}`" in TEXT, f"{element.name}.{name}"
