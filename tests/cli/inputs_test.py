"""Inputs that once passed in silence: fields, tables, Shapefiles, rasters that are no DEM, folders with other files."""
import gzip
import json
import os
import shutil
import struct
import unittest
import zipfile

import numpy as np
from osgeo import gdal, ogr, osr

from support import NORTH, WEST, Case, OneThread, box, heights, rows_of, system, write_dem, write_features

X, Y = WEST + 150.0, NORTH - 65.0  # on the slope


def write_shapefile(path, diameters):
    file = ogr.GetDriverByName("ESRI Shapefile").CreateDataSource(path)
    layer = file.CreateLayer("cliffs", system(2056), ogr.wkbPolygon)
    layer.CreateField(ogr.FieldDefn("diameter", ogr.OFTReal))
    for i, diameter in enumerate(diameters):
        feature = ogr.Feature(layer.GetLayerDefn())
        feature.SetGeometry(ogr.CreateGeometryFromWkt(box(140 + 20 * i, 230, 10, 10)))
        feature.SetField(0, diameter)
        layer.CreateFeature(feature)


class InputCase(OneThread, Case):
    def flags(self, sources="sources.gpkg", dem="dem.tif", trajectories="5"):
        return ["--dem", self.path(dem), "--sources", self.path(sources), "--diameter", "1.2", "--trajectories", trajectories]

    def run_flags(self, *more, out="out", **flags):
        return self.run_well("run", *self.flags(**flags), "-o", self.path(out), *more)

    def refused(self, *words, more=(), **flags):
        """Both `run` and `check` refuse it with the words; no folder appears."""
        for command in (["run", *self.flags(**flags), *more, "-o", self.path("none")], ["check", *self.flags(**flags), *more]):
            self.fails(2, *words, arguments=command)
        self.assertFalse(os.path.exists(self.path("none")))

    def releases(self, out="out"):
        """Height of the release above the centre of its cell, by the first vertex of the paths."""
        z = heights()
        found = []
        for _, line in rows_of(self.path(out + "/trajectories.gpkg"), "trajectories"):
            x, y, height = line.GetX(0), line.GetY(0), line.GetZ(0)
            found.append(height - float(z[int((NORTH - y) // 5), int((x - WEST) // 5)]))
        return found


class Rasters(InputCase):
    def test_a_raster_of_sources_is_told_its_way_out(self):
        """As other programs have it."""
        self.refused("cannot be opened as a vector layer", "it is a raster: make polygons of it with gdal_polygonize.py",
                     sources="dem.tif")

    def test_cells_of_the_ground_are_those_that_have_a_height(self):
        """Counted alike with zones of polygons, of a raster and without: 60 x 60 cells, the northern row without a height."""
        write_features(self.path("sources.gpkg"), "sources", [(box(140, 230, 20, 10), [])])
        write_features(self.path("zones.gpkg"), "zones", [(box(0, 200, 300, 100), ["lower-talus-3d"])], [("zone", ogr.OFTString)])
        z = heights()
        z[0] = -9999
        write_dem(self.path("dem.tif"), z, nodata=-9999)
        codes = np.zeros(z.shape)
        codes[:20] = 1
        write_dem(self.path("zones.tif"), codes)
        said = self.run_well("check", *self.flags()).stdout
        self.assertIn("default: 3 540 cells", said)
        zones = ("--zones", self.path("zones.gpkg"), "--zone-field", "zone")
        self.assertIn("lower-talus-3d: 1 140 cells", self.run_well("check", *self.flags(), *zones).stdout)
        self.write("s.toml", '[ground]\nfile = "zones.tif"\n[ground.zones.0]\npreset = "upper-talus-3d"\n'
                   '[ground.zones.1]\npreset = "lower-talus-3d"\n')
        said = self.run_well("check", self.path("s.toml"), *self.flags()).stdout
        self.assertIn("1: 1 140 cells", said)
        self.assertIn("0: 2 400 cells", said)


class Fields(InputCase):
    def setUp(self):
        super().setUp()
        points = [(f"POINT ({WEST + 152.5 + 10 * i} {NORTH - 62.5})", [f"cliff {i}", 60.0 + i, 2.0]) for i in range(3)]
        write_features(self.path("sources.gpkg"), "sources", points,
                       [("name", ogr.OFTString), ("HEIGHT", ogr.OFTReal), ("Durchmesser", ogr.OFTReal)])

    def test_height_is_not_the_release_height(self):
        done = self.run_flags()
        self.assertLess(max(self.releases()), 2.0)
        self.assertIn("field HEIGHT is not read", done.stderr)
        self.assertIn("--field release_height=HEIGHT", done.stderr)
        self.assertIn("fields read: name (3 of 3 features); others: HEIGHT, Durchmesser", done.stderr)
        self.assertTrue(any("HEIGHT is not read" in note for note in self.record()["notes"]))
        self.assertIn("HEIGHT is not read", self.run_well("check", *self.flags()).stdout)

    def test_a_field_is_read_where_it_is_named(self):
        fields = ["--field", "release_height=HEIGHT", "--field", "diameter=durchmesser"]
        done = self.run_flags(*fields)
        for height, expected in zip(sorted(self.releases()), np.repeat([60.0, 61.0, 62.0], 5)):
            self.assertAlmostEqual(height, expected, delta=0.01)  # at the centre of a cell
        said = "diameter 2 m from Durchmesser (3 of 3 features), release_height 60 to 62 m from HEIGHT (3 of 3 features)"
        self.assertIn(said, done.stderr)
        self.assertNotIn("is not read", done.stderr)
        checked = self.run_well("check", *self.flags(), *fields).stdout
        self.assertIn(said, checked)
        self.assertRegex(checked, "diameters +3 features have a diameter of their own")  # not the 1.2 m that no block gets
        settings = {s["key"]: s for s in self.record()["settings"]}
        self.assertEqual(settings["sources.fields.release_height"]["value"], "HEIGHT")
        self.assertEqual(settings["sources.attributes.release_height"]["value"], "60 to 62 (3 of 3 features)")
        self.assertEqual(settings["sources.attributes.release_height"]["source"], "attribute HEIGHT of sources.gpkg")

    def test_the_scenario_of_a_run_keeps_the_names(self):
        self.run_flags("--field", "release_height=HEIGHT", "--field", "diameter=Durchmesser")
        self.assertIn('[sources.fields]\ndiameter = "Durchmesser"\nrelease_height = "HEIGHT"\n', self.read_text("out/scenario.toml"))
        self.run_well("run", self.path("out/scenario.toml"), "-o", self.path("again"), "-q")
        stops = [sorted((f["source"], f["block"], f["z"], p.GetX(), p.GetY()) for f, p in rows_of(self.path(out + "/stops.gpkg"), "stops"))
                 for out in ("out", "again")]
        self.assertEqual(stops[0], stops[1])
        for option, other, count in (("--source", "--block", "sources"), ("--block", "--source", "blocks")):
            self.fails(2, f"{option}: -1 is not there; this scenario has {count} 0 to ",
                       arguments=["trace", self.path("out/scenario.toml"), option, "-1", other, "0"])
        path = self.run_well("trace", self.path("out/scenario.toml"), "--source", "1", "--block", "2").stdout.splitlines()
        last = dict(zip(path[0].split(","), path[-1].split(",")))
        stop = next(f for f, _ in rows_of(self.path("out/stops.gpkg"), "stops") if (f["source"], f["block"]) == (1, 2))
        self.assertAlmostEqual(float(last["z"]), stop["z"], places=2)

    def test_a_flag_counts_more_than_the_scenario(self):
        self.write("s.toml", 'dem = "dem.tif"\ntrajectories = 5\n[sources]\nfile = "sources.gpkg"\n[sources.fields]\n'
                   'diameter = "HEIGHT"\nrelease_height = "HEIGHT"\n')
        self.fails(2, "field HEIGHT (diameter) = 60: must be 0.01 to 50 m", "(and 2 more faults: talus check lists all)",
                   arguments=["run", self.path("s.toml"), "-o", self.path("no")])
        done = self.run_well("run", self.path("s.toml"), "-o", self.path("out"), "--field", "diameter=Durchmesser")
        self.assertIn("diameter 2 m from Durchmesser", done.stderr)
        self.assertIn("release_height 60 to 62 m from HEIGHT", done.stderr)

    def test_a_fault_of_many_features_is_said_three_times(self):
        points = [(f"POINT ({WEST + 52.5 + i} {NORTH - 62.5})", [-1.0 - i, 800.0 if i == 70 else 1.0]) for i in range(100)]
        points[40] = (f"POINT ({WEST + 52.5} {NORTH - 62.5})", [1.0, 1.0])
        write_features(self.path("bad.gpkg"), "bad", points, [("diameter", ogr.OFTReal), ("release_height", ogr.OFTReal)])
        done = self.call("check", *self.flags("bad.gpkg"))
        self.assertEqual(done.returncode, 2)
        lines = [line.replace(self.path("bad.gpkg"), "bad.gpkg") for line in done.stderr.splitlines()]
        self.assertEqual(len(lines), 5, done.stderr)
        for i in range(3):
            self.assertIn(f"bad.gpkg: feature {i + 1}: field diameter = {-1 - i}: must be 0.01 to 50 m", lines[i])
        self.assertIn("bad.gpkg: and 96 more like this, in features 4 to 100", lines[3])
        self.assertIn("bad.gpkg: feature 71: field release_height = 800: must be", lines[4])
        self.fails(2, "feature 1: field diameter = -1", "(and 99 more faults: talus check lists all)",
                   arguments=["run", *self.flags("bad.gpkg"), "-o", self.path("none")])

    def test_wrong_names(self):
        self.refused("unknown name 'releaseheight'", "did you mean 'release_height'", more=["--field", "releaseheight=HEIGHT"])
        self.refused("flag --field diameter=Durchmeser", "has no field 'Durchmeser'", "did you mean 'Durchmesser'",
                     more=["--field", "diameter=Durchmeser"])
        self.refused("must be NAME=COLUMN", more=["--field", "diameter"])
        self.refused("diameter is given twice", more=["--field", "diameter=HEIGHT", "--field", "diameter=Durchmesser"])
        self.write("s.toml", 'dem = "dem.tif"\n[sources]\nfile = "sources.gpkg"\n[sources.fields]\ndiametre = "D"\nname = 3\n')
        done = self.call("check", self.path("s.toml"))
        self.assertEqual(done.returncode, 2)
        self.assertIn("s.toml:5: unknown key 'diametre' in [sources.fields]; did you mean 'diameter'?", done.stderr)
        self.assertIn("s.toml:6: sources.fields.name = 3: must be text", done.stderr)

    def test_names_that_differ_only_in_their_case(self):
        def feature(i):
            return ('{"type":"Feature","properties":{"diameter":1.0,"Diameter":3.0,"DIAMETER":4.0},"geometry":'
                    f'{{"type":"Point","coordinates":[{X + i},{Y}]}}}}')
        crs = '"crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::2056"}}'
        self.write("s.geojson", '{"type":"FeatureCollection",' + crs + ',"features":[' + ",".join(map(feature, range(2))) + "]}")
        self.assertIn("diameter 1 m (2 of 2", self.run_well("check", *self.flags("s.geojson")).stdout)  # spelt so
        self.assertIn("diameter 3 m (2 of 2", self.run_well("check", *self.flags("s.geojson"), "--field", "diameter=Diameter").stdout)
        self.refused("s.geojson: has the fields diameter, Diameter, DIAMETER, which differ only in the case",
                     sources="s.geojson", more=["--field", "diameter=DiaMeter"])

    def geojson(self, name, geometry, properties):
        crs = '"crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::2056"}}'
        self.write(name, '{"type":"FeatureCollection",' + crs + ',"features":[{"type":"Feature","properties":' +
                   json.dumps(properties) + ',"geometry":' + ogr.CreateGeometryFromWkt(geometry).ExportToJson() + "}]}")
        return self.path(name)

    def test_names_that_differ_only_in_their_case_in_other_layers(self):  # the first was read
        line = f"LINESTRING ({X - 50} {Y - 20},{X + 50} {Y - 20})"
        scenario = 'dem = "dem.tif"\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 1\n'
        barrier = self.write("b.toml", scenario + '[barriers]\nfile = "b.geojson"\n')
        self.geojson("b.geojson", line, {"id": "net", "HEIGHT": 50.0, "height": 1.0, "capacity": 500.0})
        self.assertIn("height 1 m (1 of 1 features)", self.run_well("check", barrier).stdout)
        self.geojson("b.geojson", line, {"id": "net", "HEIGHT": 50.0, "Height": 1.0, "capacity": 500.0})
        self.fails(2, "b.geojson: has the fields HEIGHT, Height, which differ only in the case of their letters, and none is spelt "
                   "height: rename all but one", arguments=["check", barrier])
        zones = self.geojson("z.geojson", box(100, 10, 100, 190), {"Zone": "no preset", "zone": "upper-talus-3d"})
        self.run_well("check", *self.flags(), "--zones", zones, "--zone-field", "zone")
        self.refused("zone 'no preset' is not described", more=["--zones", zones, "--zone-field", "Zone"])
        self.refused("z.geojson: has the fields Zone, zone, which differ only in the case", more=["--zones", zones, "--zone-field", "ZONE"])

    def test_objects_with_fields_that_differ_only_in_their_case(self):  # the run was repeated, then an error of SQL
        write_features(self.path("sources.gpkg"), "sources", [(f"POINT ({X} {Y})", [0.1])], [("frequency", ogr.OFTReal)])
        self.run_flags("-q")
        objects = self.geojson("o.geojson", box(105, 150, 10, 8), {"Name": "x", "name": "y"})
        self.fails(2, "o.geojson: has the fields Name, name, which differ only in the case of their letters",
                   arguments=["hazard", self.path("out"), "--objects", objects])


class FlagsForKeys(InputCase):
    """Flags that do what a key of a scenario does: the same maps, byte for byte."""

    def scenario(self, text, sources="sources.gpkg"):
        self.write("s.toml", text + f'dem = "dem.tif"\ntrajectories = 5\n[sources]\nfile = "{sources}"\n[blocks]\ndiameter = 1.2\n')
        self.run_well("run", self.path("s.toml"), "-o", self.path("by-key"))

    def assert_as_by_key(self):
        for name in ("energy.tif", "passages.tif"):
            with open(self.path(f"out/{name}"), "rb") as one, open(self.path(f"by-key/{name}"), "rb") as other:
                self.assertEqual(one.read(), other.read(), name)

    def test_a_fitted_ground(self):
        self.write("fitted.toml", "fitted_cell = 5\n[ground.zones.default]\ntheta_scale = 0.4\nEn50 = 7\n")
        self.scenario('include = "fitted.toml"\n')
        self.run_flags("--parameters", self.path("fitted.toml"))
        self.assert_as_by_key()
        settings = {s["key"]: s for s in self.record()["settings"]}
        self.assertEqual(settings["ground.default.theta_scale"]["source"], "flag --parameters")
        self.assertIn("include", [i["role"] for i in self.record()["inputs"]])
        self.run_well("run", self.path("out/scenario.toml"), "-o", self.path("by-key"), "--overwrite")
        self.assert_as_by_key()

    def test_a_fitted_ground_beside_others(self):
        self.write("fitted.toml", "[ground.zones.default]\nEn50 = 7\n")
        self.refused("flag --parameters = ", "must not come with --preset",
                     more=["--parameters", self.path("fitted.toml"), "--preset", "lower-talus-3d"])
        self.refused("no such file", more=["--parameters", self.path("missing.toml")])
        self.write("s.toml", 'dem = "dem.tif"\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 1\n')
        self.fails(2, "flag --parameters = ", 'include = "FILE"',
                   arguments=["check", self.path("s.toml"), "--parameters", self.path("fitted.toml")])

    def test_a_fitted_ground_with_zones_needs_their_map(self):
        """docs/scenario.md: --parameters is as the key include. Without a map no cell would have the fitted ground."""
        fitted = self.write("fitted.toml", "[ground.zones.talus]\ntheta_scale = 0.4\n[ground.zones.rock]\nEn50 = 7\n")
        self.refused("flag --parameters = ", "describes zones of ground (talus, rock)", "must come with --zones",
                     more=["--parameters", fitted])
        head = 'dem = "dem.tif"\ntrajectories = 5\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 1.2\n'
        self.write("s.toml", 'include = "fitted.toml"\n' + head)
        self.fails(2, "s.toml:1: include = 'fitted.toml'", "describes zones of ground (talus, rock)", "file in [ground]",
                   arguments=["check", self.path("s.toml")])
        write_features(self.path("zones.gpkg"), "zones", [(box(0, 0, 150, 300), ["talus"]), (box(150, 0, 150, 300), ["rock"])],
                       [("zone", ogr.OFTString)])
        zones = ["--zones", self.path("zones.gpkg")]
        self.run_flags("--parameters", fitted, *zones)
        self.run_well("check", self.path("out/scenario.toml"))  # what a run leaves can be run again
        self.write("s.toml", 'include = "fitted.toml"\n' + head + '[ground]\nfile = "zones.gpkg"\n')
        self.run_well("run", self.path("s.toml"), "-o", self.path("by-key"))
        self.assert_as_by_key()
        self.write("s.toml", 'include = "fitted.toml"\n' + head)  # the map of a flag counts as that of the scenario
        self.run_well("run", self.path("s.toml"), *zones, "-o", self.path("by-key"), "--overwrite")
        self.assert_as_by_key()

    def test_the_deformation_coefficient(self):
        self.scenario("model.deformation_coefficient = 0.15\n")
        self.run_flags("--deformation-coefficient", "0.15")
        self.assert_as_by_key()
        self.refused("flag --deformation-coefficient = -1", more=["--deformation-coefficient", "-1"])

    def test_a_list_with_spaces(self):  # "300: no such file, must be a TOML file"
        self.fails(2, "300: is taken for the file of a scenario", "--thresholds 30,300",
                   arguments=(*self.arguments(), "--thresholds", "30", "300"))

    def test_a_field_that_is_not_read(self):
        points = [(f"POINT ({WEST + 152.5 + 10 * i} {NORTH - 62.5})", [0.5]) for i in range(3)]
        write_features(self.path("often.gpkg"), "often", points, [("frequency", ogr.OFTReal)])
        self.refused("--field frequency= leaves out the field", sources="often.gpkg", more=["--frequency", "3"])
        done = self.run_flags("--frequency", "3", "--field", "frequency=", sources="often.gpkg")
        self.assertIn("no field is read", done.stderr)
        self.run_well("hazard", self.path("out"), "-q")
        settings = {s["key"]: s for s in self.record()["settings"]}
        self.assertEqual(settings["frequency.total"]["value"], 3)
        self.run_well("run", self.path("out/scenario.toml"), "-o", self.path("again"), "-q")


class Tables(InputCase):
    def table(self, text, name="t.csv"):
        self.write(name, text)
        return name

    def test_a_doubled_column(self):  # GDAL 3.6 ended with a crash (139)
        for header in ("x,x,y", "x,X,y", "d,x,y,d"):
            text = header + "\n" + ",".join(["1"] * len(header.split(","))) + "\n"
            self.refused("t.csv:1: column '" + ("d" if header[0] == "d" else "x") + "' is there twice", sources=self.table(text))
        self.refused("t.csv:1: column 'x' is there twice", sources=self.table(f"x;x;y\n{X};{X};{Y}\n"))

    def test_a_quotation_mark_that_is_not_closed(self):  # 4 of 60 rows were read
        rows = [f"a{i},{X + 0.1 * i},{Y}" for i in range(60)]
        rows[4] = '"' + rows[4]
        self.refused("t.csv:6: the quotation mark that opens here is not closed", sources=self.table("name,x,y\n" + "\n".join(rows)))
        rows[30] = '"' + rows[30]  # two of them: the rows between were one
        self.refused("t.csv:32: text stands after a quotation mark that closes a cell (opened in line 6)",
                     sources=self.table("name,x,y\n" + "\n".join(rows)))
        self.refused("t.csv:2: a quotation mark stands inside a cell", sources=self.table(f'name,x,y\na 5" rock,{X},{Y}\n'))

    def test_rows_of_another_length(self):  # the short one took the diameter of the flag
        self.refused("t.csv:3: has 2 cells, must have 3", sources=self.table(f"x,y,diameter\n{X},{Y},2.5\n{X},{Y}\n"))
        self.refused("t.csv:2: has 5 cells, must have 3", sources=self.table(f"x,y,diameter\n{X},{Y},2.5,7,8\n"))
        self.refused("t.csv:4: has 1 cell, must have 3", sources=self.table(f'x,y,name\n{X},{Y},"a\nb"\n{X}\n'))

    def test_a_decimal_comma(self):  # 1,200 was read as 1.2, it may be 1200
        rule = "must be a number{}, with a point for decimals"
        self.refused("t.csv:3: diameter = '1,200': " + rule.format(" in m"),
                     sources=self.table(f"x;y;Diameter\n{X};{Y};2\n{X};{Y};1,200\n"))
        self.refused("t.csv:2: x = '2600152,5': " + rule.format(""), sources=self.table(f"x;y;diameter\n2600152,5;{Y};2\n"))
        unread = self.table(f"x;y;diameter;note\n{X};{Y};2;1,5\n")
        self.assertIn("diameter 2 m", self.run_well("check", *self.flags(unread)).stdout)

    def test_other_encodings(self):
        for encoding, text in (("utf-16", f"x,y\n{X},{Y}\n"), ("utf-16-be", f"\ufeffx,y\n{X},{Y}\n")):
            with open(self.path("t.csv"), "w", encoding=encoding) as file:
                file.write(text)
            self.refused("t.csv: is UTF-16, must be UTF-8", sources="t.csv")
        self.refused("t.csv:2: holds a zero byte (NUL)", sources=self.table(f"x,y\n{X},{Y}\0\n"))

    def test_good_tables_pass(self):
        rows = f'\ufeffname;x;y;diameter\r\n"a ""quoted"" name";{X};{Y};2\r\n\r\n;{X};{Y};\r\n" two\r\nlines ";{X};{Y};3'
        said = self.run_well("check", *self.flags(self.table(rows))).stdout
        self.assertIn("diameter 2 to 3 m (2 of 3 features, 1 empty)", said)
        self.assertIn("3 features, 3 source cells", said)
        self.run_well("check", *self.flags(self.table(f"x\ty\n{X}\t{Y}\n")))
        self.run_well("check", *self.flags(self.table(f"x y\n{X} {Y} \n")))
        self.run_well("check", *self.flags(self.table(f"x,y\n{X},{Y},,\n")))  # as spreadsheets write it
        self.run_well("check", *self.flags(self.table(f'wkt,diameter\n"LINESTRING ({X} {Y}, {X + 9} {Y})",\n')))

    def test_a_coordinate_that_is_no_number(self):  # the row counted as one without geometry
        good = f"x,y,diameter\n{X},{Y},1\n"
        for cell in ("abc", "2'650'304", "2650304m", "nan", "0x11DCB8", "2600152,5"):
            self.refused(f"t.csv:3: x = '{cell}': must be a number, with a point for decimals",
                         sources=self.table(good + f'"{cell}",{Y},1\n'))
            self.refused(f"t.csv:3: y = '{cell}': must be a number, with a point for decimals",
                         sources=self.table(good + f'{X},"{cell}",1\n'))
        for cell in ("", " "):
            said = self.run_well("check", *self.flags(self.table(good + f"{cell},{Y},1\n"))).stdout
            self.assertIn("features without geometry (or with one that cannot be read), which release nothing: FID 2", said)
        self.run_well("check", *self.flags(self.table(f'wkt,x,y\n"POINT ({X} {Y})",west,a\n')))  # x and y are fields
        ring = ", ".join(f"{X + dx} {Y + dy}" for dx, dy in ((0, 0), (20, 0), (20, 20), (0, 20), (0, 0)))
        for columns in ("x,y,WKT", "x,y,geom"):  # also where they are numbers: one point was read instead of 16 cells
            said = self.run_well("check", *self.flags(self.table(f'{columns}\n{X},{Y},"POLYGON (({ring}))"\n'))).stdout
            self.assertIn("1 feature, 16 source cells", said)
        self.write("s.toml", 'dem = "dem.tif"\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 1\n[effects.forest-stems]\n'
                   'trees = "t.csv"\n')
        self.table(f"x,y,diameter\n{X},{Y},0.3\n{X}m,{Y},0.3\n")
        self.fails(2, f"t.csv:3: x = '{X}m': must be a number", arguments=["check", self.path("s.toml")])

    def test_tables_of_other_names(self):  # refused: "must have the columns x and y; has x, y, diameter"
        rows = f"x,y,diameter,name\n{X},{Y},1.5,01\n{X + 10},{Y},2,b\n"
        self.table(rows, "plain.csv")
        self.table(rows.replace(",", "\t"), "tabs.tsv")
        with gzip.open(self.path("packed.csv.gz"), "wt", encoding="utf-8") as file:
            file.write(rows)
        said = []
        for given in (self.path("plain.csv"), self.path("tabs.tsv"), "/vsigzip/" + self.path("packed.csv.gz")):
            lines = self.run_well("check", "--dem", self.path("dem.tif"), "--sources", given, "--trajectories", "5").stdout
            said.append([line.replace(given, "FILE") for line in lines.splitlines() if line.startswith(("read ", "sources "))])
        self.assertIn("diameter 1.5 to 2 m (2 of 2 features)", said[0][0])
        self.assertIn("2 features, 2 source cells", said[0][1])
        self.assertEqual(said[1:], said[:1] * 2)
        self.table(f"x\ty\n{X}\t{Y}\t3\n", "tabs.tsv")
        self.refused("tabs.tsv:2: has 3 cells, must have 2", sources="tabs.tsv")

    def test_a_column_alone(self):  # GDAL takes no such table
        hint, one = "must have two columns at least: put another one beside wkt, as id", f'"LINESTRING ({X} {Y}, {X + 9} {Y})"\n'
        self.refused("t.csv: cannot be opened", hint, sources=self.table("wkt\n" + one))
        self.run_well("check", *self.flags(self.table("id,wkt\n1," + one)))
        self.table("wkt\n" + one, "t.gpkg")
        done = self.fails(2, "t.gpkg: cannot be opened", arguments=["check", *self.flags("t.gpkg")])
        self.assertNotIn("columns", done.stderr)

    def test_every_other_layer_is_checked(self):
        bad = self.table(f'wkt,id,height,capacity,zone\n"LINESTRING ({X} {Y},{X + 9} {Y})",a,1\n')
        for table in ('[screens]\nfile = "t.csv"', '[barriers]\nfile = "t.csv"',
                      '[ground]\nfile = "t.csv"\nfield = "zone"\n[ground.zones.road]\npreset = "forest-road-3d"'):
            self.write("s.toml", f'dem = "dem.tif"\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 1\n{table}\n')
            self.fails(2, bad + ":2: has 3 cells, must have 5", arguments=["check", self.path("s.toml")])
        write_features(self.path("sources.gpkg"), "sources", [(f"POINT ({X} {Y})", [0.1])], [("frequency", ogr.OFTReal)])
        self.run_flags("-q")
        self.fails(2, bad + ":2: has 3 cells", arguments=["hazard", self.path("out"), "--objects", self.path(bad)])


class Archives(InputCase):
    def zipped(self, folder, west):
        """d.zip in a folder, with a DEM that begins at `west`, and sources on it."""
        os.makedirs(self.path(folder))
        write_dem(self.path("z.tif"), heights(), transform=(west, 5.0, 0.0, NORTH, 0.0, -5.0))
        with zipfile.ZipFile(self.path(folder + "/d.zip"), "w") as archive:
            archive.write(self.path("z.tif"), "sub/dem.tif")
            archive.writestr("s.csv", f"x,y,diameter\n{west + 150},{Y},1\n")

    def test_their_names_are_relative_to_the_scenario(self):  # an archive of the current folder was read
        self.zipped("one", WEST)
        self.zipped("two", WEST + 1000)
        for dem, sources in (("/vsizip/d.zip/sub/dem.tif", "/vsizip/d.zip/s.csv"),
                             ("/vsizip/{d.zip}/sub/dem.tif", "/vsizip/../one/d.zip/s.csv"),
                             (f"/vsizip/{self.path('one/d.zip')}/sub/dem.tif", f"/vsizip/{self.path('one/d.zip')}/s.csv")):
            scenario = self.write("one/s.toml", f'dem = "{dem}"\ntrajectories = 1\n[sources]\nfile = "{sources}"\n')
            for folder in ("one", "two", "."):
                done = self.run_well("check", scenario, cwd=self.path(folder))
                self.assertIn(f"extent        {WEST:.3f} to {WEST + 300:.3f} east", done.stdout)
            self.run_well("run", "s.toml", "-o", self.path("out"), "--overwrite", "-q", cwd=self.path("one"))
            self.run_well("check", self.path("out/scenario.toml"), cwd="/")
            for given in self.record()["inputs"][1:]:
                self.assertIn(self.path("one/d.zip"), given["path"])

    def test_an_archive_by_itself_says_how_its_files_are_named(self):
        self.zipped("one", WEST)
        self.fails(2, f"a file in an archive is named /vsizip/{self.path('one/d.zip')}/FILE", cwd=self.path("one"),
                   arguments=("check", "--dem", "d.zip", "--sources", "/vsizip/d.zip/s.csv"))

    def test_flags_are_relative_to_the_current_folder(self):
        self.zipped("one", WEST)
        self.run_well("run", "--dem", "/vsizip/d.zip/sub/dem.tif", "--sources", "/vsizip/d.zip/s.csv", "--trajectories", "1",
                      "-o", self.path("out"), "-q", cwd=self.path("one"))
        self.run_well("check", self.path("out/scenario.toml"), cwd="/")


class Shapefiles(InputCase):
    def test_fields_that_are_not_there(self):
        write_shapefile(self.path("c.shp"), [2.5, 2.5, 3.5])
        self.assertIn("diameter 2.5 to 3.5 m (3 of 3", self.run_well("check", *self.flags("c.shp")).stdout)
        with open(self.path("c.dbf"), "rb") as file:
            whole = file.read()
        header, record = struct.unpack("<HH", whole[8:12])
        with open(self.path("c.dbf"), "wb") as file:
            file.write(whole[:4] + struct.pack("<I", 1) + whole[8:header + record] + b"\x1a")
        self.refused("c.shp: has 3 features, and its .dbf has the fields of 1", sources="c.shp")
        with open(self.path("c.dbf"), "wb") as file:
            file.write(whole[:header + record])
        self.refused("c.dbf: is cut off", sources="c.shp")
        os.remove(self.path("c.dbf"))
        self.refused("c.shp: the fields of its features are in c.dbf, which is not there", "ogr2ogr", sources="c.shp")
        with open(self.path("c.DBF"), "wb") as file:
            file.write(whole)
        self.run_well("check", *self.flags("c.shp"))

    def test_files_that_are_cut_off(self):  # what was left of them was read as all
        write_shapefile(self.path("c.shp"), [2.5, 2.5, 3.5])
        for name, options in (("c.mif", {"format": "MapInfo File"}), ("c.geojsonl", {"format": "GeoJSONSeq"})):
            gdal.VectorTranslate(self.path(name), self.path("c.shp"), **options)
            self.run_well("check", *self.flags(name))
        gdal.Translate(self.path("d.img"), self.path("dem.tif"), format="ENVI")
        with open(self.path("d.hdr"), "a", encoding="utf-8") as file:
            file.write("file compression = 0\n")
        self.run_well("check", "--dem", self.path("d.img"), "--sources", self.path("c.shp"))
        gdal.Translate(self.path("d.map"), self.path("dem.tif"), format="PCRaster")
        self.run_well("check", "--dem", self.path("d.map"), "--sources", self.path("c.shp"))
        for name, said in (("c.shp", "is cut off, must have "), ("c.mif", "has 2 shapes, and its .mid has 3 rows"),
                           ("c.geojsonl", "cannot be read as a whole: "), ("d.img", "is cut off, must have "),
                           ("d.map", "is cut off, must have 14656 bytes")):  # 256 and 60 x 60 x 4
            with open(self.path(name), "rb") as file:
                whole = file.read()
            with open(self.path(name), "wb") as file:
                file.write(whole[:whole.rindex(b"Region") if name == "c.mif" else len(whole) * 9 // 10])
            dem, sources = (name, "c.gpkg") if name.startswith("d.") else ("dem.tif", name)
            self.fails(2, f"{name}: {said}", arguments=["check", "--dem", self.path(dem), "--sources", self.path(sources), "--diameter", "1"])
            if name == "c.shp":
                with open(self.path(name), "wb") as file:
                    file.write(whole)
                gdal.VectorTranslate(self.path("c.gpkg"), self.path("c.shp"))

    def test_fields_that_are_not_in_an_archive(self):  # they were lost in silence
        write_shapefile(self.path("c.shp"), [2.5, 2.5, 3.5])
        for name in ("c.shz", "c.shp.zip"):
            for ends in (("shp", "shx", "prj", "dbf"), ("shp", "shx", "prj")):
                with zipfile.ZipFile(self.path(name), "w") as archive:
                    for end in ends:
                        archive.write(self.path("c." + end), "c." + end)
                if "dbf" in ends:
                    self.assertIn("diameter 2.5 to 3.5 m (3 of 3", self.run_well("check", *self.flags(name)).stdout)
            self.refused(f"{name}}}/c.shp: the fields of its features are in c.dbf, which is not there", "ogr2ogr c.gpkg ", sources=name)

    def test_a_name_of_fourteen_letters_is_cut(self):
        file = ogr.GetDriverByName("ESRI Shapefile").CreateDataSource(self.path("c.shp"))
        layer = file.CreateLayer("cliffs", system(2056), ogr.wkbPoint)
        gdal.PushErrorHandler("CPLQuietErrorHandler")
        layer.CreateField(ogr.FieldDefn("release_height", ogr.OFTReal))
        gdal.PopErrorHandler()
        feature = ogr.Feature(layer.GetLayerDefn())
        feature.SetGeometry(ogr.CreateGeometryFromWkt(f"POINT ({X} {Y})"))
        feature.SetField(0, 7.5)
        layer.CreateFeature(feature)
        file = layer = feature = None
        self.assertIn("release_height 7.5 m from release_he (1 of 1", self.run_well("check", *self.flags("c.shp")).stdout)


KML = """<kml xmlns="http://www.opengis.net/kml/2.2"><Document><Schema name="s" id="s"><SimpleField type="float" name="diameter"/></Schema>
<Placemark><name>a</name><ExtendedData><SchemaData schemaUrl="#s"><SimpleData name="diameter">1.5</SimpleData></SchemaData></ExtendedData>
<Point><coordinates>{},{}</coordinates></Point></Placemark></Document></kml>"""


class Kml(InputCase):
    def test_its_fields_are_read(self):
        """GDAL's older reader of KML knows only the name."""
        world = system(4326)
        world.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
        place = osr.CoordinateTransformation(system(2056), world).TransformPoint(X, Y)
        self.write("a.kml", KML.format(*place[:2]))
        self.assertIn("diameter 1.5 m", self.run_well("check", *self.flags("a.kml")).stdout)


class Overwrite(InputCase):
    def content(self, out="out"):
        return {os.path.join(folder, name): os.stat(os.path.join(folder, name)).st_mtime_ns
                for folder, _, names in os.walk(self.path(out)) for name in names}

    def test_files_of_others_stay(self):
        self.run_flags("-q")
        os.mkdir(self.path("out/photos"))
        self.write("out/photos/a.jpg", "x")
        self.write("out/project.qgz", "x")
        before = self.content()
        self.fails(2, "others in this folder: photos/, project.qgz;",
                   arguments=["run", *self.flags(), "-o", self.path("out"), "--overwrite"])
        self.assertEqual(self.content(), before)
        shutil.rmtree(self.path("out/photos"))
        os.rename(self.path("out/project.qgz"), self.path("project.qgz"))
        self.run_flags("--overwrite")
        self.assertNotEqual(self.content(), before)

    def test_what_talus_and_viewers_leave_is_replaced(self):
        write_features(self.path("screens.gpkg"), "screens",
                       [(f"LINESTRING ({WEST} {NORTH - 120},{WEST + 300} {NORTH - 120})", ["road"])], [("id", ogr.OFTString)])
        write_features(self.path("sources.gpkg"), "sources", [(box(140, 230, 20, 10), [0.1])], [("frequency", ogr.OFTReal)])
        self.write("s.toml", 'dem = "dem.tif"\ntrajectories = 20\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 1.2\n'
                   '[screens]\nfile = "screens.gpkg"\n')
        arguments = ["run", self.path("s.toml"), "-o", self.path("out"), "-q"]
        self.run_well(*arguments)
        self.run_well("hazard", self.path("out"), "-q")
        self.run_well("barrier", self.path("out"), "--screen", "road")
        for name in ("energy.tif.aux.xml", "stops.gpkg-wal", "stops.gpkg-shm"):
            self.write("out/" + name, "")
        self.run_well(*arguments, "--overwrite")
        self.assertFalse(os.path.exists(self.path("out/hazard.json")))
        self.assertFalse(os.path.exists(self.path("out/energy.tif.aux.xml")))
        self.write("out/return_period_30.tif.aux.xml", "<PAMDataset/>")  # QGIS wrote it after the raster had gone
        self.run_well(*arguments, "--overwrite")
        self.assertFalse(os.path.exists(self.path("out/return_period_30.tif.aux.xml")))
        for name in ("mine.tif", "mine.tif.aux.xml"):
            self.write("out/" + name, "mine")
        self.fails(2, "mine.tif, mine.tif.aux.xml", arguments=[*arguments, "--overwrite"])
        for name in ("mine.tif", "mine.tif.aux.xml"):
            os.remove(self.path("out/" + name))
        self.write("out/barrier_notes.csv", "mine")
        self.fails(2, "barrier_notes.csv", arguments=[*arguments, "--overwrite"])
        self.assertTrue(os.path.exists(self.path("out/barrier_notes.csv")))
        os.remove(self.path("out/barrier_notes.csv"))
        self.write("out/barrier_lines.json", '{"type": "FeatureCollection"}')  # of a name like ours
        self.write("out/.DS_Store", "")
        self.fails(2, "folder: barrier_lines.json;", arguments=[*arguments, "--overwrite"])
        os.remove(self.path("out/barrier_lines.json"))
        os.makedirs(self.path("out/.sub.talus-77/unfinished"))
        self.write("out/.sub.talus-77/unfinished/part.json", "{}")  # kept work of another run
        self.fails(2, ".sub.talus-77/", arguments=[*arguments, "--overwrite"])
        self.assertTrue(os.path.exists(self.path("out/.sub.talus-77/unfinished/part.json")))

    def test_parts_and_merged_results(self):
        for i in (1, 2):
            self.run_flags("-q", "--part", f"{i}/2", out=f"part{i}")
        self.run_flags("-q", "--part", "1/2", "--overwrite", out="part1")
        parts = [self.path("part1"), self.path("part2")]
        self.run_well("merge", self.path("all"), *parts, "-q")
        self.run_well("merge", self.path("all"), *parts, "-q", "--overwrite")
        self.write("part1/diary.txt", "dear diary")
        self.write("all/diary.txt", "dear diary")
        self.fails(2, "folder: diary.txt;", arguments=["run", *self.flags(), "--part", "1/2", "-o", parts[0], "--overwrite"])
        self.fails(2, "folder: diary.txt;", arguments=["merge", self.path("all"), *parts, "--overwrite"])
        self.assertTrue(os.path.exists(self.path("part1/diary.txt")) and os.path.exists(self.path("all/diary.txt")))

    def test_a_file_of_others(self):
        self.write("notes.gpkg", "mine")
        arguments = ["sources", "--dem", self.path("dem.tif"), "--slope", "30", "--overwrite", "-o"]
        self.fails(2, "notes.gpkg", "no GeoPackage", arguments=[*arguments, self.path("notes.gpkg")])
        write_features(self.path("mine.gpkg"), "houses", [(f"POINT ({X} {Y})", [])])
        self.fails(2, "mine.gpkg", "other layers: houses", arguments=[*arguments, self.path("mine.gpkg")])
        self.run_well(*arguments, self.path("cells.gpkg"))
        self.run_well(*arguments, self.path("cells.gpkg"))


class AsciiGrids(InputCase):
    """A header of six lines, then 60 rows of 60 heights."""

    def setUp(self):
        super().setUp()
        write_dem(self.path("dem.tif"), np.round(heights()) + 0.5, nodata=-9999.0)
        gdal.Translate(self.path("d.asc"), self.path("dem.tif"), format="AAIGrid")
        self.lines = self.read_text("d.asc").splitlines()
        self.assertEqual(len(self.lines), 6 + 60)

    def with_word(self, word):
        """The grid with another word for a height in its 30th line."""
        words = self.lines[29].split()
        words[20] = word
        return self.lines[:29] + [" ".join(words)] + self.lines[30:]

    def test_what_is_read(self):
        def terrain(dem):
            lines = self.run_well("check", *self.flags(dem=dem)).stdout.splitlines()
            return [line for line in lines if line.startswith(("terrain", "extent", "slopes"))]
        self.assertEqual(len(terrain("d.asc")), 3)
        for lines in (self.lines, [line.replace(".", ",") for line in self.lines], self.lines[:6] + [" ".join(self.lines[6:])],
                      [line + "\r" for line in self.lines], [*self.lines, "  ", ""]):
            self.write("d.asc", "\n".join(lines) + "\n")
            self.assertEqual(terrain("d.asc"), terrain("dem.tif"))
        for word in ("nan", "+1e3", "1.#QNAN", "1000,5"):
            self.write("d.asc", "\n".join(self.with_word(word)))
            self.run_well("check", *self.flags(dem="d.asc"))

    def test_other_numbers_than_the_header_says(self):  # the map lay too far south, or all after a gap was shifted
        cut = self.lines[-1][:len(self.lines[-1]) // 2 + 1]
        few = [line.replace("nrows        60", "nrows        50") for line in self.lines]
        for lines, numbers, rows in ((self.lines[:-1], 3540, 60), (self.lines[:20] + self.lines[21:], 3540, 60),
                                     ([*self.lines, self.lines[-1]], 3660, 60), (few, 3600, 50),
                                     (self.with_word(""), 3599, 60), (self.with_word("1000 .5"), 3601, 60),
                                     ([*self.lines[:-1], cut], 3540 + len(cut.split()), 60)):
            self.write("d.asc", "\n".join(lines) + "\n")
            self.refused(f"d.asc: has {numbers} numbers, its header says 60 columns x {rows} rows", "copy it again", dem="d.asc")

    def test_words(self):  # each was the height 0, or that of its first digits
        for word in ("x1000", "n/a", "1'000.5", "12.3.4", "1e", "1000m", "-", "1,000.5"):
            self.write("d.asc", "\n".join(self.with_word(word)))
            self.refused(f"d.asc:30: '{word}' is no number, must be one, or the NODATA_value", dem="d.asc")

    def test_ends_of_files(self):
        for end in ("\x1a", "\n\x1a\n", "\f", "\0"):
            self.write("d.asc", "\n".join(self.lines) + end)
            self.run_well("check", *self.flags(dem="d.asc"))

    def test_a_word_in_the_first_row(self):
        words = self.lines[6].split()
        self.write("d.asc", "\n".join([*self.lines[:6], " ".join(["none", *words[1:]]), *self.lines[7:]]))
        self.refused("d.asc:7: 'none' is no number", dem="d.asc")

    def test_grass(self):
        """Six lines of another header; `*`, or the word that the header names, is no value."""
        head = [f"north: {NORTH}", f"south: {NORTH - 300}", f"east: {WEST + 300}", f"west: {WEST}", "rows: 60", "cols: 60"]
        for more, word in (([], "*"), (["null: -"], "-"), (["type: float", "null: none"], "none")):
            self.write("d.asc", "\n".join([*head, *more, *self.with_word(word)[6:]]) + "\n")
            self.run_well("check", *self.flags(dem="d.asc"))
        self.write("d.asc", "\n".join([*head, "null: -", *self.with_word("*")[6:]]) + "\n")
        self.refused("d.asc:31: '*' is no number", dem="d.asc")
        self.write("d.asc", "\n".join([*head, *self.lines[6:-1]]) + "\n")
        self.refused("d.asc: has 3540 numbers", dem="d.asc")

    def test_in_a_vrt(self):
        gdal.BuildVRT(self.path("d.vrt"), [self.path("d.asc")]).FlushCache()
        gdal.BuildVRT(self.path("of.vrt"), [self.path("d.vrt")]).FlushCache()
        for dem in ("d.vrt", "of.vrt"):
            self.run_well("check", *self.flags(dem=dem))
        self.write("d.asc", "\n".join(line.replace("nrows        60", "nrows        50") for line in self.lines))
        for dem in ("d.vrt", "of.vrt"):
            self.refused("d.asc: has 3600 numbers, its header says 60 columns x 50 rows", dem=dem)

    def test_a_cut_raster_in_a_vrt(self):
        gdal.Translate(self.path("d.img"), self.path("dem.tif"), format="ENVI")
        gdal.BuildVRT(self.path("d.vrt"), [self.path("d.img")]).FlushCache()
        self.run_well("check", *self.flags(dem="d.vrt"))
        os.truncate(self.path("d.img"), os.path.getsize(self.path("d.img")) - 100)
        self.refused("d.img: is cut off", dem="d.vrt")

    def test_zones(self):
        write_dem(self.path("zones.tif"), np.ones((60, 60)))
        gdal.Translate(self.path("zones.asc"), self.path("zones.tif"), format="AAIGrid", outputType=gdal.GDT_Int32)
        self.write("s.toml", 'dem = "dem.tif"\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 1.2\n'
                             '[ground]\nfile = "zones.asc"\n[ground.zones.1]\npreset = "forest-road-3d"\n')
        self.run_well("check", self.path("s.toml"))
        self.write("zones.asc", "\n".join(self.read_text("zones.asc").splitlines()[:-10]))
        self.fails(2, "zones.asc: has 3000 numbers, its header says 60 columns x 60 rows", arguments=["check", self.path("s.toml")])


class Heights(InputCase):
    def test_heights_of_sources_are_said_not_to_be_read(self):
        x, y = WEST + 150, NORTH - 60
        for shapes, said in ((["POINT Z ({x} {y} 1500)", "LINESTRING Z ({x} {y} 0,{x} {south} 3)", "POINT ({x} {y})"], "2 of 3 features"),
                             (["POLYGON Z (({x} {y} 9,{x} {south} 9,{east} {south} 9,{x} {y} 9))"], "1 of 1 features"),
                             (["POINT Z ({x} {y} 0)", "POINT M ({x} {y} 5)"], "")):
            write_features(self.path("sources.gpkg"), "sources",
                           [(shape.format(x=x, y=y, south=y - 20, east=x + 20), []) for shape in shapes])
            plan = self.run_well("check", *self.flags()).stdout
            self.assertEqual("(Z)" in plan, said != "", plan)
            if said:
                self.assertIn(f"sources.gpkg: the height (Z) of {said} is not read: blocks start above the DEM", plan)
                self.assertEqual(self.run_flags("--overwrite", out="z").stderr.count(f"the height (Z) of {said} is not read"), 1)


class OffTheDem(InputCase):
    def said(self, shapes):
        write_features(self.path("sources.gpkg"), "sources", shapes, [("name", ogr.OFTString)])
        done = self.run_well("check", *self.flags())
        return [line for line in done.stdout.splitlines() if line.startswith("warning")]

    def test_shares_of_features(self):
        left, top = WEST + 100, NORTH - 30
        lines = self.said([(box(140, 270, 20, 180), ["cliff A"]),  # 30 of 180 m inside
                           (box(40, 200, 20, 30), ["inside"]),
                           (f"LINESTRING ({left} {top},{left} {top + 120})", ["edge"]),  # 30 of 120 m
                           (box(140, 500, 20, 10), ["gone"])])
        said = "\n".join(lines)
        self.assertIn("83 % of polygon 1 (cliff A) lies outside the DEM; 75 % of line 3 (edge) lies outside the DEM:", said)
        self.assertIn("features wholly off the DEM, which release nothing: FID 4 (gone)", said)
        self.assertNotIn("inside)", said)

    def test_holes_of_the_dem(self):
        z = heights()
        z[10:14, 28:30] = -9999.0  # 140 to 150 m east, 230 to 250 m north: half of the first polygon
        write_dem(self.path("dem.tif"), z, nodata=-9999.0)
        said = "\n".join(self.said([(box(140, 230, 20, 20), ["half"]), (box(140, 230, 10, 20), ["all"])]))
        self.assertIn("50 % of polygon 1 (half) lies where the DEM has no heights:", said)
        self.assertIn("features where the DEM has no heights, which release nothing: FID 2 (all)", said)

    def test_a_dem_that_counts_to_the_west_is_refused(self):
        """EPSG:2048 and 5513 count to the west and south, 3145 to the north and west; 5514 is 5513 with a minus, 2180 names its
        northing first, the axes of 3995 run along meridians."""
        for code, told in (("2048", "west and south"), ("5513", "south and west"), ("3145", "north and west"),
                           ("5514", ""), ("2180", ""), ("3995", ""), ("31467", "")):
            with self.subTest(code):
                gdal.Translate(self.path("grid.tif"), self.path("dem.tif"), outputSRS=f"EPSG:{code}", outputBounds=[1000, 3700300, 1300, 3700000])
                done = self.call("check", "--dem", self.path("grid.tif"), "--sources", self.path("sources.gpkg"), "--diameter", "1")
                self.assertEqual(f"grid.tif: coordinates count to the {told} (EPSG:{code}" in done.stderr, told != "", done.stderr)
                self.assertEqual("must count to the east and north" in done.stderr, told != "", done.stderr)

    def test_degrees_and_exchanged_axes_are_seen(self):
        """In a table without a system, which is taken in that of the DEM."""
        for x, y, told in ((8.1, 46.7, "these look like degrees, taken for metres"), (NORTH - 60, WEST + 150, "x and y look exchanged"),
                           (WEST - 9000, NORTH, "is the coordinate system of the layer the right one?")):
            self.write_table("cells.csv", "x,y", [(x, y)])
            self.fails(2, "cells.csv: lies wholly off the DEM", told, arguments=["check", "--dem", self.path("dem.tif"), "--sources",
                                                                                  self.path("cells.csv"), "--diameter", "1"])

    def zones(self, *shapes):
        write_features(self.path("zones.gpkg"), "zones", [(wkt, ["forest-road-3d"]) for wkt in shapes], [("zone", ogr.OFTString)])
        return "--zones", self.path("zones.gpkg")

    def test_zones(self):
        inside, off, thin = box(0, 0, 300, 100), box(0, 5000, 300, 100), box(0, 200.5, 300, 1)
        done = self.run_well("check", *self.flags(), *self.zones(inside, off, thin))
        self.assertIn("zones wholly off the DEM, which have no effect: FID 2 (forest-road-3d)", done.stdout)
        self.assertIn("have no effect: FID 3 (forest-road-3d): draw them wider than a cell, 5 m", done.stdout)
        self.assertNotIn("zones.gpkg: zones", self.run_well("check", *self.flags(), *self.zones(inside)).stdout)
        self.refused("zones.gpkg: lies wholly off the DEM: its features reach over", ", the DEM over", more=self.zones(off, off))

    def test_a_zone_under_a_later_one(self):
        shapes = [(box(0, 0, 300, 100), ["forest-road-3d"]), (box(0, 0, 300, 200), ["lower-talus-3d"])]
        for rows, said in ((shapes, True), (shapes[::-1], False)):
            write_features(self.path("zones.gpkg"), "zones", rows, [("zone", ogr.OFTString)])
            plan = self.run_well("check", *self.flags(), "--zones", self.path("zones.gpkg")).stdout
            text = "zones covered by later ones, so that none of their name is left: FID 1 (forest-road-3d): the last in the file counts"
            self.assertEqual(text in plan, said, plan)

    def test_a_raster_of_zones(self):
        self.write("s.toml", 'dem = "dem.tif"\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 1.2\n'
                             '[ground]\nfile = "zones.tif"\n[ground.zones.1]\npreset = "forest-road-3d"\n')
        whole = (WEST, 5.0, 0.0, NORTH, 0.0, -5.0)
        for columns, place, said in ((60, whole, ""), (30, whole, "gives no zone to 50 % of the cells of the DEM")):
            write_dem(self.path("zones.tif"), np.ones((60, columns)), transform=place)
            plan = self.run_well("check", self.path("s.toml")).stdout
            self.assertEqual("gives no zone" in plan, said != "", plan)
            self.assertIn(said, plan)
        write_dem(self.path("zones.tif"), np.ones((60, 60)), transform=(WEST - 2e6, 5.0, 0.0, NORTH - 1e6, 0.0, -5.0))
        self.fails(2, "zones.tif: gives no cell of the DEM a zone: it reaches over", "the DEM over",
                   arguments=["check", self.path("s.toml")])

    def test_codes_of_zones_with_an_offset(self):
        write_dem(self.path("zones.tif"), np.ones((60, 60)))
        zones = gdal.Open(self.path("zones.tif"), gdal.GA_Update)
        zones.GetRasterBand(1).SetOffset(1)
        zones = None
        self.write("s.toml", 'dem = "dem.tif"\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 1.2\n'
                             '[ground]\nfile = "zones.tif"\n[ground.zones.1]\npreset = "forest-road-3d"\n')
        self.fails(2, "zones.tif: has a scale or an offset (1, 1)", "gdal_translate -unscale", arguments=["check", self.path("s.toml")])

    def test_a_nodata_code_beside_a_mask(self):  # GDAL goes by the mask alone: nodata counted as the code of a zone
        codes, mask = np.ones((60, 60)), np.full((60, 60), 255, np.uint8)
        codes[:30], mask[50:] = 7.0, 0
        write_dem(self.path("zones.tif"), codes, nodata=7.0)
        zones = gdal.Open(self.path("zones.tif"), gdal.GA_Update)
        zones.CreateMaskBand(gdal.GMF_PER_DATASET)
        zones.GetRasterBand(1).GetMaskBand().WriteArray(mask)
        zones = None
        self.write("s.toml", 'dem = "dem.tif"\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 1.2\n'
                             '[ground]\nfile = "zones.tif"\n[ground.zones.1]\npreset = "forest-road-3d"\n')
        self.assertIn("gives no zone to 67 % of the cells of the DEM", self.run_well("check", self.path("s.toml")).stdout)

    def test_what_two_settings_say(self):
        """The ground outside all zones twice, a zone called as a preset, a barrier without a capacity, a shape that nothing reads."""
        head = 'dem = "dem.tif"\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 1.2\n'
        road = '[ground.zones.forest-road-3d]\n'
        net = f'[barriers]\nline = [{{ id = "net", height = 3, from = [{WEST + 20}, {NORTH - 180}], to = [{WEST + 280}, {NORTH - 180}]CAPACITY }}]\n'
        self.zones(box(0, 0, 300, 100))
        for text, said in (('[ground]\nfile = "zones.gpkg"\n' + road + 'phi = 40\n', "[ground.zones.forest-road-3d] has no preset"),
                           ('[ground]\nfile = "zones.gpkg"\n' + road + 'phi = 40\npreset = "forest-road-3d"\n', ""),
                           (net.replace("CAPACITY", ""), "barriers.line: no capacity is given of net, so that nothing breaks through (unsafe for a net)"),
                           (net.replace("CAPACITY", ", capacity = inf"), ""),
                           ("axes = [3, 2, 1]\n", "blocks.axes = [3, 2, 1]: only [effects.block-shape] reads the shape")):
            plan = self.run_well("check", self.write("s.toml", head + text)).stdout
            for words in ("has no preset", "no capacity is given", "reads the shape"):
                self.assertEqual(words in plan, words in said, plan)
            self.assertIn(said, plan)
        self.write("s.toml", head + '[ground]\ndefault = "lower-talus-3d"\n[ground.zones.default]\npreset = "forest-road-3d"\n')
        self.fails(2, "ground.default = 'lower-talus-3d': [ground.zones.default] preset is 'forest-road-3d'", "leave out the other",
                   arguments=["check", self.path("s.toml")])

    def test_barriers(self):
        """Those of a file and those of the scenario, with east and north exchanged: both are called, with their extent."""
        west, east, north = WEST + 20, WEST + 280, NORTH - 180
        exchanged = f"LINESTRING ({north} {west},{north} {east})"
        write_features(self.path("nets.gpkg"), "nets", [(exchanged, [3.0, 1000.0])],
                       [("height", ogr.OFTReal), ("capacity", ogr.OFTReal)])
        head = 'dem = "dem.tif"\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 1.2\n[barriers]\n'
        line = 'line = [{{ id = "fence", height = 3, from = [{}, {}], to = [{}, {}] }}]\n'
        off = "lines wholly off the DEM, which nothing will cross: "
        place = (f"; they reach over east {north:.0f} to {north:.0f}, north {west:.0f} to {east:.0f}, "
                 f"the DEM over east {WEST:.0f} to {WEST + 300:.0f}, north {NORTH - 300:.0f} to {NORTH:.0f} in EPSG:2056")
        for text, said in (('file = "nets.gpkg"\n', "nets.gpkg: " + off + "features 1" + place),
                           (line.format(north, west, north, east), "barriers.line (scenario): " + off + "barriers fence" + place),
                           (line.format(west, north, east, north), "")):
            plan = self.run_well("check", self.write("s.toml", head + text)).stdout
            self.assertEqual("wholly off" in plan, said != "", plan)
            self.assertIn(said, plan)

    def test_nothing_is_said_of_features_inside(self):
        self.assertNotIn("lies", "\n".join(self.said([(box(140, 230, 20, 10), ["cliff"])])))


class NoDem(InputCase):
    """Terrain with slopes of 15 to 50 degrees and bumps of all sizes, and what is taken for it by mistake."""

    def setUp(self):
        super().setUp()
        rng = np.random.default_rng(3)
        y, x = np.mgrid[0:120, 0:120] * 5.0
        z = 800.0 + 0.65 * (600.0 - y)
        for length in (400.0, 170.0, 70.0, 30.0):
            a, b = rng.uniform(0, 6, 2)
            z += 0.035 * length * np.sin(2 * np.pi * x / length + a) * np.cos(2 * np.pi * y / length + b)
        self.z = z + rng.normal(0, 0.05, z.shape)

    def warnings(self, z, kind=gdal.GDT_Float32):
        file = gdal.GetDriverByName("GTiff").Create(self.path("z.tif"), 120, 120, 1, kind)
        file.SetGeoTransform((WEST, 5.0, 0.0, NORTH, 0.0, -5.0))
        file.SetProjection(system(2056).ExportToWkt())
        file.GetRasterBand(1).WriteArray(z)
        file = None
        return self.run_well("check", *self.flags(dem="z.tif")).stdout

    def test_terrain_is_taken_without_a_word(self):
        for z in (self.z, np.round(self.z, 2), np.round(self.z, 1)):
            said = self.warnings(z)
            for word in ("steeper than 80 deg (", "from cell to cell", "holds bytes"):
                self.assertNotIn(word, said)
            self.assertIn("slopes        median 3", said)

    def test_whole_metres(self):
        said = self.warnings(np.round(self.z))
        self.assertIn("all heights are multiples of 1 m, a slope of 11 deg from cell to cell", said)
        self.assertIn("multiples of 0.3048 m (a foot)", self.warnings(np.round(self.z / 0.3048) * 0.3048))

    def test_feet(self):
        self.assertIn("half of its cells are steeper than 6", self.warnings(self.z / 0.3048))

    def test_a_hillshade(self):
        self.warnings(self.z)
        gdal.DEMProcessing(self.path("shade.tif"), self.path("z.tif"), "hillshade")
        shade = gdal.Open(self.path("shade.tif")).ReadAsArray()
        said = self.warnings(shade, gdal.GDT_Byte)
        self.assertIn("band 1 holds bytes", said)
        self.assertIn("multiples of 1 m", said)

    def test_real_terrain(self):
        folder = os.environ.get("TALUS_DATA", "")
        for name in ("gar", "alr", "mal"):
            dem = os.path.join(folder, "terrain", name + ".tif")
            if not os.path.exists(dem):
                self.skipTest(dem + " is not there")
            done = self.run_well("sources", "--dem", dem, "--slope", "60", "-o", self.path(name + ".gpkg"))
            self.assertNotIn("warning", done.stderr)
            shade = self.path(name + "_shade.tif")
            gdal.DEMProcessing(shade, dem, "hillshade")
            done = self.run_well("sources", "--dem", shade, "--slope", "60", "-o", self.path(name + "_shade.gpkg"))
            for word in ("half of its cells are steeper than 5", "multiples of 1 m", "holds bytes"):
                self.assertIn(word, done.stderr)


if __name__ == "__main__":
    unittest.main()
