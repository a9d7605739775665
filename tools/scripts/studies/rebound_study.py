#!/usr/bin/python3
"""Do measured single rebounds follow the impact law? Prints every figure and draws the picture of docs/rebounds.md.

  tools/scripts/studies/rebound_study.py [--shared ../shared] [-o PICTURE.png] [--draws 60] [--repeats 2000] [--seed 3] [--in-plane]

Reads SHARED/data/literature/wang2018_limestone_on_concrete.csv (75 drops on a concrete slab) and
SHARED/data/chant_sura/contact_events.csv (17 usable contacts of 10 runs). Neither is in the repository.
Exit code 77 if they are missing. A few minutes of one core.
"""
import argparse
import sys
from itertools import product
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import spearmanr

from rebound_law import (NAMES, PRESETS, C, columns, interval, law, random_draws, read_chant, read_wang, resample,
                         rough_planes, simulate)
from rebound_patterns import LAWS, contrasts, exponents, groups, print_tests, scatter, tests, turned_slab
from rebound_picture import draw_picture

FORMS = {"hyperbola": np.geomspace(0.1, 200, 20), "constant": np.linspace(0.2, 1.1, 10),
         "v_half": np.geomspace(0.5, 100, 12),
         "angle": list(product((0.2, 0.3, 0.4, 0.5, 0.6, 0.75), (0.35, 0.7, 1.03)))}
MODELS = list(product(FORMS, (False, True)))  # True: symmetric roughness, which is not the law's
GRID = {"theta_scale": (0, 0.1, 0.2, 0.35, 0.5, 0.7, 1.0, 1.5), "psi_scale": (0, 0.3, 0.6, 0.9, 1.2),
        "Et50": (5, 50, 1e9), "phi_deg": (10, 20, 30, 40)}


def crps(sample, observed):
    """Continuous ranked probability score: mean |x - y| - half of mean |x - x'|, fair for a finite sample."""
    x, m = np.sort(sample, axis=0), len(sample)
    weight = (2 * np.arange(1, m + 1) - m - 1) / (m * (m - 1))
    return np.abs(sample - observed).mean(0) - weight @ x


def score(s, kn, kt):
    """CRPS of v_n,out / v plus CRPS of v_t,out / v, for every impact."""
    return (crps(kn * s.vn / s.speed, s.kn * s.vn / s.speed) + crps(kt * s.vt / s.speed, s.kt * s.vt / s.speed))


def grid_scores(s, form, symmetric, draws):
    settings, scores = [], []
    for theta, psi in product(GRID["theta_scale"], GRID["psi_scale"]):
        planes = rough_planes(s, theta, psi, draws, symmetric)
        for p, et50, phi in product(FORMS[form], GRID["Et50"], GRID["phi_deg"]):
            settings.append((theta, psi, p, et50, phi, 1.0))
            scores.append(score(s, *simulate(s, planes, form, p, et50, phi, 1.0, draws)[:2]))
    return settings, np.array(scores)


def fit_law(s, draws, rng, repeats):
    """The whole law with each form of k_n: best setting, bootstrap ranges, and scores outside the fitted part."""
    print(f"\n## {s.name}: the whole law fitted (CRPS of outgoing velocity / incoming speed; lower is better)")
    best, left_out, spread = {}, {}, []
    for model in MODELS:
        settings, scores = grid_scores(s, *model, draws)
        best[model] = settings[scores.mean(1).argmin()]
        left = [scores[scores[:, s.fold != f].mean(1).argmin()] for f in s.fold]
        left_out[model] = np.array(left)[np.arange(len(left)), np.arange(len(left))]
        held = scores[scores[:, ~s.held].mean(1).argmin()][s.held].mean()
        theta, psi, p, et50, phi, _ = best[model]
        print(f"{model[0]:9} {'symmetric' * model[1]:9} fit {scores.mean(1).min():.4f}  left out "
              f"{left_out[model].mean():.4f}  held out {held:.4f}  theta, psi {theta}, {psi} p {np.round(p, 2)} "
              f"Et50 {et50:.3g} phi {phi}")
        if model == MODELS[0]:
            picks = [resample(s, rng) for _ in range(min(repeats, 1000))]
            spread = np.array([settings[scores[:, i].mean(1).argmin()] for i in picks])
    for i in range(5):
        print(f"  hyperbola {NAMES[i]:12} best {best[MODELS[0]][i]:.3g}, bootstrap 90 % {interval(spread[:, i], 90)}")
    for model in MODELS[1:]:
        for base in [b for b in MODELS[:1 + model[1]] if b != model]:
            gap = left_out[model] - left_out[base]
            print(f"  left out: {model[0] + ' symmetric' * model[1]} - {base[0]}{' symmetric' * base[1]} "
                  f"{gap.mean():+.4f} {interval([gap[resample(s, rng)].mean() for _ in range(repeats)])}")
    for name, setting in PRESETS.items():
        kn, kt, spin = law(s, setting, draws)
        print(f"  preset {name:12} score {score(s, kn, kt).mean():.4f}  k_n {kn.mean():.2f} (measured "
              f"{s.kn.mean():.2f})  k_t {kt.mean():.2f} ({s.kt.mean():.2f})  R w/v "
              f"{spin[:, np.isfinite(s.spin)].mean():.2f} ({np.nanmean(s.spin):.2f})")
    return best[MODELS[0]], best[MODELS[-1]]


CURVES = {"constant": (1, lambda p, s: p[0] + 0 * s.vn),
          "hyperbola": (1, lambda p, s: 1 / (1 + C * s.D * s.vn**2 / p[0])),
          "hyperbola without D": (1, lambda p, s: 1 / (1 + s.vn**2 / p[0])),
          "v_half": (1, lambda p, s: 1 / (1 + s.vn / p[0])),
          "angle^-1.03": (1, lambda p, s: p[0] * (s.angle / 45)**-1.03),
          "angle^b": (2, lambda p, s: p[0] * (s.angle / 45)**(1 - p[1])),
          "v_n^b": (2, lambda p, s: p[0] * s.vn**(1 - p[1])),
          "a * hyperbola": (2, lambda p, s: p[1] / (1 + C * s.D * s.vn**2 / p[0]))}  # p > 0; b = 1 - p[1]


def part(s, mask):
    return SimpleNamespace(**{k: x[mask] if isinstance(x, np.ndarray) else x for k, x in vars(s).items()})


def curve_errors(s, key):
    """Forms on the mean surface, without roughness: errors of outgoing speed / incoming speed; AICc."""
    print(f"\n## {s.name}: curves of {key} on the mean surface (errors are of the outgoing part / incoming speed)")
    measured, scale = getattr(s, key), (s.vn if key == "kn" else s.vt) / s.speed

    def fit(mask, count, curve):
        some = part(s, mask)
        error = lambda p: (curve(np.exp(p), some) - measured[mask]) * scale[mask]
        tries = [least_squares(error, [np.log(a)] + [0.0] * (count - 1)) for a in (0.5, 5, 50)]
        return min(tries, key=lambda r: r.cost)

    for name, (count, curve) in CURVES.items():
        whole, n = fit(np.ones(len(s.D), bool), count, curve), len(s.D)
        out = [(curve(np.exp(fit(s.fold != f, count, curve).x), s) - measured)[s.fold == f] * scale[s.fold == f]
               for f in np.unique(s.fold)]
        held = ((curve(np.exp(fit(~s.held, count, curve).x), s) - measured) * scale)[s.held]
        k = count + 1
        aic = n * np.log(2 * whole.cost / n) + 2 * k + 2 * k * (k + 1) / (n - k - 1)
        print(f"{name:20} AICc {aic:8.1f}  RMS {np.sqrt(2 * whole.cost / n):.4f}  left out "
              f"{np.sqrt(np.mean(np.concatenate(out)**2)):.4f}  held out {np.sqrt(np.mean(held**2)):.4f}  "
              f"p {', '.join(f'{v:.3g}' for v in np.exp(whole.x))}")


def extras(s, shared, laws):
    """Sensitivities of the field contacts, and the six impacts with a measured scar."""
    print("\n## chant-sura: subsets (raw rank correlations), spin, scars")
    for label, m in (("all", s.gap > 0), ("contact < 0.5 m", s.gap < 0.5), ("contact >= 0.5 m", s.gap >= 0.5),
                     ("wheel", np.isfinite(s.w_ratio)), ("equant", ~np.isfinite(s.w_ratio))):
        print(f"{label:16} n {m.sum():2}  k_n {s.kn[m].mean():.2f}  k_t {s.kt[m].mean():.2f}  k_n~k_t "
              f"{spearmanr(s.kn[m], s.kt[m])[0]:+.2f}  k_n~v_n {spearmanr(s.kn[m], s.vn[m])[0]:+.2f}  k_t~v_n "
              f"{spearmanr(s.kt[m], s.vn[m])[0]:+.2f}")
    wheel = np.isfinite(s.w_ratio)
    before = np.linalg.norm(s.w, axis=1) * s.D / 2 / s.speed
    simulated = [np.median(z["spin"][:, wheel] / before[wheel]) for z in laws]
    print(f"spin after / before, median of {wheel.sum()}: {np.median(s.w_ratio[wheel]):.2f}; "
          + ", ".join(f"{label} {x:.2f}" for label, x in zip(LAWS, simulated)))
    (depth, vn, loss, energy), _ = columns(shared / "data/chant_sura/raw/chant_sura_esurf_2019_impacts.csv",
                                           "observed_scarring_depth_m", "incoming_normal_speed_mps",
                                           "observed_total_translational_energy_loss_j",
                                           "observed_pre_impact_translational_j")
    for label, x in (("scar depth", depth), ("v_n (from jump height)", vn)):
        r, p = spearmanr(x, loss / energy)
        print(f"share of energy lost ~ {label}, n {len(x)}: {r:+.2f}, p {p:.2f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--shared", type=Path, default=Path("../shared"))
    parser.add_argument("-o", "--output", type=Path)
    parser.add_argument("--draws", type=int, default=60, help="of every impact, in the fit")
    parser.add_argument("--repeats", type=int, default=2000, help="of bootstraps, permutations, simulated data sets")
    parser.add_argument("--seed", type=int, default=3)
    parser.add_argument("--in-plane", action="store_true", help="take the slab's vt_out as the part along vt_in")
    o = parser.parse_args()
    try:
        data = [read_wang(o.shared), read_chant(o.shared)]
    except FileNotFoundError as missing:
        print(f"rebound_study: no measured data: {missing.filename}", file=sys.stderr)
        return 77
    data[0].absolute_kt = not o.in_plane
    rng, rows, drawn = np.random.default_rng(o.seed), [], []
    for s, preset in zip(data, ("quarry-floor", "firm-talus")):
        fit_draws, many = (random_draws(rng, m, len(s.D)) for m in (o.draws, o.repeats))
        for key in ("kn", "kt"):
            curve_errors(s, key)
        fitted, effect = fit_law(s, fit_draws, rng, o.repeats)
        chosen = ((fitted, "hyperbola", False), (PRESETS[preset], "hyperbola", False), (effect, "angle", True))
        laws = [dict(zip(("kn", "kt", "spin"), law(s, setting, many, *form))) for setting, *form in chosen]
        groups(s, laws, rng, o.repeats)
        rows += scatter(s, laws, rng, o.repeats)
        if s.name == "limestone":
            exponents(s, laws, rng, o.repeats)
            contrasts(s, laws, rng, o.repeats)
            turned_slab(s)
        else:
            extras(s, o.shared, laws)
        rows += tests(s, laws, rng, o.repeats)
        drawn.append(laws)
    print_tests(rows)
    if o.output:
        draw_picture(o.output, data, drawn)
    return 0


if __name__ == "__main__":
    sys.exit(main())
