#!/usr/bin/python3
"""How often do the 95 % intervals of `talus calibrate` hold the ground that made the data?

  tools/scripts/studies/calibration_coverage_study.py [--talus build/release/talus] [--repetitions 400] [--first 0] [--jobs 2]
      [--blocks 36] [--fit theta_scale,En50] [--trials 24] [--work DIR]

Each repetition draws a ground around the start of the fit (upper-talus-3d; the logarithm of each parameter normal, standard
deviation 0.5, within 1), releases blocks down one slope and measures one trial of each: the stop, and speed and jump at two
screens, with errors. `talus calibrate` (one start) is given these measurements alone. Printed, per parameter: how often the
interval holds the truth, with the binomial interval of that share, and how often the parameter is identifiable. The same engine
makes and judges the data: this measures the intervals, not the physics. 400 repetitions of 24 blocks take 20 minutes of two
cores. Results: docs/validation.md, "Intervals". Needs python3-numpy, python3-scipy, python3-gdal.
"""
import os
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from scipy.stats import beta

from files import read_json, read_table, write_raster, write_table, write_text
from program import parser_of, talus

WEST, SOUTH, CELL, COLUMNS, ROWS = 2_600_000.0, 1_200_000.0, 2.0, 100, 160
NORTH = SOUTH + ROWS * CELL
START = {"theta_scale": 1.0, "psi_scale": 0.9, "En50": 15.0, "Et50": 50.0}  # upper-talus-3d
TABLES = {"blocks": "id,x,y,release_height_m,vy,mass_kg", "stops": "id,x,y", "passages": "id,screen,speed_ms,jump_height_m",
          "screens": "id,wkt"}


def write_dem(path):
    """A face of 38 degrees that eases into a run-out, with bumps; row 0 is in the north, where the blocks start."""
    y, x = (np.arange(ROWS) + 0.5)[:, None] * CELL, (np.arange(COLUMNS) + 0.5)[None, :] * CELL
    steep, knee = np.tan(np.radians(38.0)), 30 * np.log1p(np.exp((y - 170) / 30))
    z = 300 - (y * steep - knee * (steep - 0.08)) + 0.3 * np.sin(x / 11 + y / 17) + 0.2 * np.sin(x / 23 - y / 13)
    write_raster(path, z, (WEST, NORTH), CELL)


def first_trials(path):
    return [row for row in read_table(path) if row["trial"] == "0"]


def write_tables(folder, **tables):
    for name, rows in tables.items():
        write_table(f"{folder}/{name}.csv", TABLES[name], rows)


def write_campaign(folder, name, tables):
    named = "".join(f'{table} = "{table}.csv"\n' for table in tables)
    write_text(f"{folder}/{name}.toml", f'name = "{name}"\ndem = "../dem.tif"\n{named}[measurement_error]\nposition_m = 0.3\n'
               "speed_fraction = 0.03\njump_height_m = 0.1\n")


def make(o, folder, number):
    """A campaign whose measurements are one trial of each block by the ground that is returned."""
    os.makedirs(folder, exist_ok=True)
    g = np.random.default_rng(1000 + number)
    truth = {key: START[key] * float(np.exp(np.clip(g.normal(0.0, 0.5), -1.0, 1.0))) for key in o.fit.split(",")}
    write_text(f"{folder}/truth.toml",
               '[ground.zones.default]\npreset = "upper-talus-3d"\n' + "".join(f"{k} = {v!r}\n" for k, v in truth.items()))
    blocks = [[f"b{i}", f"{WEST + g.uniform(60, 140):.2f}", f"{NORTH - g.uniform(8, 20):.2f}", 1, -1,
               f"{np.exp(g.uniform(np.log(100), np.log(2000))):.1f}"] for i in range(o.blocks)]
    screens = [[f"S{k}", f"LINESTRING ({WEST + 2} {NORTH - y}, {WEST + 198} {NORTH - y})"] for k, y in ((1, 90), (2, 150))]
    write_tables(folder, blocks=blocks, screens=screens)
    write_campaign(folder, "plan", ("blocks", "screens"))
    talus(o, "score", f"{folder}/plan.toml", "--parameters", f"{folder}/truth.toml", "--trials", 10, "--seed", 7000 + number, "--threads",
          1, "--dump", f"{folder}/dump", "-q")
    stops = [[r["block"], r["x"], r["y"]] for r in first_trials(f"{folder}/dump/stops.csv") if r["x"]]
    passages = [[r["block"], r["screen"], r["speed_ms"], r["jump_height_m"]] for r in first_trials(f"{folder}/dump/passages.csv")]
    write_tables(folder, stops=stops, passages=passages)
    write_campaign(folder, "campaign", TABLES)
    return truth


def one(o, number):
    """Of each parameter: whether its interval holds the truth, whether it is identifiable, its width as a factor."""
    folder = f"{o.work}/{number}"
    truth = make(o, folder, number)
    talus(o, "calibrate", f"{folder}/campaign.toml", "-o", f"{folder}/fit", "-q", "--fit", o.fit, "--starts", 1, "--trials", o.trials,
          "--threads", 1)
    fitted = {p["key"].split(".")[-1]: p for p in read_json(f"{folder}/fit/calibration.json")["parameters"]}
    return [(p["ci95"][0] <= truth[key] <= p["ci95"][1], p["identifiable"], p["ci95"][1] / p["ci95"][0])
            for key, p in ((key, fitted[key]) for key in o.fit.split(","))]


def share(count, of):
    low = beta.ppf(0.025, count, of - count + 1) if count else 0.0
    high = beta.ppf(0.975, count + 1, of - count) if count < of else 1.0
    return f"{100 * count / of:.1f} % ({100 * low:.1f} to {100 * high:.1f}) of {of}"


def main():
    parser = parser_of(__doc__, work="/tmp/calibration_coverage", jobs=2)
    parser.add_argument("--repetitions", type=int, default=400)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--blocks", type=int, default=36)
    parser.add_argument("--fit", default="theta_scale,En50")
    parser.add_argument("--trials", type=int, default=24)
    o = parser.parse_args()
    if os.path.isdir(o.work):
        sys.exit(f"{o.work}: is there already; remove it, or give another --work")
    os.makedirs(o.work)
    write_dem(f"{o.work}/dem.tif")
    with ThreadPoolExecutor(o.jobs) as jobs:
        found = list(jobs.map(lambda number: one(o, number), range(o.first, o.first + o.repetitions)))
    print("| parameter | 95 % interval holds the truth | identifiable | median width, a factor of |\n| --- | --- | --- | --- |")
    for i, key in enumerate(o.fit.split(",")):
        of = [repetition[i] for repetition in found]
        print(f"| {key} | {share(sum(held for held, _, _ in of), len(of))} | {sum(known for _, known, _ in of)} of {len(of)} | "
              f"{np.median([width for _, _, width in of]):.2f} |")


main()
