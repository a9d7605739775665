#!/usr/bin/python3
"""How often do 95 % intervals of a reduction of the error hold the true one?

  tools/scripts/studies/interval_study.py [--sets 1500]

Scores of n blocks before and after are drawn from known distributions: before, a gamma distribution of mean 0.75; the
difference normal, skewed (exponential), heavy-tailed (t of 3) or a share of the score with a scatter. Compared are the
jackknife with Student's t (what Talus prints) and with the normal quantile, the bootstrap-t, and percentiles of the
Bayesian bootstrap (what it printed before). Half a minute. Results: docs/diagnosis-evidence.md, "Intervals".
"""
import argparse

import numpy as np

T_QUANTILE = {12: 2.201, 24: 2.069, 50: 2.0096, 100: 1.984}  # 97.5 % of n - 1 degrees of freedom
TRUTH = {"normal": 0.05 / 0.75, "skewed": 0.05 / 0.75, "heavy": 0.05 / 0.75, "share": 0.1}
BOOTSTRAPS = 400


def draw(rng, n, kind):
    before = rng.gamma(2.0, 0.5, n) * 0.75
    less = {"normal": lambda: 0.05 + 0.15 * rng.standard_normal(n), "skewed": lambda: 0.25 * (rng.gamma(1.0, 1.0, n) - 0.8),
            "heavy": lambda: 0.05 + 0.12 * rng.standard_t(3, n), "share": lambda: before * (0.1 + 0.3 * rng.standard_normal(n))}[kind]()
    return before, before - less


def standard_errors(before, after):
    """Of 1 - after/before, linearised, by row of the last axis."""
    b, a = before.mean(-1, keepdims=True), after.mean(-1, keepdims=True)
    influence = (after - a - a / b * (before - b)) / b
    n = before.shape[-1]
    return np.sqrt((influence**2).sum(-1) / n / (n - 1))


def covered(rng, n, kind):
    before, after = draw(rng, n, kind)
    truth, share = TRUTH[kind], 1 - after.mean() / before.mean()
    left_out = 1 - (after.sum() - after) / (before.sum() - before)
    error = np.sqrt((n - 1) / n * np.sum((left_out - share) ** 2))
    weights = rng.exponential(1, (BOOTSTRAPS, n))
    low, high = np.quantile(1 - (weights @ after) / (weights @ before), [0.025, 0.975])
    drawn = rng.integers(0, n, (BOOTSTRAPS, n))
    b, a = before[drawn], after[drawn]
    t_low, t_high = np.quantile((1 - a.mean(1) / b.mean(1) - share) / standard_errors(b, a), [0.025, 0.975])
    own = standard_errors(before, after)
    return (abs(share - truth) <= T_QUANTILE[n] * error, abs(share - truth) <= 1.96 * error,
            share - t_high * own <= truth <= share - t_low * own, low <= truth <= high)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sets", type=int, default=1500)
    sets = parser.parse_args().sets
    rng = np.random.default_rng(1)
    print("| blocks | difference | jackknife, t | jackknife, normal | bootstrap-t | percentiles |")
    print("| --- " * 6 + "|")
    for n in T_QUANTILE:
        for kind in TRUTH:
            shares = 100 * np.mean([covered(rng, n, kind) for _ in range(sets)], axis=0)
            print(f"| {n} | {kind} | " + " | ".join(f"{s:.1f}" for s in shares) + " |", flush=True)


if __name__ == "__main__":
    main()
