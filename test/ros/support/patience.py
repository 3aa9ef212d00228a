# SPDX-License-Identifier: Apache-2.0
"""How long tests wait. None of it is a rule of the driver: what must come may take as long as a busy machine needs, and what
must not come is looked for a while."""
import os
import pathlib
import re
import time

_CACHE = pathlib.Path(os.environ.get("COUPLER_BUILD_DIR", ""), "CMakeCache.txt")  # none: of a program that is no test of a build
_SANITIZED = _CACHE.exists() and re.search(r"^COUPLER_SANITIZE:\w+=.", _CACHE.read_text(), re.MULTILINE)

# Seconds until what must come is given up. Longer than the 60 for which rospy waits for the header of a connection, and all
# that connect after it with it: now and then roscpp makes one and says nothing, and a minute later connects again.
PATIENCE = 240 if _SANITIZED else 150
QUIET = 0.7  # seconds in which nothing comes: fourteen polls at the 20 Hz of most maps

# Of a map whose test is not about timeouts: longer than any test waits, so that a reply that comes late because the machine
# is busy is no fault of the device.
NO_TIMEOUT = 10 * PATIENCE


def wait_until(condition, what, seconds=PATIENCE):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"waited {seconds} s for {what}")
        time.sleep(0.005)


def once_more(attempt):
    """What attempt() returns. If it fails, that is printed, and it is made once more: for what the middleware may lose."""
    try:
        return attempt()
    except AssertionError as error:
        print(error)
        return attempt()


def stay_quiet(topics):
    """Nothing is published on any of them from now on."""
    for topic in topics:
        topic.subscribe_anew()
    time.sleep(QUIET)
    for topic in topics:
        if topic.values:
            raise AssertionError(f"{topic.name}: {topic.values} came, though there is nothing new")
