#!/usr/bin/python3
"""Which exponents of block-mass do measured campaigns ask for, and how sure are they?

  tools/scripts/studies/size_study.py CAMPAIGN_FOLDER... [--numbers roughness,stiffness] [--seeds 1,2,3] [--trials 32] [--starts 1]
                                      [--reference 1.2] [--grid -0.5,0,0.5,1,1.5] [--talus build/release/talus] [--work DIR] [--threads 1]

For each campaign and seed `talus calibrate` fits the exponents together with that campaign's own ground; it prints the exponent,
its 95 % interval and the error on the held-out rows, with the size law and without. `talus calibrate` takes one campaign, so the
campaigns are joined afterwards: mean by inverse variance (sd: a quarter of 3.92 of the interval, over the seeds their mean), with
the chi-square of their difference. With --grid the roughness exponent is held at each value, the ground is fitted anew, and the
errors on the fitting and held-out rows are printed and summed: a profile that needs no normal distribution.
All on bilinear patches (`--surface bilinear`). Fits that are there (in --work) are not made again; a fit takes minutes of one core.
Results: docs/effects.md, "block-mass".
"""
import os
from types import SimpleNamespace

import numpy as np

from campaign_fits import add_fit_options, errors_of, fitted, name_of
from files import read_json
from program import list_of, parser_of

GROUND = "theta_scale,psi_scale,En50,Et50"


def calibrated(o, campaign, name, numbers, free, seed):
    """The folder of a fit that starts with these numbers of block-mass; `free` are fitted, the others held."""
    start = "[effects.block-mass]\n" + "".join(f"{k} = {v:g}\n" for k, v in numbers.items()) if numbers else ""
    keys = ",".join([GROUND] + [f"effects.block-mass.{key}" for key in free])
    return fitted(o, campaign, name, start, seed, "--fit", keys)


def exponents(o, campaign):
    """Prints the fits of one campaign; returns value and sd of each exponent, means over the seeds."""
    name, found = name_of(campaign), {key: [] for key in o.numbers}
    start = {key: 0.0 for key in o.numbers} | {"reference_diameter": o.reference}
    for seed in o.seeds:
        without = errors_of(o, campaign, calibrated(o, campaign, "off", {}, [], seed))
        out = calibrated(o, campaign, "-".join(o.numbers), start, o.numbers, seed)
        fit, holdout = errors_of(o, campaign, out)
        for p in read_json(f"{out}/calibration.json")["parameters"]:
            key = p["key"].removeprefix("effects.block-mass.")
            if key not in found:
                continue
            low, high = p["ci95"]
            found[key].append((p["value"], (high - low) / 3.92))
            print(f"{name:10} seed {seed}  {key:10} {p['value']:6.2f}  95 % {low:6.2f} to {high:6.2f}", flush=True)
        print(f"{name:10} seed {seed}  error, fitting rows {without[0]:.3f} off, {fit:.3f} on; held-out rows {without[1]:.3f} off, {holdout:.3f} on",
              flush=True)
    return {key: np.mean(values, axis=0) for key, values in found.items()}


def join(o, found):
    """Mean by inverse variance over the campaigns."""
    for key in o.numbers:
        value, sd = np.array([f[key] for f in found]).T
        weight = 1.0 / sd**2
        mean, error = np.sum(weight * value) / np.sum(weight), np.sum(weight) ** -0.5
        print(f"joined     {key:10} {mean:6.2f}  95 % {mean - 1.96 * error:6.2f} to {mean + 1.96 * error:6.2f}  "
              f"chi-square {np.sum(weight * (value - mean) ** 2):.1f} on {len(value) - 1}")


def profile(o):
    print("\nroughness exponent held, ground fitted anew: error on fitting rows, held-out rows (means over the seeds)")
    for exponent in o.grid:
        cells, total = [], SimpleNamespace(fit=0.0, holdout=0.0)
        for campaign in o.campaigns:
            numbers = {"roughness": exponent, "reference_diameter": o.reference}
            runs = [errors_of(o, campaign, calibrated(o, campaign, f"at{exponent:g}", numbers, [], seed)) for seed in o.seeds]
            fit, holdout = np.mean(runs, axis=0)
            total.fit, total.holdout = total.fit + fit, total.holdout + holdout
            cells.append(f"{name_of(campaign)} {fit:.3f} {holdout:.3f}")
        print(f"{exponent:6.2f}  {'  '.join(cells)}  sum {total.fit:.3f} {total.holdout:.3f}", flush=True)


def main():
    parser = parser_of(__doc__, work="size-study", threads=1)
    parser.add_argument("campaigns", nargs="+")
    parser.add_argument("--numbers", type=list_of(str), default=["roughness", "stiffness"])
    parser.add_argument("--seeds", type=list_of(int), default=[1, 2, 3])
    add_fit_options(parser)
    parser.add_argument("--reference", type=float, default=1.2, help="diameter [m]")
    parser.add_argument("--grid", type=list_of(float), default=[], help="roughness exponents to hold")
    o = parser.parse_args()
    os.makedirs(o.work, exist_ok=True)
    join(o, [exponents(o, campaign) for campaign in o.campaigns])
    if o.grid:
        profile(o)


if __name__ == "__main__":
    main()
