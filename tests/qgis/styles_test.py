"""Opens the project of a result in QGIS, without a screen: every layer is there, with its legend and its colours.

Needs QGIS 3.22 or later (python3-qgis). TALUS is the path of the program.
"""
import csv
import os
import shutil
import subprocess
import tempfile
import unittest

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from osgeo import gdal  # noqa: E402
from qgis.core import (QgsApplication, QgsExpression, QgsExpressionContext, QgsExpressionContextUtils, QgsFeature, QgsGeometry,  # noqa: E402
                       QgsMapRendererParallelJob, QgsMapSettings, QgsProject, QgsRasterLayer, QgsRectangle,
                       QgsSingleSymbolRenderer, QgsVectorLayer)
from qgis.PyQt.QtCore import QSize  # noqa: E402
from qgis.PyQt.QtGui import QColor  # noqa: E402

TALUS = os.environ.get("TALUS", "talus")
VALLEY = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../data/valley")


def renders(layers, extent, system, size=QSize(400, 400), background="white"):
    settings = QgsMapSettings()
    settings.setLayers(layers)
    settings.setExtent(extent)
    settings.setDestinationCrs(system)
    settings.setOutputSize(size)
    settings.setBackgroundColor(QColor(background))
    job = QgsMapRendererParallelJob(settings)
    job.start()
    job.waitForFinished()
    return job.renderedImage()


class Project(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.app = QgsApplication.instance() or QgsApplication([], False)
        cls.app.initQgis()
        cls.folder = tempfile.mkdtemp(prefix="talus-qgis-")
        cls.addClassCleanup(shutil.rmtree, cls.folder, True)
        shutil.copytree(VALLEY, os.path.join(cls.folder, "valley"))
        out = os.path.join(cls.folder, "out")
        for arguments in (["run", os.path.join(cls.folder, "valley/scenario.toml"), "--trajectories", "10", "-o", out],
                          ["hazard", out, "--objects", os.path.join(cls.folder, "valley/houses.gpkg")],
                          ["barrier", out, "--screen", "road"]):
            subprocess.run([TALUS, *arguments, "-q"], check=True)
        # Another place: all paths of the project are relative.
        cls.moved = cls.folder + "-moved"
        os.rename(cls.folder, cls.moved)
        cls.addClassCleanup(shutil.rmtree, cls.moved, True)
        cls.out = os.path.join(cls.moved, "out")

    def setUp(self):
        self.project = QgsProject()
        self.assertTrue(self.project.read(os.path.join(self.out, "talus.qgs")), self.project.error())
        self.group = self.project.layerTreeRoot().children()[0]
        self.layers = {layer.name(): layer.layer() for layer in self.group.findLayers()}

    def test_flatgeobuf_has_its_styles_beside_it(self):
        out = os.path.join(self.moved, "fgb")
        subprocess.run([TALUS, "run", os.path.join(self.moved, "valley/scenario.toml"), "--trajectories", "5", "--vectors",
                        "fgb", "-o", out, "-q"], check=True)
        project = QgsProject()
        self.assertTrue(project.read(os.path.join(out, "talus.qgs")), project.error())
        shown = {os.path.basename(layer.source()): layer for layer in project.mapLayers().values()}
        self.assertTrue(all(layer.isValid() for layer in shown.values()))
        for name, attribute in (("stops", "max_speed_ms"), ("exits", "energy_kj"), ("trajectories", "max_speed_ms"),
                                ("screens", "energy_kj_p95")):
            for layer in (shown[name + ".fgb"], QgsVectorLayer(f"{out}/{name}.fgb", name, "ogr")):
                self.assertEqual(layer.renderer().type(), "graduatedSymbol")
                self.assertIn(attribute, layer.renderer().classAttribute())
        for layer in (shown["exits.tif"], QgsRasterLayer(f"{out}/exits.tif", "exits")):  # exits.qml is of both
            self.assertEqual(layer.renderer().type(), "singlebandpseudocolor")

    def test_opens_everything_as_one_group(self):
        self.assertEqual(len(self.project.layerTreeRoot().children()), 1)
        self.assertEqual(self.group.name(), "Talus")
        self.assertEqual(self.project.crs().authid(), "EPSG:2056")
        self.assertGreater(len(self.layers), 25)
        for name, layer in self.layers.items():
            self.assertTrue(layer is not None and layer.isValid(), name)
            if layer.isSpatial():
                self.assertEqual(layer.crs().authid(), "EPSG:4326" if name == "Sources of the run" else "EPSG:2056", name)
        names = list(self.layers)
        maps = [name for name in names if self.layers[name].type() == 1]
        self.assertEqual(maps[:2], ["Hazard goes on beyond the map (cut short)", "Class undecided"])
        self.assertEqual((maps[2], names[-1]), ("Hazard class, energy with rotation", "Hillshade of the DEM"))
        visible = [layer.name() for layer in self.group.findLayers() if layer.isVisible()]
        self.assertEqual(visible, ["Barrier at road: MEL by stretch", "Objects: return period of a hit", "Screens: energy, P95",
                                   "Sources of the run", "Hazard goes on beyond the map (cut short)", "Hazard class, energy with rotation",
                                   "Hillshade of the DEM"])
        self.assertEqual(self.layers["Hillshade of the DEM"].renderer().type(), "hillshade")

    def test_tables_and_inputs_are_those_of_the_files(self):
        """The six cliffs where they are, and each table with its numbers."""
        cliffs = self.layers["Sources of the run"]
        self.assertEqual((cliffs.featureCount(), cliffs.renderer().type()), (6, "singleSymbol"))
        self.assertEqual(cliffs.renderer().symbol().symbolLayer(0).color().alpha(), 0)  # what lies below is seen
        for name, file in (("Barrier at road: design values", "barrier_road.csv"), ("Objects: sources of the hits", "objects_sources.csv"),
                           ("Objects: hazard curves, energy with rotation", "objects_curves.csv"), ("Screens: all quantities", "screens_summary.csv")):
            with open(os.path.join(self.out, file), encoding="utf-8", newline="") as text:
                self.assertEqual(self.layers[name].featureCount(), len(list(csv.DictReader(text))), name)
        values = {f["name"]: f["value"] for f in self.layers["Barrier at road: design values"].getFeatures()}
        self.assertAlmostEqual(values["MEL"], 1.3 * values["SEL"], delta=1e-3 * values["MEL"])  # docs/barrier.md

    def test_legends(self):
        def raster(name):
            return [item.label for item in self.layers[name].renderer().shader().rasterShaderFunction().colorRampItemList()]

        def vector(name):
            return [item.label() for item in self.layers[name].renderer().ranges()]

        self.assertEqual(raster("Hazard class, energy with rotation"), ["none", "residual", "low", "medium", "high"])
        years = ["up to 10 years", "10 to 30 years", "30 to 100 years", "100 to 300 years", "300 to 1000 years", "above 1000 years"]
        self.assertEqual(raster("Return period of more than 300 kJ, energy with rotation"), years)
        self.assertEqual(vector("Objects: return period of a hit"), years + ["no hit counted in this run"])
        self.assertEqual(raster("Reach probability"), ["0 %", "up to 2 %", "2 to 5 %", "5 to 10 %", "10 to 20 %", "20 to 50 %", "50 to 100 %"])
        kj = ["up to 30 kJ", "30 to 100 kJ", "100 to 300 kJ", "300 to 1000 kJ", "1000 to 3000 kJ", "above 3000 kJ"]
        self.assertEqual(vector("Barrier at road: MEL by stretch"), kj + ["too few crossings for a design"])
        self.assertEqual(vector("Screens: energy, P95"), kj + ["no crossing"])
        for name in "Stops: largest energy of the path", "Ends off the map: energy":
            self.assertEqual(vector(name), kj)
        self.assertEqual(vector("Paths: largest speed")[0], "up to 5 m/s")

    def test_objects_that_are_not_hit_are_seen_on_every_ground(self):
        """White with a dark rim: the drawn symbol of the last class has both, for areas and for lines."""
        areas = QgsVectorLayer("Polygon?crs=EPSG:2056", "areas", "memory")
        lines = QgsVectorLayer("LineString?crs=EPSG:2056", "lines", "memory")
        for layer, shape in ((areas, "POLYGON ((0 0,60 0,60 60,0 60,0 0))"), (lines, "LINESTRING (0 30,60 30)")):
            feature = QgsFeature()
            feature.setGeometry(QgsGeometry.fromWkt(shape))
            layer.dataProvider().addFeatures([feature])
        never = self.layers["Objects: return period of a hit"].renderer().ranges()[-1]
        screens = self.layers["Screens: energy, P95"].renderer().ranges()[-1]  # lines without a crossing look alike
        for layer, one in ((areas, never), (lines, screens)):
            layer.setRenderer(QgsSingleSymbolRenderer(one.symbol().clone()))
            for background in "#b0b0b0", "#606060":
                image = renders([layer], QgsRectangle(-20, -20, 80, 80), layer.crs(), QSize(200, 200), background)
                column = [QColor(image.pixel(100, y)).name() for y in range(200)]
                self.assertIn("#ffffff", column, background)
                self.assertGreaterEqual(column.count("#232323"), 2, background)

    def test_a_layer_alone_has_its_style(self):
        for name in "stops", "exits", "trajectories", "screens", "objects", "barrier_road":
            layer = QgsVectorLayer(os.path.join(self.out, name + ".gpkg"), name, "ogr")
            self.assertEqual(layer.renderer().type(), "graduatedSymbol", name)

    def test_candidates_pits_and_profiles_have_their_style(self):
        """Drawn in the colours of their classes; the ground of a profile is a line of one."""
        dem, line = os.path.join(self.moved, "valley/dem.tif"), os.path.join(self.moved, "line.csv")
        with open(line, "w", encoding="utf-8") as file:
            file.write('id,wkt\np,"LINESTRING (2650200 1170500, 2651000 1170500)"\n')
        for arguments in (["sources", "--dem", dem, "--slope", "45", "-o", os.path.join(self.moved, "sources.gpkg")],
                          ["check", "--dem", dem, "--sources", os.path.join(self.moved, "valley/cliffs.shp"), "--diameter", "1",
                           "--pits", os.path.join(self.moved, "pits.gpkg")],
                          ["profile", "--dem", dem, "--line", line, "--source-x", "20", "--diameter", "1", "--screen-x", "300",
                           "-o", os.path.join(self.moved, "profile")]):
            subprocess.run([TALUS, *arguments, "-q"], check=True)
        for file, layer, attribute, label in (("sources", "source_polygons", "slope_deg", "up to 45 deg"),
                                              ("sources", "source_points", "slope_deg", "up to 45 deg"),
                                              ("pits", "pits", "depth_m", "up to 0.03 m"),
                                              ("profile/profile", "bins", "energy_kj_p95", "up to 30 kJ"),
                                              ("profile/profile", "crossings", "energy_kj", "up to 30 kJ"),
                                              ("profile/profile", "stops", "max_speed_ms", "up to 30 kJ")):
            shown = QgsVectorLayer(os.path.join(self.moved, f"{file}.gpkg|layername={layer}"), layer, "ogr")
            self.assertIn(attribute, shown.renderer().classAttribute())
            classes = shown.renderer().ranges()
            self.assertEqual(classes[0].label(), label)
            image = renders([shown], shown.extent().buffered(5.0), shown.crs())
            drawn = {image.pixelColor(x, y).name() for x in range(400) for y in range(400)}
            least = 1 if layer == "crossings" else 2  # which lie above each other at their place
            self.assertGreaterEqual(len(drawn & {one.symbol().color().name() for one in classes}), least, layer)
        ground = QgsVectorLayer(os.path.join(self.moved, "profile/profile.gpkg|layername=profile"), "profile", "ogr")
        self.assertEqual(ground.renderer().symbol().color().name(), "#232323")

    def test_lines_and_areas_in_one_layer_of_objects(self):
        """QGIS draws one kind of geometry per layer: each has its own, in symbols of its kind."""
        mixed, out = os.path.join(self.moved, "mixed.gpkg"), os.path.join(self.moved, "mixed")
        for name, options in (("houses", {}), ("screens", {"accessMode": "append"})):
            gdal.VectorTranslate(mixed, os.path.join(self.moved, f"valley/{name}.gpkg"), format="GPKG", layerName="objects",
                                 geometryType="GEOMETRY", **options)
        for arguments in (["run", os.path.join(self.moved, "valley/scenario.toml"), "--trajectories", "2", "-o", out],
                          ["hazard", out, "--objects", mixed, "--width", "5"]):
            subprocess.run([TALUS, *arguments, "-q"], check=True)
        project = QgsProject()
        self.assertTrue(project.read(os.path.join(out, "talus.qgs")), project.error())
        found = {layer.name(): layer.layer() for layer in project.layerTreeRoot().children()[0].findLayers()}
        for name, kind, symbol, count in (("Objects: return period of a hit (lines)", 1, "QgsLineSymbol", 2),
                                          ("Objects: return period of a hit", 2, "QgsFillSymbol", 6)):
            layer = found[name]
            self.assertEqual((layer.geometryType(), layer.featureCount()), (kind, count))
            self.assertEqual(type(layer.renderer().ranges()[0].symbol()).__name__, symbol)
            image = renders([layer], layer.extent(), layer.crs())
            drawn = {image.pixelColor(x, y).name() for x in range(0, 400, 2) for y in range(0, 400, 2)}
            self.assertGreater(len(drawn), 1, name)

    def test_every_feature_has_a_class(self):
        for name in ("Stops: largest energy of the path", "Paths: largest speed", "Screens: energy, P95",
                     "Objects: return period of a hit", "Barrier at road: MEL by stretch"):
            layer = self.layers[name]
            used = set()
            expression = QgsExpression(layer.renderer().classAttribute())
            context = QgsExpressionContext(QgsExpressionContextUtils.globalProjectLayerScopes(layer))
            for feature in layer.getFeatures():
                context.setFeature(feature)
                value = expression.evaluate(context)
                matching = [i for i, one in enumerate(layer.renderer().ranges()) if one.lowerValue() <= value <= one.upperValue()]
                self.assertTrue(matching, (name, value))
                used.add(matching[0])
            if name.startswith("Stops"):
                self.assertGreater(len(used), 2)  # the classes tell blocks apart

    def test_objects_that_are_not_wholly_assessed_are_in_no_class_of_safe_ones(self):
        """No block comes to a field in the west of the cliffs, nor to one that lies mostly off the DEM there."""
        fields, out = os.path.join(self.moved, "fields.csv"), os.path.join(self.moved, "fields")
        with open(fields, "w", encoding="utf-8") as file:
            for row in ("name,wkt", *(f'{name},"POLYGON (({w} 1170500,{e} 1170500,{e} 1170520,{w} 1170520,{w} 1170500))"'
                                      for name, w, e in (("inside", 2650020, 2650030), ("partly", 2649980, 2650030)))):
                file.write(row + "\n")
        for arguments in (["run", os.path.join(self.moved, "valley/scenario.toml"), "--trajectories", "2", "-o", out],
                          ["hazard", out, "--objects", fields]):
            subprocess.run([TALUS, *arguments, "-q"], check=True)
        layer = QgsVectorLayer(os.path.join(out, "objects.gpkg"), "objects", "ogr")
        expression, context = QgsExpression(layer.renderer().classAttribute()), QgsExpressionContext()
        values = {}
        for feature in layer.getFeatures():
            context.setFeature(feature)
            context.setFields(layer.fields())
            self.assertEqual(feature["trajectories"], 0)
            values[feature["name"]] = expression.evaluate(context)
        self.assertEqual(values["inside"], 1e99)
        self.assertFalse(values["partly"])  # NULL

    def test_drawn_colours_are_those_of_the_classes(self):
        layer = self.layers["Hazard class, energy with rotation"]
        band = gdal.Open(os.path.join(self.out, "hazard_class.tif"))
        west, cell, _, north, _, _ = band.GetGeoTransform()
        classes = band.GetRasterBand(1).ReadAsArray()
        colours = {1: "#fff9c4", 2: "#ffd600", 3: "#2979ff", 4: "#d50000"}
        seen = 0
        for number, colour in colours.items():
            rows, columns = (classes == number).nonzero()
            if not len(rows):
                continue
            x, y = west + columns[0] * cell, north - rows[0] * cell
            image = renders([layer], QgsRectangle(x, y - cell, x + cell, y), self.project.crs(), QSize(9, 9))
            drawn, wanted = QColor(image.pixel(4, 4)), QColor(colour)
            for part in "red", "green", "blue":  # 80 % of the colour over white
                self.assertAlmostEqual(getattr(drawn, part)(), round(0.8 * getattr(wanted, part)() + 0.2 * 255), delta=2, msg=number)
            seen += 1
        self.assertGreater(seen, 1)

    def test_the_map_is_drawn(self):
        visible = [layer.layer() for layer in self.group.findLayers() if layer.isVisible()]
        image = renders(visible, self.layers["Hillshade of the DEM"].extent(), self.project.crs())
        colours = {image.pixel(x, y) for x in range(0, 400, 3) for y in range(0, 400, 3)}
        self.assertGreater(len(colours), 50)  # shaded, not empty
        if os.environ.get("TALUS_PICTURES"):
            image.save(os.path.join(os.environ["TALUS_PICTURES"], "styles_test.png"))


if __name__ == "__main__":
    unittest.main()
