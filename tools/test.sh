#!/usr/bin/env bash
# Runs every check: the tests of the release build (layers, core, files, command line, the plug-in in QGIS, reference
# results); the core and files again as clang builds them, with warnings as errors, invariants checked and sanitizers;
# equal bytes from both compilers; the Debian packages in a bare system (as root); formatting and clang-tidy.
# The measured data and reference results are read from ../shared/data, or from the folder TALUS_DATA.
set -euo pipefail
cd "$(dirname "$0")/.."
data="${TALUS_DATA:-../shared/data}"
if [ "${CI:-}" = true ] && [ ! -d "$data/reference" ]; then
  echo "tools/test.sh: no data at $data: CI must not skip the tests that need them" >&2
  exit 1
fi
export OMP_WAIT_POLICY=passive  # two tests at a time share the processors: a thread that waits does not spin
trap 'jobs -p | xargs -r kill 2> /dev/null || true' EXIT  # no job goes on after a failure
stage() { printf '\n== %s (%d min %02d s so far)\n' "$1" $((SECONDS / 60)) $((SECONDS % 60)); }

tools/install_packages.sh openmpi-bin python3-scipy python3-yaml dpkg-dev file man-db mkdocs chromium zsh fish \
  clang clang-format clang-tidy libomp-dev libclang-rt-14-dev
qgis_log="$(mktemp)"  # 1.4 GB for the tests of the plug-in come while the sources are compiled
tools/install_packages.sh qgis python3-qgis qgis-providers fonts-dejavu-core > "$qgis_log" 2>&1 &
qgis_packages=$!
stage "formatting"
git ls-files '*.cpp' '*.hpp' | xargs clang-format --dry-run --Werror
stage "release: build"
cmake --preset release ${TALUS_DATA:+-DTALUS_DATA="$TALUS_DATA"}
cmake --build --preset release
wait "$qgis_packages" || { cat "$qgis_log"; exit 1; }
stage "release: tests"
ctest --preset release -j 3  # three on two processors: tests wait for the disk, too
package_log="$(mktemp)"  # a bare Debian is installed, mostly by one processor, beside the next build
packages=""
if [ "$(id -u)" = 0 ]; then
  tools/scripts/checks/package.sh build/release > "$package_log" 2>&1 &
  packages=$!
else
  echo "skipped: tools/scripts/checks/package.sh needs root" > "$package_log"
fi
stage "asan: build by clang, warnings are errors, invariants checked, sanitizers"
cmake --preset asan ${TALUS_DATA:+-DTALUS_DATA="$TALUS_DATA"}
cmake --build --preset asan
stage "packages in a bare Debian"
[ -z "$packages" ] || wait "$packages" || { cat "$package_log"; exit 1; }
cat "$package_log"
stage "asan: tests of core and files"
tools/scripts/checks/sanitized_tests.sh build/asan
stage "the same bytes from gcc with optimisation and from clang without; beside it clang-tidy on the physics"
tidy_log="$(mktemp)"  # on all sources before a release: tools/scripts/checks/tidy.sh
tools/scripts/checks/tidy.sh src/physics > "$tidy_log" 2>&1 &
tidy=$!
tools/scripts/checks/same_bytes.sh build/release/talus build/asan/talus
wait "$tidy" || { cat "$tidy_log"; exit 1; }
cat "$tidy_log"
stage "done"
