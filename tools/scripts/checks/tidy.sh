#!/usr/bin/env bash
# Runs clang-tidy on the sources that differ from the last release (before the first one: on all), the latest changes first,
# until the time is over: tools/scripts/checks/tidy.sh BUILD_FOLDER [SECONDS]. BUILD_FOLDER holds the compile_commands.json
# of a build by clang. Prints how many sources were checked.
set -euo pipefail
cd "$(dirname "$0")/../../.."
build="$1" seconds="${2:-100000}"
release="$(git describe --tags --abbrev=0 2>/dev/null || true)"
mapfile -t changed < <(git log --format= --name-only ${release:+"$release"..HEAD} -- 'src/*.cpp' 'tools/*.cpp' | awk 'NF && !seen[$0]++')
files=()
for file in "${changed[@]}"; do [ -f "$file" ] && files+=("$file"); done
checked="$(mktemp)"
trap 'rm -f "$checked"' EXIT
export build checked
tidy_one() {
  [ "$(date +%s)" -lt "$deadline" ] || return 0
  echo "$1" >> "$checked"
  clang-tidy --quiet -p "$build" "$1" 2>/dev/null
}
export -f tidy_one
export deadline=$(($(date +%s) + seconds))
printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -I{} bash -c 'tidy_one {}'
echo "clang-tidy: $(wc -l < "$checked") of ${#files[@]} sources that differ from ${release:-the beginning} were checked, the others had no time"
