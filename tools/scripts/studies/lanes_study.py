#!/usr/bin/python3
"""How much faster is the engine with several trajectories in the lanes of one instruction than an earlier program without?

  tools/scripts/studies/lanes_study.py --before OLD/talus-bench [--bench build/release/tests/bench/talus-bench] [--shared ../shared]
                                       [--work DIR] [--repeats 5]

On the common test slope (shared/bench/make_slope.py), one thread. In each round the earlier program and this one, with every
number of lanes that the processor has, run in turn. Prints the median and the range of the ratios of the rounds: how many times
faster than the earlier program, by CPU time. `trace`: flight, impacts and slides alone, one block of each source. `run`: 100
blocks of each source with every raster on. A round takes a minute or two of one core. Results: docs/performance.md, "Lanes".
Needs python3-numpy, python3-gdal.
"""
import tempfile

from bench_slope import add_bench, figures, make_slope, parser_of, spread


def main():
    parser = parser_of(__doc__, repeats=5)
    add_bench(parser)
    parser.add_argument("--before", required=True, help="talus-bench of the earlier program")
    o = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = o.work or temporary
        make_slope(o.shared, folder)
        rounds = []
        for _ in range(o.repeats):
            before = figures(o.before, folder, "--benchmark_filter=^(trace_only|run/100/1)")
            rounds.append((before, figures(o.bench, folder, "--benchmark_filter=^(trace_in_lanes|run_in_lanes/100)")))
    lanes = [n for n in (1, 4, 8) if f"trace_in_lanes/{n}" in rounds[0][1]]
    print(f"{o.repeats} rounds; times faster than before: median (range)")
    print("| lanes | trace | ns per patch (before: "
          + spread([b["trace_only"]["ns_per_patch"] for b, _ in rounds], 1) + ") | run, 100 a source | us per trajectory (before: "
          + spread([b["run/100/1"]["us_per_trajectory"] for b, _ in rounds], 1) + ") |\n| --- | --- | --- | --- | --- |")
    for n in lanes:
        trace, run = f"trace_in_lanes/{n}", f"run_in_lanes/100/{n}"
        print(f"| {n} | {spread([b['trace_only']['ns_per_patch'] / now[trace]['ns_per_patch'] for b, now in rounds])} | "
              f"{spread([now[trace]['ns_per_patch'] for _, now in rounds], 1)} | "
              f"{spread([b['run/100/1']['us_per_trajectory'] / now[run]['us_per_trajectory'] for b, now in rounds])} | "
              f"{spread([now[run]['us_per_trajectory'] for _, now in rounds], 1)} |")


main()
