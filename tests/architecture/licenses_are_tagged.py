#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fails for a source whose first comment is not its license: "SPDX-License-Identifier: Apache-2.0".

  licenses_are_tagged.py ROOT

Sources that derive from others' works, as packaging/debian/copyright says, have those licenses, too.
"""
import re
import subprocess
import sys
from pathlib import Path

SUFFIXES = {".h", ".cc", ".in", ".js", ".mjs", ".css", ".py", ".sh", ".cmake", ".jq", ".m", ".toml"}
TAG = re.compile(r"(?://|#|%|/\*) SPDX-License-Identifier: (.+?)(?: \*/)?$")


def sources(root):
    command = ["git", "-C", str(root), "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    for name in sorted(subprocess.run(command, check=True, capture_output=True, text=True).stdout.split("\0")):
        path = root / name
        if not name or not path.is_file():
            continue
        with path.open("rb") as file:
            shebang = file.read(2) == b"#!"
        if shebang or path.suffix in SUFFIXES or path.name == "CMakeLists.txt":
            yield name, path.read_text().split("\n")[int(shebang)]


def derived(root):
    """Licenses of the sources that have a paragraph of their own, in the form of a tag."""
    text = (root / "packaging/debian/copyright").read_text()
    for files, names in re.findall(r"^Files: (.*?)^Copyright:.*?^License: (.*?)$", text, re.M | re.S):
        for file in files.split():
            yield file, names.replace(" and ", " AND ")


def main():
    root = Path(sys.argv[1])
    licenses = dict(derived(root))
    found = list(sources(root))
    faults = []
    for name, line in found:
        tag = TAG.fullmatch(line)
        expected = licenses.get(name, "Apache-2.0")
        if not tag:
            faults.append(f"{name}: no SPDX-License-Identifier in its first comment")
        elif tag[1] != expected:
            faults.append(f"{name}: {tag[1]}, but packaging/debian/copyright says {expected}")
    if len(found) < 500:
        faults.append(f"only {len(found)} sources were found: is {root} the right folder?")
    for fault in faults[:20] + ([f"and {len(faults) - 20} more"] if len(faults) > 20 else []):
        print(fault)
    print(f"{len(found)} sources")
    return 1 if faults else 0


sys.exit(main())
