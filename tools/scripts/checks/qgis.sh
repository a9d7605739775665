#!/usr/bin/env bash
# Tests the QGIS plug-in (tools/qgis) in QGIS without a window: qgis.sh build/release/talus
# Where QGIS is not installed it says so and is skipped (code 77); with CI=true that is a failure.
set -euo pipefail
talus="$(realpath "${1:-build/release/talus}")"
root="$(realpath "$(dirname "$0")/../../..")"
if ! command -v qgis_process.bin >/dev/null || ! /usr/bin/python3 -c 'import qgis.core' 2>/dev/null; then
  echo "skipped: QGIS is not installed (apt-get install --no-install-recommends qgis python3-qgis qgis-providers)"
  [ "${CI:-}" = true ] && exit 1
  exit 77
fi
profile="$(mktemp -d)"
trap 'rm -rf "$profile"' EXIT
export HOME="$profile" XDG_RUNTIME_DIR="$profile" QT_QPA_PLATFORM=offscreen TALUS="$talus" PYTHONDONTWRITEBYTECODE=1
export QGIS_PLUGINPATH="$root/tools/qgis" LC_ALL=C.UTF-8
qgis_process.bin plugins enable talus_qgis >/dev/null 2>&1
cd "$root/tests/qgis"
/usr/bin/python3 -W ignore qgis_test.py "${@:2}"
