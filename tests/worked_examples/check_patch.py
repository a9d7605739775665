#!/usr/bin/python3
"""Checks the worked example of a page of docs: the page shows the patch, and the patch applies, compiles and works.

  check_patch.py PATCH PAGE --build FOLDER --compile FILES... [--link LIBRARIES...]

PATCH is a unified diff with paths a/... and b/... from the root of the repository. PAGE is the page that shows it: its
blocks ```diff, one after the other, are the patch, letter by letter. The sources are copied, the patch is applied to the
copy, and FILES of the copy (those that it touches) are compiled as FOLDER/compile_commands.json says; a file that the
patch adds, as its nearest neighbour. With --link the objects and LIBRARIES become a program, which is run: FILES then
hold tests of GoogleTest, and LIBRARIES end with those of GoogleTest. Exit code 1 and a line for what is wrong.
"""
import argparse
import difflib
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COPIED = ("include", "src", "tests", "tools", "docs", "CMakeLists.txt", "CHANGELOG.md", "README.md")


def wrong(text):
    sys.exit(f"check_patch.py: {text}")


def compare(patch, page):
    shown = "".join(re.findall(r"^```diff\n(.*?)^```$", page.read_text(), re.DOTALL | re.MULTILINE))
    difference = list(difflib.unified_diff(patch.read_text().splitlines(), shown.splitlines(), str(patch), str(page), lineterm=""))
    if difference:
        wrong(f"{page.name} does not show {patch.name}:\n" + "\n".join(difference[:20]))


def patched_copy(patch, copy):
    """The sources with the patch; a compiler takes a header beside a file first, so the copy must be whole."""
    for name in COPIED:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, copy / name, ignore=shutil.ignore_patterns("__pycache__", "pictures"))
        else:
            shutil.copy(source, copy / name)
    environment = {**os.environ, "GIT_CEILING_DIRECTORIES": str(copy.parent)}  # else git looks for a repository around it
    result = subprocess.run(["git", "apply", str(patch)], cwd=copy, env=environment, capture_output=True, text=True)
    if result.returncode != 0:
        wrong(f"{patch.name} does not apply; make it anew (git diff) and copy it into its page:\n{result.stderr}")


def sources_of(entry):
    """The sources that a command compiles: several where a folder is compiled at once (TALUS_BY_FOLDER)."""
    file = Path(entry["file"])
    return [file] if file.parent.name != "Unity" else [Path(name) for name in re.findall(r'#include "(.+)"', file.read_text())]


def command_of(file, commands):
    """The command that compiles a file. A new file is compiled like the one with which it shares the most folders."""
    def shared(entry):
        return max(len(os.path.commonprefix([source.resolve().parts, (ROOT / file).parts])) for source in sources_of(entry))
    return max(commands, key=shared)


def with_its_folder(file, copy, commands):
    """What is compiled for a file of the copy: a source of the library with those that the build compiles at once with
    it, as all of them are in one object of the library; else the file alone."""
    sources = sources_of(command_of(file, commands))
    if not file.startswith("src/") or len(sources) == 1 or ROOT / file not in sources:
        return copy / file
    folder = copy / (str(Path(file).parent).replace("/", "_") + ".cpp")
    folder.write_text("".join(f'#include "{copy / source.relative_to(ROOT)}"\n' for source in sources))
    return folder


def compile_file(file, copy, commands):
    """The object of what `with_its_folder` gives, compiled by the command of the file; with the words of that command."""
    entry, source = command_of(file, commands), with_its_folder(file, copy, commands)
    words, kept = shlex.split(entry["command"]), []
    skip = False
    for word in words:
        if skip or word == entry["file"]:
            skip = False
        elif word in ("-o", "-c", "-include", "-Xclang"):  # a precompiled header is of the sources without the patch
            skip = word != "-c"  # clang's comes as `-Xclang -include-pch -Xclang FILE`
        else:
            kept.append(word.replace(f"-I{ROOT}/", f"-I{copy}/").replace(f'"{ROOT}"', f'"{copy}"'))
    target = source.with_suffix(".o")
    if target.exists():
        return kept, target
    kept.append("-O1")  # quick to build rather than to run
    result = subprocess.run([*kept, "-o", str(target), "-c", str(source)], cwd=entry["directory"], capture_output=True, text=True)
    if result.returncode != 0:
        wrong(f"{file} with the patch does not compile:\n{result.stderr}")
    return kept, target


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("patch", type=Path)
    parser.add_argument("page", type=Path)
    parser.add_argument("--build", type=Path, required=True, help="folder of the build, with compile_commands.json")
    parser.add_argument("--compile", nargs="+", default=[], metavar="FILE", help="from the root of the repository")
    parser.add_argument("--link", nargs="+", default=[], metavar="LIBRARY")
    o = parser.parse_args()
    compare(o.patch, o.page)
    commands = json.loads((o.build / "compile_commands.json").read_text())
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder).resolve()
        patched_copy(o.patch.resolve(), copy)
        compiled = [compile_file(file, copy, commands) for file in o.compile]
        if not o.link:
            return
        flags = [word for word in compiled[0][0] if not word.startswith(("-I", "-D", "-W"))]
        objects = list(dict.fromkeys(str(target) for _, target in compiled))
        program = copy / "check"
        result = subprocess.run([*flags, *objects, *o.link, "-o", str(program)], capture_output=True, text=True)
        if result.returncode != 0:
            wrong(f"the objects with the patch do not link:\n{result.stderr}")
        sys.exit(subprocess.run([str(program), "--gtest_brief=1"], cwd=copy).returncode)


main()
