"""The layout of the GeoTIFFs, by the rules of GDAL's validate_cloud_optimized_geotiff.py, read byte by byte; their overviews."""
import os
import struct
import unittest

import numpy as np
from osgeo import gdal, ogr

from support import NORTH, WEST, Case, write_dem, write_features

COLUMNS, ROWS, CELL = 1301, 1110, 2.0  # two overviews; edges that are no whole tiles, of odd sizes
SIZES = {1: 1, 2: 1, 3: 2, 4: 4, 12: 8, 16: 8}  # bytes of the types of TIFF
GHOST = b"GDAL_STRUCTURAL_METADATA_SIZE="


class Directory(dict):
    """The tags of a directory as tuples of numbers (texts: bytes), with its place and the place of the next."""

    def __init__(self, data, at):
        super().__init__()
        self.at, (count,) = at, struct.unpack_from("<H", data, at)
        self.ends = [at + 6 + 12 * count]
        for i in range(count):
            tag, kind, number = struct.unpack_from("<HHI", data, at + 2 + 12 * i)
            size, place = SIZES[kind] * number, at + 10 + 12 * i
            if size > 4:
                (place,) = struct.unpack_from("<I", data, place)
                self.ends.append(place + size)
            raw = data[place:place + size]
            code = {1: "B", 3: "H", 4: "I", 12: "d", 16: "Q"}.get(kind)
            self[tag] = struct.unpack(f"<{number}{code}", raw) if code else raw
        (self.next,) = struct.unpack_from("<I", data, at + 2 + 12 * count)

    @property
    def size(self):
        return self[256][0], self[257][0]

    @property
    def tiles(self):
        return list(zip(self[324], self[325]))


def directories(data):
    found, (at,) = [], struct.unpack_from("<I", data, 4)
    while at:
        found.append(Directory(data, at))
        at = found[-1].next
    return found


class Cog(Case):
    def setUp(self):
        super().setUp()
        y, x = np.mgrid[0:ROWS, 0:COLUMNS]
        z = (100.0 + CELL / (2 * ROWS) * (ROWS - y)**2 + 5.0 * np.sin(x / 40.0)).astype(np.float32)  # 45 degrees to 0
        z[700:, 900:] = -1.0  # no terrain in whole tiles and in parts of some
        write_dem(self.path("large.tif"), z, CELL, nodata=-1.0)
        places = [(800, 1600, 60, 6), (1700, 1500, 60, 6)]
        write_features(self.path("large.gpkg"), "sources", [(self.high_box(*place), [0.1]) for place in places],
                       [("frequency", ogr.OFTReal)])

    @staticmethod
    def high_box(east, north, width, height):
        """Like `box`, for a DEM whose lower-left corner lies elsewhere."""
        x, y = WEST + east, NORTH - ROWS * CELL + north
        return f"POLYGON (({x} {y},{x + width} {y},{x + width} {y + height},{x} {y + height},{x} {y}))"

    def run_large(self, out, *more):
        self.run_well("run", "--dem", self.path("large.tif"), "--sources", self.path("large.gpkg"), "--diameter", "1",
                      "--trajectories", "2", "-q", "-o", self.path(out), *more)
        return sorted(name for name in os.listdir(self.path(out)) if name.endswith(".tif"))

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def check_layout(self, data):
        self.assertEqual(data[:4], b"II*\0")
        self.assertEqual(data[8:8 + len(GHOST)], GHOST)
        claim = 8 + len(GHOST) + len("000000 bytes\n") + int(data[8 + len(GHOST):14 + len(GHOST)])
        found = directories(data)
        # Directories first, right after the header, the full resolution before its overviews; each half as large.
        self.assertEqual(found[0].at, claim + claim % 2)
        self.assertEqual([each.at for each in found], sorted(each.at for each in found))
        self.assertEqual([each.get(254, (0,))[0] for each in found], [0] + [1] * (len(found) - 1))
        for one, half in zip(found, found[1:]):
            self.assertEqual(half.size, tuple((side + 1) // 2 for side in one.size))
            self.assertEqual({tag: one[tag] for tag in (258, 259, 262, 277, 284, 322, 323, 339, 42113)},
                             {tag: half[tag] for tag in (258, 259, 262, 277, 284, 322, 323, 339, 42113)})
        self.assertLessEqual(max(found[-1].size), 512)
        # Tiles after all directories: of the smallest overview first, row by row, without gaps, each between its size and
        # its last bytes again. A tile without a value is nowhere.
        end = max(place + place % 2 for each in found for place in each.ends)
        for level in reversed(found):
            (width,), (height,) = level[322], level[323]
            across, down = (-(-size // side) for size, side in zip(level.size, (width, height)))
            self.assertEqual((len(level.tiles), width % 16, height % 16), (across * down, 0, 0))
            for place, size in level.tiles:
                if size == 0:
                    self.assertEqual(place, 0)
                    continue
                self.assertEqual(place, end + 4)
                self.assertEqual(struct.unpack_from("<I", data, place - 4)[0], size)
                end = place + size + 4
                self.assertEqual(data[end - 4:end], data[end - 8:end - 4])
        self.assertEqual(end, len(data))
        return found

    def check_overviews(self, name, smallest):
        file = gdal.Open(self.path(name))
        for b in range(1, file.RasterCount + 1):
            band = file.GetRasterBand(b)
            nodata, fine = band.GetNoDataValue(), band.ReadAsArray().astype(np.float64)
            none = np.inf if smallest else -np.inf
            fine[fine == nodata] = none
            self.assertEqual(band.GetOverviewCount(), 2)
            for level in range(2):
                fine = np.pad(fine, [(0, fine.shape[0] % 2), (0, fine.shape[1] % 2)], constant_values=none)
                of_four = np.stack([fine[0::2, 0::2], fine[0::2, 1::2], fine[1::2, 0::2], fine[1::2, 1::2]])
                fine = of_four.min(axis=0) if smallest else of_four.max(axis=0)
                shown = band.GetOverview(level).ReadAsArray().astype(np.float64)
                np.testing.assert_array_equal(np.where(fine == none, nodata, fine), shown, f"{name} {b} {level}")

    def test_layout_and_overviews_of_all_rasters(self):
        names = self.run_large("out")
        self.assertGreater(len(names), 12)
        self.run_well("hazard", self.path("out"), "-q")
        periods = [name for name in os.listdir(self.path("out")) if name.startswith("return_period") and name.endswith(".tif")]
        self.assertTrue(periods)
        for name in [*names, *periods]:
            found = self.check_layout(self.read(f"out/{name}"))
            self.assertEqual((len(found), found[0].size), (3, (COLUMNS, ROWS)), name)
            self.check_overviews(f"out/{name}", smallest=name in periods)
            info = gdal.Open(self.path(f"out/{name}")).GetMetadata("IMAGE_STRUCTURE")
            self.assertEqual((info["LAYOUT"], info["COMPRESSION"]), ("COG", "DEFLATE"))

    def test_of_gdal_itself(self):
        try:
            from osgeo_utils.samples.validate_cloud_optimized_geotiff import validate  # pylint: disable=import-outside-toplevel
        except ImportError:
            self.skipTest("this GDAL comes without validate_cloud_optimized_geotiff.py")
        for name in self.run_large("out"):
            warnings, errors, _ = validate(self.path(f"out/{name}"), full_check=True)
            self.assertEqual((warnings, errors), ([], []), name)

    def test_the_same_bytes_for_any_number_of_threads(self):
        names = self.run_large("one", "--threads", "1")
        for threads in ("2", "5"):
            self.assertEqual(self.run_large("other", "--overwrite", "--threads", threads), names)
            for name in names:
                self.assertEqual(self.read(f"one/{name}"), self.read(f"other/{name}"), name)

    def test_values_of_untouched_ground_and_beyond_the_terrain(self):
        self.run_large("out")
        touched = gdal.Open(self.path("out/passages.tif")).ReadAsArray()
        ground = gdal.Open(self.path("large.tif")).ReadAsArray() > 0.0
        self.assertEqual(set(touched[~ground]), {4294967295})
        quiet = ground & (touched == 0)
        self.assertGreater(quiet.sum(), 0.5 * touched.size)
        upper = 1.0 - 0.05**(1.0 / self.record()["released"])  # of no hit in n trials, for sure not below this
        bands = gdal.Open(self.path("out/impact_probability.tif")).ReadAsArray()
        self.assertEqual([set(band[quiet]) for band in bands[:2]], [{0.0}, {0.0}])
        self.assertEqual(len(set(bands[2][quiet])), 1)
        self.assertGreaterEqual(bands[2][quiet][0], upper)
        self.assertEqual(set(bands[:, ~ground].ravel()), {-9999.0})
        self.assertEqual(set(gdal.Open(self.path("out/energy.tif")).ReadAsArray()[:, ~ground | quiet].ravel()), {-9999.0})


if __name__ == "__main__":
    unittest.main()
