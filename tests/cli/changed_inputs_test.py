"""Inputs that lie in several files, or in a part of one: a change of any of them is seen by the commands that repeat a run."""
import os
import unittest

from osgeo import gdal, ogr

from support import Case, box, heights, write_dem, write_features

SCENARIO = """dem = "{dem}"
trajectories = 4
[sources]
file = "sources.gpkg"
[blocks]
diameter = 0.8
"""


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

    def test_a_part_of_a_file_is_looked_up_in_the_folder_of_the_scenario(self):
        self.two_rasters()
        self.run_on("GTIFF_DIR:2:two.tif")
        with open(self.path("out/scenario.toml"), encoding="utf-8") as file:
            self.assertIn(f'dem = "GTIFF_DIR:2:{self.path("two.tif")}"', file.read())
        self.run_well("check", self.path("s.toml"), cwd=self.path("out"))
        os.mkdir(self.path("other"))
        self.write("other/s.toml", SCENARIO.format(dem="GTIFF_DIR:2:two.tif").replace("sources.gpkg", "../sources.gpkg"))
        self.fails(2, "no such file (GTIFF_DIR:2:" + self.path("other/two.tif") + ")", cwd=self.folder,
                   arguments=["run", self.path("other/s.toml"), "-o", self.path("no")])  # one in the current folder is not it


if __name__ == "__main__":
    unittest.main()
