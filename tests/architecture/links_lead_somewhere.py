#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fails for a link of a Markdown document to a file, or to a heading of a document, that is not there.

  links_lead_somewhere.py ROOT

Links to other hosts are not followed.
"""
import re
import sys
from pathlib import Path

SKIPPED = {"node_modules", "build", ".git"}
FENCE = re.compile(r"^```.*?^```$", re.M | re.S)
LINK = re.compile(r"\]\(([^()\s]+)\)")
HEADING = re.compile(r"^#{1,6} +(.*?)#* *$", re.M)


def anchors_of(text):
    """Anchors that GitHub gives to headings: lower case, no punctuation, hyphens for spaces, repeated ones numbered."""
    seen = {}
    for heading in HEADING.findall(FENCE.sub("", text)):
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        slug = re.sub(r"[^\w\- ]", "", words.lower()).strip().replace(" ", "-")
        count = seen.get(slug, 0)
        seen[slug] = count + 1
        yield f"{slug}-{count}" if count else slug


def faults_of(document, root):
    text = FENCE.sub("", document.read_text(encoding="utf-8"))
    for target in LINK.findall(text):
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        file = (document.parent / path).resolve() if path else document
        if not file.is_relative_to(root) or not file.exists():
            yield f"{target}: no such file"
        elif anchor and anchor not in set(anchors_of(file.read_text(encoding="utf-8"))):
            yield f"{target}: no such heading"


def main():
    root = Path(sys.argv[1]).resolve()
    documents = sorted(path for path in root.rglob("*.md") if not SKIPPED & set(path.relative_to(root).parts))
    links = sum(len(LINK.findall(document.read_text(encoding="utf-8"))) for document in documents)
    if links < 100:
        sys.exit(f"only {links} links in {len(documents)} documents: is this the right folder?")
    faults = [f"{document.relative_to(root)}: {fault}" for document in documents for fault in faults_of(document, root)]
    if faults:
        sys.exit("\n".join(faults))
    print(f"{links} links in {len(documents)} documents lead somewhere")


main()
