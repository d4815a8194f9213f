#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fails if a source of the product has a line over 110 columns, or a header over 300 lines.

  sources_are_readable.py SOURCE_FOLDER

Tables may be wider: a row is read along its columns.
"""
import sys
from pathlib import Path

WIDEST, LONGEST_HEADER = 110, 300
SUFFIXES = (".h", ".cc", ".py", ".m")
TABLES = {"jobs/parameters/parameter_table.cc", "jobs/store/store_schema.cc"}


def find_faults(name, text):
    lines = text.splitlines()
    if name not in TABLES:
        for number, line in enumerate(lines, 1):
            if len(line) > WIDEST:
                yield f"{name}:{number}: {len(line)} columns, more than {WIDEST}"
    if name.endswith(".h") and len(lines) > LONGEST_HEADER:
        yield f"{name}: {len(lines)} lines, more than {LONGEST_HEADER} for a header"


def main():
    root = Path(sys.argv[1])
    planted = [*find_faults("a.h", "//" + "x" * 109), *find_faults("a.h", "\n" * 301), *find_faults("a.cc", "\n" * 301)]
    assert len(planted) == 2, planted
    sources = [path for folder in ("engine", "jobs", "server") for path in sorted((root / folder).rglob("*")) if path.suffix in SUFFIXES]
    faults = [fault for path in sources for fault in find_faults(str(path.relative_to(root)), path.read_text(encoding="utf-8"))]
    print("\n".join(faults) or f"{len(sources)} sources are readable")
    sys.exit(1 if faults or not sources else 0)


main()
