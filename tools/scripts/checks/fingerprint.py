#!/usr/bin/env python3
"""Did a change of the program change a byte of its results? Checksums of every output, to compare with those of before.

  tools/scripts/checks/fingerprint.py --talus build/release/talus --mpi build/release/talus-mpi -o after.txt [--against before.txt]

It runs the example valley (run, hazard with objects, barrier, sources, trace, effects, barriers), the profile, `gar` with 5
trajectories a source cell, calibrate, diagnose on elm and tschamut with few trials, two parts with merge, and two ranks. Time,
memory, and the path and version of the program are left out of JSON records. Minutes; --quick leaves out gar and tschamut, and
--brief, for slow programs, runs only the valley with few trajectories and the profile (same_bytes.sh uses it).
Exit code 1 where a checksum differs from --against.
"""
import argparse
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../.."))
VOLATILE = {"plan", "cpu_seconds", "wall_seconds", "peak_memory_mb", "command", "version", "ranks", "threads", "lanes", "date", "started", "seconds", "times"}
MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_btl_base_warn_component_unused": "0"}

EFFECTS = """
[effects.vegetation-drag]
zones = ["meadow"]
coefficient = 400
height = 8
[effects.air-drag]
coefficient = 0.8
[effects.block-shape]
lateral = 0.4
loss = 0.1
elongation = 0.3
[effects.block-mass]
roughness = 0.5
stiffness = 0.5
[effects.wet-ground]
softening = 0.4
drag = 0.3
days = [3]
zones = ["talus", "meadow"]
[effects.soft-ground]
drag = 2
zones = ["meadow"]
[effects.rolling-resistance]
coefficient = 0.4
zones = ["meadow", "road"]
[effects.fragmentation]
threshold = 80
zones = ["cliff"]
"""
STEMS = """
[effects.forest-stems]
density = 300
zones = ["talus"]
"""


def without_volatile(value):
    if isinstance(value, dict):
        if value.get("path", "").endswith("scenario.toml") and "FOLDER" in value["path"]:
            return {"path": value["path"]}  # its checksum also depends on the name of the temporary folder
        return {k: without_volatile(v) for k, v in value.items() if k not in VOLATILE}
    return [without_volatile(v) for v in value] if isinstance(value, list) else value


def checksum(path, folder):
    """Checksum of a file, without the name of the temporary folder."""
    with open(path, "rb") as file:
        data = file.read().replace(folder.encode(), b"FOLDER")
    if path.endswith("report.html"):
        data = re.sub(rb", \d+ s\.</p>", b"</p>", data)  # how long it took
    if path.endswith(".json"):
        record = without_volatile(json.loads(data))
        if path.endswith("part.json"):  # checksums of what is left out
            record = {key: record[key] for key in ("part", "of", "rounds", "rounds_done", "units_done", "settings")}
        data = json.dumps(record, sort_keys=True).encode()
    return hashlib.sha256(data).hexdigest()


class Outputs:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder

    def call(self, *arguments, program=None, keep=None, code=0):
        """Runs the program in the folder; what it prints becomes the file `keep`."""
        done = subprocess.run([*(program or [self.options.talus]), *arguments], cwd=self.folder, text=True, check=False,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, env={**os.environ, **MPI})
        if done.returncode != code:
            sys.exit(f"fingerprint.py: {' '.join(arguments)}: exit code {done.returncode}\n{done.stderr}")
        if keep:
            with open(os.path.join(self.folder, keep), "w", encoding="utf-8") as file:
                file.write(done.stdout)

    def append(self, source, target, text, change=("", "")):
        with open(os.path.join(self.folder, source), encoding="utf-8") as file:
            scenario = file.read().replace(*change) if change[0] else file.read()
        with open(os.path.join(self.folder, target), "w", encoding="utf-8") as file:
            file.write(scenario + text)

    def valley(self):
        self.call("presets", keep="presets.txt")
        fewer = ("--trajectories", "3") if self.options.brief else ()
        self.call("run", "data/valley/scenario.toml", "-o", "valley", "-q", "--threads", "2", *fewer)
        self.call("trace", "valley/scenario.toml", "--source", "100", "--block", "2" if self.options.brief else "7", "-o", "path.gpkg", keep="trace.txt")
        self.call("barrier", "valley", "--screen", "road", keep="barrier.txt")
        self.call("sources", "--dem", "data/valley/dem.tif", "-o", "cells.gpkg", "--slope", "48", keep="sources.txt")
        self.call("profile", "data/profile/profile.toml", "-o", "profile", "-q")
        few = ("trajectories = 50 ", f"trajectories = {2 if self.options.brief else 10} ")
        self.call("hazard", "valley", "--objects", "data/valley/houses.gpkg", "-q")
        self.append("data/valley/scenario.toml", "data/valley/effects.toml", EFFECTS, few)
        self.append("data/valley/effects.toml", "data/valley/wet.toml", "", ("seed = 1 ", "day = 3\nseed = 1 "))
        self.append("data/valley/scenario.toml", "data/valley/stems.toml", STEMS, few)
        self.nets(few)
        for name in ("effects", "stems", "netseffects") if self.options.brief else ("effects", "wet", "stems", "nets", "netseffects"):
            self.call("run", f"data/valley/{name}.toml", "-o", name, "-q")

    def nets(self, few):
        with open(os.path.join(self.folder, "data/valley/nets.csv"), "w", encoding="utf-8") as file:
            file.write("id,height,capacity,WKT\n")
            screens = subprocess.run(["ogrinfo", "-q", "-al", os.path.join(self.folder, "data/valley/screens.gpkg")],
                                     capture_output=True, text=True, check=True).stdout
            line = next(row.strip() for row in screens.splitlines() if "LINESTRING" in row)
            file.write(f'net,2,200,"{line}"\n')
        barriers = '\n[barriers]\nfile = "nets.csv"\n'
        self.append("data/valley/scenario.toml", "data/valley/nets.toml", barriers, few)
        self.append("data/valley/effects.toml", "data/valley/netseffects.toml", barriers)

    def parts_rounds_ranks(self):
        scenario = ["data/valley/nets.toml", "-q"]
        for part in ("1/2", "2/2"):
            self.call("run", *scenario, "-o", f"part{part[0]}", "--part", part)
        self.call("merge", "merged", "part2", "part1", "-q")
        self.call("run", *scenario, "-o", "rounds", "--rounds", "2", "--memory", "250M", "--threads", "1")
        if self.options.mpi:
            mpirun = ["mpirun", "--oversubscribe", "-n", "2", self.options.mpi]
            self.call("run", *scenario, "-o", "ranks", program=mpirun)

    def measured(self):
        self.call("calibrate", "data/elm/campaign.toml", "-o", "fit", "-q", "--trials", "20", "--threads", "2")
        self.call("score", "data/elm/campaign.toml", "--parameters", "fit/fitted.toml", keep="score.txt")
        self.call("diagnose", "data/elm/campaign.toml", "-o", "elm", "-q", "--trials", "20", "--test-trials", "20", "--base-fits", "2")
        if not self.options.quick:
            self.call("diagnose", "shared/campaigns/tschamut/campaign.toml", "-o", "tschamut", "-q", "--trials", "20", "--test-trials", "20", "--base-fits", "2")

    def gar(self):
        terrain = "shared/terrain/"
        self.call("run", "--dem", terrain + "gar.tif", "--sources", terrain + "gar_cliffs.shp", "--trajectories", "5", "-o", "gar", "-q")
        self.call("hazard", "gar", "-q")

    def make(self):
        self.valley()
        if self.options.brief:
            return
        self.parts_rounds_ranks()
        self.measured()
        if not self.options.quick:
            self.gar()

    def checksums(self):
        for name in ("data", "shared"):
            path = os.path.join(self.folder, name)
            os.unlink(path) if os.path.islink(path) else shutil.rmtree(path)
        found = {}
        for folder, _, names in os.walk(self.folder):
            for name in names:
                if name.endswith(".bin"):  # saved by a part; depends on the order in which its threads came
                    continue
                path = os.path.join(folder, name)
                found[os.path.relpath(path, self.folder)] = checksum(path, self.folder)
        return dict(sorted(found.items()))


def compare(before, after):
    different = [name for name in sorted(before.keys() | after.keys()) if before.get(name) != after.get(name)]
    for name in different:
        print(f"{'changed' if name in before and name in after else 'new' if name in after else 'gone'}: {name}")
    print(f"{len(after)} files, {len(different)} different")
    return 1 if different else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--talus", required=True)
    parser.add_argument("--mpi", help="talus-mpi; two ranks are left out without it")
    parser.add_argument("--data", default=os.environ.get("TALUS_DATA", os.path.join(ROOT, "../shared/data")))
    parser.add_argument("-o", "--out", required=True, help="file of the checksums")
    parser.add_argument("--against", help="checksums of before")
    parser.add_argument("--keep", help="folder that gets the outputs themselves")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--brief", action="store_true")
    options = parser.parse_args()
    options.talus = os.path.abspath(options.talus)
    options.mpi = options.mpi and os.path.abspath(options.mpi)
    with tempfile.TemporaryDirectory(prefix="talus-fingerprint-") as folder:
        shutil.copytree(os.path.join(ROOT, "data"), os.path.join(folder, "data"))
        os.symlink(os.path.abspath(options.data), os.path.join(folder, "shared"))
        outputs = Outputs(options, folder)
        outputs.make()
        after = outputs.checksums()
        if options.keep:
            shutil.copytree(folder, options.keep)
    with open(options.out, "w", encoding="utf-8") as file:
        file.writelines(f"{value}  {name}\n" for name, value in after.items())
    if not options.against:
        print(f"{len(after)} files")
        return 0
    with open(options.against, encoding="utf-8") as file:
        return compare({line[66:].rstrip("\n"): line[:64] for line in file}, after)


if __name__ == "__main__":
    sys.exit(main())
