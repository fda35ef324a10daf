"""What FreeCAD asks of a proxy when it saves and opens a document."""


class Stateless:
    """Base of the proxies: all that counts is in properties, so nothing else is saved."""

    def dumps(self):
        return None

    def loads(self, state):
        return None

    __getstate__ = dumps  # FreeCAD up to 0.21
    __setstate__ = loads
