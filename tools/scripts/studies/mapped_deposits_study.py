#!/usr/bin/python3
"""Does a fit find the ground from mapped deposits alone? On synthetic slopes of known ground.

  tools/scripts/studies/mapped_deposits_study.py make FOLDER [--number 0] [--blocks 60]
  tools/scripts/studies/mapped_deposits_study.py cover [--repetitions 12] [--first 0] [--blocks 60] [--fit theta_scale,En50,...]
      [--starts 1] [--trials 24]
  both: [--talus build/release/talus] [--work DIR] [--threads 2]

`make`: a slope with a cliff, the ground drawn around forest-road-3d (the logarithm of each parameter normal, standard deviation
0.5, within 1), a `talus run` of it, and a sample of the stops inside the mapped polygon as deposits.csv, mapped to 1 m, with
campaign.toml. truth.json has the ground; nothing else reads it. Slopes: straight, concave, a cone; by the number modulo 3.

`cover`: makes repetitions, calibrates each on its deposits alone and prints, per parameter, how often the 95 % interval holds the
truth and how often the parameter is identifiable. --strips holds out strips 2 and 4 of five across the slope. A slope takes up to
half a minute of one core. Results: docs/mapped-deposits.md, "Results".
"""
import json
import os
import sys
import time

import numpy as np

from files import box, features, read_json, write_layer, write_raster, write_table, write_text
from program import parser_of, talus

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
    return 1000.0 + z + numbers.normal(0.0, 0.15, (ROWS, COLUMNS))


def write_box(path, west, south, east, north):
    write_layer(path, [(box(WEST + west, SOUTH + south, WEST + east, SOUTH + north),)])


def make(o, folder, number):
    """A campaign of mapped deposits in a folder; returns the number of its blocks."""
    numbers = np.random.default_rng(100 + number)
    kind = KINDS[number % len(KINDS)]
    os.makedirs(folder, exist_ok=True)
    write_raster(f"{folder}/dem.tif", heights(kind, numbers), (WEST, SOUTH + ROWS * CELL), CELL)
    write_box(f"{folder}/cliff.gpkg", 140.0, *CLIFF[:1], 220.0, CLIFF[1])
    mapped = (20.0, 10.0, 340.0, CLIFF[0] - 20.0)
    write_box(f"{folder}/mapped.gpkg", *mapped)
    truth = {key: PRESET[key] * float(np.exp(np.clip(numbers.normal(0.0, 0.5), -1.0, 1.0))) for key in PRESET}
    write_text(f"{folder}/truth.json", json.dumps({"kind": kind, "ground": truth, "start": PRESET}, indent=1))
    ground = "".join(f"{key} = {value!r}\n" for key, value in truth.items())
    write_text(f"{folder}/run.toml", f'dem = "dem.tif"\ntrajectories = 20\nseed = {1000 + number}\n[sources]\nfile = "cliff.gpkg"\n'
               '[blocks]\ndiameter = { volume_min = 0.03, volume_max = 2, exponent = 0.6 }\n'
               f'[ground.zones.default]\n{ground}[output]\ntrajectories = 0\n')
    talus(o, "run", f"{folder}/run.toml", "-o", f"{folder}/run", "--overwrite", "-q")
    return write_deposits(o, folder, numbers, mapped)


def write_deposits(o, folder, numbers, mapped):
    """A sample of the stops in the mapped polygon."""
    west, south, east, north = (WEST + mapped[0], SOUTH + mapped[1], WEST + mapped[2], SOUTH + mapped[3])
    inside = []
    for feature in features(f"{folder}/run/stops.gpkg"):
        place = feature.GetGeometryRef()
        if feature["end"] not in ("stopped", "trapped"):
            continue
        if west < place.GetX() < east and south < place.GetY() < north:
            inside.append((place.GetX(), place.GetY(), feature["diameter_m"]))
    chosen = numbers.choice(len(inside), min(o.blocks, len(inside)), replace=False)
    rows = []
    for i, k in enumerate(chosen):
        error = numbers.normal(0.0, 1.0, 2)
        rows.append([f"d{i}", f"{inside[k][0] + error[0]:.2f}", f"{inside[k][1] + error[1]:.2f}", inside[k][2]])
    write_table(f"{folder}/deposits.csv", "id,x,y,diameter_m", rows)
    strips = "strips = 5\nholdout = [2, 4]\n" if o.strips else ""
    write_text(f"{folder}/campaign.toml", f'name = "{os.path.basename(folder)}"\ndem = "dem.tif"\n[measurement_error]\nposition_m = 1.0\n'
               f'[deposits]\nfile = "deposits.csv"\nsources = "cliff.gpkg"\nmapped = "mapped.gpkg"\n{strips}')
    return len(chosen)


def recovered(o, folder, number):
    """Calibrates and prints one campaign. Of each parameter: whether its interval holds the truth, whether it is identifiable,
    its width as a factor."""
    truth = read_json(f"{folder}/truth.json")
    start = write_text(f"{folder}/start.toml", '[ground]\ndefault = "forest-road-3d"\n')
    begin = time.time()
    talus(o, "calibrate", f"{folder}/campaign.toml", "-o", f"{folder}/fit", "--overwrite", "-q", "--fit", o.fit, "--parameters", start,
          "--starts", o.starts, "--trials", o.trials, "--threads", o.threads)
    result = read_json(f"{folder}/fit/calibration.json")
    found, line = {}, []
    for p in result["parameters"]:
        key, (low, high) = p["key"].split(".")[-1], p["ci95"]
        value = truth["ground"][key]
        found[key] = low <= value <= high, p["identifiable"], high / low
        line.append(f"{key} {value:.3g} in {low:.3g}..{high:.3g} {'yes' if found[key][0] else 'NO'}"
                    f"{'' if p['identifiable'] else ' (not identifiable)'}")
    error = result["error"]["fit"]
    patterns = ", ".join(f"{d['energy_distance_m']:.2f} m p {d['p_value']:.2f}" for d in error["deposits"]["patterns"])
    print(f"{number} {truth['kind']}: {'; '.join(line)}; inside {error['deposits']['inside']:.2f}; patterns {patterns}; "
          f"error {error['before']:.3f} to {error['after']:.3f}; {time.time() - begin:.0f} s", flush=True)
    return found


def print_row(name, found, width):
    held, known, both = (sum(map(test, found)) for test in (lambda f: f[0], lambda f: f[1], lambda f: f[0] and f[1]))
    print(f"| {name} | {held} of {len(found)} | {known} of {len(found)} | {both} of {known} |{width} |")


def cover(o):
    found = []
    for number in range(o.first, o.first + o.repetitions):
        folder = f"{o.work}/{number}"
        if make(o, folder, number) < o.blocks:
            print(f"{number}: on this ground fewer than {o.blocks} stops are on the map; left out", flush=True)
        else:
            found.append(recovered(o, folder, number))
    print("\n| parameter | 95 % interval holds the truth | identifiable | of those holds | median width, a factor of |\n| --- | --- | --- | --- | --- |")
    for key in o.fit.split(","):
        of_key = [f[key] for f in found]
        print_row(key, of_key, f" {np.median([width for _, _, width in of_key]):.1f}")
    print_row("all", [one for f in found for one in f.values()], "")


def main():
    parser = parser_of(__doc__, work="/tmp/mapped_deposits", threads=2)
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
    o = parser.parse_args()
    if o.what == "cover":
        cover(o)
    elif not o.folder:
        sys.exit("make: name a folder")
    else:
        print(make(o, o.folder.rstrip("/"), o.number), "blocks")


if __name__ == "__main__":
    main()
