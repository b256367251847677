"""The elements, as the manifest that the build puts beside this tells of them."""

import base64
import json
from dataclasses import dataclass
from importlib.resources import files

from . import shapes
from .codec import pack, unpack
from .names import keys_in_snake, snake

STATIC = files("boresight_widget") / "static"

#: Names of what comes back, where they are not those of the events: `view` and `cell` are data of elements, too.
EVENTS = {"select": "selection", "view": "viewed", "cell": "chosen_cell"}

#: Keys are the host's, and an event of the browser says nothing in Python.
NOT_TOLD = ("key",)

#: Names the traits of a widget, which has them already; of an element it is a help for keyboards.
NOT_TAKEN = ("keys",)

#: Draws what functions in JavaScript say.
IN_JAVASCRIPT = ("boresight-plot",)


@dataclass(frozen=True)
class Attribute:
    """A setting: its name in HTML, its type in TypeScript, and what it says."""

    name: str
    type: str
    description: str

    @property
    def choices(self):
        """Values it takes; none where it takes any."""
        return [part.strip()[1:-1] for part in self.type.split("|")] if "'" in self.type else []


@dataclass(frozen=True)
class Property:
    """Data: its name in JavaScript, its type in TypeScript, and what it says."""

    name: str
    type: str
    description: str

    @property
    def plain_type(self):
        return self.type.removesuffix(" | null").removeprefix("readonly ")

    @property
    def crosses(self):
        """Whether it can be given from Python."""
        return self.plain_type not in shapes.IN_JAVASCRIPT

    @property
    def shape(self):
        return shapes.SHAPES[self.plain_type]

    def take(self, value):
        """The bytes of a value, None of none; raises TypeError or ValueError where it does not fit."""
        return None if value is None else pack(self.shape.take(value, snake(self.name), {}))


@dataclass(frozen=True)
class Element:
    """An element. What it is given and what comes back are by their names in Python."""

    tag: str
    name: str
    description: str
    attributes: dict[str, Attribute]
    properties: dict[str, Property]
    events: dict[str, str]
    event_descriptions: dict[str, str]

    def check(self, given):
        """Raises TypeError where an element takes no such argument."""
        takes = {**self.attributes, **self.properties}
        for name in given:
            if name not in takes:
                raise TypeError(f"{self.name} takes no {name}; it takes {', '.join(sorted(takes))}")


def told(value):
    """What an event told, with keys as in Python; arrays come packed, as text where a host has text only."""
    if isinstance(value, str):
        value = base64.b64decode(value)
    if isinstance(value, bytes | bytearray | memoryview):
        value = unpack(value)
    return keys_in_snake(value)


def _read():
    try:
        manifest = json.loads((STATIC / "elements.json").read_text(encoding="utf-8"))
    except FileNotFoundError as problem:
        raise ImportError("boresight_widget has no front end: `npm run build` puts it into the package") from problem
    elements = {}
    for made in manifest["elements"]:
        if made["tag"] in IN_JAVASCRIPT:
            continue
        attributes = {
            snake(one["name"]): Attribute(**one) for one in made["attributes"] if one["name"] not in NOT_TAKEN
        }
        events = {one["name"]: one["name"].removeprefix("boresight-") for one in made["events"]}
        events = {event: snake(EVENTS.get(name, name)) for event, name in events.items() if name not in NOT_TOLD}
        elements[made["name"]] = Element(
            tag=made["tag"],
            name=made["name"],
            description=made["description"],
            attributes=attributes,
            # A capture's frame is a number, a setting; the map that it makes of it cannot be given.
            properties={
                snake(one["name"]): Property(**one)
                for one in made["properties"]
                if snake(one["name"]) not in attributes and Property(**one).crosses
            },
            events=events,
            event_descriptions={
                events[one["name"]]: one["description"] for one in made["events"] if one["name"] in events
            },
        )
    return manifest["version"], elements


VERSION, ELEMENTS = _read()
