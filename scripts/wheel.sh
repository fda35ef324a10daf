#!/usr/bin/env bash
# Builds the wheel of this Python and tries it in a clean virtual environment, far from this folder.
#
#   bash scripts/wheel.sh [PYTHON]        the wheel is then in build/wheels
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

PYTHON=${1:-/usr/bin/python3}
ROOT=$PWD
WORK=$(mktemp -d)
trap 'rm -rf "$WORK"' EXIT

if ! "$PYTHON" -c 'import ensurepip, venv' 2>/dev/null && [ "$(id -u)" -eq 0 ]; then
  apt-get update -q
  apt-get install -q -y --no-install-recommends python3-venv
fi

if command -v ccache >/dev/null; then export CMAKE_CXX_COMPILER_LAUNCHER=ccache; fi
rm -rf build/wheels
"$PYTHON" -m pip wheel -q --disable-pip-version-check --no-deps -w build/wheels .
wheel=$(ls build/wheels/*.whl)

# The sources of the core stay at home, licence and compiled part must be there.
"$PYTHON" - "$wheel" <<'EOT'
import sys
import zipfile

names = zipfile.ZipFile(sys.argv[1]).namelist()
assert any(name.startswith("DelaunayMesher/_core.") for name in names), names
assert any(name.endswith("LICENSE") for name in names), names
assert not [name for name in names if name.endswith((".cpp", ".h"))], names
EOT

"$PYTHON" -m venv "$WORK/venv"
"$WORK/venv/bin/python" -m pip install -q --disable-pip-version-check "$wheel[files]"
cd "$WORK"
timeout 300 venv/bin/python -m DelaunayMesher "$ROOT/resources/examples/bracket.stl" -o bracket.vtu --max-size 6
timeout 300 venv/bin/delaunaymesher "$ROOT/resources/examples/bracket.stl" -o bracket.inp --max-size 12 --quiet
venv/bin/python -c '
import DelaunayMesher, meshio, os
assert os.path.dirname(DelaunayMesher.__file__).startswith(os.getcwd()), DelaunayMesher.__file__
assert sum(len(b.data) for b in meshio.read("bracket.vtu").cells if b.type == "tetra") > 5000
'
echo "$(basename "$wheel") works in a clean environment"
