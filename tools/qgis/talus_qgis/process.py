"""Runs the program: shows its progress and warnings as they come, ends it when the user cancels.

Not by QgsBlockingProcess, which in QGIS 3.22 shows no progress in qgis_process and cannot be cancelled there.
"""
import json
import os
import queue
import re
import shlex
import signal
import subprocess
import threading
import time

from qgis.core import QgsProcessingException

from .program import HIDDEN_WINDOW
from .texts import tr

POLL = 0.1      # s between two looks at the button Cancel
REFUSED = 2      # exit code of the program
PATIENCE = 20.0  # s until a program that was asked to end is ended by force; a run ends within 2 s


class Cancelled(QgsProcessingException):
    """The user has ended the program before its end."""


class Refused(QgsProcessingException):
    """The program has refused its input."""


class Progress:
    """One bar for all phases: each takes its share of it, and the bar never goes back."""

    SHARES = {"simulate": 8.0, "diagnose": 8.0, "fit": 8.0, "evaluate": 1.0, "write": 1.0}
    SOON = 10.0  # s until the time that is left is foretold

    def __init__(self, feedback, phases, parts=1, clock=time.monotonic):
        """parts: rounds of the run; None: it makes as many as its error takes, and nobody knows how long that is."""
        self.feedback = feedback
        self.phases = phases
        self.parts = parts
        self.shown = 0.0
        self.title = None
        self.clock = clock
        self.first = None  # when the first share was said, and what the bar showed then: a resumed run begins far along

    def show(self, line):
        phase, share = line.get("phase", ""), float(line.get("share", 0.0))
        if line.get("part") and (self.parts or 0) > 1:
            done = int("".join(c for c in line["part"] if c.isdigit()) or 1)
            share = min(1.0, (done - 1 + share) / self.parts)
        whole = sum(self.SHARES.get(p, 1.0) for p in self.phases)
        before = sum(self.SHARES.get(p, 1.0) for p in self.phases[:self.phases.index(phase)]) if phase in self.phases else 0.0
        percent = 100.0 * (before + share * self.SHARES.get(phase, 1.0)) / whole
        self.shown = max(self.shown, min(100.0, percent))
        self.feedback.setProgress(self.shown)
        title = " ".join(filter(None, (tr("phase " + phase), line.get("part", "").replace("round", tr("round")), self._left())))
        if title != self.title:
            self.title = title
            self.feedback.setProgressText(title)

    def _left(self):
        """What is left of the time, in words, if all goes on as until now; nothing at the start."""
        if self.parts is None or self.shown <= 0.0:  # a resumed run says 0 first, then how far it had come
            return ""
        now = self.clock()
        self.first = self.first or (now, self.shown)
        passed, gained = now - self.first[0], self.shown - self.first[1]
        if passed < self.SOON or gained <= 0.0:
            return ""
        minutes = passed * (100.0 - self.shown) / gained / 60.0
        return tr("(less than a minute left)") if minutes < 1.0 else tr("(about {minutes} min left)").format(minutes=round(minutes))


class Messages:
    """Sorts what the program says into the log; keeps the error. `explain` adds to errors and
    warnings what the dialog calls their flags."""

    def __init__(self, feedback, progress, explain):
        self.feedback = feedback
        self.progress = progress
        self.explain = explain
        self.error = ""

    def take(self, stream, text):
        if not text:
            return
        if stream == "stderr" and text.startswith("{"):
            try:
                self._take_json(json.loads(text))
                return
            except ValueError:
                pass
        self._take_text(stream, text)

    def _take_json(self, line):
        if "phase" in line:
            self.progress.show(line)
        for kind, text in line.items():
            if kind == "warning" or (kind == "message" and text.startswith("note: ")):
                self._warn(text.removeprefix("note: "))
            elif kind == "error":
                self._fail(text)
            elif kind == "message":
                self.feedback.pushInfo(text)

    def _take_text(self, stream, text):
        if text.startswith("talus: warning: "):
            self._warn(text[len("talus: warning: "):])
        elif text.startswith("talus: error: "):
            self._fail(text[len("talus: error: "):])
        elif stream == "stdout" and text.startswith("warning "):  # of talus check
            self._warn(text[len("warning "):].strip())
        elif text.startswith(("note: ", "warning: ")):  # below the table of talus barrier
            self._warn(text.split(": ", 1)[1])
        else:
            self.feedback.pushConsoleInfo(aligned(text))

    def _warn(self, text):
        self.feedback.pushWarning(self.explain(text))

    def _fail(self, text):
        text = self.explain(text)
        if self.error:
            self.feedback.reportError(text)  # check lists every fault
        else:
            self.error = text


def aligned(text):
    """A line of a table in which the log, which is HTML, keeps the columns: spaces side by side do not break."""
    return re.sub("^ +|  +", lambda spaces: "\u00a0" * len(spaces[0]), text)


def _read(name, stream, lines):
    """Reads a stream to its end and closes it: closed by another thread, it would wait for the line that is being read."""
    with stream:
        for line in stream:
            lines.put((name, line.rstrip("\r\n")))
    lines.put((name, None))


def _start(command):
    """The program in a session of its own, so that a script that starts talus is ended together with it."""
    try:
        return subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                encoding="utf-8", errors="replace", bufsize=1, creationflags=HIDDEN_WINDOW,
                                start_new_session=True)
    except OSError as fault:
        raise QgsProcessingException(f"{command[0]}: {fault.strerror}") from fault


def _signal(process, by_force):
    """Asks the program, and what it has started, to end."""
    if os.name == "nt":
        process.kill() if by_force else process.terminate()
        return
    try:
        os.killpg(process.pid, signal.SIGKILL if by_force else signal.SIGTERM)
    except ProcessLookupError:
        pass  # all have ended


def _ended(process, readers, patience):
    """Whether the program and all that writes into its streams end within a time."""
    last = time.monotonic() + patience
    for reader in readers:
        reader.join(max(0.0, last - time.monotonic()))
    try:
        process.wait(max(0.0, last - time.monotonic()))
    except subprocess.TimeoutExpired:
        return False
    return not any(reader.is_alive() for reader in readers)


def _end(process, readers):
    """Asks the program to end and waits for it; ends it by force where it does not."""
    _signal(process, by_force=False)
    if not _ended(process, readers, PATIENCE):
        _signal(process, by_force=True)
        _ended(process, readers, PATIENCE)


def shown(command):
    """The command as it can be pasted into a shell."""
    return subprocess.list2cmdline(command) if os.name == "nt" else shlex.join(command)


def run(command, feedback, progress, explain=str):
    """Runs a command to its end. Raises QgsProcessingException with the program's own line, as `explain` completes it, where
    it fails, and Cancelled where the user has cancelled it before its end."""
    feedback.pushCommandInfo(shown(command))
    messages = Messages(feedback, progress, explain)
    lines = queue.Queue()
    process = _start(command)
    readers = [threading.Thread(target=_read, args=(name, getattr(process, name), lines), daemon=True)
               for name in ("stdout", "stderr")]
    for reader in readers:
        reader.start()
    try:
        open_streams = len(readers)
        while open_streams and not feedback.isCanceled():
            try:
                stream, text = lines.get(timeout=POLL)
            except queue.Empty:
                continue
            if text is None:
                open_streams -= 1
            else:
                messages.take(stream, text)
        while process.poll() is None and not feedback.isCanceled():  # its streams are closed, it works on
            time.sleep(POLL)
    finally:
        if process.poll() is None or any(reader.is_alive() for reader in readers):
            _end(process, readers)
    while not lines.empty():
        stream, text = lines.get_nowait()
        messages.take(stream, text or "")
    code = process.poll()
    if code == 0:
        return  # whatever was asked in its last moments, it has written its results
    if feedback.isCanceled():
        raise Cancelled(tr("Cancelled."))
    raise (Refused if code == REFUSED else QgsProcessingException)(messages.error or tr("talus ended with code {code}").format(code=code))
