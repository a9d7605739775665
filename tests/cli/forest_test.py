"""forest-stems from rasters and from lists of trees, through `talus run`, `check` and `merge`."""
import os
import unittest

import numpy as np
from osgeo import gdal, ogr

from results_test import digests
from support import NORTH, WEST, Case, bands_of, box, system, write_dem, write_features

HEAD = """dem = "dem.tif"
trajectories = 60
[sources]
file = "sources.gpkg"
[blocks]
diameter = 0.8
[effects.forest-stems]
"""
CELLS = 60  # of 5 m


def rows_of_trees(spacing=4.0):
    """Trees in rows across the slope, y 120 to 200 m from the lower edge."""
    return [(x, y) for y in np.arange(120.0, 200.0, spacing) for x in np.arange(60.0 + (y % 8) / 4, 240.0, spacing)]


def results(folder):
    """Digests of all results but the scenario, which names other files."""
    return {name: digest for name, digest in digests(folder).items() if name != "scenario.toml"}


class Forests(Case):
    def raster(self, name, values, **options):
        write_dem(self.path(name), np.asarray(values, dtype=np.float32), **options)

    def trees(self, name, trees, header="x,y,diameter,species", more=",0.5,conifer"):
        lines = [f"{WEST + x},{NORTH - 300.0 + y}{more}" for x, y in trees]
        return self.write(name, "\n".join([header, *lines]) + "\n")

    def run_forest(self, name, keys, *arguments):
        self.write(name + ".toml", HEAD + keys)
        done = self.run_well("run", self.path(name + ".toml"), "-o", self.path(name), *arguments)
        return done.stderr

    def fails_with(self, keys, *words):
        self.write("s.toml", HEAD + keys)
        self.fails(2, *words, arguments=["run", self.path("s.toml"), "-o", self.path("none")])
        self.assertFalse(os.path.exists(self.path("none")))

    def assert_replays(self, name):
        self.run_well("run", self.path(name + "/scenario.toml"), "-o", self.path(name + "-again"))
        self.assertEqual(digests(self.path(name + "-again")), digests(self.path(name)))

    def test_equal_cells_are_the_uniform_stand(self):
        self.raster("density.tif", np.full((CELLS, CELLS), 600.0))
        self.raster("dbh.tif", np.full((CELLS, CELLS), 0.25))
        self.run_forest("uniform", "density = 600\ndiameter = 0.25\n")
        told = self.run_forest("cells", 'density = "density.tif"\ndiameter = "dbh.tif"\n')
        self.run_forest("mixed", 'density = "density.tif"\ndiameter = 0.25\n')
        for name in ("cells", "mixed"):
            self.assertEqual(results(self.path(name)), results(self.path("uniform")))
        self.assertIn("forest-stems acts in 3600 of 3600 cells (9 ha): density = 600 1/ha, diameter = 0.25 m", told)
        record = self.record("cells")
        roles = {i["role"]: i for i in record["inputs"]}
        for key in ("density", "diameter"):
            self.assertEqual(len(roles["effects.forest-stems." + key]["sha256"]), 64)
        self.assert_replays("cells")

    def test_a_forest_in_cells_acts_there_only(self):
        density = np.zeros((CELLS, CELLS))
        density[20:30] = 900.0  # y 150 to 200
        self.raster("density.tif", np.where(density > 0, density, -9999.0), nodata=-9999.0)
        plain = self.write("plain.toml", HEAD.replace("[effects.forest-stems]\n", ""))
        self.run_well("run", plain, "-o", self.path("plain"))
        told = self.run_forest("forest", 'density = "density.tif"\ndiameter = 0.5\n')
        self.assertIn("forest-stems acts in 600 of 3600 cells (1.5 ha): density = 900 1/ha", told)
        self.assertIn("3000 of 3600 cells of the DEM have no value", told)
        a, b = (bands_of(self.path(n + "/velocity.tif"))[0] for n in ("plain", "forest"))
        above, inside = slice(13, 19), slice(26, 30)
        both = (a[above] > 0) & (b[above] > 0)
        np.testing.assert_allclose(b[above][both], a[above][both], rtol=0.02)
        mean = [np.mean(v[inside][v[inside] > 0]) for v in (a, b)]
        self.assertLess(mean[1], 0.75 * mean[0])
        self.assert_replays("forest")

    def test_another_grid_and_system_is_taken_pixel_by_pixel(self):
        fine = np.full((2 * CELLS, 2 * CELLS), 700.0)
        fine[:, CELLS:] = 0.0  # the eastern half
        write_dem(self.path("fine.tif"), fine.astype(np.float32), cell=2.5)
        gdal.Warp(self.path("other.tif"), self.path("fine.tif"), dstSRS="EPSG:21781", xRes=1.0, yRes=1.0)
        for name in ("fine", "other"):
            told = self.run_forest(name, f'density = "{name}.tif"\ndiameter = 0.25\n')
            self.assertIn("acts in 1800 of 3600 cells", told.replace("1799", "1800").replace("1801", "1800"))
        self.assertEqual([r["role"] for r in self.record("other")["reprojections"]], ["effects.forest-stems.density"])

    def test_a_list_of_trees(self):
        self.trees("trees.csv", rows_of_trees())
        plain = self.write("plain.toml", HEAD.replace("[effects.forest-stems]\n", ""))
        self.run_well("run", plain, "-o", self.path("plain"))
        told = self.run_forest("trees", 'trees = "trees.csv"\nheight = 25\n', "--threads", "1")
        self.assertIn(f"forest-stems: {len(rows_of_trees())} trees, diameter 0.5 m", told)
        self.run_forest("threads", 'trees = "trees.csv"\nheight = 25\n', "--threads", "3")
        self.assertEqual(digests(self.path("threads")), digests(self.path("trees")))
        self.assertNotEqual(digests(self.path("trees"))["velocity.tif"], digests(self.path("plain"))["velocity.tif"])
        a, b = (bands_of(self.path(n + "/velocity.tif"))[0] for n in ("plain", "trees"))
        inside = slice(26, 36)
        self.assertLess(np.mean(b[inside][b[inside] > 0]), 0.8 * np.mean(a[inside][a[inside] > 0]))
        complete = self.path("trees/scenario.toml")
        text = self.read_text(complete)
        self.assertIn("trees = ", text)
        self.assertNotIn("density = 0", text)
        self.assert_replays("trees")
        self.assertIn(",stem", "".join(
            self.run_well("trace", complete, "--source", "0", "--block", str(block)).stdout for block in range(5)))
        file = ogr.GetDriverByName("GPKG").CreateDataSource(self.path("trees.gpkg"))  # the same as a layer
        layer = file.CreateLayer("trees", system(2056), ogr.wkbPoint)
        layer.CreateField(ogr.FieldDefn("diameter", ogr.OFTReal))
        layer.CreateField(ogr.FieldDefn("Species", ogr.OFTString))
        layer.StartTransaction()
        for x, y in rows_of_trees():
            tree = ogr.Feature(layer.GetLayerDefn())
            tree.SetGeometry(ogr.CreateGeometryFromWkt(f"POINT ({WEST + x} {NORTH - 300.0 + y})"))
            tree.SetField(0, 0.5)
            tree.SetField(1, "CONIFER")
            layer.CreateFeature(tree)
        layer.CommitTransaction()
        layer = file = None
        self.run_forest("layer", 'trees = "trees.gpkg"\nheight = 25\n')
        self.assertEqual(results(self.path("layer")), results(self.path("trees")))

    def test_trees_of_an_included_file_stay_or_are_replaced_but_never_vanish(self):
        self.trees("trees.csv", rows_of_trees())
        self.write("stand.toml", '[effects.forest-stems]\ntrees = "trees.csv"\n')

        def scenario(keys):
            return 'include = "stand.toml"\n' + HEAD + keys

        for keys in ("diameter = 0.5\n", 'zones = ["default"]\n', 'file = "sources.gpkg"\n'):
            self.write("s.toml", scenario(keys))
            self.fails(2, keys.split(" ")[0], "must not come with the trees of an included file",
                       arguments=["run", self.path("s.toml"), "-o", self.path("none")])
        self.write("s.toml", scenario(""))
        self.assertIn(f"{len(rows_of_trees())} trees", self.run_well("run", self.path("s.toml"), "-o", self.path("kept")).stderr)
        self.assert_replays("kept")
        os.mkdir(self.path("stands"))
        for name in ("stand.toml", "trees.csv"):
            os.rename(self.path(name), self.path("stands/" + name))
        self.write("s.toml", scenario("").replace("stand.toml", "stands/stand.toml"))
        self.run_well("run", self.path("s.toml"), "-o", self.path("folder"))
        self.assertEqual(results(self.path("folder")), results(self.path("kept")))
        self.write("s.toml", scenario("density = 600\ndiameter = 0.25\n").replace("stand.toml", "stands/stand.toml"))
        self.assertNotIn(" trees,", self.run_well("run", self.path("s.toml"), "-o", self.path("stand")).stderr)
        self.run_forest("uniform", "density = 600\ndiameter = 0.25\n")
        self.assertEqual(results(self.path("stand")), results(self.path("uniform")))

    def test_parts_are_joined_and_a_changed_forest_is_refused(self):
        self.trees("trees.csv", rows_of_trees())
        keys = 'trees = "trees.csv"\n'
        self.run_forest("whole", keys)
        self.run_forest("one", keys, "--part", "1/2")
        self.run_forest("two", keys, "--part", "2/2")
        self.run_well("merge", self.path("merged"), self.path("one"), self.path("two"))
        self.assertEqual(digests(self.path("merged")), digests(self.path("whole")))
        self.trees("trees.csv", rows_of_trees()[:-1])
        self.run_forest("other", keys, "--part", "2/2")
        done = self.call("merge", self.path("no"), self.path("one"), self.path("other"))
        self.assertEqual(done.returncode, 2, done.stderr)

    def test_trees_that_are_left_out_are_counted(self):
        self.write("trees.csv", "x,y,diameter,crown\n" + "".join(
            f"{x},{y},{d},3\n" for x, y, d in [(WEST + 100, NORTH - 100, 0.3), (WEST + 100, NORTH - 100, 0.4),
                                               (WEST + 100, NORTH - 90, ""), (WEST - 5, NORTH - 90, 0.3)]))
        told = self.run_forest("left", 'trees = "trees.csv"\n')
        for words in ("forest-stems: 1 trees", "1 trees stand off the DEM", "1 trees have no diameter",
                      "1 trees stand at the very place", "fields that are not read: crown", "all as silver fir"):
            self.assertIn(words, told)
        plan = self.run_well("check", self.path("left.toml")).stdout
        self.assertIn("forest-stems: 1 trees", plan)
        self.write("trees.csv", f"x,y,diameter,species\n{WEST + 100},{NORTH - 100},0.3,conifer\n{WEST + 100},{NORTH - 90},0.3,\n")
        self.assertIn("1 features have no species: taken as silver fir",
                      self.run_forest("unknown", 'trees = "trees.csv"\n', "--overwrite"))

    def test_wrong_input_gets_one_clear_error(self):
        self.raster("negative.tif", np.full((CELLS, CELLS), -5.0))
        self.raster("centimetres.tif", np.full((CELLS, CELLS), 30.0))
        self.raster("bare.tif", np.zeros((CELLS, CELLS)))
        self.raster("far.tif", np.full((CELLS, CELLS), 300.0), transform=(WEST + 9000, 5.0, 0.0, NORTH, 0.0, -5.0))
        one = [(100.0, 150.0)]
        self.trees("thick.csv", one, more=",30,conifer")
        self.trees("palm.csv", one, more=",0.3,palm")
        self.trees("off.csv", [(-900.0, 150.0)])
        self.trees("dbh.csv", one, header="x,y,dbh,species")
        self.trees("empty.csv", [])
        self.trees("nowhere.csv", one, header="east,north,diameter,species")
        place = f"{WEST + 100},{NORTH - 150}"
        self.write("word.csv", f"x,y,diameter\n{place},0.3\n{place},thick\n{place},0.3\n")
        self.write("late.csv", "x,y,diameter\n" + f"{place},0.3\n" * 60000 + f"{place},0.3x\n")  # after 1 MB
        write_features(self.path("area.gpkg"), "area", [(box(0, 0, 9, 9), [0.3])], [("diameter", ogr.OFTReal)])
        for keys, words in {
                'density = "negative.tif"\n': ["negative.tif: -5 at 26", "must be 0 to 10000 1/ha"],
                'density = 100\ndiameter = "centimetres.tif"\n': ["centimetres.tif: 30 at 26", "0.01 to 3 m", "centimetres?"],
                'density = "bare.tif"\n': ["bare.tif: no cell of the DEM has a forest"],
                'density = "far.tif"\n': ["far.tif: no cell of the DEM has a forest", "3600 of 3600 cells without"],
                'density = "no.tif"\n': ["s.toml:8: effects.forest-stems.density = 'no.tif'", "no such file"],
                'diameter = "bare.tif"\n': ["does nothing, must give density"],
                'density = "dem.tif"\nheight = "dem.tif"\n': ["effects.forest-stems.height"],
                'trees = "thick.csv"\n': ["field diameter = 30", "0.01 to 3 m", "centimetres?"],
                'trees = "palm.csv"\n': ["palm.csv: row 1 below the header: unknown species 'palm'", "broadleaf", "conifer",
                                         "spruce, larch, pine"],
                'trees = "word.csv"\n': ["word.csv: row 2 below the header: field diameter = 'thick'", "must be a number in m"],
                'trees = "late.csv"\n': ["late.csv: row 60001 below the header: field diameter = '0.3x'"],
                'trees = "nowhere.csv"\n': ["nowhere.csv", "the columns x and y, or wkt; has east, north, diameter, species"],
                'density = 100\ndiameter = 30\n': ["diameter = 30: must be 0.01 to 3 m", "centimetres?"],
                'trees = "off.csv"\n': ["off.csv: none of its 1 trees can be used: 1 stand off the DEM"],
                'trees = "dbh.csv"\n': ["dbh.csv: has no field 'diameter'", "dbh"],
                'trees = "empty.csv"\n': ["empty.csv"],
                'trees = "area.gpkg"\n': ["area.gpkg: feature 1: is no point"],
                'trees = "palm.csv"\ndensity = 100\n': ["effects.forest-stems.density", "must not come with trees"],
                'trees = "palm.csv"\nzones = ["default"]\n': ["effects.forest-stems.zones", "must not come with trees"],
        }.items():
            with self.subTest(keys):
                self.fails_with(keys, *words)

    def test_a_raster_beside_trees_is_one_fault(self):
        self.raster("density.tif", np.full((CELLS, CELLS), 300.0))
        self.trees("trees.csv", [(100.0, 150.0)])
        self.write("s.toml", HEAD + 'trees = "trees.csv"\ndensity = "density.tif"\n')
        done = self.call("check", self.path("s.toml"))
        self.assertEqual(done.returncode, 2)
        self.assertEqual(done.stderr.count("talus: error: "), 1, done.stderr)
        self.assertIn("must not come with trees", done.stderr)

    def test_a_density_that_is_not_per_hectare_is_said(self):
        values = np.full((CELLS, CELLS), 0.2)
        values[:, :40] = 0.45  # two thirds: the median
        for name, factor, warns in (("per_m2", 1.0, True), ("per_ha", 1000.0, False)):
            self.raster(name + ".tif", factor * values)
            told = self.run_forest(name, f'density = "{name}.tif"\n')
            self.assertEqual("the median density of the forest is 0.45 stems/ha, stands have 100 to 2000" in told, warns, told)

    def check(self, keys, head=HEAD):
        self.write("s.toml", head + keys)
        return self.run_well("check", self.path("s.toml")).stdout

    def test_a_forest_that_no_stand_can_be_is_said(self):
        """N pi/4 DBH^2 is 43 m2/ha for 450 stems of 0.35 m, ten times that for 4500, and 428 for 450 of 1.1 m, their girth."""
        for density, diameter, words in ((450, 0.35, ""), (4500, 0.35, "more wood than any stand has"),
                                         (450, 1.1, "more wood than any stand has"),
                                         (0.045, 0.35, "the median density of the forest is 0.045 stems/ha")):
            self.raster("density.tif", np.full((CELLS, CELLS), density))
            self.raster("dbh.tif", np.full((CELLS, CELLS), diameter))
            for keys in (f"density = {density}\ndiameter = {diameter}\n", 'density = "density.tif"\ndiameter = "dbh.tif"\n'):
                with self.subTest(keys):
                    told = self.check(keys)
                    self.assertEqual("of the forest is" in told, words != "", told)
                    self.assertIn(words, told)

    def test_a_forest_is_counted_where_it_acts(self):
        """It stands in the eastern half only; of the polygons one lies there, one does not."""
        density = np.zeros((CELLS, CELLS))
        density[:, 30:] = 2500.0
        density[:, 50:] = 4500.0
        self.raster("density.tif", density)
        for name, x in (("east", 200), ("west", 50)):
            write_features(self.path(name + ".gpkg"), name, [(box(x, 100, 20, 50), [])])
        told = self.check('density = "density.tif"\ndiameter = 0.15\nfile = "east.gpkg"\n')
        self.assertEqual(told.count("acts in"), 1, told)
        self.assertIn("forest-stems acts in 40 of 3600 cells (0.1 ha): density = 2500 1/ha", told)
        self.assertIn("density = 2500 to 4500 (mean 3167) 1/ha",  # 20 of its 30 columns have 2500
                      self.check('density = "density.tif"\ndiameter = 0.15\n'))
        told = self.run_forest("west", 'density = "density.tif"\ndiameter = 0.15\nfile = "west.gpkg"\n')
        self.assertNotIn("acts in", told)
        self.assertIn("[effects.forest-stems] acts nowhere", told)
        self.assertEqual(self.record("west")["effects"], [])
        self.run_well("run", self.write("plain.toml", HEAD.replace("[effects.forest-stems]\n", "")), "-o", self.path("plain"))
        self.assertEqual(results(self.path("west")), results(self.path("plain")))

    def test_a_hole_at_the_edge_of_a_stand_is_a_gap(self):
        """A lane of 10 x 25 m (10 cells) in a stand of 50 x 50 m (100 cells), as a hole that shares an edge with the outer
        ring: an invalid polygon."""
        x, y = WEST + 100.0, NORTH - 200.0
        rings = [[(0, 0), (50, 0), (50, 50), (0, 50)], [(20, 0), (30, 0), (30, 25), (20, 25)]]
        text = ", ".join("(" + ", ".join(f"{x + e} {y + n}" for e, n in [*r, r[0]]) + ")" for r in rings)
        self.write("stand.csv", f'wkt,density\n"POLYGON ({text})",900\n')
        told = self.check('density = 300\nfile = "stand.csv"\n')
        self.assertIn("forest-stems acts in 90 of 3600 cells (0.225 ha): density = 300 1/ha", told)
        self.assertIn("no field is read; there are", told)
        self.assertIn("the field 'density' is not read: density of [effects.forest-stems] is that of the scenario", told)
        self.assertIn("gdal_rasterize -a density", told)

    def test_a_stand_is_counted_once(self):
        drag = "[effects.vegetation-drag]\ncoefficient = 100\n"
        self.trees("trees.csv", [(100.0, 150.0)])
        self.raster("density.tif", np.eye(CELLS))
        for keys in ('trees = "trees.csv"\n', 'density = "density.tif"\n'):
            self.fails_with(keys + drag, "vegetation-drag and forest-stems act at the same place")
        self.run_forest("both", 'trees = "trees.csv"\n' + drag + "[effects]\nallow_both = true\n")
        self.assert_replays("both")


class Presets(Case):
    def test_soil_types_of_rockyfor3d(self):
        told = self.run_well("presets").stdout
        for soil in range(8):
            self.assertIn(f"rockyfor3d-{soil} ", told)
        self.assertIn("none: a first guess", told)
        done = self.run_well(*self.arguments("r4"), "--preset", "rockyfor3d-4")
        self.assertIn("first guess: ground rockyfor3d-4 is for migration", done.stderr)
        self.assertIn("run-out may be too short (rough types: unsafe) or too long (smooth ones)", done.stderr)
        self.assertNotIn("block sizes: ", done.stderr)
        self.run_well(*self.arguments("talus"), "--preset", "upper-talus-3d")
        metres = [self.record(n)["trajectory_metres_plan"] for n in ("r4", "talus")]
        self.assertLess(metres[0], metres[1])  # docs/migration.md, "Limits"


if __name__ == "__main__":
    unittest.main()
