#!/usr/bin/env bash
# clang-tidy on the sources of some folders, all where none is named: tidy.sh [FOLDER...].
set -euo pipefail
cd "$(dirname "$0")/../../.."
[ $# -gt 0 ] || set -- src tools
cmake --preset dev -B build/tidy -DTALUS_PCH=OFF > /dev/null  # how clang compiles each file; nothing is built
mapfile -t files < <(git ls-files -- "$@" | grep '\.cpp$')
printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -n 1 clang-tidy --quiet -p build/tidy
echo "clang-tidy: ${#files[@]} sources, no finding"
