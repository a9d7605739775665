#!/usr/bin/python3
"""How long does Talus take for a region, and in how much memory? Makes a large fractal mountain range to try it on.

  tools/scripts/studies/make_mountains.py FOLDER [--side 20000] [--cell 5] [--sources 50000] [--seed 1]

Writes FOLDER/dem.tif (float32, tiled, compressed; EPSG:2056, invented) strip by strip, and FOLDER/sources.csv: points in clusters of
100 on faces steeper than 45 degrees, one source cell each. Heights are a sum of octaves of cubic splines over random lattices, ridged.
Some minutes for 20 000 x 20 000 cells. Results: docs/performance.md, "A region"; docs/regions.md, "Memory".
Needs numpy, scipy and GDAL's python binding.
"""
import argparse
import os

import numpy as np
from osgeo import gdal
from scipy import sparse

from files import system, write_table

STRIP, CLUSTER = 500, 100


def weights(places, spacing, size):
    """Cubic B-spline weights of lattice points for places along one direction."""
    u = places / spacing
    i = np.floor(u).astype(int)
    t = u - i
    w = np.stack([(1 - t)**3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3]) / 6.0
    rows = np.tile(np.arange(len(places)), 4)
    columns = (i[None, :] + np.arange(4)[:, None]).ravel()
    return sparse.csr_matrix((w.ravel(), (rows, columns)), shape=(len(places), size))


class Mountains:
    def __init__(self, side, seed):
        luck = np.random.default_rng(seed)
        self.octaves = []
        spacing = 1600.0  # cells
        while spacing >= 3.0:
            size = int(side / spacing) + 5
            across = weights(np.arange(side, dtype=float), spacing, size)
            self.octaves.append((spacing, size, luck.uniform(-1, 1, (size, size)).astype(np.float32), across))
            spacing /= 2.1

    def strip(self, top, rows, cell):
        z = np.zeros((rows, self.octaves[0][3].shape[0]), np.float32)
        for spacing, size, lattice, across in self.octaves:
            down = weights(np.arange(top, top + rows, dtype=float), spacing, size)
            octave = across.dot(down.dot(lattice).T).T
            if spacing > 100:
                octave = 0.6 - 2 * np.abs(octave)  # ridges
            z += (0.35 * cell * spacing * (spacing / 1600)**0.25 * octave).astype(np.float32)
        return z + 4500.0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder")
    parser.add_argument("--side", type=int, default=20000)
    parser.add_argument("--cell", type=float, default=5.0)
    parser.add_argument("--sources", type=int, default=50000)
    parser.add_argument("--seed", type=int, default=1)
    o = parser.parse_args()
    os.makedirs(o.folder, exist_ok=True)
    file = gdal.GetDriverByName("GTiff").Create(f"{o.folder}/dem.tif", o.side, o.side, 1, gdal.GDT_Float32,
                                                ["TILED=YES", "COMPRESS=DEFLATE", "PREDICTOR=3", "ZLEVEL=1", "BIGTIFF=YES",
                                                 "NUM_THREADS=2"])
    west, north = 2500000.0, 1300000.0
    file.SetGeoTransform((west, o.cell, 0, north, 0, -o.cell))
    file.SetProjection(system().ExportToWkt())
    mountains, luck, clusters = Mountains(o.side, o.seed), np.random.default_rng(o.seed + 1), []
    per_strip = o.sources / CLUSTER / (o.side / STRIP)
    for top in range(0, o.side, STRIP):
        rows = min(STRIP, o.side - top)
        z = mountains.strip(top, rows, o.cell)
        file.GetRasterBand(1).WriteArray(z, 0, top)
        gy, gx = np.gradient(z, o.cell)
        steep = np.argwhere((np.hypot(gx, gy) > 1.0)[20:-20, 100:-100])
        wanted = round((top / STRIP + 1) * per_strip) - len(clusters)
        for k in luck.choice(len(steep), max(0, wanted), replace=False) if len(steep) >= wanted else range(0):
            clusters.append((top + 20 + steep[k][0], 100 + steep[k][1]))
    file = None
    rows = []
    for row, column in clusters:
        for k in range(CLUSTER):
            x, y = west + (column + k % 10 + 0.5) * o.cell, north - (row + k // 10 + 0.5) * o.cell
            rows.append([len(rows), f"POINT ({x} {y})"])
    write_table(f"{o.folder}/sources.csv", "id,wkt", rows)
    print(f"{o.side} x {o.side} cells, {len(clusters) * CLUSTER} sources")


main()
