#!/usr/bin/python3
"""Does Talus agree with an independent implementation of the same model, which steps in time? Compares their results.

  tools/scripts/checks/compare_reference.py --talus build/release/talus --data ../shared/data [--threads 1] [--trials-factor 1]
      [--surface bilinear] [SCENE ...]

Each scene's sources, ground and screens are written as a scenario, `talus run` is started, its results are compared:

* Quantiles 5, 25, 50, 75, 95 % of speed, jump height and spin at every screen (all crossings), and of x, y and runout
  (plan distance from the release) of *stopped* trajectories (Talus: stopped or trapped); for `slope` also source by source. Allowed: the larger of
  4 % of the reference's 5-95 % range and 3 combined bootstrap standard errors (200 draws of either sample; rows are
  drawn as if independent: nearly every trajectory crosses once, and the sources of a group are fixed, not sampled).
  Groups of under 1 000 rows in the reference are printed, not judged.
* Ends: the shares stopped, left, caught (and limit, which the reference does not have) within 1 % of the released.
* Cells (`slope`, `gar`) where the reference counts over 50: the correlation of trajectories per cell (and of those
  above the energy threshold, where the reference has them) above 0.98. Passages show no systematic sign, there and from
  a count of 500: mean relative difference below the larger of 2 % and 3 standard errors (bootstrap of 16 x 16 tiles).
  Choosing cells by the reference's own noisy count puts this mean 0.2 % (`slope`) to 0.8 % (`gar`) below zero.

Printed, not judged (verdict `-`): ratios of sums; `corner loss`, the share of passages that the reference should miss
(it notes the cell at the end of a step only: chords shorter than a step, step / (4 cell) for paths of all directions);
crossings, path length, impacts per trajectory; the rasters of `plane` (its path is the edge of two columns: added).

Exit code 0: all passed; 1: some judged item failed (a failed run or a missing file is one); 2: usage.
The reference has bilinear patches, so that the runs have them, too; --surface creased shows what creases change.
With --trials-factor below 1 the shares and cells may fail by chance.
Some minutes. Results: docs/validation.md, "An independent implementation".
"""
import argparse
import json
import subprocess
import sys
import tempfile
import tomllib
from collections import namedtuple
from pathlib import Path

import numpy as np
from osgeo import gdal

ROOT = Path(__file__).resolve().parents[3]
SCENES = ("plane", "slope", "gar")
QUANTILES = (0.05, 0.25, 0.50, 0.75, 0.95)
MIN_ROWS, DRAWS, TILE = 1000, 200, 16
RANGE_LIMIT, SHARE_LIMIT, SIGN_LIMIT, CORRELATION_LIMIT = 4.0, 1.0, 2.0, 2.0  # %; the last: of 1 - correlation
LONGEST_STEP = 0.003  # s, of the reference
UPPER_TALUS_3D = {"theta_scale": 1.0, "psi_scale": 0.9, "En50": 15, "Et50": 50, "phi": 30, "shape": [1.0, 1.5]}
AT_REST = ("stopped", "trapped")  # ends of Talus that the reference calls stopped
SCREEN_COLUMNS = {"speed": "speed_ms", "jump": "jump_height_m", "omega": "angular_velocity_rads"}
SOURCE_COLUMNS = ("id AS name, CAST(diameter_m AS float) AS diameter, CAST(release_height_m AS float) AS release_height,"
                  " CAST(vx AS float) AS vx, CAST(vy AS float) AS vy, CAST(vz AS float) AS vz")

# difference and allowed in % (of the 5-95 % range, the released, the count); allowed = None: not judged
Row = namedtuple("Row", "scene group quantity n_ref n_talus of ref talus difference allowed", defaults=(None, None))


def verdict(row):
    return "-" if row.allowed is None else "ok" if abs(row.difference) <= row.allowed else "FAIL"  # NaN fails


class Scene:
    """The declared inputs of one reference scene."""

    def __init__(self, data, name):
        self.name, self.folder = name, data / "reference" / name
        self.dem = (data / "terrain/gar.tif" if name == "gar" else self.folder / "dem.tif").resolve()
        self.model = tomllib.loads((self.folder / "model.toml").read_text())
        self.has_screens = (self.folder / "screens.csv").exists()
        self.sources = read_columns(self.folder / "sources.csv")
        (self.trials,) = np.unique(self.sources["trajectories"])
        (self.density,) = np.unique(self.sources["density_kgm3"])


def write_layer(path, scene, table, columns):
    """A GeoPackage in the DEM's CRS from one of the scene's CSVs (x, y or wkt)."""
    path.unlink(missing_ok=True)
    dem, places = gdal.Open(str(scene.dem)), ["X_POSSIBLE_NAMES=x", "Y_POSSIBLE_NAMES=y", "GEOM_POSSIBLE_NAMES=wkt"]
    gdal.VectorTranslate(str(path), gdal.OpenEx(str(scene.folder / table), open_options=places), format="GPKG",
                         layerName=path.stem, dstSRS=dem.GetProjection(), reproject=False,
                         SQLStatement=f"SELECT {columns} FROM {path.stem}")


def ground_lines(scene, work):
    """[ground]: the scene's zone raster; without one the preset, or where its values differ a raster of one zone."""
    lines, zones, raster = ["[ground]", 'default = "upper-talus-3d"'], scene.model["zone"], scene.folder / "zones.tif"
    if not raster.exists():
        (values,) = zones.values()
        if values == UPPER_TALUS_3D:
            return lines
        zones, raster = {"1": values}, work / "zones.tif"
        gdal.Translate(str(raster), str(scene.dem), outputType=gdal.GDT_Byte, noData="none",
                       scaleParams=[[-1e9, 1e9, 1, 1]])
    lines.append(f'file = "{raster.resolve()}"')
    for code, values in zones.items():
        lines += [f"[ground.zones.{code}]"] + [f"{key} = {value}" for key, value in values.items()]
    return lines


def run_talus(scene, work, options):
    """Writes the inputs and runs Talus; raises RuntimeError with Talus's own message."""
    trajectories = max(1, round(scene.trials * options.trials_factor))
    work.mkdir(parents=True, exist_ok=True)
    write_layer(work / "sources.gpkg", scene, "sources.csv", SOURCE_COLUMNS)
    model = scene.model
    lines = [f'dem = "{scene.dem}"', "seed = 1", f"trajectories = {trajectories}", "[sources]", 'file = "sources.gpkg"',
             "[blocks]", f"density = {scene.density}", *ground_lines(scene, work),
             "[model]", f"deformation_coefficient = {model['deformation_coefficient']}",
             f'roughness = "{model["roughness"]}"',
             "[output]", f"energy_thresholds = [{model['energy_threshold_kj']}]", "trajectories = 0"]
    if scene.has_screens:
        write_layer(work / "screens.gpkg", scene, "screens.csv", "id")
        lines += ["[screens]", 'file = "screens.gpkg"']
    (work / "scenario.toml").write_text("\n".join(lines) + "\n")
    done = subprocess.run([str(options.talus.resolve()), "run", "scenario.toml", "-o", "out", "--overwrite",
                           "--surface", options.surface, "--threads", str(options.threads), "-q"], cwd=work, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"talus run ended with {done.returncode}: {done.stderr.strip()}")


def read_columns(path):
    return np.atleast_1d(np.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding="utf-8"))


def read_band(path):
    """Band 1 as floats, 0 where there is no data."""
    dataset = gdal.Open(str(path))
    values, nodata = dataset.ReadAsArray(band_list=[1]).astype(float), dataset.GetRasterBand(1).GetNoDataValue()
    return np.where(np.isnan(values) | (values == nodata), 0, values)


def read_stops(path):
    """x, y, source and end of every trajectory."""
    dataset = gdal.OpenEx(str(path), gdal.OF_VECTOR)
    rows = [(f.geometry().GetX(), f.geometry().GetY(), f["source"], f["end"]) for f in dataset.GetLayer(0)]
    return np.rec.fromrecords(rows, names="x,y,source,end")


def runout(scene, stops, source, names):
    """Plan distance from the release; names: what `source` calls the sources, in the order of the features."""
    if len(names) != len(scene.sources):
        raise ValueError(f"{len(names)} sources in the stops, {len(scene.sources)} in the scenario")
    place = {name: complex(s["x"], s["y"]) for name, s in zip(names, scene.sources)}
    return np.abs(stops["x"] + 1j * stops["y"] - np.array([place[name] for name in source]))


def compare_quantiles(scene, group, quantity, ref, talus):
    if ref.size < 2:
        return []
    generator = np.random.default_rng(1)
    expected = np.quantile(ref, QUANTILES)
    unit = 100 / (expected[-1] - expected[0])
    found, variance = np.full(len(QUANTILES), np.nan), np.zeros(len(QUANTILES))
    if talus.size > 1:
        found = np.quantile(talus, QUANTILES)
        for sample in (ref, talus):
            draws = sample[generator.integers(0, sample.size, (DRAWS, sample.size))]
            variance += np.quantile(draws, QUANTILES, axis=1).var(axis=1, ddof=1)
    allowed = np.maximum(RANGE_LIMIT, 3 * unit * np.sqrt(variance))
    return [Row(scene.name, group, quantity, ref.size, talus.size, f"{q:.0%}", a, b, unit * (b - a),
                limit if ref.size >= MIN_ROWS else None)
            for q, a, b, limit in zip(QUANTILES, expected, found, allowed)]


def compare_points(scene, out, ref, stops):
    """Screens and stops: all sources together, in `slope` also one by one."""
    if scene.has_screens:
        ref_screens, screens = read_columns(scene.folder / "passages.csv.gz"), read_columns(out / "screens.csv")
    ids, numbers = scene.sources["id"], np.unique(stops["source"])
    places = {name: (ref[name], stops[name]) for name in ("x", "y")}
    places["runout"] = runout(scene, ref, ref["block"], ids), runout(scene, stops, stops["source"], numbers)
    rows, groups = [], [("", None, None)]
    if scene.name == "slope":
        groups += [(" " + name, name, number) for name, number in zip(ids, numbers)]
    for suffix, block, number in groups:
        in_ref, in_talus = (not suffix) | (ref["block"] == block), (not suffix) | (stops["source"] == number)
        for screen in np.unique(ref_screens["screen"]) if scene.has_screens else ():
            a = (ref_screens["screen"] == screen) & ((not suffix) | (ref_screens["block"] == block))
            b = (screens["screen"] == screen) & ((not suffix) | (screens["source"] == number))
            crossings = a.sum() / in_ref.sum(), b.sum() / in_talus.sum()
            rows.append(Row(scene.name, screen + suffix, "crossings", a.sum(), b.sum(), "mean", *crossings))
            for name, column in SCREEN_COLUMNS.items():
                rows += compare_quantiles(scene, screen + suffix, name, ref_screens[name][a], screens[column][b])
        a, b = in_ref & (ref["stopped"] == 1), in_talus & np.isin(stops["end"], AT_REST)
        for name, (of_ref, of_talus) in places.items():
            rows += compare_quantiles(scene, "stops" + suffix, name, of_ref[a], of_talus[b])
    return rows


def compare_ends(scene, out, ref, stops):
    """How trajectories end; path length and impacts from run.json; what the reference should lose at corners."""
    sizes, terrain = (ref["x"].size, stops["x"].size), gdal.Open(str(scene.dem))
    rows, record = [], json.loads((out / "run.json").read_text())
    for end in ("stopped", "left", "caught", "limit"):
        ours = AT_REST if end == "stopped" else (end,)
        a, b = ref[end].mean() if end in ref.dtype.names else 0.0, np.isin(stops["end"], ours).mean()
        rows.append(Row(scene.name, "ends", end, *sizes, "share", a, b, 100 * (b - a), SHARE_LIMIT))
    for key, column in (("trajectory_metres", "length"), ("impacts", "impacts")):
        a, b = ref[column].mean(), record[key] / sizes[1]
        rows.append(Row(scene.name, "paths", column, *sizes, "mean", a, b, 100 * (b / a - 1)))
    loss = LONGEST_STEP * ref["length"].sum() / ref["seconds"].sum() / (4 * terrain.GetGeoTransform()[1])
    return rows + [Row(scene.name, "cells", "corner loss", *sizes, "bound", 0, loss, 100 * loss)]


def tile_error(values, cells):
    """The standard error of the mean of values at cells (rows, columns), from a bootstrap of tiles."""
    _, tile = np.unique(np.stack([cells[0] // TILE, cells[1] // TILE]), axis=1, return_inverse=True)
    sums, sizes = np.bincount(tile, values), np.bincount(tile)
    draws = np.random.default_rng(1).integers(0, sums.size, (DRAWS, sums.size))
    return (sums[draws].sum(axis=1) / sizes[draws].sum(axis=1)).std(ddof=1)


def compare_cells(scene, quantity, ref, talus, scale):
    """Counts per cell; scale: Talus's trajectories for one of the reference's."""
    if ref.shape != talus.shape:
        raise ValueError(f"{quantity}: the grid is {talus.shape}, the reference's {ref.shape}")
    rows, judged = [], scene.name != "plane"
    if not judged:
        ref, talus = ref.sum(axis=1, keepdims=True), talus.sum(axis=1, keepdims=True)
    for group, chosen in (("cells all", ref >= 0), ("cells >50", ref > 50), ("cells >=500", ref >= 500)):
        a, b = scale * ref[chosen], talus[chosen]
        ratio = b.sum() / a.sum()
        results = [("ratio", 1, ratio, 100 * (ratio - 1), None)]
        if judged and group != "cells all":
            mean, error = (b / a).mean() - 1, tile_error(b / a, np.nonzero(chosen))
            limit = max(SIGN_LIMIT, 300 * error) if quantity == "passages" else None
            results.append(("sign", 0, mean, 100 * mean, limit))
        if judged and group == "cells >50":
            correlation = np.corrcoef(a, b)[0, 1]
            results.append(("corr", 1, correlation, 100 * (1 - correlation), CORRELATION_LIMIT))
        rows += [Row(scene.name, group, quantity, (a > 0).sum(), (b > 0).sum(), *result) for result in results]
    return rows


def compare_scene(scene, out):
    ref, stops = read_columns(scene.folder / "stops.csv.gz"), read_stops(out / "stops.gpkg")
    rows = compare_points(scene, out, ref, stops) + compare_ends(scene, out, ref, stops)
    for quantity, reference, result, factor in (("passages", "counts.tif", "passages.tif", 1),
                                                ("exceed", "exceed.tif", "energy_exceedance.tif", stops["x"].size)):
        if (scene.folder / reference).exists():
            rows += compare_cells(scene, quantity, read_band(scene.folder / reference),
                                  factor * read_band(out / result), stops["x"].size / ref["x"].size)
    return rows


def print_rows(rows):
    for row in rows:
        values = [f"{v:.2f}" if abs(v) > 1e4 else f"{v:.5g}" for v in (row.ref, row.talus)]
        values += ["" if v is None else f"{v:.2f}" for v in (row.difference, row.allowed)]
        print(f"{row.scene:6} {row.group:11} {row.quantity:11} {row.n_ref:7} {row.n_talus:7} {row.of:>6}",
              "{:>11} {:>11} {:>8} {:>8}".format(*values), verdict(row), flush=True)


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--talus", type=Path, default=ROOT / "build/release/talus")
    parser.add_argument("--data", type=Path, default=ROOT / "../shared/data")
    parser.add_argument("--work", type=Path, help="keep scenarios and results here (default: a temporary folder)")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--trials-factor", type=float, default=1.0, help="times the reference's trajectories")
    parser.add_argument("--surface", default="bilinear", help="of the terrain: bilinear, as that of the reference, or creased")
    parser.add_argument("--json", type=Path, help="write the table here, too")
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help="of " + ", ".join(SCENES) + " (default: all)")
    options = parser.parse_args()
    if not set(options.scenes) <= set(SCENES):
        parser.error("SCENE is one of " + ", ".join(SCENES))
    return options


def main():
    options, rows = parse_arguments(), []
    gdal.UseExceptions()
    print("scene  group       quantity      n_ref n_talus     of         ref       talus   diff %  allowed verdict")
    with tempfile.TemporaryDirectory(prefix="talus-reference-") as temporary:
        for name in options.scenes or SCENES:
            scene, work = Scene(options.data, name), (options.work or Path(temporary)) / name
            try:
                run_talus(scene, work, options)
                found = compare_scene(scene, work / "out")
            except (RuntimeError, OSError, KeyError, ValueError) as problem:
                print(f"# {name}: {type(problem).__name__}: {problem}")
                found = [Row(name, "run", "", 0, 0, "", np.nan, np.nan, np.nan, 0)]
            rows += found
            print_rows(found)
    judged = sum(row.allowed is not None for row in rows)
    failed = sum(verdict(row) == "FAIL" for row in rows)
    if options.json:
        table = [row._asdict() | {"verdict": verdict(row)} for row in rows]
        options.json.write_text(json.dumps({"judged": judged, "failed": failed, "rows": table},
                                           default=lambda number: number.item()) + "\n")
    print(f"reference: {judged} judged, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
