"""Talus in QGIS: a Processing provider that runs the installed program `talus`. docs/qgis.md."""


def classFactory(interface):
    from .plugin import TalusPlugin
    return TalusPlugin()
