#!/usr/bin/python3
"""How often do the 95 % intervals of the maps and of a barrier hold the truth? Whole runs, repeated.

  tools/scripts/studies/map_coverage_study.py [--talus build/release/talus] [--repetitions 400] [--trajectories 10] [--work DIR] [--jobs 2]

A slope of 60 x 80 cells of 4 m, three cliffs with frequencies of 0.5, 0.1 and 0.02 per year and blocks of their own sizes, 36
source cells. The truth is one run of 40 000 blocks per source cell. Each repetition is a run of --trajectories blocks per source
cell with another seed, `talus hazard` and `talus barrier` on it. Looked at are 60 cells, ten each near impact probabilities of
0.5, 0.2, 0.1, 0.05, 0.02 and 0.01. Printed: in how many of the repetitions, on average over the cells, the interval holds the
truth, and the least of the cells; 95 % is what is promised, and the standard error of one cell over 400 repetitions is 1.1 %.
Intervals of counts are exact, so that they may hold more. (reach_probability is not among them: its source cells are those that
reach the cell in this run, so that another run has another truth; interval_test.cpp.) Classes: of the cells that a map calls
decided, how many have the class of the truth. The independence of seeds: the variance of the counts of passages over the
repetitions, over that of a binomial (blocks of one cell are alike, those of several are strata: at most 1).

Eight minutes of one core. Results: docs/validation.md, "Intervals".
"""
import os
import shutil
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from files import box, read_bands, read_json, write_layer, write_raster, write_text
from program import parser_of, talus

WEST, SOUTH, CELL, COLUMNS, ROWS = 2600000.0, 1200000.0, 4.0, 60, 80
TARGETS = (0.5, 0.2, 0.1, 0.05, 0.02, 0.01)
SCENARIO = """dem = "dem.tif"
seed = {seed}
trajectories = {trajectories}
[sources]
file = "cliffs.gpkg"
release_height = 1
[blocks]
density = 2700
[ground]
default = "upper-talus-3d"
[screens]
file = "screens.csv"
[output]
trajectories = 0
bounds = true
energy_thresholds = [30, 100]
"""
BOUNDED = {  # file: (value, low, high) of bands; the value is that of the truth
    "impact_probability.tif": [("probability", 1, 2, 3)],
    "passage_density.tif": [("density", 1, 2, 3)],
    "annual_frequency.tif": [("frequency", 1, 2, 3)],
    "return_period_30.tif": [("years", 1, 2, 3)],
    "return_period_100.tif": [("years", 1, 2, 3)],
}
PERCENTILES = {"energy": (("P50", 2, 1, 2), ("P95", 3, 3, 4)), "velocity": (("P50", 2, 1, 2), ("P95", 3, 3, 4)),
               "jump_height": (("P50", 2, 1, 2), ("P95", 3, 3, 4))}


def make_site(work):
    y = (np.arange(ROWS)[::-1, None] + 0.5) * CELL
    x = (np.arange(COLUMNS)[None, :] + 0.5) * CELL - COLUMNS * CELL / 2
    z = 0.8 * np.maximum(0, y - 80) + 0.15 * np.minimum(y, 80) - 4 * np.exp(-((x - 10 * np.sin(y / 40)) / 12) ** 2)
    write_raster(f"{work}/dem.tif", 1000 + z, (WEST, SOUTH + ROWS * CELL), CELL)
    cliffs = [(box(WEST + left, SOUTH + 290, WEST + left + 16, SOUTH + 298), frequency, low, high)
              for left, frequency, low, high in ((60, 0.5, 0.5, 1.0), (110, 0.1, 0.8, 1.6), (150, 0.02, 1.5, 2.0))]
    write_layer(f"{work}/cliffs.gpkg", cliffs, [(name, float) for name in ("frequency", "diameter_min", "diameter_max")])
    write_text(f"{work}/screens.csv", f'id,wkt\nS,"LINESTRING ({WEST + 8} {SOUTH + 90}, {WEST + 232} {SOUTH + 90})"\n')


def run(o, name, seed, trajectories, threads):
    out = f"{o.work}/{name}"
    if not os.path.exists(f"{out}/barrier_S.json"):
        scenario = write_text(f"{o.work}/{name}.toml", SCENARIO.format(seed=seed, trajectories=trajectories))
        talus(o, "run", scenario, "-o", out, "--threads", threads, "--overwrite", "-q")
        talus(o, "hazard", out, "-q")
        talus(o, "barrier", out, "--screen", "S", "-q")
    return out


def intervals(out, cells):
    """Value, low and high of each quantity at the cells; and the values of a barrier."""
    found = {}
    for file, parts in BOUNDED.items():
        b = read_bands(f"{out}/{file}")
        for name, value, low, high in parts:
            found[f"{file} {name}"] = [b[i - 1][cells] for i in (value, low, high)]
    for quantity, parts in PERCENTILES.items():
        b, bounds = read_bands(f"{out}/{quantity}.tif"), read_bands(f"{out}/{quantity}_bounds.tif")
        for name, value, low, high in parts:
            found[f"{quantity}.tif {name}"] = [b[value - 1][cells], bounds[low - 1][cells], bounds[high - 1][cells]]
    return found


def barrier(out):
    d = read_json(f"{out}/barrier_S.json")
    found = {"crossings per year": [d["crossings_per_year"][k] for k in ("value", "low", "high")]}
    for r in d["reliability"]:
        for key in ("shape", "scale"):
            if r.get(key) is not None:
                found[f"Weibull {key} of {r['quantity']}"] = [r[key], *r[f"{key}_interval"]]
    return found


def report(name, held):
    held = np.asarray(held, float)
    held = held[:, ~np.all(np.isnan(held), axis=0)]
    if held.shape[1] == 0:
        print(f"{name:45} the truth has no value in these cells")
        return
    each = 100 * np.nanmean(held, axis=0)
    print(f"{name:45} {np.mean(each):6.1f} %   least {np.min(each):6.1f} %   of {held.shape[0]} x {np.size(each)}", flush=True)


def cells_near_targets(probability):
    """Ten cells near each of the probabilities."""
    chosen = []
    for target in TARGETS:
        flat = np.argsort(np.abs(np.log(np.where(probability > 0, probability, 1e-9) / target)), axis=None)
        chosen += [c for c in flat if c not in chosen][:10]
    return np.unravel_index(np.array(chosen), probability.shape)


def one(o, number, cells):
    """Intervals, barrier, class, whether it is undecided, and passages of one repetition; files that are not needed go."""
    out = run(o, f"run-{number}", number + 1, o.trajectories, 1)
    classes = read_bands(f"{out}/hazard_class.tif")
    found = intervals(out, cells), barrier(out), classes[0][cells], classes[3][cells], read_bands(f"{out}/passages.tif")[0][cells]
    for name in os.listdir(out):
        if name not in ("barrier_S.json", "hazard_class.tif", "passages.tif", *BOUNDED) and not any(name.startswith(q) for q in PERCENTILES):
            path = f"{out}/{name}"
            os.remove(path) if os.path.isfile(path) else shutil.rmtree(path)
    return found


def holds(low, high, value):
    """Whether intervals hold a value; what has no bound, on a side, claims nothing on that side."""
    inside = ~(np.where(np.isnan(low), -np.inf, low) > value * (1 + 1e-6)) & ~(np.where(np.isnan(high), np.inf, high) < value * (1 - 1e-6))
    return np.where(np.isnan(value), np.nan, inside)


def main():
    parser = parser_of(__doc__, work="build/map_coverage", jobs=2)
    parser.add_argument("--repetitions", type=int, default=400)
    parser.add_argument("--trajectories", type=int, default=10, help="blocks of each source cell in a repetition")
    parser.add_argument("--truth", type=int, default=40000, help="the same in the run that is the truth")
    o = parser.parse_args()
    os.makedirs(o.work, exist_ok=True)
    if not os.path.exists(f"{o.work}/cliffs.gpkg"):
        make_site(o.work)
    best = run(o, "truth", 999999, o.truth, o.jobs)
    probability = read_bands(f"{best}/impact_probability.tif")[0]
    cells = cells_near_targets(probability)
    truth, true_class, true_barrier = intervals(best, cells), read_bands(f"{best}/hazard_class.tif")[0][cells], barrier(best)
    held, held_barrier, right, decided, counts = {k: [] for k in truth}, {k: [] for k in true_barrier}, 0, 0, []
    with ThreadPoolExecutor(o.jobs) as jobs:
        for maps, design, classes, undecided, passages in jobs.map(lambda k: one(o, k, cells), range(o.repetitions)):
            for name, (_, low, high) in maps.items():
                held[name].append(holds(low, high, truth[name][0]))
            for name, (_, low, high) in design.items():
                held_barrier[name].append([low <= true_barrier[name][0] <= high])
            right += np.sum((undecided == 0) & (classes == true_class))
            decided += np.sum(undecided == 0)
            counts.append(passages)
    for name, rows in held.items():
        report(name, rows)
    for name, rows in held_barrier.items():
        if rows:
            report(f"barrier: {name}", rows)
    print(f"hazard class where decided: {right} of {decided} are the truth's ({100 * right / max(1, decided):.1f} %)")
    n = read_json(f"{best}/run.json")["released"] / o.truth * o.trajectories
    expected = n * probability[cells] * (1 - probability[cells])
    print(f"variance of the passages over that of a binomial, mean of the cells: {np.mean(np.var(counts, axis=0, ddof=1) / expected):.3f}")


main()
