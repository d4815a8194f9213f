#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fails for a version in the README's table of packages that is not the one in use.

  versions_are_those_used.py ROOT

Versions of npm packages are those of web/package.json, the others those that are installed, looked at on Debian 12 only.
"""
import json
import platform
import re
import subprocess
import sys
from pathlib import Path

DEBIAN = {"Eigen": "libeigen3-dev", "Boost: Odeint": "libboost-dev", "SQLite": "libsqlite3-dev",
          "SQLiteCpp": "libsqlitecpp-dev", "Zstandard": "libzstd-dev", "OpenSSL": "libssl-dev",
          "cpp-httplib": "libcpp-httplib-dev", "JSON for Modern C++": "nlohmann-json3-dev", "zlib": "zlib1g-dev",
          "Brotli": "libbrotli-dev", "CLI11": "libcli11-dev", "spdlog": "libspdlog-dev", "fmt": "libfmt-dev",
          "prometheus-cpp": "prometheus-cpp-dev", "pagmo": "libpagmo-dev", "oneTBB": "libtbb-dev",
          "Ceres": "libceres-dev", "NLopt": "libnlopt-dev", "HDF5": "libhdf5-dev", "matio": "libmatio-dev",
          "MiniZip": "libminizip-dev"}
NPM = {"ECharts": "echarts", "uPlot": "uplot", "three.js": "three", "Swagger UI": "swagger-ui-dist"}


def stated_versions(readme):
    """Pairs of package and version; a row may name several."""
    table = readme.split("| package | version |", 1)[1].split("\n\n", 1)[0]
    for row in table.splitlines()[2:]:
        names, versions = (cell.strip().split(", ") for cell in row.split("|")[1:3])
        yield from zip(names, versions)


def installed_version(package):
    command = ["dpkg-query", "--show", "--showformat=${Version}", package]
    return re.sub(r"^\d+:", "", subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def main():
    root = Path(sys.argv[1])
    stated = dict(stated_versions((root / "README.md").read_text(encoding="utf-8")))
    if set(stated) != set(DEBIAN) | set(NPM):
        sys.exit(f"other packages than those looked for: {sorted(set(stated) ^ (set(DEBIAN) | set(NPM)))}")
    dependencies = json.loads((root / "web/package.json").read_text())["dependencies"]
    used = {name: dependencies[package] for name, package in NPM.items()}
    if platform.freedesktop_os_release().get("VERSION_CODENAME") == "bookworm":
        used |= {name: installed_version(package) for name, package in DEBIAN.items()}
    faults = [f"{name} {stated[name]}: in use is {version}" for name, version in used.items()
              if not re.match(re.escape(stated[name]) + r"\b", version)]
    if faults:
        sys.exit("\n".join(faults))
    print(f"{len(used)} versions are those in use")


main()
