#!/usr/bin/python3
"""How much do results change with the size of the cells and the number of trajectories?

  tools/scripts/studies/convergence_study.py [--talus build/release/talus] [--dem DEM --blocks blocks.csv] [--cells 0.5,1,2,5,10]
                                             [--trajectories 300] [--work DIR] [--threads 2]

Cells: a slope by formula (cliff of 65 degrees, talus of 36 with a gully, run-out of 8), whose heights are taken at the centres
of the cells; and, with --dem and --blocks (a campaign's), a real DEM of fine cells, whose heights are averaged. Blocks of 1 m,
preset upper-talus-3d, from 40 points above the cliff or from the campaign's releases; the same random numbers at each size.
Printed: run-out P50 and P95 (plan distance from the release), P95 of speed, energy and jump height at a line, each with the
standard error over the releases, and the P95 run-out relative to the finest cells.

Number: the slope at 2 m, 10 to 3000 trajectories per point, against an independent run of 10000: mean of the relative difference of
the impact probability and of the P95 of the energy over the cells that at least 1 % of the blocks cross.

A few minutes. Results: docs/validation.md, "Cells and trajectories".
"""
import math
import os
from collections import defaultdict

import numpy as np
from osgeo import gdal

from files import features, read_bands, read_json, read_table, write_raster, write_text
from program import list_of, parser_of, talus

WEST, SOUTH, WIDE, LONG = 2600000.0, 1200000.0, 300.0, 560.0  # EPSG:2056 [m]
LINE = 200.0  # from the south: the line at which speeds are taken [m]


def height(x, y):
    """x from the middle, y from the south [m]."""
    foot, top = 160.0, 480.0
    z = math.tan(math.radians(8)) * np.minimum(y, foot)
    z = z + math.tan(math.radians(36)) * np.clip(y - foot, 0, top - foot)
    z = z + math.tan(math.radians(65)) * np.clip(y - top, 0, 25) + 0.2 * np.maximum(0, y - top - 25)
    gully = 5.0 * np.exp(-((x - 15 * np.sin(y / 60)) / 14) ** 2) * np.clip((y - foot + 40) / 80, 0, 1)
    return 1000.0 + z - gully


def slope(path, cell):
    columns, rows = round(WIDE / cell), round(LONG / cell)
    y = LONG - (np.arange(rows)[:, None] + 0.5) * cell
    x = (np.arange(columns)[None, :] + 0.5) * cell - WIDE / 2
    write_raster(path, height(x, y), (WEST, SOUTH + LONG), cell)


def averaged(path, source, cell):
    fine = gdal.Open(source)
    g = fine.GetGeoTransform()
    if cell <= 1.001 * g[1]:
        gdal.Translate(path, fine)
        return
    columns, rows = int(fine.RasterXSize * g[1] / cell), int(fine.RasterYSize * g[1] / cell)
    gdal.Warp(path, fine, resampleAlg="average", outputBounds=(g[0], g[3] - rows * cell, g[0] + columns * cell, g[3]), xRes=cell,
              yRes=cell, outputType=gdal.GDT_Float32)


def run(o, name, sources, screen, trajectories, seed=1):
    """Runs one DEM; the folder of the results."""
    out = f"{o.work}/{name}-{trajectories}-{seed}"
    text = (f'dem = "{name}.tif"\nseed = {seed}\ntrajectories = {trajectories}\n[sources]\nfile = "{sources}"\nrelease_height = 1\n[blocks]\n'
            f'diameter = 1.0\n[ground]\ndefault = "upper-talus-3d"\n[screens]\nfile = "{screen}"\n[output]\ntrajectories = 0\n')
    if not os.path.exists(f"{out}/run.json"):
        talus(o, "run", write_text(f"{out}.toml", text), "-o", out, "-q", "--threads", o.threads)
    return out


def by_source(out):
    """Run-outs and crossings of each source: lists by its number."""
    runout, crossings = defaultdict(list), defaultdict(list)
    for row in features(f"{out}/stops.gpkg"):
        runout[row["source"]].append(math.hypot(row["x_release"] - row.GetGeometryRef().GetX(), row["y_release"] - row.GetGeometryRef().GetY()))
    for row in read_table(f"{out}/screens.csv"):
        crossings[int(row["source"])].append([float(row[k]) for k in ("speed_ms", "energy_kj", "jump_height_m")])
    return runout, crossings


def with_error(groups, statistic):
    """A statistic of all values with its standard error: the jackknife over the sources."""
    names = [k for k in groups if groups[k]]
    if len(names) < 3:
        return math.nan, math.nan
    lists = [np.asarray(groups[k]) for k in names]
    whole = statistic(np.concatenate(lists))
    without = np.array([statistic(np.concatenate(lists[:i] + lists[i + 1:])) for i in range(len(lists))])
    return whole, math.sqrt((len(lists) - 1) / len(lists) * np.sum((without - without.mean()) ** 2))


def percentile(share, column=None):
    return lambda values: np.percentile(values if column is None else values[:, column], share)


def cells(o, title, dems, sources, screen):
    print(f"\n{title}\n\n| cell (m) | run-out P50 (m) | P95 (m) | of the finest | speed P95 (m/s) | energy P95 (kJ) | jump P95 (m) | left, trapped (%) |\n"
          "| --- | --- | --- | --- | --- | --- | --- | --- |")
    finest = None
    for cell, name in dems:
        out = run(o, name, sources, screen, o.trajectories)
        runout, crossings = by_source(out)
        median, far = with_error(runout, percentile(50)), with_error(runout, percentile(95))
        finest = finest or far
        columns = [with_error(crossings, percentile(95, i)) for i in range(3)]
        ends = read_json(f"{out}/run.json")["ends"]
        lost = [100.0 * ends[k] / sum(ends.values()) for k in ("left", "trapped")]
        cell_of = "{:.1f} +- {:.1f}".format
        print(f"| {cell:g} | {cell_of(*median)} | {cell_of(*far)} | {100 * (far[0] / finest[0] - 1):+.1f} % | "
              + " | ".join(cell_of(*c) for c in columns) + f" | {lost[0]:.1f}, {lost[1]:.1f} |", flush=True)


def probability_and_energy(out):
    """Impact probability and the P95 of the energy of each cell."""
    return read_bands(f"{out}/impact_probability.tif")[0], read_bands(f"{out}/energy.tif")[2]


def numbers(o, name, sources, screen):
    print("\nNumber of trajectories\n\n| per point | impact probability | P95 of the energy | cells |\n| --- | --- | --- | --- |")
    best = probability_and_energy(run(o, name, sources, screen, 10000, seed=2))
    often = best[0] >= 0.01
    for n in (10, 30, 100, 300, 1000, 3000):
        found = probability_and_energy(run(o, name, sources, screen, n))
        dp, de = (np.abs(a[often] / b[often] - 1) for a, b in zip(found, best))
        print(f"| {n} | {100 * np.mean(dp):.1f} % | {100 * np.nanmean(de):.1f} % | {np.sum(often)} |", flush=True)


def by_formula(o):
    top = SOUTH + 498.0
    write_text(f"{o.work}/points.csv", "x,y\n" + "".join(f"{WEST + 90 + 3.0 * i:.2f},{top}\n" for i in range(40)))
    write_text(f"{o.work}/line.csv", f'id,wkt\nS,"LINESTRING ({WEST + 12} {SOUTH + LINE}, {WEST + WIDE - 12} {SOUTH + LINE})"\n')
    for cell in o.cells:
        slope(f"{o.work}/slope-{cell:g}.tif", cell)
    cells(o, "Slope by formula", [(c, f"slope-{c:g}") for c in o.cells], "points.csv", "line.csv")


def real(o):
    write_text(f"{o.work}/real.csv", "x,y\n" + "".join(f"{r['x']},{r['y']}\n" for r in read_table(o.blocks)))
    fine = gdal.Open(o.dem)
    g = fine.GetGeoTransform()
    middle = g[3] + 0.5 * fine.RasterYSize * g[5]
    line = o.line.split() if o.line else [g[0] + 12, middle, g[0] + fine.RasterXSize * g[1] - 12, middle]
    write_text(f"{o.work}/real-line.csv", f'id,wkt\nS,"LINESTRING ({line[0]} {line[1]}, {line[2]} {line[3]})"\n')
    for cell in o.cells:
        averaged(f"{o.work}/real-{cell:g}.tif", o.dem, cell)
    title = os.path.basename(os.path.dirname(os.path.abspath(o.dem)))
    cells(o, title, [(c, f"real-{c:g}") for c in o.cells], "real.csv", "real-line.csv")


def main():
    parser = parser_of(__doc__, work="build/convergence", threads=2)
    parser.add_argument("--dem")
    parser.add_argument("--blocks")
    parser.add_argument("--line", help="x y x y: the line of the real DEM at which speeds are taken")
    parser.add_argument("--cells", type=list_of(float), default="0.5,1,2,5,10", help="[m]; 2 m must be among them")
    parser.add_argument("--trajectories", type=int, default=300, help="of each point")
    o = parser.parse_args()
    os.makedirs(o.work, exist_ok=True)
    by_formula(o)
    if o.dem:
        real(o)
    numbers(o, "slope-2", "points.csv", "line.csv")


main()
