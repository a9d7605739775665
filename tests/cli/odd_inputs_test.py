"""Odd inputs: names that make files, counts that do not fit, rasters that hold no heights, forged files of results."""
import gzip
import hashlib
import json
import os
import resource
import struct
import subprocess
import sys
import unittest

import numpy as np
from osgeo import gdal, ogr

from support import (NORTH, TALUS, WEST, Case, KeptRuns, OneThread, RunCase, box, heights, rows_of, system,
                     write_dem, write_features)

BARRIER_PICTURE = os.path.join(os.path.dirname(__file__), "../../tools/scripts/figures/barrier_picture.py")
# Draws the pictures of several screens, p0.png and so on, in one process: matplotlib is long in starting.
PICTURES = """import runpy, sys
picture, folder, *names = sys.argv[1:]
for i, name in enumerate(names):
    sys.argv = [picture, folder + "/out", "-o", f"{folder}/p{i}.png", "--screen", name]
    runpy.run_path(picture, run_name="__main__")
"""


class NamesOfFiles(OneThread, Case):
    def screens(self, *ids):
        line = "LINESTRING (2600000 {0},2600300 {0})"
        write_features(self.path("screens.gpkg"), "screens",
                       [(line.format(1200100 + i), [name]) for i, name in enumerate(ids)], [("id", ogr.OFTString)])
        self.write("s.toml", 'dem = "dem.tif"\ntrajectories = 40\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 0.8\n'
                             '[screens]\nfile = "screens.gpkg"\n')
        self.run_well("run", self.path("s.toml"), "-o", self.path("out"), "-q")

    def files_of(self, screen):
        """The names of the files that `talus barrier` adds for a screen."""
        before = set(os.listdir(self.path("out")))
        self.run_well("barrier", self.path("out"), "--screen", screen, "-q")
        return sorted(set(os.listdir(self.path("out"))) - before)

    def test_each_screen_has_files_of_its_own(self):
        ids = ["a/b", "a_b", "A_b", "..", "__", "road", "L123 km 4,2", "Straße"]
        self.screens(*ids)
        files = {name: self.files_of(name) for name in ids}
        self.assertEqual({len(found) for found in files.values()}, {4}, files)  # none replaced those of another
        self.assertEqual(len({f.lower() for found in files.values() for f in found}), 4 * len(ids))
        for name, plain in (("road", "road"), ("L123 km 4,2", "L123_km_4_2"), ("Straße", "Straße")):  # names as ever
            self.assertEqual(files[name], sorted(f"barrier_{plain}{end}" for end in (".csv", ".gpkg", ".json", "_stretches.csv")))
        digits = hashlib.sha256(b"a/b").hexdigest()[:8]
        self.assertIn(f"barrier_a_b-{digits}.json", files["a/b"])
        for name, found in files.items():
            self.assertEqual(self.read_json("out/" + next(f for f in found if f.endswith(".json")))["screen"], name)

    def test_long_ids(self):
        ids = ["x" * 300 + "1", "x" * 300 + "2", "ü" * 100]
        self.screens(*ids)
        for name in ids:
            self.assertEqual(len(self.files_of(name)), 4)
        self.assertTrue(all(len(os.fsencode(name)) < 160 for name in os.listdir(self.path("out"))))

    def test_ids_that_cannot_be_told_apart(self):
        digits = hashlib.sha256(b"a/b").hexdigest()[:8]
        self.screens("a/b", "a_b", f"a_b-{digits}")
        self.fails(2, "'a/b'", "one name", "another id", arguments=["barrier", self.path("out"), "--screen", "a/b"])

    def test_a_layer_of_the_user_is_not_replaced(self):  # earlier builds wrote no .gpkg beside a design
        self.screens("road")
        self.files_of("road")
        write_features(self.path("out/barrier_road.gpkg"), "mine", [("POINT (2600000 1200000)", [])])
        self.fails(2, "barrier_road.gpkg", "was not written by talus barrier", "move it", arguments=["barrier", self.path("out"), "--screen", "road"])
        self.assertEqual(len(rows_of(self.path("out/barrier_road.gpkg"), "mine")), 1)

    def test_no_id(self):
        self.screens("", "road")
        self.fails(2, "must say at which of the screens", "1, road", arguments=["barrier", self.path("out")])

    def test_blanks_around_an_id_do_not_count(self):  # talus barrier said that no block crosses the line
        self.screens("road ", "\tpath")
        self.assertEqual([screen["id"] for screen in self.record()["screens"]], ["road", "path"])
        for name in ("road", "path"):
            self.assertEqual(len(self.files_of(name)), 4)
        self.fails(2, "the run has no screen 'road '; did you mean 'road'?",
                   arguments=["barrier", self.path("out"), "--screen", "road "])

    def test_texts_in_another_encoding(self):  # run.json and screens.csv had different names
        self.screens("road")
        table = 'wkt,{}\n"LINESTRING (2600000 1200100,2600300 1200100)",Stra\xdfe\n'
        for column, flag in (("id", "--screens"), ("name", "--sources")):
            with open(self.path("l.csv"), "w", encoding="latin-1") as file:
                file.write(table.format(column))
            self.fails(2, f"l.csv: row 1 below the header: field {column} = 'Stra\\xdfe' is not in UTF-8, must be",
                       arguments=["check", self.path("s.toml"), flag, self.path("l.csv")])

    def test_the_picture_finds_the_files(self):
        ids = ["a/b", "a_b", "L123 km 4,2"]
        self.screens(*ids)
        draw = [sys.executable, "-c", PICTURES, BARRIER_PICTURE, self.folder]
        done = subprocess.run([*draw, ids[0]], capture_output=True, text=True)
        if "No module named 'matplotlib'" in done.stderr:
            self.skipTest("no matplotlib")
        self.assertIn("run talus barrier", done.stderr)
        for name in ids:
            self.files_of(name)
        done = subprocess.run([*draw, *ids], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        for i in range(len(ids)):
            self.assertTrue(os.path.exists(self.path(f"p{i}.png")), i)


class Elevations(OneThread, Case):
    """DEMs that are known to be wrong."""

    def dem(self, place="2600000.0, 5.0, 0.0, 1200300.0, 0.0, -5.0", band=""):
        crs = system(2056).ExportToWkt().replace('"', "&quot;")
        self.write("d.vrt", f'<VRTDataset rasterXSize="60" rasterYSize="60"><SRS>{crs}</SRS><GeoTransform>{place}</GeoTransform>'
                            f'<VRTRasterBand dataType="Float32" band="1">{band}<SimpleSource>'
                            '<SourceFilename relativeToVRT="1">dem.tif</SourceFilename><SourceBand>1</SourceBand>'
                            "</SimpleSource></VRTRasterBand></VRTDataset>")
        return ["check", "--dem", self.path("d.vrt"), "--sources", self.path("sources.gpkg"), "--diameter", "0.8",
                "--trajectories", "5"]

    def test_no_place_on_the_earth(self):
        for place, word in (("2600000.0, 0.0, 0.0, 1200300.0, 0.0, -5.0", "cells of 0 m"),
                            ("2600000.0, 5.0, 0.0, 1200300.0, 0.0, 0.0", "cells of 0 m"),
                            ("nan, 5.0, 0.0, 1200300.0, 0.0, -5.0", "not finite"),
                            ("2600000.0, 5.0, 0.0, inf, 0.0, -5.0", "not finite"),
                            ("2600000.0, nan, 0.0, 1200300.0, 0.0, -5.0", "not finite"),
                            ("1e300, 5.0, 0.0, 1200300.0, 0.0, -5.0", "none on the earth")):
            with self.subTest(place):
                self.fails(2, "d.vrt", "geotransform", word, "-a_ullr", arguments=self.dem(place))

    def test_bands_that_hold_no_heights(self):
        for band, words in (("<Scale>0</Scale>", ("the scale 0", "-a_scale 1")),
                            ("<Offset>nan</Offset>", ("the offset nan", "-a_scale 1")),
                            ("<ColorInterp>Palette</ColorInterp><ColorTable><Entry c1='9' c2='0' c3='0'/></ColorTable>",
                             ("palette",))):
            with self.subTest(band):
                self.fails(2, "d.vrt", "band 1", *words, arguments=self.dem(band=band))

    def test_a_band_of_transparency_that_says_nothing(self):  # GDAL has none for real numbers: no data were ground
        dem = gdal.GetDriverByName("GTiff").Create(self.path("a.tif"), 60, 60, 3, gdal.GDT_Float32)
        dem.GetRasterBand(3).SetColorInterpretation(gdal.GCI_AlphaBand)
        dem.SetGeoTransform((WEST, 5.0, 0.0, NORTH, 0.0, -5.0))
        dem.SetProjection(system(2056).ExportToWkt())
        dem.GetRasterBand(1).WriteArray(900.0 + 3.0 * np.arange(60)[:, None] + np.zeros((60, 60)))
        dem.FlushCache()
        check = ["check", "--dem", self.path("a.tif"), "--sources", self.path("sources.gpkg"), "--diameter", "0.8"]
        self.fails(2, "a.tif", "transparency", "-dstnodata", arguments=check)
        dem.GetRasterBand(1).SetNoDataValue(-9999.0)
        dem.FlushCache()
        self.run_well(*check)

    def masked(self, nodata=-9999.0):
        """A DEM with a nodata value in one corner and a mask over another; 25 cells each."""
        z, mask = heights(), np.full((60, 60), 255, np.uint8)
        z[:5, :5], mask[40:45, 40:45] = nodata, 0
        write_dem(self.path("m.tif"), z, nodata=nodata)
        dem = gdal.Open(self.path("m.tif"), gdal.GA_Update)
        dem.CreateMaskBand(gdal.GMF_PER_DATASET)
        dem.GetRasterBand(1).GetMaskBand().WriteArray(mask)
        return dem, mask, ["check", "--dem", self.path("m.tif"), "--sources", self.path("sources.gpkg"), "--diameter", "0.8"]

    def test_a_nodata_value_beside_a_mask(self):  # "declare it": it was declared, but GDAL goes by the mask alone
        for nodata in (-9999.0, 1010.0, -3.4028234663852886e+38):
            dem, mask, check = self.masked(nodata)
            dem = None
            done = self.run_well(*check)
            self.assertIn("50 of them without a height", done.stdout)
            self.assertIn("has a nodata value and a mask, and 25 cells have the value ", done.stdout)
        dem, mask, check = self.masked()
        mask[:5, :5] = 0
        dem.GetRasterBand(1).GetMaskBand().WriteArray(mask)
        dem = None
        done = self.run_well(*check)
        self.assertIn("50 of them without a height", done.stdout)
        self.assertNotIn("a nodata value and a mask", done.stdout)

    def test_a_second_nodata_value(self):  # the command declared the second and with it no longer the first
        z = heights()
        z[:5, :5], z[50, 50:55] = -9999.0, -32768.0
        write_dem(self.path("two.tif"), z, nodata=-9999.0)
        check = ["--sources", self.path("sources.gpkg"), "--diameter", "0.8"]
        said = self.fails(2, "height -32768 m", "has the nodata value -9999 already",
                          arguments=["check", "--dem", self.path("two.tif"), *check]).stderr
        subprocess.run(said.split("declare it with ")[1].split(" (the file")[0], shell=True, cwd=self.folder, capture_output=True, check=True)
        self.assertIn("30 of them without a height", self.run_well("check", "--dem", self.path("mended.tif"), *check).stdout)

    def test_a_second_nodata_value_beside_a_mask_or_a_scale(self):
        """No command is given that would lose them: it brought the masked cells back as heights."""
        z = heights()
        z[:5, :5], z[50, 50:55] = -9999.0, -32768.0
        for name in ("masked", "scaled"):
            write_dem(self.path(name + ".tif"), z, nodata=-9999.0)
            dem = gdal.Open(self.path(name + ".tif"), gdal.GA_Update)
            if name == "masked":
                dem.CreateMaskBand(gdal.GMF_PER_DATASET)
                dem.GetRasterBand(1).GetMaskBand().WriteArray(np.full(z.shape, 255, np.uint8))
            else:
                dem.GetRasterBand(1).SetScale(0.5)
            dem = None
            said = self.fails(2, "declare it with a copy in which -9999, the nodata value that the file has already, stands in its place",
                              arguments=["check", "--dem", self.path(name + ".tif"), "--sources", self.path("sources.gpkg"), "--diameter", "0.8"]).stderr
            self.assertNotIn("gdal_calc.py", said)

    def test_heights_in_other_units(self):
        for unit, word, factor in (("cm", "centimetres", "A*0.01'"), ("km", "kilometres", "A*1000'"),
                                   ("Millimeter", "millimetres", "A*0.001'"), ("ft", "feet", "A*0.3048'"),
                                   ("inch", "inches", "A*0.0254'")):
            with self.subTest(unit):
                self.fails(2, f"heights are in {word}", f"'{unit}'", factor,
                           arguments=self.dem(band=f"<UnitType>{unit}</UnitType>"))
        for unit in ("", "m", "metre"):
            self.run_well(*self.dem(band=f"<UnitType>{unit}</UnitType>"))

    def test_the_command_for_heights_in_feet_keeps_decimals(self):
        """A DEM in whole feet: gdal_calc.py alone keeps its type, and so made whole metres of them."""
        z = np.round(heights() / 0.3048).astype(np.int16)
        dem = gdal.GetDriverByName("GTiff").Create(self.path("feet.tif"), 60, 60, 1, gdal.GDT_Int16)
        dem.SetGeoTransform((2600000.0, 5.0, 0.0, 1200300.0, 0.0, -5.0))
        dem.SetProjection(system(2056).ExportToWkt())
        dem.GetRasterBand(1).WriteArray(z)
        dem.GetRasterBand(1).SetUnitType("ft")
        dem = None
        arguments = [self.path("feet.tif") if a == self.path("dem.tif") else a for a in self.arguments("out")]
        said = " ".join(self.fails(2, "heights are in feet", arguments=arguments).stderr.split())
        command = said.split("convert them with ")[1].split(", or if")[0]
        subprocess.run(command, shell=True, cwd=self.folder, capture_output=True, check=True)
        np.testing.assert_allclose(gdal.Open(self.path("metres.tif")).ReadAsArray(), z * 0.3048, rtol=1e-6)

    def test_a_scale_is_said_and_used(self):
        """Heights in decimetres from 900 m: the same run as with heights in metres."""
        self.run_well(*self.arguments("metres"), "-q")
        z = gdal.Open(self.path("dem.tif")).ReadAsArray()
        dem = gdal.GetDriverByName("GTiff").Create(self.path("scaled.tif"), 60, 60, 1, gdal.GDT_Float32)
        dem.SetGeoTransform((2600000.0, 5.0, 0.0, 1200300.0, 0.0, -5.0))
        dem.SetProjection(system(2056).ExportToWkt())
        dem.GetRasterBand(1).WriteArray(((z.astype(np.float64) - 900.0) * 16.0).astype(np.float32))  # exact
        dem.GetRasterBand(1).SetScale(0.0625)
        dem.GetRasterBand(1).SetOffset(900.0)
        dem = None
        arguments = [self.path("scaled.tif") if a == self.path("dem.tif") else a for a in self.arguments("scaled")]
        done = self.run_well(*arguments)
        self.assertIn("times its scale 0.0625 plus its offset 900", done.stderr)
        self.assertAlmostEqual(self.record("scaled")["trajectory_metres"], self.record("metres")["trajectory_metres"], delta=30)


class LocalGrids(Case):
    """What a message says about a DEM of a mine: the commands work, and the DEM that they make is taken."""

    def setUp(self):
        super().setUp()
        self.write("points.csv", "x,y\n0,0\n")  # no place of these DEMs: only the fault of the DEM is asked for

    def shell(self, command):
        done = subprocess.run(command, shell=True, cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)

    def refused(self, dem, *words):
        done = self.fails(2, *words, arguments=["check", "--dem", self.path(dem), "--sources", self.path("points.csv"),
                                                "--diameter", "1"])
        return " ".join(done.stderr.split())

    def taken(self, dem):
        self.run_well("sources", "--dem", self.path(dem), "--slope", "30", "-o", self.path(dem + ".gpkg"))
        return gdal.Open(self.path(dem))

    def test_a_dem_without_a_system(self):
        write_dem(self.path("a pit.tif"), heights(), code=0)
        gdal.Translate(self.path("pit.asc"), self.path("a pit.tif"), format="AAIGrid")
        for dem, made in (("a pit.tif", "a pit.tif"), ("pit.asc", "mended.tif")):
            with self.subTest(dem):
                self.shell(self.refused(dem, "no coordinate system", "-a_srs EPSG:...").split("has no code: ")[1])
                self.assertEqual(self.taken(made).GetSpatialRef().GetName(), "mine grid")

    def test_a_grid_in_feet(self):
        """Without and with heights in feet: a foot is 0.3048 m. A missing value stays one."""
        grid = 'LOCAL_CS["old mine",UNIT["foot",0.3048],AXIS["X",EAST],AXIS["Y",NORTH]]'
        z = heights().astype(np.int16)
        z[0, 0] = -9999
        dem = gdal.GetDriverByName("GTiff").Create(self.path("feet.tif"), 60, 60, 1, gdal.GDT_Int16)
        dem.SetGeoTransform((5000.0, 5.0, 0.0, 8000.0, 0.0, -5.0))
        dem.SetProjection(grid)
        dem.GetRasterBand(1).SetNoDataValue(-9999)
        dem.GetRasterBand(1).WriteArray(z)
        dem = None
        text = self.refused("feet.tif", "in 'foot' (old mine), must be metres").split("multiply them with ")[1]
        self.assertNotIn("gdalwarp", text)
        command, rest = text.split(", with the options ")
        options = rest.split(" as well")[0]
        for factor, line in ((1.0, command), (0.3048, command.replace("gdal_translate", "gdal_translate " + options))):
            with self.subTest(line):
                self.shell(line)
                made = self.taken("metres.tif")
                np.testing.assert_allclose(made.GetGeoTransform(), (1524.0, 1.524, 0.0, 2438.4, 0.0, -1.524), atol=1e-9)
                found = made.ReadAsArray().astype(float)
                self.assertEqual(found[0, 0], made.GetRasterBand(1).GetNoDataValue())
                np.testing.assert_allclose(found.ravel()[1:], factor * z.ravel()[1:], rtol=1e-6)
                os.remove(self.path("metres.tif.gpkg"))


class Places(OneThread, Case):
    def check(self, sources):
        return ["check", "--dem", self.path("dem.tif"), "--sources", self.path(sources), "--diameter", "0.8",
                "--trajectories", "5"]

    def test_a_source_that_is_no_place(self):
        for text, where in (("x,y\n1e300,1200250\n", "row 1"), ("x,y\n2600150,1200235\n2600150,-1e12\n", "row 2")):
            self.write("s.csv", text)
            self.fails(2, "s.csv", where, "none on the earth", arguments=self.check("s.csv"))
        write_features(self.path("s.gpkg"), "s", [("POINT (1e300 1200250)", [])])
        self.fails(2, "s.gpkg", "feature 1", "none on the earth", arguments=self.check("s.gpkg"))

    def test_types_beside_a_table(self):  # a diameter of 1.9 m was 1, a frequency of 0.7 was 0
        self.write("t.csv", f"x,y,diameter\n{WEST + 150},{NORTH - 60},1.9\n")
        self.write("t.csvt", "Real,Real,Integer\n")
        self.fails(2, "t.csvt", "remove it", arguments=self.check("t.csv"))

    def test_a_geopackage_without_a_system(self):
        """As docs/scenario.md says: taken to be in the system of the DEM, with a warning."""
        file = ogr.GetDriverByName("GPKG").CreateDataSource(self.path("s.gpkg"))
        layer = file.CreateLayer("s", None, ogr.wkbUnknown)
        feature = ogr.Feature(layer.GetLayerDefn())
        feature.SetGeometry(ogr.CreateGeometryFromWkt(box(140, 230, 20, 10)))
        layer.CreateFeature(feature)
        file = layer = None
        done = self.run_well(*self.check("s.gpkg"))
        self.assertIn("s.gpkg: states no coordinate system: taken to be that of the DEM, EPSG:2056", done.stdout)
        self.assertRegex(done.stdout, "sources +1 feature, 8 source cells")


    def axes(self, path, layer):
        file = ogr.Open(self.path(path))
        return file.GetLayerByName(layer).GetSpatialRef().GetAxesCount()

    def test_a_system_with_an_axis_of_heights(self):
        """All was traced, then no GeoPackage could be written in such a system: the layers have the plane one."""
        tall = system(2056)
        tall.PromoteTo3D()
        gdal.GetDriverByName("GTiff").CreateCopy(self.path("tall.tif"), gdal.Open(self.path("dem.tif"))).SetSpatialRef(tall)
        self.assertEqual(gdal.Open(self.path("tall.tif")).GetSpatialRef().GetAxesCount(), 3)
        flags = ["--dem", self.path("tall.tif"), "--sources", self.path("sources.gpkg"), "--diameter", "0.8",
                 "--trajectories", "5", "--frequency", "1"]
        self.assertRegex(self.run_well("check", *flags).stdout, r"system +EPSG:2056 \(CH1903\+ / LV95\)")
        for vectors in ("gpkg", "fgb"):
            self.run_well("run", *flags, "--vectors", vectors, "-o", self.path(vectors), "-q")
            self.assertEqual(self.axes(f"{vectors}/stops.{vectors}", "stops"), 2)
        self.assertEqual(gdal.Open(self.path("gpkg/energy.tif")).GetSpatialRef().GetAuthorityCode(None), "2056")
        self.run_well("hazard", self.path("gpkg"), "--objects", self.path("sources.gpkg"), "-q")
        self.assertEqual(self.axes("gpkg/objects.gpkg", "objects"), 2)
        self.run_well("sources", "--dem", self.path("tall.tif"), "--slope", "30", "-o", self.path("cells.gpkg"))
        self.assertEqual(self.axes("cells.gpkg", "source_points"), 2)


class Options(OneThread, Case):
    def test_seeds(self):
        for seed in ("-1", "18446744073709551615"):
            self.fails(2, "--seed", seed, "must be a whole number, 0 to 9007199254740991",
                       arguments=[*self.arguments(), "--seed", seed])

    def test_numbers_are_decimal(self):
        self.run_well(*self.arguments(trajectories="010"), "--seed=0012", "-q")
        settings = {setting["key"]: setting["value"] for setting in self.record()["settings"]}
        self.assertEqual((settings["trajectories"], settings["seed"]), (10, 12))
        trace = ["trace", self.path("out/scenario.toml"), "--source", "0", "--block"]
        self.assertEqual(self.run_well(*trace, "009").stdout, self.run_well(*trace, "9").stdout)

    def test_no_number_of_any_command_is_hexadecimal(self):
        numbers = 0
        for command in json.loads(self.run_well("help", "--json").stdout)["commands"]:
            for p in command["parameters"]:
                if {p["type"], p.get("of")} & {"integer", "number"}:
                    numbers += 1
                    self.fails(2, p["flags"][-1], "0x10", "decimal", arguments=[command["name"], p["flags"][-1] + "=0x10"])
        self.assertGreater(numbers, 40)

    def test_what_would_have_no_effect(self):
        self.write("file", "")
        for words, more in ((("--above", "--until-error"), ["--above", "0.2"]),
                            (("--most-rounds", "--until-error"), ["--most-rounds", "3"]),
                            (("--allow-folder", "there is no folder 'missing'"), ["--allow-folder", "missing"]),
                            (("--allow-folder", "there is no folder"), ["--allow-folder", self.path("file")]),
                            (("--thresholds", "'30,,300' has an empty item"), ["--thresholds", "30,,300"]),
                            (("--thresholds", "'30,' has an empty item"), ["--thresholds=30,"]),
                            (("--thresholds is given 2 times", "give it once, its items with commas"),
                             ["--thresholds", "30", "--thresholds=300"])):
            self.fails(2, *words, arguments=[*self.arguments(), *more])
        for item in ("", " "):
            self.fails(2, "--fit", "empty", arguments=["calibrate", "campaign.toml", "-o", "fit", "--fit", f"En50,{item},phi"])

    def test_spaces_in_lists(self):
        self.run_well(*self.arguments(), "--thresholds", " 30, 100 ,300", "-q")
        self.assertEqual([s["value"] for s in self.record("out")["settings"] if s["key"] == "output.energy_thresholds"],
                         ["[30, 100, 300]"])

    def test_empty_values(self):  # of a variable of a script that is not set: the default was taken without a word
        scenario, out = self.write("e.toml", 'dem = "dem.tif"\n'), self.path("out")
        for option, arguments in (("--frequency", self.arguments()), ("--deformation-coefficient", self.arguments()),
                                  ("--seed", self.arguments()), ("--matrix", ["hazard", out]), ("--objects", ["hazard", out]),
                                  ("--observed", ["barrier", out]), ("--volume", ["barrier", out]), ("--out", ["report", out]),
                                  ("--source", ["trace", scenario, "--block", "1"]), ("--pits", ["check", scenario])):
            self.fails(2, option, "empty value", arguments=[*arguments, option, ""])
            self.fails(2, option, arguments=[*arguments, option + "="])
        for command in (["check", ""], ["profile", "", "-o", out], ["calibrate", "", "-o", out]):
            self.fails(2, "empty value", arguments=command)
        self.fails(2, "as a layer of a file", arguments=[*self.arguments()[:-1], self.path("x|layername=y")])

    def test_a_text_with_a_zero_byte(self):  # the message ended there
        self.write("z.toml", 'dem = "dem.tif"\n[sources]\nfile = "a\\u0000b"\n')
        self.fails(2, "z.toml:3: a text has the character of number 0", arguments=["check", self.path("z.toml")])

    def test_a_file_of_settings_that_holds_none(self):
        """Whatever reads settings from a file of its own refuses one without any."""
        self.run_well(*self.arguments(trajectories="5"), "--frequency", "1", "-q")
        head = 'dem = "dem.tif"\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 1\n'
        self.write("s.toml", 'include = "none.toml"\n' + head)
        for text in ("", "# nothing\n", "[model]\n"):
            none = self.write("none.toml", text)
            for flags in (["check", *self.arguments()[1:-2], "--parameters", none], ["check", self.path("s.toml")],
                          ["hazard", self.path("out"), "--matrix", none], ["hazard", self.path("out"), "--frequency", none]):
                self.fails(2, "none.toml: holds no ", arguments=flags)
        self.assertFalse(os.path.exists(self.path("out/hazard.json")))

    def test_a_link_to_nothing_as_output(self):
        os.symlink("/nowhere/at/all", self.path("out"))
        os.symlink("/nowhere/at/all", self.path("pits.gpkg"))
        done = self.fails(2, "is a link to /nowhere/at/all, which is not there", arguments=self.arguments())
        self.assertNotIn("warning", done.stderr)  # at the start, before anything is read
        check = ["check", *self.arguments()[1:-2], "--pits", self.path("pits.gpkg")]
        self.fails(2, "is a link to /nowhere/at/all", arguments=check)

    def test_more_threads_than_memory_allows(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (2_000_000_000, 2_000_000_000))
        self.fails(2, "--threads", "4096", "lets the program start", "ulimit -v", preexec_fn=limit,
                   arguments=[*self.arguments(), "--threads", "4096"])
        self.run_well(*self.arguments(), "--threads", "2", "-q", preexec_fn=limit)

    def test_a_plan_without_end(self):
        """8 source cells of 1e9 blocks: said by `check` and by `run`, before it is traced."""
        big = self.arguments(trajectories="1000000000")
        done = self.run_well("check", *big[1:-2])
        self.assertIn("8 000 000 000 trajectories", done.stdout)
        self.assertRegex(done.stdout, "about 9.3 days of one processor")
        with subprocess.Popen([TALUS, *big, "--progress=machine"], stderr=subprocess.PIPE, text=True) as process:
            said = []
            for line in iter(process.stderr.readline, ""):
                said.append(line)
                if line.startswith("progress"):
                    break
            process.kill()
        self.assertTrue(any("8 000 000 000 trajectories" in line for line in said), said)


class Bound(Case):
    def test_a_trajectory_has_at_most_a_million_vertices(self):
        """A block that can neither stop nor leave nor be trapped, for a day and ten million impacts."""
        self.write("p.csv", "x,y\n2600150,1200150\n")
        self.write("s.toml", 'dem = "dem.tif"\ntrajectories = 1\n[sources]\nfile = "p.csv"\nrelease_height = 100\n[blocks]\n'
                             "diameter = 0.1\ndensity = 500\n[effects.vegetation-drag]\ncoefficient = 5000\nheight = 60\n"
                             "[model]\nstop_speed = 1e-9\ntime_limit = 86400\nimpact_limit = 10000000\n"
                             "trap_time = 3600\n[output]\ntrajectories = 0\n")
        done = self.call("run", self.path("s.toml"), "-o", self.path("out"), timeout=60)
        self.assertEqual(done.returncode, 1, done.stderr)  # too many ended at a limit
        self.assertIn("limit of impacts, time or vertices", done.stderr)
        record = self.record()
        self.assertEqual(record["ends"]["limit"], 1)
        self.assertLess(record["cpu_seconds"]["simulate"], 10.0)
        with open(self.path("path.csv"), "wb") as path:
            subprocess.run([TALUS, "trace", self.path("out/scenario.toml"), "--source", "0", "--block", "0"],
                           stdout=path, check=True)
        with open(self.path("path.csv"), "rb") as path:
            rows = sum(piece.count(b"\n") for piece in iter(lambda: path.read(2**20), b""))
        self.assertGreater(rows, 1_000_000)
        self.assertLess(rows, 1_002_000)


    def test_a_trajectory_crosses_at_most_four_million_patches(self):
        """A block of 1 cm that flies to and fro for a day in a hollow of cells of 5 cm, without loss."""
        y, x = np.mgrid[0:1200, 0:1200] * 0.05
        z = 100.0 + 3.0 * np.hypot(x - x.mean(), y - y.mean())
        write_dem(self.path("dem.tif"), z.astype(np.float32), 0.05)
        self.write("p.csv", "x,y\n2600021.33,1200267.18\n")
        self.write("s.toml", 'dem = "dem.tif"\ntrajectories = 1\n[sources]\nfile = "p.csv"\nrelease_height = 1\n[blocks]\n'
                             "diameter = 0.01\n[ground.zones.default]\ntheta_scale = 0\npsi_scale = 0\nEn50 = 1e6\nEt50 = 1e6\n"
                             "phi = 0.01\n[model]\nstop_speed = 1e-9\ntime_limit = 86400\nimpact_limit = 10000000\n"
                             "trap_time = 3600\ndeformation_coefficient = 1e-6\n[output]\ntrajectories = 0\n")
        done = self.call("run", self.path("s.toml"), "-o", self.path("out"), timeout=60)
        self.assertEqual(done.returncode, 1, done.stderr)
        record = self.record()
        self.assertEqual(record["ends"]["limit"], 1)
        self.assertLess(record["impacts"], 100_000)  # 985 000 without the bound
        self.assertLess(record["peak_memory_mb"], 1500)


class Forged(OneThread, KeptRuns, RunCase):
    """Files of results that another program made to do harm. Each is refused at once."""

    def setUp(self):
        super().setUp()
        for i in (1, 2):
            self.keep_scenario(f"part{i}", "--part", f"{i}/2")
        self.merge = ["merge", self.path("m"), self.path("part1"), self.path("part2")]

    def manifest(self, change):
        """Rewrites part1/part.json, with the checksum that it must have."""
        manifest = self.read_json("part1/part.json")
        change(manifest)
        manifest.pop("sha256", None)
        text = json.dumps(manifest, indent=2, ensure_ascii=False) + "\n"
        manifest["sha256"] = hashlib.sha256(text.encode()).hexdigest()
        self.write("part1/part.json", json.dumps(manifest, indent=2, ensure_ascii=False) + "\n")

    def tally(self, change):
        """Rewrites the tally of part1, with the checksum that it must have."""
        name = next(n for n in os.listdir(self.path("part1")) if n.startswith("tally"))
        with open(self.path(f"part1/{name}"), "r+b") as file:
            changed = change(file.read())
            file.seek(0)
            file.truncate()
            file.write(changed)
        self.manifest(lambda m: m.update(tallies=[{"file": name, "sha256": hashlib.sha256(changed).hexdigest()}]))

    def refused(self, *words):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (1_500_000_000, 1_500_000_000))
        done = self.fails(2, *words, arguments=self.merge, preexec_fn=limit, timeout=20)
        self.assertFalse(os.path.exists(self.path("m")))
        return done

    def test_the_forger_is_right(self):
        """What the other tests rely on: a file that is written anew without a change is accepted."""
        self.tally(lambda bytes_: bytes_)
        self.run_well(*self.merge, "-q")

    def test_names_out_of_the_folder(self):
        self.write("secret.bin", "not to be read")
        for name in ("../secret.bin", "/etc/passwd", "tally-../../secret.bin", "tally-\x00.bin", "", "x" * 300):
            for list_, key in (("tallies", "file"), ("reaches", "file"), ("rows", "file")):
                with self.subTest(name=name, list=list_):
                    self.manifest(lambda m, n=name, k=list_: m[k].append({"round": 0, "generation": 1, "file": n, "sha256": "0"}))
                    self.refused("part.json", "it names the file")
                    self.manifest(lambda m, k=list_: m[k].pop())

    def test_numbers_that_wrap(self):
        for change in ({"part": 0}, {"of": 0}, {"part": 2**32 + 1}, {"part": -1}, {"part": 1.5}, {"rounds_done": 2**32 + 1},
                       {"rounds_done": 10**6}, {"generation": 2**64 - 1}, {"units_done": 2**63}):
            with self.subTest(change):
                key = next(iter(change))
                old = {}
                self.manifest(lambda m, c=change, k=key, o=old: (o.update({k: m[k]}), m.update(c)))
                self.refused("part.json", "must be")
                self.manifest(lambda m, o=old: m.update(o))

    def test_no_record_at_all(self):
        self.write("part1/part.json", "[" * 1_000_000)
        self.refused("part.json", "deep")
        os.truncate(self.path("part1/part.json"), 300_000_000)
        self.refused("part.json", "256 MB")
        os.remove(self.path("part1/part.json"))
        os.mkfifo(self.path("part1/part.json"))
        self.refused("part.json", "is a pipe")

    def test_lengths_of_a_tally(self):
        for text in (struct.pack("<QQ", 0, 2**62), struct.pack("<QQ", 2**40, 8) + b"x" * 8, struct.pack("<QQ", 0, 3) + b"\xff" * 3):
            with self.subTest(text):
                self.tally(lambda _, t=text: t)
                self.refused("tally", "is damaged")

    def test_counts_that_would_wrap(self):
        """A cell with nearly 2^32 passages in one part: with those of the other they have more than 32 bits."""
        count_at = 16 + 2 + 24  # after region, length; cell; impacts, length, squares
        other = next(n for n in os.listdir(self.path("part2")) if n.startswith("tally"))
        with open(self.path(f"part2/{other}"), "rb") as file:
            second = file.read()
        def both(first):  # the first cell of the other part, counted in this one
            length = struct.unpack_from("<Q", second, 8)[0]
            changed = bytearray(second[:16 + length])
            struct.pack_into("<I", changed, count_at, 2**32 - 1)
            return bytes(changed)
        self.tally(both)
        self.refused("larger than 4294967295")

    def test_rows_that_are_longer_than_their_file(self):
        name = next(n for n in os.listdir(self.path("part1")) if n.startswith("rows"))
        bytes_ = b"U" + struct.pack("<Q", 0) + b"S" + struct.pack("<Q", 2**61)
        with open(self.path(f"part1/{name}"), "wb") as file:
            file.write(bytes_)
        self.manifest(lambda m: m["rows"][0].update(file=name, sha256=hashlib.sha256(bytes_).hexdigest()))
        self.refused("rows", "is damaged")


class ForgedHazard(OneThread, KeptRuns, RunCase):
    def setUp(self):
        super().setUp()
        self.keep_scenario("out")
        with gzip.open(self.path("out/hazard_tally.gz")) as file:
            self.bytes = file.read()

    def header(self, **change):
        start = len(b"talus-hazard") + 4
        length = struct.unpack_from("<I", self.bytes, start)[0]
        header = json.loads(self.bytes[start + 4:start + 4 + length])
        header.update(change)
        text = json.dumps(header).encode()
        return self.bytes[:start] + struct.pack("<I", len(text)) + text + self.bytes[start + 4 + length:-64]

    def refused(self, bytes_, *words):
        with gzip.open(self.path("out/hazard_tally.gz"), "wb", compresslevel=1) as file:
            file.write(bytes_ + hashlib.sha256(bytes_).hexdigest().encode())
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (1_500_000_000, 1_500_000_000))
        self.fails(2, "hazard_tally.gz", *(words or ["is damaged"]), preexec_fn=limit, timeout=20,
                   arguments=["hazard", self.path("out"), "-q", "--threads", "1"])
        self.assertFalse(os.path.exists(self.path("out/hazard.json")))

    def test_a_hazard_file_that_is_lost(self):  # "the run has no annual frequencies"
        os.remove(self.path("out/hazard_tally.gz"))
        for command in (["hazard", self.path("out")], ["barrier", self.path("out"), "--screen", "road"]):
            self.fails(2, "hazard_tally.gz: is not there", arguments=command)
        self.run_well("barrier", self.path("out"), "--screen", "road", "--unweighted")

    def test_the_forger_is_right(self):
        with gzip.open(self.path("out/hazard_tally.gz"), "wb", compresslevel=1) as file:
            bytes_ = self.header()
            file.write(bytes_ + hashlib.sha256(bytes_).hexdigest().encode())
        self.run_well("hazard", self.path("out"), "-q")

    def test_headers(self):
        for change in ({"columns": 2**31 - 1}, {"columns": 2**31}, {"columns": 2**32 + 60}, {"rows": 2**31 - 1}, {"columns": -1},
                       {"columns": 0}, {"columns": 60.5}, {"columns": "60"}, {"cell_x": 0}, {"cell_x": 1e300}, {"unit": 0},
                       {"unit": None}, {"energy_thresholds": list(range(1, 100000))}, {"energy_thresholds": [300, 30]},
                       {"energy_thresholds": [-1]}, {"left": -5}, {"total": 0}, {"largest": 0}, {"trajectories": 0},
                       {"largest_diameter": -1}):
            with self.subTest(str(change)[:60]):
                self.refused(self.header(**change))

    def test_a_bomb(self):
        """A gigabyte of zeros in a megabyte, of a map that would be as large."""
        self.refused(self.header(columns=40_000, rows=40_000) + b"\0" * 50_000_000)
        self.refused(b"\0" * 50_000_000, "is no file that talus run wrote")

    def test_deep_json(self):
        start = len(b"talus-hazard") + 4
        text = b"[" * 500_000
        self.refused(self.bytes[:start] + struct.pack("<I", len(text)) + text)


if __name__ == "__main__":
    unittest.main()
