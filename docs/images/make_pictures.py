"""Makes the pictures of docs/gui.md again: drives FreeCAD's window on a display of its own.

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

PREFIX = "gui_"


def main():
    with tempfile.TemporaryDirectory() as folder:
        home, output = os.path.join(folder, "home"), os.path.join(folder, "output")
        os.makedirs(output)
        printed = window.run_in_window(os.path.join(HERE, "in_window.py"), home, output)
        if "PICTURES OK" not in printed:
            sys.exit(printed[-3000:])
        for name in sorted(os.listdir(output)):
            if name.endswith(".png"):
                shutil.copy(os.path.join(output, name), os.path.join(HERE, PREFIX + name))
                print(PREFIX + name, os.path.getsize(os.path.join(output, name)) // 1000, "kB")


if __name__ == "__main__":
    main()
