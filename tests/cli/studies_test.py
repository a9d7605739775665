"""The studies in tools/scripts/studies start, and say what they answer; what several of them share does what it says."""
import ast
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

import numpy as np
from osgeo import gdal

STUDIES = Path(__file__).resolve().parents[2] / "tools/scripts/studies"
sys.path.insert(0, str(STUDIES))
import campaign_fits
import files
import mapped_deposits_study


class Help(unittest.TestCase):
    def test_every_study_prints_its_question(self):
        """--help has the first line of the docstring, so that all that a study imports is there."""
        for study in sorted(STUDIES.glob("*.py")):
            text = study.read_text(encoding="utf-8")
            if "parse_args" not in text or "main()" not in text:
                continue
            with self.subTest(study.name):
                done = subprocess.run([sys.executable, study, "--help"], capture_output=True, text=True, env={**os.environ, "COLUMNS": "200"})
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertIn(ast.get_docstring(ast.parse(text)).splitlines()[0], done.stdout)


class MappedDeposits(unittest.TestCase):
    def test_every_kind_of_slope_fills_its_grid(self):
        """360 x 480 m in cells of 4 m (docs/mapped-deposits.md); all heights are 1000 m and more, but for 0.15 m of noise."""
        for kind in mapped_deposits_study.KINDS:
            z = mapped_deposits_study.heights(kind, np.random.default_rng(1))
            self.assertEqual(z.shape, (120, 90), kind)
            self.assertGreater(z.min(), 999.0, kind)


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_a_raster_lies_where_it_is_said(self):
        """2 x 3 cells of 5 m, north-west corner (10, 40): the last cell has its centre 12.5 m east, 7.5 m south of it."""
        files.write_raster(self.folder / "z.tif", np.array([[1.0, 2.0, 3.0], [4.0, 5.0, -9999.0]]), (10.0, 40.0), 5.0, nodata=-9999)
        west, width, _, north, _, height = gdal.Open(str(self.folder / "z.tif")).GetGeoTransform()
        self.assertEqual((west + 2.5 * width, north + 1.5 * height), (22.5, 32.5))
        (values,) = files.read_bands(self.folder / "z.tif")
        np.testing.assert_array_equal(values, [[1.0, 2.0, 3.0], [4.0, 5.0, np.nan]])

    def test_a_layer_takes_the_place_of_an_earlier_one(self):
        path = self.folder / "cliffs.gpkg"
        for count in (3, 1):
            files.write_layer(path, [(files.box(0, 0, 2, 3), "a", 0.5)] * count, [("name", str), ("frequency", float)])
        (cliff,) = [(f["name"], f["frequency"], f.GetGeometryRef().Area()) for f in files.features(path)]
        self.assertEqual(cliff, ("a", 0.5, 6.0))

    def test_a_fit_without_a_start_names_no_file(self):
        """The program refuses a file of parameters that holds none."""
        o = SimpleNamespace(work=str(self.folder), trials=20, starts=1, threads=1)
        for start in ("", "[effects.rest-in-roughness]\nkappa = 0.3\n"):
            with mock.patch.object(campaign_fits, "talus") as talus:
                campaign_fits.fitted(o, "campaigns/elm", "fit", start, 1)
            arguments = talus.call_args.args
            self.assertEqual("--parameters" in arguments, bool(start))
            if start:
                self.assertEqual(Path(arguments[arguments.index("--parameters") + 1]).read_text(encoding="utf-8"), start)


if __name__ == "__main__":
    unittest.main()
