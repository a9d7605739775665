"""The commands of the tutorials, run as a reader runs them: the ```sh blocks of a page in turn, in a folder that holds data.
TALUS is the path of the program."""
import os
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "../.."))
TALUS = os.environ.get("TALUS", "talus")


def blocks_of(page):
    """(line, text) of the ```sh blocks of a page."""
    with open(os.path.join(ROOT, "docs", page), encoding="utf-8") as file:
        text = file.read()
    return [(text[:m.start()].count("\n") + 2, m.group(1)) for m in re.finditer(r"^```sh\n(.*?)^```$", text, re.M | re.S)]


def script_of(page):
    """The blocks as one script that stops at the first command that fails, and names the line of its block."""
    parts = ["set -euo pipefail", f"talus() {{ command '{TALUS}' \"$@\"; }}"]
    for line, block in blocks_of(page):
        parts += [f"echo '== {page}:{line}' >&2", block]
    return "\n".join(parts)


class Tutorials(unittest.TestCase):
    def run_page(self, page):
        self.assertTrue(blocks_of(page), page)
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(os.path.join(ROOT, "data"), os.path.join(folder, "data"))
            done = subprocess.run(["bash", "-c", script_of(page)], cwd=folder, capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, f"{page}\n{done.stdout[-2000:]}\n{done.stderr[-4000:]}")
            return done.stdout + done.stderr

    def test_first_map(self):
        self.run_page("first-map.md")

    def test_road_job(self):
        """The numbers of the page are those that its commands print."""
        printed = self.run_page("road-job.md")
        for figure in ("forest road,6,3481,0.0445513", "forest road,6,51,0.000654185", "forest road,6,10668,0.136347", "Suedgrat,0.0202267,0.45401",
                       "SEL     383.1 kJ", "MEL     498.1 kJ", "h_i     2.412 m",
                       "300 years   energy 28.9 [27.9, 30.5] kJ     jump height 1.1 [1.07, 1.14] m",
                       "| model.deformation_coefficient ", "3 892 caught, 56 over it, 0 through it", "657 over it, 0 through it"):
            self.assertIn(figure, printed)

    def test_prepare_data(self):
        self.run_page("prepare-data.md")

    def test_choose_ground(self):
        """The shares and percentiles of the table of sensitivities."""
        printed = self.run_page("choose-ground.md")
        rows = dict((f"{m[1]} {m[2]}", m[0]) for m in ((line, *re.match(r"([^/]+)/\S+?:road,([a-z ]+),", line).groups())
                                                       for line in printed.splitlines() if "screens_summary.csv:road," in line))
        for run, share, energy, jump in (("ground-forest-road-3d", "0.699321", "94.3716", "1.39184"), ("ground-upper-talus-3d", "0.0537095", "25.0748", "0.996157"),
                                         ("ground-rockyfor3d-4", "0.00193312", "9.35952", "0.429206"), ("size-0.5", "0.312173", "6.89644", "1.56479"),
                                         ("size-1.0", "0.0505747", "28.9241", "0.766212"), ("c-0.15", "0.174765", "50.5786", "1.59384")):
            self.assertIn(f",{share},", rows[f"{run} energy"])
            self.assertIn(f",{energy},", rows[f"{run} energy"])
            self.assertIn(f",{jump},", rows[f"{run} jump height"])
        self.assertIn(",0.000104493,", rows["ground-lower-talus-3d energy"])
        self.assertIn(",0.00031348,", rows["size-2.0 energy"])

    def test_mapped_deposits(self):
        """The example at the end of the page, with its error before and after."""
        (example,) = [block for _, block in blocks_of("mapped-deposits.md") if "mapped_deposits_study.py make" in block]
        with tempfile.TemporaryDirectory() as folder:
            script = example.replace("/tmp/mapped", os.path.join(folder, "mapped")).replace("talus calibrate", f"'{TALUS}' calibrate")
            done = subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=ROOT, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("error, fitting rows (40 blocks): 0.975 before, 0.592 after", done.stdout)
        with open(os.path.join(ROOT, "docs", "mapped-deposits.md"), encoding="utf-8") as file:
            self.assertIn("falls from 0.975 to 0.592", file.read())

    def test_pits(self):
        """Rows of the table, and what the command of the page prints of a run of the study."""
        with open(os.path.join(ROOT, "docs", "pits.md"), encoding="utf-8") as file:
            page = file.read()
        (command,) = re.findall(r"^```\n(ogr2ogr .*?)^```$", page, re.M | re.S)
        with tempfile.TemporaryDirectory() as folder:
            study = [os.path.join(ROOT, "tools/scripts/studies/pit_study.py"), "--talus", TALUS, "--work", folder, "--cells", "0.25", "--directions", "0"]
            done = subprocess.run(study, capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            for line in done.stdout.splitlines():
                self.assertIn(line + "\n", page)
            kept = subprocess.run(["bash", "-c", command], cwd=os.path.join(folder, "0.25-0-plain"), capture_output=True, text=True, check=True).stdout
            self.assertIn("".join(f"    {line}\n" for line in kept.splitlines()), page)

    def test_read_maps(self):
        self.run_page("read-maps.md")


if __name__ == "__main__":
    unittest.main()
