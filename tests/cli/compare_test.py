"""talus compare: the rasters and the table against numpy, what is refused, and what is said."""
import os
import re
import shutil
import unittest

import numpy as np
from osgeo import gdal, ogr

from support import (NORTH, OPEN_RUN, WEST, KeptRuns, OneThread, RunCase, band_names, bands_of, heights, system, write_dem)

RASTERS = ["annual_frequency", "energy", "hazard_class", "impact_probability", "jump_height", "reach_probability", "velocity"]


def values_of(path):
    """All bands as float64, NaN where there is no value."""
    file = gdal.Open(path)
    values = file.ReadAsArray().astype(float).reshape(file.RasterCount, file.RasterYSize, file.RasterXSize)
    values[values == file.GetRasterBand(1).GetNoDataValue()] = np.nan
    return values


class Compare(KeptRuns, OneThread, RunCase):
    def setUp(self):
        super().setUp()
        self.write("s.toml", OPEN_RUN)

    def keep_run(self, out, *more, hazard=()):
        self.keep(out, ["run", self.path("s.toml"), "-o", self.path(out), "-q", *more],
                  ["hazard", self.path(out), "-q", *hazard])

    def two_runs(self):
        self.keep_run("a")
        self.keep_run("b", "--deformation-coefficient", "0.1")

    def compare(self, *folders, out="c", more=()):
        return self.run_well("compare", *map(self.path, folders), "-o", self.path(out), *more)

    def refused(self, *words, folders=("a", "b"), more=(), out="refused"):
        before = sorted(os.listdir(self.folder))
        self.fails(2, *words, arguments=["compare", *map(self.path, folders), "-o", self.path(out), *more])
        self.assert_nothing_left(before)

    def figures(self, out="c"):
        return {(row["table"], row["name"], row["quantity"]): row for row in self.read_table(out + "/compare.csv")}

    def test_a_folder_in_a_run_is_refused(self):
        self.keep_run("a")
        self.fails(2, "lies in", "give a folder beside it",
                   arguments=["compare", self.path("a"), self.path("a"), "-o", self.path("a/c")])
        self.assertFalse(os.path.exists(self.path("a/c")))

    def test_a_run_with_itself(self):
        self.keep_run("a")
        self.compare("a", "a")
        self.assertIn("is the same folder as", self.read_text("c/compare.md"))
        found = sorted(name for name in os.listdir(self.path("c")) if name.endswith(".tif"))
        self.assertEqual(found, sorted(kind + name + ".tif" for kind in ("highest_", "change_") for name in RASTERS))
        for name in RASTERS:
            one, highest = gdal.Open(self.path(f"a/{name}.tif")), gdal.Open(self.path(f"c/highest_{name}.tif"))
            self.assertEqual(band_names(self.path(f"a/{name}.tif")), band_names(self.path(f"c/highest_{name}.tif")))
            for band in range(1, one.RasterCount + 1):
                of_one, of_highest = one.GetRasterBand(band), highest.GetRasterBand(band)
                self.assertEqual(of_one.ReadRaster(), of_highest.ReadRaster(), name)
                self.assertEqual(of_one.GetUnitType(), of_highest.GetUnitType())
                self.assertEqual(of_one.DataType, of_highest.DataType)
            change = values_of(self.path(f"c/change_{name}.tif"))
            self.assertEqual(set(change[~np.isnan(change)]), {0.0}, name)
            self.assertEqual(self.read_text(f"a/{name}.qml"), self.read_text(f"c/highest_{name}.qml"))
        for row in self.read_table("c/compare.csv"):
            self.assertIn(row["table"], ("run", "raster", "screen"))  # no setting differs
            self.assertEqual(row["A"], row["B"])
            if "only" in row["quantity"] or "worse" in row["quantity"]:
                self.assertEqual(row["A"], "0", row)
            if row["B - A"]:
                self.assertEqual(row["B - A"], "0", row)

    def test_two_runs_as_numpy_compares_them(self):
        self.two_runs()
        said = self.compare("a", "b", more=["--rasters", ",".join([*RASTERS, "return_period_30", "intensity_T300",
                                                                  "energy_exceedance", "passage_density"])])
        figures = self.figures()
        for name in (*RASTERS, "return_period_30", "intensity_T300", "energy_exceedance", "passage_density"):
            a, b = values_of(self.path(f"a/{name}.tif")), values_of(self.path(f"b/{name}.tif"))
            lowest = name.startswith("return_period")
            worst = values_of(self.path(f"c/{'lowest' if lowest else 'highest'}_{name}.tif"))
            wanted = np.fmin(a, b) if lowest else np.fmax(a, b)
            names = band_names(self.path(f"a/{name}.tif"))
            if "undecided" in names:
                wanted[names.index("undecided")][~np.isnan(wanted[0])] = (wanted[1] < wanted[2])[~np.isnan(wanted[0])]
            np.testing.assert_array_equal(worst, wanted, name)
            change = values_of(self.path(f"c/change_{name}.tif"))
            values = [i for i, band in enumerate(names) if "bound" not in band and band not in ("undecided", "cut short")]
            apart = names[1:3] == ["lower 95 % bound", "upper 95 % bound"]
            self.assertEqual(band_names(self.path(f"c/change_{name}.tif")),
                             ["change of " + names[i] for i in values] + (["bounds apart"] if apart else []))
            for to, i in enumerate(values):
                difference = b[i] - a[i] if lowest else np.nan_to_num(b[i]) - np.nan_to_num(a[i])
                if not lowest:
                    difference[np.isnan(a[i]) & np.isnan(b[i])] = np.nan
                np.testing.assert_array_equal(change[to], np.float32(difference), name)
            shown = values[2] if name in ("energy", "velocity", "jump_height") else values[0]
            in_a, in_b = ((~np.isnan(of[shown]) if name in ("energy", "velocity", "jump_height") else np.nan_to_num(of[shown]) > 0)
                          for of in (a, b))
            only, all_runs = figures["raster", name, "cells only this run reaches"], figures["raster", name, "cells all runs reach"]
            self.assertEqual([only["A"], only["B"]], [str((in_a & ~in_b).sum()), str((in_b & ~in_a).sum())], name)
            self.assertEqual(all_runs["A"], str((in_a & in_b).sum()))
            mean = next(row for key, row in figures.items() if key[1] == name and key[2].startswith("mean of "))
            for run, of in (("A", a), ("B", b)):
                self.assertAlmostEqual(float(mean[run]) / of[shown][in_a & in_b].mean(), 1.0, delta=2e-5)
            if apart:
                open_end = (lambda of: np.where(np.isnan(of), np.inf, of)) if lowest else (lambda of: of)
                a_worse = open_end(a[2]) < open_end(b[1]) if lowest else a[1] > b[2]
                b_worse = open_end(b[2]) < open_end(a[1]) if lowest else b[1] > a[2]
                worse = figures["raster", name, "cells where this run is surely worse"]
                self.assertEqual([worse["A"], worse["B"]], [str(a_worse.sum()), str(b_worse.sum())], name)
                np.testing.assert_array_equal(change[-1] == 1, a_worse | b_worse, name)
        self.assertGreater(int(figures["raster", "energy", "cells only this run reaches"]["B"]), 0)
        self.assertGreater(int(figures["raster", "impact_probability", "cells where this run is surely worse"]["B"]), 0)
        self.assertIn("| energy ", said.stdout)
        self.assertEqual(said.stdout, self.read_text("c/compare.md"))

    def test_settings_and_screens(self):
        self.two_runs()
        self.compare("a", "b")
        figures = self.figures()
        self.assertEqual([key for key in figures if key[0] == "setting"], [("setting", "model.deformation_coefficient", "")])
        row = figures["setting", "model.deformation_coefficient", ""]
        self.assertEqual([row["A"], row["B"]], ["0.25", "0.1"])
        for quantity, of, column in (("share of the released blocks that cross", "energy", "share_of_released"),
                                     ("translational energy, P95 of the crossings", "energy", "p95"),
                                     ("jump height, P95 of the crossings", "jump height", "p95")):
            row = figures["screen", "road", quantity]
            for run in ("A", "B"):
                summary = [one for one in self.read_table(f"{run.lower()}/screens_summary.csv") if one["quantity"] == of]
                self.assertEqual(row[run], summary[0][column])
            self.assertAlmostEqual(float(row["B - A"]), float(row["B"]) - float(row["A"]), delta=1e-4)

    def test_a_pair_made_by_hand(self):
        self.two_runs()
        a, b = (np.full((60, 60), -9999.0, np.float32) for _ in range(2))
        a[10, 20:24] = 5, 0, 7, 9
        b[10, 20:24] = 8, 2, -9999, 4
        for run, values in (("a", a), ("b", b)):
            file = gdal.Open(self.path(run + "/energy.tif"), gdal.GA_Update)
            for band in range(1, 6):
                file.GetRasterBand(band).WriteArray(values)
            file = None
        self.compare("a", "b", more=["--rasters", "energy", "-q"])
        self.assertEqual(bands_of(self.path("c/highest_energy.tif"))[2, 10, 19:25].tolist(), [-9999, 8, 2, 7, 9, -9999])
        self.assertEqual(bands_of(self.path("c/change_energy.tif"))[2, 10, 19:25].tolist(), [-9999, 3, 2, -7, -5, -9999])
        figures = self.figures()
        self.assertEqual(figures["raster", "energy", "cells only this run reaches"]["A"], "1")
        self.assertEqual(figures["raster", "energy", "cells all runs reach"]["A"], "3")
        row = figures["raster", "energy", "mean of P95 there"]
        self.assertEqual([row["A"], row["B"]], ["4.66667", "4.66667"])

    def test_three_runs(self):
        self.two_runs()
        self.keep_run("d", "--seed", "7")
        done = self.compare("a", "b", "d", more=["--rasters", "impact_probability"])
        self.assertEqual([name for name in os.listdir(self.path("c")) if name.startswith("change_")], [])
        wanted = np.fmax.reduce([values_of(self.path(run + "/impact_probability.tif")) for run in "abd"])
        np.testing.assert_array_equal(values_of(self.path("c/highest_impact_probability.tif")), wanted)
        self.assertEqual(list(self.read_table("c/compare.csv")[0]), ["table", "name", "quantity", "unit", "A", "B", "C"])
        self.assertIn("different seeds", done.stdout)
        self.assertEqual(self.figures()["setting", "seed", ""]["C"], "7")

    def test_files_styles_and_project(self):
        self.two_runs()
        self.compare("a", "b", more=["-q", "--threads", "1"])
        names = set(os.listdir(self.path("c")))
        record = self.read_json("c/compare.json")
        self.assertEqual(names, {*record["files"], "compare.json"})
        self.assertEqual(record["runs"], [self.path("a"), self.path("b")])
        project = self.read_text("c/talus.qgs")
        shown = set(re.findall(r"<datasource>\./(.*?)</datasource>", project))
        self.assertEqual(shown, {name for name in names if name.endswith(".tif")})
        for name in names:
            if name.endswith(".tif"):
                self.assertIn(name[:-4] + ".qml", names)
                info = gdal.Open(self.path("c/" + name))
                self.assertEqual(info.GetMetadata("IMAGE_STRUCTURE")["LAYOUT"], "COG", name)
                self.assertEqual(info.GetGeoTransform(), (WEST, 5.0, 0.0, NORTH, 0.0, -5.0))
                self.assertIn("2056", info.GetProjection())
        self.compare("a", "b", out="again", more=["-q", "--threads", "4"])
        for name in names - {"compare.json"}:
            with open(self.path("c/" + name), "rb") as one, open(self.path("again/" + name), "rb") as other:
                self.assertEqual(one.read(), other.read(), name)

    def test_overwrite_replaces_comparisons_alone(self):
        self.two_runs()
        self.compare("a", "b", more=["-q"])
        self.refused("the folder is there and not empty", out="c")
        self.compare("a", "b", more=["-q", "--overwrite", "--rasters", "energy"])
        self.assertNotIn("change_velocity.tif", os.listdir(self.path("c")))
        self.refused("holds results of talus run", folders=("b", "b"), out="a", more=["--overwrite"])
        self.write("c/notes.txt", "mine")
        self.refused("notes.txt", out="c", more=["--overwrite"])
        os.remove(self.path("c/notes.txt"))
        self.fails(2, "holds results of talus compare", arguments=[
            "run", self.path("s.toml"), "-o", self.path("c"), "--overwrite", "-q"])

    def test_what_is_refused(self):
        self.two_runs()
        self.refused("no folder of results", folders=("a", "nothing"))
        self.refused("'passages' is no raster that can be compared", more=["--rasters", "passages"])
        self.refused("did you mean 'energy'", more=["--rasters", "enrgy"])
        self.keep_run("w", hazard=["--width", "10"])
        self.refused("w/hazard_class.tif", "another title", folders=("a", "w"))
        self.refused("w/annual_frequency.tif", "other bands", "of an object 10 m wide", folders=("a", "w"),
                     more=["--rasters", "annual_frequency"])
        self.write("m.toml", "years = [30, 100, 500]")
        self.keep_run("m", hazard=["--matrix", self.path("m.toml")])
        self.refused("m/hazard_class.tif", "another matrix", "--matrix", folders=("a", "m"))
        self.refused("a: has no intensity_T500", folders=("a", "m"), more=["--rasters", "intensity_T500"])
        self.keep("t", ["run", self.path("s.toml"), "-o", self.path("t"), "-q", "--thresholds", "30,200"])
        self.refused("t/energy_exceedance.tif", "other bands", "`P(E > 200 kJ)`", folders=("a", "t"),
                     more=["--rasters", "energy_exceedance"])
        shutil.copytree(self.path("a"), self.path("s"))
        gdal.Translate(self.path("s/energy.tif"), self.path("a/energy.tif"), srcWin=[0, 0, 30, 60])
        self.refused("s/energy.tif", "has 30 x 60 cells, must have those of the run, 60 x 60", folders=("a", "s"))
        self.keep("p", ["run", self.path("s.toml"), "-o", self.path("p"), "-q", "--part", "1/2"])
        self.refused("is one part of a run", folders=("a", "p"))

    def test_other_grids_are_refused(self):
        self.keep_run("a")
        for name, z, cell, code, west, words in (
                ("size", heights(rows=59), 5.0, 2056, WEST, ["another grid", "60 x 59 cells of 5 x 5 m", "there 60 x 60 cells"]),
                ("cell", heights(cell=4.0), 4.0, 2056, WEST, ["60 x 60 cells of 4 x 4 m"]),
                ("place", heights(), 5.0, 2056, WEST + 5, ["from west 2600005"]),
                ("system", heights(), 5.0, 21781, WEST, ["another coordinate system", "EPSG:21781", "EPSG:2056"])):
            write_dem(self.path("other.tif"), z, transform=(west, cell, 0.0, NORTH, 0.0, -cell), code=code)
            file = ogr.GetDriverByName("GPKG").CreateDataSource(self.path("other.gpkg"))
            layer = file.CreateLayer("sources", system(code), ogr.wkbPoint)
            feature = ogr.Feature(layer.GetLayerDefn())
            feature.SetGeometry(ogr.CreateGeometryFromWkt(f"POINT ({west + 120} {NORTH - 60})"))
            layer.CreateFeature(feature)
            layer = file = None
            self.run_well("run", "--dem", self.path("other.tif"), "--sources", self.path("other.gpkg"), "--diameter", "0.8",
                          "--trajectories", "5", "-o", self.path(name), "-q")
            self.refused(self.path(name), *words, folders=("a", name))

    def test_another_weighting_is_said(self):
        for name in ("a", "b"):
            self.keep(name, ["run", self.path("s.toml"), "-o", self.path(name), "-q", "--trajectories", "10"])
        self.run_well("hazard", self.path("a"), "-q")
        weights = self.write("w.toml", "[frequency]\ntotal = 50\n")
        self.run_well("hazard", self.path("b"), "-q", "--frequency", weights)
        text = self.compare("a", "b").stdout
        self.assertRegex(text, r"talus hazard --frequency +\| +\| +\| +\| " + weights)
        self.assertRegex(text, r"events of the hazard +\| +\| 1/year +\| 0.52 +\| 50")

    def test_what_is_said(self):
        self.keep_run("a")
        self.keep("b", ["run", self.path("s.toml"), "-o", self.path("b"), "-q", "--trajectories", "20", "--seed", "3"])
        text = self.compare("a", "b").stdout
        for words in ("annual_frequency.tif is not compared", self.path("b") + " has none (talus run or talus hazard makes it)",
                      "different numbers of blocks", "different seeds"):
            self.assertIn(words, text)
        z = heights()
        z[5, 5] += 0.5
        write_dem(self.path("dem.tif"), z)
        self.run_scenario("other")
        record = self.read_text("other/run.json").replace('"status": "complete"', '"status": "too many trajectories ended at a limit"')
        self.write("other/run.json", record)
        text = self.compare("a", "other", out="d").stdout
        self.assertIn("different contents of the input `dem`", text)
        self.assertIn('other: has results with the status "too many trajectories ended at a limit"', text)
        self.assertIn("share random numbers", text)

    def test_records_that_are_damaged(self):
        self.two_runs()
        good = self.read_text("b/run.json")
        for wrong in ("[]", "{}", good.replace('"settings": [', '"settings": [3, '), good[:200]):
            self.write("b/run.json", wrong)
            self.refused("b/run.json: cannot be understood")
        self.write("b/run.json", good)
        hazard = self.read_text("b/hazard.json")
        for wrong in ("3", hazard[:100]):
            self.write("b/hazard.json", wrong)
            self.refused("b/hazard.json: cannot be understood")


if __name__ == "__main__":
    unittest.main()
