#!/usr/bin/python3
"""Loads every raster of a run in QGIS with its .qml, without a window, and compares what is drawn with the legend.

  tools/scripts/checks/check_styles.py FOLDER [--picture OUT.png]     needs: apt-get install python3-qgis qgis-providers fonts-dejavu-core

QGIS reads each raster, takes the style and draws it. At each of some hundred cells the drawn colour must be the one that
the text of the style has for the value of the cell; nodata must draw nothing. Vector results must load too. Prints a line
for each fault, with exit code 1. CI does not run it, because QGIS takes 1.3 GB.
"""
import argparse
import glob
import os
import sys
import xml.etree.ElementTree as xml

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
from qgis.core import (QgsApplication, QgsMapRendererParallelJob, QgsMapSettings, QgsPointXY, QgsRasterLayer,  # noqa: E402
                       QgsRectangle, QgsVectorLayer)
from qgis.PyQt.QtCore import QSize  # noqa: E402
from qgis.PyQt.QtGui import QColor  # noqa: E402

PLACES = 30  # across and down


def legend(qml):
    """The style's band and its classes: (upper limit, colour, whether it is drawn)."""
    renderer = xml.parse(qml).getroot().find("pipe/rasterrenderer")
    items = [(float(i.get("value")), QColor(i.get("color")), i.get("alpha") != "0") for i in renderer.iter("item")]
    return int(renderer.get("band")), float(renderer.get("opacity")), items


def draw(layer, extent, width, height):
    settings = QgsMapSettings()
    settings.setLayers([layer])
    settings.setDestinationCrs(layer.crs())
    settings.setExtent(extent)
    settings.setOutputSize(QSize(width, height))
    settings.setBackgroundColor(QColor(255, 255, 255))
    job = QgsMapRendererParallelJob(settings)
    job.start()
    job.waitForFinished()
    return job.renderedImage()


def expected(value, opacity, items):
    """The colour on a white ground for a value; None is nodata."""
    colour = next((c for limit, c, drawn in items if value is not None and value <= limit and drawn), None)
    if value is not None and value <= items[0][0] and not items[0][2]:
        colour = None
    if colour is None:
        return (255, 255, 255)
    return tuple(round(255 * (1 - opacity) + opacity * c) for c in (colour.red(), colour.green(), colour.blue()))


def faults_of(tif):
    layer = QgsRasterLayer(tif, os.path.basename(tif))
    if not layer.isValid():
        return ["not read"], 0
    band, opacity, items = legend(tif[:-4] + ".qml")
    message, loaded = layer.loadNamedStyle(tif[:-4] + ".qml")
    if not loaded:
        return [f"style refused: {message}"], 0
    provider, faults, drawn = layer.dataProvider(), [], 0
    dx, dy, extent = layer.rasterUnitsPerPixelX(), layer.rasterUnitsPerPixelY(), layer.extent()
    image = draw(layer, extent, layer.width(), layer.height())  # a pixel per cell
    for i in range(PLACES):
        for j in range(PLACES):
            column, row = (2 * i + 1) * layer.width() // (2 * PLACES), (2 * j + 1) * layer.height() // (2 * PLACES)
            at = QgsPointXY(extent.xMinimum() + (column + 0.5) * dx, extent.yMaximum() - (row + 0.5) * dy)
            value, known = provider.sample(at, band)
            wanted = expected(value if known else None, opacity, items)
            seen = QColor(image.pixel(column, row)).getRgb()[:3]
            drawn += wanted != (255, 255, 255)
            if max(abs(a - b) for a, b in zip(seen, wanted)) > 2:
                faults.append(f"column {column}, row {row}: value {value if known else 'nodata'} is drawn {seen}, legend {wanted}")
    return faults, drawn


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder")
    parser.add_argument("--picture", help="PNG of impact_probability as QGIS draws it")
    o = parser.parse_args()
    app = QgsApplication([], False)
    app.initQgis()
    bad = 0
    rasters = sorted(glob.glob(f"{o.folder}/*.tif"))
    for tif in rasters:
        faults, drawn = faults_of(tif)
        print(f"{os.path.basename(tif)}: {drawn} of {PLACES * PLACES} places coloured, {len(faults)} faults")
        for fault in faults[:3]:
            print(f"  {fault}")
        bad += bool(faults)
    for gpkg in sorted(glob.glob(f"{o.folder}/*.gpkg")):
        layer = QgsVectorLayer(gpkg, "layer", "ogr")
        print(f"{os.path.basename(gpkg)}: {layer.featureCount() if layer.isValid() else 'not read'} features")
        bad += not layer.isValid()
    if o.picture:
        layer = QgsRasterLayer(f"{o.folder}/impact_probability.tif", "impact_probability")
        layer.loadNamedStyle(f"{o.folder}/impact_probability.qml")
        draw(layer, QgsRectangle(layer.extent()), 2 * layer.width(), 2 * layer.height()).save(o.picture)
    app.exitQgis()
    return 1 if bad or not rasters else 0


sys.exit(main())
