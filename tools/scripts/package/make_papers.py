#!/usr/bin/env python3
"""Makes the two changelogs that a Debian package must have: that of Talus, and one entry for the package itself.

The date is that of SOURCE_DATE_EPOCH, so that the same sources give the same bytes; without it, today.
"""
import argparse
import email.utils
import gzip
import os
import pathlib
import time


def debian_changelog(version, contact, seconds):
    """One entry in Debian's format."""
    date = email.utils.formatdate(seconds)
    return f"talus ({version}) unstable; urgency=medium\n\n  * Talus {version}; its changes: changelog.gz.\n\n -- {contact}  {date}\n"


def write_compressed(path, text):
    """The same bytes for the same text: without a name or a time in the file."""
    with open(path, "wb") as file, gzip.GzipFile("", "wb", 9, file, mtime=0) as packed:
        packed.write(text.encode())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--changes", type=pathlib.Path, required=True, help="CHANGELOG.md")
    parser.add_argument("--version", required=True, help="of the package, as 0.1.0-1")
    parser.add_argument("--contact", required=True, help="name and address of the maintainers")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder to write to")
    options = parser.parse_args()
    seconds = int(os.environ.get("SOURCE_DATE_EPOCH", time.time()))
    options.out.mkdir(parents=True, exist_ok=True)
    write_compressed(options.out / "changelog.gz", options.changes.read_text(encoding="utf-8"))
    write_compressed(options.out / "changelog.Debian.gz", debian_changelog(options.version, options.contact, seconds))


if __name__ == "__main__":
    main()
