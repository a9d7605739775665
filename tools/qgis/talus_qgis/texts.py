"""Texts in English and German; the language is that of QGIS. A text without a translation stays English."""
from qgis.core import QgsApplication

# Names of parameters in the dialogs: English, German.
LABELS = {
    "dem": ("Terrain (DEM, metres)", "Gelände (DGM, Meter)"),
    "dem-band": ("Band of the terrain", "Band des Geländes"),
    "sources": ("Sources (where blocks start)", "Anbruchgebiete (wo Blöcke starten)"),
    "diameter-field": ("Field: diameter of the block [m]", "Feld: Durchmesser des Blocks [m]"),
    "release_height-field": ("Field: height of release above the ground [m]", "Feld: Starthöhe über dem Boden [m]"),
    "frequency-field": ("Field: events per year", "Feld: Ereignisse pro Jahr"),
    "diameter_min-field": ("Field: smallest diameter [m]", "Feld: kleinster Durchmesser [m]"),
    "diameter_max-field": ("Field: largest diameter [m]", "Feld: grösster Durchmesser [m]"),
    "name-field": ("Field: name", "Feld: Name"),
    "diameter": ("Diameter of the blocks", "Durchmesser der Blöcke"),
    "preset": ("Ground", "Boden"),
    "trajectories": ("Trajectories per source cell", "Sturzbahnen pro Anbruchzelle"),
    "frequency": ("Frequency of all sources together", "Häufigkeit aller Anbruchgebiete zusammen"),
    "screens": ("Screens (lines where crossings are recorded)", "Nachweislinien (Durchgänge werden festgehalten)"),
    "barriers": ("Barriers (lines; fields height [m], capacity [kJ])", "Schutzbauten (Linien; Felder height [m], capacity [kJ])"),
    "zones": ("Zones of ground (polygons)", "Bodenzonen (Flächen)"),
    "zones-raster": ("Zones of ground as a raster", "Bodenzonen als Raster"),
    "zone-field": ("Field: zone or preset", "Feld: Zone oder Parametersatz"),
    "thresholds": ("Thresholds of energy", "Schwellen der Energie"),
    "scenario": ("Scenario file", "Szenario-Datei"),
    "surface": ("Surface between cell centres", "Oberfläche zwischen den Zellmitten"),
    "seed": ("Seed of the random numbers", "Startwert der Zufallszahlen"),
    "energy-total": ("Energy with rotation, too", "Auch die Energie mit Rotation"),
    "bounds": ("95 % bounds of the percentiles, too", "Auch 95-%-Schranken der Perzentile"),
    "vectors": ("Format of the layers", "Format der Layer"),
    "out": ("Results", "Ergebnisse"),
    "overwrite": ("Replace earlier results", "Frühere Ergebnisse ersetzen"),
    "threads": ("Processors (threads)", "Prozessoren (Threads)"),
    "resume": ("Resume a run that was cancelled", "Abgebrochenen Lauf fortsetzen"),
    "rounds": ("Rounds", "Runden"),
    "until-error": ("Rounds until the relative error is below", "Runden, bis der relative Fehler kleiner ist als"),
    "above": ("... in cells with a probability above", "... in Zellen mit einer Wahrscheinlichkeit über"),
    "most-rounds": ("... but never more rounds than", "... aber nie mehr Runden als"),
    "allow-folder": ("Folder that a VRT may read", "Ordner, aus dem ein VRT lesen darf"),
    "pits": ("Map of the pits", "Karte der Mulden"),
    "slope": ("Steepness of source cells", "Neigung der Anbruchzellen"),
    "folder": ("Folder of a run", "Ordner eines Laufs"),
    "weighting": ("Other frequencies of the sources (TOML)", "Andere Häufigkeiten der Anbruchgebiete (TOML)"),
    "matrix": ("Classes (TOML)", "Gefahrenstufen (TOML)"),
    "objects": ("Objects at risk (houses, roads)", "Gefährdete Objekte (Häuser, Strassen)"),
    "width": ("Width of the object", "Breite des Objekts"),
    "curves": ("Hazard curves of every cell", "Gefahrenkurven jeder Zelle"),
    "screen": ("Screen at which the barrier stands (id)", "Nachweislinie, an der das Netz steht (id)"),
    "observed": ("Observed crossings (CSV)", "Beobachtete Durchgänge (CSV)"),
    "gTr": ("Factor of the trajectories (gTr)", "Beiwert der Sturzbahnen (gTr)"),
    "gDp": ("Factor of the topography (gDp)", "Beiwert des Geländes (gDp)"),
    "gVol": ("Factor of the volume (gVol)", "Beiwert des Volumens (gVol)"),
    "gG": ("Factor of the density (gG)", "Beiwert der Dichte (gG)"),
    "gE": ("MEL / SEL (gE)", "MEL / SEL (gE)"),
    "percentile": ("Percentile of speed and jump height", "Perzentil von Geschwindigkeit und Sprunghöhe"),
    "volume": ("Volume of the design block", "Volumen des Bemessungsblocks"),
    "density": ("Density of the rock", "Dichte des Gesteins"),
    "containment": ("Share of the crossings held by the width", "Anteil der Durchgänge in der Breite"),
    "stretch": ("Longest stretch with a design of its own", "Längster Abschnitt mit eigener Bemessung"),
    "unweighted": ("Count every block alike", "Jeden Block gleich zählen"),
    "profile": ("Profile (TOML)", "Profil (TOML)"),
    "campaign": ("Campaigns (campaign.toml)", "Messkampagnen (campaign.toml)"),
    "title": ("Title", "Titel"),
    "attribution": ("Attribution of terrain and maps", "Quellenangabe zu Gelände und Karten"),
    "load": ("Load the results into the map", "Ergebnisse in die Karte laden"),
}

# Texts by key, for both languages; and English texts of the plug-in or of the program, in German.
KEYS = {
    "algorithm run": ("Run a simulation", "Simulation rechnen"),
    "algorithm check": ("Check inputs and plan", "Eingaben und Plan prüfen"),
    "algorithm hazard": ("Hazard maps", "Gefahrenkarten"),
    "algorithm objects": ("Hazard of objects", "Gefährdung von Objekten"),
    "algorithm barrier": ("Design of a barrier", "Bemessung eines Schutznetzes"),
    "algorithm sources": ("Find candidate sources", "Mögliche Anbruchgebiete suchen"),
    "algorithm profile": ("2D model on a profile", "2D-Modell auf einem Profil"),
    "algorithm calibrate": ("Calibrate the ground", "Boden kalibrieren"),
    "algorithm diagnose": ("Diagnose what a model lacks", "Diagnose: was dem Modell fehlt"),
    "algorithm report": ("Report (HTML)", "Bericht (HTML)"),
    "about run": ("Simulates falling blocks from the sources over the terrain and maps how often, how fast and how high they "
                  "pass each cell. Give terrain, sources and a diameter, or a scenario file. Cancel keeps what was traced; "
                  "\"Resume\" goes on with it.",
                  "Simuliert Blöcke von den Anbruchgebieten über das Gelände und kartiert, wie oft, wie schnell und wie hoch "
                  "sie jede Zelle durchqueren. Nötig sind Gelände, Anbruchgebiete und ein Durchmesser, oder eine "
                  "Szenario-Datei. Abbrechen behält das Gerechnete; «Fortsetzen» macht damit weiter."),
    "about check": ("Checks layers and settings, lists every fault, every field that is read with its range, and the plan: "
                    "cells, trajectories, memory, time. Writes nothing.",
                    "Prüft Ebenen und Einstellungen, nennt jeden Fehler, jedes gelesene Feld mit seinem Wertebereich und den "
                    "Plan: Zellen, Sturzbahnen, Speicher, Zeit. Schreibt nichts."),
    "about hazard": ("Annual frequencies, return periods, intensities and hazard classes from a run whose sources have "
                     "frequencies. Without a width the maps are for the cell.",
                     "Jährliche Häufigkeiten, Wiederkehrperioden, Intensitäten und Gefahrenstufen aus einem Lauf, dessen "
                     "Anbruchgebiete Häufigkeiten haben. Ohne Breite gelten die Karten für die Zelle."),
    "about objects": ("How often each house or road is hit, with which energy, and from where. Repeats the run, with the same "
                      "bits, and writes the hazard maps anew.",
                      "Wie oft jedes Haus oder jede Strasse getroffen wird, mit welcher Energie und woher. Wiederholt den Lauf "
                      "Bit für Bit und schreibt auch die Gefahrenkarten neu."),
    "about barrier": ("Design values of a barrier at a screen of a run: energy, height, width, by stretch, and how often they "
                      "are exceeded.",
                      "Bemessungswerte eines Schutznetzes an einer Nachweislinie: Energie, Höhe, Breite, je Abschnitt, und wie "
                      "oft sie überschritten werden."),
    "about sources": ("Candidate source cells by the steepness of the terrain: look at them before a run.",
                      "Mögliche Anbruchzellen nach der Neigung des Geländes: vor einem Lauf ansehen."),
    "about profile": ("Simulates in two dimensions on a profile.", "Simuliert in zwei Dimensionen auf einem Profil."),
    "about calibrate": ("Fits the parameters of the ground to measured rock falls.",
                        "Passt die Parameter des Bodens an gemessene Stürze an."),
    "about diagnose": ("Finds what a fitted model leaves of measured data, and which effect explains it.",
                       "Findet, was ein angepasstes Modell von den Messungen übrig lässt, und welcher Effekt es erklärt."),
    "about report": ("One self-contained HTML page on a run: maps, tables, checklist. Run it last.",
                     "Eine eigenständige HTML-Seite über einen Lauf: Karten, Tabellen, Prüfliste. Zuletzt ausführen."),
    "phase simulate": ("Simulating", "Simuliert"),
    "phase write": ("Writing the results", "Schreibt die Ergebnisse"),
    "phase evaluate": ("Evaluating the cells", "Wertet die Zellen aus"),
    "phase fit": ("Fitting", "Passt an"),
    "phase diagnose": ("Diagnosing", "Diagnose"),
    # titles of the results: the English ones are those of the project talus.qgs (src/io/results/qgis_project.cpp)
    "title objects": ("Objects: return period of a hit", "Objekte: Wiederkehrperiode eines Treffers"),
    "title screens": ("Screens: energy, P95", "Nachweislinien: Energie, P95"),
    "title exits.gpkg": ("Ends off the map: energy", "Enden ausserhalb der Karte: Energie"),
    "title stops": ("Stops: largest energy of the path", "Haltepunkte: grösste Energie der Bahn"),
    "title trajectories": ("Paths: largest speed", "Bahnen: grösste Geschwindigkeit"),
    "title vertices": ("Vertices of the paths", "Stützpunkte der Bahnen"),
    "title hazard_class": ("Hazard class", "Gefahrenstufe"),
    "title annual_frequency": ("Blocks per year", "Blöcke pro Jahr"),
    "title return_period_": ("Return period of more than {} kJ", "Wiederkehrperiode von mehr als {} kJ"),
    "title intensity_T": ("Energy once in {} years", "Energie einmal in {} Jahren"),
    "title hazard_curves": ("Hazard curves: annual frequency", "Gefahrenkurven: Häufigkeit pro Jahr"),
    "title impact_probability": ("Impact probability", "Trefferwahrscheinlichkeit"),
    "title reach_probability": ("Reach probability", "Erreichenswahrscheinlichkeit"),
    "title passage_density": ("Passage density", "Durchgangsdichte"),
    "title energy": ("Energy, P95", "Energie, P95"),
    "title energy_total": ("Energy with rotation, P95", "Energie mit Rotation, P95"),
    "title jump_height": ("Jump height, P95", "Sprunghöhe, P95"),
    "title velocity": ("Speed, P95", "Geschwindigkeit, P95"),
    "title energy_exceedance": ("Share above the first energy threshold", "Anteil über der ersten Energieschwelle"),
    "title height_exceedance": ("Share above the first height threshold", "Anteil über der ersten Höhenschwelle"),
    "title energy_bounds": ("Energy, upper bound of P95", "Energie, obere Grenze des P95"),
    "title jump_height_bounds": ("Jump height, upper bound of P95", "Sprunghöhe, obere Grenze des P95"),
    "title velocity_bounds": ("Speed, upper bound of P95", "Geschwindigkeit, obere Grenze des P95"),
    "title passages": ("Passages", "Durchgänge"),
    "title impacts": ("Impacts", "Aufschläge"),
    "title deposits": ("Deposits", "Ablagerungen"),
    "title trapped": ("Trapped blocks", "Gefangene Blöcke"),
    "title exits": ("Exits", "Austritte"),
    "title release": ("Release cells", "Startzellen"),
    "title sources": ("Source cells that reach the cell", "Anbruchzellen, die die Zelle erreichen"),
    "title source_polygons": ("Candidate sources", "Mögliche Anbruchgebiete"),
    "title source_points": ("Candidate source cells", "Mögliche Anbruchzellen"),
}

GERMAN = {
    "Talus (rock fall)": "Talus (Steinschlag)",
    "Program talus": "Programm talus",
    "the setting of Processing": "die Einstellung der Verarbeitung",
    "the environment variable TALUS": "die Umgebungsvariable TALUS",
    "{path} ({origin}) is no program that can be run. {way_out}":
        "{path} ({origin}) ist kein Programm, das laufen kann. {way_out}",
    "The program talus is not on this computer. {way_out}": "Das Programm talus fehlt auf diesem Rechner. {way_out}",
    "Install the package talus (Debian: apt install ./talus_*.deb) or build it (tools/setup.sh of its sources), then name it in "
    "Settings > Options > Processing > Providers > Talus, by the environment variable TALUS, or put it on the PATH.":
        "Das Paket talus installieren (Debian: apt install ./talus_*.deb) oder aus den Quellen bauen (tools/setup.sh); dann "
        "unter Einstellungen > Optionen > Verarbeitung > Datenanbieter > Talus nennen, in der Umgebungsvariablen TALUS, oder "
        "in den PATH legen.",
    "{path} does not describe itself (talus help --json): is it another program, or an older version? {way_out}":
        "{path} beschreibt sich nicht (talus help --json): ein anderes Programm oder eine ältere Version? {way_out}",
    "Cancelled. What a run has traced is kept: start it again with the same inputs and \"Resume\".":
        "Abgebrochen. Was ein Lauf gerechnet hat, ist behalten: mit denselben Eingaben und «Fortsetzen» neu starten.",
    "Cancelled before the program was started.": "Abgebrochen, bevor das Programm gestartet war.",
    "talus ended with code {code}": "talus endete mit Code {code}",
    "{name} has no coordinate system: set it in QGIS (layer > Set CRS)":
        "{name} hat kein Koordinatensystem: in QGIS setzen (Layer > KBS setzen)",
    "{path} has several layers ({names}): name one, as {path}|layername={first}":
        "{path} hat mehrere Layer ({names}): einen nennen, als {path}|layername={first}",
    "{name} has no feature: is nothing selected, or does a filter hide all?":
        "{name} hat kein Objekt: ist nichts gewählt, oder verbirgt ein Filter alles?",
    "{name}: {count} features are written to {path}": "{name}: {count} Objekte sind nach {path} geschrieben",
    "{name} is no raster in a file: save it as GeoTIFF first": "{name} ist kein Raster in einer Datei: zuerst als GeoTIFF speichern",
    "{name}: band {band} is written to {path}": "{name}: Band {band} ist nach {path} geschrieben",
    "{name}: give the polygons or the raster, not both": "{name}: die Flächen oder das Raster angeben, nicht beides",
    "Give the terrain and the sources, or a scenario file.": "Gelände und Anbruchgebiete angeben, oder eine Szenario-Datei.",
    "Loads the results as a group of layers.": "Lädt die Ergebnisse als Gruppe von Ebenen.",
    "Band of the raster that holds the heights.": "Band des Rasters mit den Höhen.",
    "Field of the sources that is read as {field}.": "Feld der Anbruchgebiete, das als {field} gelesen wird.",
    "Folder of the results": "Ordner der Ergebnisse",
    "Talus runs the program talus of this computer. Every parameter is explained on the pages of its documentation.":
        "Talus startet das Programm talus dieses Rechners. Seine Dokumentation erklärt jeden Parameter.",
    "round": "Runde",
    "{value} if not set": "{value}, wenn leer",
    # of the program
    "terrain: a raster in a projected system in metres": "Gelände: ein Raster in einem projizierten System in Metern",
    "where blocks start: polygons, lines or points": "wo Blöcke starten: Flächen, Linien oder Punkte",
    "lines: what crosses them is recorded": "Linien: was sie quert, wird festgehalten",
    "lines of fences, dams or walls, with the fields height [m] and capacity [kJ]":
        "Linien von Netzen, Dämmen oder Mauern, mit den Feldern height [m] und capacity [kJ]",
    "ground: polygons, or a raster; what it names is a zone of the scenario, or a preset":
        "Boden: Flächen oder ein Raster; was sie nennen, ist eine Zone des Szenarios oder ein Parametersatz",
    "the field of --zones that names the zone or preset; zone": "das Feld der Zonen, das Zone oder Parametersatz nennt; zone",
    "parameter set of the ground; talus presets lists them": "Parametersatz des Bodens; talus presets listet sie",
    "bilinear or creased (creased): heights between the cells' centres":
        "bilinear oder creased (creased): Höhen zwischen den Zellmitten",
    "of the blocks [m]": "der Blöcke [m]; ein Feld der Anbruchgebiete geht vor",
    "events per year of all sources together, for talus hazard":
        "Ereignisse pro Jahr aller Anbruchgebiete zusammen, für die Gefahrenkarten",
    "energies of the maps of exceedance [kJ], as 30,300 (default)":
        "Energien der Überschreitungskarten [kJ], wie 30,300 (Vorgabe)",
    "per source cell": "pro Anbruchzelle",
    "of the random numbers": "der Zufallszahlen; gleicher Startwert, gleiche Ergebnisse",
    "also energy_total.tif: the energy with rotation": "auch energy_total.tif: die Energie mit Rotation",
    "also 95 % bounds of the percentiles: energy_bounds.tif and others":
        "auch 95-%-Schranken der Perzentile: energy_bounds.tif und andere",
    "gpkg or fgb (gpkg): GeoPackage or FlatGeobuf for stops, exits, paths and screens":
        "gpkg: GeoPackage (Vorgabe), fgb: FlatGeobuf; für Haltepunkte, Austritte, Bahnen und Nachweislinien",
    "scenario file (TOML)": "Szenario-Datei (TOML); was hier angegeben ist, geht vor",
    "new folder for the results": "neuer Ordner für die Ergebnisse",
    "replace the folder if it holds an earlier result": "den Ordner ersetzen, wenn er ein früheres Ergebnis enthält",
    "all processors where it is not given; the results are the same":
        "alle Prozessoren, wenn nicht angegeben; die Ergebnisse sind dieselben",
    "go on with an interrupted run of the same command": "einen abgebrochenen Lauf mit denselben Eingaben fortsetzen",
    "OUT of a run whose sources have frequencies": "Ordner eines Laufs, dessen Anbruchgebiete Häufigkeiten haben",
    "classes by intensity and return period (TOML); else 30, 300 kJ and 30, 100, 300 years":
        "Stufen nach Intensität und Wiederkehrperiode (TOML); sonst 30, 300 kJ und 30, 100, 300 Jahre",
    "polygons or lines (as wide as their field width, else --width, else 0 m): how often each is hit, with which energy, and "
    "from where; repeats the run":
        "Flächen oder Linien (so breit wie ihr Feld width, sonst wie «Breite des Objekts», sonst 0 m): wie oft jedes getroffen "
        "wird, mit welcher Energie und woher; wiederholt den Lauf",
    "another weighting (TOML: [frequency], [features]); repeats the run":
        "andere Gewichtung (TOML: [frequency], [features]); wiederholt den Lauf",
    "m: the maps are for an object of this width (and the diameter of the block) at each place, else for the cell; with "
    "--objects also the width of lines without a field width":
        "m: die Karten gelten für ein Objekt dieser Breite (und den Durchmesser des Blocks) an jedem Ort, sonst für die Zelle; "
        "auch die Breite von Linien ohne Feld width",
    "hazard_curves.tif: how often each energy is exceeded, a band per energy (0, 1, 2, 4, ... kJ and the thresholds; with "
    "--width the thresholds)": "hazard_curves.tif: wie oft jede Energie überschritten wird, ein Band pro Energie",
    "replace the hazard maps that are there": "die vorhandenen Gefahrenkarten ersetzen",
    "folder of results that talus run has written, with screens": "Ordner eines Laufs mit Nachweislinien",
    "id of the line at which the barrier stands": "id der Linie, an der das Netz steht",
    "trajectories: 1.02 for a calibrated model, 1.10 else (default)":
        "Sturzbahnen: 1.02 für ein kalibriertes Modell, sonst 1.10 (Vorgabe)",
    "topography: 1.02 for a good survey, 1.10 else (default)": "Gelände: 1.02 bei guter Vermessung, sonst 1.10 (Vorgabe)",
    "volume: 1.02 for a good survey of the blocks, 1.10 else (default)":
        "Volumen: 1.02 bei guter Aufnahme der Blöcke, sonst 1.10 (Vorgabe)",
    "density of the rock: 1.00 (default)": "Dichte des Gesteins: 1.00 (Vorgabe)",
    "MEL / SEL: 1.30 as in the paper (default), 1.20 as in UNI 11211-4":
        "MEL / SEL: 1.30 wie im Artikel (Vorgabe), 1.20 nach UNI 11211-4",
    "of speed and jump height [%]: 95 (default)": "von Geschwindigkeit und Sprunghöhe [%]: 95 (Vorgabe)",
    "of the design block [m3]; the largest that crosses where it is not given":
        "des Bemessungsblocks [m3]; der grösste Durchgang, wenn nicht angegeben",
    "of the design block [kg/m3]; the run's where it is not given":
        "des Bemessungsblocks [kg/m3]; die des Laufs, wenn nicht angegeben",
    "share of the crossings that the width holds [%]: 99 (default)":
        "Anteil der Durchgänge, den die Breite hält [%]: 99 (Vorgabe)",
    "longest stretch of the line with a design of its own [m]: 30 (default)":
        "längster Abschnitt der Linie mit eigener Bemessung [m]: 30 (Vorgabe)",
    "count every block alike, also where the sources have frequencies":
        "jeden Block gleich zählen, auch wo die Anbruchgebiete Häufigkeiten haben",
}


def german():
    return QgsApplication.instance() is not None and QgsApplication.locale().lower().startswith("de")


def tr(text):
    if text in KEYS:
        return KEYS[text][german()]
    return GERMAN.get(text, text) if german() else text


def label(name):
    """The name of a parameter in a dialog."""
    if name in LABELS:
        return LABELS[name][german()]
    words = name.replace("-", " ").replace("_", " ")
    return words[:1].upper() + words[1:]
