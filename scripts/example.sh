#!/usr/bin/env bash
# Sets everything up and runs the main job: the bracket is meshed, solved and drawn into example_output/.
# Can be repeated; EXAMPLE_SIZE=2.5 makes a finer mesh.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bash scripts/setup.sh

freecad=$(command -v freecadcmd || command -v FreeCADCmd || true)
if [ -z "$freecad" ]; then
  echo "example.sh: FreeCAD is not installed (no freecadcmd)" >&2
  exit 1
fi
mkdir -p example_output
rm -f example_output/summary.txt
echo "Meshing, solving and drawing the bracket ..."
"$freecad" scripts/example_analysis.py >example_output/log.txt 2>&1 </dev/null || true

# freecadcmd's exit status says nothing about the script.
if ! grep -q '^EXAMPLE OK' example_output/log.txt; then
  tail -n 30 example_output/log.txt >&2
  echo "example.sh: failed; the whole log is example_output/log.txt" >&2
  exit 1
fi
cat example_output/summary.txt
