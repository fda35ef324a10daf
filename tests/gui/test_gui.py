"""Drive FreeCAD's real window under Xvfb; the steps are in the script_*.py files."""

import os
import re
import shutil

import pytest
import window

HERE = os.path.dirname(os.path.abspath(__file__))
SCRIPTS = sorted(name for name in os.listdir(HERE) if re.match(r"script_\w+\.py$", name))
TRACEBACK = re.compile(r"Traceback \(most recent call last\):\n(?:  .*\n)+.*")

pytestmark = [
    pytest.mark.long,
    pytest.mark.gui,
    pytest.mark.skipif(not shutil.which("xvfb-run"), reason="xvfb is not installed"),
    pytest.mark.skipif(not shutil.which("ccx"), reason="CalculiX is not installed"),
    pytest.mark.skipif(not window.freecad(), reason="FreeCAD's window is not installed"),
]


def own_tracebacks(printed):
    """The tracebacks that go through this repository.

    FreeCAD prints the exceptions of commands, panels, view providers and observers and goes on, so that no
    script sees them. Those that stay within its own modules are left out: no test depends on them.
    """
    return [text for text in TRACEBACK.findall(printed) if "DelaunayMesher" in text or HERE in text]


@pytest.mark.parametrize("script", SCRIPTS)
def test_in_window(script, tmp_path):
    home, output = tmp_path / "home", tmp_path / "output"
    output.mkdir()
    printed = window.run_in_window(os.path.join(HERE, script), home, output)
    name = re.match(r"script_(\w+)\.py", script).group(1).upper()
    assert re.search("^%s OK$" % name, printed, re.MULTILINE), printed[-5000:]
    assert not own_tracebacks(printed), "\n\n".join(own_tracebacks(printed))
