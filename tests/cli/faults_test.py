"""Faults around a run: nothing is lost, no half result is left, and what goes on has the bits of one run. docs/faults.md."""
import os
import resource
import shutil
import signal
import subprocess
import time
import unittest

from support import RUN, TALUS, KeptRuns, RunCase, heights, write_dem

BACKWARDS = r"""
#define _GNU_SOURCE
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>
static int calls = 0;
static time_t back(time_t now) { return now - 3600 * __sync_add_and_fetch(&calls, 1); }
int clock_gettime(clockid_t clock, struct timespec* t) {
  const int error = (int)syscall(SYS_clock_gettime, clock, t);
  if (clock == CLOCK_REALTIME) t->tv_sec = back(t->tv_sec);
  return error;
}
time_t time(time_t* t) {
  struct timespec now;
  clock_gettime(CLOCK_REALTIME, &now);
  if (t) *t = now.tv_sec;
  return now.tv_sec;
}
int gettimeofday(struct timeval* t, void* zone) {
  struct timespec now;
  (void)zone;
  clock_gettime(CLOCK_REALTIME, &now);
  t->tv_sec = now.tv_sec, t->tv_usec = 0;
  return 0;
}
"""


LONG = ("--trajectories", "1000")  # about a second of one processor: time for a fault


def limit(what, size, hard=None):
    return lambda: resource.setrlimit(what, (size, hard or size))


class Faults(KeptRuns, RunCase):
    def setUp(self):
        super().setUp()
        self.write("s.toml", RUN.replace("trajectories = 40\n", "trajectories = 400\n"))
        self.begin = ["run", self.path("s.toml"), "-o", self.path("out")]

    def start(self, *more, **options):
        return subprocess.Popen([TALUS, *self.begin, "--threads", "1", "--progress=machine", *more], stderr=subprocess.PIPE,
                                text=True, **options)

    def goes_on(self, *more):
        """Resumes, and finds the bits of a run without a fault."""
        self.run_well(*self.begin, "-q", "--resume", *more)
        self.assert_same("whole", "out")
        self.assertEqual(self.unfinished("out"), [])


class Disks(Faults):
    def disk(self, size):
        disk = self.path("disk")
        os.mkdir(disk)
        if os.geteuid() != 0 or subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "none", disk],
                                               check=False, capture_output=True).returncode != 0:
            self.skipTest("only root can mount a small disk")
        self.addCleanup(subprocess.run, ["umount", "-l", disk], check=True)
        self.begin[-1] = self.path("disk/out")
        return disk

    def test_full_while_it_runs_and_gone_on_with_when_there_is_room(self):
        self.keep_scenario("whole", *LONG)
        disk = self.disk("1500k")
        process = subprocess.run([TALUS, *self.begin, "-q", "--checkpoint", "0", *LONG], capture_output=True, text=True,
                                 timeout=120)
        self.assertEqual(process.returncode, 1, process.stderr)
        self.assertIn("cannot be written", process.stderr)
        self.assertIn("; resume from the last save with: ", process.stderr)
        self.assertFalse(os.path.exists(self.path("disk/out")))
        self.assertEqual(len(os.listdir(disk)), 1)
        subprocess.run(["mount", "-o", "remount,size=200m", disk], check=True)
        self.run_well(*self.begin, "-q", "--resume", *LONG)
        self.assert_same("whole", "disk/out")
        self.assertEqual(os.listdir(disk), ["out"])

    def test_a_disk_that_cannot_be_written(self):
        disk = self.disk("10m")
        subprocess.run(["mount", "-o", "remount,ro", disk], check=True)
        self.fails(2, "no folder can be made there", "Read-only file system", arguments=self.begin)
        self.fails(2, disk + ": nothing can be written there (Read-only file system)", "use another folder",
                   arguments=[*self.begin, "--memory", "200M", "--threads", "1"])

    def test_a_disk_without_room_for_the_file_of_the_limit_of_memory(self):
        disk = self.disk("10m")
        self.fails(1, disk + ": the file for --memory cannot grow to 67 MB there (No space left on device)",
                   "write the results to another one", arguments=[*self.begin, "--memory", "200M", "--threads", "1"])
        self.assertEqual(os.listdir(disk), [])

    def test_a_disk_that_becomes_read_only(self):
        disk = self.disk("200m")
        process = self.start(*LONG, "--checkpoint", "1000")
        self.wait_for_progress(process, 5)
        # A disk with a file that is open for writing cannot be made read-only: another one covers it.
        subprocess.run(["mount", "-t", "tmpfs", "-o", "ro,size=1m", "none", disk], check=True)
        self.addCleanup(subprocess.run, ["umount", "-l", disk], check=False)
        error = process.communicate(timeout=120)[1]
        self.assertEqual(process.returncode, 1, error)
        self.assertEqual(error.count("talus: error"), 1, error)


class AnotherUser(Faults):
    """The tests run as root, who may write everywhere: the program runs as `nobody`."""

    def setUp(self):
        super().setUp()
        self.user = {"user": 65534, "group": 65534, "extra_groups": []} if os.geteuid() == 0 else {}
        os.chmod(self.folder, 0o755)
        try:
            able = subprocess.run([TALUS, "--version"], capture_output=True, check=False, **self.user).returncode == 0
        except PermissionError:
            able = False
        if not able:
            self.skipTest("another user cannot run the program there")

    def closed(self, folder):
        os.chmod(self.path(folder), 0o555)
        self.addCleanup(os.chmod, self.path(folder), 0o755)

    def test_a_folder_for_the_file_of_the_limit_of_memory(self):
        self.run_scenario("part", "--part", "1/1")
        os.mkdir(self.path("ro"))
        self.closed("ro")
        for arguments in (["run", "s.toml"], ["merge", "ro/out", "part"]):
            with self.subTest(arguments[0]):
                out = ["-o", "ro/out"] if arguments[0] == "run" else []
                self.fails(2, "ro: nothing can be written there (Permission denied)", "use another folder", cwd=self.folder,
                           arguments=[*arguments, *out, "--memory", "200M", "--threads", "1"], **self.user)

    def test_a_folder_for_a_single_file(self):
        """Named as it was given, before the work; it was a hidden name, and code 1, at the end."""
        self.write("s.toml", RUN)
        self.run_scenario("out")
        os.mkdir(self.path("ro"))
        self.closed("out")
        self.closed("ro")
        before = {folder: sorted(os.listdir(self.path(folder))) for folder in ("out", "ro")}
        scenario = "out/scenario.toml"
        for folder, arguments in (("out", ["report", "out"]), ("ro", ["report", "out", "-o", "ro/page.html"]),
                                  ("out", ["barrier", "out", "--screen", "road"]),
                                  ("ro", ["sources", "--dem", "dem.tif", "--slope", "30", "-o", "ro/cells.gpkg"]),
                                  ("ro", ["trace", scenario, "--source", "0", "--block", "0", "-o", "ro/path.gpkg"]),
                                  ("ro", ["check", scenario, "--pits", "ro/pits.gpkg"])):
            with self.subTest(arguments[0], folder=folder):
                self.fails(2, f"talus: error: {folder}: nothing can be written there (Permission denied)", arguments=arguments,
                           cwd=self.folder, **self.user)
        self.fails(2, f"{self.path('ro')}: nothing can be written there", cwd=self.path("ro"),
                   arguments=["sources", "--dem", self.path("dem.tif"), "--slope", "30", "-o", "cells.gpkg"], **self.user)
        self.assertEqual({folder: sorted(os.listdir(self.path(folder))) for folder in before}, before)

    def test_a_name_that_cannot_be_looked_at_when_the_run_is_done(self):  # all its results were removed
        os.mkdir(self.path("theirs"))
        os.chmod(self.path("theirs"), 0o777)
        self.begin[-1] = self.path("theirs/out")
        process = self.start(*LONG, **self.user)
        self.wait_for_progress(process, 1)
        os.mkdir(self.path("theirs/out"), 0)
        self.addCleanup(os.chmod, self.path("theirs/out"), 0o755)
        error = process.communicate(timeout=60)[1]
        self.assertEqual(process.returncode, 2, error)
        self.assertIn("theirs/out: cannot be looked at (Permission denied); the results are kept in ", error)
        (kept,) = [name for name in os.listdir(self.path("theirs")) if name.startswith(".out.talus-")]
        self.assertTrue(os.path.exists(self.path(f"theirs/{kept}/run.json")), kept)

    def test_a_folder_in_place_of_the_terrain(self):
        """`sources` says what `run` says; it walked through all folders below, and ended with 1 at one that is closed."""
        os.makedirs(self.path("tiles/closed"))
        os.chmod(self.path("tiles/closed"), 0)
        self.addCleanup(os.chmod, self.path("tiles/closed"), 0o755)
        os.mkdir(self.path("open"))
        os.chmod(self.path("open"), 0o777)
        for arguments in (["run", "--dem", "tiles", "--sources", "sources.gpkg", "--diameter", "1", "-o", "open/out"],
                          ["sources", "--dem", "tiles", "-o", "open/cells.gpkg"]):
            self.fails(2, "tiles", "is a folder, must be a regular file: name a file in it", arguments=arguments,
                       cwd=self.folder, **self.user)


class Inputs(Faults):
    def test_files_that_change_while_they_are_used(self):
        """All is read at the start: the results, and the checksums in run.json, are of what was read."""
        self.keep_scenario("whole", *LONG)
        process = self.start(*LONG)
        self.wait_for_progress(process, 2)
        write_dem(self.path("dem.tif"), heights() + 100)
        for name in ("sources.gpkg", "screens.gpkg", "nets.gpkg", "s.toml"):
            os.remove(self.path(name))
        error = process.communicate(timeout=120)[1]
        self.assertEqual(process.returncode, 0, error)
        self.assert_same("whole", "out", without=["talus.qgs"])  # the project shows the inputs that are there
        self.assertEqual(self.record("out")["inputs"], self.record("whole")["inputs"])

    def test_a_resumed_run_with_another_dem(self):
        self.keep_scenario("whole", *LONG)
        process = self.start(*LONG)
        self.wait_for_progress(process, 2)
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=60)
        shutil.copy(self.path("dem.tif"), self.path("old.tif"))
        write_dem(self.path("dem.tif"), heights() + 100)
        again = [*self.begin, "-q", *LONG, "--resume"]
        self.fails(2, "another plan", "(another content of the file of dem)", arguments=again)
        self.assertEqual(len(self.unfinished("out")), 1)
        shutil.move(self.path("old.tif"), self.path("dem.tif"))
        self.goes_on(*LONG)

    def test_the_folder_of_work_is_removed(self):
        process = self.start(*LONG, "--checkpoint", "1000")
        self.wait_for_progress(process, 2)
        shutil.rmtree(self.path(self.unfinished("out")[0]))
        error = process.communicate(timeout=120)[1]
        self.assertEqual(process.returncode, 1, error)
        self.assertEqual(error.count("talus: error"), 1, error)
        self.assertFalse(os.path.exists(self.path("out")))


class Signals(Faults):
    def test_the_terminal_goes_away(self):
        self.keep_scenario("whole", *LONG)
        process = self.start(*LONG)
        self.wait_for_progress(process, 2)
        process.send_signal(signal.SIGHUP)
        self.assertIn("interrupted", process.communicate(timeout=60)[1])
        self.assertEqual(process.returncode, 130)
        self.goes_on(*LONG)

    def test_nohup(self):
        """A signal that was ignored when the program began is ignored."""
        process = self.start(preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        self.wait_for_progress(process, 1)
        process.send_signal(signal.SIGHUP)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0)

    def test_stopped_and_continued(self):
        self.keep_scenario("whole")
        process = self.start("--checkpoint", "0")
        self.wait_for_progress(process, 2)
        process.send_signal(signal.SIGSTOP)
        time.sleep(0.5)
        process.send_signal(signal.SIGCONT)
        self.assertEqual(process.wait(timeout=60), 0)
        process.stderr.close()
        self.assert_same("whole", "out")

    def test_the_time_that_a_queue_allows(self):
        """At a limit of processor time (SIGXCPU) the work is kept as at an interruption."""
        process = self.start("--trajectories", "200000", preexec_fn=limit(resource.RLIMIT_CPU, 2, 60))
        error = process.communicate(timeout=60)[1]
        self.assertEqual(process.returncode, 130, error)
        self.assertIn("--resume", error)
        self.assertEqual(len(self.unfinished("out")), 1)


class Limits(Faults):
    def test_memory(self):
        """From too little to start to nearly enough: one error, no crash, nothing left."""
        before = os.listdir(self.folder)
        failed = 0
        for megabytes in (100, 150, 200, 225, 300, 400):  # between 225 and 400 PROJ searches for seconds before it fails
            size = megabytes * 1_000_000
            done = self.call(*self.begin, "-q", "--threads", "2", preexec_fn=limit(resource.RLIMIT_AS, size))
            if done.returncode == 0:
                break
            failed += 1
            if "error while loading shared libraries" in done.stderr:
                continue  # the program could not start
            self.assertIn(done.returncode, (1, 2), (megabytes, done.stderr))
            self.assertEqual(done.stderr.count("talus: error"), 1, (megabytes, done.stderr))
            self.assertEqual(sorted(os.listdir(self.folder)), sorted(before), megabytes)
        self.assertGreater(failed, 0)

    def test_open_files(self):
        for most in (4, 6, 8, 12, 16):
            done = self.call(*self.begin, "-q", preexec_fn=limit(resource.RLIMIT_NOFILE, most))
            if done.returncode == 0:
                break
            if "error while loading shared libraries" in done.stderr:
                continue
            self.assertIn(done.returncode, (1, 2), (most, done.stderr))
            self.assertEqual(done.stderr.count("talus: error"), 1, (most, done.stderr))
            self.assertFalse(os.path.exists(self.path("out")))


class Streams(Faults):
    def setUp(self):
        super().setUp()
        self.write("s.toml", RUN)  # nothing here waits for the middle of a run

    def test_closed_streams(self):
        """No file of results takes the number of a closed stream: else messages would be written into it."""
        self.keep_scenario("whole")

        def close():
            for stream in (0, 1, 2):
                os.close(stream)
        for options in ([], ["-q"]):
            out = "out" + "".join(options)
            done = subprocess.run([TALUS, *self.begin[:-1], self.path(out), "--checkpoint", "0", *options], preexec_fn=close,
                                  timeout=120)
            self.assertIn(done.returncode, (0, 1))
            if not options:
                self.assertTrue(os.path.exists(self.path("out/run.json")))
            self.assert_same("whole", out)

    def test_a_full_standard_output(self):
        for command in (["check", self.path("s.toml")], ["--version"], ["help", "run"], ["help", "--json"], ["presets"]):
            with open("/dev/full", "w", encoding="utf-8") as full:
                done = subprocess.run([TALUS, *command], stdout=full, stderr=subprocess.PIPE, text=True)
            self.assertEqual(done.returncode, 1, command)
            self.assertIn("the output cannot be written", done.stderr)

    def test_a_full_standard_error(self):
        self.keep_scenario("whole")
        with open("/dev/full", "w", encoding="utf-8") as full:
            done = subprocess.run([TALUS, *self.begin], stderr=full, timeout=120)
        self.assertEqual(done.returncode, 0)
        self.assert_same("whole", "out")


class Clocks(Faults):
    def shim(self):
        """A library that sets the clock back by an hour each time that it is asked."""
        self.write("back.c", BACKWARDS)
        compiler = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
        if compiler is None or subprocess.run([compiler, "-shared", "-fPIC", "-O1", "-o", self.path("back.so"), self.path("back.c")],
                                              check=False, capture_output=True).returncode != 0:
            self.skipTest("no C compiler")
        return {**os.environ, "LD_PRELOAD": self.path("back.so")}

    def test_set_back_all_the_time(self):
        self.keep_scenario("whole")
        environment = self.shim()
        self.run_well(*self.begin, "-q", "--checkpoint", "0", env=environment)
        self.assert_same("whole", "out")
        record = self.record("out")
        for key in ("cpu_seconds", "wall_seconds"):
            self.assertTrue(all(0.0 <= s < 100.0 for s in record[key].values()), record[key])

    def test_set_back_before_it_is_resumed(self):
        self.keep_scenario("whole", *LONG)
        process = self.start(*LONG, "--checkpoint", "0")
        self.wait_for_progress(process, 20)
        process.kill()
        process.communicate()
        hidden = self.path(self.unfinished("out")[0])
        for folder, _, files in os.walk(hidden):  # all was kept in what is now the future
            for name in files:
                os.utime(os.path.join(folder, name), (4e9, 4e9))
        self.goes_on(*LONG)


class Documentation(unittest.TestCase):
    def test_each_row_names_tests_that_exist(self):
        here = os.path.dirname(os.path.abspath(__file__))
        with open(os.path.join(here, "../../docs/faults.md"), encoding="utf-8") as file:
            rows = [line for line in file if line.startswith("|") and "---" not in line][1:]
        self.assertGreater(len(rows), 25)
        for row in rows:
            names = [word for word in row.rsplit("|", 2)[1].replace("`", " ").replace(",", " ").split() if "." in word]
            self.assertTrue(names, row)
            for name in names:
                module, test = name.split(".")
                with open(os.path.join(here, module + ".py"), encoding="utf-8") as file:
                    self.assertIn(f"def {test}(", file.read(), name)


if __name__ == "__main__":
    unittest.main()
