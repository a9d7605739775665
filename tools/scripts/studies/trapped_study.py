#!/usr/bin/python3
"""Do the trapped blocks of a run lie in the pits and dammed cells of the DEM? Shares in and beside them.

  talus run --dem DEM --sources LAYER -o out
  talus check --dem DEM --sources LAYER --pits pits.gpkg
  tools/scripts/studies/trapped_study.py DEM out pits.gpkg

Beside: in one of the eight cells around it. What lies beside both counts as beside a pit. Seconds. Results:
docs/physics.md, "End of a trajectory".
"""
import sys

import numpy as np
from osgeo import gdal

from files import features


def cells_of(path, transform, field, value):
    """Column and row of each feature whose field has the value."""
    cells = []
    for feature in features(path):
        if feature[field] == value:
            place = feature.GetGeometryRef()
            cells.append([(place.GetX() - transform[0]) / transform[1], (place.GetY() - transform[3]) / transform[5]])
    return np.floor(np.array(cells).reshape(-1, 2)).astype(int)


def near(stops, cells, reach):
    """Whether each stop lies within `reach` cells of one of the cells."""
    around = {(c + i, r + j) for c, r in cells for i in range(-reach, reach + 1) for j in range(-reach, reach + 1)}
    return np.array([tuple(stop) in around for stop in stops], dtype=bool)


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    dem, run, pits_file = sys.argv[1:]
    transform = gdal.Open(dem).GetGeoTransform()
    stops = cells_of(run + "/stops.gpkg", transform, "end", "trapped")
    pits, dammed = (cells_of(pits_file, transform, "kind", kind) for kind in ("pit", "dammed"))
    print(f"{len(pits)} pits, {len(dammed)} dammed cells, {len(stops)} trapped blocks")
    for words, reach in (("in", 0), ("in or beside", 1)):
        pit = near(stops, pits, reach)
        dam = near(stops, dammed, reach) & ~pit
        print(f"{words}: pits {100 * pit.mean():.1f} %, dammed cells {100 * dam.mean():.1f} %, "
              f"neither {100 * (~pit & ~dam).mean():.1f} %")


if __name__ == "__main__":
    main()
