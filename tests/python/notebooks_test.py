#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the notebooks. Fails if one does not reach its end, or prints something else than is checked in.

  notebooks_test.py PROGRAM PACKAGE FOLDER
"""
import copy
import os
import re
import sys
import time
from pathlib import Path

# Peaks are known to 0.1 %; another mathematical library may also turn the last digit that is printed.
RELATIVE, LAST_DIGITS = 2e-3, 1.5
LARGEST_BYTES = 200_000
NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e-?\d+)?(?![\w.])")


def is_close(number, expected):
    _, _, decimals = expected.partition(".")
    allowed = max(
        abs(float(expected)) * RELATIVE, LAST_DIGITS * 10 ** -len(decimals) if "e" not in expected else 0
    )
    return abs(float(number) - float(expected)) <= allowed


def text_faults(text, expected):
    """Differences of two texts: the words, and numbers that differ by more than the tolerance."""
    # Numbers of another length move the columns of a table.
    words = [" ".join(NUMBER.sub("#", one).split()) for one in (text, expected)]
    if words[0] != words[1]:
        return [f"the text is\n{text}\ninstead of\n{expected}"]
    pairs = zip(NUMBER.findall(text), NUMBER.findall(expected))
    return [
        f"{number} instead of {wanted} in\n{text}" for number, wanted in pairs if not is_close(number, wanted)
    ]


def contents(cell):
    """Kind and text of each output of a cell: first all that is printed, in however many parts."""
    outputs = cell.get("outputs", [])
    printed = "".join(output["text"] for output in outputs if output["output_type"] == "stream")
    if printed:
        yield "printed", printed
    for output in outputs:
        if output["output_type"] == "stream":
            continue
        if output["output_type"] == "error":
            yield "error", output["evalue"]
        else:
            yield "figure" if "image/png" in output["data"] else "display", output["data"].get(
                "text/plain", ""
            )


def faults_of(cells, expected):
    for cell, wanted in zip(cells, expected):
        first = cell["source"].splitlines()[0]
        got, had = [*contents(cell)], [*contents(wanted)]
        if [kind for kind, _ in got] != [kind for kind, _ in had]:
            yield f"{first}: the outputs are {got} instead of {had}"
            continue
        for (_, text), (_, before) in zip(got, had):
            yield from (f"{first}: {fault}" for fault in text_faults(text, before))


def check_that_faults_are_found(cells):
    """Plants faults in outputs: each must be found, and a difference below the tolerance must not."""
    assert not [*faults_of(cells, cells)]
    printed = [
        index for index, cell in enumerate(cells) if any(kind == "printed" for kind, _ in contents(cell))
    ]
    assert printed, "no cell prints anything"
    for change in (
        lambda text: text + "more",
        lambda text: NUMBER.sub(lambda m: str(float(m[0]) * 1.2 + 2), text),
    ):
        planted = copy.deepcopy(cells)
        for output in planted[printed[0]]["outputs"]:
            if output["output_type"] == "stream":
                output["text"] = change(output["text"])
        assert [*faults_of(planted, cells)], "a planted fault was not found"
    planted = copy.deepcopy(cells)
    planted[printed[0]]["outputs"] = []
    assert [*faults_of(planted, cells)], "a missing output was not found"
    assert not text_faults("peak 321.71 m/s", "peak 321.7 m/s") and text_faults(
        "peak 324.7 m/s", "peak 321.7 m/s"
    )


def main():
    program, package, folder = (os.path.abspath(path) for path in sys.argv[1:4])
    try:
        import ipykernel, matplotlib, nbformat, pandas  # noqa: E401, F401
        from nbconvert.preprocessors import ExecutePreprocessor
    except ImportError as error:
        print(f"skipped: {error.name} comes with script/setup all")
        return 77
    os.environ.update(
        PATH=f"{os.path.dirname(program)}:{os.environ['PATH']}",
        PYTHONPATH=package,
        PYTHONDONTWRITEBYTECODE="1",
        PYDEVD_DISABLE_FILE_VALIDATION="1",
    )
    faults, notebooks = [], sorted(Path(folder).glob("*.ipynb"))
    for path in notebooks:
        checked_in = nbformat.read(path, as_version=4)
        check_that_faults_are_found(checked_in.cells)
        notebook, start = copy.deepcopy(checked_in), time.monotonic()
        for cell in notebook.cells:
            cell.get("outputs", []).clear()
        ExecutePreprocessor(timeout=300, kernel_name="python3").preprocess(notebook, {})
        print(f"{path.name}: {time.monotonic() - start:.1f} s, {path.stat().st_size / 1000:.0f} kB")
        faults += [f"{path.name}: {fault}" for fault in faults_of(notebook.cells, checked_in.cells)]
        if path.stat().st_size > LARGEST_BYTES:
            faults.append(f"{path.name}: larger than {LARGEST_BYTES} bytes")
    if len(notebooks) != 3:
        faults.append(f"{len(notebooks)} notebooks instead of 3")
    print("\n".join(faults))
    return 1 if faults else 0


sys.exit(main())
