#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Switches an output on, `delay` seconds after each rising edge of an input and for `duration` seconds, counted from the edge's stamp.
docs/application.md explains it. eject_rospy.py is the same for ROS 1."""
import signal
import threading

import rclpy
from coupler_driver.msg import BoolSample, Scheduled
from coupler_driver.srv import Schedule
from rclpy.duration import Duration
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.signals import SignalHandlerOptions
from rclpy.time import Time
from std_msgs.msg import Bool

RESULTS = {Scheduled.CANCELLED: "cancelled", Scheduled.FAILED: "failed", Scheduled.UNKNOWN: "unknown"}


class Eject(Node):
    def __init__(self):
        super().__init__("eject")
        device = self.declare_parameter("device", "sorter").value
        self.input = self.declare_parameter("input", "part_seen").value
        self.output = self.declare_parameter("output", "ejector").value
        self.declare_parameter("delay", 0.15)
        self.declare_parameter("duration", 0.05)
        self.declare_parameter("second_write", False)  # for a device that cannot end the duration by itself
        self.last = None  # the sample before; None: not known
        self.client = self.create_client(Schedule, f"{device}/schedule")
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_subscription(Bool, f"{device}/online", self.on_online, latched)
        self.create_subscription(BoolSample, f"{device}/{self.input}/sample", self.on_sample, 100)
        self.create_subscription(Scheduled, f"{device}/scheduled", self.on_scheduled, 100)

    def on_online(self, online):
        if online.data:
            self.get_logger().info("the device is online")
        else:
            self.get_logger().warning("the device is offline: edges are not seen until it is back")
            self.last = None

    def on_sample(self, sample):
        last, self.last = self.last, sample
        if last is None or sample.sequence <= last.sequence:
            return  # the first one after a start, the driver's too, or a reconnect: when the level changed is not known
        lost = sample.sequence - last.sequence - 1
        if lost:
            self.get_logger().warning(f"{lost} messages of {self.input} were lost: edges may have been missed")
        if not sample.value or last.value:
            return
        at = Time.from_msg(sample.since) + Duration(seconds=self.get_parameter("delay").value)
        duration = Duration(seconds=self.get_parameter("duration").value)
        if not self.get_parameter("second_write").value:
            self.schedule("true", at, duration)
        else:  # the end first: what nothing would end does not begin
            self.schedule("false", at + duration, then=lambda: self.schedule("true", at))

    def schedule(self, value, at, how_long=Duration(), then=lambda: None):
        def answered(future):
            answer = future.result()
            if answer.success:
                then()
            else:
                self.get_logger().error(f"{self.output} {value} was refused: {answer.message}")

        if not self.client.service_is_ready():
            self.get_logger().error(f"{self.output} {value} was not scheduled: no service {self.client.srv_name}")
            return
        request = Schedule.Request(point=self.output, value=value, at=at.to_msg(), how_long=how_long.to_msg())
        self.client.call_async(request).add_done_callback(answered)

    def on_scheduled(self, outcome):
        if outcome.point != self.output:
            return
        if outcome.result == Scheduled.DONE:
            self.get_logger().info(f"{self.output}: write {outcome.number} done, {outcome.lateness * 1e3:.2f} ms late")
        else:
            self.get_logger().error(f"{self.output}: write {outcome.number} {RESULTS[outcome.result]}: {outcome.reason}")


def main():
    # rclpy's own handler of signals ends its context while spin() still uses it: with many messages, some ends are a traceback.
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    told_to_end = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: told_to_end.set())
    executor = SingleThreadedExecutor()
    executor.add_node(Eject())
    while not told_to_end.is_set():
        executor.spin_once(timeout_sec=0.2)
    rclpy.shutdown()


if __name__ == "__main__":
    main()
