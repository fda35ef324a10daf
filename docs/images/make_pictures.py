"""Makes the pictures of docs/gui.md and docs/tutorial.md again, in FreeCAD's window on a display of its own.

python3 docs/images/make_pictures.py        needs FreeCAD and xvfb
"""

import os
import shutil
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(ROOT, "tests", "gui"))

import window  # noqa: E402

SCRIPTS = ("gui", "tutorial")  # <name>_in_window.py makes <name>_*.png


def make(name):
    """Run one of the scripts and take its pictures."""
    with tempfile.TemporaryDirectory() as folder:
        home, output = os.path.join(folder, "home"), os.path.join(folder, "output")
        os.makedirs(output)
        printed = window.run_in_window(os.path.join(HERE, name + "_in_window.py"), home, output)
        if "PICTURES OK" not in printed:
            sys.exit(printed[-3000:])
        for picture in sorted(os.listdir(output)):
            if picture.endswith(".png"):
                shutil.copy(os.path.join(output, picture), os.path.join(HERE, name + "_" + picture))
                print(name + "_" + picture, os.path.getsize(os.path.join(output, picture)) // 1000, "kB")


if __name__ == "__main__":
    for chosen in sys.argv[1:] or SCRIPTS:
        make(chosen)
