"""What a command has written, as a group of layers: titles, styles, the hazard class on top."""
import json
import os
import re
from contextlib import contextmanager

from qgis.core import (Qgis, QgsFillSymbol, QgsGraduatedSymbolRenderer, QgsHillshadeRenderer, QgsLayerTree, QgsLayerTreeGroup, QgsLineSymbol,
                       QgsMapLayerLegendUtils, QgsMarkerSymbol, QgsPalettedRasterRenderer, QgsProcessingContext,
                       QgsProcessingLayerPostProcessorInterface, QgsProject, QgsProviderRegistry,
                       QgsRasterDataProvider, QgsRasterLayer, QgsRasterPipe, QgsRendererRange, QgsSimpleLineSymbolLayer, QgsSingleBandPseudoColorRenderer,
                       QgsSingleSymbolRenderer, QgsVectorLayer,
                       QgsWkbTypes)
from qgis.PyQt.QtCore import QCoreApplication, Qt, QThread
from qgis.PyQt.QtGui import QColor

from . import program
from .texts import tr

GROUP_MARK = "talus/folder"  # property of the group: the folder of its results
RANK_MARK = "talus/rank"     # property of a layer: its place in the group
TITLE_MARK = "talus/title"   # property of a layer: its title; its name may say the folder, too

BELOW_ALL = 1e9  # rank of the hillshade
LINES_OF_OBJECTS = "1.8"  # mm, as in src/io/results/vector_style.cpp
NEVER = 1e97  # years; from here on an object is not hit
TYPED = "|option:AUTODETECT_TYPE=YES"  # after the path of a table: its numbers are numbers
ONE_KIND = "|geometrytype="  # in the source of a layer: one kind of geometry of a file that holds several

CLOCKS = 2.0  # s by which the clock of a disk may be behind

_kept_alive = set()  # QGIS does not hold the post-processors: each stays until its layer is loaded


def _entries():
    """The layers of results, from the top of the group downwards, as the program tells them; none where there is none."""
    try:
        return program.description()["results"]
    except program.ProgramMissing:
        return []


def _entry(name):
    """(place in the group, entry, what stands for <n> or <id>) of a file; None of one that is no result."""
    name = re.sub(r"\.fgb$", ".gpkg", name)
    for rank, entry in enumerate(_entries()):
        if entry.get("style"):  # over the map of this file: `_marks_of`
            continue
        before, blank, after = re.fullmatch(r"([^<]*)(<\w+>)?(.*)", entry["file"]).groups()
        word = {None: "()", "<n>": "([0-9.e+-]+)", "<id>": "(.+)"}[blank]
        found = re.fullmatch(re.escape(before) + word + re.escape(after), name)
        if found:
            return rank, entry, found[1]
    return None


def title_of(name, folder=None):
    """"Return period of more than 300 kJ" of the file `return_period_300.tif`; of another layer by its name. A design in a
    folder has the id of its line."""
    found = _entry(name)
    if found is None:
        title = tr("title " + name)
        return name.replace("_", " ") if title.startswith("title ") else title
    word = _id_of_design(folder, name) or found[2] if folder and name.startswith("barrier_") else found[2]
    return _title_in_run(re.sub("<n>|<id>", lambda _: word, tr(found[1]["title"])), found[1], _settings_of(folder))


def _title_in_run(title, entry, settings):
    """A title with what the settings of the run say: the lowest threshold, and which energy counts."""
    values, unit = settings.get(entry.get("thresholds"), ("", ""))  # "[30, 300]", in ascending order
    lowest = values.strip("[]").split(",")[0]
    title = title.replace("<threshold>", f"{lowest} {unit}" if lowest else tr("the lowest threshold"))
    counted = {"true": tr(", energy with rotation"), "false": tr(", translational energy")}
    return title + counted.get(settings.get("output.count_rotation", ("", ""))[0], "") if entry.get("counts_energy") else title


def _record_of_run(folder):
    """The run.json of a folder; of a comparison that of its last run, as talus.qgs has it."""
    compared = os.path.join(folder, "compare.json")
    if os.path.exists(compared):
        with open(compared, encoding="utf-8") as file:
            folder = json.load(file)["runs"][-1]
    return os.path.join(folder, "run.json")


def _settings_of(folder):
    """(value, unit) of the settings of a run, by their keys; none in a folder without a record."""
    try:
        with open(_record_of_run(folder), encoding="utf-8") as file:
            return {s["key"]: (str(s["value"]), s.get("unit", "")) for s in json.load(file)["settings"]}
    except (OSError, ValueError, KeyError, TypeError):
        return {}


def _id_of_design(folder, name):
    """The id of the line of a design as the user has given it: the record has it; the name of the files is made of it."""
    try:
        with open(os.path.join(folder, os.path.splitext(name)[0] + ".json"), encoding="utf-8") as file:
            return str(json.load(file)["screen"])
    except (OSError, ValueError, KeyError, TypeError):
        return None


def files_of(folder, begin):
    """Layers that were written into a folder since `begin`: (uri, title, file, rank, shown), the top of the group first."""
    found = []
    for name in sorted(os.listdir(folder)):
        path = os.path.join(folder, name)
        stem, kind = os.path.splitext(name)
        entry = _entry(name)
        if entry is None or not os.path.isfile(path) or os.path.getmtime(path) < begin - CLOCKS:
            continue
        if name.startswith("barrier_") and not os.path.exists(os.path.join(folder, stem + ".json")):
            continue  # no design, but its stretches, which the layer has, or a file of the user
        rank, shown, title = entry[0], entry[1]["shown"], title_of(name, folder)
        if kind in (".tif", ".csv"):
            found.append((path + (TYPED if kind == ".csv" else ""), title, name, rank, shown))
            continue
        for layer, one_kind in _layers_in(path):
            uri = path if not layer else f"{path}|layername={layer}{one_kind}"
            lines = one_kind.startswith(ONE_KIND + "LineString")  # as there: the lines lie above the areas
            one = tr("{title} (lines)").format(title=title) if lines else title if layer in ("", stem) else title_of(layer)
            found.append((uri, one, name, rank - 0.5 if lines else rank, shown and layer in ("", stem)))
    return sorted(found, key=lambda row: _place(row[3], row[1]))


def layers_of(folder, file, names):
    """Layers of a profile, as rows of `files_of`, the top first and the last hidden: those that it has, as it has no crossings
    where nothing crosses; none of a profile of x and z, which has no place on the map."""
    with open(os.path.join(folder, "run.json"), encoding="utf-8") as record:
        if not any(read["role"] == "line" for read in json.load(record)["inputs"]):
            return []
    path = os.path.join(folder, file)
    there = {layer for layer, _ in _layers_in(path)}
    return [(f"{path}|layername={name}", title_of(name), file, rank, name != names[-1])
            for rank, name in enumerate(names) if name in there]


def _place(rank, title):
    """What layers are sorted by: shorter titles first, as 30 kJ before 300 kJ."""
    return rank, len(title), title


def _layers_in(path):
    """(name, kind of geometry) of the layers in a file: QGIS draws one kind per layer; "" where there is only one."""
    details = QgsProviderRegistry.instance().querySublayers(path, Qgis.SublayerQueryFlag.ResolveGeometryType)
    names = [d.name() for d in details]
    return [(d.name(), ONE_KIND + QgsWkbTypes.displayString(QgsWkbTypes.flatType(d.wkbType()))
             if names.count(d.name()) > 1 else "") for d in details] or [("", "")]


def _same_layer(source, other):
    """Whether two sources show the same features of a file, or one of them a part of those of the other."""
    return source == other or (source.split(ONE_KIND)[0] == other.split(ONE_KIND)[0] and
                               (ONE_KIND in source) != (ONE_KIND in other))


def _apply_style_in_file(layer):
    """The style that the program has written into the GeoPackage: Processing loads layers without it."""
    if layer.loadDefaultStyle()[1] or ONE_KIND not in layer.source():
        return
    areas = QgsVectorLayer(layer.source().split(ONE_KIND)[0] + ONE_KIND + "Polygon", "", "ogr")  # with its style
    if layer.geometryType() == QgsWkbTypes.LineGeometry and isinstance(areas.renderer(), QgsGraduatedSymbolRenderer):
        layer.setRenderer(_in_lines(areas.renderer()))


def _in_lines(of_areas):
    """The same classes and colours for lines."""
    classes = []
    for entry in of_areas.ranges():
        line = QgsLineSymbol.createSimple({"line_color": entry.symbol().color().name(), "line_width": LINES_OF_OBJECTS})
        if entry.lowerValue() >= NEVER:
            line.insertSymbolLayer(0, QgsSimpleLineSymbolLayer(QColor("#232323"), float(LINES_OF_OBJECTS) + 0.8))
        classes.append(QgsRendererRange(entry.lowerValue(), entry.upperValue(), line, entry.label()))
    return QgsGraduatedSymbolRenderer(of_areas.classAttribute(), classes)


def _is_hazard_class(layer):
    return os.path.basename(layer.source()) in ("hazard_class.tif", "highest_hazard_class.tif")


def _inputs_of(folder, role):
    """The paths that a run has read as its `dem`, `sources` or `barriers`; none in a folder without a record."""
    try:
        with open(_record_of_run(folder), encoding="utf-8") as file:
            return [read["path"] for read in json.load(file)["inputs"] if read["role"] == role]
    except (OSError, ValueError, KeyError, TypeError):
        return []


def _hillshade_of(folder):
    """The DEM of a run as talus.qgs shows it, below all results; None where it is no file, or no longer one."""
    path = next(iter(_inputs_of(folder, "dem")), "")
    if not os.path.isfile(path):
        return None
    layer = QgsRasterLayer(path, tr("title hillshade"))
    shade = QgsHillshadeRenderer(layer.dataProvider(), 1, 315, 45)
    shade.setMultiDirectional(True)
    layer.setRenderer(shade)
    layer.setResamplingStage(QgsRasterPipe.ResamplingStage.Provider)  # as in src/io/results/qgis_project.cpp
    layer.dataProvider().enableProviderResampling(True)
    layer.dataProvider().setZoomedInResamplingMethod(QgsRasterDataProvider.ResamplingMethod.Bilinear)
    layer.setCustomProperty(RANK_MARK, BELOW_ALL)
    layer.setCustomProperty(TITLE_MARK, layer.name())
    return layer


def _outlines_of(folder):
    """The barriers and the sources of a run above its maps, as talus.qgs shows them; none of what is no file any more."""
    inputs = [(title, path) for role, title in (("barriers", "Barriers of the run"), ("sources", "Sources of the run"))
              for path in _inputs_of(folder, role)]
    above_maps = next((rank for rank, entry in enumerate(_entries()) if entry["file"].endswith(".tif")), 0) - 0.3
    looks = {QgsWkbTypes.PointGeometry: (QgsMarkerSymbol, {"color": "#333333", "size": "2"}),
             QgsWkbTypes.LineGeometry: (QgsLineSymbol, {"color": "#333333", "line_width": "0.6"}),
             QgsWkbTypes.PolygonGeometry: (QgsFillSymbol, {"style": "no", "outline_color": "#333333", "outline_width": "0.6"})}
    outlines = []
    for place, (title, path) in enumerate(inputs):
        layer = QgsVectorLayer(path, tr(title), "ogr") if os.path.isfile(path.split("|")[0]) else None
        if layer is None or not layer.isValid() or layer.geometryType() not in looks:
            continue
        kind, look = looks[layer.geometryType()]
        layer.setRenderer(QgsSingleSymbolRenderer(kind.createSimple(look)))
        layer.setCustomProperty(RANK_MARK, above_maps + 0.1 * place)
        layer.setCustomProperty(TITLE_MARK, layer.name())
        outlines.append(layer)
    return outlines


def _marks_of(folder):
    """(layer, whether it is shown at first) of what lies over the hazard class, as talus.qgs has it: where the run has none,
    the program has not written its style."""
    for rank, entry in enumerate(_entries()):
        style = os.path.join(folder, entry["style"]) if entry.get("style") else ""
        if not os.path.exists(style):
            continue
        layer = QgsRasterLayer(os.path.join(folder, entry["file"]), tr(entry["title"]))
        layer.loadNamedStyle(style)
        _translate_legend(layer)
        layer.setCustomProperty(RANK_MARK, rank)
        layer.setCustomProperty(TITLE_MARK, layer.name())
        yield layer, entry["shown"]


def _rank(layer):
    return float(layer.customProperty(RANK_MARK, 0))


def legend_text(text):
    """A label of a legend in the language of QGIS: `up to 30 kJ`, `30 to 100 kJ`, `above 3000 kJ`."""
    for pattern, words in ((r"up to (\S+)(.*)", "up to {}{}"), (r"above (\S+)(.*)", "above {}{}"),
                           (r"(\S+) to (\S+)(.*)", "{} to {}{}")):
        found = re.fullmatch(pattern, text)
        if found:
            *limits, rest = found.groups()
            return tr(words).format(*limits, tr(rest))
    return tr(text)


def _classes_of_user(folder):
    """Whether the classes of hazard are those of a matrix that the user has given (`talus hazard --matrix`)."""
    try:
        with open(os.path.join(folder, "hazard.json"), encoding="utf-8") as file:
            return json.load(file)["matrix_file"] != "default"
    except (OSError, ValueError, KeyError):
        return False


def _translate_legend(layer):
    if isinstance(layer, QgsVectorLayer):
        if isinstance(layer.renderer(), QgsGraduatedSymbolRenderer):
            for i, entry in enumerate(layer.renderer().ranges()):
                layer.renderer().updateRangeLabel(i, legend_text(entry.label()))
        return
    if isinstance(layer.renderer(), QgsPalettedRasterRenderer):
        for one in layer.renderer().classes():
            layer.renderer().setLabel(int(one.value), legend_text(one.label))
        return
    shader = layer.renderer().shader() if isinstance(layer.renderer(), QgsSingleBandPseudoColorRenderer) else None
    if shader is None:
        return
    colours = shader.rasterShaderFunction()
    items = colours.colorRampItemList()
    for item in items:
        item.label = legend_text(item.label)
    colours.setColorRampItemList(items)


def _leave_out_band(node):
    """Takes the name of the band, which is English and says what the title says, out of the legend of a raster."""
    layer = node.layer()
    if not isinstance(layer, QgsRasterLayer) or layer.legend() is None or not layer.renderer().usesBands():
        return
    entries = layer.legend().createLayerTreeModelLegendNodes(node)
    band = layer.renderer().displayBandName(layer.renderer().usesBands()[0]) if entries else None
    if band and entries[0].data(Qt.DisplayRole) == band:
        QgsMapLayerLegendUtils.setLegendNodeOrder(node, list(range(1, len(entries))))


def _read_anew(layer):
    """Reads the file, fields and extent of a layer again. GDAL writes statistics beside a raster that it closes, over what
    the program has written there: that is put back."""
    if isinstance(layer, QgsRasterLayer):
        with _kept_beside(layer.source()):
            layer.dataProvider().reloadData()
        layer.dataProvider().reloadData()
        layer.setExtent(layer.dataProvider().extent())
    else:
        layer.reload()
    layer.triggerRepaint()


@contextmanager
def _kept_beside(path):
    """Keeps what lies beside a raster as PATH.aux.xml."""
    beside = path + ".aux.xml"
    before = _bytes_of(beside)
    yield
    if before == _bytes_of(beside):
        return
    if before is None:
        os.remove(beside)
        return
    with open(beside, "wb") as file:
        file.write(before)


def _bytes_of(path):
    """The content of a file; None where there is none."""
    if not os.path.exists(path):
        return None
    with open(path, "rb") as file:
        return file.read()


def _in_main_thread():
    """The layers and their tree belong to it; algorithms of a model are made in others."""
    return QThread.currentThread() == QCoreApplication.instance().thread()


def only_raster(project):
    """The raster of a project that is no result, if there is just one."""
    if not _in_main_thread():
        return None
    rasters = [layer for layer in project.mapLayers().values()
               if isinstance(layer, QgsRasterLayer) and layer.providerType() == "gdal"
               and layer.customProperty(TITLE_MARK) is None
               and not os.path.exists(os.path.join(os.path.dirname(layer.source()), "run.json"))]
    return rasters[0].id() if len(rasters) == 1 else None


def latest_folder(project):
    """The folder of the results that a project shows, the topmost first; None where there is none that is still there."""
    if not _in_main_thread():
        return None
    groups = sorted(project.layerTreeRoot().findGroups(), key=lambda group: not group.itemVisibilityChecked())
    marked = [group.customProperty(GROUP_MARK) for group in groups]
    return next((folder for folder in marked if folder and os.path.exists(os.path.join(folder, "run.json"))), None)


def load(folder, rows, title, context, group_folder=None):
    """Asks QGIS to load the layers when the algorithm is done, as a group."""
    project = context.project() or QgsProject.instance()
    for uri, name, file, rank, shown in rows:
        details = QgsProcessingContext.LayerDetails(name, project, name)
        processor = IntoGroup(group_folder or folder, title, name, os.path.join(folder, os.path.splitext(file)[0] + ".qml"),
                              rank, shown)
        _kept_alive.add(processor)
        details.setPostProcessor(processor)
        context.addLayerToLoadOnCompletion(uri, details)


class IntoGroup(QgsProcessingLayerPostProcessorInterface):
    """Gives a loaded layer its style and moves it to its place in the group of its results."""

    def __init__(self, folder, title, name, style, rank, shown):
        super().__init__()
        self.folder, self.title, self.name, self.style, self.rank, self.shown = folder, title, name, style, rank, shown

    def postProcessLayer(self, layer, context, feedback):
        _kept_alive.discard(self)
        layer.setName(self.name)
        _read_anew(layer)  # QGIS takes a layer that is there already where it has the same file
        if isinstance(layer, QgsVectorLayer) and ".gpkg|layername=" in layer.source():
            _apply_style_in_file(layer)
        elif os.path.exists(self.style) and not (isinstance(layer, QgsVectorLayer) and self._is_of_raster()):
            layer.loadNamedStyle(self.style)
        layer.setCustomProperty(RANK_MARK, self.rank)
        layer.setCustomProperty(TITLE_MARK, self.name)
        if not _is_hazard_class(layer) or not _classes_of_user(self.folder):
            _translate_legend(layer)
        project = layer.project() or context.project() or QgsProject.instance()
        node = project.layerTreeRoot().findLayer(layer.id())
        if node is not None:
            self._move(node, project)

    def _is_of_raster(self):
        """Whether the style is that of the raster of the same name alone (exits.tif beside exits.gpkg)."""
        with open(self.style, encoding="utf-8") as file:
            return "<renderer-v2" not in file.read()

    def _move(self, node, project):
        root = project.layerTreeRoot()
        group = self._group(project)
        shown = self.shown
        self._remove_layers_without_file(group)
        self._tell_from_others(node.layer(), root, group)
        for other in group.findLayers():
            layer = other.layer()
            if layer is None or layer.id() == node.layerId():
                continue
            if _same_layer(layer.source(), node.layer().source()):  # of an earlier run into the same folder
                node.layer().project().removeMapLayer(layer.id())
                continue
            if isinstance(layer, QgsRasterLayer) and isinstance(node.layer(), QgsRasterLayer) and _rank(layer) != BELOW_ALL:
                if _is_hazard_class(node.layer()):  # nothing shines through the hazard class, whichever of the two comes first
                    other.setItemVisibilityChecked(False)
                elif _is_hazard_class(layer):
                    shown = False
        # QGIS may have put the node itself into the group, before the layer that was current
        place = next((i for i, child in enumerate(group.children()) if self._is_below(child, node)), len(group.children()))
        copy = node.clone()
        _leave_out_band(copy)
        copy.setItemVisibilityChecked(shown)
        copy.setExpanded(shown)
        group.insertChildNode(place, copy)
        node.parent().removeChildNode(node)
        if _is_hazard_class(copy.layer()):
            self._add_marks(copy, project)

    def _add_marks(self, node, project):
        """Puts what lies over the hazard class above it."""
        group = node.parent()
        for layer, shown in _marks_of(self.folder):
            self._tell_from_others(layer, project.layerTreeRoot(), group)
            project.addMapLayer(layer, False)
            mark = group.insertLayer(group.children().index(node), layer)
            _leave_out_band(mark)
            mark.setItemVisibilityChecked(shown)
            mark.setExpanded(shown)

    def _tell_from_others(self, layer, root, group):
        """Names a layer with its folder, where another folder has one of the same title: a list of layers tells the two apart."""
        title = layer.customProperty(TITLE_MARK)
        if self._is_title_elsewhere(title, root, group, layer.id()):
            layer.setName(f"{title} ({self._folder_among(root, group)})")

    @staticmethod
    def _remove_layers_without_file(group):
        """Takes out results of an earlier command that this one has removed."""
        for other in group.findLayers():
            layer = other.layer()
            if layer is not None and layer.customProperty(TITLE_MARK) and not os.path.exists(layer.source().split("|")[0]):
                layer.project().removeMapLayer(layer.id())

    @staticmethod
    def _is_title_elsewhere(title, root, group, layer_id):
        """Whether the results of another folder have a layer of this title. QGIS may have put the layer itself anywhere."""
        own = {node.layerId() for node in group.findLayers()} | {layer_id}
        return any(other.layer() is not None and other.layer().customProperty(TITLE_MARK) == title
                   for results in root.findGroups() if results is not group
                   for other in results.findLayers() if other.layerId() not in own)

    def _folder_among(self, root, group):
        """The end of the folder's path that tells it from the folders of the other groups: OUT, or north/OUT."""
        others = [other.customProperty(GROUP_MARK) for other in root.findGroups()
                  if other is not group and other.customProperty(GROUP_MARK)]
        parts = self.folder.split(os.sep)
        ends = (os.sep.join(parts[-count:]) for count in range(1, len(parts)))
        return next((end for end in ends if not any((os.sep + other).endswith(os.sep + end) for other in others)), self.folder)

    def _is_below(self, child, node):
        """Whether a child of the group has its place below the layer."""
        if not QgsLayerTree.isLayer(child) or child.layer() is None or child.layerId() == node.layerId():
            return False
        return _place(_rank(child.layer()), child.layer().customProperty(TITLE_MARK, "")) > _place(self.rank, self.name)

    def _group(self, project):
        """The group of the results, which is shown; those of other folders are hidden: their colours would shine through."""
        root = project.layerTreeRoot()
        marked = [group for group in root.findGroups() if group.customProperty(GROUP_MARK)]
        own = next((group for group in marked if group.customProperty(GROUP_MARK) == self.folder), None)
        if own is None:
            own = QgsLayerTreeGroup(self.title)
            own.setCustomProperty(GROUP_MARK, self.folder)
            root.insertChildNode(0, own)
            for layer in [*_outlines_of(self.folder), *filter(None, [_hillshade_of(self.folder)])]:
                project.addMapLayer(layer, False)
                own.addLayer(layer).setExpanded(False)
        for group in marked:  # candidate sources are marked by their file, and stay
            if group is not own and os.path.isdir(self.folder) and os.path.isdir(group.customProperty(GROUP_MARK)):
                self._hide(group)
        own.setItemVisibilityChecked(True)
        return own

    @staticmethod
    def _hide(group):
        """Hides the results in a group; a layer of the user's own, which QGIS may have put there, stays as it is."""
        of_talus = [node for node in group.findLayers() if node.layer() is None or node.layer().customProperty(TITLE_MARK)]
        hidden = [group] if len(of_talus) == len(group.findLayers()) else of_talus
        for node in hidden:
            node.setItemVisibilityChecked(False)
