#!/usr/bin/env bash
# Checks that two builds of the program write the same bytes:
# tools/scripts/checks/same_bytes.sh build/release/talus build/dev/talus
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
"$here/fingerprint.py" --brief --talus "$1" -o "$work/first.txt"
"$here/fingerprint.py" --brief --talus "$2" -o "$work/second.txt" --against "$work/first.txt"
