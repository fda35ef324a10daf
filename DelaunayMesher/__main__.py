"""The command line: python3 -m DelaunayMesher INPUT -o OUTPUT [options]

Exit status: 0 done, 1 no mesh (the reason on stderr), 2 wrong usage or unreadable input, 3 mesh written but
some elements are below the target angle for another reason than the input's own angles, 130 cancelled.
"""

import argparse
import os
import sys
import time
from contextlib import nullcontext
from itertools import combinations

from . import __version__
from .cadprocess import CAD_ENDINGS, CadProcess, ending_of
from .errors import (
    EXIT_BELOW_TARGET,
    EXIT_CANCELLED,
    EXIT_OK,
    InputError,
    MeshCancelled,
    MeshError,
    in_number,
    refusal,
)
from .options import BY_NAME, OPTIONS, MeshOptions
from .progress import TerminalBar


def parser():
    """The argument parser; its options are the rows of options.py."""
    result = argparse.ArgumentParser(
        prog="python3 -m DelaunayMesher",
        description="Mesh a CAD solid or a closed triangulated surface with tetrahedra.",
        epilog="Exit status: 0 done, 1 no mesh, 2 wrong usage or unreadable input, 3 mesh written but below "
        "the target angle, 130 cancelled.",
    )
    result.add_argument(
        "input",
        metavar="INPUT",
        help=".step .iges .brep .FCStd through FreeCAD; .stl .off .ply .obj .mesh .vtk .poly .smesh without",
    )
    result.add_argument(
        "-o", "--output", required=True, metavar="OUTPUT", help=".FCStd .inp .vtu .msh .med .unv ..."
    )
    for option in OPTIONS:
        add_option(result, option)
    result.add_argument(
        "--size-at",
        action="append",
        default=[],
        metavar="NAME=MM",
        help="size at FaceN, EdgeN, VertexN or SolidN, counted from 1; may be repeated",
    )
    result.add_argument("--report", metavar="FILE.json", help="write what was made, how good and how fast")
    result.add_argument("--quiet", action="store_true", help="print errors only")
    result.add_argument("--version", action="version", version="DelaunayMesher " + __version__)
    return result


def add_option(target, option):
    """One row of the table as a command line option."""
    text = option.help.replace("%", "%%")
    if option.kind == "bool":
        action = "store_false" if option.default else "store_true"
        text = ("do not " if option.default else "") + text
        target.add_argument(option.flag, dest=option.name, action=action, default=option.default, help=text)
        return
    if option.default is not None:
        text += " (default %g)" % option.default
    # Checked by options.py, which knows the ranges and says what is wrong.
    choices = "|".join(str(choice) for choice in option.choices)
    target.add_argument(
        option.flag, dest=option.name, default=option.default, metavar=option.metavar or choices, help=text
    )


def mesh_options(arguments):
    """MeshOptions from parsed arguments; raises InputError."""
    sizes = {}
    for item in arguments.size_at:
        name, equals, size = item.partition("=")
        if not equals:
            raise refusal("--size-at needs NAME=MM, not %r" % item)
        sizes[name.strip()] = size
    return MeshOptions(sizes=sizes, **{option.name: getattr(arguments, option.name) for option in OPTIONS})


def main(argv=None):
    """Run the command line; returns the exit status."""
    arguments = parser().parse_args(argv)
    bar = TerminalBar() if sys.stderr.isatty() and not arguments.quiet else None
    try:
        check_places(arguments)
    except InputError as error:  # no report: its place may be the file that is to stay as it is
        return failed(arguments, error, bar)[0]
    try:
        status, report = work(arguments, bar)
    except KeyboardInterrupt:
        status, report = failed(arguments, MeshCancelled("command line"), bar)
    except MeshError as error:
        status, report = failed(arguments, error, bar)
    if arguments.report and report is not None:
        from .report import write_report

        try:
            write_report(arguments.report, report)
        except OSError as error:
            complain("%s: %s" % (arguments.report, error.strerror))
            return EXIT_CANCELLED if status == EXIT_CANCELLED else max(status, InputError.exit_code)
    return status


def check_places(arguments):
    """Raise InputError when input, output and report are not files of their own."""
    files = [("the input", arguments.input), ("the output", arguments.output)]
    if arguments.report:
        files.append(("the report", arguments.report))
    for (other, taken), (what, path) in combinations(files, 2):
        if is_same_file(path, taken):
            raise InputError("write", "same_file", "%s: %s would replace %s" % (path, what, other))


def is_same_file(path, other):
    """Whether both name one file, which need not exist: by links, or written otherwise."""
    if os.path.exists(path) and os.path.exists(other):
        return os.path.samefile(path, other)
    return os.path.normcase(os.path.realpath(path)) == os.path.normcase(os.path.realpath(other))


def work(arguments, bar):
    """Mesh, write, say what was made: (exit status, report)."""
    with source_of(arguments) as source:  # first, as what follows loads NumPy and the core meanwhile
        return mesh_source(source, arguments, bar)


def source_of(arguments):
    """The input for pipeline.run(): a CadProcess unless the shape itself is needed again."""
    path = arguments.input
    apart = ending_of(path) in CAD_ENDINGS and ending_of(arguments.output) != ".fcstd"
    if apart and os.path.isfile(path) and sys.executable and "FreeCAD" not in sys.modules:
        return CadProcess(path)
    return nullcontext(path)


def mesh_source(source, arguments, bar):
    """As work()."""
    from .meshfile import check_output, write_mesh
    from .pipeline import run

    options = mesh_options(arguments)
    check_output(arguments.output)
    if arguments.report and not os.path.isdir(os.path.dirname(os.path.abspath(arguments.report))):
        raise refusal("%s: there is no such folder" % arguments.report)
    mesh = run(source, options, bar)
    start = time.perf_counter()
    if bar:
        bar("write", 0.0)
    write_mesh(arguments.output, mesh)
    mesh.seconds["write"] = time.perf_counter() - start
    mesh.total_seconds += mesh.seconds["write"]
    if bar:
        bar.clear()
    if not arguments.quiet:
        say(summary(mesh, arguments.output), sys.stdout)
        for warning in mesh.warnings:
            complain("warning: " + warning)
    return EXIT_BELOW_TARGET if mesh.status == "usable" else EXIT_OK, mesh.report()


def failed(arguments, error, bar):
    """Say what went wrong: (exit status, report)."""
    from .report import error_report

    if bar:
        bar.clear()
    complain(error.message if isinstance(error, MeshCancelled) else str(error))
    return error.exit_code, error_report(error, seed_of(arguments))


def seed_of(arguments):
    """The seed as a number; None when it is none."""
    try:
        return BY_NAME["seed"].check(arguments.seed)
    except InputError:
        return None


def summary(mesh, output):
    """What was made, in a few lines."""
    quality = mesh.quality
    lines = [
        "%s: %d points, %d tetrahedra of order %d" % (output, len(mesh.points), len(mesh.tets), mesh.order),
        "dihedral angles %.2f .. %.2f degrees; %s"
        % (
            quality["min_dihedral"],
            quality["max_dihedral"],
            in_number("%d element(s) below %g" % (len(mesh.below_target), mesh.options.target_angle)),
        ),
        "%.3f s: %s" % (mesh.total_seconds, ", ".join("%s %.3f" % item for item in mesh.seconds.items())),
    ]
    return "\n".join(lines)


def complain(text):
    say("DelaunayMesher: " + text, sys.stderr)


def say(text, stream):
    """Print it, unless nobody reads any more (... | head): that is no reason to stop."""
    try:
        print(text, file=stream, flush=True)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


if __name__ == "__main__":
    sys.exit(main())
