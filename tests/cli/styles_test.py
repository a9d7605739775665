"""Styles, names of classes and the project of QGIS, as files; tests/qgis/styles_test.py opens them in QGIS."""
import os
import unittest
import xml.etree.ElementTree as xml

from osgeo import gdal, ogr

from support import NORTH, WEST, RunCase, box, rows_of, write_features


class Styles(RunCase):
    def setUp(self):
        super().setUp()
        self.run_scenario("out")

    def project(self, out="out"):
        return xml.parse(self.path(f"{out}/talus.qgs")).getroot()

    def titles(self, out="out"):
        return [layer.get("name") for layer in self.project(out).iter("layer-tree-layer")]

    def test_vectors_have_a_style_in_their_file(self):
        for name, attribute in (("stops", "mass_kg"), ("exits", "energy_kj"), ("trajectories", "max_speed_ms"),
                                ("screens", "energy_kj_p95")):
            file = ogr.Open(self.path(f"out/{name}.gpkg"))
            self.assertEqual(file.GetLayer(0).GetName(), name)  # the style is not the first layer
            rows = [row.items() for row in file.GetLayerByName("layer_styles")]
            self.assertEqual([(row["f_table_name"], row["f_geometry_column"], bool(row["useAsDefault"])) for row in rows],
                             [(name, "geom", True)])
            renderer = xml.fromstring(rows[0]["styleQML"].split("\n", 1)[1]).find("renderer-v2")
            self.assertEqual(renderer.get("type"), "graduatedSymbol")
            self.assertIn(attribute, renderer.get("attr"))
            self.assertIn(attribute, [f.GetName() for f in file.GetLayer(0).schema])

    def test_screens_have_the_figures_of_the_summary(self):
        rows = {row["quantity"]: row for row in self.read_table("out/screens_summary.csv")}
        feature = rows_of(self.path("out/screens.gpkg"), "screens")[0][0]
        self.assertEqual((feature["id"], feature["crossings"]), ("road", int(rows["energy"]["crossings"])))
        self.assertEqual(feature["energy_kj_p95"], float(rows["energy"]["p95"]))
        self.assertEqual(feature["jump_height_m_max"], float(rows["jump height"]["maximum"]))

    def test_the_project_shows_what_is_there(self):
        root, record = self.project(), self.record()
        self.assertIn("talus.qgs", record["files"])
        group = root.find("layer-tree-group/layer-tree-group")
        self.assertEqual(group.get("name"), "Talus")
        self.assertEqual(self.titles()[-1], "Hillshade of the DEM")
        sources = [layer.findtext("datasource") for layer in root.iter("maplayer")]
        inputs = {"dem.tif", "sources.gpkg", "nets.gpkg"}
        for name in inputs:
            self.assertIn("../" + name, sources)
        for source in sources:
            self.assertTrue(os.path.exists(os.path.join(self.path("out"), source.split("|")[0])), source)
        shown = {os.path.basename(source.split("|")[0]) for source in sources} - inputs
        self.assertEqual(shown, {name for name in record["files"] if name.endswith((".tif", ".gpkg", ".csv"))} - {"screens.csv"})
        checked = [layer.get("name") for layer in root.iter("layer-tree-layer") if layer.get("checked") == "Qt::Checked"]
        self.assertEqual(checked, ["Screens: energy, P95", "Barriers of the run", "Sources of the run", "Impact probability", "Hillshade of the DEM"])
        self.assertNotIn(self.folder, self.read_text("out/talus.qgs"))  # no absolute path

    def test_hazard_comes_on_top_of_the_maps(self):
        write_features(self.path("houses.gpkg"), "houses", [(box(100, 100, 150, 60), ["house"])], [("name", ogr.OFTString)])
        self.run_well("hazard", self.path("out"), "--objects", self.path("houses.gpkg"), "-q")
        titles = self.titles()
        self.assertEqual(titles[0], "Objects: return period of a hit")
        self.assertLess(titles.index("Hazard class, translational energy"), titles.index("Impact probability"))
        self.assertIn("Return period of more than 300 kJ, translational energy", titles)
        checked = [layer.get("name") for layer in self.project().iter("layer-tree-layer") if layer.get("checked") == "Qt::Checked"]
        self.assertEqual(checked, ["Objects: return period of a hit", "Screens: energy, P95", "Barriers of the run",
                                   "Sources of the run", "Hazard class, translational energy", "Hillshade of the DEM"])
        self.run_well("hazard", self.path("out"), "--overwrite", "-q")  # without the objects: they are gone from the project
        self.assertNotIn("Objects: return period of a hit", self.titles())

    def test_a_barrier_is_on_top_and_goes_with_its_record(self):
        self.run_well("barrier", self.path("out"), "--screen", "road", "--percentile", "50", "-q")
        self.assertEqual(self.titles()[:2], ["Barrier at road: MEL by stretch", "Barrier at road: design values"])
        stretches = rows_of(self.path("out/barrier_road.gpkg"), "barrier_road")
        table = self.read_table("out/barrier_road_stretches.csv")
        self.assertEqual(len(stretches), 10)  # 300 m in stretches of 30 m at most
        west = 2600000.0
        for i, ((feature, geometry), row) in enumerate(zip(stretches, table)):
            self.assertEqual({name: "" if value is None else f"{value:.6g}" if isinstance(value, float) else str(value)
                              for name, value in feature.items()}, row)
            points = [geometry.GetPoint(k)[0] for k in range(geometry.GetPointCount())]
            for end, wanted in zip((points[0], points[-1]), (west + 30.0 * i, west + 30.0 * (i + 1))):
                self.assertAlmostEqual(end, wanted, places=6)
        self.run_well("hazard", self.path("out"), "-q")  # writes the project anew
        self.assertEqual(self.titles()[0], "Barrier at road: MEL by stretch")
        os.remove(self.path("out/barrier_road.json"))  # now they are files of the user
        self.run_well("hazard", self.path("out"), "--overwrite", "-q")
        self.assertEqual([title for title in self.titles() if title.startswith("Barrier at")], [])

    def test_a_barrier_is_titled_by_the_id_of_its_line(self):
        line = f"LINESTRING ({WEST} {NORTH - 220}, {WEST + 300} {NORTH - 220})"
        ids = ["L123 km 4,2", "a/b", "a_b"]
        write_features(self.path("screens.gpkg"), "screens", [(line, [name]) for name in ids], [("id", ogr.OFTString)])
        self.run_scenario("out", "--overwrite")
        for name in ids:
            self.run_well("barrier", self.path("out"), "--screen", name, "--percentile", "50", "-q")
        wanted = [f"Barrier at {name}: {what}" for what in ("MEL by stretch", "design values") for name in ("a/b", "a_b", "L123 km 4,2")]
        self.assertEqual(self.titles()[:6], wanted)  # not L123_km_4_2, a_b-c14cddc0
        self.run_well("hazard", self.path("out"), "-q")
        self.assertEqual(self.titles()[:6], wanted)

    def test_classes_have_their_names_for_gdal(self):
        self.run_well("hazard", self.path("out"), "-q")
        classes, intensity = gdal.Open(self.path("out/hazard_class.tif")), gdal.Open(self.path("out/intensity_T100.tif"))
        band = classes.GetRasterBand(1)
        names = ["none", "residual", "low", "medium", "high"]
        table = band.GetDefaultRAT()  # first: GDAL 3.6 reads the file of names for it
        self.assertEqual(band.GetCategoryNames(), names)
        self.assertEqual([table.GetValueAsString(i, 1) for i in range(table.GetRowCount())], names)
        self.assertEqual([table.GetValueAsInt(2, column) for column in (2, 3, 4)], [0xff, 0xd6, 0x00])
        table = intensity.GetRasterBand(1).GetDefaultRAT()
        self.assertEqual(table.GetTypeOfCol(0), gdal.GFT_Real)
        self.assertEqual((table.GetValueAsDouble(2, 0), table.GetValueAsDouble(2, 1), table.GetValueAsString(2, 2)),
                         (100.0, 300.0, "100 to 300 kJ"))
        self.run_well("hazard", self.path("out"), "--overwrite", "-q")  # the names are files of the hazard: replaced


if __name__ == "__main__":
    unittest.main()
