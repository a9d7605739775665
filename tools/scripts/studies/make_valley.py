#!/usr/bin/python3
"""Writes the example valley, data/valley: one side of an alpine valley that does not exist. Seconds; data/valley/README.md.

  tools/scripts/studies/make_valley.py [OUTDIR] [--seed 11]

From west to east: summit slope, two cliff bands cut by couloirs, talus at 33-37 degrees with fans,
a forest road, meadow that flattens out, houses, stream, counter-slope.  The rock is a profile whose
distance is warped by fractal noise (spectral synthesis), the talus the upper envelope of cones of
debris whose tips stand along the foot of the cliffs.  Made on a 2 m grid, written as means of 4 m
cells; the same seed gives the same bytes.  In the code s is the distance down the fall line, t along
the slope.  README.md beside the files says what they are; cliffs.shp is in EPSG:4326 on purpose, its
fields diameter_min and diameter_max cut to ten characters as OGR does it: diameter_m, diameter_1.
Needs numpy and GDAL's python binding (Debian: python3-numpy python3-gdal).
"""
import argparse
import json
from pathlib import Path

import numpy as np
from osgeo import gdal, gdal_array, ogr

gdal.UseExceptions()
gdal.SetConfigOption("OGR_CURRENT_DATE", "2025-01-01T00:00:00Z")  # or no two GeoPackages are the same
gdal.SetConfigOption("OGR_SQLITE_PRAGMA", "page_size=1024")       # or an almost empty one takes 100 kB
CELL, COLS, ROWS, FINE, FINER = 4, 300, 260, 2, 2  # m, cells, m of the fine grid, and how many to a cell
X0, Y1 = 2650000.0, 1171040.0  # outer upper left corner
FALL, NORTH = np.radians(103.0), 45  # azimuth of the fall line; m the whole valley is moved northwards
FOOT = 312.0              # height of the foot of the lower cliff above the stream
ROAD, GRADE = 26.0, 0.01  # height of the road above the stream at t = 0, and how it climbs with t
LEDGE = (268.0, -30.0)    # s, t of a grassy ledge in a wall
# couloirs: t, half width, depth (m), phase of their bends
COULOIRS = ((-225, 12, 7, 0.2), (-85, 26, 15, 1.0), (70, 14, 8, 2.7), (205, 23, 13, 4.0), (345, 14, 8, 5.3))
# cliff bands: s, height (m), phase, tangent added to that of the slope, waviness (m)
BANDS = ((190, 20, 0.9, 1.15, 13), (270, 42, 2.2, 1.25, 4))
WALLS = (("Adlerwand", 0.8, 1.4), ("Rote Platte", 0.8, 1.4), ("Geissfluh", 0.8, 1.4), ("Kanzel", 1.0, 1.8),
         ("Hohe Wand", 0.8, 1.4), ("Suedgrat", 0.5, 1.0))  # between the couloirs; diameters of their blocks (m)
SCREEN = ((850, -170), (840, -110), (832, -40), (838, 10), (846, 60), (850, 120), (862, 170))  # above the houses
HOUSES = (("Unterdorf 1", 858, -128, 10, 13), ("Unterdorf 3", 884, -104, 9, 11), ("Stall", 846, -88, 9, 17),
          ("Saege", 906, -20, 11, 18), ("Bergli", 868, 66, 9, 12), ("Kapelle", 872, 142, 7, 12))  # s, t, sides (m)
SHAPEFILE = ("-s_srs", "EPSG:2056", "-t_srs", "EPSG:4326", "-lco", "DBF_DATE_LAST_UPDATE=2025-01-01")
GPKG = ("-a_srs", "EPSG:2056", "-lco", "SPATIAL_INDEX=NO")


def to_map(s, t):
    """Coordinates in the CRS of s and t."""
    s, t = s - 600, t - NORTH
    x, y = s * np.sin(FALL) + t * np.cos(FALL), s * np.cos(FALL) - t * np.sin(FALL)
    return X0 + COLS * CELL / 2 + x, Y1 - ROWS * CELL / 2 + y


def cells_at(s, t):
    """Row and column on the fine grid, and which of the points are on the map."""
    x, y = to_map(s, t)
    r, c = ((Y1 - y) // FINE).astype(int), ((x - X0) // FINE).astype(int)
    rr, cc = r.clip(0, ROWS * FINER - 1), c.clip(0, COLS * FINER - 1)
    return rr, cc, (r == rr) & (c == cc)


def spectral(rng, hurst, longest, shortest=2.0, stretch=1.0):
    """Unit-variance fractal noise between two wavelengths, drawn out down the slope by `stretch`."""
    n = 1280 // FINE
    kx, ky = np.meshgrid(np.fft.rfftfreq(n, FINE), np.fft.fftfreq(n, FINE))
    k = np.hypot((kx * np.sin(FALL) - ky * np.cos(FALL)) * stretch, kx * np.cos(FALL) + ky * np.sin(FALL))
    weight = np.where((k > 1 / longest) & (k < 1 / shortest), k, np.inf) ** -(hurst + 1.0)
    z = np.fft.irfft2(np.fft.rfft2(rng.standard_normal((n, n))) * weight, s=(n, n))[:ROWS * FINER, :COLS * FINER]
    return z / z.std()


def step(x, a, b):
    u = np.clip((x - a) / (b - a), 0, 1)
    return u * u * (3 - 2 * u)


def softmax(a, b, blend):
    return blend * np.logaddexp(a / blend, b / blend)


def profile(s, nodes, degrees, zero):
    """Height that falls along s, its slope angle linear between the nodes, and is 0 at `zero`."""
    x = np.arange(-300.0, 1500.0)
    z = -np.cumsum(np.tan(np.radians(np.interp(x, nodes, degrees))))
    return np.interp(s, x, z) - np.interp(zero, x, z)


def rock_surface(s, t, noise):
    """Height of the rock, the warped distance it hangs on, and how much of a couloir each point is."""
    couloir, cut = np.zeros_like(s), np.zeros_like(s)
    for t0, width, depth, phase in COULOIRS:
        away = np.abs(t - t0 - 0.35 * width * np.sin(s / 31 + phase) - 10 * np.sin(s / 90 + 2 * phase)) / width
        cut += depth * np.exp(-away ** 1.4)
        couloir = np.maximum(couloir, np.exp(-(away / 1.5) ** 2) * min(1, depth / 13))
    couloir *= step(s, 60, 190)
    warped = s + 14 * noise["broad"] + step(s, 90, 180) * (2 * noise["medium"] + 5 * noise["ribs"]) + 26 * couloir
    z = FOOT + profile(warped, [-100, 60, 140, 190, 285, 330], [22, 25, 31, 35, 38, 62], 300)
    for at, top, phase, steep, shift in BANDS:
        wave = np.sin(t / 61 + phase) + 0.8 * np.sin(t / 37 + 2.1 * phase) + 0.6 * np.sin(t / 153 + 3.7 * phase)
        high = step(t, -350, -240) * step(-t, -500, -390) * np.clip(top * (0.5 + 0.42 * wave), 0, None)
        high *= 1 - 0.55 * couloir
        wide = np.maximum(high / steep, 1) * (1 + 0.8 * couloir)
        z += high * np.clip((at + wide / 2 + shift * noise["other"] - warped) / wide, 0, 1)
    r, c, _ = cells_at(*LEDGE)
    ledge = 1 - step(np.hypot((s - LEDGE[0]) / 9, (t - LEDGE[1]) / 20), 0.6, 1.3)
    z += ledge * (z[r, c] - 0.7 * (s - LEDGE[0]) - z)
    return z - cut * step(s, 110, 200) * (1 - step(s, 320, 420)), warped, couloir


def talus_surface(rng, sw, tw, rock, warped, couloir):
    """Upper envelope of cones of debris, one every 7 m along the foot of the rock; sw, tw: s, t made wavy."""
    tips, z = np.arange(-600, 640, 7.0), np.full(sw.shape, -1e3)
    wobble = np.convolve(rng.standard_normal(tips.size + 8), np.hanning(9) / 4, "valid")
    for tip, w in zip(tips, wobble):
        r, c, inside = cells_at(np.arange(215.0, 345.0, 2.0), tip)
        foot = np.argmax(inside & (warped[r, c] > BANDS[1][0] + 18))
        if inside[foot]:
            p = r[foot], c[foot]
            d = np.hypot(sw - sw[p], tw - tw[p])
            top = rock[p] + 2 + 1.5 * w + 5 * couloir[p]
            z = softmax(z, top - np.tan(np.radians(36.5 + 0.7 * w)) * d + 0.00012 * d * d, 1.5)
    return z


def apron_surface(s, sw, tw):
    """Valley floor with the stream at height 0, and fans that reach onto it below the couloirs."""
    z = profile(s, [-200, 540, 600, 660, 740, 820, 880, 930, 960], [32, 30, 27, 23.5, 19, 12, 7, 3, 1], 960)
    for t0, _, depth, _ in COULOIRS:
        r = np.hypot(sw - 285, tw - t0)
        fan = profile(r, [0, 150, 270, 340, 430, 600], [37, 36, 33, 27, 20, 12], 0)
        z = softmax(z, FOOT - 2 + 0.9 * depth + fan, 4)
    return z + 0.0008 * np.clip(s - 975, 0, None) ** 2


def cut_road(z, s, t):
    """Cut a road 6 m wide into the slope; returns heights and the axis as points (s, t)."""
    run, axis = np.arange(470.0, 900.0), []
    for ti in np.arange(-720.0, 720.0, 4.0):
        r, c, inside = cells_at(run, ti)
        above = z[r, c] > ROAD + GRADE * ti
        crossing = above[:-1] & ~above[1:] & inside[:-1] & inside[1:]
        axis += [(run[np.argmax(crossing)], ti)] if crossing.any() else []
    down, line = np.transpose(axis)
    line, down = (np.pad(a, 22, "reflect", reflect_type="odd") for a in (line, down))  # beyond the map
    line, down = line[11:-11], np.convolve(down, np.hanning(25)[1:-1] / 12, "valid")
    turn = np.interp(t, line, np.hypot(1, np.gradient(down, line)))
    off = np.clip(np.abs(s - np.interp(t, line, down)) / turn - 3.0, 0, None)
    z = np.clip(z - ROAD + 0.7 - GRADE * t, -0.95 * off, 1.1 * off) + ROAD - 0.7 + GRADE * t
    return z, list(zip(down, line))


def make_terrain(seed):
    """Everything the files are made from, as means over the cells, and the axis of the road."""
    rng = np.random.default_rng(seed)
    y, x = (np.indices((ROWS * FINER, COLS * FINER)) + 0.5) * FINE - [[[ROWS * CELL / 2]], [[COLS * CELL / 2]]]
    s, t = 600 + x * np.sin(FALL) - y * np.cos(FALL), x * np.cos(FALL) + y * np.sin(FALL) + NORTH
    noise = dict(broad=spectral(rng, 1.0, 420, 70), other=spectral(rng, 1.0, 260, 60),
                 medium=spectral(rng, 0.9, 70, 18), ribs=spectral(rng, 0.9, 100, 12, 2.5))
    rough = spectral(rng, 0.65, 140)
    rock, warped, couloir = rock_surface(s, t, noise)
    sw, tw = s + 5 * noise["broad"], t + 9 * noise["other"]
    talus = talus_surface(rng, sw, tw, rock, warped, couloir)
    apron = apron_surface(s + 10 * noise["broad"], sw, tw)
    ground = softmax(talus, apron, 5.0)
    bare = step(rock - ground, 0, 4)
    grass = step(apron - talus, -2, 18) * (1 - bare)
    stream = np.exp(-((s - 962 - 14 * np.sin(t / 95) - 7 * np.sin(t / 41 + 1)) / 6) ** 4)
    z = softmax(rock, ground, 0.8) - 3 * stream
    z, road = cut_road(z + rough * (0.6 - 0.25 * grass + 0.35 * bare) + 0.3 * noise["medium"] * grass, s, t)
    fields = dict(z=z + 780, s=s, t=t, warped=warped, couloir=couloir, bare=bare, grass=grass)
    return {name: a.reshape(ROWS, FINER, COLS, FINER).mean(axis=(1, 3)) for name, a in fields.items()}, road


def grid(a):
    ds = gdal_array.OpenArray(a)
    ds.SetGeoTransform((X0, CELL, 0, Y1, 0, -CELL))
    ds.SetProjection("EPSG:2056")
    ds.GetRasterBand(1).SetUnitType("m")
    return ds


def polygons(mask, least, tolerance):
    """A cleaned mask as one geometry, simplified, without pieces and holes below `least` cells."""
    for _ in range(2):  # majority of 3 x 3
        p = np.pad(mask.astype(int), 1, mode="edge")
        mask = sum(p[i:i + ROWS, j:j + COLS] for i in range(3) for j in range(3)) >= 5
    ds, store = grid(mask.astype(np.int16)), ogr.GetDriverByName("Memory").CreateDataSource("")
    band, layer, whole = ds.GetRasterBand(1), store.CreateLayer(""), ogr.Geometry(ogr.wkbMultiPolygon)
    gdal.SieveFilter(band, None, band, least, 4)
    gdal.Polygonize(band, band, layer, -1)
    for feature in layer:
        whole.AddGeometry(feature.geometry().SimplifyPreserveTopology(tolerance))
    return whole.UnionCascaded()


def shape(wkt, points):
    """A geometry through points (s, t), to the centimetre."""
    return ogr.CreateGeometryFromWkt(wkt % ",".join("%.2f %.2f" % to_map(s, t) for s, t in points))


def write(path, rows, *options):
    """A vector file of (geometry, attributes)."""
    features = [dict(type="Feature", geometry=json.loads(g.ExportToJson()), properties=p) for g, p in rows]
    source = json.dumps(dict(type="FeatureCollection", features=features))
    path.unlink(missing_ok=True)
    gdal.VectorTranslate(str(path), gdal.OpenEx(source), options=["-nln", path.stem, *options])


def cliff_rows(f):
    """One feature for each wall between two couloirs; some are of several parts, one has a hole."""
    slope = np.degrees(np.arctan(np.hypot(*np.gradient(f["z"], CELL))))
    mask = (slope > 57) & (f["couloir"] < 0.45) & (f["s"] < 420) & (f["t"] > -300) & (f["t"] < 480)
    walls, found = [ogr.Geometry(ogr.wkbMultiPolygon) for _ in WALLS], polygons(mask, 10, 2.5)
    for p in found:
        x, y = p.Centroid().GetPoint_2D()
        t = f["t"][int((Y1 - y) // CELL), int((x - X0) // CELL)]
        walls[sum(t > couloir[0] for couloir in COULOIRS)].AddGeometry(p)
    return [(g, dict(name=name, frequency=round(0.4 * g.Area() / 1e4, 3), diameter_m=low, diameter_1=high))
            for g, (name, low, high) in zip(walls, WALLS) if not g.IsEmpty()]


def zone_rows(f, road, box):
    """The map without the summit slope, in polygons that neither overlap nor leave gaps."""
    bare = f["bare"] > 0.5
    rest = box.Difference(polygons(bare & (f["warped"] < 150), 60, 5))
    for zone, g in (("road", road.Buffer(3.0, 2)), ("cliff", polygons(bare, 60, 4)),
                    ("meadow", polygons(f["grass"] > 0.5, 60, 5)), ("talus", box)):
        yield rest.Intersection(g).Buffer(0), dict(zone=zone)
        rest = rest.Difference(g)


def main():
    ap = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    ap.add_argument("out", nargs="?", type=Path, default=Path(__file__).resolve().parents[3] / "data" / "valley")
    ap.add_argument("--seed", type=int, default=11)
    o = ap.parse_args()
    o.out.mkdir(parents=True, exist_ok=True)
    f, axis = make_terrain(o.seed)
    z = np.where(f["warped"] < -38, -9999, np.round(f["z"], 2)).astype(np.float32)
    gdal.Translate(str(o.out / "dem.tif"), grid(z), noData=-9999,
                   creationOptions=["COMPRESS=DEFLATE", "PREDICTOR=3", "ZLEVEL=9"])
    box = polygons(np.ones((ROWS, COLS), bool), 1, 1)
    road, foot = shape("LINESTRING(%s)", axis).Simplify(0.3).Intersection(box), shape("LINESTRING(%s)", SCREEN)
    write(o.out / "cliffs.shp", cliff_rows(f), *SHAPEFILE)
    write(o.out / "zones.gpkg", zone_rows(f, road, box), "-explodecollections", *GPKG)
    write(o.out / "screens.gpkg", [(road, dict(id="road")), (foot, dict(id="foot"))], *GPKG)
    write(o.out / "houses.gpkg", [
        (shape("POLYGON((%s))", [(s + i * a, t + j * b) for i, j in ((0, 0), (0, 1), (1, 1), (1, 0), (0, 0))]),
         dict(name=name)) for name, s, t, a, b in HOUSES], *GPKG)


main()
