#!/usr/bin/env bash
# Runs every test: layers, core, files, command line, reference results; then the core again under sanitizers.
# The measured data and reference results are read from ../shared/data, or from the folder TALUS_DATA.
set -euo pipefail
cd "$(dirname "$0")/.."
if [ "${CI:-}" = true ] && [ ! -d "${TALUS_DATA:-../shared/data}/reference" ]; then
  echo "tools/test.sh: no data at ${TALUS_DATA:-../shared/data}: CI must not skip the tests that need them" >&2
  exit 1
fi
[ -z "${TALUS_DATA:-}" ] || cmake --preset release -DTALUS_DATA="$TALUS_DATA"
ctest --preset release -j 2
cmake --preset asan
cmake --build --preset asan --target core_tests io_tests
ctest --preset asan -j 2 -LE "slow|cli" -E "ScoreTest|Calibrate|FreePaths"  # statistics: long there
