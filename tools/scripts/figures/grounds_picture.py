#!/usr/bin/python3
"""Draws how far blocks come on three grounds, side by side (docs/choose-ground.md).

  tools/scripts/figures/grounds_picture.py DEM picture.png --sources cliffs.shp --lines screens.gpkg [--talus talus]

Runs 20 blocks per source cell with each of three presets. Seconds. Needs numpy, matplotlib and GDAL's python binding.
"""
import argparse
import os
import subprocess
import sys
import tempfile

from PIL import Image

GROUNDS = ("forest-road-3d", "upper-talus-3d", "lower-talus-3d")
PICTURE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "picture.py")


def map_of(ground, o, folder):
    """A picture of the impact probability on one ground."""
    out, png = os.path.join(folder, ground), os.path.join(folder, ground + ".png")
    subprocess.run([o.talus, "run", "--dem", o.dem, "--sources", o.sources, "--preset", ground, "--trajectories", "20",
                    "-q", "-o", out], check=True, stderr=subprocess.DEVNULL)
    subprocess.run([sys.executable, PICTURE, o.dem, os.path.join(out, "impact_probability.tif"), "-o", png, "--title", ground,
                    "--log", "--classes", "0.00001,0.0001,0.001,0.01", "--width", "4", "--vectors", o.sources, o.lines], check=True)
    return Image.open(png).convert("RGB")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("dem")
    parser.add_argument("picture")
    parser.add_argument("--sources", required=True)
    parser.add_argument("--lines", required=True)
    parser.add_argument("--talus", default="talus")
    o = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        maps = [map_of(ground, o, folder) for ground in GROUNDS]
    sheet = Image.new("RGB", (sum(m.width for m in maps), max(m.height for m in maps)), "white")
    for i, m in enumerate(maps):
        sheet.paste(m, (sum(n.width for n in maps[:i]), 0))
    sheet.quantize(128, dither=Image.Dither.NONE).save(o.picture, optimize=True)


main()
