"""Rasters of a run beside its probabilities: where blocks start, the energy with rotation, bounds; the energy line of stops."""
import math
import os
import unittest

import numpy as np
from osgeo import ogr

from support import NORTH, WEST, Case, band_names, bands_of, heights, rows_of, write_dem, write_features


class Release(Case):
    def test_is_what_was_drawn(self):
        self.run_well(*self.arguments())
        released = bands_of(self.path("out/release.tif"))
        self.assertEqual(released.sum(), 400)
        rows, columns = np.nonzero(released)  # the box of setUp: 140 to 160 m east, 230 to 240 m north of the corner
        self.assertEqual(sorted(set(columns)), [28, 29, 30, 31])
        self.assertEqual(sorted(set(rows)), [12, 13])
        self.assertEqual(set(released[released > 0]), {50})
        self.assertTrue((bands_of(self.path("out/passages.tif")) >= released).all())


class EnergyLine(Case):
    def test_is_that_of_release_and_stop(self):
        # Points at centres of cells: the release is the height of the cell and the drop of 2 m above it.
        z = heights()
        points = [(f"POINT ({WEST + 152.5} {NORTH - 62.5})", [2.0]), (f"POINT ({WEST + 202.5} {NORTH - 82.5})", [2.0])]
        write_features(self.path("points.gpkg"), "points", points, [("release_height", ogr.OFTReal)])
        done = self.run_well("run", "--dem", self.path("dem.tif"), "--sources", self.path("points.gpkg"), "--diameter", "1",
                             "--trajectories", "300", "-o", self.path("out"))
        angles, far = [], []
        for stop, point in rows_of(self.path("out/stops.gpkg"), "stops"):
            column, row = int((stop["x_release"] - WEST) // 5), int((NORTH - stop["y_release"]) // 5)
            drop = float(z[row, column]) + 2.0 - stop["z"]
            plan = math.hypot(point.GetX() - stop["x_release"], point.GetY() - stop["y_release"])
            angle = math.degrees(math.atan2(drop, plan))
            self.assertAlmostEqual(stop["energy_line_deg"], angle, delta=0.01)
            if stop["end"] in ("stopped", "trapped"):
                angles.append(stop["energy_line_deg"])
                if plan > 100.0:
                    far.append(stop["energy_line_deg"])
        self.assertGreater(len(far), 0.05 * len(angles))  # so that these alone count
        angles = sorted(far)
        said = self.record()["energy_line_deg"]
        self.assertEqual(said["stops"], len(angles))
        self.assertGreater(len(angles), 100)
        self.assertEqual(said["farther_than_m"], 100)
        for key, rank in (("least", 1), ("p5", math.ceil(0.05 * len(angles))), ("p50", math.ceil(0.5 * len(angles)))):
            self.assertAlmostEqual(said[key], angles[rank - 1], delta=0.006)
        self.assertIn(f"5 % below {said['p5']:.1f} deg, least {said['least']:.1f} deg", done.stderr)


class Bounds(Case):
    def test_of_reach_and_exceedance(self):
        self.run_well(*self.arguments())
        names = band_names(self.path("out/energy_exceedance.tif"))
        self.assertEqual(names[:3], ["P(E > 30 kJ)", "P(E > 300 kJ)", "P(E > 30 kJ) lower 95 % bound"])
        exceedance, reach = bands_of(self.path("out/energy_exceedance.tif")), bands_of(self.path("out/reach_probability.tif"))
        impact, passages = bands_of(self.path("out/impact_probability.tif")), bands_of(self.path("out/passages.tif"))
        for value, low, high in ((exceedance[0], exceedance[2], exceedance[3]), (exceedance[1], exceedance[4], exceedance[5]),
                                 tuple(reach)):
            self.assertTrue(((low <= value) & (value <= high)).all())
            self.assertTrue((high[passages > 0] > value[passages > 0])[value[passages > 0] < 1].all())
        # The same counts have the same bounds: of 400 trajectories, in both rasters.
        for hits in np.unique(passages):
            same = np.isclose(exceedance[0] * 400, hits)
            if same.any():
                np.testing.assert_array_equal(exceedance[3][same], impact[2][passages == hits][0])
                np.testing.assert_array_equal(exceedance[2][same], impact[1][passages == hits][0])

    def test_of_percentiles_on_request(self):
        self.run_well(*self.arguments("plain", trajectories="400"))
        self.assertFalse(os.path.exists(self.path("plain/energy_bounds.tif")))
        self.run_well(*self.arguments(trajectories="400"), "--bounds")
        passages = bands_of(self.path("out/passages.tif"))
        for name in ("energy", "velocity", "jump_height"):
            self.assertEqual(band_names(self.path(f"out/{name}_bounds.tif"))[2:4], ["P95 lower 95 % bound", "P95 upper 95 % bound"])
            values, bounds = bands_of(self.path(f"out/{name}.tif")), bands_of(self.path(f"out/{name}_bounds.tif"))
            with open(self.path(f"plain/{name}.tif"), "rb") as plain, open(self.path(f"out/{name}.tif"), "rb") as with_bounds:
                self.assertEqual(plain.read(), with_bounds.read())
            for i, (fewest_low, fewest_high) in enumerate(((6, 6), (2, 72), (1, 368))):
                low, high = bounds[2 * i], bounds[2 * i + 1]
                np.testing.assert_array_equal(low != -9999, passages >= fewest_low)
                np.testing.assert_array_equal(high != -9999, passages >= fewest_high)
                self.assertTrue((low <= values[i + 1])[low != -9999].all())
                self.assertTrue((high >= values[i + 1])[high != -9999].all())


class EnergyTotal(Case):
    def test_is_that_of_the_crossings_of_a_screen_between_two_rows_of_cells(self):
        # Below a cliff of 300 m blocks that have bounced, and spin, cross the screen in free fall: in the cell above the
        # screen each has its largest energy on the screen.
        z = heights()
        z[23:] -= 300.0
        write_dem(self.path("dem.tif"), z)
        y = NORTH - 130.0  # between rows 25 and 26
        write_features(self.path("screens.gpkg"), "screens", [(f"LINESTRING ({WEST} {y},{WEST + 300} {y})", ["line"])],
                       [("id", ogr.OFTString)])
        points = [(f"POINT ({WEST + 12.5 + 10 * i} {NORTH - 22.5})", []) for i in range(28)]
        write_features(self.path("points.gpkg"), "points", points)
        self.write("s.toml", 'dem = "dem.tif"\ntrajectories = 1\n[sources]\nfile = "points.gpkg"\n[blocks]\ndiameter = 1.1\n'
                             '[screens]\nfile = "screens.gpkg"\n[output]\nenergy_total = true\n')
        self.run_well("run", self.path("s.toml"), "-o", self.path("out"))
        total, energy = (bands_of(self.path(f"out/{name}.tif"))[4] for name in ("energy_total", "energy"))
        passages, compared, spinning = bands_of(self.path("out/passages.tif")), 0, 0
        for row in self.read_table("out/screens.csv"):
            column = int((float(row["x"]) - WEST) // 5)
            if passages[25, column] != 1 or float(row["jump_height_m"]) < 50.0:  # others have met the floor before
                continue
            self.assertAlmostEqual(total[25, column] / float(row["total_energy_kj"]), 1.0, delta=1e-5)
            self.assertAlmostEqual(energy[25, column] / float(row["energy_kj"]), 1.0, delta=1e-5)
            self.assertGreater(total[26, column], float(row["total_energy_kj"]))
            compared += 1
            spinning += float(row["total_energy_kj"]) > float(row["energy_kj"]) + 1.0
        self.assertGreater(compared, 15)
        self.assertGreater(spinning, compared / 2)  # otherwise this says nothing of the rotation

    def test_is_never_below_the_translational_energy(self):
        self.run_well(*self.arguments(), "--energy-total")
        total, energy = bands_of(self.path("out/energy_total.tif")), bands_of(self.path("out/energy.tif"))
        self.assertTrue((total >= energy).all())
        self.assertTrue((total[4] <= 2.0 * energy[4].max()).all())
        self.assertGreater((total > 1.02 * energy)[:, energy[4] > 0].mean(), 0.5)
        self.assertFalse(os.path.exists(self.path("out/energy_bounds.tif")))

    def test_wrong_keys(self):
        for key in ("energy_total", "bounds"):
            self.write("s.toml", f'dem = "dem.tif"\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 1\n[output]\n{key} = 1\n')
            self.fails(2, "s.toml:7", f"output.{key}", "must be true or false",
                       arguments=["run", self.path("s.toml"), "-o", self.path("x")])


if __name__ == "__main__":
    unittest.main()
