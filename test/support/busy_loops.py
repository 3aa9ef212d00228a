# SPDX-License-Identifier: Apache-2.0
"""Load of ordinary priority."""
import contextlib
import os
import subprocess
import sys


@contextlib.contextmanager
def busy_loops(cores):
    """One on each of these cores, which may be there twice. They end with this program, whatever ends it."""
    code = f"import os\nwhile os.getppid() == {os.getpid()}: pass"
    loops = []
    try:
        for core in cores:
            loops.append(subprocess.Popen(["taskset", "--cpu-list", str(core), sys.executable, "-c", code]))
        yield
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()
