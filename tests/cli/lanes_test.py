"""Trajectories in the lanes of one instruction: the same bytes for any number of lanes."""
import json
import re
import subprocess

from results_test import digests
from support import OPEN_RUN, TALUS, Case, RunCase


def lanes_of_machine():
    with open("/proc/cpuinfo", encoding="utf-8") as cpuinfo:
        found = re.search(r"^flags\s*:(.*)$", cpuinfo.read(), re.M)
    flags = set(found.group(1).split()) if found else set()
    if {"avx512f", "avx512dq", "avx512vl"} <= flags:
        return 8
    return 4 if "avx2" in flags else 1


class Lanes(Case):
    most = lanes_of_machine()

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


class EveryKindOfRun(RunCase):
    """Frequencies, screens, paths and bounds: one lane against as many as there are, however the run is made."""
    lanes = lanes_of_machine()

    def setUp(self):
        super().setUp()
        self.write("s.toml", OPEN_RUN)

    def in_lanes(self, out, *more):
        """A run in lanes that has the bytes of the run `one`."""
        self.run_scenario(out, *more)
        self.assertEqual(self.record(out)["lanes"], self.lanes)
        self.assert_same("one", out)

    def test_threads_memory_and_layers(self):
        self.run_scenario("one", "--lanes", "1", "--threads", "1")
        self.assertEqual(self.record("one")["lanes"], 1)
        self.in_lanes("threads", "--threads", "2")
        self.in_lanes("memory", "--memory", "200M")
        self.run_scenario("one", "--lanes", "1", "--vectors", "fgb", "--overwrite")
        self.in_lanes("layers", "--vectors", "fgb")

    def test_rounds(self):
        self.run_scenario("one", "--lanes", "1", "--rounds", "2")
        self.in_lanes("rounds", "--rounds", "2")

    def test_killed_and_resumed(self):
        many = ("--trajectories", "2000")
        self.run_scenario("one", "--lanes", "1", *many)
        process = subprocess.Popen([TALUS, "run", self.path("s.toml"), "-o", self.path("out"), "--threads", "1", "--checkpoint", "0",
                                    "--progress=machine", *many], stderr=subprocess.PIPE, text=True)
        self.wait_for_progress(process, 20)
        process.kill()
        process.communicate()
        self.assertEqual(len(self.unfinished("out")), 1)
        self.in_lanes("out", "--resume", *many)
