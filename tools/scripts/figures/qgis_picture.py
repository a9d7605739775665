#!/usr/bin/python3
"""Draws a result as QGIS shows it: the raster with the .qml beside it, over the DEM's hillshade, with its legend.

  QT_QPA_PLATFORM=offscreen tools/scripts/figures/qgis_picture.py DEM RASTER picture.png

Seconds; docs/first-map.md. Needs QGIS 3.22 or later with its python binding (Debian: qgis python3-qgis).
"""
import io
import os
import sys

from PIL import Image
from qgis.core import (Qgis, QgsApplication, QgsHillshadeRenderer, QgsLayoutExporter, QgsLayoutItemLegend, QgsLayoutItemMap,
                       QgsLayoutItemScaleBar, QgsLayoutPoint, QgsLayoutSize, QgsPrintLayout, QgsProject, QgsRasterDataProvider,
                       QgsRasterLayer)


def place(layout, item, x, y, width, height):
    layout.addLayoutItem(item)
    item.attemptMove(QgsLayoutPoint(x, y))
    item.attemptResize(QgsLayoutSize(width, height))
    return item


def layers_of(dem_path, raster_path):
    """The DEM as hillshade and the result in its own style."""
    dem, result = QgsRasterLayer(dem_path, "DEM (hillshade)"), QgsRasterLayer(raster_path, os.path.splitext(os.path.basename(raster_path))[0])
    for layer, path in ((dem, dem_path), (result, raster_path)):
        if not layer.isValid():
            sys.exit(f"{path}: QGIS cannot open it")
    dem.setRenderer(QgsHillshadeRenderer(dem.dataProvider(), 1, 315.0, 45.0))
    dem.renderer().setMultiDirectional(True)
    dem.setResamplingStage(Qgis.RasterResamplingStage.Provider)  # else the cells show as a grid
    dem.dataProvider().enableProviderResampling(True)
    dem.dataProvider().setZoomedInResamplingMethod(QgsRasterDataProvider.ResamplingMethod.Bilinear)
    result.renderer().setOpacity(0.65)
    return dem, result


def layout_of(project, dem, result):
    layout = QgsPrintLayout(project)
    layout.initializeDefaults()
    page = layout.pageCollection().page(0)
    page.setPageSize(QgsLayoutSize(200, 125))
    view = place(layout, QgsLayoutItemMap(layout), 3, 3, 136, 119)
    view.setCrs(dem.crs())
    view.setLayers([result, dem])
    view.setExtent(dem.extent())
    view.setFrameEnabled(True)
    legend = place(layout, QgsLayoutItemLegend(layout), 141, 3, 46, 60)
    legend.setLinkedMap(view)
    legend.setAutoUpdateModel(True)
    bar = place(layout, QgsLayoutItemScaleBar(layout), 141, 106, 46, 14)
    bar.setLinkedMap(view)
    bar.setUnits(0)
    bar.setUnitsPerSegment(100.0)
    bar.setNumberOfSegments(2)
    bar.setUnitLabel("m")
    return layout


def main():
    dem_path, raster_path, picture = sys.argv[1:4]
    QgsApplication.setPrefixPath("/usr", True)
    app = QgsApplication([], False)
    app.initQgis()
    project = QgsProject.instance()
    dem, result = layers_of(dem_path, raster_path)
    project.setCrs(dem.crs())
    project.addMapLayers([dem, result])
    settings = QgsLayoutExporter.ImageExportSettings()
    settings.dpi = 95
    layout = layout_of(project, dem, result)  # the exporter does not keep it alive
    done = QgsLayoutExporter(layout).exportToImage(picture, settings)
    if done != QgsLayoutExporter.Success:
        sys.exit(f"{picture}: QGIS cannot write it ({done})")
    with open(picture, "rb") as file:
        image = Image.open(io.BytesIO(file.read())).convert("RGB")
    image.quantize(128, Image.Quantize.MAXCOVERAGE, kmeans=1, dither=Image.Dither.NONE).save(picture, optimize=True)
    app.exitQgis()


if len(sys.argv) != 4:
    sys.exit(__doc__)
main()
