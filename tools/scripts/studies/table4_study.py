#!/usr/bin/python3
"""Which c gives the design values of the paper's Table 4? On a stand-in for its slope, for values of c from 0.1 to 1.

  tools/scripts/studies/table4_study.py [--talus build/release/talus] [--blocks 20000] [--angle 38]

The terrain of Vaujany is not published. The stand-in is the profile of data/profile: 38 degrees to a forest road 150 m
below the release, then 34, then 15. Two models on it: `talus profile` with the sets of Table 1, and `talus run` on the
same slope, 400 m wide (2 m cells, no channel), with those of Table 3. That slope has equal rows, so no patch of it has
a crease: the surface does not matter. Blocks of 1.0 to 1.4 m, 2700 kg/m3, released at rest 2 m above the ground;
screens 70 m and 140 m below the release (the paper does not give their places). v95 and h95 are of the first crossings;

    SEL = 1/2 V rho gVol (v95 gTr gDp)^2        h_i = h95 gTr gDp + 0.7 m

with V of a block of 1.4 m, gVol = gDp = 1.02 (high confidence) and gTr = 1.02 or 1.10 (the paper leaves it open). Printed: each
value with both gTr, and its difference from Table 4. --angle: another angle of the upper slope. Two minutes of one core. Results:
docs/barrier.md, "Energies and jumps for c from 0.1 to 1". Needs numpy and GDAL's python binding.
"""
import math
import tempfile
from pathlib import Path

import numpy as np
from osgeo import gdal

from files import box, read_table, write_layer, write_raster, write_text
from program import ROOT, parser_of, talus

COEFFICIENTS = (0.1, 0.15, 0.2, 0.25, 0.35, 0.5, 0.7, 1.0)
TABLE4 = {("1", "2D"): (4.02, 1070), ("1", "3D"): (4.66, 1020), ("2", "2D"): (4.16, 1150), ("2", "3D"): (4.91, 1320)}  # m, kJ
START, SCREENS, ROAD, CELL, WIDTH = 20.0, (110.0, 199.0), (212.0, 217.0), 2.0, 400.0  # m along the profile
ANGLE = 38.0  # of the upper slope of data/profile [degrees]
MASS = 2700 * math.pi / 6 * 1.4**3  # of the design block [kg]
REACH, FREEBOARD, VOLUME = (1.02 * 1.02, 1.10 * 1.02), 0.7, 1.02  # gTr gDp; half the block [m]; gVol
WEST, SOUTH = 2600000.0, 1200000.0


def first_crossings(path, screens):
    """Speeds and jump heights of the first crossing of each block, by screen."""
    seen, rows = set(), {name: [] for name in screens}
    for row in read_table(path):
        key = row["screen"], row["source"], row["block"]
        if key not in seen:
            seen.add(key)
            rows[row["screen"]].append((float(row["speed_ms"]), float(row["jump_height_m"])))
    return [np.array(rows[name]).T for name in screens]


def nodes_of(angle):
    """x and z of the profile, its upper slope (0 to 212 m) turned to another angle [degrees]."""
    nodes = np.genfromtxt(ROOT / "data/profile/slope.csv", delimiter=",", names=True)
    sunk = ROAD[0] * (math.tan(math.radians(angle)) - math.tan(math.radians(ANGLE)))
    return nodes["x"], np.where(nodes["x"] > 0, nodes["z"] - sunk, nodes["z"])


def in_2d(o, work, c):
    rows = [f"{x:.10g},{z:.10g}" for x, z in zip(*nodes_of(o.angle))]
    write_text(work / "slope.csv", "x,z\n" + "\n".join(rows) + "\n")
    write_text(
        work / "profile.toml", f'profile = "slope.csv"\ntrajectories = {o.blocks}\n[sources]\nx = {START}\nrelease_height = 2\n'
        f"[blocks]\ndiameter = [1.0, 1.4]\ndensity = 2700\n[model]\ndeformation_coefficient = {c}\n"
        f'[ground]\ndefault = "firm-talus-2d"\n[ground.zones.road]\nx = {list(ROAD)}\npreset = "forest-road-2d"\n'
        f"[screens]\nx = {list(SCREENS)}\n[output]\ntrajectories = 0\n")
    talus(o, "profile", work / "profile.toml", "-o", work / "out2", "--overwrite", "-q")
    return first_crossings(work / "out2/screens.csv", [f"{x:g}" for x in SCREENS])


def make_slope(work, angle):
    """The profile of the 2D model, drawn out across: east is down."""
    node_x, node_z = nodes_of(angle)
    columns, rows = int(node_x[-1] / CELL), int(WIDTH / CELL)
    z = np.interp((np.arange(columns) + 0.5) * CELL, node_x, node_z)
    write_raster(work / "dem.tif", np.tile(z, (rows, 1)), (WEST, SOUTH + WIDTH), CELL, kind=gdal.GDT_Float64)
    write_layer(work / "start.gpkg", [(f"POINT ({WEST + START} {SOUTH + WIDTH / 2})", "start")], [("name", str)])
    write_layer(work / "screens.gpkg", [(f"LINESTRING ({WEST + x} {SOUTH + 2},{WEST + x} {SOUTH + WIDTH - 2})", f"{x:g}")
                                        for x in SCREENS], [("id", str)])
    strips = ((ROAD[0], ROAD[1], "road"), (ROAD[1], node_x[-1], "lower"))
    write_layer(work / "zones.gpkg", [(box(WEST + a, SOUTH, WEST + b, SOUTH + WIDTH), name) for a, b, name in strips], [("zone", str)])


def in_3d(o, work, c):
    write_text(
        work / "run.toml", f'dem = "dem.tif"\ntrajectories = {o.blocks}\n[sources]\nfile = "start.gpkg"\nrelease_height = 2\n[blocks]\n'
        f"diameter = [1.0, 1.4]\ndensity = 2700\n[model]\ndeformation_coefficient = {c}\n[ground]\nfile = \"zones.gpkg\"\n"
        'field = "zone"\ndefault = "upper-talus-3d"\n[ground.zones.road]\npreset = "forest-road-3d"\n[ground.zones.lower]\n'
        'preset = "lower-talus-3d"\n[screens]\nfile = "screens.gpkg"\n[output]\ntrajectories = 0\n')
    talus(o, "run", work / "run.toml", "-o", work / "out3", "--overwrite", "-q")
    return first_crossings(work / "out3/screens.csv", [f"{x:g}" for x in SCREENS])


def design(speeds, heights):
    """v95, h95, and SEL [kJ] and h_i [m] with each gTr."""
    v95, h95 = np.percentile(speeds, 95), np.percentile(heights, 95)
    return v95, h95, [0.5e-3 * MASS * VOLUME * (v95 * r)**2 for r in REACH], [h95 * r + FREEBOARD for r in REACH]


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--blocks", type=int, default=20000)
    parser.add_argument("--angle", type=float, default=ANGLE, help="of the upper slope [degrees]: 30 to 45")
    o = parser.parse_args()
    print("screen model    c   blocks  mean v   v95    mean h   h95     SEL [kJ]: gTr 1.02, 1.10, Table 4         "
          "h_i [m]: gTr 1.02, 1.10, Table 4")
    with tempfile.TemporaryDirectory(prefix="talus-table4-") as folder:
        work = Path(folder)
        make_slope(work, o.angle)
        for model, run in (("2D", in_2d), ("3D", in_3d)):
            for c in COEFFICIENTS:
                for screen, (speeds, heights) in zip("12", run(o, work, c)):
                    v95, h95, sel, height = design(speeds, heights)
                    paper_height, paper_sel = TABLE4[screen, model]
                    print(f"{screen:>6} {model:>5} {c:5.2f} {len(speeds):7} {speeds.mean():7.2f} {v95:6.2f} {heights.mean():8.2f} "
                          f"{h95:6.2f}  " + ", ".join(f"{s:5.0f} ({100 * (s / paper_sel - 1):+3.0f} %)" for s in sel)
                          + f", {paper_sel:5}    " + ", ".join(f"{h:5.2f} ({100 * (h / paper_height - 1):+3.0f} %)" for h in height)
                          + f", {paper_height}", flush=True)


if __name__ == "__main__":
    main()
