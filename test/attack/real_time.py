# SPDX-License-Identifier: Apache-2.0
"""What else the machine does must not count as the node's delay."""
import os

PRIORITY = 10  # above that of measurements that run beside this one


def ask_for_real_time(ahead=0):
    """Whether this process, from now on, goes before those that did not ask: if it may (root, or CAP_SYS_NICE)."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY + ahead))
    except PermissionError:
        return False
    return True
