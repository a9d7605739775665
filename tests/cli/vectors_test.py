"""Layers as FlatGeobuf (--vectors fgb): the rows of the GeoPackages, found by all that reads them later."""
import json
import os
import unittest
import xml.etree.ElementTree as xml

from osgeo import ogr

from support import WEST, RunCase, rows_of

LAYERS = ("stops", "exits", "trajectories", "screens")


def sorted_rows(path, layer):
    """Fields and geometry of all rows; both formats keep them in another order."""
    rows = [(fields, geometry.ExportToIsoWkt()) for fields, geometry in rows_of(path, layer)]
    return sorted(rows, key=lambda row: json.dumps(row[0], sort_keys=True))


class Vectors(RunCase):
    def names(self, out):
        return {name for name in os.listdir(self.path(out)) if name.endswith((".gpkg", ".fgb"))}

    def test_the_same_rows_in_either_format(self):
        self.run_scenario("gpkg")
        self.run_scenario("fgb", "--vectors", "fgb")
        self.assertEqual(self.names("gpkg"), {name + ".gpkg" for name in LAYERS})
        self.assertEqual(self.names("fgb"), {name + ".fgb" for name in LAYERS})
        for name in LAYERS:
            one, other = self.path(f"gpkg/{name}.gpkg"), self.path(f"fgb/{name}.fgb")
            self.assertEqual(sorted_rows(one, name), sorted_rows(other, name), name)
            files = [ogr.Open(path) for path in (one, other)]
            layers = [file.GetLayerByName(name) for file in files]
            self.assertEqual(*[[(f.GetName(), f.GetTypeName()) for f in layer.schema] for layer in layers])
            self.assertEqual(*[layer.GetGeomType() for layer in layers])
            self.assertTrue(layers[0].GetSpatialRef().IsSame(layers[1].GetSpatialRef()))
            if layers[0].GetFeatureCount() > 0:  # GDAL gives an empty file no index
                self.assertTrue(layers[1].TestCapability(ogr.OLCFastSpatialFilter), name)
            for layer in layers:
                layer.SetSpatialFilterRect(WEST + 100, 1200000, WEST + 125, 1200250)
            self.assertEqual(*[len(list(layer)) for layer in layers])
        self.assertGreater(len(sorted_rows(self.path("fgb/stops.fgb"), "stops")), 0)
        self.assertEqual(set(self.record("fgb")["files"]),
                         set(self.record("gpkg")["files"]) - {name + ".gpkg" for name in LAYERS} |
                         {name + ".fgb" for name in LAYERS} | {name + ".qml" for name in LAYERS})
        for name in self.record("gpkg")["files"]:
            if name.endswith((".tif", ".csv")):
                self.assertEqual(self.hashes("gpkg")[name], self.hashes("fgb")[name], name)

    def test_equal_bytes_for_threads_parts_and_from_its_own_scenario(self):
        self.run_scenario("one", "--vectors", "fgb", "--threads", "1")
        self.run_scenario("two", "--vectors", "fgb", "--threads", "2")
        self.assert_same("one", "two")
        self.run_well("run", self.path("one/scenario.toml"), "-o", self.path("again"), "-q")
        self.assert_same("one", "again")
        for i in (1, 2):
            self.run_scenario(f"part{i}", "--vectors", "fgb", "--part", f"{i}/2")
        self.run_well("merge", self.path("merged"), self.path("part2"), self.path("part1"), "-q")
        self.assert_same("one", "merged")

    def test_the_key_of_the_scenario(self):
        text = self.read_text("s.toml")
        self.write("s.toml", text.replace("[output]\n", '[output]\nvectors = "fgb"\n'))
        self.run_scenario("out")
        self.assertEqual(self.names("out"), {name + ".fgb" for name in LAYERS})
        source = {s["key"]: (s["value"], s["source"]) for s in self.record()["settings"]}["output.vectors"]
        self.assertEqual(source, ("fgb", "scenario"))
        self.run_scenario("out", "--vectors", "gpkg", "--overwrite")  # the flag counts more; nothing is left of the other
        self.assertEqual(self.names("out"), {name + ".gpkg" for name in LAYERS})
        self.run_scenario("out", "--overwrite")
        self.assertEqual(self.names("out"), {name + ".fgb" for name in LAYERS})

    def test_another_format_is_refused(self):
        self.fails(2, "flag --vectors = 'shp': must be 'gpkg' (GeoPackage) or 'fgb' (FlatGeobuf)",
                   arguments=["run", self.path("s.toml"), "-o", self.path("out"), "--vectors", "shp"])
        self.write("t.toml", 'dem = "dem.tif"\n[output]\nvectors = "shp"\n')
        self.fails(2, "t.toml:3: output.vectors = 'shp': must be 'gpkg' (GeoPackage) or 'fgb' (FlatGeobuf)",
                   arguments=["run", self.path("t.toml"), "-o", self.path("out")])
        self.assertFalse(os.path.exists(self.path("out")))
        commands = json.loads(self.run_well("help", "--json").stdout)["commands"]
        run = next(command for command in commands if command["name"] == "run")
        vectors = next(p for p in run["parameters"] if p["name"] == "vectors")
        self.assertEqual((vectors["type"], vectors["choices"], vectors["default"]), ("choice", ["gpkg", "fgb"], "gpkg"))

    def test_styles_and_the_project(self):
        self.run_scenario("out", "--vectors", "fgb")
        self.run_well("hazard", self.path("out"), "-q")
        project = xml.parse(self.path("out/talus.qgs")).getroot()
        layers = {layer.findtext("id"): layer for layer in project.iter("maplayer")}
        for name in LAYERS:
            style = xml.parse(self.path(f"out/{name}.qml")).getroot()
            self.assertEqual(style.find("renderer-v2").get("type"), "graduatedSymbol")
            self.assertEqual(style.find("pipe/rasterrenderer") is not None, name == "exits")  # of exits.tif
            layer = layers[name + "_talus_layer"]
            self.assertEqual(layer.findtext("datasource"), f"./{name}.fgb")
            self.assertEqual(layer.find("renderer-v2").get("attr"), style.find("renderer-v2").get("attr"))
        self.run_well("report", self.path("out"))
        self.run_well("barrier", self.path("out"), "--screen", "road")


if __name__ == "__main__":
    unittest.main()
