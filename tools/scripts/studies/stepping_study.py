#!/usr/bin/python3
"""Are the far runouts of Talus right, or those of the reference? Those of a third program, as its step of time falls.

  tools/scripts/studies/stepping_study.py [--talus build/release/talus] [--data ../shared/data] [--trajectories 20000]

stepping_study.cc, which shares no code with Talus, computes the model of docs/physics.md with steps of 5 to 1 ms, on
bilinear patches as Talus here: flights exact at the ends of the steps (`parabola`), and flights by the semi-implicit
method of Euler (`euler`). Printed per source: the 95th percentile of the runout of stops with its standard error
(bootstrap), impacts, seconds and metres of a trajectory, the share that reaches the lowest screen. Five minutes of one
core. Results: docs/validation.md, "Which of the two is right". Needs g++, numpy and GDAL's python binding.
"""
import argparse
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from osgeo import gdal

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "checks"))
import compare_reference as reference  # noqa: E402
from files import features  # noqa: E402
from program import parser_of  # noqa: E402

METHODS = [("parabola", 5), ("parabola", 2.5), ("parabola", 1), ("euler", 2.5)]  # step [ms]


def write_grid(scene, path):
    """The scene as stepping_study.cc reads it: rows from the south."""
    dem, model = gdal.Open(str(scene.dem)), scene.model
    west, cell, _, north, _, down = dem.GetGeoTransform()
    heights, codes = dem.ReadAsArray()[::-1], sorted(model["zone"], key=int)
    zones = gdal.Open(str(scene.folder / "zones.tif")).ReadAsArray()[::-1]
    number = {int(code): i for i, code in enumerate(codes)}
    rows, columns = heights.shape
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"{columns} {rows} {cell!r} {west!r} {north + down * rows!r} {model['deformation_coefficient']} {len(codes)}\n")
        for code in codes:
            k = model["zone"][code]
            file.write(f"{k['theta_scale']} {k['psi_scale']} {k['En50']} {k['Et50']} {math.tan(math.radians(k['phi']))!r} "
                       f"{k['shape'][0]} {k['shape'][1]}\n")
        np.savetxt(file, heights, fmt="%.9g")
        np.savetxt(file, np.vectorize(number.get)(zones), fmt="%d")


def stepped(program, grid, scene, method, step, trajectories):
    """The ends of the trajectories by steps of time: source, runout, seconds, length, impacts, passed the lowest screen."""
    sources = "".join(f"{s['id']} {s['x']} {s['y']} {s['release_height_m']} {s['vx']} {s['vy']} {s['vz']} {s['diameter_m']}\n"
                      for s in scene.sources)
    run = subprocess.run([program, grid, str(step * 1e-3), str(trajectories), str(round(step * 10)), method], input=sources,
                         capture_output=True, text=True, check=True)
    table = np.genfromtxt(run.stdout.splitlines(), delimiter=",", names=True, dtype=None, encoding="utf-8")
    return table["source"], table, table["lowest_y"] < lowest_screen(scene)


def lowest_screen(scene):
    wkts = (scene.folder / "screens.csv").read_text().splitlines()[1:]
    return min(float(w.split("(")[1].split()[1].rstrip(",)")) for w in wkts)


def passed_screen(passages, column, blocks):
    """Which trajectories of (source, number) have a row of the lowest screen, S3."""
    rows = passages[passages["screen"] == "S3"]
    seen = set(zip(rows[column[0]].tolist(), rows[column[1]].tolist()))
    return np.array([block in seen for block in blocks])


def of_reference(scene):
    stops = reference.read_columns(scene.folder / "stops.csv.gz")
    passages = reference.read_columns(scene.folder / "passages.csv.gz")
    blocks = zip(stops["block"].tolist(), stops["trial"].tolist())
    return stops["block"], stops, passed_screen(passages, ("block", "trial"), blocks)


def of_talus(scene, work, talus, trajectories):
    (trials,) = np.unique(scene.sources["trajectories"])
    options = argparse.Namespace(talus=Path(talus), trials_factor=trajectories / trials, threads=2, surface="bilinear")
    reference.run_talus(scene, work, options)
    rows = [(f["source"], f["block"], f.geometry().GetX(), f.geometry().GetY(), f["seconds"], f["length_m"], f["impacts"])
            for f in features(work / "out/stops.gpkg")]
    table = np.rec.fromrecords(rows, names="source,block,x,y,seconds,length,impacts")
    passages = reference.read_columns(work / "out/screens.csv")
    passed = passed_screen(passages, ("source", "block"), zip(table["source"].tolist(), table["block"].tolist()))
    return scene.sources["id"][table["source"]], table, passed


def print_rows(scene, name, sources, table, passed):
    generator = np.random.default_rng(1)
    for s in scene.sources:
        mine = sources == s["id"]
        runout = np.hypot(table["x"][mine] - s["x"], table["y"][mine] - s["y"])
        draws = runout[generator.integers(0, runout.size, (100, runout.size))]
        error = np.quantile(draws, 0.95, axis=1).std(ddof=1)
        means = [(table[k][mine].mean(), table[k][mine].std(ddof=1) / math.sqrt(mine.sum())) for k in ("impacts", "seconds", "length")]
        print(f"{name:18} {s['id']} {mine.sum():7} {np.quantile(runout, 0.95):8.2f} +- {error:4.2f}",
              *(f" {mean:7.2f} +- {e:4.2f}" for mean, e in means), f" {100 * passed[mine].mean():6.3f} %", flush=True)


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--data", type=Path, default=Path("../shared/data"))
    parser.add_argument("--trajectories", type=int, default=20000, help="per source")
    o = parser.parse_args()
    scene = reference.Scene(o.data, "slope")
    print("                   source   n     runout P95 [m]     impacts           seconds          metres            at S3")
    with tempfile.TemporaryDirectory(prefix="talus-stepping-") as folder:
        work = Path(folder)
        print_rows(scene, "reference", *of_reference(scene))
        print_rows(scene, "talus", *of_talus(scene, work / "slope", o.talus, o.trajectories))
        subprocess.run(["g++", "-O2", "-std=c++20", HERE / "stepping_study.cc", "-o", work / "stepping"], check=True)
        write_grid(scene, work / "slope.grid")
        for method, step in METHODS:
            print_rows(scene, f"{method} {step:g} ms", *stepped(work / "stepping", work / "slope.grid", scene, method, step, o.trajectories))


if __name__ == "__main__":
    main()
