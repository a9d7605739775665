"""Files that the studies write and read: terrain, layers, tables, texts."""
import csv
import json

import numpy as np
from osgeo import gdal, ogr, osr

gdal.UseExceptions()
ogr.UseExceptions()


def system(code=2056):
    """The coordinate system of an EPSG code, east before north."""
    srs = osr.SpatialReference()
    srs.ImportFromEPSG(code)
    srs.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    return srs


def write_raster(path, values, corner, cell, srs=None, kind=gdal.GDT_Float32, nodata=None, options=()):
    """A GeoTIFF of values, rows from the north; corner: the west and the north edge [m]. Without srs in EPSG:2056."""
    rows, columns = values.shape
    raster = gdal.GetDriverByName("GTiff").Create(str(path), columns, rows, 1, kind, list(options))
    raster.SetGeoTransform((corner[0], cell, 0, corner[1], 0, -cell))
    raster.SetProjection((srs or system()).ExportToWkt())
    if nodata is not None:
        raster.GetRasterBand(1).SetNoDataValue(nodata)
    raster.GetRasterBand(1).WriteArray(values)


def write_layer(path, shapes, fields=(), srs=None):
    """A GeoPackage, in place of one that is there. shapes: WKT and the values of the fields, fields: (name, float or str).
    The first shape says what all are. Without srs in EPSG:2056."""
    path = str(path)
    driver = ogr.GetDriverByName("GPKG")
    if gdal.VSIStatL(path):
        driver.DeleteDataSource(path)
    file = driver.CreateDataSource(path)
    layer = file.CreateLayer(path.rsplit("/", 1)[-1].removesuffix(".gpkg"), srs or system(),
                             ogr.CreateGeometryFromWkt(shapes[0][0]).GetGeometryType())
    for name, kind in fields:
        layer.CreateField(ogr.FieldDefn(name, ogr.OFTReal if kind is float else ogr.OFTString))
    layer.StartTransaction()
    for wkt, *values in shapes:
        feature = ogr.Feature(layer.GetLayerDefn())
        feature.SetGeometry(ogr.CreateGeometryFromWkt(wkt))
        for i, value in enumerate(values):
            feature[i] = value
        layer.CreateFeature(feature)
    layer.CommitTransaction()


def box(west, south, east, north):
    """A rectangle as WKT."""
    return f"POLYGON (({west} {south},{east} {south},{east} {north},{west} {north},{west} {south}))"


def write_text(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def write_table(path, head, rows):
    """A CSV file; head: the names of the columns, with commas between."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([head.split(","), *rows])


def read_table(path):
    """The rows of a CSV file, by the names of the columns; all values are texts."""
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def read_json(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def read_bands(path):
    """The bands of a raster as floats, NaN where there is no data."""
    raster, found = gdal.Open(str(path)), []
    for i in range(1, raster.RasterCount + 1):
        band = raster.GetRasterBand(i)
        values = band.ReadAsArray().astype(float)
        if band.GetNoDataValue() is not None:
            values[values == band.GetNoDataValue()] = np.nan
        found.append(values)
    return found


def features(path):
    """The features of the first layer of a file, each to be used before the next."""
    file = ogr.Open(str(path))  # must outlive its layer
    yield from file.GetLayer(0)
