"""A run by several processes gives the bits of one process, also if one of them dies. MPIRUN and TALUS_MPI name the programs."""
import os
import signal
import subprocess
import time
import unittest

from lanes_test import lanes_of_machine
from support import OPEN_RUN, RUN, RunCase

MPIRUN = [os.environ.get("MPIRUN", "mpirun"), "--oversubscribe"]
TALUS_MPI = os.environ.get("TALUS_MPI", "talus-mpi")
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_btl_base_warn_component_unused": "0"}


class Mpi(RunCase):
    def command(self, ranks, out, *more):
        return [*MPIRUN, "-n", str(ranks), TALUS_MPI, "run", self.path("s.toml"), "-o", self.path(out), "-q", *more]

    def ranks(self, ranks, out, *more, code=0):
        done = subprocess.run(self.command(ranks, out, *more), capture_output=True, text=True, env=ENVIRONMENT, timeout=300)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr

    def shared_names(self):
        return [name for name in os.listdir("/dev/shm") if name.startswith("talus-")]

    def test_one_two_and_four_ranks(self):
        self.run_scenario("whole")
        before = self.shared_names()
        for n in (1, 2, 4):
            self.ranks(n, f"ranks{n}", "--checkpoint", "0.05")
            self.assert_same("whole", f"ranks{n}")
        self.assertEqual(self.record("ranks4")["ranks"], 4)
        self.ranks(2, "threads", "--threads", "2")
        self.assert_same("whole", "threads")
        self.ranks(2, "limited", "--memory", "200M")
        self.assert_same("whole", "limited")
        self.assertEqual(self.shared_names(), before)
        self.run_well("hazard", self.path("ranks4"), "-q")

    def test_ranks_in_lanes(self):
        self.write("s.toml", OPEN_RUN)
        self.run_scenario("one", "--lanes", "1")
        self.ranks(2, "ranks")
        self.assertEqual((self.record("one")["lanes"], self.record("ranks")["lanes"]), (1, lanes_of_machine()))
        self.assert_same("one", "ranks")

    def test_rounds_and_until_error(self):
        self.write("s.toml", RUN.replace("trajectories = 40\n", "trajectories = 150\n"))  # two units of work a source cell
        self.run_scenario("whole", "--rounds", "3")
        self.ranks(3, "three", "--rounds", "3", "--checkpoint", "0")
        self.assert_same("whole", "three")
        self.run_scenario("until", "--until-error", "0.1", "--above", "0.02")
        self.ranks(3, "until3", "--until-error", "0.1", "--above", "0.02")
        self.assert_same("until", "until3")
        self.assertEqual(self.record("until")["rounds"], self.record("until3")["rounds"])

    def test_parts_by_ranks(self):
        self.run_scenario("whole")
        self.ranks(2, "part1", "--part", "1/2")
        self.run_scenario("part2", "--part", "2/2")
        self.run_well("merge", self.path("merged"), self.path("part1"), self.path("part2"), "-q")
        self.assert_same("whole", "merged")
        for key in ("warnings", "notes", "inputs"):  # as the first rank of the first part read them
            self.assertEqual(self.record("merged")[key], self.record("whole")[key], key)

    def test_a_rank_that_dies(self):
        """In one round and in several; resumed by more ranks, and by one process."""
        self.write("s.toml", RUN.replace("trajectories = 40\n", "trajectories = 1000\n"))
        for rounds, after in (([], 4), ([], 0), (["--rounds", "2"], 3), (["--rounds", "2"], 0)):
            with self.subTest(rounds=rounds, after=after):
                whole, out = "whole" + "".join(rounds), f"out{len(rounds)}{after}"
                if not os.path.exists(self.path(whole)):
                    self.run_scenario(whole, *rounds)
                process = subprocess.Popen(self.command(2, out, "--checkpoint", "0", *rounds), stderr=subprocess.PIPE, text=True,
                                           env=ENVIRONMENT)
                self.wait_for(lambda name=out: any(os.path.exists(self.path(f"{n}/unfinished/part.json"))
                                                   for n in self.unfinished(name)))
                children = subprocess.run(["pgrep", "-P", str(process.pid)], capture_output=True, text=True).stdout.split()
                self.assertEqual(len(children), 2)
                os.kill(int(children[1]), signal.SIGKILL)
                error = process.communicate(timeout=60)[1]
                self.assertNotEqual(process.returncode, 0)
                self.assertIn("signal 9 (Killed)", error)
                self.assertFalse(os.path.exists(self.path(out)))
                if after:
                    self.ranks(after, out, "--resume", *rounds)
                else:
                    self.run_scenario(out, "--resume", *rounds)
                self.assert_same(whole, out)

    def wait_for(self, there):
        for _ in range(600):
            if there():
                return
            time.sleep(0.02)
        self.fail("nothing was kept")

    def test_a_signal_to_the_leader(self):
        """A signal to the leader alone, in the middle and when it begins to write: all processes end with 130, or had finished."""
        self.write("s.toml", RUN.replace("trajectories = 40\n", "trajectories = 400\n"))
        for percent in (40, 99):
            out = f"out{percent}"
            process = subprocess.Popen(self.command(2, out, "--progress=machine"), stderr=subprocess.PIPE, text=True, env=ENVIRONMENT)
            self.wait_for_progress(process, percent)
            leader = subprocess.run(["pgrep", "-P", str(process.pid)], capture_output=True, text=True).stdout.split()[0]
            os.kill(int(leader), signal.SIGTERM)
            error = process.communicate(timeout=60)[1]
            if percent == 99 and process.returncode == 0:
                continue
            self.assertEqual(process.returncode, 130, error)
            self.assertEqual(error.count("talus: interrupted"), 1, error)
            self.assertFalse(os.path.exists(self.path(out)))

    def test_wrong_input_is_said_once(self):
        before = self.shared_names()
        self.write("s.toml", RUN + "nonsense = 1\n")
        error = self.ranks(3, "x", code=2)
        self.assertEqual(error.count("talus: error"), 1)
        self.assertIn("nonsense", error)
        self.write("s.toml", RUN)
        self.assertEqual(self.ranks(2, "x", "--no-such", code=2).count("talus: error"), 1)
        self.ranks(2, "x")
        self.assertEqual(self.ranks(2, "x", code=2).count("talus: error"), 1)  # the folder is there
        self.assertEqual(self.ranks(3, "y", "--part", "5/2", code=2).count("talus: error"), 1)
        self.assertEqual(self.shared_names(), before)


if __name__ == "__main__":
    unittest.main()
