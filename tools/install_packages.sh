#!/usr/bin/env bash
# Installs the Debian packages that are named and not there yet; root or sudo.
set -euo pipefail
as_root=""
[ "$(id -u)" = 0 ] || as_root="sudo"
missing=()
for package in "$@"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
  $as_root apt-get update -qq
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
fi
