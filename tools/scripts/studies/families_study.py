#!/usr/bin/python3
"""How often do the tests of families raise a false alarm on a campaign, and how often do they see an effect?

  tools/scripts/studies/families_study.py CAMPAIGN.toml MODEL.toml [--rows fit|all] [--truth MODEL.toml] [--refit 60]
                                          [--surface bilinear|creased] [--build build/release]

MODEL.toml is the fitted ground (`talus calibrate`). Printed: the tests on what was measured; the size of the property test on
2000 data sets drawn from the model, also with a scatter 1.6 times the model's and with two sites that differ; with --truth the
power at 24, 48 and 89 blocks (those of the campaign, again and again) against data of that model; with --refit the size with
and without a fit of the ground (theta_scale, Et50 of each zone) to each data set. families_study.cc does the work with the
library of the build. Seconds, with --refit minutes. Results: docs/diagnosis-method.md, "The families".
"""
import argparse
import subprocess
import tempfile
from pathlib import Path

from program import ROOT

HERE = Path(__file__).resolve().parent


def libraries(build):
    """What the program `talus` is linked with, from the build's own file."""
    text = (build / "build.ninja").read_text().split("build talus: ", 1)[1]
    line = next(line for line in text.splitlines() if line.strip().startswith("LINK_LIBRARIES"))
    return [str(build / word) if word.startswith("libtalus") else word for word in line.split("=", 1)[1].split()]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("campaign")
    parser.add_argument("model")
    parser.add_argument("--rows", choices=("fit", "all"), default="fit")
    parser.add_argument("--truth")
    parser.add_argument("--refit")
    parser.add_argument("--surface")
    parser.add_argument("--build", type=Path, default=ROOT / "build/release")
    o = parser.parse_args()
    with tempfile.TemporaryDirectory() as work:
        program = f"{work}/families_study"
        subprocess.run(["g++", "-O2", "-std=c++20", "-fopenmp", f"-I{ROOT}/include", "-isystem", "/usr/include/eigen3",
                        str(HERE / "families_study.cc"), "-o", program, *libraries(o.build)], check=True)
        options = [word for name in ("truth", "refit", "surface") if getattr(o, name) for word in (f"--{name}", getattr(o, name))]
        subprocess.run([program, o.campaign, o.model, o.rows, *options], check=True)


main()
