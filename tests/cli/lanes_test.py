"""Trajectories in the lanes of one instruction: the same bytes for any number of lanes."""
import json
import re

from results_test import digests
from support import Case


class Lanes(Case):
    def setUp(self):
        super().setUp()
        self.most = self.lanes_of_machine()

    def lanes_of_machine(self):
        found = re.search(r"^flags\s*:(.*)$", self.read_text("/proc/cpuinfo"), re.M)
        flags = set(found.group(1).split()) if found else set()
        if {"avx512f", "avx512dq", "avx512vl"} <= flags:
            return 8
        return 4 if "avx2" in flags else 1

    def there(self):
        lanes = [n for n in (1, 4, 8) if n <= self.most]
        if len(lanes) < 3:
            print(f"lanes_test: this processor has {self.most} lanes; the others are not tested")
        return [str(n) for n in lanes]

    def test_the_same_bytes_for_any_number_of_lanes(self):
        self.run_well(*self.arguments("one"), "--lanes", "1", "--threads", "1")
        first = digests(self.path("one"))
        self.assertEqual(self.record("one")["lanes"], 1)
        for lanes in self.there():
            for threads in ("1", "2", "7"):
                out = f"{lanes}-{threads}"
                self.run_well(*self.arguments(out), "--lanes", lanes, "--threads", threads)
                self.assertEqual(digests(self.path(out)), first, out)
                self.assertEqual(self.record(out)["lanes"], int(lanes))

    def test_as_many_as_the_processor_has(self):
        self.run_well(*self.arguments())
        self.assertEqual(self.record()["lanes"], self.most)

    def test_parts_with_different_lanes(self):
        self.run_well(*self.arguments("whole"), "--lanes", "1")
        for i, lanes in enumerate((self.there() * 3)[:3], 1):
            self.run_well(*self.arguments(f"part{i}"), "--part", f"{i}/3", "--lanes", lanes)
        self.run_well("merge", self.path("joined"), *(self.path(f"part{i}") for i in (1, 2, 3)))
        self.assertEqual(digests(self.path("joined")), digests(self.path("whole")))

    def test_no_others(self):
        for value in ("0", "2", "16", "-1", "eight", "8.0"):
            self.fails(2, "--lanes", value, "must be 1, 4 or 8", arguments=[*self.arguments(), f"--lanes={value}"])
        if self.most < 8:
            self.fails(2, "--lanes", f"this processor has {self.most} lane", "leave it out",
                       arguments=[*self.arguments(), "--lanes", "8"])

    def test_the_help_lists_the_choices(self):
        program = json.loads(self.run_well("help", "--json").stdout)
        run = next(command for command in program["commands"] if command["name"] == "run")
        lanes = next(p for p in run["parameters"] if p["name"] == "lanes")
        self.assertEqual((lanes["type"], lanes["choices"]), ("choice", ["1", "4", "8"]))
