#!/usr/bin/env bash
# Everything that building, running and testing needs on Debian 12 or 13, then the extension itself.
# Repeat it at will: what is there is left alone, what has not changed is not built again.
#
#   bash scripts/setup.sh            installs missing packages (as root) and builds
#   DM_CMAKE_FLAGS="-DDM_WERROR=ON"  more flags for cmake
set -euo pipefail
cd "$(dirname "$0")/.."

NANOBIND_VERSION=2.9.2
PYTHON=/usr/bin/python3 # the Python that Debian's FreeCAD is built for
PACKAGES=(
  g++ cmake ninja-build doctest-dev
  python3-dev python3-pip python3-numpy python3-scipy python3-meshio python3-matplotlib
  python3-pytest python3-hypothesis
  freecad-python3
)
WANTED=(calculix-ccx) # not in Debian 13

is_installed() { [ "$(dpkg-query -W -f='${Status}' "$1" 2>/dev/null)" = "install ok installed" ]; }

# Not piped into grep -q: that stops reading at its first match, and under pipefail the broken pipe counts as a failure.
is_available() { [[ $(LC_ALL=C apt-cache policy "$1") =~ Candidate:\ [^\(] ]]; }

install_packages() {
  local missing=()
  for package in "${PACKAGES[@]}"; do is_installed "$package" || missing+=("$package"); done
  command -v freecadcmd >/dev/null || missing+=(freecad)
  export DEBIAN_FRONTEND=noninteractive
  if [ ${#missing[@]} -gt 0 ] && [ "$(id -u)" -eq 0 ]; then apt-get update -q; fi
  for package in "${WANTED[@]}"; do
    if ! is_installed "$package" && is_available "$package"; then missing+=("$package"); fi
  done
  [ ${#missing[@]} -eq 0 ] && return
  if [ "$(id -u)" -ne 0 ]; then
    echo "setup.sh: these packages are missing, run as root: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  apt-get install -q -y --no-install-recommends "${missing[@]}"
}

install_nanobind() {
  if [ ! -d "build/nanobind-$NANOBIND_VERSION" ]; then
    rm -rf build/nanobind.part
    "$PYTHON" -m pip install -q --disable-pip-version-check --root-user-action=ignore \
      --target build/nanobind.part "nanobind==$NANOBIND_VERSION"
    mv build/nanobind.part "build/nanobind-$NANOBIND_VERSION"
  fi
  NANOBIND_CMAKE="$PWD/build/nanobind-$NANOBIND_VERSION/nanobind/cmake"
}

build() {
  local launcher=()
  if command -v ccache >/dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
  # shellcheck disable=SC2086
  cmake -S . -B build/release -G Ninja -DPython_EXECUTABLE="$PYTHON" -Dnanobind_ROOT="$NANOBIND_CMAKE" \
    -DCMAKE_BUILD_TYPE=Release -DDM_TESTS=ON "${launcher[@]}" ${DM_CMAKE_FLAGS:-} >build/cmake.log ||
    { cat build/cmake.log >&2; exit 1; }
  cmake --build build/release --target "${@:-_core}"
  cmake --install build/release --prefix . --component extension >/dev/null
  "$PYTHON" -c 'from DelaunayMesher import extension; extension.load()'
}

mkdir -p build
install_packages
install_nanobind
build "$@"
