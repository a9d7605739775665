#!/usr/bin/python3
"""Draws a raster of results over the hillshade of its DEM, for reports and the manual. Seconds; manual.sh draws those of docs.

  tools/scripts/figures/picture.py DEM [RASTER] -o out.png [--band 1] [--log] [--classes 0.001,0.01,0.1]
             [--title TEXT] [--unit TEXT] [--vectors paths.gpkg sources.shp ...]
             [--names none,low,high]
             [--crop XMIN YMIN XMAX YMAX] [--colours NAME] [--width INCHES] [--dpi 110]

Nodata and zero are transparent.  --classes gives the lower bounds of the classes; a value below the
first one is transparent.  For an impact probability choose bounds that rise by factors.  --log is the
continuous scale for such values, without classes.  --names gives the names of the whole numbers from 0
in the colours of a hazard map; 0 is transparent.  Vectors in any CRS are brought to that of the DEM;
polygons are outlined, many lines are drawn finer than few.  Without RASTER only the hillshade is drawn.
--crop is in the CRS of the DEM.
Needs numpy, matplotlib and GDAL's python binding (Debian: python3-numpy
python3-matplotlib python3-gdal); with Pillow, which matplotlib needs, the PNG is quantised.
"""
import argparse
import io
import os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import BoundaryNorm, ListedColormap, LogNorm, Normalize
from osgeo import gdal, ogr, osr
from PIL import Image

gdal.UseExceptions()
HAZARD = ["#fff9c4", "#ffd600", "#2979ff", "#d50000"]  # those of hazard_class.qml
INKS = ["#20262c", "#0b62c4", "#b0127b", "#1f7a33", "#8a4b08"]


def read(path, band=1):
    """Values as float64 with NaN for nodata, the extent (xmin, xmax, ymin, ymax), the data set."""
    ds = gdal.Open(path)
    b = ds.GetRasterBand(band)
    z = b.ReadAsArray().astype(np.float64)
    if b.GetNoDataValue() is not None:
        z[z == b.GetNoDataValue()] = np.nan
    x0, dx, rx, y0, ry, dy = ds.GetGeoTransform()
    if rx or ry or dy > 0:
        raise SystemExit(f"{path}: not north-up; warp it first (gdalwarp)")
    return z, (x0, x0 + dx * ds.RasterXSize, y0 + dy * ds.RasterYSize, y0), ds


def hillshade(z, cell):
    """Grey between 0 and 1: light from the north-west and from all around, steep is darker; stretched."""
    north, east = np.gradient(z, -cell[1], cell[0])
    slope, aspect = np.arctan(np.hypot(east, north)), np.arctan2(-north, -east)

    def light(azimuth, altitude):
        a = np.radians(altitude)
        turn = np.cos(aspect - np.radians(90.0 - azimuth))
        return np.clip(np.sin(a) * np.cos(slope) + np.cos(a) * np.sin(slope) * turn, 0, 1)

    around = sum(light(a, 40) for a in (225, 270, 315, 360)) / 4
    shade = 0.35 * light(315, 40) + 0.25 * around + 0.40 * np.cos(slope) ** 1.5
    low, high = np.nanpercentile(shade, (0.5, 99.5))
    return 0.22 + 0.76 * np.clip((shade - low) / max(high - low, 1e-9), 0, 1)


def lines_of(geometry):
    if geometry.GetGeometryCount():
        for i in range(geometry.GetGeometryCount()):
            yield from lines_of(geometry.GetGeometryRef(i))
    elif geometry.GetPointCount():
        yield np.array(geometry.GetPoints())[:, :2]


def draw_vectors(ax, path, srs, ink):
    """Every layer of a file: outlines, lines or points, in the CRS of the DEM. Returns a legend entry."""
    ds, parts, points = ogr.Open(path), [], []
    for layer in ds:
        here, turn = layer.GetSpatialRef(), None
        if here is not None and srs is not None and not here.IsSame(srs):
            here = here.Clone()
            here.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
            turn = osr.CoordinateTransformation(here, srs)
        for feature in layer:
            g = feature.GetGeometryRef()
            if g is None:
                continue
            if turn:
                g.Transform(turn)
            for part in lines_of(g):
                (points if len(part) == 1 else parts).append(part)
    name, many = os.path.splitext(os.path.basename(path))[0], len(parts) > 100
    if parts:
        ax.add_collection(LineCollection(parts, colors=ink, linewidths=0.35 if many else 1.1,
                                         alpha=0.45 if many else 0.95, zorder=4, label=name))
    if points:
        xy = np.vstack(points)
        ax.plot(xy[:, 0], xy[:, 1], ".", ms=2.5, color=ink, alpha=0.7, zorder=4, label=name)


def norm_of(v, classes, log):
    """How values become colours, and the ticks of the colour bar."""
    good = v[np.isfinite(v)]
    top = float(good.max()) if good.size else 1.0
    if classes:
        bounds = classes + [top if top > classes[-1] else 2 * classes[-1] if classes[-1] > 0 else 1.0]
        return BoundaryNorm(bounds, 256), classes if bounds[-1] > 100 * classes[-1] > 0 else bounds
    low = float(good.min()) if good.size else 0.0
    if log:
        return LogNorm(max(low, top * 1e-5), top if top > low else low * 10), None
    return Normalize(min(low, 0.0), top if top > low else low + 1), None


def in_words(value):
    """Three digits, thousands apart."""
    return f"{value:.3g}" if abs(value) < 1000 else f"{value:,.0f}".replace(",", "\N{NO-BREAK SPACE}")


def nice(length):
    """The largest of 1, 2, 5 x 10^n not above the length."""
    unit = 10.0 ** np.floor(np.log10(length))
    return max(k * unit for k in (1, 2, 5) if k * unit <= length)


def scale_bar(ax, extent):
    width, height = extent[1] - extent[0], extent[3] - extent[2]
    bar = nice(width / 4)
    x, y, h = extent[0] + 0.03 * width, extent[2] + 0.03 * height, 0.009 * height
    ax.add_patch(plt.Rectangle((x - 0.012 * width, y - 0.012 * height), bar + 0.024 * width,
                               h + 0.062 * height, fc="white", ec="none", alpha=0.75, zorder=5))
    for i in range(2):
        ax.add_patch(plt.Rectangle((x + i * bar / 2, y), bar / 2, h, zorder=6, lw=0.6, ec="#222222",
                                   fc=("#222222", "white")[i]))
    text = f"{bar:g} m" if bar < 1000 else f"{bar / 1000:g} km"
    ax.text(x + bar / 2, y + 1.8 * h, text, ha="center", va="bottom", fontsize=8, zorder=6)


def save(fig, path, dpi):
    """A PNG of 256 colours at most: a third of the size, and no difference to see."""
    raw = io.BytesIO()
    fig.savefig(raw, dpi=dpi, facecolor="white", bbox_inches="tight", pad_inches=0.08)
    image = Image.open(raw).convert("RGB")
    image.quantize(256, Image.Quantize.MAXCOVERAGE, kmeans=1, dither=Image.Dither.NONE).save(path, optimize=True)


def main():
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ap.add_argument("dem")
    ap.add_argument("raster", nargs="?")
    ap.add_argument("-o", "--out", required=True)
    ap.add_argument("--band", type=int, default=1)
    ap.add_argument("--log", action="store_true")
    ap.add_argument("--classes", type=lambda s: [float(x) for x in s.split(",")])
    ap.add_argument("--names", type=lambda s: s.split(","))
    ap.add_argument("--title", default="")
    ap.add_argument("--unit", default="")
    ap.add_argument("--vectors", nargs="+", default=[])
    ap.add_argument("--crop", nargs=4, type=float, metavar=("XMIN", "YMIN", "XMAX", "YMAX"))
    ap.add_argument("--colours", default="YlOrRd")
    ap.add_argument("--width", type=float, default=8.0)
    ap.add_argument("--dpi", type=int, default=110)
    o = ap.parse_args()
    if o.raster is None and (o.classes or o.log):
        ap.error("--classes and --log need a RASTER")
    if o.classes and o.classes != sorted(set(o.classes)):
        ap.error("--classes must rise")
    z, extent, ds = read(o.dem)
    view = (o.crop[0], o.crop[2], o.crop[1], o.crop[3]) if o.crop else extent
    shape = (view[3] - view[2]) / (view[1] - view[0])
    fig, ax = plt.subplots(figsize=(o.width, (o.width - (0.9 if o.raster else 0)) * shape))
    cell = ((extent[1] - extent[0]) / z.shape[1], (extent[3] - extent[2]) / z.shape[0])
    grey = plt.get_cmap("gray").copy()
    grey.set_bad(alpha=0)
    ax.imshow(hillshade(z, cell), cmap=grey, vmin=0, vmax=1, extent=extent, interpolation="bilinear", zorder=1)
    if o.raster:
        v, where, _ = read(o.raster, o.band)
        v[~(v != 0) | (v < o.classes[0] if o.classes else v < 0 if o.log else False)] = np.nan
        norm, ticks = norm_of(v, o.classes, o.log)
        if o.names:
            norm, ticks = BoundaryNorm(np.arange(len(o.names)) + 0.5, len(o.names) - 1), range(1, len(o.names))
            o.colours = ListedColormap((HAZARD * 3)[-(len(o.names) - 1):])
        image = ax.imshow(v, cmap=o.colours, norm=norm, extent=where, interpolation="nearest", alpha=0.72, zorder=2)
        bar = fig.colorbar(image, ax=ax, fraction=0.035, pad=0.02, ticks=ticks, extendfrac=0)
        if ticks:
            bar.ax.set_yticklabels(o.names[1:] if o.names else [in_words(t) for t in ticks])
        bar.set_label(o.unit, fontsize=9)
        bar.ax.tick_params(labelsize=8)
    for path, ink in zip(o.vectors, INKS * len(o.vectors)):
        draw_vectors(ax, path, ds.GetSpatialRef(), ink)
    if o.vectors:
        legend = ax.legend(loc="upper left", fontsize=8, framealpha=0.85, borderpad=0.5)
        legend.set_zorder(7)
        for line in legend.get_lines():
            line.set(alpha=1.0, linewidth=1.1)  # also of many lines, which are drawn fine
    ax.set(xlim=view[:2], ylim=view[2:], xticks=[], yticks=[])
    ax.set_aspect("equal")
    ax.set_title(o.title, fontsize=11, loc="left")
    scale_bar(ax, view)
    save(fig, o.out, o.dpi)


try:
    main()
except RuntimeError as fault:  # the message of GDAL says what is wrong and where
    raise SystemExit(f"picture.py: {fault}")
