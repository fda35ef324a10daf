"""The table of contents: read -> plc -> core -> mesh.

The core (core/mesher.cpp) goes on: sizing -> curves -> surfaces -> boundary -> refinement -> optimisation
-> order.
"""

import os
import time
from contextlib import contextmanager

import numpy as np

from . import extension, joining, sizing, surface_plcs, volumes
from .cadprocess import CAD_ENDINGS, CadProcess, ending_of
from .errors import InputError, MeshCancelled, MeshError, entity_name
from .options import make_options
from .plc import Plc
from .result import mesh_from_core
from .surfacefile import Surface, read_surface

HOPELESS = ("too_many_elements", "out_of_memory", "bad_size", "bad_region")  # with any of the solids
BYTES_PER_ELEMENT = 600  # peak of all stages together, second order included


def run(source, options=None, report=None, keep=()):
    """Mesh of a Part shape, a Plc, a surface (points, triangles), a file name or a CadProcess.

    options: MeshOptions, dict or None. report: callable (stage, fraction in 0..1) called now and then from
    this thread; False cancels. keep: names of elements of a Part shape that stay (document.convert).
    Raises MeshError, InputError (wrong options, unreadable file) or MeshCancelled.
    """
    core = extension.load()
    options = make_options(options)
    seconds, notes = {}, []
    start = time.perf_counter()
    if isinstance(source, (str, os.PathLike)):
        with _stage("read", seconds, report):
            source = read(source, notes)
    elif isinstance(source, CadProcess):
        with _stage("read", seconds, report):
            source.wait()
    with _stage("plc", seconds, report):
        plcs, shape, converted = to_plcs(source, options, keep)
        if options.max_size is None:
            points = np.concatenate([plc.points for plc in plcs])
            options = options.with_changes(max_size=sizing.automatic_max_size(points))
    try:
        result, warnings = mesh_all(core, plcs, converted, options, report)
    except MemoryError:
        raise MeshError("refinement", "out_of_memory", "the memory is full; use a larger size") from None
    mesh = mesh_from_core(result, options, joining.element_counts(plcs), notes + warnings)
    mesh.total_seconds = time.perf_counter() - start
    mesh.seconds = _joined(seconds, mesh.seconds)
    mesh.shape = shape
    return mesh


def mesh_all(core, plcs, converted, options, report):
    """(result of the core, warnings) of all PLCs together.

    When one with several solids of a shape fails, its solids are meshed one by one instead; a solid that
    fails alone is left out, unless all do.
    """
    waiting, done, results, warnings, failures = list(plcs), [], [], [], []
    while waiting:
        plc = waiting.pop(0)
        total = len(done) + 1 + len(waiting)
        tell = _share(report, len(done) / total, 1.0 / total) if total > 1 else report
        try:
            made = sum(len(result["tets"]) for result in results)
            result = core.mesh(plc.as_dict(), plc.geometry, options_for_core(options, plc, made), tell)
        except MeshCancelled:
            raise
        except MeshError as error:
            pieces = converted.apart(plc) if converted and error.code not in HOPELESS else []
            if not pieces:
                failures.append(joining.renamed(error, plc))
                if error.code in HOPELESS or not (done or waiting):
                    raise failures[0] from None
                warnings += [*plc.warnings, "%s left out: %s" % (solid_names(plc), failures[-1])]
                continue
            warnings += [
                *plc.warnings,
                "%s; so the solids were meshed one by one, and their meshes do not "
                "fit together where they touch" % joining.renamed(error, plc),
            ]
            waiting[:0] = pieces
            continue
        done.append(plc)
        results.append(result)
        warnings += [*plc.warnings, *volumes.volume_warnings(plc, result)]
    return joining.join(results, done), warnings


def solid_names(plc):
    """'Solid2, Solid5' of a PLC of a shape."""
    return ", ".join(entity_name(3, int(number)) for number in plc.solid_numbers)


def _share(report, start, share):
    """The report of one of several parts of the work."""
    return report and (lambda stage, fraction: report(stage, start + share * fraction))


@contextmanager
def _stage(name, seconds, report):
    """Times a stage and reports its start and end."""
    start = time.perf_counter()
    _tell(report, name, 0.0)
    yield
    _tell(report, name, 1.0)
    seconds[name] = time.perf_counter() - start


def _tell(report, stage, fraction):
    if report is not None and report(stage, fraction) is False:
        raise MeshCancelled(stage)


def _joined(first, second):
    """Seconds per stage of both, in order."""
    return {stage: first.get(stage, 0.0) + second.get(stage, 0.0) for stage in {**first, **second}}


def read(path, warnings=None):
    """A Part shape of a CAD file, or the Surface of any other file; `warnings` takes what was mended."""
    if not os.path.isfile(path):
        raise InputError("read", "unreadable", "there is no file %s" % path)
    if ending_of(path) in CAD_ENDINGS:
        from . import document

        return document.read_shape(path, warnings)
    return read_surface(path)


def to_plcs(source, options, keep=()):
    """([Plc, ...], shape or None, ShapePlc or CadProcess or None) of whatever is to be meshed."""
    if isinstance(source, CadProcess):
        return source.convert(options), None, source
    if isinstance(source, Plc):
        source.check()
        return [source], None, None
    if isinstance(source, Surface):
        return surface_plcs.to_plcs(*source), None, None
    if isinstance(source, (tuple, list)) and len(source) == 2:
        return surface_plcs.to_plcs(*source), None, None
    if hasattr(source, "Shape"):
        source = source.Shape
    if not hasattr(source, "Faces"):
        raise InputError(
            "plc",
            "unknown_source",
            "cannot mesh a %s; give a Part shape, a Plc, a file name or (points, triangles)"
            % type(source).__name__,
        )
    from . import document

    converted = document.convert(source, options, keep)
    return list(converted.plcs), source, converted


def options_for_core(options, plc, made=0):
    """The options dict of the extension; made: elements of the PLCs before, which count too."""
    points = np.zeros((0, 3)) if options.size_points is None else options.size_points
    values = np.zeros(0) if options.size_values is None else options.size_values
    return {
        "max_size": options.max_size,
        "min_size": options.min_size or 0.0,
        "growth": options.growth,
        "elements_per_circle": options.elements_per_circle,
        "elements_across": options.elements_across,
        "target_angle": options.target_angle,
        "optimise": options.optimise,
        "order": options.order,
        "seed": options.seed,
        "threads": options.used_threads(),
        "max_elements": options.max_elements or elements_that_fit(made),
        "elements_before": made,
        **sizing.sizes_by_name(options.sizes, plc),
        "regions": sizing.regions_array(options.regions),
        "size_points": points,
        "size_values": values,
    }


def elements_that_fit(made):
    """Number of tetrahedra that fit into the memory, some of which are made and in it already; 0 when the
    system does not tell."""
    try:
        with open("/proc/meminfo") as file:
            free = next(int(line.split()[1]) * 1024 for line in file if line.startswith("MemAvailable"))
    except (OSError, StopIteration, ValueError):
        return 0
    return made + max(1000, min(free // BYTES_PER_ELEMENT, 2**31 - 1))
