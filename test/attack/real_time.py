# SPDX-License-Identifier: Apache-2.0
"""What else the machine does must not count as the node's delay."""
import os


def ask_for_real_time():
    """This process goes before those that did not ask, if it may (root, or CAP_SYS_NICE)."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))
    except PermissionError:
        pass
