#!/usr/bin/python3
"""Measures the effect rest-in-roughness: on measured campaigns, and the sorting by size on a plane. docs/effects.md.

  tools/scripts/studies/rest_study.py fits CAMPAIGN_FOLDER... [--kappa 0,0.1,0.3,0.6,1.2] [--seeds 1,2,3] [--trials 32] [--starts 1]
  tools/scripts/studies/rest_study.py plane [--kappa 0,0.6,1.2] [--slope 35] [--length 1500] [--blocks 2000]
  both: [--talus build/release/talus] [--work DIR] [--threads 1]

`fits`: for each kappa and seed the ground is fitted anew (`talus calibrate`); prints the error on the held-out rows, with 400 trials
a block of its own random numbers: mean over the seeds, and each seed. The spread over the seeds is the luck of the search. Fits
that are there (in --work) are not made again.

`plane`: blocks of 0.3, 1 and 3 m released at rest 2 m above the top of a plane (upper-talus-3d), with and without
block-mass (preset measured): share that stops on it, median and mean way in plan of those, and the median way of all
(those that leave count with the length of the plane); the share that still creeps after 600 s (limit); mean speed and jump height 200 m down, of those that get there. Small blocks high and large ones far is the law of real talus.

Both on bilinear patches (`--surface bilinear`), as the tables of docs/effects.md.
"""
import argparse
import csv
import json
import os
import subprocess
import sys

import numpy as np

DIAMETERS = (0.3, 1.0, 3.0)
SURFACE = "bilinear"  # on which the tables of docs/effects.md were measured


def write(path, text):
    with open(path, "w", encoding="utf-8") as out:
        out.write(text)
    return path


def talus(o, *arguments, allowed=(0,)):
    done = subprocess.run([o.talus, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode not in allowed:
        sys.exit(f"talus {' '.join(map(str, arguments))}: {done.stderr}")
    return done.stdout


def holdout_error(o, campaign, kappa, seed):
    """Error on the held-out rows of the ground fitted with this kappa."""
    name = f"{os.path.basename(os.path.normpath(campaign))}-{kappa:g}-{seed}-{o.trials}-{o.starts}"
    out, file = os.path.join(o.work, name), os.path.join(campaign, "campaign.toml")
    start = write(os.path.join(o.work, name + ".toml"), f"[effects.rest-in-roughness]\nkappa = {kappa:g}\n" if kappa else "")
    if not os.path.exists(os.path.join(out, "fitted.toml")):
        talus(o, "calibrate", file, "-o", out, "--parameters", start, "--surface", SURFACE, "--seed", seed, "--trials", o.trials,
              "--starts", o.starts, "--threads", o.threads, "-q")
    scored = json.loads(talus(o, "score", file, "--parameters", os.path.join(out, "fitted.toml"), "--surface", SURFACE, "--rows", "holdout",
                              "--trials", 400, "--seed", 1000, "--threads", o.threads, "--json", "-q"))
    return scored["holdout"]["score"]


def fits(o):
    print(f"{'campaign':12} {'kappa':>6} {'error':>7}   each of the seeds {o.seeds}")
    for campaign in o.campaigns:
        for kappa in o.kappa:
            errors = [holdout_error(o, campaign, kappa, seed) for seed in o.seeds]
            print(f"{os.path.basename(os.path.normpath(campaign)):12} {kappa:6g} {np.mean(errors):7.3f}   "
                  + " ".join(f"{e:.3f}" for e in errors), flush=True)


def make_plane(o):
    """A plane that falls to the east, and a point 50 m below its upper edge."""
    from osgeo import gdal, ogr, osr
    gdal.UseExceptions()
    ogr.UseExceptions()
    cell, rows = 5.0, 160
    columns = int((o.length + 100) / cell)
    system = osr.SpatialReference()
    system.ImportFromEPSG(2056)
    west, north = 2_600_000.0, 1_200_000.0
    heights = 4000.0 - np.tan(np.radians(o.slope)) * (np.arange(columns)[None, :] + 0.5) * cell + np.zeros((rows, 1))
    dem = gdal.GetDriverByName("GTiff").Create(os.path.join(o.work, "plane.tif"), columns, rows, 1, gdal.GDT_Float32)
    dem.SetGeoTransform([west, cell, 0, north, 0, -cell])
    dem.SetProjection(system.ExportToWkt())
    dem.GetRasterBand(1).WriteArray(heights.astype(np.float32))
    del dem
    start = (west + 50.0, north - rows * cell / 2)
    file = ogr.GetDriverByName("GPKG").CreateDataSource(os.path.join(o.work, "top.gpkg"))
    layer = file.CreateLayer("top", system, ogr.wkbPoint)
    feature = ogr.Feature(layer.GetLayerDefn())
    feature.SetGeometry(ogr.CreateGeometryFromWkt(f"POINT ({start[0]} {start[1]})"))
    layer.CreateFeature(feature)
    x = start[0] + 200.0
    lines = ogr.GetDriverByName("GPKG").CreateDataSource(os.path.join(o.work, "screen.gpkg"))
    layer = lines.CreateLayer("screen", system, ogr.wkbLineString)
    feature = ogr.Feature(layer.GetLayerDefn())
    feature.SetGeometry(ogr.CreateGeometryFromWkt(f"LINESTRING ({x} {north - 5},{x} {north - rows * cell + 5})"))
    layer.CreateFeature(feature)
    return start


def ways(o, name, diameter, effects, start):
    """Ways in plan down the plane of the blocks that stop on it [m]; speed and jump height of those that cross the screen."""
    from osgeo import ogr
    out = os.path.join(o.work, name)
    scenario = write(out + ".toml", f'dem = "plane.tif"\nsurface = "{SURFACE}"\ntrajectories = {o.blocks}\n'
                     f'[sources]\nfile = "top.gpkg"\nrelease_height = 2\n'
                     f"[blocks]\ndiameter = {diameter}\n[output]\ntrajectories = 0\n"
                     f'[screens]\nfile = "screen.gpkg"\n{effects}')
    talus(o, "run", scenario, "-o", out, "--overwrite", "-q", "--threads", o.threads, allowed=(0, 1))  # 1: many creep to the limit
    stops = ogr.Open(os.path.join(out, "stops.gpkg"))
    with open(os.path.join(out, "screens.csv"), encoding="utf-8") as file:
        crossings = list(csv.DictReader(file))
    passed = [np.mean([float(row[key]) for row in crossings]) if crossings else np.nan for key in ("speed_ms", "jump_height_m")]
    ends = [(f.GetGeometryRef().GetX() - start[0], f["end"]) for f in stops.GetLayer(0)]
    return tuple(np.array([way for way, end in ends if end == kind]) for kind in ("stopped", "limit")) + (passed,)


def plane(o):
    start = make_plane(o)
    print(f"plane of {o.slope:g} degrees, {o.length:g} m long in plan, {o.blocks} blocks of each size")
    print(f"{'kappa':>6} {'block-mass':10} {'D [m]':>6} {'stop %':>7} {'limit %':>7} {'median':>8} {'mean':>8} {'median of all [m]':>18} {'v [m/s]':>8} {'jump [m]':>8}")
    for size_law in (False, True):
        for kappa in o.kappa:
            effects = f"[effects.rest-in-roughness]\nkappa = {kappa:g}\n" if kappa else ""
            effects += '[effects.block-mass]\npreset = "measured"\n' if size_law else ""
            for diameter in DIAMETERS:
                way, creeping, (speed, jump) = ways(o, f"plane-{kappa:g}-{int(size_law)}-{diameter:g}", diameter, effects, start)
                every = np.concatenate([way, creeping, np.full(o.blocks - len(way) - len(creeping), o.length)])
                middle = (f"{np.median(way):8.0f} {np.mean(way):8.0f}" if len(way) else f"{'-':>8} {'-':>8}")
                whole = f"> {o.length:.0f}" if np.median(every) >= o.length else f"{np.median(every):.0f}"
                print(f"{kappa:6g} {'measured' if size_law else 'off':10} {diameter:6g} {100 * len(way) / o.blocks:7.1f} "
                      f"{100 * len(creeping) / o.blocks:7.1f} {middle} {whole:>18} "
                      f"{speed:8.1f} {jump:8.2f}",
                      flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    modes = parser.add_subparsers(dest="mode", required=True)
    numbers = lambda kind: lambda text: [kind(x) for x in text.split(",")]
    a, b = modes.add_parser("fits"), modes.add_parser("plane")
    a.add_argument("campaigns", nargs="+")
    a.add_argument("--kappa", type=numbers(float), default=[0, 0.1, 0.3, 0.6, 1.2])
    a.add_argument("--seeds", type=numbers(int), default=[1, 2, 3])
    a.add_argument("--trials", type=int, default=32)
    a.add_argument("--starts", type=int, default=1)
    b.add_argument("--kappa", type=numbers(float), default=[0, 0.6, 1.2])
    b.add_argument("--slope", type=float, default=35.0)
    b.add_argument("--length", type=float, default=1500.0)
    b.add_argument("--blocks", type=int, default=2000)
    for p in (a, b):
        p.add_argument("--talus", default="build/release/talus")
        p.add_argument("--work", default="rest-study")
        p.add_argument("--threads", type=int, default=1)
    o = parser.parse_args()
    os.makedirs(o.work, exist_ok=True)
    fits(o) if o.mode == "fits" else plane(o)
    return 0


if __name__ == "__main__":
    sys.exit(main())
