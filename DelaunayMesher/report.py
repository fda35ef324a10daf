"""The JSON report of a run: what was made, how good it is, how long it took."""

import json
import sys

from .errors import MeshError

REPORTED_ELEMENTS = 10000  # below_target is cut here; below_target_count has the full number


def peak_bytes():
    """Largest memory of this process so far in bytes; None where the system does not tell (Windows)."""
    try:
        with open("/proc/self/status") as file:  # getrusage's includes that of whoever started this process
            return next(int(line.split()[1]) * 1024 for line in file if line.startswith("VmHWM"))
    except (OSError, StopIteration, ValueError):
        pass
    try:
        import resource
    except ImportError:
        return None
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return int(peak) if sys.platform == "darwin" else int(peak) * 1024


def mesh_report(mesh):
    """Report of a finished mesh as a dict that json can write."""
    below = [
        _plain(item) for item in sorted(mesh.below_target, key=lambda item: (item["angle"], item["tet"]))
    ]
    return {
        "status": mesh.status,
        "seed": mesh.options.seed,
        "points": len(mesh.points),
        "tetrahedra": len(mesh.tets),
        "triangles": len(mesh.triangles),
        "order": mesh.order,
        "target_angle": mesh.options.target_angle,
        "seconds": {"total": mesh.total_seconds, **mesh.seconds},
        "peak_bytes": peak_bytes(),
        "quality": mesh.quality,
        "below_target_count": len(below),
        "below_target": below[:REPORTED_ELEMENTS],
        "straightened": [int(tet) for tet in mesh.straightened[:REPORTED_ELEMENTS]],
        "statistics": {name: float(value) for name, value in mesh.statistics.items()},
        "warnings": list(mesh.warnings),
    }


def error_report(error, seed=None):
    """Report of a run that made no mesh."""
    details = error.as_dict() if isinstance(error, MeshError) else {"code": "internal", "message": str(error)}
    return {
        "status": getattr(error, "status", "failed"),
        "seed": seed,
        "points": 0,
        "tetrahedra": 0,
        "seconds": {},
        "peak_bytes": peak_bytes(),
        "quality": {},
        "below_target": [],
        "warnings": [],
        "error": details,
    }


def write_report(path, report):
    """Write a report dict as JSON."""
    with open(path, "w", encoding="utf-8") as file:
        json.dump(report, file, indent=1)
        file.write("\n")


def _plain(item):
    return {
        "tet": item["tet"],
        "angle": round(item["angle"], 4),
        "reason": item["reason"],
        "face": item["entity"],
        "place": [round(x, 9) for x in item["place"]],
    }
