#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the tests of the Python package in this folder. Exit code 77: passed, but some need pandas.

  unit.py PROGRAM PACKAGE
"""
import importlib.util
import os
import sys
import unittest

NEED_PANDAS = {"client_test", "table_test"}
NAMES = ["transport_test", "program_test", "client_test", "table_test"]


def main():
    program, package = (os.path.abspath(path) for path in sys.argv[1:3])
    os.environ.update(
        RPSUP_TEST_PROGRAM=program, PYTHONPATH=package, PYTHONDONTWRITEBYTECODE="1", no_proxy="127.0.0.1"
    )
    sys.path.insert(0, package)
    has_pandas = importlib.util.find_spec("pandas") is not None
    names = [name for name in NAMES if has_pandas or name not in NEED_PANDAS]
    suite = unittest.defaultTestLoader.loadTestsFromNames(names)
    result = unittest.TextTestRunner(warnings="error", verbosity=2).run(suite)
    if not result.wasSuccessful() or result.testsRun < 20:
        return 1
    if not has_pandas:
        print("skipped, because not installed: pandas (script/setup all)")
    return 0 if has_pandas else 77


sys.exit(main())
