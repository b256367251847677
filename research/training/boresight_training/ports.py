"""Inputs and outputs of exported models."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Port:
    """An input or output; axes are numbers, or names where any length goes."""

    name: str
    axes: tuple[int | str, ...]
    meaning: str


def snapshot_ports(elements) -> tuple[Port, Port]:
    """Inputs of networks that answer one snapshot."""
    return (
        Port("snapshots", ("batch", elements, 2), "real and imaginary part of each virtual element, in one order"),
        Port(
            "positions",
            (elements, 3),
            "positions of the virtual elements in that order, half wavelengths, x forward, y left, z up",
        ),
    )
