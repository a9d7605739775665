"""The key and the flag `surface`, from the input to the record, and the warning of dammed cells."""
import json
import re
import unittest

import numpy as np
from osgeo import ogr

from support import NORTH, WEST, Case, RunCase, box, heights, write_dem, write_features


def gully():
    """A V gully at 45 degrees to the grid, from the north-western corner to the south-eastern one; walls of 45 degrees."""
    row, column = np.mgrid[0:60, 0:60]
    along, across = (row + column) * 5 / np.sqrt(2), np.abs(row - column) * 5 / np.sqrt(2)
    return (1000 - 0.7 * along + across).astype(np.float32)


class Surface(RunCase):
    WARNING = "of the ground steeper than half of its friction angle"

    def setting(self, out):
        return next((s["value"], s["source"]) for s in self.record(out)["settings"] if s["key"] == "surface")

    def test_default_key_and_flag(self):
        self.run_scenario("default")
        self.assertEqual(self.setting("default"), ("creased", "default"))
        self.write("s.toml", 'surface = "bilinear"\n' + self.read_text("s.toml"))
        self.run_scenario("key")
        self.assertEqual(self.setting("key"), ("bilinear", "scenario"))
        self.run_scenario("flag", "--surface", "creased")
        self.assertEqual(self.setting("flag"), ("creased", "flag --surface"))
        self.assertEqual(self.hashes("flag")["stops.gpkg"], self.hashes("default")["stops.gpkg"])
        self.run_well("run", self.path("key/scenario.toml"), "-o", self.path("again"), "-q")  # the complete scenario holds it
        self.assertEqual(self.hashes("again")["stops.gpkg"], self.hashes("key")["stops.gpkg"])
        for command in ("run", "check"):
            out = ["-o", self.path("x")] if command == "run" else []
            self.fails(2, "--surface = 'flat'", "'bilinear' or 'creased'", arguments=[command, self.path("s.toml"), "--surface", "flat", *out])
        self.write("wrong.toml", 'surface = "smooth"\n')
        self.fails(2, "wrong.toml:1", "surface = 'smooth'", "'bilinear' or 'creased'",
                   arguments=["run", self.path("wrong.toml"), "--dem", self.path("dem.tif"), "--sources", self.path("sources.gpkg"), "-o", self.path("x")])

    def test_parts_of_different_surfaces_do_not_merge(self):
        self.run_scenario("one", "--part", "1/2")
        self.run_scenario("two", "--part", "2/2", "--surface", "bilinear")
        self.fails(2, "another plan", arguments=["merge", self.path("m"), self.path("one"), self.path("two")])

    def test_dammed_cells_are_counted(self):
        """A V gully at 45 degrees to the grid: each cell of its thalweg is dammed."""
        write_dem(self.path("dem.tif"), gully())
        for surface, word in (("bilinear", "dams them"), ("creased", "staircases")):
            done = self.run_well("check", self.path("s.toml"), "--surface", surface)
            self.assertRegex(done.stdout, r"(?m)^dammed +58 cells ")
            line = next(line for line in done.stdout.splitlines() if line.startswith("warning") and self.WARNING in line)
            self.assertIn("58 cells of the DEM (1.7 % of", line)  # of 58 x 58: those at the edge have no slope
            self.assertIn(word, line)
        write_dem(self.path("dem.tif"), heights())
        self.assertNotIn(self.WARNING, self.run_well("check", self.path("s.toml")).stdout)

    def test_noise_on_a_plain_gives_no_warning(self):
        """Of nine equal draws the centre is the least of itself and its four sides, but not of all nine: 1/5 - 1/9."""
        z = (1000 + np.random.default_rng(1).normal(0, 0.05, (60, 60))).astype(np.float32)
        write_dem(self.path("dem.tif"), z)
        done = self.run_well("check", self.path("s.toml"))
        dammed = int(re.search(r"(?m)^dammed +(\d+) cells ", done.stdout)[1])
        self.assertAlmostEqual(dammed / 58**2, 1 / 5 - 1 / 9, delta=0.02)
        self.assertEqual([line for line in done.stdout.splitlines() if line.startswith("warning") and "diagonally" in line], [])

    def test_more_plain_around_a_gully_does_not_hide_it(self):
        lines = []
        for plain in (0, 400):
            z = np.full((60, 60 + plain), 2000.0, np.float32)
            z[:, :60] = gully()
            write_dem(self.path("dem.tif"), z)
            lines.append(next(line for line in self.run_well("check", self.path("s.toml")).stdout.splitlines() if self.WARNING in line))
        self.assertRegex(lines[1], r"58 cells of the DEM \(1\.7 % of")

    def test_dams_count_above_half_of_the_friction_angle(self):
        """The thalweg of the gully falls by atan(0.7) = 34.99 degrees: half of 69.98. A zone has its own angle."""
        write_dem(self.path("dem.tif"), gully())
        write_features(self.path("zones.gpkg"), "zones", [(box(0, 150, 150, 150), ["upper"])], [("zone", ogr.OFTString)])
        with open(self.path("s.toml"), encoding="utf-8") as file:
            scenario = file.read()
        for phi, upper, cells in ((69, 69, 58), (71, 71, 0), (69, 71, 29), (71, 69, 29)):
            self.write("s.toml", scenario + f'[ground]\nfile = "zones.gpkg"\nfield = "zone"\n[ground.zones.default]\nphi = {phi}\n'
                       f'[ground.zones.upper]\npreset = "upper-talus-3d"\nphi = {upper}\n')
            said = self.run_well("check", self.path("s.toml")).stdout
            self.assertEqual(f"{cells} cells of the DEM" in said, cells > 0, said)
            self.assertEqual(self.WARNING in said, cells > 0, said)


class OfACampaign(Case):
    def test_a_model_tells_on_which_surface_it_was_fitted(self):
        blocks = "".join(f"b{i},{WEST + 60 + 5 * i},{NORTH - 40},1,{400 + 20 * i}\n" for i in range(20))
        self.write("blocks.csv", "id,x,y,release_height_m,mass_kg\n" + blocks)
        self.write("c.toml", 'dem = "dem.tif"\nblocks = "blocks.csv"\nsurface = "bilinear"\n')
        self.write("m.toml", 'surface = "creased"\n[ground]\ndefault = "upper-talus-3d"\n')
        score = ["score", self.path("c.toml"), "--parameters", self.path("m.toml"), "--trials", "10"]
        done = self.run_well(*score, "--dump", self.path("dump"))
        self.assertIn("fitted on a creased surface", done.stderr)
        self.assertIn("bilinear surface", done.stdout)
        done = self.run_well(*score, "--surface", "creased", "--json", "--dump", self.path("dump2"))
        self.assertNotIn("fitted on", done.stderr)
        self.assertEqual(json.loads(done.stdout)["surface"], "creased")
        self.fails(2, "--surface = 'flat'", arguments=[*score, "--surface", "flat"])
        self.write("s.toml", 'include = "m.toml"\ndem = "dem.tif"\nsurface = "bilinear"\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 1\n')
        self.assertIn("was fitted on a creased surface", self.run_well("check", self.path("s.toml")).stdout)

    def test_a_model_says_so_where_it_is_used_on_cells_of_another_size(self):
        self.write("m.toml", 'fitted_cell = 9\n[ground]\ndefault = "upper-talus-3d"\n')
        self.write("s.toml", 'include = "m.toml"\ndem = "dem.tif"\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = 1\n')
        self.assertIn("fitted on cells of 9 m", self.run_well("check", self.path("s.toml")).stdout)
        self.write("m.toml", 'fitted_cell = 5\n[ground]\ndefault = "upper-talus-3d"\n')
        self.assertNotIn("fitted on cells", self.run_well("check", self.path("s.toml")).stdout)
        self.write("m.toml", "fitted_cell = -1\n")
        self.fails(2, "fitted_cell = -1", arguments=["check", self.path("s.toml")])

    def test_a_model_says_so_where_it_is_used_on_other_blocks_or_with_another_c(self):
        model = 'fitted_diameters = [0.4, 1]\n[model]\ndeformation_coefficient = 0.25\n[ground.zones.default]\nEn50 = 7\n'
        text = 'include = "m.toml"\ndem = "dem.tif"\n[sources]\nfile = "sources.gpkg"\n[blocks]\ndiameter = {}\n[model]\ndeformation_coefficient = {}\n'
        self.write("m.toml", model)
        for diameter, c, others, changed in ((1, 0.25, False, False), (6, 0.25, True, False), (1, 0.15, False, True),
                                             ("[0.361, 1.099]", 0.25, False, False), (1.11, 0.25, True, False)):
            self.write("s.toml", text.format(diameter, c))
            said = self.run_well("check", self.path("s.toml")).stdout
            self.assertEqual("m.toml (0.4 to 1 m); larger blocks" in said, others, said)
            self.assertEqual("fitted with the deformation coefficient c = 0.25, and this run takes 0.15" in said, changed, said)
        self.write("s.toml", text.format(0.359, 0.25))
        self.assertIn("m.toml (0.4 to 1 m); smaller blocks", self.run_well("check", self.path("s.toml")).stdout)
        self.write("m.toml", "fitted_diameters = [1, 0.4]\n")
        self.fails(2, "fitted_diameters", "[smallest, largest]", arguments=["check", self.path("s.toml")])


if __name__ == "__main__":
    unittest.main()
