# SPDX-License-Identifier: Apache-2.0
"""Tests that run at the same time, in processes of their own: most of what each does is to wait. Threads would do as well, but
Python 3.11 crashed twice in some hundred runs when it collected garbage of theirs."""
import os
import pickle
import sys
import tempfile
import traceback
import unittest

AT_ONCE = 6  # processes


class Suite(unittest.TestSuite):
    """Those of classes with `at_once` run together, then the others, one after another. What such a class starts for all of its
    tests (setUpClass) is not started: it has none."""

    @staticmethod
    def begin():
        """In each process that runs tests, before them: this one has no threads until all others have begun."""

    @staticmethod
    def end():
        """In each of the others, after them."""

    def run(self, result, debug=False):
        tests = list(_each(self))
        together = [test for test in tests if _may(test)]
        _run_together(together, self, result)
        if len(together) < len(tests):
            self.begin()
            unittest.TestSuite(test for test in tests if not _may(test)).run(result, debug)
        return result


def _each(suite):
    for test in suite:
        if isinstance(test, unittest.TestSuite):
            yield from _each(test)
        else:
            yield test


def _may(test):
    return getattr(test, "at_once", False)  # a file that cannot be loaded is a test without


def _run_together(tests, suite, result):
    for before_all in {getattr(test, "before_all", None) for test in tests} - {None}:
        os.waitpid(_fork(before_all), 0)  # connections that it makes are not the children's
    queue, fill = os.pipe()
    os.write(fill, bytes(range(len(tests))))  # who is free takes the next
    os.close(fill)
    children = [_Child(tests, suite, queue) for _ in tests[:AT_ONCE]]
    os.close(queue)
    told = {}
    for child in children:
        told.update(child.wait())
    for number, test in enumerate(tests):
        result.startTest(test)
        for name, *details in told.get(number, [("addError", "the process that ran it has ended before it")]):
            is_error = name in ("addError", "addFailure")
            getattr(result, name)(test, *[(Told, Told(text), None) if is_error else text for text in details])
        result.stopTest(test)


class Told(Exception):
    """What went wrong in another process, as text."""


def _fork(act):
    """The id of a process that does this and ends."""
    sys.stdout.flush()
    sys.stderr.flush()
    pid = os.fork()
    if pid:
        return pid
    try:
        act()
    except BaseException:  # pylint: disable=broad-except
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(0)  # pylint: disable=protected-access


class _Child:
    def __init__(self, tests, suite, queue):
        self._file = tempfile.TemporaryFile()
        self._pid = _fork(lambda: self._run(tests, suite, queue))

    def _run(self, tests, suite, queue):
        suite.begin()
        while number := os.read(queue, 1):
            account = _Account()
            tests[number[0]].run(account)
            pickle.dump((number[0], account.told), self._file)
            self._file.flush()
        suite.end()

    def wait(self):
        """Of each test that it ran: its number, and what was told of it."""
        os.waitpid(self._pid, 0)
        self._file.seek(0)
        while True:
            try:
                yield pickle.load(self._file)
            except EOFError:
                self._file.close()
                return


class _Account:
    """A result that keeps what a test tells it, as text."""
    failfast = False

    def __init__(self):
        self.told = []

    def startTest(self, _):
        pass

    def stopTest(self, _):
        pass

    def addSuccess(self, _):
        self.told.append(("addSuccess",))

    def addSkip(self, _, reason):
        self.told.append(("addSkip", reason))

    def addError(self, _, error):
        self.told.append(("addError", "".join(traceback.format_exception(*error))))

    def addFailure(self, _, error):
        self.told.append(("addFailure", "".join(traceback.format_exception(*error))))

    def addSubTest(self, _, subtest, error):
        if error:
            self.told.append(("addFailure", f"{subtest}\n" + "".join(traceback.format_exception(*error))))
