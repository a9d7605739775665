"""Texts in English and German; the language is that of QGIS. A text without a translation stays English."""
from qgis.core import QgsApplication

# Names of parameters in the dialogs: English, German.
LABELS = {
    "dem": ("Terrain (DEM, metres)", "Gelände (DGM, Meter)"),
    "dem-band": ("Band of the terrain", "Band des Geländes"),
    "sources": ("Sources (where blocks start)", "Ausbruchgebiete (wo Blöcke starten)"),
    "diameter-field": ("Field: diameter of the block [m]", "Feld: Durchmesser des Blocks [m]"),
    "release_height-field": ("Field: height of release above the ground [m]", "Feld: Starthöhe über dem Boden [m]"),
    "frequency-field": ("Field: events per year", "Feld: Ereignisse pro Jahr"),
    "diameter_min-field": ("Field: smallest diameter [m]", "Feld: kleinster Durchmesser [m]"),
    "diameter_max-field": ("Field: largest diameter [m]", "Feld: grösster Durchmesser [m]"),
    "name-field": ("Field: name", "Feld: Name"),
    "width-field": ("Field: width of lines", "Feld: Breite der Linien"),
    "field": ("Field: ...", "Feld: ..."),
    "diameter": ("Diameter of the blocks", "Durchmesser der Blöcke"),
    "preset": ("Ground", "Boden"),
    "trajectories": ("Trajectories per source cell", "Sturzbahnen pro Ausbruchzelle"),
    "number-of-blocks": ("Number of blocks", "Zahl der Blöcke"),
    "frequency": ("Frequency of all sources together", "Häufigkeit aller Ausbruchgebiete zusammen"),
    "screens": ("Screens (lines where crossings are recorded)", "Nachweislinien (Durchgänge werden festgehalten)"),
    "barriers": ("Barriers (lines; fields height [m], capacity [kJ])", "Schutzbauten (Linien; Felder height [m], capacity [kJ])"),
    "zones": ("Zones of ground (polygons)", "Bodenzonen (Flächen)"),
    "zones-raster": ("Zones of ground as a raster", "Bodenzonen als Raster"),
    "zone-field": ("Field: zone or preset", "Feld: Zone oder Parametersatz"),
    "thresholds": ("Thresholds of energy", "Schwellen der Energie"),
    "effect": ("Effects (forest, size of the blocks, ...)", "Effekte (Wald, Blockgrösse, ...)"),
    "scenario": ("Scenario file", "Szenario-Datei"),
    "surface": ("Surface between cell centres", "Oberfläche zwischen den Zellmitten"),
    "seed": ("Seed of the random numbers", "Startwert der Zufallszahlen"),
    "energy-total": ("Energy with rotation, too", "Auch die Energie mit Rotation"),
    "count-rotation": ("Count the rotation in thresholds and classes", "Die Rotation bei Schwellen und Gefahrenstufen mitzählen"),
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
    "slope": ("Steepness of source cells", "Neigung der Ausbruchzellen"),
    "folder": ("Folder of a run", "Ordner eines Laufs"),
    "weighting": ("Other frequencies of the sources (TOML)", "Andere Häufigkeiten der Ausbruchgebiete (TOML)"),
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
    "return-periods": ("Return periods", "Wiederkehrperioden"),
    "unweighted": ("Count every block alike", "Jeden Block gleich zählen"),
    "profile": ("Profile (TOML)", "Profil (TOML)"),
    "release-height": ("Height of release above the ground", "Starthöhe über dem Boden"),
    "line": ("Line of the profile, from the top down", "Linie des Profils, von oben nach unten"),
    "source-x": ("Where blocks start [m along the line]", "Wo Blöcke starten [m entlang der Linie]"),
    "screen-x": ("Where crossings are recorded [m along the line]", "Wo Durchgänge aufgezeichnet werden [m entlang der Linie]"),
    "fit": ("Parameters of the ground that are fitted", "Bodenparameter, die angepasst werden"),
    "trials": ("Trajectories per block in the searches", "Sturzbahnen pro Block beim Suchen"),
    "starts": ("Searches from different starts", "Suchen von verschiedenen Startwerten aus"),
    "share": ("Parameters that all campaigns have in common", "Parameter, die alle Messkampagnen gemeinsam haben"),
    "ground-parameters": ("Fitted ground (fitted.toml), instead of \"Ground\"", "Angepasster Boden (fitted.toml), anstelle von «Boden»"),
    "deformation-coefficient": ("Deformation coefficient c", "Deformationskoeffizient c"),
    "lanes": ("Trajectories in one instruction (lanes)", "Sturzbahnen in einem Befehl (Lanes)"),
    "parameters": ("Model from which the fit starts (TOML)", "Modell, von dem die Anpassung ausgeht (TOML)"),
    "test-trials": ("Trajectories per block in the tests", "Sturzbahnen pro Block in den Tests"),
    "most-effects": ("Largest number of effects that are added", "Höchste Zahl der Effekte, die dazukommen"),
    "level": ("Level of significance", "Signifikanzniveau"),
    "base-fits": ("Independent fits that are compared", "Unabhängige Anpassungen, die verglichen werden"),
    "all-rows": ("Fit the rows that are held out, too", "Auch die zurückgehaltenen Zeilen anpassen"),
    "nested": ("Repeat the diagnosis without each fold", "Diagnose ohne jeden Teil der Zeilen wiederholen"),
    "no-nested": ("Never repeat it without a fold", "Sie nie ohne einen Teil wiederholen"),
    "folds": ("Number of folds", "Zahl der Teile"),
    "quick-folds": ("Do not choose the effects anew in a fold", "In den Teilen die Effekte nicht neu wählen"),
    "no-quick-folds": ("Always choose them anew in a fold", "Sie in den Teilen immer neu wählen"),
    "campaign": ("Campaigns (campaign.toml)", "Messkampagnen (campaign.toml)"),
    "first": ("Folder of run A", "Ordner des Laufs A"),
    "second": ("Folder of run B", "Ordner des Laufs B"),
    "more": ("Folder of a further run", "Ordner eines weiteren Laufs"),
    "rasters": ("Rasters", "Raster"),
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
    "algorithm sources": ("Find candidate sources", "Mögliche Ausbruchgebiete suchen"),
    "algorithm profile": ("2D model on a profile", "2D-Modell auf einem Profil"),
    "algorithm calibrate": ("Calibrate the ground", "Boden kalibrieren"),
    "algorithm diagnose": ("Diagnose what a model lacks", "Diagnose: was dem Modell fehlt"),
    "algorithm compare": ("Compare runs", "Läufe vergleichen"),
    "algorithm report": ("Report (HTML)", "Bericht (HTML)"),
    "about run": ("Simulates falling blocks from the sources over the terrain and maps how often, how fast and how high they "
                  "pass each cell. Give terrain, sources and a diameter, or a scenario file. Cancel keeps what was traced; "
                  "\"Resume\" goes on with it.",
                  "Simuliert Blöcke von den Ausbruchgebieten über das Gelände und kartiert, wie oft, wie schnell und wie hoch "
                  "sie jede Zelle durchqueren. Nötig sind Gelände, Ausbruchgebiete und ein Durchmesser, oder eine "
                  "Szenario-Datei. Abbrechen behält das Gerechnete; «Fortsetzen» macht damit weiter."),
    "about check": ("Checks layers and settings, lists every fault, every field that is read with its range, and the plan: "
                    "cells, trajectories, memory, time. Writes nothing.",
                    "Prüft Layer und Einstellungen, nennt jeden Fehler, jedes gelesene Feld mit seinem Wertebereich und den "
                    "Plan: Zellen, Sturzbahnen, Speicher, Zeit. Schreibt nichts."),
    "about hazard": ("Annual frequencies, return periods, intensities and hazard classes from a run whose sources have "
                     "frequencies. Without a width the maps are for the cell.",
                     "Jährliche Häufigkeiten, Wiederkehrperioden, Intensitäten und Gefahrenstufen aus einem Lauf, dessen "
                     "Ausbruchgebiete Häufigkeiten haben. Ohne Breite gelten die Karten für die Zelle."),
    "about objects": ("How often each house or road is hit, with which energy, and from where. Repeats the run, with the same "
                      "bits, and writes the hazard maps anew.",
                      "Wie oft jedes Haus oder jede Strasse getroffen wird, mit welcher Energie und woher. Wiederholt den Lauf "
                      "Bit für Bit und schreibt auch die Gefahrenkarten neu."),
    "about barrier": ("Design values of a barrier at a screen of a run: energy, height, width, by stretch, and how often they "
                      "are exceeded.",
                      "Bemessungswerte eines Schutznetzes an einer Nachweislinie: Energie, Höhe, Breite, je Abschnitt, und wie "
                      "oft sie überschritten werden."),
    "about sources": ("Candidate source cells by the steepness of the terrain: look at them before a run.",
                      "Mögliche Ausbruchzellen nach der Neigung des Geländes: vor einem Lauf ansehen."),
    "about profile": ("Simulates in two dimensions on a profile: along a line over the terrain, or as a file says.",
                      "Simuliert in zwei Dimensionen auf einem Profil: entlang einer Linie über das Gelände, oder nach einer "
                      "Datei."),
    "about calibrate": ("Fits the parameters of the ground to measured rock falls.",
                        "Passt die Parameter des Bodens an gemessene Stürze an."),
    "about diagnose": ("Finds what a fitted model leaves of measured data, and which effect explains it.",
                       "Findet, was ein angepasstes Modell von den Messungen übrig lässt, und welcher Effekt es erklärt."),
    "about compare": ("Runs over the same terrain side by side, as with and without forest: the worse value of each cell, the "
                      "change from A to B, and a table of what differs.",
                      "Läufe über demselben Gelände im Vergleich, etwa mit und ohne Wald: der schlimmere Wert jeder Zelle, die "
                      "Änderung von A zu B und eine Tabelle der Unterschiede."),
    "about report": ("One self-contained HTML page on a run: maps, tables, checklist. Run it last.",
                     "Eine eigenständige HTML-Seite über einen Lauf: Karten, Tabellen, Prüfliste. Zuletzt ausführen."),
    "phase simulate": ("Simulating", "Simuliert"),
    "phase write": ("Writing the results", "Schreibt die Ergebnisse"),
    "phase evaluate": ("Evaluating the cells", "Wertet die Zellen aus"),
    "phase compare": ("Comparing the cells", "Vergleicht die Zellen"),
    "phase fit": ("Fitting", "Passt an"),
    "phase diagnose": ("Diagnosing", "Diagnose"),
    # titles of layers that are not in talus.qgs
    "title hillshade": ("Hillshade of the DEM", "Geländeschummerung"),
    "title vertices": ("Vertices of the paths", "Stützpunkte der Bahnen"),
    "title pits": ("Pits and dammed cells: depth", "Mulden und gestaute Zellen: Tiefe"),
    "title crossings": ("Crossings at the places: energy", "Durchgänge an den Stellen: Energie"),
    "title stops": ("Ends of the blocks: largest energy of the path", "Enden der Blöcke: grösste Energie der Bahn"),
    "title profile": ("Profile", "Profil"),
    "title bins": ("Along the profile: energy, P95", "Entlang des Profils: Energie, P95"),
    "title source_polygons": ("Candidate sources: slope", "Mögliche Ausbruchgebiete: Neigung"),
    "title source_points": ("Candidate source cells: slope", "Mögliche Ausbruchzellen: Neigung"),
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
    "(less than a minute left)": "(weniger als eine Minute übrig)",
    "(about {minutes} min left)": "(noch etwa {minutes} min)",
    "At least {value}.": "Mindestens {value}.",
    "Cancelled.": "Abgebrochen.",
    "What a run has traced is kept: start it again with the same inputs and \"Resume\".":
        "Was ein Lauf gerechnet hat, ist behalten: mit denselben Eingaben und «Fortsetzen» neu starten.",
    "The results go into a temporary folder, which QGIS removes when it is closed: name a folder under \"Results\" to keep them.":
        "Die Ergebnisse kommen in einen temporären Ordner, den QGIS beim Beenden löscht: unter «Ergebnisse» einen Ordner nennen, "
        "um sie zu behalten.",
    "A run into a temporary folder cannot be resumed, as QGIS takes another one at the next run: name a folder under \"Results\" "
    "where you want to go on.":
        "Ein Lauf in einen temporären Ordner lässt sich nicht fortsetzen, weil QGIS beim nächsten Lauf einen anderen nimmt: unter "
        "«Ergebnisse» einen Ordner nennen, um weitermachen zu können.",
    "\"Resume\" needs the folder of the run that was cancelled: name it under \"Results\". A temporary folder is a new one at "
    "every run.":
        "«Fortsetzen» braucht den Ordner des abgebrochenen Laufs: ihn unter «Ergebnisse» nennen. Ein temporärer Ordner ist bei "
        "jedem Lauf ein neuer.",
    "In this dialog ": "In diesem Dialog ist ",
    "{flag} is \"{field}\"": "{flag} «{field}»",
    " (under Advanced Parameters)": " (unter «Fortgeschrittene Parameter»)",
    "Cancelled before the program was started.": "Abgebrochen, bevor das Programm gestartet war.",
    "talus ended with code {code}": "talus endete mit Code {code}",
    "{name} has no coordinate system: set it in QGIS (layer > Set CRS)":
        "{name} hat kein Koordinatensystem: in QGIS setzen (Layer > KBS setzen)",
    "{folder}: no folder can be made there ({error}): name another folder for the results":
        "{folder}: dort kann kein Ordner angelegt werden ({error}): einen anderen Ordner für die Ergebnisse nennen",
    "{path} has several layers ({names}): name one, as {path}|layername={first}":
        "{path} hat mehrere Layer ({names}): einen nennen, als {path}|layername={first}",
    "{name} has no feature: is nothing selected, or does a filter hide all?":
        "{name} hat kein Objekt: ist nichts gewählt, oder verbirgt ein Filter alles?",
    "{name}: {count} features are written to {path}": "{name}: nach {path} geschrieben ({count} Objekte)",
    "{name} is no raster in a file: save it as GeoTIFF first": "{name} ist kein Raster in einer Datei: zuerst als GeoTIFF speichern",
    "{name}: band {band} is written to {path}": "{name}: Band {band} ist nach {path} geschrieben",
    "{name}: give the polygons or the raster, not both": "{name}: die Flächen oder das Raster angeben, nicht beides",
    "Give the terrain and the sources, or a scenario file.": "Gelände und Ausbruchgebiete angeben, oder eine Szenario-Datei.",
    "Give the terrain, a line over it, where blocks start and their diameter, or the file of a profile.":
        "Das Gelände, eine Linie darüber, wo Blöcke starten und ihren Durchmesser angeben, oder die Datei eines Profils.",
    "{name}: '{value}' is no number: write {number}": "{name}: «{value}» ist keine Zahl: {number} schreiben",
    "{name}: {value} must be {low} at least": "{name}: {value} muss mindestens {low} sein",
    "{name}: {value} must be {high} at most": "{name}: {value} darf höchstens {high} sein",
    "The events per year are those that were given; a field frequency of the sources is not read.":
        "Es gilt die angegebene Zahl der Ereignisse pro Jahr; ein Feld frequency der Ausbruchgebiete wird nicht gelesen.",
    "{name}: no such parameter of {id}": "{name}: kein Parameter von {id}",
    "; it is not used": "; nicht verwendet",
    "; is {near} meant?": "; ist {near} gemeint?",
    "Loads the results as a group of layers.": "Lädt die Ergebnisse als Gruppe von Layern.",
    "Band of the raster that holds the heights.": "Band des Rasters mit den Höhen.",
    "Field of the sources that is read as {field}. Where none is picked, their field named {field} is read, if they have one.":
        "Feld der Ausbruchgebiete, das als {field} gelesen wird. Ist keines gewählt, wird ihr Feld mit dem Namen {field} gelesen, "
        "wenn sie eines haben.",
    "A field of the sources that is named diameter, diameter_min, diameter_max, release_height, frequency or name is read where "
    "no field is picked for it.":
        "Ein Feld der Ausbruchgebiete mit dem Namen diameter, diameter_min, diameter_max, release_height, frequency oder name wird "
        "gelesen, wo dafür kein Feld gewählt ist.",
    "needed without a scenario": "nötig ohne Szenario",
    "needed without the file of a profile": "nötig ohne Profildatei",
    "The diameter is that which was given; fields of the sources with diameters are not read.":
        "Es gilt der angegebene Durchmesser; Felder der Ausbruchgebiete mit Durchmessern werden nicht gelesen.",
    "Several layers, as a road and houses, are joined into one.":
        "Mehrere Layer, wie Strasse und Häuser, werden zu einem zusammengefügt.",
    "{name}: some features have no number yet, so that all are numbered anew from 1. With saved edits the results keep the "
    "numbers of QGIS.":
        "{name}: einige Objekte haben noch keine Nummer, darum werden alle neu ab 1 nummeriert. Mit gespeicherten Änderungen "
        "behalten die Ergebnisse die Nummern von QGIS.",
    "{name}: the field {before} is handed over as {after}, as another differs from it in case only":
        "{name}: das Feld {before} wird als {after} übergeben, weil sich ein anderes nur in der Gross- und Kleinschreibung "
        "unterscheidet",
    "{name}: QGIS brings it from {from} to {to}, with an unknown accuracy":
        "{name}: QGIS bringt es von {from} nach {to}, mit unbekannter Genauigkeit",
    "{name}: QGIS brings it from {from} to {to}, accurate to {metres} m":
        "{name}: QGIS bringt es von {from} nach {to}, auf {metres} m genau",
    "Folder of the results": "Ordner der Ergebnisse",
    "{title} (lines)": "{title} (Linien)",
    "Talus runs the program talus of this computer. Every parameter is explained on the pages of its documentation.":
        "Talus startet das Programm talus dieses Rechners. Seine Dokumentation erklärt jeden Parameter.",
    "round": "Runde",
    "deg": "Grad",
    "years": "Jahre",
    # of the legends, whose words the program writes: src/io/results/style.cpp, vector_style.cpp
    "up to {}{}": "bis {}{}",
    "above {}{}": "über {}{}",
    "{} to {}{}": "{} bis {}{}",
    " years": " Jahre",
    "1/year": "1/Jahr",
    " 1/year": " 1/Jahr",
    "0 1/year": "0 1/Jahr",
    "0 years": "0 Jahre",
    "no hit counted in this run": "in diesem Lauf kein Treffer gezählt",
    "paths leave the map here": "Bahnen verlassen hier die Karte",
    "not decided by so few blocks": "mit so wenigen Blöcken nicht entschieden",
    "no crossing": "kein Durchgang",
    "too few crossings for a design": "zu wenige Durchgänge für eine Bemessung",
    "Line of the barrier, by stretch": "Linie des Schutznetzes, je Abschnitt",
    "3 or more classes lower": "3 oder mehr Stufen tiefer",
    "2 classes lower": "2 Stufen tiefer",
    "1 class lower": "1 Stufe tiefer",
    "the same class": "dieselbe Stufe",
    "1 class higher": "1 Stufe höher",
    "2 classes higher": "2 Stufen höher",
    "3 or more classes higher": "3 oder mehr Stufen höher",
    "none": "keine",
    "residual": "Restgefährdung",
    "low": "gering",
    "medium": "mittel",
    "high": "erheblich",
    "\"{field}\"": "«{field}»",
    "{value} if not set": "{value}, wenn leer",
    # titles of the results, as the program tells them
    "Objects: return period of a hit": "Objekte: Wiederkehrperiode eines Treffers",
    "Screens: energy, P95": "Nachweislinien: Energie, P95",
    "Ends off the map: energy": "Enden ausserhalb der Karte: Energie",
    "Stops: largest energy of the path": "Haltepunkte: grösste Energie der Bahn",
    "Paths: largest speed": "Bahnen: grösste Geschwindigkeit",
    "Barrier at <id>: design values": "Schutznetz an <id>: Bemessungswerte",
    "Barrier at <id>: MEL by stretch": "Schutznetz an <id>: MEL je Abschnitt",
    "Hazard class": "Gefahrenstufe",
    "Hazard goes on beyond the map (cut short)": "Gefährdung geht über die Karte hinaus (abgeschnitten)",
    "Class undecided": "Gefahrenstufe nicht entschieden",
    "Blocks per year": "Blöcke pro Jahr",
    "Return period of more than <n> kJ": "Wiederkehrperiode von mehr als <n> kJ",
    "Energy once in <n> years": "Energie einmal in <n> Jahren",
    "Hazard curves: annual frequency": "Gefahrenkurven: Häufigkeit pro Jahr",
    "Impact probability": "Trefferwahrscheinlichkeit",
    "Reach probability": "Erreichenswahrscheinlichkeit",
    "Passage density": "Durchgangsdichte",
    "Energy, P95": "Energie, P95",
    "Energy with rotation, P95": "Energie mit Rotation, P95",
    ", energy with rotation": ", Energie mit Rotation",
    ", translational energy": ", Translationsenergie",
    "Jump height, P95": "Sprunghöhe, P95",
    "Speed, P95": "Geschwindigkeit, P95",
    "Share above <threshold>": "Anteil über <threshold>",
    "Share with jump height above <threshold>": "Anteil mit Sprunghöhe über <threshold>",
    "the lowest threshold": "der tiefsten Schwelle",
    "Energy, upper bound of P95": "Energie, obere Grenze des P95",
    "Jump height, upper bound of P95": "Sprunghöhe, obere Grenze des P95",
    "Speed, upper bound of P95": "Geschwindigkeit, obere Grenze des P95",
    "Passages": "Durchgänge",
    "Impacts": "Aufschläge",
    "Deposits": "Ablagerungen",
    "Trapped blocks": "Gefangene Blöcke",
    "Exits": "Austritte",
    "Release cells": "Startzellen",
    "Source cells that reach the cell": "Ausbruchzellen, die die Zelle erreichen",
    "Barriers of the run: counts by stretch": "Schutzbauten des Laufs: Zahlen je Abschnitt",
    "Barriers of the run": "Schutzbauten des Laufs",
    "Sources of the run": "Ausbruchgebiete des Laufs",
    "Objects: sources of the hits": "Objekte: woher die Treffer kommen",
    "Objects: hazard curves": "Objekte: Gefahrenkurven",
    "Screens: all quantities": "Nachweislinien: alle Grössen",
    # of the program
    "terrain: a raster in a projected system in metres": "Gelände: ein Raster in einem projizierten System in Metern",
    "where blocks start: polygons, lines or points": "wo Blöcke starten: Flächen, Linien oder Punkte",
    "lines: what crosses them is recorded": "Linien: was sie quert, wird festgehalten",
    "lines of fences, dams or walls, with the fields height [m] and capacity [kJ]":
        "Linien von Netzen, Dämmen oder Mauern, mit den Feldern height [m] und capacity [kJ]",
    "ground: polygons, or a raster; what it names is a zone of the scenario, or a preset":
        "Boden: Flächen oder ein Raster; was sie nennen, ist eine Zone des Szenarios oder ein Parametersatz",
    "the field of --zones that names the zone or preset; zone": "das Feld der Zonen, das Zone oder Parametersatz nennt; zone",
    "NAME.KEY=VALUE: a number of an effect, as block-mass.preset=measured (docs/effects.md); several with ; between them; "
    "may be repeated":
        "NAME.SCHLÜSSEL=WERT: eine Zahl eines Effekts, wie block-mass.preset=measured (docs/effects.md); mehrere mit ; "
        "dazwischen; darf mehrmals stehen",
    "parameter set of the ground; talus presets lists them": "Parametersatz des Bodens; talus presets listet sie",
    "bilinear or creased (creased): heights between the cells' centres":
        "bilinear oder creased (creased): Höhen zwischen den Zellmitten",
    "of the blocks [m]": "der Blöcke [m]",
    "of all blocks of the profile [m]": "aller Blöcke des Profils [m]",
    "events per year of all sources together, for talus hazard":
        "Ereignisse pro Jahr aller Ausbruchgebiete zusammen, für die Gefahrenkarten",
    "energies of the maps of exceedance [kJ], with commas and no spaces: 30,300 (default)":
        "Energien der Überschreitungskarten [kJ], mit Kommas und ohne Leerzeichen: 30,300 (Vorgabe)",
    "a ground that talus calibrate or diagnose has fitted (fitted.toml), in place of --preset":
        "ein Boden, den Kalibrieren oder Diagnose angepasst hat (fitted.toml), anstelle von «Boden»",
    "c of the impact law (0.25): a lower one gives higher energies and jumps, longer paths and more hits":
        "c des Aufprallgesetzes (0.25): ein kleineres gibt höhere Energien und Sprünge, längere Bahnen und mehr Treffer",
    "trajectories in one instruction; as many as the processor has where it is not given; the results are the same":
        "Sturzbahnen in einem Befehl; so viele, wie der Prozessor kann, wenn nicht angegeben; die Ergebnisse sind dieselben",
    "per source cell": "pro Ausbruchzelle",
    "of the random numbers": "der Zufallszahlen; gleicher Startwert, gleiche Ergebnisse",
    "also energy_total.tif: the energy with rotation": "auch energy_total.tif: die Energie mit Rotation",
    "thresholds, frequencies, classes and objects count the energy with rotation, not the translational one; also "
    "energy_total.tif":
        "Schwellen, Häufigkeiten, Gefahrenstufen und Objekte zählen die Energie mit Rotation statt der translatorischen; "
        "dazu energy_total.tif",
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
    "OUT of a run whose sources have frequencies": "Ordner eines Laufs, dessen Ausbruchgebiete Häufigkeiten haben",
    "classes by intensity and return period (TOML); else 30, 300 kJ and 30, 100, 300 years":
        "Stufen nach Intensität und Wiederkehrperiode (TOML); sonst 30, 300 kJ und 30, 100, 300 Jahre",
    "polygons or lines (as wide as their field width, else --width, else 0 m): how often each is hit, with which energy, and "
    "from where; repeats the run":
        "Flächen oder Linien (so breit wie ihr Feld width, sonst wie «Breite des Objekts», sonst 0 m): wie oft jedes getroffen "
        "wird, mit welcher Energie und woher; wiederholt den Lauf",
    "the field of --objects with the width of a line [m]; width": "Feld der Objekte mit der Breite einer Linie [m]; sonst width",
    "the field of --objects with their names; name, id or object": "Feld der Objekte mit ihren Namen; sonst name, id oder object",
    "another weighting (TOML: [frequency], [features]); repeats the run":
        "andere Gewichtung (TOML: [frequency], [features]); wiederholt den Lauf",
    "m: the maps are for an object of this width (and the diameter of the block) at each place, else for the cell; with "
    "--objects also the width of lines without a field width":
        "m: die Karten gelten für ein Objekt dieser Breite (und den Durchmesser des Blocks) an jedem Ort, sonst für die Zelle; "
        "auch die Breite von Linien ohne Feld width",
    "hazard_curves.tif: how often each energy is exceeded, a band per energy (0, 1, 2, 4, ... kJ and the thresholds; with "
    "--width: 0 and the thresholds)": "hazard_curves.tif: wie oft jede Energie überschritten wird, ein Band pro Energie",
    "replace the hazard maps that are there": "die vorhandenen Gefahrenkarten ersetzen",
    "folder of results that talus run has written, with screens": "Ordner eines Laufs mit Nachweislinien",
    "id of the line at which the barrier stands; the only one of the run where it is not given":
        "id der Linie, an der das Netz steht; die einzige des Laufs, wenn nicht angegeben",
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
    "for the values that are reached once in so many years, with commas and no spaces: 30,100,300 (default)":
        "für die Werte, die einmal in so vielen Jahren erreicht werden, mit Kommas, ohne Leerzeichen: 30,100,300 (Vorgabe)",
    "count every block alike, also where the sources have frequencies":
        "jeden Block gleich zählen, auch wo die Ausbruchgebiete Häufigkeiten haben",
    "all processors where it is not given, of several processes one each; the results are the same":
        "alle Prozessoren, wenn nicht angegeben; die Ergebnisse sind dieselben",
    "number of times that the scenario's trajectories are traced":
        "wie oft die Sturzbahnen des Szenarios gerechnet werden",
    "rounds until the relative 95 % half-width of the impact probability is below this":
        "Runden, bis die relative halbe Breite des 95-%-Intervalls der Trefferwahrscheinlichkeit kleiner ist",
    "the error counts in all cells with a larger probability; 0.01":
        "der Fehler zählt in allen Zellen mit grösserer Wahrscheinlichkeit; 0.01",
    "largest number of rounds with --until-error (100)": "grösste Zahl der Runden mit --until-error (100)",
    "a VRT may name files below this folder, not only below its own and the scenario's; may be repeated":
        "ein VRT darf Dateien unter diesem Ordner nennen, nicht nur unter seinem eigenen und dem des Szenarios",
    "GeoPackage to write: pits, the cells that are lower than all eight neighbours, and dammed cells, whose way down is only "
    "diagonal":
        "GeoPackage zum Schreiben: Mulden, die tiefer sind als alle acht Nachbarn, und gestaute Zellen, die sich nur über "
        "eine Diagonale entleeren",
    "replace the file of --pits if it is there": "die Datei der Mulden ersetzen, wenn sie da ist",
    "of the run whose time is estimated; all processors where it is not given":
        "des Laufs, dessen Zeit geschätzt wird; alle Prozessoren, wenn nicht angegeben",
    "file of the profile (TOML): docs/profile.md": "Datei des Profils (TOML): docs/profile.md",
    "how many blocks": "wie viele Blöcke",
    "one line over the terrain, drawn from the top down": "eine Linie über das Gelände, von oben nach unten gezeichnet",
    "where blocks start, in m along the line: one place, or from and to with a comma and no spaces: 20,40":
        "wo Blöcke starten, in m entlang der Linie: eine Stelle, oder von und bis mit Komma ohne Leerzeichen: 20,40",
    "above the terrain [m] (1)": "über dem Gelände [m] (1)",
    "where crossings are recorded, in m along the line, with commas and no spaces: 110,199":
        "wo Durchgänge aufgezeichnet werden, in m entlang der Linie, mit Kommas ohne Leerzeichen: 110,199",
    "CSV of observed crossings (as screens.csv or a campaign's passages.csv); the probabilities are of them, else of the "
    "simulated ones":
        "CSV beobachteter Durchgänge (wie screens.csv oder passages.csv einer Messkampagne); die Wahrscheinlichkeiten gelten "
        "für sie, sonst für die simulierten",
    "another weighting (TOML: [frequency], [features]), as of talus hazard":
        "andere Gewichtung (TOML: [frequency], [features]), wie bei den Gefahrenkarten",
    "of the bootstrap: 1 (default)": "des Bootstraps: 1 (Vorgabe)",
    "measured data: campaign.toml; several: docs/several-campaigns.md":
        "Messdaten: campaign.toml; mehrere: docs/several-campaigns.md",
    "parameters, in every zone: theta_scale,psi_scale,En50,Et50 (these if it is not given),phi":
        "Parameter, in jeder Zone: theta_scale,psi_scale,En50,Et50 (diese, wenn nicht angegeben),phi",
    "trajectories per block in the searches (48)": "Sturzbahnen pro Block beim Suchen (48)",
    "of the random numbers (1)": "der Zufallszahlen (1)",
    "model from which the fit starts, whose effects it keeps; else upper-talus-3d without effects":
        "Modell, von dem die Anpassung ausgeht und dessen Effekte sie behält; sonst upper-talus-3d ohne Effekte",
    "ground from which the fit starts, without effects; else upper-talus-3d":
        "Boden, von dem die Anpassung ausgeht, ohne Effekte; sonst upper-talus-3d",
    "searches from different starts (3)": "Suchen von verschiedenen Startwerten aus (3)",
    "parameters that several campaigns share; all others each has its own":
        "Parameter, die mehrere Messkampagnen gemeinsam haben; alle anderen hat jede für sich",
    "trajectories per block in the searches (24)": "Sturzbahnen pro Block beim Suchen (24)",
    "trajectories per block in the tests (100)": "Sturzbahnen pro Block in den Tests (100)",
    "that are added, one a round (3; fewer where that is costly)":
        "die dazukommen, einer pro Runde (3; weniger, wo das aufwendig ist)",
    "of significance, over all families of effects (0.05)": "der Signifikanz, über alle Familien von Effekten (0.05)",
    "independent fits of the ground whose verdicts are compared (5; fewer where that is costly)":
        "unabhängige Anpassungen des Bodens, deren Urteile verglichen werden (5; weniger, wo das aufwendig ist)",
    "fit the rows that the campaign holds out, too": "auch die Zeilen anpassen, die die Messkampagne zurückhält",
    "repeat the whole diagnosis without each fold of the fitting rows, as is done where no row is held out: the error is "
    "then one of rows that were neither fitted nor chosen by":
        "die ganze Diagnose ohne jeden Teil der Zeilen wiederholen, wie es ohne zurückgehaltene Zeilen geschieht: der Fehler "
        "gilt dann für Zeilen, die weder angepasst wurden noch mitgewählt haben",
    "never repeat the diagnosis without a fold": "die Diagnose nie ohne einen Teil wiederholen",
    "parts that are left out in turn: groups, or blocks (5)":
        "Teile, die der Reihe nach weggelassen werden: Gruppen oder Blöcke (5)",
    "the folds take the effects that all rows chose, and refit the numbers alone: little time, and an error that has seen the "
    "choice; so is done where the diagnosis of all rows is costly":
        "die Teile nehmen die Effekte, die alle Zeilen gewählt haben, und passen nur die Zahlen neu an: wenig Zeit, und ein "
        "Fehler, der die Wahl kennt; so geschieht es auch, wenn die Diagnose aller Zeilen aufwendig ist",
    "the folds always choose anew": "die Teile wählen immer neu",
    "GeoPackage to write: the cells as polygons and as points":
        "GeoPackage zum Schreiben: die Zellen als Flächen und als Punkte",
    "cells at least this steep [deg]; without it 55 cell^-0.075, which is 48.7 at 5 m":
        "Zellen, die mindestens so steil sind [Grad]; sonst 55 Zellweite^-0.075, bei 5 m also 48.7",
    "replace the file if it is there": "die Datei ersetzen, wenn sie da ist",
    "OUT of talus run, with what hazard and barrier have added":
        "Ordner eines Laufs, mit seinen Gefahrenkarten und Bemessungen",
    "file of the page (.html); report.html in the folder where it is not given":
        "Datei der Seite (.html); report.html im Ordner, wenn nicht angegeben",
    "title of the page; the name of the folder where it is not given":
        "Titel der Seite; der Name des Ordners, wenn nicht angegeben",
    "whose terrain and maps these are, below every map; what the DEM states where it is not given":
        "von wem Gelände und Karten sind, unter jeder Karte; was das DGM angibt, wenn nicht angegeben",
    "replace an earlier page of talus report": "eine frühere Seite ersetzen",
    "OUT of talus run: run A": "Ergebnisse eines Laufs",
    "OUT of another run over the same DEM: run B": "Ergebnisse eines anderen Laufs über demselben DGM",
    "further runs: C, D, ...": "für den höchsten Wert von mehr als zwei Läufen; dann ohne Änderung",
    "new folder for the comparison": "neuer Ordner für den Vergleich",
    "names without ending, such as energy,return_period_300; else, of those that all runs have, hazard_class, "
    "annual_frequency, impact_probability, reach_probability, energy, jump_height, velocity":
        "Namen ohne Endung, etwa energy,return_period_300; sonst von denen, die alle Läufe haben, hazard_class, "
        "annual_frequency, impact_probability, reach_probability, energy, jump_height, velocity",
    "replace the folder if it holds an earlier comparison": "den Ordner ersetzen, wenn er einen früheren Vergleich enthält",
}
# Titles of the rasters of talus compare.
GERMAN.update({begin + title: german_begin + of_run
               for begin, german_begin in (("Highest: ", "Höchster Wert: "), ("Lowest: ", "Tiefster Wert: "), ("Change: ", "Änderung: "))
               for title, of_run in GERMAN.items()})


def german():
    application = QgsApplication.instance()
    if application is None:
        return False
    return (application.translation() or application.locale()).lower().startswith("de")  # that of --lang, else the setting


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
