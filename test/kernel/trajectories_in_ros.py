# SPDX-License-Identifier: Apache-2.0
"""Random trajectories of two outputs through the driver, by actionlib's client, and what their wires did meanwhile: each edge
once, in order, never early. How late they were it prints, as the device said it and as the wires showed it.
  python3 trajectories_in_ros.py COUNT WIRE WIRE     the wires of lamp and inverted"""
import pathlib
import sys
import threading
import time

import rospy
from coupler_driver.msg import Scheduled

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "ros"))
from support.actions import SUCCEEDED  # noqa: E402
from support.patience import wait_until  # noqa: E402
from support.random_trajectory import RandomTrajectories, described, lateness  # noqa: E402
from trajectory_test import SUCCESSFUL, Trajectory  # noqa: E402

JOINTS = ["plant/lamp", "plant/inverted"]
AHEAD = 0.5  # seconds: a goal comes so long before its start, since this kernel is slow
LOOK = 0.001  # seconds between two looks at the wires
CLOCKS = 0.002  # seconds: as exactly as the driver knows the node's clock in this kernel


class Wires(threading.Thread):
    """The edges of wires: (joint, level, time of day)."""

    def __init__(self, paths):
        super().__init__(daemon=True)
        self._files = [open(f"{path}/value", "rb", buffering=0) for path in paths]  # pylint: disable=consider-using-with
        self.seen = []
        self.start()

    def run(self):
        before = self._levels()
        while True:
            time.sleep(LOOK)
            now = self._levels()
            for joint, old, new in zip(JOINTS, before, now):
                if new != old:
                    self.seen.append((joint, new, time.time()))
            before = now

    def _levels(self):
        for file in self._files:
            file.seek(0)
        lamp, inverted = (int(file.read(1)) for file in self._files)
        return lamp, 1 - inverted


def main():
    rospy.init_node("trajectories_in_ros")
    count, wires = int(sys.argv[1]), Wires(sys.argv[2:])
    told = []
    rospy.Subscriber("/plant/scheduled", Scheduled, told.append, queue_size=1000)
    client = Trajectory("/plant/follow_joint_trajectory")
    trajectories = RandomTrajectories(JOINTS, "plant", stops=3, step=(0.1, 0.3), apart=20 * LOOK)
    said, late = 0, []
    for _ in range(count):
        points, edges = trajectories.next()
        begin = time.time() + AHEAD
        how, result = client.send(points, JOINTS, start=begin).result()
        if (how, result.error_code) != (SUCCEEDED, SUCCESSFUL):
            raise AssertionError(f"{how}: {result.error_string}")
        said += int(result.error_string.split()[0])
        wait_until(lambda: len(wires.seen) >= len(edges), f"{len(edges)} edges, of which there are {wires.seen}")
        seen, wires.seen = wires.seen, []
        late += lateness(JOINTS, seen, [(joint, level, begin + at) for joint, level, at in edges])
    wait_until(lambda: len(told) >= said, "what became of each change")
    if {one.result for one in told} != {Scheduled.DONE} or len(told) != said:
        raise AssertionError(f"{said} changes said, but told: {told}")
    if min(late) < -CLOCKS:
        raise AssertionError(f"an edge came {-min(late)} s early")
    print(f"{count} trajectories, {said} changes, {len(late)} edges; late by (ms)")
    print(f"  as the device said: {described([one.lateness for one in told])}")
    print(f"  as the wires showed: {described(late)}")


main()
