"""The elements as widgets of Jupyter and its kin, one class each, made from what the manifest says."""

import inspect
import math
import numbers
from pathlib import Path

import anywidget
import traitlets

from .elements import ELEMENTS, STATIC, told

#: Arguments of every widget of ipywidgets.
COMMON = ("layout", "tooltip", "tabbable")


class Data(traitlets.TraitType):
    """Data of an element, checked and packed when they are set.

    So they are when they are set to the same object again: the numbers in it may be others.
    """

    def __init__(self, described):
        super().__init__(None, allow_none=True, help=described.description)
        self.described = described
        self.tag(sync=True, to_json=lambda _, widget: widget._packed.get(self.name))

    def set(self, obj, value):
        before = obj._trait_values.get(self.name)
        obj._packed[self.name] = self.described.take(value)
        obj._trait_values[self.name] = value
        obj._notify_trait(self.name, before, value)


class Number(traitlets.TraitType):
    """A finite number, NumPy's too."""

    info_text = "a finite number"

    def validate(self, obj, value):
        if isinstance(value, bool) or not isinstance(value, numbers.Real) or not math.isfinite(value):
            self.error(obj, value)
        return int(value) if isinstance(value, numbers.Integral) else float(value)


class Words(traitlets.Unicode):
    """Text, where a number stands for itself."""

    def validate(self, obj, value):
        if isinstance(value, numbers.Real) and not isinstance(value, bool):
            value = str(value)
        return super().validate(obj, value)


class Told(traitlets.TraitType):
    """What an event told last; None before."""

    def __init__(self, description):
        super().__init__(None, allow_none=True, help=description)
        self.tag(sync=True, from_json=self._come, to_json=lambda _, widget: widget._came.get(self.name))

    def _come(self, value, widget):
        widget._came[self.name] = value
        return told(value)


def _setting(attribute):
    if attribute.choices:
        trait = traitlets.Enum(attribute.choices, None, allow_none=True, help=attribute.description)
    elif attribute.type == "number":
        trait = Number(None, allow_none=True, help=attribute.description)
    elif attribute.type == "boolean":
        trait = traitlets.Bool(None, allow_none=True, help=attribute.description)
    else:
        trait = Words(None, allow_none=True, help=attribute.description)
    return trait.tag(sync=True)


class Widget(anywidget.AnyWidget):
    """What all widgets of elements have in common."""

    _esm = Path(str(STATIC / "widget.js"))
    element = None

    def __init__(self, **given):
        self.element.check([name for name in given if name not in COMMON])
        self._packed, self._came = {}, {}
        super().__init__(**given)


def _documented(element):
    lines = [element.description, "", "Arguments and attributes:", ""]
    for name, one in {**element.properties, **element.attributes}.items():
        lines.append(f"    {name}: {one.type}. {one.description}")
    lines += ["", "Comes back:", ""]
    lines += [f"    {name}: {description}" for name, description in element.event_descriptions.items()]
    return "\n".join(lines)


def _made(element):
    named = inspect.Parameter
    parameters = [named(name, named.KEYWORD_ONLY, default=None) for name in (*element.properties, *element.attributes)]
    description = {
        "tag": element.tag,
        "attributes": {name: one.name for name, one in element.attributes.items()},
        "properties": {name: one.name for name, one in element.properties.items()},
        "events": element.events,
    }
    return type(
        element.name,
        (Widget,),
        {
            "__doc__": _documented(element),
            "__module__": "boresight_widget",
            "__signature__": inspect.Signature(parameters),
            "element": element,
            "_description": traitlets.Dict(description).tag(sync=True),
            **{name: Data(one) for name, one in element.properties.items()},
            **{name: _setting(one) for name, one in element.attributes.items()},
            **{name: Told(description) for name, description in element.event_descriptions.items()},
        },
    )


WIDGETS = {name: _made(element) for name, element in ELEMENTS.items()}
