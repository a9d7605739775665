#!/usr/bin/python3
"""Draws the first residual plots of a diagnosis as one SVG, before on the left, after on the right. Seconds; docs/diagnosis-results.md.

  tools/scripts/figures/diagnosis_picture.py OUT -o picture.svg [--rows 2]

OUT: the folder that `talus diagnose` wrote.
"""
import argparse
import re

WIDTH, HEIGHT = 330, 190  # of a plot, as in src/io/reports/diagnosis_page.cpp


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder")
    parser.add_argument("-o", "--out", required=True)
    parser.add_argument("--rows", type=int, default=2)
    o = parser.parse_args()
    with open(f"{o.folder}/report.html", encoding="utf-8") as file:
        page = file.read()
    rows = [re.findall(r"<svg[^>]*>(.*?)</svg>", row, re.S) for row in re.findall(r"<p>(<svg.*?</svg>)\s*</p>", page, re.S)][:o.rows]
    columns = max(len(row) for row in rows)
    with open(o.out, "w", encoding="utf-8") as out:
        out.write(f"<svg xmlns='http://www.w3.org/2000/svg' width='{columns * WIDTH}' height='{len(rows) * HEIGHT}' font-family='sans-serif' "
                  "font-size='11'><rect width='100%' height='100%' fill='white'/>\n")
        for i, row in enumerate(rows):
            for k, plot in enumerate(row):
                out.write(f"<g transform='translate({k * WIDTH} {i * HEIGHT})'>{plot}</g>\n")
        out.write("</svg>\n")


main()
