"""Results of a run: the same bits for any number of threads, sums that add up, paths that can be replayed."""
import csv
import hashlib
import os
import pty
import shlex
import subprocess
import unittest

import numpy as np
from osgeo import ogr
from osgeo_utils.samples.validate_cloud_optimized_geotiff import validate

from support import NORTH, TALUS, WEST, Case, bands_of, rows_of, write_features

CHANGING = ["command", "folder", "threads", "cpu_seconds", "wall_seconds", "peak_memory_mb"]  # of run.json


def digests(folder, but=("run.json",)):
    result = {}
    for name in sorted(os.listdir(folder)):
        if name not in but:
            with open(os.path.join(folder, name), "rb") as file:
                result[name] = hashlib.sha256(file.read()).hexdigest()
    return result


class Results(Case):
    def test_equal_bytes_for_any_number_of_threads_and_from_its_own_scenario(self):
        self.run_well(*self.arguments("one"), "--threads", "1")
        first, record = digests(self.path("one")), self.record("one")
        self.assertEqual(len([name for name in first if name.endswith(".tif")]), 15)
        for key in CHANGING:
            record.pop(key)
        for threads in ("2", "7"):
            self.run_well(*self.arguments(threads), "--threads", threads)
            self.assertEqual(digests(self.path(threads)), first)
            other = self.record(threads)
            for key in CHANGING:
                other.pop(key)
            self.assertEqual(other, record)
        self.run_well("run", self.path("one/scenario.toml"), "-o", self.path("again"))
        self.assertEqual(digests(self.path("again")), first)

    def test_another_seed_gives_other_paths(self):
        self.run_well(*self.arguments("a"))
        self.run_well(*self.arguments("b"), "--seed", "2")
        self.assertNotEqual(digests(self.path("a"))["passages.tif"], digests(self.path("b"))["passages.tif"])

    def test_counts_add_up(self):
        self.run_well(*self.arguments())
        record, stops = self.record(), rows_of(self.path("out/stops.gpkg"), "stops")
        self.assertEqual(record["released"], 8 * 50)
        self.assertEqual(sum(record["ends"].values()), record["released"])
        self.assertEqual([(s["source"], s["block"]) for s, _ in stops], [(i // 50, i % 50) for i in range(400)])
        for end, count in record["ends"].items():
            self.assertEqual(sum(s["end"] == end for s, _ in stops), count)
        self.assertEqual(sum(s["impacts"] for s, _ in stops), record["impacts"])
        self.assertAlmostEqual(sum(s["length_m"] for s, _ in stops), record["trajectory_metres"], delta=0.3)
        ends = record["ends"]
        self.assertEqual(list(ends), ["stopped", "trapped", "left", "caught", "limit"])
        self.assertEqual(bands_of(self.path("out/deposits.tif")).sum(), ends["stopped"] + ends["trapped"] + ends["caught"])
        self.assertEqual(bands_of(self.path("out/trapped.tif")).sum(), ends["trapped"])
        self.assertEqual(bands_of(self.path("out/exits.tif")).sum(), ends["left"])
        self.assertEqual(bands_of(self.path("out/impacts.tif")).sum(), record["impacts"])
        passages = bands_of(self.path("out/passages.tif"))
        self.assertEqual(passages.sum(), record["cells_scored"])
        self.assertEqual((passages > 0).sum(), record["touched_cells"])
        probability = bands_of(self.path("out/impact_probability.tif"))
        np.testing.assert_allclose(probability[0], passages / 400, rtol=1e-6)
        self.assertTrue(((probability[1] <= probability[0]) & (probability[0] <= probability[2])).all())
        self.assertEqual(bands_of(self.path("out/sources.tif")).max(), 8)
        density = bands_of(self.path("out/passage_density.tif")).astype(float)
        np.testing.assert_allclose(density[0].sum() * 25 * 400, record["trajectory_metres_plan"], rtol=1e-4)
        self.assertTrue(((density[1] <= density[0]) & (density[0] <= density[2])).all())
        self.assertTrue(((density[4] <= density[3]) & (density[3] <= density[0] * (1 + 1e-6))).all(), "30 and 300 kJ")
        self.assertTrue(((density[0] > 0) == (passages > 0)).all())

    def test_stops_lie_where_the_deposits_are(self):
        self.run_well(*self.arguments())
        counted = np.zeros((60, 60), np.uint32)
        for stop, point in rows_of(self.path("out/stops.gpkg"), "stops"):
            self.assertEqual(stop["feature"], "cliff, east")
            self.assertTrue(0 <= stop["x_release"] - WEST - 140 <= 20 and 0 <= stop["y_release"] - NORTH + 70 <= 10)
            if stop["end"] in ("stopped", "trapped"):
                counted[int((NORTH - point.GetY()) // 5), int((point.GetX() - WEST) // 5)] += 1
        np.testing.assert_array_equal(bands_of(self.path("out/deposits.tif")), counted)

    def test_spatial_index_finds_what_a_scan_finds(self):
        self.run_well(*self.arguments())
        stops = [point for _, point in rows_of(self.path("out/stops.gpkg"), "stops")]
        file = ogr.Open(self.path("out/stops.gpkg"))
        result = file.ExecuteSQL("SELECT rtreecheck('rtree_stops_geom')")
        self.assertEqual(result.GetNextFeature().GetField(0), "ok")
        file.ReleaseResultSet(result)
        layer = file.GetLayer()
        for x, y, size in ((150, 60, 20), (0, 0, 300), (140, 100, 3)):
            low = (WEST + x, NORTH - 300 + y)
            layer.SetSpatialFilterRect(low[0], low[1], low[0] + size, low[1] + size)
            inside = [p for p in stops if 0 <= p.GetX() - low[0] <= size and 0 <= p.GetY() - low[1] <= size]
            self.assertEqual(sum(1 for _ in layer), len(inside))

    def test_rasters_are_cloud_optimized_and_have_styles(self):
        self.run_well(*self.arguments())
        names = [name for name in os.listdir(self.path("out")) if name.endswith(".tif")]
        for name in names:
            _, errors, _ = validate(self.path("out/" + name), full_check=True)
            self.assertEqual(errors, [])
            self.assertTrue(os.path.exists(self.path("out/" + name.replace(".tif", ".qml"))))

    def test_record(self):
        self.run_well(*self.arguments())
        record = self.record()
        for item in record["inputs"]:
            with open(item["path"], "rb") as file:
                self.assertEqual(hashlib.sha256(file.read()).hexdigest(), item["sha256"])
        self.assertEqual({item["role"] for item in record["inputs"]}, {"dem", "sources"})
        settings = {s["key"]: s for s in record["settings"]}
        self.assertEqual(settings["blocks.diameter"]["source"], "flag --diameter")
        self.assertEqual(record["deformation_coefficient"], 0.25)
        self.assertEqual(sorted(record["files"] + ["run.json"]), sorted(os.listdir(self.path("out"))))
        for clock in ("cpu_seconds", "wall_seconds"):
            self.assertEqual(list(record[clock]), ["read", "simulate", "write"])
            self.assertTrue(all(value >= 0 for value in record[clock].values()))
        self.assertTrue(5 < record["peak_memory_mb"] < 2000)


class Replay(Case):
    def trace(self, source, block, out="out"):
        text = self.run_well("trace", self.path(out + "/scenario.toml"), "--source", str(source), "--block", str(block)).stdout
        return list(csv.DictReader(text.splitlines()))

    def test_trace_ends_where_the_run_did(self):
        self.run_well(*self.arguments())
        stops = rows_of(self.path("out/stops.gpkg"), "stops")
        for i in (0, 123, 399):
            stop, point = stops[i]
            path = self.trace(stop["source"], stop["block"])
            last = path[-1]
            self.assertEqual((float(last["x"]), float(last["y"]), float(last["z"])), (point.GetX(), point.GetY(), stop["z"]))
            self.assertEqual((path[0]["event"], last["event"]), ("release", stop["end"]))
            self.assertEqual(sum(row["event"] == "impact" for row in path), stop["impacts"])
            self.assertAlmostEqual(float(last["time"]), stop["seconds"], delta=1e-3)

    def test_trace_into_a_geopackage(self):
        self.run_well(*self.arguments())
        path = self.trace(1, 2)
        call = ["trace", self.path("out/scenario.toml"), "--source", "1", "--block", "2", "-o", self.path("path.gpkg")]
        self.run_well(*call)
        vertices = rows_of(self.path("path.gpkg"), "vertices")
        self.assertEqual([v["event"] for v, _ in vertices], [row["event"] for row in path])
        self.assertEqual([p.GetM() for _, p in vertices], [float(row["time"]) for row in path])
        (_, line), = rows_of(self.path("path.gpkg"), "trajectories")
        self.assertEqual(line.GetPoint(line.GetPointCount() - 1)[:2], (float(path[-1]["x"]), float(path[-1]["y"])))
        self.fails(2, "path.gpkg", "there already", arguments=call)

    def test_numbers_out_of_range(self):
        self.run_well(*self.arguments())
        scenario = self.path("out/scenario.toml")
        self.fails(2, "--source", "8", "0 to 7", arguments=["trace", scenario, "--source", "8", "--block", "0"])
        self.fails(2, "--block", "50", "0 to 49", arguments=["trace", scenario, "--source", "0", "--block", "50"])

    def test_recorded_paths(self):
        self.run_well(*self.arguments())
        stops = {(s["source"], s["block"]): (s, p) for s, p in rows_of(self.path("out/stops.gpkg"), "stops")}
        paths = rows_of(self.path("out/trajectories.gpkg"), "trajectories")
        self.assertEqual(len(paths), 400)  # fewer than 500: all
        for path, line in paths[::40]:
            stop, point = stops[path["source"], path["block"]]
            self.assertEqual(line.GetGeometryType(), ogr.wkbLineStringZM)
            n = line.GetPointCount()
            self.assertEqual((line.GetX(n - 1), line.GetY(n - 1), line.GetZ(n - 1)), (point.GetX(), point.GetY(), stop["z"]))
            times = [line.GetM(i) for i in range(n)]
            self.assertEqual(times, sorted(times))

    def test_too_many_limits_fail_after_writing(self):
        scenario = self.write("s.toml", 'dem = "dem.tif"\ntrajectories = 20\n[sources]\nfile = "sources.gpkg"\n[blocks]\n'
                                        'diameter = 0.8\n[model]\nimpact_limit = 10\n')
        done = self.call("run", scenario, "-o", self.path("out"), "-q")
        self.assertEqual(done.returncode, 1)
        line, = done.stderr.splitlines()
        record = self.record()
        self.assertGreater(record["ends"]["limit"], 0)
        self.assertNotEqual(record["status"], "complete")
        replay = shlex.split(line[line.index("talus trace") + 6:])
        rows = self.run_well(*replay).stdout.splitlines()
        self.assertTrue(rows[-1].endswith(",limit"), rows[-1])


class Screens(Case):
    def test_crossings(self):
        y = NORTH - 300 + 150  # a line across the slope
        write_features(self.path("screens.gpkg"), "screens", [(f"LINESTRING ({WEST} {y},{WEST + 300} {y})", ['road "A", km 3'])],
                       [("id", ogr.OFTString)])
        scenario = self.write("s.toml", 'dem = "dem.tif"\ntrajectories = 20\n[sources]\nfile = "sources.gpkg"\n[blocks]\n'
                                        'diameter = 0.8\n[screens]\nfile = "screens.gpkg"\n')
        self.run_well("run", scenario, "-o", self.path("out"))
        with open(self.path("out/screens.csv"), newline="", encoding="utf-8") as file:
            header = file.readline()
            file.seek(0)
            rows = list(csv.DictReader(file))
        self.assertEqual(header, "source,block,screen,speed_ms,energy_kj,total_energy_kj,jump_height_m,"
                                 "angular_velocity_rads,mass_kg,x,y\n")  # INTERFACE.md; no block breaks: no piece
        self.assertGreaterEqual(len(rows), 100)
        mass = 2700 * np.pi / 6 * 0.8**3
        for row in rows:
            self.assertEqual(row.pop("screen"), 'road "A", km 3')
            v = {key: float(value) for key, value in row.items()}
            self.assertAlmostEqual(v["mass_kg"] / mass, 1.0, delta=1e-5)
            self.assertAlmostEqual(v["y"], y, delta=1e-3)
            energy = 0.5e-3 * mass * v["speed_ms"] ** 2
            spin = 0.5e-3 * 0.4 * mass * 0.4**2 * v["angular_velocity_rads"] ** 2
            self.assertAlmostEqual(v["energy_kj"], energy, delta=2e-5 * energy)
            self.assertAlmostEqual(v["total_energy_kj"], energy + spin, delta=2e-5 * (energy + spin))


class ProgressLines(Case):
    def test_machine(self):
        lines = self.run_well(*self.arguments(), "--progress=machine", "-q").stderr.splitlines()
        numbers = [int(line.removeprefix("progress ")) for line in lines]
        self.assertEqual((numbers[0], numbers[-1], numbers), (0, 100, sorted(set(numbers))))

    def test_quiet_and_summary(self):
        self.assertEqual(self.run_well(*self.arguments("a"), "-q").stderr, "")
        text = self.run_well(*self.arguments("b")).stderr
        self.assertIn("400 trajectories from 8 source cells", text)
        self.assertIn(self.path("b"), text)

    def test_terminal(self):
        master, slave = pty.openpty()
        with subprocess.Popen([TALUS, *self.arguments(trajectories="5000")], stderr=slave) as process:
            os.close(slave)
            text = b""
            try:
                while part := os.read(master, 4096):
                    text += part
            except OSError:  # the other side is closed
                pass
            self.assertEqual(process.wait(), 0)
        os.close(master)
        self.assertRegex(text.decode(), r"\r\x1b\[K\d+ %, [\d ]+ trajectories/s, .* left")


if __name__ == "__main__":
    unittest.main()
