"""Measured single rebounds, and the impact law on their incoming states (for rebound_study.py; docs/rebounds.md).

k_n and k_t are measured against the mean surface. So the whole law is simulated (roughness, shape, slip, step 6 of
docs/physics.md, section 4), and its k_n and k_t are determined as the observer does, errors of the normal included.
"""
from types import SimpleNamespace

import numpy as np

from files import read_table

C = 0.25  # deformation_coefficient
PRESETS = {"firm-talus": (0.7, 0.9, 15, 50, 30, 1.5), "forest-road": (0.4, 0.3, 15, 50, 30, 1.5),
           "quarry-face": (0.65, 0.0, 5, 50, 30, 1.0), "quarry-floor": (0.35, 0.0, 5, 50, 30, 1.0)}
NAMES = ("theta_scale", "psi_scale", "En50", "Et50", "phi_deg", "shape_max")  # of a setting


def columns(path, *names):
    rows = read_table(path)
    return [np.array([float(row[name] or "nan") for row in rows]) for name in names], rows


def derived(s):
    """Speeds and angle against the mean surface; arm = D/2; the smooth law's k are those of this plane."""
    s.vn, s.speed = -np.einsum("ij,ij->i", s.v, s.n), np.linalg.norm(s.v, axis=1)
    s.vt = np.sqrt(s.speed**2 - s.vn**2)
    s.angle = np.degrees(np.arctan2(s.vn, s.vt))
    return s


def read_wang(shared):
    names = "diameter_m plate_angle_deg release_height_m vn_in vt_in vn_out vt_out w_out".split()
    (d, plate, drop, vn, vt, vn_out, vt_out, w_out), _ = columns(
        shared / "data/literature/wang2018_limestone_on_concrete.csv", *names)
    a, zero = np.radians(plate), np.zeros_like(d)  # the slab dips towards +x
    normal, down = np.c_[np.sin(a), zero, np.cos(a)], np.c_[np.cos(a), zero, -np.sin(a)]
    cell = plate * 1000 + drop * 100 + d * 10
    return derived(SimpleNamespace(
        name="limestone", v=vt[:, None] * down - vn[:, None] * normal, w=np.zeros((len(d), 3)), n=normal, D=d,
        plate=plate, drop=drop, kn=vn_out / vn, kt=vt_out / vt, spin=w_out * d / 2 / np.hypot(vn, vt),
        unit=np.arange(len(d)), cell=cell, fold=plate * 1000 + drop * 100, held=drop == 4.5,
        error=1.0, absolute_kt=True))


def read_chant(shared):
    names = "vix viy viz nx ny nz radius_m kn kt w_in w_out usable_n gap_m".split()
    c, rows = columns(shared / "data/chant_sura/contact_events.csv", *names)
    use = c[11] == 1
    v, n = np.array(c[:3]).T[use], np.array(c[3:6]).T[use]
    radius, kn, kt, w_in, w_out, _, gap = [x[use] for x in c[6:]]
    rows = [row for row, keep in zip(rows, use) if keep]
    n /= np.linalg.norm(n, axis=1)[:, None]
    axis = np.cross(n, v)  # of forward rolling: the gyro's axes are the block's, only the magnitude is usable
    w = np.nan_to_num(w_in)[:, None] * axis / np.linalg.norm(axis, axis=1)[:, None]
    unit = np.unique([row["run"] for row in rows], return_inverse=True)[1]
    return derived(SimpleNamespace(
        name="chant-sura", v=v, w=w, n=n, D=2 * radius, kn=kn, kt=kt, spin=w_out * radius / np.linalg.norm(v, axis=1),
        unit=unit, cell=unit, fold=unit, held=np.array([row["role"] == "held_out" for row in rows]), gap=gap, error=3.0,
        absolute_kt=False, w_ratio=w_out / w_in))


def dot(a, b):
    return np.einsum("...i,...i->...", a, b)[..., None]


def unit(a):
    return a / np.linalg.norm(a, axis=-1)[..., None]


def random_draws(rng, m, n):
    """For m draws of n impacts: N1, N2, the uniform of the shape, and two errors of the normal."""
    return np.concatenate([rng.standard_normal((2, m, n)), rng.random((1, m, n)), rng.standard_normal((2, m, n))])


def true_normal(s, draws):
    """The measured normal is the true one plus an error about two axes in the surface [deg, one standard deviation]."""
    first = unit(s.v + s.vn[:, None] * s.n)
    tilt = np.radians(s.error) * draws[3:5, ..., None]
    return unit(s.n + tilt[0] * first + tilt[1] * np.cross(s.n, first))


def rough_planes(s, theta, psi, draws, symmetric=False):
    """Steps 1-2 with `clamp`: the rough and the true smooth normals. `symmetric`: theta of either sign, not the law."""
    n = true_normal(s, draws)
    up = np.array([0.0, 0.0, 1.0])
    heading = np.broadcast_to(unit(s.v * [1, 1, 0]), n.shape)
    left = np.cross(up, heading)
    bracket = 0.5 * draws[0] if symmetric else np.maximum(0, 0.5 + 0.5 * draws[0])
    t = np.arctan(theta * bracket)[..., None]
    along, rise = dot(n, heading), n[..., 2:]
    n1 = (np.cos(t) * along - np.sin(t) * rise) * heading + dot(n, left) * left
    n1 = n1 + (np.cos(t) * rise + np.sin(t) * along) * up
    n2 = unit(n1 + psi * 0.5 * draws[1][..., None] * unit(np.cross(n1, heading)))
    v = np.broadcast_to(s.v, n.shape)
    return np.where(dot(v, n2) < 0, n2, np.where(dot(v, n1) <= 0, n1, n)), n


def normal_restitution(form, p, d, vn, speed):
    if form == "hyperbola":
        return p / (C * d * vn**2 + p)
    if form == "v_half":
        return p / (vn + p)
    if form == "angle":  # p = (k_n at 45 degrees, exponent); Wyllie's exponent is 1.03, his k_n there 0.39, his cap 2
        return np.minimum(2.0, p[0] * (np.degrees(np.arcsin(np.clip(vn / speed, 1e-3, 1))) / 45)**-p[1])
    return p + 0 * vn


def simulate(s, planes, form, p, et50, phi, shape_max, draws):
    """Steps 3-6; returns k_n, k_t, R w / v as the observer measures them, shape (draws, impacts)."""
    rough, smooth = planes
    vn = np.maximum(0, -dot(s.v, rough))
    d, arm = s.D[:, None], s.D[:, None] / 2 * (1 + (shape_max - 1) * draws[2][..., None])
    kn = normal_restitution(form, p, d, vn, s.speed[:, None])
    kt = et50 / (C * d * vn**2 + et50)
    w_n = dot(s.w, rough) * rough
    w_t = s.w - w_n
    v_t = s.v + vn * rough
    slip = kt * (v_t - arm * np.cross(w_t, rough))
    size = np.linalg.norm(slip, axis=-1)[..., None]
    friction = np.minimum(2 / 7, np.tan(np.radians(phi)) * (1 + kn) * vn / np.maximum(size, 1e-12)) * slip
    out = kt * v_t - friction + kn * vn * rough
    spin = kt * w_t + 2.5 / arm * np.cross(rough, friction) + w_n
    out = out - np.minimum(0, dot(out, smooth)) * smooth
    v_n = dot(out, s.n)[..., 0]
    tangent = out - v_n[..., None] * s.n
    first = unit(s.v + s.vn[:, None] * s.n)
    v_t = np.linalg.norm(tangent, axis=-1) if s.absolute_kt else dot(tangent, first)[..., 0]
    return v_n / s.vn, v_t / s.vt, np.linalg.norm(spin, axis=-1) * s.D / 2 / s.speed


def law(s, setting, draws, form="hyperbola", symmetric=False):
    theta, psi, p, et50, phi, shape = setting
    return simulate(s, rough_planes(s, theta, psi, draws, symmetric), form, p, et50, phi, shape, draws)


def resample(s, rng):
    """Bootstrap of what is independent: drops of the slab, runs of Chant Sura."""
    picked = rng.choice(np.unique(s.unit), len(np.unique(s.unit)))
    return np.concatenate([np.flatnonzero(s.unit == u) for u in picked])


def interval(values, share=95):
    low, high = np.nanpercentile(values, ((100 - share) / 2, (100 + share) / 2))
    return f"[{low:.3g}, {high:.3g}]"
