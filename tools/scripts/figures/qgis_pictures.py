#!/usr/bin/python3
"""Draws the pictures of docs/qgis.md, without a window: a dialog of the plug-in, and the example valley as it is loaded. Seconds.

  TALUS=build/release/talus tools/scripts/figures/qgis_pictures.py docs/pictures [--language de]

Needs: apt-get install --no-install-recommends qgis python3-qgis qgis-providers fonts-dejavu-core
"""
import argparse
import os
import sys
import tempfile

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../..")
sys.path += ["/usr/share/qgis/python/plugins", os.path.join(ROOT, "tools/qgis")]

from qgis.core import (QgsApplication, QgsHillshadeRenderer, QgsLayerTreeModel, QgsMapRendererParallelJob,  # noqa: E402
                       QgsMapSettings, QgsProcessingContext, QgsProcessingFeedback, QgsProject, QgsRasterDataProvider,
                       QgsRasterLayer, QgsRasterPipe, QgsVectorLayer)
from qgis.gui import QgsGui, QgsLayerTreeView  # noqa: E402
from qgis.PyQt.QtCore import QLocale, QSize  # noqa: E402
from qgis.PyQt.QtGui import QColor, QImage, QPainter  # noqa: E402

VALLEY = os.path.normpath(os.path.join(ROOT, "data/valley"))


def start(language):
    application = QgsApplication([], True)
    application.initQgis()
    QgsApplication.setLocale(QLocale(language))
    from processing.core.Processing import Processing
    Processing.initialize()
    from talus_qgis.provider import TalusProvider
    application.talus = TalusProvider()
    QgsApplication.processingRegistry().addProvider(application.talus)
    QgsGui.instance()
    return application


def open_valley():
    dem = QgsRasterLayer(VALLEY + "/dem.tif", "dem")
    dem.setRenderer(QgsHillshadeRenderer(dem.dataProvider(), 1, 315, 45))
    dem.setResamplingStage(QgsRasterPipe.ResamplingStage.Provider)  # else the hillshade has stripes between the cells
    dem.dataProvider().enableProviderResampling(True)
    dem.dataProvider().setZoomedInResamplingMethod(QgsRasterDataProvider.ResamplingMethod.Cubic)
    layers = [dem, QgsVectorLayer(VALLEY + "/cliffs.shp", "cliffs", "ogr")]
    for layer in layers:
        QgsProject.instance().addMapLayer(layer)
    QgsProject.instance().setCrs(dem.crs())
    return dem


def dialog(application, path):
    from processing.gui.AlgorithmDialog import AlgorithmDialog
    shown = AlgorithmDialog(QgsApplication.processingRegistry().createAlgorithmById("talus:run"))
    inputs = QgsProject.instance().mapLayersByName
    values = {"DEM": inputs("dem")[0], "SOURCES": inputs("cliffs")[0], "FREQUENCY_FIELD": "frequency"}
    shown.mainWidget().setParameters(values)
    shown.resize(900, 860)
    shown.show()
    application.processEvents()
    shown.grab().save(path)
    shown.hide()


def run(name, parameters):
    from processing.gui.Postprocessing import handleAlgorithmResults
    context, feedback = QgsProcessingContext(), QgsProcessingFeedback()
    context.setProject(QgsProject.instance())
    algorithm = QgsApplication.processingRegistry().createAlgorithmById("talus:" + name)
    _, good = algorithm.run(parameters, context, feedback)
    if not good:
        sys.exit(feedback.textLog())
    handleAlgorithmResults(algorithm, context, feedback)


def project(dem, path, application):
    """The tree of layers, left, and the map, right."""
    root = QgsProject.instance().layerTreeRoot()
    view = QgsLayerTreeView()
    model = QgsLayerTreeModel(root)
    view.setModel(model)
    for group in root.findGroups():
        group.setExpanded(True)
    view.resize(340, 780)
    view.show()
    application.processEvents()
    settings = QgsMapSettings()
    settings.setLayers([layer for layer in root.layerOrder() if root.findLayer(layer.id()).isVisible()])
    settings.setDestinationCrs(dem.crs())
    settings.setExtent(dem.extent())
    settings.setOutputSize(QSize(900, 780))  # 3 x 3 pixels a cell
    settings.setBackgroundColor(QColor(255, 255, 255))
    job = QgsMapRendererParallelJob(settings)
    job.start()
    job.waitForFinished()
    picture = QImage(1240, 780, QImage.Format_RGB32)
    painter = QPainter(picture)
    painter.drawPixmap(0, 0, view.grab())
    painter.drawImage(340, 0, job.renderedImage())
    painter.end()
    picture.save(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder")
    parser.add_argument("--language", default="en")
    options = parser.parse_args()
    application = start(options.language)
    dem = open_valley()
    dialog(application, os.path.join(options.folder, "qgis_run.png"))
    with tempfile.TemporaryDirectory() as work:
        out = os.path.join(work, "valley")
        run("run", {"DEM": dem, "SOURCES": QgsProject.instance().mapLayersByName("cliffs")[0], "FREQUENCY_FIELD": "frequency",
                    "TRAJECTORIES": 50, "COUNT_ROTATION": True, "OUT": out, "LOAD": True, "SCREENS": VALLEY + "/screens.gpkg"})
        run("hazard", {"FOLDER": out, "WIDTH": 10.0, "OBJECTS": VALLEY + "/houses.gpkg", "LOAD": True})
        project(dem, os.path.join(options.folder, "qgis_results.png"), application)
        sys.stdout.flush()
        QgsProject.instance().clear()
    os._exit(0)  # QGIS 3.22 falls over its own objects where Python ends


if __name__ == "__main__":
    main()
