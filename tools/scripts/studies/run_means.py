#!/usr/bin/python3
"""Mean plan path of runs, and their mean speed: the mean of the cells, weighted by the passages (docs/migration.md).

  tools/scripts/studies/run_means.py OUT...
"""
import sys

import numpy as np

from files import read_bands, read_json

for out in sys.argv[1:]:
    record, passages, speed = read_json(f"{out}/run.json"), read_bands(f"{out}/passages.tif")[0], read_bands(f"{out}/velocity.tif")[0]
    crossed = (passages > 0) & (speed > 0)
    path = record["trajectory_metres_plan"] / record["released"]
    print(f"{out}: mean plan path {path:.0f} m, mean speed {np.average(speed[crossed], weights=passages[crossed]):.1f} m/s")
