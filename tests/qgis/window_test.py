"""The plug-in in the window of QGIS, drawn off the screen: the dialog runs an algorithm in a task of its own and loads the
results, as the button Run does, and layers come to where QGIS puts new ones, before the layer that is current.

Run by tools/scripts/checks/qgis.sh, which sets HOME, QGIS_PLUGINPATH and TALUS.
"""
import csv
import os
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

import numpy as np
from osgeo import gdal
from qgis.core import (QgsApplication, QgsLayerTreeModel, QgsLayerTreeRegistryBridge, QgsProcessingModelAlgorithm, QgsProject,
                       QgsRasterLayer, QgsVectorLayer)
from qgis.gui import QgsGui, QgsLayerTreeView, QgsProcessingModelerParameterWidget
from qgis.PyQt.QtWidgets import QTextEdit

sys.path.append("/usr/share/qgis/python/plugins")  # of Processing
sys.path.append(os.environ["QGIS_PLUGINPATH"])

VALLEY = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../data/valley")
PATIENCE = 120.0  # s for a run of a few hundred paths
POINTS, LINES, AREAS = range(3)

application = None


def setUpModule():
    global application
    application = QgsApplication([], True)
    application.initQgis()
    from processing.core.Processing import Processing
    Processing.initialize()
    from talus_qgis.provider import TalusProvider
    application.talus = TalusProvider()
    QgsApplication.processingRegistry().addProvider(application.talus)
    QgsGui.instance()


class Window(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="talus-qgis-")
        cls.addClassCleanup(shutil.rmtree, cls.folder, True)
        cls.out = os.path.join(cls.folder, "out")
        cls.view = QgsLayerTreeView()
        cls.model = QgsLayerTreeModel(QgsProject.instance().layerTreeRoot())
        cls.view.setModel(cls.model)
        bridge = QgsProject.instance().layerTreeRegistryBridge()
        bridge.addedLayersToLayerTree.connect(cls.select)  # as QgisApp::autoSelectAddedLayer
        cls.view.selectionModel().currentChanged.connect(cls.insert_before_current)
        objects = cls.road_and_houses()
        cls.logs = [cls.run_dialog("run", {"DEM": os.path.join(VALLEY, "dem.tif"), "OUT": cls.out, "TRAJECTORIES": 5,
                                           "SOURCES": os.path.join(VALLEY, "cliffs.shp"), "FREQUENCY_FIELD": "frequency",
                                           "SCREENS": os.path.join(VALLEY, "screens.gpkg")}),
                    cls.run_dialog("hazard", {"FOLDER": cls.out, "OBJECTS": objects}),
                    cls.run_dialog("barrier", {"FOLDER": cls.out, "SCREEN": "road"})]
        cls.group = QgsProject.instance().layerTreeRoot().findGroup("Talus: out")
        cls.project = QgsProject()
        cls.project.read(os.path.join(cls.out, "talus.qgs"))

    @classmethod
    def select(cls, layers):
        cls.view.setCurrentLayer(layers[0])

    @classmethod
    def insert_before_current(cls, *_):
        """As QgisApp::updateNewLayerInsertionPoint of QGIS 3.22."""
        index, node = cls.view.currentIndex(), cls.view.currentNode()
        parent = (node if node.nodeType() == 0 else node.parent()) if node else None
        QgsProject.instance().layerTreeRegistryBridge().setLayerInsertionPoint(QgsLayerTreeRegistryBridge.InsertionPoint(
            parent or QgsProject.instance().layerTreeRoot(), index.row() if index.isValid() else 0))

    @classmethod
    def road_and_houses(cls):
        """Two layers of the map; the road has the width 6 m."""
        path = os.path.join(cls.folder, "road.gpkg")
        gdal.VectorTranslate(path, os.path.join(VALLEY, "screens.gpkg"), format="GPKG", layerName="road", SQLDialect="sqlite",
                             SQLStatement="SELECT geom, id, CAST(6 AS REAL) AS width FROM screens WHERE id = 'road'")
        layers = [QgsVectorLayer(path, "road"), QgsVectorLayer(os.path.join(VALLEY, "houses.gpkg"), "houses")]
        for layer in layers:
            QgsProject.instance().addMapLayer(layer)
        return [layer.id() for layer in layers]

    @classmethod
    def run_dialog(cls, name, values):
        """Presses Run in the dialog; returns the text of its log."""
        from processing.gui.AlgorithmDialog import AlgorithmDialog
        dialog, done = AlgorithmDialog(QgsApplication.processingRegistry().createAlgorithmById("talus:" + name)), []
        log = dialog.findChild(QTextEdit, "txtLog")
        dialog.mainWidget().setParameters(values)
        dialog.algorithmFinished.connect(lambda good, _: done.extend([good, log.toPlainText()]))  # then it closes
        dialog.runAlgorithm()
        last = time.monotonic() + PATIENCE
        while not done and time.monotonic() < last:
            application.processEvents()
            time.sleep(0.01)
        for _ in range(20):  # what the tree of layers does later
            application.processEvents()
        if not done or not done[0]:
            raise AssertionError(done)
        return done[1]

    maxDiff = None

    def test_order_and_titles_are_those_of_the_project(self):
        wanted = [node.name() for node in self.results_in(self.project)]
        found = [node.name() for node in self.group.findLayers() if node.name() not in ("Vertices of the paths", "Hillshade of the DEM")]
        self.assertGreater(len(wanted), 25)
        self.assertEqual(found, wanted)

    @staticmethod
    def results_in(project):
        """The layers in a project that the program has written, without the DEM."""
        return [node for node in project.layerTreeRoot().findLayers() if node.name() != "Hillshade of the DEM"]

    def test_the_barrier_lies_on_top(self):
        """Its line, in stretches with a design of their own, is as long as the screen."""
        top = self.group.findLayers()[:2]
        self.assertEqual([node.name() for node in top], ["Barrier at road: MEL by stretch", "Barrier at road: design values"])
        self.assertEqual([node.itemVisibilityChecked() for node in top], [True, False])
        stretches, values = [node.layer() for node in top]
        screens = QgsVectorLayer(os.path.join(VALLEY, "screens.gpkg"), "screens", "ogr")
        length = next(f.geometry().length() for f in screens.getFeatures() if f["id"] == "road")
        self.assertAlmostEqual(sum(f.geometry().length() for f in stretches.getFeatures()), length, places=3)
        self.assertEqual(stretches.crs().authid(), "EPSG:2056")
        with open(os.path.join(self.out, "barrier_road.csv"), encoding="utf-8") as file:
            written = {row["name"]: float(row["value"]) for row in csv.DictReader(file)}
        self.assertEqual({f["name"]: f["value"] for f in values.getFeatures()}, written)
        self.assertGreater(stretches.featureCount(), 3)

    def test_vector_layers_have_the_classes_of_the_project(self):
        wanted = {node.name(): node.layer() for node in self.project.layerTreeRoot().findLayers()
                  if isinstance(node.layer(), QgsVectorLayer) and node.layer().renderer() is not None
                  and node.layer().renderer().type() == "graduatedSymbol"}
        self.assertGreaterEqual(len(wanted), 7)
        found = {node.name(): node.layer() for node in self.group.findLayers()}
        for name, layer in wanted.items():
            loaded = found[name]
            self.assertEqual(loaded.geometryType(), layer.geometryType(), name)
            self.assertEqual(loaded.featureCount(), layer.featureCount(), name)
            self.assertEqual(loaded.renderer().type(), "graduatedSymbol", name)
            self.assertEqual(self.classes(loaded), self.classes(layer), name)

    def test_flatgeobuf_has_its_classes(self):
        out = os.path.join(self.folder, "fgb")
        self.run_dialog("run", {"DEM": os.path.join(VALLEY, "dem.tif"), "SOURCES": os.path.join(VALLEY, "cliffs.shp"),
                                "TRAJECTORIES": 2, "SCREENS": os.path.join(VALLEY, "screens.gpkg"), "VECTORS": "fgb", "OUT": out})
        project = QgsProject()
        project.read(os.path.join(out, "talus.qgs"))
        group = QgsProject.instance().layerTreeRoot().findGroup("Talus: fgb")
        layers = [node.layer() for node in group.findLayers() if node.name() != "Hillshade of the DEM"]
        # the group Talus: out has layers of these titles, too
        self.assertEqual([layer.name() for layer in layers],
                         [node.name() + ("" if node.name() == "Sources of the run" else " (fgb)") for node in self.results_in(project)])
        wanted = {layer.name() + " (fgb)": layer for layer in project.mapLayers().values()}
        vectors = [layer for layer in layers if isinstance(layer, QgsVectorLayer) and layer.isSpatial() and layer.name() in wanted]
        self.assertEqual(len(vectors), 4)
        for layer in vectors:
            self.assertEqual(self.classes(layer), self.classes(wanted[layer.name()]), layer.name())
            self.assertEqual(layer.renderer().type(), "graduatedSymbol", layer.name())

    def test_z_maps_that_are_replaced_are_read_anew(self):
        """Last, as it changes the results: other widths, so that rasters get other values, come and go."""
        for values in ({"WIDTH": 10.0, "OVERWRITE": True}, {"OVERWRITE": True}):
            self.run_dialog("hazard", {"FOLDER": self.out, **values})
            shown = [g.name() for g in QgsProject.instance().layerTreeRoot().findGroups() if g.itemVisibilityChecked()]
            self.assertEqual(shown, ["Talus: out"])  # those of other folders are hidden
            layers = [node.layer() for node in self.group.findLayers()]
            rasters = {os.path.basename(layer.source()): layer for layer in layers if isinstance(layer, QgsRasterLayer)}
            self.assertEqual("intensity_T30.tif" in rasters, "WIDTH" not in values)  # a layer goes with its file
            self.assertNotIn("objects.gpkg", [os.path.basename(layer.source().split("|")[0]) for layer in layers])
            for name in ("hazard_class.tif", "annual_frequency.tif"):
                layer = rasters[name]
                shown = layer.dataProvider().block(1, layer.extent(), layer.width(), layer.height())
                values_in_file = gdal.Open(layer.source()).ReadAsArray()[0]
                told = [[shown.value(row, column) for column in range(0, layer.width(), 7)]
                        for row in range(0, layer.height(), 7)]
                np.testing.assert_array_equal(np.array(told), np.array(values_in_file[::7, ::7], dtype=float), name)
            with open(rasters["hazard_class.tif"].source() + ".aux.xml", encoding="utf-8") as file:
                self.assertIn("<Category>high</Category>", file.read())

    def test_the_folder_in_a_name_tells_two_of_one_name_apart(self):
        from talus_qgis.results import IntoGroup
        tree = QgsProject.instance().layerTreeRoot()
        south, north, alone = (os.path.join(self.folder, *parts) for parts in (("south", "OUT"), ("north", "OUT"), ("east", "x")))
        groups = []
        for folder in (south, north, alone):
            groups.append(tree.insertGroup(0, "Talus"))
            groups[-1].setCustomProperty("talus/folder", folder)
        for folder, group, wanted in ((north, groups[1], "north/OUT"), (alone, groups[2], "x")):
            self.assertEqual(IntoGroup(folder, "", "", "", 0, False)._folder_among(tree, group), wanted)
        for group in groups:
            tree.removeChildNode(group)

    def test_the_folder_of_the_results_on_top_is_preselected(self):
        tree = QgsProject.instance().layerTreeRoot()
        on_top = tree.insertGroup(0, "Talus: gone")
        on_top.setCustomProperty("talus/folder", os.path.join(self.folder, "gone"))  # is no longer there
        others = [group for group in tree.findGroups() if group.customProperty("talus/folder")][1:]
        hazard = QgsApplication.processingRegistry().createAlgorithmById("talus:hazard")
        folder = hazard.parameterDefinition("FOLDER").defaultValue()
        self.assertEqual(folder, others[0].customProperty("talus/folder"))
        self.assertTrue(os.path.exists(os.path.join(folder, "run.json")))
        tree.removeChildNode(on_top)

    def test_the_screens_of_the_chosen_folder_are_listed(self):
        from processing.gui.AlgorithmDialog import AlgorithmDialog
        one = os.path.join(self.folder, "one")
        os.mkdir(one)
        with open(os.path.join(one, "run.json"), "w", encoding="utf-8") as file:
            file.write('{"screens": [{"id": "alone"}]}')
        dialog = AlgorithmDialog(QgsApplication.processingRegistry().createAlgorithmById("talus:barrier"))
        wrappers = dialog.mainWidget().wrappers
        box = wrappers["SCREEN"].widget
        for folder, listed, chosen in ((self.out, ["road", "foot"], ""), (one, ["alone"], "alone"), (self.folder, [], "alone"),
                                       (self.out, ["road", "foot"], "")):
            wrappers["FOLDER"].setParameterValue(folder, dialog.mainWidget().processing_context)
            self.assertEqual(([box.itemText(i) for i in range(box.count())], box.currentText()), (listed, chosen))
        box.setCurrentIndex(1)
        self.assertEqual(dialog.mainWidget().createProcessingParameters()["SCREEN"], "foot")
        dialog.close()

    def test_in_the_designer_of_models_a_screen_may_be_an_input(self):
        from processing.modeler.ModelerParametersDialog import ModelerParametersDialog
        barrier = QgsApplication.processingRegistry().createAlgorithmById("talus:barrier")
        dialog = ModelerParametersDialog(barrier, QgsProcessingModelAlgorithm())
        self.assertIsInstance(dialog.widget.widget.wrappers["SCREEN"], QgsProcessingModelerParameterWidget)

    def test_the_only_raster_is_the_terrain_where_there_must_be_one(self):
        for only in (True, False):  # the second raster leaves the choice to the user
            layer = QgsRasterLayer(os.path.join(VALLEY, "dem.tif"), "dem")
            QgsProject.instance().addMapLayer(layer)
            for name, wanted in (("sources", layer.id() if only else None), ("run", None)):
                algorithm = QgsApplication.processingRegistry().createAlgorithmById("talus:" + name)
                self.assertEqual(algorithm.parameterDefinition("DEM").defaultValue(), wanted)

    def test_the_log_keeps_the_columns_of_a_table(self):
        told = subprocess.run([os.environ["TALUS"], "barrier", self.out, "--screen", "road"], capture_output=True, text=True,
                              check=True).stdout.splitlines()
        table = [line for line in told if "  " in line]
        self.assertGreater(len(table), 20)
        log = self.logs[-1].splitlines()
        for line in table:
            self.assertIn(line.replace("\u00a0", " "), log)  # the window shows blanks that do not break as others

    @staticmethod
    def classes(layer):
        return [(entry.lowerValue(), entry.upperValue(), entry.label(), entry.symbol().color().name(),
                 type(entry.symbol()).__name__) for entry in layer.renderer().ranges()]


if __name__ == "__main__":
    unittest.main()
