#!/usr/bin/python3
"""Draws crossings, energy and jump height along a screen, with the design values of a barrier there. Seconds; docs/barrier.md.

  tools/scripts/figures/barrier_picture.py OUT --screen ID -o picture.png [--bin 10]

OUT is a folder of `talus run` in which `talus barrier OUT --screen ID` has been run. Every block, or piece of a broken one,
counts once, with its first crossing. Bins with fewer than 20 blocks show no percentile. Grey: the designs by stretch. Needs
numpy and matplotlib. The picture of real terrain (road, cliffs and frequencies are invented):

  printf 'id,wkt\\nroad,"LINESTRING (248186 351348, 248553 351283, 248769 351435, 248986 351521, 249137 351759, 249158 351889)"\\n' > road.csv
  T=../shared/data/terrain
  talus run --dem $T/gar.tif --sources $T/gar_cliffs.shp --screens road.csv -o gar
  talus barrier gar --screen road
  tools/scripts/figures/barrier_picture.py gar --screen road -o gar_barrier.png --bin 20
"""
import argparse
import csv
import glob
import json
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

FEWEST = 20  # of a 95th percentile: 1 / (1 - 0.95)


def along(lines, x, y):
    """Distance from the start of the line to the point of it that is nearest to each place, over all its parts."""
    best, result, start = np.full(len(x), np.inf), np.zeros(len(x)), 0.0
    for line in lines:
        for a, b in zip(np.array(line[:-1]), np.array(line[1:])):
            way = b - a
            length = np.hypot(*way)
            if length > 0:
                t = np.clip(((x - a[0]) * way[0] + (y - a[1]) * way[1]) / length**2, 0, 1)
                gap = np.hypot(x - a[0] - t * way[0], y - a[1] - t * way[1])
                nearer = gap < best
                best[nearer], result[nearer] = gap[nearer], start + t[nearer] * length
            start += length
    return result, start


def report_of(folder, screen):
    """The design at a screen: of the files barrier_*.json the one that names it (docs/barrier.md, "Names of the files")."""
    for name in sorted(glob.glob(f"{glob.escape(folder)}/barrier_*.json")):
        with open(name, encoding="utf-8") as file:
            report = json.load(file)
        if report["screen"] == screen:
            return report
    sys.exit(f"{folder}: has no barrier_*.json of screen '{screen}': run talus barrier {folder} --screen '{screen}' first")


def first_crossings(path, screen):
    seen, rows = set(), []
    with open(path, encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            piece = (row["source"], row["block"], row.get("piece") or row["mass_kg"])  # earlier runs do not number pieces
            if row["screen"] == screen and piece not in seen:
                seen.add(piece)
                rows.append([float(row[k]) for k in ("x", "y", "energy_kj", "jump_height_m")])
    return np.array(rows).T


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out")
    parser.add_argument("--screen", required=True)
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--bin", type=float, default=10.0)
    o = parser.parse_args()
    with open(f"{o.out}/run.json", encoding="utf-8") as file:
        run = json.load(file)
    report = report_of(o.out, o.screen)
    if report["containment"] is None:
        sys.exit(f"{o.out}: is of talus profile, which has no width to draw")
    design = {row["name"]: row["value"] for row in report["design"]}
    lines = next(s["lines"] for s in run["screens"] if s["id"] == o.screen)
    x, y, energy, height = first_crossings(f"{o.out}/screens.csv", o.screen)
    place, length = along(lines, x, y)
    edges = np.arange(0.0, length + o.bin, o.bin)
    which = np.digitize(place, edges) - 1

    def p95(values):
        groups = [values[which == i] for i in range(len(edges) - 1)]
        return np.array([np.percentile(g, 95) if len(g) >= FEWEST else np.nan for g in groups])

    figure, (top, middle, low) = plt.subplots(3, 1, sharex=True, figsize=(9.4, 6.6))
    share = np.histogram(place, edges)[0] / run["released"]
    top.stairs(100 * share, edges, fill=True, color="#5c7fa3")
    top.set_ylabel(f"blocks per {o.bin:g} m\n[% of all released]")
    stretch = report["containment"]["shortest"]

    def by_stretch(axes, key, label):
        for row in report["stretches"]:
            if row["design"]:
                axes.plot([row["from_m"], row["to_m"]], [row["design"][key]] * 2, color="#7d8790", linewidth=1.6, label=label)
                label = None

    for axes in (top, middle, low):
        axes.axvspan(stretch["from_m"], stretch["to_m"], color="#f3ead2", zorder=0)
        axes.grid(color="#e3e3e3", linewidth=0.6)
    by_stretch(middle, "sel_kj", "SEL by stretch")
    middle.stairs(p95(energy), edges, color="#b0127b", label="P95 of each bin", baseline=None)
    middle.axhline(design["SEL"], color="#20262c", label=f"SEL {design['SEL']:.0f} kJ")
    middle.axhline(design["MEL"], color="#20262c", linestyle="--", label=f"MEL {design['MEL']:.0f} kJ")
    middle.set_ylabel("translational\nenergy [kJ]")
    by_stretch(low, "h_i_m", "h_i by stretch")
    low.stairs(p95(height), edges, color="#1f7a33", label="P95 of each bin", baseline=None)
    low.axhline(design["h_i"], color="#20262c", label=f"h_i {design['h_i']:.2f} m")
    low.set_ylabel("jump height [m]")
    low.set_xlabel(f"along '{o.screen}' [m]; shaded: the shortest stretch with "
                   f"{100 * report['containment']['target']:g} % of the crossings")
    for axes in (middle, low):
        axes.set_ylim(bottom=0)
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8, frameon=False)
    figure.suptitle(f"{len(x):,} blocks cross '{o.screen}' of {run['released']:,}".replace(",", " "), fontsize=11)
    figure.tight_layout()
    figure.savefig(o.output, dpi=100)


main()
