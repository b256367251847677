"""Errors and warnings of the command line, as exceptions and warnings of Python."""

import re
import warnings
from collections.abc import Mapping

REPORT = re.compile(
    r"^error: (?P<message>.*?)\n {2}what: {5}(?P<what>.*?)\n {2}expected: (?P<expected>.*?)\n"
    r" {2}given: {4}(?P<given>.*?)\n {2}code: {5}(?P<code>\S*)$",
    re.DOTALL | re.MULTILINE,
)
# What the parser of the command line says of a value that is none.
VALUES = (
    re.compile(r"(?P<what>.+?) is (?P<given>.+?); expected (?P<expected>.+)", re.DOTALL),
    re.compile(
        r"invalid value '(?P<given>.*?)' for '(?P<what>\S+).*?'\s*\[possible values: (?P<expected>.+?)\]", re.DOTALL
    ),
    re.compile(r"invalid value '(?P<given>.*?)' for '(?P<what>\S+).*?': (?P<expected>.+)", re.DOTALL),
)


class BoresightError(Exception):
    """What is wrong, what was expected, and what was given instead."""

    def __init__(self, code: str, what: str, expected: str, given: str, message: str = "") -> None:
        super().__init__(code, what, expected, given, message)
        self.code = code
        """A stable name in kebab case, such as `malformed-file`."""
        self.what = what
        """What is wrong: an option by its name in Python, a file."""
        self.expected = expected
        """What would have been accepted."""
        self.given = given
        """What was given."""
        self.message = message or f"{what} is {given}; expected {expected}"
        """All of it in a sentence."""

    def __str__(self) -> str:
        return f"{self.message} [{self.code}]"


class BoresightWarning(UserWarning):
    """What to know of a result that is there all the same."""


def error_of(stderr: str, status: int, names: Mapping[str, str]) -> BoresightError:
    """The error that a command ended with, which names options by `names`, a name for each flag."""

    def named(text: str) -> str:
        return re.sub(r"--[a-z][a-z-]*", lambda found: names.get(found[0], found[0]), text)

    reports = list(REPORT.finditer(stderr))
    if reports:
        parts = {name: named(text) for name, text in reports[-1].groupdict().items()}
        return BoresightError(parts["code"], parts["what"], parts["expected"], parts["given"], parts["message"])
    if status < 0:
        return BoresightError("killed", "the command", "one that ends by itself", f"an end by signal {-status}")
    told = stderr[stderr.rfind("error: ") + len("error: ") :] if "error: " in stderr else stderr
    message = named(re.split(r"\n\s*\n", told.strip())[0].strip())
    value = next(filter(None, (pattern.fullmatch(message) for pattern in VALUES)), None)
    if value:
        return BoresightError("option", value["what"], value["expected"], value["given"], message)
    return BoresightError("usage", "the command", "options that it takes", message, message or f"status {status}")


def warn_of(stderr: str, stacklevel: int) -> None:
    """Gives what a command remarked to `warnings`."""
    for line in stderr.splitlines():
        kind, _, text = line.partition(":") if line.startswith("note:") else line.partition(" ")
        if kind in ("note", "warning") and text.strip():
            warnings.warn(text.strip(), BoresightWarning, stacklevel=stacklevel + 1)
