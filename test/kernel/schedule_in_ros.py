# SPDX-License-Identifier: Apache-2.0
"""Schedules lamp through the driver, and prints what becomes of it:
  python3 schedule_in_ros.py SECONDS     how far ahead; doubled as long as that is over when the call comes"""
import queue
import sys
import time

import rospy
from coupler_driver.msg import Scheduled
from coupler_driver.srv import Schedule, Write

RESULTS = {Scheduled.DONE: "done", Scheduled.CANCELLED: "cancelled", Scheduled.FAILED: "failed", Scheduled.UNKNOWN: "unknown"}
BY_NODE = "accepted: the device does it"
NEVER = 3000  # seconds


def main():
    rospy.init_node("schedule_in_ros", anonymous=True)
    told = queue.Queue()
    rospy.Subscriber("/plant/scheduled", Scheduled, told.put)
    for service in ("schedule", "write"):
        rospy.wait_for_service(f"/plant/{service}")
    call, write = rospy.ServiceProxy("/plant/schedule", Schedule), rospy.ServiceProxy("/plant/write", Write)

    def schedule(point, seconds):
        return call(point, "true", rospy.Time.from_sec(time.time() + seconds), rospy.Duration())

    def is_settled():
        """The driver is connected and knows that the node can, and what it publishes is heard."""
        by = schedule("memory", NEVER).message
        write("memory", "false")  # cancels it
        return by == BY_NODE and not told.empty()

    while not is_settled():
        time.sleep(0.05)
    seconds = float(sys.argv[1])
    while " s past" in (answer := schedule("lamp", seconds)).message or "exception 03" in answer.message:
        seconds *= 2
    print(f"{answer.message}, in {seconds:.0f} s", flush=True)
    if not answer.success:
        return
    while (outcome := told.get()).number != answer.number:
        pass
    print(f"{outcome.point} {RESULTS[outcome.result]}: {outcome.reason}", flush=True)


main()
