#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Switches an output on, `delay` seconds after each rising edge of an input and for `duration` seconds, counted from the edge's stamp.
docs/application.md explains it. eject_rclpy.py is the same for ROS 2."""
import queue
import threading

import rospy
from coupler_driver.msg import BoolSample, Scheduled
from coupler_driver.srv import Schedule
from std_msgs.msg import Bool

RESULTS = {Scheduled.CANCELLED: "cancelled", Scheduled.FAILED: "failed", Scheduled.UNKNOWN: "unknown"}


class Eject:
    def __init__(self):
        device = rospy.get_param("~device", "sorter")
        self.input = rospy.get_param("~input", "part_seen")
        self.output = rospy.get_param("~output", "ejector")
        self.delay = rospy.Duration(rospy.get_param("~delay", 0.15))
        self.duration = rospy.Duration(rospy.get_param("~duration", 0.05))
        self.second_write = rospy.get_param("~second_write", False)  # for a device that cannot end the duration by itself
        self.last = None  # the sample before; None: not known
        self.call = rospy.ServiceProxy(f"{device}/schedule", Schedule)
        # rospy calls back in a thread for each topic; they only hand over. One thread does the work, and may wait for an answer.
        self.messages = queue.Queue()
        threading.Thread(target=self.work, daemon=True).start()
        rospy.Subscriber(f"{device}/online", Bool, self.messages.put)
        rospy.Subscriber(f"{device}/{self.input}/sample", BoolSample, self.messages.put)
        rospy.Subscriber(f"{device}/scheduled", Scheduled, self.messages.put)

    def work(self):
        handlers = {Bool: self.on_online, BoolSample: self.on_sample, Scheduled: self.on_scheduled}
        while True:
            message = self.messages.get()
            handlers[type(message)](message)

    def on_online(self, online):
        if online.data:
            rospy.loginfo("the device is online")
        else:
            rospy.logwarn("the device is offline: edges are not seen until it is back")
            self.last = None

    def on_sample(self, sample):
        last, self.last = self.last, sample
        if last is None or sample.sequence <= last.sequence:
            return  # the first one after a start, the driver's too, or a reconnect: when the level changed is not known
        lost = sample.sequence - last.sequence - 1
        if lost:
            rospy.logwarn(f"{lost} messages of {self.input} were lost: edges may have been missed")
        if not sample.value or last.value:
            return
        at = sample.since + self.delay
        if not self.second_write:
            self.schedule("true", at, self.duration)
        elif self.schedule("false", at + self.duration):  # the end first: what nothing would end does not begin
            self.schedule("true", at)

    def schedule(self, value, at, how_long=rospy.Duration()):
        try:
            answer = self.call(self.output, value, at, how_long)
        except (rospy.ServiceException, rospy.ROSException) as error:
            rospy.logerr(f"{self.output} {value} was not scheduled: {error}")
            return False
        if not answer.success:
            rospy.logerr(f"{self.output} {value} was refused: {answer.message}")
        return answer.success

    def on_scheduled(self, outcome):
        if outcome.point != self.output:
            return
        if outcome.result == Scheduled.DONE:
            rospy.loginfo(f"{self.output}: write {outcome.number} done, {outcome.lateness * 1e3:.2f} ms late")
        else:
            rospy.logerr(f"{self.output}: write {outcome.number} {RESULTS[outcome.result]}: {outcome.reason}")


if __name__ == "__main__":
    rospy.init_node("eject")
    Eject()
    rospy.spin()
