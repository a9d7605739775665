"""The program as the studies call it, and the options that they share."""
import argparse
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]


def default_program():
    """TALUS, else the release build of this checkout, else the program of the path."""
    built = ROOT / "build/release/talus"
    return os.environ.get("TALUS", str(built) if built.exists() else "talus")


def parser_of(doc, **defaults):
    """A parser of options: --help prints the docstring of the study. With --talus, and those of --work, --threads and --jobs
    for which a default is given."""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_options(parser, **defaults)
    return parser


def add_options(parser, **defaults):
    parser.add_argument("--talus", default=default_program(), help="the program")
    words = {"work": "folder of inputs and results", "threads": "of each run", "jobs": "runs at a time"}
    for name, default in defaults.items():
        parser.add_argument(f"--{name}", default=default, type=type(default), help=f"{words[name]} (default: {default})")


def list_of(kind):
    """The type of an option of values with commas between."""
    return lambda text: [kind(value) for value in text.split(",") if value]


def talus(o, *arguments, allowed=(0,)):
    """Runs the program; what it prints. Where its exit code is not allowed the study ends with the program's message."""
    done = subprocess.run([o.talus, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode not in allowed:
        sys.exit(f"talus {' '.join(map(str, arguments))}: {done.stderr}")
    return done.stdout
