"""Names as JavaScript has them and as Python has them: azimuthDeg, azimuth_deg; floor-db, floor_db."""

import re


def camel(name):
    """azimuth_deg as azimuthDeg; other names as they are."""
    return re.sub(r"_([a-z0-9])", lambda found: found[1].upper(), name)


def snake(name):
    """azimuthDeg and azimuth-deg as azimuth_deg."""
    return re.sub(r"(?<=[a-z0-9])[A-Z]", lambda found: f"_{found[0].lower()}", name).replace("-", "_")


def keys_in_snake(value):
    """A value whose mappings have keys as Python has them, at every depth."""
    if isinstance(value, dict):
        return {snake(key): keys_in_snake(item) for key, item in value.items()}
    if isinstance(value, list):
        return [keys_in_snake(item) for item in value]
    return value
