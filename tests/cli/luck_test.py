"""Random numbers go by the ids of the blocks: the order of rows, held-out rows and threads change no figure of a fit."""
import json
import os
import random
import unittest

from support import NORTH, WEST, Case

FAST = ("-q", "--surface", "bilinear")
TOP = 160  # m from the northern edge of the DEM to the releases, 40 m above the foot: short paths, soon traced


class Luck(Case):
    """Blocks down the slope of support.py, measured by the program itself; every third is held out."""
    count = 36
    truth = "[ground.zones.default]\ntheta_scale = 0.3\nEn50 = 4\n"

    def setUp(self):
        super().setUp()
        self.blocks = [[f"b{i}", str(WEST + 40 + 5 * i), str(NORTH - TOP), "1", str(400 + 20 * i), str(1 + i % 2), str(int(i % 3 == 2))]
                       for i in range(self.count)]
        self.screens = [[f"S{k}", f"LINESTRING ({WEST + 3} {NORTH - y}, {WEST + 297} {NORTH - y})"] for k, y in ((1, TOP + 20), (2, TOP + 30))]
        self.tables(self.path("."), self.blocks, [], [], [])
        self.write("truth.toml", self.truth)
        self.run_well("score", self.path("campaign.toml"), "--parameters", self.path("truth.toml"), "--trials", "10",
                      "--seed", "99", "--surface", "bilinear", "--dump", self.path("dump"))
        first = [r for r in self.read_table("dump/stops.csv") if r["trial"] == "0" and r["x"]]
        self.stops = [[r["block"], r["x"], r["y"]] for r in first]
        self.passages = [[r["block"], r["screen"], r["speed_ms"], r["jump_height_m"]] for r in self.read_table("dump/passages.csv")
                         if r["trial"] == "0"]
        place = {b[0]: (float(b[1]), float(b[2])) for b in self.blocks}
        self.samples = [[b, repr(place[b][0]), repr(place[b][1] - r), repr(0.2 * r + int(b[1:]) % 5)] for b in place for r in (10, 20)]
        self.tables(self.path("."), *self.own())

    def tables(self, folder, blocks, stops, passages, samples):
        os.makedirs(folder, exist_ok=True)
        for name, head, table in (("blocks", "id,x,y,release_height_m,mass_kg,day,holdout", blocks), ("stops", "id,x,y", stops),
                                  ("passages", "id,screen,speed_ms,jump_height_m", passages), ("samples", "id,x,y,speed_ms", samples),
                                  ("screens", "id,wkt", self.screens)):
            self.write_table(f"{folder}/{name}.csv", head, table)
        names = "".join(f'{name} = "{name}.csv"\n' for name in ("blocks", "stops", "passages", "samples", "screens"))
        with open(f"{folder}/campaign.toml", "w", encoding="utf-8") as file:
            file.write(f'name = "own"\ndem = "{self.path("dem.tif")}"\n{names}[measurement_error]\nposition_m = 0.3\n'
                       "speed_fraction = 0.03\njump_height_m = 0.1\nangular_velocity_fraction = 0.05\n")

    def shuffled(self, tables):
        """A campaign with the rows of every table in another order."""
        mixed = random.Random(4)
        self.screens.reverse()
        self.tables(self.path("shuffled"), *[mixed.sample(t, len(t)) for t in tables])
        self.screens.reverse()
        return self.path("shuffled/campaign.toml")

    def own(self):
        return self.blocks, self.stops, self.passages, self.samples

    def other_holdout(self):
        """The fitting rows as before; half of the held-out blocks are gone, and others stand before, between and after."""
        gone = {b[0] for b in self.blocks if b[6] == "1" and int(b[0][1:]) % 2 == 0}
        keep = [[r for r in t if r[0] not in gone] for t in self.own()]
        for k, name in enumerate(("a0", "b05", "b0x", "b3x", "z9", "z91", "z92")):
            x, y = WEST + 90 + 10 * k, NORTH - TOP
            keep[0].insert(5 * k, [name, str(x), str(y), "3", str(9000 + k), "7", "1"])
            keep[1].insert(k, [name, str(x - 20), str(y - 50 - 5 * k)])
            keep[2].append([name, "S2", str(25 + k), "4"])
            keep[3].insert(0, [name, str(x), str(y - 15), str(22 + k)])
        return keep

    def with_other_holdout(self):
        self.tables(self.path("other"), *self.other_holdout())
        return self.path("other/campaign.toml")

    def scored(self, campaign, *options):
        done = self.run_well("score", campaign, "--parameters", self.path("truth.toml"), "--trials", "40", "--json", *options)
        return json.loads(done.stdout)

    def test_score(self):
        first = self.scored(self.path("campaign.toml"), "--threads", "1")
        self.assertEqual(self.scored(self.shuffled(self.own()), "--threads", "2"), first)
        other = self.scored(self.with_other_holdout())
        self.assertEqual(other["fit"], first["fit"])
        self.assertNotEqual(other["holdout"], first["holdout"])

    def record(self, command, campaign, name, *options):
        out = self.path(name)
        self.run_well(command, campaign, "-o", out, *FAST, *options, timeout=1200)
        record = self.read_json(f"{out}/{'calibration' if command == 'calibrate' else 'diagnosis'}.json")
        for key in ("command", "inputs", "seconds", "times"):  # paths and time
            record.pop(key, None)
        return record

    def without_holdout(self, record):
        """What hangs on the fitting rows alone."""
        for key in ("distributions", "warnings", "indistinguishable_from"):
            record.pop(key, None)
        for part in (record["error"], record["tail"], *(site["error"] for site in record.get("sites", []))):
            part.pop("holdout", None)
            part.pop("headline", None)
        for when in record["coverage"].values():
            when.pop("holdout")
        for entry in record.get("evidence", []):
            entry.pop("holdout")
        for round in [record, *record.get("rounds", [])]:
            if isinstance(round.get("holdout"), dict):
                round.pop("holdout")
            for candidate in round.get("candidates", []):
                candidate.pop("holdout")
                candidate.pop("holdout_reduction_ci95")
        return record

    def test_calibrate(self):
        options = ("--fit", "En50,theta_scale", "--starts", "1", "--trials", "20")
        first = self.record("calibrate", self.path("campaign.toml"), "first", *options, "--threads", "1")
        self.assertEqual(self.record("calibrate", self.shuffled(self.own()), "shuffled-out", *options, "--threads", "2"), first)
        other = self.record("calibrate", self.with_other_holdout(), "other-out", *options)
        self.assertNotEqual(other["error"]["holdout"], first["error"]["holdout"])
        self.assertEqual(self.without_holdout(other), self.without_holdout(first))

    def test_diagnose(self):
        """One round with few trials: the verdict, every candidate and every fitted number."""
        options = ("--fit", "En50", "--trials", "10", "--test-trials", "10", "--most-effects", "1", "--base-fits", "1")
        first = self.record("diagnose", self.path("campaign.toml"), "first", *options, "--threads", "1")
        self.assertGreater(len(first["candidates"]), 8)
        other = self.record("diagnose", self.shuffled(self.other_holdout()), "other-out", *options, "--threads", "2")
        self.assertEqual(self.without_holdout(other), self.without_holdout(first))


if __name__ == "__main__":
    unittest.main()
