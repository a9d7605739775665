"""Barriers: their design from the crossings of a run, and their effect on the blocks of a run."""
import itertools
import json
import math
import os
import pathlib
import re
import resource
import unittest
from collections import Counter

import numpy as np
from osgeo import ogr

from support import NORTH, WEST, Case, box, heights, write_dem, write_features

SOUTH = NORTH - 300.0
HEADER = ("source,block,screen,speed_ms,energy_kj,total_energy_kj,jump_height_m,angular_velocity_rads,mass_kg,x,y")


def line(y, left=20.0, right=280.0):
    return f"LINESTRING ({WEST + left} {SOUTH + y},{WEST + right} {SOUTH + y})"


class Design(Case):
    """A folder of results by hand: run.json and screens.csv alone."""

    def setUp(self):
        super().setUp()
        os.mkdir(self.path("out"))
        screens = [{"id": name, "lines": [[[WEST, SOUTH], [WEST + 100.0, SOUTH]]]} for name in ("road", "fe/nce", "low")]
        self.write("out/run.json", json.dumps({
            "released": 1000, "screens": screens, "inputs": [], "effects": [],
            "grid": {"columns": 60, "rows": 60, "cell_x_m": 5.0, "cell_y_m": 5.0, "west": WEST, "north": NORTH, "crs_wkt": ""},
            "settings": [{"key": "blocks.density", "value": 2500, "unit": "kg/m3", "source": "scenario"}]}))
        self.rows = [(0, i, "road", 5.0 + 0.1 * i, 0.01 * (i + 1), 3000.0 if i < 100 else 5000.0, 10.0 + 0.2 * i)
                     for i in range(101)]
        self.rows += [(0, i, "low", 5.0 + i, 1.0 + i, 3000.0, 1.0) for i in range(19)]
        self.save()

    def save(self, extra=()):
        text = HEADER + "\n"
        for source, block, screen, speed, jump, mass, place in [*self.rows, *extra]:
            energy = 0.5e-3 * mass * speed**2
            text += f"{source},{block},{screen},{speed},{energy},{energy},{jump},3,{mass},{WEST + place},{SOUTH}\n"
        self.write("out/screens.csv", text)

    def design(self, *arguments):
        done = self.run_well("barrier", self.path("out"), "--screen", "road", *arguments)
        report = self.read_json("out/barrier_road.json")
        return {row["name"]: row["value"] for row in report["design"]}, report, done.stdout

    def test_the_only_screen_need_not_be_named(self):
        self.fails(2, "--screen: must say at which of the screens of the run the barrier stands: road, fe/nce, low",
                   arguments=["barrier", self.path("out")])
        with open(self.path("out/run.json"), encoding="utf-8") as file:
            record = json.load(file)
        self.write("out/run.json", json.dumps(record | {"screens": record["screens"][:1]}))
        self.assertIn("screen road: 101 blocks cross it", self.run_well("barrier", self.path("out")).stdout)
        self.write("out/run.json", json.dumps(record | {"screens": []}))
        self.fails(2, "the run kept no crossings", arguments=["barrier", self.path("out")])

    def test_by_hand(self):
        values, report, text = self.design("--gTr", "1.02", "--gVol", "1.02")
        # v95 = 14.5, times 1.02 * 1.10; the largest block has 5000 kg: 2 m3; h95 = 0.96
        self.assertAlmostEqual(values["v95"], 14.5, 9)
        self.assertAlmostEqual(values["v_d"], 14.5 * 1.122, 9)
        self.assertAlmostEqual(values["V"], 2.0, 9)
        self.assertAlmostEqual(values["m_d"], 5100.0, 9)
        self.assertAlmostEqual(values["E_d"], 0.5e-3 * 5100.0 * (14.5 * 1.122)**2, 9)
        self.assertAlmostEqual(values["SEL"], values["E_d"], 9)
        self.assertAlmostEqual(values["MEL"], 1.3 * values["E_d"], 9)
        self.assertAlmostEqual(values["f_min"], 0.5 * (12.0 / math.pi)**(1.0 / 3.0), 9)
        self.assertAlmostEqual(values["h_i"], 0.96 * 1.122 + values["f_min"], 9)
        self.assertAlmostEqual(values["h_top"], 0.96 * 1.122 + 2.0 * values["f_min"], 9)
        # 101 crossings over 20 m: 100 of them (99 %) are 19.8 m wide; 25 a bin of 5 m, more than 1 % of 1000
        width = report["containment"]
        self.assertAlmostEqual(width["shortest"]["width_m"], 19.8, 6)
        self.assertEqual((width["by_impact_probability"]["from_m"], width["by_impact_probability"]["to_m"]), (10, 30))
        self.assertEqual([r["quantity"] for r in report["reliability"]], ["jump height", "centre height", "speed", "energy"])
        self.assertIn("h_i", text)
        rows = {row["name"]: row for row in self.read_table("out/barrier_road.csv")}
        self.assertAlmostEqual(float(rows["h_i"]["value"]), values["h_i"], 4)
        self.assertEqual(float(rows["h_i"]["share"]), 0.0)
        for quantity, name, agrees in (("jump height", "h_i", False), ("energy", "SEL", True)):  # with a Weibull law
            (fit,) = [r for r in report["reliability"] if r["quantity"] == quantity]
            self.assertEqual((fit["agrees"], rows[name]["weibull"] != ""), (agrees, agrees), quantity)
        self.assertEqual(text.count(" of the law, "), 2)  # SEL and MEL

    def test_centres_above_the_net(self):
        """Of 101 blocks the last two jump 1.9 and 2.1 m, below h_i: the centre of the larger one passes above it."""
        self.rows = [*self.rows[:99], (0, 99, "road", 10.0, 1.1, 3000.0, 20.0), (0, 100, "road", 10.0, 1.3, 5000.0, 20.0), *self.rows[101:]]
        self.save()
        values, report, _ = self.design()
        jump, centre = ({r["quantity"]: r["exceeded"][0] for r in report["reliability"]}[name] for name in ("jump height", "centre height"))
        radius = [0.5 * (6.0 / math.pi * mass / 2500.0)**(1.0 / 3.0) for mass in (3000.0, 5000.0)]
        self.assertTrue(1.1 + radius[0] < values["h_i"] < 1.3 + radius[1] and 1.3 < values["h_i"], values)
        self.assertEqual((centre["name"], centre["value"], jump["share"]), ("h_i", values["h_i"], 0.0))
        self.assertAlmostEqual(centre["share"], 1.0 / 101.0, 12)

    def test_stretches(self):
        """The line of 100 m in four of 25 m; the blocks cross from 10 to 30 m, the heaviest in the second."""
        _, report, text = self.design("--stretch", "30")
        rows = report["stretches"]
        self.assertEqual([(r["from_m"], r["to_m"]) for r in rows], [(0, 25), (25, 50), (50, 75), (75, 100)])
        self.assertEqual([r["crossings"] for r in rows], [75, 26, 0, 0])
        self.assertAlmostEqual(sum(r["share"] for r in rows), 1.0, 12)
        # the first: speeds 5.0 to 12.4, 3000 kg at 2500 kg/m3; the second: 12.5 to 15.0, 5000 kg
        for row, speed, volume, height in ((rows[0], 5 + 0.1 * 0.95 * 74, 1.2, 0.01 * (1 + 0.95 * 74)),
                                           (rows[1], 12.5 + 0.1 * 0.95 * 25, 2.0, 0.01 * (76 + 0.95 * 25))):
            design = row["design"]
            mass = volume * 2500 * 1.1
            self.assertAlmostEqual(design["volume_m3"], volume, 9)
            self.assertAlmostEqual(design["sel_kj"], 0.5e-3 * mass * (speed * 1.21)**2, 9)
            self.assertAlmostEqual(design["h_i_m"], height * 1.21 + 0.5 * (6 * volume / math.pi)**(1 / 3), 9)
        self.assertAlmostEqual(rows[1]["largest_energy_kj"], 0.5e-3 * 5000 * 15.0**2, 6)
        self.assertIsNone(rows[2]["design"])
        self.assertIn("nothing crosses the other 2 stretches", text)
        (note,) = [note for note in report["notes"] if note.startswith("one design for the whole line is too low: ")]
        self.assertEqual(note.count(" on 25.0-50.0 m, which"), 2, note)  # SEL and h_i
        self.assertIn("alike: the run has no annual frequencies", report["weighting"])
        self.assertIsNone(report["crossings_per_year"])
        table = self.read_table("out/barrier_road_stretches.csv")
        self.assertEqual([row["crossings"] for row in table], ["75", "26", "0", "0"])
        self.assertEqual(table[2]["sel_kj"], "")
        self.assertAlmostEqual(float(table[1]["h_i_m"]), rows[1]["design"]["h_i_m"], 4)
        few = self.design("--stretch", "10")[1]["stretches"]
        self.assertEqual(sum(row["crossings"] for row in few), 101)
        self.refused("--stretch = 0.5", arguments=["--screen", "road", "--stretch", "0.5"])

    def test_a_leg_that_blocks_cross_after_another_is_not_empty(self):
        """Each of the 101 blocks crosses 60 m farther along the line again, 10 m/s faster: a hairpin."""
        again = [(s, i, name, v + 10.0, h, m, at + 60.0) for s, i, name, v, h, m, at in self.rows if name == "road"]
        values, report, text = self.design("--stretch", "20")
        self.save(again)
        after, with_again, said = self.design("--stretch", "20")
        self.assertEqual(values, after)  # the whole line is by first crossings
        first, later = ([s for s in r["stretches"] if s["crossings"] > 0] for r in (report, with_again))
        self.assertEqual(first, [{**s, "share": s["share"] * 2} for s in later[:len(first)]])
        self.assertEqual([s["crossings"] for s in later[len(first):]], [s["crossings"] for s in first])
        self.assertEqual([round(s["from_m"] - f["from_m"]) for s, f in zip(later[len(first):], first)], [60] * len(first))
        self.assertGreater(later[-1]["largest_energy_kj"], 2.0 * first[-1]["largest_energy_kj"])
        self.assertNotIn("crossed the line before", text)
        self.assertIn("101 crossings on stretches are of blocks that crossed the line before", said)

    def test_the_note_names_what_is_too_low_and_never_advises_less_than_the_whole_line(self):
        """75 fast blocks with low jumps up to 25 m, 26 slow ones with high jumps beyond: only h_i of the line is too low."""
        self.rows = [(0, i, "road", 10.0, 0.1, 3000.0, 10.0 + 0.2 * i) for i in range(75)]
        self.rows += [(0, 75 + i, "road", 5.0, 0.5 + 0.1 * i, 3000.0, 25.0 + 0.2 * i) for i in range(26)]
        self.save()
        _, report, _ = self.design()
        (note,) = [note for note in report["notes"] if note.startswith("one design")]
        freeboard = 0.5 * (6 * 1.2 / math.pi)**(1 / 3)
        whole = f"{2.5 * 1.21 + freeboard:.4g}"            # the 95th of 101 values: 2.5 m
        highest = f"{2.875 * 1.21 + freeboard:.3g}"        # of the 26: 0.5 + 0.1 x 0.95 x 25
        sel = f"{0.5e-3 * 1.2 * 2500 * 1.1 * 12.1**2:.4g}"  # of the whole line: the slow stretch needs a quarter of it
        self.assertEqual(note, f"one design for the whole line is too low: h_i ({whole} m) on 25.0-50.0 m, which need up to {highest} m."
                         f" Give each stretch its own design, or the whole line SEL {sel} kJ and h_i {highest} m")

    def test_what_is_too_rare_for_a_design_is_said_where_it_exceeds_that_of_the_line(self):
        """Beyond 25 m come 5 blocks, one of them 30 m high, one of 3000 kg x (40 m/s)^2 / 2 = 2400 kJ."""
        self.rows = [(0, i, "road", 10.0, 0.1, 3000.0, 10.0 + 0.1 * i) for i in range(101)]
        self.save()
        self.assertFalse([n for n in self.design()[1]["notes"] if "too few crossings for a design" in n])
        self.rows += [(0, 101, "road", 10.0, 30.0, 3000.0, 30.0), (0, 102, "road", 40.0, 0.1, 3000.0, 60.0)]
        self.rows += [(0, 103 + i, "road", 10.0, 0.1, 3000.0, 80.0) for i in range(3)]
        self.save()
        (note,) = [n for n in self.design()[1]["notes"] if "too few crossings for a design" in n]
        self.assertIn("blocks are above SEL on 50.0-75.0 m (up to 2400 kJ), above h_i on 25.0-50.0 m (up to 30 m)", note)

    def test_a_block_larger_than_those_that_give_the_speed_is_said(self):
        """100 blocks of 3 t at 20 m/s, one of 30 t at 1 m/s: together 0.5 x 30 t x (20 m/s)^2 = 6000 kJ, which no block has."""
        def notes(*arguments):
            return [n for n in self.design(*arguments)[1]["notes"] if n.startswith("the largest block at the speed")]
        self.assertEqual(notes(), [])
        self.rows = [(0, i, "road", 20.0, 1.0, 3000.0, 10.0) for i in range(100)] + [(0, 100, "road", 1.0, 1.0, 30000.0, 10.0)]
        self.save()
        (note,) = notes()
        self.assertIn("has more energy than any crossing (on the line 6000 kJ, the crossings at most 600 kJ", note)
        self.assertEqual(notes("--volume", "2"), [])

    def test_crossings_up_to_an_end_of_the_line_are_said(self):
        """The line is 100 m, a cell 5 m: crossings within a cell of an end go on beyond it."""
        for first, last, ends in ((10.0, 30.0, None), (4.0, 60.0, "the beginning"), (40.0, 96.0, "the end"), (1.0, 99.0, "both ends"),
                                  (5.5, 94.5, None)):
            self.rows = [(0, i, "road", 10.0, 1.0, 3000.0, first + (last - first) * i / 100) for i in range(101)]
            self.save()
            notes = [note for note in self.design("--containment", "100")[1]["notes"] if note.startswith("blocks cross up to")]
            self.assertEqual(len(notes), ends is not None, (first, last, notes))
            if ends:
                self.assertTrue(notes[0].startswith(f"blocks cross up to {ends} of the line, and so probably beyond"), notes)

    def test_the_coefficient_is_pointed_out(self):
        """A lower c raises energies (docs/barrier.md): notes of runs above c = 0.15. A ground that was fitted with it is fitted again."""
        run = self.record()
        for c, said in ((0.5, True), (0.25, True), (0.2, True), (0.15, False), (0.125, False)):
            record = run | {"deformation_coefficient": c}
            self.write("out/run.json", json.dumps(record))
            notes = " ".join(self.design()[1]["notes"])
            self.assertEqual("energies, jumps, run-out and hits may be too low (unsafe): c = " + str(c) in notes, said, notes)
            self.assertEqual("Run with --deformation-coefficient 0.15 as well" in notes, said, notes)
            self.assertNotIn("The ground was fitted", notes)
            record["inputs"] = run["inputs"] + [{"role": "include", "path": "/fitted.toml", "sha256": "0"}]
            self.write("out/run.json", json.dumps(record))
            notes = " ".join(self.design()[1]["notes"])
            self.assertEqual("The ground was fitted, and holds for the c of its fit alone: unless speeds were measured, fit it again" in notes, said, notes)
            self.assertNotIn("--deformation-coefficient", notes)

    def test_what_the_run_warned_of_is_said_again(self):
        run = self.record()
        before = self.design()[1]["notes"]
        gullies = "14 % of the trajectories (140) stay in gullies steeper than phi: there"
        self.write("out/run.json", json.dumps(run | {"warnings": ["another", "block sizes: diameters are 0.3 m", gullies]}))
        _, report, text = self.design()
        self.assertEqual(report["notes"], ["block sizes: diameters are 0.3 m", gullies, *before])
        self.assertIn("\nnote: block sizes: diameters are 0.3 m\n", text)
        self.assertEqual(self.run_well("barrier", self.path("out"), "--screen", "road", "-q").stderr, "")

    def test_blocks_that_left_before_the_line_are_said(self):
        """They were missing without a word. Of 1000 blocks 101 cross the road: at most 899 can have left before it."""
        run = self.record()
        for left, gaps, more, said in ((540, 530, {}, "up to 54 % of the blocks (540 of 1000) left the DEM or entered a gap in it"),
                                       (1000, 0, {}, "up to 89.9 % of the blocks (899 of 1000) left the DEM"),
                                       (11, 0, {}, "up to 1.1 % of the blocks (11 of 1000) left the DEM"), (10, 0, {}, None),
                                       (4, 0, {"left_with_pieces": 30, "pieces": 5}, "up to 3 % of the blocks (30 of 1000) left the DEM")):
            with self.subTest(left=left):
                self.write("out/run.json", json.dumps(run | {"ends": {"left": left}, "left_into_gaps": gaps} | more))
                notes = [note for note in self.design()[1]["notes"] if "% of the blocks (" in note]
                self.assertEqual([note.split(" without crossing this line first")[0] for note in notes], [said] if said else [])
        self.write("out/run.json", json.dumps(run | {"ends": {"left": 540}}))
        self.refused("no block crosses screen 'fe/nce': this does not say that a barrier is not needed there: up to 54 % of the blocks",
                     "(unsafe)", arguments=["--screen", "fe/nce"])

    def test_blocks_that_crossed_before_they_left_are_not_missing(self):
        """Blocks 0 to 100 cross the road. A stops.csv, as of a profile, says which ones left."""
        run = self.record()
        for first, last, said in ((61, 600, "50 % of the blocks (500 of 1000) left the DEM"), (0, 100, None), (0, 110, None),
                                  (0, 111, "1.1 % of the blocks (11 of 1000) left the DEM")):
            with self.subTest(last=last):
                left = range(first, last + 1)
                self.write("out/run.json", json.dumps(run | {"ends": {"left": len(left)}}))
                ends = [f"0,{block},{'left' if block in left else 'stopped'}\n" for block in range(1000)]
                self.write("out/stops.csv", "source,block,end\n" + "".join(ends))
                notes = [note for note in self.design()[1]["notes"] if "% of the blocks (" in note]
                self.assertEqual([note.split(" without crossing this line first")[0] for note in notes], [said] if said else [])

    def test_a_line_where_blocks_do_not_get(self):
        """A part where the DEM has no height is not known to be safe."""
        run = self.record()
        for screen in run["screens"]:
            screen["share_without_height"] = 0.53
        self.write("out/run.json", json.dumps(run))
        self.refused("no block crosses screen 'fe/nce': this does not say that a barrier is not needed there: 53 % of the line lie "
                     "where the DEM has no height", "(unsafe)", arguments=["--screen", "fe/nce"])
        _, report, text = self.design()
        self.assertIn("nothing crosses the other 2 stretches: not all of them are safe, see the note below\n", text)
        self.assertEqual(sum(note.startswith("53 % of the line lie where the DEM has no height") for note in report["notes"]), 1)

    def test_options(self):
        values, _, _ = self.design("--gE", "1.2", "--percentile", "50", "--volume", "1", "--density", "2700")
        self.assertAlmostEqual(values["MEL"] / values["SEL"], 1.2, 12)
        self.assertAlmostEqual(values["v50"], 10.0, 9)
        self.assertAlmostEqual(values["m_d"], 2700.0 * 1.1, 9)

    def test_a_design_beyond_any_net_is_said(self):
        """Above 15 000 kJ or 12 m, docs/barrier.md: at 17.545 m/s, 1.3 times the energy of 2 m3 of 2500 kg/m3 is 1.1 MJ."""
        said = ", on the line or one of its stretches: place the line elsewhere, or take a dam or a gallery"
        self.assertNotIn(said, " ".join(self.design()[1]["notes"]))
        (note,) = [note for note in self.design("--volume", "40")[1]["notes"] if said in note]
        self.assertRegex(note, r"^MEL of up to \d+ kJ is more than any net holds \(15000 kJ\), on the line")
        # from 25 m on: (10 m + 0.76 m + 0.95 * 0.25 m) * 1.21 + 0.78 m
        self.rows = [(source, block, screen, speed, 10.0 + jump, mass, place) for source, block, screen, speed, jump, mass, place in self.rows]
        self.save()
        (note,) = [note for note in self.design()[1]["notes"] if said in note]
        self.assertRegex(note, r"^h_i of up to 14\.1 m is higher than any net \(12 m\), on the line")

    def test_a_mass_and_a_speed_of_different_blocks_are_said_by_stretch(self):
        """On the first stretch the heavy blocks are slow: at v95 the largest one would have more energy than any crossing."""
        said = "stretches with a design, up to "
        self.assertNotIn(said, " ".join(self.design("--stretch", "30")[1]["notes"]))
        self.rows = [(0, i, "road", 20.0 if i < 50 else 5.0, 1.0, 300.0 if i < 50 else 5000.0, 10.0) for i in range(100)]
        self.rows += [(0, 100 + i, "road", 5.0, 1.0, 5000.0, 60.0) for i in range(30)]
        self.save()
        # 1/2 5000 kg (20 m/s)^2 is 1000 kJ; the crossings have 60 and 62.5 kJ
        self.assertIn("on 1 of 2 " + said + "16 times as much", " ".join(self.design("--stretch", "30")[1]["notes"]))
        self.assertNotIn(said, " ".join(self.design("--stretch", "30", "--volume", "2")[1]["notes"]))

    def test_a_volume_far_above_those_of_the_run_is_said(self):
        """The largest block has 2 m3: 2000 m3 are kg, more likely."""
        self.assertNotIn("--volume:", " ".join(self.design("--volume", "20")[1]["notes"]))
        notes = " ".join(self.design("--volume", "2000")[1]["notes"]).replace("\u00a0", " ")
        self.assertIn("--volume: 2 000 m3 is 1 000 times the largest block that crosses in the run, 2 m3: is it in m3?", notes)

    def test_a_denser_rock_has_more_energy(self):
        """The largest block has 5000 kg at the run's 2500 kg/m3: 2 m3, which weigh 6000 kg at 3000 kg/m3."""
        values, _, _ = self.design("--density", "3000")
        self.assertAlmostEqual(values["V"], 2.0, 9)
        self.assertAlmostEqual(values["E_d"], self.design()[0]["E_d"] * 1.2, 6)

    def test_a_block_counts_once(self):
        before = self.design()[0]
        self.save([(0, i, "road", 0.5, 0.0, self.rows[i][5], 10.0) for i in range(50)])
        self.assertEqual(self.design()[0], before)

    def content(self):
        found = {}
        for name in os.listdir(self.path("out")):
            with open(self.path("out/" + name), "rb") as file:
                found[name] = file.read()
        return found

    def test_same_bytes_again_and_nothing_half_written(self):
        self.design()
        first = self.content()
        self.design()
        self.assertEqual(self.content(), first)
        self.assertEqual(sorted(first), ["barrier_road.csv", "barrier_road.gpkg", "barrier_road.json", "barrier_road_stretches.csv",
                                         "run.json", "screens.csv", "talus.qgs"])

    def test_what_is_not_its_own_stays(self):
        """A file of the same name without a design of Talus beside it is someone's own."""
        for name in ("barrier_road.csv", "barrier_road_stretches.csv", "barrier_road.gpkg", "barrier_road.json"):
            self.write("out/" + name, '{"program": "mine"}')
            self.refused(name + ": is there and of no earlier design by talus barrier", "move it or give it another name")
            self.assertEqual(self.content()[name], b'{"program": "mine"}')
            os.remove(self.path("out/" + name))
        self.design()

    def test_another_design_that_is_replaced_is_said(self):
        call = ["barrier", self.path("out"), "--screen", "road"]
        values, _, _ = self.design()
        self.assertNotIn("replaces", self.run_well(*call).stderr)  # the same again
        self.assertIn(f"talus: replaces the earlier design of screen road (SEL {values['SEL']:.4g} kJ, h_i {values['h_i']:.4g} m)\n",
                      self.run_well(*call, "--gTr", "1.02").stderr)
        self.assertEqual(self.run_well(*call, "-q").stderr, "")

    def test_name_of_the_files(self):
        self.save([(0, i, "fe/nce", 5.0 + i, 1.0 + i, 3000.0, 1.0 + i) for i in range(20)])
        self.run_well("barrier", self.path("out"), "--screen", "fe/nce")
        self.assertTrue(os.path.exists(self.path("out/barrier_fe_nce.json")))

    def test_observed_crossings(self):
        table = "id,screen,speed_ms,jump_height_m,angular_velocity_rads\n"
        table += "".join(f"b{i},road,{4 + 0.2 * i:.2f},{0.1 + 0.05 * i:.2f},3\n" for i in range(50))
        observed = self.write("passages.csv", table)
        _, report, text = self.design("--observed", observed)
        self.assertEqual([r["quantity"] for r in report["reliability"]], ["jump height", "speed"])
        self.assertEqual(report["reliability"][0]["values"], 50)
        # h_i is 0.96 * 1.21 + 0.78 = 1.94 m, which observed jumps 0.1 + 0.05 i exceed from i = 37 on
        self.assertAlmostEqual(report["reliability"][0]["exceeded"][0]["share"], 13 / 50, 12)
        self.assertIn("have no values of the energy", text)

    def test_observed_rows_of_unknown_screens(self):  # were left out without a word: 40 m/s at a misspelt road
        table = "id,screen,speed_ms,jump_height_m\n" + "".join(f"b{i},road,{4 + 0.2 * i:.2f},{0.1 + 0.05 * i:.2f}\n" for i in range(50))
        _, report, _ = self.design("--observed", self.write("seen.csv", table + "c,low,9,9\n"))
        self.assertFalse([note for note in report["notes"] if "rows are of screen" in note], report["notes"])  # a screen of the run
        _, report, _ = self.design("--observed", self.write("seen.csv", table + "c,Road,40,9\nd,Road,40,9\n"))
        self.assertEqual([note.split("seen.csv")[1] for note in report["notes"] if "rows are of screen" in note],
                         [": 2 rows are of screen 'Road', which the run does not have: they count nowhere. Is it "
                          "road, fe/nce, low?"])
        self.refused("seen.csv:52: screen = ''", "must be given", arguments=["--screen", "road", "--observed",
                                                                         self.write("seen.csv", table + "c,,40,9\n")])

    def test_few_observed_values_are_counted(self):  # all six were far above h_i, and nothing said so
        table = "id,screen,jump_height_m\n" + "".join(f"b{i},road,{5 + i}\n" for i in range(6)) + "b0,road,7\n"
        _, report, _ = self.design("--observed", self.write("few.csv", table))
        notes = " ".join(report["notes"])
        self.assertIn("hold 6 values of the jump height above 0: too few", notes)
        self.assertIn("; 6 of 6 exceed h_i", notes)
        self.assertIn("few.csv: 1 of 7 rows repeat a block", notes)

    def test_a_full_disk_leaves_the_earlier_design(self):  # the table was new, the map old
        self.run_well("barrier", self.path("out"), "--screen", "road")
        def written():
            folder = pathlib.Path(self.path("out"))
            return {file.name: file.read_bytes() for file in folder.iterdir() if "barrier_" in file.name}
        before = written()
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (80 * 1024, 80 * 1024))  # the GeoPackage has more
        done = self.call("barrier", self.path("out"), "--screen", "road", "--volume", "10", preexec_fn=limit)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("barrier_road.gpkg", done.stderr)
        self.assertEqual(written(), before)

    def refused(self, *words, arguments=("--screen", "road")):
        before = os.listdir(self.path("out"))
        self.fails(2, *words, arguments=["barrier", self.path("out"), *arguments])
        self.assertEqual(os.listdir(self.path("out")), before)

    def test_wrong_input(self):
        self.refused("no screen 'raod'", "did you mean 'road'", arguments=["--screen", "raod"])
        self.refused("only 19 blocks", "20 at least", arguments=["--screen", "low"])
        self.refused("no block crosses screen 'fe/nce': a barrier is not needed there, or", arguments=["--screen", "fe/nce"])
        self.refused("--gTr = 0.9", "1 to 3", arguments=["--screen", "road", "--gTr", "0.9"])
        self.refused("--gE = nan", arguments=["--screen", "road", "--gE", "nan"])
        self.refused("abc", arguments=["--screen", "road", "--gDp", "abc"])
        self.refused("--percentile = 0.95", "50 to 99.99 %", "not 0.95", arguments=["--screen", "road", "--percentile", "0.95"])
        self.refused("--containment = 0.99", "1 to 100 %", arguments=["--screen", "road", "--containment", "0.99"])
        self.refused("--percentile = 100", arguments=["--screen", "road", "--percentile", "100"])
        self.refused("must be 1000 at least", arguments=["--screen", "road", "--percentile", "99.9"])
        self.refused("--volume = 0", arguments=["--screen", "road", "--volume", "0"])
        self.refused("--screen", arguments=[])
        self.refused("none.csv", arguments=["--screen", "road", "--observed", self.path("none.csv")])
        few = self.write("few.csv", "id,screen,jump_height_m\n" + "".join(f"b{i},road,{i}\n" for i in range(10)))
        self.run_well("barrier", self.path("out"), "--screen", "road", "--observed", few)
        self.assertIn("9 values of the jump height above 0: too few for a Weibull fit", " ".join(self.read_json("out/barrier_road.json")["notes"]))
        other = self.write("other.csv", "id,screen,jump_height_m\na,S1,1\n")
        self.refused("no row of screen 'road' (there are rows of 'S1'), must have", arguments=["--screen", "road", "--observed", other])

    def test_shortened_crossings(self):
        head = "screen,quantity,unit,crossings,blocks,share_of_released,mean,p50,p95,p99,maximum\n"
        self.write("out/screens_summary.csv", head + "low,speed,m/s,19,19,0.019,1,1,1,1,1\nroad,speed,m/s,101,101,0.1,1,1,1,1,1\n")
        self.design()
        with open(self.path("out/screens.csv"), encoding="utf-8") as file:
            lines = file.readlines()
        self.write("out/screens.csv", "".join(lines[:60]))
        self.refused("screens.csv: has 59 crossings of screen 'road'", "screens_summary.csv beside it says 101")
        self.write("out/screens_summary.csv", head + "low,speed,m/s,19,19,0.019,1,1,1,1,1\n")
        self.refused("screens_summary.csv: has no row of screen 'road'")  # not: no block crosses it

    def test_folders_that_are_none(self):
        self.fails(2, "no run.json", arguments=["barrier", self.folder, "--screen", "road"])
        os.remove(self.path("out/screens.csv"))
        self.refused("no screens.csv")
        record = self.record()
        record["screens"][0]["lines"] = [[[0.0, 0.0]]]
        self.write("out/run.json", json.dumps(record))
        self.refused("run.json", "cannot be understood", "has a line of less than two places")
        self.write("out/run.json", "{")
        self.refused("run.json", "cannot be understood")


class Weights(Case):
    """Two cliffs above one line: the eastern one, with larger blocks, falls fifty times less often."""

    def setUp(self):
        super().setUp()
        self.sources(10.0, 0.2)
        write_features(self.path("lines.gpkg"), "lines", [(line(150.0), ["road"])], [("id", ogr.OFTString)])
        self.scenario = self.write("s.toml", 'dem = "dem.tif"\ntrajectories = 100\n[sources]\nfile = "sources.gpkg"\n'
                                   '[blocks]\ndiameter = 1.0\n[screens]\nfile = "lines.gpkg"\n')

    def sources(self, *frequencies):
        fields = [("name", ogr.OFTString), ("diameter", ogr.OFTReal)]
        fields += [("frequency", ogr.OFTReal)] if frequencies else []
        values = [["west", 0.5], ["east", 1.5]]
        values = [v + [f] for v, f in zip(values, frequencies)] if frequencies else values
        write_features(self.path("sources.gpkg"), "sources",
                       list(zip((box(60, 230, 20, 10), box(220, 230, 10, 10)), values)), fields)

    def report(self, *arguments):
        self.run_well("barrier", self.path("out"), "--screen", "road", *arguments)
        return self.read_json("out/barrier_road.json")

    def crossings(self, west, east):
        """Speed and events per year of the first crossing of each block; 8 cells of the western cliff, 4 of the eastern."""
        first = {(row["source"], row["block"]): row for row in reversed(self.read_table("out/screens.csv"))}
        self.assertLess({int(source) for source, _ in first}, set(range(13)))
        rows = [(float(row["speed_ms"]), (west / 800 if float(row["mass_kg"]) < 1000 else east / 400), row)
                for row in first.values()]
        return sorted(rows, key=lambda row: row[0])

    def expect(self, report, west, east):
        """Per year, and v95 between the values below and above which 95 % of the events are."""
        rows = self.crossings(west, east)
        total = sum(weight for _, weight, _ in rows)
        self.assertAlmostEqual(report["crossings_per_year"]["value"] / total, 1.0, 9)
        self.assertLess(report["crossings_per_year"]["low"], total)
        self.assertGreater(report["crossings_per_year"]["high"], total)
        below, bounds = 0.0, []
        for speed, weight, _ in rows:
            below += weight / total
            bounds += [speed] if 0.94 < below < 0.96 else []
        self.assertLessEqual(min(bounds), report["design"][0]["value"])
        self.assertGreaterEqual(max(bounds), report["design"][0]["value"])
        sel = next(row["value"] for row in report["design"] if row["name"] == "h_i")
        above = sum(weight for _, weight, row in rows if float(row["jump_height_m"]) > sel)
        limit = report["reliability"][0]["exceeded"][0]
        self.assertAlmostEqual(limit["per_year"]["value"], above, 9)
        self.assertAlmostEqual(limit["share_by_frequency"], above / total, 9)
        centres = sum(weight for _, weight, row in rows if self.centre(row) > sel)
        self.assertAlmostEqual(report["reliability"][1]["exceeded"][0]["per_year"]["value"], centres, 9)
        self.assertGreater(centres, above)
        self.assertAlmostEqual(sum(row["crossings_per_year"]["value"] for row in report["stretches"]) / total, 1.0, 9)
        return total

    @staticmethod
    def centre(row):
        """Of a sphere of 2700 kg/m3, whose lowest point is at the jump height."""
        return float(row["jump_height_m"]) + 0.5 * (6.0 / math.pi * float(row["mass_kg"]) / 2700.0)**(1.0 / 3.0)

    def expect_once_in(self, report, west, east):
        """The value that all as large together reach once in so many years, summed again from the crossings."""
        for key, value_of in (("speed_ms", lambda row: float(row["speed_ms"])), ("centre_height_m", self.centre)):
            crossings = sorted(((value_of(row), weight) for _, weight, row in self.crossings(west, east)), reverse=True)
            for row in report["once_in"]:
                rate = 0.0
                for value, weight in crossings:
                    rate += weight
                    if rate * row["years"] >= 1.0:
                        break
                self.assertAlmostEqual(row[key]["value"], value, 3)
                self.assertLessEqual(row[key]["low"], value + 1e-3)
                self.assertTrue(row[key]["high"] is None or row[key]["high"] >= value - 1e-3)

    def test_a_design_that_is_exceeded_too_often(self):
        self.run_well("run", self.scenario, "-o", self.path("out"))
        small = self.report("--volume", "0.01", "--gTr", "1", "--gDp", "1")
        notes = [note for note in small["notes"] if "more often than once in 300 years" in note]
        self.assertEqual(len(notes), 1)
        energy, centre = (small["once_in"][-1][key]["value"] for key in ("energy_kj", "centre_height_m"))
        design = {row["name"]: row["value"] for row in small["design"]}
        self.assertGreater(energy, design["SEL"])
        self.assertGreater(centre, design["h_i"])
        told = [float(number) for number in re.findall(r"[0-9.]+(?= \[| kJ\)| m\))", notes[0])]
        for said, value in zip(told, (energy, design["SEL"], centre, design["h_i"]), strict=True):
            self.assertAlmostEqual(said / value, 1.0, 2)

    def test_which_values_of_a_design_are_exceeded_too_often(self):
        """By the bounds of what comes once in the longest of the return periods; SEL and h_i each for itself."""
        self.run_well("run", self.scenario, "-o", self.path("out"))
        small, tall, large = (("--gTr", factor, "--gDp", "1", "--volume", volume)
                              for factor, volume in (("1", "0.01"), ("1", "2"), ("3", "500")))
        seen = set()
        for arguments, years in itertools.product((small, tall, large), ("0.01", "4.93", "1000000")):
            report = self.report(*arguments, "--return-periods", years)
            design = {row["name"]: row["value"] for row in report["design"]}
            pairs = [("SEL", report["once_in"][0]["energy_kj"], design["SEL"]),
                     ("its centre", report["once_in"][0]["centre_height_m"], design["h_i"])]
            above = tuple(word for word, value, limit in pairs if value["high"] is None or value["high"] > limit)
            surely = any(value["value"] > limit for _, value, limit in pairs)
            notes = [note for note in report["notes"] if "exceed this design" in note]
            self.assertEqual(len(notes), 1 if above else 0)
            for word, _, _ in pairs:
                self.assertEqual(word in "".join(notes), word in above)
            self.assertEqual("blocks may exceed" in "".join(notes), bool(above) and not surely)
            unknown = any(value["high"] is None for _, value, _ in pairs)
            self.assertEqual('"?" is not known: run more trajectories' in "".join(notes), unknown)
            seen.add((above, surely))
        self.assertEqual(seen, {((), False), (("SEL", "its centre"), True), (("its centre",), True), (("SEL", "its centre"), False)})

    def test_values_by_return_period(self):
        self.run_well("run", self.scenario, "-o", self.path("out"))
        report = self.report()
        self.assertEqual([row["years"] for row in report["once_in"]], [30, 100, 300])
        chosen = self.report("--return-periods", "4.93,0.01,0.493")
        self.assertEqual([row["years"] for row in chosen["once_in"]], [0.01, 0.493, 4.93])
        self.expect_once_in({"once_in": chosen["once_in"][1:]}, 10.0, 0.2)
        self.assertEqual(chosen["once_in"][0]["energy_kj"], {"value": 0.0, "low": 0.0, "high": 0.0})
        self.assertLess(chosen["once_in"][1]["energy_kj"]["value"], chosen["once_in"][2]["energy_kj"]["value"])
        self.assertEqual(self.report("--return-periods", "100000")["once_in"][0]["energy_kj"]["high"], None)
        text = self.run_well("barrier", self.path("out"), "--screen", "road", "--return-periods", "100000").stdout
        self.assertRegex(text, "100\xa0000" r" years +energy [0-9.]+ \[[0-9.]+, \?\] kJ")
        self.assertEqual(self.report("--unweighted")["once_in"], [])
        for given, said in (("1e-9", "--return-periods = 1e-09: must be 0.001 to"), ("2e6", "--return-periods = 2000000: must be"),
                            ("30,100,30.0", "--return-periods: 30 is given twice")):
            self.fails(2, said, arguments=["barrier", self.path("out"), "--return-periods", given])
        self.fails(2, "--return-periods: every block counts alike, as --unweighted asks: give the sources a field frequency",
                   arguments=["barrier", self.path("out"), "--unweighted", "--return-periods", "30"])

    def without_a_fit(self, table, weighted):
        """Nine observed jumps are too few for a law. How often the simulated ones exceed the design does not hang on them."""
        few = self.report("--observed", self.write("few.csv", "\n".join(table.splitlines()[:10]) + "\n"))
        self.assertEqual(few["reliability"], [])
        notes = [note for note in few["notes"] if "; by frequency, " in note]
        self.assertEqual([name for note in notes for name in ("h_i", "v_d", "SEL", "MEL") if f"by frequency, {name} is exceeded by" in note],
                         ["h_i", "h_i", "v_d", "SEL", "MEL"])  # of the jump and of the centre
        self.assertIn("few.csv have no values of the centre height; by frequency, h_i is exceeded by", notes[1])
        self.assertIn("few.csv hold 9 values of the jump height above 0: too few for a Weibull fit", notes[0])
        for note, quantity in zip(notes, weighted["reliability"]):
            for limit in quantity["exceeded"]:
                years = 1.0 / (limit["per_year"]["value"] or limit["per_year"]["high"])
                found = re.search(limit["name"] + " is exceeded by .*? of the simulated crossings, (?:rarer than )?once in ([0-9. ]+?) years", note)
                self.assertAlmostEqual(float(found[1].replace(" ", "")) / years, 1.0, delta=0.006)
        alike = self.report("--unweighted", "--observed", self.path("few.csv"))
        self.assertIn("so it is not known how often its design value is exceeded", " ".join(alike["notes"]))

    def test_a_block_counts_by_its_frequency(self):
        self.run_well("run", self.scenario, "-o", self.path("out"))
        weighted = self.report()
        self.assertIn("by the annual frequency of its source", weighted["weighting"])
        self.expect(weighted, 10.0, 0.2)
        self.assertLess(weighted["effective_crossings"], weighted["crossings"])
        alike = self.report("--unweighted")
        self.assertEqual(alike["effective_crossings"], alike["crossings"])
        self.assertIsNone(alike["crossings_per_year"])
        table = "id,screen,speed_ms,jump_height_m\n" + "".join(f"b{i},road,1.0,{0.01 + 0.001 * i}\n" for i in range(30))
        observed = self.report("--observed", self.write("low.csv", table))
        limit = observed["reliability"][0]["exceeded"][0]
        self.assertEqual((limit["share"], observed["frequency_of"]), (0.0, "the simulated crossings"))
        self.without_a_fit(table, weighted)
        self.assertEqual(limit["per_year"], weighted["reliability"][0]["exceeded"][0]["per_year"])
        other = self.write("w.toml", "[features]\nwest = 0.1\neast = 5.0\n")
        swapped = self.report("--frequency", other)
        self.expect(swapped, 0.1, 5.0)
        self.assertNotIn("frequency", weighted)
        self.assertEqual(swapped["frequency"]["file"], other)
        self.assertEqual(swapped["frequency"]["given"], {"frequency": {}, "features": {"west": 0.1, "east": 5.0}})
        self.assertAlmostEqual(swapped["frequency"]["events_per_year"], 5.1, 9)
        none = self.report("--frequency", self.write("z.toml", "[features]\nwest = 3.0\neast = 0.0\n"))
        zeros = " of the crossings are of sources or block classes with a frequency of 0 and count nothing, but in "
        (note,) = [note for note in none["notes"] if zeros in note]
        east = sum(weight == 0.0 for _, weight, _ in self.crossings(3.0, 0.0))
        self.assertEqual(note, f"{east}{zeros}the laws and shares of the values and in the width by the map")
        text = self.run_well("barrier", self.path("out"), "--screen", "road", "--frequency", self.path("z.toml")).stdout
        self.assertRegex(text, r"\n  nothing that falls crosses the other \d+ stretches\n")  # only blocks of the east do
        observed = self.report("--frequency", self.path("z.toml"), "--observed", self.path("low.csv"))
        self.assertIn(f"{east}{zeros}the width by the map", observed["notes"])  # the laws and shares are of the observed ones
        self.assertAlmostEqual(none["design"][2]["value"], math.pi / 6 * 0.5**3, 4)  # the largest that ever falls
        self.fails(2, "--unweighted", arguments=["barrier", self.path("out"), "--screen", "road", "--unweighted",
                                                  "--frequency", other])
        write_dem(self.path("dem.tif"), heights() + 1)
        self.fails(2, "has changed since the run", "--unweighted",
                   arguments=["barrier", self.path("out"), "--screen", "road"])
        self.report("--unweighted")

    def test_events_that_are_lost_are_said(self):
        """0.9 of 1 event per year are of a cliff off the DEM."""
        write_features(self.path("sources.gpkg"), "sources", [(box(60, 230, 20, 10), ["on", 0.1]), (box(-500, 230, 20, 10), ["off", 0.9])],
                       [("name", ogr.OFTString), ("frequency", ogr.OFTReal)])
        self.run_well("run", self.scenario, "-o", self.path("out"))
        words = "features wholly off the DEM, which release nothing: FID 2 (off), and its 0.9 events per year are lost"
        own = "by the run's own frequencies: "
        for more, other in (((), False), (("--frequency", self.write("w.toml", "[features]\non = 2\n")), True)):
            (note,) = [note for note in self.report(*more)["notes"] if words in note]
            self.assertEqual(note.startswith(own), other)

    def test_classes_keep_their_shares_of_the_events_under_another_weighting(self):
        write_features(self.path("sources.gpkg"), "sources", [(box(60, 230, 20, 10), [])])
        self.write("s.toml", self.read_text("s.toml").replace(
            "diameter = 1.0", "diameter = [{ diameter = 0.6, frequency = 0.75 }, { diameter = 1.4, frequency = 0.25 }]"))
        self.run_well("run", self.scenario, "-o", self.path("out"))
        of_run = self.report()
        total = self.report("--frequency", self.write("w.toml", "[frequency]\ntotal = 1.0\n"))
        for key in ("design", "crossings_per_year", "stretches"):
            self.assertEqual(total[key], of_run[key])
        kept = "the classes of blocks keep their shares of the events: 75 %, 25 %"
        self.assertEqual([kept in report["notes"] for report in (of_run, total)], [False, True])

    def test_without_frequencies(self):
        self.sources()
        self.run_well("run", self.scenario, "-o", self.path("out"))
        self.assertIn("alike: the run has no annual frequencies", self.report()["weighting"])
        other = self.write("w.toml", "[features]\nwest = 0.1\neast = 5.0\n")
        self.fails(2, "--frequency", "no annual frequencies",
                   arguments=["barrier", self.path("out"), "--screen", "road", "--frequency", other])


class Plane(Case):
    """A plane of 40 degrees, 200 m wide, too steep to stop on or to climb: below the sources nothing crosses a line twice."""

    POINTS = {"A": (100, 30), "B": (60, 30), "C": (140, 50)}  # m from the west and from the north

    def setUp(self):
        super().setUp()
        rows = np.arange(150)[::-1, None]
        z = 500.0 + math.tan(math.radians(40)) * 2.0 * rows * np.ones((1, 100))
        write_dem(self.path("dem.tif"), z.astype(np.float32), cell=2.0)
        write_features(self.path("lines.gpkg"), "lines", [(line(100.0, 1.0, 199.0), ["low"])], [("id", ogr.OFTString)])

    def run_plane(self, frequencies, trajectories, blocks):
        """The rows of screens.csv, of sources with these frequencies."""
        points = [(f"POINT ({WEST + x} {NORTH - y})", [name, frequencies[name]])
                  for name, (x, y) in self.POINTS.items() if name in frequencies]
        write_features(self.path("points.gpkg"), "points", points, [("name", ogr.OFTString), ("frequency", ogr.OFTReal)])
        self.write("s.toml", f'dem = "dem.tif"\nseed = 1\ntrajectories = {trajectories}\n[sources]\nfile = "points.gpkg"\n'
                   f'[screens]\nfile = "lines.gpkg"\n{blocks}')
        self.run_well("run", self.path("s.toml"), "-o", self.path("out"))
        return self.crossings()

    def crossings(self):
        return self.read_table("out/screens.csv")

    def design(self, *arguments):
        done = self.run_well("barrier", self.path("out"), "--screen", "low", *arguments)
        return self.read_json("out/barrier_low.json"), done.stdout


class AllReleased(Plane):
    """Every block of three sources crosses: what counts is known without a simulation."""

    def test_bounds_are_those_of_the_objects(self):
        """Every block of B and C crosses, none of A ever falls. The number of blocks is fixed, so that only a block more or less
        could be: 3.69 blocks of the largest weight, 1/150, are the upper Poisson bound of none, -ln 0.025."""
        rows = self.run_plane({"A": 0.0, "B": 1.0, "C": 0.3}, 150, "[blocks]\ndiameter = 1.0\n")
        self.assertEqual(len(rows), 450)
        report, _ = self.design()
        per_year = report["crossings_per_year"]
        self.assertAlmostEqual(per_year["value"], 1.3, 9)
        self.assertAlmostEqual(per_year["high"], 1.3, 9)
        self.assertAlmostEqual(per_year["low"], 1.3 + math.log(0.025) / 150, 4)
        self.run_well("hazard", self.path("out"), "--objects", self.path("lines.gpkg"))
        (hit,) = self.read_table("out/objects.csv")
        for key, name in (("value", "frequency"), ("low", "frequency_lower"), ("high", "frequency_upper")):
            self.assertAlmostEqual(per_year[key] / float(hit[name]), 1.0, 4)

    def test_the_lower_of_two_lines_under_one_id_is_as_alone(self):
        """By stretch, with sources of different frequency. Every block crosses both lines."""
        write_features(self.path("lines.gpkg"), "lines",
                       [(f"MULTILINESTRING ({line(160.0, 1.0, 199.0)[11:]},{line(100.0, 1.0, 199.0)[11:]})", ["low"]),
                        (line(100.0, 1.0, 199.0), ["alone"])], [("id", ogr.OFTString)])
        self.run_plane({"A": 0.0, "B": 1.0, "C": 0.3}, 150, "[blocks]\ndiameter = 1.0\n")
        both, text = self.design()
        self.run_well("barrier", self.path("out"), "--screen", "alone")
        alone = self.read_json("out/barrier_alone.json")
        self.assertEqual(len(both["stretches"]), 2 * len(alone["stretches"]))
        for low, one in zip(both["stretches"][len(alone["stretches"]):], alone["stretches"]):
            for key in ("crossings", "effective_crossings", "largest_energy_kj", "largest_jump_height_m", "design"):
                self.assertEqual(low[key], one[key], key)
            self.assertEqual(low["crossings_per_year"], one["crossings_per_year"])
        self.assertGreater(sum(s["crossings_per_year"]["value"] for s in alone["stretches"]), 1.29)
        self.assertAlmostEqual(both["crossings_per_year"]["value"], 1.3, 9)  # blocks, not crossings
        self.assertIn("300 crossings on stretches are of blocks that crossed the line before", text)

    def test_the_width_by_the_map_is_of_all_released_blocks(self):
        """Bins of 2 m that more than 1 % of the released blocks cross, counted by hand. Those of B and C, at the sides, never fall
        but count."""
        rows = self.run_plane({"A": 1.0, "B": 0.0, "C": 0.0}, 150, "[blocks]\ndiameter = 1.0\n")
        bins = Counter(math.floor((float(row["x"]) - WEST - 1.0) / 2.0) for row in rows)
        wide = [2.0 * place for place, count in bins.items() if count > 0.01 * 450]
        report, _ = self.design()
        by_map = report["containment"]["by_impact_probability"]
        self.assertEqual((by_map["from_m"], by_map["to_m"]), (min(wide), max(wide) + 2.0))
        falling = [float(row["x"]) - WEST - 1.0 for row in rows if row["source"] == "0"]
        self.assertAlmostEqual(by_map["share"], sum(min(wide) <= x <= max(wide) + 2.0 for x in falling) / len(falling), 9)
        self.assertEqual(self.design("--unweighted")[0]["containment"]["by_impact_probability"]["width_m"], by_map["width_m"])


    def test_blocks_lost_in_a_gap_above_the_line_are_counted(self):
        """On this plane every block crosses, or falls into the gap below B."""
        z = 500.0 + math.tan(math.radians(40)) * 2.0 * np.arange(150)[::-1, None] * np.ones((1, 100))
        z[30:40, 20:40] = -9999.0
        write_dem(self.path("dem.tif"), z.astype(np.float32), cell=2.0, nodata=-9999.0)
        rows = self.run_plane({"A": 1.0, "B": 1.0}, 150, "[blocks]\ndiameter = 1.0\n")
        lost = 300 - len({(row["source"], row["block"]) for row in rows})
        self.assertGreater(lost, 100)
        (note,) = [note for note in self.design()[0]["notes"] if "% of the blocks (" in note]
        self.assertIn(f"({lost} of 300) left the DEM or entered a gap in it without crossing this line first", note)

    def test_blocks_that_crossed_above_the_gap_are_not_missing(self):
        """Of the blocks of B that fall into the gap all cross a line above it; those of A pass beside both. By hand, from exits.gpkg."""
        z = 500.0 + math.tan(math.radians(40)) * 2.0 * np.arange(150)[::-1, None] * np.ones((1, 100))
        z[30:40, 20:40] = -9999.0
        write_dem(self.path("dem.tif"), z.astype(np.float32), cell=2.0, nodata=-9999.0)
        write_features(self.path("lines.gpkg"), "lines", [(line(255.0, 20.0, 85.0), ["low"])], [("id", ogr.OFTString)])
        crossed = {(int(row["source"]), int(row["block"])) for row in self.run_plane({"A": 1.0, "B": 1.0}, 150, "[blocks]\ndiameter = 1.0\n")}
        exits = ogr.Open(self.path("out/exits.gpkg"))
        left = [(row["source"], row["block"]) for row in exits.GetLayer(0)]
        self.assertGreater(len(set(left) & crossed), 100)
        missing = len(set(left) - crossed)
        notes = [note for note in self.design()[0]["notes"] if "% of the blocks (" in note]
        self.assertEqual([note.split(" left ")[0].split("(")[1] for note in notes], [f"{missing} of 300)"] if missing > 3 else [])
        self.assertNotIn("up to", " ".join(notes))


class Pieces(Plane):
    """Blocks that break above the line; every piece that crosses is a crossing."""

    def run_broken(self, diameter, threshold):
        return self.run_plane({"A": 1.0}, 200, f"[blocks]\ndiameter = {diameter}\n[effects.fragmentation]\nthreshold = {threshold}\n")

    def test_pieces_of_equal_mass_are_several_crossings(self):
        """A block of 0.16 m (5.8 kg) breaks into two of 2.9 kg, these into four of 1.45 kg; smaller ones stay whole."""
        rows = self.run_broken(0.16, 20)
        self.assertEqual(len({(row["source"], row["block"], row["piece"]) for row in rows}), len(rows))
        self.assertLessEqual({int(row["piece"]) for row in rows}, set(range(17)))
        masses = {(row["source"], row["block"], row["mass_kg"]) for row in rows}
        self.assertLess(len(masses), 0.4 * len(rows))
        mass = Counter()
        for row in rows:
            mass[row["block"]] += float(row["mass_kg"])
        self.assertLess(max(mass.values()), 2700 * math.pi / 6 * 0.16**3 * (1 + 1e-4))  # each piece is there once
        report, _ = self.design()
        self.assertEqual(report["crossings"], len(rows))
        self.assertEqual(report["blocks"], len(mass))
        self.assertEqual(sum(row["crossings"] for row in report["stretches"]), len(rows))
        with open(self.path("out/screens.csv"), encoding="utf-8") as file:  # as an earlier version wrote it: by mass
            text = "".join(row.rsplit(",", 1)[0] + "\n" for row in file)
        self.write("out/screens.csv", text)
        self.assertEqual(self.design()[0]["crossings"], len(masses))

    def test_pieces_cross_more_often_than_blocks_fall(self):
        """One event per year, 200 blocks: each crossing stands for 1/200 per year, and there are many for each block."""
        rows = self.run_broken(1.0, 5)
        of_block = Counter(row["block"] for row in rows)
        self.assertGreater(len(rows), 10 * len(of_block))
        report, text = self.design()
        per_year, stretches = report["crossings_per_year"], [row["crossings_per_year"] for row in report["stretches"]]
        self.assertAlmostEqual(per_year["value"], len(rows) / 200, 9)
        self.assertGreaterEqual(per_year["value"], sum(row["value"] for row in stretches) - 1e-9)
        for stretch, row in zip(stretches, report["stretches"]):
            self.assertAlmostEqual(stretch["value"], row["crossings"] / 200, 9)
            self.assertTrue(stretch["low"] <= stretch["value"] <= stretch["high"])
        self.assertIn(f"screen low: {len(rows)} crossings (blocks and pieces) of {len(of_block)} blocks, 100 % of those released", text)
        self.assertIn("every block and piece counts by the annual frequency of its source", text)
        # The gamma quantiles of Fay and Feuer by Wilson and Hilferty's formula: each block is one count, with its pieces.
        largest = max(of_block.values()) / 200
        def quantile(total, squares, z):
            shape = total**2 / squares
            return total * (1 - 1 / (9 * shape) + z / (3 * math.sqrt(shape)))**3
        total, squares = len(rows) / 200, sum((n / 200)**2 for n in of_block.values())
        self.assertAlmostEqual(per_year["low"] / quantile(total, squares, -1.959964), 1.0, 3)
        self.assertAlmostEqual(per_year["high"] / quantile(total + largest, squares + largest**2, 1.959964), 1.0, 3)
        speed = next(row["value"] for row in report["design"] if row["name"] == "v_d")
        limit = next(limit for quantity in report["reliability"] for limit in quantity["exceeded"] if limit["name"] == "v_d")
        above = sum(float(row["speed_ms"]) > speed for row in rows)
        self.assertAlmostEqual(limit["per_year"]["value"], above / 200, 9)
        self.assertAlmostEqual(limit["share_by_frequency"], above / len(rows), 9)

    def test_check_foretells_the_rows_of_the_pieces(self):
        """Of 100 times as many blocks: those of the whole blocks alone were less than half of the file."""
        self.run_broken(1.0, 5)
        size = os.path.getsize(self.path("out/screens.csv"))
        text = self.run_well("check", self.path("s.toml"), "--trajectories", "20000").stdout
        self.assertGreater(float(re.search(r"disk +about ([0-9 ]+) MB", text)[1].replace(" ", "")), 100e-6 * size)

    def test_a_block_counts_once_in_a_bin_of_the_map(self):
        rows = self.run_broken(1.0, 5)
        bins = Counter(place for _, place in {(row["block"], math.floor((float(row["x"]) - WEST - 1.0) / 2.0)) for row in rows})
        for containment, most in ((99, 2), (95, 10), (85, 30)):  # 1, 5 and 15 % of 200 blocks
            wide = [2.0 * place for place, count in bins.items() if count > most]
            by_map = self.design("--containment", str(containment))[0]["containment"]["by_impact_probability"]
            self.assertEqual((by_map["from_m"], by_map["to_m"]), (min(wide), max(wide) + 2.0), containment)


class Walk(Case):
    """Nets across the slope of 35 degrees, below the sources at y = 230 to 240."""

    FIELDS = (("id", ogr.OFTString), ("height", ogr.OFTReal), ("capacity", ogr.OFTReal))

    def nets(self, *nets):
        write_features(self.path("nets.gpkg"), "nets", [(line(y, 0.0, 300.0), list(values)) for y, *values in nets],
                       self.FIELDS)

    def scenario(self, barriers=True):
        write_features(self.path("lines.gpkg"), "lines", [(line(150.0), ["above"]), (line(100.0), ["below"])],
                       [("id", ogr.OFTString)])
        return self.write("s.toml", 'dem = "dem.tif"\ntrajectories = 100\n[sources]\nfile = "sources.gpkg"\n'
                          "[blocks]\ndiameter = [0.6, 1.2]\n[screens]\nfile = \"lines.gpkg\"\n"
                          + ('[barriers]\nfile = "nets.gpkg"\n' if barriers else ""))

    def screens(self, out):
        return [row["screen"] for row in self.read_table(out + "/screens.csv")]

    def test_a_capacity_that_is_none_must_be_given(self):
        """A net needs both numbers: the message does not offer to leave them out, which is refused."""
        self.scenario()
        for value, told in ((-1.0, "field capacity = -1: must be 0 to inf"), (None, "has no capacity, must be")):
            self.nets((120.0, "net", 4.0, value))
            done = self.fails(2, told, arguments=["check", self.path("s.toml")])
            self.assertNotIn("where it is not known", done.stderr)

    def test_one_that_is_more_than_any_net_is_said(self):
        """150 kJ in J, 3 m that were typed as 30; also where the scenario names it. Large nets and dams are silent."""
        words = "more than any net: is the capacity in J, or is it a dam?"
        nets = [(125.0, "joule", 4.0, 150000.0), (120.0, "high", 30.0, 150.0), (115.0, "large", 6.0, 8500.0),
                (110.0, "dam", 30.0, math.inf), (105.0, "off", 0.0, 150000.0)]
        self.nets(*nets)
        named = f"line = [{{ id = 'named', height = 3, capacity = 20000, from = [{WEST + 50}, {SOUTH + 60}], to = [{WEST + 90}, {SOUTH + 60}] }}]\n"
        self.write("s.toml", self.read_text(os.path.basename(self.scenario())) + named)
        for text in (self.run_well("check", self.path("s.toml")).stdout, self.run_well("run", self.path("s.toml"), "-o", self.path("out")).stderr):
            (told,) = [one for one in text.splitlines() if words in one]
            self.assertIn("barriers: joule (150000 kJ, 4 m), high (150 kJ, 30 m), named (20000 kJ, 3 m): above 15000 kJ or 12 m", told)
        self.nets(*nets[2:])
        self.assertNotIn(words, self.run_well("check", self.scenario()).stdout)

    def test_one_that_is_lower_than_the_largest_block_is_said(self):
        """The blocks have diameters of 0.6 to 1.2 m."""
        self.nets((125.0, "low", 1.1, 1000.0), (120.0, "high", 1.2, 1000.0), (115.0, "off", 0.0, 1000.0))
        text = self.run_well("check", self.scenario()).stdout
        self.assertIn("barriers: low (1.1 m): lower than the largest block, 1.2 m", text)

    def test_one_that_holds_nothing_is_said(self):
        """A number that was not filled in is 0 in many a layer."""
        self.nets((125.0, "good", 4.0, 1000.0), (120.0, "low", 0.0, 1000.0), (115.0, "weak", 4.0, 0.0))
        self.assertIn("barriers: low, weak: of height or capacity 0, which hold no block",
                      self.run_well("check", self.scenario()).stdout)

    def test_one_that_holds_all(self):
        self.nets((125.0, "wall", 100.0, math.inf))
        done = self.run_well("run", self.scenario(), "-o", self.path("out"))
        self.assertIn("above", self.screens("out"))
        self.assertNotIn("below", self.screens("out"))
        record = self.record()
        wall, = record["barriers"]
        self.assertEqual((wall["id"], wall["capacity_kj"], wall["over"], wall["broken"]), ("wall", "inf", 0, 0))
        self.assertEqual(wall["caught"], record["ends"]["caught"])
        self.assertGreater(wall["caught"], 100)
        caught = f"{wall['caught']:,}".replace(",", " ")
        self.assertIn(f"barrier wall: {caught} caught, 0 over it, 0 through it (it broke)", done.stdout + done.stderr)
        self.assertEqual(sum(record["ends"].values()), record["released"])
        rows = self.read_table("out/barriers.csv")
        self.assertEqual(len(rows), 60)
        self.assertEqual(sum(int(row["hits"]) for row in rows), wall["hits"])
        self.assertEqual((rows[-1]["barrier"], rows[-1]["from_m"], rows[-1]["to_m"]), ("wall", "295", "300"))
        self.assertIn("nets.gpkg", [os.path.basename(f["path"]) for f in record["inputs"] if f["role"] == "barriers"])

    def table(self, page, heading):
        """The rows of the first table after a heading of the report."""
        section = page[page.index(f"<h2>{heading}</h2>"):]
        rows = re.findall(r"<tr>(.*?)</tr>", section[:section.index("</table>")])
        return [re.findall(r"<td[^>]*>(.*?)</td>", row) for row in rows][1:]

    def test_what_rests_on_the_barriers_says_so(self):
        """The report, talus barrier and talus hazard of a run with nets; the figures are those of barriers.csv."""
        os.remove(self.path("sources.gpkg"))
        write_features(self.path("sources.gpkg"), "sources", [(box(140, 230, 20, 10), ["cliff", 0.5])],
                       [("name", ogr.OFTString), ("frequency", ogr.OFTReal)])
        self.nets((170.0, "low", 1.0, 20.0), (125.0, "high", 2.0, 60.0), (120.0, "off", 0.0, 60.0))
        self.run_well("run", self.scenario(), "-o", self.path("out"))
        counts = {}
        for row in self.read_table("out/barriers.csv"):
            sums = counts.setdefault(row["barrier"], [0, 0, 0])
            for i, key in enumerate(("caught", "over", "broken")):
                sums[i] += int(row[key])
        self.assertGreater(counts["low"][2], 0)  # it breaks
        caught = counts["low"][0] + counts["high"][0]
        note = f"2 barriers stood in the run and caught {caught} blocks"
        hazard = self.run_well("hazard", self.path("out"))
        self.assertIn(f"{note}: the figures here hold only while they stand", hazard.stderr)
        self.assertIn(f"{note}: the figures here hold only while they stand", self.read_json("out/hazard.json")["warnings"])
        design = self.run_well("barrier", self.path("out"), "--screen", "above")
        self.assertIn(f"note: {note}: the figures here hold only while they stand", design.stdout)
        self.run_well("report", self.path("out"))
        page = self.read_text("out/report.html")
        shown = {row[0]: [int("".join(cell.split())) for cell in row[3:]] for row in self.table(page, "Barriers of the run")}
        self.assertEqual(shown, {name: counts[name] for name in ("low", "high")})
        self.assertIn(f"<li>{note}; the maps hold only while they stand.</li>", page)
        self.assertRegex(page, rf"act</td><td>Barriers of the run</td><td class='b'>{note}; .*broken through: low \(")
        self.assertIn(">barriers of the run</text>", page)  # the key of the maps
        for name in ("low", "high"):
            self.assertIn(f">{name}</text>", page)
        self.assertEqual([barrier["lines"] for barrier in self.record()["barriers"]],
                         [[[[WEST, SOUTH + y], [WEST + 300.0, SOUTH + y]]] for y in (170.0, 125.0, 120.0)])

        self.run_well("run", self.scenario(False), "-o", self.path("bare"))
        said = self.run_well("hazard", self.path("bare")).stderr
        said += self.run_well("barrier", self.path("bare"), "--screen", "above").stdout
        self.run_well("report", self.path("bare"))
        said += self.read_text("bare/report.html")
        self.assertNotIn("Barriers of the run", said)
        self.assertNotIn("stood in the run", said)
        self.assertNotIn(">barriers of the run</text>", said)

    def test_a_barrier_counts_blocks_and_pieces(self):
        """Each piece of a broken block is caught alone: more are caught than blocks end as `caught`."""
        self.nets((125.0, "wall", 100.0, math.inf))
        with open(self.scenario(), "a", encoding="utf-8") as file:
            file.write("[effects.fragmentation]\nthreshold = 20\nlargest = 0.7\n")
        done = self.run_well("run", self.path("s.toml"), "-o", self.path("out"))
        record = self.record()
        (wall,) = record["barriers"]
        self.assertGreater(record["pieces"], 0)
        self.assertGreater(wall["caught"], record["ends"]["caught"])
        caught = f"{wall['caught']:,}".replace(",", " ")
        self.assertIn(f"barrier wall: {caught} blocks and pieces caught, 0 over it", done.stderr)
        self.assertIn(f"1 barrier stood in the run and caught {wall['caught']} blocks and pieces: the figures here hold only while it stands",
                      self.run_well("barrier", self.path("out"), "--screen", "above").stdout)

    def test_without_height_nothing_changes(self):
        self.nets((125.0, "none", 0.0, 1000.0))
        self.run_well("run", self.scenario(False), "-o", self.path("without"))
        self.run_well("run", self.scenario(), "-o", self.path("with"))
        for name in os.listdir(self.path("without")):
            if name in ("run.json", "scenario.toml", "talus.qgs"):  # which name the barriers
                continue
            with open(self.path("without/" + name), "rb") as a, open(self.path("with/" + name), "rb") as b:
                self.assertEqual(a.read(), b.read(), name)

    def test_the_same_for_any_number_of_threads_and_again(self):
        self.nets((170.0, "low", 1.0, 20.0), (125.0, "high", 2.0, 60.0))
        self.run_well("run", self.scenario(), "-o", self.path("one"), "--threads", "1")
        self.run_well("run", self.path("one/scenario.toml"), "-o", self.path("two"), "--threads", "3")
        for name in ("barriers.csv", "stops.gpkg", "screens.csv", "screens_summary.csv", "impact_probability.tif"):
            with open(self.path("one/" + name), "rb") as a, open(self.path("two/" + name), "rb") as b:
                self.assertEqual(a.read(), b.read(), name)
        for barrier in self.record("one")["barriers"]:
            self.assertEqual(barrier["hits"], barrier["caught"] + barrier["broken"])
            self.assertGreater(min(barrier["caught"], barrier["broken"], barrier["over"]), 0)
        stops = ogr.Open(self.path("one/stops.gpkg"))
        caught = next(f for f in stops.GetLayerByName("stops") if f["end"] == "caught")
        rows = self.run_well("trace", self.path("one/scenario.toml"), "--source", str(caught["source"]), "--block",
                             str(caught["block"])).stdout.splitlines()
        last = rows[-1].split(",")
        self.assertEqual(last[-1], "caught")
        self.assertEqual(float(last[1]), caught.GetGeometryRef().GetX())
        self.assertEqual(float(last[2]), caught.GetGeometryRef().GetY())

    def test_summary_of_the_screens(self):
        self.run_well("run", self.scenario(False), "-o", self.path("out"))
        rows = {(row["screen"], row["quantity"]): row for row in self.read_table("out/screens_summary.csv")}
        speeds = [float(row["speed_ms"]) for row in self.read_table("out/screens.csv") if row["screen"] == "above"]
        row = rows["above", "speed"]
        self.assertEqual(int(row["crossings"]), len(speeds))
        self.assertAlmostEqual(float(row["mean"]), sum(speeds) / len(speeds), 3)
        self.assertAlmostEqual(float(row["maximum"]), max(speeds), 3)
        along = rows["above", "place along"]
        self.assertTrue(0 < float(along["p50"]) < 260)
        self.assertTrue(0 < float(rows["above", "dip"]["mean"]) < 90)
        self.run_well("barrier", self.path("out"), "--screen", "above")
        self.fails(2, "did you mean 'above'", "below",
                   arguments=["barrier", self.path("out"), "--screen", "abvoe"])

    def test_screens_where_the_dem_has_no_height(self):
        scenario = self.scenario(False)
        write_features(self.path("lines.gpkg"), "lines", [(line(150.0), ["above"]), (line(100.0, 197.5, 397.5), ["half off"])],
                       [("id", ogr.OFTString)])
        wanted = ("lines.gpkg: where the DEM has no height (off it, in its outer half cell or in a gap) lie 50 % of screen half off: "
                  "blocks do not get there, so that the crossings are lower bounds (unsafe)")
        done = self.run_well("run", scenario, "-o", self.path("out"))
        self.assertIn(wanted, done.stderr)
        told = self.run_well("check", scenario)
        self.assertIn(wanted, told.stdout + told.stderr)
        above, half = self.record()["screens"]
        self.assertNotIn("share_without_height", above)
        self.assertAlmostEqual(half["share_without_height"], 0.5, 2)

    def test_wrong_nets(self):
        self.nets((125.0, "a", -1.0, 100.0))
        self.fails(2, "nets.gpkg", "height = -1", arguments=["run", self.scenario(), "-o", self.path("out")])
        write_features(self.path("nets.gpkg"), "nets", [(line(125.0), ["a"])], [("id", ogr.OFTString)])
        self.fails(2, "nets.gpkg", "has no height", arguments=["run", self.scenario(), "-o", self.path("out")])


if __name__ == "__main__":
    unittest.main()
