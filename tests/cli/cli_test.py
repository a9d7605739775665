"""Errors of the program: exit codes, messages of one line, no half results."""
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import time
import unittest

import numpy as np

from support import NORTH, TALUS, WEST, Case, box, heights, write_dem, write_features


class CommandLine(Case):
    def test_unknown_command_names_the_nearest(self):
        self.fails(2, "'rnu'", "did you mean 'run'", arguments=["rnu"])

    def test_unknown_option_names_the_nearest(self):
        self.fails(2, "'--trajectory'", "did you mean '--trajectories'", arguments=["run", "--trajectory", "5", "-o", "x"])
        self.fails(2, "'--versoin'", "did you mean '--version'", arguments=["--versoin"])

    def test_an_unknown_option_is_said_before_what_is_missing(self):  # "--out is required": the slip was not named
        self.fails(2, "unknown option '--bogus'", arguments=["run", "--bogus"])
        self.fails(2, "unknown option '--bogus'", arguments=["check", "--overwrite", "--bogus"])
        done = self.call("run", "--progress=json", "--bogus")
        self.assertEqual(done.returncode, 2)
        self.assertIn("unknown option '--bogus'", json.loads(done.stderr)["error"])
        self.fails(2, "--out is required", arguments=["run"])
        self.fails(2, "--overwrite requires --pits", arguments=["check", "--overwrite"])

    def test_values_that_are_no_numbers(self):
        self.fails(2, "--diameter", "abc", arguments=self.arguments(diameter="abc"))
        self.fails(2, "--trajectories", "-5", arguments=self.arguments(trajectories="-5"))
        self.fails(2, "--threads", arguments=[*self.arguments(), "--threads", "0"])

    def test_values_out_of_range(self):
        self.fails(2, "diameter", "0", arguments=self.arguments(diameter="0"))
        self.fails(2, "diameter", "nan", arguments=self.arguments(diameter="nan"))
        self.fails(2, "trajectories", arguments=self.arguments(trajectories="0"))

    def test_help_and_version(self):
        self.assertRegex(self.run_well("--version").stdout, r"^talus \d+\.\d+\.\d+\n$")
        for command in ([], ["run"], ["check"], ["trace"], ["presets"], ["score"], ["calibrate"], ["diagnose"], ["sources"],
                        ["profile"], ["barrier"], ["hazard"], ["merge"]):
            self.assertIn("Example", self.run_well(*command, "--help").stdout)

    def test_presets_are_those_of_the_paper(self):
        text = self.run_well("presets").stdout
        line = next(line for line in text.splitlines() if line.startswith("forest-road-3d"))
        self.assertEqual(line.split()[1:8], ["0.4", "0.3", "15", "50", "30", "1", "1.5"])  # Table 3
        self.assertIn("Table 3", line)


class Input(Case):
    def fails_with(self, *words):
        before = os.listdir(self.folder)
        self.fails(2, *words, arguments=self.arguments())
        self.assert_nothing_left(before)

    def test_missing_files(self):
        os.remove(self.path("dem.tif"))
        self.fails_with("dem.tif")
        self.fails(2, "none.toml", arguments=["run", self.path("none.toml"), "-o", self.path("out")])

    def test_dem_in_degrees(self):
        write_dem(self.path("dem.tif"), heights(), code=4326, transform=(7.0, 1e-4, 0.0, 46.0, 0.0, -1e-4))
        self.fails_with("dem.tif", "degree")

    def test_rotated_dem(self):
        write_dem(self.path("dem.tif"), heights(), transform=(WEST, 4.9, 0.9, 1200300.0, 0.9, -4.9))
        self.fails_with("dem.tif", "rotated")

    def test_dem_of_nan(self):
        write_dem(self.path("dem.tif"), np.full((60, 60), np.nan, np.float32))
        self.fails_with("dem.tif")

    def test_empty_sources(self):
        write_features(self.path("sources.gpkg"), "sources", [])
        self.fails_with("sources.gpkg")

    def test_sources_off_the_map(self):
        write_features(self.path("sources.gpkg"), "sources", [(box(9000, 9000, 20, 20), [])])
        self.fails_with("sources.gpkg")

    def test_gaps_of_the_dem_at_the_sources_are_said_once(self):
        """8 source cells, 2 without a height: the other 6 are all beside them, or not."""
        z = heights()
        z[12, 29:31] = -9999.0
        write_dem(self.path("dem.tif"), z, nodata=-9999.0)
        told = [self.run_well(*self.arguments()).stderr,
                self.run_well("check", *self.arguments()[1:-2]).stdout]
        for text in told:
            (line,) = [line for line in text.splitlines() if "source cells" in line and "heights" in line]
            self.assertIn(": 2 source cells or points have no height in the DEM and release nothing; 6 source cells", line)

    def test_no_diameter(self):
        arguments = self.arguments()
        at = arguments.index("--diameter")
        self.fails(2, "diameter", arguments=arguments[:at] + arguments[at + 2:])

    def scenario(self, extra):
        return self.write("s.toml", f'dem = "dem.tif"\n{extra}\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 0.8\n')

    def test_unknown_key_names_the_nearest(self):
        self.fails(2, "s.toml", "trajectorys", "trajectories",
                   arguments=["run", self.scenario("trajectorys = 5"), "-o", self.path("out")])

    def test_check_lists_every_fault(self):
        done = self.call("check", self.scenario("trajectorys = 5\nseed = -1"))
        self.assertEqual(done.returncode, 2)
        lines = done.stderr.splitlines()
        self.assertEqual(len(lines), 2, done.stderr)
        self.assertTrue(all(line.startswith("talus: error: ") for line in lines))

    def test_check_prints_the_plan_and_writes_nothing(self):
        scenario, before = self.scenario("trajectories = 7"), sorted(os.listdir(self.folder)) + ["s.toml"]
        start = time.monotonic()
        text = self.run_well("check", scenario).stdout
        self.assertLess(time.monotonic() - start, 10.0)
        for words in ("60 x 60 cells of 5 m x 5 m", "EPSG:2056", "1 feature, 8 source cells", "8 x 7 = 56 trajectories",
                      "0.8 m", "energy 30, 300 kJ"):
            self.assertIn(words, text)
        self.assert_nothing_left(set(before))

    def test_a_high_c_is_said_before_the_run(self):
        """0.25 is the default and may give too low energies: docs/barrier.md, "The value of c"."""
        scenario = self.scenario("trajectories = 1")
        for command in (["check", scenario], ["run", scenario, "-o", self.path("c")]):
            done = self.run_well(*command)
            self.assertIn("energies, jumps, run-out and hits may be too low (unsafe): c = 0.25", done.stdout + done.stderr)
        done = self.run_well("check", scenario, "--deformation-coefficient", "0.15")
        self.assertNotIn("c = ", done.stdout)

    def test_cell_sizes_are_short_where_they_are_read(self):
        write_dem(self.path("dem.tif"), heights(), cell=4.997678230579)
        self.assertIn("60 x 60 cells of 4.998 m x 4.998 m", self.run_well("check", self.scenario("")).stdout)

    def test_check_foretells_within_a_factor_of_one_and_a_half(self):
        """Estimates of cells, memory and disk from an eighth of a run at most. (Seconds: tools/scripts/studies/scaling.py.)"""
        scenario = self.scenario("trajectories = 20000")
        text = self.run_well("check", scenario).stdout
        self.run_well("run", scenario, "-o", self.path("out"), "-q")
        record = self.record()
        was = {"cells": record["touched_cells"], "memory": record["peak_memory_mb"],
               "disk": sum(os.path.getsize(self.path(f"out/{name}")) for name in record["files"]) / 1e6}
        for what, value in was.items():
            said = float(re.search(rf"^{what}\s+about ([0-9 ]+)", text, re.M).group(1).replace(" ", ""))
            self.assertLess(abs(np.log(said / value)), np.log(1.5), f"{what}: {said}, was {value}")


class Folder(Case):
    def test_existing_folder_is_kept_and_overwritten_when_asked(self):
        self.run_well(*self.arguments())
        stamp = os.stat(self.path("out/run.json")).st_ino
        self.fails(2, "out", "--overwrite", arguments=self.arguments())
        self.assertEqual(os.stat(self.path("out/run.json")).st_ino, stamp)
        self.run_well(*self.arguments(trajectories="3"), "--overwrite")
        self.assertEqual(self.record()["trajectories_per_source"], 3)
        self.assert_nothing_left(["dem.tif", "sources.gpkg", "out"])

    def test_a_failed_run_keeps_what_it_should_have_overwritten(self):
        self.run_well(*self.arguments())
        self.fails(1, arguments=[*self.arguments(trajectories="2000"), "--overwrite"], preexec_fn=limit_files(100_000))
        self.assertTrue(os.path.exists(self.path("out/run.json")))
        self.assert_nothing_left(["dem.tif", "sources.gpkg", "out"])

    def test_only_results_of_talus_are_overwritten(self):
        os.mkdir(self.path("out"))
        self.write("out/diary.txt", "dear diary")
        self.fails(2, "run.json", arguments=[*self.arguments(), "--overwrite"])
        self.assertTrue(os.path.exists(self.path("out/diary.txt")))
        self.write("file", "")
        self.fails(2, "is a file", arguments=[*self.arguments("file"), "--overwrite"])

    def test_results_of_another_command_are_not_overwritten(self):  # a run of hours was, without a word
        commands = {"run": self.arguments()[:-1]}
        commands["profile"] = ["profile", *commands["run"][1:3], "--line", self.path("line.gpkg"), "--source-x", "5",
                               "--diameter", "0.8", "--trajectories", "5", "-o"]
        write_features(self.path("line.gpkg"), "line", [(f"LINESTRING ({WEST + 150} {NORTH - 20},{WEST + 150} {NORTH - 280})", [])])
        for command, arguments in commands.items():
            self.run_well(*arguments, self.path(command), "-q")
            self.run_well(*arguments, self.path(command), "-q", "--overwrite")
        for command, other in (("run", "profile"), ("profile", "run")):
            before = sorted(os.listdir(self.path(other)))
            self.fails(2, f"{other}: holds results of talus {other}, and --overwrite replaces only those of talus {command};",
                       arguments=[*commands[command], self.path(other), "--overwrite"])
            self.assertEqual(sorted(os.listdir(self.path(other))), before)
        for command, mark in (("calibrate", "calibration.json"), ("diagnose", "diagnosis.json")):
            os.mkdir(self.path(command))
            self.write(f"{command}/{mark}", "{}")
            self.fails(2, f"holds results of talus {command},", arguments=[*commands["run"], self.path(command), "--overwrite"])

    def test_an_input_in_the_folder_is_not_deleted(self):
        self.run_well(*self.arguments())
        os.rename(self.path("dem.tif"), self.path("out/dem.tif"))
        os.symlink(self.path("out/dem.tif"), self.path("dem.tif"))
        self.fails(2, "dem.tif", arguments=[*self.arguments(), "--overwrite"])
        self.assertTrue(os.path.exists(self.path("out/dem.tif")))

    def test_an_empty_folder_is_taken(self):
        os.mkdir(self.path("out"))
        self.run_well(*self.arguments())

    def test_unwritable_parent(self):
        self.fails(2, "no folder can be made", arguments=self.arguments("dem.tif/out"))
        self.fails(2, arguments=[*self.arguments()[:-1], "/proc/out"])


def limit_files(size):
    """Limits each file of the child to `size` bytes, which acts like a full disk."""
    def apply():
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
    return apply


class Trouble(Case):
    def test_interrupted(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            process = subprocess.Popen([TALUS, *self.arguments(trajectories="2000000"), "--progress=machine"],
                                       stderr=subprocess.PIPE, text=True)
            lines = iter(process.stderr.readline, "")
            self.assertTrue(any(line == "progress 0\n" for line in lines))
            time.sleep(0.5)
            self.assertEqual(len([name for name in os.listdir(self.folder) if name.startswith(".out.talus-")]), 1)
            process.send_signal(number)
            start = time.monotonic()
            rest = process.communicate(timeout=20)[1].splitlines()
            self.assertLess(time.monotonic() - start, 5.0)
            self.assertEqual(process.returncode, 130)
            self.assertIn("interrupted", rest[-1])
            self.assertIn("--resume", rest[-1])
            kept = [name for name in os.listdir(self.folder) if name.startswith(".out.talus-")]
            self.assertEqual(len(kept), 1)
            shutil.rmtree(self.path(kept[0]))
            self.assert_nothing_left(["dem.tif", "sources.gpkg"])

    def test_full_disk_in_the_vectors(self):
        self.fails(1, "cannot be written", arguments=self.arguments(trajectories="2000"), preexec_fn=limit_files(200_000))
        self.assert_nothing_left(["dem.tif", "sources.gpkg"])

    def test_full_disk_in_a_single_file(self):
        """The file is called by its name, not by the hidden one that it has until it is complete."""
        self.write("s.toml", 'dem = "dem.tif"\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 0.8\n')
        for arguments in (["sources", "--dem", "dem.tif", "--slope", "30", "-q", "-o"], ["check", "s.toml", "--pits"],
                          ["trace", "s.toml", "--source", "0", "--block", "0", "-o"]):
            with self.subTest(arguments[0]):
                done = self.call(*arguments, "cells.gpkg", cwd=self.folder, preexec_fn=limit_files(20_000))
                self.assertEqual(done.returncode, 1, done.stderr)
                self.assertIn("talus: error: cells.gpkg: cannot be written: ", done.stderr)
                self.assertNotIn(".talus-", done.stderr)
        self.assert_nothing_left(["dem.tif", "sources.gpkg", "s.toml"])

    def test_full_disk_in_the_rasters(self):
        write_dem(self.path("dem.tif"), heights(600, 600, 0.5), 0.5)
        self.write("s.toml", 'dem = "dem.tif"\ntrajectories = 1\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 0.8\n'
                             '[output]\ntrajectories = 0\n')
        self.fails(1, ".tif", arguments=["run", self.path("s.toml"), "-o", self.path("out")],
                   preexec_fn=limit_files(500_000))
        self.assert_nothing_left(["dem.tif", "sources.gpkg", "s.toml"])

    def test_full_disk(self):
        disk = self.path("disk")
        os.mkdir(disk)
        if os.geteuid() != 0 or subprocess.run(["mount", "-t", "tmpfs", "-o", "size=400k", "none", disk],
                                               check=False, capture_output=True).returncode != 0:
            self.skipTest("only root can mount a small disk")
        self.addCleanup(subprocess.run, ["umount", disk], check=True)
        for trajectories in ("1", "20", "100", "1000"):
            self.fails(1, "full", arguments=self.arguments("disk/out", trajectories=trajectories))
            self.assertEqual(os.listdir(disk), [])

    def test_nobody_reads_the_progress(self):
        read, write = os.pipe()
        with subprocess.Popen([TALUS, *self.arguments(trajectories="300000"), "--progress=machine"], stderr=write) as process:
            os.close(write)
            os.read(read, 10)
            os.close(read)
            self.assertEqual(process.wait(timeout=60), 130)
        self.assertFalse(os.path.exists(self.path("out")))


if __name__ == "__main__":
    unittest.main()
