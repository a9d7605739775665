"""talus hazard as a user calls it."""
import hashlib
import itertools
import json
import math
import os
import re
import shutil
import signal
import subprocess
import time
import unittest

import numpy as np
from osgeo import gdal, ogr

from support import (NORTH, TALUS, WEST, Case, KeptRuns, OneThread, bands_of, box, heights, log_left_by_a_viewer,
                     rows_of, sqlite_rows, write_dem, write_features)

RUN = """dem = "dem.tif"
trajectories = 200
[sources]
file = "sources.gpkg"
[blocks]
diameter = 0.8
"""
FEW = RUN.replace("200", "50")  # where no figure hangs on the number: what is equal, a bound, or a text


class Hazard(OneThread, KeptRuns, Case):
    def setUp(self):
        super().setUp()
        write_features(self.path("sources.gpkg"), "sources",
                       [(box(100, 230, 20, 10), ["west", 0.5]), (box(200, 230, 20, 10), ["east", 0.02])],
                       [("name", ogr.OFTString), ("frequency", ogr.OFTReal)])
        self.write("s.toml", RUN)

    def simulate(self, out="out", *more):
        self.run_well("run", self.path("s.toml"), "-o", self.path(out), "-q", *more)

    def simulated(self, out="out"):
        """As `simulate`, of what several tests begin with: most with the scenario as setUp leaves it."""
        self.keep_scenario(out)

    def hashes(self, out):
        hashes = {}
        for name in sorted(os.listdir(self.path(out))):
            if name.endswith((".tif", ".gz", ".gpkg", ".csv")):
                with open(self.path(f"{out}/{name}"), "rb") as file:
                    hashes[name] = hashlib.sha256(file.read()).hexdigest()
        return hashes

    def refused(self, words, *arguments):
        done = self.call(*arguments)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertIn(words, done.stderr)

    def test_maps_and_record(self):
        self.simulated()
        done = self.run_well("hazard", self.path("out"))
        self.assertIn("0.52 events per year", done.stderr)
        self.assertEqual(done.stderr.count("talus: warning: block sizes: "), 1)  # 0.8 m, the ground of 1 to 1.4 m
        record = self.read_json("out/hazard.json")
        for name in ("annual_frequency", "return_period_30", "return_period_300", "intensity_T30", "intensity_T100",
                     "intensity_T300", "hazard_class"):
            for end in (".tif", ".qml"):
                self.assertIn(name + end, record["files"])
                self.assertTrue(os.path.exists(self.path(f"out/{name}{end}")), name + end)
        self.assertEqual(record["matrix"]["years"], [30, 100, 300])
        self.assertAlmostEqual(record["events_per_year"], 0.52)
        frequency, lower, upper = bands_of(self.path("out/annual_frequency.tif"))
        self.assertTrue(np.all(lower <= frequency) and np.all(frequency <= upper))
        self.assertLessEqual(frequency.max(), 0.52 * 1.000001)
        # 8 source cells each; passages / released of the western cliff alone, below it, are 0.5 per year times that
        passages = bands_of(self.path("out/passages.tif")).astype(float)
        west = passages[:, 18:26]
        self.assertGreater(west.sum(), 0)
        np.testing.assert_allclose(frequency[:, 18:26], west / 1600 * 0.5, rtol=1e-5)
        period = bands_of(self.path("out/return_period_30.tif"))[0]
        over = bands_of(self.path("out/energy_exceedance.tif"))[0][:, 18:26] * 3200 / 1600 * 0.5
        hit = over > 0
        np.testing.assert_allclose(period[:, 18:26][hit] * over[hit], 1.0, rtol=1e-5)
        self.assertTrue(np.all(period[:, 18:26][~hit] == -9999))
        self.assertEqual(bands_of(self.path("out/hazard_class.tif")).shape[0], 5)
        self.assertFalse([name for name in os.listdir(self.path("out")) if name.startswith(".")])

    def test_threads_change_no_byte(self):
        for out, threads in (("one", "1"), ("two", "2")):
            self.simulate(out, "--threads", threads)
            self.run_well("hazard", self.path(out), "-q", "--threads", threads)
        self.assertEqual(self.hashes("one"), self.hashes("two"))

    def test_frequencies_change_no_other_file(self):
        self.simulated()
        with_them = self.hashes("out")
        file = ogr.Open(self.path("sources.gpkg"), 1)
        file.ExecuteSQL("UPDATE sources SET frequency = NULL")
        file = None
        self.simulate("plain")
        self.assertEqual({k: v for k, v in with_them.items() if k != "hazard_tally.gz"}, self.hashes("plain"))
        self.refused("has no annual frequencies; give the sources a field frequency", "hazard", self.path("plain"))
        self.refused("0.6: there is no such file; --frequency of this command takes a file", "hazard", self.path("out"), "--frequency", "0.6")

    def test_a_run_that_replaces_hazard_maps_says_so(self):
        self.simulated()
        run = ["run", self.path("s.toml"), "-o", self.path("out"), "--overwrite", "--trajectories", "2"]
        self.assertNotIn("will also remove", self.run_well(*run).stderr)
        self.run_well("hazard", self.path("out"), "-q")
        done = self.run_well(*run)
        self.assertIn("note: --overwrite will also remove what later commands have written into ", done.stderr)
        self.assertIn("annual_frequency.tif", done.stderr)

    def test_refusals(self):
        self.simulated()
        self.refused("is no folder of results", "hazard", self.folder)
        self.run_well("hazard", self.path("out"), "-q")
        self.refused("give --overwrite", "hazard", self.path("out"))
        matrix = self.write("m.toml", 'energies = [100]\nyears = [50]\nclasses = [[1, 0], [2, 1]]\n')
        done = self.run_well("hazard", self.path("out"), "--overwrite", "--matrix", matrix)
        self.assertIn("none of the run's energy_thresholds", done.stderr)
        self.assertFalse(os.path.exists(self.path("out/intensity_T30.tif")), "of the earlier matrix")
        (removed,) = [line for line in done.stderr.splitlines() if "removed, as not asked for this time: " in line]
        for name in ("intensity_T30.tif", "return_period_300.tif"):
            self.assertEqual(name in removed, not os.path.exists(self.path("out/" + name)), removed)
        self.assertTrue(os.path.exists(self.path("out/intensity_T50.tif")))
        self.write("m.toml", "energies = [300, 30]\n")
        self.refused("must be 1 to 8 numbers", "hazard", self.path("out"), "--overwrite", "--matrix", matrix)
        with open(self.path("out/hazard_tally.gz"), "r+b") as file:
            file.truncate(200)
        self.refused("is damaged", "hazard", self.path("out"), "--overwrite")
        self.assertTrue(os.path.exists(self.path("out/intensity_T50.tif")), "what was there stays")

    def test_names_of_classes_that_cannot_be_told_apart(self):  # the maps and the report showed two classes of one name
        self.simulated()
        for names, words in (('["none", "low", "low"]', "names: classes 1 and 2 are both called 'low', must have names that"),
                             ('["none", " ", "low"]', "names: class 1 has an empty name")):
            matrix = self.write("m.toml", f"energies = [100]\nyears = [50]\nclasses = [[1, 0], [2, 1]]\nnames = {names}\n")
            self.refused(words, "hazard", self.path("out"), "--matrix", matrix)
        self.assertFalse(os.path.exists(self.path("out/hazard.json")))

    def test_results_of_a_later_version_are_said(self):  # nobody looked at the version
        self.simulated()
        record = self.record()
        first, second, rest = record["version"].split(".", 2)
        for version, said in ((f"{first}.{int(second) + 1}.0", True), (f"{int(first) + 1}.0.0", True),
                              (f"{first}.{second}.{int(rest.split('-')[0]) + 7}", False), ("", False)):
            self.write("out/run.json", json.dumps({**record, "version": version}))
            done = self.run_well("hazard", self.path("out"), "--overwrite")
            words = f"run.json was written by Talus {version}, and this is the earlier version {record['version']}"
            self.assertEqual(words in done.stderr, said, done.stderr)
            self.assertEqual(any(words in warning for warning in self.read_json("out/hazard.json")["warnings"]), said)

    def test_the_tally_of_another_run_is_refused(self):  # its maps came under the name of this run
        self.simulated()
        self.simulate("other", "--seed", "2")
        shutil.copy(self.path("other/hazard_tally.gz"), self.path("out"))
        for arguments in (["hazard", self.path("out")], ["hazard", self.path("out"), "--objects", self.path("sources.gpkg")]):
            self.refused("hazard_tally.gz: is of another run than run.json beside it", *arguments)
        self.assertFalse(os.path.exists(self.path("out/annual_frequency.tif")))

    def test_all_events_of_a_source_that_the_dem_cuts_fall_on_the_rest(self):
        """A rectangle of 40 m of which the western 20 m lie off the DEM: check, run, hazard and report say so, with the numbers."""
        cut = [(box(-20, 230, 40, 10), ["cut", 0.8]), (box(200, 230, 20, 10), ["whole", 0.3])]
        fields = [("name", ogr.OFTString), ("frequency", ogr.OFTReal)]
        for out, features, said in (("out", cut, True), ("whole", cut[1:], False)):
            os.remove(self.path("sources.gpkg"))
            write_features(self.path("sources.gpkg"), "sources", features, fields)
            words = "50 % of polygon 1 (cut) lies outside the DEM, and its 0.8 events per year all fall on the 50 % that are left"
            told = [self.run_well(*self.arguments(out)).stderr,
                    self.run_well("check", *self.arguments(out)[1:-2]).stdout, self.run_well("hazard", self.path(out)).stderr]
            self.assertEqual([words in text for text in told], [said] * 3, out)
            record = self.read_json(out + "/hazard.json")
            self.assertEqual(any(words in warning for warning in record["warnings"]), said)
            self.assertAlmostEqual(record["events_per_year"], sum(values[1] for _, values in features), 9)
            self.run_well("report", self.path(out))
            point = re.search(r"<td class='k'>(.*)</td><td>Frequency</td><td class='b'>(.*?)</td>", self.read_text(out + "/report.html"))
            self.assertEqual(point[1].split()[-1], "act" if said else "look")
            self.assertEqual("all of its events fall on the rest" in point[2], said)

    def place_sources(self, features, fields=(("name", ogr.OFTString), ("frequency", ogr.OFTReal))):
        os.remove(self.path("sources.gpkg"))
        write_features(self.path("sources.gpkg"), "sources", features, fields)

    def frequency_point(self, out):
        """Mark and text of the point on frequencies in the report."""
        self.run_well("report", self.path(out))
        point = re.search(r"<td class='k'>(.*)</td><td>Frequency</td><td class='b'>(.*?)</td>", self.read_text(out + "/report.html"))
        return point[1].split()[-1], point[2]

    def test_a_source_off_the_dem_is_lost_with_its_events(self):
        """One of 0.3 events per year lies wholly off the DEM, one of 0.5 on it: check, run, hazard and report say so."""
        self.place_sources([(box(-500, 230, 20, 10), ["Off", 0.3]), (box(200, 230, 20, 10), ["on", 0.5])])
        words = "features wholly off the DEM, which release nothing: FID 1 (Off), and its 0.3 events per year are lost"
        told = [self.run_well(*self.arguments()).stderr, self.run_well("check", *self.arguments()[1:-2]).stdout,
                self.run_well("hazard", self.path("out")).stderr]
        self.assertEqual([words in text for text in told], [True] * 3)
        record = self.read_json("out/hazard.json")
        self.assertEqual(sum(words in warning for warning in record["warnings"]), 1)
        self.assertAlmostEqual(record["events_per_year"], 0.5, 9)
        mark, text = self.frequency_point("out")
        self.assertEqual(mark, "act")
        self.assertIn("a source releases nothing (see the warnings), and its events are lost", text)
        done = self.run_well("hazard", self.path("out"), "--overwrite", "--frequency", self.write("w.toml", "[features]\non = 2\n"))
        self.assertIn("by the run's own frequencies: " + self.path("sources.gpkg") + ": " + words, done.stderr)
        for word in ("Off", '"FID 1"'):
            self.refused("FID 1 releases nothing in the run", "hazard", self.path("out"), "--overwrite", "--frequency",
                         self.write("w.toml", f"[features]\non = 2\n{word} = 0.3\n"))
        self.assertAlmostEqual(self.read_json("out/hazard.json")["events_per_year"], 2.0, 9)

    def test_parts_off_the_dem_are_said_under_any_frequency(self):
        """8 cells of 25 m2 of one source lie off the DEM, 8 on it, and 8 of another: 400 m2 release blocks."""
        shapes = [(box(-20, 230, 40, 10), ["cut"]), (box(200, 230, 20, 10), ["whole"]), (box(-500, 230, 20, 10), ["Off"])]
        self.place_sources(shapes, [("name", ogr.OFTString)])
        words = ["50 % of polygon 1 (cut) lies outside the DEM: blocks start from the rest alone",
                 "features wholly off the DEM, which release nothing: FID 3 (Off)"]
        for out, rule, events in (("area", "per_area = 0.001", 0.4), ("total", "total = 3", 3.0)):
            self.write("s.toml", RUN + f"[frequency]\n{rule}\n")
            self.simulate(out)
            said = self.run_well("hazard", self.path(out)).stderr
            record = self.read_json(out + "/hazard.json")
            for text in words:
                self.assertIn(text, said)
                self.assertEqual(sum(text in warning for warning in record["warnings"]), 1)
            self.assertNotIn("events per year are lost", said)  # nothing says how many fell from them
            self.assertAlmostEqual(record["events_per_year"], events, 6)
            mark, text = self.frequency_point(out)
            self.assertEqual(mark, "act")
            self.assertIn("a source, or a part of one, releases nothing (see the warnings)", text)

    def test_another_weighting(self):
        """The maps are those of a run whose sources had these frequencies from the start."""
        self.simulated()
        new = self.write("new.toml", "[features]\neast = 3.0\n")
        done = self.run_well("hazard", self.path("out"), "--frequency", new)
        self.assertIn("repeats the run with another weighting: 3 200 trajectories", done.stderr)
        write_features(self.path("new.gpkg"), "sources",
                       [(box(100, 230, 20, 10), ["west", 0.5]), (box(200, 230, 20, 10), ["east", 3.0])],
                       [("name", ogr.OFTString), ("frequency", ogr.OFTReal)])
        os.replace(self.path("new.gpkg"), self.path("sources.gpkg"))
        self.simulate("other")
        self.run_well("hazard", self.path("other"), "-q")
        for name in ("annual_frequency", "return_period_30", "intensity_T100", "hazard_class"):
            self.assertEqual(self.hashes("out")[name + ".tif"], self.hashes("other")[name + ".tif"], name)
        self.refused("has changed since the run", "hazard", self.path("out"), "--frequency", new, "--overwrite")
        for again, dropped in ((1, True), (2, False)):  # only the first time there is a weighting to lose
            said = self.run_well("hazard", self.path("out"), "--overwrite").stderr
            self.assertEqual(f"frequencies are those of the run, no longer those of {new}" in said, dropped, said)
        self.refused("no such feature", "hazard", self.path("other"), "--overwrite", "--frequency",
                     self.write("bad.toml", "[features]\neats = 1\n"))

    def test_the_record_says_what_another_weighting_was(self):
        """Also when its file is gone."""
        self.simulated()

        def record(text, *more):
            new = self.write("new.toml", text)
            with open(new, "rb") as file:
                digest = hashlib.sha256(file.read()).hexdigest()
            self.run_well("hazard", self.path("out"), "--frequency", new, "--overwrite", "-q", *more)
            os.remove(new)
            with open(self.path("out/hazard.json"), encoding="utf-8") as file:
                whole = json.load(file)
            frequency = whole["frequency"]
            self.assertEqual((frequency["file"], frequency["sha256"], frequency["replayed"]), (new, digest, True))
            self.assertEqual(frequency["events_per_year"], whole["events_per_year"])
            return frequency

        one = record("[features]\neast = 3.0\n")
        self.assertEqual(one["given"], {"frequency": {}, "features": {"east": 3.0}})
        self.assertAlmostEqual(one["events_per_year"], 3.5, 9)
        area = record("[frequency]\nby_true_area = true\nper_area = 0.001\n[features]\n")
        self.assertEqual(area["given"], {"frequency": {"by_true_area": True, "per_area": 0.001}, "features": {}})
        total = record("[frequency]\ntotal = 7\n")
        self.assertEqual(total["given"], {"frequency": {"total": 7.0}, "features": {}})
        self.assertAlmostEqual(total["events_per_year"], 7.0, 6)
        self.run_well("hazard", self.path("out"), "--overwrite", "-q")
        self.assertNotIn("frequency", self.read_json("out/hazard.json"))

    def test_a_project_that_was_moved(self):
        """Results and inputs keep their places to each other: the plan is repeated from the new ones, if they hold the same."""
        old, new = self.path("project"), self.path("moved here")
        os.makedirs(old + "/inputs")
        for name in ("dem.tif", "sources.gpkg", "s.toml"):
            shutil.copy(self.path(name), old + "/inputs")
        write_features(self.path("houses.gpkg"), "houses", [(box(105, 150, 10, 8), ["A"])], [("name", ogr.OFTString)])
        self.run_well("run", old + "/inputs/s.toml", "-o", old + "/out", "-q")
        objects = ["hazard", new + "/out", "--objects", self.path("houses.gpkg"), "--overwrite", "-q"]
        os.rename(old, new)
        self.run_well(*objects)
        first = self.read_table("moved here/out/objects.csv")
        shutil.copytree(new + "/inputs", self.path("elsewhere"))
        write_dem(new + "/inputs/dem.tif", heights(60, 60, 5.0) + 1.0, 5.0)
        self.fails(2, "has changed since the run", arguments=objects)
        shutil.rmtree(new + "/inputs")
        self.fails(2, "no such file", "correct their paths in this file", arguments=objects)
        os.rename(self.path("elsewhere"), new + "/inputs")
        self.run_well(*objects)
        self.assertEqual(self.read_table("moved here/out/objects.csv"), first)

    def test_a_copy_of_a_project_has_files_of_its_own(self):
        """Also where those of the first project are there and have changed since."""
        os.makedirs(self.path("one/inputs"))
        for name in ("dem.tif", "sources.gpkg", "s.toml"):
            shutil.copy(self.path(name), self.path("one/inputs"))
        self.run_well("run", self.path("one/inputs/s.toml"), "-o", self.path("one/out"), "-q")
        shutil.copytree(self.path("one"), self.path("copy"))
        write_dem(self.path("one/inputs/dem.tif"), heights(60, 60, 5.0) + 1.0, 5.0)
        trace = ["--source", "1", "--block", "1"]
        self.run_well("trace", self.path("copy/out/scenario.toml"), *trace)
        self.fails(2, "has changed since the run", arguments=["trace", self.path("one/out/scenario.toml"), *trace])

    def test_parts_of_files_keep_their_names(self):
        self.write("part.toml", self.read_text("s.toml").replace('"dem.tif"', '"GTIFF_DIR:1:dem.tif"'))
        self.run_well("run", self.path("part.toml"), "-o", self.path("out"), "-q")
        self.run_well("trace", self.path("out/scenario.toml"), "--source", "1", "--block", "1")

    def classes_run(self, out, *more):
        """A run of which half of the blocks drawn are small, but 9 of 10 events, 1 event per year in all."""
        write_features(self.path(out + ".gpkg"), "sources", [(box(100, 230, 20, 10), ["west"]), (box(200, 230, 20, 10), ["east"])],
                       [("name", ogr.OFTString)])
        write_features(self.path(out + "_houses.gpkg"), "houses", [(box(105, 150, 10, 8), ["A"])], [("name", ogr.OFTString)])
        self.write("s.toml", FEW.replace("sources.gpkg", out + ".gpkg").replace(
            "0.8", "[{ diameter = 0.6, frequency = 0.9 }, { diameter = 1.4, frequency = 0.1 }]") + "".join(more))
        self.simulated(out)

    def hazard_by(self, out, weighting=None):
        """What is printed, the map of frequencies, and those of the house."""
        more = ["--frequency", self.write("w.toml", weighting)] if weighting else []
        done = self.run_well("hazard", self.path(out), "--objects", self.path(out + "_houses.gpkg"), "--overwrite", *more)
        (house,) = self.read_table(out + "/objects.csv")
        return (done.stderr, bands_of(self.path(out + "/annual_frequency.tif"))[0],
                {name: float(house[name]) for name in ("frequency", "frequency_lower", "frequency_upper", "frequency_30", "entry_30")})

    def test_classes_keep_their_shares_of_the_events_under_another_weighting(self):  # the shares drawn counted instead
        kept = "the classes of blocks keep their shares of the events: 90 %, 10 %"
        for out, more in (("plan", ""), ("true", "[frequency]\nby_true_area = true\n")):
            self.classes_run(out, more)
            said, once, house = self.hazard_by(out)
            self.assertNotIn("keep their shares", said)
            of_run = self.hashes(out)
            # 16 cells of 25 m2, two features of 8 cells each: all of these are 1 event per year, divided as in the run
            same = ["[frequency]\ntotal = 1\n"]
            if out == "plan":
                same += ["[frequency]\nper_area = 0.0025\n", "[features]\nwest = 0.5\neast = 0.5\n"]
            for weighting in same:
                said, _, _ = self.hazard_by(out, weighting)
                self.assertEqual(self.hashes(out), of_run, weighting)
                self.assertIn(kept, said)
                self.assertEqual(self.read_json(out + "/hazard.json")["frequency"]["class_shares"], [0.9, 0.1])
            _, twice, of_house = self.hazard_by(out, "[frequency]\ntotal = 2\n")
            np.testing.assert_array_equal(twice, np.where(once > 0, 2 * once, once))
            for name, value in house.items():
                self.assertAlmostEqual(of_house[name], 2 * value, delta=2e-5 * value)
        self.run_well("report", self.path("true"))
        self.assertIn("the classes of blocks keep their shares of the events", self.read_text("true/report.html"))

    def test_few_paths_of_a_class_are_said_by_the_weighting_that_counts(self):  # that of the run was said, or none
        """N(>= V) ~ V^-1/3 is 1/D: blocks of 0.5 to 1 m come twice as often as those of 1 to 2 m, of which 3200/1001 are drawn."""
        self.place_sources([(box(100, 230, 20, 10), ["west"]), (box(200, 230, 20, 10), ["east"])], [("name", ogr.OFTString)])
        write_features(self.path("lines.gpkg"), "lines", [("LINESTRING (2600020 1200150, 2600280 1200150)", ["road"])], [("id", ogr.OFTString)])
        classes = "[{ diameter = [0.5, 1], weight = 1000, frequency = 1 }, { diameter = [1, 2], frequency = 0.1 }]"
        self.write("s.toml", RUN.replace("0.8", classes) + "[screens]\nfile = 'lines.gpkg'\n")
        self.simulate()
        law = self.write("w.toml", "[frequency]\npower_law = { A = 0.1, b = 0.3333333333333333 }\n")
        for more, share in (((), "9.09"), (("--frequency", law), "33.3")):
            self.run_well("hazard", self.path("out"), "--overwrite", "-q", *more)
            self.run_well("barrier", self.path("out"), "--percentile", "50", "-q", *more)
            for said in (self.read_json("out/hazard.json")["warnings"], self.read_json("out/barrier_road.json")["notes"]):
                (text,) = [one for one in said if "few paths stand for all events of a class" in one]
                self.assertIn(f"class: 1 to 2 m ({share} % of the events, about 3.2 of 3200 blocks in a round)", text)

    def test_cells_of_several_features_are_said(self):  # per_area counted them twice without a word
        """8 cells of 25 m2 of two features: 0.001 events per m2 and year are 0.2 of each."""
        fields, once = [("name", ogr.OFTString)], "sources overlap: 8 of 8 cells lie in more than one feature and release the blocks of each"
        twice = once + ", so that frequency.per_area counts {} events per year more than once"
        self.place_sources([(box(100, 230, 20, 10), ["a"]), (box(100, 230, 20, 10), ["b"])], fields)
        self.write("s.toml", RUN.replace("200", "20") + "[frequency]\nper_area = 0.001\n")
        self.simulate()
        self.assertIn(twice.format(0.2), self.run_well("check", self.path("s.toml")).stdout)
        self.assertIn(twice.format(0.2), self.run_well("hazard", self.path("out")).stderr)
        record = self.read_json("out/hazard.json")
        self.assertEqual(sum("sources overlap" in warning for warning in record["warnings"]), 1)
        self.assertAlmostEqual(record["events_per_year"], 0.4, 9)
        more = self.write("w.toml", "[frequency]\nper_area = 0.002\n")
        said = self.run_well("hazard", self.path("out"), "--overwrite", "--frequency", more).stderr
        self.assertIn(twice.format(0.4), said)
        self.assertNotIn(twice.format(0.2), said)
        for rules, shapes, words in (("", [("a",), ("b",)], once + ": join"),
                                     ("", [("a", 0.1), ("b", 0.2)], once + ", so that the events per year of each count there: join")):
            self.write("s.toml", RUN.replace("200", "20") + rules)
            self.place_sources([(box(100, 230, 20, 10), list(values)) for values in shapes],
                               [*fields, ("frequency", ogr.OFTReal)][:len(shapes[0])])
            said = self.run_well("check", self.path("s.toml")).stdout
            self.assertIn(words, said)
        self.place_sources([(box(100, 230, 20, 10), ["a"]), (box(120, 230, 20, 10), ["b"])], fields)  # side by side
        self.assertNotIn("sources overlap", self.run_well("check", self.path("s.toml")).stdout)

    def test_points_that_are_there_twice_are_said(self):  # they released twice without a word
        fields = [("name", ogr.OFTString), ("frequency", ogr.OFTReal), ("vx", ogr.OFTReal)]
        west, north = f"POINT ({WEST + 100} {NORTH - 65})", f"POINT ({WEST + 100} {NORTH - 60})"
        for shapes, words in (([(west, ["a", 0.5, 1.0]), (north, ["b", 0.5, 1.0]), (west, ["a", 0.5, 1.0])], "1 point has the place and the fields of another (FID 3), and"),
                              ([(west, [None, None, None])] * 3, "2 points have the place and the fields of another (FID 2, 3), and"),
                              ([(f"MULTIPOINT ({west[7:-1]}, {west[7:-1]})", ["a", 0.5, 1.0])], "1 point has the place and the fields of another (FID 1), and"),
                              ([(west, ["a", 0.5, 1.0]), (west, ["b", 0.5, 1.0]), (west, ["a", 0.4, 1.0]), (west, ["a", 0.5, 2.0])], None)):
            self.place_sources(shapes, fields)
            self.simulate("points", "--overwrite", "--trajectories", "5")
            said = [one for one in self.record("points")["warnings"] if one.startswith("points of sources: ")]
            self.assertEqual(len(said), 1 if words else 0, said)
            if words:
                self.assertIn(words, said[0])
                self.assertIn("unless it is meant", said[0])
            if shapes[0][1][1]:  # with frequencies: those who use the results are told, too
                self.assertEqual("points of sources: " in self.run_well("hazard", self.path("points")).stderr, bool(words))

    def test_another_weighting_that_says_too_little_or_too_much(self):
        """In words of its own: there were those of a scenario, with the flag --field that talus hazard does not have."""
        self.classes_run("out")
        for text, words in (("[features]\nwest = 1\n", "w.toml: [features] does not list east, must list every feature that releases blocks"),
                            ("[frequency]\ntotal = 1\n[features]\nwest = 1\neast = 1\n",
                             "w.toml: [features] cannot be given with total, per_area or power_law of [frequency]: leave out one")):
            self.refused(words, "hazard", self.path("out"), "--overwrite", "--frequency", self.write("w.toml", text))

    def test_a_run_of_a_wet_day_says_that_its_figures_are_of_wet_days(self):
        said = "wet-ground acts on the day of this run, 3: the figures here are those of a wet day"
        write_features(self.path("lines.gpkg"), "lines", [("LINESTRING (2600020 1200150, 2600280 1200150)", ["road"])], [("id", ogr.OFTString)])
        for day, strength, wet in ((3, 0.5, True), (4, 0.5, False), (3, 0, False)):
            self.write("s.toml", f"day = {day}\n{FEW}[screens]\nfile = 'lines.gpkg'\n"
                       f"[effects.wet-ground]\nsoftening = {strength}\ndays = [1, 3]\n")
            self.simulate(f"out{day}{strength}")
            out = self.path(f"out{day}{strength}")
            self.assertEqual(said in self.run_well("hazard", out).stderr, wet)
            self.assertEqual(said in self.run_well("barrier", out).stdout, wet)
            self.run_well("report", out)
            for name in ("hazard.json", "barrier_road.json", "report.html"):
                self.assertEqual(said in self.read_text(f"{out}/{name}"), wet, name)

    def test_objects_count_falls_and_maps_of_a_width_pieces(self):
        said = "hits of objects are falls: a block with its pieces counts once; maps of --width count every piece"
        write_features(self.path("houses.gpkg"), "houses", [(box(90, 150, 130, 8), ["A"])], [("name", ogr.OFTString)])
        for out, more, broken in (("whole", "", False), ("pieces", "[effects.fragmentation]\nthreshold = 20\n", True),
                                  ("strong", "[effects.fragmentation]\nthreshold = 1e6\n", False)):
            self.write("s.toml", FEW + more)
            self.simulate(out)
            self.assertEqual(self.record(out).get("pieces", 0) > 0, broken)
            done = self.run_well("hazard", self.path(out), "--objects", self.path("houses.gpkg"), "--width", "60")
            self.assertEqual(said in done.stderr, broken)
            self.assertEqual("narrow where several of them pass (unsafe)" in done.stderr, broken)
            (house,) = self.read_table(out + "/objects.csv")
            self.assertLessEqual(float(house["frequency"]), 0.52 * (1 + 1e-6))  # the falls per year of both cliffs
            self.assertEqual(bands_of(self.path(out + "/annual_frequency.tif"))[0].max() > 2 * 0.52, broken)
            self.run_well("report", self.path(out))
            self.assertEqual(said in self.read_text(out + "/report.html"), broken)

    def test_features_of_one_name_are_named_by_number(self):  # each got the value
        write_features(self.path("sources.gpkg"), "sources",
                       [(box(100, 230, 20, 10), ["a", 0.5]), (box(200, 230, 20, 10), ["a", 0.2])],
                       [("name", ogr.OFTString), ("frequency", ogr.OFTReal)])
        self.simulate()
        self.refused('2 features are called a, must be one: name them as "FID 1", "FID 2"', "hazard",
                     self.path("out"), "--frequency", self.write("w.toml", "[features]\na = 1\n"))
        self.run_well("hazard", self.path("out"), "-q", "--frequency", self.write("w.toml", "[features]\n1 = 0.5\n2 = 0.3\n"))
        self.assertAlmostEqual(self.read_json("out/hazard.json")["events_per_year"], 0.8, 9)

    def test_a_number_that_is_the_name_of_another_feature(self):  # the name won
        for name, other in (("2", "x"), ("FID 2", "2")):
            self.place_sources([(box(100, 230, 20, 10), [name, 0.5]), (box(200, 230, 20, 10), [other, 0.2])])
            self.simulate(name)
            if name == "2":
                self.refused('w.toml:2: features.2 = 1: 2 means 2 features, by name and by number, must be one: name them as '
                             '"FID 1", "FID 2"', "hazard", self.path(name), "--frequency", self.write("w.toml", "[features]\n2 = 1\n"))
            self.run_well("hazard", self.path(name), "-q", "--frequency", self.write("w.toml", '[features]\n"FID 2" = 3\n'))
            self.assertAlmostEqual(self.read_json(name + "/hazard.json")["events_per_year"], 0.5 + 3.0, 9)

    def test_a_name_that_begins_as_a_number_form(self):
        self.place_sources([(box(100, 230, 20, 10), ["FID north", 0.5]), (box(200, 230, 20, 10), ["x", 0.2])])
        self.simulate()
        self.run_well("hazard", self.path("out"), "-q", "--frequency", self.write("w.toml", '[features]\n"FID north" = 3\n'))
        self.assertAlmostEqual(self.read_json("out/hazard.json")["events_per_year"], 3.2, 9)

    def test_what_is_not_its_own_stays(self):
        self.simulated()
        write_features(self.path("out/objects.gpkg"), "mine", [(box(105, 150, 10, 8), ["A"]), (box(5000, 0, 9, 9), ["far"])],
                       [("name", ogr.OFTString)])
        done = self.call("hazard", self.path("out"), "--objects", self.path("out/objects.gpkg"))
        self.assertEqual(done.returncode, 2)
        self.assertIn("is there and none of the files of an earlier hazard.json", done.stderr)
        os.replace(self.path("out/objects.gpkg"), self.path("mine.gpkg"))
        done = self.run_well("hazard", self.path("out"), "--objects", self.path("mine.gpkg"))
        self.assertIn("objects wholly off the DEM, which have no results: far", done.stderr)
        rows = {row["name"]: row for row, _ in rows_of(self.path("out/objects.gpkg"), "objects")}
        self.assertIsNone(rows["far"]["frequency"])
        self.assertIsNone(rows["far"]["trajectories"])

    def test_what_a_reader_leaves_beside_a_raster_goes_with_it(self):
        """QGIS writes statistics beside a raster when it closes it, also when the raster has been removed before."""
        self.simulated()
        self.run_well("hazard", self.path("out"))
        ours = self.path("out/intensity_T100.tif.aux.xml")
        names = self.read_text(ours)
        self.run_well("hazard", self.path("out"), "--width", "10", "--overwrite")
        self.assertFalse(os.path.exists(ours))
        for name in ("intensity_T100.tif", "return_period_30.tif"):
            self.write(f"out/{name}.aux.xml", "<PAMDataset/>")
        self.write("out/hazard_class.tif.ovr", "overviews of the earlier raster")
        self.run_well("hazard", self.path("out"), "--overwrite")
        self.assertFalse(os.path.exists(self.path("out/hazard_class.tif.ovr")))
        self.assertEqual(self.read_text(ours), names)
        self.assertFalse(os.path.exists(self.path("out/return_period_30.tif.aux.xml")))  # those of the earlier map

    def test_the_log_of_earlier_objects_goes_with_them(self):  # the earlier objects were read, or a damaged file
        self.simulated()
        for name, x in (("first", 100), ("second", 200)):
            write_features(self.path(name + ".gpkg"), name, [(box(x, 150, 10, 8), [name])], [("name", ogr.OFTString)])
        self.run_well("hazard", self.path("out"), "--objects", self.path("first.gpkg"))
        log_left_by_a_viewer(self.path("out/objects.gpkg"))
        self.run_well("hazard", self.path("out"), "--objects", self.path("second.gpkg"), "--overwrite")
        self.assertFalse(os.path.exists(self.path("out/objects.gpkg-wal")))
        self.assertEqual(sqlite_rows(self.path("out/objects.gpkg"), "pragma integrity_check"), [("ok",)])
        self.assertEqual(sqlite_rows(self.path("out/objects.gpkg"), "select name from objects"), [("second",)])
        longest = "select max(length(description)) from gpkg_contents"
        self.assertLess(sqlite_rows(self.path("out/objects.gpkg"), longest)[0][0], 1000)
        log_left_by_a_viewer(self.path("out/objects.gpkg"))
        self.run_well("hazard", self.path("out"), "--overwrite")  # without objects
        self.assertEqual([name for name in os.listdir(self.path("out")) if name.startswith("objects")], [])

    def test_a_replacement_that_was_killed(self):
        """What is left then (tests/io/hazard_file_test.cpp has how): a record of all files, some of them not there yet."""
        self.simulated()
        self.run_well("hazard", self.path("out"), "--width", "10")
        names = self.read_json("out/hazard.json")["files"]
        self.write("out/hazard.json", json.dumps({"program": "talus", "status": "incomplete", "files": [*names, "return_period_30.tif"]}))
        os.remove(self.path("out/hazard_class.tif"))
        self.fails(2, "the hazard maps are incomplete", "--overwrite", arguments=["report", self.path("out")])
        self.run_well("hazard", self.path("out"), "--overwrite")
        self.run_well("report", self.path("out"))

    def started(self, *more):
        """A program that has made its hidden folder, and the name of that."""
        process = subprocess.Popen([TALUS, "hazard", self.path("out"), "-q", "--overwrite", *more])
        self.addCleanup(process.kill)
        hidden = f".hazard.talus-{process.pid}"
        while process.poll() is None and not os.path.exists(self.path(f"out/{hidden}/.lock")):
            time.sleep(0.001)
        return process, hidden

    def hidden(self):
        return [name for name in os.listdir(self.path("out")) if name.startswith(".")]

    def test_two_at_once(self):
        self.simulated()
        write_features(self.path("houses.gpkg"), "houses", [(box(105, 150, 10, 8), [])])
        self.run_well("hazard", self.path("out"), "-q")
        first, hidden = self.started("--objects", self.path("houses.gpkg"))
        first.send_signal(signal.SIGSTOP)
        self.fails(2, "another process is writing its hazard.json", hidden,
                   arguments=["hazard", self.path("out"), "--overwrite", "--width", "30", "--curves"])
        first.send_signal(signal.SIGCONT)
        self.assertEqual(first.wait(60), 0)
        self.run_well("hazard", self.path("out"), "-q", "--overwrite", "--width", "30", "--curves")
        named = self.read_json("out/hazard.json")["files"]
        of_run = self.record()["files"]
        self.assertEqual(sorted(os.listdir(self.path("out"))), sorted({*named, *of_run, "hazard.json", "run.json"}))

    def test_what_was_killed_is_removed_by_the_next(self):
        self.simulated()
        os.mkdir(self.path("out/.hazard.talus-mine"))  # without the lock file of a program
        first, hidden = self.started()
        first.kill()
        first.wait()
        self.assertEqual(sorted(self.hidden()), sorted([hidden, ".hazard.talus-mine"]))
        self.run_well("hazard", self.path("out"), "-q", "--overwrite")
        self.assertEqual(self.hidden(), [".hazard.talus-mine"])

    def test_a_run_that_is_not_to_be_used_is_said(self):
        self.simulated()
        record = self.record()
        self.write("out/run.json", json.dumps({**record, "status": "too many trajectories ended at a limit"}))
        done = self.run_well("hazard", self.path("out"))
        self.assertIn('the run ended with status "too many trajectories ended at a limit": do not use its results', done.stderr)
        self.assertTrue(any("do not use its results" in warning for warning in self.read_json("out/hazard.json")["warnings"]))

    def test_repeats_that_maps_end_too_early(self):
        self.simulated()
        told = ["4 % of the trajectories (4) were trapped in pits or between walls, on ground", "5 % of the sample (5) stay in gullies "
                "steeper than phi: there", "0.01 % of the trajectories (1) still moved when they reached the limit of time, impacts"]
        self.write("out/run.json", json.dumps({**self.record(), "warnings": [*told, "73 cells of the DEM have a way down"]}))
        done = self.run_well("hazard", self.path("out"))
        for words in told:
            self.assertIn(f"talus: warning: {words}", done.stderr)
        self.assertNotIn("73 cells", done.stderr)

    def test_contradicting_frequencies(self):
        self.write("s.toml", RUN + "[frequency]\nper_area = 0.01\n")
        self.refused("must be given by one of them", "run", self.path("s.toml"), "-o", self.path("out"))

    def test_check_tells(self):
        done = self.run_well("check", self.path("s.toml"))
        self.assertIn("0.52 events per year", done.stdout)

    def test_faults_of_objects_are_found_before_the_maps(self):
        self.simulated()
        write_features(self.path("doors.gpkg"), "doors", [("POINT (2600110 1200155)", ["A"])], [("name", ogr.OFTString)])
        done = self.call("hazard", self.path("out"), "--objects", self.path("doors.gpkg"), "--progress=json")
        self.assertEqual(done.returncode, 2)
        self.assertIn("feature 1: is a point, must be a polygon or a line that blocks may hit; make areas of points first, as wide "
                      "as the houses (Buffer, in QGIS)", done.stderr)
        self.assertNotIn("evaluate", done.stdout + done.stderr)

    def test_objects(self):
        """A house below each cliff, one out of reach; a road in another system that all blocks must cross."""
        self.simulated()
        write_features(self.path("houses.gpkg"), "houses",
                       [(box(105, 150, 10, 8), ["A", 3]), (box(205, 150, 10, 8), ["B", 4]),
                        (box(5, 5, 8, 8), ["C", 1])],
                       [("name", ogr.OFTString), ("people", ogr.OFTInteger)])
        done = self.run_well("hazard", self.path("out"), "--objects", self.path("houses.gpkg"))
        self.assertIn("repeats the run for the objects: 3 200 trajectories of the recorded plan", done.stderr)
        self.assertIn("energies of objects are the largest within the outline", done.stderr)
        rows = {row["name"]: row for row, _ in rows_of(self.path("out/objects.gpkg"), "objects")}
        self.assertEqual([rows[name]["people"] for name in "ABC"], [3, 4, 1])
        said = dict(re.findall(r"talus: ([ABC]): (.*)", done.stderr))  # the most often hit first
        for name in "AB":
            self.assertEqual(said[name], f"hit {rows[name]['frequency']:.3g} times per year, once in "
                             f"{rows[name]['return_period']:.3g} years (95 %: {rows[name]['frequency_lower']:.3g} to "
                             f"{rows[name]['frequency_upper']:.3g} per year)")
        self.assertEqual(said["C"], f"hit by no block of this run; at most {rows['C']['frequency_upper']:.3g} times per year (95 %)")
        self.assertEqual(list(said)[-1], "C")
        table = self.read_table("out/objects.csv")
        self.assertEqual([(row["object"], row["name"], row["people"]) for row in table],
                         [("A", "A", "3"), ("B", "B", "4"), ("C", "C", "1")])
        self.assertEqual(list(table[0]), list(rows["A"]))  # the columns of the layer
        self.assertEqual([rows[name]["object"] for name in "ABC"], ["A", "B", "C"])
        self.assertAlmostEqual(float(table[0]["frequency"]), rows["A"]["frequency"], 6)
        self.assertEqual(rows["C"]["trajectories"], 0)
        self.assertEqual(rows["C"]["frequency"], 0.0)
        self.assertIsNone(rows["C"]["return_period"])
        self.assertIn("west 100 %", rows["A"]["sources"])
        for name in "AB":
            self.assertAlmostEqual(rows[name]["frequency"] * rows[name]["return_period"], 1.0)
            self.assertLessEqual(rows[name]["frequency_lower"], rows[name]["frequency"])
            self.assertLessEqual(rows[name]["frequency"], rows[name]["frequency_upper"])
        for row in rows.values():
            # The matrix of docs/hazard.md, by 30, 100, 300 years; a row per intensity
            for (name, of), end in itertools.product((("hazard_class", "frequency"), ("entry_class", "entry")), ("", "_lower")):
                rates = [row[key + end] for key in ("frequency", of + "_30", of + "_300")]
                years = [1.0 / rate if rate > 0.0 else math.inf for rate in rates]
                classes = [rows_of_class[sum(t > limit * (1 + 1e-9) for limit in (30, 100, 300))]
                           for t, rows_of_class in zip(years, ((3, 2, 2, 1), (4, 3, 3, 1), (4, 4, 4, 1))) if t < math.inf]
                self.assertEqual(row[name + end], max(classes, default=0), (row["object"], name + end, years))
            self.assertGreaterEqual(row["hazard_class_upper"], row["hazard_class"])
            self.assertGreaterEqual(row["entry_class_upper"], row["entry_class"])
            self.assertGreaterEqual(row["hazard_class"], row["entry_class"])  # the energy at the entry is not the larger one
        self.assertGreater(rows["A"]["hazard_class"], rows["C"]["hazard_class"])
        # Every cell that a house wholly covers is crossed less often than the house is hit.
        frequency = bands_of(self.path("out/annual_frequency.tif"))[0]
        self.assertGreaterEqual(rows["A"]["frequency"], frequency[29, 21] - 1e-9)
        self.assertLessEqual(rows["A"]["frequency"], 0.5 + 1e-9)
        self.assertNotIn("are not copied", done.stderr)
        for values in table[:2]:
            curve = [row for row in self.read_table("out/objects_curves.csv") if row["object"] == values["object"]]
            for key, sign in (("energy_kj", 1), ("frequency", -1)):
                numbers = [sign * float(row[key]) for row in curve]
                self.assertEqual(numbers, sorted(numbers))
            by_energy = {float(row["energy_kj"]): row for row in curve}
            self.assertEqual(len(by_energy), len(curve), "each energy once")  # 30 kJ, the edge of a bin, was there twice
            for row, column in ((curve[0], "frequency"), (by_energy[30.0], "frequency_30")):
                self.assertEqual([row[key] for key in ("frequency", "lower", "upper")],
                                 [values[column + end] for end in ("", "_lower", "_upper")], "as in objects.csv")
        self.assertEqual({row["feature"] for row in self.read_table("out/objects_sources.csv")}, {"west", "east"})
        shares = [float(row["share"]) for row in self.read_table("out/objects_sources.csv") if row["object"] == "B"]
        self.assertAlmostEqual(sum(shares), 1.0, 4)
        self.run_well("hazard", self.path("out"), "--objects", self.path("houses.gpkg"), "--overwrite", "-q",
                      "--threads", "2")
        again = {row["name"]: row for row, _ in rows_of(self.path("out/objects.gpkg"), "objects")}
        self.assertEqual(rows, again)

    def test_objects_that_only_blocks_of_frequency_0_hit(self):
        """They are not safe from the blocks of the run: only nothing falls from there by the field."""
        self.place_sources([(box(100, 230, 20, 10), ["west", 0.5]), (box(200, 230, 20, 10), ["east", 0.0])])
        write_features(self.path("houses.gpkg"), "houses", [(box(105, 150, 10, 8), ["A"]), (box(205, 150, 10, 8), ["B"]),
                                                            (box(5, 5, 8, 8), ["C"])], [("name", ogr.OFTString)])
        self.simulate()
        done = self.run_well("hazard", self.path("out"), "--objects", self.path("houses.gpkg"))
        rows = {row["name"]: row for row, _ in rows_of(self.path("out/objects.gpkg"), "objects")}
        said = dict(re.findall(r"talus: ([ABC]): (.*)", done.stderr))
        self.assertGreater(rows["B"]["trajectories"], 1)
        self.assertEqual([rows["B"]["frequency"], rows["B"]["return_period"]], [0.0, None])
        self.assertTrue(said["A"].startswith("hit 0."), said["A"])
        self.assertTrue(said["B"].startswith(f"hit by {rows['B']['trajectories']:.0f} blocks, all of sources or block classes with a "
                                             "frequency of 0; at most "), said["B"])
        self.assertTrue(said["C"].startswith("hit by no block of this run; at most "), said["C"])

    def test_fields_of_objects_that_are_named_as_results_are_said(self):  # they were dropped in silence
        self.simulated()
        write_features(self.path("houses.gpkg"), "houses", [(box(105, 150, 10, 8), ["A", 7.5, "mine", 3, "x"])],
                       [("name", ogr.OFTString), ("Frequency", ogr.OFTReal), ("sources", ogr.OFTString),
                        ("people", ogr.OFTInteger), ("object", ogr.OFTString)])
        self.write("register.csv", f'name,fid,wkt\nA,501,"{box(105, 150, 10, 8)}"\n')
        self.assertIn("are not copied into objects.gpkg and objects.csv: fid;",
                      self.run_well("hazard", self.path("out"), "--objects", self.path("register.csv")).stderr)
        done = self.run_well("hazard", self.path("out"), "--objects", self.path("houses.gpkg"), "--overwrite")
        words = ("houses.gpkg: fields named as columns of the results are not copied into objects.gpkg and objects.csv: "
                 "Frequency, sources, object; rename them to keep them")
        self.assertIn(words, done.stderr)
        self.assertEqual(sum(words in warning for warning in self.read_json("out/hazard.json")["warnings"]), 1)
        ((row, _),) = rows_of(self.path("out/objects.gpkg"), "objects")
        self.assertEqual([row["people"], row["object"]], [3, "A"])
        self.assertLessEqual(row["frequency"], 0.5)
        self.assertIn("west", row["sources"])

    def test_a_diameter_in_place_of_classes_with_frequencies_is_said(self):
        """0.9 and 0.1 events per year of the classes go with them."""
        words = "flag --diameter = 1: takes the place of the block classes of the scenario, and their 1 events per year are dropped with them"
        self.classes_run("out")
        self.assertFalse(any("flag --diameter" in warning for warning in self.record()["warnings"]))
        done = self.run_well("run", self.path("s.toml"), "-o", self.path("one"), "--diameter", "1")
        self.assertIn(words + "; unless the sources or [frequency] say how often blocks fall, give --frequency for a hazard", done.stderr)
        self.assertEqual(sum(words in warning for warning in self.record("one")["warnings"]), 1)
        self.assertFalse(os.path.exists(self.path("one/hazard_tally.gz")))
        said = self.run_well("check", self.path("s.toml"), "--diameter", "1", "--frequency", "2").stdout
        self.assertIn(words, said)
        self.assertNotIn("say with --frequency", said)
        self.write("s.toml", RUN.replace("0.8", "[{ diameter = 0.6 }, { diameter = 1.4 }]"))
        self.assertNotIn("flag --diameter = 1: takes", self.run_well("check", self.path("s.toml"), "--diameter", "1").stdout)

    def test_objects_where_blocks_do_not_get(self):
        """A gap of the DEM, its outer half cell and what is off it are not safe: blocks end there."""
        z = heights()
        z[28:32, 20:24] = -9999.0  # no height from x = 97.5 to 122.5 and y = 137.5 to 162.5
        write_dem(self.path("dem.tif"), z, nodata=-9999.0)
        road = f"LINESTRING ({2600000 + 1} {1200000 + 50},{2600000 + 1} {1200000 + 250})"
        shapes = [(box(97.6, 137.6, 24.8, 24.8), ["gap"]), (road, ["edge"]), (box(280, 100, 350, 20), ["mostly off"]),
                  (box(205, 150, 10, 8), ["well"]), (box(102.5, 157.5, 10, 20), ["rim"]), (box(5000, 0, 9, 9), ["far"])]
        write_features(self.path("o.gpkg"), "o", shapes, [("name", ogr.OFTString)])
        self.simulate()
        done = self.run_well("hazard", self.path("out"), "--objects", self.path("o.gpkg"))
        self.assertIn("objects wholly off the DEM, which have no results: far\n", done.stderr)
        self.assertIn("objects wholly in gaps of the DEM or in its outer half cell, which have no results: gap, edge\n", done.stderr)
        self.assertIn("where the DEM has no height (off it, in its outer half cell or in a gap) lie 95 % of object mostly off, "
                      "25 % of object rim: blocks do not get there, so that the frequencies are lower bounds (unsafe)", done.stderr)
        self.assertRegex(done.stderr, r"talus: mostly off: .*; the 95 % of it where the DEM has no height is not assessed\n")
        self.assertNotRegex(done.stderr, r"talus: (gap|edge|far): ")
        self.assertNotRegex(done.stderr, r"talus: well: .* is not assessed")
        rows = {row["name"]: row for row, _ in rows_of(self.path("out/objects.gpkg"), "objects")}
        table = {row["object"]: row for row in self.read_table("out/objects.csv")}
        for name in ("gap", "edge", "far"):  # blocks touch the rim of the gap: it had a return period
            self.assertEqual([key for key, value in rows[name].items() if value], ["object", "name", "share_without_height"], name)
            self.assertEqual([key for key, value in table[name].items() if value], ["object", "name", "share_without_height"], name)
            self.assertIsNone(rows[name]["frequency"])
        for name, share, bounded in (("well", 0.0, True), ("rim", 0.25, False), ("mostly off", 0.95, False)):
            self.assertAlmostEqual(rows[name]["share_without_height"], share, 2)
            self.assertIsNotNone(rows[name]["frequency"])
            for column in ("frequency_upper", "frequency_30_upper", "energy_T100_upper", "hazard_class_upper"):
                self.assertEqual((rows[name][column] is not None, table[name][column] != ""), (bounded, bounded), (name, column))
            curve = [row for row in self.read_table("out/objects_curves.csv") if row["object"] == name]
            self.assertTrue(curve and all((row["upper"] != "") == bounded for row in curve), name)
        self.assertRegex(done.stderr, r"talus: mostly off: hit .* or more per year\); the 95 %")
        write_features(self.path("far.gpkg"), "o", [(box(5000, 0, 9, 9), ["far"])], [("name", ogr.OFTString)])
        self.fails(2, "far.gpkg: lies wholly off the DEM: its features reach over east 2605000 to 2605009",
                   "the DEM over east 2600000 to 2600300", "is the coordinate system of the layer the right one?",
                   arguments=["hazard", self.path("out"), "--objects", self.path("far.gpkg"), "--overwrite", "-q"])
        write_features(self.path("gap.gpkg"), "o", shapes[:1], [("name", ogr.OFTString)])
        self.fails(2, "gap.gpkg: none of its objects lies where the DEM has a height", "fill the gaps of the DEM",
                   arguments=["hazard", self.path("out"), "--objects", self.path("gap.gpkg"), "--overwrite", "-q"])

    def test_objects_of_one_name(self):
        self.simulated()
        shapes = [(box(105, 150, 10, 8), ["house"]), (box(205, 150, 10, 8), ["house"]), (box(5, 5, 8, 8), [None]),
                  (box(205, 120, 10, 8), ["3"]), (box(105, 120, 10, 8), ["barn"])]
        write_features(self.path("o.gpkg"), "o", shapes, [("name", ogr.OFTString)])
        done = self.run_well("hazard", self.path("out"), "--objects", self.path("o.gpkg"))
        self.assertIn("several objects have the same name (of --name-field, else name, id, object or the number of the feature), so that their rows in "
                      "objects_curves.csv and objects_sources.csv cannot be told apart: 3, house\n", done.stderr)
        write_features(self.path("p.gpkg"), "o", shapes[1:3], [("name", ogr.OFTString)])
        done = self.run_well("hazard", self.path("out"), "--objects", self.path("p.gpkg"), "--overwrite")
        self.assertNotIn("the same name", done.stderr)

    def test_sources_of_one_name_are_told_apart(self):
        write_features(self.path("sources.gpkg"), "sources", [(box(100, 230, 20, 10), ["cliff", 0.5]), (box(200, 230, 20, 10), ["cliff", 0.02])],
                       [("name", ogr.OFTString), ("frequency", ogr.OFTReal)])
        self.write("s.toml", FEW)
        self.simulate()
        write_features(self.path("houses.gpkg"), "houses", [(box(x, 150, 10, 8), [name]) for x, name in ((105, "A"), (205, "B"))],
                       [("name", ogr.OFTString)])
        self.run_well("hazard", self.path("out"), "--objects", self.path("houses.gpkg"), "-q")
        rows = self.read_table("out/objects_sources.csv")
        largest = {name: max((row for row in rows if row["object"] == name), key=lambda row: float(row["share"])) for name in "AB"}
        self.assertEqual([largest[name]["feature"] for name in "AB"], ["cliff (FID 1)", "cliff (FID 2)"])

    def test_objects_without_a_name_are_called_by_their_id(self):  # by their number, which may be the id of another
        self.simulated()
        shapes = [(box(105, 150, 10, 8), [None, "2"]), (box(205, 150, 10, 8), ["house", "1"]), (box(5, 5, 8, 8), [" ", None])]
        write_features(self.path("o.gpkg"), "o", shapes, [("name", ogr.OFTString), ("id", ogr.OFTString)])
        done = self.run_well("hazard", self.path("out"), "--objects", self.path("o.gpkg"))
        self.assertEqual([row["object"] for row in self.read_table("out/objects.csv")], ["2", "house", "3"])
        self.assertNotIn("the same name", done.stderr)
        shapes[2][1][:] = ["2", None]
        write_features(self.path("p.gpkg"), "o", shapes, [("name", ogr.OFTString), ("id", ogr.OFTString)])
        done = self.run_well("hazard", self.path("out"), "--objects", self.path("p.gpkg"), "--overwrite")
        self.assertIn("several objects have the same name", done.stderr)

    def test_objects_of_a_table(self):
        """Names stay as they stand (0123 was 123, a date changed its look), numbers are numbers in the GeoPackage."""
        self.simulated()
        shapes = [(box(105, 150, 10, 8), "0123,2020-01-01,5,1.50,"), (box(205, 150, 10, 8), "12345678901234567891,,,2,"),
                  (box(5, 5, 8, 8), "7,x,-3,,")]
        self.write("o.csv", "wkt,name,built,people,value,width\n" + "".join(f'"{wkt}",{cells}\n' for wkt, cells in shapes))
        done = self.run_well("hazard", self.path("out"), "--objects", self.path("o.csv"))
        self.assertNotIn("the field width of", done.stderr)  # it is empty
        names = ["0123", "12345678901234567891", "7"]
        table = self.read_table("out/objects.csv")
        self.assertEqual([row["object"] for row in table], names)
        self.assertEqual([row["name"] for row in table], names)
        self.assertEqual([row["people"] for row in table], ["5", "", "-3"])
        rows = [row for row, _ in rows_of(self.path("out/objects.gpkg"), "objects")]
        self.assertEqual([row["name"] for row in rows], names)
        self.assertEqual([row["built"] for row in rows], ["2020-01-01", "", "x"])
        self.assertEqual([row["people"] for row in rows], [5, None, -3])
        self.assertEqual([row["value"] for row in rows], [1.5, 2.0, None])

    def test_ids_of_a_table_stay_as_they_stand(self):
        """They became 1.1, 1.1; 43123456, 7; 1000, 2000. Numbers stay numbers, however people write them."""
        self.simulated()
        rows = {"id": ("1.10", "1.1"), "phone": ("+43123456", "7"), "code": ("1e3", "2e3"), "plot": ("01.50", "2.50"),
                "height": ("0.50", "-12.0"), "share": ("1e-05", ".25"), "floors": ("0", "12")}
        text = "wkt," + ",".join(rows) + "\n"
        for i, x in enumerate((105, 205)):
            text += ",".join([f'"{box(x, 150, 10, 8)}"', *(cells[i] for cells in rows.values())]) + "\n"
        self.run_well("hazard", self.path("out"), "--objects", self.write("o.csv", text), "-q")
        table = self.read_table("out/objects.csv")
        layer = [row for row, _ in rows_of(self.path("out/objects.gpkg"), "objects")]
        for name in ("id", "phone", "code", "plot"):
            for found in (table, layer):
                self.assertEqual(tuple(row[name] for row in found), rows[name])
        self.assertEqual([row["object"] for row in layer], ["1.10", "1.1"])
        for name, numbers in (("height", [0.5, -12.0]), ("share", [1e-5, 0.25]), ("floors", [0, 12])):
            self.assertEqual([row[name] for row in layer], numbers)
            self.assertEqual([float(row[name]) for row in table], numbers)

    def test_lists_of_objects_are_written_as_json(self):  # (2:a,b)
        self.simulated()
        given = {"tags": ["a", "b, \"c\""], "floors": [1, 2], "heights": [0.5, 12.25]}
        geometry = json.loads(ogr.CreateGeometryFromWkt(box(105, 150, 10, 8)).ExportToJson())
        self.write("o.geojson", json.dumps({"type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": "EPSG:2056"}},
                                            "features": [{"type": "Feature", "properties": given, "geometry": geometry}]}))
        self.run_well("hazard", self.path("out"), "--objects", self.path("o.geojson"), "-q")
        (table,), ((layer, _),) = self.read_table("out/objects.csv"), rows_of(self.path("out/objects.gpkg"), "objects")
        for row in (table, layer):
            self.assertEqual({name: json.loads(row[name]) for name in given}, given)

    def test_frequencies_of_any_size(self):
        """More years than a float holds are no value of a map (they were infinite), and the tables of such a run can be reported."""
        self.place_sources([(box(100, 230, 20, 10), ["west", 1e-60]), (box(200, 230, 20, 10), ["east", 1e-60])])
        write_features(self.path("houses.gpkg"), "houses", [(box(105, 150, 10, 8), ["A"])], [("name", ogr.OFTString)])
        self.simulate()
        self.run_well("hazard", self.path("out"), "-q", "--objects", self.path("houses.gpkg"))
        self.assertTrue((bands_of(self.path("out/return_period_30.tif")) == -9999).all())
        (house,) = self.read_table("out/objects.csv")
        self.assertGreaterEqual(float(house["return_period"]), 1e60)  # at most as often as a block falls
        self.run_well("report", self.path("out"), "-q")
        self.assertIn(f"<td class='n'>{float(house['return_period']):.3g} [", self.read_text("out/report.html"))

    def titles(self, name):
        """Title of a raster, and names of its bands."""
        file = gdal.Open(self.path(name))
        return [file.GetMetadataItem("TITLE")] + [file.GetRasterBand(b + 1).GetDescription() for b in range(file.RasterCount)]

    def test_an_object_of_some_width(self):
        self.simulated()
        done = self.run_well("hazard", self.path("out"))
        self.assertIn("hazard of a cell, 5 x 5 m", done.stderr)
        self.assertIn("(in plan, at any height)", self.titles("out/annual_frequency.tif")[1])
        sums = {}
        for width in (4, 20):
            done = self.run_well("hazard", self.path("out"), "--overwrite", "--width", str(width))
            self.assertIn(f"an object {width} m wide", done.stderr)
            for name in ("annual_frequency", "return_period_30", "hazard_class"):
                self.assertIn(f"an object {width} m wide", self.titles(f"out/{name}.tif")[0])
            self.assertFalse(os.path.exists(self.path("out/intensity_T30.tif")), "needs the whole curve")
            value, lower, upper = bands_of(self.path("out/annual_frequency.tif"))
            self.assertTrue(((lower <= value) & (value <= upper)).all())
            sums[width] = value.sum()
            self.assertEqual(self.read_json("out/hazard.json")["object"], {"width_m": width, "passages_below_m": 0})
        # Over all places an object of W is hit (W + D) times the length of all paths: D is 0.8 m. Rows at the edge lose a little.
        self.assertAlmostEqual(sums[20] / sums[4], 20.8 / 4.8, delta=0.05)
        self.run_well("hazard", self.path("out"), "--overwrite", "--width", "20", "-q", "--threads", "2")
        self.assertTrue((bands_of(self.path("out/annual_frequency.tif"))[0] == value).all())

    def test_widths_in_centimetres_and_an_old_report_are_said(self):
        self.simulated()
        line = f'"LINESTRING ({WEST + 20} {NORTH - 200}, {WEST + 280} {NORTH - 200})"'
        self.write("road.csv", f"wkt,name,width,fid\n{line},narrow,100,1\n{line},wide,700,2\n")
        first = self.run_well("hazard", self.path("out"), "--objects", self.path("road.csv"), "--width", "100")
        self.assertEqual(first.stderr.count("wider than any road: must be in metres"), 1)
        self.assertIn("width = 700 m, wider than any road", first.stderr)
        self.assertNotIn("--width 100:", first.stderr)
        self.assertNotIn("report.html", first.stderr)
        self.run_well("report", self.path("out"))
        second = self.run_well("hazard", self.path("out"), "--width", "101", "--overwrite")
        self.assertIn("warning: --width 101: an object as wide is hit by what passes anywhere near", second.stderr)
        self.assertIn("warning: report.html shows the results that were here before: talus report ", second.stderr)

    def test_rare_blocks_in_several_rounds(self):
        """A source of 1e-5 events per year beside one of 1000: where only its blocks pass, an object of 1 m (less than a cell) is hit
        w (W + D) times the length of their paths over the area, which passage_density.tif has; in any number of rounds."""
        points, fields = ("POINT (2600060 1200235)", "POINT (2600240 1200235)"), [("name", ogr.OFTString), ("frequency", ogr.OFTReal)]
        write_features(self.path("sources.gpkg"), "sources", [(points[0], ["often", 1000.0])], fields)
        self.simulate("often", "--diameter", "1")
        write_features(self.path("sources.gpkg"), "sources", [(points[0], ["often", 1000.0]), (points[1], ["rare", 1e-5])], fields)
        reached = bands_of(self.path("often/passages.tif")) > 0
        maps = {}
        for out, rounds in (("one", ()), ("two", ("--rounds", "2", "--trajectories", "100")),
                            ("until", ("--until-error", "0.001", "--most-rounds", "4", "--trajectories", "50")),
                            ("many", ("--until-error", "10", "--most-rounds", "10000"))):
            self.simulate(out, "--diameter", "1", *rounds)
            self.run_well("hazard", self.path(out), "--width", "1", "-q")
            self.assertEqual(self.record(out)["released"], 400)
            frequency, density = (bands_of(self.path(f"{out}/{name}.tif"))[0] for name in ("annual_frequency", "passage_density"))
            rare = (density > 0) & ~reached
            self.assertGreater(np.count_nonzero(rare), 100)
            by_hand = density[rare] * 400 * (1e-5 / 200) * (1.0 + 1.0)
            np.testing.assert_allclose(frequency[rare], by_hand, rtol=5e-4, atol=2e-11, err_msg=out)  # atol: of paths that only graze
            self.assertAlmostEqual(frequency[rare].sum() / by_hand.sum(), 1.0, 4)
            maps[out] = frequency[rare]
        for out in ("two", "until", "many"):
            np.testing.assert_allclose(maps[out], maps["one"], rtol=5e-4, atol=2e-11, err_msg=out)

    def test_hazard_curves(self):
        """At 0 and at the thresholds they are the other maps, they fall with the energy, and with --width they are its maps."""
        self.simulated()
        for width in ([], ["--width", "10"]):
            self.run_well("hazard", self.path("out"), "--curves", "--overwrite", "-q", *width)
            energies = self.read_json("out/hazard.json")["curve_energies_kj"]
            curves = bands_of(self.path("out/hazard_curves.tif"))
            self.assertEqual(len(energies), curves.shape[0])
            terrain = curves[0] != -9999
            self.assertTrue((curves[:-1] >= curves[1:])[:, terrain].all())
            np.testing.assert_array_equal(curves[0], bands_of(self.path("out/annual_frequency.tif"))[0])
            for energy in (30, 300):
                period = bands_of(self.path(f"out/return_period_{energy}.tif"))[0]
                curve = curves[energies.index(energy)]
                self.assertTrue(((period == -9999) == (curve <= 0)).all())
                np.testing.assert_allclose(curve[curve > 0], 1 / period[curve > 0], rtol=1e-6)
        self.assertEqual(energies, [0, 30, 300])
        self.run_well("hazard", self.path("out"), "--overwrite", "-q")
        self.assertFalse(os.path.exists(self.path("out/hazard_curves.tif")), "not asked for")

    def test_lines_have_a_width(self):
        self.simulated()
        line = "LINESTRING (2600020 1200150, 2600280 1200150)"
        write_features(self.path("roads.gpkg"), "roads", [(line, ["road", 6.0]), (line, ["path", None])],
                       [("name", ogr.OFTString), ("width", ogr.OFTReal)])
        found = {}
        for width in ("0", "6", "20"):
            more = [] if width == "0" else ["--width", width]
            done = self.run_well("hazard", self.path("out"), "--objects", self.path("roads.gpkg"), "--overwrite", *more)
            self.assertIn("lines: 1 as wide as their field width says; 1 without a field width, taken as " + width + " m wide", done.stderr)
            found[width] = {row["name"]: row for row, _ in rows_of(self.path("out/objects.gpkg"), "objects")}
        without_name = lambda row: {k: v for k, v in row.items() if k not in ("object", "name", "width")}
        self.assertEqual(without_name(found["6"]["path"]), without_name(found["6"]["road"]))
        self.assertEqual(found["0"]["road"], found["20"]["road"])
        self.assertGreaterEqual(found["20"]["path"]["trajectories"], found["0"]["path"]["trajectories"])
        for row in (found["0"]["path"], found["20"]["path"]):
            self.assertLessEqual(row["entry_30"], row["frequency_30"])
        self.assertGreaterEqual(found["20"]["path"]["frequency_30"], found["0"]["path"]["frequency_30"])
        write_features(self.path("bad.gpkg"), "roads", [(line, ["road", -6.0])],
                       [("name", ogr.OFTString), ("width", ogr.OFTReal)])
        self.refused("field width = -6", "hazard", self.path("out"), "--objects", self.path("bad.gpkg"), "--overwrite")

    def test_a_width_of_0_in_the_field_is_said(self):  # it counted as given, without a word
        self.simulated()
        line = "LINESTRING (2600020 1200150, 2600280 1200150)"
        write_features(self.path("roads.gpkg"), "roads", [(line, ["a", 0.0]), (line, ["b", 4.0])],
                       [("name", ogr.OFTString), ("width", ogr.OFTReal)])
        done = self.run_well("hazard", self.path("out"), "--objects", self.path("roads.gpkg"))
        self.assertIn("width = 0 of 1 line: a road of some width is hit more often (unsafe)", done.stderr)

    def test_the_width_of_a_polygon_is_not_read(self):
        self.simulated()
        house = "POLYGON ((2600100 1200140, 2600120 1200140, 2600120 1200160, 2600100 1200160, 2600100 1200140))"
        write_features(self.path("houses.gpkg"), "houses", [(house, ["house", "6 m"])],
                       [("name", ogr.OFTString), ("width", ogr.OFTString)])
        done = self.run_well("hazard", self.path("out"), "--objects", self.path("houses.gpkg"), "--overwrite")
        self.assertIn("the field width of 1 polygons is not used", done.stderr)

    def test_width_refusals(self):
        self.simulated()
        for width in ("0", "-3", "wide", "2000", "nan"):
            done = self.call("hazard", self.path("out"), "--width", width)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn("must be above 0 and at most 1000 m", done.stderr)
        matrix = self.write("m.toml", 'energies = [100]\nyears = [50]\nclasses = [[1, 0], [2, 1]]\n')
        self.refused("must be one of the run's energy thresholds", "hazard", self.path("out"), "--width", "10", "--matrix", matrix)

    def test_only_passages_below_a_height(self):
        """Over 0.5 m less is counted than over 1 km, which is as at any height."""
        sums = {}
        for below in (0, 0.5, 1000):
            self.write("s.toml", RUN + f"[output]\npassages_below = {below}\n")
            self.simulate(f"out{below}")
            sums[below] = bands_of(self.path(f"out{below}/passage_density.tif"))
        self.assertTrue((sums[0] == sums[1000]).all())
        self.assertLess(sums[0.5][0].sum(), 0.9 * sums[0][0].sum())
        self.assertTrue((sums[0.5] <= sums[0] * (1 + 1e-6) + 1e-12)[0].all())
        self.assertIn("lower than 0.5 m above the terrain", self.titles("out0.5/passage_density.tif")[1])
        write_features(self.path("houses.gpkg"), "houses", [(box(105, 150, 10, 8), ["A"])], [("name", ogr.OFTString)])
        for below in (0, 0.5):
            done = self.run_well("hazard", self.path(f"out{below}"), "--objects", self.path("houses.gpkg"))
            self.assertEqual(f"at any height: [output] passages_below = {below} m holds for" in done.stderr, below > 0, done.stderr)
            self.assertNotIn("removed", done.stderr)
        done = self.run_well("hazard", self.path("out0.5"), "--width", "10", "--overwrite")
        self.assertIn("removed, as not asked for this time: intensity_T100.qml, intensity_T100.tif", done.stderr)
        for name in ("objects.csv", "objects.gpkg", "objects_curves.csv", "objects_sources.csv"):
            self.assertIn(name, done.stderr)
            self.assertFalse(os.path.exists(self.path("out0.5/" + name)))
        self.assertIn("lower than 0.5 m above the terrain", self.titles("out0.5/annual_frequency.tif")[0])

    def test_objects_need_the_same_inputs(self):
        self.simulated()
        write_features(self.path("houses.gpkg"), "houses", [(box(105, 150, 10, 8), ["A"])], [("name", ogr.OFTString)])
        write_dem(self.path("dem.tif"), heights() + 1.0)
        self.refused("has changed since the run", "hazard", self.path("out"), "--objects", self.path("houses.gpkg"))


if __name__ == "__main__":
    unittest.main()
