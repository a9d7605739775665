#!/usr/bin/env bash
# The Debian packages, made from the build BUILD and unpacked (not installed) in WORK: what is in them, and whether the
# program, its manual and its completions work from there. In a clean system: tools/scripts/checks/package.sh.
# ctest -L package
set -euo pipefail
build="$1" work="$2"
rm -rf "$work" && mkdir -p "$work"
fail() { echo "package: $*" >&2; exit 1; }

(cd "$build" && cpack -B "$work/packages" > "$work/cpack.log" 2>&1) || { cat "$work/cpack.log" >&2; exit 1; }
for package in "$work"/packages/*.deb; do
  dpkg-deb --extract "$package" "$work/root"
  dpkg-deb --field "$package" > "$work/$(basename "$package").control"
done
cd "$work/root"

# Each package has what it is for, and depends on what its program needs.
for file in usr/bin/talus usr/share/man/man1/talus.1.gz usr/share/doc/talus/products.md usr/lib/libtalus.a \
  usr/share/doc/talus/examples/{valley/scenario,elm/campaign,profile/profile}.toml usr/share/bash-completion/completions/talus \
  usr/share/zsh/vendor-completions/_talus usr/share/fish/vendor_completions.d/talus.fish usr/include/talus/talus.hpp \
  usr/share/qgis/python/plugins/talus_qgis/metadata.txt \
  usr/share/doc/{talus,libtalus-dev}/{copyright,changelog.gz,changelog.Debian.gz}; do
  [ -s "$file" ] || fail "no $file"
done
grep -q "Depends:.*libgdal" "$work"/talus_*.control || fail "talus does not depend on GDAL"
if find . -name __pycache__ | grep -q .; then fail "compiled Python files are in a package"; fi

# The program runs on the example that is packed with it. Five blocks from each of 957 source cells.
cp -r usr/share/doc/talus/examples/valley "$work/valley"
usr/bin/talus run "$work/valley/scenario.toml" --trajectories 5 -o "$work/out" --quiet
/usr/bin/python3 - "$work/out/run.json" <<'PYTHON'
import json, sys
released = json.load(open(sys.argv[1]))["released"]
assert released == 5 * 957, released
PYTHON

# A page for each command that the program has, and no complaint of man about any of them.
mapfile -t commands < <(usr/bin/talus help --json | /usr/bin/python3 -c 'import json, sys
for command in json.load(sys.stdin)["commands"]: print(command["name"])')
for command in "${commands[@]}"; do
  page="usr/share/man/man1/talus-$command.1.gz"
  [ -s "$page" ] || fail "no manual page of talus $command"
  complaints="$(LC_ALL=C.UTF-8 MANWIDTH=100 man --warnings -E UTF-8 -l "$page" 2>&1 > "$work/page.txt")"
  [ -z "$complaints" ] || fail "$page: $complaints"
  for flag in $(usr/bin/talus "$command" --help | grep -oE '^  (-[a-z],)?--[A-Za-z0-9_-]+' | grep -oE '\-\-[A-Za-z0-9_-]+' | grep -v '^--help$'); do
    grep -qE -- "(^|[ ,])$flag( |$)" "$work/page.txt" || fail "$page says nothing of $flag"
  done
done

# Completions: what the shells offer.
bash -euc '. usr/share/bash-completion/completions/talus
  offers() { COMP_WORDS=(talus "$@") COMP_CWORD=$#; _talus; echo "${COMPREPLY[*]}"; }
  [ "$(offers ha)" = hazard ] && [ "$(offers run --traj)" = --trajectories ] &&
  [ "$(offers run --surface c)" = creased ]' || fail "completion of bash"
if command -v zsh > /dev/null; then
  zsh -n usr/share/zsh/vendor-completions/_talus || fail "completion of zsh"
fi
if command -v fish > /dev/null; then
  offered="$(HOME="$work" fish --no-config -c 'source usr/share/fish/vendor_completions.d/talus.fish; complete -C "talus ha"' | cut -f1)"
  [ "$offered" = hazard ] || fail "completion of fish: '$offered'"
fi
echo "packages: $(cd "$work/packages" && echo *.deb)"
