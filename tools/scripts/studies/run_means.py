#!/usr/bin/python3
"""How far and how fast do the blocks of a run go? Mean plan path, and mean of the cells' speed, weighted by the passages.

  tools/scripts/studies/run_means.py OUT...

Seconds. Results: docs/migration.md, "Rockyfor3D".
"""
import sys

import numpy as np

from files import read_bands, read_json

for out in sys.argv[1:]:
    record, passages, speed = read_json(f"{out}/run.json"), read_bands(f"{out}/passages.tif")[0], read_bands(f"{out}/velocity.tif")[0]
    crossed = (passages > 0) & (speed > 0)
    path = record["trajectory_metres_plan"] / record["released"]
    print(f"{out}: mean plan path {path:.0f} m, mean speed {np.average(speed[crossed], weights=passages[crossed]):.1f} m/s")
