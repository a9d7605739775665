"""`talus diagnose` from a campaign to its report, on a synthetic campaign and a measured one: few trials, the whole loop.
All campaigns with the default numbers of trials: docs/diagnosis-results.md."""
import os
import re
import tomllib
import unittest

import luck_test
from support import Case

ELM = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../data/elm")
CAMPAIGNS = os.path.join(os.environ.get("TALUS_DATA", ""), "campaigns")
ONCE = ("--base-fits", "1")  # repeated_test.py has more
FEW = ("--trials", "10", "--test-trials", "30", *ONCE)
DOCS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../docs/effects.md")
with open(DOCS, encoding="utf-8") as page:
    EFFECTS = set(re.findall(r"^\| \[([a-z-]+)\]\(#\1\)", page.read(), re.MULTILINE))
NAMES = EFFECTS | {"none", "unexplained", "undeclared-barrier", "undeclared-zone", "instrument-bias"}


class Diagnose(Case):
    def test_a_campaign_that_is_not_there_is_wrong_input(self):
        self.fails(2, "nowhere.toml", arguments=("diagnose", self.path("nowhere.toml"), "-o", self.path("out")))
        self.assertFalse(os.path.exists(self.path("out")))

    def test_the_start_is_not_replaced_by_the_results(self):
        for command, record in (("diagnose", "diagnosis.json"), ("calibrate", "calibration.json")):
            os.makedirs(self.path(command))
            start = self.write(command + "/fitted.toml", '[ground]\ndefault = "upper-talus-3d"\n')
            self.write(f"{command}/{record}", "{}")
            self.fails(2, command + "/fitted.toml", arguments=(
                command, f"{ELM}/campaign.toml", "--parameters", start, "-o", self.path(command), "--overwrite"))
            self.assertTrue(os.path.exists(start))

    def test_results_of_another_command_are_not_replaced(self):
        for record in ("diagnosis.json", "calibration.json", "run.json"):
            os.makedirs(self.path(record[:-5]))
            self.write(f"{record[:-5]}/{record}", "{}")
        for command, others in (("diagnose", {"calibration": "calibrate", "run": "run"}), ("calibrate", {"diagnosis": "diagnose", "run": "run"})):
            for folder, other in others.items():
                self.fails(2, f"holds results of talus {other}, and --overwrite replaces only those of talus {command};",
                           arguments=(command, f"{ELM}/campaign.toml", "-o", self.path(folder), "--overwrite"))

    def test_a_start_at_zero_is_refused(self):  # it was fitted from 0.01
        self.write("start.toml", '[ground.zones.default]\npreset = "upper-talus-3d"\npsi_scale = 0\n')
        self.fails(2, "psi_scale", arguments=("diagnose", f"{ELM}/campaign.toml", "--parameters",
                                              self.path("start.toml"), "-o", self.path("out")))

    def test_a_start_with_effects_is_refused(self):
        """`diagnose` would look for an effect that the ground has already."""
        self.write("start.toml", '[ground]\ndefault = "upper-talus-3d"\n[effects.air-drag]\ncoefficient = 0.8\n')
        self.fails(2, "start.toml", "must be ground alone", arguments=(
            "diagnose", f"{ELM}/campaign.toml", "--parameters", self.path("start.toml"), "-o", self.path("out")))
        self.assertFalse(os.path.exists(self.path("out")))


class Loop(Case):
    def diagnose(self, campaign, *options, untested=frozenset(), rounds=9):
        """Runs the whole loop. `untested`: effects that these data cannot test; `rounds`: the most that are asked for."""
        out = self.path("out")
        self.run_well("diagnose", campaign, "-o", out, "-q", *options, timeout=1200)
        found = self.read_json(f"{out}/diagnosis.json")
        self.assertEqual({"diagnosis.json", "report.html", "fitted.toml", "with_effect.toml"}, set(os.listdir(out)))
        self.assertIn(found["effect"], NAMES)
        self.assertEqual(NAMES - {"none", "unexplained"} - {c["effect"] for c in found["candidates"]}, untested)
        limits = [limit["effect"] for limit in found["detection_limits"]]  # of each effect that is not in the last model
        self.assertEqual(sorted(limits + [e for e in found["effects"] if e not in ("none", "unexplained")]),
                         sorted(NAMES - {"none", "unexplained"}))
        self.assertEqual({l["amount"] for l in found["detection_limits"] if l["effect"] in untested} - {None}, set())
        for rows in ("fit", "holdout"):
            self.assertTrue(0.1 < found["error"][rows]["after"] < 2.0)  # a number; 24 blocks and few trials fit badly
        e = found["error"]["holdout"]
        self.assertAlmostEqual(e["reduction"], 1 - e["after"] / e["before"], places=4)
        self.assertTrue(e["ci95"][0] <= e["reduction"] <= e["ci95"][1])
        self.assertTrue(0 <= found["probability"] <= 1)
        if found["effect"] == "none":
            self.assertEqual(found["probability"], found["rounds"][0]["p_value"])
            self.assertEqual((e["reduction"], found["where"], found["indistinguishable_from"]), (0, "", []))
        self.assertTrue(found["rounds"][-1]["effect"] in ("none", "unexplained") or len(found["rounds"]) == rounds)
        for round in found["rounds"][1:]:  # the values of the first round are at the top
            self.assertNotIn(found["effect"], {c["effect"] for c in round["candidates"]})
        page = self.read_text(f"{out}/report.html")
        for when in found["coverage"].values():
            for rows in ("fit", "holdout"):
                self.assertEqual(when[rows][0]["observable"], "runout")
                self.assertTrue(all(0 <= c[p] <= 1 for c in when[rows] for p in ("P5", "P50", "P95")))
        self.assertEqual(len([m for m in found["evidence"] if not m.get("candidate")]), 3)
        self.assertEqual([m["model"] for m in found["evidence"][3:]], [c["effect"] for c in found["candidates"]])
        climatology = found["evidence"][0]
        self.assertEqual(climatology["model"], "climatology")
        self.assertEqual([g["rows"] for g in climatology["holdout"]["groups"]],
                         [g["rows"] for g in found["evidence"][2]["holdout"]["groups"]])
        self.assertIn("<svg", page)
        self.assertIn("Calibration of the spread", page)
        self.assertNotRegex(page, "https?:")  # self-contained
        # `score` reads the model that was found.
        self.run_well("score", campaign, "--parameters", f"{out}/with_effect.toml", "-q")
        left = {}
        for name, model in (("fitted", 1), ("with_effect", 2)):  # over the better of two climatologies, of which this is one
            with open(f"{out}/{name}.toml", "rb") as file:
                skill, low, high = tomllib.load(file)["fitted_skill"]
            over_one = 1 - found["evidence"][model]["holdout"]["error"] / climatology["holdout"]["error"]
            self.assertTrue(low <= skill <= high and skill <= over_one + 1e-3, (name, skill, over_one))
            left[model] = 1 - skill
        errors = [found["evidence"][model]["holdout"]["error"] for model in (1, 2)]
        self.assertAlmostEqual(left[1] / left[2], errors[0] / errors[1], delta=1e-3)  # over the same climatology
        return found


class Diagnosis(Loop, luck_test.Luck):
    """The campaign of luck_test.py, on the second of whose days the ground was wet."""
    truth = luck_test.Luck.truth + "[effects.wet-ground]\nsoftening = 1\ndrag = 1\ndays = [2]\n"
    test_score = test_calibrate = test_diagnose = None

    def test_days_that_differ(self):
        self.tables(self.path("."), self.blocks, self.stops, self.passages, [])
        found = self.diagnose(self.path("campaign.toml"), *FEW, "--surface", "bilinear", "--fit", "theta_scale,En50", "--most-effects", "1",
                              untested={"block-shape"}, rounds=1)  # spheres
        self.assertEqual((found["effect"], found["where"]), ("wet-ground", "day 2"))
        self.assertLess(found["error"]["holdout"]["after"], found["error"]["holdout"]["before"])


@unittest.skipUnless(os.path.isdir(CAMPAIGNS), "no campaigns at TALUS_DATA")
class OfOthers(Loop):
    def test_measured_blocks_of_a_quarry(self):
        """Releases of one day, and only end points measured: neither days nor instruments can be tested."""
        start = self.write("start.toml", '[ground.zones.default]\npreset = "upper-talus-3d"\npsi_scale = 0.85\n')
        found = self.diagnose(f"{CAMPAIGNS}/authume/campaign.toml", "--trials", "10", "--test-trials", "10", *ONCE, "--fit", "En50",
                              "--parameters", start, untested={"wet-ground", "instrument-bias"})
        self.assertEqual(found["trials_per_block"], {"search": 30, "test": 30, "compare": 600})  # 24 fitting blocks: a third of 72
        self.assertGreater(len(found["residual"]), 3)
        self.assertEqual([i["path"] for i in found["inputs"] if i["role"] == "model"], [start])
        self.assertEqual(found["start_model"], start)  # what is not fitted stays as the start has it
        self.assertIn("psi_scale = 0.85\n", self.read_text(self.path("out/fitted.toml")))


if __name__ == "__main__":
    unittest.main()
