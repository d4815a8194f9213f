#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fails for a source that uses a name of ours and includes, directly or through others, no header that declares it.

  names_are_included.py ROOT

Compiled together with its neighbours such a source may build, compiled alone it does not. Names are found by their looks, without a
compiler: what a header declares outside of braces counts, and a source that declares the same name itself is left alone.
"""
import re
import sys
from pathlib import Path

FOLDERS = ("charts", "engine", "jobs", "server", "validation", "tests")
LAYERS = ("charts", "engine", "jobs", "server", "validation")

NO_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<!\w)\'(?:\\.|[^\'\\\n])+\'', re.S)
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.M)
DIRECTIVE = re.compile(r"^\s*#.*(?:\\\n.*)*$", re.M)
NAMESPACE = re.compile(r"\b(?:inline\s+)?namespace(?:\s+[\w:]+)?\s*$")
TEMPLATE = re.compile(r"^template\s*<.*?>\s*(?=[\w\[])", re.S)

TYPE = re.compile(r"\b(?:struct|class|enum|enum\s+class|union)\s+(\w+)\s*(?:final\s*)?(?::[^:].*)?$", re.S)
ALIAS = re.compile(r"\busing\s+(\w+)\s*=")
CONSTANT = re.compile(r"\b(k[A-Z]\w*)\s*(?:\[[^\]]*\]\s*)*(?:=|$)")
FUNCTION = re.compile(r"(?:^|[\s&*>])([A-Za-z_]\w*)\s*\(")
USE = re.compile(r"(?<![\w.:>~])(?:(?:charts|engine|jobs|server|validation)::(?:[a-z]\w*::)?)?(\w+)(\s*\()?")

# Names that a source declares itself, at any depth: "Type name", "auto [a, name]", "using library::Name", enumerators.
OWN = re.compile(r"(?:(\w+)|(?<=[\w>])[&*]|(?<=[\w>*&])>|(?<=\w)\.\.\.|\bauto\s*&?\s*\[[\w, ]*)(?:\s+|(?<=\[))(\w+)\s*(?=[=({;,):\[\]>]|$)")
BORROWED = re.compile(r"\busing\s+[\w:]+::(\w+)\s*;")
ENUMERATOR = re.compile(r"[{,]\s*(k[A-Z]\w*)\s*(?=[,}=])")
TEST = re.compile(r"\bTEST\(\s*(\w+)")  # of GoogleTest, whose suites have names of their own
NO_TYPES = {"return", "else", "case", "throw", "new", "delete", "do", "co_return", "public", "private", "protected", "const", "constexpr", "static"}
OTHERS = {"sqrt", "sin", "cos", "exp", "copy", "any", "sum", "join"}  # of <cmath> and <algorithm>, whose arguments are not looked at
NO_FUNCTIONS = {"static_assert", "decltype", "noexcept", "requires", "alignas", "operator"}


def statements_of_namespaces(code):
    """What stands in no braces but those of namespaces, each up to its semicolon or its own brace."""
    statement, depth, depth_of_body = "", 0, None
    for sign in DIRECTIVE.sub("", code):
        if sign == "{":
            if depth_of_body is None and not NAMESPACE.search(statement):
                depth_of_body = depth
                yield statement
            statement = ""
            depth += 1
        elif sign == "}":
            depth -= 1
            if depth == depth_of_body:
                depth_of_body = None
            statement = ""
        elif sign == ";" and depth_of_body is None:
            yield statement
            statement = ""
        elif depth_of_body is None:
            statement += sign


def declared_names(code):
    """Names that a header gives to who includes it, each with whether it is a function's."""
    for statement in statements_of_namespaces(code):
        plain = TEMPLATE.sub("", statement.strip())
        for pattern in (ALIAS, TYPE, CONSTANT):
            if match := pattern.search(plain):
                yield match[1], False
                break
        else:
            match = FUNCTION.search(plain)
            if match and match[1] not in NO_FUNCTIONS:
                yield match[1], True


def own_names(code):
    names = {match[2] for match in OWN.finditer(code) if match[1] not in NO_TYPES}
    return names.union(*(pattern.findall(code) for pattern in (BORROWED, ENUMERATOR, TEST)))


def may_use(source, header):
    """A layer uses itself and those below it; a folder of tests all layers and the tests' headers."""
    user, used = source.split("/")[0], header.split("/")[0]
    return user == "tests" or (used in LAYERS and LAYERS.index(used) <= LAYERS.index(user))


def read_sources(root):
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".h", ".cc") and "node_modules" not in path.parts:
                yield str(path.relative_to(root)), path.read_text()


def reached_from(source, includes):
    reached, waiting = {source}, [source]
    while waiting:
        for included in includes[waiting.pop()] - reached:
            reached.add(included)
            waiting.append(included)
    return reached


def main():
    texts = dict(read_sources(Path(sys.argv[1])))
    if not texts:
        sys.exit(f"{sys.argv[1]} holds no source at all: is this the right folder?")
    includes = {source: {i for i in INCLUDE.findall(text) if i in texts} for source, text in texts.items()}
    codes = {source: NO_CODE.sub(" ", text) for source, text in texts.items()}
    own = {source: own_names(code) for source, code in codes.items()}
    headers_of = {}
    for source, code in codes.items():
        if source.endswith(".h"):
            for name, is_function in declared_names(code):
                if name not in OTHERS:
                    headers_of.setdefault(name, {})[source] = is_function

    faults = 0
    for source, code in codes.items():
        reached = reached_from(source, includes)
        for name, is_called in sorted({(use[1], bool(use[2])) for use in USE.finditer(code)}):
            headers = {h: f for h, f in headers_of.get(name, {}).items() if may_use(source, h) and (is_called or not f)}
            if headers and not reached & headers.keys() and not any(name in own[r] for r in reached):
                print(f"{source} uses {name} and does not include {' or '.join(headers)}")
                faults += 1
    if faults:
        sys.exit(1)
    print(f"{len(texts)} sources include what declares the {len(headers_of)} names they use")


if __name__ == "__main__":
    main()
