# SPDX-License-Identifier: Apache-2.0
"""Tests that run at the same time, in threads of one ROS node: most of what each does is to wait."""
import concurrent.futures
import unittest

AT_ONCE = 6  # tests


class Suite(unittest.TestSuite):
    """Those of classes with `at_once` run together, and the others before them, one after another. What such a class starts for
    all of its tests (setUpClass) is not started: it has none."""

    def run(self, result, debug=False):
        tests = list(_each(self))
        unittest.TestSuite(test for test in tests if not _may(test)).run(result, debug)
        _run_together([test for test in tests if _may(test)], result)
        return result


def _each(suite):
    for test in suite:
        if isinstance(test, unittest.TestSuite):
            yield from _each(test)
        else:
            yield test


def _may(test):
    return getattr(test, "at_once", False)  # a file that cannot be loaded is a test without


def _run_together(tests, result):
    for before_all in {getattr(test, "before_all", None) for test in tests} - {None}:
        before_all()
    with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
        for account in pool.map(_run, tests):
            account.tell(result)


def _run(test):
    account = _Account()
    test.run(account)
    return account


class _Account:
    """A result that keeps what a test tells it, for the one that all tests have."""
    failfast = False

    def __init__(self):
        self._told = []

    def __getattr__(self, name):
        return lambda *arguments: self._told.append((name, arguments))

    def tell(self, result):
        for name, arguments in self._told:
            getattr(result, name)(*arguments)
