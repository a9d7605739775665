"""talus profile: the 2D model, by hand, against the plane of docs/validation.md, and its files and faults."""
import base64
import json
import math
import os
import re
import subprocess
import unittest
import xml.dom.minidom

import numpy as np
from osgeo import ogr

from support import NORTH, TALUS, WEST, Case, rows_of, write_dem, write_features

TAN38 = math.tan(math.radians(38.0))


class Profile(Case):
    def nodes(self, *nodes, name="p.csv"):
        self.write(name, "x,z\n" + "".join(f"{x!r},{z!r}\n" for x, z in nodes))

    def scenario(self, sources, rest="", head='profile = "p.csv"\n', name="p.toml", diameter="1.0"):
        return self.write(name, f"{head}[sources]\n{sources}\n[blocks]\ndiameter = {diameter}\n{rest}")

    def profile(self, *extra, name="p.toml", out="out"):
        return self.run_well("profile", self.path(name), "-o", self.path(out), "-q", *extra)

    def rows(self, file, out="out"):
        return [{k: v if k in ("end", "screen") else float(v or "nan") for k, v in row.items()}
                for row in self.read_table(os.path.join(out, file))]

    def contents(self, out):
        found = {}
        for name in sorted(os.listdir(self.path(out))):
            with open(self.path(os.path.join(out, name)), "rb") as file:
                found[name] = file.read()
        return found


class ByHand(Profile):
    def test_free_fall_over_a_step(self):
        # Thrown at 8 m/s from 2 m above a plateau, over its edge at x = 20 (1.92 m lower by then), to a floor 50 m below.
        self.nodes((0, 100), (20, 100), (20.1, 50), (80, 50))
        self.scenario("x = 15\nrelease_height = 2\nvx = 8", "[screens]\nx = [18, 40]\n[output]\nbin = 5\n")
        self.profile("--trajectories", "7")
        g, mass = 9.81, 2700.0 * math.pi / 6.0
        for screen, x, ground in (("18", 18.0, 100.0), ("40", 40.0, 50.0)):
            t = (x - 15.0) / 8.0
            rows = [row for row in reversed(self.rows("screens.csv")) if row["screen"] == screen]
            rows = list({row["block"]: row for row in rows}.values())  # the first of each: some come back
            self.assertEqual(len(rows), 7)
            for row in rows:
                speed = math.hypot(8.0, g * t)
                self.assertAlmostEqual(row["speed_ms"], speed, 3)
                self.assertAlmostEqual(row["energy_kj"], 0.5e-3 * mass * speed**2, 2)
                self.assertAlmostEqual(row["jump_height_m"], 102.0 - 0.5 * g * t * t - ground, 3)
                self.assertEqual((row["x"], row["y"]), (x, 0.0))
        envelope = {row["x_from"]: row for row in self.rows("envelope.csv")}
        bin_30 = envelope[30.0]  # highest where it enters at 30 m, fastest where it leaves at 35 m
        for statistic in ("mean", "p50", "p95", "p99", "max"):
            self.assertAlmostEqual(bin_30["jump_height_m_" + statistic], 52.0 - 0.5 * g * (15.0 / 8.0) ** 2, 3)
            self.assertAlmostEqual(bin_30["speed_ms_" + statistic], math.hypot(8.0, g * 20.0 / 8.0), 3)
            self.assertAlmostEqual(bin_30["energy_kj_" + statistic], 0.5e-3 * mass * (64.0 + (g * 2.5) ** 2), 2)
        self.assertEqual((bin_30["passages"], bin_30["share"], bin_30["x_to"]), (7.0, 1.0, 35.0))
        self.assertEqual(envelope[5.0]["passages"], 0.0)
        self.assertTrue(math.isnan(envelope[5.0]["speed_ms_mean"]))  # NaN in bins that no block crosses
        bins = [fields for fields, _ in rows_of(self.path("out/profile.gpkg"), "bins")]
        self.assertIsNone(bins[1]["speed_ms_mean"])
        self.assertIsNotNone(bins[6]["speed_ms_mean"])
        path = rows_of(self.path("out/profile.gpkg"), "trajectories")[0][1]
        at = [path.GetPoint(i) for i in range(path.GetPointCount())]
        landing = next(i for i, p in enumerate(at) if p[2] < 50.0001)
        self.assertAlmostEqual(at[landing][0], 15.0 + 8.0 * math.sqrt(2.0 * 52.0 / g), 2)

    def test_a_release_range_and_the_runout(self):
        self.nodes((0, 100), (100, 100))
        self.scenario("x = [20, 60]\nrelease_height = 0", "[ground.zones.default]\nphi = 80\n")
        self.profile("--trajectories", "400")
        x = np.array([row["x"] for row in self.rows("stops.csv")])  # they stay where they are put
        self.assertTrue(((x >= 20) & (x <= 60)).all())
        self.assertLess(abs(x.mean() - 40.0), 5.0 * 40.0 / math.sqrt(12 * 400))
        self.assertAlmostEqual(x.std(), 40.0 / math.sqrt(12), delta=5.0 * 0.26)  # 0.26: standard error of 400
        self.assertTrue(all(abs(row["runout_m"]) < 2.0 for row in self.rows("stops.csv")))
        runout = self.rows("runout.csv")
        self.assertEqual(runout[0], {"distance_from": 0.0, "distance_to": 5.0, "stopped": 400.0, "share": 1.0,
                                     "share_beyond": 0.0})

    def test_a_flat_road_below_a_long_slope_is_flat(self):
        """Drawn at 900 m. 600.28 m in 20 000 columns is no whole number of what the heights are rounded to."""
        self.nodes((0, 1500.28), (1000, 900), (1005, 900), (1500, 600))
        self.scenario("x = [1000.5, 1004.5]\nrelease_height = 0", "[ground.zones.default]\nphi = 80\n",
                      'profile = "p.csv"\nstep = 0.05\n')
        self.profile("--trajectories", "50")
        for row in self.rows("stops.csv"):  # they stay where they are put
            self.assertAlmostEqual(row["z"], 900.0, 3)

    def test_zones_are_intervals(self):
        # A bog from 60 m to 80 m takes all; without it blocks slide on for long.
        self.nodes((0, 100), (40, 70), (200, 70))
        bog = "[ground.zones.bog]\nx = [60, 80]\nEn50 = 0.001\nEt50 = 0.001\ntheta_scale = 0\nphi = 80\n"
        self.scenario("x = 5\nrelease_height = 3", "[ground.zones.default]\ntheta_scale = 0\n" + bog)
        self.profile("--trajectories", "200")
        self.scenario("x = 5\nrelease_height = 3", "[ground.zones.default]\ntheta_scale = 0\n", name="q.toml")
        self.profile("--trajectories", "200", name="q.toml", out="free")
        x = np.array([row["x"] for row in self.rows("stops.csv")])
        free = np.array([row["x"] for row in self.rows("stops.csv", "free")])
        self.assertGreater(((free > 82) | (free < 59)).mean(), 0.5)
        self.assertGreater(((x > 59) & (x < 82)).mean(), 0.9)

    def test_the_plane_of_the_reference(self):
        # docs/validation.md, "The plane": 38 degrees, Table 1, D 1.0-1.4 m, released 2 m above the ground, 140 m of height lower.
        x = 60.0 + 140.0 / TAN38
        self.nodes((0, 600), (600, 600 - 600 * TAN38))
        for rule, c, speed, p95, jump, jump95 in (("clamp", 0.25, 10.2, 17.3, 1.31, 2.80),
                                                  ("resample", 0.25, 8.6, 14.5, 1.29, 2.40),
                                                  ("clamp", 1.0, 5.1, 8.6, 0.32, 0.70)):
            with self.subTest(f"{rule} {c}"):
                self.scenario("x = 60\nrelease_height = 2", f"[screens]\nx = [{x!r}]\n[model]\n"
                              f"roughness = '{rule}'\ndeformation_coefficient = {c}\n[output]\ntrajectories = 0\n",
                              'profile = "p.csv"\nstep = 1\n', diameter="[1.0, 1.4]")
                self.profile("--trajectories", "8000", "--overwrite")
                rows = self.rows("screens.csv")
                v, h = (np.array([row[key] for row in rows]) for key in ("speed_ms", "jump_height_m"))
                self.assertAlmostEqual(v.mean() / speed, 1.0, delta=0.03)
                self.assertAlmostEqual(np.percentile(v, 95) / p95, 1.0, delta=0.04)
                self.assertAlmostEqual(h.mean(), jump, delta=0.04 * jump + 0.005)
                self.assertAlmostEqual(np.percentile(h, 95) / jump95, 1.0, delta=0.05)

    def test_a_mirrored_profile_gives_mirrored_results(self):
        nodes = [(0.0, 200.0), (150.0, 87.5), (155.0, 87.5), (300.0, 15.0), (400.0, 15.0)]
        self.nodes(*nodes)
        self.nodes(*[(400.0 - x, z) for x, z in reversed(nodes)], name="m.csv")
        # In steps of 0.5 m the columns rise by short binary fractions: both grounds are the same to the last bit.
        self.scenario("x = 20\nvx = 1", head='profile = "p.csv"\nstep = 0.5\n')
        self.scenario("x = 380\nvx = -1", head='profile = "m.csv"\nstep = 0.5\n', name="m.toml")
        self.profile("--trajectories", "300")
        self.profile("--trajectories", "300", name="m.toml", out="mirror")
        for a, b in zip(self.rows("stops.csv"), self.rows("stops.csv", "mirror")):
            self.assertAlmostEqual(a["x"], 400.0 - b["x"], 2)
            self.assertEqual(a["end"], b["end"])
        self.assertEqual(self.contents("out")["runout.csv"], self.contents("mirror")["runout.csv"])


class OnASlope(Profile):
    def setUp(self):
        super().setUp()
        self.nodes((0, 200), (150, 87.5), (155, 87.5), (300, 15), (400, 15))
        self.scenario("x = [18, 22]", "[screens]\nx = [100, 200]\n[ground.zones.road]\nx = [150, 155]\n"
                      "preset = 'forest-road-2d'\n[output]\ntrajectories = 20\n")


class Files(OnASlope):
    def test_equal_bytes_for_any_threads_and_again_from_its_own_file(self):
        self.profile("--trajectories", "1000", "--threads", "1")
        first = self.contents("out")
        self.profile("--trajectories", "1000", "--threads", "3", out="three")
        self.profile(name="out/profile.toml", out="again")
        for other in ("three", "again"):
            for name, content in self.contents(other).items():
                if name not in ("run.json", "profile.toml") or (name == "profile.toml" and other == "again"):
                    self.assertEqual(content == first[name], True, other + "/" + name)

    def test_the_files_agree_with_each_other(self):
        self.profile("--trajectories", "500")
        record = self.record()
        stops = self.rows("stops.csv")
        self.assertEqual(len(stops), 500)
        self.assertEqual(sum(record["ends"].values()), 500)
        self.assertEqual(sum(row["end"] == "stopped" for row in stops), record["ends"]["stopped"])
        self.assertEqual(record["files"], ["envelope.csv", "profile.gpkg", "profile.svg", "profile.toml", "runout.csv",
                                           "screens.csv", "stops.csv"])
        layers = {layer.GetName(): layer.GetFeatureCount() for layer in ogr.Open(self.path("out/profile.gpkg"))}
        self.assertEqual(layers, {"profile": 1, "stops": 500, "crossings": len(self.rows("screens.csv")),
                                  "trajectories": 20, "bins": 80, "layer_styles": 5})
        fields, point = rows_of(self.path("out/profile.gpkg"), "stops")[7]
        self.assertEqual(fields["x"], stops[7]["x"])
        self.assertAlmostEqual(point.GetX(), stops[7]["x"], 3)
        self.assertAlmostEqual(point.GetY(), stops[7]["z"], 3)
        stopped = [row["runout_m"] for row in stops if row["end"] in ("stopped", "trapped")]
        counts = np.histogram(stopped, bins=np.arange(0, 405, 5.0))[0]
        runout = self.rows("runout.csv")
        self.assertEqual([row["stopped"] for row in runout], list(counts[: len(runout)]))
        self.assertAlmostEqual(runout[-1]["share_beyond"], 1.0 - len(stopped) / 500, 9)
        self.assertEqual(xml.dom.minidom.parse(self.path("out/profile.svg")).documentElement.tagName, "svg")
        settings = {s["key"]: (s["value"], s["source"]) for s in record["settings"]}
        self.assertEqual(settings["ground.zones.road.theta_scale"], (0.4, "preset forest-road-2d"))
        self.assertEqual(settings["step"], (0.1, "default"))

    def test_a_line_over_a_dem(self):
        y = (59.5 - np.arange(60))[:, None] * 5.0 + np.zeros((1, 60))
        write_dem(self.path("dem.tif"), (1000.0 + 0.75 * np.maximum(0.0, y - 100.0)).astype(np.float32))
        line = f"LINESTRING ({WEST + 50} {NORTH - 20}, {WEST + 50} {NORTH - 150}, {WEST + 120} {NORTH - 280})"
        write_features(self.path("line.gpkg"), "line", [(line, [])])
        self.scenario("x = 10", '[screens]\nx = [60]\n', 'dem = "dem.tif"\nline = "line.gpkg"\n')
        self.profile("--trajectories", "300")
        shape = ogr.CreateGeometryFromWkt(line)
        for fields, point in rows_of(self.path("out/profile.gpkg"), "stops"):
            flat = ogr.CreateGeometryFromWkt(f"POINT ({point.GetX()} {point.GetY()})")
            self.assertLess(shape.Distance(flat), 1e-6)
            height = 1000.0 + 0.75 * max(0.0, point.GetY() - (NORTH - 300.0) - 100.0)
            if abs(point.GetY() - (NORTH - 200.0)) > 5.0:  # the crease lies between two rows of cells
                self.assertAlmostEqual(point.GetZ(), height, delta=0.1)
            self.assertAlmostEqual(point.GetZ(), fields["z"], 3)
        ground = rows_of(self.path("out/profile.gpkg"), "profile")[0][1]
        self.assertAlmostEqual(ground.GetPoint(0)[2], 1000.0 + 0.75 * 180.0, 3)
        self.assertGreater(ground.GetPointCount(), 50)  # it has a node at each row that it crosses
        self.assertAlmostEqual(ground.GetPoint(ground.GetPointCount() - 1)[0], WEST + 120, 3)

    def test_flags_alone_give_the_bytes_of_the_file_that_says_the_same(self):
        x, y = np.meshgrid(np.arange(60) * 5.0, np.arange(60)[::-1] * 5.0)
        write_dem(self.path("dem.tif"), (1000.0 + 0.75 * np.maximum(0.0, y - 100.0)).astype(np.float32))
        line = f"LINESTRING ({WEST + 150} {NORTH - 10}, {WEST + 150} {NORTH - 280})"
        write_features(self.path("line.gpkg"), "line", [(line, [])])
        self.write("p.toml", 'dem = "dem.tif"\nline = "line.gpkg"\nsurface = "bilinear"\ntrajectories = 40\n[sources]\n'
                             'x = [10, 20]\nrelease_height = 2\n[blocks]\ndiameter = 1.5\n[ground]\ndefault = "quarry-floor-2d"\n'
                             '[model]\ndeformation_coefficient = 0.2\n[screens]\nx = [60, 120]\n')
        self.profile()
        flags = ["--dem", self.path("dem.tif"), "--line", self.path("line.gpkg"), "--surface", "bilinear", "--trajectories", "40",
                 "--source-x", "10,20", "--release-height", "2", "--diameter", "1.5", "--preset", "quarry-floor-2d",
                 "--deformation-coefficient", "0.2", "--screen-x", "60,120"]
        self.run_well("profile", *flags, "-o", self.path("flags"), "-q")
        self.run_well("profile", self.path("flags/profile.toml"), "-o", self.path("again"), "-q")
        for name in ("envelope.csv", "runout.csv", "stops.csv", "screens.csv", "profile.svg"):
            for out in ("flags", "again"):
                self.assertEqual(self.contents(out)[name], self.contents("out")[name], f"{out} {name}")
        self.run_well("report", self.path("flags"))
        # A flag counts more than the file.
        self.profile("--screen-x", "100", "--source-x", "30", out="other")
        self.assertEqual({row["screen"] for row in self.rows("screens.csv", "other")}, {"100"})
        self.assertIn("x = 30 ", self.read_text("other/profile.toml").replace("\n", " "))

    def test_faults_of_flags(self):
        write_dem(self.path("dem.tif"), np.full((60, 60), 1000.0, np.float32))
        write_features(self.path("line.gpkg"), "line", [(f"LINESTRING ({WEST + 150} {NORTH - 10}, {WEST + 150} {NORTH - 280})", [])])
        terrain = ["--dem", self.path("dem.tif"), "--line", self.path("line.gpkg")]
        for flags, words in (
                ([], "no terrain: give --dem and --line, or in the file dem"),
                (terrain, "no sources: give --source-x 60 or --source-x 50,70, or in the file [sources] x = 60"),
                ([*terrain, "--source-x", "10"], "no block diameter, must have one: give --diameter"),
                ([*terrain, "--source-x", "10", "--diameter", "60"], "flag --diameter = 60: must be 0.01 to 50 m"),
                ([*terrain, "--source-x", "300", "--diameter", "1"], "flag --source-x = 300: must be on the profile, 0 to 270 m"),
                ([*terrain, "--source-x", "40,20", "--diameter", "1"], "must be one place, as 20, or from and to, as 20,40"),
                ([*terrain, "--source-x", "20", "--diameter", "1", "--screen-x", "5,5"], "flag --screen-x = [5, 5]: has 5 twice"),
                ([*terrain, "--source-x", "20", "--diameter", "1", "--screen-x", "500"], "flag --screen-x = 500: must be on the profile"),
                ([*terrain, "--source-x", "20", "--diameter", "1", "--release-height", "-1"], "flag --release-height = -1: must be 0 to 500 m"),
                ([*terrain[:2], "--line", "none.gpkg", "--source-x", "20", "--diameter", "1"], "flag --line = 'none.gpkg'")):
            self.fails(2, words, arguments=("profile", *flags, "-o", self.path("out")))
            self.assertFalse(os.path.exists(self.path("out")))
        for flags, words in ((["--surface", "bilinear"], "flag --surface: is of a DEM, must be left out"),
                             (terrain, "flag --dem: is given beside p.toml: profile"),
                             (["--line", self.path("line.gpkg")], "flag --line: is given beside p.toml: profile")):
            self.fails(2, words.replace("p.toml", self.path("p.toml")), arguments=("profile", self.path("p.toml"), *flags, "-o", self.path("out")))
        self.fails(2, "flag --dem: is given without line (--line)", arguments=("profile", *terrain[:2], "-o", self.path("out")))

    def test_a_preset_that_changes_nothing_is_told(self):
        self.scenario("x = 20", "[ground.zones.default]\ntheta_scale = 1\nEn50 = 10\nEt50 = 40\nphi = 30\nshape = [1, 1.4]\n")
        told = self.run_well("profile", self.path("p.toml"), "-o", self.path("out"), "--trajectories", "5", "--preset", "quarry-floor-2d")
        self.assertIn("flag --preset = 'quarry-floor-2d' changes nothing", told.stderr)

    def test_a_line_with_a_vertex_far_off_the_dem(self):  # each column of cells on the way there was listed: 4 GB
        write_dem(self.path("dem.tif"), np.full((60, 60), 1000.0, np.float32))
        write_features(self.path("line.gpkg"), "line", [(f"LINESTRING ({WEST + 50} {NORTH - 50}, 900000000 {NORTH - 50})", [])])
        for surface in ("bilinear", "creased"):
            self.scenario("x = 10", "", f'dem = "dem.tif"\nline = "line.gpkg"\nsurface = "{surface}"\n')
            limit = ["bash", "-c", 'ulimit -v 2000000; exec "$@"', "-"]  # KiB
            done = subprocess.run([*limit, TALUS, "profile", self.path("p.toml"), "-o", self.path("out")], capture_output=True,
                                  text=True, check=False)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertRegex(done.stderr, r"no terrain under it (247\.5|250|252\.5) m from its start")  # last centre: at 297.5 m

    def test_terrain_that_the_step_leaves_out(self):
        """A dam of 3 m on the row at y = -57.5. Half-way between two rows, where the line crosses diagonals, it is 1.5 m.
        With nodes every 10 m, at y = -50 and y = -60, the profile rises by 1.5 m there, and lies 1.875 m below the dam."""
        heights = np.full((60, 60), 1000.0, np.float32)
        heights[11] += 3.0
        write_dem(self.path("dem.tif"), heights)
        line = f"LINESTRING ({WEST + 50} {NORTH - 20}, {WEST + 50} {NORTH - 150})"
        write_features(self.path("line.gpkg"), "line", [(line, [])])
        for step, nodes, missed in (("10", 14, True), ("2.5", 53, False)):  # samples are 2.5 m apart, but for rounding
            self.scenario("x = 10", "[output]\nbin = 10\n", f'dem = "dem.tif"\nline = "line.gpkg"\nstep = {step}\n')
            self.profile("--trajectories", "5", out=f"out{nodes}")
            told = "".join(self.read_json(f"out{nodes}/run.json")["warnings"])
            self.assertEqual("at x = 37.5 m the profile is 1.9 m above or below the DEM" in told, missed)
            ground = rows_of(self.path(f"out{nodes}/profile.gpkg"), "profile")[0][1]
            self.assertEqual(ground.GetPointCount(), nodes)

    def test_the_heights_are_those_of_the_dem_or_a_warning_says_how_far_off(self):
        """Benches of 5 m in cells of 0.5 m and a line across them. The surface where the line crosses from one pair of
        cells to the next is interpolated here between these two."""
        rows, columns = np.indices((60, 60))
        down = 0.5 * (rows + 0.5) + 2.0 * np.sin(columns / 9.0)  # m
        z = np.interp(down, [0, 8, 9.5, 14, 15.5, 20, 21.5, 40], [1000, 1000, 995, 995, 990, 990, 985, 985]).astype(np.float32)
        write_dem(self.path("dem.tif"), z, cell=0.5)
        a, b = np.array([4.3, 1.1]), np.array([21.7, 28.6])  # from the upper left corner, right and down
        line = "LINESTRING (" + ", ".join(f"{WEST + x} {NORTH - y}" for x, y in (a, b)) + ")"
        write_features(self.path("line.gpkg"), "line", [(line, [])])
        length, truth = math.hypot(*(b - a)), []
        for axis in (0, 1):
            from_, to = a[axis] / 0.5 - 0.5, b[axis] / 0.5 - 0.5  # in cells, 0 at the first centre
            for whole in range(math.ceil(from_), math.floor(to) + 1):
                share = (whole - from_) / (to - from_)
                other = (a + share * (b - a))[1 - axis] / 0.5 - 0.5
                pair = z[:, whole] if axis == 0 else z[whole]
                truth.append((share * length, np.interp(other, np.arange(60), pair)))
        x, height = np.array(truth).T
        for step, is_off in ((0.05, False), (1, True), (5, True)):
            with self.subTest(step):
                self.scenario("x = 1", "[output]\nbin = 5\n",
                              f'dem = "dem.tif"\nline = "line.gpkg"\nsurface = "bilinear"\nstep = {step}\n')
                self.profile("--trajectories", "5", "--overwrite")
                ground = rows_of(self.path("out/profile.gpkg"), "profile")[0][1]
                nodes = np.array([ground.GetPoint(i) for i in range(ground.GetPointCount())])
                along = np.hypot(nodes[:, 0] - WEST - a[0], NORTH - nodes[:, 1] - a[1])
                off = np.abs(np.interp(x, along, nodes[:, 2]) - height)
                at = off.argmax()
                self.assertEqual(off[at] > 0.1, is_off)
                told = [text for text in self.record()["warnings"] if "leaves out terrain" in text]
                self.assertEqual(len(told), is_off)
                if is_off:
                    self.assertIn(f"at x = {x[at]:.1f} m the profile is {off[at]:.2g} m above or below", told[0])
                    self.assertIn("give a smaller step", told[0])

    def test_no_smaller_step_than_the_smallest_is_recommended(self):
        z = 100.0 + np.random.default_rng(1).uniform(0.0, 1.0, (60, 60)) - 0.03 * np.arange(60)[:, None]
        write_dem(self.path("dem.tif"), z.astype(np.float32), cell=0.05)
        line = f"LINESTRING ({WEST + 0.5} {NORTH - 0.5}, {WEST + 2.0} {NORTH - 2.5})"
        write_features(self.path("line.gpkg"), "line", [(line, [])])
        for step, words in ((0.05, "there is no smaller step: see in profile.svg"), (0.1, "give a smaller step")):
            self.scenario("x = 1", "[output]\nbin = 5\n", f'dem = "dem.tif"\nline = "line.gpkg"\nstep = {step}\n')
            self.profile("--trajectories", "5", "--overwrite")
            told = [text for text in self.record()["warnings"] if "leaves out terrain" in text]
            self.assertEqual(len(told), 1)
            self.assertIn(words, told[0])
            self.assertEqual("give a smaller step" in told[0], step > 0.05)

    def test_nodes_nearer_than_a_step(self):
        self.nodes((0, 100), (50, 50), (50.02, 40), (200, 0))
        for step, words in ((0.05, "or lean walls by that much"), (0.1, "lean walls by that much, or give a smaller step")):
            self.scenario("x = 1", head=f'profile = "p.csv"\nstep = {step}\n')
            said = self.fails(2, "p.csv:4: x = '50.02'", f"at least step = {step} m beyond 50", words,
                              arguments=["profile", self.path("p.toml"), "-o", self.path("none")]).stderr
            self.assertEqual("smaller step" in said, step > 0.05)


class Messages(Profile):
    """What is said of a profile names what a profile has, with a way out."""

    def told(self, *extra):
        return self.run_well("profile", self.path("p.toml"), "-o", self.path("out"), "--overwrite", *extra).stderr

    def test_zones_without_an_effect(self):
        self.nodes((0, 200), (150, 87.5), (400, 15))
        step = 'profile = "p.csv"\nstep = 5\n'
        road = "[ground.zones.road]\npreset = 'forest-road-2d'\nx = "
        wood = "[ground.zones.wood]\npreset = 'quarry-floor-2d'\nx = "
        narrow = "ground.zones.road.x = [211, 214]: covers none of the columns, which are step = 5 m apart"
        under = "ground.zones.road.x = [150, 160]: lies wholly under later zones"
        for rest, expected in ((road + "[211, 214]\n", [narrow]),
                               (road + "[[150, 160], [211, 214]]\n", [narrow]),
                               (road + "[211, 216]\n", []),  # holds the column at 215 m
                               (road + "[150, 160]\n" + wood + "[100, 300]\n", [under]),
                               (road + "[[150, 160], [350, 360]]\n" + wood + "[100, 300]\n", [under]),
                               (wood + "[100, 300]\n" + road + "[150, 160]\n", []),
                               (road + "[150, 160]\n" + wood + "[155, 300]\n", [])):
            with self.subTest(rest):
                self.scenario("x = 20", rest, step)
                said = self.told("--trajectories", "5")
                told = [text for text in self.record()["warnings"] if "has no effect" in text]
                self.assertEqual(len(told), len(expected), told)
                for text, words in zip(told, expected):
                    self.assertIn("p.toml: " + words, text)
                    self.assertIn("give a smaller step" if words is narrow else "move this one below them", text)
                    self.assertIn("talus: warning: " + text, said)

    def test_trapped_blocks(self):
        self.nodes((0, 100), (100, 0), (200, 100))  # 45 degrees on both sides: a block cannot rest on them
        self.scenario("x = 20")
        said = self.told("--trajectories", "50")
        self.assertIn("0 stopped, 50 trapped, 0 left the profile", said)
        self.assertIn("100 % of the trajectories (50) were trapped", said)
        self.assertIn("stops.csv shows where (end = trapped)", said)
        self.assertEqual({row["end"] for row in self.rows("stops.csv")}, {"trapped"})
        self.assertIn("runout of those that stopped or were trapped: mean 80 m", said)
        for word in (".tif", "talus check", "DEM", "the maps"):
            self.assertNotIn(word, said)
        self.assertEqual(len(self.record()["warnings"]), 1)

    def test_a_profile_that_is_drawn_upwards(self):
        down = [(0, 100), (50, 60), (100, 0), (120, 30)]
        for nodes, said in ((down, False), ([(120 - x, z) for x, z in reversed(down)], True)):
            self.nodes(*nodes)
            self.scenario("x = 60")
            text = "the profile falls to 0.0 m at a smaller x than the sources, and to "
            self.assertEqual(text in self.told("--trajectories", "5"), said)
        self.fails(2, "out: is of a profile, which has no maps", arguments=["hazard", self.path("out")])

    def test_blocks_that_leave(self):
        self.nodes((0, 100), (100, 0))
        self.scenario("x = 20")
        said = self.told("--trajectories", "50")
        self.assertIn("100 % of the trajectories (50) left the profile at its ends", said)
        self.assertIn("a longer profile would", said)
        self.assertIn("0 stopped, 0 trapped, 50 left the profile", said)
        for word in ("DEM", "the map", "missing data"):
            self.assertNotIn(word, said)

    def test_too_many_limits(self):
        self.nodes((0, 200), (150, 87.5), (400, 15))
        self.scenario("x = 20", "[model]\ntime_limit = 1\n")
        self.fails(1, "ended at the limit of impacts, time or vertices", "stops.csv shows where (end = limit)",
                   "raise time_limit or impact_limit in [model]",
                   arguments=["profile", self.path("p.toml"), "-o", self.path("out"), "--trajectories", "5", "-q"])
        self.assertEqual({row["end"] for row in self.rows("stops.csv")}, {"limit"})

    def test_the_file_of_another_command_is_told_from_its_own(self):
        self.nodes((0, 200), (150, 87.5), (400, 15))
        self.scenario("x = 20", "[screens]\nx = [110]\n")
        self.scenario("x = 20", "", 'dem = "dem.tif"\nline = "line.gpkg"\n', name="cut.toml")
        for name, words in (("p.toml", ":1: profile = 'p.csv'"), ("cut.toml", ":2: line = 'line.gpkg'")):
            for command in (["run", self.path(name), "-o", self.path("none")], ["check", self.path(name)],
                            ["trace", self.path(name), "--source", "0", "--block", "0"]):
                with self.subTest(command):
                    self.fails(2, name + words, "this is a file of talus profile", f"talus profile {self.path(name)} -o",
                               arguments=command)
        self.write("run.toml", 'dem = "dem.tif"\n[sources]\nfile = "sources.gpkg"\n')
        self.write("campaign.toml", 'dem = "dem.tif"\nblocks = "blocks.csv"\nstops = "stops.csv"\n')
        of_run = ("run.toml:2: [sources]", "this is a scenario of talus run", f"talus run {self.path('run.toml')} -o")
        of_campaign = ("campaign.toml:3: stops = 'stops.csv'", "this is a campaign of talus calibrate",
                       f"talus calibrate {self.path('campaign.toml')} -o")
        for command, words in ((["profile", self.path("run.toml"), "-o", self.path("none")], of_run),
                               (["calibrate", self.path("run.toml"), "-o", self.path("none")], of_run),
                               (["diagnose", self.path("run.toml"), "-o", self.path("none")], of_run),
                               (["profile", self.path("campaign.toml"), "-o", self.path("none")], of_campaign),
                               (["run", self.path("campaign.toml"), "-o", self.path("none")], of_campaign),
                               (["calibrate", self.path("p.toml"), "-o", self.path("none")],
                                ("p.toml:1: profile = 'p.csv'", "must be a campaign of talus calibrate"))):
            with self.subTest(command):
                self.fails(2, *words, arguments=command)

    def test_the_default_ground_is_that_of_the_list_of_presets(self):
        self.nodes((0, 200), (150, 87.5), (400, 15))
        self.scenario("x = 20")
        self.profile("--trajectories", "5")
        settings = {s["key"]: (s["value"], s["source"]) for s in self.record()["settings"]}
        default, source = settings["ground.default"]
        self.assertEqual(source, "default")
        self.assertIn(f"upper-talus-3d holds; for talus profile, {default}.\n", self.run_well("presets").stdout)


class Products(Profile):
    """`talus barrier` and `talus report` on the folder of a profile say what holds there."""

    def setUp(self):
        super().setUp()
        self.nodes((0, 200), (150, 87.5), (155, 87.5), (300, 15), (400, 15))
        self.scenario("x = [18, 22]", "[screens]\nx = [100]\n")
        y = (59.5 - np.arange(60))[:, None] * 5.0 + np.zeros((1, 60))
        write_dem(self.path("slope.tif"), (1000.0 + 0.75 * y).astype(np.float32))
        line = f"LINESTRING ({WEST + 50} {NORTH - 20}, {WEST + 50} {NORTH - 280})"
        write_features(self.path("fall.gpkg"), "line", [(line, [])])
        self.scenario("x = 10", "[screens]\nx = [100]\n", 'dem = "slope.tif"\nline = "fall.gpkg"\n', name="cut.toml")

    def design(self, out, screen):
        done = self.run_well("barrier", self.path(out), "--screen", screen, "-q")
        self.assertEqual(done.stdout, "")
        return self.read_json(f"{out}/barrier_{screen}.json"), self.run_well("barrier", self.path(out), "--screen", screen).stdout

    def page(self, out):
        """The rows of the checklist, as (mark, point, this run, why), and the text of the page."""
        self.run_well("report", self.path(out), "--overwrite")
        page = self.read_text(f"{out}/report.html")
        rows = re.findall(r"<tr[^>]*><td class='k'>\S+ (\w+)</td><td>(.*?)</td><td class='b'>(.*?)</td><td>(.*?)</td></tr>", page)
        self.assertGreater(len(rows), 8)
        return rows, page

    def test_the_report_shows_the_drawing_and_the_run_out(self):
        self.profile("--trajectories", "100", out="profile")
        _, page = self.page("profile")
        self.assertNotIn("The folder has no maps", page)
        (drawing,) = re.findall(r'src="data:image/svg\+xml;base64,([^"]+)"', page)
        self.assertEqual(base64.b64decode(drawing).decode(), self.read_text("profile/profile.svg"))
        beyond = [(float(r["distance_to"]), float(r["share_beyond"])) for r in self.read_table("profile/runout.csv")]
        half = next(to for to, share in beyond if share <= 0.5)
        self.assertIn(f"<td class='n'>50 %</td><td class='n'>{half:.4g}</td>", page)

    def test_a_table_of_another_run(self):  # the page had no table, or that of the other run
        self.profile("--trajectories", "100", out="profile")
        table = self.read_text("profile/runout.csv")
        stayed = sum(int(row["stopped"]) for row in self.read_table("profile/runout.csv"))
        self.profile("--trajectories", "50", out="other")
        for text in (table.splitlines()[0] + "\n", self.read_text("other/runout.csv")):
            self.write("profile/runout.csv", text)
            self.fails(2, "runout.csv: has ", f" blocks that stopped, run.json beside it says {stayed}:", "run the profile again",
                       arguments=["report", self.path("profile")])
        self.write("profile/runout.csv", table)
        self.run_well("report", self.path("profile"))
        said = self.run_well("profile", self.path("p.toml"), "-o", self.path("profile"), "--trajectories", "5", "--overwrite").stderr
        self.assertIn("note: --overwrite will also remove what later commands have written", said)

    def test_flags_that_notes_name_are_of_the_command_that_made_the_folder(self):
        line = f"LINESTRING ({WEST + 20} {NORTH - 180}, {WEST + 280} {NORTH - 180})"
        write_features(self.path("screens.gpkg"), "screens", [(line, ["100"])], [("id", ogr.OFTString)])
        self.run_well(*self.arguments("run"), "--screens", self.path("screens.gpkg"), "-q")
        self.profile("--trajectories", "100", out="profile")
        self.profile("--trajectories", "100", name="cut.toml", out="cut")
        flags = {command["name"]: {flag for p in command["parameters"] for flag in p["flags"]}
                 for command in json.loads(self.run_well("help", "--json").stdout)["commands"]}
        for out, command in (("run", "run"), ("profile", "profile"), ("cut", "profile")):
            report, _ = self.design(out, "100")
            self.assertIn("c = 0.25", " ".join(report["notes"]))
            rows, _ = self.page(out)
            texts = report["notes"] + [text for row in rows for text in row]
            named = {flag for text in texts for flag in re.findall(r"--[a-z][a-z-]*", text)}
            self.assertLessEqual(named, flags[command], out)
            self.assertIn("--trajectories", named)

    def test_a_profile_has_no_width(self):
        self.profile("--trajectories", "100")
        report, text = self.design("out", "100")
        self.assertIsNone(report["containment"])
        self.assertEqual(report["stretches"], [])
        self.assertNotIn("width", text)
        self.assertNotIn("stretch", text)
        self.assertNotIn("along the line", text)
        self.assertEqual(sorted(name for name in self.contents("out") if name.startswith("barrier_")), ["barrier_100.csv", "barrier_100.json"])
        self.assertNotIn("Each stretch", self.page("out")[1])
        for flag, value in (("--stretch", "5"), ("--containment", "90")):
            self.fails(2, flag, "of a profile", "leave it out", arguments=["barrier", self.path("out"), "--screen", "100", flag, value])
        self.profile("--trajectories", "100", "--overwrite")  # what barrier and report have added is Talus's own

    def test_the_checklist_names_the_terrain_of_the_profile(self):
        for name, out, terrain, x in (("p.toml", "csv", "profile p.csv", "[18, 22]"),
                                      ("cut.toml", "dem", "fall.gpkg over the DEM slope.tif", "10")):
            self.profile("--trajectories", "100", name=name, out=out)
            rows, page = self.page(out)
            points = {point: (mark, found) for mark, point, found, _ in rows}
            self.assertEqual(points["Profile"], ("look", terrain))
            self.assertEqual(points["Sources"], ("look", f"x = {x} m"))
            self.assertNotIn("DEM", points)
            self.assertNotIn("No relief", page)
            self.assertIn("look at the profile there", {point: why for _, point, _, why in rows}["Blocks that are trapped"])


class Faults(OnASlope):
    def fails_with(self, *words):
        before = os.listdir(self.folder)
        self.fails(2, *words, arguments=["profile", self.path("p.toml"), "-o", self.path("new")])
        self.assert_nothing_left(before)

    def assert_one_fault(self, *words):
        done = self.fails(2, *words, arguments=["profile", self.path("p.toml"), "-o", self.path("new")])
        self.assertNotIn("more)", done.stderr)

    def test_keys(self):
        for rest, words in {
                "[screens]\ny = [5]\n": ["p.toml:", "unknown key 'y' in [screens]"],
                "[ground.zones.road]\npreset = 'forest-road-2d'\n": ["ground.zones.road.x is missing", "[from, to]"],
                "[ground.zones]\nx = [9, 5]\n": ["ground.zones.x = [9, 5]: must be a table"],  # ended with a crash
                "[ground.zones.road]\nx = [9, 5]\n": ["ground.zones.road.x", "[from, to]"],
                "[ground.zones.road]\nx = [900, 950]\n": ["lies off the profile", "0 to 400 m"],
                "[ground.zones.default]\npsi_scale = 0.5\n": ["psi_scale = 0.5", "no sideways roughness"],
                "[effects.forest-stems]\ndensity = 300\n": ["forest-stems", "out of the plane"],
                "[screens]\nx = [401]\n": ["screens.x = 401", "0 to 400 m"],
                "[screens]\nx = [110, 50, 110.0]\n": ["screens.x = [110, 50, 110]", "has 110 twice, must name each place once"],
                "[output]\nbin = 0.25\n": ["output.bin = 0.25", "whole multiple of step"],
                "[output]\nenergy_thresholds = [3]\n": ["unknown key 'energy_thresholds'"],
        }.items():
            with self.subTest(rest):
                self.scenario("x = 20", rest)
                self.fails_with(*words)
        self.scenario("x = 20", head='profil = "p.csv"\n')
        self.fails(2, "unknown key 'profil' at the top", "did you mean 'profile'",
                   arguments=["profile", self.path("p.toml"), "-o", self.path("new")])
        self.scenario("x = 500")
        self.fails_with("sources.x = 500", "0 to 400 m")
        self.scenario("x = 400")
        self.fails_with("sources.x = 400", "is the end of the profile", "must be below 400 m")
        self.write("p.toml", 'profile = "p.csv"\n[blocks]\ndiameter = 1\n')
        self.fails_with("no sources")
        for given, words in (("x = [30, 20]", "sources.x = [30, 20]: must be [smallest, largest]"),
                             ("x = 'top'", "sources.x = 'top'"), ("x = 2e7", "sources.x = 20000000")):
            self.scenario(given)
            self.assert_one_fault(words)
        self.scenario("x = 20", head="profile = 5\n")
        self.assert_one_fault("profile = 5: must be text in quotation marks")
        self.write("p.toml", 'profile = "p.csv"\n[sources]\nx = 20\n')
        self.fails_with("no block diameter")
        self.scenario("x = 20", head='profile = "p.csv"\ndem = "dem.tif"\n')
        self.fails_with("dem: is given beside", "must be one of the two")

    def test_frequencies(self):
        """A profile has none: results would be as if they were not given (docs/profile.md)."""
        rule = ["p.toml:5", "blocks.diameter", "a profile has no annual frequencies: leave frequency out"]
        for diameter, words in {
                "[{ diameter = 0.5, frequency = 10 }, { diameter = 1.5, weight = 9, frequency = 0.01 }]": rule,
                "[{ diameter = 0.5 }, { diameter = 1.5, frequency = 0 }]": rule,
                "[{ diameter = [1, 2], frequency = 1 }]": rule,
                "{ volume_min = 0.1, volume_max = 1, exponent = 1, frequency = 1 }": ["unknown key 'frequency'"],
                "1\n[frequency]\ntotal = 1": ["unknown key 'frequency' at the top"],
                "1\n[frequency]\npower_law = { A = 0.01, b = 0.6 }": ["unknown key 'frequency' at the top"],
        }.items():
            with self.subTest(diameter):
                self.scenario("x = 20", diameter=diameter)
                self.fails_with(*words)
        self.scenario("x = 20", head='include = "model.toml"\nprofile = "p.csv"\n')
        self.fails_with("unknown key 'include' at the top")
        self.scenario("x = 20", diameter="[{ diameter = 0.5, weight = 1 }, { diameter = 1.5, weight = 9 }]")
        self.profile("--trajectories", "1000")
        large = sum(row["diameter_m"] == 1.5 for row in self.rows("stops.csv"))
        self.assertLess(abs(large - 900), 5 * math.sqrt(1000 * 0.9 * 0.1))  # the weights give the shares

    def test_files(self):
        for text, words in {"x,z\n0,5\n": ["1 nodes"], "x,z\n0,5\n0.01,4\n": ["p.csv:3", "x = '0.01'", "step = 0.1"],
                            "x,z\n9,5\n3,4\n": ["p.csv:3", "order the rows"], "x,y\n0,5\n": ["unknown column 'y'"],
                            "x,z\n0,abc\n9,1\n": ["p.csv:2", "z = 'abc'"]}.items():
            with self.subTest(text):
                self.write("p.csv", text)
                self.scenario("x = 0")
                self.fails_with(*words)
        self.scenario("x = 20", head='profile = "none.csv"\n')
        self.fails_with("none.csv", "no such file")
        write_features(self.path("line.gpkg"), "line", [(f"LINESTRING ({WEST} {NORTH},{WEST + 90} {NORTH})", [])])
        self.scenario("x = 20", head='dem = "dem.tif"\nline = "line.gpkg"\n')
        self.fails_with("line.gpkg", "no terrain")

    def test_a_line_must_lie_strictly_between_the_outermost_centres(self):
        self.scenario("x = 0", head='dem = "dem.tif"\nline = "line.csv"\n')
        west, south = WEST + 2.5, NORTH - 297.5  # of the 60 x 60 cells of 5 m
        for inside, (x, y) in ((False, (295, 100)), (False, (100, 295)), (True, (294.9, 100)), (True, (100, 294.9))):
            with self.subTest((x, y)):
                self.write("line.csv", f'id,wkt\n1,"LINESTRING ({west + 100} {south + 100},{west + x} {south + y})"\n')
                if inside:
                    self.profile("--trajectories", "5", "--overwrite")
                else:
                    self.fails_with("line.csv", "no terrain under it 195 m from its start",
                                    "must lie on the DEM, strictly between the centres of its outermost cells")

    def test_a_line_that_comes_back_to_itself(self):  # x stood for two grounds of one place, without a word
        self.scenario("x = 10", head='dem = "dem.tif"\nline = "line.gpkg"\n')
        for places, vertex in (([(150, 280), (150, 100), (150, 200)], 3), ([(150, 280), (150, 100), (150, 200), (150, 20)], 3),
                               ([(150, 280), (150, 100), (151, 200), (152, 20)], 3),  # beside itself: drawn there and back
                               ([(150, 280), (150, 150), (200, 150), (200, 200), (100, 200), (100, 20)], 5),
                               ([(150, 280), (160, 280), (160, 200), (150, 200), (150, 280)], 5),
                               ([(150, 280), (150, 200), (150, 200), (160, 150), (150, 20)], None),
                               ([(150, 280), (150, 100), (150, 100.8), (150, 20), (150, 20.5)], None),  # slips, at the end, too
                               ([(150 + 0.5 * (-1)**(i // 2), 280 - i + 1.5 * (i % 3)) for i in range(200)], None)):  # of a GPS
            text = ", ".join(f"{WEST + x} {NORTH - 300 + y}" for x, y in places)
            write_features(self.path("line.gpkg"), "line", [(f"LINESTRING ({text})", [])])
            if vertex is None:
                self.profile("--trajectories", "2", "--overwrite")
                continue
            x, y = places[vertex - 1]
            self.fails(2, "line.gpkg: the line runs back over itself or crosses itself before its vertex "
                       f"{vertex} ({WEST + x:.1f}, {NORTH - 300 + y:.1f}), must pass each place once",
                       arguments=["profile", self.path("p.toml"), "-o", self.path("out")])

    def test_a_line_off_the_dem_says_where_both_lie(self):
        self.scenario("x = 0", head='dem = "dem.tif"\nline = "line.csv"\n')
        self.write("line.csv", 'id,wkt\n1,"LINESTRING (8.09 46.68,8.1 46.69)"\n')
        self.fails_with("line.csv: lies wholly off the DEM", "these look like degrees")

    def test_folders(self):
        self.profile("--trajectories", "5")
        self.fails(2, "--overwrite", arguments=["profile", self.path("p.toml"), "-o", self.path("out")])
        self.profile("--trajectories", "6", "--overwrite")
        self.assertEqual(len(self.rows("stops.csv")), 6)
        self.fails(2, "--trajectories", arguments=["profile", self.path("p.toml"), "-o", self.path("new"),
                                                   "--trajectories", "-1"])

    def test_the_value_of_c_is_told(self):
        """As `talus run` does: docs/barrier.md, "The value of c"."""
        for model, told in (("", "0.25"), ("[model]\ndeformation_coefficient = 0.16\n", "0.16"),
                            ("[model]\ndeformation_coefficient = 0.15\n", None)):
            self.scenario("x = 20", model)
            done = self.run_well("profile", self.path("p.toml"), "-o", self.path("out"), "--trajectories", "5", "--overwrite")
            notes = [line for line in done.stderr.splitlines() if line.startswith("talus: note: ")]
            self.assertEqual(len(notes), told is not None)
            if told:
                self.assertIn(f"energies, jumps, run-out and hits may be too low (unsafe): c = {told} ", notes[0])
                self.assertIn("Run with --deformation-coefficient 0.15 as well", notes[0])
        self.scenario("x = 20")
        self.assertEqual(self.profile("--trajectories", "5", "--overwrite").stderr, "")

    def test_a_3d_preset_is_warned_of(self):
        self.scenario("x = 20", "[ground]\ndefault = 'upper-talus-3d'\n")
        done = self.run_well("profile", self.path("p.toml"), "-o", self.path("new"), "--trajectories", "5")
        self.assertIn("upper-talus-3d is of the 3D model", done.stderr)


if __name__ == "__main__":
    unittest.main()
