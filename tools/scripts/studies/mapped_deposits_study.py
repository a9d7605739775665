#!/usr/bin/python3
"""Recovery of the ground from mapped deposits alone, on synthetic slopes of known ground. docs/mapped-deposits.md.

  tools/scripts/studies/mapped_deposits_study.py make FOLDER [--number 0] [--blocks 60]
  tools/scripts/studies/mapped_deposits_study.py cover [--repetitions 12] [--first 0] [--blocks 60] [--fit theta_scale,En50,...]
      [--starts 1] [--trials 24]
  both: [--talus build/release/talus] [--work DIR] [--threads 2]

`make`: a slope with a cliff, the ground drawn around forest-road-3d (the logarithm of each parameter normal, standard deviation
0.5, within 1), a `talus run` of it, and a sample of the stops inside the mapped polygon as deposits.csv, mapped to 1 m, with
campaign.toml. truth.json has the ground; nothing else reads it. Slopes: straight, concave, a cone; by the number modulo 3.

`cover`: makes repetitions, calibrates each on its deposits alone and prints, per parameter, how often the 95 % interval holds the
truth and how often the parameter is identifiable. --strips holds out strips 2 and 4 of five across the slope.
"""
import argparse
import csv
import json
import os
import subprocess
import sys
import time

import numpy as np
from osgeo import gdal, ogr, osr

gdal.UseExceptions()
ogr.UseExceptions()

CELL, COLUMNS, ROWS = 4.0, 90, 120  # 360 m wide, 480 m long; the cliff is in the north
WEST, SOUTH = 2600000.0, 1200000.0  # EPSG:2056
CLIFF = (400.0, 430.0)              # from the south [m]
PRESET = {"theta_scale": 0.4, "psi_scale": 0.3, "En50": 15.0, "Et50": 50.0}  # forest-road-3d, from which a fit starts
KINDS = ("straight", "concave", "cone")


def heights(kind, numbers):
    y = (np.arange(ROWS)[::-1] + 0.5)[:, None] * CELL
    x = (np.arange(COLUMNS) + 0.5)[None, :] * CELL - 0.5 * COLUMNS * CELL
    below = np.maximum(0.0, y - 120.0)
    if kind == "straight":
        z = 0.72 * below
    elif kind == "concave":
        z = 0.45 * below + 0.0009 * below**2
    else:
        z = 0.70 * np.maximum(0.0, below - 0.0009 * x**2 * np.clip((400.0 - y) / 280.0, 0.0, 1.0))
    z = z + 0.05 * np.minimum(y, 120.0) + 1.2 * np.clip(y - CLIFF[0], 0.0, CLIFF[1] - CLIFF[0])
    return (1000.0 + z + numbers.normal(0.0, 0.15, z.shape)).astype(np.float32)


def system():
    srs = osr.SpatialReference()
    srs.ImportFromEPSG(2056)
    return srs


def write_dem(path, z):
    dem = gdal.GetDriverByName("GTiff").Create(path, COLUMNS, ROWS, 1, gdal.GDT_Float32)
    dem.SetGeoTransform((WEST, CELL, 0.0, SOUTH + ROWS * CELL, 0.0, -CELL))
    dem.SetProjection(system().ExportToWkt())
    dem.GetRasterBand(1).WriteArray(z)
    dem.FlushCache()


def write_box(path, west, south, east, north):
    if os.path.exists(path):
        os.remove(path)
    file = ogr.GetDriverByName("GPKG").CreateDataSource(path)
    layer = file.CreateLayer("polygons", system(), ogr.wkbPolygon)
    feature = ogr.Feature(layer.GetLayerDefn())
    corners = [(west, south), (east, south), (east, north), (west, north), (west, south)]
    feature.SetGeometry(ogr.CreateGeometryFromWkt(
        "POLYGON ((" + ",".join(f"{WEST + x} {SOUTH + y}" for x, y in corners) + "))"))
    layer.CreateFeature(feature)


def talus(o, *arguments):
    done = subprocess.run([o.talus, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"talus {' '.join(map(str, arguments))}: {done.stderr}")
    return done.stdout


def make(o, folder, number):
    """A campaign of mapped deposits in a folder; returns the number of its blocks."""
    numbers = np.random.default_rng(100 + number)
    kind = KINDS[number % len(KINDS)]
    os.makedirs(folder, exist_ok=True)
    write_dem(f"{folder}/dem.tif", heights(kind, numbers))
    write_box(f"{folder}/cliff.gpkg", 140.0, *CLIFF[:1], 220.0, CLIFF[1])
    mapped = (20.0, 10.0, 340.0, CLIFF[0] - 20.0)
    write_box(f"{folder}/mapped.gpkg", *mapped)
    truth = {key: PRESET[key] * float(np.exp(np.clip(numbers.normal(0.0, 0.5), -1.0, 1.0))) for key in PRESET}
    with open(f"{folder}/truth.json", "w", encoding="utf-8") as out:
        json.dump({"kind": kind, "ground": truth, "start": PRESET}, out, indent=1)
    ground = "".join(f"{key} = {value!r}\n" for key, value in truth.items())
    with open(f"{folder}/run.toml", "w", encoding="utf-8") as out:
        out.write(f'dem = "dem.tif"\ntrajectories = 20\nseed = {1000 + number}\n[sources]\nfile = "cliff.gpkg"\n'
                  '[blocks]\ndiameter = { volume_min = 0.03, volume_max = 2, exponent = 0.6 }\n'
                  f'[ground.zones.default]\n{ground}[output]\ntrajectories = 0\n')
    talus(o, "run", f"{folder}/run.toml", "-o", f"{folder}/run", "--overwrite", "-q")
    return write_deposits(o, folder, numbers, mapped)


def write_deposits(o, folder, numbers, mapped):
    """A sample of the stops in the mapped polygon."""
    west, south, east, north = (WEST + mapped[0], SOUTH + mapped[1], WEST + mapped[2], SOUTH + mapped[3])
    inside = []
    stops = ogr.Open(f"{folder}/run/stops.gpkg")  # must outlive its layer
    for feature in stops.GetLayer(0):
        place = feature.GetGeometryRef()
        if feature["end"] not in ("stopped", "trapped"):
            continue
        if west < place.GetX() < east and south < place.GetY() < north:
            inside.append((place.GetX(), place.GetY(), feature["diameter_m"]))
    chosen = numbers.choice(len(inside), min(o.blocks, len(inside)), replace=False)
    with open(f"{folder}/deposits.csv", "w", encoding="utf-8", newline="") as out:
        table = csv.writer(out)
        table.writerow(["id", "x", "y", "diameter_m"])
        for i, k in enumerate(chosen):
            error = numbers.normal(0.0, 1.0, 2)
            table.writerow([f"d{i}", f"{inside[k][0] + error[0]:.2f}", f"{inside[k][1] + error[1]:.2f}", inside[k][2]])
    strips = "strips = 5\nholdout = [2, 4]\n" if o.strips else ""
    with open(f"{folder}/campaign.toml", "w", encoding="utf-8") as out:
        out.write(f'name = "{os.path.basename(folder)}"\ndem = "dem.tif"\n[measurement_error]\nposition_m = 1.0\n[deposits]\n'
                  f'file = "deposits.csv"\nsources = "cliff.gpkg"\nmapped = "mapped.gpkg"\n{strips}')
    return len(chosen)


def cover(o):
    keys = o.fit.split(",")
    held = {key: 0 for key in keys}
    known, known_held, done, widths = dict(held), dict(held), 0, {key: [] for key in keys}
    lower = []
    for number in range(o.first, o.first + o.repetitions):
        folder = f"{o.work}/{number}"
        if make(o, folder, number) < o.blocks:
            print(f"{number}: on this ground fewer than {o.blocks} stops are on the map; left out", flush=True)
            continue
        with open(f"{folder}/truth.json", encoding="utf-8") as file:
            truth = json.load(file)
        with open(f"{folder}/start.toml", "w", encoding="utf-8") as out:
            out.write('[ground]\ndefault = "forest-road-3d"\n')
        begin = time.time()
        talus(o, "calibrate", f"{folder}/campaign.toml", "-o", f"{folder}/fit", "--overwrite", "-q", "--fit", o.fit, "--parameters",
              f"{folder}/start.toml", "--starts",
              o.starts, "--trials", o.trials, "--threads", o.threads)
        with open(f"{folder}/fit/calibration.json", encoding="utf-8") as file:
            result = json.load(file)
        done += 1
        line = []
        for p in result["parameters"]:
            key = p["key"].split(".")[-1]
            value = truth["ground"][key]
            inside = p["ci95"][0] <= value <= p["ci95"][1]
            held[key] += inside
            known[key] += p["identifiable"]
            known_held[key] += inside and p["identifiable"]
            widths[key].append(p["ci95"][1] / p["ci95"][0])
            line.append(f"{key} {value:.3g} in {p['ci95'][0]:.3g}..{p['ci95'][1]:.3g} {'yes' if inside else 'NO'}"
                        f"{'' if p['identifiable'] else ' (not identifiable)'}")
        error = result["error"]["fit"]
        lower.append(error["reduction"])
        patterns = ", ".join(f"{d['energy_distance_m']:.2f} m p {d['p_value']:.2f}" for d in error["deposits"]["patterns"])
        print(f"{number} {truth['kind']}: {'; '.join(line)}; inside {error['deposits']['inside']:.2f}; patterns {patterns}; "
              f"error {error['before']:.3f} to {error['after']:.3f}; {time.time() - begin:.0f} s", flush=True)
    print(f"\n| parameter | 95 % interval holds the truth | identifiable | of those holds | median width, a factor of |\n| --- | --- | --- | --- | --- |")
    for key in keys:
        print(f"| {key} | {held[key]} of {done} | {known[key]} of {done} | {known_held[key]} of {known[key]} | "
              f"{np.median(widths[key]):.1f} |")
    print(f"| all | {sum(held.values())} of {done * len(keys)} | {sum(known.values())} of {done * len(keys)} | "
          f"{sum(known_held.values())} of {sum(known.values())} | |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=["make", "cover"])
    parser.add_argument("folder", nargs="?")
    parser.add_argument("--number", type=int, default=0)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--repetitions", type=int, default=12)
    parser.add_argument("--blocks", type=int, default=60)
    parser.add_argument("--fit", default="theta_scale,psi_scale,En50,Et50")
    parser.add_argument("--starts", type=int, default=1)
    parser.add_argument("--trials", type=int, default=24)
    parser.add_argument("--strips", action="store_true", help="hold out strips 2 and 4 of 5")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--talus", default="build/release/talus")
    parser.add_argument("--work", default="/tmp/mapped_deposits")
    o = parser.parse_args()
    if o.what == "cover":
        cover(o)
    elif not o.folder:
        sys.exit("make: name a folder")
    else:
        print(make(o, o.folder.rstrip("/"), o.number), "blocks")


if __name__ == "__main__":
    main()
