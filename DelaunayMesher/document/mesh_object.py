"""The FEM mesh document object: its properties are the options, run() fills it.

It links to the meshed part (`Shape`), and FreeCAD's own mesh refinements and mesh groups work on it.
Recomputing the document never meshes.  A run that fails or is cancelled leaves the object as it was.
"""

import hashlib
import json
import time
from dataclasses import asdict, dataclass
from typing import Any, List, Tuple

import Fem  # noqa: F401  registers the document types; without it the better type below is not known
import FreeCAD
import numpy as np

from ..errors import InputError
from ..options import MeshOptions
from ..surfacefile import Surface
from . import femmesh, history, references
from .placement import is_surface, own_shape, source_of
from .properties import add_option_properties, get_options, set_options
from .size_region import add_size_region, regions_of
from .stateless import Stateless

TYPES = ("Fem::FemMeshShapeBaseObjectPython", "Fem::FemMeshObjectPython")  # from FreeCAD 1.0; before
LINK_LISTS = {
    "MeshRegionList": "Mesh refinements (FreeCAD up to 1.1)",
    "MeshRefinementList": "Mesh refinements",
    "MeshGroupList": "Mesh groups",
    "SizeRegionList": "Sizes inside spheres, boxes and cylinders",
    "MeshBoundaryLayerList": "Not used; FreeCAD's tree asks for it",
}
LARGEST_LIST = 200  # entries of a list kept in the stored report
WITHOUT_EFFECT = ("threads", "max_elements")  # options that do not change the mesh


class MeshDelaunay(Stateless):
    """Proxy of the document object."""

    Type = "Fem::FemMeshDelaunay"

    def __init__(self, target):
        target.Proxy = self
        add_properties(target)

    def onDocumentRestored(self, target):
        """Old documents get the properties they lack, those made without a window the view."""
        add_properties(target)
        if FreeCAD.GuiUp:
            from ..gui import missing_view, view_mesh_object

            missing_view.complete(target, view_mesh_object.VPMeshDelaunay)

    def execute(self, target):
        """Recomputing does not mesh: that is run()'s job."""


def add_properties(target):
    """Add the properties that the object does not have yet."""
    if not hasattr(target, "Shape"):
        target.addProperty("App::PropertyLinkGlobal", "Shape", "FEM Mesh", "The part that is meshed")
    for name, text in LINK_LISTS.items():
        if not hasattr(target, name):
            target.addProperty("App::PropertyLinkList", name, "Base", text)
    add_option_properties(target)
    if not hasattr(target, "Sizes"):
        target.addProperty(
            "App::PropertyStringList", "Sizes", "Size", "Sizes at elements of the part: Face3=0.5"
        )
    for name, text, hidden in (
        ("Summary", "What the last run made", False),
        ("Report", "The report of the last run (JSON)", True),
    ):
        if not hasattr(target, name):
            target.addProperty("App::PropertyString", name, "Result", text, 0, True, hidden)
    if not hasattr(target, "RunNumber"):
        text = "Number of the run that made the mesh; undo goes by it"
        target.addProperty("App::PropertyInteger", "RunNumber", "Result", text, 0, True, True)


def add_mesh(part, analysis=None, name="FEMMeshDelaunay", **options):
    """A new, empty mesh object for the document object `part`, in `analysis` (default: the active one, if
    any).

    part: anything with a solid, or a closed mesh of triangles (Mesh::Feature).
    options: as MeshOptions takes them, such as max_size=5.0, order=2, sizes={"Face3": 0.5}.  Raises
    InputError for an unknown or impossible option; nothing is created then.
    """
    from ..options import make_options

    if own_shape(part) is None and not is_surface(part):
        raise InputError("options", "no_shape", "%s has no shape to mesh" % getattr(part, "Label", part))
    if analysis is not None and not analysis.isDerivedFrom("Fem::FemAnalysis"):
        raise InputError("options", "no_analysis", "%s is no analysis" % analysis.Label)
    chosen = make_options(None, **options)
    if chosen.size_points is not None:
        raise InputError("options", "not_stored", "size_points are not kept in documents; give them to run()")
    document = part.Document
    known = document.supportedTypes()
    target = document.addObject(next(kind for kind in TYPES if kind in known), name)
    MeshDelaunay(target)
    target.Shape = part
    target.Label = "%s_Mesh" % part.Label
    attach_view(target)
    store_options(target, chosen)
    analysis = analysis or active_analysis(document)
    if analysis:
        analysis.addObject(target)
    return target


def store_options(target, options):
    """Write a MeshOptions into a new mesh object; each of its regions becomes a size region."""
    set_options(target, options)
    target.Sizes = size_rows(options.sizes)
    for region in options.regions:
        add_size_region(target, region)


def size_rows(sizes):
    """['Face3=0.5', ...] from {'Face3': 0.5, ...}, as the property Sizes holds them."""
    return ["%s=%.12g" % item for item in sizes.items()]


def read_sizes(rows):
    """{'Face3': 0.5, ...} from the property Sizes; InputError for a row that is not like that."""
    sizes = {}
    for row in rows:
        name, _, size = row.partition("=")
        try:
            sizes[name.strip()] = float(size)
        except ValueError:
            raise InputError(
                "options", "bad_size", "a size is written like Face3=0.5, not %r" % row
            ) from None
    return sizes


def attach_view(target):
    """The view provider, where there is a window."""
    if FreeCAD.GuiUp:
        from ..gui import view_mesh_object

        view_mesh_object.VPMeshDelaunay(target.ViewObject)


def active_analysis(document):
    """The analysis that is active in the window and belongs to this document, or None."""
    if not FreeCAD.GuiUp:
        return None
    import FemGui

    analysis = FemGui.getActiveAnalysis()
    return analysis if analysis and analysis.Document == document else None


def analysis_of(target):
    """The analysis that holds the mesh object, or None."""
    for user in target.InList:
        if user.isDerivedFrom("Fem::FemAnalysis"):
            return user
    return None


@dataclass
class Task:
    """What a run of a mesh object is given.

    shape: a Part shape, or the Surface of a mesh of triangles; keep: names of elements that stay; groups:
    (name, names of elements) pairs; made_from: tells one part and its options from another, see is_current().
    """

    shape: Any
    options: MeshOptions
    keep: List[str]
    groups: List[Tuple[str, List[str]]]
    warnings: List[str]
    made_from: str

    def detach(self):
        """Take a copy of the shape: the document's own may be recomputed while a thread works on it."""
        if not isinstance(self.shape, Surface):
            self.shape = self.shape.copy()

    def mesh(self, report=None):
        """The Mesh; report as in run()."""
        mesh = mesh_shape(self.shape, self.options, report, self.keep)
        mesh.warnings[:0] = self.warnings
        return mesh


def collect(target, **extra):
    """The Task of a mesh object; extra as in run().  Raises InputError."""
    part = target.Shape
    if part is None:
        raise InputError("options", "no_part", "%s is not linked to a part" % target.Label)
    shape = source_of(part)
    if shape is None:
        raise InputError("options", "no_shape", "%s has no visible shape to mesh" % part.Label)
    sizes = read_sizes(target.Sizes)
    refined, warnings = references.refinement_sizes(target, part, shape)
    for name, size in refined.items():
        sizes[name] = min(size, sizes.get(name, size))
    options = get_options(target, sizes=sizes, regions=regions_of(target))
    made_from = fingerprint(shape, options)
    options = options.with_changes(**{**extra, "regions": [*options.regions, *extra.get("regions", ())]})
    groups = references.named_groups(target, part, shape)
    keep = references.constraint_names(analysis_of(target), part, shape)
    keep += [name for _, names in groups for name in names]
    return Task(shape, options, keep, groups, warnings, made_from)


def fingerprint(shape, options):
    """Text that differs when the mesh of a shape (or Surface) with these options does.

    By places that its geometry has wherever it is stored or drawn: the volume takes OCC seconds, and the
    bounding box of a shape changes once it was drawn.
    """
    if isinstance(shape, Surface):
        places = shape.points[shape.triangles].reshape(-1, 3)
    else:
        places = np.array([tuple(place) for place in places_of(shape)])
    size = max(np.linalg.norm(np.ptp(places, axis=0)), 1e-300)
    shares = np.round(places / size, 6) + 0.0  # no negative zeros
    chosen = {name: value for name, value in asdict(options).items() if name not in WITHOUT_EFFECT}
    return "%.7g %s %s" % (size, hashlib.md5(shares.tobytes()).hexdigest(), chosen)


def places_of(shape):
    """The vertices of a shape, the middles of its edges and faces, the poles of its splines, in order."""
    for vertex in shape.Vertexes:
        yield vertex.Point
    for edge in shape.Edges:
        if not edge.Degenerated:
            yield edge.valueAt(sum(edge.ParameterRange) / 2)
            yield from getattr(edge.Curve, "getPoles", list)()
    for face in shape.Faces:
        u0, u1, v0, v1 = face.ParameterRange
        yield face.valueAt((u0 + u1) / 2, (v0 + v1) / 2)
        for row in getattr(face.Surface, "getPoles", list)():
            yield from row


def is_current(target):
    """Whether the object holds a mesh made from the part and the options as they are now, which has nodes on
    all that loads and mesh groups refer to (a seam, say, has none as long as nothing does).

    A mesh that came otherwise (an opened file, an earlier version) counts as current.  Raises InputError.
    """
    if not target.FemMesh.VolumeCount:
        return False
    made_from = stored_report(target).get("made_from")
    if target.Shape is None or made_from is None:
        return True
    task = collect(target)
    return made_from == task.made_from and has_all(target.FemMesh, task)


def has_all(mesh, task):
    """Whether a Fem.FemMesh of ours has the groups and the nodes that a Task asks for."""
    present = {mesh.getGroupName(group) for group in mesh.Groups}
    vertices = [name for name in task.keep if name.startswith("Vertex")]
    wanted = {name for name in task.keep if name not in vertices}
    return (
        wanted <= present
        and all(mesh.getNodesByVertex(task.shape.getElement(name)) for name in vertices)
        and all(any(g == name or g.startswith(name + "_") for g in present) for name, _ in task.groups)
    )


def run(target, report=None, **extra):
    """Mesh the part and fill the object; blocks.  Returns the Mesh.

    report: callable (stage, fraction) -> bool, False cancels.  extra: regions, size_points, size_values.
    Raises MeshError, InputError or MeshCancelled; the object then keeps what it had.
    """
    task = collect(target, **extra)
    mesh = task.mesh(report)
    start = time.perf_counter()
    with history.kept(target):
        for _ in femmesh.put(target, femmesh.fill(mesh, task.groups)):
            pass
        mesh.seconds["write"] = time.perf_counter() - start
        mesh.total_seconds += mesh.seconds["write"]
        record(target, mesh, task)
    return mesh


def mesh_shape(shape, options, report=None, keep=()):
    """Mesh of a Part shape or a Surface (pipeline.run); keep: names of elements that stay."""
    from .. import pipeline

    return pipeline.run(shape, options, report, keep)


def record(target, mesh, task):
    """Say in the object what its new mesh is, in the step that undo is to take back."""
    describe(target, mesh, task.made_from)
    history.number_run(target, mesh, task.groups)


def describe(target, mesh, made_from=None):
    """Say in the object what its mesh is like, and what it was made from."""
    target.Summary = summary(mesh)
    target.Report = json.dumps({**shortened(mesh.report()), "made_from": made_from})


def summary(mesh):
    """One line for people."""
    angles = mesh.quality
    return (
        "%d nodes, %d tetrahedra of order %d, dihedral angles %.1f to %.1f degrees, %d below %.4g, %.1f s"
        % (
            len(mesh.points),
            len(mesh.tets),
            mesh.order,
            angles["min_dihedral"],
            angles["max_dihedral"],
            len(mesh.below_target),
            mesh.options.target_angle,
            mesh.total_seconds,
        )
    )


def shortened(report):
    """The report with long lists cut, so that the document stays small."""
    return {
        key: value[:LARGEST_LIST] if isinstance(value, list) and len(value) > LARGEST_LIST else value
        for key, value in report.items()
    }


def stored_report(target):
    """The report on the object's mesh as a dict; {} when no run made it, or it was cleared since."""
    return json.loads(target.Report) if target.Report and target.FemMesh.VolumeCount else {}
