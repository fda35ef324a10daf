"""Results of the core for several PLCs -> one; names of elements as the whole part has them."""

import re

import numpy as np

from .merge_warnings import merged

OWN = ("point_dimension", "point_entity", "tet_solid", "triangle_face", "line_edge")
SOLID = 3  # dimension


def join(results, plcs):
    """One result dict from those of several PLCs; solids get their numbers in the whole part.

    Points that coincide stay apart.  Mid-side nodes come last, as in any result.
    """
    results = [with_cad_numbers(result, plc) for result, plc in zip(results, plcs)]
    aliases = joined_aliases(plcs)
    if len(results) == 1:
        return {**results[0], "aliases": aliases}
    joined = {name: np.concatenate([result[name] for result in results]) for name in OWN}
    joined["points"] = np.concatenate([result["points"] for result in results])
    starts = np.cumsum([0] + [len(result["points"]) for result in results])[:-1]
    for name in ("tets", "triangles", "lines"):
        joined[name] = np.concatenate([result[name] + start for result, start in zip(results, starts)])
    firsts = np.cumsum([0] + [len(result["tets"]) for result in results])[:-1]
    joined["straightened"] = np.concatenate(
        [result["straightened"] + first for result, first in zip(results, firsts)]
    )
    below = [{**result["below_target"]} for result in results]
    for item, first in zip(below, firsts):
        item["tet"] = item["tet"] + first
    joined["below_target"] = {
        name: [entry for item in below for entry in item[name]]
        if name == "reason"
        else np.concatenate([item[name] for item in below])
        for name in below[0]
    }
    joined["seconds"] = list(totals(result["seconds"] for result in results).items())
    joined["statistics"] = totals(dict(result["statistics"]).items() for result in results)
    joined["warnings"] = merged(text for result in results for text in result["warnings"])
    return middles_last({**joined, "aliases": aliases})


def joined_aliases(plcs):
    """{'Face': {dropped: kept}, ...} of all PLCs."""
    joined = {}
    for plc in plcs:
        for kind, numbers in plc.aliases.items():
            joined.setdefault(kind, {}).update(numbers)
    return joined


def element_counts(plcs):
    """{'Vertex', 'Edge', 'Face', 'Solid': how many the part has} of which these are all PLCs."""
    counts = [plc.element_counts for plc in plcs]
    return {kind: max(count[kind] for count in counts) for kind in counts[0]}


def totals(tables):
    """{name: sum} over several lists of (name, number)."""
    sums = {}
    for table in tables:
        for name, number in table:
            sums[name] = sums.get(name, 0.0) + number
    return sums


def with_cad_numbers(result, plc):
    """The result with the solids of the whole part instead of those of the PLC."""
    if plc.solid_numbers is None or len(plc.solid_numbers) == plc.cad_solid_count:
        return result
    numbers = np.concatenate([[0], plc.solid_numbers]).astype(np.int32)
    entity = result["point_entity"].copy()
    inside = (result["point_dimension"] == SOLID) & (entity > 0)
    entity[inside] = numbers[entity[inside]]
    below = {**result["below_target"]}
    named = (below["dimension"] == SOLID) & (below["entity"] > 0)
    below["entity"] = np.where(named, numbers[np.where(named, below["entity"], 0)], below["entity"])
    return {
        **result,
        "point_entity": entity,
        "tet_solid": numbers[result["tet_solid"]],
        "below_target": below,
    }


def middles_last(result):
    """The result with its points in the usual order: corners, then mid-side nodes."""
    if result["tets"].shape[1] == 4:
        return result
    middle = np.zeros(len(result["points"]), dtype=bool)
    middle[result["tets"][:, 4:]] = True
    order = np.argsort(middle, kind="stable")
    place = np.empty(len(order), dtype=np.int32)
    place[order] = np.arange(len(order))
    moved = {name: result[name][order] for name in ("points", "point_dimension", "point_entity")}
    moved.update({name: place[result[name]] for name in ("tets", "triangles", "lines")})
    return {**result, **moved}


def renamed(error, plc):
    """The error with the solids' numbers in the whole part."""
    if plc.solid_numbers is None:
        return error

    def number(match):
        local = int(match.group(1))
        known = 1 <= local <= len(plc.solid_numbers)
        return "Solid%d" % plc.solid_numbers[local - 1] if known else match.group(0)

    stage, code, *texts = error.__reduce__()[1]
    message, place, entity, other = texts
    message, entity, other = (
        re.sub(r"\bSolid([0-9]+)\b", number, text) if text else text for text in (message, entity, other)
    )
    return type(error)(stage, code, message, place, entity, other)
