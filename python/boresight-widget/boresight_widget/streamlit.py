"""The elements as components of Streamlit, one function each: `spectrum`, `range_doppler` and so on.

Each takes what the widget of the same name takes, and `key`, as elements of Streamlit do. It gives what came back, by
name, as attributes. Each event runs the script again, so those of every move of the pointer come back only where
`events` names them.
"""

from types import SimpleNamespace

import streamlit

from .codec import pack
from .elements import ELEMENTS, told
from .names import snake

#: What comes back unless `events` says otherwise.
DEFAULT_EVENTS = ("selection", "alarm", "result", "error")

_component = streamlit.components.v2.component("boresight-widget.element", js="widget.js")


def _shown(element, key, events, given):
    element.check(given)
    asked = {event: name for event, name in element.events.items() if name in events}
    data = {
        "tag": element.tag,
        "attributes": {one.name: given.get(name) for name, one in element.attributes.items()},
        "properties": {one.name: one.take(given.get(name)) for name, one in element.properties.items()},
        "events": asked,
    }
    state = _component(data=pack(data), key=key, **{f"on_{name}_change": lambda: None for name in asked.values()})
    return SimpleNamespace(**{name: told(state.get(name)) for name in asked.values()})


def _function(element):
    def show(*, key=None, events=DEFAULT_EVENTS, **given):
        return _shown(element, key, events, given)

    show.__name__ = show.__qualname__ = snake(element.name[0].lower() + element.name[1:])
    show.__doc__ = f"{element.description} Takes what `boresight_widget.{element.name}` takes."
    return show


_functions = [_function(element) for element in ELEMENTS.values()]
globals().update({function.__name__: function for function in _functions})
__all__ = [function.__name__ for function in _functions]
