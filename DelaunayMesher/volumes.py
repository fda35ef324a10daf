"""Whether the mesh of each solid has the volume of the part."""

from .errors import entity_name

OFF = 0.05  # share of a volume: more than refined facets of curved faces change


def volume_warnings(plc, result):
    """What to know about solids of a Plc whose tetrahedra fill neither the volume of the surface mesh nor
    that of the part.

    Only where boundary triangles were replaced can tetrahedra be on the wrong side; elsewhere coarse facets
    of round faces, which the refinement makes rounder, are all that differs.  result: dict of the core.
    """
    if not result["statistics"]["boundary_replaced"]:
        return []
    warnings = []
    pairs = zip(result["surface_volumes"].tolist(), result["tet_volumes"].tolist())
    for number, (surface, filled) in enumerate(pairs, 1):
        if is_off(filled, surface) and is_off(filled, plc.volume(number)):
            warnings.append(
                "the mesh of %s has %.4g mm3, but the solid %.4g mm3: where its faces lie too close to each "
                "other the mesh is not the part. Give these faces a smaller size"
                % (solid_name(plc, number), filled, plc.volume(number))
            )
    return warnings


def is_off(volume, wanted):
    return abs(volume - wanted) > OFF * abs(wanted)


def solid_name(plc, number):
    """'Solid3' as the whole part counts."""
    numbers = plc.solid_numbers
    return entity_name(3, number if numbers is None else int(numbers[number - 1]))
