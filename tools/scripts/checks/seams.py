#!/usr/bin/python3
"""Are there seams in the rasters of a run: do cells differ more from their neighbours across the edge of a region than within one?

  tools/scripts/checks/seams.py RESULTS [passages.tif energy.tif ...]

Talus tallies in square regions of 64 x 64 cells, counted from the south-west. The relative difference of neighbours is the sum of
|a - b| over the sum of a + b. Prints it across the edges of the regions, and beside it the mean, scatter (standard deviation) and
extremes for the other 63 pairs of rows (or columns) of a region. First bands only. Seconds to minutes, by the
size. Results: docs/performance.md, "No seams". Needs numpy and GDAL's python binding.
"""
import argparse
import os

import numpy as np
from osgeo import gdal

gdal.UseExceptions()
SIDE = 64  # of a region, cells: kRegionSide


def differences(path):
    """[direction, place in the region]: relative difference; the last place is across the edge."""
    raster = gdal.Open(path)
    band = raster.GetRasterBand(1)
    columns, rows = raster.RasterXSize, raster.RasterYSize
    sums, totals = np.zeros((2, SIDE)), np.zeros((2, SIDE))
    step = 1000
    for top in range(0, rows, step):
        z = band.ReadAsArray(0, top, columns, min(step + 1, rows - top)).astype(float)
        z = np.where(z > 0, z, 0.0)  # also nodata and NaN: no values
        for direction, a, b in ((0, z[:-1], z[1:]), (1, z[:step, :-1], z[:step, 1:])):
            place = np.arange(a.shape[direction])
            if direction == 0:  # row of the northern cell -> of the southern one, from the south
                place = rows - 2 - (top + place)
            np.add.at(sums[direction], place % SIDE, np.abs(a - b).sum(axis=1 - direction))
            np.add.at(totals[direction], place % SIDE, (a + b).sum(axis=1 - direction))
    return sums / np.maximum(totals, 1e-300)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results")
    parser.add_argument("rasters", nargs="*", default=["passages.tif", "energy.tif", "jump_height.tif"])
    arguments = parser.parse_args()
    print("| raster | between | across an edge | elsewhere, scatter | least to most |")
    print("| --- | --- | --- | --- | --- |")
    for name in arguments.rasters:
        for direction, mean in zip(("rows", "columns"), differences(os.path.join(arguments.results, name))):
            inside = mean[:-1]
            print(f"| {name} | {direction} | {mean[-1]:.4f} | {inside.mean():.4f}, {inside.std():.4f} "
                  f"| {inside.min():.4f} to {inside.max():.4f} |", flush=True)


if __name__ == "__main__":
    main()
