#!/usr/bin/python3
"""Do blocks stop in gullies because of the surface between cell centres? Bilinear against creased patches.

  tools/scripts/studies/gully_study.py [--talus build/release/talus] [--terrain ../shared/data/terrain] [TABLE ...]

Tables (all where none is named; `terrain` needs --terrain):
  v          a V gully (floor 35 degrees, walls 45) at 0, 20 and 45 degrees to the grid, thalweg through cell centres
             and half a cell beside, cells of 5, 2 and 1 m: share of 200 blocks that stop within 300 m
  steep      the same gully, cells of 5 m: share that stops within 300 m, and share that stays, also farther down, in
             cells counted as steep gullies
  round      a gully with a round bottom (radius of two cells and of four) at 0 to 45 degrees, 1000 blocks
  staircase  slope from cell to cell down the thalweg of the sampled V at 20 degrees
  terrain    gar, alr, mal: stops in dammed cells (lower than the four neighbours, higher than a diagonal one), how
             many of them where the ground is steeper than 15 degrees (half of phi), in true pits, path lengths and
             run-outs; from every n-th source cell of `talus sources`

A block counts as stopped unless it passes; the gully is long enough that none leaves the terrain before. Blocks of
1 m start 1 m above the thalweg, on the default ground (upper-talus-3d, phi 30 degrees). A minute of one core, with
`terrain` some minutes. Results: docs/physics.md, "Creases" and "Steep gullies".
Needs numpy and GDAL's python binding (Debian: python3-numpy python3-gdal).
"""
import tempfile
from pathlib import Path

import numpy as np
from osgeo import gdal, ogr

from files import features, read_bands, read_json, system, write_layer, write_raster
from program import parser_of, talus

SURFACES = ("bilinear", "creased")
LENGTH, BEFORE, SIDE = 300.0, 20.0, 60.0  # m: of the way, above the release, and on both sides of the thalweg


def point(x, y):
    return (f"POINT ({x!r} {y!r})",)


def v_profile(_cell):
    return lambda n: np.abs(n)


def round_profile(radius):
    """A circle that turns into walls of 45 degrees."""
    edge = radius * np.sqrt(0.5)
    return lambda n: np.where(np.abs(n) < edge, radius - np.sqrt(np.maximum(radius ** 2 - n ** 2, 0.0)),
                              radius - edge + np.abs(n) - edge)


class Gully:
    """A straight gully: height -tan(35 deg) s + section(n), s along and n across the thalweg."""

    def __init__(self, cell, degrees, offset, section):
        self.cell, angle = cell, np.radians(degrees)
        self.way = np.array([np.cos(angle), np.sin(angle)])
        size = LENGTH + 2 * BEFORE + 10 * cell
        corner = np.array([SIDE, SIDE])
        extent = corner + size * self.way + SIDE
        self.columns, self.rows = (np.ceil(extent / cell)).astype(int)
        self.start = (np.floor(corner / cell) + 0.5) * cell + np.array([0.0, offset * cell])  # on the thalweg
        x = (np.arange(self.columns) + 0.5) * cell
        y = (np.arange(self.rows)[::-1] + 0.5) * cell
        dx, dy = np.meshgrid(x - self.start[0], y - self.start[1])
        along, across = dx * self.way[0] + dy * self.way[1], dy * self.way[0] - dx * self.way[1]
        self.heights = 1000.0 - np.tan(np.radians(35.0)) * along + section(across)

    def stopped(self, o, work, surface, blocks):
        """Share of blocks that do not pass LENGTH."""
        dem, points, out = work / "dem.tif", work / "points.gpkg", work / "out"
        crs, place = system(31287), 4e5 + self.start  # the lower-left corner is (0, 0) + 400 km
        write_raster(dem, self.heights, (4e5, 4e5 + self.rows * self.cell), self.cell, srs=crs)
        write_layer(points, [point(*place)], srs=crs)
        run(o, ["--dem", dem, "--sources", points, "--diameter", 1, "--trajectories", blocks, "--surface", surface], out)
        ends = [(f.GetField("end"), f.geometry().GetX(), f.geometry().GetY()) for f in features(out / "stops.gpkg")]
        along = [(np.array([x, y]) - place) @ self.way for end, x, y in ends if end != "left"]
        return sum(a < LENGTH for a in along) / len(ends)


def run(o, options, out):
    talus(o, "run", *options, "-o", out, "--overwrite", "-q", *(["--threads", o.threads] if o.threads else []))


def table(head, rows):
    print("| " + " | ".join(head) + " |\n|" + " --- |" * len(head))
    for row in rows:
        print("| " + " | ".join(row) + " |", flush=True)
    print()


def percent(share):
    return f"{100 * share:.1f} %"


def v_table(o, work):
    def rows():
        for cell in (5, 2, 1):
            for degrees in (0, 20, 45):
                for offset, name in ((0.0, "through centres"), (0.5, "half a cell beside")):
                    gully = Gully(cell, degrees, offset, v_profile(cell))
                    yield [f"{cell} m", f"{degrees}", name] + [percent(gully.stopped(o, work, s, 200)) for s in SURFACES]
    table(["cell", "degrees", "thalweg", *SURFACES], rows())


def steep_table(o, work):
    def rows():
        for degrees in (0, 10, 20, 30, 45):
            stopped = Gully(5, degrees, 0.0, v_profile(5)).stopped(o, work, "creased", 200)
            record = read_json(work / "out" / "run.json")
            yield [f"{degrees}", percent(stopped), percent(record["steep_gullies"]["blocks"] / 200)]
    table(["degrees", "stop within 300 m", "stay in steep gullies"], rows())


def round_table(o, work):
    def rows():
        for cell in (5, 2):
            for radius in (2, 4):
                for degrees in (0, 10, 20, 30, 45):
                    gully = Gully(cell, degrees, 0.0, round_profile(radius * cell))
                    yield [f"{cell} m", f"{radius} cells", f"{degrees}"] + [percent(gully.stopped(o, work, s, 1000))
                                                                        for s in SURFACES]
    table(["cell", "radius", "degrees", *SURFACES], rows())


def staircase_table(_o, _work):
    """Steepest descent from cell to cell (eight neighbours) along the sampled thalweg."""
    def rows():
        for degrees in (0, 10, 20, 30, 45):
            for name, section in (("V", v_profile(5)), ("round, 2 cells", round_profile(10.0)),
                                  ("round, 4 cells", round_profile(20.0))):
                steps = descent(Gully(5, degrees, 0.0, section))
                flat = float((steps < 30.0).mean())
                yield [f"{degrees}", name, f"{steps.min():.1f}", f"{steps.max():.1f}", percent(flat)]
    table(["degrees", "bottom", "flattest step [deg]", "steepest [deg]", "steps below 30 deg"], rows())


def descent(gully):
    """Slopes of the steps of steepest descent down the gully, in degrees; a pit counts as 0."""
    z = gully.heights.astype("f4").astype(float)
    row, column = gully.rows - 1 - int(gully.start[1] // gully.cell), int(gully.start[0] // gully.cell)
    steps = []
    while 1 < row < gully.rows - 2 and 1 < column < gully.columns - 2 and len(steps) * gully.cell < LENGTH:
        best = max(((z[row, column] - z[row + i, column + j]) / (gully.cell * np.hypot(i, j)), i, j)
                   for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j)
        steps.append(np.degrees(np.arctan(max(best[0], 0.0))))
        if best[0] <= 0.0:
            break
        row, column = row + best[1], column + best[2]
    return np.array(steps)


def neighbours(z):
    """Heights to the north, south, west and east of each inner cell; to the north-west, north-east, south-west, south-east."""
    return ([z[:-2, 1:-1], z[2:, 1:-1], z[1:-1, :-2], z[1:-1, 2:]], [z[:-2, :-2], z[:-2, 2:], z[2:, :-2], z[2:, 2:]])


def cells_of(z):
    """Masks of the dammed cells and of the true pits."""
    c = z[1:-1, 1:-1]
    sides, corners = neighbours(z)
    low = np.logical_and.reduce([c < s for s in sides])
    dammed, pits = low & np.logical_or.reduce([s < c for s in corners]), low & np.logical_and.reduce([c < s for s in corners])
    return np.pad(dammed, 1), np.pad(pits, 1)


def steep_cells(z, cell):
    """Mask of the cells whose slope by Horn is above half of phi, 15 degrees."""
    (north, south, west, east), (nw, ne, sw, se) = neighbours(z)
    rise_x, rise_y = (ne + 2 * east + se) - (nw + 2 * west + sw), (nw + 2 * north + ne) - (sw + 2 * south + se)
    return np.pad(np.hypot(rise_x, rise_y) / (8 * cell) > np.tan(np.radians(15.0)), 1)


def terrain_table(o, work):
    def rows():
        for name in ("gar", "alr", "mal"):
            dem = Path(o.terrain) / f"{name}.tif"
            points = every_nth_source(o, work, dem)
            transform = gdal.Open(str(dem)).GetGeoTransform()
            z = read_bands(dem)[0]
            dammed, pits = cells_of(z)
            steep = steep_cells(z, transform[1])
            before = None
            for surface in SURFACES:
                out = work / f"out_{name}_{surface}"
                run(o, ["--dem", dem, "--sources", points, "--diameter", 1, "--trajectories", o.trajectories,
                        "--surface", surface], out)
                values = terrain_values(out, transform, dammed, pits, steep)
                change = "" if before is None else [f" ({100 * (v / b - 1):+.1f} %)" for v, b in
                                                    zip(values["lengths"], before["lengths"])]
                yield [name, surface, f"{values['released']}", percent(values["stopped"]), percent(values["dammed"]),
                       percent(values["steep"]), percent(values["pits"])] + [
                           f"{v:.0f}{c}" for v, c in zip(values["lengths"], change or [""] * 4)]
                before = values
    table(["terrain", "surface", "blocks", "stopped", "of them in dammed cells", "of these above 15 degrees",
           "in true pits", "mean path [m]", "run-out: mean [m]", "median [m]", "95 % [m]"], rows())


def every_nth_source(o, work, dem):
    cells, points = work / "cells.gpkg", work / "points.gpkg"
    cells.unlink(missing_ok=True)
    talus(o, "sources", "--dem", dem, "-o", cells, "-q")
    file = ogr.Open(str(cells))
    (layer,) = [la for la in (file.GetLayer(i) for i in range(file.GetLayerCount())) if la.GetGeomType() == ogr.wkbPoint]
    places = [point(f.geometry().GetX(), f.geometry().GetY()) for f in layer]
    write_layer(points, places[::max(1, len(places) // o.sources)], srs=layer.GetSpatialRef())
    return points


def terrain_values(out, transform, dammed, pits, steep):
    west, width, _, north, _, height = transform
    rows = [(f.GetField("end"), f.geometry().GetX(), f.geometry().GetY(), f.GetField("x_release"), f.GetField("y_release"),
             f.GetField("length_m")) for f in features(out / "stops.gpkg")]
    x, y, x0, y0, length = np.array([r[1:] for r in rows]).T
    stopped = np.array([r[0] in ("stopped", "trapped") for r in rows])
    column, row = ((x - west) // width).astype(int)[stopped], ((y - north) // height).astype(int)[stopped]
    runout = np.hypot(x - x0, y - y0)
    return {"released": len(rows), "stopped": stopped.mean(), "dammed": dammed[row, column].mean(),
            "steep": steep[row, column][dammed[row, column]].mean(), "pits": pits[row, column].mean(),
            "lengths": (length.mean(), runout.mean(), np.median(runout), np.quantile(runout, 0.95))}


TABLES = {"v": v_table, "steep": steep_table, "round": round_table, "staircase": staircase_table, "terrain": terrain_table}


def main():
    parser = parser_of(__doc__, threads=0)
    parser.add_argument("tables", nargs="*", metavar="TABLE", help=", ".join(TABLES))
    parser.add_argument("--terrain", help="folder of gar.tif, alr.tif, mal.tif")
    parser.add_argument("--sources", type=int, default=2000, help="source cells of a terrain")
    parser.add_argument("--trajectories", type=int, default=8, help="per source cell of a terrain")
    o = parser.parse_args()
    for name in o.tables or [t for t in TABLES if t != "terrain" or o.terrain]:
        if name not in TABLES or (name == "terrain" and not o.terrain):
            parser.error(f"{name}: must be one of {', '.join(TABLES)}; terrain needs --terrain")
        with tempfile.TemporaryDirectory() as work:
            TABLES[name](o, Path(work))


if __name__ == "__main__":
    main()
