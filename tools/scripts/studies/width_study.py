#!/usr/bin/python3
"""Does the hazard of an object of some width depend on the size of the cells? The valley at cells of 1, 2 and 5 m.

  tools/scripts/studies/width_study.py [--talus build/release/talus] [--work DIR] [--width 10] [--trajectories 25]
                   [--points 4] [--objects 400] [--own-terrain] [-o width_study.png]

The terrain is that of data/valley: its surface, bilinear between the centres of its 4 m cells, read at the centres of
cells of 5 m; the surface between these is then read at the centres of the cells of each grid. So the grids of 1 m and 5 m have
the same surface (each patch of 1 m lies in one of 5 m), and that of 2 m nearly so; with `--own-terrain` each grid reads the
valley itself, and the coarser is smoother. The runs have bilinear patches: creases would lie elsewhere on each grid. The blocks
start at the same points on each grid: `--points` release points of each source cell of the valley, as point sources, each
with its share of the frequency of its cliff. Each run is repeated with another seed: that is the noise to compare with.
Places are the centres of the 5 m cells (within 0.7 m on the others) that blocks reach.

Table 1, with --width and without: how many of these places have the same class on two maps; the same of those where the
class is decided on both (band 4 of hazard_class.tif is 0); of those of class low or higher on one of them, and of the whole map,
with `none` and `residual` taken as one (`residual` is any passage rarer than all years of the matrix: more blocks always find
further such places); the frequency of passages and of passages above 300 kJ, as a ratio of the means over all places, and the
spread of the differences in units of the standard errors (1 is noise alone). Table 2: against `--objects`, discs of that width at
`--objects` random places: the map against all hits, and above 300 kJ against the energy where the block enters the disc and the
largest while it touches it.
Some minutes. Results: docs/hazard.md, "Tests of the width". Needs python3-numpy, python3-gdal; with -o python3-matplotlib.
"""
import math
import tempfile
from pathlib import Path

import numpy as np
from osgeo import gdal

from files import features, read_bands, read_json, read_table, write_layer, write_raster
from program import ROOT, parser_of, talus

VALLEY = ROOT / "data/valley"
CELLS = (1, 2, 5)
SEEDS = (1, 2)
SCENARIO = """dem = "dem.tif"
surface = "bilinear"
seed = {seed}
trajectories = {trajectories}
[sources]
file = "../points.gpkg"
release_height = [0.5, 2.0]
[blocks]
density = 2700
[ground]
file = "{valley}/zones.gpkg"
field = "zone"
default = "upper-talus-3d"
[ground.zones.cliff]
preset = "upper-talus-3d"
theta_scale = 0.8
[ground.zones.talus]
preset = "upper-talus-3d"
[ground.zones.road]
preset = "forest-road-3d"
[ground.zones.meadow]
preset = "lower-talus-3d"
theta_scale = 0.7
[output]
energy_thresholds = [30, 300]
height_thresholds = [2]
trajectories = 0
"""


def read_between(z, size, cell):
    """The bilinear surface between the centres of cells of one size, at the centres of cells of another."""
    rows, columns = (int(n * size / cell) for n in z.shape)
    v, u = ((np.arange(n) + 0.5) * cell / size - 0.5 for n in (rows, columns))
    r, c = (np.clip(a.astype(int), 0, n - 2) for a, n in ((v, z.shape[0]), (u, z.shape[1])))
    q, p = np.clip(v - r, 0, 1)[:, None], np.clip(u - c, 0, 1)[None, :]
    at = lambda dr, dc: z[np.ix_(r + dr, c + dc)]
    return (1 - q) * ((1 - p) * at(0, 0) + p * at(0, 1)) + q * ((1 - p) * at(1, 0) + p * at(1, 1))


def write_dem(folder, cell, own_terrain):
    ds = gdal.Open(str(VALLEY / "dem.tif"))
    west, size, _, north, _, _ = ds.GetGeoTransform()
    (z,) = read_bands(VALLEY / "dem.tif")
    out = read_between(z, size, cell) if own_terrain else read_between(read_between(z, size, 5), 5, cell)
    write_raster(folder / "dem.tif", np.where(np.isnan(out), -9999, out), (west, north), cell, srs=ds.GetSpatialRef(), nodata=-9999)


def write_points(o):
    """Release points of the valley's own run, `--points` of each source cell, with frequency and diameters."""
    cliffs = {f["name"]: (f["frequency"], f["diameter_m"], f["diameter_1"]) for f in features(VALLEY / "cliffs.shp")}
    run(o, VALLEY / "scenario.toml", o.work / "base", "--trajectories", o.points)
    released = [(f["feature"], f["x_release"], f["y_release"]) for f in features(o.work / "base" / "stops.gpkg")]
    count = {name: sum(name == n for n, _, _ in released) for name in cliffs}
    shapes = []
    for name, x, y in released:
        frequency, low, high = cliffs[name]
        shapes.append((f"POINT ({x!r} {y!r})", frequency / count[name], low, high))
    write_layer(o.work / "points.gpkg", shapes, [(name, float) for name in ("frequency", "diameter_min", "diameter_max")])


def run(o, scenario, out, *more):
    if not (out / "run.json").exists():
        talus(o, "run", scenario, "-o", out, "-q", *more)


def make_runs(o):
    for cell in CELLS:
        folder = o.work / f"cell{cell}"
        folder.mkdir(exist_ok=True)
        write_dem(folder, cell, o.own_terrain)
        for seed in SEEDS:
            scenario = folder / f"seed{seed}.toml"
            scenario.write_text(SCENARIO.format(seed=seed, trajectories=o.trajectories, valley=VALLEY))
            run(o, scenario, folder / f"seed{seed}")


def at_places(a, cell):
    """Values at the centres of the 5 m cells."""
    centres = lambda n: ((np.arange(n) + 0.5) * 5 / cell).astype(int)
    return a[np.ix_(centres(208), centres(240))]


class Maps:
    """Class, frequency and standard error at the places, of one run, for an object of some width or for the cell."""

    def __init__(self, o, cell, seed, width, *more):
        out = o.work / f"cell{cell}" / f"seed{seed}"
        options = ["--width", width] if width else []
        talus(o, "hazard", out, "-q", "--overwrite", *options, *more)
        self.out = out
        classes = read_bands(out / "hazard_class.tif")
        self.classes, self.decided = at_places(classes[0], cell), at_places(classes[3], cell) == 0
        self.value, self.error = [], []
        for name, invert in (("annual_frequency", False), ("return_period_300", True)):
            value, low, high = (at_places(band, cell) for band in read_bands(out / f"{name}.tif")[:3])
            if invert:
                value, low, high = (np.nan_to_num(1 / a) for a in (value, high, low))
            self.value.append(value)
            self.error.append((high - low) / 3.92)


def same_but_for_residual(one, other):
    """Share of the same class, `none` and `residual` as one: of the places above these, their number, and the whole map."""
    c, d = np.maximum(one.classes, 1), np.maximum(other.classes, 1)  # NaN stays
    hazard, known = (c > 1) | (d > 1), np.isfinite(c) & np.isfinite(d)
    return np.mean((c == d)[hazard]), int(hazard.sum()), np.mean((c == d)[known])


def compare(one, other):
    """Share of the reached places with the same class, and by quantity the ratio of means and the spread."""
    reached = (one.classes > 0) | (other.classes > 0)
    same, decided = one.classes == other.classes, reached & one.decided & other.decided
    figures = [np.mean(same[reached]), int(reached.sum()), np.mean(same[decided]), int(decided.sum()),
               *same_but_for_residual(one, other)]
    for quantity in range(2):
        f, g = one.value[quantity], other.value[quantity]
        e = np.hypot(one.error[quantity], other.error[quantity])
        often = reached & (f + g > 0) & (f > 4 * one.error[quantity]) & (g > 4 * other.error[quantity])
        figures += [f[reached].mean() / g[reached].mean(), float(np.std((f - g)[often] / e[often]))]
    return figures


def print_comparisons(o):
    kept = {}
    for width in (o.width, 0):
        maps = {(cell, seed): Maps(o, cell, seed, width) for cell in CELLS for seed in SEEDS}
        kept[width] = maps
        print(f"\n| {'object of %g m' % width if width else 'the cell as object'} | same class | places | same where decided | places "
              "| low or higher | places | whole map, residual as none | frequency: ratio | spread | above 300 kJ: ratio | spread |\n"
              + "| --- " * 12 + "|")
        pairs = [((a, 1), (b, 1)) for a, b in ((1, 2), (2, 5), (1, 5))] + [((c, 1), (c, 2)) for c in CELLS]
        for (a, s), (b, t) in pairs:
            same, places, sure, told, low, lows, whole, ratio, spread, ratio300, spread300 = compare(maps[a, s], maps[b, t])
            what = f"{a} m and {b} m" if a != b else f"{a} m, two seeds"
            print(f"| {what} | {100 * same:.1f} % | {places} | {100 * sure:.1f} % | {told} | {100 * low:.1f} % | {lows} | "
                  f"{100 * whole:.1f} % | {ratio:.3f} | {spread:.2f} | {ratio300:.3f} | {spread300:.2f} |")
    return kept


def write_discs(o, maps):
    """Discs of the width at random places that are hit, drawn from the frequent to the rare."""
    rng = np.random.default_rng(1)
    rows, columns = np.nonzero(maps[5, 1].value[0] > 1e-3)
    found = []
    for i in rng.permutation(rows.size)[:o.objects]:
        x, y = 2650000 + 5 * (columns[i] + 0.5), 1171040 - 5 * (rows[i] + 0.5)
        ring = ",".join(f"{x + o.width / 2 * math.cos(a):.4f} {y + o.width / 2 * math.sin(a):.4f}" for a in np.linspace(0, 2 * math.pi, 65))
        found.append((f"POLYGON(({ring}))", f"disc {i}", (rows[i], columns[i])))
    write_layer(o.work / "discs.gpkg", [f[:2] for f in found], [("name", str)])
    return [f[2] for f in found]


def objects_of(out):
    number = lambda row, key: float(row[key] or "nan")
    return [[(number(r, k), (number(r, k + "_upper") - number(r, k + "_lower")) / 3.92) for k in ("frequency", "entry_300", "frequency_300")]
            for r in read_table(out / "objects.csv")]


def print_objects(o, maps):
    places = write_discs(o, maps)
    print("\n| objects against the map | objects | hits: ratio of the sums | spread | above 300 kJ at entry: ratio | spread "
          "| above 300 kJ at most: ratio | spread |\n| --- | --- | --- | --- | --- | --- | --- | --- |")
    for cell in CELLS:
        here = Maps(o, cell, 1, o.width, "--objects", o.work / "discs.gpkg")
        hit, line = objects_of(here.out), []
        for quantity, column in ((0, 0), (1, 1), (1, 2)):
            pairs = [(here.value[quantity][p], h[column][0], h[column][1]) for p, h in zip(places, hit)]
            m, f, e = np.transpose([p for p in pairs if np.isfinite(p).all()])
            line += [m.sum() / f.sum(), float(np.sqrt(np.mean(((m - f) / e)[f > 0] ** 2)))]
        print(f"| discs of {o.width:g} m, cells of {cell} m | {len(places)} | "
              + " | ".join(f"{ratio:.3f} | {spread:.2f}" for ratio, spread in zip(line[::2], line[1::2])) + " |")


def draw(o, kept):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.colors import ListedColormap
    colours = ListedColormap(["#ffffff", "#fff9c4", "#ffd600", "#2979ff", "#d50000"])
    figure, axes = plt.subplots(2, 3, figsize=(13, 8))
    for line, (width, maps) in zip(axes, kept.items()):
        for ax, cell in zip(line, CELLS):
            ax.imshow(np.nan_to_num(maps[cell, 1].classes), cmap=colours, vmin=-0.5, vmax=4.5, interpolation="nearest")
            ax.set_title(f"cells of {cell} m, " + (f"object of {width:g} m" if width else "the cell as object"))
            ax.axis("off")
    figure.tight_layout()
    figure.savefig(o.out, dpi=80)


def main():
    ap = parser_of(__doc__, work=Path(tempfile.gettempdir()) / "width_study")
    ap.add_argument("--width", type=float, default=10)
    ap.add_argument("--trajectories", type=int, default=25)
    ap.add_argument("--points", type=int, default=4)
    ap.add_argument("--objects", type=int, default=400)
    ap.add_argument("--own-terrain", action="store_true", help="each grid reads the 4 m terrain itself")
    ap.add_argument("-o", "--out")
    o = ap.parse_args()
    o.work.mkdir(parents=True, exist_ok=True)
    write_points(o)
    make_runs(o)
    for cell in CELLS:
        record = read_json(o.work / f"cell{cell}" / "seed1" / "run.json")
        print(f"{cell} m: {record['released']} blocks, {record['trajectory_metres_plan'] / record['released']:.1f} m in plan each, "
              f"ends {record['ends']}")
    kept = print_comparisons(o)
    print_objects(o, kept[o.width])
    if o.out:
        draw(o, kept)


main()
