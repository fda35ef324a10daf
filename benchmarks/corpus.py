"""Our command line over a folder of CAD files and surfaces: one row per part, with a time limit for each.

    /usr/bin/python3 benchmarks/corpus.py FOLDER -o table.csv [--seconds 60] [--merge rivals.csv]

The folder is your own: no part is kept here. Each part runs in a process of its own; a row says whether
there is a mesh (ok), how large, its worst angles, the elements below the target angle by reason, the time
and the memory, or what went wrong. Sizes are automatic (1/20 of the diagonal), or --max-size, or those of
--merge: a table of other meshers with the same columns (part, mesher, size, ...; missing ones stay empty),
whose rows are written beside ours.
"""

import argparse
import csv
import json
import os
import signal
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, ROOT)

from DelaunayMesher.cadprocess import CAD_ENDINGS, ending_of  # noqa: E402
from DelaunayMesher.surfacefile import READERS  # noqa: E402

REASONS = ("input_angle", "size_floor", "fallback")
BELOW = ("5", "10", "15", "20")
COLUMNS = [
    *("part", "mesher", "size", "ok", "status", "seconds", "wall", "MB", "tets"),
    *("min_dihedral", "max_dihedral", *("below" + limit for limit in BELOW), *REASONS, "note"),
]


def parts_in(folder):
    """Names of the files that we can read."""
    known = (*CAD_ENDINGS, *READERS)
    return sorted(name for name in os.listdir(folder) if ending_of(name) in known)


def run_limited(command, seconds):
    """(exit status or None when it took too long, what it wrote on stderr)"""
    process = subprocess.Popen(
        command,
        cwd=ROOT,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        start_new_session=True,
    )
    try:
        errors = process.communicate(timeout=seconds)[1]
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)  # FreeCAD's own children too
        process.communicate()
        return None, ""
    return process.returncode, errors.decode(errors="replace")


def mesh_part(path, name, size, options):
    """The row of one part."""
    row = {"part": os.path.basename(path), "mesher": name, "size": size or "", "ok": 0}
    with tempfile.TemporaryDirectory() as folder:
        report = os.path.join(folder, "report.json")
        command = [sys.executable, "-m", "DelaunayMesher", os.path.abspath(path)]
        command += ["-o", os.path.join(folder, "mesh.vtu"), "--report", report, "--quiet"]
        command += ["--threads", str(options.threads), "--order", str(options.order)]
        if size:
            command += ["--max-size", str(size)]
        if options.no_optimise:
            command.append("--no-optimise")
        start = time.perf_counter()
        status, errors = run_limited(command, options.seconds)
        row["wall"] = "%.2f" % (time.perf_counter() - start)
        if os.path.exists(report):
            with open(report, encoding="utf-8") as stream:
                row.update(row_of_report(json.load(stream)))
    row["ok"] = int(status in (0, 3))
    row["status"] = "timeout" if status is None else status
    if not row["ok"]:
        row["note"] = "over %g s" % options.seconds if status is None else last_line(errors)
    return row


def row_of_report(report):
    """The columns that come from a JSON report."""
    row = {"MB": (report["peak_bytes"] or 0) // 2**20, "tets": report["tetrahedra"] or ""}
    if not report["tetrahedra"]:
        return row
    quality = report["quality"]
    reasons = [item["reason"] for item in report["below_target"]]
    row.update(("below" + limit, quality["below"][limit]) for limit in BELOW)
    row.update((reason, reasons.count(reason)) for reason in REASONS)
    taken = report["seconds"]  # of these, the mesh alone
    row["seconds"] = "%.3f" % (taken["total"] - taken["read"] - taken["write"])
    row["min_dihedral"], row["max_dihedral"] = (
        "%.2f" % quality[which + "_dihedral"] for which in ("min", "max")
    )
    row["note"] = "; ".join(report["warnings"])
    return row


def last_line(text):
    lines = [line for line in text.splitlines() if line.strip()]
    return lines[-1] if lines else ""


def read_table(path):
    """Rows of another table, as dicts."""
    with open(path, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def sizes_of(rows):
    """{part: the first size that a table has for it}"""
    sizes = {}
    for row in rows:
        if row.get("size"):
            sizes.setdefault(row["part"], float(row["size"]))
    return sizes


def write_table(path, rows):
    with open(path, "w", newline="", encoding="utf-8") as stream:
        table = csv.DictWriter(stream, COLUMNS, restval="", extrasaction="ignore")
        table.writeheader()
        table.writerows(sorted(rows, key=lambda row: row["part"]))


def write_markdown(path, rows):
    """A table with one line for each part and one column for each mesher, ours first."""
    meshers = sorted({row["mesher"] for row in rows}, key=lambda name: (not name.startswith("ours"), name))
    found = {(row["part"], row["mesher"]): row for row in rows}
    lines = ["| part | " + " | ".join(meshers) + " |", "| --- |" + " --- |" * len(meshers)]
    for part in sorted({row["part"] for row in rows}):
        cells = [cell(found.get((part, name))) for name in meshers]
        lines.append("| %s | %s |" % (os.path.splitext(part)[0], " | ".join(cells)))
    with open(path, "w", encoding="utf-8") as stream:
        stream.write("\n".join(lines) + "\n")


def cell(row):
    """'elements, smallest..largest angle, seconds', or why there is no mesh."""
    if row is None:
        return ""
    if str(row["ok"]) != "1" or not row.get("min_dihedral"):
        note = row.get("note") or ""
        return "no mesh: time" if "timeout" in note or note.startswith("over") else "no mesh"
    thousands = int(row["tets"]) / 1000
    angles = "%.1f..%.1f" % (float(row["min_dihedral"]), float(row["max_dihedral"]))
    return "%.1f k, %s, %.2f s" % (thousands, angles, float(row["seconds"]))


def summary(rows):
    """One line for each mesher: successes and quality over the parts it meshed."""
    for name in sorted({row["mesher"] for row in rows}):
        own = [row for row in rows if row["mesher"] == name]
        done = [row for row in own if str(row["ok"]) == "1" and row.get("min_dihedral")]
        angles = sorted(float(row["min_dihedral"]) for row in done)
        if not angles:
            print("%s: 0 of %d meshed" % (name, len(own)))
            continue
        tets = sum(int(row["tets"]) for row in done)
        seconds = sum(float(row["seconds"]) for row in done)
        good = sum(angle >= 20 for angle in angles)
        print(
            "%s: %d of %d meshed, %d with all angles at least 20 degrees; smallest angles: worst %.2f, "
            "median %.2f; %d tetrahedra in %.1f s"
            % (name, len(done), len(own), good, angles[0], angles[len(angles) // 2], tets, seconds)
        )


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", help="CAD files and closed triangulated surfaces")
    parser.add_argument("-o", "--output", required=True, help="the table, .csv")
    parser.add_argument("--markdown", help="the same as a page, .md")
    parser.add_argument("--seconds", type=float, default=60, help="time limit for each part")
    parser.add_argument("--parts", nargs="+", help="only files whose name contains one of these")
    parser.add_argument("--max-size", type=float, help="the same size for all parts, mm")
    parser.add_argument("--order", type=int, default=1, choices=(1, 2))
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--no-optimise", action="store_true")
    parser.add_argument("--merge", help="a table of other meshers; their sizes are used")
    options = parser.parse_args()

    rivals = read_table(options.merge) if options.merge else []
    sizes = sizes_of(rivals)
    name = "ours, not optimised" if options.no_optimise else "ours"
    rows = []
    for part in parts_in(options.folder):
        if options.parts and not any(word in part for word in options.parts):
            continue
        size = options.max_size or sizes.get(part)
        row = mesh_part(os.path.join(options.folder, part), name, size, options)
        rows.append(row)
        angles = "%s .. %s" % (row.get("min_dihedral", ""), row.get("max_dihedral", ""))
        print(part, row["status"], row.get("tets", ""), angles, row["wall"], row.get("note", ""), flush=True)
        meshed = {row["part"] for row in rows}
        table = rows + [rival for rival in rivals if rival["part"] in meshed]
        write_table(options.output, table)
        if options.markdown:
            write_markdown(options.markdown, table)
    print()
    summary(table)


main()
