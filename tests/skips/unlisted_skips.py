#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fails for a test that was skipped and does not stand in the list of skips that are allowed, with its reason.

  unlisted_skips.py JUNIT LIST PRESET [PREFIX]

JUNIT is what `ctest --output-junit` wrote, or --gtest_output=xml of a program whose tests have PREFIX before their names; each line of LIST is a preset or "any", a pattern of test names, and the reason.
"""
import sys
from fnmatch import fnmatchcase
from xml.etree import ElementTree


def read_allowed(path, preset):
    """Patterns of the tests that may be skipped in a preset."""
    patterns = []
    with open(path, encoding="utf-8") as lines:
        for number, line in enumerate(lines, 1):
            if not line.strip() or line.startswith("#"):
                continue
            fields = line.split(maxsplit=2)
            if len(fields) < 3:
                sys.exit(f"{path}:{number}: wanted are a preset or any, a pattern of names, and the reason")
            if fields[0] in ("any", preset):
                patterns.append(fields[1])
    return patterns


def is_skipped(case):
    return case.get("status") not in ("run", "fail") or case.get("result", "completed") != "completed"


def main():
    junit, path, preset = sys.argv[1:4]
    prefix = sys.argv[4] if len(sys.argv) > 4 else None

    def name_of(case):
        return case.get("name") if prefix is None else f"{prefix}{case.get('classname')}.{case.get('name')}"

    cases = list(ElementTree.parse(junit).getroot().iter("testcase"))
    if not cases:
        sys.exit(f"{junit} holds no test")
    allowed = read_allowed(path, preset)
    skipped = [case for case in cases if is_skipped(case)]
    unlisted = [case for case in skipped if not any(fnmatchcase(name_of(case), pattern) for pattern in allowed)]
    print(f"skips: {len(skipped)} of {len(cases)} tests were skipped, {len(unlisted)} of them without a reason in {path}")
    for case in unlisted:
        skipped_element = case.find("skipped")
        message = skipped_element.get("message") if skipped_element is not None else None
        said = (case.findtext("system-out") or message or "").strip().splitlines()
        print(f"  {name_of(case)}: {said[-1] if said else 'nothing said'}")
    sys.exit(1 if unlisted else 0)


main()
