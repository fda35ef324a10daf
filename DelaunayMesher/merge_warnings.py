"""Warnings of several PLCs that differ in numbers and names only -> one that holds for all."""

import re

from .errors import DIMENSION_NAMES

NAMED = 12  # elements named in a message, as in the core

_NAME = "(?:%s)[0-9]+" % "|".join(DIMENSION_NAMES)
_NAMES = r"(?P<names>\b%s(?:, %s)*)(?: and (?P<more>[0-9]+) more)?" % (_NAME, _NAME)
_LENGTH = r"(?P<length>[0-9.]+(?:e[-+][0-9]+)?) mm\b"
_NUMBER = "[-+0-9.e]+"
_PLACE = r"(?P<place>\(%s, %s, %s\))" % (_NUMBER, _NUMBER, _NUMBER)
_COUNT = r"(?P<count>\b[0-9]+\b)"
_VARYING = re.compile("|".join((_NAMES, _PLACE, _LENGTH, _COUNT)))


def merged(warnings):
    """List of the warnings, without repetition; of those with the same words the first takes all in:
    lists of elements are united (and cut short), counts added up, of lengths the smallest holds, of places
    the first."""
    groups = {}
    for text in dict.fromkeys(warnings):
        groups.setdefault(_VARYING.sub("#", text), []).append(text)
    return [texts[0] if len(texts) == 1 else _merge(texts) for texts in groups.values()]


def _merge(texts):
    """One text of several with the same words."""
    found = zip(*(_VARYING.finditer(text) for text in texts))
    replacements = iter([_common(matches) for matches in found])
    return _VARYING.sub(lambda _: next(replacements), texts[0])


def _common(matches):
    """What stands for the varying parts (regular expression matches) at one place of the texts."""
    first = matches[0]
    if first["names"]:
        names = sorted({name for match in matches for name in match["names"].split(", ")}, key=_order)
        more = sum(int(match["more"] or 0) for match in matches) + max(0, len(names) - NAMED)
        return ", ".join(names[:NAMED]) + (" and %d more" % more if more else "")
    if first["place"]:
        return first["place"]
    if first["length"]:
        return min((match["length"] for match in matches), key=float) + " mm"
    return str(sum(int(match["count"]) for match in matches))


def _order(name):
    """Faces, edges, vertices, solids; each by number."""
    kind = re.match("[A-Z][a-z]+", name).group()
    return ("Face", "Edge", "Vertex", "Solid").index(kind), int(name[len(kind) :])
