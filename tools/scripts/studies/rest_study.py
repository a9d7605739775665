#!/usr/bin/python3
"""Does the effect rest-in-roughness make fits to measured campaigns better, and does it sort blocks by size on a plane?

  tools/scripts/studies/rest_study.py fits CAMPAIGN_FOLDER... [--kappa 0,0.1,0.3,0.6,1.2] [--seeds 1,2,3] [--trials 32] [--starts 1]
  tools/scripts/studies/rest_study.py plane [--kappa 0,0.6,1.2] [--slope 35] [--length 1500] [--blocks 2000]
  both: [--talus build/release/talus] [--work DIR] [--threads 1]

`fits`: for each kappa and seed the ground is fitted anew (`talus calibrate`); prints the error on the held-out rows, with 400 trials
a block of its own random numbers: mean over the seeds, and each seed. The spread over the seeds is the luck of the search. Fits
that are there (in --work) are not made again.

`plane`: blocks of 0.3, 1 and 3 m released at rest 2 m above the top of a plane (upper-talus-3d), with and without
block-mass (preset measured): share that stops on it, median and mean way in plan of those, and the median way of all
(those that leave count with the length of the plane); the share that still creeps after 600 s (limit); mean speed and jump height
200 m down, of those that get there. Small blocks high and large ones far is the law of real talus.

Both on bilinear patches (`--surface bilinear`). A fit takes minutes of one core, the plane with 200 blocks some minutes. Results:
docs/effects.md, "rest-in-roughness".
"""
import argparse
import os

import numpy as np

from campaign_fits import SURFACE, add_fit_options, errors_of, fitted, name_of
from files import features, read_table, write_layer, write_raster, write_text
from program import add_options, list_of, talus

DIAMETERS = (0.3, 1.0, 3.0)
CELL, ROWS = 5.0, 160
WEST, NORTH = 2_600_000.0, 1_200_000.0
START = (WEST + 50.0, NORTH - ROWS * CELL / 2)  # of the blocks on the plane


def effect_of(kappa):
    return f"[effects.rest-in-roughness]\nkappa = {kappa:g}\n" if kappa else ""


def fits(o):
    print(f"{'campaign':12} {'kappa':>6} {'error':>7}   each of the seeds {o.seeds}")
    for campaign in o.campaigns:
        for kappa in o.kappa:
            errors = [errors_of(o, campaign, fitted(o, campaign, f"{kappa:g}", effect_of(kappa), seed))[1] for seed in o.seeds]
            print(f"{name_of(campaign):12} {kappa:6g} {np.mean(errors):7.3f}   "
                  + " ".join(f"{e:.3f}" for e in errors), flush=True)


def make_plane(o):
    """A plane that falls to the east, a point 50 m below its upper edge, and a screen 200 m below the point."""
    columns = int((o.length + 100) / CELL)
    heights = 4000.0 - np.tan(np.radians(o.slope)) * (np.arange(columns)[None, :] + 0.5) * CELL + np.zeros((ROWS, 1))
    write_raster(f"{o.work}/plane.tif", heights, (WEST, NORTH), CELL)
    write_layer(f"{o.work}/top.gpkg", [(f"POINT ({START[0]} {START[1]})",)])
    x = START[0] + 200.0
    write_layer(f"{o.work}/screen.gpkg", [(f"LINESTRING ({x} {NORTH - 5},{x} {NORTH - ROWS * CELL + 5})",)])


def ways(o, name, diameter, effects):
    """Ways in plan down the plane of the blocks that stop on it [m]; speed and jump height of those that cross the screen."""
    out = os.path.join(o.work, name)
    scenario = write_text(out + ".toml", f'dem = "plane.tif"\nsurface = "{SURFACE}"\ntrajectories = {o.blocks}\n'
                     f'[sources]\nfile = "top.gpkg"\nrelease_height = 2\n'
                     f"[blocks]\ndiameter = {diameter}\n[output]\ntrajectories = 0\n"
                     f'[screens]\nfile = "screen.gpkg"\n{effects}')
    talus(o, "run", scenario, "-o", out, "--overwrite", "-q", "--threads", o.threads, allowed=(0, 1))  # 1: many creep to the limit
    crossings = read_table(f"{out}/screens.csv")
    passed = [np.mean([float(row[key]) for row in crossings]) if crossings else np.nan for key in ("speed_ms", "jump_height_m")]
    ends = [(f.GetGeometryRef().GetX() - START[0], f["end"]) for f in features(f"{out}/stops.gpkg")]
    return tuple(np.array([way for way, end in ends if end == kind]) for kind in ("stopped", "limit")) + (passed,)


def plane(o):
    make_plane(o)
    print(f"plane of {o.slope:g} degrees, {o.length:g} m long in plan, {o.blocks} blocks of each size")
    print(f"{'kappa':>6} {'block-mass':10} {'D [m]':>6} {'stop %':>7} {'limit %':>7} {'median':>8} {'mean':>8} {'median of all [m]':>18} "
          f"{'v [m/s]':>8} {'jump [m]':>8}")
    for size_law in (False, True):
        for kappa in o.kappa:
            effects = effect_of(kappa) + ('[effects.block-mass]\npreset = "measured"\n' if size_law else "")
            for diameter in DIAMETERS:
                way, creeping, (speed, jump) = ways(o, f"plane-{kappa:g}-{int(size_law)}-{diameter:g}", diameter, effects)
                every = np.concatenate([way, creeping, np.full(o.blocks - len(way) - len(creeping), o.length)])
                middle = (f"{np.median(way):8.0f} {np.mean(way):8.0f}" if len(way) else f"{'-':>8} {'-':>8}")
                whole = f"> {o.length:.0f}" if np.median(every) >= o.length else f"{np.median(every):.0f}"
                print(f"{kappa:6g} {'measured' if size_law else 'off':10} {diameter:6g} {100 * len(way) / o.blocks:7.1f} "
                      f"{100 * len(creeping) / o.blocks:7.1f} {middle} {whole:>18} "
                      f"{speed:8.1f} {jump:8.2f}",
                      flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    modes = parser.add_subparsers(dest="mode", required=True)
    a, b = modes.add_parser("fits"), modes.add_parser("plane")
    a.add_argument("campaigns", nargs="+")
    a.add_argument("--kappa", type=list_of(float), default=[0, 0.1, 0.3, 0.6, 1.2])
    a.add_argument("--seeds", type=list_of(int), default=[1, 2, 3])
    add_fit_options(a)
    b.add_argument("--kappa", type=list_of(float), default=[0, 0.6, 1.2])
    b.add_argument("--slope", type=float, default=35.0, help="[degrees]")
    b.add_argument("--length", type=float, default=1500.0, help="in plan [m]")
    b.add_argument("--blocks", type=int, default=2000, help="of each size")
    for mode in (a, b):
        add_options(mode, work="rest-study", threads=1)
    o = parser.parse_args()
    os.makedirs(o.work, exist_ok=True)
    fits(o) if o.mode == "fits" else plane(o)


if __name__ == "__main__":
    main()
