"""A small mountain side to try the program on, and ways to call it. TALUS is the path of the program."""
import csv
import hashlib
import json
import os
import shutil
import signal
import socket
import sqlite3
import struct
import subprocess
import tempfile
import threading
import unittest

import numpy as np
from osgeo import gdal, ogr, osr

gdal.UseExceptions()
ogr.UseExceptions()

TALUS = os.environ.get("TALUS", "talus")
WEST, NORTH = 2600000.0, 1200300.0  # EPSG:2056


def system(code):
    srs = osr.SpatialReference()
    srs.ImportFromEPSG(code)
    srs.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    return srs


def heights(columns=60, rows=60, cell=5.0):
    """A slope of 35 degrees that faces south, above a flat floor, with small bumps."""
    y = (rows - 0.5 - np.arange(rows))[:, None] * cell
    x = (np.arange(columns) + 0.5)[None, :] * cell
    z = 1000.0 + np.maximum(0.0, y - 100.0) * 0.7 + 0.3 * np.sin(x / 7.0) * np.cos(y / 5.0)
    return z.astype(np.float32)


def write_dem(path, z, cell=5.0, code=2056, transform=None, nodata=None):
    dem = gdal.GetDriverByName("GTiff").Create(path, z.shape[1], z.shape[0], 1, gdal.GDT_Float32)
    dem.SetGeoTransform(transform or (WEST, cell, 0.0, NORTH, 0.0, -cell))
    if code:
        dem.SetProjection(system(code).ExportToWkt())
    if nodata is not None:
        dem.GetRasterBand(1).SetNoDataValue(nodata)
    dem.GetRasterBand(1).WriteArray(z)
    dem.FlushCache()


def write_features(path, layer_name, shapes, fields=()):
    """shapes: (WKT, values of the fields)."""
    file = ogr.GetDriverByName("GPKG").CreateDataSource(path)
    layer = file.CreateLayer(layer_name, system(2056), ogr.wkbUnknown)
    for name, kind in fields:
        layer.CreateField(ogr.FieldDefn(name, kind))
    for wkt, values in shapes:
        feature = ogr.Feature(layer.GetLayerDefn())
        feature.SetGeometry(ogr.CreateGeometryFromWkt(wkt))
        for i, value in enumerate(values):
            feature.SetField(i, value)
        layer.CreateFeature(feature)
    file = None


def box(x, y, width, height):
    """A rectangle as WKT, metres from the lower left corner of the standard DEM."""
    left, low = WEST + x, NORTH - 300.0 + y
    right, high = left + width, low + height
    return f"POLYGON (({left} {low},{right} {low},{right} {high},{left} {high},{left} {low}))"


def rows_of(path, layer_name):
    file = ogr.Open(path)
    layer = file.GetLayerByName(layer_name)
    return [(f.items(), f.GetGeometryRef().Clone()) for f in layer]


def edited_by_a_viewer(path):
    """A connection that has written into a GeoPackage; what it wrote is in the log beside the file (NAME-wal) until it is
    closed."""
    viewer = sqlite3.connect(path)
    viewer.execute("pragma journal_mode = wal")
    viewer.execute("update gpkg_contents set description = ?", ("x" * 150_000,))
    viewer.commit()
    return viewer


def log_left_by_a_viewer(path):
    """Writes into a GeoPackage as a viewer that is killed before its log has come into the file."""
    viewer = edited_by_a_viewer(path)
    for end in ("", "-wal"):
        shutil.copy(path + end, path + end + ".kept")
    viewer.close()
    for end in ("", "-wal"):
        os.replace(path + end + ".kept", path + end)


def sqlite_rows(path, command):
    """Rows of a GeoPackage as any viewer reads them: with the log that lies beside it."""
    reader = sqlite3.connect(path)
    try:
        return reader.execute(command).fetchall()
    finally:
        reader.close()


def band_names(path):
    file = gdal.Open(path)
    return [file.GetRasterBand(i + 1).GetDescription() for i in range(file.RasterCount)]


def bands_of(path):
    return gdal.Open(path).ReadAsArray()


class Program:
    """The program, loaded once: each call is a fork of it (program_server.cpp)."""
    of_thread = threading.local()

    @classmethod
    def of_this_thread(cls):
        """None where no server was built, or the environment is no longer that of its start."""
        if "TALUS_SERVER" not in os.environ:
            return None
        if not hasattr(cls.of_thread, "program"):
            cls.of_thread.program = cls()
        return cls.of_thread.program if cls.of_thread.program.environment == dict(os.environ) else None

    def __init__(self):
        self.environment = dict(os.environ)
        self.socket, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with theirs:
            self.process = subprocess.Popen([TALUS], pass_fds=[theirs.fileno()], env={
                **self.environment, "LD_PRELOAD": os.environ["TALUS_SERVER"], "TALUS_SERVER": str(theirs.fileno())})

    def __del__(self):
        self.end()

    def end(self):
        self.socket.close()
        self.process.kill()
        self.process.wait()

    def number(self):
        answer = self.socket.recv(4)
        if len(answer) != 4:
            raise RuntimeError("the server of the program has ended")
        return struct.unpack("i", answer)[0]

    def call(self, arguments, timeout, cwd=None):
        with tempfile.TemporaryFile("w+", encoding="utf-8") as out, tempfile.TemporaryFile("w+", encoding="utf-8") as err:
            words = b"".join(os.fsencode(word) + b"\0" for word in (cwd or os.getcwd(), *arguments))
            socket.send_fds(self.socket, [words], [out.fileno(), err.fileno()])
            self.socket.settimeout(timeout)
            child = None
            try:
                child = self.number()
                status = self.number()
            except BaseException as error:  # what it still has to say must not be taken for its next answer
                if child is not None:
                    os.kill(child, signal.SIGKILL)
                del Program.of_thread.program
                self.end()
                if isinstance(error, TimeoutError):
                    raise subprocess.TimeoutExpired([TALUS, *arguments], timeout) from None
                raise
            out.seek(0), err.seek(0)
            return subprocess.CompletedProcess([TALUS, *arguments], os.waitstatus_to_exitcode(status), out.read(), err.read())


class Case(unittest.TestCase):
    """A fresh folder with dem.tif and sources.gpkg for every test."""

    def setUp(self):
        self.folder = self.new_folder()
        self.addCleanup(shutil.rmtree, self.folder, True)
        write_dem(self.path("dem.tif"), heights())
        write_features(self.path("sources.gpkg"), "sources", [(box(140, 230, 20, 10), ["cliff, east"])],
                       [("name", ogr.OFTString)])

    def new_folder(self):
        return tempfile.mkdtemp(prefix="talus-test-")

    def path(self, name):
        return os.path.join(self.folder, name)

    def read_text(self, name):
        with open(self.path(name), encoding="utf-8") as file:
            return file.read()

    def write_table(self, name, head, rows):
        """A CSV file; head: the names of the columns, with commas between."""
        with open(self.path(name), "w", encoding="utf-8", newline="") as file:
            csv.writer(file).writerows([head.split(","), *rows])

    def read_json(self, name):
        return json.loads(self.read_text(name))

    def read_table(self, name):
        """Rows of a CSV file, by the names of the columns."""
        with open(self.path(name), encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def record(self, out="out"):
        return self.read_json(out + "/run.json")

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.path(name)

    def arguments(self, out="out", diameter="0.8", trajectories="50"):
        return ["run", "--dem", self.path("dem.tif"), "--sources", self.path("sources.gpkg"), "--diameter", diameter,
                "--trajectories", trajectories, "-o", self.path(out)]

    def call(self, *arguments, **options):
        options.setdefault("timeout", 120)
        program = Program.of_this_thread() if set(options) <= {"timeout", "cwd"} else None
        if program is not None:
            return program.call(arguments, **options)
        return subprocess.run([TALUS, *arguments], capture_output=True, text=True, check=False, **options)

    def run_well(self, *arguments, **options):
        done = self.call(*arguments, **options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def fails(self, code, *words, arguments, **options):
        """The program ends with `code` and one line on stderr, beside warnings and notes, that holds the words; nothing on
        stdout."""
        done = self.call(*arguments, **options)
        self.assertEqual(done.returncode, code, done.stderr)
        notes = ("talus: warning: ", "talus: note: ", ": fields read: ", ": no field is read", " is not read")
        errors = [line for line in done.stderr.splitlines()
                  if line.startswith("talus: error: ") or not any(note in line for note in notes)]
        self.assertEqual(len(errors), 1, done.stderr)
        self.assertTrue(errors[0].startswith("talus: error: "), errors)
        for word in words:
            self.assertIn(word, errors[0])
        self.assertEqual(done.stdout, "")
        return done

    def assert_nothing_left(self, before):
        self.assertEqual(sorted(os.listdir(self.folder)), sorted(before))


class OneThread:
    """Before Case or RunCase: runs, hazard maps and merges by one thread, which costs least, where a test does not say
    how many. That the results do not hang on their number is tested by tests that say it."""

    def run_well(self, *arguments, **options):
        if arguments[0] in ("run", "hazard", "merge") and "--threads" not in arguments:
            arguments = (*arguments, "--threads", "1")
        return super().run_well(*arguments, **options)


class KeptRuns:
    """Before Case or RunCase: a result that several tests of a module begin with is made once, and each has a copy that
    it may change. The folders of the tests have one name, one after the other: results hold the paths of inputs."""
    place, store, results = None, None, {}

    def new_folder(self):
        gdal.SetConfigOption("OGR_CURRENT_DATE", "2024-01-01T00:00:00.000Z")  # else no GeoPackage is the same again
        self.addCleanup(gdal.SetConfigOption, "OGR_CURRENT_DATE", None)
        if KeptRuns.place is None or os.path.exists(KeptRuns.place):  # a program that was killed wrote there until now
            KeptRuns.place = super().new_folder()
        else:
            os.mkdir(KeptRuns.place, 0o700)
        return KeptRuns.place

    def digests(self, without=None):
        """Of all files in the folder of the test, but for those of one result."""
        found = {}
        for folder, _, names in os.walk(self.folder):
            for name in names:
                file = os.path.relpath(os.path.join(folder, name), self.folder)
                if file.split(os.sep)[0] != without:
                    with open(self.path(file), "rb") as content:
                        found[file] = hashlib.sha256(content.read()).hexdigest()
        return found

    def keep(self, out, *commands):
        """Runs the commands, which write the folder `out` and nothing else. Where an earlier test has run them and
        every file in its folder was the same, bit by bit, and had the same path, the results are copied."""
        key = json.dumps([self.folder, out, commands, self.digests()], sort_keys=True)
        if key in KeptRuns.results:
            shutil.rmtree(self.path(out), True)
            shutil.copytree(KeptRuns.results[key], self.path(out))
            return
        before = self.digests(without=out)
        for command in commands:
            self.run_well(*command)
        self.assertEqual(self.digests(without=out), before, "the commands have written beside their folder")
        KeptRuns.store = KeptRuns.store or tempfile.TemporaryDirectory(prefix="talus-kept-")
        KeptRuns.results[key] = os.path.join(KeptRuns.store.name, str(len(KeptRuns.results)))
        shutil.copytree(self.path(out), KeptRuns.results[key])

    def keep_scenario(self, out, *more):
        """Of the scenario s.toml; first in a test, before its folder holds what is not in those of the others."""
        self.keep(out, ["run", self.path("s.toml"), "-o", self.path(out), "-q", *more])


# A run with all kinds of results.
RUN = """dem = "dem.tif"
trajectories = 40
[sources]
file = "sources.gpkg"
[blocks]
diameter = [0.6, 1.2]
[screens]
file = "screens.gpkg"
[barriers]
file = "nets.gpkg"
[output]
trajectories = 50
energy_total = true
bounds = true
"""
OPEN_RUN = RUN.replace('[barriers]\nfile = "nets.gpkg"\n', "")  # without barriers: traced in lanes, if the processor has some


class RunCase(Case):
    """Runs the scenario RUN, s.toml, and compares two runs."""

    def setUp(self):
        super().setUp()
        write_features(self.path("sources.gpkg"), "sources",
                       [(box(100, 230, 30, 15), ["west", 0.5]), (box(200, 230, 20, 10), ["east", 0.02])],
                       [("name", ogr.OFTString), ("frequency", ogr.OFTReal)])
        line = "LINESTRING (2600000 {0},2600300 {0})"
        write_features(self.path("screens.gpkg"), "screens", [(line.format(1200100), ["road"])], [("id", ogr.OFTString)])
        write_features(self.path("nets.gpkg"), "nets", [(line.format(1200090), ["net", 1.0, 100.0])],
                       [("id", ogr.OFTString), ("height", ogr.OFTReal), ("capacity", ogr.OFTReal)])
        self.write("s.toml", RUN)

    def wait_for_progress(self, process, percent):
        """Waits until a program with --progress=machine has reported `percent` or more: on a busy machine it skips lines."""
        self.addCleanup(process.kill)
        said = []
        for line in iter(process.stderr.readline, ""):
            said.append(line)
            if line.startswith("progress ") and int(line.split()[1]) >= percent:
                return
        self.fail("".join(said))

    def run_scenario(self, out, *more):
        return self.run_well("run", self.path("s.toml"), "-o", self.path(out), "-q", *more)

    def hashes(self, out):
        hashes = {}
        for name in sorted(os.listdir(self.path(out))):
            if name != "run.json":
                with open(self.path(f"{out}/{name}"), "rb") as result:
                    content = result.read()
                if name == "talus.qgs":  # it has the ways from the folder to these inputs
                    for file in ("dem.tif", "sources.gpkg", "nets.gpkg"):
                        content = content.replace(os.path.relpath(self.path(file), self.path(out)).encode(), file.encode())
                hashes[name] = hashlib.sha256(content).hexdigest()
        return hashes

    def assert_same(self, one, other, without=()):
        self.maxDiff = None
        files = [{name: value for name, value in self.hashes(out).items() if name not in without} for out in (one, other)]
        self.assertEqual(*files)
        left, right = self.record(one), self.record(other)
        for key in ("released", "ends", "trajectory_metres", "impacts", "cells_scored", "touched_cells", "steep_gullies", "files"):
            self.assertEqual(left[key], right[key], key)
        self.assertEqual(left.get("barriers"), right.get("barriers"))  # of runs with some

    def unfinished(self, out):
        return [name for name in os.listdir(self.folder) if name.startswith(f".{out}.talus-")]
