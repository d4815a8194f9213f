#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compiles each source alone, without making code: one that does not include what it uses fails.

  sources_compile_alone.py ROOT BUILD-FOLDER [SOURCE...]

Compiled together with others, as unity builds do, such a source builds nevertheless. Options are those of the sources in
BUILD-FOLDER/compile_commands.json. Clang compiles, which reads precompiled headers fast. Sources that reach the same headers of libraries share
one, which holds nothing but what each of them reaches itself.
"""
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections import defaultdict
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from names_are_included import read_sources, reached_from

OWN = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.M)
LIBRARY = re.compile(r"^\s*#\s*include\s*<([^>]+)>", re.M)
SLOW = re.compile(r"(Eigen|boost|nlohmann|gtest|gmock|rapidcheck|SQLiteCpp|CLI|spdlog)/")  # takes seconds to compile
SHARED_BY = 4  # files, for which a precompiled header takes less time than it saves


def options_of_build(folder):
    """Definitions and paths of includes, all sources' together."""
    options = {}
    for entry in json.loads((folder / "compile_commands.json").read_text()):
        words = iter(shlex.split(entry["command"]))
        for word in words:
            if word in ("-isystem", "-I"):
                options[word, next(words)] = None
            elif word.startswith(("-I", "-D")):
                options[(word,)] = None
    return [word for option in options for word in option]


def sources_of_build(root, folder):
    """Sources that the build compiles, by themselves or in batches."""
    for entry in json.loads((folder / "compile_commands.json").read_text()):
        file = Path(entry["file"])
        for source in map(Path, OWN.findall(file.read_text()) if "Unity" in file.parts else [file]):
            if source.resolve().is_relative_to(root):
                yield str(source.resolve().relative_to(root))


def main():
    root, folder = (Path(argument).resolve() for argument in sys.argv[1:3])
    clang = shutil.which("clang++")
    if clang is None:
        print("clang is missing: script/setup all installs it")
        sys.exit(77)
    texts = dict(read_sources(root))
    includes = {file: {i for i in OWN.findall(text) if i in texts} for file, text in texts.items()}
    sources = sorted(set(sys.argv[3:] or sources_of_build(root, folder)) & texts.keys())
    libraries = {source: frozenset().union(*(LIBRARY.findall(texts[file]) for file in reached_from(source, includes))) for source in sources}
    command = [clang, "-std=c++20", "-fsyntax-only", "-w", f"-I{root}", *options_of_build(folder)]

    # Sets of libraries that several files reach; each file takes the largest set that it reaches.
    groups = defaultdict(list)
    for file, reached in libraries.items():
        groups[frozenset(name for name in reached if SLOW.match(name))].append(reached)
    shared = [frozenset.intersection(*group) for group in groups.values() if len(group) >= SHARED_BY]
    chosen = {file: max((s for s in shared if s <= libraries[file]), key=lambda s: (sum(bool(SLOW.match(name)) for name in s), len(s)), default=frozenset())
              for file in sources}

    def compile_file(file, header):
        done = subprocess.run([*command, *header, "-x", "c++", str(root / file)], capture_output=True, text=True, check=False)
        return file, done.returncode, done.stderr

    with tempfile.TemporaryDirectory() as scratch, ThreadPoolExecutor(os.cpu_count()) as pool:
        def make_header(number, names):
            if not names:
                return []
            header = Path(scratch) / f"{number}.h"
            header.write_text("".join(f"#include <{name}>\n" for name in sorted(names)))
            subprocess.run([*(word for word in command if word != "-fsyntax-only"), "-fpch-instantiate-templates", "-x", "c++-header", str(header),
                            "-o", f"{header}.pch"], check=True)
            return ["-include-pch", f"{header}.pch"]

        sets = list(set(chosen.values()))
        headers = dict(zip(sets, pool.map(make_header, range(len(sets)), sets)))
        jobs = [(file, headers[names]) for file, names in chosen.items()]
        faults = 0
        for file, code, said in pool.map(lambda job: compile_file(*job), jobs):
            if code != 0:
                faults += 1
                print(f"{file} does not compile alone:\n{said[:2000]}")
    print(f"{len(jobs)} sources compiled alone, {faults} with faults; {len(sets)} sets of libraries")
    sys.exit(1 if faults or not jobs else 0)


main()
