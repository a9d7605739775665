"""Thresholds, frequencies, classes and objects that count the energy with rotation, as a user calls it."""
import collections
import os
import re
import unittest

import numpy as np
from osgeo import gdal, ogr

from support import Case, KeptRuns, OneThread, band_names, bands_of, box, write_features

RUN = """dem = "dem.tif"
trajectories = 200
[sources]
file = "sources.gpkg"
[blocks]
diameter = 0.8
[screens]
file = "screens.gpkg"
[output]
energy_thresholds = [8, 30]
"""
COUNTED = {"energy_exceedance", "energy_total", "hazard_tally", "passage_density", "scenario", "run", "talus"}  # the files that may differ
MATRIX = "energies = [8, 30]\n"


def title_of(path):
    dataset = gdal.Open(path)
    return dataset.GetMetadataItem("TITLE")


class CountRotation(OneThread, KeptRuns, Case):
    def setUp(self):
        super().setUp()
        write_features(self.path("sources.gpkg"), "sources",
                       [(box(100, 230, 20, 10), ["west", 0.5]), (box(200, 230, 20, 10), ["east", 0.02])],
                       [("name", ogr.OFTString), ("frequency", ogr.OFTReal)])
        line = "LINESTRING (2600000 1200150,2600300 1200150)"
        write_features(self.path("screens.gpkg"), "screens", [(line, ["road"])], [("id", ogr.OFTString)])
        write_features(self.path("road.gpkg"), "road", [(line, ["road"])], [("name", ogr.OFTString)])
        self.write("s.toml", RUN)
        self.write("m.toml", MATRIX)

    def runs(self):
        self.keep_scenario("plain")
        self.keep_scenario("total", "--count-rotation")

    def hazard(self, out, *more):
        return self.run_well("hazard", self.path(out), "--overwrite", "--matrix", self.path("m.toml"), *more).stderr

    def map(self, out, name):
        return bands_of(self.path(f"{out}/{name}.tif"))

    def bytes_of(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def test_exceedances_are_of_the_energy_that_counts_and_nothing_else_changes(self):
        self.runs()
        self.assertFalse(os.path.exists(self.path("plain/energy_total.tif")))
        differs = 0
        for i, threshold in enumerate((8.0, 30.0)):
            translational, total = self.map("plain", "energy")[4], self.map("total", "energy_total")[4]
            passed = translational > 0
            one, other = self.map("plain", "energy_exceedance")[i], self.map("total", "energy_exceedance")[i]
            np.testing.assert_array_equal((one > 0)[passed], (translational > threshold)[passed])
            np.testing.assert_array_equal((other > 0)[passed], (total > threshold)[passed])
            self.assertTrue((other >= one).all())
            differs += (other > one).sum()
            densities = self.map("plain", "passage_density")[3 + i], self.map("total", "passage_density")[3 + i]
            self.assertGreater(densities[1].sum(), 1.02 * densities[0].sum())
        self.assertGreater(differs, 100)
        for name in os.listdir(self.path("plain")):
            if name.split(".")[0] not in COUNTED:
                self.assertEqual(self.bytes_of("plain/" + name), self.bytes_of("total/" + name), name)
        self.assertIn("total kinetic energy (with rotation)", title_of(self.path("total/energy_exceedance.tif")))
        self.assertEqual(band_names(self.path("total/energy_exceedance.tif"))[:2], ["P(E with rotation > 8 kJ)", "P(E with rotation > 30 kJ)"])
        self.assertIn("translational", title_of(self.path("plain/energy_exceedance.tif")))
        self.assertIn("count_rotation = true", self.read_text("total/scenario.toml"))
        self.assertEqual([s["value"] for out in ("plain", "total") for s in self.read_json(out + "/run.json")["settings"]
                          if s["key"] == "output.count_rotation"], ["false", "true"])

    def test_without_it_no_byte_changes(self):
        self.runs()
        self.write("s.toml", RUN + "count_rotation = false\n")
        self.run_well("run", self.path("s.toml"), "-o", self.path("off"), "-q")
        for name in os.listdir(self.path("plain")):
            if name not in ("run.json", "talus.qgs"):  # the source of the setting is the file
                self.assertEqual(self.bytes_of("plain/" + name).replace(b"plain", b"off"), self.bytes_of("off/" + name), name)
        self.assertNotIn("count_rotation", self.read_text("off/scenario.toml"))

    def test_the_key_is_the_flag(self):
        self.runs()
        self.write("s.toml", RUN + "count_rotation = true\n")
        self.run_well("run", self.path("s.toml"), "-o", self.path("key"), "-q")
        self.run_well("run", self.path("total/scenario.toml"), "-o", self.path("again"), "-q")
        for out in ("key", "again"):
            for name in ("energy_exceedance.tif", "passage_density.tif", "hazard_tally.gz"):
                if name.endswith(".tif") or out == "key":
                    self.assertEqual(self.bytes_of("total/" + name), self.bytes_of(f"{out}/{name}"), name)
        self.write("s.toml", RUN + "count_rotation = 1\n")
        self.fails(2, "output.count_rotation", "must be true or false", arguments=["run", self.path("s.toml"), "-o", self.path("x")])
        self.assertIn("energy with rotation 8", self.run_well("check", self.path("total/scenario.toml")).stdout)

    def test_frequencies_and_classes_follow(self):
        self.runs()
        for more in ([], ["--width", "10"]):
            self.assertNotIn("rotation", self.hazard("plain", "--curves", *more))
            self.assertIn("energies count the rotation", self.hazard("total", "--curves", *more))
            one, other = self.map("plain", "hazard_class")[0], self.map("total", "hazard_class")[0]
            self.assertTrue((other >= one).all())
            self.assertGreater((other > one).sum(), 5)
            np.testing.assert_allclose(self.map("plain", "annual_frequency"), self.map("total", "annual_frequency"), rtol=1e-5)
            for name in ("hazard_class", "return_period_30", "hazard_curves"):
                self.assertIn("with rotation", title_of(self.path(f"total/{name}.tif")))
                self.assertNotIn("rotation", title_of(self.path(f"plain/{name}.tif")))
        self.assertEqual([self.read_json(out + "/hazard.json")["count_rotation"] for out in ("plain", "total")], [False, True])
        self.hazard("total")
        # of the western cliff alone, 8 source cells of 200 blocks, as in hazard_test
        period = self.map("total", "return_period_30")[0][:, 18:26]
        over = self.map("total", "energy_exceedance")[1][:, 18:26] * 3200 / 1600 * 0.5
        self.assertGreater((over > 0).sum(), 10)
        np.testing.assert_allclose(period[over > 0] * over[over > 0], 1.0, rtol=1e-5)
        self.assertTrue(np.all(period[over == 0] == -9999))
        self.assertIn("energy with rotation once in 100 years", band_names(self.path("total/intensity_T100.tif")))
        self.hazard("plain")
        one, other = self.map("plain", "intensity_T300")[0], self.map("total", "intensity_T300")[0]
        self.assertGreater(other[one > 1].mean(), 1.03 * one[one > 1].mean())

    def test_another_weighting_counts_it_too(self):
        self.runs()
        self.hazard("total")
        names = ("return_period_8", "return_period_30", "intensity_T100", "hazard_class")
        first = [self.map("total", name) for name in names]
        weighting = self.write("w.toml", '[features]\nwest = 0.5\neast = 0.02\n')
        self.hazard("total", "--frequency", weighting)
        for name, before in zip(names, first):
            np.testing.assert_allclose(self.map("total", name), before, rtol=1e-5)
        self.assertTrue(self.read_json("total/hazard.json")["count_rotation"])

    def test_objects_have_the_energy_of_the_crossings(self):
        """A line as object and as screen: with which energies blocks come is what screens.csv says of their first crossings
        (of the rim of the block, 0.4 m before its centre)."""
        self.runs()
        rows = {}
        for out in ("plain", "total"):
            self.hazard(out, "--objects", self.path("road.gpkg"))
            (rows[out],) = self.read_table(out + "/objects.csv")
        first = collections.OrderedDict()
        for row in self.read_table("total/screens.csv"):
            first.setdefault((row["source"], row["block"]), row)
        for out, column in (("plain", "energy_kj"), ("total", "total_energy_kj")):
            for threshold in (8, 30):
                above = sum(float(row[column]) > threshold for row in first.values()) / len(first)
                entry = float(rows[out][f"entry_{threshold}"]) / float(rows[out]["frequency"])
                self.assertGreater(above, 0.02)
                self.assertAlmostEqual(entry / above, 1.0, delta=0.06, msg=f"{out} {threshold}")
        self.assertEqual(rows["plain"]["frequency"], rows["total"]["frequency"])
        for column in ("frequency_30", "entry_30", "frequency_30_lower"):
            self.assertGreater(float(rows["total"][column]), 1.1 * float(rows["plain"][column]))
        self.assertNotIn("energies", rows["plain"])
        self.assertEqual(rows["total"]["energies"], "with rotation")
        self.assertIn("total_energy_kj", self.read_table("total/objects_curves.csv")[0])
        self.assertIn("energy_kj", self.read_table("plain/objects_curves.csv")[0])
        for out, words in (("plain", False), ("total", True)):
            self.run_well("report", self.path(out), "-q")
            page = self.read_text(out + "/report.html")
            for text in ("Energies and classes of objects count the rotation", "energy with rotation [kJ]", "Return period, energy with rotation &gt; 30 kJ",
                         "energy with rotation, return period", "classes and objects count the energy with rotation"):
                self.assertEqual(text in page, words, text)
            titles = re.findall(r'data-title="(Energy[^"]*P95[^"]*)"', page)  # of the whole paths, in the order of the page
            self.assertEqual(titles, ["Energy, P95 (translational energy)", "Energy with rotation, P95"] if words else ["Energy, P95"])
            self.assertEqual("Hazard class, energy with rotation" in self.read_text(out + "/talus.qgs"), words)
            self.assertEqual("Objects: hazard curves, energy with rotation" in self.read_text(out + "/talus.qgs"), words)

    def test_a_barrier_says_that_its_energies_are_translational(self):
        self.runs()
        for out, words in (("plain", False), ("total", True)):
            done = self.run_well("barrier", self.path(out), "--screen", "road")
            self.assertEqual("energies here are translational" in done.stdout + done.stderr, words)
        one, other = (self.read_json(out + "/barrier_road.json") for out in ("plain", "total"))
        self.assertEqual(one["design"], other["design"])

    def test_parts_with_another_setting_are_refused(self):
        for out, more in (("one", ["--part", "1/2"]), ("two", ["--part", "2/2", "--count-rotation"])):
            self.run_well("run", self.path("s.toml"), "-o", self.path(out), "-q", *more)
        self.fails(2, "another plan", "count_rotation", arguments=["merge", self.path("m"), self.path("one"), self.path("two")])
        self.fails(2, "another plan", "count_rotation",
                   arguments=["run", self.path("s.toml"), "-o", self.path("one"), "--part", "1/2", "--resume", "--count-rotation"])
        self.run_well("run", self.path("s.toml"), "-o", self.path("other"), "-q", "--part", "1/2", "--count-rotation")
        self.run_well("merge", self.path("m"), self.path("other"), self.path("two"), "-q")
        self.runs()
        for name in ("energy_exceedance.tif", "passage_density.tif", "hazard_tally.gz"):
            self.assertEqual(self.bytes_of("m/" + name), self.bytes_of("total/" + name), name)

    def test_rounds_and_regions_count_as_one_run(self):
        self.runs()
        for out, more in (("rounds", ["--trajectories", "100", "--rounds", "2"]), ("regions", ["--memory", "200M", "--threads", "1"])):
            self.run_well("run", self.path("s.toml"), "-o", self.path(out), "-q", "--count-rotation", *more)
            for name in ("energy_exceedance.tif", "passage_density.tif"):
                self.assertEqual(self.bytes_of(f"{out}/{name}"), self.bytes_of("total/" + name), (out, name))

    def test_swiss_classes_of_translational_energies_are_told(self):
        self.runs()
        words = "the Swiss classes count the energy with rotation, this run the translational one"
        self.write("named.toml", 'energies = [30, 300]\nnames = ["keine", "Rest", "klein", "mittel", "gross"]\n')
        self.write("own.toml", "energies = [30, 300]\nyears = [10, 100, 300]\n")
        for out, more, told in (("plain", [], True), ("plain", ["--matrix", self.path("named.toml")], True),
                                ("plain", ["--matrix", self.path("own.toml")], False), ("total", [], False)):
            done = self.run_well("hazard", self.path(out), "--overwrite", *more)
            self.assertEqual(words in done.stderr, told, (out, more))
            self.assertEqual(any(words in w for w in self.read_json(out + "/hazard.json")["warnings"]), told)

    def test_a_tally_of_the_other_setting_is_refused(self):
        self.runs()
        os.replace(self.path("plain/hazard_tally.gz"), self.path("total/hazard_tally.gz"))
        self.fails(2, "hazard_tally.gz", arguments=["hazard", self.path("total")])


if __name__ == "__main__":
    unittest.main()
