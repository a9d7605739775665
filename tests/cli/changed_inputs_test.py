"""Inputs that lie in several files, or in a part of one: a change of any of them is seen by the commands that repeat a run."""
import os
import shutil
import sqlite3
import unittest
import zipfile

import numpy as np
from osgeo import gdal, ogr

from support import NORTH, WEST, Case, box, heights, system, write_dem, write_features

SCENARIO = """dem = "{dem}"
trajectories = 4
[sources]
file = "sources.gpkg"
[blocks]
diameter = 0.8
"""


BESIDE = '<PAMDataset>\n  <PAMRasterBand band="1">\n    {}\n  </PAMRasterBand>\n</PAMDataset>\n'  # dem.tif.aux.xml


class ChangedInputs(Case):
    def setUp(self):
        super().setUp()
        write_features(self.path("sources.gpkg"), "sources", [(box(100, 230, 20, 10), ["west", 0.5])],
                       [("name", ogr.OFTString), ("frequency", ogr.OFTReal)])

    def two_rasters(self):
        """A GeoTIFF whose second directory is the DEM."""
        write_dem(self.path("two.tif"), heights() * 0.0)
        gdal.Translate(self.path("two.tif"), self.path("dem.tif"), creationOptions=["APPEND_SUBDATASET=YES"])

    def run_on(self, dem="dem.tif", out="out", more=""):
        self.write("s.toml", SCENARIO.format(dem=dem) + more)
        self.run_well("run", self.path("s.toml"), "-q", "-o", self.path(out))

    def trace(self, scenario="out/scenario.toml", **options):
        return self.run_well("trace", self.path(scenario), "--source", "1", "--block", "2", **options).stdout

    def refuses(self, scenario="out/scenario.toml", *words):
        self.fails(2, scenario, "has changed since the run", *words,
                   arguments=["trace", self.path(scenario), "--source", "1", "--block", "2"])

    def replace_in(self, name, old, new):
        """Other bytes in a file, as many as before."""
        with open(self.path(name), "rb") as file:
            content = file.read()
        self.assertIn(old, content)
        with open(self.path(name), "wb") as file:
            file.write(content.replace(old, new))

    def vrt(self, name, source):
        gdal.Translate(self.path(name), self.path(source), format="VRT")

    def zip_sources(self):
        with zipfile.ZipFile(self.path("s.zip"), "w") as archive:
            for end in ("shp", "shx", "dbf", "prj"):
                archive.write(self.path("s/sources." + end), "sources." + end)

    def test_a_geopackage_that_was_opened_and_not_changed(self):
        """QGIS sets the kind of journal, the change counter and the versions in the head of a file that it shows with a
        filter, and takes some of them back: sqlite.org/fileformat2.html, "The Database Header"."""
        self.run_on()
        before, sources = self.trace(), self.path("sources.gpkg")
        with open(sources, "rb") as file:
            first = file.read()
        database = sqlite3.connect(sources)
        database.execute("PRAGMA journal_mode = wal")
        database.execute("PRAGMA journal_mode = delete")
        database.close()
        with open(sources, "rb") as file:
            second = file.read()
        self.assertNotEqual(second, first)
        self.assertEqual(self.trace(), before)
        with open(sources, "wb") as file:
            file.write(first[:18] + b"\x02\x02" + first[20:27] + b"\x77" + first[28:95] + b"\x77" + first[96:])
        self.assertEqual(self.trace(), before)
        with open(sources, "wb") as file:
            file.write(first[:60] + b"\x00\x00\x00\x07" + first[64:])  # the version of its user: content
        self.refuses()

    def test_trace_needs_the_same_inputs(self):
        """A run, one in rounds, and a part are replayed while nothing has changed; a scenario of the user's own always."""
        self.run_on()
        self.run_well("run", self.path("s.toml"), "-q", "-o", self.path("rounds"), "--rounds", "2")
        self.run_well("run", self.path("s.toml"), "-q", "-o", self.path("part"), "--part", "1/2")
        runs = [name + "/scenario.toml" for name in ("out", "rounds", "part")]
        before = self.trace()
        for scenario in runs:
            self.assertEqual(self.trace(scenario), before)
        gdal.Info(self.path("dem.tif"), stats=True)  # what QGIS writes beside a raster is no input
        self.assertTrue(os.path.exists(self.path("dem.tif.aux.xml")))
        self.assertEqual(self.trace(), before)
        write_dem(self.path("dem.tif"), heights() * 1.1)
        for scenario in runs:
            self.refuses(scenario, "it, or a file that it names, has changed since the run (another content of the file of dem)")
        shutil.copy(self.path("out/scenario.toml"), self.path("out/mine.toml"))
        changed = self.trace("s.toml")
        self.assertNotEqual(changed, before)
        self.assertEqual(self.trace("out/mine.toml"), changed)
        write_dem(self.path("dem.tif"), heights())
        self.assertEqual(self.trace(), before)
        self.replace_in("out/scenario.toml", b"seed = ", b"seed = 1")
        self.refuses("out/scenario.toml", "has changed since the run (a setting, or")
        self.write("s.toml", self.read_text("s.toml") + "# a remark\n")  # the scenario of the user may change
        self.refuses("out/scenario.toml", "has changed since the run (a setting, or")

    def test_files_that_are_read_with_an_input(self):
        gdal.Translate(self.path("raw.bil"), self.path("dem.tif"), format="EHdr")
        self.vrt("inner.vrt", "dem.tif")
        self.vrt("outer.vrt", "inner.vrt")
        self.two_rasters()
        for dem, changed in (("raw.bil", "raw.hdr"), ("raw.bil", "raw.prj"), ("outer.vrt", "dem.tif"),
                             ("GTIFF_DIR:2:two.tif", "two.tif")):
            with self.subTest(dem=dem, changed=changed):
                self.run_on(dem)
                self.assertTrue(all(len(entry["sha256"]) == 64 for entry in self.record()["inputs"]))
                self.trace()
                with open(self.path(changed), "ab") as file:
                    file.write(b"\n")
                self.refuses()
                shutil.rmtree(self.path("out"))

    def test_files_that_are_read_with_a_layer(self):
        os.mkdir(self.path("s"))
        for name in ("s/sources.shp", "sources.tab", "sources.mif"):
            gdal.VectorTranslate(self.path(name), self.path("sources.gpkg"),
                                 format="ESRI Shapefile" if name.endswith("shp") else "MapInfo File")
        self.zip_sources()
        archive = "/vsizip/" + self.path("s.zip") + "/sources.shp"
        for name, changed in (("sources.tab", "sources.dat"), ("sources.mif", "sources.mid"), (archive, "s/sources.dbf")):
            with self.subTest(name=name):
                self.run_well("run", "--dem", self.path("dem.tif"), "--sources", name if name == archive else self.path(name),
                              "--diameter", "0.8", "--trajectories", "4", "-q", "-o", self.path("out"))
                self.trace()
                self.replace_in(changed, b"west", b"East")
                self.zip_sources()
                self.refuses()
                shutil.rmtree(self.path("out"))

    def test_the_log_of_a_geopackage(self):
        """An edit of another program, QGIS say, that has the file open stays in its log."""
        other = sqlite3.connect(self.path("sources.gpkg"))
        self.addCleanup(other.close)
        other.execute("PRAGMA journal_mode = WAL")
        other.execute("PRAGMA wal_autocheckpoint = 0")
        with other:
            other.execute("UPDATE gpkg_contents SET description = 'before'")
        self.run_on()
        self.trace()
        with open(self.path("sources.gpkg"), "rb") as file:
            content = file.read()
        with other:
            other.execute("UPDATE gpkg_contents SET description = 'behind'")
        with open(self.path("sources.gpkg"), "rb") as file:
            self.assertEqual(file.read(), content)
        self.refuses()

    def test_parts_on_other_inputs_are_not_merged(self):
        gdal.Translate(self.path("raw.bil"), self.path("dem.tif"), format="EHdr")
        self.write("s.toml", SCENARIO.format(dem="raw.bil"))
        for part in "1", "2":
            self.run_well("run", self.path("s.toml"), "-q", "--part", part + "/2", "-o", self.path("part" + part))
            with open(self.path("raw.hdr"), "ab") as file:
                file.write(b"\n")
        self.fails(2, "another plan", arguments=["merge", self.path("merged"), self.path("part1"), self.path("part2")])

    def test_what_is_said_beside_a_raster(self):
        """GDAL keeps in NAME.aux.xml what a raster cannot hold, and statistics: these are no input, a scale is one."""
        write_features(self.path("houses.gpkg"), "houses", [(box(105, 150, 10, 8), ["A"])], [("name", ogr.OFTString)])
        hazard = ["hazard", self.path("out"), "--objects", self.path("houses.gpkg"), "--overwrite", "-q"]
        self.run_on()
        self.run_well(*hazard)
        before = self.trace()
        gdal.Info(self.path("dem.tif"), stats=True, reportHistograms=True)
        self.assertIn("STATISTICS_MEAN", self.read_text("dem.tif.aux.xml"))
        self.assertIn("Histograms", self.read_text("dem.tif.aux.xml"))
        self.run_well(*hazard)
        self.assertEqual(self.trace(), before)
        for said in ("<Scale>0.5</Scale>", "<Offset>300</Offset>", "<NoDataValue>1001</NoDataValue>", "<UnitType>metre</UnitType>"):
            self.write("dem.tif.aux.xml", BESIDE.format(said))
            self.refuses()
        self.write("dem.tif.aux.xml", BESIDE.format("<Offset>300</Offset>\n    <Scale>0.5</Scale>"))
        self.fails(2, "has changed since the run", arguments=hazard)
        self.run_on(out="scaled")
        scaled = self.trace("scaled/scenario.toml")
        self.assertNotEqual(scaled, before)
        gdal.Info(self.path("dem.tif"), stats=True)  # writes the file anew, with its scale
        self.assertIn("STATISTICS_MEAN", self.read_text("dem.tif.aux.xml"))
        self.assertEqual(self.trace("scaled/scenario.toml"), scaled)
        os.remove(self.path("dem.tif.aux.xml"))
        self.assertEqual(self.trace(), before)

    def test_parts_on_a_scaled_dem_are_not_merged(self):
        self.write("s.toml", SCENARIO.format(dem="dem.tif"))
        for part in "1", "2":
            self.run_well("run", self.path("s.toml"), "-q", "--part", part + "/2", "-o", self.path("part" + part))
            self.write("dem.tif.aux.xml", BESIDE.format("<Offset>300</Offset>\n    <Scale>0.5</Scale>"))
        self.fails(2, "another plan", arguments=["merge", self.path("merged"), self.path("part1"), self.path("part2")])

    def geolocated(self):
        """A warped VRT of a raster whose cells are placed by two others, x.tif and y.tif."""
        raw = gdal.GetDriverByName("GTiff").Create(self.path("raw.tif"), 60, 60, 1, gdal.GDT_Float32)
        raw.GetRasterBand(1).WriteArray(heights())
        x, y = np.meshgrid(WEST + 2.5 + 5.0 * np.arange(60), NORTH - 2.5 - 5.0 * np.arange(60))
        for name, values in (("x.tif", x), ("y.tif", y)):
            array = gdal.GetDriverByName("GTiff").Create(self.path(name), 60, 60, 1, gdal.GDT_Float64)
            array.GetRasterBand(1).WriteArray(values)
            array = None
        raw.SetMetadata({"SRS": system(2056).ExportToWkt(), "X_DATASET": self.path("x.tif"), "X_BAND": "1",
                         "Y_DATASET": self.path("y.tif"), "Y_BAND": "1", "PIXEL_OFFSET": "0", "LINE_OFFSET": "0",
                         "PIXEL_STEP": "1", "LINE_STEP": "1"}, "GEOLOCATION")
        raw = None
        gdal.Warp(self.path("warped.vrt"), self.path("raw.tif"), format="VRT", geoloc=True, dstSRS="EPSG:2056",
                  outputBounds=(WEST, NORTH - 300, WEST + 300, NORTH), xRes=5, yRes=5)

    def test_arrays_that_place_a_warped_vrt(self):
        self.geolocated()
        self.assertIn('key="X_DATASET"', self.read_text("warped.vrt"))
        self.run_on("warped.vrt")
        self.trace()
        for name in "x.tif", "y.tif":
            with self.subTest(name=name):
                with open(self.path(name), "ab") as file:
                    file.write(b"\n")
                self.refuses()
                with open(self.path(name), "rb+") as file:
                    file.truncate(os.path.getsize(self.path(name)) - 1)
                self.trace()

    def test_a_forest_from_a_vrt_is_read_again(self):
        """Folders that a VRT may name are in OUT/scenario.toml, whichever input the VRT is."""
        os.makedirs(self.path("tiles"))
        os.makedirs(self.path("vrt"))
        os.makedirs(self.path("far"))
        write_dem(self.path("tiles/density.tif"), heights() * 0.0 + 600.0)
        self.vrt("vrt/density.vrt", "tiles/density.tif")
        more = '[effects.forest-stems]\ndensity = "vrt/density.vrt"\ndiameter = 0.3\n'
        self.run_on(more=more, out="far/out")
        self.trace("far/out/scenario.toml")
        for part in "1", "2":
            self.run_well("run", self.path("s.toml"), "-q", "--part", part + "/2", "-o", self.path("far/part" + part))
        self.run_well("merge", self.path("far/merged"), self.path("far/part1"), self.path("far/part2"))
        self.run_on(out="far/plain")
        self.assertNotIn("vrt_folders", self.read_text("far/plain/scenario.toml"))  # only where a VRT is named

    def test_a_folder_whose_name_is_not_utf8(self):
        """OUT/scenario.toml could not hold it: refused at the start, by a flag and in a scenario."""
        folder = os.path.join(os.fsencode(self.folder), b"f\xe9")
        os.mkdir(folder)
        dem = os.fsdecode(os.path.join(folder, b"dem.tif"))
        shutil.copy(self.path("dem.tif"), dem)
        self.fails(2, "flag --dem", "is not UTF-8", "f\\xe9", "rename", arguments=[
            "run", "--dem", dem, "--sources", self.path("sources.gpkg"), "--diameter", "1", "-o", self.path("out")])
        scenario = os.fsdecode(os.path.join(folder, b"s.toml"))
        self.run_on(out="good")
        shutil.copy(self.path("s.toml"), scenario)
        self.fails(2, "dem = 'dem.tif'", "is not UTF-8", "rename", arguments=["run", scenario, "-o", self.path("out")])
        self.assertFalse(os.path.exists(self.path("out")))

    def test_a_field_whose_name_is_not_utf8(self):
        """OUT/scenario.toml could not hold it: refused at the start."""
        run = ["run", "--dem", self.path("dem.tif"), "--sources", self.path("sources.gpkg"), "--diameter", "1", "-o", self.path("out")]
        self.fails(2, "flag --field diameter=Durchm\\xe4sser", "is not UTF-8", "rename the field",
                   arguments=[*run, "--field", b"diameter=Durchm\xe4sser"])
        self.fails(2, "flag --zone-field", "is not UTF-8", "Gel\\xe4nde", "rename the field",
                   arguments=[*run, "--zones", self.path("sources.gpkg"), "--zone-field", b"Gel\xe4nde"])
        self.assertFalse(os.path.exists(self.path("out")))

    def test_a_part_of_a_file_is_looked_up_in_the_folder_of_the_scenario(self):
        self.two_rasters()
        self.run_on("GTIFF_DIR:2:two.tif")
        self.assertIn(f'dem = "GTIFF_DIR:2:{self.path("two.tif")}"', self.read_text("out/scenario.toml"))
        self.run_well("check", self.path("s.toml"), cwd=self.path("out"))
        os.mkdir(self.path("other"))
        self.write("other/s.toml", SCENARIO.format(dem="GTIFF_DIR:2:two.tif").replace("sources.gpkg", "../sources.gpkg"))
        self.fails(2, "no such file (GTIFF_DIR:2:" + self.path("other/two.tif") + ")", cwd=self.folder,
                   arguments=["run", self.path("other/s.toml"), "-o", self.path("no")])  # one in the current folder is not it


if __name__ == "__main__":
    unittest.main()
