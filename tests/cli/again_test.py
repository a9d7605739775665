"""Two runs into one folder at the same time, and repeated runs: nothing is lost, and no work is done twice."""
import os
import shutil
import signal
import subprocess
import unittest

from support import TALUS, RunCase


class Again(RunCase):
    def start(self, out, *more):
        command = [TALUS, "run", self.path("s.toml"), "-o", self.path(out), "--threads", "1", *more]
        return subprocess.Popen(command, stderr=subprocess.PIPE, text=True)

    def killed(self, out, *more, percent=20):
        """Starts a run and kills it when `percent` of it is done."""
        process = self.start(out, "--progress=machine", *more)
        self.wait_for_progress(process, percent)
        process.kill()
        process.communicate()

    def test_two_runs_of_one_name(self):
        first = self.start("out", "--trajectories", "4000", "--progress=machine")
        self.wait_for_progress(first, 1)
        for more in ([], ["--overwrite"], ["--resume"]):  # long before it has saved anything
            self.fails(2, "another process is writing it",
                       arguments=["run", self.path("s.toml"), "-o", self.path("out"), "-q", *more])
        first.send_signal(signal.SIGINT)
        first.communicate(timeout=20)
        self.assertEqual(first.returncode, 130)
        self.assertEqual(len(self.unfinished("out")), 1)

    def test_a_name_that_was_filled_meanwhile(self):
        first = self.start("out", "--trajectories", "1000", "--progress=machine")
        self.wait_for_progress(first, 1)
        os.mkdir(self.path("out"))
        self.write("out/mine.txt", "not to be lost")
        error = first.communicate(timeout=60)[1]
        self.assertEqual(first.returncode, 2, error)
        self.assertIn("the results are kept in", error)
        self.assertEqual(os.listdir(self.path("out")), ["mine.txt"])
        kept = self.unfinished("out")
        self.assertTrue(os.path.exists(self.path(f"{kept[0]}/run.json")), kept)
        os.remove(self.path("out/mine.txt"))
        self.run_scenario("out")  # does not take the results for what a killed run has left
        self.assertTrue(os.path.exists(self.path(f"{kept[0]}/run.json")), self.unfinished("out"))

    def test_resumed_twice_at_once(self):
        for attempt in range(4):
            out = f"out{attempt}"
            self.killed(out, "--trajectories", "2000", "--checkpoint", "0")
            both = [self.start(out, "--trajectories", "2000", "--resume") for _ in range(2)]
            errors = [process.communicate(timeout=60)[1] for process in both]
            self.assertEqual(sum("results are in" in e for e in errors), 1, errors)
            self.assertEqual(sum("going on" in e for e in errors), 1, errors)
            other = next(e for e in errors if "results are in" not in e)
            self.assertTrue("another process is writing it" in other or "is done" in other, other)

    def test_a_run_that_is_done_with_too_many_at_a_limit(self):
        with open(self.path("s.toml"), "a") as file:
            file.write("\n[model]\nimpact_limit = 2\n")
        arguments = ["run", self.path("s.toml"), "-o", self.path("out")]
        self.fails(1, "ended at the limit", arguments=[*arguments, "-q"])
        before = os.stat(self.path("out/run.json")).st_mtime_ns
        self.fails(1, "the run is done, but too many", arguments=[*arguments, "--resume"])  # not traced again
        self.assertEqual(os.stat(self.path("out/run.json")).st_mtime_ns, before)

    def test_nothing_to_resume(self):
        done = self.run_well("run", self.path("s.toml"), "-o", self.path("out"), "--resume")  # a name that was mistyped
        self.assertIn("note: nothing is saved that could be resumed in " + self.path("out") + ": the run begins", done.stderr)

    def test_a_run_that_is_done(self):
        self.run_scenario("out")
        again = self.run_well("run", self.path("s.toml"), "-o", self.path("out"), "--resume")  # a task that was requeued
        self.assertIn("the run is done", again.stderr)
        for more in (["--seed", "2"], ["--rounds", "2"]):
            self.fails(2, "holds a finished run that is not this one", arguments=["run", self.path("s.toml"), "-o", self.path("out"), "--resume", *more])
        self.fails(2, "30;300", "30,100,300", arguments=["run", self.path("s.toml"), "-o", self.path("out"), "--thresholds", "30;300"])
        self.run_scenario("rounds", "--rounds", "3")
        os.mkdir(self.path("rounds/unfinished"))  # killed before it could remove that
        self.run_scenario("rounds", "--rounds", "3", "--resume")
        self.assertFalse(os.path.exists(self.path("rounds/unfinished")))
        until = ["--until-error", "9", "--most-rounds", "2"]
        self.run_scenario("until", *until)
        self.run_scenario("until", *until, "--resume")
        for out, *more in (["rounds", "--rounds", "2"], ["rounds", "--rounds", "3", "--above", "0.2"],
                           ["until", "--until-error", "8", "--most-rounds", "2"], ["until", "--until-error", "9"],
                           ["until", *until, "--above", "0.2"], ["until"]):
            self.fails(2, "holds a finished run that is not this one",
                       arguments=["run", self.path("s.toml"), "-o", self.path(out), "--resume", *more])

    def test_the_scenario_is_edited_while_its_rounds_run(self):
        self.run_scenario("whole", "--rounds", "40")
        process = self.start("out", "--rounds", "40", "--progress=machine")
        self.wait_for_progress(process, 1)
        os.remove(self.path("s.toml"))
        self.assertEqual(process.communicate(timeout=60)[1].count("error"), 0)
        self.assertEqual(process.returncode, 0)
        self.assert_same("whole", "out")

    def test_other_rounds_are_refused(self):
        rounds = ["--until-error", "0.0001", "--most-rounds", "999"]
        self.killed("out", *rounds, "--checkpoint", "0", percent=99)
        for other in (["--until-error", "0.5", "--most-rounds", "999"], ["--until-error", "0.0001", "--most-rounds", "2"],
                      [*rounds, "--above", "0.1"]):
            self.fails(2, "begun with other --rounds",
                       arguments=["run", self.path("s.toml"), "-o", self.path("out"), "--resume", *other])

    def test_what_was_killed_before_it_kept_anything(self):
        self.killed("out", "--trajectories", "2000", "--checkpoint", "600")
        self.assertEqual(len(self.unfinished("out")), 1)
        self.run_scenario("out")
        self.assertEqual(self.unfinished("out"), [])

    def test_parts_of_other_folders(self):
        """The same files in another place are the same plan, as on another machine; another content is another plan."""
        self.run_scenario("whole")
        self.run_scenario("part1", "--part", "1/2")
        os.mkdir(self.path("node"))
        for name in ("s.toml", "dem.tif", "sources.gpkg", "screens.gpkg", "nets.gpkg"):
            shutil.copy(self.path(name), self.path("node"))
        self.run_well("run", self.path("node/s.toml"), "-o", self.path("part2"), "--part", "2/2", "-q")
        self.run_well("merge", self.path("merged"), self.path("part1"), self.path("part2"), "-q")
        for name in ("impact_probability.tif", "reach_probability.tif", "stops.gpkg", "scenario.toml"):
            self.assertEqual(self.hashes("merged")[name], self.hashes("whole")[name], name)

    def test_one_part_of_one(self):
        self.run_scenario("whole")
        self.run_scenario("part", "--part", "1/1")  # a job array of one task
        self.run_well("merge", self.path("merged"), self.path("part"), "-q")
        self.assert_same("whole", "merged")

    def test_numbers_that_are_none(self):
        start = ["run", self.path("s.toml"), "-o", self.path("x")]
        for option in ("--until-error", "--checkpoint", "--above"):
            self.fails(2, option, "nan", "not in range", arguments=[*start, option, "nan"])
        self.fails(2, "--part", "must be I/N", arguments=[*start, "--part", "1"])
        self.fails(2, "--memory", "1100M at least", arguments=[*start, "--memory", "500M", "--threads", "32"])
        self.assertFalse(os.path.exists(self.path("x")))


if __name__ == "__main__":
    unittest.main()
