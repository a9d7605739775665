"""`talus score` and `talus calibrate` as a user calls them; the score against an independent implementation."""
import csv
import importlib.util
import json
import math
import os
import unittest

from support import NORTH, WEST, Case

CAMPAIGNS = os.path.join(os.environ.get("TALUS_DATA", ""), "campaigns")
PRESET = '[ground]\ndefault = "forest-road-3d"\n'


def reference():
    """score.py, written by others from the same definition; nothing where it is not there."""
    path = os.path.join(CAMPAIGNS, "score.py")
    if not os.path.exists(path):
        return None
    spec = importlib.util.spec_from_file_location("score", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def table(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(file))


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
        stops = [dict(block=r["block"], trial=r["trial"], x=r["x"], y=r["y"], stopped=str(int(r["end"] == "stopped")),
                      caught=str(int(r["end"] == "caught")), mass_stop=float(r["mass_share"]) * mass[r["block"]])
                 for r in table(self.path(name) + "/stops.csv")]
        passages = [dict(block=r["block"], trial=r["trial"], screen=r["screen"], speed=r["speed_ms"],
                         jump=r["jump_height_m"], omega=r["angular_velocity_rads"])
                    for r in table(self.path(name) + "/passages.csv")]
        simulated = module.simulated(measured, stops, passages, 1)
        fit = measured["fit"]
        for rows, ask in (("fit", fit), ("holdout", set(measured["blocks"]) - fit)):
            _, groups, counts = module.error(measured, simulated, ask)
            ours = {g["group"]: g for g in result[rows]["groups"] if not g["group"].startswith("sample")}
            self.assertEqual(set(ours), set(groups))
            self.assertGreaterEqual(len(groups), 1)
            for group, score in groups.items():
                self.assertAlmostEqual(ours[group]["score"], score, delta=1e-6, msg=f"{name} {rows} {group}")
                self.assertEqual(ours[group]["rows"], counts[group])

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
