"""A CAD file read by a process of its own, so that FreeCAD's 100 MB are gone before meshing starts.

Idea: the process reads the shape while this one still loads its own modules, takes the options from its
standard input, converts the shape and hands back the PLCs, pickled; then it ends, unless a PLC has solids
that could be meshed one by one. A crash of FreeCAD becomes an InputError.
"""

import contextlib
import os
import pickle
import signal
import subprocess
import sys

from .errors import InputError, MeshError

CAD_ENDINGS = (".step", ".stp", ".iges", ".igs", ".brep", ".brp", ".fcstd")


def ending_of(path):
    """The file name's ending in lower case, '.step' for instance."""
    return os.path.splitext(str(path))[1].lower()


class CadProcess:
    """Stands for a CAD file in pipeline.run() and, once converted, for its document.ShapePlc.

    plcs: the Plc of each group of solids.
    """

    def __init__(self, path):
        """Starts reading."""
        self.path, self.plcs = path, []
        package = os.path.dirname(os.path.abspath(__file__))
        folders = [os.path.dirname(package), os.environ.get("PYTHONPATH")]
        self.process = subprocess.Popen(
            [sys.executable, "-m", "DelaunayMesher.cadprocess", os.fspath(path)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, folders))},
        )

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()
        with contextlib.suppress(OSError):  # what it did not read any more
            self.process.stdin.close()

    def wait(self):
        """Wait until the file is read; raises InputError."""
        self._answer()

    def convert(self, options):
        """The PLCs; raises MeshError."""
        self.plcs = self._ask(options)
        return list(self.plcs)

    def apart(self, plc):
        """As ShapePlc.apart()."""
        if plc.solid_count == 1:
            return []
        place = next(index for index, item in enumerate(self.plcs) if item is plc)
        pieces = self._ask(place)
        if pieces:
            self.plcs[place : place + 1] = pieces
        return pieces

    def _ask(self, question):
        with contextlib.suppress(OSError):  # it has died
            pickle.dump(question, self.process.stdin)
            self.process.stdin.flush()
        return self._answer()

    def _answer(self):
        try:
            answer = pickle.load(self.process.stdout)
        except (EOFError, pickle.UnpicklingError):
            raise InputError("read", "unreadable", "FreeCAD died of %s" % self.path) from None
        if isinstance(answer, MeshError):
            raise answer
        return answer


def serve(path, questions, answers):
    """Read, convert, answer: what the process does. It stays as long as there are solids to take apart."""
    from . import document

    try:
        notes = []
        shape = document.read_shape(path, notes)
        _send(None, answers)
        converted = document.convert(shape, pickle.load(questions))
        converted.plcs[0].warnings[:0] = notes
        _send(converted.plcs, answers)
        while any(plc.solid_count > 1 for plc in converted.plcs):
            _send(converted.apart(converted.plcs[pickle.load(questions)]), answers)
    except MeshError as error:
        _send(error, answers)
    except EOFError:  # nobody wants to know any more
        pass


def _send(answer, answers):
    pickle.dump(answer, answers, pickle.HIGHEST_PROTOCOL)
    answers.flush()


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # whoever started it ends it
    with os.fdopen(os.dup(1), "wb") as channel:
        os.dup2(2, 1)  # whatever OCC prints
        serve(sys.argv[1], sys.stdin.buffer, channel)
