"""Undo and redo of runs.

FreeCAD's undo refers to the old FEM mesh instead of copying it, and the next assignment overwrites what it
refers to: the old mesh would be lost.  So every run has a number, a property of the mesh object that takes
part in undo, and the meshes of earlier runs are kept here as arrays, for the length of the session.  After an
undo or redo the mesh with the object's number is put back.
"""

from contextlib import contextmanager

import FreeCAD

from .femmesh import fill, put

MOST_ELEMENTS = 3000000  # in the meshes kept for one object besides the last two; some 60 bytes each


class Kept:
    """A mesh of an earlier run: what FreeCAD gets is made again when it is wanted."""

    def __init__(self, mesh, groups):
        self.mesh, self.groups, self.elements = mesh, groups, len(mesh.tets)

    def put_into(self, target):
        for _ in put(target, fill(self.mesh, self.groups)):
            pass


class Copied:
    """A mesh that no run of this session made, that of an opened document for instance."""

    def __init__(self, filled):
        self.filled, self.elements = filled.copy(), filled.VolumeCount

    def put_into(self, target):
        target.FemMesh = self.filled


class Runs:
    """The meshes of one mesh object; `shown` is the number of the one that the object holds."""

    def __init__(self, shown):
        self.meshes = {}
        self.shown = shown


class UndoObserver:
    """FreeCAD calls these after each undo and redo."""

    def slotUndoDocument(self, document):
        restore(document)

    def slotRedoDocument(self, document):
        restore(document)


observers = []


def runs_of(target):
    """The Runs of a mesh object."""
    proxy = target.Proxy
    if not hasattr(proxy, "runs"):
        proxy.runs = Runs(target.RunNumber)
    return proxy.runs


@contextmanager
def kept(target):
    """While a new mesh is put into the object: its present one is kept, and put back after an error."""
    number = keep_present(target)
    try:
        yield
    except BaseException:
        runs = runs_of(target)
        runs.meshes[number].put_into(target)
        runs.shown = number
        raise


def keep_present(target):
    """Keep the mesh that the object has; returns the number of the run that made it."""
    if not observers:
        observers.append(UndoObserver())
        FreeCAD.addDocumentObserver(observers[0])
    runs = runs_of(target)
    if target.RunNumber not in runs.meshes:
        runs.meshes[target.RunNumber] = Copied(target.FemMesh)
    return target.RunNumber


def number_run(target, mesh, groups):
    """Give the mesh that the object has got a number; inside the transaction that is to be undone."""
    runs = runs_of(target)
    target.RunNumber += 1
    runs.shown = target.RunNumber
    undoable = target.Document.UndoMode > 0
    runs.meshes = {number: old for number, old in runs.meshes.items() if undoable and number < runs.shown}
    runs.meshes[runs.shown] = Kept(mesh, groups)
    forget_oldest(runs)


def forget_oldest(runs):
    """Stay within MOST_ELEMENTS, the last two meshes not counted."""
    older = sorted(runs.meshes)[:-2]
    elements = sum(runs.meshes[number].elements for number in older)
    for number in older:
        if elements <= MOST_ELEMENTS:
            break
        elements -= runs.meshes.pop(number).elements


def restore(document):
    """Put the meshes back that the numbers of the document's mesh objects ask for."""
    for target in document.Objects:
        runs = getattr(getattr(target, "Proxy", None), "runs", None)
        if not isinstance(runs, Runs) or runs.shown == target.RunNumber:
            continue
        wanted = runs.meshes.get(target.RunNumber)
        if wanted is None:
            FreeCAD.Console.PrintWarning(
                "%s: the mesh of this step is no longer kept, run the mesher again\n" % target.Label
            )
            continue
        wanted.put_into(target)
        runs.shown = target.RunNumber
        target.purgeTouched()
