"""Layers of QGIS as files that the program reads.

A layer that is a plain file goes to the program as it is, so that the record of the run names the user's own file. What
QGIS alone knows (selected features, filters, layers in memory or in a database, another CRS, one band of several) is
written into the folder OUT_inputs beside the results: a run can be resumed, and `hazard` reads the inputs once more.
"""
import filecmp
import os
import re
import tempfile

from osgeo import gdal
from qgis.core import (QgsFeature, QgsFeatureSink, QgsProcessingException, QgsProcessingFeatureSourceDefinition,
                       QgsProviderRegistry, QgsRasterLayer, QgsVectorFileWriter, QgsVectorLayer)

from .texts import tr

READ_AS_THEY_ARE = (".gpkg", ".shp", ".geojson", ".json", ".fgb")


def folder_beside(results):
    return os.path.normpath(results) + "_inputs"


def plain_vector(value, layer):
    """`file|layername=NAME` of a layer that is all of a layer in a file; None if QGIS knows more of it than the file."""
    if isinstance(value, QgsProcessingFeatureSourceDefinition) and _restricted(value):
        return None
    if not isinstance(layer, QgsVectorLayer) or layer.providerType() != "ogr":
        return None
    if layer.subsetString() or layer.isEditable() or layer.dataProvider().subsetString():
        return None
    parts = QgsProviderRegistry.instance().decodeUri("ogr", layer.source())
    path, name = parts.get("path") or "", parts.get("layerName") or ""
    if not os.path.isfile(path) or not path.lower().endswith(READ_AS_THEY_ARE) or "|" in path:
        return None
    file_layer = QgsVectorLayer(path + (f"|layername={name}" if name else ""), "", "ogr")
    if not file_layer.isValid() or file_layer.crs() != layer.crs():
        return None
    if not name and len(file_layer.dataProvider().subLayers()) > 1:
        name = file_layer.dataProvider().subLayers()[0].split("!!::!!")[1]  # the one that QGIS shows
    return path + (f"|layername={name}" if name else "")


def _restricted(definition):
    """Whether only selected features, a number of them or those of a filter are meant."""
    return (definition.selectedFeaturesOnly or definition.featureLimit >= 0 or bool(getattr(definition, "filterExpression", "")))


def suffix_for(layer):
    """A Shapefile stays one: the program knows the names of fields that it cuts, as diameter_m of diameter_min."""
    shapefile = isinstance(layer, QgsVectorLayer) and layer.dataProvider().storageType() == "ESRI Shapefile"
    return ".shp" if shapefile else ".gpkg"


def write_vector(source, path, context, feedback):
    """Writes the features of a source, with their CRS, into a GeoPackage or Shapefile; equal features give equal bytes."""
    if not source.sourceCrs().isValid():
        raise QgsProcessingException(tr("{name} has no coordinate system: set it in QGIS (layer > Set CRS)").format(
            name=source.sourceName()))
    folder = os.path.dirname(path)
    os.makedirs(folder, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder) as fresh:
        dated = gdal.GetConfigOption("OGR_CURRENT_DATE")
        gdal.SetConfigOption("OGR_CURRENT_DATE", "2000-01-01T00:00:00.000Z")  # else the time of writing stands in the file
        try:
            count = _write_features(source, os.path.join(fresh, os.path.basename(path)), context, feedback)
        finally:
            gdal.SetConfigOption("OGR_CURRENT_DATE", dated)
        if count == 0:
            raise QgsProcessingException(tr("{name} has no feature: is nothing selected, or does a filter hide all?").format(
                name=source.sourceName()))
        for name in os.listdir(fresh):
            os.replace(os.path.join(fresh, name), os.path.join(folder, name))
    feedback.pushInfo(tr("{name}: {count} features are written to {path}").format(name=source.sourceName(), count=count,
                                                                                 path=path))
    return path


def _write_features(source, path, context, feedback):
    options = QgsVectorFileWriter.SaveVectorOptions()
    shapefile = path.endswith(".shp")
    options.driverName = "ESRI Shapefile" if shapefile else "GPKG"
    options.fileEncoding = "UTF-8"
    options.layerName = os.path.splitext(os.path.basename(path))[0]
    # a field fid of the layer stays a field
    options.layerOptions = ["DBF_DATE_LAST_UPDATE=2000-01-01"] if shapefile else ["FID=talus_fid"]
    writer = QgsVectorFileWriter.create(path, source.fields(), source.wkbType(), source.sourceCrs(),
                                        context.transformContext(), options)
    if writer.hasError() != QgsVectorFileWriter.NoError:
        raise QgsProcessingException(f"{path}: {writer.errorMessage()}")
    count = 0
    for feature in source.getFeatures():
        if feedback.isCanceled():
            break
        copy = QgsFeature(source.fields())
        copy.setAttributes(feature.attributes())
        copy.setGeometry(feature.geometry())
        if not writer.addFeature(copy, QgsFeatureSink.FastInsert):
            raise QgsProcessingException(f"{path}: {writer.errorMessage()}")
        count += 1
    del writer  # closes the file
    return count


def raster_file(layer, band, folder, feedback):
    """The file of a raster layer; a GeoTIFF in `folder` where a band other than the first or another CRS is meant."""
    if not isinstance(layer, QgsRasterLayer) or layer.providerType() != "gdal":
        raise QgsProcessingException(tr("{name} is no raster in a file: save it as GeoTIFF first").format(
            name=layer.name() if layer is not None else "?"))
    path = layer.source()
    own = QgsRasterLayer(path, "", "gdal")
    same_crs = own.crs() == layer.crs()
    if os.path.isfile(path) and band in (None, 1) and same_crs:
        return path
    os.makedirs(folder, exist_ok=True)
    name = re.sub(r"[^\w-]+", "_", layer.name()) or "raster"
    target = os.path.join(folder, f"{name}_band{band or 1}.tif")
    fresh = target[:-len(".tif")] + ".new.tif"
    options = {"bandList": [band or 1], "format": "GTiff", "creationOptions": ["COMPRESS=DEFLATE"]}
    if not same_crs:
        options["outputSRS"] = layer.crs().toWkt()
    if gdal.Translate(fresh, path, **options) is None:
        raise QgsProcessingException(f"{path}: {gdal.GetLastErrorMsg()}")
    if os.path.exists(target) and filecmp.cmp(target, fresh, shallow=False):
        os.remove(fresh)
    else:
        os.replace(fresh, target)
    feedback.pushInfo(tr("{name}: band {band} is written to {path}").format(name=layer.name(), band=band or 1, path=target))
    return target


