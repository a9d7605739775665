#!/usr/bin/env python3
"""Shows that a build by folder (TALUS_BY_FOLDER) calls what a build by file calls: by_folder.py [TARGET...] [--jobs N].

Sources of a folder that are compiled at once see each other's unnamed namespaces: a helper in the unnamed namespace of
`talus::run` would hide a function of `talus` of its name from its neighbours, without a word from the compiler. Every
source is compiled to the language of LLVM both ways, and each function must call the same functions of unnamed
namespaces. All targets: about half an hour of one processor. Run it after helpers were named, and before a release.
"""

import argparse
import collections
import json
import re
import shlex
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
TARGETS = ("talus_core", "talus_fit", "talus_io", "talus_run", "talus_cli", "talus", "talus-mpi")
DEFINED = re.compile(r'^define .*?@("[^"]+"|[\w.$]+)\(')
NAMED = re.compile(r"@([\w.]*_GLOBAL__N_[\w.]*)")  # in an unnamed namespace; lambdas, which have a $, are numbered anew
LAMBDA = re.compile(r"\d+\$_\d+")
GENERATED = re.compile(r"__cxx_global_var_init|\.omp_outlined")  # numbered anew, too


def compile_commands(folder, by_folder, targets):
    subprocess.run(["cmake", "--preset", "dev", "-B", folder, "-DTALUS_PCH=OFF", f"-DTALUS_BY_FOLDER={by_folder}"],
                   cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    commands = json.loads((folder / "compile_commands.json").read_text())
    return [c for c in commands if any(f"/{target}.dir/" in c["command"] for target in targets)]


def text_of(command):
    """The source in the language of LLVM, not optimised."""
    words = shlex.split(command["command"])
    out = words.index("-o")
    words[out:out + 2] = ["-S", "-emit-llvm", "-O0", "-g0", "-o", "-"]
    done = subprocess.run(words, cwd=command["directory"], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return done.stdout


def calls_of(command):
    """The functions of unnamed namespaces that each function names, by the names that the linker sees."""
    calls, function = {}, None
    for line in text_of(command).splitlines():
        if found := DEFINED.match(line):
            function = None if GENERATED.match(found[1]) else LAMBDA.sub("$", found[1])
            calls.setdefault(function, set())
        elif line == "}":
            function = None
        elif function:
            calls[function].update(NAMED.findall(line))
    return calls


def calls_of_all(commands, jobs):
    """As calls_of; two functions of one name, in unnamed namespaces of two files, are put together."""
    calls = collections.defaultdict(set)
    with ThreadPoolExecutor(jobs) as pool:
        for of_file in pool.map(calls_of, commands):
            for function, called in of_file.items():
                calls[function] |= called
    return calls


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("targets", nargs="*", default=TARGETS, metavar="TARGET", help="of the build; " + ", ".join(TARGETS))
    parser.add_argument("--jobs", type=int, default=2)
    o = parser.parse_args()
    with tempfile.TemporaryDirectory() as work:
        by_file, by_folder = (calls_of_all(compile_commands(Path(work) / way, way, o.targets), o.jobs) for way in ("OFF", "ON"))
    both = sorted((by_file.keys() & by_folder.keys()) - {None})
    wrong = [(function, by_file[function] ^ by_folder[function]) for function in both if by_file[function] != by_folder[function]]
    for function, differ in wrong:
        names = subprocess.run(["c++filt", function.strip('"'), *sorted(differ)], capture_output=True, text=True).stdout.splitlines()
        print(f"{names[0]} calls by file or by folder only:", *(f"\n    {name}" for name in names[1:]))
    print(f"{len(both)} functions, {len(wrong)} of which call others by folder than by file")
    sys.exit(bool(wrong))


main()
