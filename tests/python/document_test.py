#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the blocks of a document below lines `<!-- run by a test, in Python -->` as one script.

  document_test.py PROGRAM PACKAGE DOCUMENT

Blocks below lines `<!-- its output, in Python -->` must stand in what the script prints, in their order.
"""
import importlib.util
import os
import re
import subprocess
import sys
import tempfile


def blocks_of(text, mark, language):
    blocks = re.findall(rf"^<!-- {mark}, in Python -->\n```{language}\n(.*?)^```$", text, re.M | re.S)
    if len(blocks) != text.count(f"<!-- {mark}, in Python -->") or not blocks:
        sys.exit(f"not every line of '{mark}' stands above a block")
    return blocks


def first_missing(printed, expected):
    """The first of the expected texts that does not follow those before it."""
    at = 0
    for text in expected:
        found = printed.find(text, at)
        if found < 0:
            return text
        at = found + len(text)
    return None


def main():
    program, package, document = (os.path.abspath(path) for path in sys.argv[1:4])
    assert first_missing("a b", ["b", "a"]) == "a" and first_missing("a b", ["a", "b"]) is None
    if importlib.util.find_spec("pandas") is None:
        print("skipped: pandas comes with script/setup all")
        return 77
    with open(document, encoding="utf-8") as file:
        text = file.read()
    script = "\n".join(blocks_of(text, "run by a test", "python"))
    environment = {"PATH": f"{os.path.dirname(program)}:{os.environ['PATH']}", "PYTHONPATH": package}
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            [sys.executable, "-B", "-c", script],
            capture_output=True,
            text=True,
            cwd=folder,
            env={**os.environ, **environment},
        )
    printed = "".join(f"{line.rstrip()}\n" for line in done.stdout.splitlines())
    missing = first_missing(printed, blocks_of(text, "its output", "text"))
    if done.returncode != 0 or missing is not None:
        print(done.stdout, done.stderr, f"exit code {done.returncode}; not printed:\n{missing}")
        return 1
    print(f"the Python of {document} works")
    return 0


sys.exit(main())
