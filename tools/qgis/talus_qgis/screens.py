"""The choice of a screen in a dialog: those of the run whose folder is chosen above."""
import json
import os

from processing.gui.wrappers import DIALOG_MODELER, WidgetWrapper, WidgetWrapperFactory, dialogTypes
from qgis.PyQt.QtWidgets import QComboBox

FOLDER = "FOLDER"  # name of the parameter


def screens_of(folder):
    """The ids of the screens of a run; none of what is no folder of one."""
    try:
        with open(os.path.join(folder, "run.json"), encoding="utf-8") as file:
            return [screen["id"] for screen in json.load(file).get("screens", [])]
    except (OSError, ValueError, TypeError, KeyError, AttributeError):
        return []


class ScreenChoice(WidgetWrapper):
    """A list in which any id can be typed, too: a batch or a script may know one before its run is done."""

    def __new__(cls, param, dialog, row=0, col=0):
        if dialogTypes.get(type(dialog).__name__) != DIALOG_MODELER:
            return super().__new__(cls)
        plain = param.clone()  # in the designer of models a text, which may also come from an input of the model
        plain.setMetadata({})
        widget = WidgetWrapperFactory.create_wrapper(plain, dialog, row, col)
        widget.parameter = plain  # QGIS does not hold it
        return widget

    def createWidget(self):
        box = QComboBox()
        box.setEditable(True)
        box.currentTextChanged.connect(lambda _: self.widgetValueHasChanged.emit(self))
        return box

    def postInitialize(self, wrappers):
        for wrapper in wrappers:
            if wrapper.parameterDefinition().name() == FOLDER:
                wrapper.widgetValueHasChanged.connect(self._list)
                self._list(wrapper)

    def _list(self, folder):
        """Lists the screens of a folder, and chooses the only one. A text stays where it may be right."""
        screens, before = screens_of(folder.parameterValue()), self.value()
        self.widget.clear()
        self.widget.addItems(screens)
        self.setValue(before if before in screens or not screens else screens[0] if len(screens) == 1 else "")

    def setValue(self, value):
        self.widget.setEditText(value or "")

    def value(self):
        return self.widget.currentText().strip()
