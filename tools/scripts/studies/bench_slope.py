"""The slope of shared/bench and talus-bench on it (for benchmark.py, lanes_study.py, scaling.py)."""
import argparse
import json
import os
import statistics
import subprocess

from program import ROOT


def parser_of(doc, repeats):
    """A parser of options: --help prints the docstring of the study. With --shared, --work and --repeats."""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--shared", default=str(ROOT.parent / "shared"), help="has bench/make_slope.py")
    parser.add_argument("--work", help="folder that keeps the slope (default: a temporary one)")
    parser.add_argument("--repeats", type=int, default=repeats, help=f"rounds (default: {repeats})")
    return parser


def add_bench(parser):
    parser.add_argument("--bench", default=str(ROOT / "build/release/tests/bench/talus-bench"), help="the program of benchmarks")


def make_slope(shared, folder, *options):
    """The slope in a folder, where it is not there."""
    if not os.path.exists(f"{folder}/sources.shp"):
        subprocess.run(["/usr/bin/python3", f"{shared}/bench/make_slope.py", folder, *options], check=True, stdout=subprocess.DEVNULL)


def figures(program, folder, *options):
    """What talus-bench measures on the slope, by the name of the benchmark; without those that this machine cannot run."""
    out = subprocess.run([program, f"{folder}/dem.tif", f"{folder}/sources.shp", "--benchmark_format=json", *options], check=True,
                         capture_output=True, text=True).stdout
    return {b["name"].split("/iterations")[0].split("/manual")[0]: b for b in json.loads(out)["benchmarks"] if "error_message" not in b}


def spread(values, digits=2):
    """Median of the rounds, with their range."""
    return f"{statistics.median(values):.{digits}f} ({min(values):.{digits}f} to {max(values):.{digits}f})"
