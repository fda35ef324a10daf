#!/usr/bin/env bash
# Tests the workbench in the FreeCAD of other Debian releases, each in a folder of its own (as root):
#
#   bash scripts/other_freecad.sh trixie       FreeCAD 1.0
#   bash scripts/other_freecad.sh sid          FreeCAD 1.1 (sid changes daily)
#   bash scripts/other_freecad.sh trixie sid   both; sid uses the extension built in trixie
#
# In each: the extension is built (scripts/setup.sh, stable ABI), the bracket is meshed and solved without a
# window, then the tests that need FreeCAD and those that drive its window run.  Needs scripts/setup.sh to have
# run here.  Folders: build/root-SUITE (2 to 3 GB, used again), pictures of the windows: build/pictures-SUITE.
# Exit status: 1 a test failed, 3 a folder could not be made (network, packages) and nothing was tested in it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

MIRROR=${DEBIAN_MIRROR:-http://deb.debian.org/debian}
PLACE=/srv/DelaunayMesher # in the folder
LONGEST=1500              # seconds for a test run; tests of the window have limits of their own
RUN=(freecad xvfb xauth libgl1-mesa-dri python3-vtk9
  python3-numpy python3-scipy python3-matplotlib python3-meshio python3-pytest python3-hypothesis)
BUILD=(g++ cmake ninja-build doctest-dev python3-dev python3-pip freecad-python3)

say() { printf '\n-- %s (%s)\n' "$*" "$(date +%T)"; }

# The root folder of a suite, with FreeCAD in it.
make_root() {
  local suite=$1 root="$PWD/build/root-$1"
  [ -e "$root/ready" ] && return
  rm -rf "$root"
  debootstrap --variant=minbase "$suite" "$root" "$MIRROR" || return 1
  echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/fast"
  printf 'path-exclude=/usr/share/%s/*\n' doc man locale >>"$root/etc/dpkg/dpkg.cfg.d/fast"
  # A mirror's copy of sid may be older than its date of expiry.
  printf 'Acquire::Retries "3";\nAcquire::Check-Valid-Until "false";\n' >"$root/etc/apt/apt.conf.d/80mirror"
  local packages=("${RUN[@]}")
  if needs_build "$suite"; then packages+=("${BUILD[@]}"); fi
  inside "$root" apt-get update -q || return 1
  inside "$root" apt-get install -q -y --no-install-recommends "${packages[@]}" || return 1
  inside "$root" apt-get install -q -y --no-install-recommends calculix-ccx || copy_calculix "$root"
  inside "$root" apt-get clean
  touch "$root/ready"
}

# Whether the extension is built in this suite: in all but sid when trixie is there to do it.
needs_build() { [ "$1" != sid ] || [[ " $SUITES " != *" trixie "* ]]; }

# CalculiX of this machine with its libraries, for a release that has none.
copy_calculix() {
  local root=$1 program
  program=$(readlink -f "$(command -v ccx)")
  mkdir -p "$root/opt/ccx"
  cp "$program" "$root/opt/ccx/program"
  ldd "$program" | grep -o '/[^ ]*' | xargs -I{} cp -L {} "$root/opt/ccx/"
  printf '#!/bin/sh\nexec /opt/ccx/ld-linux-x86-64.so.2 --library-path /opt/ccx /opt/ccx/program "$@"\n' \
    >"$root/usr/local/bin/ccx"
  chmod +x "$root/usr/local/bin/ccx"
}

# A command in the folder: FreeCAD needs /proc, its window /dev/shm.
inside() {
  local root=$1
  shift
  # shellcheck disable=SC2016
  unshare -m --propagation private sh -c '
    root=$0
    mount --bind /proc "$root/proc"
    mount --rbind /dev "$root/dev"
    exec chroot "$root" env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
      HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive DM_NO_SKIPS=1 \
      http_proxy="$http_proxy" https_proxy="$https_proxy" "$@"' "$root" "$@"
}

# The project as it is here, without what was built.
copy_project() {
  local root=$1
  rm -rf "${root:?}$PLACE"
  mkdir -p "$root$PLACE/build"
  git ls-files -z --cached --others --exclude-standard | tar --null -T - -c | tar -x -C "$root$PLACE"
  cp -r build/nanobind-* "$root$PLACE/build/"
}

build_extension() {
  local suite=$1 root="$PWD/build/root-$1"
  if needs_build "$suite"; then
    inside "$root" env DM_CMAKE_FLAGS=-DSKBUILD_SABI_COMPONENT=Development.SABIModule \
      sh -c "cd $PLACE && bash scripts/setup.sh"
  else
    cp "build/root-trixie$PLACE/DelaunayMesher"/_core.abi3.so "$root$PLACE/DelaunayMesher/"
  fi
}

# Succeeds when all tests do.
test_suite() {
  local suite=$1 root="$PWD/build/root-$1" failed=0
  say "$suite: FreeCAD without a window: the bracket, meshed and solved"
  inside "$root" sh -c "cd $PLACE && mkdir -p example_output && timeout 300 freecadcmd scripts/example_analysis.py \
    >example_output/log.txt 2>&1 </dev/null; grep -q '^EXAMPLE OK' example_output/log.txt && cat example_output/summary.txt ||
    { tail -n 30 example_output/log.txt; exit 1; }" || failed=1
  say "$suite: tests of documents"
  inside "$root" sh -c "cd $PLACE && timeout $LONGEST python3 -m pytest tests/document" || failed=1
  say "$suite: tests in the window"
  inside "$root" sh -c "cd $PLACE && timeout $LONGEST python3 -m pytest -m long tests/gui --basetemp=/srv/windows" ||
    failed=1
  collect_pictures "$suite" "$root/srv/windows"
  return $failed
}

collect_pictures() {
  local suite=$1 folder=$2
  mkdir -p "build/pictures-$suite"
  find "$folder" -name '*.png' -not -path '*current*' -exec cp {} "build/pictures-$suite/" \;
}

main() {
  SUITES=${*:-trixie sid}
  if [ "$(id -u)" -ne 0 ]; then
    echo "other_freecad.sh: needs root, for chroot" >&2
    exit 3
  fi
  ls -d build/nanobind-* >/dev/null || { echo "other_freecad.sh: run scripts/setup.sh first" >&2; exit 3; }
  if ! command -v debootstrap >/dev/null; then
    apt-get update -q
    apt-get install -q -y --no-install-recommends debootstrap
  fi
  declare -A making
  local suite status=0
  for suite in $SUITES; do
    make_root "$suite" >"build/root-$suite.log" 2>&1 </dev/null &
    making[$suite]=$!
  done
  for suite in $SUITES; do
    say "$suite: FreeCAD and the extension"
    if ! wait "${making[$suite]}"; then
      tail -n 15 "build/root-$suite.log"
      printf '\n!! NOT TESTED: the FreeCAD of %s, its packages could not be installed\n\n' "$suite"
      [ $status -eq 1 ] || status=3
      continue
    fi
    inside "$PWD/build/root-$suite" sh -c "dpkg-query -W freecad python3"
    copy_project "$PWD/build/root-$suite"
    build_extension "$suite"
    test_suite "$suite" || status=1
  done
  exit $status
}

main "$@"
