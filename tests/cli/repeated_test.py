"""`talus diagnose` with several base fits and with every block out of its fold: a small campaign, few trials.
Quick folds: Nested.QuickFoldsRefitTheNumbersToTheOtherRows."""
import unittest

import luck_test

FAST = ("--trials", "10", "--test-trials", "10", "--fit", "En50", "--most-effects", "1", "-q")


class Repeated(luck_test.Luck):
    """The campaign of luck_test.py with fewer blocks."""
    count = 24
    test_score = test_calibrate = test_diagnose = None

    def diagnosis(self, campaign, out, *options):
        self.run_well("diagnose", campaign, "-o", self.path(out), *FAST, *options, timeout=1800)
        record = self.read_json(out + "/diagnosis.json")
        for key in ("command", "inputs", "seconds", "cpu_seconds", "times"):
            record.pop(key, None)
        return record

    def test_out_of_fold(self):
        found = self.diagnosis(self.path("campaign.toml"), "first", "--all-rows", "--folds", "2", "--base-fits", "2")
        self.stability(found, 2)
        nested = found["nested"]
        self.assertEqual((nested["folds_by"], len(nested["folds"])), ("block", 2))
        self.assertEqual([f["blocks"] for f in nested["folds"]], [12, 12])
        self.assertTrue(all(f["effects"] and f["p_value"] is not None for f in nested["folds"]))
        e = found["error"]["holdout"]
        self.assertEqual((e["rows"], e["before"], e["after"]), ("out-of-fold", nested["before"], nested["after"]))
        self.assertAlmostEqual(e["reduction"], 1 - e["after"] / e["before"], places=4)
        self.evidence(found, "out-of-fold", self.count)

    def stability(self, found, fits):
        s = found["stability"]
        self.assertEqual((s["fits"], len(s["verdicts"]), len(set(s["seeds"]))), (fits, fits, fits))
        self.assertEqual(s["p_range"], [min(s["p_values"]), max(s["p_values"])])
        self.assertEqual(s["seeds"][0], found["seed"])
        self.assertEqual(bool(s["undecided_between"]), len(set(s["verdicts"])) > 1)
        self.assertEqual(found["verdict"].startswith("undecided between "), bool(s["undecided_between"]))

    def evidence(self, found, rows, blocks):
        models = {m["model"]: m[rows] for m in found["evidence"] if not m.get("candidate")}
        self.assertEqual(set(models), {"climatology", "ground", "found"})
        self.assertEqual((models["ground"]["reduction"], models["ground"]["nats_gained"]), (0, 0))
        for m in models.values():
            self.assertEqual(m["groups"][0]["group"], "stop")
            self.assertAlmostEqual(m["reduction"], 1 - m["error"] / models["ground"]["error"], places=4)
            digits = 1e-5 * max(abs(m["log_score"]), abs(models["ground"]["log_score"]))  # numbers have six of them
            self.assertAlmostEqual(m["nats_gained"], m["log_score"] - models["ground"]["log_score"], delta=digits)
            self.assertAlmostEqual(m["log_score"], sum(g["log_score"] * g["rows"] for g in m["groups"]) / blocks, places=4)
        candidates = [m for m in found["evidence"] if m.get("candidate")]
        self.assertEqual([m["model"] for m in candidates], [c["effect"] for c in found["candidates"]])
        refined = {c["effect"] for c in found["candidates"] if c["refined"]}
        self.assertEqual({m["model"] for m in candidates if rows in m}, refined)
        for m in (m for m in candidates if rows in m):
            low, high = m[rows]["nats_gained_ci95"]
            self.assertTrue(low <= m[rows]["nats_gained"] <= high)

    def test_wrong_choices(self):
        campaign, out = self.path("campaign.toml"), self.path("out")
        self.fails(2, "--nested and --no-nested", arguments=("diagnose", campaign, "-o", out, "--nested", "--no-nested"))
        self.fails(2, "--quick-folds and --no-quick-folds",
                   arguments=("diagnose", campaign, "-o", out, "--quick-folds", "--no-quick-folds"))
        self.tables(self.path("out-held"), [[*b[:6], "1"] for b in self.blocks], *self.own()[1:])
        held, few = self.path("out-held/campaign.toml"), ("--folds", "13")  # a refusal of all 24 rows comes soon
        self.fails(2, "cross-validation in 13 folds needs at least 26 fitting rows, not 24", "--no-nested", arguments=("diagnose", held, "-o", out, "--all-rows", *few))
        self.fails(2, "nothing to fit to", arguments=("diagnose", held, "-o", out, *few))
        self.fails(2, "needs at least 26", arguments=("diagnose", campaign, "-o", out, "--nested", "--folds", "13"))


if __name__ == "__main__":
    unittest.main()
