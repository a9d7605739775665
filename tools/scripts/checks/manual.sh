#!/usr/bin/env bash
# Builds the manual as HTML (into the folder given, else a temporary one) and fails on a broken link, and on a page that would ask
# the network for something. Needs mkdocs (Debian: mkdocs). A few seconds.
set -euo pipefail
cd "$(dirname "$0")/../../.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
site=$(realpath -m "${1:-$work/site}")
cp -r docs "$work/docs"
sed "s|^docs_dir: .*|docs_dir: $work/docs|; s|^site_dir: .*|site_dir: $site|; s|custom_dir: |&$PWD/|" mkdocs.yml > "$work/mkdocs.yml"
mkdocs build --quiet --strict --clean -f "$work/mkdocs.yml"
if grep -rlE '<(script|link|img|iframe)[^>]*(src|href)="(https?:)?//' --include='*.html' "$site" | head -5 | grep .; then
  echo "manual.sh: these pages ask the network for something" >&2
  exit 1
fi
echo "the manual is built: $(find "$site" -name '*.html' | wc -l) pages, every link is there"
