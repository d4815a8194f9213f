#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fails if a file-local name of a source is declared in a header of its library, or is a constant or type of another source.

  local_names_differ.py SOURCE_FOLDER

Sources are compiled in batches. There such a name hides the other one from all that stands behind it, and the compiler says nothing: a sweep's
name was once held against the longest name of a body. Which sources share a batch changes with each new file. Functions of two sources are
overloads, which the compiler tells apart or refuses.
"""
import re
import sys
from collections import defaultdict
from pathlib import Path

# Sources that end up in the same batches.
LIBRARIES = ("engine", "charts", "validation", "jobs", "server")

CONSTANT = re.compile(r"(?:inline |static |constexpr |const |thread_local )+[^=(;]*?(\w+)(?=\s*(?:\[[^\]]*\])?\s*(?:=|\{|;))")
MORE_CONSTANTS = re.compile(r",\s*(k[A-Z]\w*)\s*=")
TYPE = re.compile(r"(?:struct|class|enum(?: class)?) (\w+)\b")
FUNCTION = re.compile(r"(?:\[\[nodiscard\]\] |inline |static |constexpr |template <[^>]*> )*[\w:<>,*& ]+?[ *&](\w+)\(")
KEYWORDS = {"if", "for", "while", "return", "switch", "operator", "sizeof", "static_assert", "explicit", "decltype"}
# Sources that no batch takes in.
ALONE = ("server/http/memory_reserve.cc", "engine/dynamics/kernel/")


def names_at_column_0(text):
    """Names that the lines without indentation declare, each with its kind."""
    names = set()
    for line in text.split("\n"):
        if not line or not (line[0].isalpha() or line.startswith("[[")) or line.startswith(("namespace", "using", "public", "private")):
            continue
        code = line.split("//")[0]
        for kind, pattern in (("type", TYPE), ("constant", CONSTANT), ("function", FUNCTION)):
            match = pattern.match(code)
            if match and "::" + match.group(1) not in code.split("(")[0]:
                names.add((match.group(1), kind))
                break
        if code.startswith(("constexpr", "const ", "inline constexpr")):
            names.update((name, "constant") for name in MORE_CONSTANTS.findall(code))
    return {(name, kind) for name, kind in names if name not in KEYWORDS}


def anonymous_parts(text):
    return "\n".join(re.findall(r"^namespace \{\n(.*?)^\}  // namespace$", text, re.S | re.M))


def main():
    folder = Path(sys.argv[1])
    faults = []
    for library in LIBRARIES:
        local = defaultdict(list)
        for source in sorted((folder / library).rglob("*.cc")):
            name = source.relative_to(folder).as_posix()
            if name.startswith(ALONE):
                continue
            for found, kind in names_at_column_0(anonymous_parts(source.read_text(encoding="utf-8"))):
                local[found].append((name, kind))
        declared = defaultdict(list)
        for header in sorted((folder / library).rglob("*.h")):
            for found, _ in names_at_column_0(header.read_text(encoding="utf-8")):
                declared[found].append(header.relative_to(folder).as_posix())
        for found, places in sorted(local.items()):
            sources = [source for source, _ in places]
            if len(sources) > 1 and any(kind != "function" for _, kind in places):
                faults.append(f"{found} is local in {' and in '.join(sources)}")
            if found in declared:
                faults.append(f"{found} is local in {sources[0]}, and declared in {declared[found][0]}")
    for fault in faults:
        print(fault)
    if faults:
        sys.exit(f"{len(faults)} names hide others where sources are compiled together: rename one of each")
    print("no file-local name is another's")


if __name__ == "__main__":
    main()
