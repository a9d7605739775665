#!/usr/bin/env bash
# Installs what Talus needs (Debian 12), builds it and runs the example valley. Run from anywhere; root or sudo.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_packages.sh g++ cmake ninja-build libgdal-dev libsqlite3-dev libdeflate-dev libproj-dev proj-data gdal-bin libeigen3-dev libboost-dev \
  libnlopt-cxx-dev libssl-dev libcli11-dev libtomlplusplus-dev nlohmann-json3-dev libgtest-dev libgmock-dev libbenchmark-dev libopenmpi-dev \
  python3 python3-gdal python3-numpy python3-matplotlib
cmake --preset release
cmake --build --preset release --target talus
build/release/talus run data/valley/scenario.toml -o build/valley --overwrite
/usr/bin/python3 tools/scripts/figures/picture.py data/valley/dem.tif build/valley/impact_probability.tif \
  -o build/valley/map.png --log --classes 0.00001,0.0001,0.001,0.01 --title "Impact probability" \
  --vectors data/valley/cliffs.shp data/valley/screens.gpkg data/valley/houses.gpkg
echo "Maps are in build/valley (open them in QGIS), a picture in build/valley/map.png"
