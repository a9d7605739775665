#!/usr/bin/env bash
# clang-tidy on the sources of some folders, all where none is named: tidy.sh BUILD_FOLDER [FOLDER...]. BUILD_FOLDER holds
# compile_commands.json of a build by clang.
set -euo pipefail
cd "$(dirname "$0")/../../.."
build="$1"
shift
[ $# -gt 0 ] || set -- src tools
mapfile -t files < <(git ls-files -- "$@" | grep '\.cpp$')
printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -n 1 clang-tidy --quiet -p "$build"
echo "clang-tidy: ${#files[@]} sources, no finding"
