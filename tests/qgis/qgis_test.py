"""The plug-in in QGIS, without a window: by qgis_process, and from Python as the toolbox does it.

Run by tools/scripts/checks/qgis.sh, which sets HOME, QGIS_PLUGINPATH and TALUS.
"""
import csv
import glob
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import xml.etree.ElementTree as xml

from osgeo import gdal, ogr, osr
from qgis.core import (QgsApplication, QgsCoordinateReferenceSystem, QgsFeature, QgsFeatureRequest, QgsField, QgsGeometry, QgsLayerTreeModel,
                       QgsMapRendererParallelJob, QgsMapSettings, QgsProcessingAlgRunnerTask, QgsProcessingContext,
                       QgsProcessingFeatureSourceDefinition, QgsProcessingFeedback, QgsProcessingModelAlgorithm,
                       QgsProcessingModelChildAlgorithm, QgsProcessingModelChildParameterSource,
                       QgsProcessingOutputLayerDefinition, QgsProcessingParameterBand, QgsProcessingParameterBoolean,
                       QgsProcessingParameterDefinition, QgsProject,
                       QgsRasterLayer, QgsRasterRange, QgsRectangle, QgsVectorLayer, QgsVectorLayerJoinInfo)
from qgis.PyQt.QtCore import QEventLoop, QLocale, QSize, Qt, QTimer, QVariant
from qgis.PyQt.QtGui import QColor

sys.path.append("/usr/share/qgis/python/plugins")  # of Processing
sys.path.append(os.environ["QGIS_PLUGINPATH"])

HERE = os.path.dirname(os.path.abspath(__file__))
VALLEY = os.path.join(HERE, "../../data/valley")
DEM = os.path.join(VALLEY, "dem.tif")
ALGORITHMS = ["barrier", "calibrate", "check", "compare", "diagnose", "hazard", "objects", "profile", "run", "sources"]
QGIS_PROCESS = shutil.which("qgis_process.bin") or "qgis_process"  # Debian's own wrapper fails in 3.22

application = None


def setUpModule():
    global application
    gdal.UseExceptions()
    ogr.UseExceptions()
    application = QgsApplication([], False)
    application.initQgis()
    from processing.core.Processing import Processing
    Processing.initialize()
    from talus_qgis.provider import TalusProvider
    application.talus = TalusProvider()
    QgsApplication.processingRegistry().addProvider(application.talus)


def commands_of_the_program():
    done = subprocess.run([os.environ["TALUS"], "help", "--json"], capture_output=True, check=True)
    return {command["name"]: command for command in json.loads(done.stdout)["commands"]}


class Log(QgsProcessingFeedback):
    """Keeps what the log would show, and may cancel."""

    def __init__(self, cancel_at=None):
        super().__init__(False)
        self.warnings, self.infos, self.steps, self.cancelled = [], [], [], None
        if cancel_at is not None:
            self.progressChanged.connect(lambda share: self._cancel() if share >= cancel_at and not self.cancelled else None)
        self.progressChanged.connect(self.steps.append)

    def _cancel(self):
        self.cancelled = time.monotonic()
        self.cancel()

    def pushWarning(self, text):
        self.warnings.append(text)

    def pushInfo(self, text):
        self.infos.append(text)


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="talus-qgis-")
        self.addCleanup(shutil.rmtree, self.folder, True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def run_algorithm(self, name, parameters, log=None, context=None):
        algorithm = QgsApplication.processingRegistry().createAlgorithmById("talus:" + name)
        context = context or QgsProcessingContext()
        context.setProject(QgsProject.instance())
        good, message = algorithm.checkParameterValues(parameters, context)
        self.assertTrue(good, message)
        results, done = algorithm.run(parameters, context, log or Log())
        return results, done

    def cliffs(self):
        layer = QgsVectorLayer(os.path.join(VALLEY, "cliffs.shp"), "cliffs", "ogr")
        self.assertTrue(layer.isValid())
        return layer

    def cliffs_in_memory(self):
        cliffs = self.cliffs()
        memory = QgsVectorLayer("MultiPolygon?crs=EPSG:4326", "in memory", "memory")
        memory.dataProvider().addAttributes(cliffs.fields().toList())
        memory.updateFields()
        rows = []
        for feature in cliffs.getFeatures():
            row = QgsFeature(memory.fields())
            row.setGeometry(QgsGeometry(feature.geometry()))
            row.setAttributes(feature.attributes())
            rows.append(row)
        memory.dataProvider().addFeatures(rows)
        return memory

    def inputs(self, **more):
        return {"DEM": DEM, "SOURCES": os.path.join(VALLEY, "cliffs.shp"), "DIAMETER": 1.0, "TRAJECTORIES": 5,
                "OUT": self.path("out"), "LOAD": False, **more}

    def written(self, pattern):
        """The files that the plug-in has written for the program."""
        return sorted(glob.glob(self.path(pattern)))

    def record(self, out="out"):
        with open(self.path(out + "/run.json"), encoding="utf-8") as file:
            return json.load(file)


class Provider(Case):
    def test_all_algorithms_are_listed(self):
        expected = sorted(ALGORITHMS + (["report"] if "report" in commands_of_the_program() else []))
        self.assertEqual(sorted(a.name() for a in application.talus.algorithms()), expected)

    def test_parameters_are_those_of_the_program(self):
        left_out = {"quiet", "progress", "allow-network", "sources-layer", "field", "memory", "part", "checkpoint"}
        for algorithm in application.talus.algorithms():
            command = commands_of_the_program()[algorithm.table["command"]]
            names = {d.name() for d in algorithm.parameterDefinitions()}
            for parameter in command["parameters"]:
                if parameter["name"] not in left_out:
                    self.assertIn(parameter["name"].upper().replace("-", "_"), names, algorithm.id())

    def test_no_default_hides_what_a_file_says(self):
        """A campaign gives its surface, a profile its number of blocks: untouched dialogs pass neither."""
        for algorithm in application.talus.algorithms():
            for p in algorithm.parameterDefinitions():
                if not isinstance(p, (QgsProcessingParameterBoolean, QgsProcessingParameterBand)) and not p.isDestination():
                    self.assertIsNone(p.defaultValue(), f"{algorithm.id()} {p.name()}")
        calibrate = QgsApplication.processingRegistry().algorithmById("talus:calibrate")
        self.assertIn("(creased if not set)", calibrate.parameterDefinition("SURFACE").description())
        self.assertIn("At least 20.", calibrate.parameterDefinition("TRIALS").help())

    def test_a_layer_of_the_undefined_system_is_refused(self):
        from talus_qgis import layers
        layer = QgsVectorLayer("Point?crs=EPSG:2056", "houses", "memory")
        layers.refuse_without_system(layer)
        undefined = QgsCoordinateReferenceSystem()
        undefined.createFromWkt('LOCAL_CS["Undefined Cartesian SRS",UNIT["metre",1]]')
        for system in undefined, QgsCoordinateReferenceSystem():
            layer.setCrs(system)
            with self.assertRaisesRegex(Exception, "houses has no coordinate system"):
                layers.refuse_without_system(layer)

    def test_bounds_and_choices(self):
        run = QgsApplication.processingRegistry().algorithmById("talus:run")
        diameter = run.parameterDefinition("DIAMETER")
        self.assertEqual((diameter.minimum(), diameter.maximum()), (0.01, 50.0))
        self.assertIn("lower-talus-3d", run.parameterDefinition("PRESET").options())
        good, message = run.checkParameterValues({"OUT": "x"}, QgsProcessingContext())
        self.assertFalse(good)

    def test_what_a_newcomer_needs_is_not_under_advanced(self):
        run = QgsApplication.processingRegistry().algorithmById("talus:run")
        for name in ("OVERWRITE", "DIAMETER_MIN_FIELD", "DIAMETER_MAX_FIELD", "DIAMETER_FIELD", "OUT", "RESUME"):
            self.assertFalse(run.parameterDefinition(name).flags() & QgsProcessingParameterDefinition.FlagAdvanced, name)
        for name in ("DEM", "SOURCES"):
            self.assertIn("needed without a scenario", run.parameterDefinition(name).description())
        self.assertIn("their field named frequency is read", run.parameterDefinition("FREQUENCY_FIELD").help())
        self.assertIn("is read where no field is picked", run.shortHelpString())

    def test_no_parameter_is_called_by_its_flag(self):
        """Each has words of its own in both languages, and a help in German."""
        from talus_qgis import texts
        for algorithm in application.talus.algorithms():
            for p in algorithm.described():
                if p["name"] not in ("quiet", "progress", "allow-network", "sources-layer", "field", "memory", "part", "checkpoint"):
                    self.assertIn(p["name"], texts.LABELS, algorithm.id())
                    self.assertIn(p["text"], texts.GERMAN, algorithm.id())
                if p["unit"]:
                    self.assertIn(p["unit"], [*texts.GERMAN, "s", "m", "m3", "kg/m3", "kJ", "%"], algorithm.id())

    def test_a_profile_has_a_number_of_blocks(self):
        """It has one source, and no cells."""
        from talus_qgis import texts
        profile = QgsApplication.processingRegistry().algorithmById("talus:profile")
        self.assertTrue(profile.parameterDefinition("TRAJECTORIES").description().startswith("Number of blocks"))
        self.assertEqual(texts.LABELS["number-of-blocks"][1], "Zahl der Blöcke")
        run = QgsApplication.processingRegistry().algorithmById("talus:run")
        self.assertTrue(run.parameterDefinition("TRAJECTORIES").description().startswith("Trajectories per source cell"))

    def test_the_help_says_more_than_the_label_and_names_no_flag(self):
        from talus_qgis import texts
        before = QLocale()
        try:
            for language in ("en", "de_CH"):
                QgsApplication.setLocale(QLocale(language))
                said = {}
                for name in ALGORITHMS:
                    text = QgsApplication.processingRegistry().createAlgorithmById("talus:" + name).shortHelpString()
                    self.assertNotRegex(text, r"(?<![\w-])--[a-z]", name)
                    said[name] = dict(re.findall(r"<p><b>([^<]*)</b>(.*?)</p>", text))
                find = lambda name, begin: next(help for title, help in said[name].items() if title.startswith(begin))
                german = language != "en"
                self.assertEqual(find("run", texts.label("diameter")), "")  # of the blocks
                self.assertEqual(find("run", texts.label("trajectories")), "")
                self.assertEqual(find("run", texts.label("seed")), ": gleicher Startwert, gleiche Ergebnisse" if german else "")
                self.assertEqual(find("barrier", texts.label("percentile")), ": 95 (Vorgabe)" if german else ": 95 (default)")
                self.assertEqual(find("barrier", texts.label("volume")), ": der grösste Durchgang, wenn nicht angegeben" if german
                                 else ": the largest that crosses where it is not given")
                self.assertIn(texts.label("objects"), find("objects", texts.label("width-field")) if not german else texts.label("objects"))
                self.assertIn(texts.label("pits"), find("check", texts.label("overwrite")) if not german else texts.label("pits"))
        finally:
            QgsApplication.setLocale(before)

    def test_german(self):
        from talus_qgis import texts
        before = QLocale()
        QgsApplication.setLocale(QLocale("de_CH"))
        try:
            self.assertTrue(texts.german())
            run = QgsApplication.processingRegistry().createAlgorithmById("talus:run")
            self.assertIn("Durchmesser", run.parameterDefinition("DIAMETER").description())
            self.assertIn("Gelände", run.parameterDefinition("DEM").help())
            self.assertEqual(run.displayName(), "Simulation rechnen")
        finally:
            QgsApplication.setLocale(before)

    def test_every_german_text_of_the_program_is_one_that_it_says(self):
        from talus_qgis import texts
        said = {p["text"] for c in commands_of_the_program().values() for p in c["parameters"]}
        with open(texts.__file__, encoding="utf-8") as source:
            of_program = source.read().split("# of the program")[1]
        for text in texts.GERMAN:
            if (f'"{text}"' if len(text) < 40 else f'"{text[:40]}') in of_program:
                self.assertIn(text, said)

    def test_a_missing_program_is_said(self):
        from talus_qgis import program
        before = os.environ["TALUS"]
        os.environ["TALUS"] = "/nowhere/talus"
        try:
            run = QgsApplication.processingRegistry().createAlgorithmById("talus:run")
            can, message = run.canExecute()
            self.assertFalse(can)
            self.assertIn("/nowhere/talus", message)
            self.assertIn("apt install", message)
            self.assertEqual(run.checkParameterValues({"DEM": DEM}, QgsProcessingContext()), (False, message))
        finally:
            os.environ["TALUS"] = before
        self.assertTrue(program.path())


class ByQgisProcess(Case):
    def call(self, algorithm, *arguments, code=0):
        done = subprocess.run([QGIS_PROCESS, "run", "talus:" + algorithm, "--", *arguments], capture_output=True, text=True,
                              timeout=300, check=False)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def two_layers(self):
        """The cliffs in EPSG:4326, second in a GeoPackage."""
        path = self.path("two.gpkg")
        gdal.VectorTranslate(path, os.path.join(VALLEY, "houses.gpkg"), format="GPKG", layerName="houses")
        gdal.VectorTranslate(path, os.path.join(VALLEY, "cliffs.shp"), format="GPKG", layerName="cliffs",
                             accessMode="update", geometryType="PROMOTE_TO_MULTI")
        file = ogr.Open(path)
        self.assertEqual(file.GetLayerByName("cliffs").GetSpatialRef().GetAuthorityCode(None), "4326")
        return path

    def test_run_then_hazard_then_barrier(self):
        text = self.call("run", f"DEM={DEM}", f"SOURCES={self.two_layers()}|layername=cliffs", "DIAMETER_MIN_FIELD=diameter_m",
                         "DIAMETER_MAX_FIELD=diameter_1", "TRAJECTORIES=20", f"SCREENS={VALLEY}/screens.gpkg",
                         "PRESET=upper-talus-3d", f"OUT={self.path('out')}", "SEED=3")
        self.assertIn("WARNING", text)  # of the program: sizes other than those the preset was fitted to
        self.assertIn("block sizes", text)
        record = self.record()
        self.assertEqual(record["released"], 957 * 20)  # 957 source cells: data/valley/README.md, scenario.toml
        flags = " ".join(record["command"])
        for word in ("--field=diameter_min=diameter_m", "layername=cliffs", "--seed=3"):
            self.assertIn(word, flags)
        self.assertIn(self.path("out/impact_probability.tif"), text)
        text = self.call("hazard", f"FOLDER={self.path('out')}", f"OBJECTS={VALLEY}/houses.gpkg", "WIDTH=10")
        self.assertTrue(os.path.exists(self.path("out/hazard_class.tif")))
        self.assertTrue(os.path.exists(self.path("out/objects.gpkg")))
        text = self.call("barrier", f"FOLDER={self.path('out')}", "SCREEN=road")
        self.assertTrue(os.path.exists(self.path("out/barrier_road.csv")))
        self.assertIn(f"LINE:\t{self.path('out/barrier_road.gpkg')}|layername=barrier_road", text)
        if "report" in commands_of_the_program():
            self.call("report", f"FOLDER={self.path('out')}", f"OUT={self.path('page.html')}")
            self.assertGreater(os.path.getsize(self.path("page.html")), 10000)
            text = self.call("report", f"FOLDER={self.path('out')}")
            self.assertIn(self.path("out/report.html"), text)  # the result, where no name was given

    def test_what_is_wrong_is_one_clear_line(self):
        text = self.call("run", f"DEM={DEM}", f"SOURCES={VALLEY}/houses.gpkg", f"OUT={self.path('out')}", code=1)
        self.assertIn("has no block diameter", text)
        text = self.call("run", f"DEM={DEM}", f"SOURCES={self.two_layers()}", "DIAMETER=1", f"OUT={self.path('out')}", code=1)
        self.assertIn(f"two.gpkg has several layers (houses, cliffs): name one, as {self.path('two.gpkg')}|layername=houses", text)
        self.assertFalse(os.path.exists(self.path("out")))

    def test_a_temporary_folder(self):
        text = self.call("run", f"DEM={DEM}", f"SOURCES={VALLEY}/cliffs.shp", "TRAJECTORIES=1", "OUT=TEMPORARY_OUTPUT")
        self.assertRegex(text, r"RECORD:\s+\S+/OUT/run.json")
        self.assertIn("temporary folder, which QGIS removes", text)

    def few_blocks(self):
        """The first twelve blocks of the campaign of elm."""
        folder = self.path("few")
        shutil.copytree(os.path.join(HERE, "../../data/elm"), folder)
        for name, rows in (("blocks", 12), ("stops", 12), ("passages", 24)):
            with open(f"{folder}/{name}.csv", "r+", encoding="utf-8") as file:
                kept = file.readlines()[:1 + rows]
                file.seek(0)
                file.writelines(kept)
                file.truncate()
        return folder + "/campaign.toml"

    def test_profile(self):
        """Along a line that is drawn in another system; no file is written by hand."""
        line = self.path("line.geojson")  # in EPSG:4326
        drawn = self.path("drawn.geojson")
        with open(drawn, "w", encoding="utf-8") as file:
            file.write('{"type": "LineString", "coordinates": [[2650100, 1170500], [2651000, 1170500]]}')
        gdal.VectorTranslate(line, drawn, format="GeoJSON", srcSRS="EPSG:2056", dstSRS="EPSG:4326", reproject=True)
        text = self.call("profile", f"DEM={DEM}", f"LINE={line}", "SOURCE_X=20,60", "DIAMETER=1.2", "SCREEN_X=300", "TRAJECTORIES=20",
                         f"OUT={self.path('out')}")
        self.assertEqual(self.record()["released"], 20)
        self.assertIn(self.path("out/profile.svg"), text)

    def test_calibrate_then_diagnose(self):
        campaign = self.few_blocks()
        text = self.call("calibrate", f"CAMPAIGN={campaign}", "FIT=phi", "TRIALS=20", "STARTS=1", f"OUT={self.path('fit')}")
        self.assertIn(f"FITTED:\t{self.path('fit/fitted.toml')}", text)
        fitted = self.path("fit/fitted.toml")
        text = self.call("diagnose", f"CAMPAIGN={campaign}", "FIT=phi", f"PARAMETERS={fitted}", "TRIALS=10", "TEST_TRIALS=10", "BASE_FITS=1",
                         "MOST_EFFECTS=1", "NO_NESTED=true", f"OUT={self.path('why')}")
        self.assertIn(f"REPORT:\t{self.path('why/report.html')}", text)
        with open(self.path("why/diagnosis.json"), encoding="utf-8") as file:
            command = json.load(file)["command"]
        for word in ("--base-fits=1", "--no-nested", "--fit=phi", f"--parameters={fitted}"):
            self.assertIn(word, command)

    def test_sources_and_check(self):
        self.call("sources", f"DEM={DEM}", f"OUT={self.path('cells.gpkg')}", "SLOPE=50")
        text = self.call("check", f"DEM={DEM}", f"SOURCES={self.path('cells.gpkg')}|layername=source_polygons", "DIAMETER=1")
        self.assertIn("releases", text)
        self.assertIn("EPSG:2056", text)


class Commands(Case):
    """The run of a command: talus_qgis.process."""

    def script(self, name, *lines):
        path = self.path(name)
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(("#!/bin/sh", *lines, "")))
        os.chmod(path, 0o755)
        return path

    def alive(self):
        """Commands that work in the folder of this test."""
        listed = subprocess.run(["ps", "-eo", "args="], capture_output=True, text=True, check=False).stdout
        return [line for line in listed.splitlines() if self.folder in line]

    def test_cancel_ends_what_a_script_has_started(self):
        script = self.script("talus", f'"{os.environ["TALUS"]}" "$@"', "exit $?")
        before = os.environ["TALUS"]
        os.environ["TALUS"] = script
        try:
            log = Log(cancel_at=10.0)
            _, good = self.run_algorithm("run", self.inputs(TRAJECTORIES=150), log)
            ended = time.monotonic()
        finally:
            os.environ["TALUS"] = before
        self.assertFalse(good)
        self.assertLess(ended - log.cancelled, 2.0)
        self.assertEqual(self.alive(), [])
        self.assertIn("Resume", log.textLog())

    def test_what_does_not_end_is_ended_by_force(self):
        from talus_qgis import process
        stubborn = self.script("stubborn", "trap '' TERM", "echo '{\"phase\": \"write\", \"share\": 0.5}' >&2",
                               "while :; do sleep 0.1; done")
        script = self.script("talus", f"{stubborn} &", "wait")
        log, before = Log(cancel_at=10.0), process.PATIENCE
        process.PATIENCE = 0.5
        try:
            with self.assertRaisesRegex(Exception, "Cancelled"):
                process.run([script], log, process.Progress(log, ["write"]))
        finally:
            process.PATIENCE = before
        self.assertLess(time.monotonic() - log.cancelled, 2.0)
        self.assertEqual(self.alive(), [])

    def test_a_run_that_succeeds_is_not_cancelled(self):
        from talus_qgis import process
        said = "echo '{\"phase\": \"write\", \"share\": 1}' >&2"
        log = Log(cancel_at=99.0)
        process.run([self.script("last", "trap '' TERM", said, "sleep 0.3")], log, process.Progress(log, ["write"]))
        self.assertIsNotNone(log.cancelled)
        with self.assertRaisesRegex(Exception, "Cancelled"):
            log = Log(cancel_at=99.0)
            process.run([self.script("early", said, "sleep 5")], log, process.Progress(log, ["write"]))

    def test_the_time_that_is_left(self):
        """Ten percent of the bar in 60 s: 40 % are left four times as long. A resumed run counts from where it goes on."""
        from talus_qgis import process
        log, times = Log(), iter((0.0, 5.0, 60.0, 100.0, 118.0))
        said = []
        log.setProgressText = said.append
        progress = process.Progress(log, ["simulate"], clock=lambda: next(times))
        for share in 0.0, 0.5, 0.51, 0.6, 0.9, 0.99:  # the program always says 0 first
            progress.show({"phase": "simulate", "share": share})
        self.assertEqual(said, ["Simulating", "Simulating (about 4 min left)", "Simulating (less than a minute left)"])
        said.clear()
        progress = process.Progress(log, ["simulate"], None, clock=iter((0.0, 300.0, 600.0)).__next__)
        for name, share in ("round 1", 0.1), ("round 1", 1.0), ("round 2", 0.1):  # rounds until an error: nobody knows
            progress.show({"phase": "simulate", "part": name, "share": share})
        self.assertEqual(said, ["Simulating round 1", "Simulating round 2"])

    def test_notes_below_a_table_are_warnings(self):
        from talus_qgis import process
        log = Log()
        process.run([self.script("talus", "echo 'table  1'", "echo 'note: too low'", "echo 'warning: too few'")], log,
                    process.Progress(log, []))
        self.assertEqual(log.warnings, ["too low", "too few"])

    def test_the_help_is_a_page_where_there_is_one(self):
        from talus_qgis import algorithms, program
        here = os.path.dirname(program.__file__)
        for table in algorithms.ALGORITHMS:
            self.assertTrue(program.help_page(table["help"]).endswith(f"/docs/{table['help']}.md"), table["id"])
        self.assertEqual(program.help_page(), "file://" + os.path.normpath(os.path.join(here, "../../../docs/qgis.md")))
        os.makedirs(self.path("bin"))
        os.makedirs(self.path("share/doc/talus/html"))
        shutil.copy(shutil.which("true"), self.path("bin/talus"))
        before, os.environ["TALUS"] = os.environ["TALUS"], self.path("bin/talus")
        try:
            for name in ("share/doc/talus/qgis.md", "share/doc/talus/html/qgis.html"):
                with open(self.path(name), "w", encoding="utf-8") as file:
                    file.write("x")
            self.assertEqual(program.help_page(), "file://" + self.path("share/doc/talus/html/qgis.html"))
        finally:
            os.environ["TALUS"] = before

    def test_the_command_of_the_log_can_be_pasted_into_a_shell(self):
        from talus_qgis import process
        words = ["--name=it's \"$HOME\"; echo `id` & *", "a b", "", "(x)", "back\\slash", "two\nlines"]
        printed = subprocess.run(["sh", "-c", process.shown(["printf", "%s\\0", *words])], capture_output=True, check=True).stdout
        self.assertEqual(printed.decode().split("\0")[:-1], words)


class FromPython(Case):
    def test_memory_layer_equals_its_file(self):
        cliffs, memory = self.cliffs(), self.cliffs_in_memory()
        fields = {"DIAMETER_MIN_FIELD": "diameter_m", "DIAMETER_MAX_FIELD": "diameter_1"}
        for out, source in (("file", cliffs), ("memory", memory)):
            results, good = self.run_algorithm("run", self.inputs(SOURCES=source, OUT=self.path(out), **fields))
            self.assertTrue(good)
        self.assertEqual(len(self.written("memory_inputs/sources_*/sources.gpkg")), 1)
        self.assertEqual(self.record("file")["ends"], self.record("memory")["ends"])
        a, b = (gdal.Open(self.path(out + "/passages.tif")).ReadAsArray() for out in ("file", "memory"))
        self.assertTrue((a == b).all())

    def three_lines(self):
        """Lines from south to north, 450, 550 and 650 m from the western edge, with the numbers (FID) 1 to 3 and no field."""
        layer = QgsVectorLayer("LineString?crs=EPSG:2056", "lines", "memory")
        for x in (2650450, 2650550, 2650650):
            feature = QgsFeature()
            feature.setGeometry(QgsGeometry.fromWkt(f"LineString({x} 1170050, {x} 1170950)"))
            layer.dataProvider().addFeatures([feature])
        QgsProject.instance().addMapLayer(layer)
        self.addCleanup(QgsProject.instance().removeMapLayer, layer.id())
        return layer

    def screens(self, out):
        """The distance of each screen from the western edge [m]."""
        return {screen["id"]: round(screen["lines"][0][0][0]) - 2650000 for screen in self.record(out)["screens"]}

    def test_selected_features_keep_their_numbers(self):
        lines = self.three_lines()
        lines.selectByIds([2, 3])
        _, good = self.run_algorithm("run", self.inputs(SCREENS=QgsProcessingFeatureSourceDefinition(lines.id(), True)))
        self.assertTrue(good)
        self.assertEqual(self.screens("out"), {"2": 550, "3": 650})
        # a copy of the copy: its column of numbers is a field in QGIS
        copy = QgsVectorLayer(self.written("out_inputs/screens_*/screens.gpkg")[0], "copy", "ogr")
        QgsProject.instance().addMapLayer(copy)
        self.addCleanup(QgsProject.instance().removeMapLayer, copy.id())
        copy.selectByIds([3])
        _, good = self.run_algorithm("run", self.inputs(SCREENS=QgsProcessingFeatureSourceDefinition(copy.id(), True),
                                                        OUT=self.path("again")))
        self.assertTrue(good)
        self.assertEqual(self.screens("again"), {"3": 650})

    def test_the_numbers_of_a_shapefile_begin_at_0(self):
        cliffs = self.cliffs()
        cliffs.selectByIds([0, 3, 5])
        QgsProject.instance().addMapLayer(cliffs)
        self.addCleanup(QgsProject.instance().removeMapLayer, cliffs.id())
        names = {feature.id(): feature["name"] for feature in cliffs.getSelectedFeatures()}
        self.run_algorithm("run", self.inputs(SOURCES=QgsProcessingFeatureSourceDefinition(cliffs.id(), True)))
        written = ogr.Open(self.written("out_inputs/sources_*/sources.gpkg")[0])
        self.assertEqual({feature.GetFID(): feature.GetField("name") for feature in written.GetLayer(0)}, names)
        self.assertEqual(sorted(names), [0, 3, 5])

    def test_features_that_are_not_saved_are_numbered_anew_and_that_is_said(self):
        lines = self.three_lines()
        lines.startEditing()
        self.addCleanup(lines.rollBack)
        feature = QgsFeature(lines.fields())
        feature.setGeometry(QgsGeometry.fromWkt("LineString(2650350 1170050, 2650350 1170950)"))
        lines.addFeature(feature)
        lines.deleteFeature(1)
        log = Log()
        _, good = self.run_algorithm("run", self.inputs(SCREENS=lines), log)
        self.assertTrue(good, log.textLog())
        self.assertEqual(sorted(self.screens("out")), ["1", "2", "3"])
        self.assertEqual(sorted(self.screens("out").values()), [350, 550, 650])
        self.assertTrue(any("lines: some features have no number yet" in text for text in log.warnings), log.warnings)

    def test_an_invalid_polygon_is_mended_by_the_program(self):
        """In a task, as from the dialog, and as Processing is set by default: it stops at an invalid geometry, and QGIS 3.22
        itself ended."""
        bow = QgsVectorLayer("Polygon?crs=EPSG:2056", "bow-tie", "memory")
        feature = QgsFeature()
        feature.setGeometry(QgsGeometry.fromWkt("Polygon((2650300 1170600, 2650340 1170640, 2650340 1170600, 2650300 1170640, "
                                                "2650300 1170600))"))
        bow.dataProvider().addFeatures([feature])
        QgsProject.instance().addMapLayer(bow)
        self.addCleanup(QgsProject.instance().removeMapLayer, bow.id())
        context, log, ended = QgsProcessingContext(), Log(), []
        context.setProject(QgsProject.instance())
        context.setInvalidGeometryCheck(QgsFeatureRequest.GeometryAbortOnInvalid)
        algorithm = QgsApplication.processingRegistry().createAlgorithmById("talus:run")
        task = QgsProcessingAlgRunnerTask(algorithm, self.inputs(SOURCES=bow), context, log)
        loop = QEventLoop()
        task.executed.connect(lambda good, results: (ended.append(good), loop.quit()))
        QTimer.singleShot(60000, loop.quit)
        QgsApplication.taskManager().addTask(task)
        loop.exec_()
        self.assertEqual(ended, [True], log.textLog())
        self.assertTrue(any("mended" in text for text in log.warnings), log.warnings)
        # two triangles of 40 x 20 m / 2 in cells of 4 m: 50 cells, to those on the edges
        self.assertAlmostEqual(self.record()["released"] / 5, 50, delta=12)

    def test_a_selection_of_a_shapefile_keeps_the_fields_that_it_cuts(self):
        cliffs = self.cliffs()
        cliffs.selectAll()
        QgsProject.instance().addMapLayer(cliffs)
        self.addCleanup(QgsProject.instance().removeMapLayer, cliffs.id())
        inputs = self.inputs()
        del inputs["DIAMETER"]  # the features have their own: diameter_min, cut to diameter_m
        for out, selected in (("all", False), ("selected", True)):
            source = QgsProcessingFeatureSourceDefinition(cliffs.id(), selected)
            _, good = self.run_algorithm("run", {**inputs, "SOURCES": source, "OUT": self.path(out)})
            self.assertTrue(good)
        self.assertEqual(self.record("all")["ends"], self.record("selected")["ends"])
        self.assertEqual(len(self.written("selected_inputs/sources_*/sources.gpkg")), 1)

    def test_selected_features_and_filters(self):
        cliffs = self.cliffs()
        cliffs.selectByIds([1, 2])
        area = {f.id(): f.geometry().area() for f in cliffs.getFeatures()}
        QgsProject.instance().addMapLayer(cliffs)
        self.addCleanup(QgsProject.instance().removeMapLayer, cliffs.id())
        chosen = QgsProcessingFeatureSourceDefinition(cliffs.id(), True)
        self.run_algorithm("run", self.inputs(SOURCES=chosen, OUT=self.path("selected")))
        self.run_algorithm("run", self.inputs(SOURCES=cliffs.id(), OUT=self.path("all")))
        cliffs.setSubsetString("\"name\" <> 'x'")
        filtered = QgsProcessingFeatureSourceDefinition(cliffs.id(), False)
        self.run_algorithm("run", self.inputs(SOURCES=filtered, OUT=self.path("filtered")))
        some, everything = self.record("selected")["released"], self.record("all")["released"]
        self.assertEqual(everything, 957 * 5)
        # the cells of two features are the share of their area, to the cells on the edges
        share = (area[1] + area[2]) / sum(area.values())
        self.assertAlmostEqual(some / everything, share, delta=0.05)
        self.assertEqual(self.record("filtered")["released"], everything)
        self.assertEqual(len(self.written("selected_inputs/sources_*/sources.gpkg")), 1)
        self.assertFalse(os.path.exists(self.path("all_inputs")))

    def test_an_empty_selection_is_refused(self):
        cliffs = self.cliffs()
        QgsProject.instance().addMapLayer(cliffs)
        self.addCleanup(QgsProject.instance().removeMapLayer, cliffs.id())
        log = Log()
        _, good = self.run_algorithm("run", self.inputs(SOURCES=QgsProcessingFeatureSourceDefinition(cliffs.id(), True)), log)
        self.assertFalse(good)
        self.assertIn("has no feature", log.textLog())

    def test_another_band(self):
        two = self.path("two_bands.tif")
        dem = gdal.Open(DEM)
        out = gdal.GetDriverByName("GTiff").Create(two, dem.RasterXSize, dem.RasterYSize, 2, gdal.GDT_Float32)
        out.SetGeoTransform(dem.GetGeoTransform())
        out.SetProjection(dem.GetProjection())
        out.GetRasterBand(1).WriteArray(dem.ReadAsArray() * 0 + 7)
        out.GetRasterBand(2).WriteArray(dem.ReadAsArray())
        for i in (1, 2):
            out.GetRasterBand(i).SetNoDataValue(dem.GetRasterBand(1).GetNoDataValue())
        out = None
        self.run_algorithm("run", self.inputs(OUT=self.path("one")))
        _, good = self.run_algorithm("run", self.inputs(DEM=two, DEM_BAND=2, OUT=self.path("second")))
        self.assertTrue(good)
        self.assertEqual(self.record("one")["ends"], self.record("second")["ends"])

    def test_cells_without_data_are_those_of_qgis(self):
        """Further values and ranges, and the file's own value switched off: what QGIS shows as nodata has no height."""
        values = gdal.Open(DEM).ReadAsArray()[:90, :90].copy()
        dem = gdal.Open(DEM)
        values[:, 25:40], values[3, :], values[5, :] = 1234.0, 2000.5, -9999.0
        out = gdal.GetDriverByName("GTiff").Create(self.path("void.tif"), 90, 90, 1, gdal.GDT_Float32)
        out.SetGeoTransform(dem.GetGeoTransform())
        out.SetProjection(dem.GetProjection())
        out.GetRasterBand(1).SetNoDataValue(-9999.0)
        out.GetRasterBand(1).WriteArray(values)
        out = None
        from talus_qgis import layers
        low = QgsRasterRange(float("nan"), 1234.0, QgsRasterRange.IncludeMax)
        for ranges, of_file in (([QgsRasterRange(1234.0, 1234.0)], True), ([low], False), ([], False),
                                ([QgsRasterRange(1234.0, 2000.5, QgsRasterRange.IncludeMin), low], True), ([], True)):
            layer = QgsRasterLayer(self.path("void.tif"), "void", "gdal")
            layer.dataProvider().setUserNoDataValue(1, ranges)
            layer.dataProvider().setUseSourceNoDataValue(1, of_file)
            shown = layer.dataProvider().block(1, layer.extent(), 90, 90)
            file = layers.raster_file(layers.raster_copy(layer), 1, self.path("in"), "dem", Log())
            self.assertEqual(file == self.path("void.tif"), not ranges and of_file)
            written = gdal.Open(file)
            read, nodata = written.ReadAsArray(), written.GetRasterBand(1).GetNoDataValue()
            for row in range(90):
                for column in range(90):
                    value = read[row, column]
                    self.assertEqual(bool(value == nodata or value != value), shown.isNoData(row, column), (ranges, row, column))
                    if not shown.isNoData(row, column):
                        self.assertEqual(value, values[row, column])
        QgsProject.instance().addMapLayer(layer)
        self.addCleanup(QgsProject.instance().removeMapLayer, layer.id())
        layer.dataProvider().setUserNoDataValue(1, [QgsRasterRange(1234.0, 1234.0)])
        log = Log()
        self.run_algorithm("check", self.inputs(DEM=layer), log)  # its cliffs lie off this corner
        self.assertIn("dem.tif", log.textLog())

    def two_rasters_of_two_bands(self):
        """The terrain and a raster of zones, each in the second band of a file, with one name of layer."""
        dem = gdal.Open(DEM)
        found = []
        for name, values in (("a", dem.ReadAsArray()), ("b", dem.ReadAsArray() * 0 + 1)):
            out = gdal.GetDriverByName("GTiff").Create(self.path(name + ".tif"), dem.RasterXSize, dem.RasterYSize, 2,
                                                       gdal.GDT_Float32)
            out.GetRasterBand(1).WriteArray(values * 0 + 7)
            out.GetRasterBand(2).WriteArray(values)
            out.SetGeoTransform(dem.GetGeoTransform())
            out.SetProjection(dem.GetProjection())
            out = None
            found.append(QgsRasterLayer(self.path(name + ".tif"), "same name", "gdal"))
        return found

    def test_rasters_of_one_name_are_two_files(self):
        from talus_qgis import layers
        first, second = self.two_rasters_of_two_bands()
        a = layers.raster_file(first, 2, self.path("in"), "dem", Log())
        b = layers.raster_file(second, 2, self.path("in"), "zones", Log())
        again = layers.raster_file(first, 2, self.path("in"), "dem", Log())
        self.assertEqual(a, again)
        self.assertEqual(len(self.written("in/*/*")), 2)
        self.assertTrue((gdal.Open(a).ReadAsArray() == gdal.Open(DEM).ReadAsArray()).all())
        self.assertTrue((gdal.Open(b).ReadAsArray() == 1).all())

    def test_nothing_is_left_of_a_raster_that_cannot_be_written(self):
        from talus_qgis import layers
        first, _ = self.two_rasters_of_two_bands()
        with self.assertRaises(Exception):
            layers.raster_file(first, 9, self.path("in"), "dem", Log())
        stopped = Log()
        stopped.cancel()
        with self.assertRaisesRegex(Exception, "Cancelled"):
            layers.raster_file(first, 2, self.path("in"), "dem", stopped)
        self.assertFalse(os.path.exists(self.path("in")))

    def test_each_check_has_a_folder_of_its_own(self):
        algorithm = QgsApplication.processingRegistry().createAlgorithmById("talus:check")
        context = QgsProcessingContext()
        self.assertNotEqual(algorithm._folder({}, context), algorithm._folder({}, context))

    def test_the_sources_of_a_result_stay_as_they_were(self):
        """A second run with other sources, refused for want of --overwrite."""
        some, all_of_them = self.cliffs_in_memory(), self.cliffs_in_memory()
        some.dataProvider().deleteFeatures([f.id() for f in some.getFeatures()][2:])
        _, good = self.run_algorithm("run", self.inputs(SOURCES=some))
        self.assertTrue(good)
        given = next(i["path"] for i in self.record()["inputs"] if i["role"] == "sources").split("|")[0]
        with open(given, "rb") as file:
            before = file.read()
        log = Log()
        _, good = self.run_algorithm("run", self.inputs(SOURCES=all_of_them), log)
        self.assertFalse(good)
        self.assertIn("overwrite", log.textLog())
        with open(given, "rb") as file:
            self.assertEqual(file.read(), before)
        self.assertEqual(QgsVectorLayer(given, "", "ogr").featureCount(), some.featureCount())
        self.assertEqual(len(self.written("out_inputs/*")), 1)  # nothing of what was refused

    def test_no_inputs_are_left_of_a_run_that_is_refused(self):
        log = Log()
        _, good = self.run_algorithm("run", self.inputs(SOURCES=self.cliffs_in_memory(), THRESHOLDS="30,x"), log)
        self.assertFalse(good)
        self.assertIn("--thresholds", log.textLog())
        self.assertEqual(self.written("out*"), [])

    def test_choices_by_their_numbers(self):
        """As QGIS lists them for scripts; the text of a choice is the usual way."""
        _, good = self.run_algorithm("run", self.inputs(PRESET=5, SURFACE="1"))
        self.assertTrue(good)
        settings = {s["key"]: s["value"] for s in self.record()["settings"]}
        self.assertEqual(settings["surface"], "bilinear")
        self.assertIn("forest-road-3d", str(settings))
        algorithm = QgsApplication.processingRegistry().createAlgorithmById("talus:run")
        good, message = algorithm.checkParameterValues(self.inputs(PRESET=99), QgsProcessingContext())
        self.assertFalse(good)
        self.assertIn("PRESET", message)

    def test_pits_of_a_check_are_loaded(self):
        results, good = self.run_algorithm("check", self.inputs(PITS=self.path("pits.gpkg"), OUT=None))
        self.assertTrue(good)
        self.assertTrue(QgsVectorLayer(results["PITS"], "", "ogr").isValid())
        results, good = self.run_algorithm("check", self.inputs(OUT=None))
        self.assertTrue(good)
        self.assertEqual(results, {})

    def test_a_profile_over_a_terrain_is_loaded_and_one_of_a_file_is_not(self):
        line = QgsVectorLayer("LineString?crs=EPSG:2056", "line", "memory")
        drawn = QgsFeature()
        drawn.setGeometry(QgsGeometry.fromWkt("LineString (2650100 1170500, 2651000 1170500)"))
        line.dataProvider().addFeature(drawn)
        along = {"DEM": DEM, "LINE": line, "SOURCE_X": "20,60", "DIAMETER": 1.2}
        for more, layers in ({**along, "SCREEN_X": "300"}, 4), (along, 3), (  # without places it has no crossings
                {"PROFILE": os.path.join(HERE, "../../data/profile/profile.toml")}, 0):
            context = QgsProcessingContext()
            _, good = self.run_algorithm("profile", {"TRAJECTORIES": 20, "OUT": self.path(f"profile{layers}"), "LOAD": True, **more},
                                         context=context)
            self.assertTrue(good)
            self.assertEqual(len(context.layersToLoadOnCompletion()), layers)
        algorithm = QgsApplication.processingRegistry().createAlgorithmById("talus:profile")
        good, message = algorithm.checkParameterValues({"DEM": DEM, "LINE": line, "OUT": self.path("none")}, QgsProcessingContext())
        self.assertEqual((good, message), (False, "Give the terrain, a line over it, where blocks start and their diameter, or the file of a profile."))

    def test_a_diameter_that_is_given_goes_before_those_of_the_sources(self):  # which are 0.5 to 1.8 m
        log = Log()
        _, good = self.run_algorithm("run", self.inputs(TRAJECTORIES=1, DIAMETER=0.7), log)
        self.assertTrue(good, log.textLog())
        self.assertTrue(any("The diameter is that which was given" in text for text in log.infos), log.infos)
        stops = QgsVectorLayer(self.path("out/stops.gpkg") + "|layername=stops", "stops", "ogr")
        self.assertEqual({stop["diameter_m"] for stop in stops.getFeatures()}, {0.7})

    def test_cancel_while_a_layer_is_written(self):
        from talus_qgis import layers

        class AtSecond(Log):
            asked = 0

            def isCanceled(self):
                self.asked += 1
                return self.asked > 1

        source = self.as_source(self.cliffs_in_memory())
        whole = layers.write_vector(source, self.path("in"), "sources.gpkg", QgsProcessingContext(), Log())
        with open(whole, "rb") as file:
            before = file.read()
        with self.assertRaisesRegex(Exception, "Cancelled"):
            layers.write_vector(source, self.path("in"), "sources.gpkg", QgsProcessingContext(), AtSecond())
        with open(whole, "rb") as file:
            self.assertEqual(file.read(), before)
        self.assertEqual(self.written("in/*"), [os.path.dirname(whole)])

    def as_source(self, layer):
        algorithm = QgsApplication.processingRegistry().createAlgorithmById("talus:run")
        context = QgsProcessingContext()
        self.kept = [*getattr(self, "kept", []), (algorithm, layer, context)]
        context.setProject(QgsProject.instance())
        return algorithm.parameterAsSource({"SOURCES": layer}, "SOURCES", context)

    def test_the_date_of_writing_is_set_for_one_thread(self):
        from talus_qgis import layers
        seen = []

        class Looks(Log):
            def isCanceled(self):
                other = threading.Thread(target=lambda: seen.append(gdal.GetConfigOption("OGR_CURRENT_DATE")))
                other.start()
                other.join()
                return False

        source = self.as_source(self.cliffs_in_memory())
        files = [layers.write_vector(source, self.path(name), "sources.gpkg", QgsProcessingContext(), Looks())
                 for name in ("a", "b") if not time.sleep(0.01)]
        self.assertEqual(set(seen), {None})
        self.assertIsNone(gdal.GetConfigOption("OGR_CURRENT_DATE"))
        self.assertEqual(*(os.path.basename(os.path.dirname(file)) for file in files))  # the checksum of the content
        with open(files[0], "rb") as file:
            self.assertIn(b"2000-01-01T00:00:00.000Z", file.read())

    def test_a_layer_of_one_kind_of_geometry_is_not_the_file(self):
        """A GeoJSON with polygons and lines, of which QGIS shows the polygons."""
        from talus_qgis import layers
        rings = '[[[7.1, 46.1], [7.2, 46.1], [7.2, 46.2], [7.1, 46.1]]]'
        shapes = [f'{{"type": "Polygon", "coordinates": {rings}}}', f'{{"type": "LineString", "coordinates": {rings[1:-1]}}}']
        with open(self.path("mixed.geojson"), "w", encoding="utf-8") as file:
            file.write('{"type": "FeatureCollection", "features": [' + ", ".join(
                f'{{"type": "Feature", "properties": {{"a": 1}}, "geometry": {shape}}}' for shape in shapes) + "]}")
        name = self.path("mixed.geojson")
        for rest in ("|geometrytype=Polygon", "|layername=mixed|geometrytype=Polygon", "|layerid=0|geometrytype=Polygon"):
            polygons = QgsVectorLayer(name + rest, "", "ogr")
            self.assertEqual(polygons.featureCount(), 1)
            self.assertIsNone(layers.plain_vector(polygons, polygons))
            copy = layers.write_vector(self.as_source(polygons), self.path("in"), "sources.gpkg", QgsProcessingContext(), Log())
            self.assertEqual(QgsVectorLayer(copy, "", "ogr").featureCount(), 1)
        cliffs = self.cliffs()
        self.assertEqual(layers.plain_vector(cliffs, cliffs), os.path.join(VALLEY, "cliffs.shp"))
        self.assertIsNone(layers.plain_vector(cliffs, QgsVectorLayer(cliffs.source() + "|option:ENCODING=UTF-8", "", "ogr")))

    def test_virtual_and_joined_fields_are_handed_over(self):
        gdal.VectorTranslate(self.path("names.shp"), os.path.join(VALLEY, "cliffs.shp"), selectFields=["name"])
        virtual, joined, table = (QgsVectorLayer(self.path("names.shp"), "cliffs", "ogr") for _ in range(3))
        virtual.addExpressionField("1.5", QgsField("mine", QVariant.Double))
        table.addExpressionField("1.5", QgsField("size_of_block", QVariant.Double))
        QgsProject.instance().addMapLayer(table)
        self.addCleanup(QgsProject.instance().removeMapLayer, table.id())
        join = QgsVectorLayerJoinInfo()
        join.setJoinLayer(table)
        join.setJoinFieldName("name")
        join.setTargetFieldName("name")
        join.setPrefix("j_")
        join.setUsingMemoryCache(True)
        joined.addJoin(join)
        for out, layer, field in (("virtual", virtual, "mine"), ("joined", joined, "j_size_of_block")):
            inputs = self.inputs(SOURCES=layer, OUT=self.path(out), DIAMETER_FIELD=field)
            del inputs["DIAMETER"]
            log = Log()
            _, good = self.run_algorithm("run", inputs, log)
            self.assertTrue(good, log.textLog())
        for out in ("virtual", "joined"):
            self.assertEqual(len(self.written(out + "_inputs/*/sources.gpkg")), 1)  # a Shapefile would cut the name
        given = self.inputs(SOURCES=self.path("names.shp"), OUT=self.path("given"), DIAMETER=1.5)
        self.run_algorithm("run", given)
        self.assertEqual(self.record("virtual")["ends"], self.record("joined")["ends"])
        self.assertEqual(self.record("virtual")["ends"], self.record("given")["ends"])

    def road(self, **more):
        """The road of the valley alone, in EPSG:4326, with its `id` and a width."""
        gdal.VectorTranslate(self.path("road.gpkg"), os.path.join(VALLEY, "screens.gpkg"), format="GPKG", layerName="road",
                             dstSRS="EPSG:4326", SQLDialect="sqlite", SQLStatement="SELECT geom, id, CAST(6 AS INTEGER) AS width"
                             " FROM screens WHERE id = 'road'", **more)
        return self.path("road.gpkg") + "|layername=road"

    def test_road_and_houses_are_objects_together(self):
        """As one layer that GDAL has joined; a single layer is read as it is."""
        _, good = self.run_algorithm("run", self.inputs(FREQUENCY_FIELD="frequency", TRAJECTORIES=2))
        self.assertTrue(good)
        houses = os.path.join(VALLEY, "houses.gpkg")
        for name, objects in (("one", houses), ("list", [houses]), ("both", [houses, self.road()])):
            shutil.copytree(self.path("out"), self.path(name))
            log = Log()
            _, good = self.run_algorithm("objects", {"FOLDER": self.path(name), "OBJECTS": objects, "LOAD": False}, log)
            self.assertTrue(good, log.textLog())
        self.assertEqual((self.written("one_inputs"), self.written("list_inputs")), ([], []))
        self.assertEqual(len(self.written("both_inputs/objects_*/objects.gpkg")), 1)
        gdal.VectorTranslate(self.path("by_gdal.gpkg"), houses, format="GPKG", layerName="objects", geometryType="GEOMETRY")
        gdal.VectorTranslate(self.path("by_gdal.gpkg"), os.path.join(VALLEY, "screens.gpkg"), format="GPKG", layerName="objects",
                             accessMode="append", SQLDialect="sqlite", addFields=True, SQLStatement="SELECT geom, id, id AS name, "
                             "6 AS width FROM screens WHERE id = 'road'")
        shutil.copytree(self.path("out"), self.path("gdal"))
        subprocess.run([os.environ["TALUS"], "hazard", self.path("gdal"), "--objects", self.path("by_gdal.gpkg"), "-q"], check=True)
        found, wanted = (self.rows(name + "/objects.csv") for name in ("both", "gdal"))
        self.assertEqual([row["object"] for row in wanted], [row["object"] for row in found])
        self.assertEqual(wanted[-1]["object"], "road")
        self.assertGreater(float(wanted[-1]["trajectories"]), 50.0)
        self.assertEqual((found[-1]["id"], float(found[-1]["width"])), ("road", 6.0))
        # to EPSG:4326 and back: some mm, and so a block more or less at the edge
        self.assertAlmostEqual(float(found[-1]["trajectories"]) / float(wanted[-1]["trajectories"]), 1.0, delta=0.02)

    def test_fields_of_objects_by_name(self):
        """The road counts as wide as its field Breite, and is called by its field Strasse."""
        self.run_algorithm("run", self.inputs(FREQUENCY_FIELD="frequency", TRAJECTORIES=2))
        gdal.VectorTranslate(self.path("names.gpkg"), os.path.join(VALLEY, "screens.gpkg"), format="GPKG", layerName="road",
                             SQLDialect="sqlite", SQLStatement="SELECT geom, 'Dorfstrasse' AS Strasse, 6 AS Breite FROM screens"
                             " WHERE id = 'road'")
        log = Log()
        _, good = self.run_algorithm("objects", {"FOLDER": self.path("out"), "OBJECTS": self.path("names.gpkg"), "LOAD": False,
                                                 "WIDTH_FIELD": "Breite", "NAME_FIELD": "Strasse"}, log)
        self.assertTrue(good, log.textLog())
        self.assertNotIn("no width", log.textLog())
        self.assertEqual([row["object"] for row in self.rows("out/objects.csv")], ["Dorfstrasse"])

    def test_a_script_may_give_selected_objects(self):
        self.run_algorithm("run", self.inputs(FREQUENCY_FIELD="frequency", TRAJECTORIES=2))
        houses = QgsVectorLayer(os.path.join(VALLEY, "houses.gpkg"), "houses", "ogr")
        houses.selectByIds([2])
        QgsProject.instance().addMapLayer(houses)
        self.addCleanup(QgsProject.instance().removeMapLayer, houses.id())
        chosen = QgsProcessingFeatureSourceDefinition(houses.id(), True)
        log = Log()
        _, good = self.run_algorithm("objects", {"FOLDER": self.path("out"), "OBJECTS": chosen, "LOAD": False}, log)
        self.assertTrue(good, log.textLog())
        self.assertEqual([row["object"] for row in self.rows("out/objects.csv")], [houses.getFeature(2)["name"]])

    def rows(self, name):
        with open(self.path(name), encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_numbers_of_features_are_no_fields_of_objects(self):
        """QGIS shows those of a GeoPackage as a field fid: nobody has to rename it. One of a Shapefile is a field."""
        self.run_algorithm("run", self.inputs(FREQUENCY_FIELD="frequency", TRAJECTORIES=2))
        houses = QgsVectorLayer(os.path.join(VALLEY, "houses.gpkg"), "houses", "ogr")
        self.assertIn("fid", houses.fields().names())
        houses.selectByIds([2])
        QgsProject.instance().addMapLayer(houses)
        self.addCleanup(QgsProject.instance().removeMapLayer, houses.id())
        gdal.VectorTranslate(self.path("own.shp"), os.path.join(VALLEY, "houses.gpkg"), SQLDialect="sqlite",
                             SQLStatement="SELECT geom, name, 7 AS number FROM houses LIMIT 1")
        own = ogr.Open(self.path("own.shp"), 1)
        own.GetLayer(0).AlterFieldDefn(1, ogr.FieldDefn("fid", ogr.OFTInteger), ogr.ALTER_NAME_FLAG)
        own = None
        for objects, told in (([os.path.join(VALLEY, "houses.gpkg"), self.road()], False),
                              (QgsProcessingFeatureSourceDefinition(houses.id(), True), False),
                              ([self.path("own.shp"), self.road()], True)):
            log = Log()
            _, good = self.run_algorithm("objects", {"FOLDER": self.path("out"), "OBJECTS": objects, "LOAD": False, "OVERWRITE": True}, log)
            self.assertTrue(good, log.textLog())
            self.assertEqual("are not copied" in " ".join(log.warnings), told, log.warnings)

    def test_an_object_layer_that_is_not_there_is_refused(self):
        self.run_algorithm("run", self.inputs(FREQUENCY_FIELD="frequency", TRAJECTORIES=2))
        algorithm = QgsApplication.processingRegistry().createAlgorithmById("talus:objects")
        log, context = Log(), QgsProcessingContext()
        objects = [os.path.join(VALLEY, "houses.gpkg"), self.path("nowhere.gpkg")]
        _, good = algorithm.run({"FOLDER": self.path("out"), "OBJECTS": objects, "LOAD": False}, context, log)
        self.assertFalse(good)
        self.assertIn("nowhere.gpkg", log.textLog())

    def test_the_encoding_is_that_of_qgis(self):
        """A Shapefile whose text is UTF-8 and that does not say so."""
        gdal.VectorTranslate(self.path("cliffs.shp"), os.path.join(VALLEY, "cliffs.shp"), layerCreationOptions=["ENCODING=UTF-8"],
                             SQLStatement="SELECT 'Süd' AS name FROM cliffs")
        os.remove(self.path("cliffs.cpg"))
        layer = QgsVectorLayer(self.path("cliffs.shp"), "cliffs", "ogr")
        self.assertEqual(self.handed_over(layer), self.path("cliffs.shp"))
        layer.setProviderEncoding("UTF-8")
        written = ogr.Open(self.handed_over(layer))
        self.assertEqual({feature.GetField("name") for feature in written.GetLayer(0)}, {"Süd"})

    def test_fields_that_a_geopackage_cannot_hold_as_they_are(self):
        """A field `geom`, and names that differ only in case: all values are handed over, and a picked field is followed."""
        layer = QgsVectorLayer("LineString?crs=EPSG:2056&field=NAME:string&field=name:string&field=geom:string&field=Name:string"
                               "&field=name_2:string&field=D:double&field=d:double", "cliffs", "memory")
        feature = QgsFeature(layer.fields())
        feature.setGeometry(QgsGeometry.fromWkt("LineString(2650300 1170600, 2650340 1170640)"))
        feature.setAttributes(["a", "b", "c", "e", "f", 1.5, 9.0])
        layer.dataProvider().addFeatures([feature])
        file = ogr.Open(self.handed_over(layer))
        values = file.GetLayer(0).GetNextFeature().items()
        self.assertEqual(values.pop("name"), "b")  # the one that the program reads
        self.assertEqual(values.pop("geom"), "c")
        self.assertEqual(sorted(map(str, values.values())), ["1.5", "9.0", "a", "e", "f"])
        log = Log()
        _, good = self.run_algorithm("run", {**self.inputs(SOURCES=layer, DIAMETER_FIELD="D", NAME_FIELD="NAME"), "DIAMETER": None},
                                     log)
        self.assertTrue(good, log.textLog())
        self.assertTrue(any("the field D is handed over as D_2" in text for text in log.warnings), log.warnings)
        self.assertLessEqual({"--field=diameter=D_2", "--field=name=NAME_3"}, set(self.record()["command"]))
        stops = ogr.Open(self.path("out/stops.gpkg"))
        self.assertEqual({stop.GetField("diameter_m") for stop in stops.GetLayer(0)}, {1.5})

    def handed_over(self, layer):
        """The file of a layer, or the copy of it."""
        from talus_qgis import layers
        return layers.plain_vector(layer, layer) or layers.write_vector(self.as_source(layer), self.path("in"), "sources.gpkg",
                                                                       QgsProcessingContext(), Log())

    def test_one_of_several_layers_without_features(self):
        """Is refused as a layer alone is: its objects would be missing without a word."""
        self.run_algorithm("run", self.inputs(TRAJECTORIES=5))
        shutil.copy(os.path.join(VALLEY, "houses.gpkg"), self.path("houses.gpkg"))  # QGIS writes into a file that it filters
        houses = QgsVectorLayer(self.path("houses.gpkg"), "houses", "ogr")
        self.assertTrue(houses.setSubsetString("fid < 0"))
        log = Log()
        _, good = self.run_algorithm("objects", {"FOLDER": self.path("out"), "OBJECTS": [self.road(), houses]}, log)
        self.assertFalse(good)
        self.assertIn("houses has no feature", log.textLog())

    def test_joined_fields_keep_their_values(self):
        from talus_qgis import layers
        layer = QgsVectorLayer("LineString?crs=EPSG:2056&field=id:string&field=WIDTH:integer&field=note:integer", "a", "memory")
        other = QgsVectorLayer("Polygon?crs=EPSG:2056&field=name:string&field=width:double&field=note:string", "b", "memory")
        for target, shape, values in ((layer, "LineString(2650000 1170000, 2650010 1170000)", ["r", 6, 7]),
                                      (other, "Polygon((2650000 1170000, 2650010 1170000, 2650000 1170010, 2650000 1170000))",
                                       ["h", 1.5, "x"])):
            feature = QgsFeature(target.fields())
            feature.setGeometry(QgsGeometry.fromWkt(shape))
            feature.setAttributes(values)
            target.dataProvider().addFeatures([feature])
        sources = [self.as_source(layer), self.as_source(other)]
        joined = layers.Joined(sources, QgsProcessingContext(), Log())
        file = layers.write_vector(joined, self.path("in"), "objects.gpkg", QgsProcessingContext(), Log())
        written = ogr.Open(file)
        rows = [[row.GetField(name) for name in ("id", "width", "note", "name")] + [row.GetGeometryRef().GetGeometryName()]
                for row in written.GetLayer(0)]
        self.assertEqual(rows, [["r", 6.0, "7", "r", "LINESTRING"], [None, 1.5, "x", "h", "POLYGON"]])

    def test_an_error_says_what_the_dialog_calls_its_flags(self):
        inputs = self.inputs(SOURCES=os.path.join(VALLEY, "houses.gpkg"))
        del inputs["DIAMETER"]
        log = Log()
        _, good = self.run_algorithm("run", inputs, log)
        self.assertFalse(good)
        line = log.textLog().strip().splitlines()[-1]
        self.assertIn('In this dialog --diameter / [blocks] diameter is "Diameter of the blocks"', line)
        self.assertIn('--field is "Field: diameter of the block [m]"', line)
        os.makedirs(self.path("out"))
        with open(self.path("out/mine.txt"), "w", encoding="utf-8") as file:
            file.write("x")
        log = Log()
        self.run_algorithm("run", self.inputs(), log)
        self.assertIn('In this dialog --overwrite is "Replace earlier results"', log.textLog())
        log = Log()
        self.run_algorithm("check", self.inputs(SOURCES=os.path.join(VALLEY, "houses.gpkg"), ZONE_FIELD="x"), log)
        self.assertIn('--zones is "Zones of ground (polygons)"', log.textLog())

    def test_a_temporary_folder_is_not_resumed(self):
        log = Log(cancel_at=10.0)
        temporary = self.inputs(OUT="TEMPORARY_OUTPUT", TRAJECTORIES=150)
        _, good = self.run_algorithm("run", temporary, log)
        self.assertFalse(good)
        self.assertIn("A run into a temporary folder cannot be resumed", log.textLog())
        run = QgsApplication.processingRegistry().createAlgorithmById("talus:run")
        for folder in ("TEMPORARY_OUTPUT", QgsProcessingOutputLayerDefinition("TEMPORARY_OUTPUT")):
            good, message = run.checkParameterValues({**temporary, "OUT": folder, "RESUME": True}, QgsProcessingContext())
            self.assertFalse(good)
            self.assertIn("needs the folder of the run", message)
        good, message = run.checkParameterValues({**temporary, "OUT": self.path("out"), "RESUME": True}, QgsProcessingContext())
        self.assertTrue(good, message)

    def test_a_decimal_comma_is_refused(self):
        """QGIS takes a text that is no number for 0 where a parameter may be left out."""
        run = QgsApplication.processingRegistry().createAlgorithmById("talus:run")
        for key, text, number in (("DIAMETER", "1,2", "1.2"), ("TRAJECTORIES", "many", "1.2"), ("UNTIL_ERROR", "0,1", "0.1")):
            good, message = run.checkParameterValues(self.inputs(**{key: text}), QgsProcessingContext())
            self.assertFalse(good)
            self.assertEqual(message, f"{key}: '{text}' is no number: write {number}")
        good, message = run.checkParameterValues(self.inputs(DIAMETER="1.2", TRAJECTORIES="5"), QgsProcessingContext())
        self.assertTrue(good, message)

    def test_a_number_out_of_bounds_is_told_them(self):
        for name, values, fault in (("run", self.inputs(DIAMETER=60.0), "DIAMETER: 60.0 must be 50 at most"),
                                    ("calibrate", {"CAMPAIGN": ["campaign.toml"], "TRIALS": 10, "OUT": self.path("out")},
                                     "TRIALS: 10 must be 20 at least")):
            algorithm = QgsApplication.processingRegistry().createAlgorithmById("talus:" + name)
            self.assertEqual(algorithm.checkParameterValues(values, QgsProcessingContext()), (False, fault))

    def test_a_misspelt_parameter_is_refused(self):
        """QGIS passes over it: the deformation coefficient would be the default one, without a word."""
        run = QgsApplication.processingRegistry().createAlgorithmById("talus:run")
        for key, near in (("DEFORMATION_COEFICIENT", "; is DEFORMATION_COEFFICIENT meant?"), ("diameter", "; is DIAMETER meant?"),
                          ("XYZ", "")):
            good, message = run.checkParameterValues({**self.inputs(), key: 0.15}, QgsProcessingContext())
            self.assertFalse(good)
            self.assertEqual(message, f"{key}: no such parameter of talus:run" + near)

    def test_a_given_frequency_counts_instead_of_the_field(self):
        """The cliffs of the valley have a field frequency: the program takes one of the two."""
        log = Log()
        _, good = self.run_algorithm("check", self.inputs(FREQUENCY=3.0, WIDTH=10), log)
        self.assertTrue(good, log.textLog())
        self.assertTrue(any("a field frequency of the sources is not read" in line for line in log.infos), log.infos)
        self.assertIn("WIDTH: no such parameter of talus:check; it is not used", log.warnings)

    def test_a_run_that_is_done_is_loaded_when_it_is_resumed(self):
        self.run_algorithm("run", self.inputs())
        long_ago = time.time() - 3600.0
        for file in self.written("out/*"):
            os.utime(file, (long_ago, long_ago))
        first, again = QgsProcessingContext(), QgsProcessingContext()
        self.run_algorithm("run", self.inputs(LOAD=True, OUT=self.path("fresh")), context=first)
        _, good = self.run_algorithm("run", self.inputs(LOAD=True, RESUME=True), context=again)
        self.assertTrue(good)
        self.assertGreater(len(first.layersToLoadOnCompletion()), 5)
        self.assertEqual(len(again.layersToLoadOnCompletion()), len(first.layersToLoadOnCompletion()))

    def test_warnings_and_progress_reach_the_log(self):
        log = Log()
        _, good = self.run_algorithm("run", self.inputs(DIAMETER=5.0), log)
        self.assertTrue(good)
        self.assertTrue(any("block sizes" in text for text in log.warnings), log.warnings)
        self.assertEqual(log.steps, sorted(log.steps))
        self.assertGreater(len(log.steps), 20)
        self.assertEqual(log.steps[-1], 100.0)

    def test_cancel_and_resume(self):
        inputs = self.inputs(SOURCES=self.cliffs_in_memory(), TRAJECTORIES=150)  # written twice: the bytes must be the same
        log = Log(cancel_at=10.0)
        _, good = self.run_algorithm("run", inputs, log)
        ended = time.monotonic()
        self.assertFalse(good)
        self.assertLess(ended - log.cancelled, 2.0)
        self.assertEqual(self.children(), [])
        self.assertFalse(os.path.exists(self.path("out/run.json")))
        self.assertIn("Resume", log.textLog())
        again = Log()
        _, good = self.run_algorithm("run", {**inputs, "RESUME": True}, again)
        self.assertTrue(good, again.textLog())
        self.assertTrue(any("going on" in text for text in again.infos), again.infos)
        self.run_algorithm("run", {**inputs, "OUT": self.path("whole")})
        a, b = (gdal.Open(self.path(out + "/passages.tif")).ReadAsArray() for out in ("out", "whole"))
        self.assertTrue((a == b).all())

    def children(self):
        found = subprocess.run(["ps", "--ppid", str(os.getpid()), "-o", "comm="], capture_output=True, text=True, check=False)
        return [name for name in found.stdout.split() if "talus" in name]

    def test_results_are_a_group_with_styles(self):
        context = QgsProcessingContext()
        self.run_algorithm("run", self.inputs(LOAD=True, SCREENS=os.path.join(VALLEY, "screens.gpkg")), context=context)
        self.load(context)
        self.assert_as_in_project()
        context = QgsProcessingContext()
        _, good = self.run_algorithm("hazard", {"FOLDER": self.path("out"), "LOAD": True,
                                                "OBJECTS": os.path.join(VALLEY, "houses.gpkg")}, context=context)
        self.assertTrue(good)
        self.load(context)
        layers = self.assert_as_in_project()
        self.assertEqual(len(layers), len({(layer.source(), layer.name()) for layer in layers}))
        hazard = next(layer for layer in layers if layer.name().startswith("Hazard class"))
        self.assert_drawn_as_in_style(hazard)
        self.assertGreater(len(hazard.renderer().legendSymbologyItems()), 2)
        QgsProject.instance().clear()

    def test_a_layer_of_the_user_in_a_group_stays_visible(self):
        """Results of another folder hide those before them, not a net that QGIS put into their group."""
        groups = {}
        for name in ("a", "b"):
            context = QgsProcessingContext()
            self.run_algorithm("run", self.inputs(OUT=self.path(name), LOAD=True), context=context)
            self.load(context)
            groups[name] = next(g for g in QgsProject.instance().layerTreeRoot().findGroups() if g.name() == "Talus: " + name)
            if name == "a":
                net = QgsVectorLayer("LineString?crs=EPSG:2056", "net", "memory")
                QgsProject.instance().addMapLayer(net, False)
                groups["a"].insertLayer(0, net)
        self.assertEqual([node.name() for node in groups["a"].findLayers() if node.isVisible()], ["net"])
        self.assertTrue(any(node.isVisible() for node in groups["b"].findLayers()))
        QgsProject.instance().clear()

    def test_results_where_no_folder_can_be_made_are_refused(self):
        with open(self.path("file"), "w", encoding="utf-8"):
            pass
        log = Log()
        _, good = self.run_algorithm("run", self.inputs(SOURCES=self.cliffs_in_memory(), OUT=self.path("file/out")), log)
        self.assertFalse(good)
        self.assertIn("no folder can be made there (Not a directory): name another folder", log.textLog())

    def test_effects_without_a_file(self):
        log = Log()
        _, good = self.run_algorithm("run", self.inputs(EFFECT="block-mass.preset=measured; rest-in-roughness.kappa=0.1"), log)
        self.assertTrue(good)
        (low,) = [text for text in log.warnings if "may be too low (unsafe): c = 0.25" in text]
        self.assertIn('In this dialog --deformation-coefficient is "', low)
        self.assertEqual([use["name"] for use in self.record()["effects"]], ["block-mass", "rest-in-roughness"])

    def test_a_comparison_is_a_group_with_styles(self):
        """Over the hillshade and with the sources of the runs, as its talus.qgs; titles say which energy the runs count."""
        for name, ground in (("a", "upper-talus-3d"), ("b", "lower-talus-3d")):
            self.run_algorithm("run", self.inputs(OUT=self.path(name), PRESET=ground, FREQUENCY=1.0))
            self.run_algorithm("hazard", {"FOLDER": self.path(name), "LOAD": False})
        context = QgsProcessingContext()
        found, good = self.run_algorithm("compare", {"FIRST": self.path("a"), "SECOND": self.path("b"), "OUT": self.path("out"),
                                                     "LOAD": True}, context=context)
        self.assertTrue(good)
        self.assertEqual(found["CHANGE_ENERGY"], self.path("out/change_energy.tif"))
        self.assertEqual(found["TABLE"], self.path("out/compare.csv"))
        self.load(context)
        layers = {layer.name(): layer for layer in self.assert_as_in_project()}
        for name in ("Change: Energy, P95", "Change: Hazard class, translational energy", "Highest: Energy, P95"):
            self.assert_drawn_as_in_style(layers[name])
        QgsProject.instance().clear()

    def test_where_the_hazard_goes_on_is_loaded_over_the_classes(self):
        """Also where the maps are made anew. Without blocks that leave the map there is no such layer."""
        gdal.Translate(self.path("part.tif"), DEM, projWin=[2650100, 1170750, 2650900, 1170450])
        self.run_algorithm("run", self.inputs(DEM=self.path("part.tif")))
        for _ in range(2):
            context = QgsProcessingContext()
            _, good = self.run_algorithm("hazard", {"FOLDER": self.path("out"), "LOAD": True, "OVERWRITE": True}, context=context)
            self.assertTrue(good)
            self.load(context)
            layers = self.assert_as_in_project()
            mark, undecided, classes = [layer for layer in layers if layer.source().endswith("hazard_class.tif")]
            self.assertEqual((mark.name(), undecided.name()), ("Hazard goes on beyond the map (cut short)", "Class undecided"))
            self.assertEqual(classes.renderer().type(), "singlebandpseudocolor")
            self.assertEqual([label for label, _ in mark.renderer().legendSymbologyItems()], ["paths leave the map here"])
            band = gdal.Open(self.path("out/hazard_class.tif"))
            cut = band.GetRasterBand(5).ReadAsArray()
            self.assertGreater((cut == 1).sum(), 3)
            west, cell, _, north, _, _ = band.GetGeoTransform()
            for value, colour in ((1, "#c30fa5"), (0, "#ffffff")):
                rows, columns = (cut == value).nonzero()
                x, y = west + columns[0] * cell, north - rows[0] * cell
                settings = QgsMapSettings()
                settings.setLayers([mark])
                settings.setExtent(QgsRectangle(x, y - cell, x + cell, y))
                settings.setDestinationCrs(mark.crs())
                settings.setOutputSize(QSize(9, 9))
                settings.setBackgroundColor(QColor("white"))
                job = QgsMapRendererParallelJob(settings)
                job.start()
                job.waitForFinished()
                self.assertEqual(job.renderedImage().pixelColor(4, 4).name(), colour)
        QgsProject.instance().clear()

    def test_german_legends(self):
        from talus_qgis import results
        before = QLocale()
        QgsApplication.setLocale(QLocale("de_CH"))
        try:
            told = {"up to 30 kJ": "bis 30 kJ", "30 to 100 kJ": "30 bis 100 kJ", "above 3000 kJ": "über 3000 kJ",
                    "10 to 30 years": "10 bis 30 Jahre", "above 1000 years": "über 1000 Jahre", "no hit counted in this run": "in diesem Lauf kein Treffer gezählt",
                    "0 %": "0 %", "above 1 1/year": "über 1 1/Jahr", "up to 10": "bis 10", "residual": "Restgefährdung"}
            for english, german in told.items():
                self.assertEqual(results.legend_text(english), german)
            context = QgsProcessingContext()
            for name, parameters in (("run", self.inputs(LOAD=True)), ("hazard", {"FOLDER": self.path("out"), "LOAD": True})):
                _, good = self.run_algorithm(name, parameters, context=context)
                self.assertTrue(good)
            self.load(context)
            layers = {node.name(): node.layer() for node in QgsProject.instance().layerTreeRoot().findLayers()}
            classes = [label for label, _ in layers["Gefahrenstufe, Translationsenergie"].renderer().legendSymbologyItems()]
            self.assertEqual(classes, ["keine", "Restgefährdung", "gering", "mittel", "erheblich"])
            english = re.compile("up to|above|none|low|year| to ")
            for layer in layers.values():
                labels = ([label for label, _ in layer.renderer().legendSymbologyItems()] if isinstance(layer, QgsRasterLayer)
                          else [item.label() for item in layer.renderer().legendSymbolItems()])
                self.assertEqual([label for label in labels if english.search(label)], [], layer.name())
            model = QgsLayerTreeModel(QgsProject.instance().layerTreeRoot())
            for node in QgsProject.instance().layerTreeRoot().findLayers():
                shown = [entry.data(Qt.DisplayRole) for entry in model.layerLegendNodes(node)]
                self.assertEqual([label for label in shown if label and (english.search(label) or "(Gray)" in label)], [], node.name())
        finally:
            QgsApplication.setLocale(before)
            QgsProject.instance().clear()

    def test_two_commands_whose_layers_are_loaded_together(self):
        """As in a model: the layers of the first have their styles, too, and their group."""
        context = QgsProcessingContext()
        self.run_algorithm("run", self.inputs(LOAD=True), context=context)
        long_ago = time.time() - 3600.0
        for file in self.written("out/*"):
            os.utime(file, (long_ago, long_ago))  # so that `hazard` does not name them as its own
        self.run_algorithm("hazard", {"FOLDER": self.path("out"), "LOAD": True}, context=context)
        self.load(context)
        names = {layer.name() for layer in self.assert_as_in_project()}
        self.assertLessEqual({"Hazard class, translational energy", "Impact probability"}, names)
        QgsProject.instance().clear()

    def test_names_of_a_matrix_of_the_user_are_not_translated(self):
        """Also where they are words of which the plug-in has German ones."""
        names = ["none", "low", "above 30 kJ", "high to extreme"]
        with open(self.path("own.toml"), "w", encoding="utf-8") as file:
            file.write(f"years = [30, 100]\nenergies = [30]\nclasses = [[2, 1, 1], [3, 3, 1]]\nnames = {json.dumps(names)}\n")
        before = QLocale()
        QgsApplication.setLocale(QLocale("de_CH"))
        try:
            context = QgsProcessingContext()
            self.run_algorithm("run", self.inputs())
            _, good = self.run_algorithm("hazard", {"FOLDER": self.path("out"), "MATRIX": self.path("own.toml"), "LOAD": True},
                                         context=context)
            self.assertTrue(good)
            self.load(context)
            layer = next(node.layer() for node in QgsProject.instance().layerTreeRoot().findLayers() if node.name().startswith("Gefahrenstufe,"))
            self.assertEqual([label for label, _ in layer.renderer().legendSymbologyItems()], names)
        finally:
            QgsApplication.setLocale(before)
            QgsProject.instance().clear()

    def assert_as_in_project(self):
        """The one group of the results has the titles, the order and the visibility of the project that the program has
        written (without what lies second in a GeoPackage)."""
        groups = [g for g in QgsProject.instance().layerTreeRoot().findGroups() if g.name() == "Talus: out"]
        self.assertEqual(len(groups), 1)  # one group for the run and what is added to it
        project = xml.parse(self.path("out/talus.qgs")).getroot()
        wanted = [(layer.get("name"), layer.get("checked") == "Qt::Checked") for layer in project.iter("layer-tree-layer")
                  if layer.get("name") != "Hillshade of the DEM"]
        *results, hillshade = groups[0].findLayers()
        found = [(node.name(), node.itemVisibilityChecked()) for node in results if node.name() != "Vertices of the paths"]
        self.assertGreater(len(wanted), 15)
        self.assertEqual(found, wanted)
        self.assertEqual((hillshade.name(), hillshade.itemVisibilityChecked()), ("Hillshade of the DEM", True))
        self.assertEqual(hillshade.layer().renderer().type(), "hillshade")
        return [node.layer() for node in results]

    def test_every_title_of_a_result_has_a_german_one(self):
        from talus_qgis import results, texts
        told = json.loads(subprocess.run([os.environ["TALUS"], "help", "--json"], capture_output=True, check=True).stdout)["results"]
        self.assertGreater(len(told), 25)
        for label in ("paths leave the map here", "not decided by so few blocks"):  # src/products/hazard_table.cpp
            self.assertIn(label, texts.GERMAN)
        for entry in told:
            self.assertIn(entry["title"], texts.GERMAN)
            for blank in ("<n>", "<id>", "<threshold>"):
                self.assertEqual(blank in entry["title"], blank in texts.GERMAN[entry["title"]])
        for name, title in (("return_period_300.tif", "Return period of more than 300 kJ"), ("stops.fgb", "Stops: largest energy of the path"),
                            ("barrier_a_b.csv", "Barrier at a_b: design values"), ("exits.tif", "Exits"), ("mine_too.tif", "mine too.tif")):
            self.assertEqual(results.title_of(name), title)
        with open(self.path("barrier_a_b-0123abcd.json"), "w", encoding="utf-8") as file:
            json.dump({"screen": "a/b \\1"}, file)
        for name, title in (("barrier_a_b-0123abcd.gpkg", "Barrier at a/b \\1: MEL by stretch"),
                            ("barrier_mine.csv", "Barrier at mine: design values")):
            self.assertEqual(results.title_of(name, self.folder), title)
        self.assertIn(", energy with rotation", texts.GERMAN)
        self.assertIn("the lowest threshold", texts.GERMAN)
        self.assertEqual(results.title_of("energy_exceedance.tif"), "Share above the lowest threshold")
        self.assertIn(", translational energy", texts.GERMAN)
        for value, more in (("false", ", translational energy"), ("true", ", energy with rotation")):
            with open(self.path("run.json"), "w", encoding="utf-8") as file:
                json.dump({"settings": [{"key": "seed", "value": 1}, {"key": "output.count_rotation", "value": value},
                                        {"key": "output.energy_thresholds", "value": "[2.5, 300]", "unit": "kJ"}]}, file)
            self.assertEqual(results.title_of("energy_exceedance.tif", self.folder), "Share above 2.5 kJ" + more)
            self.assertEqual(results.title_of("height_exceedance.tif", self.folder), "Share with jump height above the lowest threshold")
            self.assertEqual(results.title_of("return_period_30.tif", self.folder), "Return period of more than 30 kJ" + more)
            self.assertEqual(results.title_of("hazard_class.tif", self.folder), "Hazard class" + more)
            self.assertEqual(results.title_of("energy.tif", self.folder), "Energy, P95")
        self.assertLess(results._place(7, results.title_of("return_period_30.tif")),
                        results._place(7, results.title_of("return_period_100.tif")))

    def test_in_a_model(self):
        """run, then hazard on its folder: outputs of one are inputs of the next."""
        model = QgsProcessingModelAlgorithm("chain", "tests")
        for name, values in (("run", {"DEM": DEM, "SOURCES": os.path.join(VALLEY, "cliffs.shp"), "TRAJECTORIES": 5,
                                      "DIAMETER_MIN_FIELD": "diameter_m", "DIAMETER_MAX_FIELD": "diameter_1",
                                      "OUT": self.path("out"), "LOAD": False}), ("hazard", {"LOAD": False})):
            child = QgsProcessingModelChildAlgorithm("talus:" + name)
            child.setChildId(name)
            for key, value in values.items():
                child.addParameterSources(key, [QgsProcessingModelChildParameterSource.fromStaticValue(value)])
            if name == "hazard":
                child.addParameterSources("FOLDER", [QgsProcessingModelChildParameterSource.fromChildOutput("run", "OUT")])
            model.addChildAlgorithm(child)
        context = QgsProcessingContext()
        log = Log()
        results, good = model.run({}, context, log)
        self.assertTrue(good, log.textLog())
        self.assertEqual(results["CHILD_RESULTS"]["hazard"]["HAZARD_CLASS"], self.path("out/hazard_class.tif"))
        self.assertEqual(context.layersToLoadOnCompletion(), {})

    def load(self, context):
        """As the toolbox does it after an algorithm."""
        from processing.gui.Postprocessing import handleAlgorithmResults
        algorithm = QgsApplication.processingRegistry().algorithmById("talus:run")
        handleAlgorithmResults(algorithm, context, Log())

    def assert_drawn_as_in_style(self, layer):
        path = layer.source()
        renderer = xml.parse(path[:-4] + ".qml").getroot().find("pipe/rasterrenderer")
        band, opacity = int(renderer.get("band")), float(renderer.get("opacity"))
        items = [(float(i.get("value")), QColor(i.get("color")), i.get("alpha") != "0") for i in renderer.iter("item")]
        entries = [(float(i.get("value")), QColor(i.get("color")), i.get("alpha") != "0")
                   for i in renderer.iter("paletteEntry")]
        settings = QgsMapSettings()
        settings.setLayers([layer])
        settings.setDestinationCrs(layer.crs())
        settings.setExtent(layer.extent())
        settings.setOutputSize(QSize(layer.width(), layer.height()))
        settings.setBackgroundColor(QColor(255, 255, 255))
        job = QgsMapRendererParallelJob(settings)
        job.start()
        job.waitForFinished()
        image = job.renderedImage()
        raster = gdal.Open(path)
        values = raster.GetRasterBand(band)
        nodata, cells = values.GetNoDataValue(), values.ReadAsArray()
        compared, colours = 0, set()
        for y in range(2, layer.height(), 3):
            for x in range(2, layer.width(), 3):
                value = float(cells[y, x])
                if entries:
                    hit = next((e for e in entries if e[0] == value), None)
                else:
                    hit = next((e for e in items if value <= e[0]), None)
                if value == nodata or value != value or hit is None or not hit[2]:
                    continue
                want = [255 * (1 - opacity) + opacity * c for c in (hit[1].red(), hit[1].green(), hit[1].blue())]
                got = image.pixelColor(x, y)
                for a, b in zip(want, (got.red(), got.green(), got.blue())):
                    self.assertLessEqual(abs(a - b), 2.0, (x, y, value))
                colours.add(value)
                compared += 1
        self.assertGreater(compared, 500)
        self.assertGreater(len(colours), 2)
