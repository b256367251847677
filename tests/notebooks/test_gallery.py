"""The code for notebooks that the page Elements gives to copy runs, with every setting that its form has."""

from pathlib import Path

import pytest

from boresight_widget.elements import ELEMENTS

ROOT = Path(__file__).parents[2]
CELLS = sorted((ROOT / "web/app/pages/elements/python").glob("*.py"))
TAGS = {element.tag.removeprefix("boresight-"): element for element in ELEMENTS.values()}


@pytest.fixture
def recordings(tmp_path, monkeypatch):
    """A folder with the files of the recordings, in which the cells run."""
    for pattern in ("awr1642/*.bin", "awr1642/*.cfg", "awr1642/*.dat", "delphi/*.gz"):
        for path in (ROOT / "recordings").glob(pattern):
            (tmp_path / path.name).symlink_to(path)
    monkeypatch.chdir(tmp_path)


def setting(attribute):
    if attribute.choices:
        return attribute.choices[0]
    return {"number": 1, "boolean": True}.get(attribute.type, "1")


def test_each_element_has_a_cell():
    assert [path.stem for path in CELLS] == sorted(TAGS)


@pytest.mark.parametrize("path", CELLS, ids=lambda path: path.stem)
@pytest.mark.parametrize("all_set", [False, True])
def test_cells_run(path, all_set, recordings):
    element = TAGS[path.stem]
    given = {name: setting(one) for name, one in element.attributes.items()} if all_set else {}
    text = path.read_text(encoding="utf-8")
    assert text.count("settings = {}") == 1
    cell = text.replace("settings = {}", f"settings = {given!r}")
    *_, last = cell.strip().splitlines()
    names = {}
    exec(compile(cell, str(path), "exec"), names)
    assert type(names[last]).__name__ == element.name
