#!/usr/bin/env bash
# Sets up, then runs the C++ and the Python tests; the long ones too with --long.
# Other arguments go to pytest: bash scripts/test.sh tests/test_options.py -x
set -euo pipefail
cd "$(dirname "$0")/.."

LONG=()
ARGUMENTS=()
for argument in "$@"; do
  if [ "$argument" = --long ]; then LONG=(--long); else ARGUMENTS+=("$argument"); fi
done

bash scripts/setup.sh all
if [ ${#LONG[@]} -eq 0 ]; then export DM_QUICK_TESTS=1; fi
ctest --test-dir build/release --output-on-failure --no-tests=error -j "$(nproc)"
/usr/bin/python3 -m pytest "${LONG[@]}" "${ARGUMENTS[@]}"
