#!/usr/bin/env bash
# Sets up, then runs the C++ and the Python tests; with --long the long ones after them.
# Other arguments go to pytest: bash scripts/test.sh tests/test_options.py -x
set -euo pipefail
cd "$(dirname "$0")/.."

LONG=no
ARGUMENTS=()
for argument in "$@"; do
  if [ "$argument" = --long ]; then LONG=yes; else ARGUMENTS+=("$argument"); fi
done

bash scripts/setup.sh all
ctest --test-dir build/release --output-on-failure --no-tests=error -j "$(nproc)"
/usr/bin/python3 -m pytest "${ARGUMENTS[@]}"

if [ $LONG = yes ]; then
  # doctest leaves out test cases marked skip() unless told otherwise
  for program in build/release/test_*; do [ -x "$program" ] && "$program" --no-skip; done
  /usr/bin/python3 -m pytest -m long "${ARGUMENTS[@]}"
fi
