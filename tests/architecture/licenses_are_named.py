#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fails for a work of others in the program that packaging/debian/copyright does not name, and for a license
without its text.

  licenses_are_named.py ROOT BUILD

Works of others are the npm packages that the program serves (web/files.cmake), and the header files and archives
that Ninja has read for it. Those of the C and C++ libraries and of the kernel are left out: every program has them.
"""
import re
import subprocess
import sys
from fnmatch import fnmatchcase
from pathlib import Path

RUNTIME = re.compile(r"libc6-dev|libgcc-\d+-dev|libstdc\+\+-\d+-dev|libc\+\+.*|libclang-.*|linux-libc-dev")

HOLDER = re.compile(r"(?i:\(c\)|copyright|@author)\s+(?:\(c\)\s*)?(?:[\d-]+(?:present)?,?\s+)?([A-Z][a-z]\w*(?: [A-Z]\w+)*)")


def read_paragraphs(text):
    """Fields of each paragraph, by name."""
    for block in re.split(r"\n\s*\n", text.strip()):
        fields = re.split(r"^([\w-]+):", block, flags=re.M)
        yield {name: value.strip() for name, value in zip(fields[1::2], fields[2::2])}


def own_faults(root, paragraphs):
    """Faults of the file in itself: fields, texts of licenses, paths that there are not."""
    texts = {p["License"].split("\n")[0] for p in paragraphs if "Files" not in p and "License" in p}
    used = set()
    for paragraph in paragraphs:
        if "Files" not in paragraph:
            continue
        paths = paragraph["Files"].split()
        for field in ("Copyright", "License"):
            if not paragraph.get(field):
                yield f"{paths[0]}: no {field}"
        used |= set(re.split(r" and | or ", paragraph.get("License", "").split("\n")[0]))
        own = [path for path in paths if not path.startswith("/") and "*" not in path]
        yield from (f"{path}: no such file" for path in own if not (root / path).exists())
    yield from (f"no text of {name}" for name in sorted(used - texts))
    yield from (f"{name} is of no file" for name in sorted(texts - used))


def served_packages(root):
    """Files of npm packages that the program serves."""
    listed = re.search(r"set\(page_packages(.*?)\)", (root / "web/files.cmake").read_text(), re.S)[1]
    return ["web/node_modules/" + entry.split("=")[1] for entry in listed.split()]


def holders(notices):
    """Names of holders in notices of copyright."""
    for line in notices.splitlines():
        if match := HOLDER.search(line):
            yield match[1]


def run(*command, **options):
    return subprocess.run(command, check=True, capture_output=True, text=True, **options).stdout


def compiled_in(build):
    """Header files and archives of other packages that the build has read for the program."""
    paths, own = set(), False
    for line in run("ninja", "-C", str(build), "-t", "deps").splitlines():
        if line.startswith(" "):
            if own and line.strip().startswith("/usr/"):
                paths.add(line.strip())
        else:
            # From CMake 3.27 on programs have such lines, too.
            own = re.match(r"(?!tests/)\S+\.o: ", line) is not None
    link = run("ninja", "-C", str(build), "-t", "commands", "-s", "rpsup")
    paths |= set(re.findall(r"/usr/\S+\.a\b", link))
    found = run("dpkg-query", "--search", *sorted(paths)).splitlines() if paths else []
    packages = {path: package.split(":")[0] for package, path in (line.rsplit(": ", 1) for line in found)}
    return sorted(path for path in paths if not RUNTIME.fullmatch(packages.get(path, "")))


def main():
    root, build = Path(sys.argv[1]), Path(sys.argv[2])
    paragraphs = list(read_paragraphs((root / "packaging/debian/copyright").read_text()))
    patterns = [path for p in paragraphs for path in p.get("Files", "").split() if path != "*"]
    faults = list(own_faults(root, paragraphs))

    works = compiled_in(build)
    if len(works) < 100:
        faults.append(f"only {len(works)} headers of others were found: is {build} built?")
    served = served_packages(root)
    if len(served) < 4:
        faults.append("web/files.cmake names less than four files of npm packages")
    missing = [path for path in served + works if not any(fnmatchcase(path, pattern) for pattern in patterns)]
    faults += [f"{path}: in no paragraph" for path in missing[:20]]

    # Holders that a served file names for its own parts.
    bundled = root / "web/node_modules/swagger-ui-dist/swagger-ui-bundle.js.LICENSE.txt"
    if bundled.exists():
        told = "\n".join(p.get("Copyright", "") for p in paragraphs)
        names = set(holders(bundled.read_text()))
        if len(names) < 5:
            faults.append(f"{bundled}: only {len(names)} holders were found")
        faults += [f"{bundled.name}: {name} is not named" for name in sorted(names) if name not in told]

    for fault in faults:
        print(fault)
    print(f"{len(works)} headers and archives, {len(served)} files of npm packages")
    return 1 if faults else 0


sys.exit(main())
