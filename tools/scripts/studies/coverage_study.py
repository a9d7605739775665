#!/usr/bin/python3
"""How often do the bounds of passage_density.tif miss the true mean, for blocks with random lengths in a cell of 5 m?

  tools/scripts/studies/coverage_study.py [--times 2000] [--seed 5]

Each of N blocks passes with probability p and then leaves a length of the given distribution. Printed: per cent of the
intervals that miss the mean, of the gamma interval of Fay and Feuer alone, of that from the variance alone, and of the
narrower of both, which is written (`mean_length` in src/products/passage_bounds.cpp; here without its table). 5 % are
allowed; the standard error of 5 % is 0.5 % for 2 000 times. Seconds. Results: docs/products.md, "Passage density". Needs
python3-numpy, python3-scipy.
"""
import argparse

import numpy as np
from scipy.stats import gamma

TAIL = 0.025
STRAIGHT = np.hypot(5, 5)
CASES = ((1000, .0005), (1000, .002), (1000, .01), (1000, .05), (1000, .3), (1000, .7), (1000, .97), (100, .02), (100, .3), (100, .9))


def lengths(rng):
    return {
        "equal, 5 m": lambda n: np.full(n, 5.0),
        "chords of the cell": lambda n: np.minimum(7.07, 5 / np.cos(rng.uniform(0, .78, n))) * rng.uniform(0, 1, n) ** .3,
        "grazing, 0.5 m": lambda n: np.minimum(rng.exponential(.5, n), 7),
        "wandering, exponential, 15 m": lambda n: rng.exponential(15, n),
        "wandering, log-normal, sigma 1.5": lambda n: np.exp(rng.normal(.5, 1.5, n)),
    }


def intervals(length, squares, released):
    """Of Fay and Feuer, and from the variance."""
    some = length > 0
    longest = np.maximum(STRAIGHT, squares / np.where(some, length, 1))
    above, spread = length + longest, squares + longest**2
    shape = length**2 / np.where(some, squares, 1)
    low = np.where(some & (shape >= 1 - 1e-9), length * gamma.ppf(TAIL, np.maximum(shape, 1)) / np.maximum(shape, 1), 0)
    high = gamma.ppf(1 - TAIL, above**2 / spread) * spread / above
    counts = np.maximum(0, squares - length**2 / released) / longest**2
    margin = longest * (gamma.ppf(1 - TAIL, counts + 1) - counts)
    return (low, high), (np.where(some, length - margin, 0), length + margin)


def main():
    ap = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    ap.add_argument("--times", type=int, default=2000)
    ap.add_argument("--seed", type=int, default=5)
    o = ap.parse_args()
    rng = np.random.default_rng(o.seed)
    print("| lengths | blocks | passages | Fay and Feuer | variance | narrower |\n| --- | --- | --- | --- | --- | --- |")
    for name, draw in lengths(rng).items():
        mean = draw(1_000_000).mean()
        for blocks, p in CASES:
            drawn = [draw(k) for k in rng.binomial(blocks, p, o.times)]
            length, squares = np.array([d.sum() for d in drawn]), np.array([(d * d).sum() for d in drawn])
            a, b = intervals(length, squares, blocks)
            both = (np.maximum(a[0], b[0]), np.minimum(a[1], b[1]))
            missed = [100 * np.mean((blocks * p * mean < low) | (blocks * p * mean > high)) for low, high in (a, b, both)]
            print(f"| {name} | {blocks} | {blocks * p:g} | " + " | ".join(f"{m:.1f} %" for m in missed) + " |")


main()
