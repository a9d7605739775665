"""Where the program `talus` is, and what it says of itself: `talus help --json` is the one description of its parameters."""
import json
import os
import shutil
import subprocess

from qgis.core import QgsSettings

from .texts import tr

SETTING = "TALUS_PROGRAM"
HIDDEN_WINDOW = getattr(subprocess, "CREATE_NO_WINDOW", 0)  # on Windows no terminal opens

_descriptions = {}  # by path, time and size of the program: a new version is asked anew


class ProgramMissing(Exception):
    """The program is not there, or does not answer."""


def path():
    """The program: of the setting, else of the environment variable TALUS, else on the PATH. Raises ProgramMissing."""
    setting = QgsSettings().value("Processing/Configuration/" + SETTING, "") or ""
    for origin, given in ((tr("the setting of Processing"), setting), (tr("the environment variable TALUS"),
                                                                       os.environ.get("TALUS", ""))):
        if given:
            found = shutil.which(given)
            if found is None:
                raise ProgramMissing(tr("{path} ({origin}) is no program that can be run. {way_out}").format(
                    path=given, origin=origin, way_out=way_out()))
            return found
    found = shutil.which("talus")
    if found is None:
        raise ProgramMissing(tr("The program talus is not on this computer. {way_out}").format(way_out=way_out()))
    return found


def way_out():
    return tr("Install the package talus (Debian: apt install ./talus_*.deb) or build it (tools/setup.sh of its sources), "
              "then name it in Settings > Options > Processing > Providers > Talus, by the environment variable TALUS, "
              "or put it on the PATH.")


def description():
    """What `talus help --json` says. Raises ProgramMissing."""
    program = path()
    status = os.stat(program)
    key = (program, status.st_mtime_ns, status.st_size)
    if key not in _descriptions:
        _descriptions[key] = _ask(program)
    return _descriptions[key]


def _ask(program):
    try:
        done = subprocess.run([program, "help", "--json"], stdin=subprocess.DEVNULL, capture_output=True, timeout=30,
                              check=False, creationflags=HIDDEN_WINDOW)
        told = json.loads(done.stdout.decode("utf-8"))
        return {part: told[part] for part in ("commands", "results")}
    except (OSError, ValueError, KeyError, TypeError, subprocess.TimeoutExpired) as fault:
        raise ProgramMissing(tr("{path} does not describe itself (talus help --json): is it another program, or an older "
                                "version? {way_out}").format(path=program, way_out=way_out())) from fault


def command(name):
    """The description of one command; None if the program has no such command. Raises ProgramMissing."""
    return next((c for c in description()["commands"] if c["name"] == name), None)


def help_page(page="qgis"):
    """A page of docs as installed with the program or beside the plug-in; empty if there is none."""
    here = os.path.dirname(os.path.realpath(__file__))
    folders = [os.path.join(here, "../../../docs"), "/usr/share/doc/talus"]
    try:
        folders.insert(0, os.path.join(os.path.dirname(os.path.realpath(path())), "../share/doc/talus"))
    except ProgramMissing:
        pass
    for name in (f"html/{page}.html", f"{page}.html", f"{page}.md"):  # a page that a browser shows, wherever it is, before the text
        for folder in folders:
            file = os.path.normpath(os.path.join(folder, name))
            if os.path.exists(file):
                return "file://" + file
    return ""
