#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compiles each source of the libraries alone, without making code: a batch of sources hides includes that are missing in one of them.

sources_compile_alone.py BUILD_FOLDER; its compile_commands.json has the options of each target.
"""
import json
import os
import re
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

build = Path(sys.argv[1])
batch = re.compile(r'^#include "(.*)"$', re.MULTILINE)


def compilations():
    """Source, command and folder of each source outside tests that is compiled in a batch."""
    for entry in json.loads((build / "compile_commands.json").read_text()):
        if "/Unity/" not in entry["file"] or f"{build}/tests/" in entry["file"]:
            continue
        for source in batch.findall(Path(entry["file"]).read_text()):
            words = shlex.split(entry["command"].replace(entry["file"], source))
            del words[words.index("-o"):words.index("-o") + 2]
            compiler = next(at for at, word in enumerate(words) if re.search(r"(g|c|clang)\+\+", os.path.basename(word)))
            yield source, [*words[compiler:], "-fsyntax-only"], entry["directory"]


def compile_alone(compilation):
    source, command, folder = compilation
    run = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    return source, run.returncode, run.stderr


sources = list(compilations())
with ThreadPoolExecutor(2) as pool:  # CMake tells ctest so; each takes up to 1.5 GB
    failed = [(source, log) for source, code, log in pool.map(compile_alone, sources) if code != 0]
for source, log in failed:
    print(f"{source} cannot be compiled alone:\n{log[:1500]}")
print(f"{len(sources)} sources compiled alone, {len(failed)} of them failed")
sys.exit(1 if failed or not sources else 0)
