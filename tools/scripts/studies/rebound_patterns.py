"""Patterns of the measured rebounds, beside those of each law on the same incoming states (for rebound_study.py)."""
import numpy as np
from scipy.stats import rankdata

from rebound_law import C, interval, resample

LAWS = ("fitted", "preset", "angle+sym")  # the law fitted; as its preset; k_n by angle with symmetric roughness, fitted


def beside(values):
    return "  ".join(f"{name} {value}" for name, value in zip(LAWS, values))


def correlation(a, b, q):
    """Correlation of a and b (last axis: impacts), both freed of the orthonormal columns q."""
    a, b = (x - (x @ q) @ q.T for x in (a, b))
    return (a * b).sum(-1) / np.sqrt((a * a).sum(-1) * (b * b).sum(-1))


def partial(a, b, held):
    """Rank correlation of a and b, the columns of `held` taken out linearly."""
    q = np.linalg.qr(np.c_[np.ones(len(held)), held])[0]
    return correlation(rankdata(a, axis=-1), rankdata(b, axis=-1), q)


def wanted_tests(s):
    """(a, b, name of what is held, its columns). On the slab k_n and k_t are paired within cells of plate, drop and size."""
    ranks, slab = lambda *x: rankdata(np.array(x), axis=1).T, s.name == "limestone"
    d = (s.D,) if slab else ()
    rows = [(k, "angle", "v_n" + ", D" * slab, ranks(*d, s.vn)) for k in ("kn", "kt")]
    rows += [(k, "vn", "angle" + ", D" * slab, ranks(*d, s.angle)) for k in ("kn", "kt")]
    rows += [(k, "D", "v_n, angle", ranks(s.vn, s.angle)) for k in ("kn", "kt")]
    if not slab:
        return rows + [("kn", "kt", "v_n, angle", ranks(s.vn, s.angle))]
    cells = (s.cell[:, None] == np.unique(s.cell)[1:]) * 1.0
    return rows + [(a, b, "cell", cells) for a, b in (("kn", "kt"), ("kn", "spin"), ("kt", "spin"))]


def tests(s, laws, rng, repeats):
    """Partial rank correlations: measured, bootstrap interval, permutation p, 95 % of data sets drawn from each law."""
    rows = []
    for a, b, label, held in wanted_tests(s):
        x, y = getattr(s, a), getattr(s, b)
        r, picks = partial(x, y, held), [resample(s, rng) for _ in range(repeats)]
        boot = [partial(x[i], y[i], held[i]) for i in picks]
        q = np.linalg.qr(np.c_[np.ones(len(held)), held])[0]
        rest = rankdata(x) - q @ (q.T @ rankdata(x))  # permuted (Freedman and Lane)
        chance = correlation(rest[np.argsort(rng.random((repeats, len(x))), axis=1)], rankdata(y), q)
        p = (1 + np.sum(np.abs(chance) >= abs(r))) / (1 + repeats)
        drawn = [partial(z[a], z.get(b, y), held) for z in laws]
        rows.append((s.name, f"{a} ~ {b} | {label}", r, interval(boot), p, [interval(z) for z in drawn]))
    return rows


def print_tests(rows):
    print("\n## Partial rank correlations; p by permutation, then Holm over all of them; 95 % of data drawn from a law")
    order, worst = np.argsort([row[4] for row in rows]), 0.0
    holm = np.empty(len(rows))
    for i, k in enumerate(order):
        worst = max(worst, min(1.0, rows[k][4] * (len(rows) - i)))
        holm[k] = worst
    for row, p in zip(rows, holm):
        print(f"{row[0]:10} {row[1]:24} {row[2]:+.2f} {row[3]:16} p {row[4]:.4f} Holm {p:.4f}  {beside(row[5])}")


def exponents(s, laws, rng, repeats):
    """k = a v_n^p D^q sin(angle)^r by least squares of logarithms."""
    x = np.c_[np.ones(len(s.D)), np.log(s.vn), np.log(s.D), np.log(np.sin(np.radians(s.angle)))]
    solve = lambda k, i=slice(None): np.linalg.lstsq(x[i], np.log(np.maximum(k, 0.02)).T[i], rcond=None)[0]
    print(f"\n## {s.name}: exponents of v_n, D, sin(angle) at the others held")
    for key in ("kn", "kt"):
        k = getattr(s, key)
        boot = np.array([solve(k, resample(s, rng)) for _ in range(repeats)])
        for j, name in enumerate(("v_n", "D", "sin(angle)"), 1):
            print(f"{key} {name:10} {solve(k)[j]:+.2f} {interval(boot[:, j]):16}  "
                  + beside([interval(solve(z[key])[j]) for z in laws]))


def needed(s, mask, rng, repeats):
    """En50 that the smooth hyperbola needs for these impacts (1e4, the last tried, stands for k_n >= 1)."""
    trial = np.geomspace(0.05, 1e4, 250)
    k = trial[:, None] / (C * s.D * s.vn**2 + trial[:, None])
    cost, rows = ((k - s.kn) * s.vn / s.speed)**2, np.flatnonzero(mask)
    picks = [rows] + [rng.choice(rows, len(rows)) for _ in range(repeats)]
    best = trial[[cost[:, i].sum(1).argmin() for i in picks]]
    return best[0], interval(best)


def groups(s, laws, rng, repeats):
    """k_n by speed, En50 needed by angle and size, share of k_n > 1 by angle: measured and simulated."""
    few = s.name != "limestone"
    print(f"\n## {s.name}: k_n and k_t by v_n, measured and as each law gives them")
    edges = np.quantile(s.vn, np.linspace(0, 1, 4 if few else 6))
    for low, high in zip(edges, edges[1:]):
        m = (s.vn >= low) & ((s.vn < high) | (high == edges[-1]))
        boot = [s.kn[rng.choice(np.flatnonzero(m), m.sum())].mean() for _ in range(repeats)]
        means = [f"{z['kn'][:, m].mean():.2f}, {z['kt'][:, m].mean():.2f}" for z in laws]
        print(f"v_n {low:.2f}-{high:.2f} n {m.sum():2}  k_n {s.kn[m].mean():.2f} {interval(boot):14} "
              f"k_t {s.kt[m].mean():.2f}  k_n, k_t: {beside(means)}")
    print(f"## {s.name}: share of k_n > 1 by impact angle (95 %: Wilson); En50 that the smooth hyperbola needs there")
    for low, high in ((0, 15), (15, 35), (35, 50), (50, 90)):
        m = (s.angle >= low) & (s.angle < high)
        if m.sum() < 3:
            continue
        n, p, z2 = m.sum(), (s.kn[m] > 1).mean(), 3.8416
        half, mid = np.sqrt(z2 * (p * (1 - p) / n + z2 / 4 / n**2)) / (1 + z2 / n), (p + z2 / 2 / n) / (1 + z2 / n)
        en, en_range = needed(s, m, rng, repeats)
        print(f"angle {low:2}-{high} n {n:2}  > 1: {p:.2f} [{max(0, mid - half):.2f}, {mid + half:.2f}]  "
              + beside([f"{(z['kn'][:, m] > 1).mean():.2f}" for z in laws]) + f"  En50 {en:.3g} {en_range}")


def scatter(s, laws, rng, repeats):
    """Standard deviation of k_n and k_t within a cell (slab) or of all (field); their correlations within cells."""
    slab = s.name == "limestone"
    labels = s.cell if slab else np.zeros(len(s.D))
    member = (labels[:, None] == np.unique(labels)) * 1.0
    q, free = member / np.sqrt(member.sum(0)), len(labels) - member.shape[1]
    print(f"## {s.name}: standard deviation {'within cells' if slab else 'of all'}")
    for key in ("kn", "kt"):
        deviation = lambda k: np.sqrt(((k - (k @ q) @ q.T)**2).sum(-1) / free)
        print(f"{key} {deviation(getattr(s, key)):.3f}  " + beside([interval(deviation(z[key])) for z in laws]))
    rows, picks = [], [resample(s, rng) for _ in range(repeats)]
    shuffled = np.array([np.lexsort((rng.random(len(labels)), labels)) for _ in range(repeats)])
    for a, b in (("kn", "kt"), ("kn", "spin"), ("kt", "spin")) if slab else ():
        x, y = (getattr(s, k) - (getattr(s, k) @ q) @ q.T for k in (a, b))
        r, order, nothing = correlation(x, y, q), np.argsort(labels, kind="stable"), np.zeros((len(x), 1))
        chance = correlation(x[shuffled], y[order], nothing)  # x permuted within its cells
        p = (1 + np.sum(np.abs(chance) >= abs(r))) / (1 + repeats)
        drawn = [interval(correlation(z[a], z[b], q)) for z in laws]
        boot = interval([np.corrcoef(x[i], y[i])[0, 1] for i in picks])
        rows.append((s.name, f"{a} ~ {b} | cell means", r, boot, p, drawn))
    return rows


def contrasts(s, laws, rng, repeats):
    """The plan of the drops allows two direct looks: same v_n at two angles, same angle at two speeds."""
    print("\n## limestone: direct contrasts of k_n (ratio; the hyperbola's: En50 from the divisor's impacts)")
    looks = [(f"plate {a} / {b}, v_n {lo}-{hi}", (s.plate == a), (s.plate == b), (s.vn > lo) & (s.vn < hi))
             for a, b, lo, hi in ((60, 45, 3.7, 4.4), (45, 30, 5.2, 5.9))]
    looks += [(f"drop 4.5 / 2.5 m, plate {a}", s.drop == 4.5, s.drop == 2.5, s.plate == a) for a in (30, 45, 60, 75)]
    looks += [(f"D 0.2 / 0.1 m, plate {a}", s.D == 0.2, s.D == 0.1, s.plate == a) for a in (30, 45, 60, 75)]
    for label, one, two, both in looks:
        i, j = np.flatnonzero(one & both), np.flatnonzero(two & both)
        ratio = [s.kn[rng.choice(i, len(i))].mean() / s.kn[rng.choice(j, len(j))].mean() for _ in range(repeats)]
        en, _ = needed(s, two & both, rng, 1)
        k = en / (C * s.D * s.vn**2 + en)
        print(f"{label:26} n {len(i)}, {len(j)}  v_n {s.vn[i].mean():.2f}, {s.vn[j].mean():.2f}  angle "
              f"{s.angle[i].mean():.0f}, {s.angle[j].mean():.0f}  ratio {s.kn[i].mean() / s.kn[j].mean():.2f} "
              f"{interval(ratio)}  smooth hyperbola {k[i].mean() / k[j].mean():.2f}  "
              + beside([interval(z["kn"][:, i].mean(1) / z["kn"][:, j].mean(1)) for z in laws]))


def turned_slab(s):
    """Mean impact angles are 2-5 degrees flatter than a vertical fall on the plate angle makes them: what if not?"""
    turn = np.zeros_like(s.vn)
    for plate in np.unique(s.plate):
        turn[s.plate == plate] = np.radians(90 - plate - s.angle[s.plate == plate].mean())
    c, t = np.cos(turn), np.sin(turn)
    n_out, t_out = s.kn * s.vn, s.kt * s.vt
    vn, vt, kn, kt = c * s.vn + t * s.vt, c * s.vt - t * s.vn, c * n_out - t * t_out, c * t_out + t * n_out
    kn, kt, angle = kn / vn, kt / vt, np.arctan2(vn, vt)
    x = np.c_[np.ones(len(vn)), np.log(vn), np.log(s.D), np.log(np.sin(angle))]
    print("\n## limestone: the slab turned so that the mean impact angle is 90 deg - plate angle")
    for plate in np.unique(s.plate):
        m = s.plate == plate
        print(f"plate {plate:.0f}  turned by {np.degrees(turn[m][0]):.1f} deg  k_n {s.kn[m].mean():.2f} -> "
              f"{kn[m].mean():.2f}  k_n > 1 {(s.kn[m] > 1).mean():.2f} -> {(kn[m] > 1).mean():.2f}  "
              f"k_t {s.kt[m].mean():.2f} -> {kt[m].mean():.2f}")
    for label, k in (("kn", kn), ("kt", kt)):
        print(f"{label} exponents of v_n, D, sin(angle): " + ", ".join(
            f"{e:+.2f}" for e in np.linalg.lstsq(x, np.log(k), rcond=None)[0][1:]))
    held = rankdata(np.array([s.D, vn]), axis=1).T
    print(f"kn ~ angle | v_n, D {partial(kn, angle, held):+.2f}   kt ~ angle | v_n, D {partial(kt, angle, held):+.2f}")
