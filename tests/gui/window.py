"""A real FreeCAD window on a display of its own, for tests: a clean home with this repository as an add-on.

run_in_window() starts FreeCAD with a script; the script uses drive.py.  FreeCAD's exit status says nothing,
so a script ends with a line '... OK' that is looked for.
"""

import os
import shutil
import signal
import subprocess

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SETTINGS = """<?xml version="1.0" encoding="UTF-8" standalone="no" ?>
<FCParameters><FCParamGroup Name="Root"><FCParamGroup Name="BaseApp"><FCParamGroup Name="Preferences">
<FCParamGroup Name="General"><FCText Name="AutoloadModule">PartWorkbench</FCText>
<FCText Name="Language">%s</FCText></FCParamGroup>
<FCParamGroup Name="View"><FCBool Name="Gradient" Value="0"/><FCBool Name="Simple" Value="1"/>
<FCUInt Name="BackgroundColor" Value="4143380479"/></FCParamGroup>
<FCParamGroup Name="Mod"><FCParamGroup Name="Start"><FCBool Name="ShowOnStartup" Value="0"/>
</FCParamGroup></FCParamGroup>
</FCParamGroup></FCParamGroup></FCParamGroup></FCParameters>
"""


def freecad():
    """The FreeCAD program with a window, or None."""
    return shutil.which("freecad") or shutil.which("FreeCAD")


def make_home(home, language="English"):
    """A home directory in which FreeCAD finds this repository as an add-on."""
    for version in ("", "v1-1"):  # FreeCAD 1.1 has folders of its own, and asks when they are missing
        mods = os.path.join(home, ".local", "share", "FreeCAD", version, "Mod")
        config = os.path.join(home, ".config", "FreeCAD", version)
        for folder in (mods, config):
            os.makedirs(folder, exist_ok=True)
        if not os.path.lexists(os.path.join(mods, "DelaunayMesher")):
            os.symlink(ROOT, os.path.join(mods, "DelaunayMesher"))
        with open(os.path.join(config, "user.cfg"), "w", encoding="utf-8") as file:
            file.write(SETTINGS % language)


def run_in_window(script, home, output, seconds=300, language="English"):
    """Run a script in FreeCAD's window; returns all it printed.  `output`: folder for its files.

    FreeCAD puts the script's folder on sys.path, and leaves PYTHONPATH out.
    """
    make_home(str(home), language)
    environment = {
        **os.environ,
        "HOME": str(home),
        "OUTPUT": str(output),
        "QTWEBENGINE_DISABLE_SANDBOX": "1",
        "LIBGL_ALWAYS_SOFTWARE": "1",
        "PYTHONDONTWRITEBYTECODE": "1",
    }
    for name in ("XDG_DATA_HOME", "XDG_CONFIG_HOME", "XDG_CACHE_HOME"):
        environment.pop(name, None)
    command = ["xvfb-run", "-a", "-s", "-screen 0 1440x1000x24", freecad(), script]
    process = subprocess.Popen(
        command,
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        start_new_session=True,
    )
    try:
        printed = process.communicate(timeout=seconds)[0].decode("utf-8", "replace")
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)  # xvfb-run, its display and FreeCAD
        printed = process.communicate()[0].decode("utf-8", "replace")
        printed += "\nended after %g s\n" % seconds
    log = os.path.join(str(output), "log.txt")
    if os.path.exists(log):
        with open(log, encoding="utf-8") as file:
            printed += file.read()
    return printed
