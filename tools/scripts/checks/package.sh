#!/usr/bin/env bash
# Makes the Debian packages from build/release, installs them in a clean Debian 12, and works there as a user would:
# program, manual, completion, example, library, processes of MPI, plug-in of QGIS. Needs root (chroot), the network,
# and about 3 GB for a while.
#   tools/scripts/checks/package.sh [BUILD]     BUILD: build/release
# With TALUS_BASE=FOLDER the bare system is kept there for the next time.
set -euo pipefail
cd "$(dirname "$0")/../../.."
build="$(realpath "${1:-build/release}")"
stage() { printf '\n== %s (%d s so far)\n' "$1" "$SECONDS"; }

tools/install_packages.sh debootstrap lintian dpkg-dev file mkdocs
work="$(mktemp -d)"
trap 'rm -rf --one-file-system "$work"' EXIT
root="$work/root"

stage "packages"
export SOURCE_DATE_EPOCH="${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || date +%s)}"
cmake "$build" > /dev/null  # mkdocs may have come since
cmake --build "$build" --target talus talus-mpi
rm -rf "$build/packages"
(cd "$build" && cpack)
for package in "$build"/packages/*.deb; do
  echo && dpkg-deb --field "$package" Package Version Depends Installed-Size
done
# Not asked of a package that no Debian bug waits for, and whose library is static.
lintian --fail-on error --suppress-tags initial-upload-closes-no-bugs "$build"/packages/*.deb

stage "a clean Debian 12"
if [ -n "${TALUS_BASE:-}" ] && [ -e "$TALUS_BASE/usr/bin/apt-get" ]; then
  cp -a "$TALUS_BASE" "$root"
else
  debootstrap --variant=minbase bookworm "$root" http://deb.debian.org/debian > "$work/debootstrap.log" ||
    { tail "$work/debootstrap.log" >&2; exit 1; }
  [ -z "${TALUS_BASE:-}" ] || cp -a "$root" "$TALUS_BASE"
fi
echo force-unsafe-io > "$root/etc/dpkg/dpkg.cfg.d/fast"  # a system for a minute: no waiting for the disk
cp "$build"/packages/*.deb "$root/root/"
cp -r tests/package "$root/root/bounce"
install() {  # packages, into the clean system
  in_root apt-get install -y -qq --no-install-recommends "$@" > "$work/apt.log" 2>&1 || { tail -30 "$work/apt.log" >&2; exit 1; }
}
in_root() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }

stage "installation of the program"
in_root apt-get update -qq
package() { printf '/root/%s' "$(basename "$build"/packages/"$1"_*.deb)"; }
install "$(package talus)" man-db bash-completion

stage "as a user"
in_root bash -euc '
  talus --version
  cp -r /usr/share/doc/talus/examples/valley /root/valley
  cd /root/valley
  talus run scenario.toml --trajectories 5 -o out --quiet
  talus hazard out
  ls out | tr "\n" " " && echo
  grep -o "<h1[^>]*>.*</h1>" /usr/share/doc/talus/html/hazard.html && ls /usr/share/doc/talus/html/pictures/hazard* | head -1
  man --no-hyphenation -l /usr/share/man/man1/talus-run.1.gz | head -20
  . /usr/share/bash-completion/bash_completion
  . /usr/share/bash-completion/completions/talus
  COMP_WORDS=(talus ha) COMP_CWORD=1
  _talus
  [ "${COMPREPLY[*]}" = hazard ] && echo "completion: talus ha -> talus ${COMPREPLY[*]}"'

stage "the library"
install "$(package libtalus-dev)" g++ cmake make
in_root sh -euc 'cmake -S /root/bounce -B /root/bounce/build > /dev/null && cmake --build /root/bounce/build > /dev/null
  /root/bounce/build/bounce'

stage "two processes of MPI"
install "$(package talus-mpi)" openmpi-bin
in_root bash -euc '
  cd /root/valley
  mpirun --allow-run-as-root --oversubscribe -n 2 talus-mpi run scenario.toml --trajectories 5 -o out_mpi --quiet
  for file in out_mpi/*.tif out_mpi/*.gpkg; do cmp "$file" "out/${file#out_mpi/}"; done
  echo "$(ls out_mpi/*.tif out_mpi/*.gpkg | wc -l) rasters and layers with the same bytes"'

stage "the plug-in in QGIS"
install qgis python3-qgis qgis-providers
in_root bash -euc '
  cd /root/valley
  export QT_QPA_PLATFORM=offscreen XDG_RUNTIME_DIR=/root PYTHONDONTWRITEBYTECODE=1  # a user could not write there
  qgis_process.bin plugins enable talus_qgis > /dev/null 2>&1
  qgis_process.bin run talus:run -- DEM=dem.tif SOURCES=cliffs.shp FREQUENCY_FIELD=frequency TRAJECTORIES=5 OUT=out_qgis
  qgis_process.bin run talus:hazard -- FOLDER=out_qgis OBJECTS=houses.gpkg
  ls out_qgis/hazard_class.tif out_qgis/objects.gpkg'

stage "removal"
in_root sh -c 'apt-get purge -y -qq talus talus-mpi libtalus-dev > /dev/null 2>&1; find / -xdev -path /root -prune -o -path /var -prune -o -name "*talus*" -print' > "$work/left"
if [ -s "$work/left" ]; then
  echo "left behind:" && cat "$work/left" && exit 1
fi
echo "nothing is left behind"
stage "done"
