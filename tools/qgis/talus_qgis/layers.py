"""Layers of QGIS as files that the program reads.

A layer that is a plain file goes to the program as it is, so that the record of the run names the user's own file. What
QGIS alone knows (selected features, filters, joined and virtual fields, layers in memory or in a database, another CRS,
one band of several, cells without data) is written into the folder OUT_inputs beside the results: a run can be resumed,
and `hazard` reads the inputs once more. There each input lies in a folder named after its parameter and its content, so
that what an earlier run has read stays as it was.
"""
import filecmp
import hashlib
import math
import os
import shutil
import tempfile
from contextlib import contextmanager
from itertools import filterfalse

from osgeo import gdal
from qgis.core import (QgsCoordinateTransform, QgsCsException, QgsFeature, QgsFeatureRequest, QgsFeatureSink, QgsField,
                       QgsFieldConstraints, QgsFields, QgsProcessingException, QgsProcessingFeatureSourceDefinition, QgsProviderRegistry,
                       QgsRasterLayer, QgsRasterRange, QgsVectorFileWriter, QgsVectorLayer, QgsWkbTypes)
from qgis.PyQt.QtCore import Qt, QVariant

from .texts import tr

NO_SYSTEM = "{name} has no coordinate system: set it in QGIS (layer > Set CRS)"
ROWS_AT_A_TIME = 256
READ_AS_THEY_ARE = (".gpkg", ".shp", ".geojson", ".json", ".fgb")


def folder_beside(results):
    return os.path.normpath(results) + "_inputs"


def names_in(inputs):
    """What lies in a folder of inputs."""
    return set(os.listdir(inputs)) if os.path.isdir(inputs) else set()


def remove(inputs, names):
    """Removes some folders of a folder of inputs; it, too, if it is empty then."""
    for name in names:
        shutil.rmtree(os.path.join(inputs, name), ignore_errors=True)
    if os.path.isdir(inputs) and not os.listdir(inputs):
        os.rmdir(inputs)


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
    if any(value for part, value in parts.items() if part not in ("path", "layerName")):
        return None  # one kind of geometry, a layer by its number, options of the driver
    if not os.path.isfile(path) or not path.lower().endswith(READ_AS_THEY_ARE) or "|" in path:
        return None
    file_layer = QgsVectorLayer(path + (f"|layername={name}" if name else ""), "", "ogr")
    if not file_layer.isValid() or file_layer.crs() != layer.crs() or _names(file_layer) != _names(layer):
        return None
    if file_layer.dataProvider().encoding() != layer.dataProvider().encoding():
        return None  # chosen in QGIS for a Shapefile: the file itself says another one, or none
    return path + (f"|layername={name}" if name else "") if _count(path, name) == layer.featureCount() else None


def refuse_unnamed(layer):
    """A file of several layers without the name of one: QGIS would take the first, the road instead of the houses."""
    parts = QgsProviderRegistry.instance().decodeUri("ogr", layer.source())
    if layer.providerType() != "ogr" or parts.get("layerName") or parts.get("layerId") not in (None, -1):
        return
    # QGIS lists a layer once for each kind of geometry in it
    names = list(dict.fromkeys(sub.split("!!::!!")[1] for sub in layer.dataProvider().subLayers()))
    if len(names) > 1:
        raise QgsProcessingException(tr("{path} has several layers ({names}): name one, as {path}|layername={first}").format(
            path=parts.get("path"), names=", ".join(names), first=names[0]))


def _names(layer):
    """The names of the fields; those that are joined and virtual come last."""
    return layer.fields().names()


def _count(path, name):
    """The number of features in a layer of a file, as the program reads it."""
    file = gdal.OpenEx(path, gdal.OF_VECTOR | gdal.OF_READONLY)
    layer = file.GetLayerByName(name) if name else file.GetLayer(0)
    return layer.GetFeatureCount() if layer is not None else None


def _restricted(definition):
    """Whether only selected features, a number of them or those of a filter are meant."""
    return (definition.selectedFeaturesOnly or definition.featureLimit >= 0 or bool(getattr(definition, "filterExpression", "")))


@contextmanager
def _kept(inputs, name):
    """A temporary folder to write an input into, and a list for the place at which it is kept: a folder of `inputs` named
    after the parameter and the content. Nothing is left of an input that was not written to its end."""
    try:
        os.makedirs(inputs, exist_ok=True)
    except OSError as error:
        raise QgsProcessingException(tr("{folder}: no folder can be made there ({error}): name another folder for the "
                                        "results").format(folder=inputs, error=error.strerror)) from error
    try:
        with tempfile.TemporaryDirectory(dir=inputs) as fresh:
            place = []
            yield fresh, place
            files = sorted(os.listdir(fresh))
            place.append(os.path.join(inputs, f"{name}_{_checksum(fresh, files)}"))
            os.makedirs(place[0], exist_ok=True)
            for file in files:
                target = os.path.join(place[0], file)
                if not (os.path.exists(target) and filecmp.cmp(os.path.join(fresh, file), target, shallow=False)):
                    os.replace(os.path.join(fresh, file), target)
    except BaseException:
        if not os.listdir(inputs):
            os.rmdir(inputs)
        raise


def _checksum(folder, files):
    """The first 12 digits of the SHA-256 of some files."""
    whole = hashlib.sha256()
    for file in files:
        whole.update(file.encode() + b"\0")
        with open(os.path.join(folder, file), "rb") as content:
            for block in iter(lambda: content.read(1 << 20), b""):
                whole.update(block)
    return whole.hexdigest()[:12]


def _stop_if_cancelled(feedback):
    if feedback.isCanceled():
        raise QgsProcessingException(tr("Cancelled before the program was started."))


def refuse_without_system(source):
    """Raises for a layer without a coordinate system; QGIS takes the "undefined" one of a GeoPackage for a valid one."""
    system = source.sourceCrs()
    if not system.isValid() or system.toWkt().startswith(("LOCAL_CS", "ENGCRS")):
        raise QgsProcessingException(tr(NO_SYSTEM).format(name=source.sourceName()))


def write_vector(source, inputs, file, context, feedback, own_fields=False):
    """Writes the features of a source, with their CRS, into a GeoPackage; equal features give equal bytes.

    own_fields: without the numbers (FID) of features that QGIS shows as a field fid, though it is none of the file."""
    refuse_without_system(source)
    with _kept(inputs, os.path.splitext(file)[0]) as (fresh, place):
        dated = gdal.GetThreadLocalConfigOption("OGR_CURRENT_DATE")  # of this thread alone: QGIS goes on writing in others
        gdal.SetThreadLocalConfigOption("OGR_CURRENT_DATE", "2000-01-01T00:00:00.000Z")  # not the time of writing
        try:
            count = _write_features(source, os.path.join(fresh, file), context, feedback, own_fields)
        finally:
            gdal.SetThreadLocalConfigOption("OGR_CURRENT_DATE", dated)
        if count == 0:
            raise _no_feature(source)
    path = os.path.join(place[0], file)
    feedback.pushInfo(tr("{name}: {count} features are written to {path}").format(name=source.sourceName(), count=count,
                                                                                 path=path))
    return path


def _no_feature(source):
    return QgsProcessingException(tr("{name} has no feature: is nothing selected, or does a filter hide all?").format(
        name=source.sourceName()))


class Joined:
    """Several layers as one, in the CRS of the first: its fields are those of all, which differ in more than the case of
    their names. A layer with `id` and without `name` is named by its `id`, as the program does it for a layer alone."""

    def __init__(self, sources, context, feedback):
        self.sources = sources
        for source in sources:
            refuse_without_system(source)
        self.transforms = [QgsCoordinateTransform(source.sourceCrs(), self.sourceCrs(), context.transformContext())
                           for source in sources]
        for source, transform in zip(sources, self.transforms):
            if not transform.isShortCircuited():
                self._tell(source, transform, feedback)

    def _tell(self, source, transform, feedback):
        """With which accuracy a layer comes into the CRS of the first."""
        names = {"name": source.sourceName(), "from": source.sourceCrs().authid(), "to": self.sourceCrs().authid()}
        accuracy = transform.instantiatedCoordinateOperationDetails().accuracy
        if accuracy < 0.0:
            feedback.pushWarning(tr("{name}: QGIS brings it from {from} to {to}, with an unknown accuracy").format(**names))
        else:
            feedback.pushInfo(tr("{name}: QGIS brings it from {from} to {to}, accurate to {metres} m").format(
                metres=f"{accuracy:g}", **names))

    def sourceName(self):
        return " + ".join(source.sourceName() for source in self.sources)

    def sourceCrs(self):
        return self.sources[0].sourceCrs()

    def wkbType(self):
        kinds = {source.wkbType() for source in self.sources}
        return kinds.pop() if len(kinds) == 1 else QgsWkbTypes.Unknown

    def fields(self):
        found = {}
        for source in self.sources:
            for field in filterfalse(_is_number_of_feature, distinct(source.fields())):
                first = found.get(field.name().lower())
                found[field.name().lower()] = (first[0], _common_type(first[1], field)) if first else (field.name(),
                                                                                                     field.type())
        fields = QgsFields()
        for name, kind in found.values():
            fields.append(QgsField(name, kind))
        return fields

    def getFeatures(self):
        fields = self.fields()
        for source, transform in zip(self.sources, self.transforms):
            columns = _columns(fields, distinct(source.fields()))
            any_feature = False
            for feature in source.getFeatures():
                any_feature = True
                copy, values, geometry = QgsFeature(fields), feature.attributes(), feature.geometry()
                try:
                    geometry.transform(transform)
                except QgsCsException as fault:
                    raise QgsProcessingException(f"{source.sourceName()}: {fault}") from fault
                copy.setGeometry(geometry)
                copy.setAttributes([None if column < 0 else _as_type(values[column], field.type())
                                    for field, column in zip(fields, columns)])
                yield copy
            if not any_feature:
                raise _no_feature(source)


def _is_number_of_feature(field):
    """Whether a field is none of the file, but the number that it has for each feature."""
    constraints = field.constraints()
    return (field.name().lower() == "fid" and
            constraints.constraintOrigin(QgsFieldConstraints.ConstraintUnique) == QgsFieldConstraints.ConstraintOriginProvider)


def _common_type(kind, field):
    numbers = (QVariant.Int, QVariant.LongLong, QVariant.Double)
    if kind == field.type():
        return kind
    return QVariant.Double if kind in numbers and field.type() in numbers else QVariant.String


def _columns(fields, own):
    """The column of a layer for each field of all; -1 where it has none."""
    by_name = {field.name().lower(): i for i, field in enumerate(own)}
    columns = [by_name.get(field.name().lower(), -1) for field in fields]
    name = fields.lookupField("name")
    if name >= 0 and columns[name] < 0:
        columns[name] = by_name.get("id", -1)
    return columns


def _as_type(value, kind):
    if value is None or (isinstance(value, QVariant) and value.isNull()):
        return None
    if kind == QVariant.Double:
        return float(value)
    if kind != QVariant.String or isinstance(value, str):
        return value
    if isinstance(value, float):
        return f"{value:.15g}"
    return value.toString(Qt.ISODate) if hasattr(value, "toString") else str(value)


def distinct(fields):
    """The fields under the names that they have in a copy. In a GeoPackage names must differ in more than their case: of such
    names the first, or the one in small letters, which the program prefers, stays; others get _2, _3."""
    order = sorted(range(fields.count()), key=lambda i: fields[i].name() != fields[i].name().lower())
    taken, names = {name.lower() for name in fields.names()}, {}
    for i in order:
        name, number = fields[i].name(), 2
        if name.lower() in (other.lower() for other in names.values()):
            while f"{name}_{number}".lower() in taken:
                number += 1
            name = f"{name}_{number}"
        taken.add(name.lower())
        names[i] = name
    found = QgsFields()
    for i, field in enumerate(fields):
        copy = QgsField(field)
        copy.setName(names[i])
        found.append(copy)
    return found


def name_in_copy(source, name):
    """The name of a field of a source in its copy."""
    column = source.fields().indexFromName(name)  # spelt so
    return distinct(source.fields())[column].name() if column >= 0 else name


def _tell_renamed(source, feedback):
    for before, after in zip(source.fields(), distinct(source.fields())):
        if before.name() != after.name():
            feedback.pushWarning(tr("{name}: the field {before} is handed over as {after}, as another differs from it in case "
                                    "only").format(name=source.sourceName(), before=before.name(), after=after.name()))


def _write_features(source, path, context, feedback, own_fields):
    """Writes the features under the numbers (FID) that QGIS shows: where a layer has no ids and no names, the program calls
    features by them."""
    numbered = _are_numbered(source, feedback)
    for one in source.sources if isinstance(source, Joined) else [source]:
        _tell_renamed(one, feedback)
    whole = distinct(source.fields())
    columns = [i for i, field in enumerate(whole) if not (own_fields and _is_number_of_feature(field))]
    fields = QgsFields()
    for i in columns:
        fields.append(whole[i])
    column = _free_name("talus_fid", fields)  # a field fid of the layer stays a field, and so does a field geom
    geometry = _free_name("geom", fields)
    if numbered:
        fields.append(QgsField(column, QVariant.LongLong))
    options = QgsVectorFileWriter.SaveVectorOptions()
    options.driverName = "GPKG"
    options.fileEncoding = "UTF-8"
    options.layerName = os.path.splitext(os.path.basename(path))[0]
    options.layerOptions = ["FID=" + column, "GEOMETRY_NAME=" + geometry]
    writer = QgsVectorFileWriter.create(path, fields, source.wkbType(), source.sourceCrs(), context.transformContext(), options)
    if writer.hasError() != QgsVectorFileWriter.NoError:
        raise QgsProcessingException(f"{path}: {writer.errorMessage()}")
    count = 0
    try:
        for feature in source.getFeatures():
            _stop_if_cancelled(feedback)
            copy = QgsFeature(fields)
            values = feature.attributes()
            copy.setAttributes([values[i] for i in columns] + ([feature.id()] if numbered else []))
            copy.setGeometry(feature.geometry())
            if not writer.addFeature(copy, QgsFeatureSink.FastInsert):
                raise QgsProcessingException(f"{path}: {writer.errorMessage()}")
            count += 1
    finally:
        del writer  # closes the file
    return count


def _are_numbered(source, feedback):
    """Whether each feature has a number of its own. Those of several layers together and those that are not saved yet have
    none: GDAL numbers them from 1."""
    if isinstance(source, Joined):
        return False
    request = QgsFeatureRequest().setFlags(QgsFeatureRequest.NoGeometry).setNoAttributes()
    numbers = [feature.id() for feature in source.getFeatures(request)]
    numbered = all(number >= 0 for number in numbers) and len(set(numbers)) == len(numbers)
    if not numbered:
        feedback.pushWarning(tr("{name}: some features have no number yet, so that all are numbered anew from 1. With saved "
                                "edits the results keep the numbers of QGIS.").format(name=source.sourceName()))
    return numbered


def _free_name(wanted, fields):
    """A name that no field has, in any case of letters."""
    name = wanted
    while fields.lookupField(name) >= 0:
        name += "_"
    return name


def raster_copy(layer):
    """A raster layer for another thread; clone() forgets what is nodata in QGIS."""
    copy = layer.clone()
    if layer.providerType() == "gdal":
        own, other = layer.dataProvider(), copy.dataProvider()
        for band in range(1, layer.bandCount() + 1):
            other.setUserNoDataValue(band, own.userNoDataValues(band))
            if own.sourceHasNoDataValue(band):
                other.setUseSourceNoDataValue(band, own.useSourceNoDataValue(band))
    return copy


def _nodata_of_qgis(layer, band):
    """(whether the file's own value is nodata, further ranges of values that are) where QGIS is set to take other cells for
    nodata than the file; else None."""
    provider = layer.dataProvider()
    ranges = provider.userNoDataValues(band)
    of_file = provider.useSourceNoDataValue(band) or not provider.sourceHasNoDataValue(band)
    return None if of_file and not ranges else (of_file, ranges)


def raster_file(layer, band, inputs, name, feedback):
    """The file of a raster layer; a GeoTIFF in `inputs` where a band other than the first, another CRS or other cells
    without data are meant."""
    if not isinstance(layer, QgsRasterLayer) or layer.providerType() != "gdal":
        raise QgsProcessingException(tr("{name} is no raster in a file: save it as GeoTIFF first").format(
            name=layer.name() if layer is not None else "?"))
    path = layer.source()
    own = QgsRasterLayer(path, "", "gdal")
    same_crs = own.crs() == layer.crs()
    nodata = _nodata_of_qgis(layer, band or 1)
    if os.path.isfile(path) and band in (None, 1) and same_crs and nodata is None:
        return path
    options = {"bandList": [band or 1], "rat": False}
    if not same_crs:
        options["outputSRS"] = layer.crs().toWkt()
    with _kept(inputs, name) as (fresh, place):
        _translate(os.path.join(fresh, name + ".tif"), path, options, nodata, feedback)
    target = os.path.join(place[0], name + ".tif")
    feedback.pushInfo(tr("{name}: band {band} is written to {path}").format(name=layer.name(), band=band or 1, path=target))
    return target


def _translate(target, path, options, nodata, feedback):
    """Writes a part of a raster as GeoTIFF, without the statistics that QGIS keeps beside a raster that it has shown: equal
    cells give equal bytes."""
    going_on = {"callback": lambda *_: 0 if feedback.isCanceled() else 1}
    try:
        part = gdal.Translate("", path, format="VRT", **options)
        if part is not None:
            part.GetRasterBand(1).SetMetadata({})
            if nodata is not None:
                part = _with_nodata(target + ".part", part, *nodata, going_on)
            part = gdal.Translate(target, part, format="GTiff", creationOptions=["COMPRESS=DEFLATE"], **going_on)
        fault = "" if part is not None else gdal.GetLastErrorMsg()
    except RuntimeError as raised:  # where another plug-in has switched exceptions of GDAL on
        part, fault = None, str(raised)
    finally:
        if os.path.exists(target + ".part"):
            os.remove(target + ".part")
    _stop_if_cancelled(feedback)
    if part is None:
        raise QgsProcessingException(f"{path}: {fault}")


def _with_nodata(target, raster, of_file, ranges, going_on):
    """A copy whose cells without data are NaN: those of the file's own value, where it counts, and those in ranges of what
    QGIS shows (after scale and offset). In double precision, as not every whole number is one in single precision."""
    own = raster.GetRasterBand(1).GetNoDataValue() if of_file else None
    part = gdal.Translate(target, raster, format="GTiff", outputType=gdal.GDT_Float64, noData="none", **going_on)
    if part is None:
        raise RuntimeError(gdal.GetLastErrorMsg())
    band = part.GetRasterBand(1)
    scale, offset = band.GetScale() or 1.0, band.GetOffset() or 0.0
    for row in range(0, band.YSize, ROWS_AT_A_TIME):
        values = band.ReadAsArray(0, row, band.XSize, min(ROWS_AT_A_TIME, band.YSize - row))
        shown = values * scale + offset
        for cells in [values == own] + [_within(shown, one) for one in ranges]:
            values[cells] = float("nan")
        band.WriteArray(values, 0, row)
    band.SetNoDataValue(float("nan"))
    part.FlushCache()
    return part


def _within(values, one):
    """Which values lie in a range of QGIS; an end that is NaN is none."""
    kinds = QgsRasterRange
    above = values >= one.min() if one.bounds() in (kinds.IncludeMinAndMax, kinds.IncludeMin) else values > one.min()
    below = values <= one.max() if one.bounds() in (kinds.IncludeMinAndMax, kinds.IncludeMax) else values < one.max()
    return (above | math.isnan(one.min())) & (below | math.isnan(one.max()))
