"""The algorithms: one class for all commands. Their parameters are what `talus help --json` says; ALGORITHMS holds only what
QGIS needs in addition: which inputs are layers, whose fields are picked, which files come out."""
import difflib
import glob
import math
import os
import re
import time

from qgis.core import (QgsFeatureRequest, QgsProcessing, QgsProcessingAlgorithm, QgsProcessingException,
                       QgsProcessingFeatureSourceDefinition, QgsProcessingOutputFile, QgsProcessingOutputFolder,
                       QgsProcessingOutputLayerDefinition, QgsProcessingOutputRasterLayer, QgsProcessingOutputVectorLayer,
                       QgsProcessingParameterBand, QgsProcessingParameterBoolean, QgsProcessingParameterDefinition,
                       QgsProcessingParameterEnum, QgsProcessingParameterFeatureSource, QgsProcessingParameterField,
                       QgsProcessingParameterFile, QgsProcessingParameterFileDestination,
                       QgsProcessingParameterFolderDestination, QgsProcessingParameterMultipleLayers,
                       QgsProcessingParameterNumber, QgsProcessingParameterRasterLayer, QgsProcessingParameterString,
                       QgsProcessingUtils, QgsProject, QgsProperty, QgsVectorLayer)
from qgis.PyQt.QtGui import QIcon

from . import layers, process, program, results
from .texts import label, tr

LARGEST_IN_DIALOG = 2147483647  # a spin box of QGIS takes no more
NOT_IN_DIALOG = {"quiet", "progress", "allow-network", "sources-layer", "field", "memory", "part", "checkpoint"}
ALWAYS_ADVANCED = {"threads", "lanes", "allow-folder", "seed", "surface"}

# Fields of the sources that can be picked, by the program's name of them.
SOURCE_FIELDS = [("diameter", False), ("release_height", False), ("frequency", False), ("diameter_min", False),
                 ("diameter_max", False), ("name", True)]
KEYS_OF_SCENARIO = {"diameter": "[blocks] diameter", "sources": "[sources] file"}  # as messages name them
SHAPES = [QgsProcessing.TypeVectorPoint, QgsProcessing.TypeVectorLine, QgsProcessing.TypeVectorPolygon]

RUN_RASTERS = ["impact_probability", "reach_probability", "energy", "velocity", "jump_height", "passages", "deposits",
               "release"]
SCENARIO_INPUTS = {
    "order": ["dem", "sources", "diameter", "preset", "parameters", "trajectories", "frequency", "screens", "barriers", "zones",
              "zone-field"],
    "bands": {"dem"},
    "shapes": {"sources": SHAPES, "screens": [QgsProcessing.TypeVectorLine],
               "barriers": [QgsProcessing.TypeVectorLine], "zones": [QgsProcessing.TypeVectorPolygon]},
    "fields": {"sources": SOURCE_FIELDS},
    "field of": {"zone-field": "zones"},
    "raster too": {"zones"},
    "advanced": {"scenario", "surface", "effect", "thresholds", "seed", "energy-total", "count-rotation", "bounds", "vectors", "rounds", "until-error",
                 "deformation-coefficient", "above", "most-rounds", "pits"},
    "labels": {"parameters": "ground-parameters"},
    "needs": [("scenario",), ("dem", "sources")],
}

ALGORITHMS = [
    {"id": "run", "command": "run", "help": "products", **SCENARIO_INPUTS, "phases": ["simulate", "write"], "folder": "out",
     "rasters": RUN_RASTERS, "vectors": ["stops", "trajectories"], "files": {"record": "run.json",
                                                                              "complete-scenario": "scenario.toml"}},
    {"id": "check", "command": "check", "help": "prepare-data", **SCENARIO_INPUTS, "phases": [],
     "advanced": SCENARIO_INPUTS["advanced"] | {"overwrite"}, "geopackage": ("pits", ["pits"])},
    {"id": "sources", "command": "sources", "help": "sources", "bands": {"dem"}, "order": ["dem", "slope", "out"], "phases": [],
     "geopackage": ("out", ["source_polygons", "source_points"])},
    {"id": "hazard", "command": "hazard", "help": "hazard", "order": ["folder", "width", "curves", "objects", "width-field", "name-field", "overwrite"],
     "advanced": {"matrix", "frequency"}, "phases": ["evaluate", "write", "simulate"], "folder": "folder",
     "several": {"objects"},
     "rasters": ["hazard_class", "annual_frequency"], "vectors": ["objects"], "record": "hazard.json"},
    {"id": "objects", "command": "hazard", "help": "hazard", "order": ["folder", "objects", "width", "width-field", "name-field", "overwrite"],
     "required": {"objects"}, "advanced": {"matrix", "frequency", "curves"}, "phases": ["evaluate", "write", "simulate"], "folder": "folder",
     "several": {"objects"},
     "rasters": ["hazard_class", "annual_frequency"], "vectors": ["objects"],
     "files": {"table": "objects.csv", "curves": "objects_curves.csv"}, "record": "hazard.json"},
    {"id": "barrier", "command": "barrier", "help": "barrier", "order": ["folder", "screen"],
     "advanced": {"observed", "frequency", "percentile", "containment", "stretch", "return-periods", "unweighted"}, "phases": [],
     "folder": "folder", "screen": "screen"},
    {"id": "profile", "command": "profile", "help": "profile", "phases": ["simulate", "write"],
     "order": ["dem", "line", "source-x", "diameter", "release-height", "preset", "screen-x", "trajectories"],
     "bands": {"dem"}, "shapes": {"line": [QgsProcessing.TypeVectorLine]}, "labels": {"trajectories": "number-of-blocks"},
     "advanced": {"profile", "effect", "deformation-coefficient"}, "needs": [("profile",), ("dem", "line", "source-x", "diameter")],
     "needs text": "Give the terrain, a line over it, where blocks start and their diameter, or the file of a profile.",
     "files": {"record": "run.json", "picture": "profile.svg"}, "folder": "out",
     "layers": ("profile.gpkg", ["crossings", "stops", "profile", "bins"])},
    {"id": "calibrate", "command": "calibrate", "help": "closing-the-loop", "phases": ["fit"], "folder": "out",
     "nothing to load": True,
     "advanced": {"fit", "trials", "starts", "share", "parameters"},
     "files": {"fitted": "fitted.toml", "report": "report.md", "record": "calibration.json"}},
    {"id": "diagnose", "command": "diagnose", "help": "closing-the-loop", "phases": ["diagnose"], "folder": "out",
     "nothing to load": True,
     "advanced": {"fit", "trials", "parameters", "test-trials", "most-effects", "level", "base-fits", "all-rows", "nested",
                  "no-nested", "folds", "quick-folds", "no-quick-folds"},
     "files": {"fitted": "fitted.toml", "report": "report.html", "record": "diagnosis.json"}},
    {"id": "compare", "command": "compare", "help": "compare", "order": ["first", "second", "more", "rasters", "out"],
     "phases": ["compare", "write"], "folder": "out",
     "rasters": ["highest_hazard_class", "highest_energy", "change_annual_frequency", "change_impact_probability", "change_energy"],
     "files": {"table": "compare.csv"}},
    {"id": "report", "command": "report", "help": "report", "phases": []},
]


def key_of(name):
    """The name of a parameter in QGIS: ZONE_FIELD of --zone-field."""
    return name.upper().replace("-", "_")


def _rest_of(text):
    """What comes after the first part of a text; brackets belong together."""
    for ends in (";:", ","):
        depth = 0
        for i, letter in enumerate(text):
            depth += (letter in "([") - (letter in ")]")
            if depth == 0 and letter in ends:
                return text[i + 1:].strip()
    return ""


def _is_number(text):
    """Whether QGIS reads a text as the number that it is: with a decimal point, whatever the language."""
    try:
        float(text)
    except ValueError:
        return False
    return "_" not in text


def _choice(p, value):
    """The text of a choice that may be given by its number in the list, as QGIS lists choices for scripts."""
    texts = p["choices"]
    return texts[int(value)] if str(value).isascii() and str(value).isdigit() and value not in texts and int(value) < len(texts) else value


def _is_temporary(value):
    """Whether a folder is left to QGIS to name."""
    if isinstance(value, QgsProcessingOutputLayerDefinition):
        value = value.sink
    if isinstance(value, QgsProperty):
        value = value.staticValue()
    return value == QgsProcessing.TEMPORARY_OUTPUT


class TalusAlgorithm(QgsProcessingAlgorithm):
    def __init__(self, table):
        super().__init__()
        self.table = table
        self.layers = {}  # of parameters, taken in the main thread
        self.destinations = {}  # files and folders that are written

    # What QGIS asks

    def createInstance(self):
        return TalusAlgorithm(self.table)

    def name(self):
        return self.table["id"]

    def displayName(self):
        return tr("algorithm " + self.table["id"])

    def icon(self):
        return QIcon(os.path.join(os.path.dirname(__file__), "icon.svg"))

    def helpUrl(self):
        return program.help_page(self.table["help"])

    def tags(self):
        return ["talus", "rockfall", "rock fall", "steinschlag", "naturgefahren", self.table["command"]]

    def shortDescription(self):
        return tr("about " + self.table["id"])

    def shortHelpString(self):
        lines = [tr("about " + self.table["id"])]
        for p in self.described():
            if p["name"] not in NOT_IN_DIALOG:
                lines.append(": ".join(filter(None, [f"<b>{self._title(p)}</b>", self._help(p)])))
        if self.table.get("fields"):
            lines.append(tr("A field of the sources that is named diameter, diameter_min, diameter_max, release_height, "
                            "frequency or name is read where no field is picked for it."))
        lines.append(tr("Talus runs the program talus of this computer. Every parameter is explained on the pages of its "
                        "documentation."))
        return "<p>" + "</p><p>".join(lines) + "</p>"

    def canExecute(self):
        try:
            program.description()
            return True, ""
        except program.ProgramMissing as fault:
            return False, str(fault)

    def flags(self):
        return super().flags() | QgsProcessingAlgorithm.FlagCanCancel

    # Parameters

    def described(self):
        """The parameters of the command as the program tells them; none where there is no program."""
        try:
            command = program.command(self.table["command"])
        except program.ProgramMissing:
            return []
        found = [dict(p) for p in command["parameters"]] if command else []
        for p in found:
            p["required"] = p["required"] or p["name"] in self.table.get("required", ())
        order = self.table.get("order", [])
        return sorted(found, key=lambda p: order.index(p["name"]) if p["name"] in order else len(order))

    def by_scenario(self):
        """Whether a scenario file may give the values."""
        return any(p["name"] == "scenario" for p in self.described())

    def initAlgorithm(self, configuration=None):
        for p in self.described():
            if p["name"] in NOT_IN_DIALOG:
                continue
            advanced = p["name"] in self.table.get("advanced", ()) or p["name"] in ALWAYS_ADVANCED
            self._add(self._definition(p), self._help(p), advanced)
            if p["name"] in self.table.get("bands", ()):
                band = QgsProcessingParameterBand("DEM_BAND", label("dem-band"), 1, key_of(p["name"]), True)
                self._add(band, tr("Band of the raster that holds the heights."), False)
            for field, rare in self.table.get("fields", {}).get(p["name"], ()):
                self._add(QgsProcessingParameterField(key_of(field) + "_FIELD", label(field + "-field"), None,
                                                      key_of(p["name"]), QgsProcessingParameterField.Any, False, True),
                          tr("Field of the sources that is read as {field}. Where none is picked, their field named {field} "
                             "is read, if they have one.").format(field=field), rare)
            if p["name"] in self.table.get("raster too", ()):
                self._add(QgsProcessingParameterRasterLayer(key_of(p["name"]) + "_RASTER", label(p["name"] + "-raster"), None,
                                                            True), p["text"], True)
        self._declare_outputs()

    def _add(self, definition, text, advanced):
        definition.setHelp(tr(text))
        if advanced:
            definition.setFlags(definition.flags() | QgsProcessingParameterDefinition.FlagAdvanced)
        self.addParameter(definition)

    def _definition(self, p):
        """No default is set in a dialog: it would hide what a scenario, a campaign or a profile says. A folder that is read
        is that of the results on top of the map, if there are any."""
        key, title, optional = key_of(p["name"]), self._title(p), not p["required"]
        kind = p["type"]
        if p["name"] in self.table.get("field of", {}):
            return QgsProcessingParameterField(key, title, None, key_of(self.table["field of"][p["name"]]),
                                               QgsProcessingParameterField.Any, False, optional)
        if kind == "flag":
            return QgsProcessingParameterBoolean(key, title, False)
        if kind == "choice":
            return QgsProcessingParameterEnum(key, title, p["choices"], False, None, optional, True)
        if kind in ("number", "integer"):
            return self._number(p, key, title, optional)
        if kind == "folder":
            if p["written"]:
                return QgsProcessingParameterFolderDestination(key, title, None, optional)
            return QgsProcessingParameterFile(key, title, QgsProcessingParameterFile.Folder, "",
                                              self._preselected(p), optional)
        if kind == "file":
            return self._file(p, key, title, optional)
        text = QgsProcessingParameterString(key, title, None, False, optional)
        if p["name"] == self.table.get("screen"):
            text.setMetadata({"widget_wrapper": {"class": "talus_qgis.screens.ScreenChoice"}})
        return text

    @staticmethod
    def _preselected(p):
        """The folder of the results on top of the map, where the folder of a run is asked for; not for further runs."""
        return results.latest_folder(QgsProject.instance()) if p["name"] in ("folder", "first") else None

    def _help(self, p):
        several = p["name"] in self.table.get("several", ())
        low = p["bounds"].get("low", 0)
        text = tr(p["text"])
        if re.match("(of|per|that|how many) ", p["text"]):  # goes on where the name of the option ends, as the label says it
            text = _rest_of(text)
        least = tr("At least {value}.").format(value=low) if p["type"] == "integer" and low > 1 else ""
        joined = tr("Several layers, as a road and houses, are joined into one.") if several else ""
        return ". ".join(filter(None, [self._with_labels(text), least, joined]))

    def _with_labels(self, text):
        """A text of the program with the names that the dialog has for its flags."""
        labels = {flag: self._label(p) for p in self.described() if p["name"] not in NOT_IN_DIALOG for flag in p["flags"]}
        return re.sub(r"--[a-z][a-z-]*", lambda flag: tr("\"{field}\"").format(field=labels[flag[0]]) if flag[0] in labels else flag[0],
                      text)

    def _label(self, p):
        name = self.table.get("labels", {}).get(p["name"], p["name"])
        return label("weighting" if p["type"] == "file" and name == "frequency" else name)

    def _title(self, p):
        title = self._label(p)
        if p["unit"]:
            title += f" [{tr(p['unit'])}]"
        if any(p["name"] in names for names in self.table.get("needs", ())[1:]):
            title += ", " + tr("needed without a scenario" if self.by_scenario() else "needed without the file of a profile")
        if p["type"] != "flag" and p["default"] is not None:
            title += " (" + tr("{value} if not set").format(value=p["default"]) + ")"
        return title

    def _number(self, p, key, title, optional):
        whole = p["type"] == "integer"
        kind = QgsProcessingParameterNumber.Integer if whole else QgsProcessingParameterNumber.Double
        low, high = p["bounds"].get("low", -1e300), p["bounds"].get("high", 1e300)
        if whole:
            low, high = max(low, -LARGEST_IN_DIALOG), min(high, LARGEST_IN_DIALOG)
        return QgsProcessingParameterNumber(key, title, kind, None, optional, low, high)

    def _file(self, p, key, title, optional):
        if p["written"]:
            vector = "vector" in p["holds"]
            kinds = "GeoPackage (*.gpkg)" if vector else f"{p['holds'][0].upper()} (*.{p['holds'][0]})"
            destination = QgsProcessingParameterFileDestination(key, title, kinds, None, optional)
            destination.setCreateByDefault(not optional)
            return destination
        if p["repeatable"]:
            several = QgsProcessingParameterMultipleLayers(key, title, QgsProcessing.TypeFile, None, optional)
            several.setMinimumNumberInputs(1)
            return several
        if p["name"] in self.table.get("several", ()):
            several = QgsProcessingParameterMultipleLayers(key, title, QgsProcessing.TypeVectorAnyGeometry, None, optional)
            several.setMinimumNumberInputs(0 if optional else 1)
            return several
        if "vector" in p["holds"]:
            return QgsProcessingParameterFeatureSource(key, title, self.table.get("shapes", {}).get(p["name"], []), None,
                                                       optional)
        if "raster" in p["holds"]:
            only = None if optional else results.only_raster(QgsProject.instance())  # a scenario may name another terrain
            return QgsProcessingParameterRasterLayer(key, title, only, optional)
        return QgsProcessingParameterFile(key, title, QgsProcessingParameterFile.File, p["holds"][0], None, optional)

    def _declare_outputs(self):
        table = self.table
        loads = (table.get("folder") and not table.get("nothing to load")) or table.get("geopackage")
        if loads:
            self._add(QgsProcessingParameterBoolean("LOAD", label("load"), True), tr("Loads the results as a group of layers."),
                      False)
        for name in table.get("rasters", ()):
            self.addOutput(QgsProcessingOutputRasterLayer(key_of(name), results.title_of(name + ".tif")))
        for name in table.get("vectors", ()):
            self.addOutput(QgsProcessingOutputVectorLayer(key_of(name), results.title_of(name + ".gpkg")))
        for name in table.get("geopackage", (None, ()))[1]:
            self.addOutput(QgsProcessingOutputVectorLayer(key_of(name), results.title_of(name)))
        for name, file in table.get("files", {}).items():
            self.addOutput(QgsProcessingOutputFile(key_of(name), file))
        if table.get("folder") == "folder":
            self.addOutput(QgsProcessingOutputFolder("RESULTS", tr("Folder of the results")))
        if table["id"] == "barrier":
            self.addOutput(QgsProcessingOutputFile("TABLE", "barrier_*.csv"))
            self.addOutput(QgsProcessingOutputVectorLayer("LINE", tr("Line of the barrier, by stretch")))

    # Work

    def checkParameterValues(self, parameters, context):
        there, fault = self.canExecute()
        if not there:  # without the program its parameters are not known
            return False, fault
        needs = self.table.get("needs")
        if needs and not any(all(parameters.get(key_of(name)) not in (None, "") for name in names) for names in needs):
            return False, tr(self.table.get("needs text", "Give the terrain and the sources, or a scenario file."))
        if parameters.get("RESUME") and self.parameterAsBool(parameters, "RESUME", context) and _is_temporary(
                parameters.get("OUT")):
            return False, tr("\"Resume\" needs the folder of the run that was cancelled: name it under \"Results\". A "
                             "temporary folder is a new one at every run.")
        if fault := self._fault_of_names(parameters) or self._fault_of_numbers(parameters):
            return False, fault
        given = dict(parameters)
        for key in map(key_of, self.table.get("several", ())):  # a script may still give the selected features of one layer
            if isinstance(given.get(key), QgsProcessingFeatureSourceDefinition):
                given[key] = given[key].source.staticValue()
        for p in self.described():
            if p["type"] == "choice" and given.get(key_of(p["name"])) not in (None, ""):
                given[key_of(p["name"])] = _choice(p, given[key_of(p["name"])])
        return super().checkParameterValues(given, context)

    def _fault_of_names(self, parameters):
        """What is wrong with a name that no algorithm of Talus has, as in a call of qgis_process: QGIS would pass over it. Those
        of others are passed over: a script may give one set of inputs to check and to run."""
        names = [definition.name() for definition in self.parameterDefinitions()]
        of_all = set(names)  # those of the provider may be of the time before the program was there
        of_all |= {definition.name() for algorithm in self.provider().algorithms() for definition in algorithm.parameterDefinitions()}
        for name in parameters:
            if name not in of_all:
                near = difflib.get_close_matches(str(name).upper(), names, 1)
                fault = tr("{name}: no such parameter of {id}").format(name=name, id=self.id())
                return fault + (tr("; is {near} meant?").format(near=near[0]) if near else "")
        return ""

    def _fault_of_numbers(self, parameters):
        """What is wrong with a number: QGIS would take the text "1,2" for 0, and of one out of bounds it does not tell them."""
        for p in self.described():
            name, value = key_of(p["name"]), parameters.get(key_of(p["name"]))
            if p["type"] not in ("number", "integer") or not isinstance(value, (str, int, float)) or value == "":
                continue
            if not _is_number(str(value)):
                with_point = str(value).replace(",", ".")
                return tr("{name}: '{value}' is no number: write {number}").format(
                    name=name, value=value, number=with_point if _is_number(with_point) else "1.2")
            low, high = p["bounds"].get("low", -math.inf), p["bounds"].get("high", math.inf)
            if float(value) < low - (1 if p["type"] == "integer" else 0):  # a whole number just below is "not set"
                return tr("{name}: {value} must be {low} at least").format(name=name, value=value, low=low)
            if float(value) > high:
                return tr("{name}: {value} must be {high} at most").format(name=name, value=value, high=high)
        return ""

    def prepareAlgorithm(self, parameters, context, feedback):
        """Takes the layers in the main thread, to which they belong."""
        self.layers, self.destinations = {}, {}
        own = {definition.name() for definition in self.parameterDefinitions()}
        for name in sorted(set(parameters) - own):
            feedback.pushWarning(tr("{name}: no such parameter of {id}").format(name=name, id=self.id()) + tr("; it is not used"))
        for p in self.described():
            if p["type"] != "file" or p.get("written"):
                continue
            key = key_of(p["name"])
            if "raster" in p["holds"]:
                name = key + "_RASTER" if p["name"] in self.table.get("raster too", ()) else key
                layer = self.parameterAsRasterLayer(parameters, name, context)
                if layer is None and parameters.get(name):
                    raise QgsProcessingException(self.invalidRasterError(parameters, name))
                self.layers[name] = layers.raster_copy(layer) if layer is not None else None
            if "vector" in p["holds"] and parameters.get(key) not in (None, "", []):
                several = p["name"] in self.table.get("several", ())
                self.layers[key] = [self._vector(one, key, context) for one in (
                    self._each(parameters, key, context) if several else [parameters])]
        return True

    def _each(self, parameters, key, context):
        """A parameter of several layers as parameters of one layer each."""
        value = parameters[key]
        if isinstance(value, QgsProperty):
            value = value.staticValue()
        given = value if isinstance(value, (list, tuple)) else [value]
        found = []
        for one in given:
            if isinstance(one, QgsProcessingFeatureSourceDefinition):
                found.append({key: one})
                continue
            layer = self.parameterAsVectorLayer({key: one}, key, context)
            if layer is None:
                raise QgsProcessingException(self.invalidSourceError({key: one}, key))
            found.append({key: layer})
        return found

    def _vector(self, parameters, key, context):
        """(file of the layer if that is all of it, its source of features)."""
        source = self.parameterAsSource(parameters, key, context)
        if source is None:
            raise QgsProcessingException(self.invalidSourceError(parameters, key))
        # By default Processing stops at an invalid polygon, and QGIS itself ends. The program mends them and says so.
        source.setInvalidGeometryCheck(QgsFeatureRequest.GeometryNoCheck)
        value = parameters[key]
        plain = value.source if isinstance(value, QgsProcessingFeatureSourceDefinition) else value
        if isinstance(plain, QgsProperty):
            plain = plain.staticValue()
        layer = self.parameterAsVectorLayer({key: plain}, key, context)
        if isinstance(layer, QgsVectorLayer):
            layers.refuse_unnamed(layer)
        return layers.plain_vector(value, layer), source

    def processAlgorithm(self, parameters, context, feedback):
        try:
            command = [program.path(), self.table["command"]]
        except program.ProgramMissing as fault:
            raise QgsProcessingException(str(fault)) from fault
        folder = self._folder(parameters, context)
        if self.table.get("folder") == "out" and self._is_in_temporary(folder):
            feedback.pushWarning(tr("The results go into a temporary folder, which QGIS removes when it is closed: name a folder "
                                    "under \"Results\" to keep them."))
        inputs = layers.folder_beside(folder)
        before = layers.names_in(inputs)
        try:
            words = self._words(parameters, context, feedback, inputs)
        except Exception:
            layers.remove(inputs, layers.names_in(inputs) - before)
            raise
        made = layers.names_in(inputs) - before
        rounds = self.parameterAsInt(parameters, "ROUNDS", context) if parameters.get("ROUNDS") else 1
        begin = time.time()
        progress = process.Progress(feedback, self._phases(parameters), None if parameters.get("UNTIL_ERROR") else rounds)
        try:
            process.run(command + words, feedback, progress, self._explained)
        except process.Cancelled as cancelled:
            raise QgsProcessingException(f"{cancelled} {self._after_cancel(folder)}".strip()) from cancelled
        except process.Refused:
            layers.remove(inputs, made)
            raise
        return self._results(parameters, context, folder, begin)

    @staticmethod
    def _is_in_temporary(folder):
        return folder.startswith(os.path.normpath(QgsProcessingUtils.tempFolder()) + os.sep)

    def _after_cancel(self, folder):
        """How to go on."""
        if not any(p["name"] == "resume" for p in self.described()):
            return ""
        if self._is_in_temporary(folder):
            return tr("A run into a temporary folder cannot be resumed, as QGIS takes another one at the next run: name a "
                      "folder under \"Results\" where you want to go on.")
        return tr("What a run has traced is kept: start it again with the same inputs and \"Resume\".")

    def _explained(self, text):
        """An error, with a line that says what the dialog calls the flags in it."""
        hints = []
        for p in self.described():
            names = [*p["flags"], *filter(None, [KEYS_OF_SCENARIO.get(p["name"])])]
            places = {name: re.search(r"(?<![\w-])(?<!the run )" + re.escape(name) + r"(?![\w-])", text) for name in names}
            found = [name for name in places if places[name]]
            field, place = self._in_dialog(p, text)
            if found and field:
                hints.append((min(places[name].start() for name in found), tr("{flag} is \"{field}\"").format(
                    flag=" / ".join(found), field=field) + place))
        return text + ("\n" + tr("In this dialog ") + ", ".join(hint for _, hint in sorted(hints)) if hints else "")

    def _in_dialog(self, p, text):
        """What the dialog calls a parameter, and where it is; empty where it is not in the dialog."""
        advanced = p["name"] in self.table.get("advanced", ()) or p["name"] in ALWAYS_ADVANCED
        if p["name"] == "field":
            named = re.search(r"--field (\w+)=", text)
            return label(named[1] + "-field" if named else "field"), ""
        if p["name"] in NOT_IN_DIALOG:
            return "", ""
        return self._label(p), tr(" (under Advanced Parameters)") if advanced else ""

    def _phases(self, parameters):
        if self.table["command"] == "hazard" and not parameters.get("OBJECTS"):
            return ["simulate" if parameters.get("FREQUENCY") else "evaluate", "write"]
        return self.table["phases"]

    def _folder(self, parameters, context):
        """The folder of the results; for a command without one, a new one for what has to be written for it."""
        name = self.table.get("folder")
        if name is None:
            return QgsProcessingUtils.generateTempFilename("talus_" + self.table["id"])
        key = key_of(name)
        return os.path.normpath(self.parameterAsFile(parameters, key, context) if name == "folder" else
                                self._destination(parameters, key, context))

    def _destination(self, parameters, key, context):
        """The file or folder to write. QGIS makes a new temporary name at every question, so it is asked once."""
        if key not in self.destinations:
            self.destinations[key] = self.parameterAsFileOutput(parameters, key, context)
        return self.destinations[key]

    def _words(self, parameters, context, feedback, inputs):
        """The command line: positional words last, so that a list before them cannot take them."""
        flags, positional = [], []
        for p in self.described():
            if p["name"] in NOT_IN_DIALOG:
                continue
            for value in self._values(p, parameters, context, feedback, inputs):
                if p["positional"]:
                    positional.append(value)
                elif p["type"] == "flag":
                    flags.append(p["flags"][-1])
                else:
                    flags.append(f"{p['flags'][-1]}={value}")
        flags += self._field_words(parameters, context, feedback)
        if any(p["name"] == "progress" for p in self.described()):
            flags.append("--progress=json")
        return flags + (["--", *positional] if positional else [])

    def _field_words(self, parameters, context, feedback):
        words = []
        for name, fields in self.table.get("fields", {}).items():
            for field, _ in fields:
                column = self._column(parameters, key_of(field) + "_FIELD", name, context)
                if column:
                    words.append(f"--field={field}={column}")
                elif field == "frequency" and parameters.get("FREQUENCY") not in (None, ""):
                    words.append("--field=frequency=")  # the program takes one of the two
                    feedback.pushInfo(tr("The events per year are those that were given; a field frequency of the sources is "
                                         "not read."))
        sizes = [field for fields in self.table.get("fields", {}).values() for field, _ in fields if field.startswith("diameter")]
        given = parameters.get("DIAMETER") not in (None, "")
        if sizes and given and not any(word.startswith("--field=diameter") for word in words):
            words += [f"--field={field}=" for field in sizes]
            feedback.pushInfo(tr("The diameter is that which was given; fields of the sources with diameters are not read."))
        return words

    def _column(self, parameters, key, layer, context):
        """A picked field of a layer, as it is called in what the program reads."""
        column = self.parameterAsString(parameters, key, context)
        for plain, source in self.layers.get(key_of(layer)) or ():
            if plain is None and column:
                column = layers.name_in_copy(source, column)
        return column

    def _values(self, p, parameters, context, feedback, inputs):
        """What the user gave for a parameter, as words of the command line; nothing where nothing was given."""
        key, kind = key_of(p["name"]), p["type"]
        if kind == "file" and not p["written"] and set(p["holds"]) & {"raster", "vector"}:
            return self._layer_words(p, parameters, context, feedback, inputs)
        if parameters.get(key) in (None, ""):
            if p["type"] not in ("file", "folder") or not p["written"] or not p["required"]:
                return []
        if kind == "flag":
            return [""] if self.parameterAsBool(parameters, key, context) else []
        if kind == "integer":
            return [str(self.parameterAsInt(parameters, key, context))]
        if kind == "number":
            return [repr(self.parameterAsDouble(parameters, key, context))]
        if kind == "choice":
            return [self.parameterAsEnumString({key: _choice(p, parameters[key])}, key, context)]
        if p["name"] in self.table.get("field of", ()):
            return [self._column(parameters, key, self.table["field of"][p["name"]], context)]
        if p["repeatable"] and kind == "file":
            return self.parameterAsFileList(parameters, key, context)
        if kind in ("file", "folder"):
            return [self._destination(parameters, key, context) if p["written"] else
                    self.parameterAsFile(parameters, key, context)]
        return [self.parameterAsString(parameters, key, context)]

    def _layer_words(self, p, parameters, context, feedback, inputs):
        key = key_of(p["name"])
        words = []
        if "vector" in p["holds"] and self.layers.get(key):
            plain, source = self.layers[key][0]
            if len(self.layers[key]) > 1:
                plain, source = None, layers.Joined([source for _, source in self.layers[key]], context, feedback)
            own_fields = p["name"] in self.table.get("several", ())  # the results have a field fid of their own
            words.append(plain or layers.write_vector(source, inputs, p["name"] + ".gpkg", context, feedback, own_fields))
        raster = self.layers.get(key + "_RASTER" if p["name"] in self.table.get("raster too", ()) else key)
        if "raster" in p["holds"] and raster:
            if words:
                raise QgsProcessingException(tr("{name}: give the polygons or the raster, not both").format(
                    name=label(p["name"])))
            band = parameters.get("DEM_BAND") if p["name"] in self.table.get("bands", ()) else None
            number = self.parameterAsInt(parameters, "DEM_BAND", context) if band else 1
            words.append(layers.raster_file(raster, number, inputs, p["name"], feedback))
        return words

    # Results

    def _results(self, parameters, context, folder, begin):
        found = {}
        table = self.table
        if "geopackage" in table:
            return self._geopackage_results(parameters, context)
        for p in self.described():
            if p.get("written") and p["type"] in ("file", "folder"):
                found[key_of(p["name"])] = self._destination(parameters, key_of(p["name"]), context)
        if table["id"] == "report" and not found.get("OUT"):
            found["OUT"] = self._file_in(self.parameterAsFile(parameters, "FOLDER", context), "report.html")
        if "folder" not in table:
            return {key: value for key, value in found.items() if value}
        for name in table.get("rasters", ()):
            found[key_of(name)] = self._file_in(folder, name + ".tif")
        for name in table.get("vectors", ()):
            path = self._file_in(folder, name + ".gpkg") or self._file_in(folder, name + ".fgb")
            found[key_of(name)] = f"{path}|layername={name}" if path and path.endswith(".gpkg") else path
        for name, file in table.get("files", {}).items():
            found[key_of(name)] = self._file_in(folder, file)
        if table["folder"] == "folder":
            found["RESULTS"] = folder
        if table["id"] == "barrier":
            found.update(self._latest_design(folder))
        if self.parameterAsBool(parameters, "LOAD", context) and not table.get("nothing to load"):
            if parameters.get("RESUME") and self.parameterAsBool(parameters, "RESUME", context):
                begin = 0.0  # of a run that was done already, nothing is written anew
            rows = results.layers_of(folder, *table["layers"]) if "layers" in table else results.files_of(folder, begin)
            results.load(folder, rows, "Talus: " + os.path.basename(folder), context)
        return {key: value for key, value in found.items() if value}

    @staticmethod
    def _file_in(folder, name):
        path = os.path.join(folder, name)
        return path if os.path.exists(path) else None

    def _geopackage_results(self, parameters, context):
        name, names = self.table["geopackage"]
        path = self._destination(parameters, key_of(name), context)
        if not path:
            return {}
        found = {key_of(name): path, **{key_of(layer): f"{path}|layername={layer}" for layer in names}}
        if self.parameterAsBool(parameters, "LOAD", context):
            rows = [(f"{path}|layername={layer}", results.title_of(layer), os.path.basename(path), i, i == 0)
                    for i, layer in enumerate(names)]
            results.load(os.path.dirname(path), rows, "Talus: " + os.path.basename(path), context, path)
        return found

    @staticmethod
    def _latest_design(folder):
        """The table of the values of a barrier, and its line."""
        lines = glob.glob(os.path.join(glob.escape(folder), "barrier_*.gpkg"))
        if not lines:
            return {}
        stem = os.path.splitext(max(lines, key=os.path.getmtime))[0]
        return {"TABLE": stem + ".csv", "LINE": f"{stem}.gpkg|layername={os.path.basename(stem)}"}
