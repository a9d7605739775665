"""The common job without a scenario file: layers and fields by name, screens, zones, frequency and thresholds by flags."""
import csv
import os
import re
import shlex
import subprocess
import unittest

from osgeo import gdal, ogr

from support import NORTH, WEST, Case, box, heights, rows_of, system, write_dem, write_features


class Layers(Case):
    def setUp(self):
        super().setUp()
        file = ogr.GetDriverByName("GPKG").CreateDataSource(self.path("site.gpkg"))
        for name, x in (("houses", 280), ("cliffs", 140)):
            layer = file.CreateLayer(name, system(2056), ogr.wkbPolygon)
            layer.CreateField(ogr.FieldDefn("diameter", ogr.OFTReal))
            feature = ogr.Feature(layer.GetLayerDefn())
            feature.SetField(0, 1.2)
            feature.SetGeometry(ogr.CreateGeometryFromWkt(box(x, 230, 10, 10)))
            layer.CreateFeature(feature)
        self.flags = ["--dem", self.path("dem.tif"), "--trajectories", "5"]

    def rows(self, name):
        return list(csv.DictReader(self.read_text(name).splitlines()))

    def test_a_layer_is_named_or_the_file_is_refused(self):
        site = self.path("site.gpkg")
        self.fails(2, "houses, cliffs", "|layername=houses", arguments=["run", *self.flags, "--sources", site, "-o", self.path("o")])
        self.fails(2, "has no such layer", "cliffs", arguments=["run", *self.flags, "--sources", site + "|layername=cliff", "-o", self.path("o")])
        self.fails(2, "filter", arguments=["run", *self.flags, "--sources", site + "|layername=cliffs|subset=a = 1", "-o", self.path("o")])
        self.run_well("run", *self.flags, "--sources", site + "|layername=cliffs", "-o", self.path("named"))
        self.run_well("run", *self.flags, "--sources", site, "--sources-layer", "cliffs", "-o", self.path("flag"))
        self.run_well("run", *self.flags, "--sources", site + "|layerid=1", "-o", self.path("number"))
        for out in "flag", "number":
            for name in "impact_probability.tif", "energy.tif":
                self.assertTrue((gdal.Open(self.path(f"named/{name}")).ReadAsArray() == gdal.Open(self.path(f"{out}/{name}")).ReadAsArray()).all())
        self.run_well("trace", self.path("named/scenario.toml"), "--source", "0", "--block", "0")  # it keeps the layer
        source = next(i for i in self.record("named")["inputs"] if i["role"] == "sources")
        self.assertEqual(len(source["sha256"]), 64)

    def test_another_spelling_of_a_layer(self):  # "no such file"
        site, check = self.path("site.gpkg"), ["check", *self.flags, "--sources"]
        for end in ("layer=cliffs", "cliffs", "LayerName=cliffs", "layername = cliffs"):
            said = self.fails(2, "no such file", "; its layer is named by ", arguments=[*check, site + "|" + end]).stderr
            self.run_well(*check, re.search(r"its layer is named by '([^']+)'", said)[1])
        done = self.fails(2, "no such file", arguments=[*check, self.path("none.gpkg|layer=cliffs")])
        self.assertNotIn("layername", done.stderr)
        self.run_well("run", *self.flags, "--sources", site + "|layername=cliffs", "--diameter", "1", "-o", self.path("o"), "--frequency", "1")
        self.fails(2, "there is no such file; its layer is named by '" + site + "|layername=houses'",
                   arguments=["hazard", self.path("o"), "--objects", site + "|layer=houses"])

    def test_what_a_layer_name_may_not_do(self):
        """A name with a layer is a file, too: it is not overwritten, and parts with other layers are not merged."""
        site, check = self.path("site.gpkg"), ["check", *self.flags, "--sources"]
        for part in ("|geometrytype=Polygon", "|layerid=abc"):
            self.fails(2, f"'{part}' is not read", arguments=[*check, site + "|layername=cliffs" + part])
        for number in ("-5", "99999999999", "1x", ""):
            self.fails(2, f"'|layerid={number}' is not read", "a whole number from 0", "|layername=houses",
                       arguments=[*check, site + "|layerid=" + number])
        for parts in ("|layername=houses|layername=cliffs", "|layername=cliffs|layerid=1", "|layername="):
            self.fails(2, f"'{parts[parts.rindex('|'):]}' is not read: a file is followed by one layer", arguments=[*check, site + parts])
        self.fails(2, "has a layer already", arguments=[*check, site + "|layername=cliffs", "--sources-layer", "houses"])
        self.fails(2, "--sources-layer: has an empty value", arguments=[*check, site, "--sources-layer", ""])
        self.fails(2, "--parameters: has an empty value", arguments=[*check, site + "|layername=cliffs", "--parameters", ""])
        self.fails(2, "must come with --zones", arguments=[*check, site + "|layername=cliffs", "--zone-field", "kind"])
        self.fails(2, "flag --frequency = 0: must be above 0", arguments=[*check, site + "|layername=cliffs", "--frequency", "0"])
        self.run_well(*check, site + "|layername=cliffs", "--pits", self.path("p.gpkg"))
        self.fails(2, "is the file that --overwrite would replace",
                   arguments=[*check, self.path("p.gpkg|layername=pits"), "--diameter", "1", "--pits", self.path("p.gpkg"), "--overwrite"])
        years = ogr.GetDriverByName("GPKG").CreateDataSource(self.path("years.gpkg"))
        for year in "2019/cliffs", "2020/cliffs":
            layer = years.CreateLayer(year, system(2056), ogr.wkbPolygon)
            feature = ogr.Feature(layer.GetLayerDefn())
            feature.SetGeometry(ogr.CreateGeometryFromWkt(box(140, 230, 10, 10)))
            layer.CreateFeature(feature)
        layer = years = None
        for i, year in ((1, "2019/cliffs"), (2, "2020/cliffs")):
            self.run_well("run", *self.flags, "--sources", self.path("years.gpkg|layername=") + year, "--diameter", "1", "--part", f"{i}/2",
                          "-o", self.path(f"part{i}"))
        self.fails(2, "part", arguments=["merge", self.path("merged"), self.path("part1"), self.path("part2")])

    def test_objects_in_a_named_layer(self):
        self.run_well("run", *self.flags, "--sources", self.path("site.gpkg|layername=cliffs"), "--frequency", "1", "-o", self.path("out"))
        self.run_well("hazard", self.path("out"), "--objects", self.path("site.gpkg|layername=houses"))
        project = self.path("out/talus.qgs")
        text = self.read_text(project)
        with open(project, "w", encoding="utf-8") as file:
            file.write(text.replace("<qgis ", '<qgis saveDateTime="2026-11-23T10:00:00" ', 1))
        done = self.run_well("hazard", self.path("out"), "--overwrite")
        self.assertIn("talus.qgs was saved in QGIS and stays as it is", done.stderr)
        self.assertIn("saveDateTime", self.read_text(project))

    def test_objects_whose_fields_have_other_names(self):
        """As one whose fields have the usual names."""
        self.run_well("run", *self.flags, "--sources", self.path("site.gpkg|layername=cliffs"), "--frequency", "1", "-o", self.path("out"))
        road = f"LINESTRING ({WEST + 155} {NORTH - 120},{WEST + 155} {NORTH - 200})"  # down the slope
        shapes = [(road, [12.0, "Strasse"]), (box(140, 150, 10, 8), [None, "Haus"])]
        write_features(self.path("usual.gpkg"), "o", shapes, [("width", ogr.OFTReal), ("name", ogr.OFTString)])
        write_features(self.path("other.gpkg"), "o", shapes, [("Breite", ogr.OFTReal), ("Name des Hauses", ogr.OFTString)])
        hazard = ["hazard", self.path("out"), "--overwrite", "--objects"]
        self.run_well(*hazard, self.path("usual.gpkg"))
        usual = [(row["object"], row["frequency"]) for row in self.rows("out/objects.csv")]
        self.assertEqual([name for name, _ in usual], ["Strasse", "Haus"])
        other = [*hazard, self.path("other.gpkg")]
        done = self.run_well(*other, "--width-field", "Breite", "--name-field", "Name des Hauses")
        self.assertEqual([(row["object"], row["frequency"]) for row in self.rows("out/objects.csv")], usual)
        self.assertIn("lines: 1 as wide as their field Breite says", done.stderr)
        self.assertNotIn("no width", done.stderr)
        done = self.run_well(*other)
        self.assertIn(f"warning: {self.path('other.gpkg')}: 1 line has no width and counts as 0 m wide", done.stderr)
        self.assertIn("the fields Breite, Name des Hauses", done.stderr)
        self.assertIn("objects are called by the numbers of their features", done.stderr)
        self.assertLess(float(self.rows("out/objects.csv")[0]["frequency"]), float(usual[0][1]))
        self.assertNotIn("no width", self.run_well(*other, "--width", "12").stderr)
        self.assertEqual(self.rows("out/objects.csv")[0]["frequency"], usual[0][1])
        self.fails(2, "has no field 'Breit'", "did you mean 'Breite'?", arguments=[*other, "--width-field", "Breit"])
        self.fails(2, "has no field 'width'", arguments=[*other, "--width-field", "width"])
        self.fails(2, "--objects", arguments=["hazard", self.path("out"), "--overwrite", "--name-field", "name"])

    def test_an_object_without_geometry_is_left_out(self):
        self.run_well("run", *self.flags, "--sources", self.path("site.gpkg|layername=cliffs"), "--frequency", "1", "-o", self.path("out"))
        houses = [(box(0, 5000, 9, 9), ["lost"]), (box(140, 150, 10, 8), ["A"]), (box(0, 5000, 9, 9), ["far"]), (box(160, 150, 10, 8), ["B"]),
                  (box(0, 5000, 9, 9), ["lost"])]
        write_features(self.path("houses.gpkg"), "houses", houses, [("name", ogr.OFTString)])
        file = ogr.Open(self.path("houses.gpkg"), 1)
        layer = file.GetLayer()
        for number in (1, 5):
            feature = layer.GetFeature(number)
            feature.SetGeometry(None)
            layer.SetFeature(feature)
        feature = layer = None
        file = None
        done = self.run_well("hazard", self.path("out"), "--objects", self.path("houses.gpkg"))
        self.assertIn("objects without geometry, which have no results: features 1, 5", done.stderr)
        self.assertIn("objects wholly off the DEM, which have no results: far", done.stderr)
        rows = {row["object"]: row["frequency"] for row in self.rows("out/objects.csv")}
        self.assertEqual(list(rows), ["A", "far", "B"])
        self.assertEqual(rows["far"], "")
        write_features(self.path("two.gpkg"), "houses", [houses[1], houses[3]], [("name", ogr.OFTString)])
        self.run_well("hazard", self.path("out"), "--overwrite", "--objects", self.path("two.gpkg"))
        self.assertEqual({row["object"]: row["frequency"] for row in self.rows("out/objects.csv")}, {key: rows[key] for key in "AB"})
        done = self.run_well("hazard", self.path("out"), "--overwrite")
        self.assertRegex(done.stderr, "warning: removed, as not asked for this time: .*objects.csv")

    def test_edited_candidates_are_not_replaced(self):
        cells = self.path("cells.gpkg")
        sources = ["sources", "--dem", self.path("dem.tif"), "--slope", "10", "-o", cells, "--overwrite"]
        self.run_well(*sources)
        self.run_well(*sources)
        file = ogr.Open(cells, 1)
        file.GetLayerByName("source_polygons").DeleteFeature(1)
        file = None
        self.fails(2, "was edited after talus had written it (source_polygons)", "give a new name", arguments=sources)
        file = ogr.Open(cells)
        self.assertNotIn(1, [feature.GetFID() for feature in file.GetLayerByName("source_polygons")])

    def test_diameters_of_some_features(self):
        write_features(self.path("some.gpkg"), "cliffs", [(box(140, 230, 10, 10), [0.6]), (box(200, 230, 10, 10), [None])],
                       [("diameter", ogr.OFTReal)])
        done = self.run_well("check", *self.flags, "--sources", self.path("some.gpkg"), "--diameter", "1.2")
        self.assertRegex(done.stdout, "diameters +1.2 m, of features without one of their own\n +1 feature has a diameter of its own")

    def test_the_job_without_toml(self):
        zones = ogr.GetDriverByName("GPKG").CreateDataSource(self.path("zones.gpkg"))
        layer = zones.CreateLayer("zones", system(2056), ogr.wkbPolygon)
        layer.CreateField(ogr.FieldDefn("ground", ogr.OFTString))
        feature = ogr.Feature(layer.GetLayerDefn())
        feature.SetField(0, "forest-road-3d")
        feature.SetGeometry(ogr.CreateGeometryFromWkt(box(0, 0, 400, 150)))
        layer.CreateFeature(feature)
        zones = layer = None
        with open(self.path("line.csv"), "w", encoding="utf-8") as file:
            file.write(f'id,wkt\nroad,"LINESTRING ({WEST + 20} {NORTH - 150}, {WEST + 380} {NORTH - 150})"\n')
        flags = [*self.flags, "--sources", self.path("site.gpkg"), "--sources-layer", "cliffs", "--screens", self.path("line.csv"),
                 "--zones", self.path("zones.gpkg"), "--zone-field", "ground", "--frequency", "0.5", "--thresholds", "10,100"]
        done = self.run_well("run", *flags, "-o", self.path("out"))
        self.assertIn("zone forest-road-3d is the preset of this name", done.stderr)
        self.run_well("hazard", self.path("out"))
        self.assertTrue(gdal.Open(self.path("out/return_period_100.tif")))
        complete = self.read_text("out/scenario.toml")
        for words in ("total = 0.5", "energy_thresholds = [10, 100]", "[ground.zones.forest-road-3d]", 'field = "ground"'):
            self.assertIn(words, complete)
        self.run_well("run", self.path("out/scenario.toml"), "-o", self.path("again"))
        for name in "impact_probability.tif", "energy.tif":
            self.assertTrue((gdal.Open(self.path(f"out/{name}")).ReadAsArray() == gdal.Open(self.path(f"again/{name}")).ReadAsArray()).all())
        self.fails(2, "--thresholds = [100, 10]: must ascend", arguments=["run", *flags[:-1], "100,10", "-o", self.path("no")])
        self.fails(2, "flag --frequency", arguments=["run", *self.flags, "--sources", self.path("site.gpkg"), "--sources-layer", "cliffs",
                                                     "--frequency", "-1", "-o", self.path("no")])

    def test_barriers_by_a_flag_are_those_of_the_scenario(self):
        """A wall across the slope without a limit of energy: nothing that starts above it is found below."""
        with open(self.path("wall.csv"), "w", encoding="utf-8") as file:
            file.write(f'wkt,height,capacity\n"LINESTRING ({WEST - 50} {NORTH - 150}, {WEST + 500} {NORTH - 150})",100,1000000\n')
        flags = ["--dem", self.path("dem.tif"), "--trajectories", "20", "--sources", self.path("site.gpkg|layername=cliffs"),
                 "--barriers", self.path("wall.csv")]
        done = self.run_well("run", *flags, "-o", self.path("out"))
        self.assertIn("wall.csv: no field id or name: the lines are called by the numbers of their features", done.stderr)
        below = gdal.Open(self.path("out/impact_probability.tif")).ReadAsArray()
        row = int(150 / gdal.Open(self.path("out/impact_probability.tif")).GetGeoTransform()[1])
        self.assertGreater((below[:row] > 0).sum(), 0)
        self.assertEqual((below[row + 1:] > 0).sum(), 0)
        self.run_well("run", self.path("out/scenario.toml"), "-o", self.path("again"))
        self.assertTrue((gdal.Open(self.path("again/impact_probability.tif")).ReadAsArray() == below).all())
        self.fails(2, "has no height", arguments=["run", *flags[:-1], self.barrier_without("height"), "-o", self.path("no")])

    def barrier_without(self, field):
        text = self.read_text("wall.csv").replace(field, "other")
        return self.write("bad.csv", text)

    def write_sources(self, name, kind, values, field="diameter"):
        """Boxes side by side with the values in a field; as a GeoPackage or a Shapefile."""
        driver = "GPKG" if name.endswith(".gpkg") else "ESRI Shapefile"
        file = ogr.GetDriverByName(driver).CreateDataSource(self.path(name))
        layer = file.CreateLayer(os.path.splitext(name)[0], system(2056), ogr.wkbPolygon)
        layer.CreateField(ogr.FieldDefn(field, kind))
        for i, value in enumerate(values):
            feature = ogr.Feature(layer.GetLayerDefn())
            if value is not None:
                feature.SetField(0, value)
            feature.SetGeometry(ogr.CreateGeometryFromWkt(box(100 + 20 * i, 230, 10, 10)))
            layer.CreateFeature(feature)
        return self.path(name)

    def test_numbers_in_a_text_field_are_read_and_said(self):
        for name in "text.gpkg", "text.shp":
            source = self.write_sources(name, ogr.OFTString, ["1.2", "0.8", None])
            done = self.run_well("run", *self.flags, "--sources", source, "--diameter", "1", "-o", self.path("out"), "--overwrite")
            self.assertIn("diameter 0.8 to 1.2 m (2 of 3 features, 1 empty; text, read as numbers)", done.stderr)
            stops = [row for row, _ in rows_of(self.path("out/stops.gpkg"), "stops")]
            self.assertEqual(sorted({row["diameter_m"] for row in stops}), [0.8, 1.0, 1.2])
        # A comma may be one of thousands: never guessed.
        for values, fault, way in ((["1.2", "1,2"], "'1,2'", "to_real(replace(the field, ',', '.'))"),
                                   (["1.2", "1.2 m"], "'1.2 m'", "to_real(regexp_replace(the field, '[^0-9.,]', ''))")):
            source = self.write_sources("bad.gpkg", ogr.OFTString, values)
            self.fails(2, "feature 2: field diameter = " + fault, "must be a number in m", way,
                       arguments=["run", *self.flags, "--sources", source, "-o", self.path("no")])
            os.remove(source)

    def test_empty_velocities_are_said_to_count_as_0(self):
        write_features(self.path("v.gpkg"), "sources", [(box(100, 230, 10, 10), [1.0, None]), (box(140, 230, 10, 10), [None, None])],
                       [("vx", ogr.OFTReal), ("vy", ogr.OFTReal)])
        done = self.run_well("check", *self.flags, "--sources", self.path("v.gpkg"), "--diameter", "1")
        self.assertIn("vx 1 m/s (1 of 2 features, 1 empty, counted as 0), vy (empty, counted as 0)", done.stdout)

    def test_yes_and_no_are_no_numbers(self):  # a diameter of "yes" was 1 m
        file = ogr.GetDriverByName("GPKG").CreateDataSource(self.path("yes.gpkg"))
        layer = file.CreateLayer("yes", system(2056), ogr.wkbPolygon)
        field = ogr.FieldDefn("diameter", ogr.OFTInteger)
        field.SetSubType(ogr.OFSTBoolean)
        layer.CreateField(field)
        feature = ogr.Feature(layer.GetLayerDefn())
        feature.SetField(0, 1)
        feature.SetGeometry(ogr.CreateGeometryFromWkt(box(100, 230, 10, 10)))
        layer.CreateFeature(feature)
        file = layer = None
        self.fails(2, "feature 1: field diameter = yes is of the type Boolean, must be a number field in m",
                   arguments=["run", *self.flags, "--sources", self.path("yes.gpkg"), "-o", self.path("no")])

    def test_check_lists_every_fault_and_every_field(self):
        self.write_sources("bad.gpkg", ogr.OFTReal, [-1.0, 1.0, 5000.0, None])
        nets = ogr.GetDriverByName("GPKG").CreateDataSource(self.path("nets.gpkg"))
        layer = nets.CreateLayer("nets", system(2056), ogr.wkbLineString)
        for name in "height", "capacity", "Baujahr":
            layer.CreateField(ogr.FieldDefn(name, ogr.OFTReal))
        for height in (3.0, -2.0):
            feature = ogr.Feature(layer.GetLayerDefn())
            feature.SetField(0, height)
            feature.SetGeometry(ogr.CreateGeometryFromWkt(f"LINESTRING ({WEST} {NORTH - 200},{WEST + 300} {NORTH - 200})"))
            layer.CreateFeature(feature)
        nets = layer = None
        scenario = 'dem = "dem.tif"\ntrajectories = 2\n[sources]\nfile = "{}"\n[blocks]\ndiameter = 1\n[barriers]\nfile = "nets.gpkg"\n'
        done = self.call("check", self.write("bad.toml", scenario.format("bad.gpkg")))
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        said = done.stderr.splitlines()
        wanted = ("bad.gpkg: feature 1: field diameter = -1", "bad.gpkg: feature 3: field diameter = 5000",
                  "nets.gpkg: feature 1: has no capacity", "nets.gpkg: feature 2: field height = -2", "nets.gpkg: feature 2: has no capacity")
        self.assertEqual(len(said), len(wanted), done.stderr)
        for line, words in zip(said, wanted):
            self.assertIn(words, line)
        self.fails(2, "feature 1: field diameter = -1", "(and 1 more fault: talus check lists all)",
                   arguments=["run", self.path("bad.toml"), "-o", self.path("no")])
        good = self.write_sources("good.gpkg", ogr.OFTReal, [1.0, 2.0, None])
        nets = ogr.Open(self.path("nets.gpkg"), 1)
        layer = nets.GetLayer(0)
        for number in 1, 2:
            feature = layer.GetFeature(number)
            feature["height"], feature["capacity"] = 3.0, 400.0 + number
            layer.SetFeature(feature)
        nets = layer = feature = None
        said = self.run_well("check", self.write("good.toml", scenario.format(good))).stdout
        self.assertIn("good.gpkg: fields read: diameter 1 to 2 m (2 of 3 features, 1 empty)", said)
        self.assertIn("nets.gpkg: fields read: height 3 m (2 of 2 features), capacity 401 to 402 kJ (2 of 2 features); "
                      "others: Baujahr", said)

    def test_features_have_the_number_that_qgis_shows(self):
        source = self.write_sources("plain.gpkg", ogr.OFTReal, [1.0, 1.5], "frequency")
        self.run_well("run", *self.flags, "--sources", source, "--diameter", "1", "-o", self.path("out"))
        starts = {(row["feature"], row["x_release"] > WEST + 115) for row, _ in rows_of(self.path("out/stops.gpkg"), "stops")}
        self.assertEqual(starts, {("1", False), ("2", True)})
        self.run_well("hazard", self.path("out"), "-q", "--frequency", self.write("weights.toml", "[features]\n1 = 0.5\n2 = 0.25\n"))
        self.fails(2, "there is no such feature", "1, 2", arguments=["hazard", self.path("out"), "--overwrite", "--frequency",
                                                                     self.write("zero.toml", "[features]\n0 = 0.5\n")])

    def test_paths_in_commands_are_quoted(self):
        for folder in "a b", "it's", "$(touch x)":
            os.makedirs(self.path(folder))
            dem = self.path(f"{folder}/dem.tif")
            write_dem(dem, heights(), code=0)
            done = self.fails(2, "gdal_edit.py", arguments=["run", "--dem", dem, "--sources", self.path("sources.gpkg"), "-o", self.path("no")])
            self.assertEqual(shlex.split(done.stderr.split("with gdal_edit.py ")[1])[-1], dem)

    def test_parent_folders_are_made_and_not_left_behind(self):
        before = os.listdir(self.folder)
        self.fails(2, "diameter", arguments=["run", "--dem", self.path("dem.tif"), "--sources", self.path("sources.gpkg"),
                                              "-o", self.path("no/such/folder")])
        self.assertEqual(sorted(os.listdir(self.folder)), sorted(before))
        self.fails(2, "steep", arguments=["sources", "--dem", self.path("dem.tif"), "--slope", "89.9", "-o", self.path("no/such/cells.gpkg")])
        self.assertEqual(sorted(os.listdir(self.folder)), sorted(before))
        self.run_well(*self.arguments("some/new/folder", trajectories="3"), "-q")
        self.assertTrue(os.path.exists(self.path("some/new/folder/run.json")))
        self.run_well("sources", "--dem", self.path("dem.tif"), "--slope", "30", "-o", self.path("more/cells.gpkg"))
        self.assertTrue(os.path.exists(self.path("more/cells.gpkg")))
        self.run_well(*self.arguments("with/memory/out"), "--memory", "300M")
        self.assertEqual(os.listdir(self.path("with")) + os.listdir(self.path("with/memory")), ["memory", "out"])
        self.write("file", "")
        self.fails(2, "no folder can be made", arguments=self.arguments("file/out"))

    def test_a_picture_of_a_barrier_at_a_screen_with_any_name(self):
        with open(self.path("line.csv"), "w", encoding="utf-8") as file:
            file.write(f'id,wkt\n"L123 km 4,2","LINESTRING ({WEST + 20} {NORTH - 150}, {WEST + 380} {NORTH - 150})"\n')
        self.run_well(*self.arguments(trajectories="100"), "--screens", self.path("line.csv"), "-q")
        self.run_well("barrier", self.path("out"), "--screen", "L123 km 4,2", "-q")
        script = os.path.join(os.path.dirname(__file__), "../../tools/scripts/figures/barrier_picture.py")
        done = subprocess.run(["/usr/bin/python3", script, self.path("out"), "--screen", "L123 km 4,2", "-o", self.path("picture.png")],
                              capture_output=True, text=True, check=False)
        if "No module named 'matplotlib'" in done.stderr:
            self.skipTest("no matplotlib")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(os.path.getsize(self.path("picture.png")), 10000)


if __name__ == "__main__":
    unittest.main()
