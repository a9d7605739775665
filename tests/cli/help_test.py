"""What the program says of itself, for people and for other programs: help, `help --json`, `--progress=json`."""
import json
import os
import re
import signal
import subprocess
import unittest

from support import TALUS, Case

TYPES = {"file", "folder", "number", "integer", "text", "choice", "flag", "list"}


class Help(Case):
    def setUp(self):
        super().setUp()
        self.program = json.loads(self.run_well("help", "--json").stdout)
        self.commands = {command["name"]: command for command in self.program["commands"]}

    def of(self, command, name):
        found = [p for p in self.commands[command]["parameters"] if p["name"] == name]
        self.assertEqual(len(found), 1, name)
        return found[0]

    def test_no_arguments_print_the_help(self):
        text = self.run_well("--help").stdout
        self.assertEqual(self.run_well().stdout, text)
        self.assertEqual(self.run_well("help").stdout, text)
        self.assertEqual(self.run_well("help", "run").stdout, self.run_well("run", "--help").stdout)
        self.fails(2, "'rnu'", "did you mean 'run'", arguments=["help", "rnu"])

    def test_version_and_commands(self):
        self.assertEqual(self.run_well("--version").stdout, f"talus {self.program['version']}\n")
        listed = re.findall(r"^  ([a-z]+) {2,}\S", self.run_well("--help").stdout.split("Subcommands:")[1], re.M)
        self.assertEqual(list(self.commands), listed)
        self.assertTrue(all(command["text"] for command in self.commands.values()))

    def test_every_flag_of_the_help_is_there_and_no_other(self):
        for name, command in self.commands.items():
            options = self.run_well(name, "--help").stdout.split("Options:")[1]
            shown = {flag for line in options.splitlines() if line.startswith("  -")
                     for flag in re.match(r"  (-[\w-]+(?:,-[\w-]+)*)", line).group(1).split(",")} - {"-h", "--help"}
            given = [flag for p in command["parameters"] for flag in p["flags"]]
            self.assertEqual(set(given), shown, name)
            self.assertEqual(len(given), len(set(given)), name)

    def test_positionals_and_requirements_are_those_of_the_help(self):
        for name, command in self.commands.items():
            text = self.run_well(name, "--help").stdout
            positional = re.findall(r"^  (\w+) ", text.split("Positionals:")[1].split("Options:")[0], re.M) \
                if "Positionals:" in text else []
            self.assertEqual([p["name"] for p in command["parameters"] if p["positional"]], positional, name)
            required = set(re.findall(r"^  (?:-\w,--)?-?-?([\w-]+) .*REQUIRED", text, re.M))
            self.assertEqual({p["name"] for p in command["parameters"] if p["required"]}, required, name)

    def test_every_parameter_is_told_whole(self):
        for name, command in self.commands.items():
            for p in command["parameters"]:
                where = f"{name} {p['name']}"
                self.assertIn(p["type"], TYPES, where)
                self.assertTrue(p["text"], where)
                self.assertIsInstance(p["required"], bool, where)
                self.assertIsInstance(p["repeatable"], bool, where)
                if p["type"] == "file":
                    self.assertLessEqual(set(p["holds"]), {"raster", "vector", "toml", "csv", "html"}, where)
                    self.assertTrue(p["holds"], where)
                if p["type"] == "choice" and p["default"] is not None:
                    self.assertIn(p["default"], p["choices"], where)
                self.assertIn("unit", p, where)
                bounds = p["bounds"]
                self.assertLessEqual(set(bounds), {"low", "low_excluded", "high", "high_excluded"}, where)
                if "low" in bounds and "high" in bounds:
                    self.assertLess(bounds["low"], bounds["high"], where)

    def test_bounds_are_those_that_the_program_keeps(self):
        for name, flag in (("diameter", "--diameter"), ("trajectories", "--trajectories"), ("frequency", "--frequency")):
            p = self.of("run", name)
            more = [] if flag == "--diameter" else ["--diameter", "1"]
            b = p["bounds"]
            for value, good in ((b["low"], not b.get("low_excluded")), (b["high"], not b.get("high_excluded")),
                                (b["low"] - 1, False), (b["high"] * 1.5, False)):
                done = self.call("check", "-q", "--dem", self.path("dem.tif"), "--sources", self.path("sources.gpkg"), *more,
                                 f"{flag}={value:.12g}")
                self.assertEqual(done.returncode == 0, good, (flag, value, done.stderr))

    def test_defaults_are_those_that_a_run_uses(self):
        self.run_well("run", "--dem", self.path("dem.tif"), "--sources", self.path("sources.gpkg"), "--diameter", "0.8",
                      "--trajectories", "3", "-o", self.path("out"))
        text = self.read_text("out/scenario.toml")
        self.assertIn(f"seed = {self.of('run', 'seed')['default']}", text)
        self.assertIn(self.of("run", "preset")["default"], self.of("run", "preset")["choices"])
        self.assertIn(f'default = "{self.of("run", "preset")["default"]}"', text)
        self.assertEqual(self.of("profile", "preset")["default"], "firm-talus-2d")  # docs/profile.md
        thresholds = [float(word) for word in self.of("run", "thresholds")["default"].split(",")]
        told = re.search(r"energy_thresholds = \[(.*?)\]", text).group(1)
        self.assertEqual(thresholds, [float(word) for word in told.split(",")])

    def test_what_a_layer_picker_needs(self):
        self.assertEqual(self.of("run", "dem")["holds"], ["raster"])
        self.assertEqual(self.of("run", "sources")["holds"], ["vector"])
        self.assertEqual(self.of("run", "diameter")["unit"], "m")
        self.assertEqual(self.of("hazard", "objects")["holds"], ["vector"])
        self.assertTrue(self.of("run", "field")["repeatable"])
        self.assertEqual(self.of("run", "thresholds")["of"], "number")
        self.assertTrue(self.of("run", "out")["written"])
        self.assertEqual(self.of("score", "rows")["choices"], ["fit", "holdout", "all"])

    def test_numbers_of_a_scenario(self):
        numbers = {p["name"]: p for p in self.program["scenario"]}
        self.assertEqual(numbers["blocks.density"]["unit"], "kg/m3")
        self.assertEqual(numbers["blocks.density"]["bounds"], {"low": 500, "high": 8000})
        self.assertEqual(numbers["blocks.density"]["default"], 2700)
        self.assertIn("effects.rest-in-roughness.kappa", numbers)


class ProgressAsJson(Case):
    def lines_of(self, *arguments, code=0):
        done = self.call(*arguments, "--progress=json")
        self.assertEqual(done.returncode, code, done.stderr)
        return [json.loads(line) for line in done.stderr.splitlines()]

    def assert_phases(self, lines, *phases):
        steps = [line for line in lines if "phase" in line]
        self.assertEqual(list(dict.fromkeys(step["phase"] for step in steps)), list(phases))
        for phase in phases:
            shares = [step["share"] for step in steps if step["phase"] == phase]
            self.assertEqual(shares, sorted(set(shares)))
            self.assertTrue(all(0.0 <= share <= 1.0 for share in shares))
        self.assertEqual(steps[-1]["share"], 1.0)

    def test_run_and_hazard(self):
        lines = self.lines_of(*self.arguments(trajectories="200"), "--frequency", "0.1")
        self.assert_phases(lines, "simulate", "write")
        self.assertTrue(any("results are in" in line.get("message", "") for line in lines))
        lines = self.lines_of("hazard", self.path("out"), "--objects", self.path("sources.gpkg"))
        self.assert_phases(lines, "evaluate", "write", "simulate")

    def test_rounds_are_named(self):
        lines = self.lines_of(*self.arguments(trajectories="20"), "--rounds", "3")
        self.assertEqual(list(dict.fromkeys(line["part"] for line in lines if line.get("part"))),
                         ["round 1", "round 2", "round 3"])

    def test_warnings_and_errors_are_lines(self):
        # 30 m blocks: no preset was fitted to such
        lines = self.lines_of(*self.arguments(diameter="30", trajectories="5"))
        self.assertTrue(any("warning" in line for line in lines))
        lines = self.lines_of(*self.arguments(diameter="0", out="other"), code=2)
        self.assertEqual(len(lines), 1)
        self.assertIn("diameter", lines[0]["error"])

    def test_names_with_quotes_and_bytes_stay_json(self):
        lines = self.lines_of("run", "--dem", self.path('no "such"\n\\file.tif'), "--sources", self.path("sources.gpkg"),
                              "--diameter", "1", "-o", self.path("out"), code=2)
        self.assertIn('no "such"', lines[0]["error"])

    def test_interrupt(self):
        with subprocess.Popen([TALUS, *self.arguments(trajectories="2000000"), "--progress=json"], stderr=subprocess.PIPE,
                              text=True) as process:
            while json.loads(process.stderr.readline()).get("share", 0.0) < 0.01:
                pass
            process.send_signal(signal.SIGTERM)
            rest = [json.loads(line) for line in process.stderr.read().splitlines()]
            self.assertEqual(process.wait(20), 130)
        self.assertTrue(any("--resume" in line.get("message", "") for line in rest), rest)
        self.assertFalse(os.path.exists(self.path("out/run.json")))

    def test_profile(self):
        valley = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../data/profile/profile.toml")
        lines = self.lines_of("profile", valley, "-o", self.path("p"), "--trajectories", "500")
        self.assert_phases(lines, "simulate", "write")


if __name__ == "__main__":
    unittest.main()
