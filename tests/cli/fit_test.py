"""`talus score` and `talus calibrate` as a user calls them; the score against an independent implementation."""
import csv
import importlib.util
import json
import math
import os
import tomllib
import unittest
import warnings
from xml.etree import ElementTree

from support import NORTH, WEST, Case

ELM = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../data/elm")
CAMPAIGNS = os.path.join(os.environ.get("TALUS_DATA", ""), "campaigns")
PRESET = '[ground]\ndefault = "forest-road-3d"\n'


def reference():
    """score.py, which others wrote from the same definition; None without it."""
    path = os.path.join(CAMPAIGNS, "score.py")
    if not os.path.exists(path):
        return None
    spec = importlib.util.spec_from_file_location("score", path)
    module = importlib.util.module_from_spec(spec)
    warnings.simplefilter("ignore", ResourceWarning)  # it leaves its files to be closed
    spec.loader.exec_module(module)
    return module


@unittest.skipUnless(reference(), "no campaigns with score.py at TALUS_DATA")
class AgainstTheReference(Case):
    """score.py on the values that the program simulated must give the program's own scores."""

    def compare(self, name, trials):
        folder = os.path.join(CAMPAIGNS, name)
        done = self.run_well("score", folder + "/campaign.toml", "--parameters", self.write("m.toml", PRESET), "--trials",
                             str(trials), "--json", "-q", "--dump", self.path(name))
        result = json.loads(done.stdout)
        module = reference()
        measured = module.measured(folder)
        measured["err"] = {}  # the measurement error is in the values already
        mass = {b: float(row["mass_kg"]) for b, row in measured["blocks"].items()}
        stops = [dict(block=r["block"], trial=r["trial"], x=r["x"], y=r["y"], stopped=str(int(r["end"] in ("stopped", "trapped"))),
                      caught=str(int(r["end"] == "caught")), mass_stop=float(r["mass_share"]) * mass[r["block"]])
                 for r in self.read_table(name + "/stops.csv")]
        passages = [dict(block=r["block"], trial=r["trial"], screen=r["screen"], speed=r["speed_ms"],
                         jump=r["jump_height_m"], omega=r["angular_velocity_rads"])
                    for r in self.read_table(name + "/passages.csv")]
        simulated = module.simulated(measured, stops, passages, 1)
        fit = measured["fit"]
        for rows, ask in (("fit", fit), ("holdout", set(measured["blocks"]) - fit)):
            _, groups, counts = module.error(measured, simulated, ask, fair_crossed=True)
            ours = {g["group"]: g for g in result[rows]["groups"] if not g["group"].startswith("sample")}
            self.assertEqual(set(ours), set(groups))
            self.assertGreaterEqual(len(groups), 1)
            for group, score in groups.items():
                self.assertAlmostEqual(ours[group]["score"], score, delta=1e-6, msg=f"{name} {rows} {group}")
                self.assertEqual(ours[group]["rows"], counts[group])
        # The climatology of a held-out row is what score.py gives a row without simulated values.
        held_out = set(measured["blocks"]) - fit
        _, groups, _ = module.error(measured, module.simulated(measured, [], [], 1), held_out)
        ours = {g["group"]: g["climatology"] for g in result["holdout"]["groups"]}
        for group in set(groups) - {g for g in groups if g.startswith("crossed")}:
            self.assertAlmostEqual(ours[group], groups[group], delta=1e-6, msg=f"{name} climatology {group}")

    def test_screens_and_stops(self):
        self.compare("alder", 40)
        self.compare("elm", 40)

    def test_rows_with_few_simulated_values_score_as_the_climatology(self):
        self.compare("fir", 12)

    def test_broken_blocks(self):
        self.compare("ginkgo", 30)
        self.compare("birch", 30)

    def test_stops_alone(self):
        self.compare("authume", 40)
        self.compare("tschamut", 40)


class BlocksThatLeave(Case):
    """A ground that hardly brakes sends blocks off the DEM that were measured at rest on it."""

    def test_a_preset_is_the_model_that_names_it_alone(self):
        """For zones, too: elm has three."""
        file = self.write("preset.toml", '[ground]\ndefault = "lower-talus-3d"\n')
        asked = ["score", ELM + "/campaign.toml", "--trials", "20", "--json"]
        of_file = self.run_well(*asked, "--parameters", file).stdout
        self.assertEqual(self.run_well(*asked, "--preset", "lower-talus-3d").stdout, of_file)
        self.assertNotEqual(self.run_well(*asked, "--preset", "upper-talus-3d").stdout, of_file)
        for models in ([], ["--preset", "lower-talus-3d", "--parameters", file]):
            self.fails(2, "give the model, either --parameters fitted.toml, or --preset upper-talus-3d", arguments=[*asked, *models])
        self.fails(2, "lower-talus", "did you mean", arguments=[*asked, "--preset", "lower-talus-2"])

    SMOOTH = '[ground]\ndefault = "upper-talus-3d"\n[ground.zones.default]\nEn50 = 60\nEt50 = 200\ntheta_scale = 0.3\n'

    def test_they_are_counted(self):
        done = self.run_well("score", ELM + "/campaign.toml", "--parameters", self.write("smooth.toml", self.SMOOTH), "--trials",
                             "20", "--dump", self.path("dump"))
        left = {}
        for row in self.read_table("dump/stops.csv"):
            left[row["block"]] = left.get(row["block"], 0) + (row["end"] == "left")
        with open(ELM + "/blocks.csv", encoding="utf-8") as file:
            held_out = {row["id"]: row["holdout"] == "1" for row in csv.DictReader(file)}
        with open(ELM + "/stops.csv", encoding="utf-8") as file:
            at_rest = {row["id"] for row in csv.DictReader(file)}
        for words, held in (("fitting", False), ("held-out", True)):
            blocks = [b for b in held_out if held_out[b] == held]
            leaving = sum(left[b] > 5 for b in blocks if b in at_rest)
            self.assertGreater(leaving, 0)
            self.assertIn(f"warning: of {leaving} of {len(blocks)} {words} blocks more than a quarter of the trials leave the DEM", done.stderr)
        good = self.write("good.toml", PRESET)
        self.assertNotIn("leave the DEM", self.run_well("score", ELM + "/campaign.toml", "--parameters", good).stderr)


class OwnCampaign(Case):
    """Blocks down the slope of support.py, measured by the program itself from a known model."""

    TRUTH = "[ground.zones.default]\ntheta_scale = 0.3\nEn50 = 4\n"

    def setUp(self):
        super().setUp()
        blocks = "id,x,y,release_height_m,mass_kg,holdout\n" + "".join(
            f"b{i},{WEST + 40 + 5 * i},{NORTH - 40},1,{400 + 20 * i},{int(i % 3 == 2)}\n" for i in range(45))
        self.write("blocks.csv", blocks)
        self.write("screens.csv", f'id,wkt\nS1,"LINESTRING ({WEST + 3} {NORTH - 150}, {WEST + 297} {NORTH - 150})"\n')
        head = 'name = "own"\ndem = "dem.tif"\nblocks = "blocks.csv"\nscreens = "screens.csv"\n'
        errors = "[measurement_error]\nposition_m = 0.3\nspeed_fraction = 0.03\njump_height_m = 0.1\n"
        self.write("truth.toml", self.TRUTH)
        self.write("first.toml", head + errors)
        self.run_well("score", self.path("first.toml"), "--parameters", self.path("truth.toml"), "--trials", "10",
                      "--seed", "99", "--dump", self.path("dump"))
        stops = [r for r in self.read_table("dump/stops.csv") if r["trial"] == "0" and r["x"]]
        passages = [r for r in self.read_table("dump/passages.csv") if r["trial"] == "0"]
        self.write("stops.csv", "id,x,y\n" + "".join(f"{r['block']},{r['x']},{r['y']}\n" for r in stops))
        self.write("passages.csv", "id,screen,speed_ms,jump_height_m\n" + "".join(
            f"{r['block']},{r['screen']},{r['speed_ms']},{r['jump_height_m']}\n" for r in passages))
        self.campaign = self.write("campaign.toml", head + 'stops = "stops.csv"\npassages = "passages.csv"\n' + errors)

    def test_calibrate_keeps_and_fits_effects(self):
        start = self.write("start.toml", "[effects.rest-in-roughness]\nkappa = 0.5\n")
        fast = ["--starts", "1", "--trials", "20", "-q", "--parameters", start]
        self.run_well("calibrate", self.campaign, "-o", self.path("kept"), "--fit", "En50", *fast)
        self.assertIn("[effects.rest-in-roughness]\nkappa = 0.5\n", self.read_text("kept/fitted.toml"))
        self.run_well("calibrate", self.campaign, "-o", self.path("free"), "--fit", "effects.rest-in-roughness.kappa", *fast)
        record = self.read_json("free/calibration.json")
        (kappa,) = record["parameters"]
        self.assertEqual((kappa["key"], kappa["start"]), ("effects.rest-in-roughness.kappa", 0.5))
        self.assertTrue(0 <= kappa["ci95"][0] <= kappa["ci95"][1] <= 3, kappa)
        self.assertEqual(record["start_model"], start)

    def test_a_second_stop(self):  # was left out with a warning
        rows = self.read_text("stops.csv").splitlines()
        self.write("stops.csv", "\n".join(rows + [rows[2]]) + "\n")
        self.fails(2, f"stops.csv:{len(rows) + 1}: id = '{rows[2].split(',')[0]}': is there already in line 3",
                   arguments=["score", self.campaign, "--parameters", self.path("truth.toml")])

    def test_an_error_that_hides_the_model_is_said(self):  # in cm; any model is then as good as the true one
        arguments = ["score", self.campaign, "--parameters", self.path("truth.toml"), "--trials", "20"]
        self.assertNotIn("is more than half of the spread", self.run_well(*arguments).stderr)
        self.write("campaign.toml", self.read_text("campaign.toml").replace("position_m = 0.3", "position_m = 30"))
        done = self.run_well(*arguments)
        self.assertIn("campaign.toml: [measurement_error] position_m = 30: is more than half of the spread", done.stderr)
        self.assertIn("position_m = 30", " ".join(json.loads(self.run_well(*arguments, "--json", "-q").stdout)["warnings"]))

    def test_tables_of_a_header_alone_are_said(self):  # they passed for tables of blocks that nobody measured
        self.write("s.csv", "id,x,y\n"), self.write("p.csv", "id,screen,speed_ms\n"), self.write("samples.csv", "id,x,y,speed_ms\n")
        for file, other, names in (("stops.csv", "s.csv", ("s.csv", "samples.csv")), ("passages.csv", "p.csv", ("p.csv", "samples.csv"))):
            text = self.read_text("campaign.toml").replace(file, other).replace("[measurement", 'samples = "samples.csv"\n[measurement')
            done = self.run_well("score", self.write("empty.toml", text), "--parameters", self.path("truth.toml"), "--trials", "10")
            for name in names:
                self.assertIn(f"/{name}: has a header and no rows", done.stderr)
            self.assertEqual(done.stderr.count("has a header and no rows"), 2, done.stderr)

    def assert_ranks_are_drawn(self, coverage):
        """ranks.svg has a histogram for each observable, with bars as high as its ranks."""
        svg = "{http://www.w3.org/2000/svg}"
        drawn = ElementTree.parse(self.path("fit/ranks.svg")).getroot().findall(svg + "svg")
        expected = coverage["after"]["fit"] + coverage["after"]["holdout"]
        self.assertEqual([h.find(svg + "text").text for h in drawn], [c["observable"] for c in expected])
        self.assertEqual(len({(h.get("x"), h.get("y")) for h in drawn}), len(drawn))  # none over another
        for histogram, observable in zip(drawn, expected):
            heights = [float(bar.get("height")) for bar in histogram.findall(svg + "rect")[1:]]
            unit = sum(heights) / sum(observable["ranks"])
            for height, rank in zip(heights, observable["ranks"], strict=True):
                self.assertAlmostEqual(height, unit * rank, delta=0.15)

    def fitted_diameters(self, model):
        with open(self.path(model), "rb") as file:
            return tomllib.load(file)["fitted_diameters"]

    def assert_skill_is_that_of(self, climatology, model):
        """The model says how much better it is than the better climatology, of the places or by release."""
        better = min(climatology, climatology["ways_from_release"], key=lambda one: one["score"])
        with open(self.path(model), "rb") as file:
            skill = tomllib.load(file)["fitted_skill"]
        for one, other in zip(skill, [better["skill"], *better["skill_ci95"]], strict=True):
            self.assertAlmostEqual(one, other, delta=6e-5)

    def diameters_of_fitting_rows(self):
        """The smallest and the largest [m], to a millimetre outwards."""
        with open(self.path("blocks.csv"), encoding="utf-8") as file:
            rows = [row for row in csv.DictReader(file) if row.get("holdout") != "1"]
        found = [(6 * float(row["mass_kg"]) / math.pi / float(row.get("density_kgm3") or 2700)) ** (1 / 3) for row in rows]
        return [math.floor(1000 * min(found)) / 1000, math.ceil(1000 * max(found)) / 1000]

    def test_calibrate_lowers_the_error_and_writes_a_model_that_runs(self):
        before = os.listdir(self.folder)
        done = self.run_well("calibrate", self.campaign, "-o", self.path("fit"), "--fit", "theta_scale,En50", "--starts",
                             "2", "--trials", "20")
        self.assertIn("held-out rows (15 blocks)", done.stdout)
        self.assertEqual(sorted(os.listdir(self.path("fit"))), ["calibration.json", "fitted.toml", "ranks.svg", "report.md"])
        self.assertEqual(sorted(os.listdir(self.folder)), sorted(before + ["fit"]))
        result = self.read_json("fit/calibration.json")
        error = result["error"]
        self.assertLess(error["fit"]["after"], error["fit"]["before"])
        self.assertLess(error["holdout"]["after"], error["holdout"]["before"])
        keys = {p["key"]: p for p in result["parameters"]}
        self.assertEqual(set(keys), {"ground.zones.default.theta_scale", "ground.zones.default.En50"})
        for p in keys.values():
            self.assertLessEqual(p["ci95"][0], p["value"])
            self.assertGreaterEqual(p["ci95"][1], p["value"])
        theta = keys["ground.zones.default.theta_scale"]
        self.assertLess(abs(math.log(theta["value"] / 0.3)), 0.5)
        self.assertEqual(len(result["correlation"]), 2)
        self.assertEqual(self.fitted_diameters("fit/fitted.toml"), self.diameters_of_fitting_rows())
        report = self.read_text("fit/report.md")
        for word in ("95 % interval", "Held-out rows", "runout", "speed S1", "Crossed S1", "climatology", "below P95", "Run-out beyond", "`ranks.svg`"):
            self.assertIn(word, report)
        self.assert_ranks_are_drawn(result["coverage"])

        scored = self.run_well("score", self.campaign, "--parameters", self.path("fit/fitted.toml"), "--json")
        self.assertAlmostEqual(json.loads(scored.stdout)["fit"]["score"], error["fit"]["after"], delta=1e-6)  # the same trials
        self.assertLess(error["fit"]["after"], error["fit"]["before"])
        self.assert_skill_is_that_of(json.loads(scored.stdout)["holdout"]["climatology"], "fit/fitted.toml")
        self.write("s.toml", 'include = "fit/fitted.toml"\ndem = "dem.tif"\n[sources]\nfile = "sources.gpkg"\n'
                   "[blocks]\ndiameter = 0.8\n")
        self.run_well("run", self.path("s.toml"), "--trajectories", "3", "-o", self.path("out"))
        self.assertEqual(result["files"], ["calibration.json", "report.md", "fitted.toml", "ranks.svg"])
        self.run_well("calibrate", self.campaign, "-o", self.path("fit"), "--fit", "En50", "--starts", "1", "--trials", "20", "-q",
                      "--overwrite")
        self.assertEqual(len(self.read_json("fit/calibration.json")["parameters"]), 1)
        settings = {s["key"]: s for s in self.record()["settings"]}
        self.assertAlmostEqual(settings["ground.default.theta_scale"]["value"], theta["value"], delta=1e-5)
        self.assertEqual(settings["ground.default.theta_scale"]["source"], "include fit/fitted.toml")
        self.assertIn("include", [i["role"] for i in self.record()["inputs"]])

    def test_each_warning_is_said_once(self):
        head, *rows = self.read_text("blocks.csv").splitlines()
        self.write("blocks.csv", "".join(line + "\n" for line in [head + ",L1_m,L2_m,L3_m"] + [row + ",60,50,40" for row in rows]))  # in cm
        done = self.run_well("calibrate", self.campaign, "-o", self.path("fit"), "--fit", "En50", "--starts", "1", "--trials", "20")
        said = self.read_json("fit/calibration.json")["warnings"]
        self.assertTrue(any("blocks.csv" in warning for warning in said), said)
        for warning in said:
            self.assertEqual(done.stderr.count(warning), 1, warning)

    def test_same_result_for_any_number_of_threads(self):
        texts = []
        for threads in "1", "3":
            out = self.path("t" + threads)
            self.run_well("calibrate", self.campaign, "-o", out, "--fit", "En50", "--starts", "1", "--trials", "20",
                          "--threads", threads, "-q")
            texts.append(self.read_text(out + "/fitted.toml"))
        self.assertEqual(texts[0], texts[1])

    def test_a_model_that_says_nothing_is_refused(self):
        none = self.write("none.toml", "# nothing\n")
        self.fails(2, "none.toml: holds no [ground]", arguments=["score", self.campaign, "--parameters", none])

    def test_few_trials_are_said(self):
        model = ["score", self.campaign, "--parameters", self.path("truth.toml"), "--json"]
        said = json.loads(self.run_well(*model, "--trials", "20").stdout)["warnings"]
        self.assertTrue([w for w in said if w.startswith("--trials 20: must be 100 at least")], said)
        self.assertEqual(json.loads(self.run_well(*model).stdout)["warnings"], [])

    def test_the_list_of_parameters_takes_no_campaign(self):  # --fit took the file that came after it
        self.fails(2, "nowhere.toml: no such file", arguments=["calibrate", "--fit", "theta_scale", self.path("nowhere.toml"), "-o", self.path("x")])

    def test_score_prints_rows_beside_the_score(self):
        done = self.run_well("score", self.campaign, "--parameters", self.path("truth.toml"), "--rows", "fit")
        self.assertRegex(done.stdout, r"stop +\d\.\d{3} +\d\.\d{3} to +\d\.\d{3} +28\n")
        self.assertNotIn("held-out", done.stdout)
        self.assertRegex(done.stdout, r"\nclimatology +\d\.\d{3} +\d\.\d{3} to +\d\.\d{3} +\d+\n")
        self.assertRegex(done.stdout, r"\nfitting rows: skill \d")
        self.assertRegex(done.stdout, r"\nrunout +28  +\d+ % \(0 to 1\d\) +\d+ % \(\d+ to \d+\) +\d+ % \(\d+ to 100\)\n")
        self.assertNotIn("warning", done.stderr)  # the model that made the data scatters as they do

    def test_a_model_that_scatters_too_little_is_said_to(self):
        """Where each rebound loses nearly all, blocks of one kind stop near one another."""
        self.write("damped.toml", "[ground.zones.default]\ntheta_scale = 0.3\nEn50 = 0.5\nEt50 = 5\n")
        done = self.run_well("score", self.campaign, "--parameters", self.path("damped.toml"), "--json")
        fit = json.loads(done.stdout)["fit"]
        runout = next(c for c in fit["coverage"] if c["observable"] == "runout")
        self.assertLess(min(runout["p_corrected"].values()), 0.01)
        self.assertEqual(sum(runout["ranks"]), runout["rows"])
        self.assertRegex(done.stderr, r"warning: runout: \d+ % of 28 fitting rows lie below the simulated P\d+, \d+ % should")
        text = self.run_well("score", self.campaign, "--parameters", self.path("damped.toml")).stdout
        self.assertRegex(text, r"\nrunout .* \*\n")
        if fit["score"] >= fit["climatology"]["score"]:
            self.assertIn("fitting rows: no skill:", text)
        self.assertLess(fit["tail"]["climatology"], fit["tail"]["score"])

    def test_too_little_that_was_measured(self):
        """No fitting block, fewer than five, and thirty without measurements: one error each, and no folder."""
        head, *blocks = self.read_text("blocks.csv").splitlines()
        for fitting in 0, 4:
            self.write("blocks.csv", "\n".join([head] + [b[:-1] + str(int(i >= fitting)) for i, b in enumerate(blocks)]) + "\n")
            for command in "calibrate", "diagnose":
                self.fails(2, "campaign.toml", f"{fitting} of 45", "of 5 of them that differ", arguments=[command, self.campaign, "-o", self.path("x")])
        self.write("blocks.csv", "\n".join([head] + blocks) + "\n")
        self.write("stops.csv", "id,x,y\n")
        self.write("passages.csv", "id,screen\n")
        self.fails(2, "30 of 45", arguments=["diagnose", self.campaign, "-o", self.path("x")])
        self.assertFalse(os.path.exists(self.path("x")))

    def test_a_model_that_does_nothing_that_was_measured_is_said_to(self):
        """No block gets to the screen: the speeds there are scored by the climatology, not by the model."""
        self.write("stuck.toml", "[ground.zones.default]\nEn50 = 0.1\nEt50 = 0.1\ntheta_scale = 2\nphi = 60\n")
        done = self.run_well("score", self.campaign, "--parameters", self.path("stuck.toml"), "--rows", "fit", "--json")
        groups = {g["group"]: g for g in json.loads(done.stdout)["fit"]["groups"]}
        self.assertEqual(groups["speed S1"]["rows_as_climatology"], groups["speed S1"]["rows"])
        self.assertEqual(groups["stop"]["rows_as_climatology"], 0)
        self.assertRegex(done.stderr, r"warning: speed S1: \d+ of \d+ fitting rows")
        self.assertNotIn("stop", done.stderr)
        done = self.run_well("score", self.campaign, "--parameters", self.path("stuck.toml"))
        self.assertRegex(done.stderr, r"warning: speed S1: \d+ of \d+ held-out rows")

    def test_a_place_off_the_map_would_widen_every_spread(self):
        head, first, *stops = self.read_text("stops.csv").splitlines()
        block, x, rest = first.split(",", 2)
        self.write("stops.csv", "\n".join([head, f"{block},{float(x) + 5e4},{rest}"] + stops) + "\n")
        self.fails(2, "stops.csv:2: x = ", "off the DEM", arguments=["score", self.campaign, "--parameters", self.path("truth.toml")])

    def test_nothing_to_score(self):
        self.write("stops.csv", "id,x,y\n")
        self.write("passages.csv", "id,screen\n")
        self.fails(2, "nothing to score", arguments=["score", self.campaign, "--parameters", self.path("truth.toml")])

    def test_a_day_is_a_number_that_a_model_can_name(self):
        head, *blocks = self.read_text("blocks.csv").splitlines()
        self.write("blocks.csv", "\n".join([head + ",day"] + [b + ",-3" for b in blocks]) + "\n")
        self.fails(2, "blocks.csv:2: day = '-3'", "0 to 1000000", arguments=["score", self.campaign, "--parameters", self.path("truth.toml")])

    def test_faults(self):
        before = os.listdir(self.folder)
        self.fails(2, "--parameters", arguments=["score", self.campaign])
        self.fails(2, "none.toml: no such file (", "check the path: it must be a TOML file", arguments=["score", self.campaign, "--parameters", self.path("none.toml")])
        self.fails(2, "nowhere.toml", arguments=["calibrate", self.path("nowhere.toml"), "-o", self.path("x")])
        self.fails(2, "'E50'", "En50", arguments=["calibrate", self.campaign, "-o", self.path("x"), "--fit", "E50"])
        self.fails(2, "'En50'", "twice", arguments=["calibrate", self.campaign, "-o", self.path("x"), "--fit", "En50,En50"])
        self.fails(2, "'effects.rest-in-roughness.kapa'", "did you mean 'effects.rest-in-roughness.kappa'",
                   arguments=["calibrate", self.campaign, "-o", self.path("x"), "--fit", "effects.rest-in-roughness.kapa"])
        self.fails(2, "says no days", arguments=["calibrate", self.campaign, "-o", self.path("x"), "--fit", "effects.wet-ground.drag"])
        for command in ["score", self.campaign, "--parameters", self.path("truth.toml")], ["calibrate", self.campaign, "-o", self.path("x")]:
            self.fails(2, "--seed", "9007199254740991", arguments=[*command, "--seed", "-1"])
        os.mkdir(self.path("taken"))
        self.write("taken/note.txt", "mine")
        done = self.fails(2, "taken", "new name", arguments=["score", self.campaign, "--parameters", self.path("truth.toml"), "--dump", self.path("taken")])
        self.assertNotIn("--overwrite", done.stderr)  # score has no such option
        os.remove(self.path("taken/note.txt"))
        os.rmdir(self.path("taken"))
        self.write("m.toml", "[ground.zones.rock]\nEn50 = 3\n")
        self.fails(2, "rock", "no such zone", arguments=["score", self.campaign, "--parameters", self.path("m.toml")])
        os.remove(self.path("m.toml"))
        self.assert_nothing_left(before)


if __name__ == "__main__":
    unittest.main()
