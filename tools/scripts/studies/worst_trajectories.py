#!/usr/bin/python3
"""How much time and memory can a trajectory take? Over random terrains and random parameters within their bounds.

  tools/scripts/studies/worst_trajectories.py --sets 60 --seed 12                    the limits of the model at their defaults
  tools/scripts/studies/worst_trajectories.py --sets 40 --seed 2 --highest-limits    up to their highest values

Each set is a terrain of its own (plane, pit, gully, noise, flat, stairs; cells of 0.05 to 100 m) and four blocks at one place.
Prints the five sets with the most processor time per trajectory: seconds, peak memory of the run [MB], ends, terrain. A set that
takes more than two minutes is named. Some minutes. Results: docs/physics.md, "End of a trajectory". Needs numpy and GDAL.
"""
import math
import random
import subprocess
import sys
import tempfile

import numpy as np

from files import read_json, write_raster, write_text
from program import parser_of

WEST, NORTH = 2600000.0, 1200300.0
BLOCKS = 4


def terrain(luck, noise):
    """(name, heights, cell) of a random terrain."""
    cell, side = luck.choice([0.05, 0.2, 1, 5, 30, 100]), luck.choice([4, 20, 60])
    y, x = np.arange(side)[::-1][:, None] * cell, np.arange(side)[None, :] * cell
    kind = luck.choice(["plane", "pit", "gully", "noise", "flat", "stairs"])
    slope = math.tan(math.radians(luck.choice([0, 5, 20, 30, 35, 45, 60, 80])))
    z = slope * y + 0.0 * x
    if kind == "pit":
        z = slope * np.hypot(x - x.mean(), y - y.mean())
    elif kind == "gully":
        z = z + abs(x - x.mean()) * luck.choice([0.3, 1, 5])
    elif kind == "noise":
        z = z + noise.normal(0.0, cell * luck.choice([0.01, 0.3, 2]), (side, side))
    elif kind == "flat":
        z = 0.0 * z
    elif kind == "stairs":
        z = np.floor(y / cell / 3) * cell * 3 * slope + 0.0 * x
    return f"{kind}, slope {slope:.3g}, {side} x {side} cells of {cell} m", z - z.min() + 100.0, cell


def scenario(luck, number, highest):
    pick = luck.choice
    height = pick([0, 1, 100, 500])
    diameter = math.exp(luck.uniform(math.log(0.01), math.log(50)))
    text = f"""dem = "d.tif"
trajectories = {BLOCKS}
seed = {number}
surface = "{pick(['creased', 'bilinear'])}"
[sources]
file = "p.csv"
release_height = {height}
[blocks]
diameter = {diameter}
density = {pick([500, 2700, 8000])}
[ground.zones.default]
theta_scale = {pick([0, 0.01, 1, 5])}
psi_scale = {pick([0, 1, 5])}
En50 = {pick([1e-6, 1e-3, 1, 100, 1e6])}
Et50 = {pick([1e-6, 1e-3, 1, 100, 1e6])}
phi = {pick([0.01, 1, 10, 35, 60, 88.9])}
[model]
stop_speed = {pick([0.5, 1e-9, 0.01, 10]) if highest else 0.5}
trap_time = {pick([5, 1e-3, 3600]) if highest else 5}
time_limit = {86400 if highest else 600}
impact_limit = {10000000 if highest else 100000}
deformation_coefficient = {pick([0.25, 1e-6, 100])}
"""
    if luck.random() < 0.5:
        text += f"[effects.vegetation-drag]\ncoefficient = {pick([1, 100, 5000])}\nheight = {pick([1, 10, 60])}\n"
    if luck.random() < 0.3:
        text += f"[effects.air-drag]\ncoefficient = {pick([0.5, 2])}\n"
    if luck.random() < 0.3:
        text += f"[effects.rolling-resistance]\ncoefficient = {pick([0.01, 0.5])}\n"
    return text


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--sets", type=int, default=60)
    parser.add_argument("--seed", type=int, default=12)
    parser.add_argument("--highest-limits", action="store_true")
    o = parser.parse_args()
    luck, noise, found = random.Random(o.seed), np.random.default_rng(o.seed), []
    with tempfile.TemporaryDirectory() as folder:
        for number in range(o.sets):
            name, z, cell = terrain(luck, noise)
            write_raster(f"{folder}/d.tif", z, (WEST, NORTH), cell)
            share = luck.choice([0.3, 0.5])
            write_text(f"{folder}/p.csv", f"x,y\n{WEST + share * z.shape[1] * cell},{NORTH - 0.5 * z.shape[0] * cell}\n")
            write_text(f"{folder}/s.toml", scenario(luck, number, o.highest_limits))
            if z.max() > 8900:
                continue
            command = [o.talus, "run", f"{folder}/s.toml", "-o", f"{folder}/out", "--overwrite", "--threads", "1", "-q"]
            try:
                done = subprocess.run(command, capture_output=True, text=True, timeout=120)
            except subprocess.TimeoutExpired:
                print(f"set {number}: more than two minutes ({name})")
                continue
            if done.returncode not in (0, 1):
                sys.exit(f"set {number}: {done.stderr}")
            run = read_json(f"{folder}/out/run.json")
            found.append((run["cpu_seconds"]["simulate"] / BLOCKS, run["peak_memory_mb"], run["ends"], name))
    found.sort(key=lambda row: -row[0])
    print(f"{len(found)} sets of {BLOCKS} trajectories; the costliest:")
    for seconds, memory, ends, name in found[:5]:
        print(f"{seconds:.4f} s each, {memory:.0f} MB, {ends}, {name}")


main()
