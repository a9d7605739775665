"""talus report as a user calls it, and its page in a browser."""
import base64
import html.parser
import json
import math
import os
import re
import shutil
import signal
import subprocess
import unittest
import zlib

import numpy as np
from osgeo import gdal, ogr

from support import NORTH, TALUS, WEST, KeptRuns, OneThread, RunCase, box, heights, write_dem, write_features

HOSTILE = "<script>alert(1)</script>&amp;'\"\u202e</svg>"
VALLEY = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../data/valley")
CHROMIUM = next((path for path in map(shutil.which, ("chromium", "chromium-browser", "google-chrome")) if path), None)
VOID = {"meta", "br", "input", "rect", "line", "circle", "polygon", "polyline", "path", "image", "use"}


class Page(html.parser.HTMLParser):
    """A page: its elements with their attributes, its text; fails on an element that is not closed in turn."""

    def __init__(self, path):
        super().__init__(convert_charrefs=True)
        self.elements, self.text, self.open = [], "", []
        with open(path, encoding="utf-8") as file:
            self.source = file.read()
        self.feed(self.source)
        self.close()
        if self.open:
            raise AssertionError(f"not closed: {self.open}")

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            raise AssertionError(f"</{tag}> in line {self.getpos()[0]} closes nothing")

    def handle_data(self, data):
        if not self.open or self.open[-1] not in ("script", "style"):
            self.text += data

    def all(self, tag):
        return [attributes for name, attributes in self.elements if name == tag]

    def maps(self):
        return {image["data-title"]: image for image in self.all("image") if "data-values" in image}

    def viewer(self):
        return next(svg for svg in self.all("svg") if svg.get("id") == "viewer")


def codes(image, columns):
    """The 16-bit codes of a map, as docs/report.md states them."""
    data = np.frombuffer(zlib.decompress(base64.b64decode(image["data-values"])), np.uint8).astype(int)
    half = len(data) // 2
    return (data[:half] + 256 * data[half:]).reshape(-1, columns)


def value_of(code):
    if code < 2:
        return None if code == 0 else 0.0
    exponent, digits = divmod(int(code) - 2, 900)
    return float(f"{digits + 100}e{exponent - 32}")


def three_digits(value, nodata):
    if value == nodata or math.isnan(value):
        return None
    return float(f"{value:.2e}")


def band_of(path, number, *window):
    """Values of a band, and its nodata value."""
    file = gdal.Open(path)
    band = file.GetRasterBand(number)
    return band.ReadAsArray(*window), band.GetNoDataValue()


class Report(OneThread, KeptRuns, RunCase):
    """A run with screens, hazard with objects, and a barrier."""

    def results(self, hazard=True, out="out"):
        self.keep_scenario(out)
        if hazard:
            write_features(self.path("houses.gpkg"), "houses",
                           [(box(100, 100, 12, 9), ["mill"]), (box(205, 120, 12, 9), ["school"])], [("name", ogr.OFTString)])
            self.keep(out, ["hazard", self.path(out), "--objects", self.path("houses.gpkg"), "-q"],
                      ["barrier", self.path(out), "--screen", "road", "-q"])

    def page(self, *more, out="out"):
        self.run_well("report", self.path(out), "-q", *more)
        return Page(self.path(out + "/report.html"))

    def assert_alone(self, page):
        """Nothing on the page loads anything."""
        for tag, attributes in page.elements:
            self.assertNotIn("src", attributes, tag)
            for name, value in attributes.items():
                self.assertFalse(name.startswith("on"), f"{tag} {name}")
                if name.endswith("href"):
                    self.assertRegex(value, r"^(#[a-z0-9-]+|data:image/png;base64,[A-Za-z0-9+/=]+)$", tag)
        self.assertNotIn("link", [tag for tag, _ in page.elements])
        self.assertNotRegex(page.source, r"https?:|@import|url\((?!#)")
        self.assertIn("default-src 'none'", page.source)
        self.assertEqual(len(page.all("script")), page.source.count("<script"))

    def window(self, page):
        viewer, grid = page.viewer(), self.record()["grid"]
        column = round((float(viewer["data-west"]) - grid["west"]) / grid["cell_x_m"])
        row = round((grid["north"] - float(viewer["data-north"])) / grid["cell_y_m"])
        return column, row, int(viewer["data-columns"]), int(viewer["data-rows"])


class Content(Report):
    def test_presets_of_zones_are_named(self):
        """Also of a run of the complete scenario of another, which has every number of a zone beside its preset."""
        write_features(self.path("zones.gpkg"), "zones", [(box(0, 100, 300, 60), ["road"])], [("zone", ogr.OFTString)])
        self.write("s.toml", self.read_text("s.toml") + '[ground]\nfile = "zones.gpkg"\n[ground.zones.road]\npreset = "forest-road-3d"\n')
        self.results(hazard=False)
        self.run_well("run", self.path("out/scenario.toml"), "-o", self.path("again"), "-q")
        for out in ("out", "again"):
            self.assertIn("upper-talus-3d, forest-road-3d", self.page(out=out).text)

    def test_all_sections(self):
        self.results()
        page = self.page("--title", "Above the road", "--attribution", "Survey of the canton")
        self.assert_alone(page)
        record = self.record()
        for words in ("Above the road", "Survey of the canton", "What was run", "At the screens", "Barrier at road", "Objects",
                      "Before you sign", "Assumptions", "mill", "school", "EPSG:2056"):
            self.assertIn(words, page.text)
        for entry in record["inputs"]:
            self.assertIn(entry["sha256"], page.text)
            self.assertIn(entry["path"], page.text)
        warnings = set(record["warnings"] + self.read_json("out/hazard.json")["warnings"])
        self.assertGreater(len(warnings), len(record["warnings"]))
        self.assertIn(f"{len(warnings)}, listed above", page.text)
        for warning in warnings:
            self.assertIn(warning, page.text)
        self.assertIn(", ".join(f"{end} {count:,}".replace(",", "\u00a0") for end, count in record["ends"].items()), page.text)
        self.assertLessEqual({"Impact probability", "Energy, P95 (translational energy)", "Jump height, P95", "Deposits", "Released blocks",
                              "Hazard class, translational energy", "Annual frequency",
                              "Return period, translational energy > 30 kJ"}, set(page.maps()))
        self.assertIn("relief", [image["id"] for image in page.all("image")])
        text = self.read_text("out/report.html")
        self.assertIn("<th>up to 30 years</th><th>30 to 100 years</th>", text)
        self.assertIn("<tr><th>more than 30 kJ</th><td>high</td><td>medium</td><td>medium</td><td>residual</td></tr>", text)

    def test_values_behind_the_click_are_those_of_the_files(self):
        self.results()
        page = self.page()
        left, top, columns, rows = self.window(page)
        files = {"Impact probability": ("impact_probability", 1), "Energy, P95 (translational energy)": ("energy", 3), "Deposits": ("deposits", 1),
                 "Jump height, P95": ("jump_height", 3), "Hazard class, translational energy": ("hazard_class", 1),
                 "Return period, translational energy > 30 kJ": ("return_period_30", 1), "Annual frequency": ("annual_frequency", 1)}
        for title, (name, band) in files.items():
            values, nodata = band_of(self.path(f"out/{name}.tif"), band, left, top, columns, rows)
            shown = codes(page.maps()[title], columns)
            self.assertEqual(shown.shape, values.shape)
            self.assertGreater(np.count_nonzero(shown > 1), 20, title)
            for code, value in zip(shown.ravel(), values.ravel()):
                self.assertEqual(value_of(code), three_digits(float(value), nodata), title)
        cells = [band_of(self.path("out/hazard_class.tif"), band, left, top, columns, rows)[0] for band in (1, 4)]
        has_class = (cells[0] > 0) | (cells[1] > 0)
        self.assertIn(f"{100 * np.mean(cells[1][has_class]):.2g} % of the pixels with a class", page.text)
        for code, value, has in zip(codes(page.maps()["Class not decided"], columns).ravel(), cells[1].ravel(), has_class.ravel()):
            self.assertEqual(value_of(code), float(value) if has else None)
        whole, _ = band_of(self.path("out/impact_probability.tif"), 1)
        inside = whole[top:top + rows, left:left + columns]
        self.assertEqual(np.count_nonzero(whole > 0), np.count_nonzero(inside > 0))  # nothing is cut off

    def test_large_maps_hold_the_largest_value_of_their_cells(self):
        self.results(hazard=False)
        for name in ("impact_probability", "passages", "release"):  # the results of a grid of 1800 x 1800 cells
            values = np.kron(band_of(self.path(f"out/{name}.tif"), 1)[0], np.ones((30, 30)))
            rng = np.random.default_rng(1)
            values = np.where(values > 0, values * rng.uniform(0.5, 1.5, values.shape), values)
            copy = gdal.GetDriverByName("GTiff").Create(self.path("large.tif"), 1800, 1800, 1, gdal.GDT_Float32)
            copy.GetRasterBand(1).WriteArray(values)
            copy.GetRasterBand(1).SetNoDataValue(-9999)
            copy = None
            os.replace(self.path("large.tif"), self.path(f"out/{name}.tif"))
            if name == "impact_probability":
                expected = values.astype(np.float32)
        for name in os.listdir(self.path("out")):
            if name.endswith(".tif") and name not in ("impact_probability.tif", "passages.tif", "release.tif"):
                os.remove(self.path("out/" + name))
        record = self.record()
        record["grid"].update(columns=1800, rows=1800, cell_x_m=5 / 30, cell_y_m=5 / 30)
        self.write("out/run.json", json.dumps(record))
        page = self.page()
        viewer = page.viewer()
        columns, rows = int(viewer["data-columns"]), int(viewer["data-rows"])
        self.assertLessEqual(max(columns, rows), 800)
        side = round(float(viewer["data-pixel-x"]) * 6)
        self.assertGreater(side, 1)
        self.assertIn(f"{side} x {side} cells", page.text)
        left = round((float(viewer["data-west"]) - WEST) * 6)
        top = round((NORTH - float(viewer["data-north"])) * 6)
        shown = codes(page.maps()["Impact probability"], columns)
        for row in range(0, rows, 7):
            for column in range(0, columns, 7):
                cells = expected[top + row * side:top + (row + 1) * side, left + column * side:left + (column + 1) * side]
                self.assertEqual(value_of(shown[row, column]), three_digits(float(cells.max()), -9999))
        self.assertIn("No relief under the maps", page.text)  # the DEM has other cells

    def test_sizes_of_the_blocks(self):
        """One feature has no diameter of its own and takes 1.0 m, another 1.2 m; the rare class is no misfit of the ground."""
        write_features(self.path("sources.gpkg"), "sources", [(box(140, 230, 20, 10), [1.2]), (box(180, 230, 20, 10), [None])],
                       [("diameter", ogr.OFTReal)])
        self.run_well(*self.arguments(diameter="1.0"), "-q")
        self.assertEqual(self.record("out")["diameters_m"], [1.0, 1.2])
        self.assertRegex(self.page().text, r"look\s*Cells and blocks\s*cells of 5 m, blocks of 1 to 1.2 m: a cell is 4.2 to 5 diameters")

    def test_rare_sizes_are_no_misfit_of_the_ground(self):
        write_features(self.path("sources.gpkg"), "sources", [(box(140, 230, 20, 10), ["cliff"])], [("name", ogr.OFTString)])
        self.write("s.toml", 'dem = "dem.tif"\ntrajectories = 2\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = '
                             '[{ diameter = 1.0, weight = 1000, frequency = 0.1 }, { diameter = 1.4, weight = 1, frequency = 0.1 }]\n')
        self.run_well("run", self.path("s.toml"), "-o", self.path("out"), "-q")
        warnings = [w for w in self.record("out")["warnings"] if w.startswith("block sizes: ")]
        self.assertEqual(len(warnings), 1, warnings)  # of the rare class
        self.assertRegex(self.page().text, r"Sizes of the blocks and the fit of the ground\s*no warning")

    def test_cells_above_two_metres_are_to_be_looked_at(self):
        for cell, mark in ((2.0, "fine"), (2.5, "look")):
            gdal.Warp(self.path("new.tif"), self.path("dem.tif"), xRes=cell, yRes=cell)
            self.run_well("run", "--dem", self.path("new.tif"), "--sources", self.path("sources.gpkg"), "--diameter", "1.2",
                          "--trajectories", "2", "-o", self.path("out"), "-q", "--overwrite")
            self.assertRegex(self.page("--overwrite").text, rf"{mark}\s*Cells and blocks\s*cells of {cell:g} m, blocks of 1.2 m: a cell is "
                                                            rf"{cell / 1.2:.1f} diameters wide")

    def test_warnings_that_lower_the_hazard_come_first(self):
        self.results(hazard=False)
        told = ["the weather was fine", "5 % of the trajectories (5) were trapped in pits or between walls", "energies may be too low (unsafe)"]
        self.write("out/run.json", json.dumps({**self.record("out"), "warnings": told}))
        text = self.page().text
        self.assertEqual(sorted(told, key=text.index), [*told[1:], told[0]])

    def test_results_of_a_later_version_are_said(self):
        self.results(hazard=False)
        self.assertNotIn("was written by Talus", self.page().text)
        self.write("out/run.json", json.dumps({**self.record("out"), "version": "98.7.6"}))
        self.assertIn("run.json was written by Talus 98.7.6, and this is the earlier version", self.page("--overwrite").text)

    def test_without_hazard_and_screens(self):
        write_features(self.path("sources.gpkg"), "sources", [(box(140, 230, 20, 10), ["cliff"])], [("name", ogr.OFTString)])
        self.run_well(*self.arguments(), "-q")
        page = self.page()
        self.assert_alone(page)
        self.assertNotIn("At the screens", page.text)
        self.assertFalse([title for title in page.maps() if title.startswith("Hazard class")])
        self.assertIn("Nothing on this page is per year", page.text)

    def test_screens_in_numbers(self):
        self.results(hazard=False)
        page = self.page()
        rows = [row for row in self.read_table("out/screens_summary.csv") if row["quantity"] in ("speed", "energy", "jump height")]
        self.assertEqual(len(rows), 3)
        for row in rows:
            for key in ("p50", "p95", "p99", "maximum"):
                self.assertIn(f"{float(row[key]):.3g}", page.text)

    def test_a_dem_that_was_moved_or_changed_is_left_out(self):
        self.results(hazard=False)
        with open(self.path("dem.tif"), "ab") as file:
            file.write(b" ")
        page = self.page()
        self.assertIn("the DEM has changed since the run", page.text)
        self.assertNotIn("relief", [image["id"] for image in page.all("image")])
        os.remove(self.path("dem.tif"))
        self.assertIn("the DEM is no longer where it was", self.page("--overwrite").text)

    def test_the_fit_of_the_ground(self):
        os.mkdir(self.path("fit"))
        self.write("fit/fitted.toml", '[ground.zones.default]\npreset = "upper-talus-3d"\nEn50 = 13\n')
        self.write("fit/calibration.json", json.dumps({
            "campaign": "quarry" + HOSTILE, "parameters": [{"key": "ground.En50", "unit": "m3/s2", "value": 13.0,
                                                            "ci95": [9.5, 17.5], "identifiable": False, "at_bound": True}],
            "error": {"holdout": {"before": 0.811, "after": 0.634}}, "warnings": []}))
        self.write("s.toml", 'include = "fit/fitted.toml"\n' + self.read_text("s.toml"))
        self.results(hazard=False)
        page = self.page()
        self.assert_alone(page)
        for words in ("Fit of the ground", "quarry<script>", "0.811", "9.5 to 17.5", "not identifiable, ends at the bound of the search"):
            self.assertIn(words, page.text)
        with open(self.path("fit/fitted.toml"), "a", encoding="utf-8") as file:
            file.write("# another\n")
        self.assertIn("has changed since the run", self.page("--overwrite").text)

    def row_of(self, text, point):
        """Mark and what follows of a row of the checklist."""
        return re.search(rf"\u2610 (act|look|fine){point}([^\u2610]*)", text).groups()

    def test_a_fit_without_skill_is_not_fine(self):
        """With the model, and with the scenario that its run leaves; the worth of its numbers comes from the record beside it."""
        os.mkdir(self.path("fit"))
        scenario = self.read_text("s.toml")
        cases = (([-0.1, -0.3, 0.1], True, "act", "no skill: -10.0 % (95 %: -30.0 to 10.0 %)", "do not use this fit"),
                 ([0.1, -0.1, 0.3], True, "look", "skill 10.0 % (95 %: -10.0 to 30.0 %): it may have none", "may be no better"),
                 ([0.1], True, "look", "skill 10.0 %: it may have none", "may be no better"),
                 ([0.2, 0.1, 0.3], False, "look", "1 of 1 fitted numbers is not identifiable", "one of many"),
                 ([0.2, 0.1, 0.3], True, "fine", "skill 20.0 % (95 %: 10.0 to 30.0 %)", "its slope"),
                 (None, True, "look", "its skill is not known", "or of an earlier version"))
        for i, (skill, known, mark, found, _) in enumerate(cases):
            self.write("fit/fitted.toml", (f"fitted_skill = {skill}\n" if skill else "") + "fitted_cell = 5\n[ground.zones.default]\nEn50 = 13\n")
            self.write("fit/calibration.json", json.dumps({
                "campaign": "quarry", "parameters": [{"key": "ground.En50", "unit": "m3/s2", "value": 13.0, "ci95": [9.5, 17.5],
                                                      "identifiable": known}],
                "error": {"holdout": {"before": 0.811, "after": 0.634, "climatology": 0.597}}, "warnings": []}))
            self.write("s.toml", 'include = "fit/fitted.toml"\n' + scenario)
            out = f"out{i}"
            self.run_scenario(out)
            self.run_well("run", self.path(out + "/scenario.toml"), "-o", self.path(out + "b"), "-q")
            for folder in (out, out + "b"):
                text = self.page(out=folder).text
                self.assertIn("0.597", text)
                self.assertEqual(text.count(found), 1 if "identifiable" in found else 3 if mark == "act" else 2, (folder, found))
                row = self.row_of(text, "Ground")
                self.assertEqual(row[0], mark, row)
                self.assertIn(found, row[1])
                self.assertIn(cases[i][4], row[1])
                self.assertEqual(self.row_of(text, "DEM of the fit and DEM of the run")[0], "fine")

    def test_the_climatology_of_a_diagnosis(self):
        os.mkdir(self.path("fit"))
        self.write("fit/with_effect.toml", "[ground.zones.default]\nEn50 = 13\n")
        self.write("fit/diagnosis.json", json.dumps({
            "campaign": "quarry", "effect": "none", "error": {"holdout": {"rows": "out-of-fold", "before": 0.811, "after": 0.634}},
            "evidence": [{"model": "climatology", "fit": {"error": 0.111}, "out-of-fold": {"error": 0.597}},
                         {"model": "ground", "out-of-fold": {"error": 0.811}}]}))
        self.write("s.toml", 'include = "fit/with_effect.toml"\n' + self.read_text("s.toml"))
        self.results(hazard=False)
        self.assertRegex(self.page().text, r"0\.811\s*0\.634\s*0\.597")

    def test_the_fit_of_the_ground_alone_is_not_the_effect_that_was_found(self):
        """`fitted.toml` of a diagnosis lacks what it found: the error of a run with it is the one before."""
        os.mkdir(self.path("fit"))
        self.write("fit/fitted.toml", '[ground.zones.default]\npreset = "upper-talus-3d"\nEn50 = 13\n')
        self.write("fit/with_effect.toml", '[ground.zones.default]\npreset = "upper-talus-3d"\nEn50 = 11\n')
        self.write("fit/diagnosis.json", json.dumps({
            "campaign": "quarry", "effect": "block-shape", "effects": ["block-shape", "block-mass"], "verdict": "block-shape",
            "where": "everywhere", "error": {"holdout": {"before": 0.811, "after": 0.634}}, "warnings": []}))
        scenario = self.read_text("s.toml")
        self.write("s.toml", 'include = "fit/fitted.toml"\n' + scenario)
        self.results(hazard=False)
        text = self.page().text
        self.assertIn("0.811", text)
        self.assertNotIn("0.634", text)
        self.assertIn("block-shape, block-mass; this file is the ground alone, without it", text)
        self.write("s.toml", 'include = "fit/with_effect.toml"\n' + scenario)
        self.results(hazard=False, out="second")
        text = self.page(out="second").text
        self.assertIn("0.634", text)
        self.assertNotIn("the ground alone", text)

    def test_ends_that_are_not_those_of_the_released_blocks(self):  # a record that was edited was shown
        self.run_scenario("out")
        record = self.read_json("out/run.json")
        record["ends"]["stopped"] += 1
        self.write("out/run.json", json.dumps(record))
        released = record["released"]
        self.fails(2, f"run.json: cannot be understood (it has {released} released blocks, and ends of {released + 1})",
                   arguments=["report", self.path("out")])

    def test_hazard_of_a_run_of_several_rounds_is_that_of_the_run(self):
        self.run_scenario("out", "--rounds", "2")
        self.run_well("hazard", self.path("out"), "-q")
        self.assertNotIn("Hazard of another run", self.page().text)
        record = self.read_json("out/hazard.json")
        record["run"]["plan"] = "0" * 64
        self.write("out/hazard.json", json.dumps(record))
        self.assertIn("Hazard of another run", self.page("--overwrite").text)

    def test_frequencies_of_another_file(self):
        """The page names those that the maps were made with, and a barrier that was designed by others."""
        self.results(hazard=False)
        note = "this design counts by other frequencies than the hazard maps"

        def text(*given):
            self.run_well("hazard", self.path("out"), "--overwrite", "-q", *given)
            return self.page("--overwrite").text

        self.run_well("barrier", self.path("out"), "--screen", "road", "-q")
        page = text()
        self.assertIn("follow from those of the run (settings, under Record): 0.52 events per year together", page)
        self.assertNotIn(note, page)
        new = self.write("w.toml", "[features]\nwest = 5\n")
        page = text("--frequency", new)
        digest = self.read_json("out/hazard.json")["frequency"]["sha256"]
        of_file = (f"those in {new} ([features] west = 5; SHA-256 {digest}), "
                   "which take the place of those of the run (settings, under Record)")
        self.assertIn(f"follow from {of_file}: 5.02 events per year together", page)
        self.assertIn(f"{note}: those of the run (settings, under Record); the maps by {of_file}", page)
        self.run_well("barrier", self.path("out"), "--screen", "road", "--frequency", new, "-q")
        self.assertNotIn(note, self.page("--overwrite").text)
        self.assertIn(f"{note}: {of_file}; the maps by those of the run", text())
        self.run_well("barrier", self.path("out"), "--screen", "road", "--unweighted", "-q")
        self.assertNotIn(note, self.page("--overwrite").text)

    def test_what_no_block_exceeds_has_a_bound(self):
        """As `talus barrier` prints it: the upper bound of the frequency, where no crossing exceeds a value."""
        self.results(hazard=False)
        said = self.run_well("barrier", self.path("out"), "--screen", "road").stdout
        limits = [one["per_year"] for quantity in self.read_json("out/barrier_road.json")["reliability"] for one in quantity["exceeded"]]
        bounds = [1.0 / one["high"] for one in limits if one["value"] == 0.0]
        self.assertEqual(said.count("rarer than once in "), len(bounds))
        self.assertGreater(len(bounds), 0)
        found = re.findall(r"rarer than once in ([\d., \xa0]+) years", self.page().text)
        self.assertEqual(len(found), len(bounds))
        for text, years in zip(found, bounds):
            self.assertAlmostEqual(float(re.sub(r"[ \xa0]", "", text)) / years, 1.0, 2)

    def test_values_by_return_period(self):
        """As `talus barrier` prints them."""
        self.results(hazard=False)
        said = self.run_well("barrier", self.path("out"), "--screen", "road", "--return-periods", "30,300000").stdout.replace("\xa0", " ")
        rows = re.findall(r"(30|300 000) years +energy (.*\]) kJ +jump height (.*\]) m +centre height (.*\]) m +speed (.*\]) m/s", said)
        self.assertEqual(len(rows), 2)
        self.assertIn("?]", rows[1][1])
        page = self.page().text.replace("\xa0", " ")
        for years, *values in rows:
            self.assertRegex(page, r"\s*".join(map(re.escape, [f"{years} years", *values])))
        design = self.read_json("out/barrier_road.json")
        for row in design["once_in"]:
            del row["centre_height_m"]  # as in earlier designs
        self.write("out/barrier_road.json", json.dumps(design))
        page = self.page("--overwrite").text.replace("\xa0", " ")
        for years, energy, jump, _, speed in rows:
            self.assertRegex(page, r"\s*".join(map(re.escape, [f"{years} years", energy, jump, "?", speed])))

    def test_a_screen_with_a_vertex_far_off_the_map(self):  # a point every 4 pixels up to there: 4 GB
        write_features(self.path("screens.gpkg"), "screens",
                       [(f"LINESTRING ({WEST} 1200100,{WEST + 300} 1200100,900000000 1200100)", ["road"])], [("id", ogr.OFTString)])
        self.run_scenario("out")
        done = subprocess.run(["bash", "-c", 'ulimit -v 2000000; exec "$@"', "-", TALUS, "report", self.path("out"), "--overwrite", "-q"],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_objects_are_called_as_in_the_tables(self):
        """The map had the numbers of the layer, and an object in a gap of the DEM was hit 0 times per year."""
        z = heights()
        z[28:32, 50:54] = -9999.0  # no height from x = 247.5 to 272.5 and y = 137.5 to 162.5
        write_dem(self.path("dem.tif"), z, nodata=-9999.0)
        write_features(self.path("houses.gpkg"), "houses", [(box(100, 100, 12, 9), ["EGID 7"]), (box(250, 140, 20, 20), ["EGID 8"]),
                                                                  (box(5, 290, 5, 5), ["EGID 9"])],
                       [("id", ogr.OFTString)])
        self.run_scenario("out", "--trajectories", "3")
        self.run_well("hazard", self.path("out"), "--objects", self.path("houses.gpkg"), "-q")
        source = self.page().source
        on_map = re.findall(r"<text[^>]*>(EGID \d|\d)</text>", source[:source.index("</defs>")])
        self.assertEqual(sorted(name for name in on_map if name.startswith("EGID")), ["EGID 7", "EGID 8", "EGID 9"])
        first, second, third = re.findall(r"<tr><td>EGID.*", source)
        self.assertEqual(first, "<tr><td>EGID 8</td><td colspan='6'>not assessed: the DEM has no height there</td></tr>")
        self.assertTrue(second.startswith("<tr><td>EGID 7</td><td class='n'>"), second)
        names, told = ["none", "residual", "low", "medium", "high"], {"EGID 7": second, "EGID 9": third}
        for row in self.read_table("out/objects.csv")[::2]:
            here, low, high = (names[int(row["hazard_class" + end])] for end in ("", "_lower", "_upper"))
            self.assertEqual(low != high, row["object"] == "EGID 9")  # nothing came there, of too few blocks to say more
            said = f"{here} [{low} to {high}]" if low != high else here
            here, low, high = (names[int(row["entry_class" + end])] for end in ("", "_lower", "_upper"))
            entry = f"{here} [{low} to {high}]" if low != high else here
            said += "" if entry == said else f"; at the first touch {entry}"
            said += "" if float(row["frequency"]) > 0.0 else " in this run"
            self.assertIn(f"<td>{said}</td>", told[row["object"]])

    def test_a_road_that_is_screen_and_object_is_named_once(self):
        line = f"LINESTRING ({WEST} 1200100,{WEST + 300} 1200100)"
        write_features(self.path("road.gpkg"), "road", [(line, ["road"]), (line.replace("1200100", "1200110"), ["path"])], [("name", ogr.OFTString)])
        self.run_scenario("out", "--trajectories", "3")
        self.run_well("hazard", self.path("out"), "--objects", self.path("road.gpkg"), "--width", "5", "-q")
        source = self.page().source
        names = re.findall(r"<text[^>]*font-weight=\"bold\"[^>]*>(road|path|net)</text>", source[:source.index("</defs>")])
        self.assertEqual(sorted(names), ["net", "path", "road"])

    def test_no_name_is_lost_where_there_is_little_room(self):
        """Forty houses side by side, a row of three parallel ways that lead over both edges of the map."""
        houses = [(box(100 + 5 * (i % 10), 100 + 5 * (i // 10), 4.5, 4.5), [f"house {i}"]) for i in range(37)]
        ways = [(f"LINESTRING ({WEST - 900} {1200120 + 3 * i},{WEST + 900} {1200120 + 3 * i})", [f"way {i}"]) for i in range(3)]
        write_features(self.path("houses.gpkg"), "houses", houses + ways, [("name", ogr.OFTString)])
        self.run_scenario("out", "--trajectories", "3")
        self.run_well("hazard", self.path("out"), "--objects", self.path("houses.gpkg"), "-q")
        page = self.page()
        source, viewer = page.source, page.viewer()
        found = {}
        for x, y, name in re.findall(r'<text x="([^"]*)" y="([^"]*)"[^>]*font-weight="bold"[^>]*>((?:house|way) \d+)</text>',
                                     source[:source.index("</defs>")]):
            self.assertNotIn(name, found)
            found[name] = float(x), float(y)
        self.assertEqual(set(found), {names[0] for _, names in houses + ways})
        for name, (x, y) in found.items():
            self.assertTrue(0 <= x <= float(viewer["data-width"]) - 6 * len(name) and 10 <= y <= float(viewer["data-height"]), (name, x, y))
            for other, (u, v) in found.items():
                self.assertTrue(name == other or abs(y - v) >= 12 or x + 6 * len(name) < u or u + 6 * len(other) < x, (name, other))

    def test_titles_of_legends_are_as_long_as_there_is_room(self):
        """A bold letter of 11 px is about 6.2 px wide, and a legend 230 px."""
        self.write("s.toml", self.read_text("s.toml") + "count_rotation = true\n")
        self.results()
        source = self.page().source
        groups = re.findall(r'<g id="legend-\d+"[^>]*>(.*?)</g>', source, re.DOTALL)
        titles = [re.findall(r'<text[^>]*font-weight="bold"[^>]*>([^<]*)</text>', group) for group in groups]
        self.assertIn("Return period, energy with rotation &gt; 300 kJ [years]", [" ".join(title) for title in titles])
        for title in titles:
            self.assertLessEqual(max(len(line.replace("&gt;", ">")) for line in title), 36, title)

    def test_hostile_names_stay_text(self):
        road = f"road{HOSTILE}"
        write_features(self.path("screens.gpkg"), "screens",
                       [(f"LINESTRING ({WEST} 1200100,{WEST + 300} 1200100)", [road])], [("id", ogr.OFTString)])
        write_features(self.path("sources.gpkg"), "sources", [(box(100, 230, 30, 15), [f"cliff{HOSTILE}", 0.5])],
                       [("name", ogr.OFTString), ("frequency", ogr.OFTReal)])
        self.run_scenario("out")
        write_features(self.path("houses.gpkg"), "houses", [(box(100, 100, 30, 30), [f"mill{HOSTILE}"])],
                       [("name", ogr.OFTString)])
        self.run_well("hazard", self.path("out"), "--objects", self.path("houses.gpkg"), "-q")
        self.run_well("barrier", self.path("out"), "--screen", road, "-q")
        record = self.record()

        def spoilt(value):
            if isinstance(value, dict):
                return {key: item if key in ("crs_wkt", "plan") else spoilt(item) for key, item in value.items()}
            if isinstance(value, list):
                return [spoilt(item) for item in value]
            return value + HOSTILE if isinstance(value, str) and value != "dem" and not value.endswith("dem.tif") and \
                not re.fullmatch("[0-9a-f]{64}|default|m", value) else value

        self.write("out/run.json", json.dumps(spoilt(record)))
        page = self.page("--title", f"title{HOSTILE}", "--attribution", f"canton{HOSTILE}")
        self.assert_alone(page)
        self.assertEqual(len(page.all("script")), 1)
        for name in ("road", "mill", "cliff", "title", "canton"):
            self.assertIn(f"{name}<script>alert(1)</script>&amp;'\"", page.text)
        self.assertNotIn("&amp;lt;", page.source)  # escaped once
        self.assertNotRegex(page.source, "[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")


    def test_names_of_classes_go_by_their_value(self):
        self.results()
        style = self.read_text("out/hazard_class.qml")
        items = re.findall(r"<item [^>]*/>\s*", style)
        expected = [[float(re.search('value="([^"]*)"', item).group(1)), re.search('label="([^"]*)"', item).group(1)]
                    for item in items]
        self.assertGreater(len(expected), 3)
        self.write("out/hazard_class.qml", style.replace("".join(items), "".join(items[:0:-1])))
        image = self.page().maps()["Hazard class, translational energy"]
        self.assertEqual(json.loads(image["data-classes"]), expected[:0:-1])  # the last first, the first not at all

    def test_the_day_is_that_of_the_file_and_so_called(self):
        self.results(hazard=False)
        os.utime(self.path("out/run.json"), (1.0e9, 1.0e9))  # 2001-09-09
        page = self.page()
        self.assertIn("run.json written on2001-09-09", page.text)  # two cells of the table
        self.assertIn("run.json written on 2001-09-09, plan", page.text)
        self.assertIn("run.json of 2001-09-09", page.text)
        self.assertNotIn("day of the run", page.text)


class Files(Report):
    def test_names_and_overwrite(self):
        self.results(hazard=False)
        self.fails(2, "nowhere", "no run.json", arguments=["report", self.path("nowhere")])
        self.fails(2, "must end in .html", arguments=["report", self.path("out"), "-o", self.path("page.pdf")])
        self.fails(2, "no folder can be made there", arguments=["report", self.path("out"), "-o", self.path("out/run.json/page.html")])
        self.run_well("report", self.path("out"), "-o", self.path("new/one/page.html"))
        self.assertEqual(os.listdir(self.path("new/one")), ["page.html"])
        self.page()
        self.fails(2, "is there already", "--overwrite", arguments=["report", self.path("out")])
        self.page("--overwrite")
        self.write("mine.html", "<p>mine</p>")
        self.fails(2, "no page of talus report",
                   arguments=["report", self.path("out"), "-o", self.path("mine.html"), "--overwrite"])
        self.run_well("report", self.path("out"), "-o", self.path("page.html"))
        self.assertFalse([name for name in os.listdir(self.folder) + os.listdir(self.path("out")) if name.startswith(".")])
        self.run_well("report", self.path("out"), "-o", self.path("out/for the canton.html"))
        self.run_scenario("out", "--overwrite")  # the pages belong to the folder
        self.assertFalse([name for name in os.listdir(self.path("out")) if name.endswith(".html")])

    def test_a_link_stays_and_leads_to_the_new_page(self):  # it was replaced by a page, what it led to stayed
        self.results(hazard=False)
        os.mkdir(self.path("web"))
        os.symlink("web/page.html", self.path("page.html"))
        report = ["report", self.path("out"), "-o"]
        self.run_well(*report, self.path("web/page.html"))
        self.run_well(*report, self.path("page.html"), "--title", "Second title", "--overwrite")
        self.assertEqual(os.readlink(self.path("page.html")), "web/page.html")
        self.assertEqual(os.listdir(self.path("web")), ["page.html"])
        self.assertIn("Second title", self.read_text("web/page.html"))

    def test_no_hidden_file_is_left_by_a_signal(self):
        self.results(hazard=False)
        told = 0
        for _ in range(8):
            process = subprocess.Popen([TALUS, "report", self.path("out"), "-q", "--overwrite"])
            hidden = self.path(f"out/.report.talus-{process.pid}.html")
            while process.poll() is None and not os.path.exists(hidden):
                pass
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
                told += 1
            process.wait(60)
            self.assertEqual([name for name in os.listdir(self.path("out")) if name.startswith(".")], [])
        self.assertGreater(told, 0)
        Page(self.path("out/report.html"))  # whole

    def test_memory_for_a_large_table_of_crossings(self):
        """The text of the table, and not several times that."""
        self.results(hazard=False)

        def megabytes():
            process = subprocess.Popen([TALUS, "report", self.path("out"), "-q", "-o", self.path("p.html"), "--overwrite"])
            _, process.returncode, used = os.wait4(process.pid, 0)
            self.assertEqual(process.returncode, 0)
            return used.ru_maxrss / 1024

        small = megabytes()
        with open(self.path("out/screens.csv"), "r+", encoding="utf-8") as file:
            rows = "".join(file.readlines()[1:])
            file.write(rows * round(40e6 / len(rows)))
        self.assertLess(megabytes() - small, 2 * 40)

    def test_the_same_page_again(self):
        self.results()
        day = {**os.environ, "SOURCE_DATE_EPOCH": "1700000000"}
        for name in ("one.html", "two.html"):
            self.run_well("report", self.path("out"), "-o", self.path(name), "-q", env=day)
        with open(self.path("one.html"), "rb") as one, open(self.path("two.html"), "rb") as two:
            self.assertEqual(one.read(), two.read())

    def test_a_day_that_is_none_is_refused(self):
        self.results(hazard=False)
        for text in ("abc", "", "-1", "1.5", "253402300800", "1e9"):
            self.fails(2, f"SOURCE_DATE_EPOCH = '{text}'", "must be a whole number of seconds",
                       arguments=["report", self.path("out")], env={**os.environ, "SOURCE_DATE_EPOCH": text})

    def test_tampered_folders(self):
        self.results()

        def refused(name, content, *words):
            with open(self.path("out/" + name), "rb") as file:
                kept = file.read()
            self.write("out/" + name, content)
            self.fails(2, name, *words, arguments=["report", self.path("out")])
            self.assertFalse(os.path.exists(self.path("out/report.html")))
            with open(self.path("out/" + name), "wb") as file:
                file.write(kept)

        record = self.record()
        refused("run.json", "[" * 100_000, "cannot be understood")
        refused("run.json", "{}", "cannot be understood")
        for change in ({"columns": 10**9}, {"columns": -5}, {"cell_x_m": 0}, {"cell_x_m": 1e999}, {"crs_wkt": 7}):
            refused("run.json", json.dumps({**record, "grid": {**record["grid"], **change}}), "cannot be understood")
        screens = [{"id": "road", "lines": [[[0.0, 0.0]]]}]  # talus barrier refuses it, too
        refused("run.json", json.dumps({**record, "screens": screens}), "'road' has a line of less than two places")
        refused("hazard.json", '{"warnings": 3, "events_per_year": "many"}', "cannot be understood")
        hazard = self.read_json("out/hazard.json")
        for classes, words in ((hazard["matrix"]["classes"][:-1], "one row of classes more than energies"),
                               ([row[:-1] for row in hazard["matrix"]["classes"]], "one class more than years"),
                               ([[99 for _ in row] for row in hazard["matrix"]["classes"]], "the number of one of its"),
                               ([[-1 for _ in row] for row in hazard["matrix"]["classes"]], "the number of one of its")):
            refused("hazard.json", json.dumps({**hazard, "matrix": {**hazard["matrix"], "classes": classes}}), words)
        refused("barrier_road.json", '{"screen": ["road"]}', "cannot be understood")
        refused("screens_summary.csv", "screen,speed\nroad\n")
        refused("objects_curves.csv", "object,energy_kj,frequency\nmill,much,1\n", "must be a number")
        os.remove(self.path("out/run.json"))
        os.mkfifo(self.path("out/run.json"))
        self.fails(2, "run.json", "a pipe", arguments=["report", self.path("out")])

    def test_rasters_without_a_record_are_left_out(self):
        """Hazard maps whose hazard.json is lost, and rasters that are lost: said; what nobody vouches for is not shown."""
        self.results()
        os.remove(self.path("out/energy.tif"))
        os.remove(self.path("out/annual_frequency.tif"))
        page = self.page()
        self.assertIn("energy.tif: named in run.json, but missing", page.text)
        self.assertIn("annual_frequency.tif: named in hazard.json, but missing", page.text)
        self.assertIn("Hazard class, translational energy", page.maps())
        self.assertIn("How often each object is hit", page.text)
        os.remove(self.path("out/hazard.json"))
        page = self.page("--overwrite")
        self.assertFalse([title for title in page.maps() if "Hazard" in title or "Return period" in title or "Class" in title])
        self.assertIn("not shown, as no record names them", page.text)
        self.assertIn("hazard_class.tif", page.text)
        self.assertNotIn("How often each object is hit", page.text)

    def test_a_raster_of_another_grid_is_refused(self):
        self.results(hazard=False)
        record = self.record()
        record["grid"]["columns"] = 61
        self.write("out/run.json", json.dumps(record))
        self.fails(2, "impact_probability.tif", "60 x 60 cells", arguments=["report", self.path("out")])

    def test_a_style_that_is_none_leaves_the_map_out(self):
        self.results(hazard=False)
        for text in ("", "<qgis>", "<qgis><pipe><rasterrenderer band='9e9'/></pipe></qgis>", "x" * 2_000_000):
            self.write("out/energy.qml", text)
            page = self.page("--overwrite")
            self.assertNotIn("Energy, P95 (translational energy)", page.maps())
            self.assertIn("energy.tif: has no style with classes", page.text)


# Clicks on every map, then writes what the page shows into the document.
HARNESS = """<script>
addEventListener('load', async () => {
  const said = [];
  const viewer = document.getElementById('viewer'), box = viewer.getScreenCTM();
  const x = Number(viewer.dataset.width) * (COLUMN + 0.5) / Number(viewer.dataset.columns);
  const y = Number(viewer.dataset.height) * (ROW + 0.5) / Number(viewer.dataset.rows);
  const place = new DOMPoint(x, y).matrixTransform(box);
  viewer.dispatchEvent(new MouseEvent('click', {clientX: place.x, clientY: place.y, bubbles: true}));
  const slider = document.getElementById('slider');
  slider.value = 250;
  slider.dispatchEvent(new Event('input'));
  const choice = document.getElementById('choose-b');
  choice.value = '2';
  choice.dispatchEvent(new Event('change'));
  for (let i = 0; i < 200 && document.querySelectorAll('#values tr').length === 0; ++i)
    await new Promise(done => setTimeout(done, 20));
  const state = document.createElement('pre');
  state.id = 'state';
  state.textContent = JSON.stringify({
    values: Array.from(document.querySelectorAll('#values tr')).map(row => [row.cells[0].textContent, row.cells[1].textContent]),
    place: document.getElementById('place').textContent,
    left: document.getElementById('left-part').getAttribute('width'),
    view: document.getElementById('view-b').getAttribute('href'),
    pictures: (await Promise.all(Array.from(document.querySelectorAll('image')).map(image => new Promise(done => {
      const picture = new Image();
      picture.onload = () => done(picture.naturalWidth);
      picture.onerror = () => done(0);
      picture.src = image.getAttribute('href');
    }))))});
  document.body.append(state);
});
</script>"""


class Browser(Report):
    """The page in headless Chromium."""

    def setUp(self):
        super().setUp()
        if CHROMIUM is None:
            if os.environ.get("CI") == "true":
                self.fail("no chromium: CI must not skip this test")
            self.skipTest("chromium is not installed: the page is not opened in a browser")

    def chromium(self, *arguments):
        done = subprocess.run([CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr", "--v=0",
                               f"--user-data-dir={self.path('profile')}", "--window-size=1200,1600",
                               "--virtual-time-budget=10000", *arguments],
                              capture_output=True, text=True, check=False, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("CONSOLE", done.stderr)
        return done.stdout

    def test_click_and_slider(self):
        self.results()
        style = self.read_text("out/hazard_class.qml")
        self.write("out/hazard_class.qml", re.sub('<item value="0"[^>]*/>', "", style))  # names go by value, not by place
        page = self.page()
        left, top, columns, rows = self.window(page)
        energy = band_of(self.path("out/energy.tif"), 3, left, top, columns, rows)[0]
        row, column = np.unravel_index(np.argmax(energy), energy.shape)
        share = band_of(self.path("out/impact_probability.tif"), 1, left, top, columns, rows)[0][row, column]
        policy = re.search('<meta http-equiv="Content-Security-Policy"[^>]*>', page.source).group(0)
        source = page.source.replace(policy, "").replace("</body>", HARNESS.replace("COLUMN", str(column))
                                                         .replace("ROW", str(row)) + "</body>")
        self.write("clicked.html", source)
        dom = self.chromium("--dump-dom", "file://" + self.path("clicked.html"))
        state = json.loads(re.search('<pre id="state">(.*?)</pre>', dom, re.DOTALL).group(1).replace("&gt;", ">"))
        values = dict(state["values"])
        self.assertEqual(set(values), set(page.maps()))
        self.assertEqual(float(values["Energy, P95 (translational energy)"].removesuffix(" kJ")), float(f"{energy[row, column]:.2e}"))
        self.assertEqual(float(values["Impact probability"].removesuffix(" %")), float(f"{100 * float(f'{share:.2e}'):.6g}"))
        here = int(band_of(self.path("out/hazard_class.tif"), 1, left + int(column), top + int(row), 1, 1)[0][0, 0])
        self.assertGreater(here, 0)
        self.assertEqual(values["Hazard class, translational energy"], re.search(f'<item value="{here}" label="([^"]*)"', style).group(1))
        self.assertIn(f"East {float(page.viewer()['data-west']) + 5 * column:.1f}", state["place"])
        self.assertAlmostEqual(float(state["left"]), 1 + float(page.viewer()["data-width"]) / 4, 1)
        self.assertEqual(state["view"], "#map-2")
        self.assertEqual(len(state["pictures"]), len(page.all("image")))
        self.assertEqual(set(state["pictures"]), {columns})

    def test_opens_as_it_is_and_prints(self):
        self.results()
        page = self.page()
        dom = self.chromium("--dump-dom", "file://" + self.path("out/report.html"))
        self.assertEqual(dom.count("<option"), 2 * len(page.maps()))  # the script ran under the policy of the page
        self.chromium("--screenshot=" + self.path("page.png"), "file://" + self.path("out/report.html"))
        picture = gdal.Open(self.path("page.png")).ReadAsArray()
        self.assertEqual(picture.shape[1:], (1600, 1200))
        red, green, blue = picture[:3].astype(int)
        self.assertGreater(len(np.unique((red * 256 + green) * 256 + blue)), 100)  # colours
        pdf = self.printed(self.path("out/report.html"))
        self.assertTrue(pdf.startswith(b"%PDF"))
        self.assertGreater(len(pdf), 50_000)

    def test_two_low_maps_share_a_printed_page(self):
        self.run_well("run", os.path.join(VALLEY, "scenario.toml"), "--trajectories", "2", "-q", "-o", self.path("valley"))
        self.run_well("report", self.path("valley"))
        html = self.read_text("valley/report.html")
        maps = html.count("<figure class='map low'>")
        self.assertGreater(maps, 5)
        self.write("alone.html", html.replace("class='map low'", "class='map'"))  # one on a page
        pages = [self.printed(self.path(name)).count(b"/Type /Page\n") for name in ("valley/report.html", "alone.html")]
        self.assertLessEqual(pages[0], pages[1] - maps // 2 + 1)

    def test_a_table_of_objects_with_many_sources_fits(self):
        """Twenty sources for each of two roads, three of them named: on the screen and on A4, each row a few lines high."""
        write_features(self.path("sources.gpkg"), "sources",
                       [(box(60 + 10 * i, 230, 6, 10), [f"cliff above the road {i}", 0.5]) for i in range(20)],
                       [("name", ogr.OFTString), ("frequency", ogr.OFTReal)])
        write_features(self.path("roads.gpkg"), "roads",
                       [(f"LINESTRING ({WEST} {1200100 + 20 * i},{WEST + 300} {1200100 + 20 * i})", [name])
                        for i, name in enumerate(("Gemeindestrasse zum Hinterfeld", "Waldweg"))], [("name", ogr.OFTString)])
        self.run_scenario("many", "--thresholds", "30,100,300,1000,3000,10000", "--trajectories", "5")
        self.run_scenario("out")
        for out in ("many", "out"):
            self.run_well("hazard", self.path(out), "--objects", self.path("roads.gpkg"), "--width", "6", "-q")
            page = self.page(out=out)
            self.assert_objects_fit(page)
        shares = {}
        for row in self.read_table("out/objects_sources.csv"):
            shares.setdefault(row["object"], []).append((row["feature"], float(row["share"])))
        for road, sources in shares.items():
            self.assertGreater(len(sources), 10)
            largest = sorted(sources, key=lambda one: -one[1])[:3]
            self.assertIn("; ".join(f"{name} {100 * share:.3g} %" for name, share in largest) + f"; and {len(sources) - 3} more", page.text)

    def assert_objects_fit(self, page):
        script = """<script>addEventListener('load', () => {
            const table = document.querySelector('table.objects'), state = document.createElement('pre');
            state.id = 'state';
            state.textContent = JSON.stringify([table.scrollWidth, table.parentElement.clientWidth, document.documentElement.scrollWidth,
                Array.from(table.rows).slice(1).map(row => row.offsetHeight)]);
            document.body.append(state); });</script></body>"""
        policy = re.search('<meta http-equiv="Content-Security-Policy"[^>]*>', page.source).group(0)
        self.write("measured.html", page.source.replace(policy, "").replace("</body>", script))
        for width in (1100, 733):  # A4, 210 mm, less two margins of 14 mm: 688 px; here with a rim of 15 px and a scroll bar
            dom = self.chromium(f"--window-size={width},1600", "--dump-dom", "file://" + self.path("measured.html"))
            table, room, whole, rows = json.loads(re.search('<pre id="state">(.*?)</pre>', dom, re.DOTALL).group(1))
            self.assertLessEqual(table, room, width)
            self.assertLessEqual(whole, width)
            self.assertLess(max(rows), 150, width)

    def test_pages_end_at_no_header_and_before_no_last_row(self):
        """Wherever a page ends: the matrix of the classes is on one page, and the last row of the checklist is not alone."""
        self.results()
        source = self.page().source
        paint = ("<style>table.whole th{background:#f0f!important}table.whole td{background:#0ff!important}"
                 ".a td{background:#f80!important}.b td{background:#08f!important}</style></head>")
        source = source.replace("</head>", paint)
        checklist = source.index("<h2>Before you sign")
        rows = [found.start() for found in re.finditer("<tr", source[checklist:source.index("<table class='sign'")])]
        self.assertGreater(len(rows), 8)
        last, before = (checklist + at for at in (rows[-1], rows[-2]))

        def painted(text, name):
            return re.sub(r"<tr(?: class='\w+')?>", f"<tr class='{name}'>", text, count=1)

        source = source[:before] + painted(source[before:last], "a") + painted(source[last:], "b")
        body, end = source.split("<h3>Classes of hazard</h3>"), "<h2>Before you sign</h2>"
        self.assertEqual((len(body), body[1].count(end)), (2, 1))
        head = body[0].split("<body>")[0] + "<body>"
        for millimetres in range(150, 270, 12):
            space = f"<div style='height:{millimetres}mm'></div>"
            matrix = body[1][:body[1].index("</table>") + 8]
            checks = body[1][body[1].index(end):body[1].index("<h2>Record</h2>")]
            self.write("paged.html", head + space + "<h3>Classes of hazard</h3>" + matrix +
                       "<div style='break-before:page'></div>" + f"<div style='height:{millimetres - 140}mm'></div>" + checks + "</body></html>")
            self.printed(self.path("paged.html"))
            for one, other in (((255, 0, 255), (0, 255, 255)), ((255, 136, 0), (0, 136, 255))):
                pages = [self.pages_with(colour) for colour in (one, other)]
                self.assertEqual(len(pages[0]), 1, (millimetres, one))
                self.assertEqual(pages[0], pages[1], (millimetres, one))

    def pages_with(self, colour):
        """Numbers of the pages of page.pdf with a colour."""
        found = []
        with open(self.path("page.pdf"), "rb") as file:
            count = file.read().count(b"/Type /Page\n")
        for number in range(1, count + 1):
            page = gdal.OpenEx(f"PDF:{number}:{self.path('page.pdf')}", gdal.OF_RASTER, open_options=["DPI=50", "RENDERING_OPTIONS=VECTOR"])
            pixels = page.ReadAsArray()[:3].astype(int)
            if np.any(np.all(np.abs(pixels - np.array(colour)[:, None, None]) < 8, axis=0)):
                found.append(number)
        return found

    def printed(self, page):
        self.chromium("--print-to-pdf=" + self.path("page.pdf"), "file://" + page)
        with open(self.path("page.pdf"), "rb") as file:
            return file.read()


if __name__ == "__main__":
    unittest.main()
