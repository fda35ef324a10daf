"""What goes wrong, in words a designer can act on (docs/errors.md lists the reason codes).

Every failure carries: status ('failed' or 'cancelled'), stage (where in the pipeline), code (a stable word
for programs), message, place (x, y, z in mm or None) and entity (a CAD element's name such as 'Face12', or
None).
"""

import re

EXIT_OK = 0
EXIT_NO_MESH = 1
EXIT_USAGE = 2
EXIT_BELOW_TARGET = 3
EXIT_CANCELLED = 130

DIMENSION_NAMES = ("Vertex", "Edge", "Face", "Solid")
_COUNTED = re.compile(r"\b([0-9]+)((?: [^\W\d][\w-]*)+?)\(s\)")


def entity_name(dimension, index):
    """Name of a CAD element: 'Face12' for (2, 11), 'Solid1' for (3, 1) as solids count from 1, or None."""
    if dimension < 0 or index < 0:
        return None
    return "%s%d" % (DIMENSION_NAMES[dimension], index if dimension == 3 else index + 1)


def in_number(text):
    """'1 place' and '2 open edges' for '1 place(s)' and '2 open edge(s)' in a text."""
    return _COUNTED.sub(lambda found: found[1] + found[2] + ("" if found[1] == "1" else "s"), text)


class MeshError(Exception):
    """No mesh: `stage`, `code`, `place` and `entity` say where and why; `str()` gives it all in one line."""

    status = "failed"
    exit_code = EXIT_NO_MESH

    def __init__(self, stage, code, message, place=None, entity=None, other=None):
        super().__init__(message)
        self.stage = stage
        self.code = code
        self.message = message
        self.place = None if place is None else tuple(float(x) for x in place)
        self.entity = entity
        self.other = other

    def __str__(self):
        names = [name for name in (self.entity, self.other) if name and name not in self.message]
        text = self.message
        if names:
            text += " [%s]" % ", ".join(names)
        if self.place is not None and " near (" not in text:
            text += " near (%.6g, %.6g, %.6g)" % self.place
        return "%s: %s (%s)" % (self.stage, text, self.code)

    def __reduce__(self):
        return type(self), (self.stage, self.code, self.message, self.place, self.entity, self.other)

    def as_dict(self):
        """For JSON reports."""
        return {
            "stage": self.stage,
            "code": self.code,
            "message": self.message,
            "place": self.place,
            "entity": self.entity,
            "other": self.other,
        }


class InputError(MeshError):
    """Unreadable input, a wrong option or an unknown name: nothing was started."""

    exit_code = EXIT_USAGE


class MeshCancelled(MeshError):
    """The progress callback asked to stop; nothing was changed."""

    status = "cancelled"
    exit_code = EXIT_CANCELLED

    def __init__(self, stage="", code="cancelled", message="cancelled", place=None, entity=None, other=None):
        super().__init__(stage, code, message, place, entity, other)


def incomplete_file():
    """The OSError for a file that is not whole, though its writer noticed no failure."""
    return OSError("the file could not be completed; is the disk full?")


def refusal(message, code="bad_option", entity=None):
    """The InputError for an option that makes no sense."""
    return InputError("options", code, message, entity=entity)
