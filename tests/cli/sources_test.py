"""talus sources: candidate source cells, against gdaldem and by hand."""
import hashlib
import math
import os
import sqlite3
import unittest

import numpy as np
from osgeo import gdal

from support import NORTH, WEST, Case, box, edited_by_a_viewer, heights, rows_of, sqlite_rows, write_dem, write_features

CELL = 5.0


def ridge(columns=40, rows=30):
    """Flat, a wall of 60 degrees over columns 10-19, flat; a hole in the middle of the wall."""
    x = np.arange(columns)[None, :] * CELL + np.zeros((rows, 1))
    return (1000.0 + math.tan(math.radians(60.0)) * np.clip(x - 10 * CELL, 0.0, 9 * CELL)).astype(np.float32)


class Sources(Case):
    def find(self, *extra, dem="dem.tif", out="cells.gpkg"):
        return self.run_well("sources", "--dem", self.path(dem), "-o", self.path(out), *extra)

    def layers(self, out="cells.gpkg"):
        return rows_of(self.path(out), "source_polygons"), rows_of(self.path(out), "source_points")

    def digest(self, name):
        with open(self.path(name), "rb") as file:
            return hashlib.sha256(file.read()).hexdigest()

    def test_a_wall_by_hand(self):
        write_dem(self.path("dem.tif"), ridge(), CELL)
        done = self.find("--slope", "59.99")
        polygons, points = self.layers()
        # Of the 10 columns of the wall 8 have both neighbours on it; 28 of 30 rows are not at the rim.
        self.assertEqual(len(points), 8 * 28)
        self.assertEqual(len(polygons), 1)
        fields, shape = polygons[0]
        self.assertEqual(fields["cells"], 8 * 28)
        self.assertAlmostEqual(fields["slope_deg"], 60.0, 3)
        self.assertAlmostEqual(fields["slope_max_deg"], 60.0, 3)
        self.assertAlmostEqual(fields["plan_area_m2"], 8 * 28 * 25.0, 6)
        self.assertAlmostEqual(fields["area_m2"], 2.0 * 8 * 28 * 25.0, 0)  # 1 / cos(60 deg) = 2
        self.assertAlmostEqual(shape.Area(), 8 * 28 * 25.0, 6)
        self.assertEqual(shape.GetEnvelope(), (WEST + 55.0, WEST + 95.0, NORTH - 145.0, NORTH - 5.0))
        self.assertEqual(points[0][1].GetPoint_2D(), (WEST + 57.5, NORTH - 7.5))
        self.assertAlmostEqual(points[0][0]["area_m2"], 50.0, 2)
        self.assertIn("224 of 1 200 cells", done.stderr)

    def test_frequencies_by_true_area_are_those_of_the_areas_in_the_layer(self):
        """Rough ground, where another rule for the slope gives other areas."""
        rough = np.random.default_rng(5).normal(0.0, 1.5, (60, 60))
        write_dem(self.path("dem.tif"), (heights() + rough).astype(np.float32), CELL)
        self.assertIn("--slope = 0.8: is in degrees", self.find("--slope", "0.8", "--overwrite").stderr)
        self.find("--slope", "45", "--overwrite")
        area = sum(fields["area_m2"] for fields, _ in self.layers()[0])
        self.assertGreater(area, 1000.0)
        self.write("s.toml", 'dem = "dem.tif"\ntrajectories = 1\n[sources]\nfile = "cells.gpkg|layername=source_polygons"\n'
                   "[blocks]\ndiameter = 1\n[frequency]\nby_true_area = true\nper_area = 1e-3\n")
        self.run_well("run", self.path("s.toml"), "-o", self.path("out"), "-q")
        self.run_well("hazard", self.path("out"), "-q")
        self.assertAlmostEqual(self.read_json("out/hazard.json")["events_per_year"] / (1e-3 * area), 1.0, 9)

    def test_the_cells_are_those_of_gdaldem(self):
        z = heights(60, 60) + 30.0 * np.abs(np.sin(np.arange(60) / 3.0))[None, :]
        z[20:23, 30] = -9999.0
        write_dem(self.path("dem.tif"), z.astype(np.float32), CELL, nodata=-9999.0)
        self.assertNotIn("is in degrees", self.find("--slope", "50").stderr)
        reference = gdal.DEMProcessing("", self.path("dem.tif"), "slope", format="MEM")
        slope = reference.ReadAsArray()
        marks = slope >= 50.0
        self.assertTrue(50 < marks.sum() < 3000)
        mine = np.zeros_like(marks)
        for fields, point in self.layers()[1]:
            row, column = int((NORTH - point.GetY()) / CELL), int((point.GetX() - WEST) / CELL)
            mine[row, column] = True
            self.assertAlmostEqual(fields["slope_deg"], float(slope[row, column]), 3)
        self.assertEqual((mine != marks).sum(), 0)
        self.assertEqual(sum(fields["cells"] for fields, _ in self.layers()[0]), marks.sum())
        self.assertGreater(len(self.layers()[0]), 1)

    def test_a_run_takes_the_file_and_starts_from_the_cells(self):
        write_dem(self.path("dem.tif"), ridge(), CELL)
        self.find()
        self.run_well("run", "--dem", self.path("dem.tif"), "--sources", self.path("cells.gpkg"), "--diameter", "0.8",
                      "--trajectories", "2", "-o", self.path("out"))
        self.assertEqual(self.record()["source_cells"], len(self.layers()[1]))

    def test_equal_bytes_and_default_threshold(self):
        write_dem(self.path("dem.tif"), ridge(), CELL)
        done = self.find()
        self.find("-q", out="again.gpkg")
        self.assertIn("48.75 deg (the default for cells of 5 m)", done.stderr)
        contents = []
        for name in ("cells.gpkg", "again.gpkg"):
            with open(self.path(name), "rb") as file:
                contents.append(file.read())
        self.assertEqual(contents[0], contents[1])

    def test_faults_leave_nothing(self):
        before = os.listdir(self.folder)
        arguments = ["sources", "--dem", self.path("dem.tif"), "-o", self.path("cells.gpkg")]
        self.fails(2, "--slope = 90", "below 90 deg", arguments=[*arguments, "--slope", "90"])
        self.fails(2, "no cell is at least 80 deg steep", "--slope", arguments=[*arguments, "--slope", "80"])
        self.fails(2, "cells.shp", ".gpkg", arguments=[*arguments[:-1], self.path("cells.shp")])
        self.fails(2, "no folder can be made", arguments=[*arguments[:-1], self.path("dem.tif/cells.gpkg")])
        self.fails(2, "none.tif", arguments=["sources", "--dem", self.path("none.tif"), "-o", self.path("cells.gpkg")])
        self.fails(2, "--dem", arguments=["sources", "-o", self.path("cells.gpkg")])
        self.fails(2, "too long for its temporary file; give a shorter one", arguments=[*arguments[:-1], self.path(250 * "d" + ".gpkg")])
        self.assert_nothing_left(before)

    def test_a_file_is_kept_and_overwritten_when_asked(self):
        self.find("--slope", "30")
        self.fails(2, "is there already", arguments=["sources", "--dem", self.path("dem.tif"), "-o",
                                                     self.path("cells.gpkg")])
        self.fails(2, "no cell", arguments=["sources", "--dem", self.path("dem.tif"), "-o", self.path("cells.gpkg"),
                                            "--slope", "85", "--overwrite"])
        count = len(self.layers()[1])
        self.find("--slope", "34.9", "--overwrite")
        self.assertLess(len(self.layers()[1]), count)

    def test_only_files_of_the_same_command_are_replaced(self):  # those of the other command were, without a word
        self.find("--slope", "30")
        pits = ["check", *self.arguments()[1:-2], "-q", "--overwrite", "--pits"]
        sources = ["sources", "--dem", self.path("dem.tif"), "--slope", "30", "-q", "--overwrite", "-o"]
        before = self.digest("cells.gpkg")
        self.fails(2, "what the same command has written (pits)", "other layers: source_polygons, source_points", "give a new name",
                   arguments=[*pits, self.path("cells.gpkg")])
        self.assertEqual(self.digest("cells.gpkg"), before)
        self.run_well(*pits[:-2], "--pits", self.path("pits.gpkg"))
        before = self.digest("pits.gpkg")
        self.fails(2, "(source_polygons, source_points)", "other layers: pits", arguments=[*sources, self.path("pits.gpkg")])
        self.assertEqual(self.digest("pits.gpkg"), before)
        write_features(self.path("others.gpkg"), "pits", [(box(1, 1, 1, 1), [])])
        self.fails(2, "was written by another program", arguments=[*pits, self.path("others.gpkg")])
        with open(self.path("json.gpkg"), "w", encoding="utf-8") as file:  # GDAL opens it whatever its name is
            file.write('{"type": "FeatureCollection", "name": "pits", "features": []}')
        self.fails(2, "is no GeoPackage", arguments=[*pits, self.path("json.gpkg")])

    def test_a_style_of_the_user_is_not_lost(self):  # that QGIS has saved in the file
        self.find("--slope", "30")
        self.find("--slope", "31", "--overwrite")
        with sqlite3.connect(self.path("cells.gpkg")) as file:
            file.execute("insert into layer_styles (f_table_name, styleName, styleQML, update_time) "
                         "values ('source_points', 'mine', '<qgis/>', '2026-11-30T12:00:00Z')")
        file.close()
        self.fails(2, "was edited after talus had written it (layer_styles)",
                   arguments=["sources", "--dem", self.path("dem.tif"), "--slope", "30", "-o", self.path("cells.gpkg"), "--overwrite"])

    def test_a_link_stays_and_leads_to_the_new_file(self):  # it was replaced by a file, the file it led to stayed
        os.mkdir(self.path("far"))
        os.symlink("far/cells.gpkg", self.path("cells.gpkg"))
        self.fails(2, "is a link to far/cells.gpkg, which is not there",
                   arguments=["sources", "--dem", self.path("dem.tif"), "-o", self.path("cells.gpkg")])
        self.find("--slope", "30", out="far/cells.gpkg")
        count = len(self.layers()[1])
        self.find("--slope", "34.9", "--overwrite")
        self.assertEqual(os.readlink(self.path("cells.gpkg")), "far/cells.gpkg")
        self.assertEqual(os.listdir(self.path("far")), ["cells.gpkg"])
        self.assertLess(len(self.layers()[1]), count)
        os.rename(self.path("far/cells.gpkg"), self.path("far/cells.bak"))
        os.symlink("cells.bak", self.path("far/cells.gpkg"))
        self.fails(2, "cells.bak, which must end in .gpkg", "give another name",
                   arguments=["sources", "--dem", self.path("dem.tif"), "-o", self.path("cells.gpkg"), "--overwrite"])

    def test_the_log_of_an_earlier_file_goes_with_it(self):  # the new file was read as damaged
        self.find("--slope", "30")
        viewer = edited_by_a_viewer(self.path("cells.gpkg"))
        self.addCleanup(viewer.close)
        self.assertGreater(os.path.getsize(self.path("cells.gpkg-wal")), 100_000)
        self.find("--slope", "34.9", "--overwrite")
        self.find("--slope", "34.9", out="fresh.gpkg")
        self.assertEqual([name for name in os.listdir(self.folder) if name.startswith("cells.gpkg")], ["cells.gpkg"])
        self.assertEqual(sqlite_rows(self.path("cells.gpkg"), "pragma integrity_check"), [("ok",)])
        for rows in ("select fid, slope_deg, hex(geom) from source_points", "select table_name, description from gpkg_contents"):
            self.assertEqual(sqlite_rows(self.path("cells.gpkg"), rows), sqlite_rows(self.path("fresh.gpkg"), rows))


if __name__ == "__main__":
    unittest.main()
