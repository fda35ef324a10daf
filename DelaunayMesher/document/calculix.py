"""From the mesh to stresses: CalculiX on the analysis of a mesh object, with FreeCAD's own tools.

solve(mesh) blocks; a Calculation lets CalculiX run beside the window.  Everything that FreeCAD's solver
objects can do is theirs (properties, working folder, results); here they are only driven, in the way that the
running version of FreeCAD wants it.
"""

import os
import shutil
import tempfile

import FreeCAD

from ..errors import MeshError, in_number
from .mesh_object import analysis_of

CCX_TOOLS, CALCULIX = "Fem::SolverCcxTools", "Fem::SolverCalculiX"  # the second from FreeCAD 1.1 on
MAKERS = ("makeSolverCalculiXCcxTools", "makeSolverCalculixCcxTools")  # from FreeCAD 1.0 on, and before


def solve(target):
    """Solve the analysis that `target`, a mesh object, is in; returns the result object.

    Raises MeshError with stage 'solve' when something is missing or CalculiX fails.
    """
    calculation = Calculation(target)
    process = calculation.start()
    process.waitForFinished(-1)
    return calculation.load()


class Calculation:
    """One run of CalculiX: the constructor writes its input, start() runs it, load() reads the results."""

    def __init__(self, target):
        self.analysis = analysis_of(target)
        if self.analysis is None:
            raise failure("no_analysis", "%s is in no analysis; drag it into one" % target.Label)
        present = self.analysis.Group
        self.solver = solver_of(self.analysis)
        try:
            check(self.analysis, self.solver, target)
        except MeshError:
            if self.solver not in present:
                target.Document.removeObject(self.solver.Name)
            raise
        tool = CcxTools if kind_of(self.solver) == CCX_TOOLS else CalculixTools
        self.tool = tool(self.analysis, self.solver)
        self.process = None

    def start(self):
        """The running QProcess."""
        self.process = self.tool.start()
        return self.process

    def load(self):
        """The result object, when the process has ended well; else MeshError with CalculiX's own words."""
        output = bytes(self.process.readAllStandardOutput()).decode("utf-8", "replace")
        errors = [line.strip() for line in output.splitlines() if "*ERROR" in line]
        if errors or self.process.exitCode():
            reason = "; ".join(errors[:3]) or "exit status %d" % self.process.exitCode()
            raise failure("calculix", "CalculiX gave up: %s" % reason)
        return self.tool.load()


class CcxTools:
    """The solver object that every FreeCAD has."""

    def __init__(self, analysis, solver):
        from femtools.ccxtools import FemToolsCcx

        self.program = ccx_program()
        self.tool = FemToolsCcx(analysis, solver)
        self.tool.update_objects()
        self.tool.setup_working_dir()
        self.tool.write_inp_file()

    def start(self):
        from PySide import QtCore

        folder, name = os.path.split(os.path.splitext(self.tool.inp_file_name)[0])
        process = QtCore.QProcess()
        process.setWorkingDirectory(folder)
        environment = QtCore.QProcessEnvironment.systemEnvironment()
        environment.insert("OMP_NUM_THREADS", str(os.cpu_count() or 1))
        process.setProcessEnvironment(environment)
        process.start(self.program, ["-i", name])
        return process

    def load(self):
        self.tool.reset_mesh_purge_results_checked()
        self.tool.load_results()
        return newest(self.tool.analysis.Group, "Fem::FemResultObject")


class CalculixTools:
    """The solver object of FreeCAD 1.1 and later; it reads its results itself when the process ends."""

    def __init__(self, analysis, solver):
        from femsolver.calculix.calculixtools import CalculiXTools

        ccx_program()
        self.tool, self.solver = CalculiXTools(solver), solver
        if not os.path.isdir(
            solver.WorkingDirectory
        ):  # FreeCAD makes none while its preferences are untouched
            solver.WorkingDirectory = tempfile.mkdtemp(prefix="fem_")
        self.tool.process.finished.disconnect()
        self.tool.prepare()

    def start(self):
        self.tool.compute()
        return self.tool.process

    def load(self):
        self.tool.update_properties()
        return newest(self.solver.Results, "Fem::FemPostPipeline")


def failure(code, text):
    """The error of this stage."""
    return MeshError("solve", code, text)


def kind_of(item):
    """FreeCAD's name for the kind of a FEM object."""
    return getattr(getattr(item, "Proxy", None), "Type", "")


def solver_of(analysis):
    """The analysis's only CalculiX solver; a new one when it has no solver at all."""
    solvers = [item for item in analysis.Group if item.isDerivedFrom("Fem::FemSolverObject")]
    usable = [item for item in solvers if kind_of(item) in (CCX_TOOLS, CALCULIX)]
    if len(usable) == 1:
        return usable[0]
    if solvers:
        raise failure(
            "which_solver",
            in_number(
                "%s has %d solver(s), of them %d for CalculiX; exactly one of these is needed"
                % (analysis.Label, len(solvers), len(usable))
            ),
        )
    return add_solver(analysis)


def add_solver(analysis):
    """A new CalculiX solver object in the analysis."""
    import ObjectsFem

    make = next(getattr(ObjectsFem, name) for name in MAKERS if hasattr(ObjectsFem, name))
    solver = make(analysis.Document)
    analysis.addObject(solver)
    return solver


def check(analysis, solver, target):
    """Raise MeshError when FreeCAD finds that something is missing (material, constraint, mesh)."""
    from femtools import membertools
    from femtools.checksanalysis import check_member_for_solver_calculix

    mesh, reason = membertools.get_mesh_to_solve(analysis)
    if mesh != target:
        raise failure("which_mesh", (reason or "%s would be solved instead" % mesh.Label).strip())
    members = membertools.AnalysisMember(analysis)
    missing = check_member_for_solver_calculix(analysis, solver, mesh, members).strip()
    if missing:
        raise failure("not_ready", missing.replace("\n", " "))
    check_references(analysis, target)


def check_references(analysis, target):
    """Raise MeshError for a load or support without a node: FreeCAD would leave it out in silence."""
    from femmesh import meshtools

    for item in analysis.Group:
        if not item.isDerivedFrom("Fem::Constraint") or not getattr(item, "References", None):
            continue
        if not getattr(item, "Suppressed", False) and not meshtools.get_femnodes_by_references(
            target.FemMesh, item.References
        ):
            raise failure(
                "no_nodes",
                "%s: the mesh has no node on %s; mesh again, or refer to the part that is meshed"
                % (item.Label, ", ".join(named(item.References))),
            )


def named(references):
    """['Box.Face1', ...] of a References property."""
    return [
        "%s.%s" % (item.Label, element) if element else item.Label
        for item, elements in references
        for element in ([elements] if isinstance(elements, str) else elements or [""])
    ]


def ccx_program():
    """Path of CalculiX: FreeCAD's preference, or the one on the search path."""
    settings = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Mod/Fem/Ccx")
    chosen = settings.GetString("ccxBinaryPath", "")
    bundled = os.path.join(FreeCAD.getHomePath(), "bin", "ccx")
    found = next((path for path in map(shutil.which, (chosen, "ccx", bundled)) if path), None)
    if not found:
        raise failure(
            "no_calculix",
            "CalculiX (ccx) is not installed, or FreeCAD does not know where: Preferences, FEM, CalculiX",
        )
    return found


def newest(items, kind):
    """The last object of a kind; MeshError when there is none."""
    found = [item for item in items if item.isDerivedFrom(kind)]
    if not found:
        raise failure("no_result", "CalculiX gave no result")
    return found[-1]


def extremes(result):
    """(largest displacement in mm, largest von Mises stress in MPa) of a result of solve(); (0, 0) when it
    has none.
    """
    if hasattr(result, "vonMises"):
        return max(result.DisplacementLengths, default=0.0), max(result.vonMises, default=0.0)
    moved = stress = 0.0
    for number in range(result.Data.GetNumberOfBlocks()):
        fields = result.Data.GetBlock(number).GetPointData()
        if fields.HasArray("Displacement") and fields.HasArray("von Mises Stress"):
            moved = max(moved, fields.GetArray("Displacement").GetRange(-1)[1])
            stress = max(stress, fields.GetArray("von Mises Stress").GetRange()[1])
    return moved, stress
