"""Parts and merge, rounds, interruption and resume: however the work is divided, the bits are those of one run."""
import contextlib
import hashlib
import json
import os
import random
import re
import shutil
import signal
import subprocess
import time
import unittest

import numpy as np
from osgeo import gdal, ogr

from support import NORTH, RUN, TALUS, WEST, KeptRuns, RunCase, bands_of, box, system, write_features


class Parts(KeptRuns, RunCase):
    def test_three_parts_and_three_rounds(self):
        self.run_scenario("whole", "--rounds", "3", "--threads", "2")
        for i in (3, 1, 2):
            self.run_scenario(f"part{i}", "--rounds", "3", "--part", f"{i}/3", "--threads", "1")
        self.run_well("merge", self.path("merged"), *(self.path(f"part{i}") for i in (2, 3, 1)), "-q")
        self.assert_same("whole", "merged")
        self.assertEqual(self.record("merged")["parts"], 3)
        self.assertEqual(self.record("merged")["rounds"], self.record("whole")["rounds"])
        self.assertEqual(self.record("whole")["rounds"]["done"], 3)
        self.assertIn("trajectories = 120\n", self.read_text("whole/scenario.toml"))
        # The same blocks in one round: the same counts, a source cell counted once, in another order of the rows.
        self.run_scenario("one", "--trajectories", "120")
        for name in ("impact_probability", "reach_probability", "energy", "jump_height", "sources", "deposits"):
            self.assertEqual(self.hashes("whole")[name + ".tif"], self.hashes("one")[name + ".tif"], name)
        self.run_well("hazard", self.path("merged"), "-q")  # evaluates what the rounds saved

    def test_parts_are_numbered_in_digits(self):
        scenario = self.write("s.toml", RUN)
        for part in ("1/-1", "+1/2", "2/ 3", "0/2", "3/2", "1", "1/2/3", "/"):
            self.fails(2, f"--part '{part}'", arguments=["run", scenario, "-o", self.path("out"), f"--part={part}"])

    def test_warnings_about_the_ground_are_those_of_the_run(self):
        """The complete scenario of a run has every number of a zone beside its preset: it is still the ground of the preset."""
        write_features(self.path("zones.gpkg"), "zones",
                       [(box(0, 200, 300, 60), ["rock"]), (box(0, 100, 300, 60), ["road"]), (box(0, 20, 300, 60), ["own"])],
                       [("zone", ogr.OFTString)])
        self.write("s.toml", RUN.replace("[0.6, 1.2]", "3") + '[ground]\nfile = "zones.gpkg"\ndefault = "rockyfor3d-4"\n'
                   '[ground.zones.rock]\npreset = "rockyfor3d-5"\n'
                   '[ground.zones.road]\npreset = "forest-road-3d"\ntheta_scale = 0.5\n'
                   '[ground.zones.own]\npreset = "lower-talus-3d"\ntheta_scale = 0.7\nEn50 = 9\n')
        self.run_scenario("whole")
        self.run_well("run", self.path("whole/scenario.toml"), "-o", self.path("again"), "-q")
        for i in (1, 2):
            self.run_scenario(f"part{i}", "--part", f"{i}/2")
        self.run_well("merge", self.path("merged"), self.path("part1"), self.path("part2"), "-q")
        told = [w for w in self.record("whole")["warnings"] if w.startswith(("block sizes: ", "first guess: "))]
        self.assertEqual(len(told), 2, told)
        self.assertIn("forest-road-3d (1 to 1.4 m); larger blocks: run-out and speed too low (unsafe)", told[0])
        self.assertNotIn("lower-talus-3d", told[0])  # both numbers are the user's own
        self.assertIn("ground rockyfor3d-4, rockyfor3d-5 is", told[1])
        for out in ("again", "merged"):
            self.assertEqual(self.record(out)["warnings"], self.record("whole")["warnings"], out)

    def test_a_merged_run_says_what_one_run_says(self):
        """An included fit for other cells and another surface, and a flag that changes nothing: the complete scenario of a
        part knows of neither. A run that is resumed says it, too."""
        fitted = 'surface = "bilinear"\nfitted_cell = 0.5\n[ground.zones.default]\nEn50 = 9\n'
        self.write("fitted.toml", fitted)
        self.write("s.toml", 'include = "fitted.toml"\nsurface = "creased"\n' + RUN.replace("[0.6, 1.2]", "3") +
                   "[ground.zones.default]\ntheta_scale = 1\npsi_scale = 0.9\nEn50 = 8\nEt50 = 50\nphi = 35\nshape = [0.9, 1.1]\n")
        flags = ("--preset", "upper-talus-3d")
        many = (*flags, "--trajectories", "400")
        self.run_scenario("whole", *many)
        for i in (1, 2):
            self.run_scenario(f"part{i}", "--part", f"{i}/2", *many)
        merge = self.run_well("merge", self.path("merged"), self.path("part2"), self.path("part1"))
        process = self.start("resumed", *flags, "--threads", "1", "--progress=machine")
        self.wait_for_progress(process, 5)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=20)
        self.assertEqual(process.returncode, 130)
        self.run_scenario("resumed", *many, "--resume")
        whole = self.record("whole")
        for words in ("was fitted on cells of 0.5 m, and this run is on cells of 5 m", "was fitted on a bilinear surface",
                      "flag --preset = 'upper-talus-3d' changes nothing"):
            self.assertEqual(sum(words in warning for warning in whole["warnings"]), 1, words)
            self.assertIn(words, merge.stderr)
        self.assertIn({"role": "include", "path": self.path("fitted.toml"), "sha256": hashlib.sha256(fitted.encode()).hexdigest()},
                      whole["inputs"])
        for out in ("merged", "resumed"):
            for key in ("warnings", "notes", "inputs", "settings"):
                self.assertEqual(self.record(out)[key], whole[key], (out, key))

    def test_a_merged_run_names_the_files_that_merge_has_read(self):
        """The machine of the first part had its input in another folder, which is not there."""
        self.keep_scenario("whole")
        self.run_scenario("part2", "--part", "2/2")
        os.mkdir(self.path("far"))
        for name in ("s.toml", "dem.tif", "sources.gpkg", "screens.gpkg", "nets.gpkg"):
            shutil.copy(self.path(name), self.path("far"))
        self.run_well("run", self.path("far/s.toml"), "-o", self.path("part1"), "-q", "--part", "1/2")
        shutil.rmtree(self.path("far"))
        self.run_well("merge", self.path("merged"), self.path("part2"), self.path("part1"), "-q")
        inputs = {one["role"]: one for one in self.record("merged")["inputs"]}
        self.assertEqual(inputs.pop("scenario")["path"], self.path("far/s.toml"))
        self.assertEqual(inputs, {one["role"]: one for one in self.record("whole")["inputs"] if one["role"] != "scenario"})
        self.assert_same("whole", "merged")

    @staticmethod
    @contextlib.contextmanager
    def manifest(folder):
        """part.json, to be changed: gets the right checksum."""
        with open(f"{folder}/part.json", encoding="utf-8") as file:
            content = json.load(file)
        yield content
        del content["sha256"]
        text = json.dumps(content, indent=2, ensure_ascii=False) + "\n"
        content["sha256"] = hashlib.sha256(text.encode()).hexdigest()
        with open(f"{folder}/part.json", "w", encoding="utf-8") as file:
            file.write(json.dumps(content, indent=2, ensure_ascii=False) + "\n")

    def test_inputs_that_are_on_other_machines(self):
        """The parts have inputs of their own: those of one must be here, in any order; then none, and their new place is told."""
        for i in "12":
            os.makedirs(self.path(f"m{i}"))
            for name in ("dem.tif", "sources.gpkg", "screens.gpkg", "nets.gpkg", "s.toml"):
                shutil.copy(self.path(name), self.path(f"m{i}/{name}"))
            self.run_well("run", self.path(f"m{i}/s.toml"), "-o", self.path(f"p{i}"), "--part", f"{i}/2", "-q")
        self.run_well("merge", self.path("both"), self.path("p1"), self.path("p2"), "-q")
        os.rename(self.path("m2"), self.path("elsewhere"))
        self.run_well("merge", self.path("one"), self.path("p2"), self.path("p1"), "-q")
        self.assert_same("both", "one", without=("talus.qgs",))
        os.rename(self.path("m1"), self.path("moved"))
        self.fails(2, "p2/scenario.toml", "if the inputs have moved, correct their paths in this file",
                   arguments=("merge", self.path("none"), self.path("p1"), self.path("p2")))
        trace = ("trace", self.path("one/scenario.toml"), "--source", "1", "--block", "1")
        self.fails(2, "correct their paths", arguments=trace)
        text = self.read_text("one/scenario.toml")
        self.write("one/scenario.toml", text.replace(self.path("m1"), self.path("moved")))
        self.run_well(*trace)

    def test_what_cannot_be_merged(self):
        for i in (1, 2):
            self.keep_scenario(f"part{i}", "--part", f"{i}/2")
        one, two = self.path("part1"), self.path("part2")
        done = self.run_well("run", self.path("s.toml"), "-o", one, "--part", "1/2", "--resume")  # a task that was requeued
        self.assertIn("part 1/2 is done", done.stderr)
        self.fails(2, "another plan", "(seed 9 instead of ",
                   arguments=["run", self.path("s.toml"), "-o", one, "--part", "1/2", "--resume", "--seed", "9"])
        self.fails(2, "part1: what is kept there is part 1/2; give that with --part",
                   arguments=["run", self.path("s.toml"), "-o", one, "--part", "2/2", "--resume"])
        self.fails(2, "1 of 2 parts are given, part 2 is the first", arguments=["merge", self.path("m"), one])
        self.fails(2, "give each part once", arguments=["merge", self.path("m"), one, one])
        self.fails(2, "is no part of a run", arguments=["merge", self.path("m"), self.folder, one])
        for command in (["hazard", one], ["report", one], ["barrier", one, "--screen", "road"]):
            self.fails(2, "part1: is one part of a run", "join the parts first, with talus merge OUT PART...", arguments=command)
        empty = self.run_well("run", self.path("s.toml"), "-o", self.path("empty"), "--part", "1/99999")
        self.assertIn("is empty: the plan has", empty.stderr)
        self.run_scenario("other", "--part", "2/2", "--seed", "9")
        self.fails(2, "another plan", " instead of 9)", arguments=["merge", self.path("m"), one, self.path("other")])
        self.run_scenario("rounds", "--part", "2/2", "--rounds", "2")
        self.fails(2, "the same --rounds", arguments=["merge", self.path("m"), one, self.path("rounds")])
        with self.manifest(two) as manifest:  # as if it had been interrupted after the first of two
            manifest["rounds"]["count"] = 2
        self.fails(2, "was to have 2 rounds (--above 0.01), another part 1 round", "the same --rounds",
                   arguments=["merge", self.path("m"), one, two])
        with self.manifest(two) as manifest:
            manifest["rounds"]["count"] = 1
        self.fails(2, "--until-error with --part",
                   arguments=["run", self.path("s.toml"), "-o", self.path("x"), "--part", "1/2", "--until-error", "0.1"])
        for text in ("0/2", "3/2", "1", "1/2x"):
            self.fails(2, "must be I/N", arguments=["run", self.path("s.toml"), "-o", self.path("x"), "--part", text])
        name = next(n for n in sorted(os.listdir(two)) if n.startswith("tally"))
        with open(f"{two}/{name}", "r+b") as file:
            file.seek(1000)
            byte = file.read(1)
            file.seek(1000)
            file.write(bytes([byte[0] ^ 1]))
        self.fails(2, name, "is damaged", arguments=["merge", self.path("m"), one, two])
        with open(f"{one}/part.json") as file:
            manifest = file.read()
        self.write("part1/part.json", manifest.replace('"upper-talus-3d"', '"lower-talus-3d"').replace('"1"', '"3"'))
        self.fails(2, "part.json", "its checksum is another", arguments=["merge", self.path("m"), one, two])
        os.remove(f"{one}/scenario.toml")
        self.fails(2, "it has no scenario.toml", arguments=["merge", self.path("m"), one, two])
        self.assertFalse(os.path.exists(self.path("m")))

    def test_the_error_is_that_of_the_cells_that_were_asked_for(self):  # merge took those above 0.01
        rounds = ("--rounds", "2", "--above", "0.05")
        self.run_scenario("whole", *rounds)
        for i in (1, 2):
            self.run_scenario(f"part{i}", *rounds, "--part", f"{i}/2")
        self.run_well("merge", self.path("merged"), self.path("part1"), self.path("part2"), "-q")
        self.assertEqual(self.record("merged")["rounds"], self.record("whole")["rounds"])
        self.assertEqual(self.record("merged")["rounds"]["above_probability"], 0.05)
        self.assertGreater(self.record("merged")["rounds"]["cells"], 0)
        self.run_scenario("other", "--rounds", "2", "--part", "2/2")
        self.fails(2, "was to have 2 rounds (--above 0.01), another part 2 rounds (--above 0.05)", "the same --rounds and --above",
                   arguments=["merge", self.path("m"), self.path("part1"), self.path("other")])
        again = ["run", self.path("s.toml"), "-o", self.path("part1"), "--part", "1/2", "--resume", "--rounds", "2"]
        self.assertIn("part 1/2 is done", self.run_well(*again, "--above", "0.05").stderr)
        self.fails(2, "the folder is there and not empty", arguments=again)

    def test_pieces_keep_their_numbers(self):
        self.write("s.toml", RUN.replace("trajectories = 40", "trajectories = 10") +
                   "[effects.fragmentation]\nthreshold = 20\n")
        self.run_scenario("whole", "--rounds", "2")
        for i in (1, 2):
            self.run_scenario(f"part{i}", "--rounds", "2", "--part", f"{i}/2")
        self.run_well("merge", self.path("merged"), self.path("part2"), self.path("part1"), "-q")
        self.assert_same("whole", "merged")
        pieces = {int(row["piece"]) for row in self.read_table("merged/screens.csv")}
        self.assertLess({0, 1, 2}, pieces)
        self.assertLessEqual(pieces, set(range(17)))  # a block gives 16 at most

    def test_rows_of_an_earlier_format_are_not_read(self):
        self.run_scenario("part1", "--part", "1/1")
        manifest = self.read_text("part1/part.json")
        number = int(re.search(r'"format": (\d+)', manifest)[1])
        earlier = re.sub(r',\n  "sha256": "[0-9a-f]{64}"\n}\n$', "\n}\n", manifest.replace(f'"format": {number}', f'"format": {number - 1}'))
        checksum = hashlib.sha256(earlier.encode()).hexdigest()  # of the text without its line
        self.write("part1/part.json", earlier[:-3] + f',\n  "sha256": "{checksum}"\n}}\n')
        self.fails(2, "part.json", f"in format {number - 1}, this one reads format {number}", "run this part again",
                   arguments=["merge", self.path("m"), self.path("part1")])

    def start(self, out, *more, trajectories="400"):
        return subprocess.Popen([TALUS, "run", self.path("s.toml"), "-o", self.path(out), "-q", "--trajectories",
                                 trajectories, *more], stderr=subprocess.PIPE, text=True)

    def test_killed_ten_times(self):
        """Five times after a random time, the start and the end of a run included, and five times at a random share of the work."""
        self.write("s.toml", RUN.replace('trajectories = 40\n', 'trajectories = 200\n'))
        start = time.monotonic()
        self.run_scenario("whole")
        whole = time.monotonic() - start
        luck = random.Random(1)
        for attempt in range(10):
            out = f"killed{attempt}"
            process = self.start(out, "--checkpoint", "0", "--threads", "2", "--progress=machine", trajectories="200")
            if attempt % 2 == 0:
                time.sleep(luck.uniform(0.1, 1.0) * whole)
            else:
                self.wait_for_progress(process, luck.randint(5, 80))
            process.kill()
            process.communicate()
            if attempt % 2 == 1:  # there is something to resume
                self.assertTrue(any(os.path.exists(self.path(f"{n}/unfinished/part.json")) for n in self.unfinished(out)))
            self.run_scenario(out, "--resume", "--trajectories", "200", "--checkpoint", "0.05", "--threads", "1")
            self.assert_same("whole", out)
            self.assertEqual([n for n in self.unfinished(out) if os.path.exists(self.path(f"{n}/unfinished/part.json"))], [])

    def test_interrupted_and_gone_on_with(self):
        self.keep_scenario("whole", "--trajectories", "400")
        process = self.start("out", "--threads", "1", "--progress=machine")
        self.wait_for_progress(process, 5)
        process.send_signal(signal.SIGINT)
        error = process.communicate(timeout=20)[1]
        self.assertEqual(process.returncode, 130)
        self.assertIn("interrupted", error)
        self.assertIn("--resume", error)
        self.assertEqual(len(self.unfinished("out")), 1)
        arguments = ["run", self.path("s.toml"), "-o", self.path("out"), "-q", "--trajectories", "400"]
        self.fails(2, "--resume", "--overwrite", arguments=arguments)
        self.fails(2, "another plan", arguments=[*arguments, "--resume", "--seed", "2"])
        self.run_well(*arguments, "--resume")
        self.assert_same("whole", "out")
        self.assertEqual(self.unfinished("out"), [])

    def test_a_resumed_run_says_in_which_round_it_is(self):
        """From its first share on: a bar of several rounds is long."""
        process = self.start("out", "--rounds", "2", "--threads", "1", "--progress=machine")
        self.wait_for_progress(process, 5)
        process.send_signal(signal.SIGINT)
        self.assertIn("interrupted", process.communicate(timeout=20)[1])
        done = self.run_well("run", self.path("s.toml"), "-o", self.path("out"), "--trajectories", "400", "--rounds", "2", "--resume",
                             "--progress=json")
        lines = [json.loads(line) for line in done.stderr.splitlines() if line.startswith("{")]
        parts = [line.get("part") for line in lines if line.get("phase") == "simulate" and line["share"] > 0]
        self.assertEqual(parts[0], "round 1")
        self.assertEqual(set(parts), {"round 1", "round 2"})

    def test_the_command_that_goes_on_is_read_by_a_shell(self):
        odd = "a b'c$d"
        self.keep_scenario("whole", "--trajectories", "400")
        os.mkdir(self.path(odd))
        process = self.start(odd + "/out", "--threads", "1", "--progress=machine")
        self.wait_for_progress(process, 5)
        process.send_signal(signal.SIGINT)
        error = process.communicate(timeout=20)[1]
        self.assertEqual(process.returncode, 130, error)
        done = subprocess.run(["sh", "-c", error.split("resume with: ")[1]], capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_same("whole", odd + "/out")

    def test_killed_while_it_writes(self):
        """Finished maps are not written again, and the results are those of a run without interruption."""
        self.keep_scenario("whole", "--trajectories", "400")
        for attempt in range(5):
            process = self.start(out := f"out{attempt}", "--checkpoint", "0")
            finished = []
            while process.poll() is None and not finished:
                with contextlib.suppress(FileNotFoundError):  # the file has just been renamed
                    finished = [f"{self.path(n)}/{f}" for n in self.unfinished(out) for f in os.listdir(self.path(n))
                                if f.endswith(".tif") and f.count(".") == 1]
                time.sleep(0.001)
            process.kill()
            process.communicate()
            if self.unfinished(out):
                break
        self.assertTrue(finished, "no attempt was killed after its first map")
        written = os.stat(finished[0]).st_mtime_ns
        self.run_scenario(out, "--trajectories", "400", "--resume")
        self.assertEqual(os.stat(self.path(f"{out}/{os.path.basename(finished[0])}")).st_mtime_ns, written)
        self.assert_same("whole", out)

    def test_a_killed_part_in_rounds(self):
        """A part of a run in rounds, killed and resumed, then merged with the other part: the bits of one run."""
        self.write("s.toml", RUN.replace("trajectories = 40\n", "trajectories = 150\n"))
        self.run_scenario("whole", "--rounds", "3")
        self.run_scenario("part1", "--rounds", "3", "--part", "1/2")
        part2 = ["run", self.path("s.toml"), "-o", self.path("part2"), "--rounds", "3", "--part", "2/2"]
        process = subprocess.Popen([TALUS, *part2, "--checkpoint", "0", "--threads", "1", "--progress=machine"],
                                   stderr=subprocess.PIPE, text=True)
        self.wait_for_progress(process, 60)
        process.kill()
        process.communicate()
        self.assertEqual(len(self.unfinished("part2")), 1)
        single = [word for word in part2 if word not in ("--rounds", "3")]
        self.fails(2, "other --rounds", arguments=[*single, "-q", "--resume"])
        self.run_well(*part2, "-q", "--resume")
        self.run_well("merge", self.path("merged"), self.path("part1"), self.path("part2"), "-q")
        self.assert_same("whole", "merged")

    def test_merge_spares_what_it_reads(self):
        os.mkdir(self.path("result"))
        for i in (1, 2):
            self.run_scenario(f"result/part{i}", "--part", f"{i}/2")
        self.write("result/run.json", "{}")
        self.write("result/part1/mine.bin", "x")
        parts = [self.path(f"result/part{i}") for i in (1, 2)]
        self.fails(2, "others in this folder: part1/, part2/",
                   arguments=["merge", self.path("result"), *parts, "--overwrite"])
        self.run_well("merge", self.path("merged"), *parts, "-q")
        self.assertTrue(os.path.exists(self.path("result/part1/mine.bin")))

    def test_what_a_killed_merge_has_left(self):
        """The next merge of the name removes it; the saved work of a run, and what is not of the program, stay."""
        for i in (1, 2):
            self.keep_scenario(f"part{i}", "--part", f"{i}/2")
        arguments = ["merge", self.path("out"), self.path("part1"), self.path("part2"), "-q"]
        killed = subprocess.Popen([TALUS, *arguments])
        hidden = f".out.talus-{killed.pid}"
        while killed.poll() is None and not os.path.exists(self.path(f"{hidden}/unfinished/.lock")):
            time.sleep(0.001)
        killed.send_signal(signal.SIGSTOP)
        self.fails(2, "another process is writing it", hidden, arguments=arguments)
        killed.kill()
        killed.wait()
        self.assertEqual(self.unfinished("out"), [hidden])
        saved = self.path(".out.talus-run/unfinished/part.json")  # of an interrupted run of the name
        os.makedirs(os.path.dirname(saved))
        shutil.copy(self.path("part1/part.json"), saved)
        os.mkdir(self.path(".out.talus-mine"))
        self.run_well(*arguments)
        self.assertEqual(sorted(self.unfinished("out")), [".out.talus-mine", ".out.talus-run"])
        self.assertTrue(os.path.exists(saved))
        self.assertFalse([name for name in os.listdir(self.path("out")) if not os.path.isfile(self.path(f"out/{name}"))])

    def test_many_rounds_have_frequencies_of_one(self):
        """Nine rounds of few blocks: sums of weights that would not fit if one round took all the bits."""
        self.run_scenario("rounds", "--rounds", "9", "--trajectories", "10")
        self.run_scenario("one", "--trajectories", "90")
        for out in ("rounds", "one"):
            self.run_well("hazard", self.path(out), "-q")
        rounds, one = (bands_of(self.path(f"{out}/annual_frequency.tif"))[0] for out in ("rounds", "one"))
        np.testing.assert_allclose(rounds, one, rtol=1e-5)
        self.assertGreater(rounds.max(), 0.1)

    def test_a_limit_of_memory_changes_no_bit(self):
        self.keep_scenario("whole")
        self.run_scenario("limited", "--memory", "200M", "--threads", "1", "--checkpoint", "0.05")
        self.assert_same("whole", "limited")
        start = ["run", self.path("s.toml"), "-o", self.path("x"), "--threads", "1", "--memory"]
        for text in ("2", "2X", "G", "500MB", "500m", " 500M", "0x1p29M"):
            self.fails(2, "--memory", text, "with M or G", arguments=[*start, text])
        self.fails(2, "--memory", "1 thread:", "200M at least", arguments=[*start, "1M"])

    def test_a_terrain_that_is_larger_than_the_limit_of_memory(self):
        """400 MB of heights and 100 MB of zones, with a limit of 200 MB. The rasters are filled in pieces of 64 MB,
        between which the process is not measured. Without the limit it takes 530 MB, with the zones 630 MB."""
        side, small = 10000, bands_of(self.path("dem.tif"))
        dem = gdal.GetDriverByName("GTiff").Create(self.path("large.tif"), side, side, 1, gdal.GDT_Float32,
                                                   ["TILED=YES", "SPARSE_OK=TRUE", "COMPRESS=DEFLATE"])
        dem.SetGeoTransform((WEST, 5.0, 0.0, NORTH - 300.0 + 5.0 * side, 0.0, -5.0))
        dem.SetProjection(system(2056).ExportToWkt())
        dem.GetRasterBand(1).SetNoDataValue(-9999.0)
        dem.GetRasterBand(1).WriteArray(small, 0, side - small.shape[0])
        dem = None
        write_features(self.path("zones.gpkg"), "zones", [(box(0, 0, 200, 200), ["forest-road-3d"])], [("zone", ogr.OFTString)])
        for more in ([], ["--zones", self.path("zones.gpkg")]):
            process = subprocess.Popen([TALUS, "run", "--dem", self.path("large.tif"), "--sources", self.path("sources.gpkg"),
                                        "--diameter", "1", "--trajectories", "2", "--memory", "200M", "--threads", "1", "-q",
                                        "-o", self.path(f"out{len(more)}"), *more])
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            self.assertEqual(process.returncode, 0, more)
            self.assertLess(used.ru_maxrss * 1024, 200e6 + 64 * 2**20, more)

    def test_options_that_contradict_each_other(self):
        start = ["run", self.path("s.toml"), "-o", self.path("x")]
        self.fails(2, "--rounds", arguments=[*start, "--rounds", "2", "--until-error", "0.1"])
        self.fails(2, "--until-error", arguments=[*start, "--most-rounds", "2"])
        self.fails(2, "1e9 blocks", arguments=[*start, "--rounds", "10000", "--trajectories", "1000000"])

    def test_until_the_error_is_small(self):
        for threads in ("1", "2"):
            self.run_scenario(f"out{threads}", "--until-error", "0.2", "--above", "0.02", "--threads", threads)
        self.assert_same("out1", "out2")
        rounds = self.record("out1")["rounds"]
        self.assertTrue(rounds["reached"])
        self.assertLess(rounds["relative_half_width"], 0.2)
        self.assertGreater(rounds["done"], 1)
        self.run_scenario("less", "--rounds", str(rounds["done"] - 1), "--above", "0.02")
        self.assertGreaterEqual(self.record("less")["rounds"]["relative_half_width"], 0.2)  # the last round was needed
        self.run_scenario("cap", "--until-error", "0.001", "--most-rounds", "2")
        self.assertFalse(self.record("cap")["rounds"]["reached"])
        self.assertIn("--until-error was not reached", " ".join(self.record("cap")["warnings"]))
        self.assertEqual(self.record("cap")["rounds"]["done"], 2)


if __name__ == "__main__":
    unittest.main()
