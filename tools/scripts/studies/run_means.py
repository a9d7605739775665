#!/usr/bin/python3
"""Mean plan path of runs, and their mean speed: the mean of the cells, weighted by the passages (docs/migration.md).

  tools/scripts/studies/run_means.py OUT...
"""
import json
import sys

import numpy as np
from osgeo import gdal

gdal.UseExceptions()

for out in sys.argv[1:]:
    with open(out + "/run.json", encoding="utf-8") as file:
        record = json.load(file)
    passages = gdal.Open(out + "/passages.tif").ReadAsArray()
    speed = gdal.Open(out + "/velocity.tif").ReadAsArray()[0]
    crossed = (passages > 0) & (speed > 0)
    path = record["trajectory_metres_plan"] / record["released"]
    print(f"{out}: mean plan path {path:.0f} m, mean speed {np.average(speed[crossed], weights=passages[crossed]):.1f} m/s")
