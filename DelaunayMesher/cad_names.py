"""Names of CAD elements as FreeCAD has them, 'Face3' for instance -> which element that is."""

import re

from .errors import refusal

_NAME = re.compile(r"^(Vertex|Edge|Face|Solid)([1-9][0-9]*)$")


def parse_name(name):
    """('Face', 3) for 'Face3'; raises InputError for anything that is not a CAD element's name."""
    match = _NAME.match(name)
    if not match:
        raise refusal(
            "%r is no name of a CAD element; use VertexN, EdgeN, FaceN or SolidN" % name, "unknown_name"
        )
    return match.group(1), int(match.group(2))


def carrier(name, counts, aliases):
    """('Face', 2), counted from 0, for 'Face3', or for the face at the same place that has its elements.

    counts: {'Vertex', 'Edge', 'Face', 'Solid': how many the part has}; aliases: kind -> {number: that of the
    one of another solid into which it was merged}. Raises InputError for an element that is not there.
    """
    kind, number = parse_name(name)
    count = counts[kind]
    if number > count:
        raise refusal("there is no %s: the part has %s" % (name, _all_of(kind, count)), "unknown_name", name)
    return kind, aliases.get(kind, {}).get(number - 1, number - 1)


def _all_of(kind, count):
    """'Face1 to Face12' for a message."""
    if count == 0:
        return "no element of this kind"
    return "only %s1" % kind if count == 1 else "%s1 to %s%d" % (kind, kind, count)
