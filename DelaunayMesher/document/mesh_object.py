"""The FEM mesh document object: its properties are the options, run() fills it.

It links to the meshed part (`Shape`), and FreeCAD's own mesh refinements and mesh groups work on it.
Recomputing the document never meshes.  A run that fails or is cancelled leaves the object as it was.
"""

import json
import time

import Fem  # noqa: F401  registers the document types; without it the better type below is not known
import FreeCAD

from ..errors import InputError
from . import femmesh, references
from .placement import own_shape, shape_to_mesh
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


class MeshDelaunay(Stateless):
    """Proxy of the document object."""

    Type = "Fem::FemMeshDelaunay"

    def __init__(self, target):
        target.Proxy = self
        add_properties(target)

    def onDocumentRestored(self, target):
        """Old documents get the properties they lack."""
        add_properties(target)

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

    options: as MeshOptions takes them, such as max_size=5.0, order=2, sizes={"Face3": 0.5}.  Raises
    InputError for an unknown or impossible option; nothing is created then.
    """
    from ..options import make_options

    if own_shape(part) is None:
        raise InputError("options", "no_shape", "%s has no shape to mesh" % getattr(part, "Label", part))
    chosen = make_options(None, **options)
    if chosen.size_points is not None:
        raise InputError("options", "not_stored", "size_points are not kept in documents; give them to run()")
    document = part.Document
    known = document.supportedTypes()
    target = document.addObject(next(kind for kind in TYPES if kind in known), name)
    MeshDelaunay(target)
    target.Shape = part
    target.Label = "%s_Mesh" % part.Label
    set_options(target, chosen)
    target.Sizes = size_rows(chosen.sizes)
    attach_view(target)
    for region in chosen.regions:
        add_size_region(target, region)
    analysis = analysis or active_analysis(document)
    if analysis:
        analysis.addObject(target)
    return target


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


def collect(target, **extra):
    """(shape, options, names of elements to keep, groups, warnings) for a run of the mesh object."""
    part = target.Shape
    if part is None:
        raise InputError("options", "no_part", "%s is not linked to a part" % target.Label)
    shape = shape_to_mesh(part)
    sizes = read_sizes(target.Sizes)
    refined, warnings = references.refinement_sizes(target, part, shape)
    for name, size in refined.items():
        sizes[name] = min(size, sizes.get(name, size))
    regions = [*regions_of(target), *extra.pop("regions", ())]
    options = get_options(target, sizes=sizes, regions=regions, **extra)
    groups = references.named_groups(target, part, shape)
    keep = references.constraint_names(analysis_of(target), part)
    keep += [name for _, names in groups for name in names]
    return shape, options, keep, groups, warnings


def run(target, report=None, **extra):
    """Mesh the part and fill the object; blocks.  Returns the Mesh.

    report: callable (stage, fraction) -> bool, False cancels.  extra: regions, size_points, size_values.
    Raises MeshError, InputError or MeshCancelled; the object then keeps what it had.
    """
    shape, options, keep, groups, warnings = collect(target, **extra)
    mesh = mesh_shape(shape, options, report, keep)
    mesh.warnings[:0] = warnings
    start = time.perf_counter()
    for _ in femmesh.put(target, femmesh.fill(mesh, groups)):
        pass
    mesh.seconds["write"] = time.perf_counter() - start
    mesh.total_seconds += mesh.seconds["write"]
    describe(target, mesh)
    return mesh


def mesh_shape(shape, options, report=None, keep=()):
    """Mesh of a Part shape (pipeline.run); keep: names of elements that stay."""
    from .. import pipeline

    return pipeline.run(shape, options, report, keep)


def describe(target, mesh):
    """Say in the object what its mesh is like."""
    target.Summary = summary(mesh)
    target.Report = json.dumps(shortened(mesh.report()))


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
    """The report of the last run as a dict; {} when there was none."""
    return json.loads(target.Report) if target.Report else {}
