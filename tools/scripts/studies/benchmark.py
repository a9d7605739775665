#!/usr/bin/python3
"""How fast is the engine, next to a sketch of the same loop and to the least that a trajectory can cost?

  tools/scripts/studies/benchmark.py [--bench build/release/tests/bench/talus-bench] [--shared ../shared] [--work DIR] [--repeats 3]

Makes the slope (2 000 x 2 000 cells of 2 m, 1 000 sources) with shared/bench/make_slope.py, compiles shared/bench/sketch.cpp
(an unoptimised sketch of the loop with counts and one maximum), and runs it and talus-bench in turn. Prints medians over the
rounds; a ratio is formed within each round, and its median and range are printed. Two sketches at once show what the machine
itself loses when two cores share caches, memory or a host. Compare the ratios of one run; the figures are those of one machine.
A round takes about a minute of two cores. Results: docs/performance.md, "Speed". Needs g++, python3-numpy, python3-gdal.
"""
import os
import re
import resource
import statistics
import subprocess
import tempfile
import time

from bench_slope import add_bench, figures, make_slope, parser_of, spread


def sketch_speed(folder):
    """Million plan metres per CPU-second of the sketch. Its own clock is wall time, so it is scaled by wall / CPU of the process."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    out = subprocess.run([f"{folder}/sketch", f"{folder}/dem.asc", f"{folder}/sources.csv", "10"], check=True,
                         capture_output=True, text=True).stdout
    wall, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return float(re.search(r"Mm/s ([0-9.]+)", out).group(1)) * max(1.0, wall / cpu)


def two_sketches(folder):
    """Gain of two programs at once that share nothing, on this machine: twice the wall seconds of one over those of two together."""
    command = [f"{folder}/sketch", f"{folder}/dem.asc", f"{folder}/sources.csv", "10"]

    def seconds(programs):
        start = time.monotonic()
        for process in [subprocess.Popen(command, stdout=subprocess.DEVNULL) for _ in range(programs)]:
            process.wait()
        return time.monotonic() - start

    return 2 * seconds(1) / seconds(2)


def table(runs, sketches, doubles):
    def median(name, key):
        return statistics.median(run[name][key] for run in runs)

    print(f"sketch: {statistics.median(sketches):.2f} million plan metres per CPU-second ({min(sketches):.2f} to {max(sketches):.2f}, "
          f"{len(sketches)} rounds)")
    print("| trajectories per source, threads | million plan m per CPU-s | x sketch | us per trajectory | wall s |")
    print("| --- | --- | --- | --- | --- |")
    for name in ("run/10/1", "run/100/1", "run/10/2", "run/100/2"):
        ratio = spread([run[name]["plan_Mm_per_cpu_s"] / sketch for run, sketch in zip(runs, sketches)])
        print(f"| {name[4:].replace('/', ', ')} | {median(name, 'plan_Mm_per_cpu_s'):.2f} | {ratio} | "
              f"{median(name, 'us_per_trajectory'):.0f} | {median(name, 'wall_s'):.2f} |")
    for n in (10, 100):
        print(f"two threads against one, {n} trajectories: {spread([r[f'run/{n}/1']['wall_s'] / r[f'run/{n}/2']['wall_s'] for r in runs])}x")
    print(f"two sketches at once against one after the other: {spread(doubles)}x")
    walk, law, traced = (median(name, "ns_per_plan_m") for name in ("floor_walk", "impact_law", "trace_only"))
    floor = walk + law

    def row(name, figure, ns):
        print(f"| {name} | {figure} | {ns:.1f} ns | {ns / floor:.2f} |")

    print("| part | figure | per plan metre | x floor |\n| --- | --- | --- | --- |")
    row("bare walk over the same patches", f"{median('floor_walk', 'ns_per_patch'):.1f} ns per patch", walk)
    row("the impact law alone", f"{median('impact_law', 'ns_per_impact'):.1f} ns per impact", law)
    row("floor: both", "", floor)
    row("trace: flight, impacts, slides", f"{median('trace_only', 'ns_per_patch'):.1f} ns per patch", traced)
    for name in ("run/10/1", "run/100/1"):
        row(f"full run, {name[4:-2]} trajectories per source, 1 thread", f"{median('score', 'ns_per_cell'):.1f} ns per cell scored",
            1e3 / median(name, "plan_Mm_per_cpu_s"))


def main():
    parser = parser_of(__doc__, repeats=3)
    add_bench(parser)
    o = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = o.work or temporary
        os.makedirs(folder, exist_ok=True)
        make_slope(o.shared, folder)
        subprocess.run(["g++", "-O2", "-std=c++17", f"{o.shared}/bench/sketch.cpp", "-o", f"{folder}/sketch"], check=True)
        runs, sketches, doubles = [], [], []
        for _ in range(o.repeats):
            sketches.append(sketch_speed(folder))
            runs.append(figures(o.bench, folder))
            doubles.append(two_sketches(folder))
        table(runs, sketches, doubles)


main()
