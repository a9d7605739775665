#!/usr/bin/python3
"""Results against the size of the cells and the number of trajectories. docs/validation.md, "Cells and trajectories".

  tools/scripts/studies/convergence_study.py [--talus build/release/talus] [--dem DEM --blocks blocks.csv] [--cells 0.5,1,2,5,10]
                                             [--trajectories 300] [--work DIR] [--threads 2]

Cells: a slope by formula (cliff of 65 degrees, talus of 36 with a gully, run-out of 8), whose heights are taken at the centres
of the cells; and, with --dem and --blocks (a campaign's), a real DEM of fine cells, whose heights are averaged. Blocks of 1 m,
preset upper-talus-3d, from 40 points above the cliff or from the campaign's releases; the same random numbers at each size.
Printed: run-out P50 and P95 (plan distance from the release), P95 of speed, energy and jump height at a line, each with the
standard error over the releases, and the P95 run-out relative to the finest cells.

Number: the slope at 2 m, 10 to 3000 trajectories per point, against an independent run of 10000: mean of the relative difference of
the impact probability and of the P95 of the energy over the cells that at least 1 % of the blocks cross.
"""
import argparse
import csv
import json
import math
import os
import subprocess
from collections import defaultdict

import numpy as np
from osgeo import gdal, ogr, osr

gdal.UseExceptions()
ogr.UseExceptions()
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


def system():
    srs = osr.SpatialReference()
    srs.ImportFromEPSG(2056)
    return srs.ExportToWkt()


def slope(path, cell):
    columns, rows = round(WIDE / cell), round(LONG / cell)
    y = LONG - (np.arange(rows)[:, None] + 0.5) * cell
    x = (np.arange(columns)[None, :] + 0.5) * cell - WIDE / 2
    dem = gdal.GetDriverByName("GTiff").Create(path, columns, rows, 1, gdal.GDT_Float32)
    dem.SetGeoTransform([WEST, cell, 0, SOUTH + LONG, 0, -cell])
    dem.SetProjection(system())
    dem.GetRasterBand(1).WriteArray(height(x, y).astype(np.float32))


def averaged(path, source, cell):
    fine = gdal.Open(source)
    g = fine.GetGeoTransform()
    if cell <= 1.001 * g[1]:
        gdal.Translate(path, fine)
        return
    columns, rows = int(fine.RasterXSize * g[1] / cell), int(fine.RasterYSize * g[1] / cell)
    gdal.Warp(path, fine, resampleAlg="average", outputBounds=(g[0], g[3] - rows * cell, g[0] + columns * cell, g[3]), xRes=cell,
              yRes=cell, outputType=gdal.GDT_Float32)


def write(path, text):
    with open(path, "w", encoding="utf-8") as out:
        out.write(text)
    return path


def run(o, name, sources, screen, trajectories, seed=1):
    """Runs one DEM; the folder of the results."""
    out = f"{o.work}/{name}-{trajectories}-{seed}"
    text = (f'dem = "{name}.tif"\nseed = {seed}\ntrajectories = {trajectories}\n[sources]\nfile = "{sources}"\nrelease_height = 1\n[blocks]\n'
            f'diameter = 1.0\n[ground]\ndefault = "upper-talus-3d"\n[screens]\nfile = "{screen}"\n[output]\ntrajectories = 0\n')
    if not os.path.exists(f"{out}/run.json"):
        subprocess.run([o.talus, "run", write(f"{o.work}/{name}-{trajectories}-{seed}.toml", text), "-o", out, "-q", "--threads", str(o.threads)], check=True)
    return out


def by_source(out):
    """Run-outs and crossings of each source: lists by its number."""
    runout, crossings = defaultdict(list), defaultdict(list)
    layer = ogr.Open(f"{out}/stops.gpkg")
    for row in layer.GetLayer(0):
        runout[row["source"]].append(math.hypot(row["x_release"] - row.GetGeometryRef().GetX(), row["y_release"] - row.GetGeometryRef().GetY()))
    with open(f"{out}/screens.csv", encoding="utf-8") as file:
        for row in csv.DictReader(file):
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
        with open(f"{out}/run.json", encoding="utf-8") as file:
            ends = json.load(file)["ends"]
        lost = [100.0 * ends[k] / sum(ends.values()) for k in ("left", "trapped")]
        cell_of = "{:.1f} +- {:.1f}".format
        print(f"| {cell:g} | {cell_of(*median)} | {cell_of(*far)} | {100 * (far[0] / finest[0] - 1):+.1f} % | "
              + " | ".join(cell_of(*c) for c in columns) + f" | {lost[0]:.1f}, {lost[1]:.1f} |", flush=True)


def band(path, number):
    raster = gdal.Open(path)
    values = raster.GetRasterBand(number).ReadAsArray().astype(float)
    nodata = raster.GetRasterBand(number).GetNoDataValue()
    return np.where(values == nodata, np.nan, values) if nodata is not None else values


def numbers(o, name, sources, screen):
    print("\nNumber of trajectories\n\n| per point | impact probability | P95 of the energy | cells |\n| --- | --- | --- | --- |")
    best = run(o, name, sources, screen, 10000, seed=2)
    p, e = band(f"{best}/impact_probability.tif", 1), band(f"{best}/energy.tif", 3)
    often = p >= 0.01
    for n in (10, 30, 100, 300, 1000, 3000):
        out = run(o, name, sources, screen, n)
        dp = np.abs(band(f"{out}/impact_probability.tif", 1)[often] / p[often] - 1)
        de = np.abs(band(f"{out}/energy.tif", 3)[often] / e[often] - 1)
        print(f"| {n} | {100 * np.mean(dp):.1f} % | {100 * np.nanmean(de):.1f} % | {np.sum(often)} |", flush=True)


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--talus", default=f"{here}/../../../build/release/talus")
    parser.add_argument("--dem")
    parser.add_argument("--blocks")
    parser.add_argument("--line", help="x y x y: the line of the real DEM at which speeds are taken")
    parser.add_argument("--cells", default="0.5,1,2,5,10")
    parser.add_argument("--trajectories", type=int, default=300)
    parser.add_argument("--work", default="build/convergence")
    parser.add_argument("--threads", type=int, default=2)
    o = parser.parse_args()
    o.work, o.talus = os.path.abspath(o.work), os.path.abspath(o.talus)
    os.makedirs(o.work, exist_ok=True)
    sizes = [float(c) for c in o.cells.split(",")]
    top = SOUTH + 498.0
    write(f"{o.work}/points.csv", "x,y\n" + "".join(f"{WEST + 90 + 3.0 * i:.2f},{top}\n" for i in range(40)))
    write(f"{o.work}/line.csv", f'id,wkt\nS,"LINESTRING ({WEST + 12} {SOUTH + LINE}, {WEST + WIDE - 12} {SOUTH + LINE})"\n')
    for cell in sizes:
        slope(f"{o.work}/slope-{cell:g}.tif", cell)
    cells(o, "Slope by formula", [(c, f"slope-{c:g}") for c in sizes], "points.csv", "line.csv")
    if o.dem:
        with open(o.blocks, encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        write(f"{o.work}/real.csv", "x,y\n" + "".join(f"{r['x']},{r['y']}\n" for r in rows))
        fine = gdal.Open(o.dem)
        g = fine.GetGeoTransform()
        line = o.line.split() if o.line else [g[0] + 12, g[3] + 0.5 * fine.RasterYSize * g[5], g[0] + fine.RasterXSize * g[1] - 12, g[3] + 0.5 * fine.RasterYSize * g[5]]
        write(f"{o.work}/real-line.csv", f'id,wkt\nS,"LINESTRING ({line[0]} {line[1]}, {line[2]} {line[3]})"\n')
        for cell in sizes:
            averaged(f"{o.work}/real-{cell:g}.tif", o.dem, cell)
        cells(o, os.path.basename(os.path.dirname(os.path.abspath(o.dem))), [(c, f"real-{c:g}") for c in sizes], "real.csv", "real-line.csv")
    numbers(o, "slope-2", "points.csv", "line.csv")


main()
