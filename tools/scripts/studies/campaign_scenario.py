#!/usr/bin/python3
"""What does a run with chosen parameters give for the releases of a field campaign? Writes the scenario of this run.

  tools/scripts/studies/campaign_scenario.py CAMPAIGN_FOLDER OUT_FOLDER [--trajectories 100] [--zone CODE=PRESET ...]

Each block of blocks.csv becomes a point source with its own diameter (of the sphere of its mass and density), release height
and velocity; zones.tif becomes the ground, with a preset per code: --zone 1=lower-talus-3d --zone 2=quarry-floor-2d ...
Nothing is fitted. Seconds. Results: docs/validation.md, "Measured rock falls".
"""
import argparse
import math
import os

from osgeo import gdal

from files import read_table, write_layer, write_text


def write_sources(blocks, dem, path):
    shapes = []
    for block in blocks:
        volume = float(block["mass_kg"]) / float(block["density_kgm3"])
        shapes.append((f"POINT ({block['x']} {block['y']})", block["id"], (6.0 * volume / math.pi) ** (1.0 / 3.0),
                       float(block["release_height_m"] or 1.0), *(float(block[name] or 0.0) for name in ("vx", "vy", "vz"))))
    fields = [("name", str)] + [(name, float) for name in ("diameter", "release_height", "vx", "vy", "vz")]
    write_layer(path, shapes, fields, gdal.Open(dem).GetSpatialRef())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("campaign")
    parser.add_argument("out")
    parser.add_argument("--trajectories", type=int, default=100)
    parser.add_argument("--zone", action="append", default=[], metavar="CODE=PRESET")
    o = parser.parse_args()
    os.makedirs(o.out, exist_ok=True)
    folder = os.path.abspath(o.campaign)
    blocks = read_table(f"{folder}/blocks.csv")
    write_sources(blocks, f"{folder}/dem.tif", os.path.join(o.out, "sources.gpkg"))
    lines = [f'dem = "{folder}/dem.tif"', f"trajectories = {o.trajectories}", "", "[sources]", 'file = "sources.gpkg"', "",
             "[blocks]", f"density = {blocks[0]['density_kgm3']}", "", "[ground]"]
    if o.zone:
        lines += [f'file = "{folder}/zones.tif"', 'default = "upper-talus-3d"']
        for zone in o.zone:
            code, preset = zone.split("=")
            lines += ["", f"[ground.zones.{code}]", f'preset = "{preset}"']
    else:
        lines += ['default = "upper-talus-3d"']
    write_text(os.path.join(o.out, "scenario.toml"), "\n".join(lines) + "\n")


main()
