#!/usr/bin/python3
"""How many blocks do the berms of a pit keep, by the size of the cells and the direction of the grid? And with a bund?

  tools/scripts/studies/pit_study.py [--talus build/release/talus] [--work build/pit] [-o table.csv]
                                     [--cells 0.25,0.5,1,2] [--directions 0,30,45] [--blocks 4000] [--threads 1]

The pit is invented: four faces 15 m high at 70 degrees, berms 8 m wide between them, level above and below, straight along the
strike. Heights are taken at the centres of the cells. Blocks of 0.3 to 1 m start 0.2 m above the faces, from 80 m of their length;
quarry-face-2d with psi_scale 0.6 on the faces, quarry-floor-2d with psi_scale 0.3 elsewhere.

Rows: the profile (step 0.1 m); the profile with its toes, or its edges, cut by a chord 1 m long in plan, or with c = 0.15
(docs/barrier.md, "The value of c"); DEMs by cells and direction (of the fall, from the grid's east); a bund on each berm (1.5 m
high, flanks 1:1, its outer foot at the edge), in profiles and DEMs; a [barriers] line of the height of the bund along its crest,
through which nothing breaks.

Columns: percent of the blocks of a face that rest between its crest and the outer edge of its berm, with the half-width of the
binomial 95 % interval; percent of the top face's blocks that rest on the floor; distance from the lowest toe within which 95 % of
the lowest face's blocks rest. --work keeps the runs: CELL-DIRECTION-FORM has out/stops.gpkg and berms.gpkg.

Half a minute of one core. Results: docs/pits.md.
Needs numpy and GDAL's python binding (Debian: python3-numpy python3-gdal).
"""
import math
import os
import sys

import numpy as np

from files import features, read_table, write_layer, write_raster, write_table, write_text
from program import list_of, parser_of, talus

HEIGHT, BERM = 15.0, 8.0                 # of a face, and width of a berm [m]
SLOPE = math.tan(math.radians(70.0))     # of a face
CRESTS = [40.0 + i * (HEIGHT / SLOPE + BERM) for i in range(4)]  # of the faces, along the fall [m]
TOES = [crest + HEIGHT / SLOPE for crest in CRESTS]
TOP = 600.0                              # height above the pit [m]
BUND = 1.5                               # height of a bund, and distance of its crest from the edge [m]
SIDE = 240.0                             # of the DEM [m]; its middle is 70 m along the fall
WEST, SOUTH = 2600000.0, 1200000.0       # of the DEM, EPSG:2056 [m]
HEAD = ("terrain", "cells (m)", "grid (deg)", "berm 1 keeps (%)", "berm 2 keeps (%)", "berm 3 keeps (%)", "face 1 to floor (%)",
        "P95 beyond toe (m)")


def nodes(form=""):
    """Places along the fall and heights of the profile. form: "", "bund", or what is cut: "toes" or "edges"."""
    toe, edge = (0.5 if form == cut else 0.0 for cut in ("toes", "edges"))
    found = [(0.0, TOP)]
    for i, (crest, foot) in enumerate(zip(CRESTS, TOES)):
        high, low = TOP - i * HEIGHT, TOP - (i + 1) * HEIGHT
        if form == "bund" and i > 0:
            found += [(crest - 2 * BUND, high), (crest - BUND, high + BUND)]
        found += [(crest - edge, high), (crest + edge, high - edge * SLOPE)] if edge else [(crest, high)]
        found += [(foot - toe, low + toe * SLOPE), (foot + toe, low)] if toe else [(foot, low)]
    return found + [(SIDE, found[-1][1])]


class Place:
    """Map coordinates of places along and across the fall, which is turned from the east by degrees."""

    def __init__(self, degrees):
        self.along = np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees))])
        self.across = np.array([-self.along[1], self.along[0]])
        self.origin = np.array([WEST + SIDE / 2, SOUTH + SIDE / 2]) - 70.0 * self.along

    def fall(self, x, y):
        """Distance along the fall."""
        return (x - self.origin[0]) * self.along[0] + (y - self.origin[1]) * self.along[1]

    def points(self, pairs):
        """Points (along, across) as the text of a WKT."""
        return ", ".join("{:.4f} {:.4f}".format(*(self.origin + u * self.along + v * self.across)) for u, v in pairs)

    def box(self, start, end, half):
        return f"POLYGON (({self.points([(start, -half), (end, -half), (end, half), (start, half), (start, -half)])}))"

    def line(self, at, half):
        return f"LINESTRING ({self.points([(at, -half), (at, half)])})"


def write_pit(folder, place, cell, form):
    """The DEM, the faces, the zones, the berms with their faces, and the line of the barriers."""
    number = round(SIDE / cell)
    x = WEST + (np.arange(number)[None, :] + 0.5) * cell
    y = SOUTH + SIDE - (np.arange(number)[:, None] + 0.5) * cell
    heights = np.interp(place.fall(x, y), *np.transpose(nodes("bund" if form == "bund" else "")))
    write_raster(f"{folder}/dem.tif", heights, (WEST, SOUTH + SIDE), cell)
    faces = list(zip(CRESTS, TOES))
    write_layer(f"{folder}/faces.gpkg", [(place.box(*face, 40), f"face {i}") for i, face in enumerate(faces, 1)], [("name", str)])
    write_layer(f"{folder}/zones.gpkg", [(place.box(*face, 200), "face") for face in faces], [("zone", str)])
    benches = zip(CRESTS[:-1], CRESTS[1:])
    write_layer(f"{folder}/berms.gpkg", [(place.box(*bench, 200), f"berm {i}") for i, bench in enumerate(benches, 1)], [("name", str)])
    lines = [(place.line(crest - BUND, 80), f"berm {i}", BUND, math.inf) for i, crest in enumerate(CRESTS[1:], 1)]
    write_layer(f"{folder}/lines.gpkg", lines, [("id", str), ("height", float), ("capacity", float)])


def scenario(trajectories, form):
    text = (f'dem = "dem.tif"\ntrajectories = {trajectories}\n[sources]\nfile = "faces.gpkg"\nrelease_height = 0.2\n'
            '[blocks]\ndiameter = [0.3, 1.0]\n[ground]\nfile = "zones.gpkg"\n'
            '[ground.zones.face]\npreset = "quarry-face-2d"\npsi_scale = 0.6\n'
            '[ground.zones.default]\npreset = "quarry-floor-2d"\npsi_scale = 0.3\n[output]\ntrajectories = 0\n')
    return text + ('[barriers]\nfile = "lines.gpkg"\n' if form == "barrier" else "")


def of_dem(o, cell, degrees, form=""):
    """Places of rest along the fall, of the blocks of each face."""
    folder, place = f"{o.work}/{cell:g}-{degrees:g}-{form or 'plain'}", Place(degrees)
    os.makedirs(folder, exist_ok=True)
    write_pit(folder, place, cell, form)
    cells = 80.0 * HEIGHT / SLOPE / cell ** 2  # of a face
    write_text(f"{folder}/pit.toml", scenario(max(1, round(o.blocks / cells)), form))
    talus(o, "run", f"{folder}/pit.toml", "-o", f"{folder}/out", "--overwrite", "-q", "--threads", o.threads)
    rests = {f"face {i}": [] for i in range(1, 5)}
    for stop in features(f"{folder}/out/stops.gpkg"):
        if stop["end"] == "left":
            sys.exit(f"{folder}: a block left the DEM")
        rests[stop["feature"]].append(place.fall(stop.geometry().GetX(), stop.geometry().GetY()))
    return [np.array(found) for found in rests.values()]


def of_profile(o, form="", c=0.25):
    """Places of rest along the profile, of the blocks of each face. c: of the deformation energy; 0.25 is the program's."""
    folder, rests = f"{o.work}/profile-{form or 'plain'}-{c:g}", []
    os.makedirs(folder, exist_ok=True)
    write_table(f"{folder}/pit.csv", "x,z", [(f"{x:.3f}", f"{z:.3f}") for x, z in nodes(form)])
    zones = ", ".join(f"[{crest:.3f}, {toe:.3f}]" for crest, toe in zip(CRESTS, TOES))
    for i, (crest, toe) in enumerate(zip(CRESTS, TOES), 1):
        write_text(f"{folder}/face{i}.toml",
                   f'profile = "pit.csv"\nstep = 0.1\ntrajectories = {o.blocks}\n[sources]\nx = [{crest:.3f}, {toe:.3f}]\n'
                   'release_height = 0.2\n[blocks]\ndiameter = [0.3, 1.0]\n[ground]\ndefault = "quarry-floor-2d"\n'
                   f'[ground.zones.face]\npreset = "quarry-face-2d"\nx = [{zones}]\n[output]\ntrajectories = 0\n'
                   f'[model]\ndeformation_coefficient = {c}\n')
        talus(o, "profile", f"{folder}/face{i}.toml", "-o", f"{folder}/out{i}", "--overwrite", "-q", "--threads", o.threads)
        rests.append(np.array([float(row["x"]) for row in read_table(f"{folder}/out{i}/stops.csv")]))
    return rests


def row(rests):
    """The last five columns of the table."""
    found = []
    for crest, edge, rest in zip(CRESTS, CRESTS[1:], rests):
        share = np.mean((rest >= crest) & (rest < edge))
        found.append(f"{100 * share:.1f} +- {196 * math.sqrt(share * (1 - share) / len(rest)):.1f}")
    return [*found, f"{100 * np.mean(rests[0] > TOES[-1]):.1f}", f"{np.percentile(rests[-1], 95) - TOES[-1]:.1f}"]


def rows(o):
    yield ["profile", "", "", *row(of_profile(o))]
    yield ["profile, toes cut", "", "", *row(of_profile(o, "toes"))]
    yield ["profile, edges cut", "", "", *row(of_profile(o, "edges"))]
    yield ["profile, c = 0.15", "", "", *row(of_profile(o, c=0.15))]
    for cell in o.cells:
        for degrees in o.directions:
            yield ["DEM", f"{cell:g}", f"{degrees:g}", *row(of_dem(o, cell, degrees))]
    yield ["profile, bund", "", "", *row(of_profile(o, "bund"))]
    yield ["profile, bund, c = 0.15", "", "", *row(of_profile(o, "bund", 0.15))]
    for cell in o.cells:
        yield ["DEM, bund", f"{cell:g}", f"{o.directions[0]:g}", *row(of_dem(o, cell, o.directions[0], "bund"))]
    yield ["DEM, barrier line", f"{o.cells[0]:g}", f"{o.directions[0]:g}", *row(of_dem(o, o.cells[0], o.directions[0], "barrier"))]


def main():
    parser = parser_of(__doc__, work="build/pit", threads=1)
    parser.add_argument("-o", "--out", help="the table as CSV")
    parser.add_argument("--cells", type=list_of(float), default="0.25,0.5,1,2", help="[m]")
    parser.add_argument("--directions", type=list_of(float), default="0,30,45", help="[deg]")
    parser.add_argument("--blocks", type=int, default=4000, help="of each face, at least")
    o = parser.parse_args()
    print("| " + " | ".join(HEAD) + " |\n|" + " --- |" * len(HEAD))
    table = []
    for cells in rows(o):
        table.append(cells)
        print("| " + " | ".join(cells) + " |", flush=True)
    if o.out:
        write_table(o.out, ",".join(HEAD), table)


main()
