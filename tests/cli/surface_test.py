"""The key and the flag `surface`, from the input to the record, and the warning of dammed cells."""
import json
import os
import re
import unittest

import numpy as np
from osgeo import gdal, ogr

from support import NORTH, WEST, Case, RunCase, box, heights, write_dem, write_features


def gully():
    """A V gully at 45 degrees to the grid, from the north-western corner to the south-eastern one; walls of 45 degrees."""
    row, column = np.mgrid[0:60, 0:60]
    along, across = (row + column) * 5 / np.sqrt(2), np.abs(row - column) * 5 / np.sqrt(2)
    return (1000 - 0.7 * along + across).astype(np.float32)


class Surface(RunCase):
    WARNING = "of the ground steeper than half of its friction angle"

    def setting(self, out):
        return next((s["value"], s["source"]) for s in self.record(out)["settings"] if s["key"] == "surface")

    def test_default_key_and_flag(self):
        self.run_scenario("default")
        self.assertEqual(self.setting("default"), ("creased", "default"))
        self.write("s.toml", 'surface = "bilinear"\n' + self.read_text("s.toml"))
        self.run_scenario("key")
        self.assertEqual(self.setting("key"), ("bilinear", "scenario"))
        self.run_scenario("flag", "--surface", "creased")
        self.assertEqual(self.setting("flag"), ("creased", "flag --surface"))
        self.assertEqual(self.hashes("flag")["stops.gpkg"], self.hashes("default")["stops.gpkg"])
        self.run_well("run", self.path("key/scenario.toml"), "-o", self.path("again"), "-q")  # the complete scenario holds it
        self.assertEqual(self.hashes("again")["stops.gpkg"], self.hashes("key")["stops.gpkg"])
        for command in ("run", "check"):
            out = ["-o", self.path("x")] if command == "run" else []
            self.fails(2, "--surface = 'flat'", "'bilinear' or 'creased'", arguments=[command, self.path("s.toml"), "--surface", "flat", *out])
        self.write("wrong.toml", 'surface = "smooth"\n')
        self.fails(2, "wrong.toml:1", "surface = 'smooth'", "'bilinear' or 'creased'",
                   arguments=["run", self.path("wrong.toml"), "--dem", self.path("dem.tif"), "--sources", self.path("sources.gpkg"), "-o", self.path("x")])

    def test_parts_of_different_surfaces_do_not_merge(self):
        self.run_scenario("one", "--part", "1/2")
        self.run_scenario("two", "--part", "2/2", "--surface", "bilinear")
        self.fails(2, "another plan", arguments=["merge", self.path("m"), self.path("one"), self.path("two")])

    def test_dammed_cells_are_counted(self):
        """A V gully at 45 degrees to the grid: each cell of its thalweg is dammed."""
        write_dem(self.path("dem.tif"), gully())
        for surface, word in (("bilinear", "dams them"), ("creased", "staircases")):
            done = self.run_well("check", self.path("s.toml"), "--surface", surface)
            self.assertRegex(done.stdout, r"(?m)^dammed +58 cells ")
            line = next(line for line in done.stdout.splitlines() if line.startswith("warning") and self.WARNING in line)
            self.assertIn("58 cells of the DEM (1.7 % of", line)  # of 58 x 58: those at the edge have no slope
            self.assertIn(word, line)
        write_dem(self.path("dem.tif"), heights())
        self.assertNotIn(self.WARNING, self.run_well("check", self.path("s.toml")).stdout)

    def test_noise_on_a_plain_gives_no_warning(self):
        """Of nine equal draws the centre is the least of itself and its four sides, but not of all nine: 1/5 - 1/9."""
        z = (1000 + np.random.default_rng(1).normal(0, 0.05, (60, 60))).astype(np.float32)
        write_dem(self.path("dem.tif"), z)
        done = self.run_well("check", self.path("s.toml"))
        dammed = int(re.search(r"(?m)^dammed +(\d+) cells ", done.stdout)[1])
        self.assertAlmostEqual(dammed / 58**2, 1 / 5 - 1 / 9, delta=0.02)
        self.assertEqual([line for line in done.stdout.splitlines() if line.startswith("warning") and "diagonally" in line], [])

    def test_more_plain_around_a_gully_does_not_hide_it(self):
        lines = []
        for plain in (0, 400):
            z = np.full((60, 60 + plain), 2000.0, np.float32)
            z[:, :60] = gully()
            write_dem(self.path("dem.tif"), z)
            lines.append(next(line for line in self.run_well("check", self.path("s.toml")).stdout.splitlines() if self.WARNING in line))
        self.assertRegex(lines[1], r"58 cells of the DEM \(1\.7 % of")

    def test_dams_count_above_half_of_the_friction_angle(self):
        """The thalweg of the gully falls by atan(0.7) = 34.99 degrees: half of 69.98. A zone has its own angle."""
        write_dem(self.path("dem.tif"), gully())
        write_features(self.path("zones.gpkg"), "zones", [(box(0, 150, 150, 150), ["upper"])], [("zone", ogr.OFTString)])
        with open(self.path("s.toml"), encoding="utf-8") as file:
            scenario = file.read()
        for phi, upper, cells in ((69, 69, 58), (71, 71, 0), (69, 71, 29), (71, 69, 29)):
            self.write("s.toml", scenario + f'[ground]\nfile = "zones.gpkg"\nfield = "zone"\n[ground.zones.default]\nphi = {phi}\n'
                       f'[ground.zones.upper]\npreset = "upper-talus-3d"\nphi = {upper}\n')
            said = self.run_well("check", self.path("s.toml")).stdout
            self.assertEqual(f"{cells} cells of the DEM" in said, cells > 0, said)
            self.assertEqual(self.WARNING in said, cells > 0, said)


class OfACampaign(Case):
    def test_a_model_tells_on_which_surface_it_was_fitted(self):
        blocks = "".join(f"b{i},{WEST + 60 + 5 * i},{NORTH - 40},1,{400 + 20 * i}\n" for i in range(20))
        self.write("blocks.csv", "id,x,y,release_height_m,mass_kg\n" + blocks)
        self.write("c.toml", 'dem = "dem.tif"\nblocks = "blocks.csv"\nsurface = "bilinear"\n')
        self.write("m.toml", 'surface = "creased"\n[ground]\ndefault = "upper-talus-3d"\n')
        score = ["score", self.path("c.toml"), "--parameters", self.path("m.toml"), "--trials", "10"]
        done = self.run_well(*score, "--dump", self.path("dump"))
        self.assertIn("fitted on a creased surface", done.stderr)
        self.assertIn("bilinear surface", done.stdout)
        done = self.run_well(*score, "--surface", "creased", "--json", "--dump", self.path("dump2"))
        self.assertNotIn("fitted on", done.stderr)
        self.assertEqual(json.loads(done.stdout)["surface"], "creased")
        self.fails(2, "--surface = 'flat'", arguments=[*score, "--surface", "flat"])
        self.write("s.toml", 'include = "m.toml"\ndem = "dem.tif"\nsurface = "bilinear"\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 1\n')
        self.assertIn("was fitted on a creased surface", self.run_well("check", self.path("s.toml")).stdout)

    def test_a_model_says_so_where_it_is_used_on_cells_of_another_size(self):
        self.write("m.toml", 'fitted_cell = 9\n[ground]\ndefault = "upper-talus-3d"\n')
        self.write("s.toml", 'include = "m.toml"\ndem = "dem.tif"\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 1\n')
        self.assertIn("fitted on cells of 9 m", self.run_well("check", self.path("s.toml")).stdout)
        self.write("m.toml", 'fitted_cell = 5\n[ground]\ndefault = "upper-talus-3d"\n')
        self.assertNotIn("fitted on cells", self.run_well("check", self.path("s.toml")).stdout)
        self.write("m.toml", "fitted_cell = -1\n")
        self.fails(2, "fitted_cell = -1", arguments=["check", self.path("s.toml")])

    def test_a_model_says_so_where_it_is_used_on_other_blocks_or_with_another_c(self):
        model = 'fitted_diameters = [0.4, 1]\n[model]\ndeformation_coefficient = 0.25\n[ground.zones.default]\nEn50 = 7\n'
        text = 'include = "m.toml"\ndem = "dem.tif"\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = {}\n[model]\ndeformation_coefficient = {}\n'
        self.write("m.toml", model)
        for diameter, c, others, changed in ((1, 0.25, False, False), (6, 0.25, True, False), (1, 0.15, False, True),
                                             ("[0.361, 1.099]", 0.25, False, False), (1.11, 0.25, True, False)):
            self.write("s.toml", text.format(diameter, c))
            said = self.run_well("check", self.path("s.toml")).stdout
            self.assertEqual("m.toml (0.4 to 1 m); larger blocks" in said, others, said)
            self.assertEqual("fitted with the deformation coefficient c = 0.25, and this run takes 0.15" in said, changed, said)
        self.write("s.toml", text.format(0.359, 0.25))
        self.assertIn("m.toml (0.4 to 1 m); smaller blocks", self.run_well("check", self.path("s.toml")).stdout)
        self.write("m.toml", "fitted_diameters = [1, 0.4]\n")
        self.fails(2, "fitted_diameters", "[smallest, largest]", arguments=["check", self.path("s.toml")])


class WhatARunKnowsOfTheFit(RunCase):
    def setUp(self):
        super().setUp()
        self.write("s.toml", 'include = "m.toml"\ndem = "dem.tif"\ntrajectories = 3\n[sources]\nfile = "sources.gpkg"\n'
                             "[blocks]\ndiameter = 1\n")

    def test_a_run_says_that_the_fit_of_its_ground_has_no_skill(self):
        for skill, said in (("[-0.097, -0.216, 0.021]", "no skill: -9.7 % (95 %: -21.6 to 2.1 %)"), ("[0]", "no skill: 0.0 %: "),
                            ("[0.05, -0.01, 0.11]", None), ("[0.05]", None)):
            self.write("m.toml", f"fitted_skill = {skill}\n[ground.zones.default]\nEn50 = 7\n")
            self.run_scenario("out", "--overwrite")
            warnings = [w for w in self.record()["warnings"] if "has no skill" in w]
            self.assertEqual(len(warnings), said is not None, warnings)
            hazard = self.run_well("hazard", self.path("out")).stderr  # says it again
            self.assertEqual("has no skill" in hazard, said is not None, hazard)
            self.assertTrue(said is None or said in warnings[0], warnings)
        for wrong in ("0.1", "[0.1, 0.2]", "[0.1, 0.2, 0.3]", '["no"]'):
            self.write("m.toml", f"fitted_skill = {wrong}\n[ground.zones.default]\nEn50 = 7\n")
            self.fails(2, "fitted_skill", arguments=["check", self.path("s.toml")])

    FIT = """surface = "creased"
fitted_cell = 5
fitted_diameters = [0.4, 1]
fitted_skill = [-0.1, -0.3, 0.1]
[model]
deformation_coefficient = 0.15
[ground.zones.default]
preset = "upper-talus-3d"
theta_scale = 1
psi_scale = 0.9
En50 = 15
Et50 = 50
phi = 30
shape = [1, 1.5]
"""  # all numbers are those of the preset, which was fitted to other sizes

    def test_the_scenario_that_a_run_leaves_says_what_the_fit_says(self):
        """Warnings of the same run again, and of one with another c, other cells, blocks or surface."""
        self.write("m.toml", self.FIT)
        self.run_scenario("out")
        self.run_well("run", self.path("out/scenario.toml"), "-o", self.path("again"), "-q")
        for name in os.listdir(self.path("out")):
            if name not in ("run.json", "talus.qgs"):
                self.assertEqual(self.hashes("out")[name], self.hashes("again")[name], name)
        self.assertEqual(self.record("out")["plan"], self.record("again")["plan"])
        model = [entry for entry in self.record("out")["inputs"] if entry["role"] == "include"]
        self.assertEqual([entry for entry in self.record("again")["inputs"] if entry["role"] == "include"], model)
        gdal.Warp(self.path("coarse.tif"), self.path("dem.tif"), xRes=10, yRes=10)
        os.remove(self.path("m.toml"))  # a run that is repeated does not read it
        changes = (((), "no skill: -10.0 % (95 %: -30.0 to 10.0 %)"),
                   (("--deformation-coefficient", "0.25"), "c = 0.15, and this run takes 0.25"),
                   (("--dem", self.path("coarse.tif")), "was fitted on cells of 5 m, and this run is on cells of 10 m"),
                   (("--surface", "bilinear"), "was fitted on a creased surface, and this run is on a bilinear one"),
                   (("--diameter", "3"), "the ground was fitted to others: m.toml (0.4 to 1 m); larger blocks"))
        for flags, words in changes:
            self.run_well("run", self.path("again/scenario.toml"), *flags, "-o", self.path("other"), "-q", "--overwrite")
            warnings = self.record("other")["warnings"]
            for _, one in changes:
                self.assertEqual(sum(one in warning for warning in warnings), one in (words, changes[0][1]), (flags, one, warnings))

    def test_a_ground_is_fitted_if_a_number_of_it_is(self):
        """A model of which the scenario replaces the ground, and one of effects alone, leave the ground that of a preset."""
        everything = "[ground]\ndefault = \"forest-road-3d\"\n"
        for model, own, fitted in ((self.FIT, "", True), (self.FIT, everything, False), ("[model]\nroughness = \"resample\"\n", "", False)):
            self.write("m.toml", model.replace("deformation_coefficient = 0.15\n", "") if fitted or own else model)
            self.write("own.toml", self.read_text("s.toml") + own)
            said = self.run_well("run", self.path("own.toml"), "-o", self.path("out"), "--overwrite").stderr
            self.assertEqual("The ground was fitted, and holds for the c of its fit alone" in said, fitted, said)
            self.assertEqual("Run with --deformation-coefficient 0.15 as well" in said, not fitted, said)
            self.run_well("report", self.path("out"))
            page = self.read_text("out/report.html")
            self.assertEqual("The ground was fitted, and holds" in page, fitted)
            self.assertEqual("Fit of the ground</h2>" in page, fitted)

    def test_what_is_known_of_a_fit_is_no_part_of_the_plan(self):
        """It changes no result: parts and checkpoints of earlier versions fit together with those of this one."""
        plans = set()
        for known in ("", "fitted_cell = 5\n", "fitted_skill = [0.2]\n"):
            self.write("m.toml", known + "[ground.zones.default]\nEn50 = 7\n")
            self.run_scenario("out", "--overwrite")
            plans.add(self.record()["plan"])
        self.assertEqual(len(plans), 1)

    def test_faults_of_what_a_run_leaves_of_a_fit(self):
        self.write("m.toml", self.FIT)
        self.run_scenario("out")
        text = self.read_text("out/scenario.toml")
        for old, new, *words in (("fitted_cell = 5", "fitted_cell = -5", "fit.fitted_cell = -5"), ("file = ", "# file = ", "[fit]: names no file"), ("file = ", "file = 5 # ", "fit.file = 5"),
                                 ('default = ["En50"', 'default = [1, "En50"', "fit.zones.default", "list of keys"),
                                 ('default = ["En50"', 'default = ["nonsense"', "fit.zones.default", "list of keys of a ground"),
                                 ("default = [", "talus = [", "fit.zones.talus", "must be a ground of this scenario: rename it here as in [ground.zones]"),
                                 ("dem = ", 'include = "../m.toml"\ndem = ', "[fit]", "must not come with include")):
            head, tail = text.split("[fit]")
            self.write("out/mine.toml", head.replace(old, new) + "[fit]" + tail if old == "dem = " else head + "[fit]" + tail.replace(old, new, 1))
            self.fails(2, *words, arguments=["check", self.path("out/mine.toml")])


if __name__ == "__main__":
    unittest.main()
