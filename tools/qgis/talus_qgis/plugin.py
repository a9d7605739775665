"""The plug-in: it adds the provider to the Processing toolbox and takes it away."""
from qgis.core import QgsApplication

from .provider import TalusProvider


class TalusPlugin:
    def __init__(self):
        self.provider = None

    def initProcessing(self):  # called by qgis_process, too
        self.provider = TalusProvider()
        QgsApplication.processingRegistry().addProvider(self.provider)

    def initGui(self):
        self.initProcessing()

    def unload(self):
        if self.provider is not None:
            QgsApplication.processingRegistry().removeProvider(self.provider)
            self.provider = None
