#!/usr/bin/python3
"""How does the time of `talus run` grow with threads, ranks, trajectories, DEM and cell size, and does `talus check` foretell it?

  tools/scripts/studies/scaling.py [--talus build/release/talus] [--talus-mpi build/release/talus-mpi] [--shared ../shared] [--work DIR]
                   [--repeats 3] [-o scaling.png]

On the slope of shared/bench/make_slope.py (4 km x 4 km, 1 000 sources, upper-talus-3d, D = 1.2 m, 20 trajectories a source where
nothing else is said). The cases of one table are run in turn, `--repeats` times. A figure is the median over the turns; a ratio
is formed within each turn, then the median is taken. Cost is processor seconds of tracing and tallying per trajectory metre (3D).
About ten minutes of two cores. Results: docs/performance.md, "How it grows" and "What check foretells". Needs python3-numpy,
python3-gdal; with -o python3-matplotlib.
"""
import os
import re
import statistics
import subprocess
import tempfile

from bench_slope import make_slope, parser_of, spread
from files import read_json
from program import ROOT, add_options, talus

ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


class Slope:
    """One version of the slope: its scenario, made once."""

    def __init__(self, o, name, *options):
        self.folder = f"{o.work}/{name}"
        make_slope(o.shared, self.folder, *options)

    def arguments(self, trajectories=20):
        return ["--dem", f"{self.folder}/dem.tif", "--sources", f"{self.folder}/sources.shp", "--preset", "upper-talus-3d",
                "--diameter", "1.2", "--trajectories", str(trajectories)]


def run(o, slope, threads=1, ranks=0, trajectories=20):
    """run.json of one run, with the size of its results."""
    with tempfile.TemporaryDirectory(dir=o.work) as out:
        program = ["mpirun", "--oversubscribe", "-n", str(ranks), o.talus_mpi] if ranks else [o.talus]
        subprocess.run([*program, "run", *slope.arguments(trajectories), "-o", f"{out}/r", "-q", "--threads", str(threads)],
                       check=True, env=ENVIRONMENT)
        record = read_json(f"{out}/r/run.json")
        record["megabytes"] = sum(os.path.getsize(f"{out}/r/{name}") for name in os.listdir(f"{out}/r")) / 1e6
    return record


def in_turn(o, cases):
    """Runs all cases (name -> how to run it), turn by turn. Returns name -> run.json of each turn."""
    records = {name: [] for name in cases}
    for _ in range(o.repeats):
        for name, how in cases.items():
            records[name].append(run(o, **how))
    return records


def wall(record):
    return record["wall_seconds"]["simulate"]


def cost(record):
    """Nanoseconds of a processor per trajectory metre."""
    return 1e9 * record["cpu_seconds"]["simulate"] / record["trajectory_metres"]


def median(records, of):
    return statistics.median(of(r) for r in records)


def ratio(one, other, of):
    """Ratio of two cases, formed in each turn: median (smallest to largest)."""
    return spread([of(a) / of(b) for a, b in zip(one, other)])


def table(title, records, first, of, unit, versus):
    """Prints a row per case: the figure, and its ratio to the first case or the inverse of this ratio."""
    print(f"\n| {title} | {unit} | {versus} |\n| --- | --- | --- |")
    for name, turns in records.items():
        pair = (records[first], turns) if "faster" in versus else (turns, records[first])
        print(f"| {name} | {median(turns, of):.3g} | {ratio(*pair, of)} |")
    return {name: median(turns, of) for name, turns in records.items()}


def seconds_of(text):
    """"1 min 20 s" in seconds."""
    units = {"h": 3600, "min": 60, "s": 1}
    return sum(int(n) * units[unit] for n, unit in re.findall(r"(\d+) (h|min|s)\b", text))


def foretold(o, cases):
    """Compares what `talus check` foretells with the run itself, on one thread."""
    print("\n| run | memory MB: foretold, was | results MB | cells reached | time s |\n| --- | --- | --- | --- | --- |")
    for name, (slope, trajectories) in cases.items():
        text = talus(o, "check", *slope.arguments(trajectories), "--threads", 1)
        said = [float(re.search(rf"^{what}\s+about ([0-9 ]+)", text, re.M).group(1).replace(" ", ""))
                for what in ("memory", "disk", "cells")]
        said.append(seconds_of(re.search(r"^time\s+about ([^,]+) on", text, re.M).group(1)))
        was = run(o, slope, trajectories=trajectories)
        seconds = was["wall_seconds"]
        figures = [was["peak_memory_mb"], was["megabytes"], was["touched_cells"], seconds["simulate"] + seconds["write"]]
        print(f"| {name} | " + " | ".join(f"{s:.0f}, {w:.0f}: {s / w:.2f}" for s, w in zip(said, figures)) + " |")


def draw(path, panels):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(1, len(panels), figsize=(4 * len(panels), 3.2))
    for axis, (title, label, figures) in zip(axes, panels):
        axis.bar(list(figures), list(figures.values()), color="#4477aa", width=0.6)
        axis.set_title(title, fontsize=10)
        axis.set_ylabel(label)
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def main():
    parser = parser_of(__doc__, repeats=3)
    add_options(parser)
    parser.add_argument("--talus-mpi", default=str(ROOT / "build/release/talus-mpi"), help="ranks are left out where it is not there")
    parser.add_argument("-o", "--out", help="picture")
    o = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        o.work = o.work or temporary
        slope = Slope(o, "slope")
        workers = {"1 thread": {"slope": slope, "trajectories": 100}, "2 threads": {"slope": slope, "threads": 2, "trajectories": 100}}
        if os.path.exists(o.talus_mpi):
            workers |= {f"{n} rank{'s' * (n > 1)}": {"slope": slope, "ranks": n, "trajectories": 100} for n in (1, 2, 4)}
        panels = [("Threads and ranks", "wall s", table("workers", in_turn(o, workers), "1 thread", wall, "wall s", "times faster"))]
        cases = {str(n): {"slope": slope, "trajectories": n} for n in (10, 30, 100, 300)}
        panels.append(("Trajectories a source", "ns per m",
                       table("trajectories a source", in_turn(o, cases), "10", cost, "ns per m", "of the first")))
        cases = {f"{side} x {side}": {"slope": Slope(o, f"pad{side}", "--pad", str((side - 2000) // 2)) if side > 2000 else slope}
                 for side in (2000, 4000, 6000)}
        panels.append(("DEM, cells", "ns per m", table("DEM, cells", in_turn(o, cases), "2000 x 2000", cost, "ns per m", "of the first")))
        cases = {f"{cell} m": {"slope": Slope(o, f"cell{cell}", "--cell", str(cell)) if cell != 2 else slope} for cell in (1, 2, 4)}
        panels.append(("Cell size", "ns per m", table("cell size", in_turn(o, cases), "2 m", cost, "ns per m", "of 2 m")))
        foretold(o, {"20 a source": (slope, 20), "300 a source": (slope, 300)})
        if o.out:
            draw(o.out, panels)


main()
