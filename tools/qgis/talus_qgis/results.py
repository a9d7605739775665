"""What a command has written, as a group of layers: titles, styles, the hazard class on top."""
import os

from qgis.core import (QgsLayerTreeGroup, QgsProcessingContext, QgsProcessingLayerPostProcessorInterface, QgsProject,
                       QgsProviderRegistry, QgsRasterLayer, QgsVectorLayer)

from .texts import tr

# From the top of the group downwards. `True`: shown at first; the others wait for a click.
ORDER = [("hazard_class", True), ("objects", True), ("stops", False), ("trajectories", False), ("exits.gpkg", False),
         ("reach_probability", True), ("impact_probability", False), ("annual_frequency", False), ("return_period_", False),
         ("intensity_T", False), ("hazard_curves", False), ("energy", False), ("energy_total", False), ("velocity", False),
         ("jump_height", False), ("energy_exceedance", False), ("height_exceedance", False), ("passage_density", False),
         ("passages", False), ("impacts", False), ("deposits", False), ("trapped", False), ("exits", False),
         ("sources", False), ("release", False)]

GROUP_MARK = "talus/folder"  # property of the group: the folder of its results
RANK_MARK = "talus/rank"     # property of a layer: its place in the group

CLOCKS = 2.0  # s by which the clock of a disk may be behind

_kept_alive = []  # QGIS does not hold the post-processors


def rank_of(name):
    """(place, whether it is shown) of a file."""
    stem = os.path.splitext(name)[0]
    exact = {key: i for i, (key, _) in enumerate(ORDER)}
    for key in (name, stem):
        if key in exact:
            return exact[key], ORDER[exact[key]][1]
    for i, (key, shown) in enumerate(ORDER):
        if key.endswith("_") or key == "intensity_T":
            if stem.startswith(key):
                return i, shown
    return len(ORDER), False


def title_of(stem):
    """"Return period of 300 kJ" of `return_period_300`."""
    for key in ("return_period_", "intensity_T"):
        if stem.startswith(key):
            return tr("title " + key).format(stem[len(key):])
    title = tr("title " + stem)
    return stem.replace("_", " ") if title.startswith("title ") else title


def files_of(folder, begin):
    """Layers that were written into a folder since `begin`: (uri, title, file, rank, shown), the top of the group first."""
    found = []
    for name in sorted(os.listdir(folder)):
        path = os.path.join(folder, name)
        stem, kind = os.path.splitext(name)
        if kind not in (".tif", ".gpkg", ".fgb") or not os.path.isfile(path) or os.path.getmtime(path) < begin - CLOCKS:
            continue
        rank, shown = rank_of(name)
        if kind == ".tif":
            found.append((path, title_of(stem), name, rank, shown))
            continue
        for layer in _layers_in(path):
            title = title_of(stem) if layer in ("", stem) else title_of(layer)
            uri = path if not layer else f"{path}|layername={layer}"
            found.append((uri, title, name, rank, shown))
    return sorted(found, key=lambda row: (row[3], row[1]))


def _layers_in(path):
    details = QgsProviderRegistry.instance().querySublayers(path) if hasattr(QgsProviderRegistry.instance(),
                                                                             "querySublayers") else []
    return [d.name() for d in details] or [""]


def load(folder, rows, title, context, group_folder=None):
    """Asks QGIS to load the layers when the algorithm is done, as a group."""
    project = context.project() or QgsProject.instance()
    _kept_alive.clear()
    for uri, name, file, rank, shown in rows:
        details = QgsProcessingContext.LayerDetails(name, project, name)
        processor = IntoGroup(group_folder or folder, title, name, os.path.join(folder, os.path.splitext(file)[0] + ".qml"),
                              rank, shown)
        _kept_alive.append(processor)
        details.setPostProcessor(processor)
        context.addLayerToLoadOnCompletion(uri, details)


class IntoGroup(QgsProcessingLayerPostProcessorInterface):
    """Gives a loaded layer its style and moves it to its place in the group of its results."""

    def __init__(self, folder, title, name, style, rank, shown):
        super().__init__()
        self.folder, self.title, self.name, self.style, self.rank, self.shown = folder, title, name, style, rank, shown

    def postProcessLayer(self, layer, context, feedback):
        layer.setName(self.name)
        if os.path.exists(self.style) and not (isinstance(layer, QgsVectorLayer) and self._is_of_raster()):
            layer.loadNamedStyle(self.style)
        layer.setCustomProperty(RANK_MARK, self.rank)
        project = layer.project() or context.project() or QgsProject.instance()
        node = project.layerTreeRoot().findLayer(layer.id())
        if node is not None:
            self._move(node, project.layerTreeRoot())

    def _is_of_raster(self):
        """Whether the style is that of the raster of the same name (exits.tif beside exits.gpkg)."""
        with open(self.style, encoding="utf-8") as file:
            return "<rasterrenderer" in file.read()

    def _move(self, node, root):
        group = self._group(root)
        place, shown = 0, self.shown
        for other in group.findLayers():
            layer = other.layer()
            if layer is None or layer.id() == node.layerId():
                continue
            if layer.source() == node.layer().source():  # of an earlier run into the same folder
                node.layer().project().removeMapLayer(layer.id())
                continue
            rank = int(layer.customProperty(RANK_MARK, 0))
            if isinstance(layer, QgsRasterLayer) and isinstance(node.layer(), QgsRasterLayer):
                if self.rank == 0:  # nothing shines through the hazard class, whichever of the two comes first
                    other.setItemVisibilityChecked(False)
                elif rank == 0:
                    shown = False
            if (rank, layer.name()) < (self.rank, self.name):
                place += 1
        copy = node.clone()
        copy.setItemVisibilityChecked(shown)
        copy.setExpanded(shown)
        group.insertChildNode(place, copy)
        node.parent().removeChildNode(node)

    def _group(self, root):
        for group in root.findGroups():
            if group.customProperty(GROUP_MARK) == self.folder:
                return group
        group = QgsLayerTreeGroup(self.title)
        group.setCustomProperty(GROUP_MARK, self.folder)
        root.insertChildNode(0, group)
        return group
