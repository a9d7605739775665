"""How trajectories end: trapped between walls, out of the map; the maps, layers and warnings of it."""
import json
import os
import re
import unittest
import xml.etree.ElementTree as xml

import numpy as np
from osgeo import gdal, ogr

from support import NORTH, WEST, Case, bands_of, box, heights, rows_of, write_dem, write_features

EAST = (np.arange(60) + 0.5)[None, :] * 5.0  # of the cell centres, from the western edge [m]
UP = (59.5 - np.arange(60))[:, None] * 5.0    # of the cell centres, from the southern edge [m]


class Ends(Case):
    def dem(self, z):
        write_dem(self.path("dem.tif"), (z + 0.0 * EAST + 0.0 * UP).astype(np.float32))

    def sources(self, x, y, frequency=None):
        os.remove(self.path("sources.gpkg"))
        write_features(self.path("sources.gpkg"), "sources", [(box(x, y, 20, 10), ["cliff", frequency])],
                       [("name", ogr.OFTString), ("frequency", ogr.OFTReal)])

    def test_a_valley_between_steep_walls_traps_every_block(self):
        self.dem(1000.0 + 0.75 * np.abs(UP - 147.5))  # tan(30 degrees) = 0.577; the floor is level
        self.sources(140, 200)
        done = self.run_well(*self.arguments())
        ends = self.record()["ends"]
        self.assertEqual(ends, {"stopped": 0, "trapped": 400, "left": 0, "caught": 0, "limit": 0})
        self.assertIn("0 stopped, 400 trapped, 0 left the map", done.stderr)
        self.assertIn("100 % of the trajectories (400) were trapped in pits or between walls", done.stderr)
        self.assertEqual({stop["end"] for stop, _ in rows_of(self.path("out/stops.gpkg"), "stops")}, {"trapped"})
        trapped = bands_of(self.path("out/trapped.tif"))
        np.testing.assert_array_equal(trapped, bands_of(self.path("out/deposits.tif")))
        self.assertEqual(trapped.sum(), 400)
        self.assertEqual(trapped[28:33].sum(), 400)  # on the floor
        self.assertEqual(rows_of(self.path("out/exits.gpkg"), "exits"), [])
        check = self.run_well("check", "--dem", self.path("dem.tif"), "--sources", self.path("sources.gpkg"), "--diameter", "0.8")
        self.assertRegex(check.stdout, r"(?m)^warning +100 % of the sample \(\d+\) were trapped")

    def test_no_block_stays_on_a_steep_plane(self):
        self.dem(1000.0 + 1.0 * UP)
        self.sources(140, 230, frequency=0.4)
        done = self.run_well(*self.arguments())
        record = self.record()
        self.assertEqual(record["ends"], {"stopped": 0, "trapped": 0, "left": 400, "caught": 0, "limit": 0})
        self.assertIn("100 % of the trajectories (400) left the DEM or met missing data", done.stderr)
        exits = bands_of(self.path("out/exits.tif"))
        self.assertEqual(exits.sum(), 400)
        self.assertEqual(exits[-1].sum(), 400)  # the southern edge
        rows = rows_of(self.path("out/exits.gpkg"), "exits")
        stops = rows_of(self.path("out/stops.gpkg"), "stops")
        self.assertEqual(len(rows), 400)
        counted = np.zeros((60, 60), np.uint32)
        for (row, point), (stop, end) in zip(rows, stops):
            for key in ("source", "block", "feature", "diameter_m", "mass_kg", "z", "seconds"):
                self.assertEqual(row[key], stop[key])
            self.assertEqual((point.GetX(), point.GetY()), (end.GetX(), end.GetY()))
            self.assertAlmostEqual(point.GetY(), NORTH - 297.5, 6)  # the last row of centres: beyond is no terrain
            self.assertLess(row["speed_ms"], stop["max_speed_ms"] + 1e-3)
            self.assertAlmostEqual(row["energy_kj"], 0.5e-3 * row["mass_kg"] * row["speed_ms"] ** 2, delta=1e-3 * row["energy_kj"])
            counted[-1, int((point.GetX() - WEST) // 5)] += 1
        np.testing.assert_array_equal(exits, counted)

        done = self.run_well("hazard", self.path("out"))
        self.assertIn("0.4 of the 0.4 events per year (100 %) leave the DEM", done.stderr)
        self.assertAlmostEqual(self.read_json("out/hazard.json")["left_per_year"], 0.4, 9)
        hazard = gdal.Open(self.path("out/hazard_class.tif"))
        self.assertEqual(hazard.GetRasterBand(5).GetDescription(), "cut short")
        np.testing.assert_array_equal(hazard.GetRasterBand(5).ReadAsArray() == 1, exits > 0)
        self.assertIn("hazard_class_cut_short.qml", self.read_json("out/hazard.json")["files"])
        self.assert_cut_short_is_shown(exits > 0)
        again = self.write("again.toml", "[features]\ncliff = 0.1\n")  # other frequencies: traced again
        done = self.run_well("hazard", self.path("out"), "--overwrite", "--frequency", again)
        self.assertIn("0.1 of the 0.1 events per year (100 %) leave the DEM", done.stderr)

    def assert_cut_short_is_shown(self, cells):
        """By a layer of talus.qgs that is on, and over every map of the report: a square for each cell, whose middle is its own."""
        layer, = [layer for layer in xml.parse(self.path("out/talus.qgs")).getroot().iter("layer-tree-layer")
                  if layer.get("name") == "Hazard goes on beyond the map (cut short)"]
        self.assertEqual((layer.get("source"), layer.get("checked")), ("./hazard_class.tif", "Qt::Checked"))
        self.run_well("report", self.path("out"), "-q")
        page = self.read_text("out/report.html")
        self.assertIn(">paths leave the map here</text>", page)
        viewer = dict(re.findall(r'data-(\S+)="(\S+)"', re.search("id='viewer'[^>]*>", page).group(0)))
        path = re.search(r"<path id='cut-short' [^>]*d=\"([^\"]*)\"", page).group(1)
        found = np.zeros(cells.shape, int)
        for left, top, wide, high in re.findall(r"M(\S+) (\S+)h(\S+)v(\S+)h-\S+?z", path):
            x = float(viewer["west"]) + (float(left) + 0.5 * float(wide)) * int(viewer["columns"]) * 5.0 / float(viewer["width"])
            y = float(viewer["north"]) - (float(top) + 0.5 * float(high)) * int(viewer["rows"]) * 5.0 / float(viewer["height"])
            found[int((NORTH - y) // 5), int((x - WEST) // 5)] += 1
        np.testing.assert_array_equal(found, cells)
        os.remove(self.path("out/report.html"))

    def test_where_no_block_leaves_nothing_is_cut_short(self):
        self.dem(1000.0 + 0.75 * np.abs(UP - 147.5))
        self.sources(140, 200, frequency=0.4)
        self.run_well(*self.arguments())
        self.run_well("hazard", self.path("out"), "-q")
        self.assertNotIn("hazard_class_cut_short.qml", os.listdir(self.path("out")))
        self.assertNotIn("cut short", self.read_text("out/talus.qgs"))
        record = self.read_json("out/hazard.json")  # of an earlier command by whose frequencies some cell was marked
        self.write("out/hazard_class_cut_short.qml", "<qgis/>")
        self.write("out/hazard.json", json.dumps({**record, "files": record["files"] + ["hazard_class_cut_short.qml"]}))
        done = self.run_well("hazard", self.path("out"), "--overwrite")
        self.assertNotIn("removed", done.stderr)
        self.assertNotIn("hazard_class_cut_short.qml", os.listdir(self.path("out")))
        self.run_well("report", self.path("out"), "-q")
        self.assertNotIn("cut-short", self.read_text("out/report.html"))

    def test_a_piece_that_leaves_counts_for_its_block(self):
        """Near the eastern edge of a slope that faces south, with nothing that turns blocks: the largest piece of each stays
        on its line and stops on the floor below, and smaller ones leave. A screen 1 cm inside the rim of the terrain sees
        the pieces that leave."""
        self.dem(1000.0 + 1.2 * np.maximum(0.0, UP - 120.0))
        os.remove(self.path("sources.gpkg"))
        write_features(self.path("sources.gpkg"), "sources", [(box(275, 240, 5, 20), ["cliff", 0.4])],
                       [("name", ogr.OFTString), ("frequency", ogr.OFTReal)])
        west, east, south, north = WEST + 2.51, WEST + 297.49, NORTH - 297.49, NORTH - 2.51
        ring = ",".join(f"{x} {y}" for x, y in ((west, south), (east, south), (east, north), (west, north), (west, south)))
        write_features(self.path("rim.gpkg"), "rim", [(f"LINESTRING ({ring})", ["rim"])], [("id", ogr.OFTString)])
        scenario = self.write("s.toml", """dem = "dem.tif"
trajectories = 100
[sources]
file = "sources.gpkg"
[blocks]
diameter = 0.8
[ground.zones.default]
preset = "upper-talus-3d"
psi_scale = 0
[screens]
file = "rim.gpkg"
[effects.fragmentation]
threshold = 20
""")
        whole = self.run_well("run", scenario, "-o", self.path("whole"), "--threads", "2")
        record = self.record("whole")
        self.assertEqual((record["released"], record["ends"]["left"]), (400, 0))
        rows = self.read_table("whole/screens.csv")
        left = len({(row["source"], row["block"]) for row in rows})
        self.assertGreater(left, 10)
        self.assertGreater(len(rows), left)  # two pieces of some block: it counts once
        self.assertEqual(bands_of(self.path("whole/exits.tif")).sum(), len(rows))  # none comes back
        self.assertEqual((record["left_with_pieces"], record["limit_with_pieces"]), (left, 0))
        text = (f"{left / 4:.3g} % of the trajectories ({left}) left the DEM or met missing data: the maps do not show how far "
                f"they go; {left / 4:.3g} % left it with smaller pieces only (exits.tif of a run shows where): take a larger DEM, or "
                "fill gaps inside it")
        self.assertIn(text, record["warnings"])
        self.assertIn(text, whole.stderr)
        self.assertRegex(self.run_well("check", scenario).stdout, r"(?m)^warning .* left it with smaller pieces only")

        done = self.run_well("hazard", self.path("whole"))
        self.assertAlmostEqual(self.read_json("whole/hazard.json")["left_per_year"], 0.4 * left / 400, 9)
        self.assertIn("of the 0.4 events per year", done.stderr)
        self.run_well("report", self.path("whole"))
        self.assertIn(f"{left} of 400 blocks ({left / 4:.3g} %), {left} of them with smaller pieces only",
                      self.read_text("whole/report.html"))
        again = self.write("again.toml", "[features]\ncliff = 0.1\n")  # other frequencies: traced again
        self.run_well("hazard", self.path("whole"), "--overwrite", "--frequency", again)
        self.assertAlmostEqual(self.read_json("whole/hazard.json")["left_per_year"], 0.1 * left / 400, 9)

        for part in ("1/2", "2/2"):
            self.run_well("run", scenario, "-o", self.path("part" + part[0]), "--part", part, "--threads", "1")
        self.run_well("merge", self.path("merged"), self.path("part1"), self.path("part2"))
        self.assertEqual(self.record("merged")["left_with_pieces"], left)
        self.assertEqual(self.record("merged")["warnings"], record["warnings"])
        self.run_well("hazard", self.path("merged"))
        self.assertAlmostEqual(self.read_json("merged/hazard.json")["left_per_year"], 0.4 * left / 400, 9)

    def test_missing_data_is_an_exit(self):
        z = 1000.0 + 1.0 * UP + 0.0 * EAST
        z[30, 28:36] = -9999.0
        write_dem(self.path("dem.tif"), z.astype(np.float32), nodata=-9999.0)
        self.run_well(*self.arguments())
        exits = bands_of(self.path("out/exits.tif"))
        self.assertGreater(exits[29].sum(), 100)  # the row above the hole
        self.assertEqual(exits[exits != 4294967295].sum(), self.record()["ends"]["left"])

    def test_a_hole_is_told_from_the_edge(self):
        """Blocks of one source run into a hole inside the DEM, those of the other leave over its edge: a plane of 45
        degrees, where none stops. A bay of missing data, open to the edge, is not a hole."""
        z = 1000.0 + 1.0 * UP + 0.0 * EAST
        z[30, 8:36] = -9999.0
        write_dem(self.path("dem.tif"), z.astype(np.float32), nodata=-9999.0)
        os.remove(self.path("sources.gpkg"))
        write_features(self.path("sources.gpkg"), "sources", [(box(100, 230, 20, 10), []), (box(245, 230, 10, 10), [])])
        whole = self.run_well(*self.arguments("whole"), "--threads", "1")
        record = self.record("whole")
        exits = bands_of(self.path("whole/exits.tif"))[1:-1, 1:-1]  # without the outer cells
        into_gaps = int(exits[exits != 4294967295].sum())
        left = record["ends"]["left"]
        self.assertEqual((left, record["left_into_gaps"]), (record["released"], into_gaps))
        self.assertGreater(into_gaps, 0.5 * left)
        self.assertLess(into_gaps, 0.8 * left)
        at_edge, into = (f"{100 * n / left:.3g} %" for n in (left - into_gaps, into_gaps))
        text = (f"100 % of the trajectories ({left}) left the DEM or met missing data: the maps do not show how far they go; "
                f"{at_edge} left it at its edge: take a larger DEM; {into} left it into gaps inside it: fill holes of the survey "
                "(gdal_fillnodata.py -md N, half the width of the widest in cells); a lake may stay")
        self.assertIn(text, whole.stderr)
        self.assertIn(text, record["warnings"])
        for part in ("1/2", "2/2"):
            self.run_well(*self.arguments("part" + part[0]), "--part", part)
        self.run_well("merge", self.path("merged"), self.path("part1"), self.path("part2"))
        self.assertEqual(self.record("merged")["left_into_gaps"], into_gaps)
        self.assertEqual(self.record("merged")["warnings"], record["warnings"])
        check = self.run_well("check", *self.arguments()[1:-2])
        self.assertRegex(check.stdout, r"(?m)^warning +100 % of the sample .* left it into gaps inside it: fill holes")
        self.run_well("report", self.path("whole"))
        with open(self.path("whole/report.html"), encoding="utf-8") as page:
            self.assertIn(f"{into_gaps} of them into gaps inside the DEM", page.read())

        z[30, :36] = -9999.0
        write_dem(self.path("dem.tif"), z.astype(np.float32), nodata=-9999.0)
        bay = self.run_well(*self.arguments("bay"))
        self.assertEqual(self.record("bay")["left_into_gaps"], 0)
        self.assertIn("the maps do not show how far they go; a larger DEM would\n", bay.stderr)

    def test_counts_of_parts_add_up(self):
        self.dem(1000.0 + np.where(EAST < 150.0, 0.75 * np.abs(UP - 147.5), 0.9 * UP))
        self.sources(140, 230, frequency=0.4)
        arguments = self.arguments("whole")
        self.run_well(*arguments)
        ends = self.record("whole")["ends"]
        self.assertGreater(ends["trapped"], 20)
        self.assertGreater(ends["left"], 20)
        for part in ("1/3", "2/3", "3/3"):
            self.run_well(*arguments[:-1], self.path("part" + part[0]), "--part", part)
        self.run_well("merge", self.path("merged"), *(self.path(f"part{i}") for i in (1, 2, 3)))
        self.assertEqual(self.record("merged")["ends"], ends)
        self.assertEqual(self.record("merged")["steep_gullies"], self.record("whole")["steep_gullies"])
        for name in ("trapped.tif", "exits.tif", "exits.gpkg", "stops.gpkg", "deposits.tif", "hazard_tally.gz"):
            with open(self.path("whole/" + name), "rb") as one, open(self.path("merged/" + name), "rb") as other:
                self.assertEqual(one.read() == other.read(), True, name)

    def in_steep_gullies(self, z, cell=5.0, tan_phi=np.tan(np.radians(30.0))):
        """The cells of docs/physics.md, "Steep gullies"; the outermost two are none here."""
        def at(i, j):  # the neighbours i to the east and j to the south of the cells off the rim
            return z[1 + j:z.shape[0] - 1 + j, 1 + i:z.shape[1] - 1 + i].astype(float)
        to_east = at(1, -1) + 2 * at(1, 0) + at(1, 1) - at(-1, -1) - 2 * at(-1, 0) - at(-1, 1)
        to_south = at(-1, 1) + 2 * at(0, 1) + at(1, 1) - at(-1, -1) - 2 * at(0, -1) - at(1, -1)
        steep = np.hypot(to_east, to_south) / (8 * cell) > tan_phi
        walls = np.zeros(steep.shape, bool)
        for i, j in ((1, 0), (0, 1), (1, 1), (1, -1)):
            rise = tan_phi * cell * np.hypot(i, j)
            walls |= (at(i, j) - at(0, 0) > rise) & (at(-i, -j) - at(0, 0) > rise)
        wide = np.pad(walls & steep, 1)
        beside = np.logical_or.reduce([wide[1 + j:wide.shape[0] - 1 + j, 1 + i:wide.shape[1] - 1 + i]
                                       for i in (-1, 0, 1) for j in (-1, 0, 1)])
        return np.pad(steep & beside, 1)

    def test_blocks_that_stay_on_the_staircase_of_a_steep_gully(self):
        """A straight V gully of 35 degrees at 20 degrees to the grid, with walls of 45 degrees: its floor is steeper than phi,
        so that no block should stay in it, but more than half do (docs/physics.md, "Creases")."""
        size, way = 70, np.radians(20.0)
        x, y = np.meshgrid((np.arange(size) + 0.5) * 5.0, (size - 0.5 - np.arange(size)) * 5.0)
        along = (x - 62.5) * np.cos(way) + (y - 62.5) * np.sin(way)
        across = (y - 62.5) * np.cos(way) - (x - 62.5) * np.sin(way)
        z = (1000.0 - np.tan(np.radians(35.0)) * along + np.abs(across)).astype(np.float32)
        north = NORTH - 300.0 + size * 5.0  # the lower left corner of the standard DEM
        write_dem(self.path("dem.tif"), z, transform=(WEST, 5.0, 0.0, north, 0.0, -5.0))
        os.remove(self.path("sources.gpkg"))
        write_features(self.path("sources.gpkg"), "sources", [(f"POINT ({WEST + 62.5} {NORTH - 237.5})", [])])
        arguments = self.arguments(diameter="1", trajectories="200")
        done = self.run_well(*arguments)
        gully, kept = self.in_steep_gullies(z), np.zeros(z.shape, int)
        for stop, point in rows_of(self.path("out/stops.gpkg"), "stops"):
            if stop["end"] in ("stopped", "trapped"):
                kept[int((north - point.GetY()) // 5), int((point.GetX() - WEST) // 5)] += 1
        kept[~gully] = 0
        told = self.record()["steep_gullies"]
        self.assertEqual(told["blocks"], kept.sum())
        self.assertGreater(told["blocks"], 100)
        row, column = np.unravel_index(kept.argmax(), kept.shape)
        worst = {"x": WEST + (column + 0.5) * 5, "y": north - (row + 0.5) * 5, "blocks": kept.max(),
                 "passages": bands_of(self.path("out/passages.tif"))[row, column]}
        self.assertEqual(told["worst_cell"], worst)
        words = f"{kept.sum() / 2:g} % of the trajectories ({kept.sum()}) stay in gullies steeper than phi"
        self.assertIn(words, done.stderr)
        place = f"x = {worst['x']:.1f}, y = {worst['y']:.1f}: {worst['blocks']} of the {worst['passages']} blocks that cross this cell"
        self.assertIn(place, done.stderr)
        self.assertRegex(self.run_well("check", *arguments[1:-2]).stdout, r"(?m)^warning .* stay in gullies steeper than phi")
        self.run_well("report", self.path("out"))
        page = self.read_text("out/report.html")
        self.assertRegex(page, rf"act</td><td>Blocks that stay in steep gullies</td><td class='b'>{kept.sum()} of 200 blocks")
        self.assertIn(f"{worst['blocks']} of the {worst['passages']} that cross this cell", page)

    def test_no_block_stays_in_a_steep_gully_where_there_is_none(self):
        """A slope with a level road, and a valley with a level floor: blocks rest there in the real terrain, too."""
        for name, z in (("road", np.where(UP < 100.0, 0.8 * UP, 0.8 * np.maximum(100.0, UP - 15.0))),
                        ("valley", 0.75 * np.abs(UP - 147.5))):
            self.dem(1000.0 + z)
            self.sources(140, 230)
            done = self.run_well(*self.arguments(name))
            ends = self.record(name)["ends"]
            self.assertGreater(ends["stopped"] + ends["trapped"], 10, name)
            self.assertEqual(self.record(name)["steep_gullies"], {"blocks": 0}, name)
            self.assertNotIn("steep", done.stderr.replace("too steep to rest on", ""), name)

    def test_check_maps_the_pits(self):
        z = heights()
        z[20, 30] = z[19:22, 29:32].min() - 2.5  # by 2.5 m, or by less where the bumps have lowered a neighbour
        z[50, 10] -= 40.0
        z[30:33, 40:43] = [[960, 960, 960], [960, 950, 953], [960, 957, 940]]  # way down only to the south-east
        write_dem(self.path("dem.tif"), z)
        arguments = ["check", "--dem", self.path("dem.tif"), "--sources", self.path("sources.gpkg"), "--diameter", "0.8"]
        before = os.listdir(self.folder)
        core = z[1:-1, 1:-1]
        around = np.min([z[1 + j:59 + j, 1 + i:59 + i] for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j], axis=0)
        depth = (around.astype(float) - core)[core < around]
        sides = np.min([z[1 + j:59 + j, 1 + i:59 + i] for i, j in ((1, 0), (-1, 0), (0, 1), (0, -1))], axis=0)
        dams = (sides.astype(float) - core)[(core < sides) & (around < core)]
        self.assertIn(3.0, dams)
        said = self.run_well(*arguments).stdout
        self.assertRegex(said, rf"(?m)^pits +{len(depth)} cells are lower than all eight neighbours, by up to ")
        self.assertRegex(said, rf"(?m)^dammed +{len(dams)} cell")
        self.assert_nothing_left(before)
        self.run_well(*arguments, "-q", "--pits", self.path("pits.gpkg"))
        cells = rows_of(self.path("pits.gpkg"), "pits")
        pits, dammed = ([row for row in cells if row[0]["kind"] == kind] for kind in ("pit", "dammed"))
        self.assertEqual(len(pits) + len(dammed), len(cells))
        np.testing.assert_allclose([row["depth_m"] for row, _ in dammed], dams, rtol=1e-12)
        self.assertIn((41.5, 31.5, 950.0), {((p.GetX() - WEST) / 5.0, (NORTH - p.GetY()) / 5.0, row["z"]) for row, p in dammed})
        self.assertEqual(len(pits), len(depth))
        np.testing.assert_allclose([pit["depth_m"] for pit, _ in pits], depth, rtol=1e-12)
        places = {((point.GetX() - WEST) / 5.0, (NORTH - point.GetY()) / 5.0) for _, point in pits}
        self.assertIn((30.5, 20.5), places)
        self.assertIn((10.5, 50.5), places)
        self.fails(2, "--overwrite", arguments=[*arguments, "--pits", self.path("pits.gpkg")])
        self.run_well(*arguments, "--pits", self.path("pits.gpkg"), "--overwrite")
        self.fails(2, ".gpkg", arguments=[*arguments, "--pits", self.path("pits.tif")])
        self.fails(2, "sources.gpkg", "other layers: sources",
                   arguments=[*arguments, "--pits", self.path("sources.gpkg"), "--overwrite"])
        self.assert_nothing_left(before + ["pits.gpkg"])


if __name__ == "__main__":
    unittest.main()
