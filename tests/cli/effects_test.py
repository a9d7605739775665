"""Effects in `talus run`: they act in their places, change what they should, and a run can be replayed."""
import json
import math
import unittest

import numpy as np
from osgeo import ogr

from results_test import digests
from support import NORTH, WEST, Case, bands_of, box, rows_of, write_features

HEAD = """dem = "dem.tif"
trajectories = 60
[sources]
file = "sources.gpkg"
[blocks]
diameter = 0.8
axes = [1.5, 1.2, 1.0]
"""


class Effects(Case):
    def run_scenario(self, name, text):
        return self.run_effects(name, HEAD + text)

    def run_effects(self, name, text):
        self.write(name + ".toml", text)
        self.run_well("run", self.path(name + ".toml"), "-o", self.path(name))
        return self.record(name)

    def setting(self, record, key):
        return [s["value"] for s in record["settings"] if s["key"] == key]

    def assert_replays(self, name):
        self.run_well("run", self.path(name + "/scenario.toml"), "-o", self.path(name + "-again"))
        self.assertEqual(digests(self.path(name + "-again")), digests(self.path(name)))

    def test_vegetation_drag_in_a_zone(self):
        write_features(self.path("zones.gpkg"), "zones", [(box(0, 100, 300, 60), ["meadow"])],
                       [("zone", ogr.OFTString)])
        ground = '[ground]\nfile = "zones.gpkg"\n[ground.zones.meadow]\n'
        self.run_scenario("plain", ground)
        record = self.run_scenario("drag", ground + '[effects.vegetation-drag]\ncoefficient = 800\nheight = 30\n'
                                   'zones = ["meadow"]\n')
        self.assertEqual(self.setting(record, "effects.vegetation-drag.coefficient"), [800])
        self.assertEqual(self.setting(record, "effects.vegetation-drag.zones"), ['["meadow"]'])
        plain, drag = (bands_of(self.path(name + "/velocity.tif"))[0] for name in ("plain", "drag"))
        above = slice(13, 27)  # rows from the north: y 165 to 235, above the meadow
        below = slice(38, 41)  # y 95 to 110: the lower part of it
        both = (plain[above] > 0) & (drag[above] > 0)
        np.testing.assert_allclose(drag[above][both], plain[above][both], rtol=0.02)
        mean = [np.mean(v[below][v[below] > 0]) for v in (plain, drag)]
        self.assertLess(mean[1], 0.8 * mean[0])
        self.assert_replays("drag")

    def test_a_flag_gives_the_bits_of_the_scenario(self):
        """--effect, repeated and with semicolons, over [effects] of the file."""
        self.run_scenario("file", '[effects.block-mass]\npreset = "measured"\n[effects.rest-in-roughness]\nkappa = 0.3\n')
        self.write("plain.toml", HEAD + "[effects.rest-in-roughness]\nkappa = 0.1\n")
        self.run_well("run", self.path("plain.toml"), "-o", self.path("flags"), "--effect", "air-drag.coefficient=0",
                      "--effect", "block-mass.preset=measured; rest-in-roughness.kappa=0.3")
        self.assertEqual(*(bands_of(self.path(name + "/energy.tif")).tobytes() for name in ("file", "flags")))
        self.assertEqual(self.setting(self.record("flags"), "effects.rest-in-roughness.kappa"), [0.3])
        self.assert_replays("flags")

    def test_a_flag_that_takes_a_place_away_says_so(self):
        write_features(self.path("stand.gpkg"), "stand", [(box(0, 150, 300, 50), [])])
        self.write("s.toml", HEAD + '[effects.forest-stems]\ndensity = 300\nfile = "stand.gpkg"\n')
        self.write("trees.csv", f"x,y,diameter\n{WEST + 100},{NORTH - 100},0.3\n")
        done = self.run_well("check", self.path("s.toml"), "--effect", "forest-stems.trees=" + self.path("trees.csv") + ";")
        self.assertIn("flag --effect: takes the place of file of [effects.forest-stems]", done.stdout)

    def test_wrong_flags_are_refused(self):
        self.write("s.toml", HEAD)
        for flag, words in (("block-mass", ["must be NAME.KEY=VALUE, for example block-mass.preset=measured"]),
                            ("block-mas.preset=measured", ["unknown key 'block-mas'", "did you mean 'block-mass'"]),
                            ("block-mass.preset=mesured", ["effects.block-mass.preset = 'mesured'", "did you mean 'measured'"]),
                            ("forest-stems.density=99999", ["effects.forest-stems.density = 99999", "0 to 10000"]),
                            ("forest-stems.density=no.tif", ["effects.forest-stems.density = 'no.tif'", "no such file"]),
                            ("air-drag.coefficient=1;air-drag.coefficient=2", ["air-drag.coefficient is given twice"]),
                            ('air-drag.coefficient=1\n[dem]', ["effects.air-drag.coefficient", "must be a number"])):
            self.fails(2, "flag --effect", *words, arguments=["run", self.path("s.toml"), "-o", self.path("none"), "--effect", flag])

    def test_forest_stems_in_polygons(self):
        write_features(self.path("stand.gpkg"), "stand", [(box(0, 150, 300, 50), [])])
        self.run_scenario("plain", "")
        record = self.run_scenario("forest", '[effects.forest-stems]\ndensity = 800\ndiameter = 0.5\nfile = "stand.gpkg"\n')
        self.assertIn("effects.forest-stems", [i["role"] for i in record["inputs"]])

        plain, forest = (bands_of(self.path(name + "/velocity.tif"))[0] for name in ("plain", "forest"))
        above, inside = slice(13, 19), slice(26, 30)  # y 205 to 235; y 150 to 170, the lower part of the stand
        both = (plain[above] > 0) & (forest[above] > 0)
        np.testing.assert_allclose(forest[above][both], plain[above][both], rtol=0.02)
        # Blocks of 724 kg at 10 m/s have 36 kJ, a stem of 0.5 m takes up to 325 kJ: three of four hits stop them.
        # One is met every 1e4 / (800 1.3) = 10 m. The slope is steeper than phi, so stopped blocks start again.
        mean = [np.mean(v[inside][v[inside] > 0]) for v in (plain, forest)]
        self.assertLess(mean[1], 0.75 * mean[0])
        self.assert_replays("forest")
        csv = self.run_well("trace", self.path("forest/scenario.toml"), "--source", "0", "--block", "1").stdout
        self.assertIn(",stem", csv)

    def test_all_others_change_the_run_and_replay(self):
        self.run_scenario("plain", "")
        first = digests(self.path("plain"))["velocity.tif"]
        for name, text in {"shape": "[effects.block-shape]\nlateral = 0.5\nloss = 0.1\n",
                           "mass": "[effects.block-mass]\nroughness = 0.5\n",
                           "wet": "[effects.wet-ground]\nsoftening = 0.8\ndays = [2, 9]\n",
                           "soft": "[effects.soft-ground]\ndrag = 2\n",
                           "rolling": "[effects.rolling-resistance]\ncoefficient = 0.4\n",
                           "air": "[effects.air-drag]\ncoefficient = 1\n",
                           "rest": "[effects.rest-in-roughness]\nkappa = 1\n"}.items():
            with self.subTest(name):
                self.run_scenario(name, text)
                changed = digests(self.path(name))["velocity.tif"] != first
                self.assertEqual(changed, name != "wet")  # the run has no day
        self.write("none.toml", HEAD + "[effects.wet-ground]\nsoftening = 0.8\ndays = []\n")
        self.fails(2, "[effects.wet-ground] has no days, must list those on which it acts", arguments=["check", self.path("none.toml")])
        self.write("day.toml", "day = 9\n" + HEAD + "[effects.wet-ground]\nsoftening = 0.8\ndays = [2, 9]\n")
        self.run_well("run", self.path("day.toml"), "-o", self.path("day"))
        self.assertNotEqual(digests(self.path("day"))["velocity.tif"], first)
        self.assert_replays("day")

    def test_effects_that_cannot_act_are_said(self):
        wet = "[effects.wet-ground]\nsoftening = 1\ndays = [3, 5]\n"
        shape = "[effects.block-shape]\nloss = 0.3\nelongation = 1\n"
        spheres = HEAD.replace("axes = [1.5, 1.2, 1.0]\n", "")
        for text, told, here in ((HEAD + wet, ["wet-ground] acts on days 3, 5, the day of this run is 0"], "does nothing here"),
                                 ("day = 5\n" + HEAD + wet, [], ""), (HEAD + shape, [], ""),
                                 (spheres + shape, ["block-shape] acts on blocks that are no spheres", "axes = [1, 1, 1]"],
                                  "does nothing here"),
                                 (HEAD.replace("1.2", "1.5") + shape, ["axes = [1.5, 1.5, 1]"], "does nothing here"),
                                 ("day = 5\n" + HEAD, ["day = 5 changes nothing: no effect that depends on the day is on"], "")):
            with self.subTest(text):
                self.write("s.toml", text)
                plan = self.run_well("check", self.path("s.toml")).stdout
                self.assertEqual(plan.count("does nothing here"), 1 if here else 0, plan)
                for words in told:
                    self.assertIn(words, plan)

    def test_each_effect_that_acts_is_named(self):
        numbers = {"vegetation-drag": "coefficient = 250", "forest-stems": "density = 450", "air-drag": "coefficient = 1",
                   "block-shape": "lateral = 0.5", "block-mass": "roughness = 0.5", "wet-ground": "softening = 0.8\ndays = [0]",
                   "soft-ground": "drag = 2", "rolling-resistance": "coefficient = 0.4", "fragmentation": "threshold = 200",
                   "rest-in-roughness": "kappa = 0.1"}
        tables = "".join(f"[effects.{name}]\n{text}\n" for name, text in numbers.items())
        self.write("all.toml", HEAD + tables + "[effects]\nallow_both = true\n")
        plan = self.run_well("check", self.path("all.toml")).stdout
        for name, text in numbers.items():
            self.assertIn(f"{name} acts in 3600 of 3600 cells (9 ha): ", plan)
            self.assertIn(text.split("\n", maxsplit=1)[0], plan)
        self.assertNotIn(" acts in ", self.run_well("check", self.write("none.toml", HEAD)).stdout)

    def test_an_effect_that_does_nothing_is_not_said_to_act(self):
        """In the plan, the record and the report: other days, spheres, strength 0 over a file."""
        write_features(self.path("stand.gpkg"), "stand", [(box(0, 150, 300, 50), [])])
        self.write("stand.toml", '[effects.forest-stems]\ndensity = 450\nfile = "stand.gpkg"\n')
        spheres = HEAD.replace("axes = [1.5, 1.2, 1.0]\n", "")
        record = self.run_effects("idle", 'include = "stand.toml"\n' + spheres + "[effects.forest-stems]\ndensity = 0\n"
                                  "[effects.block-shape]\nlateral = 0.5\n[effects.wet-ground]\nsoftening = 1\ndays = [5]\n"
                                  "[effects.soft-ground]\ndrag = 2\nfile = \"stand.gpkg\"\n")
        self.assertEqual(record["effects"], [{"name": "soft-ground", "cells": 600}])  # 60 x 10 cells
        self.assertEqual([note for note in record["notes"] if " acts in " in note],
                         ["soft-ground acts in 600 of 3600 cells (1.5 ha): drag = 2, stiffness = 15 MN/m2, scar_length = 1.5 m"])
        self.run_well("report", self.path("idle"))
        page = self.read_text("idle/report.html")
        self.assertIn("acting: soft-ground; given, but does nothing here: forest-stems, block-shape, wet-ground; off: ", page)
        self.assertIn("Further effects: soft-ground. Given, but does nothing here: forest-stems, block-shape, wet-ground.", page)

    def test_what_rests_on_a_forest_says_so(self):
        write_features(self.path("sources.gpkg"), "sources", [(box(140, 230, 20, 10), ["cliff", 0.5])],
                       [("name", ogr.OFTString), ("frequency", ogr.OFTReal)])
        write_features(self.path("lines.gpkg"), "lines", [(f"LINESTRING ({WEST} {NORTH - 150},{WEST + 300} {NORTH - 150})", ["road"])],
                       [("id", ogr.OFTString)])
        screens = '[screens]\nfile = "lines.gpkg"\n'
        for name, text in {"forest-stems": "[effects.forest-stems]\ndensity = 100\n",
                           "vegetation-drag": "[effects.vegetation-drag]\ncoefficient = 50\n",
                           "none": "[effects.soft-ground]\ndrag = 1\n"}.items():
            with self.subTest(name):
                self.run_effects(name, HEAD + screens + text)
                note = f"forest or other vegetation stood in the run ({name}): the figures here hold only while it stands"
                hazard = self.run_well("hazard", self.path(name)).stderr
                design = self.run_well("barrier", self.path(name), "--screen", "road").stdout
                self.run_well("report", self.path(name))
                page = self.read_text(name + "/report.html")
                if name == "none":
                    self.assertNotIn("vegetation stood", hazard + design + page)
                    self.assertNotIn("<td>Forest</td>", page)
                    continue
                self.assertIn("warning: " + note, hazard)
                self.assertIn("note: " + note, design)
                self.assertIn(f"<td>Forest</td><td class='b'>forest or other vegetation stood in the run ({name})</td>", page)

    def test_drag_that_holds_small_blocks_in_the_air_is_said(self):
        """c/m above 4 1/s; a block of 0.8 m and 2700 kg/m3 has m = 2700 pi/6 0.8^3 kg."""
        limit = 4 * 2700 * math.pi / 6 * 0.8 ** 3
        for coefficient, said in ((0.99 * limit, False), (1.01 * limit, True)):
            self.write("s.toml", HEAD + f"[effects.vegetation-drag]\ncoefficient = {coefficient}\n")
            plan = self.run_well("check", self.path("s.toml")).stdout
            self.assertEqual("[effects.vegetation-drag] holds small blocks in the air: the smallest, of 0.8 m" in plan, said, plan)
        self.write("s.toml", HEAD + "[effects.vegetation-drag]\ncoefficient = 400\n[effects.fragmentation]\nthreshold = 2\n")
        self.assertIn("holds pieces of broken blocks in the air: above c/m = 4 1/s, here below 0.41 m",  # cbrt(6 400 / (4 2700 pi))
                      self.run_well("check", self.path("s.toml")).stdout)

    def test_a_preset_of_the_2d_model_in_a_map_is_said(self):
        """Its psi_scale is 0: nothing turns the blocks sideways."""
        for preset, psi, count in (("firm-talus-2d", "", 1), ("firm-talus-2d", "psi_scale = 0.5\n", 0), ("upper-talus-3d", "", 0),
                                   ("rockyfor3d-0", "", 0)):
            self.write("s.toml", f'{HEAD}[ground.zones.default]\npreset = "{preset}"\n{psi}')
            plan = self.run_well("check", self.path("s.toml")).stdout
            self.assertEqual(plan.count(f"ground 'default' ({preset}): the preset is of the 2D model"), count, plan)

    def test_a_preset_gives_the_bits_of_its_numbers(self):
        record = self.run_scenario("named", '[effects.block-mass]\npreset = "measured"\n')
        own = [s for s in record["settings"] if s["key"].startswith("effects.block-mass.")]
        self.assertTrue(all(s["source"].startswith("preset measured: ") for s in own), own)
        numbers = "".join(f"{s['key'].rsplit('.', 1)[1]} = {s['value']}\n" for s in own)
        self.run_scenario("numbers", "[effects.block-mass]\n" + numbers)
        self.assertEqual(digests(self.path("named")), digests(self.path("numbers")))
        self.run_scenario("plain", "")
        self.assertNotEqual(digests(self.path("named"))["velocity.tif"], digests(self.path("plain"))["velocity.tif"])
        self.assert_replays("named")

    def sizes(self, diameter, *arguments):
        """The warnings about sizes on stderr and in the record, of a run of one diameter."""
        done = self.run_well(*self.arguments("sizes", str(diameter), "5"), "--overwrite", *arguments)
        told = [line for line in done.stderr.splitlines() if line.startswith("talus: warning: block sizes: ")]
        recorded = [w for w in self.record("sizes")["warnings"] if w.startswith("block sizes: ")]
        self.assertEqual([line.removeprefix("talus: warning: ") for line in told], recorded)
        return recorded

    def test_sizes_outside_those_of_the_preset(self):
        self.assertEqual(self.sizes(1.2), [])
        (told,) = self.sizes(0.3)
        self.assertIn("0.3 m", told)
        self.assertIn("upper-talus-3d (1 to 1.4 m)", told)
        self.assertIn("smaller blocks: at both measured sites they went farther", told)
        self.assertNotIn("unsafe", told)
        (told,) = self.sizes(3)
        self.assertIn("larger blocks: run-out and speed too low (unsafe)", told)
        self.assertNotIn("smaller blocks", told)
        self.assertEqual(len(self.sizes(3, "--preset", "quarry-floor-2d")), 1)
        plan = self.run_well("check", "--dem", self.path("dem.tif"), "--sources", self.path("sources.gpkg"), "--diameter", "0.3").stdout
        self.assertEqual(plan.count("block sizes: "), 1)

    def test_the_measured_size_law_outside_its_sizes(self):
        """Fitted to blocks of 0.3 to 1.1 m; at its reference diameter, 1.2 m, it changes nothing."""
        for diameter, said in ((0.25, True), (0.4, False), (1.2, False), (1.3, True), (3, True)):
            text = HEAD.replace("diameter = 0.8", f"diameter = {diameter}").replace("60", "2")
            self.write("m.toml", text + '[effects.block-mass]\npreset = "measured"\n')
            plan = self.run_well("check", self.path("m.toml")).stdout
            self.assertEqual("fitted to 0.3 to 1.1 m: here it is an extrapolation" in plan, said, plan)

    def test_blocks_that_are_held_at_their_source(self):
        wrong, held = "sorts them the wrong way", "came to rest within two diameters of their release"
        four = HEAD.replace("diameter = 0.8", "diameter = 4")
        for kappa, mass in ((0, False), (0.3, False), (0.3, True)):
            rest = f"[effects.rest-in-roughness]\nkappa = {kappa}\n" if kappa else ""
            self.write("rest.toml", four + rest + ('[effects.block-mass]\npreset = "measured"\n' if mass else ""))
            done = self.run_well("run", self.path("rest.toml"), "-o", self.path("rest"), "--overwrite")
            rows = rows_of(self.path("rest/stops.gpkg"), "stops")
            near = sum(np.hypot(g.GetX() - f["x_release"], g.GetY() - f["y_release"]) <= 8.0 and
                       f["end"] in ("stopped", "trapped") for f, g in rows)
            self.assertEqual(f"({near}) {held}" in done.stderr, near > 0.03 * len(rows), done.stderr)
            self.assertEqual(held in done.stderr, kappa > 0, done.stderr)
            self.assertEqual(wrong in done.stderr, kappa > 0 and not mass, done.stderr)
            plan = self.run_well("check", self.path("rest.toml")).stdout
            self.assertEqual(held in plan, held in done.stderr, plan)
            self.assertEqual(wrong in plan, wrong in done.stderr, plan)

    def test_broken_blocks_count_once_and_stops_hold_the_largest_piece(self):
        self.run_scenario("plain", "")
        record = self.run_scenario("broken", "[effects.fragmentation]\nthreshold = 20\nlargest = 0.7\n")
        self.assertGreater(record["pieces"], 100)
        self.assertEqual(bands_of(self.path("broken/impacts.tif")).sum(), record["impacts"])
        self.assertLessEqual(bands_of(self.path("broken/impact_probability.tif"))[0].max(), 1.0)
        mass = [sum(s["mass_kg"] for s, _ in rows_of(self.path(name + "/stops.gpkg"), "stops"))
                for name in ("plain", "broken")]
        self.assertLess(mass[1], 0.9 * mass[0])
        self.assert_replays("broken")

    def test_a_stand_is_counted_once(self):
        both = ("[effects.vegetation-drag]\ncoefficient = 100\n[effects.forest-stems]\ndensity = 100\n"
                'file = "stand.gpkg"\n')
        write_features(self.path("stand.gpkg"), "stand", [(box(0, 150, 300, 50), [])])
        self.write("both.toml", HEAD + both)
        self.fails(2, "vegetation-drag and forest-stems act at the same place", "allow_both = true",
                   arguments=["run", self.path("both.toml"), "-o", self.path("both")])
        self.run_scenario("allowed", "[effects]\nallow_both = true\n" + both)
        self.assert_replays("allowed")

    def test_faults_name_what_is_meant(self):
        for text, words in {
                "[effects.soft-grund]\ndrag = 1\n": ["unknown key 'soft-grund' in [effects]", "'soft-ground'"],
                "[effects.soft-ground]\ndrags = 1\n": ["unknown key 'drags'", "'drag'"],
                "[effects.soft-ground]\ndrag = -1\n": ["effects.soft-ground.drag = -1: must be 0 to 50"],
                "[effects.soft-ground]\nstiffness = 9\n": ["does nothing, must give drag"],
                "[effects.wet-ground]\ndrag = 1\n": ["has no days"],
                '[effects.soft-ground]\ndrag = 1\nzones = ["moor"]\n': ["there is no zone 'moor'", "default"],
                '[effects.soft-ground]\ndrag = 1\nfile = "no.gpkg"\n': ["effects.soft-ground.file", "no such file"],
                '[effects.block-mass]\npreset = "mesured"\n': ["unknown preset 'mesured' of block-mass", "'measured'"],
                "[effects.block-mass]\nreference_diameter = 2\n": ["must give roughness or stiffness, or preset"],
                '[effects.air-drag]\ncoefficient = 1\nzones = ["default"]\n': ["unknown key 'zones'"],
                "[screens]\n": ["[screens] names no file, must have file"],
        }.items():
            with self.subTest(text):
                self.write("s.toml", HEAD + text)
                self.fails(2, "s.toml:", *words, arguments=["run", self.path("s.toml"), "-o", self.path("out")])


if __name__ == "__main__":
    unittest.main()
