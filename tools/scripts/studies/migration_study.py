#!/usr/bin/python3
"""Which ground of Talus is nearest to a soil type of Rockyfor3D? A second. Results: docs/migration.md, "Rockyfor3D".

  tools/scripts/studies/migration_study.py [--diameter 1.0] [--from 1] [--to 15] [--talus build/release/talus]

Normal restitution of Rockyfor3D: k = Rn / (1 + (v/9)^2), v in m/s. Of PIERRE 2: k = En50 / (c D v^2 + En50), c = 0.25.
En50 has the least squares in the speed after the rebound, v k, over v in steps of 0.01 m/s: hard blows count, slow ones hardly.
Residuals of v k [m/s] and of k: root of the mean square, and the largest. At v = 0 the one law is Rn and the other 1, so no En50
makes them equal. With --talus the En50 is compared with the preset of that program.
The second table: theta_scale of a roughness MOH, from the angle at which a sphere meets a step of this height.
"""
import argparse
import math
import subprocess

import numpy as np

C = 0.25
# Mean Rn by soil type. docs/migration.md says which are found in print, and which are from memory.
RN = {1: 0.23, 2: 0.28, 3: 0.33, 4: 0.38, 5: 0.43, 6: 0.53, 7: 0.35}
MEAN_BRACKET = 0.542  # mean of max(0, 0.5 + 0.5 N1): docs/physics.md, "4 Impact"


def rockyfor3d(rn, v):
    return rn / (1 + (v / 9) ** 2)


def pierre(en50, v, diameter):
    return en50 / (C * diameter * v ** 2 + en50)


def fitted(rn, v, diameter):
    """En50 of least squares, by a golden section in its logarithm."""
    after = v * rockyfor3d(rn, v)

    def error(x):
        return np.mean((v * pierre(math.exp(x), v, diameter) - after) ** 2)

    low, high, g = math.log(1e-3), math.log(1e3), (math.sqrt(5) - 1) / 2
    for _ in range(100):
        a, b = high - g * (high - low), low + g * (high - low)
        low, high = (low, b) if error(a) < error(b) else (a, high)
    return math.exp((low + high) / 2)


def presets_of(program):
    """En50 of the presets that a program prints, by name."""
    text = subprocess.run([program, "presets"], check=True, capture_output=True, text=True).stdout
    column = text.splitlines()[0].split().index("En50")
    return {w[0]: float(w[column]) for w in map(str.split, text.splitlines()) if w and w[0].startswith("rockyfor3d-") and len(w) > column
            and w[column].replace(".", "", 1).isdigit()}


def theta_scale(moh, diameter):
    """theta_scale whose mean tan(theta) is the slope at which a sphere meets a step of height MOH."""
    cosine = 1 - moh / (diameter / 2)
    return math.sqrt(1 - cosine ** 2) / cosine / MEAN_BRACKET


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--diameter", type=float, default=1.0)
    parser.add_argument("--from", dest="low", type=float, default=1.0)
    parser.add_argument("--to", dest="high", type=float, default=15.0)
    parser.add_argument("--talus")
    o = parser.parse_args()
    v = np.arange(o.low, o.high + 0.005, 0.01)
    known = presets_of(o.talus) if o.talus else {}
    print(f"D = {o.diameter:g} m, v_n = {o.low:g} to {o.high:g} m/s\n")
    print("type   Rn   En50   preset   v k: rms  largest   k: rms  largest   k at 2, 5, 10 m/s: Rockyfor3D, Talus")
    for soil, rn in RN.items():
        en50 = fitted(rn, v, o.diameter)
        rest = pierre(en50, v, o.diameter) - rockyfor3d(rn, v)
        pairs = "  ".join(f"{rockyfor3d(rn, x):.2f} {pierre(en50, x, o.diameter):.2f}" for x in (2, 5, 10))
        print(f"{soil:4d} {rn:4.2f} {en50:6.2f} {known.get(f'rockyfor3d-{soil}', float('nan')):8.2f} {math.sqrt(np.mean((v * rest) ** 2)):10.2f} "
              f"{abs(v * rest).max():8.2f} {math.sqrt(np.mean(rest ** 2)):8.2f} {abs(rest).max():8.2f}   {pairs}")
    print("\nMOH [m]  theta_scale   Rt of Rockyfor3D (no penetration)")
    for moh in (0.0, 0.01, 0.03, 0.05, 0.1, 0.15, 0.2):
        print(f"{moh:7.2f} {theta_scale(moh, o.diameter):12.2f} {1 / (1 + moh / (o.diameter / 2)):12.2f}")


if __name__ == "__main__":
    main()
