"""The provider `talus` of the Processing toolbox."""
import os

from qgis.core import QgsProcessingProvider
from qgis.PyQt.QtGui import QIcon

from . import program
from .algorithms import ALGORITHMS, TalusAlgorithm
from .texts import tr

try:
    from processing.core.ProcessingConfig import ProcessingConfig, Setting
except ImportError:  # without the interface of Processing there is only the environment
    ProcessingConfig = None


class TalusProvider(QgsProcessingProvider):
    def id(self):
        return "talus"

    def name(self):
        return "Talus"

    def longName(self):
        return tr("Talus (rock fall)")

    def icon(self):
        return QIcon(os.path.join(os.path.dirname(__file__), "icon.svg"))

    def load(self):
        if ProcessingConfig is not None:
            ProcessingConfig.settingIcons[self.name()] = self.icon()
            ProcessingConfig.addSetting(Setting(self.name(), program.SETTING, tr("Program talus"), "",
                                                valuetype=Setting.FILE))
            ProcessingConfig.readSettings()
        self.refreshAlgorithms()
        return True

    def unload(self):
        if ProcessingConfig is not None:
            ProcessingConfig.removeSetting(program.SETTING)

    def loadAlgorithms(self):
        for table in ALGORITHMS:
            if self._known(table["command"]):
                self.addAlgorithm(TalusAlgorithm(table))

    @staticmethod
    def _known(command):
        """Whether the installed program has the command. Where no program is found all are listed: each says so."""
        try:
            return program.command(command) is not None
        except program.ProgramMissing:
            return True
