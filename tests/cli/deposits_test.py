"""Campaigns of blocks that were mapped where they lie: what is read and refused, and what score and calibrate make of it."""
import json
import os
import unittest

import numpy as np
from osgeo import ogr

from support import NORTH, WEST, Case, box, rows_of, write_features

TABLE = '[deposits]\nfile = "deposits.csv"\nsources = "sources.gpkg"\nmapped = "mapped.gpkg"\n'
MODEL = '[ground]\ndefault = "forest-road-3d"\n'


class Deposits(Case):
    """The slope of the other tests: a cliff, and blocks mapped below it where a run let them stop."""

    def setUp(self):
        super().setUp()
        write_features(self.path("mapped.gpkg"), "mapped", [(box(100, 10, 100, 190), [])])
        self.write("run.toml", 'dem = "dem.tif"\ntrajectories = 60\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = [0.4, 1.0]\n'
                               '[ground]\ndefault = "forest-road-3d"\n[output]\ntrajectories = 0\n')
        self.run_well("run", self.path("run.toml"), "-o", self.path("run"), "-q")
        self.stops = [(g.GetX(), g.GetY(), f["diameter_m"]) for f, g in rows_of(self.path("run/stops.gpkg"), "stops")
                      if f["end"] in ("stopped", "trapped") and WEST + 102 < g.GetX() < WEST + 198
                      and NORTH - 285 < g.GetY() < NORTH - 105]
        self.assertGreater(len(self.stops), 60)
        chosen = np.random.default_rng(3).choice(len(self.stops), 50, replace=False)
        self.rows = [[f"d{i}", repr(self.stops[k][0]), repr(self.stops[k][1]), repr(self.stops[k][2])]
                     for i, k in enumerate(chosen)]
        self.deposits(self.rows)
        self.campaign()
        self.model = self.write("m.toml", MODEL)

    def deposits(self, rows, header=("id", "x", "y", "diameter_m")):
        self.write("deposits.csv", ",".join(header) + "\n" + "".join(",".join(row) + "\n" for row in rows))

    def campaign(self, more="", top="", table=TABLE):
        return self.write("campaign.toml", f'name = "map"\ndem = "dem.tif"\n{top}\n{table}{more}\n')

    def score(self, *more, model=None):
        done = self.run_well("score", self.path("campaign.toml"), "--parameters", model or self.model, "--json", *more)
        return json.loads(done.stdout)

    def refuses(self, *words):
        self.fails(2, *words, arguments=["score", self.path("campaign.toml"), "--parameters", self.model])


class Sources(Deposits):
    def test_a_field_height_is_not_the_release_height(self):
        write_features(self.path("sources.gpkg"), "sources", [(box(140, 230, 20, 10), [60.0])], [("HEIGHT", ogr.OFTReal)])
        done = self.run_well("score", self.path("campaign.toml"), "--parameters", self.model, "--trials", "10")
        self.assertIn("sources.gpkg: a field height is not read", done.stderr)
        write_features(self.path("tall.gpkg"), "sources", [(box(140, 230, 20, 10), [60.0])], [("release_height", ogr.OFTReal)])
        self.campaign(table=TABLE.replace("sources.gpkg", "tall.gpkg"))
        other = self.run_well("score", self.path("campaign.toml"), "--parameters", self.model, "--trials", "10")
        self.assertNotIn("is not read", other.stderr)
        self.assertNotEqual(done.stdout, other.stdout)


class Score(Deposits):
    def test_the_right_model_is_near_the_pattern_and_another_is_not(self):
        right = self.score("-q")["fit"]
        wrong = self.score("-q", model=self.write("w.toml", '[ground.zones.default]\npreset = "forest-road-3d"\nEn50 = 1\nEt50 = 1.5\n'))["fit"]
        self.assertEqual([g["group"][:8] for g in right["groups"]][:1], ["deposits"])
        self.assertIn("run-out angle", [g["group"] for g in right["groups"]])
        self.assertLess(right["score"], 0.8 * wrong["score"])
        self.assertLess(right["score"], right["climatology"]["score"])
        for pattern in right["deposits"]["patterns"]:
            self.assertGreater(pattern["p_value"], 0.01)
            self.assertGreaterEqual(pattern["p_corrected"], pattern["p_value"])
        found = wrong["deposits"]["patterns"]
        least = min(p["p_value"] for p in found)
        self.assertLess(least, 0.011)
        self.assertAlmostEqual(min(p["p_corrected"] for p in found), least * len(found), 9)  # Holm's of the smallest

    def test_the_order_of_rows_and_the_threads_change_nothing(self):
        one = self.score("-q", "--threads", "1")
        self.deposits(self.rows[::-1])
        self.assertEqual(self.score("-q", "--threads", "2"), one)

    def test_the_score_is_that_of_its_definition(self):
        """From the dumped stops, by the formula of docs/mapped-deposits.md."""
        result = self.score("-q", "--dump", self.path("dump"))["fit"]
        stops = {}
        for row in self.read_table("dump/stops.csv"):
            if row["x"]:
                stops.setdefault(row["block"], []).append((float(row["x"]), float(row["y"])))
        mapped = {row[0]: np.array([float(row[1]), float(row[2])]) for row in self.rows}
        sizes = sorted(float(row[3]) for row in self.rows)
        limit = 0.5 * (sizes[24] + sizes[25])
        by_class = [[r[0] for r in self.rows if (float(r[3]) >= limit) == big] for big in (False, True)]
        for group, blocks in zip(result["groups"], by_class):
            spread = np.sqrt(np.var([mapped[b] for b in blocks], axis=0).sum())
            rows = []
            for b in blocks:
                x = np.array(stops[b])
                n = len(x)
                pairs = np.linalg.norm(x[:, None] - x[None], axis=2).sum() / (n * (n - 1))
                rows.append((np.linalg.norm(x - mapped[b], axis=1).mean() - 0.5 * pairs) / spread)
            self.assertEqual(group["rows"], len(blocks))
            self.assertAlmostEqual(group["score"], np.mean(rows), delta=2e-6)

    def test_strips_hold_out_by_place(self):
        self.campaign("strips = 5\nholdout = [2, 4]\n")
        result = self.score("-q", "--dump", self.path("dump"))
        self.assertEqual(result["fit"]["blocks"] + result["holdout"]["blocks"], 50)
        self.assertTrue(14 <= result["holdout"]["blocks"] <= 26, result["holdout"]["blocks"])  # 20, but for blocks in cells at a limit
        stops = [r for r in self.read_table("dump/stops.csv") if r["x"]]
        # The strip of the centre of the cell of a place, from the middle of the source (all its cells have like areas) and of the blocks.
        places = {r[0]: np.array([float(r[1]), float(r[2])]) for r in self.rows}
        down = np.mean(list(places.values()), axis=0) - [WEST + 150, NORTH - 65]
        across = np.array([-down[1], down[0]])
        order = sorted(across @ p for p in places.values())
        limits = [0.5 * (order[i - 1] + order[i]) for i in (10, 20, 30, 40)]
        held_out = lambda p: sum(across @ (np.floor((p - [WEST, NORTH]) / 5.0) * 5.0 + 2.5 + [WEST, NORTH]) > a for a in limits) in (1, 3)
        same = sum(held_out(np.array([float(r["x"]), float(r["y"])])) == held_out(places[r["block"]]) for r in stops)
        self.assertGreater(same / len(stops), 0.97)  # but for cells at a limit, as the areas differ a little

    def test_the_column_holdout(self):
        self.deposits([row + [str(int(i % 5 == 0))] for i, row in enumerate(self.rows)], ("id", "x", "y", "diameter_m", "holdout"))
        result = self.score("-q")
        self.assertEqual((result["fit"]["blocks"], result["holdout"]["blocks"]), (40, 10))

    def test_a_block_at_a_limit_is_of_the_class_from_there_on(self):
        """So the rows of the classes are the counts of the written diameters; a mass in between has another last bit."""
        sizes = ["0.3", "0.5", "0.6", "0.7"]
        rows = [[*row[:3], sizes[i % 4], str(2600 + i)] for i, row in enumerate(self.rows)]
        self.deposits(rows, ("id", "x", "y", "diameter_m", "density_kgm3"))
        self.campaign("classes = [0.3, 0.5, 0.6, 0.7]\n")
        groups = {g["group"]: g["rows"] for g in self.score("-q", "--trials", "20")["fit"]["groups"]}
        counts = [sum(row[3] == size for row in rows) for size in sizes]
        names = ["deposits 0.3 to 0.5 m", "deposits 0.5 to 0.6 m", "deposits 0.6 to 0.7 m", "deposits from 0.7 m"]
        self.assertEqual([groups.get(name) for name in names], counts)
        self.assertNotIn("deposits below 0.3 m", groups)

    def test_mass_and_diameter_mean_the_same(self):
        one = self.score("-q")
        self.deposits([row[:3] + [repr(2700.0 * np.pi / 6.0 * float(row[3]) ** 3)] for row in self.rows], ("id", "x", "y", "mass_kg"))
        other = self.score("-q")
        for a, b in zip(one["fit"]["groups"], other["fit"]["groups"]):
            self.assertAlmostEqual(a["score"], b["score"], delta=0.02)

    def test_blocks_above_every_source_are_named(self):
        write_features(self.path("mapped.gpkg"), "mapped", [(box(100, 10, 100, 280), [])])
        self.deposits(self.rows + [["up", str(WEST + 150), str(NORTH - 30), "0.5"]])
        done = self.run_well("score", self.path("campaign.toml"), "--parameters", self.model, "--trials", "10")
        self.assertIn("1 of 51 blocks lie higher than any release from ", done.stderr)
        self.assertIn(" m at most: up; no block can get there", done.stderr)

    def test_blocks_outside_the_polygons_are_left_out_and_said(self):
        self.deposits(self.rows + [["far", str(WEST + 20), str(NORTH - 200), "0.5"]])
        done = self.run_well("score", self.path("campaign.toml"), "--parameters", self.model)
        self.assertIn("1 of 51 blocks lie outside the mapped polygons and are left out: far", done.stderr)
        self.assertIn("(50 blocks)", done.stdout)
        self.assertIn("energy distance of the patterns", done.stdout)
        self.assertRegex(done.stdout, r"\d+\.\d % of the simulated blocks come to rest inside the mapped polygons; the others do not count")

    def test_the_share_in_the_strips_is_said_beside_that_in_the_polygons(self):
        """Strips hold the same polygons: without them the blocks of both kinds of rows come to rest there as often."""
        whole = self.score("-q")["fit"]["deposits"]
        self.assertEqual(whole["mapped"], whole["inside"])
        self.campaign("strips = 5\nholdout = [2, 4]\n")
        rows = self.score("-q")
        blocks = [rows[kind]["blocks"] for kind in ("fit", "holdout")]
        mapped = [rows[kind]["deposits"]["mapped"] for kind in ("fit", "holdout")]
        self.assertAlmostEqual(np.dot(blocks, mapped) / sum(blocks), whole["mapped"], 5)
        text = self.run_well("score", self.path("campaign.toml"), "--parameters", self.model).stdout
        for kind, words in (("fit", "fitted"), ("holdout", "held out")):
            share = rows[kind]["deposits"]
            self.assertLess(share["inside"], 0.9 * share["mapped"])
            self.assertIn(f"{100 * share['mapped']:.1f} % of the simulated blocks come to rest inside the mapped polygons, "
                          f"{100 * share['inside'] / share['mapped']:.1f} % of these in the strips that are {words}; the others do not count", text)

    def test_no_polygons_are_said(self):
        self.campaign(table='[deposits]\nsources = "sources.gpkg"\n')  # the table is deposits.csv where none is named
        done = self.run_well("score", self.path("campaign.toml"), "--parameters", self.model)
        self.assertIn("the whole DEM counts as mapped", done.stderr)
        self.assertIn("% of the simulated blocks come to rest on the DEM, all of which counts as mapped; the others do not count", done.stdout)


class Faults(Deposits):
    def test_tables(self):
        for rows, words in (([], ["has no blocks"]), ([["a", "5", "5", "1"]], ["deposits.csv:2", "off the terrain"]),
                            ([self.rows[0][:3] + [""]], ["deposits.csv:2", "diameter_m", "must be given"]),
                            ([self.rows[0], self.rows[0]], ["deposits.csv:3", "already in line 2"]),
                            ([["a", str(WEST + 20), str(NORTH - 200), "0.5"]], ["none of the 1 blocks", "inside its polygons"])):
            self.deposits(rows)
            self.refuses(*words)
        self.deposits(self.rows[:12])
        self.campaign("strips = 50\nholdout = [2]\n")
        self.refuses("strips = 50, must be at most 12, the number of mapped blocks")
        self.campaign()
        self.deposits([row + ["5"] for row in self.rows], ("id", "x", "y", "diameter_m", "mass_kg"))
        self.refuses("diameter_m", "leave the other empty")
        self.deposits(self.rows[:20] + [[f"far{i}", str(WEST + 20), str(NORTH - 200), "0.5"] for i in range(21)])
        self.refuses("21 of 41 blocks lie outside the mapped polygons, more than half", "draw the polygons round")

    def test_a_layer_for_the_table(self):
        self.campaign(table=TABLE.replace('"deposits.csv"', '"mapped.gpkg"'))
        self.refuses("mapped.gpkg: is a layer of vectors", "CSV only", "AS_XY")
        # As QGIS writes it: the places in X and Y, and the number of the feature.
        self.campaign()
        self.deposits([[x, y, str(i), *more] for i, (name, x, y, size) in enumerate(self.rows) for more in [(name, size)]],
                      ("X", "Y", "fid", "id", "diameter_m"))
        done = self.run_well("score", self.path("campaign.toml"), "--parameters", self.model)
        self.assertIn("deposits.csv: column fid: not read", done.stderr)
        self.assertIn("(50 blocks)", done.stdout)

    def test_campaign(self):
        for table, top, words in (
                ('deposits = "deposits.csv"', "", ["must be a table", "[deposits]"]),
                ("[deposits]\n", "", ["no sources", "talus sources"]),
                (TABLE, 'blocks = "deposits.csv"', ["must not stand beside [deposits]", "two campaigns"]),
                (TABLE + "holdout = [1]\n", "", ["must come with strips"]),
                (TABLE + "strips = 3\n", "", ["must come with holdout"]),
                (TABLE + "strips = 3\nholdout = [4]\n", "", ["at most strips = 3"]),
                (TABLE + "strips = 2\nholdout = [1, 2]\n", "", ["leave a strip"]),
                (TABLE + "classes = [0.5, 0.4]\n", "", ["must ascend"]),
                (TABLE + "polygons = 3\n", "", ["polygons"]),
                (TABLE.replace("sources.gpkg", "none.gpkg"), "", ["no such file"])):
            self.campaign(table=table, top=top)
            self.refuses(*words)

    def test_places(self):
        write_features(self.path("mapped.gpkg"), "mapped", [(box(5000, 10, 100, 190), [])])
        self.refuses("cover no cell of the DEM")
        point, line = f"POINT ({WEST + 100} {NORTH - 100})", f"LINESTRING ({WEST + 100} {NORTH - 100},{WEST + 200} {NORTH - 100})"
        for other in (point, line):  # beside a polygon both were left out without a word
            write_features(self.path("mapped.gpkg"), "mapped", [(box(100, 10, 100, 190), []), (other, [])])
            self.refuses("mapped.gpkg: feature 2: is no polygon, must be one")
        write_features(self.path("mapped.gpkg"), "mapped", [])
        self.refuses("has no polygons")
        write_features(self.path("mapped.gpkg"), "mapped", [(box(100, 10, 100, 190), [])])
        write_features(self.path("sources.gpkg"), "sources", [(box(5000, 230, 20, 10), ["far"])], [("name", ogr.OFTString)])
        self.refuses("sources.gpkg", "off the DEM")

    def test_diagnose_names_what_to_use(self):
        self.fails(2, "needs blocks of known release", "talus calibrate", arguments=["diagnose", self.path("campaign.toml"), "-o", self.path("d")])
        self.assertFalse(os.path.exists(self.path("d")))

    def test_fields_of_sources_that_do_not_count_are_said(self):
        write_features(self.path("sources.gpkg"), "sources", [(box(140, 230, 20, 10), [0.1])], [("frequency", ogr.OFTReal)])
        done = self.run_well("score", self.path("campaign.toml"), "--parameters", self.model)
        self.assertIn("the field frequency counts nothing here", done.stderr)


class Calibrate(Deposits):
    def test_two_maps_in_one_call(self):
        """They have errors, and no log scores."""
        self.campaign()
        other = self.write("other.toml", f'name = "other"\ndem = "dem.tif"\n{TABLE}')
        self.run_well("calibrate", self.path("campaign.toml"), other, "-o", self.path("both"), "--fit", "theta_scale", "--starts", "1",
                      "--trials", "20", "--parameters",
                      self.write("s.toml", '[ground.zones.default]\npreset = "forest-road-3d"\ntheta_scale = 1.0\n'), timeout=600)
        result = self.read_json("both/calibration.json")
        self.assertEqual([s["name"] for s in result["sites"]], ["map", "other"])
        for site in result["sites"]:
            self.assertLess(site["error"]["fit"]["after"], site["error"]["fit"]["before"])
            self.assertIsNone(site["evidence"][0]["fit"]["groups"][0]["log_score"])

    def test_a_fit_to_the_pattern(self):
        self.campaign("strips = 5\nholdout = [2, 4]\n")
        done = self.run_well("calibrate", self.path("campaign.toml"), "-o", self.path("fit"), "--fit", "theta_scale", "--starts", "1",
                             "--trials", "20", "--parameters",
                             self.write("s.toml", '[ground.zones.default]\npreset = "forest-road-3d"\ntheta_scale = 1.0\n'), timeout=600)
        self.assertIn("energy distance of the patterns", done.stdout)
        result = self.read_json("fit/calibration.json")
        self.assertEqual([i["role"] for i in result["inputs"]], ["campaign", "dem", "deposits", "sources", "mapped", "model"])
        low, high = result["parameters"][0]["ci95"]
        self.assertTrue(low <= 0.4 <= high, (low, high))  # of forest-road-3d
        self.assertIn("deposits", result["error"]["holdout"])
        self.assertIn("distance from the nearest source", [d["observable"] for d in result["distributions"]])
        self.assertIn("come to rest inside the mapped polygons", self.read_text("fit/report.md"))


if __name__ == "__main__":
    unittest.main()
