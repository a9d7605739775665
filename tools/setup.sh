#!/usr/bin/env bash
# Installs what Talus needs (Debian 12), builds it and runs the example valley. Run from anywhere; root or sudo.
set -euo pipefail
cd "$(dirname "$0")/.."
as_root=""
[ "$(id -u)" = 0 ] || as_root="sudo"
packages=(g++ cmake ninja-build libgdal-dev libproj-dev proj-data gdal-bin libeigen3-dev libboost-dev libnlopt-cxx-dev libcli11-dev
  libtomlplusplus-dev nlohmann-json3-dev libssl-dev libgtest-dev libgmock-dev libbenchmark-dev libopenmpi-dev openmpi-bin python3 python3-gdal python3-numpy
  python3-scipy python3-matplotlib)
missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
  $as_root apt-get update -qq
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
fi
cmake --preset release
cmake --build --preset release
build/release/talus run data/valley/scenario.toml -o build/valley --overwrite
/usr/bin/python3 tools/scripts/figures/picture.py data/valley/dem.tif build/valley/impact_probability.tif -o build/valley/map.png --log \
  --classes 0.00001,0.0001,0.001,0.01 --vectors data/valley/cliffs.shp data/valley/screens.gpkg data/valley/houses.gpkg \
  --title "Impact probability"
echo "Maps are in build/valley (open them in QGIS), a picture in build/valley/map.png"
