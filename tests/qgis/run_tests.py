"""Runs modules of tests in one QGIS: run_tests.py NAME... [options of unittest]."""
import os
import sys
import unittest

outcome = unittest.main(module=None, argv=sys.argv, exit=False).result
sys.stdout.flush()
sys.stderr.flush()
os._exit(0 if outcome.wasSuccessful() else 1)  # QGIS 3.22 falls over its own objects where Python ends
