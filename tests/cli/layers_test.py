"""The common job without a scenario file: layers and fields by name, screens, zones, frequency and thresholds by flags."""
import unittest

from osgeo import gdal, ogr

from support import NORTH, WEST, Case, box, system


class Layers(Case):
    def setUp(self):
        super().setUp()
        file = ogr.GetDriverByName("GPKG").CreateDataSource(self.path("site.gpkg"))
        for name, x in (("houses", 300), ("cliffs", 140)):
            layer = file.CreateLayer(name, system(2056), ogr.wkbPolygon)
            layer.CreateField(ogr.FieldDefn("diameter", ogr.OFTReal))
            feature = ogr.Feature(layer.GetLayerDefn())
            feature.SetField(0, 1.2)
            feature.SetGeometry(ogr.CreateGeometryFromWkt(box(x, 230, 10, 10)))
            layer.CreateFeature(feature)
        self.flags = ["--dem", self.path("dem.tif"), "--trajectories", "5"]

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
        with open(self.path("out/scenario.toml"), encoding="utf-8") as file:
            complete = file.read()
        for words in ("total = 0.5", "energy_thresholds = [10, 100]", "[ground.zones.forest-road-3d]", 'field = "ground"'):
            self.assertIn(words, complete)
        self.run_well("run", self.path("out/scenario.toml"), "-o", self.path("again"))
        for name in "impact_probability.tif", "energy.tif":
            self.assertTrue((gdal.Open(self.path(f"out/{name}")).ReadAsArray() == gdal.Open(self.path(f"again/{name}")).ReadAsArray()).all())
        self.fails(2, "must ascend", arguments=["run", *flags[:-1], "100,10", "-o", self.path("no")])
        self.fails(2, "flag --frequency", arguments=["run", *self.flags, "--sources", self.path("site.gpkg"), "--sources-layer", "cliffs",
                                                     "--frequency", "-1", "-o", self.path("no")])


if __name__ == "__main__":
    unittest.main()
