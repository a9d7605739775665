"""The picture of rebound_study.py: measured rebounds, and those of the law from the same incoming states."""
import io

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

INKS = {30: "#0b62c4", 45: "#1f7a33", 60: "#b0127b", 75: "#c2570c"}
STYLES = (("the law, fitted", "#20262c", "-"), ("the law, preset", "#8a8f94", "--"),
          ("k_n by angle, symmetric roughness", "#c2570c", "-"))


def against(axes, x, simulated, key, bins):
    """Mean of the simulated k over bins of x, one line for each law."""
    edges = np.quantile(x, np.linspace(0, 1, bins + 1))
    where = [np.flatnonzero((x >= low) & (x <= high)) for low, high in zip(edges, edges[1:])]
    for (label, ink, dash), z in zip(STYLES, simulated):
        axes.plot([x[i].mean() for i in where], [z[key][:, i].mean() for i in where], dash, color=ink, lw=1.6,
                  label=label)


def binned(axes, x, k, bins):
    """Means and 95 % (1000 bootstraps): the field's single values are not ours to publish (WSL Data Policy)."""
    rng, edges = np.random.default_rng(1), np.quantile(x, np.linspace(0, 1, bins + 1))
    for low, high in zip(edges, edges[1:]):
        i = np.flatnonzero((x >= low) & (x <= high))
        ends = np.percentile(k[rng.choice(i, (1000, len(i)))].mean(1), (2.5, 97.5))
        axes.errorbar(x[i].mean(), k[i].mean(), np.abs(ends - k[i].mean())[:, None], fmt="s", color="#0b62c4",
                      capsize=3, label="measured" if low == edges[0] else None)


def slab_points(axes, x, s, key):
    for plate, ink in INKS.items():
        for d, mark in ((0.1, "o"), (0.2, "^")):
            m = (s.plate == plate) & (s.D == d)
            axes.plot(x[m], getattr(s, key)[m], mark, ms=4, mfc="none", color=ink,
                      label=f"slab {plate} deg" if d == 0.1 else None)


def within_cells(axes, s, laws):
    """Deviations of k_n and k_t from the mean of their cell."""
    member = (s.cell[:, None] == np.unique(s.cell)) * 1.0
    centred = lambda k: k - (k @ member / member.sum(0)) @ member.T
    for (label, ink, _), z in list(zip(STYLES, laws))[::-2]:
        axes.plot(centred(z["kn"][:12]).ravel(), centred(z["kt"][:12]).ravel(), ".", ms=2, color=ink, alpha=0.35,
                  label=label)
    for plate, ink in INKS.items():
        m = s.plate == plate
        axes.plot(centred(s.kn)[m], centred(s.kt)[m], "o", ms=4, mfc="white", color=ink)
    axes.set(xlim=(-0.8, 0.8), ylim=(-0.4, 0.4), xlabel="k_n less the mean of its cell",
             ylabel="k_t less the mean of its cell", title="Limestone: within cells (plate, drop, size)")
    axes.legend(fontsize=7, markerscale=4)


def draw_picture(path, data, drawn):
    slab, field = data
    figure, axes = plt.subplots(2, 3, figsize=(12, 7))
    degrees = "impact angle (deg)"
    for a, x, key, label in ((axes[0, 0], slab.vn, "kn", "v_n (m/s)"), (axes[0, 1], slab.angle, "kn", degrees),
                             (axes[0, 2], slab.angle, "kt", degrees)):
        slab_points(a, x, slab, key)
        against(a, x, drawn[0], key, 6)
        a.set(xlabel=label, ylabel=f"{key[0]}_{key[1]} against the slab", ylim=(0, 2.5 if key == "kn" else 1.2))
    axes[0, 0].set_title("Limestone on concrete: k_n against speed")
    axes[0, 1].set_title("... against angle (triangles: D 0.2 m)")
    axes[0, 2].set_title("... k_t against angle")
    axes[0, 0].legend(fontsize=7)
    within_cells(axes[1, 0], slab, drawn[0])
    for a, key in ((axes[1, 1], "kn"), (axes[1, 2], "kt")):
        binned(a, field.vn, getattr(field, key), 3)
        against(a, field.vn, drawn[1], key, 3)
        a.set(xlabel="v_n (m/s)", ylabel=f"{key[0]}_{key[1]} against the DEM's plane",
              ylim=(0, 1.6 if key == "kn" else 1.2), title="Chant Sura, 17 contacts: means, 95 %")
    axes[1, 1].legend(fontsize=7)
    figure.tight_layout()
    raw = io.BytesIO()
    figure.savefig(raw, dpi=100)
    Image.open(raw).convert("RGB").quantize(96).save(path, optimize=True)
