"""The law in tools/scripts/studies/rebound_law.py against the impacts worked by hand; the study without its data says so."""
import csv
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/scripts/studies"))
import rebound_law as rebounds

LEVEL = np.array([[0.0, 0.0, 1.0]])


def one_impact(v, w, n):
    return rebounds.derived(SimpleNamespace(v=np.array([v]), w=np.array([w]), n=n, D=np.array([2.0]), error=0.0,
                                            absolute_kt=False))


class Law(unittest.TestCase):
    def test_impacts_worked_by_hand(self):
        with open(ROOT / "tests/cases/impact.csv", encoding="utf-8") as file:
            cases = list(csv.DictReader(line for line in file if not line.startswith("#")))
        for case in cases:
            v_t, rim, v_n, k_n, k_t, phi, v_out, rim_out, near = [float(case[name]) for name in list(case)[:9]]
            if v_t == 0.0:
                continue  # k_t as observed is not defined
            energy = rebounds.C * 2.0 * v_n**2
            et50 = 1e30 if k_t == 1.0 else k_t / (1.0 - k_t) * energy
            s = one_impact([v_t, 0.0, -v_n], [0.0, -rim, 0.0], LEVEL)
            kn, kt, spin = rebounds.simulate(s, (LEVEL[None], LEVEL[None]), "constant", k_n, et50, phi, 1.0,
                                             np.zeros((5, 1, 1)))
            self.assertAlmostEqual(kn[0, 0], k_n, delta=1e-12, msg=case)
            self.assertAlmostEqual(kt[0, 0] * v_t, v_out, delta=max(near, 1e-11), msg=case)
            self.assertAlmostEqual(spin[0, 0] * s.speed[0], abs(rim_out), delta=max(near, 1e-11), msg=case)

    def test_asperity_lowers_the_slope_of_a_block_moving_down(self):
        slope = np.radians(40.0)
        n = np.array([[np.sin(slope), 0.0, np.cos(slope)]])
        s = one_impact([3.0, 0.0, -8.0], [0.0, 0.0, 0.0], n)
        draws = np.zeros((5, 1, 1))
        draws[0] = 1.0  # 0.5 + 0.5 N1 = 1, so tan(theta) = theta_scale
        rough, smooth = rebounds.rough_planes(s, np.tan(np.radians(25.0)), 0.0, draws)
        self.assertAlmostEqual(np.degrees(np.arctan2(rough[0, 0, 0], rough[0, 0, 2])), 15.0, places=10)
        np.testing.assert_allclose(smooth[0], n, atol=1e-15)


class Study(unittest.TestCase):
    def test_without_data_it_is_skipped_plainly(self):
        with tempfile.TemporaryDirectory() as nothing:
            done = subprocess.run([sys.executable, ROOT / "tools/scripts/studies/rebound_study.py", "--shared", nothing],
                                  capture_output=True, text=True)
        self.assertEqual(done.returncode, 77)
        self.assertIn("no measured data", done.stderr)


if __name__ == "__main__":
    unittest.main()
