"""References to CAD elements in FreeCAD's own objects -> names of elements of the meshed shape, sizes and
groups.

FreeCAD's mesh refinements ("mesh regions") carry a size and references; mesh groups a name and references.
They may refer to another object than the meshed one (the box inside a cut, a body's feature): the element is
then looked for by its geometry.
"""

from ..cad_names import parse_name
from ..errors import InputError
from .placement import own_shape, placement_in_mesh

REFINEMENT_LISTS = ("MeshRegionList", "MeshRefinementList")  # up to FreeCAD 1.1, and later


def referred_names(references, part, shape):
    """Names ('Face3', ...) of the elements of `shape` (that of `part`) that a References property means."""
    names = []
    for item, elements in references:
        if isinstance(elements, str):
            elements = (elements,)
        for element in [e for e in elements if e] or all_solids(item):
            names.append(find_element(item, element, part, shape))
    return list(dict.fromkeys(names))


def all_solids(item):
    """A reference to a whole object means its solids."""
    shape = own_shape(item)
    if shape is None:
        raise InputError("options", "unknown_reference", "%s has no shape to refer to" % item.Label)
    return ["Solid%d" % (number + 1) for number in range(len(shape.Solids))]


def find_element(item, element, part, shape):
    """Name of the element of `shape` (that of `part`) that `element` of `item` means; InputError if none."""
    found = matching_element(item, element, part, shape)
    if not found:
        raise InputError(
            "options",
            "unknown_reference",
            "%s of %s is not an element of the meshed part" % (element, item.Label),
            entity=element,
        )
    return found


def matching_element(item, element, part, shape):
    """find_element, but None where there is none."""
    from femtools import geomtools

    try:
        if "." in element:  # of an object in a container, of an element of an array
            wanted = item.getSubObject(element).copy()
        elif item in (part, getattr(part, "Tip", None)):  # a body has the elements of its last feature
            return element if has_element(shape, element) else None
        else:
            wanted = geomtools.get_element(item, element).copy()
        wanted.Placement = placement_in_mesh(item, part).multiply(wanted.Placement)
        return geomtools.find_element_in_shape(shape, wanted)
    except Exception:  # FreeCAD has several for an element that is gone and for an object without a shape
        return None


def has_element(shape, name):
    """Whether a shape has an element 'Face3', 'Edge1', 'Vertex2' or 'Solid1'."""
    kind, number = parse_name(name)
    return 0 < number <= len(getattr(shape, "Vertexes" if kind == "Vertex" else kind + "s"))


def refinement_objects(target):
    """FreeCAD's refinements of this mesh object, without repetition and without suppressed ones."""
    found = []
    for name in REFINEMENT_LISTS:
        for item in getattr(target, name, ()):
            if item not in found and not getattr(item, "Suppressed", False):
                found.append(item)
    return found


def refinement_sizes(target, part, shape):
    """({'Face3': 0.5, ...}, warnings) from all refinements of the mesh object; the smallest size wins."""
    sizes, warnings = {}, []
    for item in refinement_objects(target):
        size = length(item, "CharacteristicLength")
        if size <= 0.0 or not getattr(item, "References", None):
            warnings.append("%s has no effect: it needs a size and references" % item.Label)
            continue
        for name in referred_names(item.References, part, shape):
            sizes[name] = min(size, sizes.get(name, size))
    return sizes, warnings


def length(item, name):
    """A length property as a number in mm; 0 when there is none."""
    value = getattr(item, name, 0.0)
    return float(getattr(value, "Value", value) or 0.0)


def named_groups(target, part, shape):
    """[(name, ['Face1', ...]), ...] from the mesh groups of the mesh object."""
    groups = []
    for item in getattr(target, "MeshGroupList", ()):
        if item.References:
            name = item.Label if getattr(item, "UseLabel", False) else item.Name
            groups.append((name, referred_names(item.References, part, shape)))
    return groups


def constraint_names(analysis, part, shape):
    """Names of the faces, edges and vertices of `part` that the constraints of an analysis refer to (seams
    among them stay).
    """
    names = []
    for item in analysis.Group if analysis else ():
        for other, elements in getattr(item, "References", None) or ():
            wanted = [e for e in elements if e.split(".")[-1].startswith(("Face", "Edge", "Vertex"))]
            names += [matching_element(other, element, part, shape) for element in wanted]
    return [name for name in names if name]
